"""Files of columns, as data loggers write them: to columns of figures, or the first line that has none.

A file is decoded, its columns are read by a `Layout`, and what cannot be read is refused with its line and with what
to write, tried out on the first lines of the file.
"""

import io
import itertools
import math
import os
import re
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.numerals import familiar
from kurbel.declared.units import MOST_POINTS
from kurbel.errors import Fault, RuleError, refused

LARGEST_FILE = 64 * 2**20
"""Bytes; a million samples have about twenty million."""
MOST_NUMBERS = 5_000_000
"""Numbers that are read from one file."""
LIMITS = (
    f"; a file has at most {LARGEST_FILE // 2**20} MiB and {MOST_NUMBERS} numbers that are read, one cycle at most "
    f"{MOST_POINTS} samples"
)
DELIMITERS = {"comma": ",", "semicolon": ";", "tab": "\t", "space": " "}
"""Word in the machine file -> what is between two columns."""
DECIMALS = {"point": ".", "comma": ","}
SECONDS = {"s": 1.0, "ms": 1e-3}
"""Unit of time in the column of angles -> seconds."""
_FIGURES = re.compile(r"[-+.,;:%0-9eE \t]*[0-9][-+.,;:%0-9eE \t]*")
"""What could be the figures of a file: nothing else of it is shown, since any other file may hold secrets."""
_THOUSANDS = re.compile(r"[-+]?[0-9]{1,3}([.,][0-9]{3})+([.,][0-9]+)?")
_UNIT = re.compile(r"[\[(]([^\])]+)[\])]")
_QUOTED = re.compile(r'"([^"\n]*)"')


class Layout(NamedTuple):
    """How a file of samples is laid out, by its keys.

    columns: those of what was measured, counted from 1; angle_step: degrees from row to row, where no column has
    angles; recorded_speed: revolutions per second, for times; skip_rows: lines above the first figures.
    """

    columns: tuple[int, ...] = (2,)
    angle_column: int = 1
    angle_unit: str = "deg"
    recorded_speed: float | None = None
    angle_step: float | None = None
    skip_rows: int = 0
    delimiter: str = "comma"
    decimal: str = "point"

    @property
    def wanted(self) -> tuple[int, ...]:
        """The columns that are read, that of the angles first."""
        return self.columns if self.angle_step else (self.angle_column, *self.columns)

    @property
    def between(self) -> str | None:
        """What splits a line; None for any run of blanks."""
        return None if self.delimiter == "space" else DELIMITERS[self.delimiter]

    @property
    def ambiguous(self) -> bool:
        """Whether the same sign is between columns and in numbers, which only quotation marks can tell apart."""
        return self.delimiter == self.decimal

    def tidied(self, text: str) -> str:
        """Return a text with decimal points, and without quotation marks, between which a comma is a decimal one."""
        if '"' in text:
            text = _QUOTED.sub(self._unquoted, text)
        return text if self.decimal == "point" or self.ambiguous else text.replace(",", ".")

    def _unquoted(self, found: re.Match[str]) -> str:
        """Return a cell without its quotation marks; with them, if without it would be two."""
        cell = found[1].strip().replace(DECIMALS[self.decimal], ".")
        return found[0] if DELIMITERS[self.delimiter] in cell else cell

    def cells(self, line: str) -> list[str]:
        """Return the cells of a line."""
        return self.tidied(line).split(self.between)

    def is_row(self, line: str) -> bool:
        """Return whether a line has a number in every wanted column."""
        cells = self.cells(line.partition("#")[0].strip())
        return len(cells) >= max(self.wanted) and all(_is_number(cells[one - 1].strip()) for one in self.wanted)


class Table(NamedTuple):
    """What was read: angles (n,) in degrees, figures (m, n) of m columns, and what names the line of a sample.

    headed: the unit in the heading of the first of these columns, as in `p [bar]`, or ''.
    """

    angles: Array
    figures: Array
    line: Callable[[int], str]
    headed: str = ""


