"""The samples of a measured trace, put to the test and closed to a whole cycle."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kurbel.declared.bounds import out_of_size
from kurbel.errors import Fault, RuleError
from kurbel.machine.trace import PERIODS

if TYPE_CHECKING:
    from kurbel.arrays import Array

Named = Callable[[int], Fault]
"""The place of a sample as a fault that lacks a message."""


class Samples(NamedTuple):
    """One cycle of a trace: angles (n,) in degrees, rising over a period, values (n,), what was tidied up."""

    angles: Array
    values: Array
    notes: tuple[str, ...] = ()


def whole_cycle(angles: Array, values: Array, named: Named, kind: str = "pressure") -> Samples:
    """Return the samples closed to a whole cycle; raises RuleError for what cannot be one.

    angles (n,) in degrees, values (n,) in the base of their kind; named: the place of a sample as a fault that lacks a
    message.
    """
    first = _wrap(angles)
    angles, values = np.roll(angles, -first), np.roll(values, -first)
    place = _rolled(named, first, len(angles))
    fault = _number_fault(angles, values, place, kind) or _order_fault(angles, place)
    if fault:
        raise RuleError(fault)
    turned = (f"the angle begins anew at {angles[0]:.10g} deg; the samples from there on come first",) if first else ()
    angles, values, twins = _without_twins(angles, values)
    notes = (*turned, *twins)
    span = float(angles[-1] - angles[0])
    period = next((p for p in PERIODS if span <= p * (1 + 1e-9)), 0.0)
    if not period:
        raise RuleError(
            _say(place(len(angles) - 1), f"the samples run over {span:g} deg; cut one cycle of 720 deg out")
        )
    return _closed(angles, values, period, notes, place)


def _wrap(angles: Array) -> int:
    """Return the index of the sample at which the angle of one cycle begins anew, 0 where it does not."""
    back = np.flatnonzero(np.diff(angles) < 0)
    once = len(back) == 1 and angles[back[0]] - angles[back[0] + 1] > 180 and angles[-1] <= angles[0]
    return int(back[0]) + 1 if once else 0


def _rolled(named: Named, first: int, count: int) -> Named:
    """Return `named` for samples of which the one with index `first` has come to the front."""
    return lambda index: named((index + first) % count)


def _say(place: Fault, message: str) -> Fault:
    return place._replace(message=f"{place.message}: {message}" if place.message else message)


def _number_fault(angles: Array, values: Array, named: Named, kind: str) -> Fault | None:
    for what, given in (("angle", angles), (kind, values)):
        bad = np.flatnonzero(~np.isfinite(given))
        if len(bad):
            more = f" ({len(bad)} such samples)" if len(bad) > 1 else ""
            return _say(named(int(bad[0])), f"the {what} is {given[bad[0]]}, not a number{more}; leave such rows out")
        top = int(np.abs(given).argmax())
        wrong = out_of_size(abs(float(given[top])), what)
        if "large" in wrong:
            return _say(named(top), f"the {what} {given[top]:g} {wrong}")
    return None


def _order_fault(angles: Array, named: Named) -> Fault | None:
    back = np.flatnonzero(np.diff(angles) < 0)
    if len(back):
        i = int(back[0]) + 1
        turned = angles[i - 1] - angles[i] > 180
        advice = "a cycle ends here; keep one cycle only" if turned else "put the points in order of the angle"
        return _say(named(i), f"{angles[i]:.10g} deg after {angles[i - 1]:.10g} deg; {advice}")
    if len(angles) < 2 or angles[0] == angles[-1]:
        return _say(named(0), "a trace needs samples at two angles or more")
    thrice = np.flatnonzero(angles[2:] == angles[:-2])
    if len(thrice):
        i = int(thrice[0]) + 2
        return _say(named(i), f"three points at {angles[i]:.10g} deg; a jump has two")
    return None


def _without_twins(angles: Array, values: Array) -> tuple[Array, Array, tuple[str, ...]]:
    twins = (np.diff(angles) == 0) & (np.diff(values) == 0)
    if not twins.any():
        return angles, values, ()
    kept = np.concatenate(([True], ~twins))
    return angles[kept], values[kept], (f"{int(twins.sum())} samples given twice count once",)


def _closed(angles: Array, values: Array, period: float, notes: tuple[str, ...], named: Named) -> Samples:
    """Close the cycle with the first sample where only the last one is missing."""
    end = float(angles[0]) + period
    missing = end - float(angles[-1])
    if missing > 1.5 * _usual_step(angles):
        raise RuleError(_say(named(len(angles) - 1), _hole(float(angles[-1]), end)))
    if missing > 1e-9 * period:
        notes += (f"the closing sample at {end:.10g} deg is missing; that at {angles[0]:.10g} deg closes the cycle",)
        angles, values = np.append(angles, end), np.append(values, values[0])
    else:
        angles = np.append(angles[:-1], end)
    _refuse_large_holes(angles, named)
    return Samples(angles, values, (*notes, *_hole_notes(angles)))


def _hole(begin: float, end: float) -> str:
    return f"no samples from {begin:.10g} to {end:.10g} deg; a trace covers a whole cycle of 360 or 720 deg"


def _usual_step(angles: Array) -> float:
    """Return the step in degrees such that no wider ones cover half of the angle: a denser stretch is no rule."""
    steps = np.sort(np.diff(angles))
    return float(steps[np.searchsorted(np.cumsum(steps), steps.sum() / 2)])


_LARGE_HOLES = ((20.0, 10.0), (45.0, 3.0))
"""(degrees, times the median step) beyond both of which no straight line stands for what was not measured."""


def _refuse_large_holes(angles: Array, named: Named) -> None:
    steps = np.diff(angles)
    given = np.sort(steps[steps > 0])
    median = float(given[len(given) // 2])  # numpy.median imports numpy.ma, a fifth of the start-up
    for width, times in _LARGE_HOLES:
        wide = np.flatnonzero((steps > width) & (steps > times * median))
        if len(wide):
            i = int(wide[0])
            raise RuleError(_say(named(i), _hole(float(angles[i]), float(angles[i + 1]))))


def _hole_notes(angles: Array) -> tuple[str, ...]:
    """Say where samples are missing: steps wider than three usual ones."""
    wide = np.flatnonzero(np.diff(angles) > 3 * _usual_step(angles))
    return tuple(
        f"no samples from {angles[i]:.10g} to {angles[i + 1]:.10g} deg; a straight line joins them"
        for i in wide[:5].tolist()
    )
