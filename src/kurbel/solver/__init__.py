"""From a machine to its results, in SI: numpy, no files, no printing.

Letters before an equation number name the source: R is Rötscher, *Die Maschinenelemente* (1927), ch. 14; B is Blau,
*Die Mechanik fester Körper* (1905), § 6; D is Redtenbacher, *Der Maschinenbau* (1862); G is *Öl- und Gasmaschinen*,
on crankshafts. The books print magnitudes for each stroke; here every value has its sign, through the whole cycle:

- φ runs in the sense of rotation from the inner dead centre, where the piston is farthest from the shaft (G: firing
  dead centre); the outstroke leads to the outer one. Angles that are shown are in degrees, derivatives are by radians.
- x, c, b and the piston force P count positive toward the shaft; a force against the motion has the other sign.
- S is compression; N = P tan ψ presses on the guide on the side away from that of the pin on the outstroke; T pushes
  the crank pin on in the sense of rotation, D toward the shaft; M = T R.
- pressures are above the ambient; ψ is the tilt of the connecting rod, θ that of a swinging lever or rocker; λ = R/L.
"""
