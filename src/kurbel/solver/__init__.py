"""From a machine to its results: a case uses the whole machine, the machine its cylinders, a cylinder its pressures.

Letters before the numbers of formulas and pages name their source:

    R   Rötscher, Die Maschinenelemente, 1927, chapter 14
    B   Blau, 1905
    D   Redtenbacher, 1862
    G   Öl- und Gasmaschinen, the chapter on crankshafts

The books print magnitudes and change signs between the strokes; here every quantity has a sign of its own:

    φ        crank angle in degrees from the inner dead centre on, in the sense of rotation
    x, c, b  displacement from the inner dead centre toward the shaft, velocity, acceleration: c < 0 on the way back
    P        force along the stroke line, positive toward the shaft; friction and resistance count with their sign
    ψ        angle between rod and stroke line, positive on the side where the pin runs on the outstroke
    S, N     rod force, positive in compression; force on the guide, positive as P and ψ are
    D, T     force on the crank pin toward the shaft, and in the sense of rotation
    M        torque on the shaft, positive where it drives
"""
