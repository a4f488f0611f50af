"""Results of a machine: pressures in a chamber, forces in a cylinder, torque of all cylinders, and so on.

Letters before the numbers of formulas and pages name their source:

    R   Rötscher, Die Maschinenelemente, 1927, chapter 14
    B   Blau, 1905
    D   Redtenbacher, 1862
    G   Öl- und Gasmaschinen, the chapter on crankshafts

The books print magnitudes and change signs between the strokes; here every quantity is signed:

    φ        crank angle in degrees from the inner dead centre, in the sense of rotation
    x, c, b  displacement from the inner dead centre toward the shaft, velocity, acceleration; c < 0 on the return
    P        force along the stroke line, positive toward the shaft, as are friction and load along this line
    ψ        angle between rod and stroke line, positive where the crank pin is on its side of the outstroke
    S, N     rod force, positive in compression; force on the guide, positive where P and ψ are positive
    D, T     force on the crank pin toward the shaft, and in the sense of rotation
    M        torque on the shaft, positive where it drives
"""
