"""First pass of every printed format: the values of a report as tables of text, with their digits, units and marks."""

import re
from collections.abc import Callable, Collection, Iterator, Sequence
from itertools import groupby
from typing import Any, NamedTuple

from kurbel.quantity import NOISE_POWER
from kurbel.render import Look
from kurbel.render.numbers import Scale, alone, angle, angle_scale, cell, decimal, scale_of, single, whole_if_integral
from kurbel.render.text import width
from kurbel.report.tables import Column, KeyValue, Part, PlaceTable, Report, Value

MARK = "*"
_MOST_LISTED = 12


class TextColumn(NamedTuple):
    """A column as text. Its cells are made when they are read: a table of a million rows is never held.

    width: of the widest cell; kind: `number`, `name`, `symbol` or `sentence`; marked: rows that end in MARK, where all
    others end in `pad`.
    """

    symbol: str
    unit: str
    values: Sequence[Any]
    width: int
    text: Callable[[Any], str] = str
    kind: str = "number"
    marked: Collection[int] = ()
    pad: str = ""

    @property
    def whole_width(self) -> int:
        """Width of the widest of its cells, symbol and unit."""
        return max(width(self.symbol), width(self.unit), self.width)

    @property
    def words(self) -> bool:
        """Whether it holds words, which are flush left."""
        return self.kind != "number"

    def cells(self, start: int = 0, stop: int | None = None) -> Iterator[str]:
        """Yield the texts of these rows, of all by default."""
        for row in range(len(self.values))[start:stop]:
            yield self.text(self.values[row]) + (MARK if row in self.marked else self.pad)


def texts(symbol: str, unit: str, cells: Sequence[str], kind: str = "number") -> TextColumn:
    """Return a column of texts."""
    return TextColumn(symbol, unit, cells, max(map(width, cells), default=0), kind=kind)


class TextTable(NamedTuple):
    """A table for markup; heads: how many of its columns name the rows.

    verdicts: `good`, `bad` or "" of each row, or none at all; lists: rows whose value is a list, which may be folded.
    """

    caption: str
    columns: Sequence[TextColumn]
    heads: int = 0
    verdicts: Sequence[str] = ()
    lists: Collection[int] = ()


# tables over the crank angle


class Sheet(NamedTuple):
    """Parts of a report over the same crank angles: heads hold the angles, bands each part by its name.

    named_beside: the names are short and have a column of their own, as L/R in the book.
    """

    heads: list[TextColumn]
    bands: list[tuple[str, list[TextColumn]]]
    named_beside: bool


def sheets(report: Report, look: Look) -> Iterator[Sheet]:
    """Yield one sheet for each run of parts with the same crank angles."""
    parts = [part for part in report.all_parts if part.columns]
    for _, run in groupby(parts, lambda part: part.columns[0].values):
        yield _sheet(report, list(run), look)


def _sheet(report: Report, parts: list[Part], look: Look) -> Sheet:
    pad = " " if any(column.marked for part in parts for column in part.columns) else ""
    phi = parts[0].columns[0]
    angles = [phi]
    if report.mirrored:
        values = tuple(None if value is None else 360 - value for value in phi.values)
        symbol, ascii_symbol = f"360° − {phi.symbol}", f"360 - {phi.ascii_symbol}"
        angles.append(phi._replace(symbol=symbol, ascii_symbol=ascii_symbol, values=values))
    heads = [_numbers(one, angle_scale(one.values), look, pad) for one in angles]
    bands = [
        (part_name(report, part, look), [_numbers(one, _scale(one, look), look, pad) for one in part.columns[1:]])
        for part in parts
    ]
    return Sheet(heads, bands, report.group == "ratios")


def part_name(report: Report, part: Part, look: Look) -> str:
    """Return the heading of the results of a part; nothing for the only one, which the title names."""
    if part is not report.whole and report.group == "ratios":
        ratio = str(whole_if_integral(float(part.name))).replace("inf", "∞")
        return look.text(f"L/R = {decimal(ratio, look.comma)}")
    return look.text(str(part.name)) if len(report.all_parts) > 1 else ""


def _scale(column: Column, look: Look) -> Scale:
    if column.decimals is not None:
        return Scale(column.decimals)
    return scale_of((column.size,) if column.size else column.values, look.digits)


