"""Results for programs: CSV and JSON with all digits. The JSON Schema of the answers is in answers.schema.json."""

import csv
import json
import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from html import escape
from itertools import chain, repeat
from typing import Any

from kurbel import __version__
from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.numbers import decimal, rounded, whole_if_integral
from kurbel.render.text import TURNING
from kurbel.report.tables import Column, Part, Provenance, Report

FORMAT = 1
"""Number of the format of JSON; it changes when a script that reads it would break."""
_FORMULA = ("=", "+", "-", "@", "＝", "＋", "－", "＠")
"""Characters that begin a formula in a spreadsheet, also wide ones."""
_ESCAPED = {code: f"\\u{code:04x}" for code in TURNING}
_FIRST = {"ratios": "rod_ratio", "bearings": "bearing", "scenes": "scene"}
"""Group of the parts of a report -> head of the column with their names, if not `cylinder`."""


# CSV


class _Echo:
    """A file for `csv.writer`, which then returns each line."""

    def write(self, text: str) -> str:
        return text


def csv_line(look: Look) -> Callable[[Iterable[object]], str]:
    """Return a function that makes a line of texts, numbers and None; with a decimal comma the separator is `;`."""
    return csv.writer(_Echo(), delimiter=";" if look.comma else ",", lineterminator="\n").writerow


def csv_cell(value: Any, look: Look, in_full: bool = False) -> object:
    """Return a value for `csv_line`: an apostrophe marks a text that a spreadsheet would take for a formula.

    Numbers have the digits that are wanted, or all; the values of a list are parted by blanks.
    """
    if isinstance(value, str):
        text = look.data(value)
        return f"'{text}" if text.startswith(_FORMULA) else text
    if isinstance(value, tuple):
        return " ".join(str(csv_cell(one, look)) for one in value)
    number = rounded(value, None if in_full else look.digits)
    return number if value is None or not look.comma else decimal(repr(number), True)


def csv_text(report: Report, look: Look) -> Iterator[str]:
    """Yield head and rows as CSV.

    These are the tables over the crank angle; if there are none, the tables of places; if there are none either, the
    key values, a row for each and for each value of a list. Several parts follow one another, with their names in a
    first column.
    """
    parts = report.all_parts
    blocks: list[tuple[Part, dict[str, Iterable[object]]]] = []  # the cells of a part by the heads of their columns
    if any(part.columns for part in parts):
        blocks = [(part, _columns(part.columns, look)) for part in parts if part.columns]
        named = len(blocks) + sum(bool(part.nowhere) for part in report.parts)
        # all heads once, each new one before the known one that follows it in its own table
        heads: list[str] = []
        for _, columns in blocks:
            place = len(heads)
            for head in reversed(columns):
                if head in heads:
                    place = heads.index(head)
                else:
                    heads.insert(place, head)
    elif tables := [(part, table) for part in parts for table in part.place_tables if table.id != "pistons"]:
        for part, table in tables:
            names = ((csv_cell(name, look) for name in column) for column in zip(*table.names))
            cells = {"table": repeat(table.id, len(table.names)), **dict(zip(table.heads, names))}
            blocks.append((part, cells | _columns(table.columns, look)))
        first = dict.fromkeys(head for _, table in tables for head in table.heads)
        heads = list(dict.fromkeys(("table", *first, *(head for _, columns in blocks for head in columns))))
        named = len({id(part) for part, _ in blocks})
    else:
        heads, named = ["key_value", "unit", "value", "at_deg"], len(parts)
        for part in parts:
            rows = []
            for one in part.key_values:
                at = csv_cell(one.at_deg, look, True)
                values = one.value if isinstance(one.value, tuple) else (one.value,)
                rows += [(one.id, one.unit, csv_cell(value, look), at) for value in values]
            blocks.append((part, dict(zip(heads, zip(*rows)))))
    name = [_FIRST.get(report.group, "cylinder")] if named > 1 or report.group in ("ratios", "scenes") else []
    line = csv_line(look)
    yield line([*name, *heads])
    for part, columns in blocks:
        of = part.name if isinstance(part.name, str) else whole_if_integral(part.name)
        named_rows = [repeat(csv_cell(of, look, True)) for _ in name]
        longest = zip(*named_rows, *(columns.get(head, repeat("")) for head in heads)) if columns else ()
        yield from map(line, longest)


