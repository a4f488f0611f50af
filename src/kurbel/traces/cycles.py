"""From samples of one or many cycles, as a logger wrote them, to laps of whole cycles over the same angles.

A lap is the range after which the angle restarts: a turn, or a four-stroke cycle. If the angle increases without
restart, a lap is one turn, and two make a four-stroke cycle; a known effort may run over more turns, which are then one
cycle. Incomplete cycles are rejected, with the row.
"""

import math
from collections.abc import Callable
from typing import NamedTuple, NoReturn

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.declared.forms.values import out_of_size
from kurbel.declared.units import MOST_POINTS
from kurbel.errors import Fault, NotANumber, RuleError
from kurbel.traces.correct import period_of
from kurbel.traces.read import LIMITS, MOST_NUMBERS, Layout, read_table


class Laps(NamedTuple):
    """Laps of a trace in order: of one cycle each, or of one turn each if only the machine file decides the cycle.

    angles (n,) in degrees, rising over a period; values (m, n) of m laps; notes: what was corrected; completed: the
    closing sample is a copy of the first, as the file has none.
    """

    angles: Array
    values: Array
    notes: tuple[str, ...] = ()
    completed: bool = False


class Recording:
    """Samples in the order of time, which one step after another puts in order and closes to laps.

    angles (n,) in degrees; values (k, n); rows (n,): of which row each is; notes: what was changed. place: of a row, as
    a fault that lacks a message; most_turns: of the shaft in one cycle.
    """

    def __init__(
        self, angles: Array, values: Array, place: Callable[[int], Fault], most_turns: int = 2
    ) -> None:
        self.angles, self.values, self.rows = angles, values, np.arange(len(angles))
        self.most_turns = most_turns
        self._place = place
        self.notes: list[str] = []

    def keep(self, which: slice | Indices) -> None:
        """Keep only these samples, in the order of their indices."""
        self.angles, self.values, self.rows = (
            self.angles[which],
            self.values[:, which],
            self.rows[which],
        )

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
        several = self.most_turns > 2
        whole = (
            "a diagram covers whole turns of 360 deg"
            if several
            else "a trace covers a whole cycle of 360 or 720 deg"
        )
        self.refuse(index, f"no samples from {low:.10g} to {high:.10g} deg; {whole}{advice}")

    def refuse(self, index: int, message: str, fault: type[Fault] = Fault) -> NoReturn:
        """Raise RuleError with what is wrong with a sample."""
        place = self._place(int(self.rows[index]))
        raise RuleError(
            fault(place.path, f"{place.message}: {message}" if place.message else message)
        )


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
    angles, figures, line = read_table(file, layout)
    with np.errstate(over="ignore"):  # what is beyond all numbers is refused with its line
        values = base(figures)
    try:
        return whole_cycles(
            angles, values, lambda row: Fault(("file",), line(row)), kind, against, most_turns
        )
    except RuleError as error:
        (fault,) = error.faults
        if layout.recorded_speed is None or "angle_unit" in fault.message:
            raise
        message = f"{fault.message}; are 'recorded_speed' and 'angle_unit' (s or ms) right?"
        raise RuleError(fault._replace(message=message)) from None


def whole_cycles(
    angles: Array,
    values: Array,
    place: Callable[[int], Fault],
    kind: str = "pressure",
    against: bool = False,
    most_turns: int = 2,
) -> Laps:
    """Return samples closed to whole cycles; raises RuleError for what cannot be.

    angles (n,) in degrees; values (k, n) in the base of their kind, a row for each measured column; place: names a row;
    against: angles count against the rotation; most_turns: of the shaft in one cycle.
    """
    recording = Recording(-angles if against else angles, values, place, most_turns)
    _refuse_no_numbers(recording, kind)
    steps = np.diff(recording.angles)
    if against and (steps < 0).sum() > (steps > 0).sum():  # in the order of the angle, not of time
        recording.keep(slice(None, None, -1))
    _put_in_order(recording)
    _lay_over_one_lap(recording)
    _leave_out_twins(recording)
    return _closed(recording)


# one recording, as it was written


