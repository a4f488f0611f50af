"""A recording: samples, each with the row of its file, and what is refused of them there."""

from collections.abc import Callable
from typing import Any, NamedTuple, NoReturn

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.errors import Fault, RuleError


class Recording(NamedTuple):
    """Samples in the order of time: angles (n,) in degrees, values (k, n), and of which row each is (n,).

    place: of a row, as a fault that lacks a message.
    """

    angles: Array
    values: Array
    rows: Indices
    place: Callable[[int], Fault]

    @classmethod
    def of(cls, angles: Array, values: Array, place: Callable[[int], Fault], against: bool = False) -> "Recording":
        """Return the samples of all rows; against: their angles count against the rotation."""
        whole = cls(angles, values, np.arange(len(angles)), place)
        if not against:
            return whole
        steps = np.diff(angles)
        # most rise: they stand in the order of the angle, not of time
        ordered = whole.taken(slice(None, None, -1)) if (steps > 0).sum() > (steps < 0).sum() else whole
        return ordered._replace(angles=-ordered.angles)

    def taken(self, which: Any) -> "Recording":
        """Return these samples of it."""
        return Recording(self.angles[which], self.values[:, which], self.rows[which], self.place)

    def refuse(self, index: int, message: str) -> NoReturn:
        """Raise RuleError with what is wrong with a sample."""
        place = self.place(int(self.rows[index]))
        raise RuleError(place._replace(message=f"{place.message}: {message}" if place.message else message))


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


def refuse_large_holes(recording: Recording) -> None:
    """Raise RuleError where a stretch without samples is wide, in degrees and in steps."""
    angles = recording.angles
    steps = np.diff(angles)
    given = np.sort(steps[steps > 0])
    median = float(given[len(given) // 2])  # numpy.median imports numpy.ma, a fifth of the start-up
    for width, times in _LARGE_HOLES:
        wide = np.flatnonzero((steps > width) & (steps > times * median))
        if len(wide):
            i = int(wide[0])
            recording.refuse(i, hole(float(angles[i]), float(angles[i + 1])))
