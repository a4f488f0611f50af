"""From samples of one or many cycles, as a logger wrote them, to laps of whole cycles over the same angles.

A lap is the range after which the angle restarts: a turn, or a four-stroke cycle. If the angle increases without
restart, a lap is one turn, and two make a four-stroke cycle. Incomplete cycles are rejected, with the row.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple, NoReturn

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.declared.forms.values import out_of_size
from kurbel.declared.units import MOST_POINTS
from kurbel.errors import Fault, RuleError
from kurbel.traces.correct import PERIODS, period_of
from kurbel.traces.read import LIMITS, Layout, read_table


class Samples(NamedTuple):
    """Laps of a trace in order: of one cycle each, or of one turn each if only the machine file decides the cycle.

    angles (n,) in degrees, rising over a period; values (m, n) of m laps; notes: what was corrected; completed: the
    closing sample is a copy of the first, as the file has none; headed: the unit in the heading of the values, or ''.
    """

    angles: Array
    values: Array
    notes: tuple[str, ...] = ()
    completed: bool = False
    headed: str = ""


class Recording(NamedTuple):
    """Samples in the order of time: angles (n,) in degrees, values (k, n), and of which row each is (n,).

    place: of a row, as a fault that lacks a message.
    """

    angles: Array
    values: Array
    rows: Indices
    place: Callable[[int], Fault]

    def taken(self, which: Any) -> "Recording":
        """Return the recording with only these samples."""
        return Recording(self.angles[which], self.values[:, which], self.rows[which], self.place)

    def refuse(self, index: int, message: str) -> NoReturn:
        """Raise RuleError with what is wrong with a sample."""
        place = self.place(int(self.rows[index]))
        raise RuleError(place._replace(message=f"{place.message}: {message}" if place.message else message))


def samples_of_file(
    file: str, layout: Layout, kind: str, base: Callable[[Array], Array], against: bool = False
) -> Samples:
    """Return the laps of what was measured from a file; raises RuleError.

    kind: of the values, pressure or torque; base: turns figures of the file into the base of their unit; against:
    angles count against the rotation.
    """
    table = read_table(file, layout)
    with np.errstate(over="ignore"):  # what is beyond all numbers is refused with its line
        values = base(table.figures)
    try:
        found = whole_cycles(table.angles, values, lambda row: Fault(("file",), table.line(row)), kind, against)
    except RuleError as error:
        (fault,) = error.faults
        if layout.recorded_speed is None or "angle_unit" in fault.message:
            raise
        message = f"{fault.message}; are 'recorded_speed' and 'angle_unit' (s or ms) right?"
        raise RuleError(fault._replace(message=message)) from None
    return found._replace(headed=table.headed)


def whole_cycles(
    angles: Array, values: Array, place: Callable[[int], Fault], kind: str = "pressure", against: bool = False
) -> Samples:
    """Return samples closed to whole cycles; raises RuleError for what cannot be.

    angles (n,) in degrees; values (k, n) in the base of their kind, a row for each measured column; place: names a row;
    against: angles count against the rotation.
    """
    recording = Recording(angles, values, np.arange(len(angles)), place)
    if against:
        steps = np.diff(angles)
        # where most rise they are in the order of the angle, not of time
        in_time = recording.taken(slice(None, None, -1)) if (steps > 0).sum() > (steps < 0).sum() else recording
        recording = in_time._replace(angles=-in_time.angles)
    _refuse_no_numbers(recording, kind)
    recording, turned = _in_order(recording)
    recording, left_out = _laid_over_one_lap(recording)
    recording, twice = _without_twins(recording)
    samples = _closed(recording)
    return samples._replace(notes=(*turned, *left_out, *twice, *samples.notes))


# one recording, as it was written


def _refuse_no_numbers(recording: Recording, kind: str) -> None:
    for what, given in (("angle", recording.angles[np.newaxis]), (kind, recording.values)):
        bad = np.flatnonzero(~np.isfinite(given).all(axis=0))
        if len(bad):
            first = int(bad[0])
            wrong = next(one for one in given[:, first].tolist() if not math.isfinite(one))
            more = f" ({len(bad)} such samples)" if len(bad) > 1 else ""
            recording.refuse(first, f"the {what} is {wrong}, not a number{more}; leave such rows out")
        row, top = divmod(int(np.abs(given).argmax()), given.shape[1])
        beyond = out_of_size(abs(float(given[row, top])), what)
        if "large" in beyond:
            recording.refuse(top, f"the {what} {given[row, top]:g} {beyond}")


def _in_order(recording: Recording) -> tuple[Recording, list[str]]:
    """Return a recording of one cycle that begins within it from its smallest angle on, others as they are, and notes.

    Raises RuleError where the angle goes back by less than half a turn: there no turn ends.
    """
    notes: list[str] = []
    angles = recording.angles
    steps = np.diff(angles)
    falls = np.flatnonzero(steps < 0)
    if len(falls) == 1 and 180 < -steps[falls[0]] <= PERIODS[-1] and angles[-1] <= angles[0]:
        first = int(falls[0]) + 1
        notes = [f"the angle begins anew at {angles[first]:.10g} deg; the samples from there on come first"]
        recording = recording.taken(np.roll(np.arange(len(angles)), -first))
        angles = recording.angles
        steps = np.diff(angles)
    back = np.flatnonzero((steps < 0) & (steps >= -180))
    if len(back):
        i = int(back[0]) + 1
        message = f"{angles[i]:.10g} deg after {angles[i - 1]:.10g} deg; put the points in order of the angle"
        if len(back) > 1 and len(back) >= 0.9 * len(steps) and len(back) == len(falls):
            message = (
                f"the angle falls from {angles[0]:.10g} to {angles[-1]:.10g} deg: the rows run backward; put them in "
                "order of the angle, or write 'angle_sense: against' if the encoder counts against the rotation"
            )
        recording.refuse(i, message)
    if len(angles) < 2 or (angles[0] == angles[-1] and not (steps < 0).any()):
        recording.refuse(0, "a trace needs samples at two angles or more")
    return recording, notes


# many laps, one below the other

_SAME_ANGLE = 1e-3
"""Share of a step by which equal angles of two laps may differ through rounding."""
_LEAST_ALIKE = 0.2
"""Correlation of laps below which they are not repetitions, even if a wrong speed shifts them."""
_REST = 0.05
"""Share of a lap above which a note reports that the incomplete last lap is left out."""


def _laid_over_one_lap(recording: Recording) -> tuple[Recording, list[str]]:
    """Return all laps over the angles of the first, or a recording of one lap as it is, and notes.

    Between samples at other angles than those of the first lap they are straight. What follows the last whole lap is
    left out. Raises RuleError for laps with holes, and for an angle that counts on over laps that are not alike, each
    and the next but one: it may count samples.
    """
    begins_anew = bool((np.diff(recording.angles) < 0).any())
    if not begins_anew and period_of(float(np.ptp(recording.angles))):
        return recording, []
    recording, lap = _counting_on(recording) if begins_anew else (recording, PERIODS[0])
    angles, values = recording.angles, recording.values
    step = usual_step(angles)
    laps = int((angles[-1] - angles[0] + 1.5 * min(step, lap / 20)) // lap)
    bounds = np.searchsorted(angles, angles[0] + lap * np.arange(laps + 1) - min(1e-6 * lap, step / 2))
    if laps < 2 or (np.diff(bounds) < 2).any():
        return recording, []
    _refuse_large_holes(recording)

    count = int(bounds[1])
    first = recording.taken(slice(count))
    wanted = first.angles + lap * np.arange(laps)[:, np.newaxis]
    even = (np.diff(bounds) == count).all()
    if even and np.abs(angles[: bounds[-1]].reshape(laps, count) - wanted).max() <= _SAME_ANGLE * lap / count:
        each = values[:, : bounds[-1]].reshape(-1, count)
    else:
        each = np.concatenate([np.interp(wanted, angles, column) for column in values])
    swing = each - each.mean()
    whole = float((swing**2).mean())
    if not begins_anew and len(each) > 2 and whole and float((swing[2:] * swing[:-2]).mean()) < _LEAST_ALIKE * whole:
        cycle = PERIODS[-1]
        message = (
            f"the angle counts on over {len(each)} turns that are not alike; if it numbers samples, write how "
            f"far apart they are, such as 'angle_step: {cycle / len(angles):.4g} deg' for one cycle of {cycle:g} deg"
        )
        first.refuse(0, message)
    left = len(angles) - int(bounds[-1])
    notes = [f"the {left} samples after lap {laps} of {lap:g} deg are left out"] if left > _REST * count else []
    return first._replace(values=each), notes


def _counting_on(recording: Recording) -> tuple[Recording, float]:
    """Return a recording whose angle begins anew with angles that count on, and after how many degrees it does.

    A closing sample gives way to the first of the next lap. Raises RuleError for more than two turns.
    """
    span, steps = float(np.ptp(recording.angles)), np.diff(recording.angles)
    lap = period_of(span)
    if not lap:
        back = int(np.flatnonzero(steps < 0)[0])
        message = (
            f"the angle begins anew after {span:.10g} deg; a turn has 360, a four-stroke cycle 720 deg: other units?"
            f"{' Or is the first row a heading? Then skip it' if back == 0 else ''}"
        )
        recording.refuse(back + 1, message)
    counted = recording.angles + lap * np.concatenate(([0], np.cumsum(steps < 0)))
    closing = np.append((steps < 0) & (np.diff(counted) <= 1e-9 * lap), False)
    return recording._replace(angles=counted).taken(~closing), lap


# one lap: twins, holes, and the closing sample

_ROUNDED = 0.25
"""Share of samples at the angle of the one before from which on the angles are rounded: of those none is left out."""
_LARGE_HOLES = ((20.0, 10.0), (45.0, 3.0))
"""(degrees, times the median step): a gap beyond both is not bridged by a straight line."""
_WIDE = 3.0
"""Times the usual step: a wider one is reported as missing samples."""
_HOLE = "no samples from {:.10g} to {:.10g} deg; a trace covers a whole cycle of 360 or 720 deg"


def _without_twins(recording: Recording) -> tuple[Recording, list[str]]:
    """Return the recording without duplicate samples, and notes; raises RuleError for three at one angle."""
    angles = recording.angles
    thrice = np.flatnonzero(angles[2:] == angles[:-2])
    if len(thrice):
        i = int(thrice[0]) + 2
        finer = f"; write 'angle_step' if the angles are only rounded ({len(thrice) + 1} such samples)"
        recording.refuse(i, f"three points at {angles[i]:.10g} deg; a jump has two{finer if len(thrice) > 1 else ''}")
    twins = np.diff(angles) == 0
    same = twins & (np.diff(recording.values) == 0).all(axis=0)
    if np.count_nonzero(twins) >= _ROUNDED * len(angles) > 2 or not same.any():
        return recording, []
    return recording.taken(np.append(True, ~same)), [f"{int(same.sum())} samples given twice count once"]


def _closed(recording: Recording) -> Samples:
    """Close the cycle with the first sample if only the last one is missing; raises RuleError for large gaps."""
    angles, values, *_ = recording
    span = float(np.ptp(angles))
    period = period_of(span)
    if not period:
        recording.refuse(-1, f"the samples run over {span:g} deg; cut whole cycles out")
    if len(angles) > MOST_POINTS:
        recording.refuse(MOST_POINTS, f"one cycle has more than {MOST_POINTS} samples; thin them out{LIMITS}")
    end = float(angles[0]) + period
    missing = end - float(angles[-1])
    if missing > 1.5 * usual_step(angles):
        other = "; are these times? Then write 'angle_unit: s' and 'recorded_speed: 1500 rpm', say" if span < 10 else ""
        if min(abs(span - 2 * math.pi), abs(span / 2 - 2 * math.pi)) < 0.2:
            other = "; are these radians? Then write 'angle_unit: rad'"
        recording.refuse(-1, _HOLE.format(angles[-1], end) + other)
    completed = missing > 1e-9 * period
    if completed:
        values = np.append(values, values[:, :1], axis=1)
    angles = np.append(angles if completed else angles[:-1], end)
    _refuse_large_holes(recording._replace(angles=angles))
    wide = np.flatnonzero(np.diff(angles) > _WIDE * usual_step(angles))[:5].tolist()
    notes = (f"no samples from {angles[i]:.10g} to {angles[i + 1]:.10g} deg; a straight line joins them" for i in wide)
    return Samples(angles, values, tuple(notes), completed)


def _refuse_large_holes(recording: Recording) -> None:
    """Raise RuleError where a stretch without samples is wide, in degrees and in median steps."""
    angles = recording.angles
    steps = np.diff(angles)
    given = np.sort(steps[steps > 0])
    median = float(given[len(given) // 2])
    wide = np.flatnonzero(steps > min(max(degrees, times * median) for degrees, times in _LARGE_HOLES))
    if len(wide):
        i = int(wide[0])
        recording.refuse(i, _HOLE.format(angles[i], angles[i + 1]))


def usual_step(angles: Array) -> float:
    """Return the step in degrees such that no wider ones cover half of the angle: a denser stretch is no rule."""
    steps = np.sort(np.diff(angles))
    passed = np.cumsum(steps)
    return float(steps[np.searchsorted(passed, passed[-1] / 2)])
