"""Files of columns, as data loggers write them: columns of figures, or the first line that has none."""

import io
import itertools
import os
import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.numerals import familiar
from kurbel.errors import Fault, RuleError, refused
from kurbel.machine_file.text_file import text_of

MOST_NUMBERS = 5_000_000
"""Numbers that are taken from one file."""
FIGURES = re.compile(r"[-+.,;:%0-9eE \t]*[0-9][-+.,;:%0-9eE \t]*")
"""What could be the figures of a file: nothing else of it is shown, since any other file may hold secrets."""
_QUOTED = re.compile(r'"([^"\n]*)"')


class Columns(NamedTuple):
    """How a file of columns is laid out: columns count from 1, skip_rows are the lines above the first figures.

    angle: None where the rows only count; values: the columns of what was measured.
    """

    angle: int | None = 1
    values: tuple[int, ...] = (2,)
    skip_rows: int = 0
    delimiter: str = ","
    decimal: str = "."

    @property
    def between(self) -> str | None:
        """What splits a line; None for any run of blanks."""
        return None if self.delimiter == " " else self.delimiter

    @property
    def wanted(self) -> tuple[int, ...]:
        """The columns that are read, in their order."""
        return (*(() if self.angle is None else (self.angle,)), *self.values)

    def tidied(self, text: str) -> str:
        """Return a text with decimal points, and without quotation marks, between which a comma is a decimal one."""
        if '"' in text:
            text = _QUOTED.sub(self._unquoted, text)
        return text.replace(self.decimal, ".") if self.decimal not in (".", self.delimiter) else text

    def _unquoted(self, found: re.Match[str]) -> str:
        """Return a cell without its quotation marks; with them, if without it would be two."""
        cell = found[1].strip().replace(self.decimal, ".")
        return found[0] if self.delimiter in cell else cell

    def cells(self, line: str) -> list[str]:
        """Return the cells of a line."""
        return self.tidied(line).split(self.between)


class Table(NamedTuple):
    """What was read: angles (n,) or None, values (m, n) of m columns, and what names the line of a sample."""

    angles: Array | None
    values: Array
    line: Callable[[int], str]


def read_columns(file: str, columns: Columns) -> Table:
    """Return the columns of a file; raises RuleError with the line of the first that cannot be read."""
    text = text_of(file)
    if columns.delimiter == columns.decimal and '"' not in text:
        refused("a comma cannot stand both in numbers and between columns; write 'delimiter: semicolon'", "decimal")
    table = _table(text, columns)
    if not table.size:
        refused(f"{os.path.basename(file)} has no figures{_below(columns)}", "file")
    if table.size > MOST_NUMBERS:
        refused(f"has more than {MOST_NUMBERS} numbers; thin them out", "file")
    angles = None if columns.angle is None else table[:, 0]
    values = table[:, -len(columns.values) :].T
    return Table(angles, values, lambda index: f"line {_line_number(text, columns, index)}")


@lru_cache(maxsize=4)
def _table(text: str, columns: Columns) -> Array:
    """Return the wanted columns (n, k); look-alikes of a blank or a minus are sought only where one is in the way.

    Kept, since designs that vary what is said of a trace have one text in common.
    """
    found = _loaded(text, columns)
    if found is None:
        found = _loaded(familiar(text), columns)
    if found is None:
        raise RuleError(_first_fault(familiar(text), columns))
    found.flags.writeable = False
    return found


def _loaded(text: str, columns: Columns) -> Array | None:
    with warnings.catch_warnings(), suppress(ValueError):
        warnings.simplefilter("ignore")  # an empty file, of which a message of ours speaks
        return np.loadtxt(
            io.StringIO(columns.tidied(text)),
            delimiter=columns.between,
            skiprows=columns.skip_rows,
            usecols=tuple(column - 1 for column in columns.wanted),
            ndmin=2,
            max_rows=MOST_NUMBERS // len(columns.wanted) + 1,
        )
    return None


def _figure_lines(text: str, columns: Columns) -> Iterator[tuple[int, str]]:
    """Yield number and text of every line below the headings that has more than a comment, as numpy.loadtxt sees it."""
    for number, line in enumerate(io.StringIO(text), 1):
        figures = line.partition("#")[0].strip()
        if number > columns.skip_rows and figures:
            yield number, figures


def _line_number(text: str, columns: Columns, index: int) -> int:
    return next(number for number, _ in itertools.islice(_figure_lines(text, columns), index, None))


def _below(columns: Columns) -> str:
    if columns.skip_rows == 0:
        return ""
    return f" below its first {columns.skip_rows} lines" if columns.skip_rows > 1 else " below its first line"


def _first_fault(text: str, columns: Columns) -> Fault:
    """Return the fault of the first line that is no row of figures, and what to write so that it could be read."""
    from kurbel.machine_file.layout import advice

    last = max(columns.wanted)
    for number, line in _figure_lines(text, columns):
        cells = columns.cells(line)
        if len(cells) < last:
            shown = f": {_quoted(line)}".rstrip(": ")
            return Fault(("file",), f"line {number} has no column {last}{shown}{advice(text, number, line, columns)}")
        for column in columns.wanted:
            if not is_number(cell := cells[column - 1].strip()):
                wrong = f"'{shown}' is no number" if (shown := _quoted(cell)) else f"column {column} holds no number"
                return Fault(("file",), f"line {number}: {wrong}{advice(text, number, line, columns, cell)}")
    return Fault(("file",), "its rows cannot be read as numbers")


def _quoted(text: str) -> str:
    """Return a piece of a file for a message, if figures could look like it."""
    if not FIGURES.fullmatch(text):
        return ""
    return " ".join(text.split()) if len(text) <= 40 else f"{' '.join(text[:40].split())}…"


def is_number(text: str) -> bool:
    """Return whether numpy.loadtxt takes a text for a number."""
    try:
        float(text)
    except ValueError:
        return False
    return text.isascii() and "_" not in text
