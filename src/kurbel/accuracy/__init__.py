"""Error against run time: every quantity by several methods, held against references of 40 digits.

methods: integrals, searches and periodic solutions in floats or in mpmath's numbers. textbook: the crank train once
more. trials: what is compared for a machine. extremes: the program on stiff and extreme input.
"""
