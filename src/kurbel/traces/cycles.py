"""From samples of one or many cycles, as a logger wrote them, to laps of whole cycles over the same angles.

A lap is the range after which the angle restarts: a turn, or a four-stroke cycle. If the angle increases without
restart, a lap is one turn, and two make a four-stroke cycle; a known effort may run over more turns, which are then one
cycle. Incomplete cycles are rejected, with the row.
"""

import math
from collections.abc import Callable
from typing import NamedTuple, NoReturn

import numpy as np

from kurbel.arrays import Array, Flags, Indices
from kurbel.declared.forms.values import out_of_size
from kurbel.declared.units import MOST_POINTS
from kurbel.errors import Fault, NotANumber, RuleError
from kurbel.traces.correct import period_of
from kurbel.traces.period import Clock, Period, period_of_pressure
from kurbel.traces.read import LIMITS, MOST_NUMBERS, Layout, read_table


class Laps(NamedTuple):
    """Laps of a trace in order: of one cycle each, or of one turn each if only the machine file decides the cycle.

    angles (n,) in degrees, rising over a period; values (m, n) of m laps; notes: what was corrected; completed: the
    closing sample is a copy of the first, as the file has none; clock: how times became angles.
    """

    angles: Array
    values: Array
    notes: tuple[str, ...] = ()
    completed: bool = False
    clock: Clock | None = None


class Recording:
    """Samples in the order of time, which one step after another puts in order and closes to laps.

    angles (n,) in degrees; values (k, n); rows (n,): of which row each is; notes: what was changed. place: of a row, as
    a fault that lacks a message; most_turns: of the shaft in one cycle; is_drawn: a stretch between equal values is a
    line of the diagram and not a hole; way: of the piston in strokes at angles, where the file has that instead of
    angles; step: degrees from row to row of a lap, where laps have angles of their own.
    """

    def __init__(
        self,
        angles: Array,
        values: Array,
        place: Callable[[int], Fault],
        most_turns: int = 2,
        is_drawn: bool = False,
        way: Callable[[Array], Array] | None = None,
    ) -> None:
        self.angles = angles
        self.values = values
        self.rows = np.arange(len(angles))
        self.most_turns = most_turns
        self.is_drawn = is_drawn
        self.way = way
        self.step = 0.0
        self.notes: list[str] = []
        self._location_of_row = place

    def keep(self, which: slice | Indices) -> None:
        """Keep only these samples, in the order of their indices."""
        self.angles = self.angles[which]
        self.values = self.values[:, which]
        self.rows = self.rows[which]

    @property
    def span(self) -> float:
        """Degrees from its smallest to its largest angle."""
        return float(np.ptp(self.angles))

    @property
    def period(self) -> float:
        """Degrees of the shortest cycle that its angles fit into, 0 where they run over more turns than one has."""
        return period_of(self.span, self.most_turns)

    def refuse_hole(self, index: int, low: float, high: float, advice: str = "") -> NoReturn:
        """Raise RuleError for a stretch without samples, which begins at this one."""
        rule = "a trace covers a whole cycle of 360 or 720 deg"
        if self.most_turns > 2:
            rule = "a diagram covers whole turns of 360 deg"
        self.refuse(index, f"no samples from {low:.10g} to {high:.10g} deg; {rule}{advice}")

    def refuse(self, index: int, message: str, fault: type[Fault] = Fault) -> NoReturn:
        """Raise RuleError with what is wrong with a sample."""
        location = self._location_of_row(int(self.rows[index]))
        if location.message:
            message = f"{location.message}: {message}"
        raise RuleError(fault(location.path, message))


