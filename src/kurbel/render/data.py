"""Results for programs: CSV and JSON with all digits, and the JSON Schema of the answers."""

import csv
import json
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from itertools import chain, repeat
from typing import Any

from kurbel import __version__
from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.numbers import decimal, rounded, whole_if_integral
from kurbel.render.text import TURNING
from kurbel.report.tables import Column, KeyValue, Part, PlaceTable, Provenance, Report, Value

FORMAT = 1
"""Number of the format of JSON; it changes when a script that reads it would break."""
_AT_ONCE = 10_000
"""Values of a column of JSON that are written together."""
_FORMULA = ("=", "+", "-", "@", "＝", "＋", "－", "＠")
"""What a formula begins with in a spreadsheet, also in wide characters."""
_ESCAPED = {code: f"\\u{code:04x}" for code in TURNING}
_FIRST = {"ratios": "rod_ratio", "bearings": "bearing", "scenes": "scene"}
"""Group of the parts of a report -> head of the column with their names, if not `cylinder`."""


# CSV


class _Echo:
    """A file for `csv.writer`, which then returns each line."""

    def write(self, text: str) -> str:
        return text


def csv_line(look: Look) -> Callable[[Iterable[Any]], str]:
    """Return what makes a line of texts, numbers and None; with the decimal comma, `;` parts the cells."""
    return csv.writer(_Echo(), delimiter=";" if look.comma else ",", lineterminator="\n").writerow


def csv_cell(value: Any, look: Look) -> Any:
    """Return a value for `csv_line`: an apostrophe marks a text that a spreadsheet would take for a formula.

    Numbers have the digits that are wanted, or all; the values of a list are parted by blanks.
    """
    if isinstance(value, str):
        text = look.data(value)
        return f"'{text}" if text.startswith(_FORMULA) else text
    if isinstance(value, tuple):
        return " ".join(str(csv_cell(one, look)) for one in value)
    if value is None or not look.comma:
        return rounded(value, look.digits)
    return decimal(repr(rounded(value, look.digits)), True)


def csv_text(report: Report, look: Look) -> Iterator[str]:
    """Yield head and rows as CSV.

    These are the tables over the crank angle; if there are none, the tables of places; if there are none either, the
    key values, a row for each and for each value of a list. Several parts follow one another, with their names in a
    first column.
    """
    parts = report.all_parts
    if any(part.columns for part in parts):
        blocks = [(part, {_head(one): _cells(one, look) for one in part.columns}) for part in parts if part.columns]
        heads = _merged(list(columns) for _, columns in blocks)
        named = len(blocks) + sum(bool(part.nowhere) for part in report.parts)
    elif tables := [(part, table) for part in parts for table in part.place_tables]:
        blocks = [(part, _place_cells(table, look)) for part, table in tables]
        names = dict.fromkeys(name for _, table in tables for name in table.heads)
        heads = ["table", *names, *dict.fromkeys(_head(one) for _, table in tables for one in table.columns)]
        named = len({id(part) for part, _ in tables})
    else:
        blocks = [(part, _key_value_cells(part, look)) for part in parts]
        heads, named = ["key_value", "unit", "value", "at_deg"], len(parts)
    first = [_FIRST.get(report.group, "cylinder")] if named > 1 or report.group in ("ratios", "scenes") else []
    line = csv_line(look)
    yield line([*first, *heads])
    for part, columns in blocks:
        name = [repeat(_name(part, look)) for _ in first]
        yield from map(line, zip(*name, *(columns.get(head, repeat("")) for head in heads)))


def _merged(orders: Iterable[list[str]]) -> list[str]:
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


def _name(part: Part, look: Look) -> Any:
    name = part.name if isinstance(part.name, str) else whole_if_integral(part.name)
    return csv_cell(name, replace(look, digits=None))


def _cells(column: Column, look: Look) -> Iterator[Any]:
    """Yield the values of a column; crank angles have all digits, whole ones no decimal point."""
    if column.id != "phi":
        return (csv_cell(value, look) for value in column.values)
    in_full = replace(look, digits=None)
    return (csv_cell(whole_if_integral(value), in_full) for value in column.values)


def _place_cells(table: PlaceTable, look: Look) -> dict[str, Iterator[Any]]:
    cells = {_head(column): _cells(column, look) for column in table.columns}
    for head, names in zip(table.heads, zip(*table.names)):
        cells[head] = (csv_cell(name, look) for name in names)
    return cells | {"table": repeat(table.id, len(table.names))}


