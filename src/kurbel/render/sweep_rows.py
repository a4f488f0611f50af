"""The rows of a sweep as csv, json lines, Markdown, a table or Parquet, where they go, and what `kurbel find` prints.

A table and Markdown are written when all rows are there. Of csv and JSON whole lines are written, the first ones at
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

import numpy as np

import kurbel
from kurbel.declared.unit_systems import SI, convert, shown_unit
from kurbel.designs.answers import Cell, Design
from kurbel.designs.chosen import RowCondition, Unit
from kurbel.designs.find import Solutions
from kurbel.designs.sweep import Sweep, computed_rows
from kurbel.errors import UsageError
from kurbel.pictures.picture import Axis, Curve, Mark, PageFigure, Panel, Picture, Words
from kurbel.pictures.picture_source import in_units, level
from kurbel.render import Look
from kurbel.render.csv_text import csv_cell, csv_line
from kurbel.render.json_text import FORMAT
from kurbel.render.markup import Markdown, written
from kurbel.render.output import look_at, opened, write_out
from kurbel.render.page import blocks
from kurbel.render.text import plain_lines, single
from kurbel.render.text_tables import TextColumn, TextTable

_AT_LEAST_EVERY = 0.5
"""Seconds after which lines that are ready are written."""
_IN_A_GROUP = 10_000
"""Rows of a group of a Parquet file."""
_COMPARED_AT_ONCE = 100
"""Rows of a file whose inputs are compared together."""
_NUMBER = re.compile(rb'(?:\{"row": )?(\d+)\b')
_WORD = re.compile(r'[^,;\s"{}\[\]]+')
"""The number of a row at the beginning of its line, and the names, numbers and words in it, in csv and in json."""
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


def head_and_row_lines(titles: Titles, look: Look) -> tuple[str, Callable[[Design], str]]:
    """Return the line of the heads, and what makes the line of a row, in csv or as JSON."""
    if look.format == "csv":
        csv_row = csv_line(look)
        head = csv_row([csv_cell(name, look) for name in titles.whole])
        return head, lambda row: csv_row([csv_cell(value, look) for value in titles.values(row)])

    def json_row(row: Design) -> str:
        said = {"": None, "yes": True, "no": False}
        found = dict(zip(titles.whole, titles.values(row)))
        found |= {name: said.get(text, text) for name, text in zip(titles.last, row.texts)}
        return json.dumps(found, allow_nan=False, ensure_ascii=False) + "\n"

    return "", json_row


def _for_people(titles: Titles, look: Look, rows: Sequence[Design]) -> Iterator[str]:
    """Return rows as a table of text or of Markdown."""
    heads = [(titles.row, ""), *titles.names, *((name, "") for name in titles.last)]
    cells = [[_cell(value, look) for value in titles.values(row)] for row in rows]
    columns = [
        TextColumn(
            look.text(name),
            look.unit(unit),
            [row[k] for row in cells],
            "name" if name in titles.last else "number",
        )
        for k, (name, unit) in enumerate(heads)
    ]
    if look.format == "markdown":
        return iter(["".join(written([TextTable("", columns, 1)], Markdown(look))).lstrip("\n")])
    return plain_lines(blocks(columns[:1], columns[1:], look))


def _cell(value: Cell, look: Look) -> str:
    """Return a value as people read it, its number to four digits."""
    if isinstance(value, str):
        return look.unit(value) if isinstance(value, Unit) else look.text(value)
    if isinstance(value, tuple):
        return " ".join(_cell(one, look) for one in value)
    if value is None:
        return ""
    text, power = single(value, look.digits)
    return look.number(f"{text}e{power}" if power else text)


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
    look = look_at(file_name, look)
    if look.format in ("table", "markdown"):
        write_out(_for_people(titles, look, list(rows)), file_name, look.encoding)
        return
    count = kept.rows

    def counted() -> Iterator[Design]:
        nonlocal count
        for row in rows:
            yield row
            count += 1  # it is written when the next one is wanted

    following = counted()
    try:
        first = list(
            islice(following, 1)
        )  # before anything is opened: there may be none, for whatever reason
        with opened(file_name, resumed=kept.size) as file:
            if look.format == "parquet":
                _write_parquet(file, titles, chain(first, following))
            else:
                heads, line = head_and_row_lines(titles, look)
                texts = chain([heads] if headed else [], map(line, chain(first, following)))
                _write_lines(file, texts, look.encoding)
    except BaseException:
        some = f"{count} row{'s' * (count > 1)}"
        if count and not to_file:
            early(f"{some} written")
        elif (
            count and look.format != "parquet" and os.path.isfile(part := _part_of(str(file_name)))
        ):
            early(f"{part} holds {some}")
        raise


def _part_of(file_name: str) -> str:
    return os.path.realpath(file_name) + ".part"


def _write_lines(file: BinaryIO, lines: Iterable[str], encoding: str) -> None:
    """Write lines, the first ones at once, and those that are ready whenever some time has passed."""
    encoder = codecs.getincrementalencoder(encoding)("replace")  # one byte order mark at most
    due = 0.0
    for line in lines:
        file.write(encoder.encode(line))
        if time.monotonic() >= due:
            file.flush()
            due = time.monotonic() + _AT_LEAST_EVERY


def _write_parquet(file: BinaryIO, titles: Titles, rows: Iterator[Design]) -> None:
    """Write rows as Parquet. Raises UsageError where pyarrow is missing."""
    try:
        import pyarrow.parquet
    except ImportError:
        raise UsageError("Parquet needs pyarrow: pip install 'kurbel[parquet]'") from None
    stored = {
        "number": pyarrow.float64(),
        "text": pyarrow.string(),
        "list": pyarrow.list_(pyarrow.float64()),
    }
    types = [
        pyarrow.int64(),
        *(stored[one] for one in (*titles.types, *("text" for _ in titles.last))),
    ]
    schema = pyarrow.schema(zip(titles.whole, types))
    with pyarrow.parquet.ParquetWriter(file, schema) as writer:
        while group := list(islice(rows, _IN_A_GROUP)):
            arrays = []
            for type, column in zip(types, zip(*map(titles.values, group))):
                if type == "string":  # of words some may be read as numbers
                    column = tuple(None if one is None else str(one) for one in column)
                arrays.append(pyarrow.array(column, type))
            writer.write_table(pyarrow.table(arrays, schema=schema))


# the rows that an interrupted sweep left


def kept_rows(
    file_name: str,
    sweep: Sweep,
    titles: Titles,
    look: Look,
    rows: range,
    conditions: Sequence[RowCondition],
) -> tuple[Kept, range]:
    """Return what a file, or the part of it that an early end left, has of these rows, and those still to be computed.

    Raises UsageError for a file that begins otherwise, or that has rows that this sweep has not, or with other inputs
    or other answers: the inputs of each row are compared, and the answers of the last one.
    """
    path = part if os.path.isfile(part := _part_of(file_name)) else file_name
    if not os.path.isfile(path):  # a device or a pipe, which may have no end, keeps nothing
        return Kept(), rows
    heads, line_of = head_and_row_lines(titles, look)
    head = heads.encode() if rows.start == 0 else b""
    begin_of = head_and_row_lines(
        Titles(titles.names[: len(sweep.plan.inputs)], row=titles.row), look
    )[1]

    def refuse(why: str) -> NoReturn:
        raise UsageError(
            f"--resume: {path} is not of this sweep: {why}; "
            "give the same machine and options, name another file, or leave --resume out to begin anew"
        )

    def compare(row: int, there: list[str], here: list[str]) -> None:
        for one, other in zip_longest(there, here, fillvalue="nothing"):
            if not _same(one, other):
                refuse(f"row {row} has {one} in it, and {other} now")

    count, following, last = 0, rows.start, b""
    try:
        with open(path, "rb") as file:
            begin = next(file, b"")
            if not (
                head.startswith(begin)
                if head
                else _NUMBER.match(begin) or b'{"row": '.startswith(begin)
            ):
                refuse(f"it begins with {_shown(begin)}")
            size = len(head) if begin == head else 0
            file.seek(size)
            while lines := [
                line for line in islice(file, _COMPARED_AT_ONCE) if line.endswith(b"\n")
            ]:
                numbers = []
                for line in lines:
                    number = _NUMBER.match(line) or refuse(f"it has a line {_shown(line)}")
                    row = int(number[1]) - 1
                    if row not in rows:
                        refuse(
                            f"it has row {row + 1}, these are rows {rows.start + 1} to {rows.stop}"
                        )
                    if row < following or (not conditions and row != following):
                        refuse(f"row {following + 1} is missing in it")
                    numbers.append(row)
                    following = row + 1
                for row, line, inputs in zip(numbers, lines, sweep.inputs(numbers)):
                    here = _WORD.findall(begin_of(Design(row + 1, inputs)))
                    compare(row + 1, _words(line)[: len(here)], here)
                count, size, last = count + len(lines), size + sum(map(len, lines)), lines[-1]
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from None

    if last:
        computed = next(computed_rows(sweep, range(following - 1, following)))
        compare(following, _words(last), _WORD.findall(line_of(computed)))
        if not all(condition.holds(computed) for condition in conditions):
            refuse(f"row {following} is in it, which --where leaves out")
    return Kept(count, size), rows[following - rows.start :]


def _shown(line: bytes) -> str:
    return repr(line.decode("utf-8", "replace").rstrip("\n")[:60])


def _words(line: bytes) -> list[str]:
    return _WORD.findall(line.decode("utf-8", "replace"))


def _same(one: str, other: str) -> bool:
    """Return whether two words are equal, or numbers but for their last digits."""
    try:
        return one == other or math.isclose(float(one), float(other), rel_tol=_SAME, abs_tol=_SAME)
    except ValueError:
        return False


# what kurbel find prints


def as_rows(found: Solutions, system: str) -> tuple[Titles, list[Design]]:
    """Return a row for each solution: the keys in the units of their ranges, and the key values."""
    units = [(one.key, one.kind, one.unit) for one in found.varied]
    largest = [max(map(abs, values)) for values in zip(*(one.key_values for one in found.found))]
    units += [
        (one.id, one.kind, shown_unit(one.kind, system, size))
        for one, size in zip(found.heads, largest)
    ]
    rows = [
        Design(number, tuple(float(convert(value, *of)) for value, (_, *of) in zip(values, units)))
        for number, values in enumerate(((*one.values, *one.key_values) for one in found.found), 1)
    ]
    return Titles(tuple((name, unit) for name, _, unit in units)), rows


def as_json(found: Solutions) -> dict[str, object]:
    """Return the findings for JSON, all in SI."""
    quantities = [one.quantity for one in found.answers]
    answers = [
        {"id": one.id, "symbol": of.symbol, "unit": one.unit}
        for one, of in zip(found.heads, quantities)
    ]
    ranges = [list(span) for span in found.met]
    return {
        "kurbel": kurbel.__version__,
        "format": FORMAT,
        "command": "find",
        "machine": found.machine,
        "varied": [
            {"key": one.key, "low": one.low, "high": one.high, "unit": SI[one.kind]}
            for one in found.varied
        ],
        "wanted": [
            {"id": one.head.id, "unit": one.head.unit, "aim": one.aim, "value": one.value}
            for one in found.wanted
        ],
        "found": [
            {
                "values": list(one.values),
                "key_values": [
                    {**answer, "value": value} for answer, value in zip(answers, one.key_values)
                ],
                "notes": list(one.notes),
            }
            for one in found.found
        ],
        "range": ranges[0] if len(ranges) == 1 else ranges,
        "jumps": [list(jump.values) for jump in found.jumps],
        "failed": [{"low": one.low, "high": one.high, "failure": one.why} for one in found.failed],
    }


def picture(found: Solutions, system: str) -> Picture:
    """Return the wanted key value over the only key, with the solutions, and gaps at jumps and where designs fail."""
    key, wanted = found.varied[0], found.wanted[0]
    places, values = found.places[:, 0], found.values[:, wanted.place]
    # one nan at a jump, two for a design that fails
    places, values = (np.repeat(one, 1 + np.isnan(values)) for one in (places, values))
    jumps = np.searchsorted(places, [jump.values[0] for jump in found.jumps])
    x, y = np.insert(places, jumps, np.nan), np.insert(values, jumps, np.nan)
    x = np.where(np.isnan(y), np.nan, x)
    quantity = found.answers[wanted.place].quantity
    symbol = Words(quantity.symbol, quantity.ascii_symbol)
    curves = [Curve(symbol, x, y)]
    if wanted.value is not None:
        curves.append(level(x, wanted.value, Words(wanted.text)))
    name = Words(key.key.rpartition(".")[2])
    marks = tuple(
        Mark(
            one.values[0],
            one.key_values[wanted.place],
            PageFigure(name, one.values[0], kind=key.kind),
        )
        for one in found.found
    )
    across, up = (
        Axis(Words(key.key), key.kind, low=key.low, high=key.high),
        Axis(symbol, wanted.head.kind),
    )
    panel = in_units(Panel(across, up, tuple(curves), marks=marks), system)
    text = "The key value over the key; marked where it is as wanted, parted where it jumps or designs fail."
    return Picture("find", f"{wanted.head.id} over {key.key}", text, (panel,), found.machine)


def remarks(found: Solutions) -> list[str]:
    """Return the remarks on the solutions, a line each."""
    key = found.varied[0]
    lines = [
        f"solution {number}: {note}"
        for number, one in enumerate(found.found, 1)
        for note in one.notes
    ]
    for jump in found.jumps:
        place = key.written(jump.values[0], figures=9)
        lines.append(f"{found.wanted[0].text}: passed by a jump at {key.key} = {place}")
    for part in found.failed:
        where = "at" if part.low == part.high else f"from {key.in_unit(part.low):.6g} to"
        lines.append(f"{key.key} {where} {key.written(part.high)}: designs fail: {part.why}")
    return lines
