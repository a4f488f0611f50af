"""Traces over the volume of the chamber or the displacement of the piston, as p-V files have them, without any angle.

While a file is read its rows get the angles of a crank with an infinite rod, z = sin²(φ/2), by the order of the rows: a
growing volume is one stroke, a falling one the other. In its chamber the trace gets the angles at which its mechanism
has these fractions of the stroke.
"""

import itertools
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices
from kurbel.errors import Fault, NotANumber, RuleError, refused
from kurbel.mechanisms.setting import Setting
from kurbel.traces.correct import Strokes, Trace
from kurbel.traces.cycles import Laps, whole_cycles
from kurbel.traces.read import Layout, read_table

_LOW, _HIGH = 0.25, 0.75
"""Fractions of the stroke that must be passed before a dead centre counts: noise has none."""
_BACK = 0.02
"""Fraction of the stroke by which noise may take a volume back."""
_HOLE = 0.2
"""Fraction of the stroke without rows, at most."""
_LEAST_TURN = 300.0
"""Degrees that rows of one cycle cover at least."""


class StrokeRows(NamedTuple):
    """Rows (n,) in the order of time: angles in degrees that count on, and of which row of the file each is."""

    angles: Array
    rows: Indices


def strokes_of_file(
    file: str,
    layout: Layout,
    base: Callable[[Array], Array],
    kind: str,
    factor: float,
    against: bool,
) -> tuple[Laps, Strokes]:
    """Return the laps of pressures in a file over volumes, or over displacements, and these; raises RuleError.

    base: turns figures of the file into Pa; kind: volume or displacement, in the column of the angles of the layout;
    factor: m³ or m for 1 of the column; against: the rows run against the time.
    """
    table = read_table(file, layout)
    with np.errstate(over="ignore"):  # what is beyond all numbers is refused with its line
        pressures = base(table.figures)
    column = table.angles * factor

    def refuse_row(row: int, message: str, fault: type[Fault] = Fault) -> None:
        raise RuleError(fault(("file",), f"{table.line(int(row))}: {message}"))

    if not np.isfinite(column).all():
        row = int(np.argmin(np.isfinite(column)))
        fault = NotANumber if np.isnan(column[row]) else Fault
        refuse_row(row, f"the {kind} is {column[row]}, not a number; leave such rows out", fault)
    smallest = float(column.min())
    swept = float(column.max()) - smallest
    if swept <= 0:
        refused(f"the {kind} is the same in all rows", f"{kind}_column")
    order = np.arange(len(column))
    if against:
        order = order[::-1]
    fractions = (column[order] - smallest) / swept
    read = _angles_of(fractions, kind, lambda row, message: refuse_row(order[row], message))
    rows = order[read.rows]
    laps = whole_cycles(
        read.angles,
        pressures[:, rows],
        lambda row: Fault(("file",), table.line(int(rows[row]))),
        most_turns=1,
        way=_way,
    )
    left_out = len(column) - len(rows)
    if left_out:
        note = f"{left_out} rows between others of the same {kind} are left out: it has too few digits there"
        laps = laps._replace(notes=(*laps.notes, note))
    return laps, Strokes(kind, swept, smallest, against)


def _angles_of(fractions: Array, kind: str, refuse_row: Callable[[int, str], None]) -> StrokeRows:
    """Return the angles of rows by their fractions (n,) of the stroke, from 0 at the smallest on.

    refuse_row: raises RuleError with what is wrong with a row.
    """
    steps = np.abs(np.diff(fractions))
    widest = int(np.argmax(steps))
    if steps[widest] > _HOLE:
        percent = f"{100 * steps[widest]:.0f} % of the stroke"
        refuse_row(widest + 1, f"no rows over {percent} before it; a card has rows everywhere")
    centres, is_low = _dead_centres(fractions)

    # the strokes between them, each in the order of its volume
    bounds = [0, *centres, len(fractions)]
    angles: list[Array] = []
    rows: list[Indices] = []
    turn = 0.0
    grows = not is_low[0]
    for begin, end in itertools.pairwise(bounds):
        inside = fractions[begin:end]
        upward = inside if grows else 1 - inside
        back = np.maximum.accumulate(upward) - upward
        if back.size and back.max() > _BACK:
            size = f"{100 * back.max():.2g} % of the stroke"
            message = (
                f"the {kind} goes back by {size} within a stroke; put the rows in the order of time"
            )
            refuse_row(begin + int(np.argmax(back)), message)
        by_volume = np.argsort(upward, kind="stable")
        risen = np.degrees(2 * np.arcsin(np.sqrt(upward[by_volume])))
        # 180° of either stroke, from the dead centre before it
        angles.append(risen + turn)
        rows.append(by_volume + begin)
        turn += 180.0
        grows = not grows
    # before a smallest volume the rows are those of a stroke from 180° on
    begins_at = 180.0 if is_low[0] else 0.0
    counted = np.concatenate(angles) + begins_at
    order = np.concatenate(rows)

    # of more than two rows at one place the first and the last
    is_first = np.append(True, np.diff(counted) > 0)
    is_last = np.append(is_first[1:], True)
    kept: Flags = is_first | is_last
    if np.ptp(counted) < _LEAST_TURN:
        refused(
            f"the {kind}s make no cycle: both strokes are needed, with the rows in the order of time, "
            f"and not of the {kind}",
            "file",
        )
    return StrokeRows(counted[kept], order[kept])


