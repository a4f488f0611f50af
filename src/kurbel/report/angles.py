"""The crank angles at which a table is printed."""

import math
from array import array
from collections.abc import Sequence

from kurbel.errors import UsageError

MOST_ROWS = 1_500_000
"""More rows than this, over all cylinders, are refused: they would not fit into half a gigabyte of memory."""


def stepped(step: float, end: float, parts: int = 1) -> Sequence[float]:
    """Return 0, step, 2 step, … up to `end`, and `end` itself, in degrees; parts: as for `check_rows`.

    >>> list(stepped(70, 180))
    [0.0, 70.0, 140.0, 180.0]

    Raises UsageError for a step that is not positive or gives too many rows.
    """
    if not 0 < step < math.inf:
        raise UsageError("--step must be a positive number of degrees")
    check_rows(end / step, parts)
    # whole steps are counted, not added up, and 3 · 0.1 is written 0.3, so that no rounding creeps in
    count = math.ceil(end / step * (1 - 1e-12))
    angles = array("d", (float(f"{i * step:.15g}") for i in range(count)))
    angles.append(end)
    return angles


def check_rows(angles: float, parts: int) -> None:
    """Raise UsageError for a table that is too long; parts: the cylinders or L/R that have these angles each."""
    if angles * parts > MOST_ROWS:
        each = f" for each of {parts}" if parts > 1 else ""
        raise UsageError(
            f"{angles:.7g} crank angles{each} give more than {MOST_ROWS} rows; take a larger --step or fewer --angles"
        )


def crank_angles(step: float, angles: Sequence[float] | None, end: float, parts: int) -> Sequence[float]:
    """Return the angles given, or 0, step, 2 step, … `end` in degrees; parts: cylinders or L/R that have them each."""
    if angles is None:
        return stepped(step, end, parts)
    check_rows(len(angles), parts)
    return angles
