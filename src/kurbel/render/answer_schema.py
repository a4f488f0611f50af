"""The JSON Schema of what `-f json` prints, for programs that read it."""

from typing import Any

from kurbel.render.json_text import FORMAT

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