def samples_of_file(
    file: str,
    layout: Layout,
    kind: str,
    base: Callable[[Array], Array],
    against: bool = False,
    most_turns: int = 2,
) -> Laps:
    """Return the laps of what was measured from a file; raises RuleError.

    kind: of the values, pressure or torque; base: turns figures of the file into the base of their unit; against:
    angles count against the rotation; most_turns: of the shaft in one cycle.
    """
    table = read_table(file, layout)
    with np.errstate(over="ignore"):  # what is beyond all numbers is refused with its line
        values = base(table.figures)

    def location_of_row(row: int) -> Fault:
        return Fault(("file",), table.line(row))

    angles = table.angles
    clock = None
    period = None
    if layout.is_timed:
        if kind == "pressure" and np.isfinite(values).all():
            period = period_of_pressure(angles, values[0])
        clock = _clock(period, layout.recorded_speed)
        speed = _cutting_speed(clock)
        angles = angles * (360.0 * speed)
    try:
        laps = whole_cycles(angles, values, location_of_row, kind, against, most_turns)
    except RuleError as error:
        # where angles come from times, a wrong speed or unit may be the cause
        (fault,) = error.faults
        if layout.recorded_speed is None or "angle_unit" in fault.message:
            raise
        message = f"{fault.message}; are 'recorded_speed' and 'angle_unit' (s or ms) right?"
        if period is not None:
            turning = 60 / period.seconds
            message += (
                f" Its pressure repeats after {period.seconds:.6g} s: "
                f"'recorded_speed: {turning:.6g} rpm' in two strokes, {2 * turning:.6g} rpm in four"
            )
        raise RuleError(fault._replace(message=message)) from None
    return laps._replace(clock=clock)


_MOST_OFF = 0.15
"""By which a recorded speed may miss that of the pressure and be meant all the same."""


def _clock(period: Period | None, recorded: float | None) -> Clock:
    """Return the clock of a recording whose pressure repeats after a period; raises RuleError without any speed.

    A period is one turn or two, of which the recorded speed in revolutions per second shows the number.
    """
    if recorded is None:
        if period is None:
            message = (
                "times become angles by a speed, and the pressure has no clear period; "
                "write 'recorded_speed: 1500 rpm', say"
            )
            raise RuleError(Fault(("angle_unit",), message))
        return Clock(1 / period.seconds, period.error, None)
    if period is None:
        return Clock(None, 0.0, recorded)
    turns = round(recorded * period.seconds)
    if turns not in (1, 2) or abs(recorded * period.seconds / turns - 1) > _MOST_OFF:
        return Clock(None, 0.0, recorded)
    return Clock(turns / period.seconds, period.error, recorded)


def _cutting_speed(clock: Clock) -> float:
    """Return the speed in revolutions per second that cuts whole cycles: as recorded, unless the pressure differs."""
    if clock.recorded is not None and not clock.is_off:
        return clock.recorded
    return clock.speed or clock.recorded or 0.0


def whole_cycles(
    angles: Array,
    values: Array,
    place: Callable[[int], Fault],
    kind: str = "pressure",
    against: bool = False,
    most_turns: int = 2,
    way: Callable[[Array], Array] | None = None,
) -> Laps:
    """Return samples closed to whole cycles; raises RuleError for what cannot be.

    angles (n,) in degrees; values (k, n) in the base of their kind, a row for each measured column; place: names a row;
    against: angles count against the rotation; most_turns: of the shaft in one cycle; way: of the piston in strokes at
    angles, where these were computed from it.
    """
    is_drawn = kind == "torque"
    in_time = -angles if against else angles
    recording = Recording(in_time, values, place, most_turns, is_drawn, way)
    _refuse_no_numbers(recording, kind)
    if kind == "pressure":
        _refuse_no_samples(recording)
    steps = np.diff(recording.angles)
    falls_mostly = (steps < 0).sum() > (steps > 0).sum()
    if against and falls_mostly:  # in the order of the angle, not of time
        recording.keep(slice(None, None, -1))
    _put_in_order(recording)
    _lay_over_one_lap(recording)
    _leave_out_twins(recording)
    return _closed(recording)


# one recording, as it was written


def _refuse_no_numbers(recording: Recording, kind: str) -> None:
    """Raise RuleError for an angle or a value that is no number, or too large for one."""
    for what, rows in (("angle", recording.angles[np.newaxis]), (kind, recording.values)):
        sizes = np.abs(rows).max(axis=0)
        largest = int(np.argmax(sizes))  # nan counts as the largest
        size = float(sizes[largest])
        if not math.isfinite(size):
            fault = NotANumber if math.isnan(size) else Fault
            message = f"the {what} is {size}, not a number; leave such rows out"
            recording.refuse(largest, message, fault)
        beyond = out_of_size(size, what)
        if "large" in beyond:
            recording.refuse(largest, f"the {what} {size:g} {beyond}")


