"""Columns of texts side by side under their heads, in as many blocks as the width of the page asks for."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from kurbel.render import Look
from kurbel.render.charset import left, right, width
from kurbel.render.lines import Line, Piece, line


class Texts(NamedTuple):
    """A column: what stands over it, its unit, and its cells, which may be read again; words stand flush left.

    wide: the cells of the widest, where that is known without reading all of them.
    """

    head: str
    unit: str
    cells: Iterable[str]
    words: bool = False
    wide: int | None = None

    @property
    def width(self) -> int:
        """The width of the column."""
        widest = max(map(width, self.cells), default=0) if self.wide is None else self.wide
        return max(width(self.head), width(self.unit), widest)


def blocks(side: Sequence[Texts], columns: Sequence[Texts], look: Look, gap: int) -> Iterator[Iterator[Line]]:
    """Yield the lines of each block: as many columns as fit beside those of the side, at least one."""
    widths = [one.width for one in (*side, *columns)]
    beside, start = sum(width + gap for width in widths[: len(side)]), 0
    for end in range(min(1, len(columns)), len(columns) + 1):
        wide = beside + sum(width + gap for width in widths[len(side) :][start : end + 1]) - gap
        if end == len(columns) or (look.width is not None and wide > look.width):
            across = [*range(len(side)), *range(len(side) + start, len(side) + end)]
            yield _block([(*side, *columns)[k] for k in across], [widths[k] for k in across], look.charset.rule, gap)
            start = end


def _block(columns: Sequence[Texts], widths: Sequence[int], rule: str, gap: int) -> Iterator[Line]:
    ruled = line(rule * (sum(widths) + gap * (len(widths) - 1)), "rule")
    fills = [left if one.words else right for one in columns]
    words = [one.words for one in columns]
    gaps = ["", *[" " * gap] * (len(widths) - 1)]

    def texts(found: Iterable[str], role: str) -> Line:
        return tuple(
            Piece(between + fill(text, wide), "name" if word else "mark" if text.endswith("*") else role)
            for between, fill, text, wide, word in zip(gaps, fills, found, widths, words)
        )

    yield texts((one.head for one in columns), "head")
    if any(one.unit for one in columns):
        yield texts((one.unit for one in columns), "unit")
    yield ruled
    for row in zip(*(one.cells for one in columns)):
        yield texts(row, "cell")
    yield ruled
