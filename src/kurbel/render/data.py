"""Results for programs: CSV and JSON with all digits, and the JSON Schema of the answers."""

import json
from array import array
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain, repeat
from typing import Any, NamedTuple

from kurbel import __version__
from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.numbers import decimal, exact, rounded, whole_if_integral
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


class _Block(NamedTuple):
    """Rows of one part: head -> texts, quoted where they must be; a head that it lacks is empty there."""

    part: Part
    columns: Mapping[str, Iterable[str]]


def csv_text(report: Report, look: Look) -> Iterator[str]:
    """Yield head and rows as CSV with `\\n` line ends; with the decimal comma, `;` separates the columns.

    These are the tables over the crank angle; if there are none, the tables of places; if there are none either, the
    key values, a row for each and for each value of a list. Several parts follow one another, with their names in a
    first column.
    """
    parts = report.all_parts
    if any(part.columns for part in parts):
        heads, blocks = _angle_rows(report, look)
        named = report.group == "ratios" or len(blocks) + sum(bool(part.nowhere) for part in report.parts) > 1
    elif any(part.place_tables for part in parts):
        heads, blocks = _place_rows(report, look)
        named = report.group == "scenes" or any(one.part is not blocks[0].part for one in blocks)
    else:
        heads = ["key_value", "unit", "value", "at_deg"]
        blocks = [_Block(part, _key_value_columns(part, look)) for part in parts]
        named = len(parts) > 1
    separator = ";" if look.comma else ","
    first = [_FIRST.get(report.group, "cylinder")] if named else []
    yield separator.join([*first, *(quoted(head, look) for head in heads)]) + "\n"
    for part, columns in blocks:
        name = [_name(part, look)] if named else []
        for row in zip(*(columns.get(head, repeat("")) for head in heads)):
            yield separator.join((*name, *row)) + "\n"


def _angle_rows(report: Report, look: Look) -> tuple[list[str], list[_Block]]:
    """Return the heads of all parts, each new one before the known one that follows it in its part, and the blocks."""
    blocks = []
    heads: list[str] = []
    for part in report.all_parts:
        if part.columns:
            columns = {_head(column): _texts(column, look) for column in part.columns}
            blocks.append(_Block(part, columns))
            place = len(heads)
            for head in reversed(columns):
                if head in heads:
                    place = heads.index(head)
                else:
                    heads.insert(place, head)
    return heads, blocks


def _place_rows(report: Report, look: Look) -> tuple[list[str], list[_Block]]:
    blocks = []
    names: dict[str, None] = {}
    quantities: dict[str, None] = {}
    for part in report.all_parts:
        for table in part.place_tables:
            columns = {_head(column): [number(value, look) for value in column.values] for column in table.columns}
            quantities |= dict.fromkeys(columns)
            names |= dict.fromkeys(table.heads)
            for head, cells in zip(table.heads, zip(*table.names)):
                columns[head] = [quoted(harmless(look.charset.data(cell)), look) for cell in cells]
            columns["table"] = [quoted(table.id, look)] * len(table.names)
            blocks.append(_Block(part, columns))
    return ["table", *names, *quantities], blocks


def _key_value_columns(part: Part, look: Look) -> dict[str, list[str]]:
    columns: dict[str, list[str]] = {"key_value": [], "unit": [], "value": [], "at_deg": []}
    for one in part.key_values:
        for value in one.value if isinstance(one.value, tuple) else (one.value,):
            columns["key_value"].append(quoted(one.id, look))
            columns["unit"].append(quoted(one.unit, look))
            columns["value"].append(number(value, look))
            columns["at_deg"].append(number(one.at_deg, look, in_full=True))
    return columns


def _head(column: Column) -> str:
    """Return id and unit: `x_m`, `b_m/s^2`, `M_Nm`, or the id alone for a ratio."""
    unit = column.unit.replace(" abs", "_abs").replace(" ", "")
    return f"{column.id}_{unit}" if unit else column.id


def _name(part: Part, look: Look) -> str:
    if isinstance(part.name, str):
        return quoted(harmless(look.charset.data(part.name)), look)
    return number(whole_if_integral(part.name), look, in_full=True)


def _texts(column: Column, look: Look) -> Iterator[str]:
    """Yield the values of a column; angles have all digits, whole ones no decimal point."""
    if column.id == "phi":
        values = (None if value is None else whole_if_integral(value) for value in column.values)
        return (number(value, look, in_full=True) for value in values)
    if isinstance(column.values, array) and look.digits is None and not look.comma:
        return (repr(value + 0.0) for value in column.values)  # as `exact` writes them, in half the time
    return (number(value, look) for value in column.values)


def number(value: Value, look: Look, in_full: bool = False) -> str:
    """Return a number with the digits that are wanted, or all; nothing for no value."""
    return "" if value is None else decimal(exact(value, None if in_full else look.digits), look.comma)


def harmless(name: str) -> str:
    """Return a name that a spreadsheet does not take for a formula: an apostrophe marks it as text."""
    return f"'{name}" if name[:1] in _FORMULA else name


def quoted(text: str, look: Look) -> str:
    """Return a text of CSV, in quotes if it has the separator, a quote or a line end."""
    if any(character in text for character in (";" if look.comma else ",", '"', "\n", "\r")):
        return '"' + text.replace('"', '""') + '"'
    return text


# JSON


