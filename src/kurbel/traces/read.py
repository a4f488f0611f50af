"""Reading files of columns, as data loggers write them; errors point at the first line that is no row of figures.

A file is decoded, its columns are read by a `Layout`, and what cannot be read is refused with its line and with what
to write, tried out on the first lines of the file.
"""

import io
import itertools
import math
import os
import re
import warnings
from collections.abc import Callable, Iterator
from functools import lru_cache
from importlib.util import find_spec
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.numerals import familiar
from kurbel.declared.units import MOST_POINTS
from kurbel.errors import Fault, RuleError, refused
from kurbel.traces.period import angles_of_pulses

LARGEST_FILE = 64 * 2**20
"""Most bytes of a file; a million samples take about twenty million."""
MOST_NUMBERS = 5_000_000
"""Most numbers that are read from one file."""
LIMITS = (
    f"; a file has at most {LARGEST_FILE // 2**20} MiB and {MOST_NUMBERS} numbers that are read, one cycle at most "
    f"{MOST_POINTS} samples"
)
DELIMITERS = {"comma": ",", "semicolon": ";", "tab": "\t", "space": " "}
"""Word in the machine file -> separator of columns."""
DECIMALS = {"point": ".", "comma": ","}
SECONDS = {"s": 1.0, "ms": 1e-3}
"""Unit of time in the column of angles -> seconds."""
_FIGURES = re.compile(r"[-+.,;:%0-9eE \t]*[0-9][-+.,;:%0-9eE \t]*")
"""A possible figure: messages show nothing else of a file, since it may be a different file with secrets."""
_NUMBER = re.compile(
    r"[-+]?(([0-9]+\.?[0-9]*|\.[0-9]+)(e[-+]?[0-9]+)?|inf|infinity|nan)", re.IGNORECASE | re.ASCII
)
_SPLIT_DECIMALS = re.compile(r"^[^#\n]*,[0-9]+,0[0-9][^#\n]*", re.MULTILINE)
_QUOTED = re.compile(r'"([^"\n]*)"')


class Layout(NamedTuple):
    """How a file of samples is laid out, by its keys.

    columns: those of what was measured, counted from 1; angle_step: degrees from row to row, where no column has
    angles; recorded_speed: revolutions per second, for times; pulse_column: of pulses of a wheel with so many teeth, of
    which some are missing, instead of angles; skip_rows: lines above the first figures; delimiter: '' for the usual one,
    a comma in a text; sheet: of a workbook, by its name, None for the first; rows: what a row is called in messages.
    """

    columns: tuple[int, ...] = (2,)
    angle_column: int = 1
    angle_unit: str = "deg"
    recorded_speed: float | None = None
    angle_step: float | None = None
    pulse_column: int | None = None
    teeth: int = 1
    missing_teeth: int = 0
    skip_rows: int = 0
    delimiter: str = ""
    decimal: str = "point"
    sheet: str | None = None
    rows: str = "line"

    @property
    def wanted(self) -> tuple[int, ...]:
        """The columns that are read, that of the angles first."""
        if self.angle_step:
            return self.columns
        return (self.pulse_column or self.angle_column, *self.columns)

    @property
    def is_timed(self) -> bool:
        """Whether the first column has times."""
        return self.angle_unit in SECONDS and not self.angle_step and not self.pulse_column

    @property
    def between(self) -> str | None:
        """What splits a line; None for any run of blanks."""
        return None if self.delimiter == "space" else DELIMITERS[self.delimiter]

    def tidied(self, text: str) -> str:
        """Return a text with decimal points, and without quotation marks, between which a comma is a decimal one.

        Where the same sign is between columns and in numbers only the marks tell them apart.
        """

        def unquoted(quoted: re.Match[str]) -> str:
            cell = quoted[1].strip().replace(DECIMALS[self.decimal], ".")
            would_split = DELIMITERS[self.delimiter] in cell
            return quoted[0] if would_split else cell

        if '"' in text:
            text = _QUOTED.sub(unquoted, text)
        if self.decimal in ("point", self.delimiter):
            return text
        return text.replace(",", ".")

    def read(self, line: str) -> tuple[list[str], int]:
        """Return the cells of a line, and the first wanted column that has no number; 0 for a row of figures."""
        figures = line.partition("#")[0].strip()
        cells = [cell.strip() for cell in self.tidied(figures).split(self.between)]
        for column in self.wanted:
            if column > len(cells) or not _NUMBER.fullmatch(cells[column - 1]):
                return cells, column
        return cells, 0


