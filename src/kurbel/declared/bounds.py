"""What a machine file may hold: for every kind of quantity the smallest and the largest size of a value.

The bounds are far outside of what was ever built and far inside of what floats can be computed with, so that no square
and no quotient of values from a file leaves their range. They hold for the file, not for records made in Python.
"""

import math

from kurbel.declared.kinds import KINDS
from kurbel.declared.units import Factor
from kurbel.errors import Fault, Path

Point = tuple[float, float]

MOST_POINTS = 500_000
"""Points or samples of one diagram."""
MOST_ITEMS = 100
"""Items of one list, such as cylinders."""


def out_of_size(value: float, kind: str) -> str:
    """Return in what way a value in the base of its kind is beyond what a machine file may hold; '' if it is not.

    >>> out_of_size(1e-200, "length")
    'is too small; a length in a machine file is 0 or at least 1e-09 m'
    """
    smallest, largest, unit, *_ = KINDS[kind]
    if not abs(value) <= largest:
        return f"is too large; {_held(kind)} at most {largest:g} {unit}".rstrip()
    if 0 < abs(value) < smallest:
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
