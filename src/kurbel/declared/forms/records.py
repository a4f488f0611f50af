"""Forms of mappings: a mapping becomes a record once all of its keys could be read."""

import math
from collections.abc import Iterable, Iterator
from importlib import import_module
from typing import Any, NoReturn

import numpy as np

from kurbel.arrays import Indivisible
from kurbel.declared.forms.scalars import Choice, reference
from kurbel.declared.keys import ABSENT, Described, Form, Key, Keys, Schema, contradictions, none_of, required
from kurbel.declared.reading import REFUSED, Given, Plain, Reading, Tree, glued_hint, kind_of
from kurbel.errors import Path, RuleError, refused
from kurbel.near_words import near
from kurbel.numerics.arithmetic import is_number

TOO_EXTREME = "these numbers are too large or too small to compute with"


class Record(Form):
    """A mapping that becomes a record; one of a module above that which declares the key is named as `module:Class`.

    inline_too: its keys also stand inline elsewhere, and are looked for there.
    """

    shape = dict

    def __init__(self, record: type[Described] | str, inline_too: bool = False) -> None:
        self._record, self.inline_too = record, inline_too

    def load(self) -> type[Described]:
        """Return the class, imported where it is named."""
        if isinstance(self._record, str):
            module, name = self._record.split(":")
            self._record = getattr(import_module(module), name)
        return self._record  # type: ignore[return-value]

    @property
    def keys(self) -> Keys:
        """The keys of the class."""
        return self.load().KEYS

    def expected(self) -> str:
        return f"a mapping with the keys {', '.join(self.keys)}"

    def records(self, word: str) -> "Iterator[tuple[str, Record]]":
        yield word, self

    def parts(self) -> Iterable[tuple[str, Form]]:
        return [(name, key.form) for name, key in self.keys.items()]

    def places(self, path: str, words: str) -> Iterator[tuple[str, str]]:
        return iter(()) if self.inline_too else super().places(path, words)

    def moved(self, name: str, mapping: Tree) -> dict[str, str]:
        return dict.fromkeys(self.all_names({}), f"move it below '{name}'") if self.inline_too else {}

    def alternatives(self) -> Iterator[tuple[str, str]]:
        """Yield the pairs of keys of its mapping that say the same thing."""
        for name, key in self.keys.items():
            if key.instead:
                yield name, key.instead
            for record in key.form.inline():
                yield from record.alternatives()

    def own_names(self) -> list[str]:
        """Return the names of the keys that stand in the mapping itself."""
        return [name for name, key in self.keys.items() if not key.form.shared]

    def all_names(self, mapping: Tree) -> dict[str, None]:
        """Return the names of all keys that this mapping may have: its own, inline ones, those of the variant."""
        names = dict.fromkeys(self.own_names())
        for name, key in self.keys.items():
            names |= dict.fromkeys(key.form.names(name, mapping))
        return names

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read a mapping into a record."""
        if not isinstance(value, dict):
            no_mapping(self, value)
        known = self.all_names(value)
        unknown = [name for name in value if name not in known]
        # a misspelt key counts as given but unreadable, so that nobody is told that it is missing as well
        meant = dict.fromkeys(self._unknown(reading, value, unknown, tuple(known), path), REFUSED)
        return self.build(reading, value | meant, path)

    def build(self, reading: Reading, mapping: Tree, path: Path, inline: bool = False) -> Any:
        """Read the keys of the record out of a mapping that may hold those of others."""
        own = self.own_names()
        rest = {name: value for name, value in mapping.items() if name not in own}
        missing = required(self.keys)
        values: Tree = {}
        for name, key in self.keys.items():
            found = key.form.find(reading, name, mapping, rest, path)
            if found is not ABSENT:
                values[name] = found
            elif name in missing:
                # of an inline record, point at what is there of it
                beside = next((given for given in own if given in mapping), "") if inline else ""
                where = (*path, beside) if beside else path
                values[name] = reading.fault(where, _missing(name, key, beside), bool(beside))
        return Given(self, mapping, path, values)

    def flattened(self, error: RuleError, mapping: Tree) -> RuleError:
        """Return the faults of the record as those of its mapping."""
        faults = error.faults
        for key in self.keys.values():
            faults = tuple(key.form.flat(fault, mapping) for fault in faults)
        return RuleError(*faults)

    def born(self, values: Tree) -> Any:
        """Return the record of these values of its keys; raises RuleError."""
        try:
            born = self.load().from_keys(**values)
        except ArithmeticError:
            refused(TOO_EXTREME)
        return refused(TOO_EXTREME) if too_extreme(born, values) else born

    def _unknown(
        self, reading: Reading, mapping: Tree, unknown: list[str], known: tuple[str, ...], path: Path
    ) -> Iterator[str]:
        """Note a fault for each unknown key and yield the known ones that were probably meant."""
        elsewhere: dict[str, str] = {}
        other_words: dict[str, tuple[str, Form]] = {}
        for name, key in self.keys.items() if unknown else ():
            elsewhere |= key.form.moved(name, mapping)
            other_words |= key.form.meant(name, key)
        listed = False
        for name in unknown:
            home = self._as_here(reading.where_it_belongs(name, path), mapping)
            meant = "" if name in elsewhere else _meant(name, mapping[name], known, other_words, home)
            message = elsewhere.get(name) or _unknown_message(name, meant, home)
            if not message:
                message = "unknown key" if listed else f"unknown key; known here are {', '.join(known)}"
                listed = True
            reading.fault((*path, name), message, at_key=True)
            if meant and meant not in mapping:
                yield meant

    def _as_here(self, words: str, mapping: Tree) -> str:
        """Return words for places as they are called from this mapping: those of a cylinder in an item of the list."""
        for key in self.keys.values() if words else ():
            words = key.form.called_from(words, mapping)
        return words

    def schema(self, definitions: Schema) -> Schema:
        name = self.load().__name__
        if name not in definitions:
            definitions[name] = self.object_schema(definitions)
        return reference(name)

    def object_schema(self, definitions: Schema) -> Schema:
        """Return the schema of the mapping itself."""
        properties: Schema = {}
        rules: list[Schema] = []
        self.describe_all(properties, rules, definitions)
        schema = {"type": "object", "additionalProperties": False, "properties": properties}
        return schema | demands(self.keys) | ({"allOf": rules} if rules else {})

    def describe_all(self, properties: Schema, rules: list[Schema], definitions: Schema) -> None:
        """Add all keys to the schema of a mapping, those of other records after its own."""
        for name, key in sorted(self.keys.items(), key=lambda item: item[1].form.shared):
            key.form.describe(name, key, properties, rules, definitions)


def demands(keys: Keys) -> Schema:
    """Return the schema of the keys that must be given."""
    return {"required": needed} if (needed := required(keys)) else {}


def no_mapping(form: Form, value: Any) -> NoReturn:
    """Raise RuleError for a value that is no mapping."""
    if isinstance(value, Plain) and not value:
        refused(f"nothing stands here; write below it, indented, {form.expected()}")
    refused(f"expected {form.expected()}, got {kind_of(value)}{glued_hint(value)}")


def _missing(name: str, key: Key, beside: str) -> str:
    meaning = key.text[:1].lower() + key.text[1:]
    return f"'{name}' is missing{' beside it' if beside else ''}: {meaning}; {key.write(name)}"


def _meant(name: str, value: Any, known: tuple[str, ...], other_words: dict[str, tuple[str, Form]], home: str) -> str:
    """Return the key that was probably meant, by another word for it or by its own name misspelt; or ''.

    home: where a key of this name belongs, if there is one; then the word means a key of a single value only with
    one that suits it, such as a piston rod in mm, which is no mass.
    """
    meant, form = other_words.get(name, ("", None))
    if form and meant in known and not (home and form.shape is str and form.read(Reading(), value, ()) is REFUSED):
        return meant
    return near(name, known)


def _unknown_message(name: str, meant: str, home: str) -> str:
    """Return what was probably meant by an unknown key, or an empty text where nothing is like it."""
    if meant:
        return f"unknown key; did you mean '{meant}'?"
    if name == "<<":
        return "merging is not supported; write the keys themselves; a cylinder may be 'like: NAME' of another"
    return f"does not belong here; {home}" if home else ""


def too_extreme(born: Any, values: Tree) -> Any:
    """Return whether, or where, a number of a record is not finite, nor infinite by a word or by default."""
    meant: Any = False
    for value in values.values():
        if is_number(value) or isinstance(value, np.ndarray):
            meant = meant | (value == math.inf)
    broken: Any = False
    for name, value in vars(born).items():
        if isinstance(value, np.ndarray) and not isinstance(born, Indivisible):
            endless = (value == math.inf) & (meant | (vars(type(born)).get(name) == math.inf))
            broken = broken | np.logical_not(np.isfinite(value) | endless)
        elif is_number(value) and not abs(value) < math.inf:
            broken = broken | np.logical_not(value == math.inf and (meant | (vars(type(born)).get(name) == math.inf)))
    return broken


class Maker:
    """The second pass: makes the records of what was read, and notes what is wrong with them."""

    def __init__(self, reading: Reading) -> None:
        self.reading = reading

    def made(self, value: Any, path: Path = ()) -> Any:
        """Return what a value that was read becomes; REFUSED after noting what is wrong with it."""
        if isinstance(value, Given):
            value.made = self._record(value)
            return value.made
        if isinstance(value, tuple) and any(isinstance(one, Given) for one in value):
            items = tuple(self.made(one, (*path, index)) for index, one in enumerate(value))
            if not any(one is REFUSED for one in items):
                return items
            self.reading.partly[path] = items
            return REFUSED
        return value

    def _record(self, given: Given) -> Any:
        path, form = given.path, given.form
        values = {name: self.made(one, (*path, name)) for name, one in given.values.items()}
        try:
            if not any(one is REFUSED for one in values.values()):
                return form.born(values)
            # what is there contradicts the rest whether it could be read or not
            partly = self.reading.partly
            known = {name: self._partly(partly.get((*path, name), one)) for name, one in values.items()}
            faults = (*contradictions(form.keys, values), *form.load().faults_of_keys(known))
            return self.reading.refuse(path, RuleError(*faults))
        except RuleError as error:
            return self.reading.refuse(path, form.flattened(error, given.mapping))

    def _partly(self, value: Any) -> Any:
        """Return a list of which some items could not be read, the others made."""
        items = value if isinstance(value, tuple) else ()
        return tuple(self.made(one) if isinstance(one, Given) else one for one in items) or value


class Variant(Choice):
    """One of these words, on which hang further keys of the same mapping: those of the mechanism, say."""

    def __init__(self, default: str, cases: dict[str, Record], also: dict[str, str]) -> None:
        super().__init__(tuple(cases), also)
        self.default, self.cases = default, cases

    def find(self, reading: Reading, name: str, mapping: Tree, rest: Tree, path: Path) -> Any:
        """Read the chosen record out of the mapping."""
        word = super().find(reading, name, mapping, rest, path)
        if word is REFUSED:
            return REFUSED
        return self.cases[self.default if word is ABSENT else word].build(reading, rest, path, inline=True)

    def names(self, name: str, mapping: Tree) -> Iterable[str]:
        """Return those of the chosen variant; of all of them where the word that chooses is unknown."""
        word = mapping.get(name, self.default)
        chosen = self.cases.get(word) if isinstance(word, str) else None
        return [inner for case in ([chosen] if chosen else self.cases.values()) for inner in case.all_names(mapping)]

    def inline(self) -> Iterable[Record]:
        return self.cases.values()

    def places_of(self, name: str, path: str, words: str) -> Iterator[tuple[str, str]]:
        yield words, name
        for word, case in self.cases.items():
            yield from ((f"to '{name}: {word}'", inner) for inner in case.keys)

    def records(self, word: str) -> Iterator[tuple[str, Record]]:
        for name, case in self.cases.items():
            yield f"{word}: {name}", case

    def describe(self, name: str, key: Key, properties: Schema, rules: list[Schema], definitions: Schema) -> None:
        """Add the keys of all variants, and for each word what must and must not stand beside it."""
        super().describe(name, key, properties, rules, definitions)
        everything = dict.fromkeys(inner for case in self.cases.values() for inner in case.keys)
        for word, case in self.cases.items():
            case.describe_all(properties, rules, definitions)
            chosen: Schema = {"properties": {name: {"const": word}}}
            if word != self.default:
                chosen["required"] = [name]
            foreign = [[inner] for inner in everything if inner not in case.keys]
            rules.append({"if": chosen, "then": (none_of(foreign) if foreign else {}) | demands(case.keys)})
