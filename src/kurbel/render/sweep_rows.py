"""The rows of a sweep as csv, json lines, Markdown, a table or Parquet, where they go, and those that a file has.

Whole lines are written, the first ones at once, to a file FILE.part that becomes FILE when it has all: the old file
stays until then, and an interrupted run leaves what it has, which `--resume` continues.
"""

import codecs
import csv
import json
import math
import os
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import chain, islice
from typing import BinaryIO, NamedTuple, NoReturn

from kurbel.designs.chosen import Condition, Unit
from kurbel.designs.study import Cell, Design
from kurbel.designs.sweep import Sweep
from kurbel.designs.workers import rows_of
from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.data import csv_cell, csv_line
from kurbel.render.numbers import single
from kurbel.render.output import opened, stdout_look

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

    def values(self, row: Design) -> list[Cell]:
        """Return the values of a row under the heads."""
        return [row.number, *row.values, *row.texts]


# rows as lines of text


def lines_of(titles: Titles, look: Look, first: Sequence[Design] = ()) -> tuple[str, Callable[[Design], str]]:
    """Return the lines of the heads, and what makes the line of a row.

    first: rows that decide the widths of a table.
    """
    if look.format == "csv":
        csv_row = csv_line(look)
        return (
            csv_row([csv_cell(name, look) for name in titles.whole]),
            lambda row: csv_row([csv_cell(value, look) for value in titles.values(row)]),
        )

    if look.format == "json":
        heads = titles.whole

        def json_row(row: Design) -> str:
            texts = {"": None, "yes": True, "no": False}
            found = dict(zip(heads, titles.values(row)))
            found |= {name: texts.get(text, text) for name, text in zip(titles.last, row.texts)}
            return json.dumps(found, allow_nan=False, ensure_ascii=False) + "\n"

        return "", json_row

    def cells(row: Design) -> list[str]:
        return [_cell(value, look) for value in titles.values(row)]

    names = [titles.row, *(look.text(name) for name, _ in titles.names), *titles.last]
    units = ["", *(look.unit(unit) for _, unit in titles.names), *("" for _ in titles.last)]
    if look.format == "markdown":

        def markdown_row(cells: Iterable[str]) -> str:
            escaped = (cell.replace("\\", "\\\\").replace("|", "\\|") for cell in cells)
            return f"| {' | '.join(escaped)} |\n"

        rules = ["--:"] * (len(titles.names) + 1) + ["---"] * len(titles.last)
        named = (f"{name} ({unit})" if unit else name for name, unit in zip(names, units))
        return markdown_row(named) + markdown_row(rules), lambda row: markdown_row(cells(row))

    # a table: numbers flush right, with heads and units over them
    widths = [max(map(len, column)) for column in zip(names, units, *map(cells, first))]
    if titles.last:  # a reason may be long, and nothing follows it
        widths[-1] = 0

    def table_row(texts: Iterable[str]) -> str:
        return "  ".join(text.rjust(width) for text, width in zip(texts, widths)).rstrip() + "\n"

    rule = look.text("─") * (sum(widths) + 2 * (len(widths) - 1))
    above = table_row(names) + (table_row(units) if any(units) else "")
    return f"{above}{rule}\n", lambda row: table_row(cells(row))


def _cell(value: Cell, look: Look) -> str:
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


class Kept(NamedTuple):
    """Rows that a file has already, and the bytes of their lines, which stay."""

    rows: int = 0
    size: int = 0


def write_rows(
    rows: Iterable[Design],
    titles: Titles,
    look: Look,
    file_name: str | None,
    early: Callable[[str], None],
    headed: bool = True,
    kept: Kept = Kept(),  # noqa: B008 (immutable)
) -> None:
    """Write the rows; a reader that leaves early is no fault. Raises UsageError.

    headed: csv with its head; early: gets a sentence about what an early end leaves.
    """
    to_file = file_name is not None and file_name != "-"
    if not to_file:
        look = replace(look, encoding=stdout_look(look).encoding)
    following = iter(rows)
    counts = [kept.rows]
    try:
        # before anything is opened: there may be none, for whatever reason
        first = list(islice(following, _WIDTH_OF if look.format == "table" else 1))
        with opened(file_name, resumed=kept.size) as file:
            if look.format == "parquet":
                _write_parquet(file, titles, chain(first, following), counts.append)
            else:
                heads, line = lines_of(titles, look, first)
                lines = map(line, chain(first, following))
                _write_lines(file, heads if headed or look.format != "csv" else "", lines, look.encoding, counts.append)
    except BaseException:
        count = sum(counts)
        some = f"{count} row{'s' * (count > 1)}"
        if count and not to_file:
            early(f"{some} written")
        elif count and os.path.isfile(part := _part_of(str(file_name))):
            early(f"{part} holds {some}")
        raise


def _part_of(file_name: str) -> str:
    return os.path.realpath(file_name) + ".part"


def _write_lines(file: BinaryIO, heads: str, lines: Iterable[str], encoding: str, wrote: Callable[[int], None]) -> None:
    """Write whole lines, those that are ready whenever some time has passed, and at an interrupt too."""
    encoder = codecs.getincrementalencoder(encoding)("replace")  # one byte order mark at most
    file.write(encoder.encode(heads))
    ready: list[bytes] = []
    due = 0.0

    def put() -> None:
        file.write(b"".join(ready))
        file.flush()
        wrote(len(ready))
        ready.clear()

    try:
        for line in lines:
            ready.append(encoder.encode(line))
            if time.monotonic() >= due:
                put()
                due = time.monotonic() + _AT_LEAST_EVERY
    finally:
        put()


