"""A table before it is laid out: its columns as cells of text, the parts that share their crank angles side by side."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, NamedTuple

from kurbel.render.numbers import DIGITS, angle_scale, cell, scale_of, whole_if_integral

if TYPE_CHECKING:
    from kurbel.render import Look
    from kurbel.report.tables import Column, Part, Report

MARK = "*"


class Row(NamedTuple):
    """One quantity as text; in print it runs across the page or down it."""

    symbol: str
    unit: str
    cells: tuple[str, ...]


class Band(NamedTuple):
    """The rows of one part, with the name over or beside them (empty where there is only one part)."""

    name: str
    rows: tuple[Row, ...]


class Sheet(NamedTuple):
    """One table: the crank angles (with those of the return stroke, where the table is mirrored) and its bands.

    named_beside: the names of the bands are short and stand in a column of their own, as L/R does in the book.
    """

    heads: tuple[Row, ...]
    bands: tuple[Band, ...]
    named_beside: bool


def sheets(report: Report, look: Look) -> list[Sheet]:
    """Return one sheet for each run of parts with the same crank angles."""
    parts = [part for part in report.all_parts if part.columns]
    runs = (tuple(run) for _, run in groupby(parts, lambda part: part.columns[0].values))
    return [_sheet(report, run, look) for run in runs]


def _sheet(report: Report, parts: tuple[Part, ...], look: Look) -> Sheet:
    pad = " " if any(column.marked for part in parts for column in part.columns) else ""
    bands = tuple(
        Band(part_name(report, part, look), tuple(_row(column, look, pad) for column in part.columns[1:]))
        for part in parts
    )
    phi = parts[0].columns[0]
    heads = [_angles(phi, look, pad)]
    if report.mirrored:
        symbol, ascii_symbol = f"360° − {phi.symbol}", f"360 - {phi.ascii_symbol}"
        values = tuple(None if value is None else 360 - value for value in phi.values)
        heads.append(_angles(phi._replace(symbol=symbol, ascii_symbol=ascii_symbol, values=values), look, pad))
    return Sheet(tuple(heads), bands, report.group == "ratios")


def part_name(report: Report, part: Part, look: Look) -> str:
    """Return what stands over the results of a part; nothing where it is the only one and the title says it all."""
    if part is report.whole:
        return look.charset.text(str(part.name)) if report.parts else ""
    if report.group == "ratios":
        return f"L/R = {ratio_text(part, look)}"
    return look.charset.text(str(part.name)) if len(report.all_parts) > 1 else ""


def ratio_text(part: Part, look: Look) -> str:
    """Return L/R as a person writes it."""
    ratio = str(whole_if_integral(float(part.name)))
    if ratio == "inf" and look.charset.has("∞"):
        return "∞"
    return ratio.replace(".", ",") if look.comma else ratio


def _row(column: Column, look: Look, pad: str) -> Row:
    scale = scale_of(column.values, look.digits or DIGITS)
    if column.decimals is not None:
        scale = scale._replace(decimals=column.decimals, exponent=0)
    marks = dict.fromkeys(column.marked, MARK)
    cells = tuple(cell(value, scale, look.comma) + marks.get(i, pad) for i, value in enumerate(column.values))
    charset = look.charset
    return Row(charset.symbol(column.symbol, column.ascii_symbol), charset.unit(column.unit, scale.exponent), cells)


def _angles(column: Column, look: Look, pad: str) -> Row:
    scale = angle_scale(column.values)
    cells = tuple(cell(value, scale, look.comma) + pad for value in column.values)
    charset = look.charset
    return Row(charset.symbol(column.symbol, column.ascii_symbol), charset.unit(column.unit), cells)