class Table(NamedTuple):
    """What was read: angles (n,) in degrees, or times in seconds; figures (m, n) of m columns; line: names that of a row."""

    angles: Array
    figures: Array
    line: Callable[[int], str]


def read_table(file: str, layout: Layout) -> Table:
    """Return the columns of a file; raises RuleError with the first line that cannot be read."""
    text, written_layout = _text_and_layout(file, layout)
    try:
        return _table_of(text, written_layout, file)
    except RuleError as error:
        # of a workbook the sheet may be the wrong one, or its formulas lack their values
        (fault,) = error.faults
        has_advice = "; write '" in fault.message or "; leave such" in fault.message
        raw = _bytes_of(file)
        if has_advice or not is_workbook(raw):
            raise
        sheet = written_layout.sheet
        advice = _advice_on_sheet()(raw, os.path.basename(file), sheet, max(written_layout.wanted))
        if not advice:
            raise
        message = fault.message.partition(";")[0] + advice
        raise RuleError(fault._replace(message=message)) from None


def _table_of(text: str, layout: Layout, file: str) -> Table:
    """Return the columns of the text of a file; raises RuleError with the first line that cannot be read."""
    if layout.delimiter == layout.decimal and '"' not in text:
        refused(
            "a comma cannot be both in numbers and between columns; write 'delimiter: semicolon'",
            "decimal",
        )
    numbers = _numbers(text, layout)
    if not numbers.size:
        lines = layout.rows if layout.skip_rows == 1 else f"{layout.skip_rows} {layout.rows}s"
        below = f" below its first {lines}" if layout.skip_rows else ""
        refused(f"{os.path.basename(file)} has no figures{below}", "file")
    if numbers.size > MOST_NUMBERS:
        refused(f"has more than {MOST_NUMBERS} numbers; thin them out{LIMITS}", "file")

    first_row = 0
    if layout.angle_step:
        angles = np.asarray(np.arange(len(numbers)) * layout.angle_step, dtype=float)
    elif layout.pulse_column:
        pulses = numbers[:, 0]
        angles, kept = angles_of_pulses(pulses, layout.teeth, layout.missing_teeth)
        numbers = numbers[kept]
        first_row = kept.start
    elif layout.is_timed:
        angles = numbers[:, 0] * SECONDS[layout.angle_unit]
    else:
        angles = numbers[:, 0] * (math.degrees(1.0) if layout.angle_unit == "rad" else 1.0)

    def line(index: int) -> str:
        rows = itertools.islice(_figure_lines(text, layout), index + first_row, None)
        number, _ = next(rows)
        return f"{layout.rows} {number}"

    return Table(angles, numbers[:, -len(layout.columns) :].T, line)


def _text_and_layout(file: str, layout: Layout) -> tuple[str, Layout]:
    """Return the text of a file, and the layout with what is usual in such a file."""
    raw = _bytes_of(file)
    if is_workbook(raw):
        text = _sheet_text()(raw, os.path.basename(file), layout.sheet, max(layout.wanted))
        return text, layout._replace(delimiter=layout.delimiter or "tab", rows="row")
    if layout.sheet is not None:
        name = os.path.basename(file)
        refused(f"{name} is no workbook; leave 'sheet' out", "sheet")
    return text_of(raw, file), layout._replace(delimiter=layout.delimiter or "comma")


def _sheet_text() -> Callable[[bytes, str, str | None, int], str]:
    from kurbel.traces.workbook import sheet_text

    return sheet_text


def _advice_on_sheet() -> Callable[[bytes, str, str | None, int], str]:
    from kurbel.traces.workbook import advice_on_sheet

    return advice_on_sheet


@lru_cache(maxsize=4)
def _numbers(text: str, layout: Layout) -> Array:
    """Return the wanted columns (n, k).

    Kept, since designs that vary what is known of a trace have one text in common. Refuses columns between which
    commas seem to be decimal ones, too: '0,37,05' without any point.
    """
    readable = familiar(text)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an empty file, of which a message of ours speaks
            numbers = np.loadtxt(
                io.StringIO(layout.tidied(readable)),
                delimiter=layout.between,
                skiprows=layout.skip_rows,
                usecols=tuple(column - 1 for column in layout.wanted),
                ndmin=2,
                max_rows=MOST_NUMBERS // len(layout.wanted) + 1,
            )
    except ValueError:
        raise RuleError(_first_fault(readable, layout)) from None
    body = text.split("\n", layout.skip_rows)[-1]
    split = layout.delimiter == "comma" and "." not in body and _SPLIT_DECIMALS.search(body)
    if split:
        number = layout.skip_rows + body.count("\n", 0, split.start()) + 1
        row = f": '{_shown(split[0])}'" if _shown(split[0]) else ""
        message = (
            f"{layout.rows} {number}{row} has whole numbers in its columns, or has a decimal comma before its last "
            "digits, which begin with 0; export the file with decimal points, or with semicolons between columns and "
            "write 'delimiter: semicolon' and 'decimal: comma'"
        )
        refused(message, "file")
    numbers.flags.writeable = False
    return numbers