def json_text(report: Report, look: Look) -> Iterator[str]:
    """Yield one JSON object in pieces, each column on a line of its own. Raises UsageError for a decimal comma."""
    if look.comma:
        raise UsageError("--decimal comma: JSON has the decimal point only; use it with table, csv or markdown")
    content = {"kurbel": __version__, "format": FORMAT, "command": report.command}
    if report.machine is not None:
        content |= {"machine": report.machine, **_provenance(report.provenance)}
    if report.head:
        content["head"] = report.head
    if report.parts:
        name = _ratio if report.group == "ratios" else _named
        content[report.group] = [name(part, look) for part in report.parts]
    if report.whole is not None:
        content |= {f"machine_{key}": value for key, value in _results(report.whole, look).items()}
    if report.notes:
        content["notes"] = list(report.notes)
    return chain(_pieces(content, "", look), "\n")


def findings_json(
    machine: str | None, made_from: Provenance | None, findings: list[dict[str, Any]], look: Look
) -> Iterator[str]:
    """Yield a check as one JSON object in pieces, a line for every finding; machine: None where the file has none."""
    head = {"kurbel": __version__, "format": FORMAT, "command": "check", "machine": machine}
    return chain(_pieces({**head, **_provenance(made_from), "findings": findings}, "", look), "\n")


def _provenance(given: Provenance | None) -> dict[str, Any]:
    """Return what results were made from and with."""
    if given is None:
        return {}
    versions = {"kurbel": __version__, **given.versions}
    return {"inputs": [vars(one) for one in given.inputs], "overrides": given.overrides, "versions": versions}


def _named(part: Part, look: Look) -> dict[str, Any]:
    return {"name": part.name, **_results(part, look)}


def _ratio(part: Part, look: Look) -> dict[str, Any]:
    ratio = whole_if_integral(float(part.name))
    results = {key: value for key, value in _results(part, look).items() if value}
    return {"rod_ratio": "inf" if ratio == float("inf") else ratio, **results}


def _results(part: Part, look: Look) -> dict[str, Any]:
    tables = {"place_tables": [_place_table(one, look) for one in part.place_tables]} if part.place_tables else {}
    return {
        "columns": [_column(column, look) for column in part.columns],
        **tables,
        "key_values": [_key_value(one, look) for one in part.key_values],
        "left_out": [{"what": one.what, "why": one.why} for one in part.left_out],
        "warnings": list(part.warnings),
    }


def _place_table(table: PlaceTable, look: Look) -> dict[str, Any]:
    rows = {"rows": [dict(zip(table.heads, names)) for names in table.names]} if table.heads else {}
    columns = [_column(column, look) for column in table.columns]
    return {"id": table.id, "title": table.title, **rows, "columns": columns}


def _column(column: Column, look: Look) -> dict[str, Any]:
    """Return a column, whose values are rounded only when they are written: a long table is never held."""

    def values() -> Iterator[str]:
        for start in range(0, len(column.values), _AT_ONCE):
            piece = [_value(value, column.id == "phi", look) for value in column.values[start : start + _AT_ONCE]]
            yield (", " if start else "") + json.dumps(piece, allow_nan=False)[1:-1]

    content = {"id": column.id, "symbol": column.symbol, "unit": column.unit, "values": values}
    return content | ({"marked": list(column.marked)} if column.marked else {})


def _value(value: Value, is_angle: bool, look: Look) -> Value:
    if value is None:
        return None
    return whole_if_integral(value) if is_angle else rounded(value, look.digits)


def _key_value(one: KeyValue, look: Look) -> dict[str, Any]:
    value = [rounded(each, look.digits) for each in one.value] if isinstance(one.value, tuple) else one.value
    if isinstance(value, (int, float)):
        value = rounded(value, look.digits)
    content = {"id": one.id, "symbol": one.symbol, "unit": one.unit, "value": value}
    return content if one.at_deg is None else content | {"at_deg": rounded(one.at_deg, None)}


def _pieces(node: Any, indent: str, look: Look) -> Iterator[str]:
    """Yield a node on one line, or its entries on lines of their own where one of them holds an object.

    node: what JSON holds, or a function that yields the values of a list as text.
    """
    if callable(node):
        yield from chain("[", node(), "]")
        return
    if not isinstance(node, (dict, list, tuple)):
        yield _written(node, look)
        return
    broken, deeper = _holds_object(node), indent + " "
    before, between = ("\n" + deeper, ",\n" + deeper) if broken else ("", ", ")
    opening, closing = "{}" if isinstance(node, dict) else "[]"
    keys = [f"{_written(key, look)}: " for key in node] if isinstance(node, dict) else [""] * len(node)
    yield opening + before
    for index, (key, child) in enumerate(zip(keys, node.values() if isinstance(node, dict) else node)):
        yield (between if index else "") + key
        yield from _pieces(child, deeper, look)
    yield closing


def _written(node: Any, look: Look) -> str:
    """Return a text, number or null; characters that turn the writing are escaped."""
    return json.dumps(node, ensure_ascii=not look.charset.has("φ"), allow_nan=False).translate(_ESCAPED)


def _holds_object(node: Any) -> bool:
    children = node.values() if isinstance(node, dict) else node if isinstance(node, (list, tuple)) else ()
    return any(isinstance(child, dict) or _holds_object(child) for child in children)


# the JSON Schema of what `-f json` prints

_TEXT = {"type": "string"}
_TEXTS = {"type": "array", "items": _TEXT}
_NUMBER = {"type": ["number", "null"]}
_ANGLE = {"type": "number", "description": "crank angle in degrees at which it stands"}


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
            "description": "names of the rows, absent where the first column tells them",
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
