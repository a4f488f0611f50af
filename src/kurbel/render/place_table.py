"""Tables whose rows are named places: the names on the left, quantities across."""

from collections.abc import Iterator
from typing import NamedTuple

from kurbel.render import Look
from kurbel.render.charset import left, right, width
from kurbel.render.lines import Line, Piece, line
from kurbel.render.numbers import Scale, alone, angle, cell, scale_of
from kurbel.render.prose import folded
from kurbel.report.tables import Column, PlaceTable, Report, Value

_GAP = 2


class Cells(NamedTuple):
    """A table of places as text: for each column its symbol, its unit and its cells."""

    names: tuple[tuple[str, ...], ...]
    heads: tuple[tuple[str, str], ...]
    rows: tuple[tuple[str, ...], ...]

    def name_widths(self, over: tuple[str, ...]) -> list[int]:
        """Return the widths of the names and of what stands over them; of rows without a name there are none."""
        return [max(map(width, names)) for names in zip(over or ("",) * len(self.names[0]), *self.names)]

    @property
    def widths(self) -> list[int]:
        """The widths of the columns."""
        return [max(map(width, texts)) for texts in zip(*zip(*self.heads), *self.rows)]

    def fitting(self, room: int | None, over: tuple[str, ...]) -> "Iterator[Cells]":
        """Yield the table in parts that fit into so many columns; without names the first column says again which row.

        A part has one column more than what says the row, however narrow it must be.
        """
        first = 0 if self.names[0] else 1
        beside = sum(one + _GAP for one in (*self.name_widths(over), *self.widths[:first]))
        chosen: list[int] = []
        for number, wide in enumerate(self.widths[first:], first):
            if room and chosen and beside + sum(self.widths[k] + _GAP for k in chosen) + wide > room:
                yield self._of(*range(first), *chosen)
                chosen = []
            chosen.append(number)
        yield self._of(*range(first), *chosen)

    def _of(self, *columns: int) -> "Cells":
        return Cells(
            self.names,
            tuple(self.heads[k] for k in columns),
            tuple(tuple(row[k] for k in columns) for row in self.rows),
        )


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
            number, power = alone(value, look.digits or column.alone, look.comma)
            return number + (look.charset.times_power(power) if power else "")
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
    for part in report.all_parts:
        for table in part.place_tables:
            over = table.heads if table.headed else ()
            found = [line(one, "name") for one in folded(look.charset.text(table.title), look.width)]
            for cells in cells_of(table, look).fitting(look.width, over):
                found += _lines(cells, look, over)
            yield found


def _lines(cells: Cells, look: Look, name_heads: tuple[str, ...]) -> Iterator[Line]:
    over = name_heads or ("",) * len(cells.names[0])
    name_widths, widths = cells.name_widths(name_heads), cells.widths
    symbols, units = zip(*cells.heads)
    side = sum(cells_ + _GAP for cells_ in name_widths)
    ruled = line(look.charset.rule * (side + sum(cells_ + _GAP for cells_ in widths) - _GAP), "rule")
    yield _line([left(name, wide) for name, wide in zip(over, name_widths)], symbols, widths, "head")
    if any(units):
        yield _line([" " * (side - _GAP)] if side else [], units, widths, "unit")
    yield ruled
    before: tuple[str, ...] = ()
    for names, texts in zip(cells.names, cells.rows):
        # a part that repeats the row above stays blank, so that its places stand together
        shown = ("", *names[1:]) if len(names) > 1 and before[:1] == names[:1] else names
        yield _line([left(name, wide) for name, wide in zip(shown, name_widths)], texts, widths, "cell")
        before = names
    yield ruled


def _line(names: list[str], texts: tuple[str, ...], widths: list[int], role: str) -> Line:
    side = [Piece(name + " " * _GAP, "name") for name in names]
    gaps = ["", *[" " * _GAP] * (len(widths) - 1)]
    return (*side, *(Piece(gap + right(text, wide), role) for gap, text, wide in zip(gaps, texts, widths)))
