"""One line per crank angle: quantities across, each part under its name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from kurbel.render.charset import right, width
from kurbel.render.lines import BLANK, Line, Piece, line
from kurbel.render.sheet import Band, Row, Sheet

if TYPE_CHECKING:
    from kurbel.render import Look

_GAP = 3


def table(sheet: Sheet, look: Look) -> Iterator[Line]:
    """Yield the lines of the sheet, part under part."""
    for index, band in enumerate(sheet.bands):
        if index:
            yield BLANK
        yield from _band(band, sheet.heads, look.charset.rule)


def _band(band: Band, heads: tuple[Row, ...], rule: str) -> Iterator[Line]:
    columns = [*heads, *band.rows]
    widths = [max(width(row.symbol), width(row.unit), row.cells.width) for row in columns]
    ruled = line(rule * (sum(widths) + _GAP * (len(widths) - 1)), "rule")
    if band.name:
        yield line(band.name, "name")
    yield _line([row.symbol for row in columns], widths, "head")
    if any(row.unit for row in columns):
        yield _line([row.unit for row in columns], widths, "unit")
    yield ruled
    for texts in zip(*(row.cells for row in columns)):
        yield _line(list(texts), widths, "cell")
    yield ruled


def _line(texts: list[str], widths: list[int], role: str) -> Line:
    filled = [right(text, cells) for text, cells in zip(texts, widths)]
    gaps = ["", *[" " * _GAP] * (len(filled) - 1)]
    return tuple(Piece(gap + text, "mark" if text.endswith("*") else role) for gap, text in zip(gaps, filled))
