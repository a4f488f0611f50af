"""JSON as the contract says: one object, numbers in full, missing values null."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from kurbel import __version__
from kurbel.errors import UsageError
from kurbel.render.numbers import rounded, whole_if_integral

if TYPE_CHECKING:
    from kurbel.render import Look
    from kurbel.report.tables import Column, KeyValue, Part, Report, Value

FORMAT = 1
"""Number of the output format; it changes when a script that reads it would break."""


def json_text(report: Report, look: Look) -> str:
    """Return the report as one JSON object, each column on a line of its own. Raises UsageError for a decimal comma."""
    if look.comma:
        raise UsageError("--decimal comma: JSON has the decimal point only; use it with table, csv or markdown")
    content = _report(report, look.digits)
    return "".join(_lines(content, "", ascii_only=not look.charset.has("φ"))) + "\n"


def _report(report: Report, digits: int | None) -> dict[str, Any]:
    content: dict[str, Any] = {"kurbel": __version__, "format": FORMAT, "command": report.command}
    if report.machine is not None:
        content["machine"] = report.machine
    if report.head:
        content["head"] = list(report.head)
    if report.parts:
        of_part = _ratio if report.group == "ratios" else _cylinder
        content[report.group] = [of_part(part, digits) for part in report.parts]
    if report.whole is not None:
        content |= {f"machine_{key}": value for key, value in _results(report.whole, digits).items()}
    if report.notes:
        content["notes"] = list(report.notes)
    return content


def _cylinder(part: Part, digits: int | None) -> dict[str, Any]:
    return {"name": part.name, **_results(part, digits)}


def _ratio(part: Part, digits: int | None) -> dict[str, Any]:
    ratio = whole_if_integral(float(part.name))
    results = {key: value for key, value in _results(part, digits).items() if value}
    return {"rod_ratio": "inf" if ratio == float("inf") else ratio, **results}


def _results(part: Part, digits: int | None) -> dict[str, Any]:
    return {
        "columns": [_column(column, digits) for column in part.columns],
        **_place_tables(part, digits),
        "key_values": [_key_value(key_value, digits) for key_value in part.key_values],
        "left_out": [{"what": one.what, "why": one.why} for one in part.left_out],
        "warnings": list(part.warnings),
    }


def _place_tables(part: Part, digits: int | None) -> dict[str, Any]:
    if not part.place_tables:
        return {}
    tables = [
        {
            "id": table.id,
            "title": table.title,
            "rows": [dict(zip(table.heads, names)) for names in table.names],
            "columns": [_column(column, digits) for column in table.columns],
        }
        for table in part.place_tables
    ]
    return {"place_tables": tables}


def _column(column: Column, digits: int | None) -> dict[str, Any]:
    if column.id == "phi":
        values: list[Value] = [None if value is None else whole_if_integral(value) for value in column.values]
    else:
        values = [_value(value, digits) for value in column.values]
    content: dict[str, Any] = {"id": column.id, "symbol": column.symbol, "unit": column.unit, "values": values}
    return content | ({"marked": list(column.marked)} if column.marked else {})


def _key_value(one: KeyValue, digits: int | None) -> dict[str, Any]:
    if isinstance(one.value, tuple):
        value: Any = [_value(value, digits) for value in one.value]
    else:
        value = _value(one.value, digits)
    content = {"id": one.id, "symbol": one.symbol, "unit": one.unit, "value": value}
    return content | ({} if one.at_deg is None else {"at_deg": _value(one.at_deg, None)})


def _value(value: Value, digits: int | None) -> Value:
    return None if value is None else rounded(value, digits)


def _lines(node: Any, indent: str, ascii_only: bool) -> list[str]:
    """Return a node on one line, or its entries on lines of their own where one of them holds an object."""
    if not _holds_object(node):
        return [json.dumps(node, ensure_ascii=ascii_only, allow_nan=False)]
    deeper = indent + " "
    if isinstance(node, dict):
        keys = [json.dumps(key, ensure_ascii=ascii_only) + ": " for key in node]
        opening, children, closing = "{", list(node.values()), "}"
    else:
        keys, opening, children, closing = [""] * len(node), "[", node, "]"
    texts = [key + "".join(_lines(child, deeper, ascii_only)) for key, child in zip(keys, children)]
    return [opening, "\n", deeper, f",\n{deeper}".join(texts), closing]


def _holds_object(node: Any) -> bool:
    children = node.values() if isinstance(node, dict) else node if isinstance(node, list) else ()
    return any(isinstance(child, dict) or _holds_object(child) for child in children)
