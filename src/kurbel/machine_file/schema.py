"""JSON Schema (draft-07) of the machine file, for editors, from the same declarations that the reader reads.

A schema cannot know rules between numbers, such as a rod longer than its crank; it knows keys, shapes, words, units and
bounds of bare numbers, and which keys exclude each other.
"""

from __future__ import annotations

import re
from typing import Any

from kurbel.declared import keys as forms
from kurbel.declared.bounds import MOST_ITEMS, MOST_POINTS, SIZES, range_of
from kurbel.declared.numerals import NUMBER
from kurbel.declared.units import example, unit_names

Schema = dict[str, Any]
_ROOT = forms.Record("kurbel.machine:Machine")


def json_schema() -> Schema:
    """Return the JSON Schema of a whole machine file."""
    definitions: dict[str, Schema] = {}
    root = _object(forms.load(_ROOT), definitions)
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "kurbel machine file",
        "description": "Every physical value is a number with its unit, such as 450 mm.",
        **root,
        "definitions": dict(sorted(definitions.items())),
    }


def _object(cls: Any, definitions: dict[str, Schema]) -> Schema:
    """Return the schema of a mapping that becomes a record of this class."""
    properties: dict[str, Schema] = {}
    rules: list[Schema] = []
    required = _collect(cls, properties, rules, definitions)
    schema: Schema = {"type": "object", "additionalProperties": False, "properties": properties}
    if required:
        schema["required"] = required
    if rules:
        schema["allOf"] = rules
    return schema


def _collect(cls: Any, properties: dict[str, Schema], rules: list[Schema], definitions: dict[str, Schema]) -> list[str]:
    """Add the keys of a record, with those that share its mapping, and return the names that must stand there."""
    keys: forms.Keys = cls.KEYS
    for name, key in keys.items():
        if not isinstance(key.form, (forms.Inline, forms.Variant)):
            properties.setdefault(name, {**_form(key.form, definitions), "description": _description(key)})
            if key.instead:
                rules.append(_none_of([[name, key.instead]]))
    for name, key in keys.items():
        if isinstance(key.form, forms.Inline):
            _inline(key.form, properties, rules, definitions)
        elif isinstance(key.form, forms.Variant):
            _variant(name, key, properties, rules, definitions)
    return [name for name, key in keys.items() if key.required]


def _inline(
    form: forms.Inline, properties: dict[str, Schema], rules: list[Schema], definitions: dict[str, Schema]
) -> None:
    before = set(properties)
    required = _collect(forms.load(form.record), properties, rules, definitions)
    added = [name for name in properties if name not in before]
    if required:
        rules.append({"if": {"anyOf": [{"required": [name]} for name in added]}, "then": {"required": required}})
    if form.unless:
        rules.append({"if": {"required": [form.unless]}, "then": _none_of([[name] for name in added])})


def _variant(
    name: str, key: forms.Key, properties: dict[str, Schema], rules: list[Schema], definitions: dict[str, Schema]
) -> None:
    """Add the keys of all variants, and for each word what must and must not stand beside it."""
    form = key.form
    assert isinstance(form, forms.Variant)
    properties[name] = {"enum": [word for word, _ in form.cases], "description": _description(key)}
    own = {word: forms.load(case).KEYS for word, case in form.cases}
    everything = list(dict.fromkeys(inner for keys in own.values() for inner in keys))
    for word, case in form.cases:
        required = _collect(forms.load(case), properties, rules, definitions)
        chosen: Schema = {"properties": {name: {"const": word}}}
        if word != form.default:
            chosen["required"] = [name]
        foreign = [[inner] for inner in everything if inner not in own[word]]
        then = _none_of(foreign) if foreign else {}
        if required:
            then["required"] = required
        rules.append({"if": chosen, "then": then})


def _none_of(groups: list[list[str]]) -> Schema:
    """Return a schema that forbids each of these groups of keys together."""
    return {"not": {"anyOf": [{"required": group} for group in groups]}}


def _description(key: forms.Key) -> str:
    symbol = f" ({key.symbol})" if key.symbol else ""
    absent = f"; absent: {key.absent}" if key.absent else ""
    return f"{key.text}{symbol}{absent}"


