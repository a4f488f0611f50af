"""What a machine file may hold: for every kind of quantity the smallest and the largest size of a value.

The bounds are far outside of what was ever built and far inside of what floats can be computed with, so that no square
and no quotient of values from a file leaves their range. They hold for the file, not for records made in Python.
"""

from __future__ import annotations

import math

from kurbel.declared.unit_systems import SI
from kurbel.declared.units import Factor
from kurbel.errors import Fault, Path

Point = tuple[float, float]

MOST_POINTS = 500_000
"""Points or samples of one diagram."""
MOST_ITEMS = 100
"""Items of one list, such as cylinders."""

SIZES: dict[str, tuple[float, float]] = {
    "length": (1e-9, 1e9),
    "area": (1e-18, 1e18),
    "mass": (1e-12, 1e18),
    "force": (0, 1e18),
    "pressure": (0, 1e15),
    "stress": (1e-3, 1e15),
    "time": (1e-12, 1e12),
    "angle": (0, 1e6),
    "speed": (1e-9, 1e6),
    "frequency": (1e-9, 1e9),
    "angular_velocity": (0, 1e9),
    "angular_acceleration": (0, 1e18),
    "velocity": (0, 1e15),
    "acceleration": (0, 1e18),
    "torque": (0, 1e18),
    "energy": (0, 1e18),
    "power": (0, 1e18),
    "inertia": (1e-18, 1e18),
    "unbalance": (1e-15, 1e18),
    "gd2": (1e-18, 1e18),
    "stiffness": (1e-12, 1e18),
    "damping": (1e-15, 1e18),
    "pressure_velocity": (0, 1e18),
    "volume": (1e-27, 1e27),
    "volume_rise": (0, 1e27),
    "pressure_rise": (0, 1e15),
    "density": (1e-9, 1e9),
    "spring": (1e-15, 1e3),
    "ratio": (1e-15, 1e15),
}
"""Kind -> the smallest size above 0, and the largest, in the base of the kind; a value may be 0, and of either sign.

Where the smallest is 0, values are sums in which noise is no fault: a measured pressure may be 1e-17 Pa. An angle of
1e6° is known to 1e-10°; beyond, nothing would be left of the angle within one turn.
"""


def out_of_size(value: float, kind: str) -> str:
    """Return in what way a value in the base of its kind is beyond what a machine file may hold; '' if it is not.

    >>> out_of_size(1e-200, "length")
    'is too small; a length in a machine file is 0 or at least 1e-09 m'
    """
    smallest, largest = SIZES[kind]
    name = "bare number" if kind == "ratio" else kind.replace("_", " ")
    name = f"{'an' if name[0] in 'aei' else 'a'} {name} in a machine file is"
    if not abs(value) <= largest:
        return f"is too large; {name} at most {largest:g} {SI[kind]}".rstrip()
    if 0 < abs(value) < smallest:
        return f"is too small; {name} 0 or at least {smallest:g} {SI[kind]}".rstrip()
    return ""


def range_of(kind: str) -> str:
    """Return the sizes that a value of this kind may have.

    >>> range_of("length")
    '0 or 1e-09 to 1e+09 m'
    """
    smallest, largest = SIZES[kind]
    return f"{f'0 or {smallest:g}' if smallest else '0'} to {largest:g} {SI[kind]}".rstrip()


def size_faults(points: list[Point], unit: Factor, kind: str, path: Path) -> list[Fault]:
    """Return a fault for the first point whose value in this unit of its kind is too large; [] where there is none."""
    up, down = unit
    largest = SIZES[kind][1]
    for index, (_, value) in enumerate(points):
        if not abs(value * up / down) <= largest:
            return [Fault((*path, index, 1), f"{value:g} {out_of_size(math.inf, kind)}")]
    return []
