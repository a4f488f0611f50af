"""The samples of a measured trace: read from a file of columns, put to the test, and closed to a whole cycle."""

from __future__ import annotations

import itertools
import os
import re
import warnings
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kurbel.declared.bounds import MOST_POINTS, out_of_size
from kurbel.declared.numerals import familiar
from kurbel.errors import Fault, RuleError

if TYPE_CHECKING:
    from kurbel.arrays import Array

PERIODS = (360.0, 720.0)
LARGEST_FILE = 64 * 2**20
"""Bytes; half a million samples have about ten million."""
_LONGEST_LINE = 10_000
_FIGURES = re.compile(r"[-+.,;:%0-9eE \t]*[0-9][-+.,;:%0-9eE \t]*")
_EVEN = 1e-3  # of a step: what rounded angles may miss


class Columns(NamedTuple):
    """How a file of columns is laid out: columns count from 1, skip_rows are the lines above the first figures."""

    angle: int = 1
    pressure: int = 2
    skip_rows: int = 0
    delimiter: str = ","
    decimal: str = "."

    @property
    def between(self) -> str | None:
        """What splits a line; None for any run of blanks."""
        return None if self.delimiter == " " else self.delimiter


class Samples(NamedTuple):
    """One cycle of a trace: angles (n,) in degrees, rising over exactly one period, and pressures (n,) in Pa.

    Two samples at one angle are a jump. period: 360 or 720; notes: what was tidied up.
    """

    angles: Array
    pressures: Array
    period: float
    notes: tuple[str, ...] = ()

    @property
    def even(self) -> bool:
        """Whether the samples stand at equal angles."""
        steps = np.diff(self.angles)
        step = self.period / len(steps)
        return bool(np.abs(steps - step).max() <= _EVEN * step)


def read_columns(file: str, columns: Columns) -> tuple[Array, Array, Callable[[int], str]]:
    """Return the two columns of a file, and what names the line of a sample; raises RuleError with the line."""
    try:
        table = _table(file, columns)
    except ValueError:
        raise RuleError(_first_fault(file, columns)) from None
    except OSError as error:
        raise RuleError(Fault(("file",), f"cannot be read: {error.strerror or error}")) from None
    if len(table) > MOST_POINTS:
        raise RuleError(Fault(("file",), f"has more than {MOST_POINTS} samples; thin them out"))
    if not len(table):
        raise RuleError(Fault(("file",), f"{os.path.basename(file)} has no figures{_below(columns)}"))
    return table[:, 0], table[:, 1], lambda index: f"line {_line_number(file, columns, index)}"