def read_table(file: str, layout: Layout) -> Table:
    """Return angles and columns of a file; raises RuleError with the line of the first that cannot be read."""
    text = text_of(file)
    if layout.ambiguous and '"' not in text:
        refused("a comma cannot be both in numbers and between columns; write 'delimiter: semicolon'", "decimal")
    numbers = _numbers(text, layout)
    if not numbers.size:
        lines = "line" if layout.skip_rows == 1 else f"{layout.skip_rows} lines"
        below = f" below its first {lines}" if layout.skip_rows else ""
        refused(f"{os.path.basename(file)} has no figures{below}", "file")
    if numbers.size > MOST_NUMBERS:
        refused(f"has more than {MOST_NUMBERS} numbers; thin them out{LIMITS}", "file")

    if layout.angle_step:
        angles = np.asarray(np.arange(len(numbers)) * layout.angle_step, dtype=float)
    elif layout.recorded_speed is not None:
        angles = numbers[:, 0] * (360.0 * layout.recorded_speed * SECONDS[layout.angle_unit])
    else:
        angles = numbers[:, 0] * (math.degrees(1.0) if layout.angle_unit == "rad" else 1.0)

    def line(index: int) -> str:
        number, _ = next(itertools.islice(_figure_lines(text, layout), index, None))
        return f"line {number}"

    heads = [one for one in text.split("\n", layout.skip_rows)[: layout.skip_rows] if one.strip()]
    cells = heads[-1].split(layout.between) if heads else []
    unit = _UNIT.search(cells[layout.columns[0] - 1]) if len(cells) >= layout.columns[0] else None
    return Table(angles, numbers[:, -len(layout.columns) :].T, line, unit[1].strip() if unit else "")


@lru_cache(maxsize=4)
def _numbers(text: str, layout: Layout) -> Array:
    """Return the wanted columns (n, k); look-alikes of a blank or a minus are sought only where one is in the way.

    Kept, since designs that vary what is known of a trace have one text in common.
    """
    for one in (text, familiar(text)):
        with warnings.catch_warnings(), suppress(ValueError):
            warnings.simplefilter("ignore")  # an empty file, of which a message of ours speaks
            found = np.loadtxt(
                io.StringIO(layout.tidied(one)),
                delimiter=layout.between,
                skiprows=layout.skip_rows,
                usecols=tuple(column - 1 for column in layout.wanted),
                ndmin=2,
                max_rows=MOST_NUMBERS // len(layout.wanted) + 1,
            )
            _refuse_split_decimals(text, layout)
            found.flags.writeable = False
            return found
    raise RuleError(_first_fault(familiar(text), layout))


def _refuse_split_decimals(text: str, layout: Layout) -> None:
    """Raise RuleError where commas between columns seem to be decimal ones, too: '0,37,05' without any point."""
    body = text.split("\n", layout.skip_rows)[-1]
    if layout.delimiter != "comma" or "." in body or not re.search(",0[0-9]", body):
        return
    for number, line in _figure_lines(text, layout):
        if re.search(",[0-9]+,0[0-9]", line):
            message = (
                f"line {number}: '{_shown(line)}' is whole numbers in columns, or has a decimal comma before its last "
                "digits, which begin with 0; export the file with decimal points, or with semicolons between columns "
                "and write 'delimiter: semicolon' and 'decimal: comma'"
            )
            refused(message, "file")


def _figure_lines(text: str, layout: Layout) -> Iterator[tuple[int, str]]:
    """Yield number and text of every line below the headings that has more than a comment, as numpy.loadtxt sees it."""
    for number, line in enumerate(io.StringIO(text), 1):
        figures = line.partition("#")[0].strip()
        if number > layout.skip_rows and figures:
            yield number, figures


# the bytes of a file