def _columns(columns: Iterable[Column], look: Look) -> dict[str, Iterable[object]]:
    """Return the cells of columns by id and unit: `x_m`, `b_m/s^2`, `M_Nm`, or the id alone for a ratio.

    Crank angles have all digits, whole ones no decimal point.
    """
    found: dict[str, Iterable[object]] = {}
    for one in columns:
        unit = one.unit.replace(" abs", "_abs").replace(" ", "")
        angle = one.id == "phi"
        values = map(whole_if_integral, one.values) if angle else one.values
        found[f"{one.id}_{unit}" if unit else one.id] = map(partial(csv_cell, look=look, in_full=angle), values)
    return found


# JSON


def json_text(report: Report, look: Look) -> Iterator[str]:
    """Yield one JSON object in pieces, each column on a line of its own. Raises UsageError for a decimal comma."""
    if look.comma:
        raise UsageError("--decimal comma: JSON has the decimal point only; use it with table, csv or markdown")
    content: dict[str, Any] = {"kurbel": __version__, "format": FORMAT, "command": report.command}
    if report.machine is not None:
        content |= {"machine": report.machine, **_made_from(report.provenance)}
    if report.head:
        content["head"] = list(report.head)
    if report.group == "ratios":
        content["ratios"] = []
        for part in report.parts:
            ratio = whole_if_integral(float(part.name))
            results = {key: value for key, value in _results(part, look).items() if value}
            content["ratios"].append({"rod_ratio": "inf" if ratio == float("inf") else ratio, **results})
    elif report.parts:
        content[report.group] = [{"name": part.name, **_results(part, look)} for part in report.parts]
    if report.whole is not None:
        whole = _results(report.whole, look).items()
        content |= {f"machine_{key}": value for key, value in whole if value or report.group != "ratios"}
    if report.notes:
        content["notes"] = list(report.notes)
    return chain(_pieces(content, "\n", look), "\n")


def findings_json(
    machine: str | None, made_from: Provenance | None, findings: list[dict[str, object]], look: Look
) -> Iterator[str]:
    """Yield a check as one JSON object in pieces, a line for every finding; machine: None where the file has none."""
    head = {"kurbel": __version__, "format": FORMAT, "command": "check", "machine": machine}
    return chain(_pieces({**head, **_made_from(made_from), "findings": findings}, "\n", look), "\n")


def findings_junit(checks: Sequence[tuple[str, Sequence[Mapping[str, Any]]]], look: Look) -> Iterator[str]:
    """Yield checks as JUnit XML: a suite for every file, given with its findings, and a case for every finding.

    An error is a failure with its sentence; warnings and what is left out pass and have theirs as output. The name of
    the case of a limit has no values, so that a CI service compares runs by it, that of an error of the file is the
    sentence after its key, and none occurs twice. Elements and attributes are those of the schema of Jenkins.
    """

    def quoted(text: str) -> str:
        return escape(look.data(text))

    failures = sum(one["severity"] == "error" for _, found in checks for one in found)
    total = sum(max(len(found), 1) for _, found in checks)
    yield f'<?xml version="1.0" encoding="UTF-8"?>\n<testsuites name="kurbel" tests="{total}" failures="{failures}">\n'
    for file, found in checks:
        name, broken = quoted(file), sum(one["severity"] == "error" for one in found)
        yield f'<testsuite name="{name}" tests="{max(len(found), 1)}" failures="{broken}" errors="0" skipped="0">\n'
        if not found:  # a file of results without a test counts as a fault
            yield f'<testcase classname="{name}" name="valid machine"/>\n'
        names = Counter[str]()
        for one in found:
            message, key = one["message"], one["key"] or ""
            if key.startswith(("limits.", "expect.")) and message.startswith(key.partition(".")[2]):
                own = message.partition(": ")[0]
            else:
                plain = one["severity"] != "error" or message.startswith(key)
                own = message = message if plain else f"{key}: {message}"
            names[own] += 1
            own += f" ({names[own]})" if names[own] > 1 else ""
            yield f'<testcase classname="{name}" name="{quoted(own)}">'
            if one["severity"] == "error":
                place = ":".join(str(part) for part in (file, one["line"], one["column"]) if part)
                yield f'<failure message="{quoted(message)}" type="error">{quoted(f"{place}: {message}")}</failure>'
            else:
                yield f"<system-out>{quoted(message)}</system-out>"
            yield "</testcase>\n"
        yield "</testsuite>\n"
    yield "</testsuites>\n"