def _table(file: str, columns: Columns) -> Array:
    """Return both columns (n, 2); no more rows than show that there are too many of them are ever held in memory."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # an empty file, of which a message of ours speaks
        return np.loadtxt(
            (familiar(line).replace(columns.decimal, ".") for line in _lines(file)),
            delimiter=columns.between,
            skiprows=columns.skip_rows,
            usecols=(columns.angle - 1, columns.pressure - 1),
            ndmin=2,
            max_rows=MOST_POINTS + 1,
        )


def _lines(file: str) -> Iterator[str]:
    """Yield the lines of a file; headings may be in any encoding, figures are ASCII."""
    if os.path.getsize(file) > LARGEST_FILE:
        raise RuleError(Fault(("file",), f"is larger than {LARGEST_FILE // 2**20} MiB; thin out the samples"))
    with open(file, encoding="utf-8-sig", errors="replace") as stream:
        while line := stream.readline(_LONGEST_LINE + 1):
            if len(line) > _LONGEST_LINE:
                raise RuleError(Fault(("file",), f"has a line of more than {_LONGEST_LINE} characters"))
            yield line


def _figure_lines(file: str, columns: Columns) -> Iterator[tuple[int, str]]:
    """Yield number and text of every line below the headings that has more than a comment, as numpy.loadtxt sees it."""
    for number, line in enumerate(_lines(file), 1):
        figures = familiar(line).partition("#")[0].strip()
        if number > columns.skip_rows and figures:
            yield number, figures


def _line_number(file: str, columns: Columns, index: int) -> int:
    return next(number for number, _ in itertools.islice(_figure_lines(file, columns), index, None))


def _below(columns: Columns) -> str:
    if columns.skip_rows == 0:
        return ""
    return f" below its first {columns.skip_rows} lines" if columns.skip_rows > 1 else " below its first line"


def _first_fault(file: str, columns: Columns) -> Fault:
    """Return the fault of the first line that is no row of figures."""
    last = max(columns.angle, columns.pressure)
    for number, line in _figure_lines(file, columns):
        cells = line.split(columns.between)
        if len(cells) < last:
            shown = f": {_quoted(line)}".rstrip(": ")
            return Fault(("file",), f"line {number} has no column {last}{shown}{_hint(line, number, columns)}")
        for column in (columns.angle, columns.pressure):
            cell = cells[column - 1].strip()
            if not _is_number(cell.replace(columns.decimal, ".")):
                wrong = f"'{shown}' is no number" if (shown := _quoted(cell)) else f"column {column} holds no number"
                return Fault(("file",), f"line {number}: {wrong}{_hint(line, number, columns, cell)}")
    return Fault(("file",), "its rows cannot be read as numbers")


def _quoted(text: str) -> str:
    """Return a piece of a file for a message, if figures could look like it: any other file may hold secrets."""
    if not _FIGURES.fullmatch(text):
        return ""
    return " ".join(text.split()) if len(text) <= 40 else f"{' '.join(text[:40].split())}…"


def _hint(line: str, number: int, columns: Columns, cell: str = "") -> str:
    """Return what to write so that a line could be read."""
    if _is_number(cell.replace(",", ".")) and columns.decimal == ".":
        return "; write 'decimal: comma'"
    signs = (("semicolon", ";"), ("tab", "\t"), ("comma", ","), ("space", " "))
    joined = [word for word, sign in signs if sign in (cell or line).strip() and sign != columns.delimiter]
    if any(c.isdigit() for c in line) and joined:
        return f"; write 'delimiter: {joined[0]}' if that stands between its columns"
    return f"; write 'skip_rows: {number}' if it is a heading" if number == columns.skip_rows + 1 else ""


def _is_number(text: str) -> bool:
    """Return whether numpy.loadtxt takes a text for a number."""
    try:
        float(text)
    except ValueError:
        return False
    return text.isascii() and "_" not in text


def whole_cycle(angles: Array, pressures: Array, named: Callable[[int], Fault]) -> Samples:
    """Return the samples closed to a whole cycle; raises RuleError for what cannot be one.

    angles (n,) in degrees, pressures (n,) in Pa; named: the place of a sample as a fault that lacks a message.
    """
    first = _wrap(angles)
    angles, pressures = np.roll(angles, -first), np.roll(pressures, -first)
    place = _rolled(named, first, len(angles))
    fault = _number_fault(angles, pressures, place) or _order_fault(angles, place)
    if fault:
        raise RuleError(fault)
    turned = (f"the angle begins anew at {angles[0]:.10g} deg; the samples from there on come first",) if first else ()
    angles, pressures, twins = _without_twins(angles, pressures)
    notes = (*turned, *twins)
    span = float(angles[-1] - angles[0])
    period = next((p for p in PERIODS if span <= p * (1 + 1e-9)), 0.0)
    if not period:
        raise RuleError(
            _say(place(len(angles) - 1), f"the samples run over {span:g} deg; cut one cycle of 720 deg out")
        )
    return _closed(angles, pressures, period, notes, place)


def _wrap(angles: Array) -> int:
    """Return the index of the sample at which the angle of one cycle begins anew, 0 where it does not."""
    back = np.flatnonzero(np.diff(angles) < 0)
    once = len(back) == 1 and angles[back[0]] - angles[back[0] + 1] > 180 and angles[-1] <= angles[0]
    return int(back[0]) + 1 if once else 0


def _rolled(named: Callable[[int], Fault], first: int, count: int) -> Callable[[int], Fault]:
    """Return `named` for samples of which the one with index `first` has come to the front."""
    return lambda index: named((index + first) % count)


def _say(place: Fault, message: str) -> Fault:
    return Fault(place.path, f"{place.message}: {message}" if place.message else message)


def _number_fault(angles: Array, pressures: Array, named: Callable[[int], Fault]) -> Fault | None:
    for what, values in (("angle", angles), ("pressure", pressures)):
        bad = np.flatnonzero(~np.isfinite(values))
        if len(bad):
            more = f" ({len(bad)} such samples)" if len(bad) > 1 else ""
            return _say(named(int(bad[0])), f"the {what} is {values[bad[0]]}, not a number{more}; leave such rows out")
        top = int(np.abs(values).argmax())
        wrong = out_of_size(abs(float(values[top])), what)
        if "large" in wrong:
            return _say(named(top), f"the {what} {values[top]:g} {wrong}")
    return None


def _order_fault(angles: Array, named: Callable[[int], Fault]) -> Fault | None:
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


def _without_twins(angles: Array, pressures: Array) -> tuple[Array, Array, tuple[str, ...]]:
    twins = (np.diff(angles) == 0) & (np.diff(pressures) == 0)
    if not twins.any():
        return angles, pressures, ()
    kept = np.concatenate(([True], ~twins))
    return angles[kept], pressures[kept], (f"{int(twins.sum())} samples given twice count once",)


def _closed(
    angles: Array, pressures: Array, period: float, notes: tuple[str, ...], named: Callable[[int], Fault]
) -> Samples:
    """Close the cycle with the first sample where only the last one is missing."""
    end = float(angles[0]) + period
    missing = end - float(angles[-1])
    if missing > 1.5 * _usual_step(angles):
        raise RuleError(_say(named(len(angles) - 1), _hole(float(angles[-1]), end)))
    if missing > 1e-9 * period:
        notes += (f"the closing sample at {end:.10g} deg is missing; that at {angles[0]:.10g} deg closes the cycle",)
        angles, pressures = np.append(angles, end), np.append(pressures, pressures[0])
    else:
        angles = np.append(angles[:-1], end)
    _refuse_large_holes(angles, named)
    return Samples(angles, pressures, period, (*notes, *_hole_notes(angles)))


def _hole(begin: float, end: float) -> str:
    return f"no samples from {begin:.10g} to {end:.10g} deg; a trace covers a whole cycle of 360 or 720 deg"


def _usual_step(angles: Array) -> float:
    """Return the step in degrees such that no wider ones cover half of the angle: a denser stretch is no rule."""
    steps = np.sort(np.diff(angles))
    return float(steps[np.searchsorted(np.cumsum(steps), steps.sum() / 2)])


_LARGE_HOLES = ((20.0, 10.0), (45.0, 3.0))
"""(degrees, times the median step) beyond both of which no straight line stands for what was not measured."""


def _refuse_large_holes(angles: Array, named: Callable[[int], Fault]) -> None:
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
