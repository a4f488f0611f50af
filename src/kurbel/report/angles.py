"""The crank angles at which a table is printed."""

from __future__ import annotations

import math

from kurbel.errors import UsageError

MOST = 1_000_000
"""More rows than this are refused."""


def stepped(step: float, end: float) -> tuple[float, ...]:
    """Return 0, step, 2 step, … up to `end`, and `end` itself, in degrees.

    >>> stepped(70, 180)
    (0.0, 70.0, 140.0, 180.0)

    Raises UsageError for a step that is not positive or gives too many rows.
    """
    if not 0 < step < math.inf:
        raise UsageError("--step must be a positive number of degrees")
    if end / step > MOST:
        raise UsageError(f"--step {step:g} gives more than {MOST} angles")
    # whole steps are counted, not added up, and 3 · 0.1 is written 0.3, so that no rounding creeps in
    count = math.ceil(end / step * (1 - 1e-12))
    return (*(float(f"{i * step:.15g}") for i in range(count)), float(end))
