"""The look of Zusammenstellung 112: quantities down the side, crank angles across, broken as over two pages."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from kurbel.render import Look
from kurbel.render.sheet import Row, Sheet
from kurbel.render.text import BLANK, Line, Piece, left, line, right, width

_NINE = 9  # the book breaks after 80°
_GAP = 2


@dataclass(frozen=True, eq=False)
class _Grid:
    """Widths of the columns of a sheet, the same in all its blocks."""

    name: int
    symbol: int
    unit: int
    cell: int

    @property
    def side(self) -> int:
        """Width of what stands left of the numbers."""
        return sum(cells + _GAP for cells in (self.name, self.symbol, self.unit) if cells)


def table(sheet: Sheet, look: Look) -> Iterator[Line]:
    """Yield the lines of the sheet, block under block."""
    grid = _grid(sheet)
    if look.width is not None and look.width < grid.side + 2 * grid.cell:
        sheet = replace(sheet, named_beside=False)
        grid = _grid(sheet)
    count = len(sheet.heads[0].cells)
    sizes = _book_sizes(count) if look.width is None else _fitting_sizes(count, (look.width - grid.side) // grid.cell)
    start = 0
    for size in sizes:
        if start:
            yield BLANK
        yield from _block(sheet, grid, slice(start, start + size), look.charset.text("─"))
        start += size


def _book_sizes(count: int) -> list[int]:
    """Return nine angles to a block; a single one left over joins the last: 19 = 9 + 10, as in the book."""
    full = max(0, (count - 2) // _NINE)
    return [*[_NINE] * full, count - full * _NINE]


def _fitting_sizes(count: int, most: int) -> list[int]:
    """Return blocks as even as can be of at most `most` angles, the longer ones last."""
    blocks = -(-count // max(most, 1))
    return [count // blocks + (index >= blocks - count % blocks) for index in range(blocks)] if count else []


def _grid(sheet: Sheet) -> _Grid:
    rows = [*sheet.heads, *(row for band in sheet.bands for row in band.rows)]
    name = max(width(band.name) for band in sheet.bands) if sheet.named_beside else 0
    cells = max(row.width for row in rows)
    return _Grid(name, max(width(row.symbol) for row in rows), max(width(row.unit) for row in rows), cells + _GAP)


def _block(sheet: Sheet, grid: _Grid, across: slice, rule: str) -> Iterator[Line]:
    count = len(range(len(sheet.heads[0].cells))[across])
    ruled = line(rule * (grid.side + count * grid.cell), "rule")
    for head in sheet.heads:
        yield _line("", head, grid, across, "head")
    for band in sheet.bands:
        yield ruled
        if band.name and not sheet.named_beside:
            yield line(band.name, "name")
        for index, row in enumerate(band.rows):
            yield _line("" if index else band.name, row, grid, across, "cell")
    yield ruled


def _line(name: str, row: Row, grid: _Grid, across: slice, role: str) -> Line:
    gap = " " * _GAP
    side = [Piece(left(name, grid.name) + gap, "name")] if grid.name else []
    symbol = right(row.symbol, grid.symbol) if role == "head" else left(row.symbol, grid.symbol)
    side.append(Piece(symbol + gap, "head" if role == "head" else "symbol"))
    if grid.unit:
        side.append(Piece(left(row.unit, grid.unit) + gap, "unit"))
    cells = (Piece(right(text, grid.cell), "mark" if text.endswith("*") else role) for text in row.cells[across])
    return (*side, *cells)
