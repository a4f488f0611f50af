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
from kurbel.declared.units import (
    FEET_AND_INCHES,
    KINDS,
    ZEROED_UNITS,
    listed_units,
    range_of,
    unit_names,
)
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
        "$id": "urn:kurbel:machine-file:1",
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
        # an item that is like another need not have all keys
        if form.called and isinstance(form.item, RecordForm):
            short = _mapping(definitions[form.item.record.__name__]["properties"])
            item = {"if": {"required": ["like"]}, "then": short, "else": item}
        return {"type": "array", "items": item, "minItems": 1, "maxItems": form.most}
    if isinstance(form, Nested):
        return _of(form.outer(), definitions)
    if isinstance(form, OneOf):
        return {"anyOf": [_of(option, definitions) for option in form.forms]}
    if isinstance(form, Keyed):
        return _of_keyed(form, definitions)
    if isinstance(form, FigureForm):
        return _of_figure(form, definitions)
    return dict(form.schema)


def _of_keyed(form: Keyed, definitions: Schema) -> Schema:
    """Return the schema of a mapping with one key that decides its form, or without one."""
    cases = []
    for name, case in form.cases.items():
        properties = {name: _of(case, definitions)}
        keys = case.keys if isinstance(case, RecordForm) else {}
        for beside in form.beside:
            if beside in keys:
                properties[beside] = _of(keys[beside].form, definitions)
        cases.append(_mapping(properties) | {"required": [name]})
    return {"anyOf": [*cases, _of(form.otherwise, definitions)]}


def _of_figure(form: FigureForm, definitions: Schema) -> Schema:
    """Return the schema of a figure with its tolerance, or of two bounds."""
    name = f"figure_{form.size.kind}"
    tolerated = {"type": "string", "pattern": r"^[^±]*[0-9][^±]*(±|\+\s*/?\s*-)\s*[0-9.][^±]*$"}
    bounds = {"type": "array", "items": _of(form.size, definitions), "minItems": 2, "maxItems": 2}
    definitions[name] = {
        "anyOf": [tolerated, bounds],
        "errorMessage": f"write {form.expected}",
        "examples": [form.example, form.absolute],
    }
    return _reference(name)


def _mapping(properties: Schema) -> Schema:
    return {"type": "object", "additionalProperties": False, "properties": properties}


def _reference(name: str) -> Schema:
    # draft-07 ignores everything next to a $ref, so the $ref goes into a list of its own
    return {"allOf": [{"$ref": f"#/definitions/{name}"}]}


def _of_number(form: NumberForm, definitions: Schema) -> Schema:
    """Return the schema of a number with its unit, of a bare one within its bounds, or of a whole one."""
    if form.whole:
        integer: Schema = {"type": "integer", "minimum": form.least}
        if form.most is not None:
            integer["maximum"] = form.most
        return integer
    if form.kind == "ratio":
        largest = KINDS["ratio"].largest
        least = -largest if form.least is None else form.least
        most = largest if form.most is None else form.most
        number: Schema = {"type": ["number", "string"]}
        if form.above is not None:
            number["exclusiveMinimum"] = form.above
        number["minimum"] = least
        if form.below is not None:
            number["exclusiveMaximum"] = form.below
        number["maximum"] = most
        number["pattern"] = f"^\\s*{RATIO}\\s*$"
    else:
        name = f"quantity_{form.kind}"
        units = ", ".join(listed_units(form.kind))
        written = f"{WRITTEN}\\s*{_unit_pattern(form.kind)}"
        if form.kind == "length":
            written = f"(?:{written}|{FEET_AND_INCHES})"
        definitions[name] = {
            "type": "string",
            "pattern": f"^\\s*{written}\\s*$",
            "description": f"{form.expected}; in size {range_of(form.kind)}; units: {units}",
            # draft-07 has no words for a fault; editors (YAML and JSON language servers, ajv) take them from these
            "errorMessage": f"write {form.expected}",
            "patternErrorMessage": f"write {form.expected}; units: {units}",
            "examples": [form.example],
        }
        number = _reference(name)
    # what is allowed in addition to the bounds
    others: list[object] = [*form.words]
    if form.zero:
        others.append(0)
    if not others:
        return number
    return {"anyOf": [number, {"enum": others}]}


def _unit_pattern(kind: str) -> str:
    """Return a pattern of the units of a kind in every spelling that is read: `kgf m2` is also `kgf·m²`, `kgf*m^2`."""
    patterns = []
    if kind in ("length", "film"):
        patterns.append("feet|foot|inch(?:es)?|'{1,2}|[\"′’″”]")
    if kind == "pressure":
        plain = "|".join(unit for unit in unit_names(kind) if unit not in ZEROED_UNITS)
        patterns.append(f"(?:{plain}) ?(?:abs(?:olute)?|gauge|\\((?:a|g|abs)\\))")
    for unit in unit_names(kind):
        pattern = re.escape(re.sub(r"(?<=[a-z])2", "²", unit))
        pattern = pattern.replace("\\ ", "[ ·*]+")
        pattern = pattern.replace("/", "\\s*/\\s*")
        pattern = re.sub("^u(?=m)", "[uµμ]", pattern)
        pattern = re.sub("(?<=m|n)(?=Hg|H2O)", " ?", pattern)
        pattern = pattern.replace("²", "(?:\\^?2|²)")
        patterns.append(pattern)
    return f"(?:{'|'.join(patterns)})"


