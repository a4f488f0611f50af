"""JSON Schema (draft-07) of the machine file, for editors, from the same declarations that the reader reads.

A schema cannot express rules between numbers, such as a rod longer than its crank, but keys, shapes, words, units,
bounds of bare numbers, and which keys exclude each other.
"""

import re
from collections import Counter
from collections.abc import Mapping

from kurbel.declared.forms.figures import EXPECTATIONS, LIMITS, FigureForm, Figures
from kurbel.declared.forms.structures import (
    Inline,
    Keyed,
    Listing,
    Nested,
    OneOf,
    RecordForm,
    Variant,
)
from kurbel.declared.forms.values import Form, NumberForm, Schema, Text
from kurbel.declared.keys import required
from kurbel.declared.numerals import RATIO, WRITTEN
from kurbel.declared.units import KINDS, range_of, unit_names
from kurbel.machine_file.reader import ROOT, key_values
from kurbel.quantity import Quantity


def json_schema() -> Schema:
    """Return the JSON Schema of a whole machine file."""
    definitions: Schema = {}
    root = _of_mapping(ROOT, definitions)
    for name, form in (("limits", LIMITS), ("expect", EXPECTATIONS)):
        root["properties"][name] |= _of_figures(form, key_values(), definitions)
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "kurbel machine file",
        "description": "Every physical value is a number with its unit, such as 450 mm.",
        **root,
        "definitions": dict(sorted(definitions.items())),
    }


def _of(form: Form, definitions: Schema) -> Schema:
    """Return the schema of a value of a form; what is used more than once goes into the definitions."""
    if isinstance(form, NumberForm):
        return _of_number(form, definitions)
    if isinstance(form, Text) and form.unit_of:
        return {"type": "string", "pattern": f"^\\s*{_unit_pattern(form.unit_of)}\\s*$"}
    if isinstance(form, RecordForm):
        name = form.record.__name__
        if name not in definitions:
            definitions[name] = {}  # known before its keys are, one of which may lead back to it
            definitions[name] = _of_mapping(form, definitions)
        return _reference(name)
    if isinstance(form, Listing):
        item = _of(form.item, definitions)
        if form.called and isinstance(
            form.item, RecordForm
        ):  # one that is like another need not say everything
            short = _mapping(definitions[form.item.record.__name__]["properties"])
            item = {"if": {"required": ["like"]}, "then": short, "else": item}
        return {"type": "array", "items": item, "minItems": 1, "maxItems": form.most}
    if isinstance(form, Nested):
        return _of(form.outer(), definitions)
    if isinstance(form, OneOf):
        return {"anyOf": [_of(one, definitions) for one in form.forms]}
    if isinstance(form, Keyed):
        each = []
        for name, case in form.cases.items():
            own = case.keys if isinstance(case, RecordForm) else {}
            beside = {key: _of(own[key].form, definitions) for key in form.beside if key in own}
            each.append(_mapping({name: _of(case, definitions), **beside}) | {"required": [name]})
        return {"anyOf": [*each, _of(form.otherwise, definitions)]}
    if isinstance(form, FigureForm):
        name = f"figure_{form.size.kind}"
        two = {"type": "array", "items": _of(form.size, definitions), "minItems": 2, "maxItems": 2}
        definitions[name] = {
            "anyOf": [
                {"type": "string", "pattern": r"^[^±]*[0-9][^±]*(±|\+\s*/?\s*-)\s*[0-9.][^±]*$"},
                two,
            ],
            "errorMessage": f"write {form.expected}",
            "examples": [form.example, form.absolute],
        }
        return _reference(name)
    return dict(form.schema)


def _mapping(properties: Schema) -> Schema:
    return {"type": "object", "additionalProperties": False, "properties": properties}


def _reference(name: str) -> Schema:
    # draft-07 ignores everything next to a $ref, so the $ref goes into a list of its own
    return {"allOf": [{"$ref": f"#/definitions/{name}"}]}


def _of_number(form: NumberForm, definitions: Schema) -> Schema:
    """Return the schema of a number with its unit, of a bare one within its bounds, or of a whole one."""
    if form.whole:
        return {"type": "integer", "minimum": form.least} | (
            {} if form.most is None else {"maximum": form.most}
        )
    if form.kind == "ratio":
        largest = KINDS["ratio"].largest
        bounds = {
            "exclusiveMinimum": form.above,
            "minimum": -largest if form.least is None else form.least,
            "exclusiveMaximum": form.below,
            "maximum": largest if form.most is None else form.most,
        }
        given = {name: bound for name, bound in bounds.items() if bound is not None}
        number: Schema = {"type": ["number", "string"], **given, "pattern": f"^\\s*{RATIO}\\s*$"}
    else:
        name, units = f"quantity_{form.kind}", ", ".join(unit_names(form.kind))
        definitions[name] = {
            "type": "string",
            "pattern": f"^\\s*{WRITTEN}\\s*{_unit_pattern(form.kind)}\\s*$",
            "description": f"{form.expected}; in size {range_of(form.kind)}; units: {units}",
            # draft-07 has no words for a fault; editors (YAML and JSON language servers, ajv) take them from these
            "errorMessage": f"write {form.expected}",
            "patternErrorMessage": f"write {form.expected}; units: {units}",
            "examples": [form.example],
        }
        number = _reference(name)
    others: list[object] = [*form.words] + [0] * form.zero
    return {"anyOf": [number, {"enum": others}]} if others else number


