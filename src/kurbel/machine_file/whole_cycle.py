"""The samples of a measured trace, put to the test, cut into turns, and closed to whole cycles."""

import math
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.kinds import MOST_POINTS, out_of_size
from kurbel.machine_file.recording import Recording, hole, refuse_large_holes, usual_step
from kurbel.machine_file.turns import lapped
from kurbel.traces.correct import PERIODS


class Samples(NamedTuple):
    """Laps of a trace, one after the other: of one cycle each, or of one turn each where only the machine tells.

    angles (n,) in degrees, rising over a period; values (m, n) of m laps; notes: what was tidied up; completed: the
    last sample is the first one again, none stood there.
    """

    angles: Array
    values: Array
    notes: tuple[str, ...] = ()
    completed: bool = False


def whole_cycle(recording: Recording, kind: str = "pressure") -> Samples:
    """Return the samples closed to whole cycles, values in the base of their kind; raises RuleError for what cannot be.

    A recording has a row of values for each measured column.
    """
    _refuse_no_numbers(recording, kind)
    begun, turned = _begun_at_its_start(recording)
    _refuse_disorder(begun)
    laps, told = lapped(begun)
    _refuse_thrice(laps)
    laps, twins = _without_twins(laps)
    span = float(laps.angles[-1] - laps.angles[0])
    period = next((p for p in PERIODS if span <= p * (1 + 1e-9)), 0.0)
    if not period:
        laps.refuse(-1, f"the samples run over {span:g} deg; cut whole cycles out")
    if len(laps.angles) > MOST_POINTS:
        laps.refuse(MOST_POINTS, f"one cycle has more than {MOST_POINTS} samples; thin them out")
    return _closed(laps, period, (*turned, *told, *twins))


def _begun_at_its_start(recording: Recording) -> tuple[Recording, tuple[str, ...]]:
    """Return a recording of one cycle that begins within it from its smallest angle on, others as they are."""
    angles = recording.angles
    back = np.flatnonzero(np.diff(angles) < 0)
    falls = len(back) == 1 and 180 < angles[back[0]] - angles[back[0] + 1] <= PERIODS[-1]
    if not falls or angles[-1] > angles[0]:
        return recording, ()
    first = int(back[0]) + 1
    values, rows = np.roll(recording.values, -first, axis=1), np.roll(recording.rows, -first)
    note = f"the angle begins anew at {angles[first]:.10g} deg; the samples from there on come first"
    return Recording(np.roll(angles, -first), values, rows, recording.place), (note,)


def _refuse_no_numbers(recording: Recording, kind: str) -> None:
    for what, given in (("angle", recording.angles[np.newaxis]), (kind, recording.values)):
        bad = np.flatnonzero(~np.isfinite(given).all(axis=0))
        if len(bad):
            first = int(bad[0])
            wrong = next(one for one in given[:, first].tolist() if not np.isfinite(one))
            more = f" ({len(bad)} such samples)" if len(bad) > 1 else ""
            recording.refuse(first, f"the {what} is {wrong}, not a number{more}; leave such rows out")
        row, top = divmod(int(np.abs(given).argmax()), given.shape[1])
        beyond = out_of_size(abs(float(given[row, top])), what)
        if "large" in beyond:
            recording.refuse(top, f"the {what} {given[row, top]:g} {beyond}")


def _refuse_disorder(recording: Recording) -> None:
    """Raise RuleError where the angle goes back by less than half a turn: there no turn ends."""
    angles = recording.angles
    steps = np.diff(angles)
    back = np.flatnonzero((steps < 0) & (steps >= -180))
    if len(back) > 1 and len(back) >= 0.9 * len(steps) and len(back) == np.count_nonzero(steps < 0):
        message = (
            f"the angle falls from {angles[0]:.10g} to {angles[-1]:.10g} deg: the rows run backward; put them in order "
            "of the angle, or write 'angle_sense: against' if the encoder counts against the rotation"
        )
        recording.refuse(int(back[0]) + 1, message)
    if len(back):
        i = int(back[0]) + 1
        order = "put the points in order of the angle"
        recording.refuse(i, f"{angles[i]:.10g} deg after {angles[i - 1]:.10g} deg; {order}")
    if len(angles) < 2 or (angles[0] == angles[-1] and not (steps < 0).any()):
        recording.refuse(0, "a trace needs samples at two angles or more")


def _refuse_thrice(recording: Recording) -> None:
    angles = recording.angles
    thrice = np.flatnonzero(angles[2:] == angles[:-2])
    if len(thrice):
        i = int(thrice[0]) + 2
        finer = f"; write 'angle_step' if the angles are only rounded ({len(thrice) + 1} such samples)"
        recording.refuse(i, f"three points at {angles[i]:.10g} deg; a jump has two{finer if len(thrice) > 1 else ''}")


_ROUNDED = 0.25
"""Share of samples at the angle of the one before from which on the angles are rounded: of those none is left out."""


def _without_twins(recording: Recording) -> tuple[Recording, tuple[str, ...]]:
    twins = np.diff(recording.angles) == 0
    if not twins.any() or np.count_nonzero(twins) >= _ROUNDED * len(recording.angles) > 2:
        return recording, ()
    twins &= (np.diff(recording.values) == 0).all(axis=0)
    if not twins.any():
        return recording, ()
    told = (f"{int(twins.sum())} samples given twice count once",)
    return recording.taken(np.concatenate(([True], ~twins))), told


def _closed(recording: Recording, period: float, notes: tuple[str, ...]) -> Samples:
    """Close the cycle with the first sample where only the last one is missing."""
    angles, values, *_ = recording
    end = float(angles[0]) + period
    missing = end - float(angles[-1])
    if missing > 1.5 * usual_step(angles):
        recording.refuse(-1, hole(float(angles[-1]), end) + _counted_otherwise(float(angles[-1] - angles[0])))
    completed = missing > 1e-9 * period
    if completed:
        values = np.append(values, values[:, :1], axis=1)
    angles = np.append(angles if completed else angles[:-1], end)
    refuse_large_holes(recording._replace(angles=angles))
    return Samples(angles, values, (*notes, *_hole_notes(angles)), completed)


def _counted_otherwise(span: float) -> str:
    """Return what to write if angles that run over so few degrees are none; '' where they are too many for that.

    >>> _counted_otherwise(12.56)
    "; are these radians? Then write 'angle_unit: rad'"
    """
    if any(abs(span / turns - 2 * math.pi) < 0.2 for turns in (1, 2)):
        return "; are these radians? Then write 'angle_unit: rad'"
    return "; are these times? Then write 'angle_unit: s' and 'recorded_speed: 1500 rpm', say" if span < 10 else ""


def _hole_notes(angles: Array) -> tuple[str, ...]:
    """Say where samples are missing: steps wider than three usual ones."""
    wide = np.flatnonzero(np.diff(angles) > 3 * usual_step(angles))
    return tuple(
        f"no samples from {angles[i]:.10g} to {angles[i + 1]:.10g} deg; a straight line joins them"
        for i in wide[:5].tolist()
    )