def _key_value_cells(part: Part, look: Look) -> dict[str, Iterator[Any]]:
    pairs = [(one, value) for one in part.key_values for value in _values(one)]
    in_full = replace(look, digits=None)
    return {
        "key_value": (one.id for one, _ in pairs),
        "unit": (one.unit for one, _ in pairs),
        "value": (csv_cell(value, look) for _, value in pairs),
        "at_deg": (csv_cell(one.at_deg, in_full) for one, _ in pairs),
    }


def _values(one: KeyValue) -> tuple[Value, ...]:
    return one.value if isinstance(one.value, tuple) else (one.value,)


def _head(column: Column) -> str:
    """Return id and unit: `x_m`, `b_m/s^2`, `M_Nm`, or the id alone for a ratio."""
    unit = column.unit.replace(" abs", "_abs").replace(" ", "")
    return f"{column.id}_{unit}" if unit else column.id


# JSON


def json_text(report: Report, look: Look) -> Iterator[str]:
    """Yield one JSON object in pieces, each column on a line of its own. Raises UsageError for a decimal comma."""
    if look.comma:
        raise UsageError("--decimal comma: JSON has the decimal point only; use it with table, csv or markdown")
    content = {"kurbel": __version__, "format": FORMAT, "command": report.command}
    if report.machine is not None:
        content |= {"machine": report.machine, **_made_from(report.provenance)}
    if report.head:
        content["head"] = list(report.head)
    if report.group == "ratios":
        content["ratios"] = [_ratio(part, look) for part in report.parts]
    elif report.parts:
        content[report.group] = [{"name": part.name, **_results(part, look)} for part in report.parts]
    if report.whole is not None:
        content |= {f"machine_{key}": value for key, value in _results(report.whole, look).items()}
    if report.notes:
        content["notes"] = list(report.notes)
    return chain(_pieces(content, "\n", look), "\n")


def findings_json(
    machine: str | None, made_from: Provenance | None, findings: list[dict[str, Any]], look: Look
) -> Iterator[str]:
    """Yield a check as one JSON object in pieces, a line for every finding; machine: None where the file has none."""
    head = {"kurbel": __version__, "format": FORMAT, "command": "check", "machine": machine}
    return chain(_pieces({**head, **_made_from(made_from), "findings": findings}, "\n", look), "\n")


def _made_from(given: Provenance | None) -> dict[str, Any]:
    if given is None:
        return {}
    versions = {"kurbel": __version__, **given.versions}
    return {"inputs": [one._asdict() for one in given.inputs], "overrides": list(given.overrides), "versions": versions}


def _ratio(part: Part, look: Look) -> dict[str, Any]:
    ratio = whole_if_integral(float(part.name))
    results = {key: value for key, value in _results(part, look).items() if value}
    return {"rod_ratio": "inf" if ratio == float("inf") else ratio, **results}


def _results(part: Part, look: Look) -> dict[str, Any]:
    tables = {"place_tables": [_place_table(one) for one in part.place_tables]} if part.place_tables else {}
    return {
        "columns": list(part.columns),
        **tables,
        "key_values": [_key_value(one, look) for one in part.key_values],
        "left_out": [{"what": one.what, "why": one.why} for one in part.left_out],
        "warnings": list(part.warnings),
    }


def _place_table(table: PlaceTable) -> dict[str, Any]:
    rows = {"rows": [dict(zip(table.heads, names)) for names in table.names]} if table.heads else {}
    return {"id": table.id, "title": table.title, **rows, "columns": list(table.columns)}


def _key_value(one: KeyValue, look: Look) -> dict[str, Any]:
    values = [rounded(value, look.digits) for value in _values(one)]
    value = values if isinstance(one.value, tuple) else values[0]
    content = {"id": one.id, "symbol": one.symbol, "unit": one.unit, "value": value}
    return content if one.at_deg is None else content | {"at_deg": rounded(one.at_deg, None)}


def _pieces(node: Any, line_end: str, look: Look) -> Iterator[str]:
    """Yield a node in pieces: on one line, or its entries on lines of their own where one of them holds an object."""
    if isinstance(node, Column):
        yield from _column_pieces(node, look)
    elif not _holds_object(node):
        yield _written(node, look)
    else:
        deeper = line_end + " "
        is_object = isinstance(node, dict)
        entries = node.items() if is_object else (("", one) for one in node)
        for index, (key, child) in enumerate(entries):
            yield ("," if index else "{" if is_object else "[") + deeper
            yield f"{_written(key, look)}: " if is_object else ""
            yield from _pieces(child, deeper, look)
        yield "}" if is_object else "]"


