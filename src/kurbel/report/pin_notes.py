"""Which cylinders stand at one place along the shaft and share no crank pin, as `check` and `balance` note."""

import math
from collections.abc import Iterator
from itertools import pairwise

from kurbel.declared.unit_systems import show
from kurbel.machine import Cylinder, Machine

_SAME_PLACE = 1e-9  # m
_SAME_ANGLE = 1e-6  # degrees


def pin_notes(machine: Machine) -> Iterator[str]:
    """Yield which cylinders that stand at one place along the shaft share no crank pin."""
    placed = [one for one in machine.cylinders if one.axial_position is not None]
    for first, second in pairwise(sorted(placed, key=_place)):
        apart = math.remainder(_throw(second) - _throw(first), 360.0)
        if _place(second) - _place(first) <= _SAME_PLACE and abs(apart) > _SAME_ANGLE:
            yield (
                f"{first.name} and {second.name} stand at one place along the shaft, but their throws "
                f"{show(abs(apart), 'angle')} apart: they share no crank pin. Two on one pin have crank positions that "
                "differ as their bank angles do; throws of their own need an 'axial_position' each"
            )


def _place(cylinder: Cylinder) -> float:
    return cylinder.axial_position or 0.0


def _throw(cylinder: Cylinder) -> float:
    """Return where its throw stands at φ = 0, in degrees."""
    return cylinder.bank_angle - cylinder.crank_position