def _figure_lines(text: str, layout: Layout) -> Iterator[tuple[int, str]]:
    """Yield number and text of every line below the headings that has more than a comment, as numpy.loadtxt sees it."""
    for number, line in enumerate(io.StringIO(text), 1):
        figures = line.partition("#")[0].strip()
        if number > layout.skip_rows and figures:
            yield number, figures


# the bytes of a file

_LONGEST_LINE = 10_000
_ZIP = b"PK\x03\x04"
_WORKBOOK = b"xl/workbook.xml"
"""Name of a file in each Excel workbook from 2007 on, which is a zip archive."""
_FOREIGN = {
    _ZIP: "an Excel or other workbook, or a zip archive",
    b"\xd0\xcf\x11\xe0": "an old Excel workbook (xls)",
    b"TDSm": "a TDMS file of LabVIEW",
    b"MDF ": "an MDF file of a measuring system",
    b"\x89HDF": "an HDF5 file",
    b"MATLAB 5.0 MAT": "a MAT file of MATLAB",
    b"\x1f\x8b": "compressed by gzip",
    b"PAR1": "a Parquet file",
    b"%PDF": "a PDF",
}
"""First bytes of files that are mistaken for tables -> what they are."""


def _bytes_of(file: str) -> bytes:
    """Return the bytes of a file; raises RuleError for what is too large, or cannot be read."""
    try:
        if os.path.getsize(file) > LARGEST_FILE:
            refused(
                f"is larger than {LARGEST_FILE // 2**20} MiB; thin out the samples{LIMITS}", "file"
            )
        with open(file, "rb") as stream:
            return stream.read()
    except OSError as error:
        refused(f"cannot be read: {error.strerror or error}", "file")


def is_workbook(raw: bytes) -> bool:
    """Return whether these are the bytes of an Excel workbook that can be read here: openpyxl is installed."""
    return raw.startswith(_ZIP) and _WORKBOOK in raw and find_spec("openpyxl") is not None


def text_of(raw: bytes, file: str) -> str:
    """Return the text of the bytes of a file with line feeds alone; headings may be in any encoding, figures are ASCII.

    UTF-16 is known by its mark, or by the zero in every other byte of its figures. Raises RuleError for what is no text.
    """
    for begin, what in _FOREIGN.items():
        if raw.startswith(begin):
            advice = "; export its table of figures as CSV"
            if _WORKBOOK in raw and begin == _ZIP:
                advice += ", or install openpyxl, with which kurbel reads xlsx"
            refused(f"{os.path.basename(file)} is {what}, no text{advice}", "file")

    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        encoding = "utf-16"
    else:
        encoding = "utf-16-le" if raw[1:400:2].count(0) > len(raw[:400]) // 4 else "utf-8-sig"
    text = raw.decode(encoding, errors="replace").replace("\r\n", "\n").replace("\r", "\n")
    if "\0" in text:
        refused("is no text: it has zero bytes; export the samples as CSV", "file")
    if max(map(len, text.split("\n"))) > _LONGEST_LINE:
        refused(f"has a line of more than {_LONGEST_LINE} characters", "file")
    return text


# what to write instead

_PLAIN = "; figures are plain numbers, such as 1013.25 or 1.01325e3, without signs between thousands: export them so"
_NO_FIGURES = "; is it a file of figures?"
_TRIED = 200
"""Lines that are examined; no heading is longer."""


def _first_fault(text: str, layout: Layout) -> Fault:
    """Return the fault of the first line that is no row of figures, and what to write so that it could be read."""
    for number, line in _figure_lines(text, layout):
        cells, column = layout.read(line)
        if not column:
            continue
        advice = _advice(text, number, cells, column, layout)
        last_column = max(layout.wanted)
        if len(cells) < last_column:
            shown_line = _shown(line)
            row = f": {shown_line}" if shown_line else ""
            return Fault(
                ("file",), f"{layout.rows} {number} has no column {last_column}{row}{advice}"
            )
        # the cell as it is written, where that is certain
        as_written = line.split(layout.between)
        cell = cells[column - 1]
        if len(as_written) == len(cells):
            cell = as_written[column - 1].strip()
        shown_cell = _shown(cell)
        wrong = f"'{shown_cell}' is no number" if shown_cell else f"column {column} holds no number"
        return Fault(("file",), f"{layout.rows} {number}: {wrong}{advice}")
    return Fault(("file",), "its rows cannot be read as numbers")


