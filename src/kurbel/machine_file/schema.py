"""JSON Schema (draft-07) of the machine file, for editors, from the same declarations that the reader reads.

A schema cannot know rules between numbers, such as a rod longer than its crank; it knows keys, shapes, words, units and
bounds of bare numbers, and which keys exclude each other.
"""

from kurbel.declared.forms import EXPECTATIONS, LIMITS
from kurbel.declared.forms.values import Schema
from kurbel.machine_file.reader import ROOT, key_values


def json_schema() -> Schema:
    """Return the JSON Schema of a whole machine file."""
    definitions: Schema = {}
    root = ROOT.object_schema(definitions)
    for name, form in (("limits", LIMITS), ("expect", EXPECTATIONS)):
        root["properties"][name] |= form.schema_of(key_values(), definitions)
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "kurbel machine file",
        "description": "Every physical value is a number with its unit, such as 450 mm.",
        **root,
        "definitions": dict(sorted(definitions.items())),
    }