_LONGEST_LINE = 10_000
_WORKBOOK = "save its sheet as CSV"
_FOREIGN = {
    b"PK\x03\x04": ("an Excel or other workbook, or a zip archive", _WORKBOOK),
    b"\xd0\xcf\x11\xe0": ("an old Excel workbook (xls)", _WORKBOOK),
    b"TDSm": ("a TDMS file of LabVIEW", "export its channels as CSV"),
    b"MDF ": ("an MDF file of a measuring system", "export its channels as CSV"),
    b"\x89HDF": ("an HDF5 file", "export its data set as CSV"),
    b"MATLAB 5.0 MAT": ("a MAT file of MATLAB", "write its matrix as CSV (writematrix)"),
    b"\x1f\x8b": ("compressed by gzip", "unpack it"),
    b"PAR1": ("a Parquet file", "export its columns as CSV"),
    b"%PDF": ("a PDF", "name the file of figures itself"),
}
"""First bytes of files that people name for a table -> what they are, and the way out."""


def text_of(file: str) -> str:
    """Return the text of a file with line feeds alone; figures are ASCII, headings may be in any encoding.

    Raises RuleError for what is too large, or no text.
    """
    try:
        if os.path.getsize(file) > LARGEST_FILE:
            refused(f"is larger than {LARGEST_FILE // 2**20} MiB; thin out the samples{LIMITS}", "file")
        with open(file, "rb") as stream:
            raw = stream.read()
    except OSError as error:
        refused(f"cannot be read: {error.strerror or error}", "file")
    for begin, (what, advice) in _FOREIGN.items():
        if raw.startswith(begin):
            refused(f"{os.path.basename(file)} is {what}, no text; {advice}", "file")
    text = raw.decode(_encoding(raw), errors="replace").replace("\r\n", "\n").replace("\r", "\n")
    if "\0" in text:
        refused("is no text: it has zero bytes; export the samples as CSV", "file")
    start = 0
    while len(text) - start > _LONGEST_LINE:  # by leaps: less is between two line feeds
        start = text.rfind("\n", start, start + _LONGEST_LINE + 1) + 1
        if not start:
            refused(f"has a line of more than {_LONGEST_LINE} characters", "file")
    return text


def _encoding(raw: bytes) -> str:
    """Return the encoding; UTF-16 is known by its mark, or by the zero in every other byte of its figures."""
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return "utf-16"
    head = raw[:400]
    for first, name in ((1, "utf-16-le"), (0, "utf-16-be")):
        if head and head[first::2].count(0) > len(head) // 4:
            return name
    return "utf-8-sig"


# what to write instead

_PLAIN = "; figures are plain numbers, such as 1013.25 or 1.01325e3: export them so"
_NO_FIGURES = "; is it a file of figures?"
_TRIED = 200
"""Lines that are looked at: headings are no longer."""


def _first_fault(text: str, layout: Layout) -> Fault:
    """Return the fault of the first line that is no row of figures, and what to write so that it could be read."""
    last = max(layout.wanted)
    for number, line in _figure_lines(text, layout):
        cells = layout.cells(line)
        if len(cells) < last:
            row = f": {_shown(line)}" if _shown(line) else ""
            return Fault(("file",), f"line {number} has no column {last}{row}{_advice(text, number, line, layout)}")
        as_written = line.split(layout.between)
        for column in layout.wanted:
            cell = cells[column - 1].strip()
            if not _is_number(cell):
                shown = _shown(as_written[column - 1].strip() if len(as_written) == len(cells) else cell)
                wrong = f"'{shown}' is no number" if shown else f"column {column} holds no number"
                return Fault(("file",), f"line {number}: {wrong}{_advice(text, number, line, layout, cell)}")
    return Fault(("file",), "its rows cannot be read as numbers")


def _shown(text: str) -> str:
    """Return a part of a file for a message, if figures could look like it; else ''."""
    if not _FIGURES.fullmatch(text):
        return ""
    return " ".join(text.split()) if len(text) <= 40 else f"{' '.join(text[:40].split())}…"


