"""Results as a workbook for Excel, by XlsxWriter: every table on a sheet of its own, numbers in full.

The first row of a sheet has the heads with their units, and stays in view. Numbers are stored with all digits, or with those that are
wanted, and shown with the digits of a printed table. The same report gives the same bytes every time.
"""

from collections.abc import Iterable, Iterator, Sequence
from datetime import datetime
from itertools import chain
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple, Union

from kurbel import __version__
from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.text import Scale, digit_scale, head_scale, rounded, width
from kurbel.render.text_tables import part_name
from kurbel.tables.tables import (
    CellValue,
    Column,
    KeyValue,
    Part,
    PlaceTable,
    Report,
    notes_for_people,
)

if TYPE_CHECKING:
    from xlsxwriter import Workbook
    from xlsxwriter.worksheet import Worksheet

WorkbookCell = Union[float, int, str, None]
_MOST_ROWS = 1_048_576
"""Of a sheet, with its head."""
_LONGEST_NAME = 31
"""Characters of the name of a sheet."""
_NOT_IN_NAMES = dict.fromkeys(map(ord, "[]:*?/\\'"), " ")
_NARROWEST, _WIDEST = 8, 60
"""Widths of columns in characters."""
_MEASURED_ROWS = 200
"""Rows of a column whose widths are measured."""
_CREATED = datetime(2000, 1, 1)
"""The date that every workbook has: results do not depend on the day."""


class SheetColumn(NamedTuple):
    """A column of a sheet: its head with the unit, and its cells.

    scale: how all of its numbers are shown; None: each with digits of its own.
    """

    head: str
    cells: Sequence[WorkbookCell]
    scale: Scale | None = None


class Sheet(NamedTuple):
    """A sheet: its name, which is shortened to what Excel permits, and its columns."""

    name: str
    columns: Sequence[SheetColumn]
    warns: bool = False


# the sheets of a report


def report_sheets(report: Report, look: Look) -> Iterator[Sheet]:
    """Yield the sheets of a report: key values, tables, meaning of the columns, warnings and notes."""
    if any(part.key_values for part in report.all_parts):
        yield _key_value_sheet(report, look)
    for part in report.all_parts:
        if part.columns:
            columns = [_sheet_column(column, look) for column in part.columns]
            yield Sheet(_part_name(report, part, look) or report.command, columns)
    for id, tables in _place_tables(report).items():
        yield _place_sheet(id, tables, report, look)
    meanings = _meanings(report, look)
    if meanings:
        yield _sheet_of_texts("columns", ("column", "symbol", "unit", "meaning"), meanings)
    has_warnings = any(part.warnings for part in report.all_parts)
    notes = list(_notes(report, look))
    yield _sheet_of_texts("notes", ("what", "of", "text"), notes)._replace(warns=has_warnings)


def _part_name(report: Report, part: Part, look: Look) -> str:
    return part_name(report, part, look._replace(comma=False))


def _headed(id: str, unit: str, look: Look) -> str:
    """Return the head of a column: its id with its unit."""
    return f"{id} [{look.unit(unit)}]" if unit else id


def _sheet_column(column: Column, look: Look) -> SheetColumn:
    """Return a column with its numbers to the wanted digits; crank angles have all of theirs."""
    head = _headed(column.id, column.unit, look)
    if column.id == "phi":
        return SheetColumn(head, column.values, head_scale(column.values, look.digits))
    cells = [rounded(value, look.digits) for value in column.values]
    if column.decimals is not None:
        return SheetColumn(head, cells, Scale(column.decimals))
    scale = None if column.alone else digit_scale(cells, look.digits)
    return SheetColumn(head, cells, scale)


def _key_value_sheet(report: Report, look: Look) -> Sheet:
    """Return the key values of all parts: a row for each, and for each value of a list."""
    rows: list[tuple[WorkbookCell, ...]] = []
    for part in report.all_parts:
        name = look.data(str(part.name))
        for key_value in part.key_values:
            rows += _key_value_rows(name, key_value, look)
    heads = ("part", "key value", "symbol", "value", "unit", "at φ [°]", "side", "meaning")
    columns = [SheetColumn(look.data(head), cells) for head, cells in zip(heads, zip(*rows))]
    return Sheet("key values", columns)