def _of_figures(form: Figures, quantities: Mapping[str, Quantity], definitions: Schema) -> Schema:
    """Return the schema of a mapping from these key values, by id."""
    # a symbol of several, or of one and the id of another, names none
    uses: Counter[str] = Counter()
    for quantity in quantities.values():
        uses.update({quantity.id, quantity.symbol, quantity.ascii_symbol})
    properties: Schema = {}
    # schema as text -> patterns of the names that have it, which have one pattern below a scope
    name_patterns: dict[str, list[str]] = {}
    schemas: dict[str, Schema] = {}
    for id, quantity in quantities.items():
        if quantity.listed:
            continue
        for name in (id, quantity.symbol, quantity.ascii_symbol):
            is_unique = name == id or uses[name] == 1
            if not is_unique or name in properties:
                continue
            schema = _of(form.figure_of(quantity), definitions)
            properties[name] = {**schema, "description": quantity.text}
            text = repr(schema)
            schemas[text] = schema
            escaped = re.sub(r"[][\\^$.|?*+(){}/]", r"\\\g<0>", name)
            name_patterns.setdefault(text, []).append(escaped)
    patterns: Schema = {}
    for text, schema in schemas.items():
        patterns[f"^.+\\.({'|'.join(name_patterns[text])})$"] = schema
    return {**_mapping(properties), "patternProperties": patterns}


def _of_mapping(form: RecordForm, definitions: Schema) -> Schema:
    """Return the schema of the mapping of a record itself."""
    properties: Schema = {}
    rules: list[Schema] = []
    describe(form, properties, rules, definitions)
    schema = _mapping(properties) | _demands(form)
    if rules:
        schema["allOf"] = [*schema.get("allOf", []), *rules]
    return schema


def describe(
    record: RecordForm, properties: Schema, rules: list[Schema], definitions: Schema
) -> None:
    """Add all keys to the schema of a mapping, those of inline records after its own."""
    inline: list[Inline] = []
    for name, key in record.keys.items():
        form = key.form
        if isinstance(form, Inline):
            inline.append(form)
            continue
        is_shared = name in properties  # with another mechanism, where it may need nothing
        properties.setdefault(name, {**_of(form, definitions), "description": key.description})
        if key.instead and not key.compared:
            rules.append(_none_of([[name, key.instead]]))
        if key.needs and not is_shared:
            rules.append({"dependencies": {name: [key.needs]}})
        if isinstance(form, Variant):
            _describe_variant(name, form, properties, rules, definitions)
    for form in inline:
        _describe_inline(form, properties, rules, definitions)


def _describe_inline(
    form: Inline, properties: Schema, rules: list[Schema], definitions: Schema
) -> None:
    """Add the keys of an inline record.

    If any of them is given, those that it demands must be given; if the list `form.unless` is given, all are forbidden.
    """
    before = set(properties)
    describe(form, properties, rules, definitions)
    # each in a group of its own
    added = [[name] for name in properties if name not in before]
    demands = _demands(form)
    if demands:
        is_present = {"anyOf": [{"required": group} for group in added]}
        rules.append({"if": is_present, "then": demands})
    if form.unless:
        rules.append({"if": {"required": [form.unless]}, "then": _none_of(added)})


def _describe_variant(
    name: str, variant: Variant, properties: Schema, rules: list[Schema], definitions: Schema
) -> None:
    """Add the keys of all cases of a variant; each word forbids the keys of other cases."""
    all_keys: dict[str, None] = {}
    for case in variant.cases.values():
        all_keys |= dict.fromkeys(case.keys)
    for word, case in variant.cases.items():
        describe(case, properties, rules, definitions)
        is_chosen: Schema = {"properties": {name: {"const": word}}}
        if word != variant.default:
            is_chosen["required"] = [name]
        foreign = [[key] for key in all_keys if key not in case.keys]
        forbidden = _none_of(foreign) if foreign else {}
        rules.append({"if": is_chosen, "then": forbidden | _demands(case)})


def _demands(form: RecordForm) -> Schema:
    """Return the schema of the keys that must be given."""
    demands: Schema = {}
    names = required(form.keys, form.keys)
    if names:
        demands["required"] = names
    # of a key and one that is compared with it one at least
    compared = [(name, key.instead) for name, key in form.keys.items() if key.compared]
    if compared:
        demands["allOf"] = [{"anyOf": [{"required": [key]} for key in pair]} for pair in compared]
    return demands


def _none_of(groups: list[list[str]]) -> Schema:
    """Return a schema that forbids each of these groups of keys together."""
    return {"not": {"anyOf": [{"required": group} for group in groups]}}