def _holds_object(node: Any) -> bool:
    children = node.values() if isinstance(node, dict) else node if isinstance(node, list) else ()
    return any(isinstance(child, (dict, Column)) or _holds_object(child) for child in children)


def _column_pieces(column: Column, look: Look) -> Iterator[str]:
    """Yield a column in pieces: a long one is never held as text. Crank angles have all digits."""
    head = _written({"id": column.id, "symbol": column.symbol, "unit": column.unit}, look)
    yield head[:-1] + ', "values": ['
    for start in range(0, len(column.values), _AT_ONCE):
        values = column.values[start : start + _AT_ONCE]
        shown = [whole_if_integral(one) if column.id == "phi" else rounded(one, look.digits) for one in values]
        yield (", " if start else "") + json.dumps(shown, allow_nan=False)[1:-1]
    yield f'], "marked": {list(column.marked)}}}' if column.marked else "]}"


def _written(node: Any, look: Look) -> str:
    """Return a node on one line; characters that turn the writing are escaped."""
    return json.dumps(node, ensure_ascii=not look.has("φ"), allow_nan=False).translate(_ESCAPED)


# the JSON Schema of what `-f json` prints

_TEXT = {"type": "string"}
_TEXTS = {"type": "array", "items": _TEXT}
_NUMBER = {"type": ["number", "null"]}
_ANGLE = {"type": "number", "description": "crank angle of the extreme in degrees"}


def _ref(name: str) -> dict[str, str]:
    return {"$ref": f"#/definitions/{name}"}


def _object(needed: dict[str, Any], **free: Any) -> dict[str, Any]:
    """Return the schema of an object that has these keys and no others."""
    return {
        "type": "object",
        "properties": needed | free,
        "required": list(needed),
        "additionalProperties": False,
    }


def _list(name: str) -> dict[str, Any]:
    return {"type": "array", "items": _ref(name)}


_RESULTS = {
    "columns": _list("column"),
    "key_values": _list("key_value"),
    "left_out": _list("left_out"),
    "warnings": _TEXTS,
}
_TABLES = {"place_tables": _list("place_table")}
_DEFINITIONS = {
    "column": _object(
        {"id": _TEXT, "symbol": _TEXT, "unit": _TEXT, "values": {"type": "array", "items": _NUMBER}},
        marked={"type": "array", "items": {"type": "integer"}, "description": "places of values that a note speaks of"},
    ),
    "key_value": _object(
        {
            "id": _TEXT,
            "symbol": _TEXT,
            "unit": _TEXT,
            "value": {"anyOf": [_NUMBER, {"type": "array", "items": _NUMBER}]},
        },
        at_deg=_ANGLE,
    ),
    "left_out": _object({"what": _TEXT, "why": _TEXT}),
    "place_table": _object(
        {
            "id": _TEXT,
            "title": _TEXT,
            "columns": _list("column"),
        },
        rows={
            "type": "array",
            "items": {"type": "object", "additionalProperties": _TEXT},
            "description": "names of the rows, absent if the first column names them",
        },
    ),
    "part": _object({"name": _TEXT, **_RESULTS}, **_TABLES),
    "ratio": _object({"rod_ratio": {"type": ["number", "string"]}, "columns": _list("column")}),
    "finding": _object(
        {
            "file": _TEXT,
            "line": {"type": ["integer", "null"]},
            "column": {"type": ["integer", "null"]},
            "key": {"type": ["string", "null"]},
            "message": _TEXT,
            "severity": {"enum": ["error", "warning", "info"]},
        }
    ),
    "input": _object({"file": _TEXT, "sha256": {"type": ["string", "null"]}}),
}


def answer_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft-07) of the answers of all commands but the lines of `kurbel sweep`."""
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "An answer of kurbel",
        **_object(
            {"kurbel": _TEXT, "format": {"const": FORMAT}, "command": _TEXT},
            machine={"type": ["string", "null"], "description": "null where a check finds none in the file"},
            inputs=_list("input"),
            overrides=_TEXTS,
            versions={"type": "object", "additionalProperties": _TEXT},
            head=_TEXTS,
            cylinders=_list("part"),
            bearings=_list("part"),
            ratios=_list("ratio"),
            scenes=_list("part"),
            findings=_list("finding"),
            notes=_TEXTS,
            **{f"machine_{key}": value for key, value in (_RESULTS | _TABLES).items()},
        ),
        "definitions": _DEFINITIONS,
    }
