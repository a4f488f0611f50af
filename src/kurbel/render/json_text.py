"""Results as JSON, and a check as JUnit XML, for programs. The JSON Schema of the answers is in answers.schema.json."""

import json
import os
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from hashlib import sha256
from itertools import chain, repeat
from typing import Any
from xml.etree import ElementTree

from kurbel import __version__
from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.text import TURNING, rounded, whole_if_integral
from kurbel.tables.tables import (
    PISTONS,
    CellValue,
    Column,
    InputFile,
    KeyValue,
    Part,
    PlaceTable,
    Provenance,
    Report,
)

Content = dict[str, object]
"""What becomes an object of JSON."""
FORMAT = 1
"""Number of the format of JSON; it changes when a script that reads it would break."""
_ESCAPED = {code: f"\\u{code:04x}" for code in TURNING}


def json_text(report: Report, look: Look) -> Iterator[str]:
    """Yield one JSON object in pieces, each column on a line of its own. Raises UsageError for a decimal comma."""
    if look.comma:
        raise UsageError(
            "--decimal comma: JSON has the decimal point only; use it with table, csv or markdown"
        )
    content: Content = {"kurbel": __version__, "format": FORMAT, "command": report.command}
    if report.machine is not None:
        content["machine"] = report.machine
        content |= _made_from(report.provenance and report.provenance())
    if report.head:
        content["head"] = list(report.head)
    with_ratios = report.group == "ratios"
    if with_ratios or report.parts:
        content[report.group] = [_named(part, with_ratios, look) for part in report.parts]
    if report.whole is not None:
        for key, value in _results(report.whole, look).items():
            if value or not with_ratios:
                content[f"machine_{key}"] = value
    if report.notes:
        content["notes"] = list(report.notes)
    return chain(_pieces(content, "\n", look), "\n")


def findings_json(
    machine: str | None, made_from: Provenance | None, findings: list[dict[str, object]], look: Look
) -> Iterator[str]:
    """Yield a check as one JSON object in pieces, a line for every finding; machine: None where the file has none."""
    content: Content = {
        "kurbel": __version__,
        "format": FORMAT,
        "command": "check",
        "machine": machine,
        **_made_from(made_from),
        "findings": findings,
    }
    return chain(_pieces(content, "\n", look), "\n")


def _made_from(provenance: Provenance | None) -> dict[str, object]:
    """Return what results depend on, as JSON has it."""
    if provenance is None:
        return {}
    return {
        "inputs": [{"file": file.file, "sha256": sha256_of(file)} for file in provenance.inputs],
        "overrides": list(provenance.overrides),
        "versions": {"kurbel": __version__, **provenance.versions},
    }


def sha256_of(file: InputFile) -> str | None:
    """Return the SHA-256 of a file that was read, None if it is gone."""
    if file.content is None:
        return None
    return sha256(file.content).hexdigest()


def _named(part: Part, ratio: bool, look: Look) -> Content:
    """Return a part with its name, or with its L/R, where empty results are left out."""
    results = _results(part, look)
    if not ratio:
        return {"name": part.name, **results}
    rod_ratio = "inf" if part.name == float("inf") else whole_if_integral(float(part.name))
    with_content = {key: value for key, value in results.items() if value}
    return {"rod_ratio": rod_ratio, **with_content}


def _results(part: Part, look: Look) -> Content:
    """Return what JSON has of a part; its columns are still to be written, one after another."""
    key_values = []
    for key_value in part.key_values:
        entry = _key_value(key_value, key_value.value, look)
        if key_value.at_deg is not None:
            entry["at_deg"] = rounded(key_value.at_deg, look.digits)
        if key_value.side:
            entry["side"] = key_value.side
        key_values.append(entry)

    tables, pistons = list[Content](), list[Content]()
    for table in part.place_tables:
        if table.id == PISTONS:
            pistons += _pistons(table, look)
        else:
            tables.append(_table(table))

    content: Content = {"columns": list(part.columns)}
    if tables:
        content["place_tables"] = tables
    content["key_values"] = key_values
    if pistons:
        content["pistons"] = pistons
    content["left_out"] = [left_out._asdict() for left_out in part.left_out]
    content["warnings"] = list(part.warnings)
    return content


def _key_value(
    quantity: Column | KeyValue, value: CellValue | tuple[float, ...], look: Look
) -> Content:
    """Return a key value with its numbers to the wanted digits."""
    shown: object
    if isinstance(value, tuple):
        shown = [rounded(number, look.digits) for number in value]
    else:
        shown = rounded(value, look.digits)
    return {"id": quantity.id, "symbol": quantity.symbol, "unit": quantity.unit, "value": shown}


def _pistons(table: PlaceTable, look: Look) -> Iterator[Content]:
    """Yield the pistons of a table as key values under their names."""
    for row, names in enumerate(table.names):
        key_values = [_key_value(column, column.values[row], look) for column in table.columns]
        yield {"name": names[0], "key_values": key_values}