def _write_parquet(file: BinaryIO, titles: Titles, rows: Iterator[Design], wrote: Callable[[int], None]) -> None:
    """Write rows as Parquet. Raises UsageError where pyarrow is missing."""
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        raise UsageError("Parquet needs pyarrow: pip install 'kurbel[parquet]'") from None
    stored = {"number": pyarrow.float64(), "text": pyarrow.string(), "list": pyarrow.list_(pyarrow.float64())}
    types = [pyarrow.int64(), *(stored[one] for one in (*titles.types, *("text" for _ in titles.last)))]
    schema = pyarrow.schema(zip(titles.whole, types))
    with parquet.ParquetWriter(file, schema) as writer:
        while group := list(islice(rows, _IN_A_GROUP)):
            arrays = []
            for type, column in zip(types, zip(*map(titles.values, group))):
                if type == "string":  # of words some may be read as numbers
                    column = tuple(None if one is None else str(one) for one in column)
                arrays.append(pyarrow.array(column, type))
            writer.write_table(pyarrow.table(arrays, schema=schema))
            wrote(len(group))


# the rows that an interrupted sweep left


def kept_rows(
    file_name: str, sweep: Sweep, titles: Titles, look: Look, rows: range, conditions: Sequence[Condition]
) -> tuple[Kept, range]:
    """Return what a file, or the part of it that an early end left, has of these rows, and those still to be computed.

    Raises UsageError for a file that begins otherwise, or that has rows that this sweep has not, or with other inputs
    or other answers: the inputs of each are compared, and the answers of the last one that has any.
    """
    path = part if os.path.isfile(part := _part_of(file_name)) else file_name
    if not os.path.isfile(path):  # a device or a pipe, which may have no end, keeps nothing
        return Kept(), rows
    heads, line_of = lines_of(titles, look)
    head = heads if rows.start == 0 else ""

    def refuse(why: str) -> NoReturn:
        raise UsageError(
            f"--resume: {path} is not of this sweep: {why}; "
            "give the same machine and options, name another file, or leave --resume out to begin anew"
        )

    def compare(cells: Sequence[str], now: Sequence[str]) -> None:
        for name, there, here in zip(titles.whole, cells, now):
            if there != here and not _same(there, here):
                refuse(f"row {cells[0]} has {there or 'no'} {name} in it, and {here or 'none'} now")

    count, following, last = 0, rows.start, list[str]()
    try:
        with open(path, "rb") as file:
            begin = next(file, b"")
            opening = (head or '{"row": ' * (look.format == "json")).encode()
            if begin[: len(opening)] != opening[: len(begin)] or not (opening or begin[:1] in b"0123456789"):
                refuse(f"it begins with {begin.decode('utf-8', 'replace').rstrip(chr(10))[:60]!r}")
            size = len(begin) if head and begin.endswith(b"\n") else 0
            file.seek(size)

            whole = (line for line in file if line.endswith(b"\n"))
            while lines := list(islice(whole, _COMPARED_AT_ONCE)):
                some = []
                for line in lines:
                    if not (cells := _cells(line.decode("utf-8", "replace"), titles, look)):
                        refuse(f"it has a line {line.decode('utf-8', 'replace').rstrip()[:60]!r}")
                    some.append((int(cells[0]) - 1, cells))
                inputs = iter(sweep.inputs([row for row, _ in some if row in rows]))
                for row, cells in some:
                    if row not in rows:
                        refuse(f"it has row {row + 1}, these are rows {rows.start + 1} to {rows.stop}")
                    if row < following or (not conditions and row != following):
                        refuse(f"row {following + 1} is missing in it")
                    compare(cells, [cells[0], *(_cell_text(one, look) for one in next(inputs))])
                    following = row + 1
                    last = cells if any(cells[1 + len(sweep.plan.inputs) : 1 + len(sweep.heads)]) else last
                count, size = count + len(lines), size + sum(map(len, lines))
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from None

    if last:
        computed = next(rows_of(sweep, range(int(last[0]) - 1, int(last[0]))))
        compare(last, _cells(line_of(computed), titles, look))
        if not all(one.holds(computed) for one in conditions):
            refuse(f"row {last[0]} is in it, which --where leaves out")
    return Kept(count, size), rows[following - rows.start :]


def _cells(line: str, titles: Titles, look: Look) -> list[str]:
    """Return the texts of the cells of a line; none of a line that no row of these titles has."""
    try:
        if look.format == "csv":
            found = next(csv.reader([line], delimiter=";" if look.comma else ","), [])
        else:
            values = dict(json.loads(line))
            each = [tuple(one) if isinstance(one, list) else one for one in values.values()]
            found = [_cell_text(one, look) for one in each] if list(values) == titles.whole else []
    except (csv.Error, ValueError, TypeError):
        return []
    return found if len(found) == len(titles.whole) and found[0].isdecimal() else []


def _cell_text(value: Cell, look: Look) -> str:
    cell = csv_cell(value, look)
    return "" if cell is None else str(cell)


def _same(there: str, here: str) -> bool:
    """Return whether two cells have the same numbers, but for their last digits."""
    try:
        pairs = [[float(one.replace(",", ".")) for one in text.split()] for text in (there, here)]
    except ValueError:
        return False
    alike = (math.isclose(*pair, rel_tol=_SAME, abs_tol=_SAME) for pair in zip(*pairs))
    return len(pairs[0]) == len(pairs[1]) > 0 and all(alike)
