"""Tables whose rows are named places: the names on the left, quantities across."""

from collections.abc import Iterator
from typing import NamedTuple

from kurbel.render import Look
from kurbel.render.columns import Texts, blocks
from kurbel.render.lines import Line, line
from kurbel.render.numbers import Scale, alone, angle, cell, scale_of
from kurbel.render.prose import folded
from kurbel.report.tables import Column, PlaceTable, Report, Value

_GAP = 2


class Cells(NamedTuple):
    """A table of places as text: the names of its rows; for each column its symbol, its unit and its cells."""

    names: tuple[tuple[str, ...], ...]
    heads: tuple[tuple[str, str], ...]
    rows: tuple[tuple[str, ...], ...]


def cells_of(table: PlaceTable, look: Look) -> Cells:
    """Return the table as text; columns of one unit share their scale, so that they can be compared by eye.

    What stands alone does not: it has its power of ten beside it.
    """
    blank = "_" if table.headed else " "
    names = tuple(tuple(look.charset.text(name.replace("_", blank)) for name in row) for row in table.names)
    sharing = [column for column in table.columns if not _own_scale(column)]
    scales = {
        unit: scale_of((v for column in sharing if column.unit == unit for v in column.values), look.digits)
        for unit in {column.unit for column in sharing}
    }

    def text(value: Value, column: Column) -> str:
        if value is None:
            return look.charset.no_value
        if column.decimals is not None:
            return cell(value, Scale(column.decimals), look.comma)
        if column.alone:
            return look.charset.counted(*alone(value, look.digits or column.alone, look.comma))
        return angle(value, look.comma) if column.unit == "deg" else cell(value, scales[column.unit], look.comma)

    def unit_of(column: Column) -> str:
        own = _own_scale(column) or column.unit == "deg"
        return look.charset.unit(column.unit, 0 if own else scales[column.unit].exponent)

    heads = tuple((look.charset.symbol(c.symbol, c.ascii_symbol), unit_of(c)) for c in table.columns)
    columns = [[text(value, column) for value in column.values] for column in table.columns]
    return Cells(names, heads, tuple(zip(*columns)))


def _own_scale(column: Column) -> bool:
    return bool(column.alone) or column.decimals is not None


def place_tables(report: Report, look: Look) -> Iterator[list[Line]]:
    """Yield the lines of every table of places, each with its title."""
    for table in (table for part in report.all_parts for table in part.place_tables):
        title = [line(one, "name") for one in folded(look.charset.text(table.title), look.width)]
        parts = blocks(*_columns(table, cells_of(table, look)), look, _GAP)
        yield [*title, *(one for lines in parts for one in lines)]


def _columns(table: PlaceTable, cells: Cells) -> tuple[list[Texts], list[Texts]]:
    """Return the columns of names, and those of quantities; without names the first of these says which row it is."""
    columns = [Texts(*head, texts) for head, texts in zip(cells.heads, zip(*cells.rows))]
    if not cells.names[0]:
        return columns[:1], columns[1:]
    first, *others = zip(*cells.names)
    if others:
        # a name that repeats the one above stays blank, so that its places stand together
        first = tuple("" if one == before else one for one, before in zip(first, (None, *first)))
    over = table.heads if table.headed else ("",) * len(cells.names[0])
    return [Texts(head, "", texts, words=True) for head, texts in zip(over, (first, *others))], columns