def _table(table: PlaceTable) -> Content:
    """Return a table of places: the names of its rows, if they have any, and its columns."""
    content: Content = {"id": table.id, "title": table.title}
    if table.heads:
        content["rows"] = [dict(zip(table.heads, names)) for names in table.names]
    content["columns"] = list(table.columns)
    return content


def _pieces(node: object, line_end: str, look: Look) -> Iterator[str]:
    """Yield a node in pieces: on one line, or with a line for each entry if one of them is an object."""
    if isinstance(node, (dict, list)) and _holds_object(node):
        start, end = "{}" if isinstance(node, dict) else "[]"
        heads: Iterable[str] = repeat("")
        children: Iterable[object] = node
        if isinstance(node, dict):
            heads = (f"{json.dumps(key)}: " for key in node)
            children = node.values()
        for head, child in zip(heads, children):
            yield f"{start}{line_end} {head}"
            yield from _pieces(child, line_end + " ", look)
            start = ","
        yield end
        return

    content = _column(node, look) if isinstance(node, Column) else node
    # characters that turn the writing are escaped
    in_ascii = not look.has("φ")
    yield json.dumps(content, ensure_ascii=in_ascii, allow_nan=False).translate(_ESCAPED)


def _column(column: Column, look: Look) -> Content:
    """Return a column with its numbers to the wanted digits; crank angles have all of theirs."""
    if column.id == "phi":
        values = [whole_if_integral(angle) for angle in column.values]
    else:
        values = [rounded(value, look.digits) for value in column.values]
    content: Content = {
        "id": column.id,
        "symbol": column.symbol,
        "unit": column.unit,
        "values": values,
    }
    if column.marked:
        content["marked"] = column.marked
    return content


def _holds_object(node: object) -> bool:
    """Return whether an object of JSON is anywhere in a node."""
    if isinstance(node, dict):
        return any(_is_object(child) for child in node.values())
    if isinstance(node, list):
        return any(_is_object(child) for child in node)
    return False


def _is_object(node: object) -> bool:
    return isinstance(node, (dict, Column)) or _holds_object(node)


def answer_schema() -> object:
    """Return the JSON Schema (draft-07) of the answers of all commands but the lines of `kurbel sweep`."""
    with open(
        os.path.join(os.path.dirname(__file__), "answers.schema.json"), encoding="utf-8"
    ) as file:
        return json.load(file)


def indented(schema: object) -> str:
    """Return a schema as text, with escapes instead of Greek: valid in whatever encoding a shell redirects to."""
    return json.dumps(schema, indent=2, allow_nan=False) + "\n"


# JUnit


def findings_junit(
    checks: Sequence[tuple[str, Sequence[Mapping[str, Any]]]], look: Look
) -> Iterator[str]:
    """Yield checks as JUnit XML: a suite for every file, given with its findings, and a case for every finding.

    An error is a failure with its sentence; warnings pass and have theirs as output. What is left out is no test. The name of
    the case of a limit has no values, so that a CI service compares runs by it, that of an error of the file is the
    sentence after its key, and none occurs twice. Elements and attributes are those of the schema of Jenkins.
    """
    root = ElementTree.Element("testsuites", name="kurbel")
    for file, of_file in checks:
        findings = [finding for finding in of_file if not _is_left_out(finding)]
        file_name = look.data(file)
        failures = sum(finding["severity"] == "error" for finding in findings)
        attributes = {
            "name": file_name,
            "tests": str(max(len(findings), 1)),
            "failures": str(failures),
            "errors": "0",
            "skipped": "0",
        }
        suite = ElementTree.SubElement(root, "testsuite", attributes)
        if not findings:  # a file of results without a test counts as a fault
            ElementTree.SubElement(suite, "testcase", classname=file_name, name="valid machine")
        names = Counter[str]()
        for finding in findings:
            name, message = _junit_name(finding, look)
            names[name] += 1
            if names[name] > 1:
                name = f"{name} ({names[name]})"
            case = ElementTree.SubElement(suite, "testcase", classname=file_name, name=name)
            if finding["severity"] == "error":
                parts = (file_name, finding["line"], finding["column"])
                position = ":".join(str(part) for part in parts if part)
                failure = ElementTree.SubElement(case, "failure", message=message, type="error")
                failure.text = f"{position}: {message}"
            else:
                ElementTree.SubElement(case, "system-out").text = message
    ElementTree.indent(root, "")
    yield f'<?xml version="1.0" encoding="UTF-8"?>\n{ElementTree.tostring(root, "unicode")}\n'


def _is_left_out(finding: Mapping[str, Any]) -> bool:
    """Return whether it says what is left out, of the machine or of one of several cylinders."""
    return finding["severity"] == "info" and "left out: " in finding["message"]


def _junit_name(finding: Mapping[str, Any], look: Look) -> tuple[str, str]:
    """Return the name of the case of a finding, and its sentence."""
    key = finding["key"] or ""
    message = look.data(finding["message"])
    is_limit = key.startswith(("limits.", "expect.")) and message.startswith(key.partition(".")[2])
    if is_limit:
        return message.partition(": ")[0], message
    if finding["severity"] == "error" and not message.startswith(key):
        message = f"{key}: {message}"
    return message, message