def _key_value_rows(
    name: str, key_value: KeyValue, look: Look
) -> Iterator[tuple[WorkbookCell, ...]]:
    value_or_list = key_value.value
    values = value_or_list if isinstance(value_or_list, tuple) else (value_or_list,)
    for value in values:
        yield (
            name,
            key_value.id,
            look.symbol(key_value.symbol, key_value.ascii_symbol),
            rounded(value, look.digits),
            look.unit(key_value.unit),
            rounded(key_value.at_deg, look.digits),
            key_value.side,
            look.data(key_value.text),
        )


def _place_tables(report: Report) -> dict[str, list[tuple[Part, PlaceTable]]]:
    """Return the tables of places by their ids, each with the part that it belongs to."""
    tables: dict[str, list[tuple[Part, PlaceTable]]] = {}
    for part in report.all_parts:
        for table in part.place_tables:
            tables.setdefault(table.id, []).append((part, table))
    return tables


def _place_sheet(
    id: str, tables: Sequence[tuple[Part, PlaceTable]], report: Report, look: Look
) -> Sheet:
    """Return the tables of one id as one table; those of several parts have their names in a first column."""
    columns: dict[str, SheetColumn] = {}
    count = 0
    for part, table in tables:
        rows = max((len(column.values) for column in table.columns), default=len(table.names))
        part_columns: list[SheetColumn] = []
        if len(tables) > 1:
            name = _part_name(report, part, look) or look.data(str(part.name))
            part_columns.append(SheetColumn("part", [name] * rows))
        for head, names in zip(table.heads, zip(*table.names)):
            part_columns.append(SheetColumn(look.data(head), [look.data(text) for text in names]))
        part_columns += [_sheet_column(column, look) for column in table.columns]
        for column in part_columns:
            before = columns.get(column.head, SheetColumn(column.head, [None] * count))
            scale = column.scale if before.scale in (None, column.scale) else None
            columns[column.head] = column._replace(
                cells=[*before.cells, *column.cells], scale=scale
            )
        count += rows
    return Sheet(id, list(columns.values()))


def _meanings(report: Report, look: Look) -> list[tuple[str, ...]]:
    """Return the columns of all tables, each once: id, symbol, unit and meaning."""
    rows: dict[tuple[str, ...], None] = {}
    for part in report.all_parts:
        columns_of_places = chain.from_iterable(table.columns for table in part.place_tables)
        for column in (*part.columns, *columns_of_places):
            symbol = look.symbol(column.symbol, column.ascii_symbol)
            if column.text:
                rows[column.id, symbol, look.unit(column.unit), look.data(column.text)] = None
    return list(rows)


def _notes(report: Report, look: Look) -> Iterator[tuple[str, str, str]]:
    """Yield what is said next to the tables, and what they were made from."""
    for part in report.all_parts:
        for warning in part.warnings:
            yield "warning", look.data(str(part.name)), look.data(warning)
    for part in report.all_parts:
        for left_out in part.left_out:
            name = look.data(str(part.name))
            yield "left out", name, look.data(f"{left_out.what}: {left_out.why}")
    for note in notes_for_people(report):
        yield "note", "", look.data(note)
    yield "title", "", look.data(report.title)
    yield "command", "", f"kurbel {report.command}"
    if report.machine is not None:
        yield "machine", "", look.data(report.machine)
    provenance = report.provenance() if report.provenance else None
    if provenance is not None:
        for input_file in provenance.inputs:
            yield "input", "", look.data(input_file.file)
        for override in provenance.overrides:
            yield "set", "", look.data(override)
    yield "kurbel", "", __version__


def sheet_of_rows(
    heads: Sequence[tuple[str, str]],
    rows: Iterable[Sequence[CellValue | str | tuple[float, ...]]],
    look: Look,
) -> Sheet:
    """Return rows under heads, names with units, as a sheet; the values of a list are parted by blanks."""
    columns: list[list[WorkbookCell]] = [[] for _ in heads]
    for row in rows:
        for cells, value in zip(columns, row):
            if isinstance(value, tuple):
                cells.append(" ".join(str(rounded(number, look.digits)) for number in value))
            elif isinstance(value, str):
                cells.append(look.data(value))
            else:
                cells.append(rounded(value, look.digits))
    titles = [_headed(name, unit, look) for name, unit in heads]
    return Sheet("rows", [SheetColumn(title, cells) for title, cells in zip(titles, columns)])