def _form(form: Any, definitions: dict[str, Schema]) -> Schema:
    """Return the schema of a value of this form."""
    if isinstance(form, (forms.Record, forms.Listing, forms.OneOf, forms.Keyed)):
        return _structure(form, definitions)
    if isinstance(form, forms.Limits):
        return _limits(definitions)
    if isinstance(form, forms.Points):
        pair = {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}
        return {"type": "array", "items": pair, "minItems": form.least, "maxItems": MOST_POINTS}
    return _scalar(form, definitions)


def _structure(form: Any, definitions: dict[str, Schema]) -> Schema:
    if isinstance(form, forms.Record):
        name = form.target.split(":")[1]
        if name not in definitions:
            definitions[name] = _object(forms.load(form), definitions)
        return _reference(name)
    if isinstance(form, forms.Listing):
        return {"type": "array", "items": _form(form.item, definitions), "minItems": 1, "maxItems": MOST_ITEMS}
    if isinstance(form, forms.OneOf):
        return {"anyOf": [_form(each, definitions) for each in form.forms]}
    cases = [
        {
            "type": "object",
            "additionalProperties": False,
            "required": [name],
            "properties": {name: _form(case, definitions)},
        }
        for name, case in form.cases
    ]
    return {"anyOf": [*cases, _form(form.otherwise, definitions)]}


def _scalar(form: Any, definitions: dict[str, Schema]) -> Schema:
    if isinstance(form, forms.Physical):
        return _or_words(_quantity(form.kind, definitions), form.words)
    if isinstance(form, forms.Number):
        largest = SIZES["ratio"][1]
        bounds = {
            "exclusiveMinimum": form.above,
            "minimum": -largest if form.least is None else form.least,
            "exclusiveMaximum": form.below,
            "maximum": largest if form.most is None else form.most,
        }
        number = {"type": "number", **{name: bound for name, bound in bounds.items() if bound is not None}}
        return _or_words(number, form.words)
    if isinstance(form, forms.Count):
        most = {} if form.most is None else {"maximum": form.most}
        return {"type": "integer", "minimum": form.least, **most}
    if isinstance(form, forms.Choice):
        return {"enum": list(form.words)}
    if isinstance(form, forms.UnitName):
        return {"type": "string", "pattern": f"^\\s*{_units(form.kind)}\\s*$"}
    # a name may look like a number: `name: 12`
    return {"type": "string", "minLength": 1} if isinstance(form, forms.FilePath) else {"type": ["string", "number"]}


def _or_words(schema: Schema, words: tuple[tuple[str, float], ...]) -> Schema:
    return {"anyOf": [schema, {"enum": [word for word, _ in words]}]} if words else schema


def _quantity(kind: str, definitions: dict[str, Schema]) -> Schema:
    """Return a reference to the schema of a number with a unit of this kind."""
    name = f"quantity_{kind}"
    if name not in definitions:
        pattern = f"^\\s*{NUMBER.pattern}\\s*{_units(kind)}\\s*$"
        about = {"description": f"in size {range_of(kind)}", "examples": [example(kind)]}
        definitions[name] = {"type": "string", "pattern": pattern, **about}
    return _reference(name)


def _reference(name: str) -> Schema:
    # draft-07 overlooks whatever stands beside a $ref, so it goes into a list of its own
    return {"allOf": [{"$ref": f"#/definitions/{name}"}]}


def _units(kind: str) -> str:
    """Return a pattern of the units of a kind in every spelling that the reader takes."""
    return "(?:" + "|".join(_spellings(name) for name in unit_names(kind)) + ")"


def _spellings(unit: str) -> str:
    """Return a pattern of one unit: `kgf m2` is also `kgf·m²` and `kgf*m^2`."""
    letters = re.escape(re.sub(r"(?<=[a-z])2", "²", unit)).replace("\\ ", "[ ·*]+").replace("/", "\\s*/\\s*")
    return re.sub("^u(?=m)", "[uµμ]", letters).replace("²", "(?:\\^?2|²)")


def _limits(definitions: dict[str, Schema]) -> Schema:
    from kurbel.mechanisms import every_quantity

    quotient = {"type": "string", "pattern": f"^\\s*{NUMBER.pattern}\\s*/\\s*{NUMBER.pattern}\\s*$"}
    ratio = {"anyOf": [{"type": "number"}, quotient]}
    properties = {
        quantity.id: {
            **(ratio if quantity.kind == "ratio" else _quantity(quantity.kind, definitions)),
            "description": quantity.text,
        }
        for quantity in every_quantity().all_key_values
        if not quantity.listed
    }
    return {"type": "object", "additionalProperties": False, "minProperties": 1, "properties": properties}
