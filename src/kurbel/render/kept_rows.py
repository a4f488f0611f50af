"""The rows that an interrupted sweep left in its file, and whether they are of the sweep that is to go on there."""

import csv
import json
import math
import os
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple, NoReturn

from kurbel.designs.chosen import Condition
from kurbel.designs.sweep import Row, Sweep
from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.sweep_output import WRITERS, Titles, csv_rows, part_of

_SAME = 1e-9
"""What two processors may differ by in a number, relatively and in SI: they round otherwise, but are of one sweep."""


class _Line(NamedTuple):
    """A row as it stands in the file: its number, and the texts of all its cells."""

    number: int
    cells: list[str]


class KeptRows:
    """What a file, or the part of it that an early end left, has of these rows of a sweep.

    kept: the number of its rows, and the bytes of its whole lines, which stay.
    Raises UsageError for a file that begins otherwise.
    """

    def __init__(self, file_name: str, titles: Titles, look: Look, rows: range) -> None:
        part = part_of(file_name)
        self._file_name = part if os.path.isfile(part) else file_name
        self._titles, self._look, self._rows = titles, look, rows
        content = _content(self._file_name)
        size = content.rfind(b"\n") + 1
        self._lines = content[:size].decode("utf-8", "replace").split("\n")[:-1]
        head = next(csv_rows(titles, (), look)) if look.format == "csv" and rows.start == 0 else ""
        opening, text = head or '{"row": ' * (look.format == "json"), content.decode("utf-8", "replace")
        if text[: len(opening)] != opening[: len(text)] or not (opening or text[:1] in "0123456789"):
            self._refuse(f"it begins with {text.partition(chr(10))[0][:60]!r}")
        self._headed = bool(head)
        self.kept = max(len(self._lines) - self._headed, 0), size

    def rest(self, sweep: Sweep, conditions: Sequence[Condition]) -> range:
        """Return the rows that are still to be computed.

        Raises UsageError where the file has rows that this sweep has not, or has with other inputs or other answers:
        the inputs of each are compared, and the answers of the last one that has any.
        """
        following, last = self._rows.start, None
        first = 1 + len(sweep.plan.inputs)
        for line in self._parsed():
            if line.number - 1 not in self._rows:
                self._refuse(f"it has row {line.number}, these are rows {self._rows.start + 1} to {self._rows.stop}")
            if line.number <= following or (not conditions and line.number - 1 != following):
                self._refuse(f"row {following + 1} is missing in it")
            self._compare(line, sweep.unanswered(line.number - 1), first)
            following = line.number
            last = line if any(line.cells[first : 1 + len(sweep.heads)]) else last
        if last:
            self._compare_answers(last, sweep, conditions)
        return self._rows[following - self._rows.start :]

    def _compare_answers(self, line: _Line, sweep: Sweep, conditions: Sequence[Condition]) -> None:
        from kurbel.designs.workers import rows_of

        row = next(rows_of(sweep, range(line.number - 1, line.number)))
        self._compare(line, row, len(line.cells))
        if not all(one.holds(row) for one in conditions):
            self._refuse(f"row {line.number} is in it, which --where leaves out")

    def _compare(self, line: _Line, row: Row, count: int) -> None:
        """Refuse a line of which one of the first cells is not what the row has there."""
        *_, text = WRITERS[self._look.format](self._titles, [row], self._look)
        cells = self._cells(text.rstrip("\n"))
        for name, there, here in list(zip(self._titles.whole, line.cells, cells))[:count]:
            if there != here and not self._same(there, here):
                self._refuse(f"row {line.number} has {there or 'no'} {name} in it, and {here or 'none'} now")

    def _parsed(self) -> Iterator[_Line]:
        for text in self._lines[self._headed :]:
            try:
                cells = self._cells(text)
                yield _Line(int(cells[0]), cells)
            except (ValueError, IndexError, AttributeError, csv.Error):
                self._refuse(f"it has a line {text[:60]!r}")

    def _cells(self, line: str) -> list[str]:
        """Return the texts under the heads; raises ValueError for other heads."""
        if self._look.format == "json":
            found = json.loads(line)
            names, cells = list(found), [_text(one) for one in found.values()]
        else:
            names, cells = self._titles.whole, next(csv.reader([line], delimiter=";" if self._look.comma else ","))
        if names != self._titles.whole or len(cells) != len(names):
            raise ValueError(line)
        return cells

    def _same(self, there: str, here: str) -> bool:
        """Return whether two cells have the same numbers, but for their last digits."""
        try:
            pairs = [[float(one.replace(",", ".")) for one in text.split()] for text in (there, here)]
        except ValueError:
            return False
        alike = (math.isclose(*pair, rel_tol=_SAME, abs_tol=_SAME) for pair in zip(*pairs))
        return len(pairs[0]) == len(pairs[1]) > 0 and all(alike)

    def _refuse(self, why: str) -> NoReturn:
        raise UsageError(
            f"--resume: {self._file_name} is not of this sweep: {why}; "
            "give the same machine and options, name another file, or leave --resume out to begin anew"
        )


def _text(value: Any) -> str:
    """Return a value of JSON as the text of a cell."""
    if isinstance(value, list):
        return " ".join(map(repr, value))
    return "" if value is None else value if isinstance(value, str) else repr(value)


def _content(file_name: str) -> bytes:
    """Return what a file has; a device or a pipe, which may have no end, keeps nothing."""
    if not os.path.isfile(file_name):
        return b""
    try:
        with open(file_name, "rb") as file:
            return file.read()
    except OSError as error:
        raise UsageError(f"cannot read {file_name}: {error.strerror}") from None
