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
        yield from _band(band, sheet.heads, look)


def _band(band: Band, heads: tuple[Row, ...], look: Look) -> Iterator[Line]:
    if band.name:
        yield line(band.name, "name")
    for index, rows in enumerate(_fitting(band.rows, heads, look.width)):
        if index:
            yield BLANK
        yield from _block([*heads, *rows], look.charset.rule)


def _width(row: Row) -> int:
    return max(width(row.symbol), width(row.unit), row.cells.width)


def _fitting(rows: tuple[Row, ...], heads: tuple[Row, ...], cells: int | None) -> Iterator[tuple[Row, ...]]:
    """Yield as many columns at a time as fit beside the angles, at least one."""
    if cells is None:
        yield rows
        return
    beside = sum(_width(head) + _GAP for head in heads) - _GAP
    start, used = 0, beside
    for end, row in enumerate(rows):
        used += _GAP + _width(row)
        if used > cells and end > start:
            yield rows[start:end]
            start, used = end, beside + _GAP + _width(row)
    yield rows[start:]


def _block(columns: list[Row], rule: str) -> Iterator[Line]:
    widths = [_width(row) for row in columns]
    ruled = line(rule * (sum(widths) + _GAP * (len(widths) - 1)), "rule")
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
