"""The rows of a sweep as csv, json lines, Markdown, a table or Parquet, where they go, and those that a file has.

Whole lines are written, the first ones at once, to a file FILE.part that becomes FILE when it has all: the old file
stays until then, and an interrupted run leaves what it has, which `--resume` continues.
"""

import codecs
import csv
import json
import math
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from itertools import chain, islice
from shutil import copyfile
from typing import Any, BinaryIO, NamedTuple, NoReturn

from kurbel.designs.chosen import Condition, Unit
from kurbel.designs.sweep import Row, Sweep
from kurbel.designs.workers import rows_of
from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.data import csv_cell, csv_line
from kurbel.render.numbers import single
from kurbel.render.output import silence, stdout_look, take_mode, whole_file

_AT_LEAST_EVERY = 0.5
"""Seconds after which lines that are ready are written."""
_IN_A_GROUP = 10_000
"""Rows of a group of a Parquet file."""
_WIDTH_OF = 20
"""Rows that decide the widths of the columns of a table; a wider cell further down moves its row."""
_COMPARED_AT_ONCE = 100
"""Rows of a file whose inputs are compared together."""
_SAME = 1e-9
"""By how much two processors may differ in a number, relatively and in SI: they round otherwise, in the same sweep."""


class Titles(NamedTuple):
    """Names of the columns with their units, in order, and the heads of the texts after the values.

    row: the head of the first column; types: see `Sweep.types`, for Parquet only.
    """

    names: tuple[tuple[str, str], ...]
    last: tuple[str, ...] = ()
    row: str = "row"
    types: Sequence[str] = ()

    @property
    def whole(self) -> list[str]:
        """All heads with their units, as in csv: `row`, `T_max_N`, …, `keeps`, `broken`, `failure`."""
        heads = [f"{name}_{unit.replace(' ', '')}" if unit else name for name, unit in self.names]
        return [self.row, *heads, *self.last]

    def values(self, row: Row) -> list[Any]:
        """Return the values of a row under the heads."""
        return [row.number, *row.values, *map(row.text, self.last)]


# rows as lines of text


class Lines(NamedTuple):
    """How rows become lines: those of the heads, and what makes the line of a row."""

    heads: list[str]
    of: Callable[[Row], str]


def lines_of(titles: Titles, look: Look, first: Sequence[Row] = ()) -> Lines:
    """Return how the format of the look writes rows; first: rows that decide the widths of a table."""
    if look.format == "table":
        return _table_lines(titles, look, first)
    return {"csv": _csv_lines, "json": _json_lines, "markdown": _markdown_lines}[look.format](titles, look)


def _csv_lines(titles: Titles, look: Look) -> Lines:
    line = csv_line(look)
    plain = None if look.digits or look.comma else float

    def of(row: Row) -> str:  # most values are numbers in full, which `csv_cell` would only take longer for
        values = titles.values(row)
        return line([value + 0.0 if type(value) is plain else csv_cell(value, look) for value in values])

    return Lines([line(csv_cell(name, look) for name in titles.whole)], of)


def _json_lines(titles: Titles, look: Look) -> Lines:
    names = titles.whole

    def of(row: Row) -> str:
        texts = {"keeps": row.keeps, "broken": row.broken or None, "failure": row.failure or None}
        found = {name: texts.get(name, value) for name, value in zip(names, titles.values(row))}
        return json.dumps(found, allow_nan=False, ensure_ascii=False) + "\n"

    return Lines([], of)


def _markdown_lines(titles: Titles, look: Look) -> Lines:
    def line(cells: Iterable[str]) -> str:
        escaped = (cell.replace("\\", "\\\\").replace("|", "\\|") for cell in cells)
        return f"| {' | '.join(escaped)} |\n"

    heads = [*(f"{name} ({look.unit(unit)})" if unit else name for name, unit in titles.names)]
    rules = ["--:"] * (len(heads) + 1) + ["---"] * len(titles.last)
    return Lines(
        [line([titles.row, *heads, *titles.last]), line(rules)],
        lambda row: line(_cell(value, look) for value in titles.values(row)),
    )