def _numbers(column: Column, scale: Scale, look: Look, pad: str) -> TextColumn:
    """Return a column whose cells all have the same decimals: the largest or the smallest value is the widest."""

    def text(value: Value) -> str:
        return cell(value, scale, look.comma)

    ends = (end((value for value in column.values if value is not None), default=None) for end in (min, max))
    wide = max(len(text(end)) for end in ends) + len(pad)
    symbol = look.symbol(column.symbol, column.ascii_symbol)
    unit = look.unit(column.unit, scale.exponent)
    return TextColumn(symbol, unit, column.values, wide, text, marked=frozenset(column.marked), pad=pad)


# tables of named places


def place_table(table: PlaceTable, look: Look) -> tuple[list[TextColumn], list[TextColumn]]:
    """Return the names of the rows, and the columns; those of one unit share their scale, to be compared by eye.

    Columns with decimals or digits of their own do not.
    """
    blank = "_" if table.headed else " "
    names = [
        texts(head, "", [look.text(name.replace("_", blank)) for name in column], "name")
        for head, column in zip(table.heads, zip(*table.names))
    ]
    sharing: dict[str, list[Value]] = {}
    for column in table.columns:
        if column.decimals is None and not column.alone:
            sharing.setdefault(column.unit, []).extend(column.values)
    scales = {unit: scale_of(values, look.digits) for unit, values in sharing.items()}
    return names, [_place_column(column, scales, look) for column in table.columns]


def _place_column(column: Column, scales: dict[str, Scale], look: Look) -> TextColumn:
    own = column.decimals is not None
    scale = Scale(column.decimals or 0) if own or column.alone else scales[column.unit]

    def text(value: Value) -> str:
        if value is None:
            return look.text("–")
        if column.alone and not own:
            return look.counted(*alone(value, look.digits or column.alone, look.comma))
        if column.unit == "deg" and not own:
            return angle(value, look.comma)
        return cell(value, scale, look.comma)

    exponent = 0 if column.unit == "deg" else scale.exponent
    symbol = look.symbol(column.symbol, column.ascii_symbol)
    return texts(symbol, look.unit(column.unit, exponent), [text(value) for value in column.values])


# key values


class KeyValueText(NamedTuple):
    """A key value as text; at: the crank angle of an extreme; single: it is one number, to be aligned with others."""

    symbol: str
    number: str
    unit: str
    at: str
    sentence: str
    single: bool


def key_value_text(one: KeyValue, look: Look) -> KeyValueText:
    """Return a key value as text: a number with its power of ten, or the numbers of a list, of a long one its ends."""

    def text(value: float) -> str:
        if one.unit == "deg" and (look.digits is None or isinstance(one.value, tuple)):
            return angle(value, look.comma)
        return look.counted(*single(value, look.digits, look.comma))

    if one.value is None or one.value == ():
        number = look.text("–")
    elif one.noise:
        number = look.below(NOISE_POWER)
    elif not isinstance(one.value, tuple):
        number = text(one.value)
    elif len(one.value) > _MOST_LISTED:
        number = f"{len(one.value)} from {text(min(one.value))} to {text(max(one.value))}"
    else:
        number = ("; " if look.comma else ", ").join(map(text, one.value))
    return KeyValueText(
        look.symbol(one.symbol, one.ascii_symbol),
        number,
        look.unit(one.unit),
        "" if one.at_deg is None else angle(one.at_deg, look.comma) + look.text("°"),
        sentence_text(one.text, look),
        not isinstance(one.value, tuple) and one.value is not None and not one.noise,
    )


def key_value_table(caption: str, found: Collection[KeyValue], look: Look) -> TextTable:
    """Return key values as a table: symbol, value, unit, crank angle, meaning."""
    rows = [key_value_text(one, look) for one in found]
    columns = [
        texts("Symbol", "", [row.symbol for row in rows], "symbol"),
        texts("Value", "", [row.number for row in rows]),
        texts("Unit", "", [row.unit for row in rows], "name"),
        texts("At", "", [row.at for row in rows]),
        texts("Meaning", "", [row.sentence for row in rows], "sentence"),
    ]
    lists = {row for row, one in enumerate(found) if isinstance(one.value, tuple) and one.value}
    return TextTable(caption, columns, 1, lists=lists)


def sentence_text(text: str, look: Look) -> str:
    """Return a sentence in the characters of the output, its numbers with the decimal comma where that is wanted."""
    text = look.text(re.sub(r"(?<=[a-z])\^2", "²", text))
    return re.sub(r"(?<=\d)\.(?=\d)", ",", text) if look.comma else text
