"""Error against run time: every quantity by several methods, compared with references of 40 digits.

methods: rules and searches for floats and for mpmath's numbers. jets, linkages, valves, cards, efforts: motion, events
and what drives, in mpmath's numbers. textbook: the free bodies of a cylinder; references: what a machine sums over
them. trials: what is compared for a machine, and with which methods. shaft: the periodic speed of the shaft by
collocation; marching: its rivals; stiff: what is compared of it. extremes: the program on stiff and extreme input.
"""