def _table_lines(titles: Titles, look: Look, first: Sequence[Row]) -> Lines:
    """Return lines of numbers flush right, with heads and units over them."""
    names = [titles.row, *(name for name, _ in titles.names), *titles.last]
    units = ["", *(look.unit(unit) for _, unit in titles.names), *("" for _ in titles.last)]
    cells = [[_cell(value, look) for value in titles.values(row)] for row in first]
    widths = [max(map(len, column)) for column in zip(names, units, *cells)]
    if titles.last:  # a reason may be long, and nothing follows it
        widths[-1] = 0

    def line(texts: Iterable[str]) -> str:
        return "  ".join(text.rjust(width) for text, width in zip(texts, widths)).rstrip() + "\n"

    heads = [line(look.text(one) for one in each) for each in ((names, units) if any(units) else (names,))]
    rule = look.text("─") * (sum(widths) + 2 * (len(widths) - 1))
    return Lines([*heads, rule + "\n"], lambda row: line(_cell(value, look) for value in titles.values(row)))


def _cell(value: Any, look: Look) -> str:
    """Return a value as people read it, its number to four digits."""
    if isinstance(value, str):
        return look.unit(value) if isinstance(value, Unit) else look.text(value)
    if isinstance(value, tuple):
        return " ".join(_cell(one, look) for one in value)
    if value is None:
        return ""
    text, power = single(value, look.digits, look.comma)
    return f"{text}e{power}" if power else text


# where they go


def part_of(file_name: str) -> str:
    """Return the path that holds the rows of a sweep until all are there."""
    return os.path.realpath(file_name) + ".part"


