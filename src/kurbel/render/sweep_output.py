"""The rows of a sweep, as csv, json lines, Markdown, a table or Parquet, and where they go.

Whole lines are written, the first ones at once, to a file FILE.part that becomes FILE when it has all: what was there
stays until then, and an interrupted run keeps its own.
"""

import json
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from itertools import chain, islice
from typing import Any, NamedTuple

from kurbel.designs.chosen import Unit
from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.csv_text import _harmless, _quoted
from kurbel.render.numbers import decimal, exact, single
from kurbel.render.output import silence, stdout_look, take_mode, whole_file

_AT_LEAST_EVERY = 0.5
"""Seconds after which lines that are ready are written."""
_IN_A_GROUP = 10_000
"""Rows of a group of a Parquet file."""
_WIDTH_OF = 20
"""Rows whose widths tell those of the columns of a table; what is wider afterwards moves its row."""


class Titles(NamedTuple):
    """Names of the columns with their units, in order, and the heads of the texts after the values.

    row: what a row is called by; types: see `Sweep.types`, which only Parquet asks for.
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

    def values(self, row: Any) -> list[Any]:
        """Return what stands in a row under the heads."""
        return [row.number, *row.values, *map(row.text, self.last)]


def csv_rows(titles: Titles, rows: Iterable[Any], look: Look) -> Iterator[str]:
    """Yield the rows as CSV; a list stands in one cell, its values parted by blanks."""
    separator = ";" if look.comma else ","
    yield separator.join(_quoted(_harmless(name), separator) for name in titles.whole) + "\n"
    plain = float if look.digits is None and not look.comma else None
    for row in rows:
        cells = [
            # most are numbers in full, which `exact` writes like this in five times the time
            repr(value + 0.0) if type(value) is plain else _csv_cell(value, look, separator)
            for value in titles.values(row)
        ]
        yield separator.join(cells) + "\n"


def _csv_cell(value: Any, look: Look, separator: str) -> str:
    text = _cell(value, look, in_full=True)
    # a number is never quoted, so that none is looked at twice
    return _quoted(text, separator) if isinstance(value, str) else text


def json_rows(titles: Titles, rows: Iterable[Any], look: Look) -> Iterator[str]:
    """Yield one object a line, whose keys are the heads of csv."""
    names = titles.whole
    for row in rows:
        told = {"keeps": row.keeps, "broken": row.broken or None, "failure": row.failure or None}
        found = {name: told.get(name, value) for name, value in zip(names, titles.values(row))}
        yield json.dumps(found, allow_nan=False, ensure_ascii=False) + "\n"


def markdown_rows(titles: Titles, rows: Iterable[Any], look: Look) -> Iterator[str]:
    """Yield a table in Markdown, numbers to four digits."""
    heads = [*(f"{name} ({look.charset.unit(unit)})" if unit else name for name, unit in titles.names)]
    rules = ["--:"] * (len(heads) + 1) + ["---"] * len(titles.last)
    for line in ([titles.row, *heads, *titles.last], rules):
        yield f"| {' | '.join(map(_escaped, line))} |\n"
    for row in rows:
        yield f"| {' | '.join(_escaped(_cell(value, look)) for value in titles.values(row))} |\n"


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace("|", "\\|")


def _cell(value: Any, look: Look, in_full: bool = False) -> str:
    """Return a value as text, its number to four digits, or in full as csv has it."""
    if value is None:
        return ""
    if isinstance(value, Unit) and not in_full:
        return look.charset.unit(value)
    if isinstance(value, str):
        return _harmless(look.charset.text(value)) if in_full else look.charset.text(value)
    if isinstance(value, tuple):
        return " ".join(_cell(one, look, in_full) for one in value)
    if in_full:
        return decimal(exact(value, look.digits), look.comma)
    text, power = single(value, look.digits, look.comma)
    return f"{text}e{power}" if power else text


def table_rows(titles: Titles, rows: Iterable[Any], look: Look) -> Iterator[str]:
    """Yield a table of numbers to four digits, flush right, heads and units over it."""
    names = [titles.row, *(name for name, _ in titles.names), *titles.last]
    units = ["", *(look.charset.unit(unit) for _, unit in titles.names), *("" for _ in titles.last)]
    following = iter(rows)
    first = [[_cell(value, look) for value in titles.values(row)] for _, row in zip(range(_WIDTH_OF), following)]
    widths = [max(map(len, column)) for column in zip(names, units, *first)]
    if titles.last:  # a reason may be long, and nothing stands after it
        widths[-1] = 0
    rule = look.charset.text("─") * (sum(widths) + 2 * (len(widths) - 1))
    for cells in (names, units) if any(units) else (names,):
        yield _line([look.charset.text(cell) for cell in cells], widths)
    yield rule + "\n"
    for cells in first:
        yield _line(cells, widths)
    for row in following:
        yield _line([_cell(value, look) for value in titles.values(row)], widths)


def _line(cells: Sequence[str], widths: Sequence[int]) -> str:
    return "  ".join(cell.rjust(width) for cell, width in zip(cells, widths)).rstrip() + "\n"


WRITERS: dict[str, Callable[..., Iterator[str]]] = {
    "csv": csv_rows,
    "json": json_rows,
    "markdown": markdown_rows,
    "table": table_rows,
}


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
        self.titles = titles
        self.rows, self._kept = kept
        """Rows that are written, and bytes of those that were there before."""
        self._file_name = None if file_name == "-" else file_name
        self._look = look if self._file_name else replace(look, encoding=stdout_look().encoding)
        self._headed = headed

    def write(self, rows: Iterable[Any]) -> None:
        """Write the rows; a reader that leaves early is no fault. Raises UsageError."""
        write = self._write_parquet() if self._look.format == "parquet" else self._write_lines
        following = iter(rows)
        first = list(islice(following, 1))  # before anything is opened: there may be none, for whatever reason
        with self._opened() as file:
            write(chain(first, following), file)

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
    def _opened(self) -> Iterator[Any]:
        path = self._file_name
        try:
            if path is None:
                sys.stdout.flush()
                yield getattr(sys.stdout, "buffer", sys.stdout)
            elif target := whole_file(path):
                path = part_of(target)
                with self._part(path, target) as file:
                    yield file
                os.replace(path, target)
            else:  # a device or a pipe begins anew by itself and has no place to go to
                with open(path, "wb") as file:
                    yield file
        except BrokenPipeError:
            silence(sys.stdout)
        except OSError as error:
            where = path or "to standard output"
            raise UsageError(f"cannot write {where}: {error.strerror or error}") from None

    @contextmanager
    def _part(self, path: str, target: str) -> Iterator[Any]:
        """Yield the file at a path, after the bytes that stay; one without rows goes again."""
        if self._kept and not os.path.isfile(path):
            from shutil import copyfile

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

    def _write_lines(self, rows: Iterable[Any], file: Any) -> None:
        """Write whole lines, those that are ready whenever some time has passed, and at an interrupt too."""
        writer = WRITERS[self._look.format]
        texts, heads = writer(self.titles, rows, self._look), len(list(writer(self.titles, (), self._look)))
        if self._look.format == "csv" and not self._headed:
            next(texts)
            heads = 0
        ready: list[bytes] = []
        written = 0.0
        self.rows -= heads

        def put() -> None:
            lines, count = b"".join(ready), len(ready)
            ready.clear()
            file.write(lines)
            file.flush()
            self.rows += count

        try:
            for text in texts:
                ready.append(text.encode(self._look.encoding, "replace"))
                if time.monotonic() - written >= _AT_LEAST_EVERY:
                    put()
                    written = time.monotonic()
        finally:
            put()

    def _write_parquet(self) -> Callable[[Iterable[Any], Any], None]:
        """Return what writes rows to a file as Parquet. Raises UsageError where pyarrow is missing."""
        try:
            import pyarrow
            from pyarrow import parquet
        except ImportError:
            raise UsageError("Parquet needs pyarrow: pip install 'kurbel[parquet]'") from None
        names, types = self.titles.whole, ("number", *self.titles.types, *("text" for _ in self.titles.last))
        stored = {"number": pyarrow.float64(), "text": pyarrow.string(), "list": pyarrow.list_(pyarrow.float64())}
        fields = {name: stored[one] for name, one in zip(names, types)} | {names[0]: pyarrow.int64()}
        schema = pyarrow.schema(list(fields.items()))

        def write(rows: Iterable[Any], file: Any) -> None:
            following = iter(rows)
            with parquet.ParquetWriter(file, schema) as writer:
                while group := list(islice(following, _IN_A_GROUP)):
                    columns = zip(*(self.titles.values(row) for row in group))
                    found = dict(zip(names, map(_column, columns, types)))
                    writer.write_table(pyarrow.table(found, schema=schema))
                    self.rows += len(group)

        return write


def _column(values: tuple[Any, ...], type: str) -> list[Any]:
    """Return the values of a column as what is stored of them: texts, numbers, or lists of them."""
    as_stored: dict[str, Callable[[Any], Any]] = {"text": str, "number": lambda one: one, "list": list}
    return [None if one is None else as_stored[type](one) for one in values]
