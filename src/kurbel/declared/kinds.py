"""Every kind of quantity, declared once: its units as people read it, the sizes that a machine file may hold.

The sizes are far outside of what was ever built and far inside of what floats can be computed with, so that no square
and no quotient of values from a file leaves their range. They hold for the file, not for records made in Python.
"""

# annotations are taken as they stand: NamedTuple compiles each postponed one at every start

import math
from typing import Any, NamedTuple

from kurbel.errors import Fault, Path
from kurbel.numerics.arithmetic import every, some

Factor = tuple[float, float]
"""A unit as multiplier and divisor of its base, so that 450 mm becomes 450 / 1000, correctly rounded."""


class Kind(NamedTuple):
    """What is said of a kind: sizes in its base, and units, of which none is that of SI.

    smallest: above 0; where it is 0, values are sums in which noise is no fault: a measured pressure may be 1e-17 Pa.
    metric: also several units, of which the size of a value decides. written: a value as a person writes it.
    """

    smallest: float
    largest: float
    si: str
    metric: Any = None
    technical: Any = None
    imperial: Any = None
    written: str = ""


KINDS = {
    "length": Kind(1e-9, 1e9, "m", ("mm", "m"), "mm", "in", "450 mm"),
    "area": Kind(1e-18, 1e18, "m^2", "cm^2", "cm^2", "in^2"),
    "mass": Kind(1e-12, 1e18, "kg", ("kg", "t"), None, "lb", "120 kg"),
    "force": Kind(0, 1e18, "N", ("N", "kN", "MN"), "kgf", "lbf"),
    "pressure": Kind(0, 1e15, "Pa", ("mbar", "bar"), "at", "psi", "5.4 bar"),
    "stress": Kind(1e-3, 1e15, "Pa", "N/mm^2", "kgf/cm^2", "psi", "60 N/mm2"),
    "time": Kind(1e-12, 1e12, "s"),
    "angle": Kind(0, 1e6, "deg", written="90 deg"),
    "speed": Kind(1e-9, 1e6, "1/s", "rpm", "rpm", "rpm", "50 rpm"),
    "frequency": Kind(1e-9, 1e9, "Hz"),
    "angular_velocity": Kind(0, 1e9, "rad/s"),
    "angular_acceleration": Kind(0, 1e18, "rad/s^2"),
    "velocity": Kind(0, 1e15, "m/s", imperial="ft/s"),
    "acceleration": Kind(0, 1e18, "m/s^2", imperial="ft/s^2"),
    "torque": Kind(0, 1e18, "N m", ("N m", "kN m"), "kgf m", "lbf ft"),
    "energy": Kind(0, 1e18, "J", ("J", "kJ", "MJ"), "kgf m", "lbf ft"),
    "power": Kind(0, 1e18, "W", ("W", "kW", "MW"), "PS", "hp"),
    "inertia": Kind(1e-18, 1e18, "kg m^2", imperial="lb ft^2"),
    "unbalance": Kind(1e-15, 1e18, "kg m", imperial="lb in"),
    "gd2": Kind(1e-18, 1e18, "kg m^2", None, "kgf m^2", "lb ft^2", "10 kgf m2"),
    "stiffness": Kind(1e-12, 1e18, "N m/rad", imperial="lbf ft/rad"),
    "damping": Kind(1e-15, 1e18, "N m s/rad", imperial="lbf ft s/rad"),
    "pressure_velocity": Kind(0, 1e18, "W/m^2", "N/mm^2 m/s", "kgf m/s/cm^2", "psi ft/s"),
    "volume": Kind(1e-27, 1e27, "m^3", ("cm^3", "m^3"), "dm^3", "in^3", "10 cm3"),
    "volume_rise": Kind(0, 1e27, "m^3/deg", "cm^3/deg", "cm^3/deg", "in^3/deg"),
    "pressure_rise": Kind(0, 1e15, "Pa/deg", ("mbar/deg", "bar/deg"), "at/deg", "psi/deg", "10 bar/deg"),
    "density": Kind(1e-9, 1e9, "kg/m^3"),
    "spring": Kind(1e-15, 1e3, "m/Pa", "mm/bar", "mm/at", "in/psi", "10 mm/at"),
    "ratio": Kind(1e-15, 1e15, ""),
}
"""A value may be 0, and of either sign. An angle of 1e6° is known to 1e-10°; beyond, nothing of it would be left."""

Point = tuple[float, float]

MOST_POINTS = 500_000
"""Points or samples of one diagram."""
MOST_ITEMS = 100
"""Items of one list, such as cylinders."""


def out_of_size(value: Any, kind: str) -> str:
    """Return in what way a value in the base of its kind, or any of many, is beyond what a machine file may hold.

    >>> out_of_size(1e-200, "length")
    'is too small; a length in a machine file is 0 or at least 1e-09 m'
    """
    smallest, largest, unit, *_ = KINDS[kind]
    if not every(abs(value) <= largest):
        return f"is too large; {_held(kind)} at most {largest:g} {unit}".rstrip()
    if some((value != 0) & (abs(value) < smallest)):
        return f"is too small; {_held(kind)} 0 or at least {smallest:g} {unit}".rstrip()
    return ""


def _held(kind: str) -> str:
    name = "bare number" if kind == "ratio" else kind.replace("_", " ")
    return f"{'an' if name[0] in 'aei' else 'a'} {name} in a machine file is"


def range_of(kind: str) -> str:
    """Return the sizes that a value of this kind may have.

    >>> range_of("length")
    '0 or 1e-09 to 1e+09 m'
    """
    smallest, largest, unit, *_ = KINDS[kind]
    return f"{f'0 or {smallest:g}' if smallest else '0'} to {largest:g} {unit}".rstrip()


def size_faults(points: list[Point], unit: Factor, kind: str, path: Path) -> list[Fault]:
    """Return a fault for the first point whose value in this unit of its kind is too large; [] where there is none."""
    up, down = unit
    largest = KINDS[kind].largest
    for index, (_, value) in enumerate(points):
        if not abs(value * up / down) <= largest:
            return [Fault((*path, index, 1), f"{value:g} {out_of_size(math.inf, kind)}")]
    return []
