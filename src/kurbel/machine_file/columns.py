"""Files of columns, as data loggers write them: two columns of figures, or the first line that has none."""

from __future__ import annotations

import itertools
import os
import re
import warnings
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kurbel.declared.bounds import MOST_POINTS
from kurbel.declared.numerals import familiar
from kurbel.errors import Fault, RuleError, refuse

if TYPE_CHECKING:
    from kurbel.arrays import Array

LARGEST_FILE = 64 * 2**20
"""Bytes; half a million samples have about ten million."""
_LONGEST_LINE = 10_000
_FIGURES = re.compile(r"[-+.,;:%0-9eE \t]*[0-9][-+.,;:%0-9eE \t]*")


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


def read_columns(file: str, columns: Columns) -> tuple[Array, Array, Callable[[int], str]]:
    """Return the two columns of a file, and what names the line of a sample; raises RuleError with the line."""
    try:
        table = _table(file, columns)
    except ValueError:
        raise RuleError(_first_fault(file, columns)) from None
    except OSError as error:
        raise RuleError(Fault(("file",), f"cannot be read: {error.strerror or error}")) from None
    if len(table) > MOST_POINTS:
        refuse(Fault(("file",), f"has more than {MOST_POINTS} samples; thin them out"))
    if not len(table):
        refuse(Fault(("file",), f"{os.path.basename(file)} has no figures{_below(columns)}"))
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
        refuse(Fault(("file",), f"is larger than {LARGEST_FILE // 2**20} MiB; thin out the samples"))
    with open(file, encoding="utf-8-sig", errors="replace") as stream:
        while line := stream.readline(_LONGEST_LINE + 1):
            if len(line) > _LONGEST_LINE:
                refuse(Fault(("file",), f"has a line of more than {_LONGEST_LINE} characters"))
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