_RARE = 0.01
"""Share of the samples of a column up to which one value is no sample, but what a logger writes instead."""
_FAR = 5.0
"""Ranges of all other samples by which such a value lies beyond them."""
_ENOUGH = 20
"""Samples in a column, at least."""


def _refuse_no_samples(recording: Recording) -> None:
    """Raise RuleError for a pressure far beyond all others, such as the 9999 of a lost sample."""
    if recording.values.shape[1] < _ENOUGH:
        return
    for column in recording.values:
        for extreme in (float(column.max()), float(column.min())):
            is_extreme = column == extreme
            others = column[~is_extreme]
            if not others.size or np.count_nonzero(is_extreme) > _RARE * len(column) + 1:
                continue
            low = float(others.min())
            high = float(others.max())
            beyond = max(extreme - high, low - extreme)
            if beyond <= _FAR * (high - low) or high == low:
                continue
            message = (
                f"the pressure {extreme / 1e5:.5g} bar is no sample: all others lie from "
                f"{low / 1e5:.4g} to {high / 1e5:.4g} bar; leave such rows out"
            )
            recording.refuse(int(np.argmax(is_extreme)), message)


def _put_in_order(recording: Recording) -> None:
    """Let a recording of one cycle that begins within it begin at its smallest angle.

    Raises RuleError where the angle goes back by less than half a turn: there no turn ends.
    """
    _begin_at_smallest_angle(recording)
    angles = recording.angles
    steps = np.diff(angles)
    backward = np.flatnonzero((steps < 0) & (steps >= -180))
    runs_backward = len(backward) > 1 and len(backward) >= 0.9 * len(steps)
    if runs_backward:
        message = (
            f"the angle falls from {angles[0]:.10g} to {angles[-1]:.10g} deg: the rows run "
            "backward; put them in order of the angle, or write 'angle_sense: against' if the "
            "encoder counts against the rotation"
        )
        recording.refuse(int(backward[0]) + 1, message)
    if len(backward):
        i = int(backward[0]) + 1
        message = (
            f"{angles[i]:.10g} deg after {angles[i - 1]:.10g} deg; "
            "put the points in order of the angle"
        )
        recording.refuse(i, message)
    if not np.ptp(angles):
        recording.refuse(0, "a trace needs samples at two angles or more")


def _begin_at_smallest_angle(recording: Recording) -> None:
    """Put the samples after the only fall of the angle first, where it ends one cycle."""
    angles = recording.angles
    steps = np.diff(angles)
    falls = np.flatnonzero(steps < 0)
    if len(falls) != 1 or angles[-1] > angles[0]:
        return
    fall = -steps[falls[0]]
    if not 180 < fall <= 360.0 * recording.most_turns:
        return
    first = int(falls[0]) + 1
    recording.keep(np.roll(np.arange(len(recording.rows)), -first))
    recording.notes.append(
        f"the angle begins anew at {recording.angles[0]:.10g} deg; "
        "the samples from there on come first"
    )


# many laps, one below the other

_SAME_ANGLE = 1e-3
"""Share of a step by which equal angles of two laps may differ through rounding."""
_LEAST_ALIKE = 0.2
"""Correlation of laps below which they are not repetitions, even if a wrong speed shifts them."""
_MOST_UNLIKE = 0.25
"""Mean squared difference of two laps, over the variance, up to which they may be repetitions in spite of row numbers."""
_REST = 0.05
"""Share of a lap above which a note reports that the incomplete last lap is left out."""


