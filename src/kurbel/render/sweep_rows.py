"""The rows of a sweep as csv, json lines, Markdown, a table or a workbook, and where they go.

A table, Markdown and a workbook are written when all rows are there. Of csv and JSON whole lines are written, the first ones at
once, to a file FILE.part that becomes FILE when it has all: the old file stays until then, and an interrupted run
leaves what it has, which `--resume` continues.
"""

import codecs
import json
import math
import os
import re
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain, islice, zip_longest
from typing import BinaryIO, NamedTuple, NoReturn

from kurbel.designs.answers import Cell, Design
from kurbel.designs.chosen import RowCondition, Unit
from kurbel.designs.sweep import Sweep, computed_rows
from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.csv_text import csv_cell, csv_line
from kurbel.render.markup import Markdown, written
from kurbel.render.output import look_at, opened, write_out
from kurbel.render.page import blocks
from kurbel.render.text import plain_lines, single
from kurbel.render.text_tables import TextColumn, TextTable

_AT_LEAST_EVERY = 0.5
"""Seconds after which lines that are ready are written."""
_COMPARED_AT_ONCE = 100
"""Rows of a file whose inputs are compared together."""
_NUMBER = re.compile(rb'(?:\{"row": )?(\d+)\b')
_WORD = re.compile(r'[^,;\s"{}\[\]]+')
"""The number of a row at the beginning of its line, and the names, numbers and words in it, in csv and in json."""
_SAME = 1e-9
"""By how much two processors may differ in a number, relatively and in SI: they round otherwise, in the same sweep."""
_JSON_OF_WORDS = {"": None, "yes": True, "no": False}
"""What JSON has for the words of the last columns."""


class Titles(NamedTuple):
    """Names of the columns with their units, in order, and the heads of the texts after the values.

    row: the head of the first column.
    """

    names: tuple[tuple[str, str], ...]
    last: tuple[str, ...] = ()
    row: str = "row"

    @property
    def heads(self) -> list[str]:
        """All heads with their units, as in csv: `row`, `T_max_N`, …, `keeps`, `broken`, `failure`."""
        heads = [self.row]
        for name, unit in self.names:
            heads.append(f"{name}_{unit.replace(' ', '')}" if unit else name)
        return [*heads, *self.last]

    @property
    def with_units(self) -> list[tuple[str, str]]:
        """All names, each with its unit."""
        return [(self.row, ""), *self.names, *((name, "") for name in self.last)]

    def values(self, row: Design) -> list[Cell]:
        """Return the values of a row under the heads."""
        return [row.number, *row.values, *row.texts]


# rows as lines of text


def head_and_row_lines(titles: Titles, look: Look) -> tuple[str, Callable[[Design], str]]:
    """Return the line of the heads, and what makes the line of a row, in csv or as JSON."""
    if look.format == "csv":
        csv_row = csv_line(look)
        head = csv_row([csv_cell(name, look) for name in titles.heads])
        return head, lambda row: csv_row([csv_cell(value, look) for value in titles.values(row)])

    def json_row(row: Design) -> str:
        cells: dict[str, object] = dict(zip(titles.heads, titles.values(row)))
        for head, text in zip(titles.last, row.texts):
            cells[head] = _JSON_OF_WORDS.get(text, text)
        return json.dumps(cells, allow_nan=False, ensure_ascii=False) + "\n"

    return "", json_row


def _for_people(titles: Titles, look: Look, rows: Sequence[Design]) -> Iterator[str]:
    """Return rows as a table of text or of Markdown."""
    heads = titles.with_units
    cells_of_columns: list[list[str]] = [[] for _ in heads]
    for row in rows:
        for column_cells, value in zip(cells_of_columns, titles.values(row)):
            column_cells.append(_cell(value, look))

    columns = []
    for (name, unit), column_cells in zip(heads, cells_of_columns):
        role = "name" if name in titles.last else "number"
        columns.append(TextColumn(look.text(name), look.unit(unit), column_cells, role))
    if look.format == "markdown":
        markdown = "".join(written([TextTable("", columns, 1)], Markdown(look)))
        return iter([markdown.lstrip("\n")])
    return plain_lines(blocks(columns[:1], columns[1:], look))


