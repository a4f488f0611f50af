"""Results as JSON, and a check as JUnit XML, for programs. The JSON Schema of the answers is in answers.schema.json."""

import json
import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
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
        content |= {
            "machine": report.machine,
            **_made_from(report.provenance and report.provenance()),
        }
    if report.head:
        content["head"] = list(report.head)
    ratios = report.group == "ratios"
    if ratios or report.parts:
        content[report.group] = [_named(part, ratios, look) for part in report.parts]
    if report.whole is not None:
        whole = _results(report.whole, look).items()
        content |= {f"machine_{key}": value for key, value in whole if value or not ratios}
    if report.notes:
        content["notes"] = list(report.notes)
    return chain(_pieces(content, "\n", look), "\n")


def findings_json(
    machine: str | None, made_from: Provenance | None, findings: list[dict[str, object]], look: Look
) -> Iterator[str]:
    """Yield a check as one JSON object in pieces, a line for every finding; machine: None where the file has none."""
    head = {"kurbel": __version__, "format": FORMAT, "command": "check", "machine": machine}
    return chain(_pieces({**head, **_made_from(made_from), "findings": findings}, "\n", look), "\n")


def _made_from(given: Provenance | None) -> dict[str, object]:
    if given is None:
        return {}
    versions = {"kurbel": __version__, **given.versions}
    inputs = [{"file": one.file, "sha256": sha256_of(one)} for one in given.inputs]
    return {"inputs": inputs, "overrides": list(given.overrides), "versions": versions}


def sha256_of(one: InputFile) -> str | None:
    """Return the SHA-256 of a file that was read, None if it is gone."""
    return None if one.content is None else sha256(one.content).hexdigest()


def _named(part: Part, ratio: bool, look: Look) -> Content:
    """Return a part with its name, or with its L/R, where empty results are left out."""
    results = _results(part, look)
    if not ratio:
        return {"name": part.name, **results}
    name = "inf" if part.name == float("inf") else whole_if_integral(float(part.name))
    return {"rod_ratio": name, **{key: value for key, value in results.items() if value}}


def _results(part: Part, look: Look) -> Content:
    """Return what JSON has of a part; its columns are still to be written, one after another."""

    def number(value: CellValue) -> CellValue:
        return rounded(value, look.digits)

    def key_value(one: Column | KeyValue, value: object, **more: object) -> dict[str, object]:
        return {"id": one.id, "symbol": one.symbol, "unit": one.unit, "value": value, **more}

    places, key_values, pistons = list[Content](), list[Content](), list[Content]()
    for table in part.place_tables:
        if table.id == PISTONS:
            for names, *values in zip(table.names, *(column.values for column in table.columns)):
                own = [key_value(one, number(value)) for one, value in zip(table.columns, values)]
                pistons.append({"name": names[0], "key_values": own})
        else:
            rows = (
                {"rows": [dict(zip(table.heads, names)) for names in table.names]}
                if table.heads
                else {}
            )
            places.append(
                {"id": table.id, "title": table.title, **rows, "columns": list(table.columns)}
            )
    for one in part.key_values:
        at: Content = {} if one.at_deg is None else {"at_deg": number(one.at_deg)}
        if one.side:
            at["side"] = one.side
        value = list(map(number, one.value)) if isinstance(one.value, tuple) else number(one.value)
        key_values.append(key_value(one, value, **at))
    return {
        "columns": list(part.columns),
        **({"place_tables": places} if places else {}),
        "key_values": key_values,
        **({"pistons": pistons} if pistons else {}),
        "left_out": [one._asdict() for one in part.left_out],
        "warnings": list(part.warnings),
    }


def _pieces(node: object, line_end: str, look: Look) -> Iterator[str]:
    """Yield a node in pieces: on one line, or with a line for each entry if one of them is an object."""
    if isinstance(node, Column):
        phi = node.id == "phi"  # crank angles have all digits
        values = [
            whole_if_integral(value) if phi else rounded(value, look.digits)
            for value in node.values
        ]
        marked = {"marked": node.marked} if node.marked else {}
        node = {"id": node.id, "symbol": node.symbol, "unit": node.unit, "values": values, **marked}
    elif isinstance(node, (dict, list)) and _holds_object(node):
        start, end = "{}" if isinstance(node, dict) else "[]"
        heads = (f"{json.dumps(key)}: " for key in node) if isinstance(node, dict) else repeat("")
        for head, child in zip(heads, node.values() if isinstance(node, dict) else node):
            yield f"{start}{line_end} {head}"
            yield from _pieces(child, line_end + " ", look)
            start = ","
        yield end
        return
    # characters that turn the writing are escaped
    yield json.dumps(node, ensure_ascii=not look.has("φ"), allow_nan=False).translate(_ESCAPED)


def _holds_object(node: object) -> bool:
    children = node.values() if isinstance(node, dict) else node if isinstance(node, list) else ()
    return any(isinstance(child, (dict, Column)) or _holds_object(child) for child in children)


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

    An error is a failure with its sentence; warnings and what is left out pass and have theirs as output. The name of
    the case of a limit has no values, so that a CI service compares runs by it, that of an error of the file is the
    sentence after its key, and none occurs twice. Elements and attributes are those of the schema of Jenkins.
    """
    root = ElementTree.Element("testsuites", name="kurbel")
    for file, found in checks:
        file, names = look.data(file), Counter[str]()
        broken = sum(one["severity"] == "error" for one in found)
        counts = {
            "tests": str(max(len(found), 1)),
            "failures": str(broken),
            "errors": "0",
            "skipped": "0",
        }
        suite = ElementTree.SubElement(root, "testsuite", {"name": file, **counts})
        if not found:  # a file of results without a test counts as a fault
            ElementTree.SubElement(suite, "testcase", classname=file, name="valid machine")
        for one in found:
            error, key, message = (
                one["severity"] == "error",
                one["key"] or "",
                look.data(one["message"]),
            )
            of_limit = key.startswith(("limits.", "expect.")) and message.startswith(
                key.partition(".")[2]
            )
            if error and not of_limit and not message.startswith(key):
                message = f"{key}: {message}"
            name = message.partition(": ")[0] if of_limit else message
            names[name] += 1
            name += f" ({names[name]})" if names[name] > 1 else ""
            case = ElementTree.SubElement(suite, "testcase", classname=file, name=name)
            if error:
                place = ":".join(str(part) for part in (file, one["line"], one["column"]) if part)
                ElementTree.SubElement(
                    case, "failure", message=message, type="error"
                ).text = f"{place}: {message}"
            else:
                ElementTree.SubElement(case, "system-out").text = message
    ElementTree.indent(root, "")
    yield f'<?xml version="1.0" encoding="UTF-8"?>\n{ElementTree.tostring(root, "unicode")}\n'
