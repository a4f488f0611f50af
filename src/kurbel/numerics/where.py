"""Where a quantity has a value: the exact angles over a cycle, and between which values it moves."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.numerics.grid import Grid
from kurbel.numerics.search import OnNodes, Sampled, curves, extremes_of, sign_changes


class Where(NamedTuple):
    """The angles in degrees at which a quantity has a value, ascending, and between which values it moves."""

    angles: tuple[float, ...]
    span: tuple[float, float]


def where(grid: Grid, samples: OnNodes, sampled: Callable[[Array, Array], Sampled], value: float) -> Where:
    """Return the angles of the cycle at which a quantity passes a value, or reaches it as its extreme.

    samples: the quantity on the grid, (pieces, nodes); sampled: takes (degrees, within), each (n,). At a jump over the
    value it is the angle of the jump.
    """
    whole = curves(grid, {"it": samples}, lambda *place: {"it": sampled(*place)})["it"]

    def less(degrees: Array, within: Array) -> dict[str, Sampled]:
        found = sampled(degrees, within)
        return {"it": Sampled(found.value - value, found.slope)}

    lowered = {"it": whole.less(value)}
    passed = sign_changes(grid, lowered, less, float(np.abs(whole.value).max()))["it"]
    ends = extremes_of(whole)
    reached = [one.degrees for one in ends if math.isclose(one.value, value, rel_tol=1e-14)]
    return Where(tuple(sorted({*passed.tolist(), *reached})), (ends.smallest.value, ends.largest.value))