def _refuse_no_numbers(recording: Recording, kind: str) -> None:
    for what, given in (("angle", recording.angles[np.newaxis]), (kind, recording.values)):
        sizes = np.abs(given).max(axis=0)
        largest = int(np.argmax(sizes))  # nan counts as the largest
        size = float(sizes[largest])
        if not math.isfinite(size):
            fault = NotANumber if math.isnan(size) else Fault
            recording.refuse(
                largest, f"the {what} is {size}, not a number; leave such rows out", fault
            )
        if "large" in (beyond := out_of_size(size, what)):
            recording.refuse(largest, f"the {what} {size:g} {beyond}")


def _put_in_order(recording: Recording) -> None:
    """Let a recording of one cycle that begins within it begin at its smallest angle.

    Raises RuleError where the angle goes back by less than half a turn: there no turn ends.
    """
    steps = np.diff(recording.angles)
    falls = np.flatnonzero(steps < 0)
    most = 360.0 * recording.most_turns
    if (
        len(falls) == 1
        and 180 < -steps[falls[0]] <= most
        and recording.angles[-1] <= recording.angles[0]
    ):
        first = int(falls[0]) + 1
        recording.keep(np.roll(np.arange(len(recording.rows)), -first))
        recording.notes.append(
            f"the angle begins anew at {recording.angles[0]:.10g} deg; the samples from there on come first"
        )
        steps = np.diff(recording.angles)
    angles, back = recording.angles, np.flatnonzero((steps < 0) & (steps >= -180))
    if len(back) > 1 and len(back) >= 0.9 * len(steps):
        message = (
            f"the angle falls from {angles[0]:.10g} to {angles[-1]:.10g} deg: the rows run backward; put them in "
            "order of the angle, or write 'angle_sense: against' if the encoder counts against the rotation"
        )
        recording.refuse(int(back[0]) + 1, message)
    if len(back):
        i = int(back[0]) + 1
        recording.refuse(
            i,
            f"{angles[i]:.10g} deg after {angles[i - 1]:.10g} deg; put the points in order of the angle",
        )
    if not np.ptp(angles):
        recording.refuse(0, "a trace needs samples at two angles or more")


# many laps, one below the other

