"""Tables whose rows are named places: the names on the left, quantities across."""

from collections.abc import Iterator
from dataclasses import replace

from kurbel.render import Look
from kurbel.render.columns import blocks
from kurbel.render.numbers import Scale, alone, angle, cell, scale_of
from kurbel.render.sheet import Row
from kurbel.render.text import Line, folded, line
from kurbel.report.tables import Column, PlaceTable, Report, Value

_GAP = 2


def text_of(table: PlaceTable, look: Look) -> tuple[list[Row], list[Row]]:
    """Return the names of its rows, and its columns; those of one unit share their scale, to be compared by eye.

    What stands alone does not: it has its power of ten beside it.
    """
    blank = "_" if table.headed else " "
    names = [
        Row(head, "", tuple(look.charset.text(name.replace("_", blank)) for name in column), words=True)
        for head, column in zip(table.heads, zip(*table.names))
    ]
    sharing = [column for column in table.columns if not _own_scale(column)]
    scales = {
        unit: scale_of((v for column in sharing if column.unit == unit for v in column.values), look.digits)
        for unit in {column.unit for column in sharing}
    }

    def text(value: Value, column: Column) -> str:
        if value is None:
            return look.charset.text("–")
        if column.decimals is not None:
            return cell(value, Scale(column.decimals), look.comma)
        if column.alone:
            return look.charset.counted(*alone(value, look.digits or column.alone, look.comma))
        return angle(value, look.comma) if column.unit == "deg" else cell(value, scales[column.unit], look.comma)

    def quantity(column: Column) -> Row:
        own = _own_scale(column) or column.unit == "deg"
        unit = look.charset.unit(column.unit, 0 if own else scales[column.unit].exponent)
        symbol = look.charset.symbol(column.symbol, column.ascii_symbol)
        return Row(symbol, unit, tuple(text(value, column) for value in column.values))

    return names, [quantity(column) for column in table.columns]


def _own_scale(column: Column) -> bool:
    return bool(column.alone) or column.decimals is not None


def place_tables(report: Report, look: Look) -> Iterator[list[Line]]:
    """Yield the lines of every table of places, each with its title."""
    for table in report.printed_tables:
        title = [line(one, "name") for one in folded(look.charset.text(table.title), look.width)]
        names, columns = text_of(table, look)
        side = [_beside(name, table.headed, len(names) > 1 and name is names[0]) for name in names]
        # without names the first column says which row it is
        parts = blocks(side or columns[:1], columns if side else columns[1:], look, _GAP)
        yield [*title, *(one for lines in parts for one in lines)]


def _beside(name: Row, headed: bool, grouping: bool) -> Row:
    """Return the names as they stand at the side; grouping: what repeats the one above stays blank."""
    pairs = zip(name.cells, ("", *name.cells))
    cells = tuple("" if grouping and one == above else one for one, above in pairs)
    return replace(name, symbol=name.symbol if headed else "", cells=cells)
