"""CSV: one head row, one row per crank angle, numbers in full; names of the columns in ASCII with their units."""

from array import array
from collections.abc import Iterable, Iterator
from itertools import repeat

from kurbel.render import Look
from kurbel.render.numbers import decimal, exact, whole_if_integral
from kurbel.report.tables import Column, Part, Report, Value

_FIRST = {"ratios": "rod_ratio", "bearings": "bearing"}
"""Group of the parts of a report -> head of the column that tells them apart, if not `cylinder`."""
_FORMULA = ("=", "+", "-", "@", "＝", "＋", "－", "＠")
"""What a formula begins with in a spreadsheet, also in wide characters."""


def csv_text(report: Report, look: Look) -> Iterator[str]:
    """Yield the rows of the table as CSV with `\\n` line ends; with the decimal comma, `;` separates the columns.

    Several cylinders stand under one another, told apart by a first column; a column that one of them has not is
    empty there. Tables of places are written where nothing stands over the crank angle, one under another likewise;
    without them the key values, each on a row, of a list each of its values.
    """
    separator = ";" if look.comma else ","
    parts = [part for part in report.all_parts if part.columns]
    if parts:
        yield from _table(report, parts, look, separator)
        return
    places = any(part.place_tables for part in report.all_parts)
    for row in _place_rows(report, look) if places else _key_value_rows(report, look):
        yield _line(row, separator)


def _line(row: Iterable[str], separator: str) -> str:
    return separator.join(_quoted(text, separator) for text in row) + "\n"


def _table(report: Report, parts: list[Part], look: Look, separator: str) -> Iterator[str]:
    """Yield head and rows; a number is never quoted, so that none is looked at twice."""
    heads = _merged([[head(column) for column in part.columns] for part in parts])
    named = report.group == "ratios" or len([*parts, *(part for part in report.parts if part.nowhere)]) > 1
    first = _FIRST.get(report.group, "cylinder")
    yield _line([*([first] if named else []), *heads], separator)
    for part in parts:
        columns = {head(column): column for column in part.columns}
        texts = [_texts(columns.get(name), len(part.columns[0].values), look) for name in heads]
        name = [_quoted(_name(part, look), separator)] if named else []
        for row in zip(*texts):
            yield separator.join((*name, *row)) + "\n"


def _merged(orders: list[list[str]]) -> list[str]:
    """Return all names once, each new one before the known one that follows it in its own list."""
    merged: list[str] = []
    for order in orders:
        place = len(merged)
        for name in reversed(order):
            if name in merged:
                place = merged.index(name)
            else:
                merged.insert(place, name)
    return merged


def _key_value_rows(report: Report, look: Look) -> Iterator[list[str]]:
    named = len(report.all_parts) > 1
    yield [*([_FIRST.get(report.group, "cylinder")] if named else []), "key_value", "unit", "value", "at_deg"]
    for part in report.all_parts:
        for one in part.key_values:
            for value in one.value if isinstance(one.value, tuple) else (one.value,):
                texts = (one.id, one.unit, _number(value, look.digits, look), _number(one.at_deg, None, look))
                yield [*([_name(part, look)] if named else []), *texts]


def _place_rows(report: Report, look: Look) -> Iterator[list[str]]:
    tables = [(part, table) for part in report.all_parts for table in part.place_tables]
    heads = list(dict.fromkeys(name for _, table in tables for name in table.heads))
    columns = list(dict.fromkeys(head(column) for _, table in tables for column in table.columns))
    scenes = report.group == "scenes"
    named = scenes or any(part is not tables[0][0] for part, _ in tables)
    yield [*(["scene" if scenes else "cylinder"] if named else []), "table", *heads, *columns]
    for part, table in tables:
        texts = {head(column): [_number(v, look.digits, look) for v in column.values] for column in table.columns}
        texts |= {
            one: [_harmless(look.charset.data(name)) for name in names]
            for one, names in zip(table.heads, zip(*table.names))
        }
        blank = [""] * len(table.names)
        for row in zip(*(texts.get(name, blank) for name in (*heads, *columns))):
            yield [*([_name(part, look)] if named else []), table.id, *row]


def head(column: Column) -> str:
    """Return id and unit: `x_m`, `b_m/s^2`, `M_Nm`, or the id alone for a ratio."""
    unit = column.unit.replace(" abs", "_abs").replace(" ", "")
    return f"{column.id}_{unit}" if unit else column.id


def _name(part: Part, look: Look) -> str:
    if isinstance(part.name, str):
        return _harmless(look.charset.data(part.name))
    return _number(whole_if_integral(part.name), None, look)


def _harmless(name: str) -> str:
    """Return a name that a spreadsheet does not take for a formula: an apostrophe marks it as text."""
    return f"'{name}" if name[:1] in _FORMULA else name


def _texts(column: Column | None, count: int, look: Look) -> Iterator[str]:
    if column is None:
        return repeat("", count)
    if column.id == "phi":
        return ("" if value is None else _number(whole_if_integral(value), None, look) for value in column.values)
    if isinstance(column.values, array) and look.digits is None and not look.comma:
        return (repr(value + 0.0) for value in column.values)  # as `exact` writes them, in half the time
    return (_number(value, look.digits, look) for value in column.values)


def _number(value: Value, digits: int | None, look: Look) -> str:
    return "" if value is None else decimal(exact(value, digits), look.comma)


def _quoted(text: str, separator: str) -> str:
    if any(character in text for character in (separator, '"', "\n", "\r")):
        return '"' + text.replace('"', '""') + '"'
    return text
