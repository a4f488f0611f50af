"""A table before it is laid out: its columns as cells of text, the parts that share their crank angles side by side."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby

from kurbel.render import Look
from kurbel.render.numbers import Scale, angle_scale, cell, decimal, scale_of, whole_if_integral
from kurbel.render.text import width
from kurbel.report.tables import Column, Part, Report, Value

MARK = "*"


class Cells:
    """The values of a column as text, each made when it is asked for, so that a long table is never held.

    pad: what stands behind a cell that is not marked.
    """

    def __init__(self, column: Column, scale: Scale, comma: bool, pad: str) -> None:
        self._values, self._scale, self._comma, self._pad = column.values, scale, comma, pad
        self._marked = frozenset(column.marked)

    def __len__(self) -> int:
        return len(self._values)

    def __iter__(self) -> Iterator[str]:
        return self[:]

    def __getitem__(self, part: slice) -> Iterator[str]:
        """Yield the cells of a part of the column."""
        for index in range(len(self._values))[part]:
            yield self._text(self._values[index]) + (MARK if index in self._marked else self._pad)

    def _text(self, value: Value) -> str:
        return cell(value, self._scale, self._comma)

    @cached_property
    def width(self) -> int:
        """Width of the widest: with the same decimals for all, that of the largest or the smallest value."""
        ends = (end((value for value in self._values if value is not None), default=None) for end in (min, max))
        return max(len(self._text(end)) for end in ends) + len(self._pad)


@dataclass(frozen=True, eq=False)
class Row:
    """One quantity as text; in print it runs across the page or down it. words: it is no quantity but names."""

    symbol: str
    unit: str
    cells: Cells | Sequence[str]
    words: bool = False

    @property
    def width(self) -> int:
        """Width of the widest cell."""
        return self.cells.width if isinstance(self.cells, Cells) else max(map(width, self.cells), default=0)


@dataclass(frozen=True, eq=False)
class Band:
    """The rows of one part, with the name over or beside them (empty where there is only one part)."""

    name: str
    rows: tuple[Row, ...]


@dataclass(frozen=True, eq=False)
class Sheet:
    """One table: the crank angles (with those of the return stroke, where the table is mirrored) and its bands.

    named_beside: the names of the bands are short and stand in a column of their own, as L/R does in the book.
    """

    heads: tuple[Row, ...]
    bands: tuple[Band, ...]
    named_beside: bool


def sheets(report: Report, look: Look) -> Iterator[Sheet]:
    """Yield one sheet for each run of parts with the same crank angles."""
    parts = [part for part in report.all_parts if part.columns]
    runs = (tuple(run) for _, run in groupby(parts, lambda part: part.columns[0].values))
    return (_sheet(report, run, look) for run in runs)


def _sheet(report: Report, parts: tuple[Part, ...], look: Look) -> Sheet:
    pad = " " if any(column.marked for part in parts for column in part.columns) else ""
    bands = tuple(
        Band(part_name(report, part, look), tuple(_row(column, look, pad) for column in part.columns[1:]))
        for part in parts
    )
    phi = parts[0].columns[0]
    heads = [_scaled(phi, angle_scale(phi.values), look, pad)]
    if report.mirrored:
        symbol, ascii_symbol = f"360° − {phi.symbol}", f"360 - {phi.ascii_symbol}"
        values = tuple(None if value is None else 360 - value for value in phi.values)
        mirrored = phi._replace(symbol=symbol, ascii_symbol=ascii_symbol, values=values)
        heads.append(_scaled(mirrored, angle_scale(values), look, pad))
    return Sheet(tuple(heads), bands, report.group == "ratios")


def part_name(report: Report, part: Part, look: Look) -> str:
    """Return what stands over the results of a part; nothing where it is the only one and the title says it all."""
    if part is report.whole:
        return look.charset.text(str(part.name)) if report.parts else ""
    if report.group == "ratios":
        ratio = str(whole_if_integral(float(part.name))).replace("inf", "∞")
        return look.charset.text(f"L/R = {decimal(ratio, look.comma)}")
    return look.charset.text(str(part.name)) if len(report.all_parts) > 1 else ""


def _row(column: Column, look: Look, pad: str) -> Row:
    scale = scale_of((column.size,) if column.size else column.values, look.digits)
    if column.decimals is not None:
        scale = Scale(column.decimals)
    return _scaled(column, scale, look, pad)


def _scaled(column: Column, scale: Scale, look: Look, pad: str) -> Row:
    charset = look.charset
    symbol = charset.symbol(column.symbol, column.ascii_symbol)
    return Row(symbol, charset.unit(column.unit, scale.exponent), Cells(column, scale, look.comma, pad))