def _cell(value: Cell, look: Look) -> str:
    """Return a value as people read it, its number to four digits."""
    if isinstance(value, str):
        if isinstance(value, Unit):
            return look.unit(value)
        return look.text(value)
    if isinstance(value, tuple):
        return " ".join(_cell(number, look) for number in value)
    if value is None:
        return ""
    text, power = single(value, look.digits)
    return look.number(f"{text}e{power}" if power else text)


# where they go


class WrittenRows(NamedTuple):
    """Rows that a file has already, and the bytes of their lines, which stay."""

    rows: int = 0
    size: int = 0


NOTHING_WRITTEN = WrittenRows()


def write_rows(
    rows: Iterable[Design],
    titles: Titles,
    look: Look,
    file_name: str | None,
    early: Callable[[str], None],
    headed: bool = True,
    written_before: WrittenRows = NOTHING_WRITTEN,
) -> None:
    """Write the rows; a reader that leaves early is no fault, as `opened` sees to. Raises UsageError.

    headed: csv with its head; early: called with a sentence about what an early end leaves.
    """
    look = look_at(file_name, look)
    if look.format == "xlsx":
        from kurbel.render.workbook import sheet_of_rows, write_workbook

        sheet = sheet_of_rows(titles.with_units, map(titles.values, rows), look)
        with opened(file_name) as file:
            write_workbook([sheet], file, look)
        return
    if look.format in ("table", "markdown"):
        write_out(_for_people(titles, look, list(rows)), file_name, look.encoding)
        return

    # a row counts as written when the next one is wanted
    count = written_before.rows

    def counted() -> Iterator[Design]:
        nonlocal count
        for row in rows:
            yield row
            count += 1

    counted_rows = counted()
    try:
        # the first row before anything is opened: there may be none, for whatever reason
        first_row = list(islice(counted_rows, 1))
        all_rows = chain(first_row, counted_rows)
        with opened(file_name, resumed=written_before.size) as file:
            head_line, row_line = head_and_row_lines(titles, look)
            heads = [head_line] if headed else []
            _write_lines(file, chain(heads, map(row_line, all_rows)), look.encoding)
    except BaseException:
        if count:
            _report_what_is_left(count, file_name, look, early)
        raise


def _report_what_is_left(
    count: int, file_name: str | None, look: Look, early: Callable[[str], None]
) -> None:
    """Say how many rows an early end leaves, and where; count: of those known to be written."""
    if file_name is None or file_name == "-":
        early(f"{_rows_in_words(count)} written")
        return
    part = _part_of(file_name)
    if os.path.isfile(part):
        # by the file: an interrupt may come between the writing of a row and its counting
        with open(part, "rb") as file:
            lines = sum(1 for _ in file)
        count = lines - 1 if look.format == "csv" else lines
        early(f"{part} holds {_rows_in_words(count)}")


def _rows_in_words(count: int) -> str:
    return "1 row" if count == 1 else f"{count} rows"


def _part_of(file_name: str) -> str:
    return os.path.realpath(file_name) + ".part"


def _write_lines(file: BinaryIO, lines: Iterable[str], encoding: str) -> None:
    """Write lines, the first ones at once, and those that are ready whenever some time has passed."""
    # an incremental encoder writes one byte order mark at most
    encoder = codecs.getincrementalencoder(encoding)("replace")
    due = 0.0
    for line in lines:
        file.write(encoder.encode(line))
        if time.monotonic() >= due:
            file.flush()
            due = time.monotonic() + _AT_LEAST_EVERY


# the rows that an interrupted sweep left


def rows_written_before(
    file_name: str,
    sweep: Sweep,
    titles: Titles,
    look: Look,
    rows: range,
    conditions: Sequence[RowCondition],
) -> tuple[WrittenRows, range]:
    """Return what a file, or the part of it that an early end left, has of these rows, and those still to be computed.

    Raises UsageError for a file that begins otherwise, or that has rows that this sweep has not, or with other inputs
    or other answers: the inputs of each row are compared, and the answers of the last one.
    """
    part = _part_of(file_name)
    path = part if os.path.isfile(part) else file_name
    # a device or a pipe, which may have no end, keeps nothing
    if not os.path.isfile(path):
        return NOTHING_WRITTEN, rows

    begun = _BegunFile(path, sweep, titles, look, rows, gaps_allowed=bool(conditions))
    try:
        begun.read()
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from None
    if begun.last_line:
        begun.compare_answers(conditions)
    return WrittenRows(begun.count, begun.size), rows[begun.next_row - rows.start :]