def _is_number(text: str) -> bool:
    """Return whether numpy.loadtxt takes a text for a number."""
    try:
        float(text)
    except ValueError:
        return False
    return text.isascii() and "_" not in text


def _advice(text: str, number: int, line: str, layout: Layout, cell: str = "") -> str:
    """Return what to write so that a file could be read: keys under which its first lines are rows, or a guess.

    number, line, cell: the line, and the cell in it, that could not be.
    """
    lines = text.split("\n", _TRIED)[:_TRIED]
    quoted = any('"' in one for one in lines)
    tried = [one for one in _alternatives(layout) if quoted or not one.ambiguous]
    begun = {one: _begin_of_figures(lines, one) for one in tried}
    readable = [one._replace(skip_rows=begin) for one, begin in begun.items() if begin is not None]
    found = min(readable, key=lambda one: one.skip_rows, default=None)
    written = _differing_keys(found, layout) if found else []
    only_headings = len(written) == 1 and "skip_rows" in written[0]
    if written and not (only_headings and _FIGURES.fullmatch(cell)):  # of headings no cell is one of figures
        return f"; write {' and '.join(written)}{' if it is a heading' if only_headings else ''}"

    # no layout reads all lines: what the first bad one hints at, signs by which it is a row, or what is in the way
    signs = next((one for one in tried if one.columns == layout.columns and one.is_row(line)), None)
    if signs:
        return f"; write {' and '.join(_differing_keys(signs, layout))}"
    first_row = next((i for i, one in enumerate(lines, 1) if i > layout.skip_rows and layout.is_row(one)), 0)
    if number < first_row and not _FIGURES.fullmatch(cell):
        return f"; write 'skip_rows: {first_row - 1}' if it is a heading"
    if 0 < first_row < number:
        return "; leave such lines out, or mend them"
    cells = layout.cells(line)
    if len(cells) >= max(layout.wanted):
        thousands = ", without signs between thousands" if _THOUSANDS.fullmatch(cell) else ""
        return f"{_PLAIN}{thousands}" if any(one.isdigit() for one in cell) else _NO_FIGURES
    if not any(_is_number(one.strip()) for one in cells):
        return _NO_FIGURES
    if len(cells) > 1 or layout.angle_step:
        return f"; it has {len(cells)} only"
    return "; if it has no angles, write 'pressure_column: 1' and 'angle_step: 0.5 deg', say"


def _alternatives(layout: Layout) -> Iterator[Layout]:
    """Yield layouts with other signs, the given one first; rows that only count need no second column."""
    for delimiter in dict.fromkeys((layout.delimiter, "semicolon", "tab", "comma", "space")):
        for decimal in dict.fromkeys((layout.decimal, *DECIMALS)):
            signs = layout._replace(delimiter=delimiter, decimal=decimal)
            yield signs
            if layout.angle_step:
                yield signs._replace(columns=(1,))


def _begin_of_figures(lines: Sequence[str], layout: Layout) -> int | None:
    """Return how many lines are above the first of at least two rows of figures; None where rows are broken."""
    rows = {i: layout.is_row(line) for i, line in enumerate(lines) if line.partition("#")[0].strip()}
    begin = next((index for index, row in rows.items() if row), len(lines))
    below = [row for index, row in rows.items() if index >= begin]
    if len(below) < 2 or not all(below):
        return None
    return begin if any(index < begin for index in rows) else 0


def _differing_keys(found: Layout, given: Layout) -> list[str]:
    """Return the keys that make the given layout that which was found."""
    keys = {"skip_rows": found.skip_rows, "delimiter": found.delimiter, "decimal": found.decimal}
    written = [f"'{key}: {value}'" for key, value in keys.items() if value != getattr(given, key)]
    return written if found.columns == given.columns else [*written, f"'pressure_column: {found.columns[0]}'"]