class SweepOutput:
    """The output of a sweep; headed: csv with its head; kept: rows that the file has, and their bytes, which stay."""

    def __init__(
        self,
        titles: Titles,
        look: Look,
        file_name: str | None,
        headed: bool = True,
        kept: tuple[int, int] = (0, 0),
    ) -> None:
        self.titles, self._headed = titles, headed
        self.rows, self._kept = kept
        """Rows that are written, and bytes of those that were there before."""
        self._file_name = None if file_name == "-" else file_name
        self._look = look if self._file_name else replace(look, encoding=stdout_look(look).encoding)

    def write(self, rows: Iterable[Row]) -> None:
        """Write the rows; a reader that leaves early is no fault. Raises UsageError."""
        write = self._parquet_writer() if self._look.format == "parquet" else self._write_lines
        following = iter(rows)
        # before anything is opened: there may be none, for whatever reason
        first = list(islice(following, _WIDTH_OF if self._look.format == "table" else 1))
        with self._opened() as file:
            write(first, following, file)

    def left(self) -> str:
        """Return what an early end leaves, "" for nothing."""
        count = f"{self.rows} row{'s' * (self.rows > 1)}"
        if self.rows <= 0:
            return ""
        if self._file_name is None:
            return f"{count} written"
        part = part_of(self._file_name)
        return f"{part} holds {count}" if os.path.isfile(part) else ""

    @contextmanager
    def _opened(self) -> Iterator[BinaryIO]:
        path = self._file_name
        try:
            if path is None:
                sys.stdout.flush()
                yield sys.stdout.buffer
            elif target := whole_file(path):
                path = part_of(target)
                with self._part(path, target) as file:
                    yield file
                os.replace(path, target)
            else:  # a device or a pipe has no place to go to
                with open(path, "wb") as file:
                    yield file
        except BrokenPipeError:
            silence(sys.stdout)
        except OSError as error:
            raise UsageError(f"cannot write {path or 'to standard output'}: {error.strerror or error}") from None

    @contextmanager
    def _part(self, path: str, target: str) -> Iterator[BinaryIO]:
        """Yield the file at a path, after the bytes that stay; one without rows is removed."""
        if self._kept and not os.path.isfile(path):
            copyfile(target, path)
        try:
            with open(path, "r+b" if self._kept else "wb") as file:
                take_mode(path, target)
                file.seek(self._kept)
                file.truncate()
                yield file
        except BaseException:
            if self.rows <= 0:
                os.unlink(path)
            raise

    def _write_lines(self, first: list[Row], following: Iterator[Row], file: BinaryIO) -> None:
        """Write whole lines, those that are ready whenever some time has passed, and at an interrupt too."""
        lines = lines_of(self.titles, self._look, first)
        encoder = codecs.getincrementalencoder(self._look.encoding)("replace")  # one byte order mark at most
        if self._headed or self._look.format != "csv":
            file.write(encoder.encode("".join(lines.heads)))
        ready: list[bytes] = []
        written = 0.0

        def put() -> None:
            file.write(b"".join(ready))
            file.flush()
            self.rows += len(ready)
            ready.clear()

        try:
            for row in chain(first, following):
                ready.append(encoder.encode(lines.of(row)))
                if time.monotonic() - written >= _AT_LEAST_EVERY:
                    put()
                    written = time.monotonic()
        finally:
            put()

    def _parquet_writer(self) -> Callable[[list[Row], Iterator[Row], BinaryIO], None]:
        """Return what writes rows to a file as Parquet. Raises UsageError where pyarrow is missing."""
        try:
            import pyarrow
            from pyarrow import parquet
        except ImportError:
            raise UsageError("Parquet needs pyarrow: pip install 'kurbel[parquet]'") from None
        stored = {"number": pyarrow.float64(), "text": pyarrow.string(), "list": pyarrow.list_(pyarrow.float64())}
        types = [pyarrow.int64(), *(stored[one] for one in (*self.titles.types, *("text" for _ in self.titles.last)))]
        schema = pyarrow.schema(zip(self.titles.whole, types))

        def write(first: list[Row], following: Iterator[Row], file: BinaryIO) -> None:
            rows = chain(first, following)
            with parquet.ParquetWriter(file, schema) as writer:
                while group := list(islice(rows, _IN_A_GROUP)):
                    columns = zip(types, zip(*(self.titles.values(row) for row in group)))
                    arrays = [  # of words some may be read as numbers
                        pyarrow.array(
                            [None if one is None else str(one) for one in column] if type == "string" else column, type
                        )
                        for type, column in columns
                    ]
                    writer.write_table(pyarrow.table(arrays, schema=schema))
                    self.rows += len(group)

        return write


# the rows that an interrupted sweep left


