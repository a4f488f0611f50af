"""One line per crank angle: quantities across, each part under its name."""

from collections.abc import Iterator

from kurbel.render import Look
from kurbel.render.columns import Texts, blocks
from kurbel.render.lines import BLANK, Line, line
from kurbel.render.sheet import Row, Sheet

_GAP = 3


def table(sheet: Sheet, look: Look) -> Iterator[Line]:
    """Yield the lines of the sheet, part under part."""
    for index, band in enumerate(sheet.bands):
        if index:
            yield BLANK
        if band.name:
            yield line(band.name, "name")
        parts = blocks([*map(_texts, sheet.heads)], [*map(_texts, band.rows)], look, _GAP)
        for number, lines in enumerate(parts):
            yield from (BLANK, *lines) if number else lines


def _texts(row: Row) -> Texts:
    return Texts(row.symbol, row.unit, row.cells, wide=row.cells.width)
