"""Results as CSV, with all digits: for spreadsheets and other programs."""

import csv
from collections.abc import Callable, Iterable, Iterator
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
        return f"'{text}" if text.startswith(_FORMULA) else text
    if isinstance(value, tuple):
        return " ".join(str(csv_cell(one, look)) for one in value)
    number = rounded(value, None if in_full else look.digits)
    return number if value is None or not look.comma else repr(number).replace(".", ",")


Cells = dict[str, Iterable[object]]
"""The cells of columns by their heads."""


def csv_text(report: Report, look: Look) -> Iterator[str]:
    """Yield head and rows as CSV.

    These are the tables over the crank angle; if there are none, the tables of places; if there are none either, the
    key values. Several parts follow one another, with their names in a first column.
    """
    parts = report.all_parts
    places = [
        (part, [place_table for place_table in part.place_tables if place_table.id != PISTONS])
        for part in parts
    ]
    if any(part.columns for part in parts):
        blocks = [(part, [_columns(part.columns, look)]) for part in parts if part.columns]
    elif any(tables for _, tables in places):
        blocks = [
            (part, [_of_places(table, look) for table in tables])
            for part, tables in places
            if tables
        ]
    else:
        blocks = [(part, [_of_key_values(part, look)]) for part in parts]
    named = len(blocks) + sum(bool(part.nowhere) for part in parts) > 1 or report.group in (
        "ratios",
        "scenes",
    )
    names = {
        head
        for part in parts
        for place_table in part.place_tables
        for head in ("table", *place_table.heads)
    }
    every = dict.fromkeys(head for _, tables in blocks for cells in tables for head in cells)
    heads = sorted(
        every, key=lambda head: head not in names
    )  # otherwise in order of their first occurrence
    line = csv_line(look)
    yield line([_FIRST.get(report.group, "cylinder"), *heads] if named else heads)
    for part, tables in blocks:
        name = part.name if isinstance(part.name, str) else whole_if_integral(part.name)
        beside = [csv_cell(name, look, True)] if named else []
        for cells in tables:
            rows = zip(*(cells.get(head, repeat("")) for head in heads))
            yield from (line((*beside, *row)) for row in rows)


def _columns(columns: Iterable[Column], look: Look) -> Cells:
    """Return the cells of columns by id and unit: `x_m`, `b_m/s^2`, `M_Nm`, or the id alone for a ratio."""
    found: Cells = {}
    for column in columns:
        unit = column.unit.replace(" abs", "_abs").replace(" ", "")
        found[f"{column.id}_{unit}" if unit else column.id] = _cells(column, look)
    return found


def _cells(column: Column, look: Look) -> Iterator[object]:
    """Yield the values of a column; crank angles have all digits, whole ones no decimal point."""
    for value in column.values:
        yield (
            csv_cell(whole_if_integral(value), look, True)
            if column.id == "phi"
            else csv_cell(value, look)
        )


def _of_places(table: PlaceTable, look: Look) -> Cells:
    names = ([csv_cell(name, look) for name in column] for column in zip(*table.names))
    return {
        "table": repeat(table.id, len(table.names)),
        **dict(zip(table.heads, names)),
        **_columns(table.columns, look),
    }


def _of_key_values(part: Part, look: Look) -> Cells:
    """Return the cells of key values: a row for each, and for each value of a list."""
    rows = []
    for key_value in part.key_values:
        at = csv_cell(key_value.at_deg, look, True)
        values = key_value.value if isinstance(key_value.value, tuple) else (key_value.value,)
        rows += [(key_value.id, key_value.unit, csv_cell(value, look), at) for value in values]
    return {
        head: [row[k] for row in rows]
        for k, head in enumerate(("key_value", "unit", "value", "at_deg"))
    }