def _unit_pattern(kind: str) -> str:
    """Return a pattern of the units of a kind in every spelling that is read: `kgf m2` is also `kgf·m²`, `kgf*m^2`."""
    patterns = []
    for unit in unit_names(kind):
        letters = (
            re.escape(re.sub(r"(?<=[a-z])2", "²", unit))
            .replace("\\ ", "[ ·*]+")
            .replace("/", "\\s*/\\s*")
        )
        letters = re.sub("(?<=m|n)(?=Hg|H2O)", " ?", re.sub("^u(?=m)", "[uµμ]", letters))
        patterns.append(letters.replace("²", "(?:\\^?2|²)"))
    return f"(?:{'|'.join(patterns)})"


def _of_figures(form: Figures, known: Mapping[str, Quantity], definitions: Schema) -> Schema:
    """Return the schema of a mapping from these key values, by id."""
    # a symbol of several, or of one and the id of another, names none
    named = Counter(
        name for one in known.values() for name in {one.id, one.symbol, one.ascii_symbol}
    )
    properties: Schema = {}
    names: dict[str, list[str]] = {}  # of those of one schema, which have one pattern below a scope
    schemas: dict[str, Schema] = {}
    for id, quantity in known.items():
        for name in (id, quantity.symbol, quantity.ascii_symbol):
            if not quantity.listed and (name == id or named[name] == 1) and name not in properties:
                schema = _of(form.figure_of(quantity), definitions)
                properties[name] = {**schema, "description": quantity.text}
                schemas[repr(schema)] = schema
                names.setdefault(repr(schema), []).append(
                    re.sub(r"[][\\^$.|?*+(){}/]", r"\\\g<0>", name)
                )
    patterns = {f"^.+\\.({'|'.join(names[text])})$": schema for text, schema in schemas.items()}
    return {**_mapping(properties), "patternProperties": patterns}


def _of_mapping(form: RecordForm, definitions: Schema) -> Schema:
    """Return the schema of the mapping of a record itself."""
    properties: Schema = {}
    rules: list[Schema] = []
    describe(form, properties, rules, definitions)
    return _mapping(properties) | _demands(form) | ({"allOf": rules} if rules else {})


def describe(
    record: RecordForm, properties: Schema, rules: list[Schema], definitions: Schema
) -> None:
    """Add all keys to the schema of a mapping, those of inline records after its own."""
    for name, key in sorted(record.keys.items(), key=lambda item: isinstance(item[1].form, Inline)):
        form = key.form
        if isinstance(form, Inline):
            before = set(properties)
            describe(form, properties, rules, definitions)
            added = [[inner] for inner in properties if inner not in before]
            if demands := _demands(form):
                rules.append(
                    {"if": {"anyOf": [{"required": group} for group in added]}, "then": demands}
                )
            if form.unless:
                rules.append({"if": {"required": [form.unless]}, "then": _none_of(added)})
            continue
        shared = name in properties  # with another mechanism, where it may need nothing
        properties.setdefault(name, {**_of(form, definitions), "description": key.description})
        if key.instead:
            rules.append(_none_of([[name, key.instead]]))
        if key.needs and not shared:
            rules.append({"dependencies": {name: [key.needs]}})
        if not isinstance(form, Variant):
            continue
        for word, case in form.cases.items():
            describe(case, properties, rules, definitions)
            chosen: Schema = {"properties": {name: {"const": word}}}
            if word != form.default:
                chosen["required"] = [name]
            others = dict.fromkeys(inner for one in form.cases.values() for inner in one.keys)
            foreign = [[inner] for inner in others if inner not in case.keys]
            rules.append(
                {"if": chosen, "then": (_none_of(foreign) if foreign else {}) | _demands(case)}
            )


def _demands(form: RecordForm) -> Schema:
    """Return the schema of the keys that must be given."""
    return {"required": needed} if (needed := required(form.keys)) else {}


def _none_of(groups: list[list[str]]) -> Schema:
    """Return a schema that forbids each of these groups of keys together."""
    return {"not": {"anyOf": [{"required": group} for group in groups]}}
