"""Error against run time: every quantity by several methods, compared with references of 40 digits.

methods: rules and searches for floats and for mpmath's numbers. cards, textbook: the crank train after the books, in
mpmath's numbers. trials: what is compared for a machine, and with which methods. shaft: the periodic speed of the shaft
by collocation; marching: its rivals; stiff: what is compared of it. extremes: the program on stiff and extreme input.
"""