def _made_from(given: Provenance | None) -> dict[str, object]:
    if given is None:
        return {}
    versions = {"kurbel": __version__, **given.versions}
    return {"inputs": [one._asdict() for one in given.inputs], "overrides": list(given.overrides), "versions": versions}


def _results(part: Part, look: Look) -> dict[str, object]:
    """Return what JSON has of a part; its columns are still to be written, one after another."""
    tables, key_values, pistons = [], [], list[dict[str, object]]()
    for table in part.place_tables:
        if table.id == "pistons":
            for name, *values in zip((names[0] for names in table.names), *(one.values for one in table.columns)):
                figures = ((one, rounded(value, look.digits)) for one, value in zip(table.columns, values))
                own = [{"id": one.id, "symbol": one.symbol, "unit": one.unit, "value": value} for one, value in figures]
                pistons.append({"name": name, "key_values": own})
            continue
        rows = {"rows": [dict(zip(table.heads, names)) for names in table.names]} if table.heads else {}
        tables.append({"id": table.id, "title": table.title, **rows, "columns": list(table.columns)})
    for one in part.key_values:
        values = [
            rounded(value, look.digits) for value in (one.value if isinstance(one.value, tuple) else (one.value,))
        ]
        value = values if isinstance(one.value, tuple) else values[0]
        at = {} if one.at_deg is None else {"at_deg": rounded(one.at_deg, look.digits)}
        key_values.append({"id": one.id, "symbol": one.symbol, "unit": one.unit, "value": value, **at})
    return {
        "columns": list(part.columns),
        **({"place_tables": tables} if tables else {}),
        "key_values": key_values,
        **({"pistons": pistons} if pistons else {}),
        "left_out": [{"what": one.what, "why": one.why} for one in part.left_out],
        "warnings": list(part.warnings),
    }


def _pieces(node: Any, line_end: str, look: Look) -> Iterator[str]:
    """Yield a node in pieces: on one line, or with a line for each entry if one of them is an object."""
    if isinstance(node, Column):
        phi = node.id == "phi"  # crank angles have all digits
        values = [whole_if_integral(one) if phi else rounded(one, look.digits) for one in node.values]
        node = {"id": node.id, "symbol": node.symbol, "unit": node.unit, "values": values} | (
            {"marked": list(node.marked)} if node.marked else {}
        )
    elif _holds_object(node):
        deeper = line_end + " "
        is_object = isinstance(node, dict)
        for index, (key, child) in enumerate(node.items() if is_object else (("", one) for one in node)):
            yield ("," if index else "{" if is_object else "[") + deeper
            yield f"{json.dumps(key)}: " if is_object else ""
            yield from _pieces(child, deeper, look)
        yield "}" if is_object else "]"
        return
    # characters that turn the writing are escaped
    yield json.dumps(node, ensure_ascii=not look.has("φ"), allow_nan=False).translate(_ESCAPED)


def _holds_object(node: object) -> bool:
    children = node.values() if isinstance(node, dict) else node if isinstance(node, list) else ()
    return any(isinstance(child, (dict, Column)) or _holds_object(child) for child in children)


def answer_schema() -> Any:
    """Return the JSON Schema (draft-07) of the answers of all commands but the lines of `kurbel sweep`."""
    with open(os.path.join(os.path.dirname(__file__), "answers.schema.json"), encoding="utf-8") as file:
        return json.load(file)