class KeptRows:
    """What a file, or the part of it that an early end left, has of these rows of a sweep.

    kept: the number of its rows, and the bytes of its whole lines, which stay.
    Raises UsageError for a file that begins otherwise.
    """

    def __init__(self, file_name: str, titles: Titles, look: Look, rows: range) -> None:
        part = part_of(file_name)
        self._file_name = part if os.path.isfile(part) else file_name
        self._names, self._look, self._rows = titles.whole, look, rows
        self._lines = lines_of(titles, look)
        head = "".join(self._lines.heads) if rows.start == 0 else ""
        self._headed = bool(head)
        opening = head or '{"row": ' * (look.format == "json")
        begin, count, size = "", -self._headed, 0
        for line in self._file():
            begin = begin or line.decode("utf-8", "replace")
            if line.endswith(b"\n"):
                count, size = count + 1, size + len(line)
        if begin[: len(opening)] != opening[: len(begin)] or not (opening or begin[:1] in "0123456789"):
            self._refuse(f"it begins with {begin.rstrip(chr(10))[:60]!r}")
        self.kept = max(count, 0), size

    def _file(self) -> Iterator[bytes]:
        """Yield the lines of the file; a device or a pipe, which may have no end, keeps nothing."""
        if not os.path.isfile(self._file_name):
            return
        try:
            with open(self._file_name, "rb") as file:
                yield from file
        except OSError as error:
            raise UsageError(f"cannot read {self._file_name}: {error.strerror}") from None

    def rest(self, sweep: Sweep, conditions: Sequence[Condition]) -> range:
        """Return the rows that are still to be computed.

        Raises UsageError where the file has rows that this sweep has not, or has with other inputs or other answers:
        the inputs of each are compared, and the answers of the last one that has any.
        """
        following, last = self._rows.start, None
        first = 1 + len(sweep.plan.inputs)
        lines = self._parsed()
        while some := list(islice(lines, _COMPARED_AT_ONCE)):
            known = [row for row, _ in some if row in self._rows]
            inputs = dict(zip(known, sweep.inputs(known)))
            for row, cells in some:
                if row not in self._rows:
                    self._refuse(f"it has row {row + 1}, these are rows {self._rows.start + 1} to {self._rows.stop}")
                if row < following or (not conditions and row != following):
                    self._refuse(f"row {following + 1} is missing in it")
                self._compare(cells, [cells[0], *map(self._text, inputs[row])])
                following = row + 1
                last = cells if any(cells[first : 1 + len(sweep.heads)]) else last
        if last:
            self._compare_answers(last, sweep, conditions)
        return self._rows[following - self._rows.start :]

    def _compare_answers(self, cells: list[str], sweep: Sweep, conditions: Sequence[Condition]) -> None:
        number = int(cells[0])
        row = next(rows_of(sweep, range(number - 1, number)))
        self._compare(cells, self._cells(self._lines.of(row).rstrip("\n")))
        if not all(one.holds(row) for one in conditions):
            self._refuse(f"row {number} is in it, which --where leaves out")

    def _compare(self, cells: list[str], now: list[str]) -> None:
        """Refuse a line that begins with other cells than those of now."""
        for name, there, here in zip(self._names, cells, now):
            if there != here and not _same(there, here):
                self._refuse(f"row {cells[0]} has {there or 'no'} {name} in it, and {here or 'none'} now")

    def _parsed(self) -> Iterator[tuple[int, list[str]]]:
        """Yield the row of each whole line, counted from 0, and the texts of its cells."""
        for line in islice(self._file(), int(self._headed), None):
            text = line.decode("utf-8", "replace")
            if not text.endswith("\n"):
                return
            try:
                cells = self._cells(text.rstrip("\n"))
                row = int(cells[0]) - 1
            except (ValueError, IndexError, AttributeError, csv.Error):
                self._refuse(f"it has a line {text.rstrip(chr(10))[:60]!r}")
            yield row, cells

    def _cells(self, line: str) -> list[str]:
        """Return the texts under the heads; raises ValueError for other heads."""
        if self._look.format == "json":
            found = json.loads(line)
            names, cells = list(found), [self._text(one) for one in found.values()]
        else:
            names, cells = self._names, next(csv.reader([line], delimiter=";" if self._look.comma else ","))
        if names != self._names or len(cells) != len(names):
            raise ValueError(line)
        return cells

    def _text(self, value: Any) -> str:
        """Return the text of a cell of csv, or of a value of json."""
        if self._look.format == "csv":
            return str(csv_cell(value, self._look))
        if isinstance(value, (list, tuple)):
            return " ".join(map(repr, value))
        return "" if value is None else value if isinstance(value, str) else repr(value)

    def _refuse(self, why: str) -> NoReturn:
        raise UsageError(
            f"--resume: {self._file_name} is not of this sweep: {why}; "
            "give the same machine and options, name another file, or leave --resume out to begin anew"
        )


def _same(there: str, here: str) -> bool:
    """Return whether two cells have the same numbers, but for their last digits."""
    try:
        pairs = [[float(one.replace(",", ".")) for one in text.split()] for text in (there, here)]
    except ValueError:
        return False
    alike = (math.isclose(*pair, rel_tol=_SAME, abs_tol=_SAME) for pair in zip(*pairs))
    return len(pairs[0]) == len(pairs[1]) > 0 and all(alike)