_SAME_ANGLE = 1e-3
"""Share of a step by which equal angles of two laps may differ through rounding."""
_LEAST_ALIKE = 0.2
"""Correlation of laps below which they are not repetitions, even if a wrong speed shifts them."""
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
    angles, step = recording.angles, usual_step(recording.angles)
    laps = int((angles[-1] - angles[0] + 1.5 * min(step, lap / 20)) // lap)
    bounds = np.searchsorted(
        angles, angles[0] + lap * np.arange(laps + 1) - min(1e-6 * lap, step / 2)
    )
    if laps < 2 or (np.diff(bounds) < 2).any():
        return
    _refuse_large_holes(recording, angles)

    count, end = int(bounds[1]), int(bounds[-1])
    offsets = lap * np.arange(laps)[:, np.newaxis]
    from_samples: Indices = np.arange(count)
    shared: Array = angles[:count]
    even = (np.diff(bounds) == count).all()
    if (
        even
        and np.abs(angles[:end].reshape(laps, count) - shared - offsets).max()
        <= _SAME_ANGLE * lap / count
    ):
        each = recording.values[:, :end].reshape(-1, count)
    else:
        shared, from_samples = _angles_of_all(angles[:end], bounds, lap)
        each = np.concatenate(
            [np.interp(shared + offsets, angles, column) for column in recording.values]
        )
    swing = each - each.mean()
    if (
        not begins_anew
        and len(each) > 2
        and (swing[2:] * swing[:-2]).mean() < _LEAST_ALIKE * (swing**2).mean()
    ):
        message = (
            f"the angle counts on over {len(each)} turns that are not alike; if it numbers samples, write how far "
            f"apart they are, such as 'angle_step: {720 / len(angles):.4g} deg' for one cycle of 720 deg"
        )
        recording.refuse(0, message)
    if len(angles) - end > _REST * count:
        recording.notes.append(
            f"the {len(angles) - end} samples after lap {laps} of {lap:g} deg are left out"
        )
    recording.keep(from_samples)
    recording.angles = shared
    recording.values = each


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
    falls = np.diff(recording.angles) < 0
    lap = recording.period
    if not lap:
        turn = "a turn has 360, a four-stroke cycle 720 deg: other units?"
        recording.refuse(
            int(np.argmax(falls)) + 1,
            f"the angle begins anew after {recording.span:.10g} deg; {turn}",
        )
    recording.angles = recording.angles + lap * np.append(0, np.cumsum(falls))
    closing = falls & (np.diff(recording.angles) <= 1e-9 * lap)
    recording.keep(np.append(~closing, True))
    return lap


# one lap: twins, holes, and the closing sample

_ROUNDED = 0.25
"""Share of samples at the angle of the one before from which on the angles are rounded: of those none is left out."""
_LARGE_HOLES = ((20.0, 10.0), (45.0, 3.0))
"""(degrees, times the median step): a gap beyond both is not bridged by a straight line."""
_WIDE = 3.0
"""Times the usual step: a wider one is reported as missing samples."""


def _leave_out_twins(recording: Recording) -> None:
    """Leave out duplicate samples; raises RuleError for three at one angle."""
    angles = recording.angles
    thrice = np.flatnonzero(angles[2:] == angles[:-2])
    if len(thrice):
        rounded = "; write 'angle_step' if the angles are only rounded" if len(thrice) > 1 else ""
        i = int(thrice[0]) + 2
        recording.refuse(i, f"three points at {angles[i]:.10g} deg; a jump has two{rounded}")
    twins = np.diff(angles) == 0
    same = twins & (np.diff(recording.values) == 0).all(axis=0)
    if same.any() and not np.count_nonzero(twins) >= _ROUNDED * len(angles) > 2:
        recording.keep(np.append(True, ~same))
        count = np.count_nonzero(same)
        recording.notes.append(
            f"{count} samples given twice count once"
            if count > 1
            else "1 sample given twice counts once"
        )


def _closed(recording: Recording) -> Laps:
    """Close the cycle with the first sample if only the last one is missing; raises RuleError for large gaps."""
    angles, values = recording.angles, recording.values
    span = recording.span
    period = recording.period
    if not period:
        recording.refuse(-1, f"the samples run over {span:g} deg; cut whole cycles out")
    if len(angles) > MOST_POINTS:
        recording.refuse(
            MOST_POINTS, f"one cycle has more than {MOST_POINTS} samples; thin them out{LIMITS}"
        )
    end = float(angles[0]) + period
    missing = end - float(angles[-1])
    if missing > 1.5 * usual_step(angles):
        other = (
            "; are these times? Then write 'angle_unit: s' and 'recorded_speed: 1500 rpm', say"
            if span < 10
            else ""
        )
        if min(abs(span - 2 * math.pi), abs(span / 2 - 2 * math.pi)) < 0.2:
            other = "; are these radians? Then write 'angle_unit: rad'"
        recording.refuse_hole(-1, angles[-1], end, other)
    completed = missing > 1e-9 * period
    if completed:
        values = np.append(values, values[:, :1], axis=1)
    angles = np.append(angles if completed else angles[:-1], end)
    _refuse_large_holes(recording, angles)
    wide = np.flatnonzero(np.diff(angles) > _WIDE * usual_step(angles))[:5].tolist()
    holes = (
        f"no samples from {angles[i]:.10g} to {angles[i + 1]:.10g} deg; a straight line joins them"
        for i in wide
    )
    return Laps(angles, values, (*recording.notes, *holes), completed)


def _refuse_large_holes(recording: Recording, angles: Array) -> None:
    """Raise RuleError where a stretch without samples is wide, in degrees and in median steps."""
    steps = np.diff(angles)
    given = np.sort(steps[steps > 0])
    median = float(given[len(given) // 2])
    wide = np.flatnonzero(
        steps > min(max(degrees, times * median) for degrees, times in _LARGE_HOLES)
    )
    if len(wide):
        i = int(wide[0])
        recording.refuse_hole(i, angles[i], angles[i + 1])


def usual_step(angles: Array) -> float:
    """Return the step in degrees such that no wider ones cover half of the angle: a denser stretch is no rule."""
    steps = np.sort(np.diff(angles))
    passed = np.cumsum(steps)
    return float(steps[np.searchsorted(passed, passed[-1] / 2)])