def _way(angles: Array) -> Array:
    """Return the strokes that the piston of an infinite rod has gone at angles (n,) in degrees."""
    strokes = np.floor(angles / 180)
    within = np.radians(angles - 180 * strokes)
    return np.asarray(strokes + (1 - np.cos(within)) / 2, dtype=float)


def _dead_centres(fractions: Array) -> tuple[list[int], list[bool]]:
    """Return the rows at which the volume turns, and which are smallest ones; each lasts to the next."""
    is_low = fractions < _LOW
    ends = np.flatnonzero(is_low | (fractions > _HIGH))
    states = is_low[ends]
    begins = np.flatnonzero(np.append(True, states[1:] != states[:-1]))
    centres: list[int] = []
    lows: list[bool] = []
    for begin, last in zip(begins, [*begins[1:], len(ends)]):
        first_row = int(ends[begin])
        run = fractions[first_row : int(ends[last - 1]) + 1]
        at_low = bool(states[begin])
        turning = int(np.argmin(run)) if at_low else int(np.argmax(run))
        centres.append(first_row + turning)
        lows.append(at_low)
    if centres[-1] == len(fractions) - 1:  # where the rows end no stroke begins
        centres.pop()
        lows.pop()
    return centres, lows


# in its chamber

_SAME = 1e-4
"""Fraction of the stroke by which rows at equal angles may miss their places."""
_ROUNDS = 8
_NEAR = 10.0
"""Degrees on either side of a dead centre over which the pressures of both turns are compared."""
_LEAST_CLEARANCE = 1e-6


def placed(trace: Trace, setting: Setting) -> Trace:
    """Return a trace with the crank angles of its fractions of the stroke, over whole cycles of its chamber."""
    strokes = trace.strokes
    assert strokes is not None
    nominal = trace.angles
    fractions = np.sin(np.radians(nominal / 2)) ** 2
    crank_angles = _crank_angles(setting, strokes, nominal, fractions)
    fit = _at_equal_angles(setting, strokes, crank_angles, fractions)
    begin, span = 0.0, 1.0
    if fit is not None:
        crank_angles, begin, span = fit

    # V_c/V_h, where the file has the volumes of the chamber
    clearance = trace.clearance
    if clearance is None and strokes.kind == "volume":
        measured = (strokes.smallest + begin * strokes.swept) / (span * strokes.swept)
        clearance = measured if measured >= _LEAST_CLEARANCE else None
    inner, outer = setting.mechanism.dead_centres()
    angles = crank_angles - (outer if setting.mirrored else inner)
    in_chamber = replace(
        trace, angles=angles, clearance=clearance, strokes=None, placed=strokes
    ).over(setting.cycle)
    if setting.cycle == 360:
        return in_chamber

    # it fires at the dead centre with the higher pressure
    after = np.abs(in_chamber.from_dead_centre(setting))
    pressures = in_chamber.pressures
    firing = pressures[after < _NEAR].mean()
    other = pressures[after > setting.cycle / 2 - _NEAR].mean()
    return in_chamber if firing >= other else replace(in_chamber, angle_zero=360.0)


def _crank_angles(setting: Setting, strokes: Strokes, nominal: Array, fractions: Array) -> Array:
    """Return the crank angles (n,) in degrees that rise over whole turns, by nominal angles and fractions of the stroke."""
    mechanism = setting.mechanism
    turn = np.floor(nominal / 360)
    grows = nominal - 360 * turn < 180
    shrinks_outward = strokes.kind == "volume" and not setting.head_end
    displaced = (1 - fractions if shrinks_outward else fractions) * mechanism.stroke
    outward = mechanism.crank_angles_at(displaced, True)
    inward = mechanism.crank_angles_at(displaced, False)
    angles = np.where(grows, outward, inward)
    if shrinks_outward:
        angles = np.where(grows, inward, outward + 360)
    angles = np.maximum.accumulate(angles + 360 * turn)
    angles[-1] = angles[0] + round(nominal[-1] - nominal[0])
    return np.minimum(angles, angles[-1])


def _at_equal_angles(
    setting: Setting, strokes: Strokes, angles: Array, fractions: Array
) -> tuple[Array, float, float] | None:
    """Return rows at equal angles, with fraction and span of the stroke in those of the file; None where they are not.

    Fractions z of the file are a + b z(φ₀ + k Δφ): a, b and φ₀ by least squares, since no row need be at a dead centre.
    """
    count = len(angles) - 1
    steps: Array = np.asarray(
        np.arange(count + 1) * (round(angles[-1] - angles[0]) / count), dtype=float
    )
    mechanism = setting.mechanism

    def fraction_at(degrees: Any) -> Any:
        if strokes.kind == "volume":
            return setting.stroke_fraction(degrees - setting.own_dead_centre)
        return setting._replace(head_end=True).stroke_fraction(
            degrees - mechanism.dead_centres()[0]
        )

    first = float(np.median(angles - steps))
    begin, span = 0.0, 1.0
    rest = np.ones(1)
    for _ in range(_ROUNDS):
        places = fraction_at(first + steps)
        slopes = (fraction_at(first + steps + 1e-3) - fraction_at(first + steps - 1e-3)) / 2e-3
        columns = np.stack((np.ones(count + 1), places, slopes), axis=1)
        (begin, span, shift), *_ = np.linalg.lstsq(columns, fractions, rcond=None)
        rest = fractions - columns @ np.array([begin, span, shift])
        first += float(shift / span)
    is_equal = bool(np.abs(rest).max() <= _SAME) and abs(first - angles[0]) < 360
    if not is_equal:
        return None
    return np.asarray(first + steps, dtype=float), float(begin), float(span)
