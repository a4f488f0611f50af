"""Error against run time: every quantity by several methods, held against references of high precision.

given: what the file says, in any kind of number. decimals, oracle, references, periodic: the truth in Decimal, by other
methods than the solver's. textbook, rivals, marching: how else one could compute it. scenes: what for. trials: the
rows. extremes: the program on stiff and extreme input. Nothing here is imported by what it examines.
"""