class _BegunFile:
    """A file of rows that an early end left: what it has, line by line, compared with the sweep.

    count, size: of its whole lines, rows and bytes; next_row: the first that it has not; gaps_allowed: rows may be
    missing in it, as --where leaves some out.
    """

    def __init__(
        self, path: str, sweep: Sweep, titles: Titles, look: Look, rows: range, gaps_allowed: bool
    ) -> None:
        self.path = path
        self.sweep = sweep
        self.rows = rows
        self.gaps_allowed = gaps_allowed
        self.head_line, self.row_line = head_and_row_lines(titles, look)
        input_names = titles.names[: len(sweep.plan.inputs)]
        self.inputs_line = head_and_row_lines(Titles(input_names, row=titles.row), look)[1]
        self.count = 0
        self.size = 0
        self.next_row = rows.start
        self.last_line = b""

    def read(self) -> None:
        """Read the whole lines, and compare the inputs of their rows."""
        with open(self.path, "rb") as file:
            self._read_head(file)
            while True:
                lines = [line for line in islice(file, _COMPARED_AT_ONCE) if line.endswith(b"\n")]
                if not lines:
                    return
                self._compare_inputs(lines)
                self.count += len(lines)
                self.size += sum(map(len, lines))
                self.last_line = lines[-1]

    def _read_head(self, file: BinaryIO) -> None:
        """Leave the file at its first row; the file of a shard begins with a row, not with the heads."""
        head = self.head_line.encode() if self.rows.start == 0 else b""
        first_line = next(file, b"")
        if head:
            begins_alike = head.startswith(first_line)
        else:
            begins_alike = bool(_NUMBER.match(first_line)) or b'{"row": '.startswith(first_line)
        if not begins_alike:
            self._refuse(f"it begins with {_excerpt(first_line)}")
        self.size = len(head) if first_line == head else 0
        file.seek(self.size)

    def _compare_inputs(self, lines: list[bytes]) -> None:
        row_numbers = [self._row_number(line) for line in lines]
        for row, line, inputs in zip(row_numbers, lines, self.sweep.inputs(row_numbers)):
            words_now = _WORD.findall(self.inputs_line(Design(row + 1, inputs)))
            self._compare(row + 1, _words(line)[: len(words_now)], words_now)

    def _row_number(self, line: bytes) -> int:
        """Return the row of a line, counted from 0, which must follow the one before it."""
        number = _NUMBER.match(line)
        if not number:
            self._refuse(f"it has a line {_excerpt(line)}")
        row = int(number[1]) - 1
        if row not in self.rows:
            span = f"{self.rows.start + 1} to {self.rows.stop}"
            self._refuse(f"it has row {row + 1}, these are rows {span}")
        is_missing = row != self.next_row and not self.gaps_allowed
        if row < self.next_row or is_missing:
            self._refuse(f"row {self.next_row + 1} is missing in it")
        self.next_row = row + 1
        return row

    def compare_answers(self, conditions: Sequence[RowCondition]) -> None:
        """Compute the last row anew, and compare all that its line has."""
        last_row = range(self.next_row - 1, self.next_row)
        computed = next(computed_rows(self.sweep, last_row))
        words_now = _WORD.findall(self.row_line(computed))
        self._compare(self.next_row, _words(self.last_line), words_now)
        if not all(condition.holds(computed) for condition in conditions):
            self._refuse(f"row {self.next_row} is in it, which --where leaves out")

    def _compare(self, row: int, words_there: list[str], words_now: list[str]) -> None:
        for word_there, word_now in zip_longest(words_there, words_now, fillvalue="nothing"):
            if not _are_equal(word_there, word_now):
                self._refuse(f"row {row} has {word_there} in it, and {word_now} now")

    def _refuse(self, why: str) -> NoReturn:
        raise UsageError(
            f"--resume: {self.path} is not of this sweep: {why}; "
            "give the same machine and options, name another file, or leave --resume out to begin anew"
        )


def _excerpt(line: bytes) -> str:
    return repr(line.decode("utf-8", "replace").rstrip("\n")[:60])


def _words(line: bytes) -> list[str]:
    return _WORD.findall(line.decode("utf-8", "replace"))


def _are_equal(word: str, other: str) -> bool:
    """Return whether two words are equal, or numbers but for their last digits."""
    if word == other:
        return True
    try:
        return math.isclose(float(word), float(other), rel_tol=_SAME, abs_tol=_SAME)
    except ValueError:
        return False
