"""Where samples are missing: refused where no straight line stands for them, else told."""

import math
from collections.abc import Callable

import numpy as np

from kurbel.arrays import Array
from kurbel.errors import Fault, RuleError

Named = Callable[[int], Fault]
"""The place of a sample as a fault that lacks a message."""


def said(place: Fault, message: str) -> Fault:
    """Return the fault at a place with its message."""
    return place._replace(message=f"{place.message}: {message}" if place.message else message)


def hole(begin: float, end: float) -> str:
    """Return what is missing from a cycle."""
    return f"no samples from {begin:.10g} to {end:.10g} deg; a trace covers a whole cycle of 360 or 720 deg"


def usual_step(angles: Array) -> float:
    """Return the step in degrees such that no wider ones cover half of the angle: a denser stretch is no rule."""
    steps = np.sort(np.diff(angles))
    passed = np.cumsum(steps)
    return float(steps[np.searchsorted(passed, passed[-1] / 2)])


_LARGE_HOLES = ((20.0, 10.0), (45.0, 3.0))
"""(degrees, times the median step) beyond both of which no straight line stands for what was not measured."""


def counted_otherwise(span: float) -> str:
    """Return what to write if angles that run over so few degrees are none; '' where they are too many for that.

    >>> counted_otherwise(12.56)
    "; are these radians? Then write 'angle_unit: rad'"
    """
    if any(abs(span / turns - 2 * math.pi) < 0.2 for turns in (1, 2)):
        return "; are these radians? Then write 'angle_unit: rad'"
    return "; are these times? Then write 'angle_unit: s' and 'recorded_speed: 1500 rpm', say" if span < 10 else ""


def refuse_large_holes(angles: Array, named: Named) -> None:
    """Raise RuleError where a stretch without samples is wide, in degrees and in steps."""
    steps = np.diff(angles)
    given = np.sort(steps[steps > 0])
    median = float(given[len(given) // 2])  # numpy.median imports numpy.ma, a fifth of the start-up
    for width, times in _LARGE_HOLES:
        wide = np.flatnonzero((steps > width) & (steps > times * median))
        if len(wide):
            i = int(wide[0])
            raise RuleError(said(named(i), hole(float(angles[i]), float(angles[i + 1]))))


def hole_notes(angles: Array) -> tuple[str, ...]:
    """Say where samples are missing: steps wider than three usual ones."""
    wide = np.flatnonzero(np.diff(angles) > 3 * usual_step(angles))
    return tuple(
        f"no samples from {angles[i]:.10g} to {angles[i + 1]:.10g} deg; a straight line joins them"
        for i in wide[:5].tolist()
    )
