"""JSON as the contract says: one object, numbers in full, missing values null."""

import json
from collections.abc import Callable, Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any, NamedTuple

from kurbel import __version__
from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.numbers import rounded, whole_if_integral
from kurbel.report.tables import Column, KeyValue, Part, PlaceTable, Provenance, Report, Value

if TYPE_CHECKING:
    from kurbel.report.check import Findings

FORMAT = 1
"""Number of the output format; it changes when a script that reads it would break."""


def json_text(report: Report, look: Look) -> Iterator[str]:
    """Return one JSON object in pieces, each column on a line of its own. Raises UsageError for a decimal comma."""
    if look.comma:
        raise UsageError("--decimal comma: JSON has the decimal point only; use it with table, csv or markdown")
    return _lines(_report(report, look.digits), look)


def findings_json(found: "Findings", look: Look) -> Iterator[str]:
    """Return a check as one JSON object in pieces, a line for every finding."""
    content = {
        **_head("check"),
        "machine": found.machine,
        **_provenance(found.provenance),
        "findings": [one._asdict() for one in found.findings],
    }
    return _lines(content, look)


def _lines(content: dict[str, Any], look: Look) -> Iterator[str]:
    return chain(_pieces(content, "", ascii_only=not look.charset.has("φ")), "\n")


def _head(command: str) -> dict[str, Any]:
    """Return what every object begins with."""
    return {"kurbel": __version__, "format": FORMAT, "command": command}


def _provenance(given: Provenance | None) -> dict[str, Any]:
    """Return what results were made from and with."""
    if given is None:
        return {}
    versions = {"kurbel": __version__, **given.versions}
    return {"inputs": [vars(i) for i in given.inputs], "overrides": list(given.overrides), "versions": versions}


def _report(report: Report, digits: int | None) -> dict[str, Any]:
    content = _head(report.command)
    if report.machine is not None:
        content |= {"machine": report.machine, **_provenance(report.provenance)}
    if report.head:
        content["head"] = list(report.head)
    if report.parts:
        ratios = report.group == "ratios"
        content[report.group] = [
            _ratio(part, digits) if ratios else {"name": part.name, **_results(part, digits)} for part in report.parts
        ]
    if report.whole is not None:
        content |= {f"machine_{key}": value for key, value in _results(report.whole, digits).items()}
    if report.notes:
        content["notes"] = list(report.notes)
    return content


def _ratio(part: Part, digits: int | None) -> dict[str, Any]:
    ratio = whole_if_integral(float(part.name))
    results = {key: value for key, value in _results(part, digits).items() if value}
    return {"rod_ratio": "inf" if ratio == float("inf") else ratio, **results}


def _results(part: Part, digits: int | None) -> dict[str, Any]:
    return {
        "columns": [_column(column, digits) for column in part.columns],
        **({"place_tables": [_place_table(one, digits) for one in part.place_tables]} if part.place_tables else {}),
        "key_values": [_key_value(key_value, digits) for key_value in part.key_values],
        "left_out": [{"what": one.what, "why": one.why} for one in part.left_out],
        "warnings": list(part.warnings),
    }


def _place_table(table: PlaceTable, digits: int | None) -> dict[str, Any]:
    rows = [dict(zip(table.heads, names)) for names in table.names]
    columns = [_column(column, digits) for column in table.columns]
    return {"id": table.id, "title": table.title, **({"rows": rows} if table.heads else {}), "columns": columns}


def _column(column: Column, digits: int | None) -> dict[str, Any]:
    if column.id == "phi":
        values = _Values(column.values, lambda value: None if value is None else whole_if_integral(value))
    else:
        values = _Values(column.values, lambda value: _value(value, digits))
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


class _Values(NamedTuple):
    """The values of a column, and how each is written."""

    values: Sequence[Value]
    written: Callable[[Value], Value]

    def pieces(self) -> Iterator[str]:
        """Yield the list in pieces that are short beside a long column."""
        yield "["
        for start in range(0, len(self.values), _AT_ONCE):
            piece = [self.written(value) for value in self.values[start : start + _AT_ONCE]]
            yield (", " if start else "") + json.dumps(piece, allow_nan=False)[1:-1]
        yield "]"


_AT_ONCE = 10_000


def _pieces(node: Any, indent: str, ascii_only: bool) -> Iterator[str]:
    """Yield a node on one line, or its entries on lines of their own where one of them holds an object."""
    if isinstance(node, _Values):
        yield from node.pieces()
    elif not isinstance(node, (dict, list)):
        yield json.dumps(node, ensure_ascii=ascii_only, allow_nan=False)
    else:
        broken, deeper = _holds_object(node), indent + " "
        before, between = ("\n" + deeper, ",\n" + deeper) if broken else ("", ", ")
        opening, closing = "{}" if isinstance(node, dict) else "[]"
        keys = [json.dumps(key, ensure_ascii=ascii_only) + ": " for key in node] if opening == "{" else [""] * len(node)
        yield opening + before
        for index, (key, child) in enumerate(zip(keys, node.values() if isinstance(node, dict) else node)):
            yield (between if index else "") + key
            yield from _pieces(child, deeper, ascii_only)
        yield closing


def _holds_object(node: Any) -> bool:
    children = node.values() if isinstance(node, dict) else node if isinstance(node, list) else ()
    return any(isinstance(child, dict) or _holds_object(child) for child in children)
