"""Error against run time: every quantity by several methods, compared with references of 40 digits.

methods: rules and searches for floats and for mpmath's numbers. textbook: the crank train after the books, in mpmath's
numbers. trials: what is compared for a machine, and with which methods. extremes: the program on stiff and extreme
input.
"""