def _sheet_of_texts(name: str, heads: Sequence[str], rows: Sequence[tuple[str, ...]]) -> Sheet:
    return Sheet(name, [SheetColumn(head, cells) for head, cells in zip(heads, zip(*rows))])


# how they are written


def write_workbook(sheets: Iterable[Sheet], file: BinaryIO, look: Look) -> None:
    """Write the sheets as a workbook. Raises UsageError where XlsxWriter is missing, or a table is too long."""
    try:
        from xlsxwriter import Workbook
    except ImportError:
        raise UsageError("Excel needs XlsxWriter: pip install XlsxWriter") from None
    workbook = Workbook(file, {"constant_memory": True})
    workbook.set_properties({"created": _CREATED, "comments": f"kurbel {__version__}"})
    formats = _Formats(workbook, look)
    names: set[str] = set()
    try:
        for sheet in sheets:
            rows = max((len(column.cells) for column in sheet.columns), default=0)
            if rows >= _MOST_ROWS:
                raise UsageError(
                    f"a sheet of Excel has {_MOST_ROWS} rows, the table {rows}; "
                    "take fewer rows, or write csv"
                )
            worksheet = workbook.add_worksheet(_name_of_sheet(sheet.name, names))
            _write_sheet(worksheet, sheet, rows, formats)
    finally:
        workbook.close()


def _name_of_sheet(text: str, taken: set[str]) -> str:
    """Return a name that Excel permits, and that no other sheet has; it is among those taken from now on.

    >>> taken = set()
    >>> _name_of_sheet("HP [side]", taken), _name_of_sheet("hp  side", taken), _name_of_sheet("History", taken)
    ('HP side', 'hp side 2', 'History 2')
    """
    stem = " ".join(text.translate(_NOT_IN_NAMES).split()) or "table"
    name = stem[:_LONGEST_NAME].strip()
    number = 1
    while name.lower() in (*taken, "history"):  # the second is a name of Excel's own
        number += 1
        ending = f" {number}"
        name = stem[: _LONGEST_NAME - len(ending)].strip() + ending
    taken.add(name.lower())
    return name


class _Formats:
    """The formats of the cells of a workbook, each made once."""

    def __init__(self, workbook: "Workbook", look: Look) -> None:
        self.look = look
        self.head = workbook.add_format({"bold": True, "bottom": 1, "align": "center"})
        self._workbook = workbook
        self._of_numbers: dict[str, Any] = {}

    def of_number(self, value: float | int, scale: Scale | None) -> Any:
        """Return the format of a number at the scale of its column, or at its own; that of a count has no decimals."""
        if isinstance(value, int):
            scale = Scale(0)
        elif scale is None:
            scale = digit_scale([value], self.look.digits)
        decimals = "0" * max(0, scale.decimals)
        if scale.exponent:
            text = "0." + "0" * ((self.look.digits or 4) - 1) + "E+00"
        elif decimals:
            text = f"0.{decimals}"
        else:
            text = "0"
        if text not in self._of_numbers:
            self._of_numbers[text] = self._workbook.add_format({"num_format": text})
        return self._of_numbers[text]


def _write_sheet(worksheet: "Worksheet", sheet: Sheet, rows: int, formats: _Formats) -> None:
    """Write the head, which stays in view and has filters, and the rows below it."""
    if sheet.warns:
        worksheet.set_tab_color("orange")
    worksheet.freeze_panes(1, 0)
    if sheet.columns:
        worksheet.autofilter(0, 0, rows, len(sheet.columns) - 1)
    for index, column in enumerate(sheet.columns):
        worksheet.set_column(index, index, _width_of(column))
        worksheet.write_string(0, index, column.head, formats.head)
    for row in range(rows):
        for index, column in enumerate(sheet.columns):
            value = column.cells[row] if row < len(column.cells) else None
            if isinstance(value, str):
                # never a formula, however it begins
                worksheet.write_string(row + 1, index, value)
            elif value is not None:
                worksheet.write_number(
                    row + 1, index, value, formats.of_number(value, column.scale)
                )


def _width_of(column: SheetColumn) -> int:
    """Return the width of a column that shows its head, with room for the filter, and its first cells."""
    texts = [cell for cell in column.cells[:_MEASURED_ROWS] if isinstance(cell, str)]
    longest = max((width(text) for text in texts), default=_NARROWEST)
    return min(_WIDEST, max(_NARROWEST, longest + 1, width(column.head) + 4))