def _lay_over_one_lap(recording: Recording) -> None:
    """Lay all laps over the same angles, if there are several; what follows the last whole lap is left out.

    Laps at equal angles keep these. Others are laid over the angles of all of them, straight between their own samples,
    so that each keeps its area and its corners. Raises RuleError for laps with holes, and for an angle that counts on
    over laps that are not alike, each and the next but one: it may count samples.
    """
    begins_anew = bool((np.diff(recording.angles) < 0).any())
    if not begins_anew and recording.period:
        return
    lap = _count_on(recording) if begins_anew else 360.0

    # where the whole laps begin and the last one ends
    angles = recording.angles
    step = usual_step(np.diff(angles))
    span = angles[-1] - angles[0]
    laps = int((span + 1.5 * min(step, lap / 20)) // lap)
    next_end = angles[0] + lap * (laps + 1)
    if _hardly_moves(recording, np.array([angles[-1], next_end]))[0]:
        laps += 1
    starts = angles[0] + lap * np.arange(laps + 1)
    bounds = np.searchsorted(angles, starts - min(1e-6 * lap, step / 2))
    counts = np.diff(bounds)
    if laps < 2 or (counts < 2).any():
        return
    _refuse_large_holes(recording, angles)

    laid = laid_over_one(angles, recording.values, bounds, lap)
    if not laid.has_equal_angles:
        recording.step = step
    end = int(bounds[-1])
    if not begins_anew:
        _refuse_unlike_laps(recording, laid.values, recording.values[0, end : end + int(counts[0])])
    if len(angles) - end > _REST * counts[0]:
        recording.notes.append(
            f"the {len(angles) - end} samples after lap {laps} of {lap:g} deg are left out"
        )
    recording.keep(laid.samples)
    recording.angles = laid.angles
    recording.values = laid.values


class LaidOver(NamedTuple):
    """Laps over the same angles (n,) in degrees: values (m, n), and of which sample each angle is."""

    angles: Array
    values: Array
    samples: Indices
    has_equal_angles: bool


def laid_over_one(angles: Array, columns: Array, bounds: Indices, lap: float) -> LaidOver:
    """Return the laps of columns (k, n) one below the other; those at equal angles keep these.

    angles (n,): rising over all laps of so many degrees; bounds (m + 1,): index of the first sample of each lap, and
    of the first one after the last lap.
    """
    laps = len(bounds) - 1
    count = int(bounds[1])
    end = int(bounds[-1])
    offsets = lap * np.arange(laps)[:, np.newaxis]
    if (np.diff(bounds) == count).all():
        first = angles[:count]
        differences = angles[:end].reshape(laps, count) - first - offsets
        if np.abs(differences).max() <= _SAME_ANGLE * lap / count:
            values = columns[:, :end].reshape(-1, count)
            return LaidOver(first, values, np.arange(count), True)

    # others get the angles of all laps
    shared, samples = _angles_of_all(angles[:end], bounds, lap)
    of_columns = [np.interp(shared + offsets, angles, column) for column in columns]
    return LaidOver(shared, np.concatenate(of_columns), samples, False)


def joined(laps: Laps, parts: int) -> Laps:
    """Return cycles of so many laps each, one after the other; laps after the last whole cycle are left out."""
    lap = laps.angles[-1] - laps.angles[0]
    count = len(laps.values) // parts
    open_angles = laps.angles[:-1]
    angles = np.add.outer(lap * np.arange(parts), open_angles).ravel()
    values = laps.values[: count * parts, :-1].reshape(count, -1)
    return laps._replace(
        angles=np.append(angles, open_angles[0] + parts * lap),
        values=np.append(values, values[:, :1], axis=1),
    )


def cut(laps: Laps, parts: int) -> Laps:
    """Return so many cycles, each of equal length, that one lap consists of; each at the angles of all."""
    (values,) = laps.values
    begin = laps.angles[0]
    cycle = float(laps.angles[-1] - begin) / parts
    step = usual_step(np.diff(laps.angles))
    starts = begin + cycle * np.arange(parts + 1)
    bounds = np.searchsorted(laps.angles, starts - min(1e-6 * cycle, step / 2))
    laid = laid_over_one(laps.angles, values[np.newaxis], bounds, cycle)
    return laps._replace(
        angles=np.append(laid.angles, laid.angles[0] + cycle),
        values=np.append(laid.values, laid.values[:, :1], axis=1),
    )


def _refuse_unlike_laps(recording: Recording, values: Array, rest: Array) -> None:
    """Raise RuleError where an angle counts on over laps (m, n) that are not alike, each and the next but one.

    rest (r,): samples after them, which of two laps go on as the first, where the angles may number rows.
    """
    swing = values - values.mean()
    variance = (swing**2).mean()
    if len(values) > 2:
        is_alike = not (swing[2:] * swing[:-2]).mean() < _LEAST_ALIKE * variance
    elif len(rest) > _REST * values.shape[1] and _number_rows(recording.angles):
        is_alike = ((rest - values[0, : len(rest)]) ** 2).mean() < _MOST_UNLIKE * variance
    else:
        return
    if is_alike:
        return
    message = (
        f"the angle counts on over {len(values)} turns that are not alike; if it numbers samples, "
        f"write how far apart they are, such as 'angle_step: {720 / len(recording.angles):.4g} deg' "
        "for one cycle of 720 deg"
    )
    recording.refuse(0, message)


def _angles_of_all(angles: Array, bounds: Indices, lap: float) -> tuple[Array, Indices]:
    """Return the angles (n,) in degrees of the samples of all laps, as if in the first, and of which sample each is.

    angles (k,): rising over all laps; bounds (m + 1,): index of the first sample of each lap. Equal angles are there
    once. Of too many every second is left out, or more.
    """
    laps = len(bounds) - 1
    offsets = np.repeat(lap * np.arange(laps), np.diff(bounds))
    # the first sample of a lap may be early by rounding
    in_lap = np.maximum(angles - offsets, angles[0])
    smallest_step = _SAME_ANGLE * lap / int(np.diff(bounds).max())
    _, firsts = np.unique(np.rint((in_lap - angles[0]) / smallest_step), return_index=True)
    most = max(int(bounds[1]), min(MOST_POINTS, MOST_NUMBERS // laps))
    chosen = firsts[:: math.ceil(len(firsts) / most)]
    return in_lap[chosen], chosen


def _count_on(recording: Recording) -> float:
    """Let an angle that begins anew count on, and return after how many degrees it begins anew.

    A closing sample gives way to the first of the next lap. Raises RuleError for more than two turns.
    """
    is_fall = np.diff(recording.angles) < 0
    lap = recording.period
    if not lap:
        message = (
            f"the angle begins anew after {recording.span:.10g} deg; "
            "a turn has 360, a four-stroke cycle 720 deg: other units?"
        )
        recording.refuse(int(np.argmax(is_fall)) + 1, message)
    recording.angles = recording.angles + lap * np.append(0, np.cumsum(is_fall))
    is_closing = is_fall & (np.diff(recording.angles) <= 1e-9 * lap)
    recording.keep(np.append(~is_closing, True))
    return lap


# one lap: twins, holes, and the closing sample

_ROUNDED = 0.25
"""Share of samples at the angle of the one before from which on the angles are rounded: of those none is left out."""
_LARGE_HOLES = ((20.0, 10.0), (45.0, 3.0))
"""(degrees, times the median step): a gap beyond both is not bridged by a straight line."""
_HARDLY = 0.02
"""Strokes over which rows are not missed, whatever angle they take."""
_WIDE = 3.0
"""Times the usual step: a wider one is reported as missing samples."""


def _leave_out_twins(recording: Recording) -> None:
    """Leave out duplicate samples; raises RuleError for three at one angle."""
    angles = recording.angles
    triples = np.flatnonzero(angles[2:] == angles[:-2])
    if len(triples):
        advice = "; write 'angle_step' if the angles are only rounded" if len(triples) > 1 else ""
        i = int(triples[0]) + 2
        recording.refuse(i, f"three points at {angles[i]:.10g} deg; a jump has two{advice}")

    # of two samples with the same angle and values the second; rounded angles keep theirs
    is_twin = np.diff(angles) == 0
    is_duplicate = is_twin & (np.diff(recording.values) == 0).all(axis=0)
    are_rounded = np.count_nonzero(is_twin) >= _ROUNDED * len(angles) > 2
    if are_rounded or not is_duplicate.any():
        return
    recording.keep(np.append(True, ~is_duplicate))
    count = np.count_nonzero(is_duplicate)
    note = "1 sample given twice counts once"
    if count > 1:
        note = f"{count} samples given twice count once"
    recording.notes.append(note)


def _closed(recording: Recording) -> Laps:
    """Close the cycle with the first sample if only the last one is missing; raises RuleError for large gaps."""
    angles = recording.angles
    values = recording.values
    span = recording.span
    period = recording.period
    if not period:
        recording.refuse(-1, f"the samples run over {span:g} deg; cut whole cycles out")
    if len(angles) > MOST_POINTS:
        message = f"one cycle has more than {MOST_POINTS} samples; thin them out{LIMITS}"
        recording.refuse(MOST_POINTS, message)

    # more is missing than the closing sample
    end = float(angles[0]) + period
    missing = end - float(angles[-1])
    is_line = _level_lines(recording, np.diff(angles))
    step = max(usual_step(np.diff(angles)[~is_line]), recording.step)
    is_open = missing > 1.5 * step and not _hardly_moves(recording, np.array([angles[-1], end]))[0]
    if is_open:
        recording.refuse_hole(-1, angles[-1], end, _unit_advice(angles))

    completed = missing > 1e-9 * period
    if completed:
        values = np.append(values, values[:, :1], axis=1)
    angles = np.append(angles if completed else angles[:-1], end)
    _refuse_large_holes(recording, angles)

    # smaller holes are reported
    notes = list(recording.notes)
    is_wide = (np.diff(angles) > _WIDE * step) & ~_hardly_moves(recording, angles)
    wide = np.flatnonzero(is_wide)
    for i in wide[:5].tolist():
        notes.append(
            f"no samples from {angles[i]:.10g} to {angles[i + 1]:.10g} deg; "
            "a straight line joins them"
        )
    return Laps(angles, values, tuple(notes), completed)


def _unit_advice(angles: Array) -> str:
    """Return which unit angles (n,) may really have, or what they may number, or ''."""
    span = float(np.ptp(angles))
    radians_missed = min(abs(span - 2 * math.pi), abs(span / 2 - 2 * math.pi))
    if radians_missed < 0.2:
        return "; are these radians? Then write 'angle_unit: rad'"
    if span < 10:
        return "; are these times? Then write 'angle_unit: s' and 'recorded_speed: 1500 rpm', say"
    if _number_rows(angles):
        return (
            "; do these number the samples? Then write how far apart they are, such as "
            f"'angle_step: {720 / len(angles):.4g} deg' for one cycle of 720 deg"
        )
    return ""


def _number_rows(angles: Array) -> bool:
    """Return whether angles (n,) are whole numbers one after the other, as those of rows."""
    return bool((np.diff(angles) == 1).all())


def _refuse_large_holes(recording: Recording, angles: Array) -> None:
    """Raise RuleError where a stretch without samples is wide, in degrees and in median steps."""
    steps = np.diff(angles)
    is_line = _level_lines(recording, steps)
    large = np.flatnonzero(_is_large(steps) & ~is_line & ~_hardly_moves(recording, angles))
    if len(large):
        i = int(large[0])
        recording.refuse_hole(i, angles[i], angles[i + 1])


def _is_large(steps: Array) -> Flags:
    """Return which of steps (n,) in degrees are too wide for a straight line between samples."""
    rising = np.sort(steps[steps > 0])
    median = float(rising[len(rising) // 2])
    limit = min(max(degrees, times * median) for degrees, times in _LARGE_HOLES)
    return steps > limit


def _hardly_moves(recording: Recording, angles: Array) -> Flags:
    """Return between which of angles (n,), computed from the way of the piston, it goes hardly any way.

    At a dead centre the rounding of a volume is degrees wide.
    """
    if recording.way is None:
        return np.zeros(len(angles) - 1, dtype=bool)
    return np.asarray(np.diff(recording.way(angles)) <= _HARDLY, dtype=bool)


def _level_lines(recording: Recording, steps: Array) -> Flags:
    """Return which of steps (n,) in degrees are wide, and a level line that a diagram has instead of many samples."""
    if not recording.is_drawn:
        return np.zeros(len(steps), dtype=bool)
    is_level = (np.diff(recording.values) == 0).all(axis=0)
    is_level = np.append(is_level, np.zeros(len(steps) - len(is_level), dtype=bool))
    return _is_large(steps) & is_level


def usual_step(steps: Array) -> float:
    """Return the step of those (n,) in degrees such that no wider ones cover half of the angle.

    A denser stretch is no rule.
    """
    steps = np.sort(steps)
    passed = np.cumsum(steps)
    return float(steps[np.searchsorted(passed, passed[-1] / 2)])
