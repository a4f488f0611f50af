"""Results as CSV, with all digits: for spreadsheets and other programs."""

import csv
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import repeat

from kurbel.render import Look
from kurbel.render.text import rounded, whole_if_integral
from kurbel.tables.tables import PISTONS, CellValue, Column, Part, PlaceTable, Report

_FORMULA = ("=", "+", "-", "@", "＝", "＋", "－", "＠")
"""Characters that begin a formula in a spreadsheet, also wide ones."""
_FIRST = {"ratios": "rod_ratio", "bearings": "bearing", "scenes": "scene"}
"""Group of the parts of a report -> head of the column with their names, if not `cylinder`."""


class _Echo:
    """A file for `csv.writer`, which then returns each line."""

    def write(self, text: str) -> str:
        return text


def csv_line(look: Look) -> Callable[[Iterable[object]], str]:
    """Return a function that makes a line of texts, numbers and None; with a decimal comma the separator is `;`."""
    return csv.writer(_Echo(), delimiter=";" if look.comma else ",", lineterminator="\n").writerow


def csv_cell(
    value: CellValue | str | tuple[float, ...], look: Look, in_full: bool = False
) -> object:
    """Return a value for `csv_line`: an apostrophe marks a text that a spreadsheet would take for a formula.

    Numbers have the digits that are wanted, or all; the values of a list are parted by blanks.
    """
    if isinstance(value, str):
        text = look.data(value)
        if not text.startswith(_FORMULA):
            return text
        return f"'{text}"
    if isinstance(value, tuple):
        return " ".join(str(csv_cell(number, look)) for number in value)
    number = rounded(value, None if in_full else look.digits)
    if number is None or not look.comma:
        return number
    return repr(number).replace(".", ",")


Cells = dict[str, Iterable[object]]
"""The cells of columns by their heads."""


def csv_text(report: Report, look: Look) -> Iterator[str]:
    """Yield head and rows as CSV.

    These are the tables over the crank angle; if there are none, the tables of places; if there are none either, the
    key values. Several parts follow one another, with their names in a first column.
    """
    parts = report.all_parts
    blocks = _blocks(parts, look)
    parts_without_results = sum(bool(part.nowhere) for part in parts)
    # the totals of an only cylinder have ids of their own
    several = len(blocks) + parts_without_results > 1 and not report.is_of_one_cylinder
    is_named = several or report.group in ("ratios", "scenes")

    heads = _heads(parts, blocks)
    first_head = [_FIRST.get(report.group, "cylinder")] if is_named else []
    line = csv_line(look)
    yield line([*first_head, *heads])
    for part, tables in blocks:
        name = part.name if isinstance(part.name, str) else whole_if_integral(part.name)
        first_cell = [csv_cell(name, look, True)] if is_named else []
        for table_cells in tables:
            columns = [table_cells.get(head, repeat("")) for head in heads]
            for row in zip(*columns):
                yield line([*first_cell, *row])


def _blocks(parts: Sequence[Part], look: Look) -> list[tuple[Part, list[Cells]]]:
    """Return what is written of each part: its columns, else its tables of places, else its key values."""
    with_columns = [part for part in parts if part.columns]
    if with_columns:
        return [(part, [_columns(part.columns, look)]) for part in with_columns]

    blocks = []
    for part in parts:
        tables = [table for table in part.place_tables if table.id != PISTONS]
        if tables:
            blocks.append((part, [_of_places(table, look) for table in tables]))
    return blocks or [(part, [_of_key_values(part, look)]) for part in parts]


def _heads(parts: Sequence[Part], blocks: Sequence[tuple[Part, list[Cells]]]) -> list[str]:
    """Return all heads, those of names first, otherwise in the order of their first occurrence."""
    heads_of_names = {"table"}
    for part in parts:
        for place_table in part.place_tables:
            heads_of_names.update(place_table.heads)
    heads: dict[str, None] = {}
    for _, tables in blocks:
        for table_cells in tables:
            heads |= dict.fromkeys(table_cells)
    return sorted(heads, key=lambda head: head not in heads_of_names)


def _columns(columns: Iterable[Column], look: Look) -> Cells:
    """Return the cells of columns by id and unit: `x_m`, `b_m/s^2`, `M_Nm`, or the id alone for a ratio."""
    cells: Cells = {}
    for column in columns:
        unit = column.unit.replace(" abs", "_abs").replace(" ", "")
        head = f"{column.id}_{unit}" if unit else column.id
        cells[head] = _cells(column, look)
    return cells


def _cells(column: Column, look: Look) -> Iterator[object]:
    """Yield the values of a column; crank angles have all digits, whole ones no decimal point."""
    for value in column.values:
        if column.id == "phi":
            yield csv_cell(whole_if_integral(value), look, True)
        else:
            yield csv_cell(value, look)


def _of_places(table: PlaceTable, look: Look) -> Cells:
    cells: Cells = {"table": repeat(table.id, len(table.names))}
    for head, names in zip(table.heads, zip(*table.names)):
        cells[head] = [csv_cell(name, look) for name in names]
    return cells | _columns(table.columns, look)


def _of_key_values(part: Part, look: Look) -> Cells:
    """Return the cells of key values: a row for each, and for each value of a list."""
    rows: list[tuple[object, ...]] = []
    for key_value in part.key_values:
        at = csv_cell(key_value.at_deg, look, True)
        value_or_list = key_value.value
        values = value_or_list if isinstance(value_or_list, tuple) else (value_or_list,)
        for value in values:
            rows.append((key_value.id, key_value.unit, csv_cell(value, look), at))
    heads = ("key_value", "unit", "value", "at_deg")
    if not rows:
        return {head: [] for head in heads}
    return dict(zip(heads, map(list, zip(*rows))))
