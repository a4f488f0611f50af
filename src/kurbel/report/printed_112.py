"""The figures that Zusammenstellung 112 prints: F. Rötscher, Die Maschinenelemente (1927), p. 602 f.

Read from the scan. None where it is illegible: 70° and 80° lie in the fold between the two pages.
"""

from __future__ import annotations

__ = None  # illegible

STEP = 10
ACCELERATION = {
    5: (1.200, 1.173, 1.093, 0.966, 0.801, 0.608, 0.400, __, __, -0.200,
        -0.362, -0.495, -0.600, -0.678, -0.731, -0.766, -0.785, -0.796, -0.800),
    4.5: (1.222, 1.194, 1.110, 0.977, 0.805, 0.604, __, __, __, -0.222,
          -0.382, -0.512, -0.611, -0.681, -0.727, -0.755, -0.769, -0.776, -0.778),
    4: (1.250, 1.220, 1.131, 0.981, 0.809, 0.599, __, __, __, -0.250,
        -0.409, -0.534, -0.625, -0.686, -0.723, -0.741, -0.748, -0.750, -0.750),
}  # fmt: skip
"""L/R -> cos φ + R/L cos 2φ as printed, for φ = 0, 10, … 180°."""

VELOCITY = {
    5: (0.0, 0.206, 0.405, 0.585, 0.740, 0.865, 0.953, __, __, 1.000,
        0.950, 0.874, 0.779, 0.666, 0.542, 0.413, 0.278, 0.139, 0.0),
    4.5: (0.0, 0.212, 0.413, 0.597, 0.753, 0.877, __, __, __, 1.000,
          0.946, 0.867, 0.768, 0.655, 0.532, 0.403, 0.271, 0.136, 0.0),
    4: (0.0, 0.216, 0.423, 0.609, 0.768, 0.891, __, __, __, 1.000,
        0.941, 0.857, 0.755, 0.641, 0.518, 0.391, 0.261, 0.131, 0.0),
}  # fmt: skip
"""L/R -> sin(φ+ψ)/cos ψ as printed."""

PRINTED = {"acceleration_factor": ACCELERATION, "velocity_factor": VELOCITY}
"""Row id -> L/R -> figures."""

HALF_UNIT = 0.0005
"""Half a unit of the last printed decimal: what rounding may differ by."""
