"""Columns of texts side by side under their heads, in as many blocks as the width of the page asks for."""

from collections.abc import Iterable, Iterator, Sequence

from kurbel.render import Look
from kurbel.render.sheet import Row, Sheet
from kurbel.render.text import BLANK, Line, Piece, left, line, right, width

_GAP = 3


def table(sheet: Sheet, look: Look) -> Iterator[Line]:
    """Yield the lines of the sheet, one for each crank angle, part under part."""
    for index, band in enumerate(sheet.bands):
        if index:
            yield BLANK
        if band.name:
            yield line(band.name, "name")
        for number, lines in enumerate(blocks(sheet.heads, band.rows, look, _GAP)):
            yield from (BLANK, *lines) if number else lines


def blocks(side: Sequence[Row], columns: Sequence[Row], look: Look, gap: int) -> Iterator[Iterator[Line]]:
    """Yield the lines of each block: as many columns as fit beside those of the side, at least one."""
    widths = [max(width(one.symbol), width(one.unit), one.width) for one in (*side, *columns)]
    beside, start = sum(width + gap for width in widths[: len(side)]), 0
    for end in range(min(1, len(columns)), len(columns) + 1):
        wide = beside + sum(width + gap for width in widths[len(side) :][start : end + 1]) - gap
        if end == len(columns) or (look.width is not None and wide > look.width):
            across = [*range(len(side)), *range(len(side) + start, len(side) + end)]
            rule = look.charset.text("─")
            yield _block([(*side, *columns)[k] for k in across], [widths[k] for k in across], rule, gap)
            start = end


def _block(columns: Sequence[Row], widths: Sequence[int], rule: str, gap: int) -> Iterator[Line]:
    ruled = line(rule * (sum(widths) + gap * (len(widths) - 1)), "rule")
    fills = [left if one.words else right for one in columns]
    words = [one.words for one in columns]
    gaps = ["", *[" " * gap] * (len(widths) - 1)]

    def texts(found: Iterable[str], role: str) -> Line:
        return tuple(
            Piece(between + fill(text, wide), "name" if word else "mark" if text.endswith("*") else role)
            for between, fill, text, wide, word in zip(gaps, fills, found, widths, words)
        )

    yield texts((one.symbol for one in columns), "head")
    if any(one.unit for one in columns):
        yield texts((one.unit for one in columns), "unit")
    yield ruled
    for row in zip(*(one.cells for one in columns)):
        yield texts(row, "cell")
    yield ruled
