"""The samples of a measured trace, put to the test, cut into turns, and closed to whole cycles."""

from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.bounds import MOST_POINTS, out_of_size
from kurbel.errors import Fault, RuleError
from kurbel.machine.trace import PERIODS
from kurbel.machine_file.holes import Named, counted_otherwise, hole, hole_notes, refuse_large_holes, said, usual_step
from kurbel.machine_file.turns import Record, lapped


class Samples(NamedTuple):
    """Laps of a trace, one after the other: of one cycle each, or of one turn each where only the machine tells.

    angles (n,) in degrees, rising over a period; values (m, n) of m laps; notes: what was tidied up; completed: the
    last sample is the first one again, none stood there.
    """

    angles: Array
    values: Array
    notes: tuple[str, ...] = ()
    completed: bool = False


def whole_cycle(angles: Array, values: Array, named: Named, kind: str = "pressure") -> Samples:
    """Return the samples closed to whole cycles; raises RuleError for what cannot be one.

    angles (n,) in degrees; values (k, n) in the base of their kind, of k columns; named: the place of a sample as a
    fault that lacks a message.
    """
    _refuse_no_numbers(angles, values, named, kind)
    angles, values, place, turned = _begun_at_its_start(angles, values, named)
    _refuse_disorder(angles, place)
    record, told = lapped(Record(angles, values, np.arange(len(angles))), place)
    _refuse_thrice(record, place)
    record, twins = _without_twins(record)
    span = float(record.angles[-1] - record.angles[0])
    period = next((p for p in PERIODS if span <= p * (1 + 1e-9)), 0.0)
    if not period:
        raise RuleError(said(place(len(angles) - 1), f"the samples run over {span:g} deg; cut whole cycles out"))
    if len(record.angles) > MOST_POINTS:
        raise RuleError(said(place(MOST_POINTS), f"one cycle has more than {MOST_POINTS} samples; thin them out"))
    return _closed(record, period, (*turned, *told, *twins), place)


def _begun_at_its_start(angles: Array, values: Array, named: Named) -> tuple[Array, Array, Named, tuple[str, ...]]:
    """Return the samples of one cycle that begins within it from its smallest angle on, others as they are."""
    back = np.flatnonzero(np.diff(angles) < 0)
    falls = len(back) == 1 and 180 < angles[back[0]] - angles[back[0] + 1] <= PERIODS[-1]
    once = falls and angles[-1] <= angles[0]
    if not once:
        return angles, values, named, ()
    first, count = int(back[0]) + 1, len(angles)
    rolled = np.roll(angles, -first)
    note = f"the angle begins anew at {rolled[0]:.10g} deg; the samples from there on come first"
    return rolled, np.roll(values, -first, axis=1), lambda index: named((index + first) % count), (note,)


def _refuse_no_numbers(angles: Array, values: Array, named: Named, kind: str) -> None:
    for what, given in (("angle", angles[np.newaxis]), (kind, values)):
        bad = np.flatnonzero(~np.isfinite(given).all(axis=0))
        if len(bad):
            first = int(bad[0])
            wrong = next(one for one in given[:, first].tolist() if not np.isfinite(one))
            more = f" ({len(bad)} such samples)" if len(bad) > 1 else ""
            raise RuleError(said(named(first), f"the {what} is {wrong}, not a number{more}; leave such rows out"))
        row, top = divmod(int(np.abs(given).argmax()), given.shape[1])
        beyond = out_of_size(abs(float(given[row, top])), what)
        if "large" in beyond:
            raise RuleError(said(named(top), f"the {what} {given[row, top]:g} {beyond}"))


def _refuse_disorder(angles: Array, named: Named) -> None:
    """Raise RuleError where the angle goes back by less than half a turn: there no turn ends."""
    steps = np.diff(angles)
    back = np.flatnonzero((steps < 0) & (steps >= -180))
    if len(back) > 1 and len(back) >= 0.9 * len(steps) and len(back) == np.count_nonzero(steps < 0):
        message = (
            f"the angle falls from {angles[0]:.10g} to {angles[-1]:.10g} deg: the rows run backward; put them in order "
            "of the angle, or write 'angle_sense: against' if the encoder counts against the rotation"
        )
        raise RuleError(said(named(int(back[0]) + 1), message))
    if len(back):
        i = int(back[0]) + 1
        order = "put the points in order of the angle"
        raise RuleError(said(named(i), f"{angles[i]:.10g} deg after {angles[i - 1]:.10g} deg; {order}"))
    if len(angles) < 2 or (angles[0] == angles[-1] and not (steps < 0).any()):
        raise RuleError(said(named(0), "a trace needs samples at two angles or more"))


def _refuse_thrice(record: Record, named: Named) -> None:
    angles = record.angles
    thrice = np.flatnonzero(angles[2:] == angles[:-2])
    if len(thrice):
        i = int(thrice[0]) + 2
        finer = f"; write 'angle_step' if the angles are only rounded ({len(thrice) + 1} such samples)"
        message = f"three points at {angles[i]:.10g} deg; a jump has two{finer if len(thrice) > 1 else ''}"
        raise RuleError(said(named(int(record.rows[i])), message))


_ROUNDED = 0.25
"""Share of samples at the angle of the one before from which on the angles are rounded: of those none is left out."""


def _without_twins(record: Record) -> tuple[Record, tuple[str, ...]]:
    twins = np.diff(record.angles) == 0
    if not twins.any() or np.count_nonzero(twins) >= _ROUNDED * len(record.angles) > 2:
        return record, ()
    twins &= (np.diff(record.values) == 0).all(axis=0)
    if not twins.any():
        return record, ()
    kept = np.concatenate(([True], ~twins))
    told = (f"{int(twins.sum())} samples given twice count once",)
    return Record(record.angles[kept], record.values[:, kept], record.rows[kept]), told


def _closed(record: Record, period: float, notes: tuple[str, ...], named: Named) -> Samples:
    """Close the cycle with the first sample where only the last one is missing."""
    angles, values, rows = record

    def place(index: int) -> Fault:
        return named(int(rows[index]))

    end = float(angles[0]) + period
    missing = end - float(angles[-1])
    if missing > 1.5 * usual_step(angles):
        message = hole(float(angles[-1]), end) + counted_otherwise(float(angles[-1] - angles[0]))
        raise RuleError(said(place(len(angles) - 1), message))
    completed = missing > 1e-9 * period
    if completed:
        angles, values = np.append(angles, end), np.append(values, values[:, :1], axis=1)
    else:
        angles = np.append(angles[:-1], end)
    refuse_large_holes(angles, place)
    return Samples(angles, values, (*notes, *hole_notes(angles)), completed)