def _shown(text: str) -> str:
    """Return a part of a file for a message, if figures could look like it; else ''."""
    if not _FIGURES.fullmatch(text):
        return ""
    if len(text) > 40:
        return f"{' '.join(text[:40].split())}…"
    return " ".join(text.split())


def _advice(text: str, number: int, cells: list[str], column: int, layout: Layout) -> str:
    """Return what to write so that a file could be read: the keys by which most of its first lines are rows, or a hint.

    number, cells: of the first line that is no row; column: the first that it lacks, or that holds no number.
    """
    # which lines each layout reads; of those that read as many, one that reads the faulty line too
    lines = [line.partition("#")[0].strip() for line in text.split("\n", _TRIED)[:_TRIED]]
    layouts = _similar_layouts(layout, '"' in "".join(lines))
    rows_of_layouts = [_rows_read(lines, candidate) for candidate in layouts]
    faulty = text.split("\n", number)[number - 1].partition("#")[0].strip()

    def merit(i: int) -> tuple[int, bool]:
        _, bad_column = layouts[i].read(faulty)
        return len(rows_of_layouts[i]), not bad_column

    chosen = max(range(len(layouts)), key=merit)
    rows = rows_of_layouts[chosen]
    reads_rows = len(rows) > 1
    first_row = rows[0] if reads_rows else 0
    skip_rows = first_row if number <= first_row else layout.skip_rows
    best = layouts[chosen]._replace(skip_rows=skip_rows)

    # keys that read more lines
    cell = cells[column - 1] if column <= len(cells) else ""
    if reads_rows and best != layout:
        written = f"; write {' and '.join(_differing_keys(best, layout))}"
        skips_lines_only = best._replace(skip_rows=layout.skip_rows) == layout
        if not skips_lines_only:
            return written
        if not _FIGURES.fullmatch(cell):  # of headings no cell is one of figures
            return f"{written} if it is a heading"

    # or what the line looks like
    rows_as_given = rows_of_layouts[0]
    if rows_as_given and rows_as_given[0] < number - 1:
        return f"; leave such {layout.rows}s out, or correct them"
    if cell:
        has_digit = any(character.isdigit() for character in cell)
        return _PLAIN if has_digit else _NO_FIGURES
    if not any(map(_NUMBER.fullmatch, cells)):
        return _NO_FIGURES
    if len(cells) > 1 or layout.angle_step:
        return f"; it has {len(cells)} only"
    return "; if it has no angles, write 'pressure_column: 1' and 'angle_step: 0.5 deg', say"


def _similar_layouts(layout: Layout, has_quotes: bool) -> list[Layout]:
    """Return this layout, and those with other signs between columns and in numbers, or one column alone."""
    delimiters = dict.fromkeys((layout.delimiter, "semicolon", "tab", "comma", "space"))
    decimals = dict.fromkeys((layout.decimal, *DECIMALS))
    layouts = []
    for delimiter, decimal in itertools.product(delimiters, decimals):
        if delimiter == decimal and not has_quotes:
            continue
        candidate = layout._replace(delimiter=delimiter, decimal=decimal)
        layouts.append(candidate)
        if layout.angle_step:
            layouts.append(candidate._replace(columns=(1,)))
    return layouts


def _rows_read(lines: list[str], layout: Layout) -> list[int]:
    """Return the numbers, from 0, of the lines that a layout reads as rows of figures."""
    rows = []
    for i, line in enumerate(lines):
        if not line:
            continue
        _, bad_column = layout.read(line)
        if not bad_column:
            rows.append(i)
    return rows


def _differing_keys(layout: Layout, written_layout: Layout) -> list[str]:
    """Return the keys that make the layout of the machine file into another one."""
    new = layout._asdict()
    old = written_layout._asdict()
    keys = []
    for key in ("skip_rows", "delimiter", "decimal"):
        if new[key] != old[key]:
            keys.append(f"'{key}: {new[key]}'")
    if layout.columns != written_layout.columns:
        keys.append(f"'pressure_column: {layout.columns[0]}'")
    return keys
