"""Forms of mappings and lists: records, lists of them, alternatives, mappings with one telling key, inline records."""

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from importlib import import_module
from typing import Any, NoReturn

import numpy as np

from kurbel.arrays import Indivisible
from kurbel.declared.forms.values import Choice, reference
from kurbel.declared.keys import (
    ABSENT,
    TOO_EXTREME,
    Described,
    Form,
    Key,
    Keys,
    Schema,
    contradictions,
    none_of,
    required,
)
from kurbel.declared.reading import REFUSED, Given, Plain, Reading, Tree, glued_hint, is_nothing, kind_of, shown
from kurbel.declared.units import MOST_ITEMS
from kurbel.errors import Fault, Path, RuleError, refused
from kurbel.near_words import did_you_mean, near
from kurbel.numerics.arithmetic import is_number


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


class Listing(Form):
    """A list of items of one form, at least one; becomes a tuple."""

    shape = list

    def __init__(self, item: Form) -> None:
        self.item, self.kind = item, item.kind

    def expected(self) -> str:
        return "a list, each item after '- '"

    def written(self) -> str:
        return f"a list; each {self.item.written()}"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": "array", "items": self.item.schema(definitions), "minItems": 1, "maxItems": MOST_ITEMS}

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read a list into a tuple."""
        if isinstance(value, Plain) and not value:
            refused("nothing stands here; write a list below it, each item after '- '")
        if not isinstance(value, list):
            refused(f"expected a list, each item after '- ', got {kind_of(value)}")
        if not value:
            refused("the list is empty; give at least one item or leave the key out")
        if len(value) > MOST_ITEMS:
            refused(f"{len(value)} items; no machine has more than {MOST_ITEMS} of them")
        items = tuple(self.item.read(reading, item, (*path, index)) for index, item in enumerate(value))
        if any(item is REFUSED for item in items):
            reading.partly[path] = items
            return REFUSED
        return items

    def parts(self) -> Iterable[tuple[str, Form]]:
        return (("", self.item),)


class OneOf(Form):
    """Several forms that differ in shape (text, list, mapping), or word and number; the first that suits reads it."""

    def __init__(self, *forms: Form) -> None:
        self.forms = forms
        self.kind = next((form.kind for form in forms if form.kind), "")

    def expected(self) -> str:
        return ", or ".join(form.expected() for form in self.forms)

    def example(self) -> str:
        return self.forms[0].example()

    def written(self) -> str:
        return " or ".join(form.written() for form in self.forms)

    def schema(self, definitions: Schema) -> Schema:
        return {"anyOf": [form.schema(definitions) for form in self.forms]}

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read a value by the first form that has its shape."""
        shape = type(value) if isinstance(value, (dict, list)) else str
        words = [word for form in self.forms if isinstance(form, Choice) for word in form.words]
        if found := [name for name in value if name in words] if shape is dict else []:
            alone = f"- {found[0]}" if isinstance(path[-1], int) else f"{path[-1]}: {found[0]}"
            return reading.fault((*path, found[0]), f"takes no value; write '{alone}'", at_key=True)
        alike = [form for form in self.forms if form.shape is shape]
        if alike:  # of a word and a number, the one that it looks like
            return next((form for form in alike if form.suits(value)), alike[0]).read(reading, value, path)
        return refused(f"expected {self.expected()}, got {'nothing' if is_nothing(value) else kind_of(value)}")

    @property
    def is_number(self) -> bool:
        return any(form.is_number for form in self.forms)

    def of_numbers(self, numbers: Any) -> Any:
        return next(form for form in self.forms if form.is_number).of_numbers(numbers)

    def numbers(self, texts: Sequence[str]) -> list[float] | None:
        return next((form.numbers(texts) for form in self.forms if form.shape is str and form.suits(texts[0])), None)

    def parts(self) -> Iterable[tuple[str, Form]]:
        return [("", form) for form in self.forms]


class Keyed(Form):
    """A mapping whose single telling key decides what it becomes: `{constant: …}`, `{trace: …}`; else `otherwise`.

    texts: what those of the telling keys mean under which no mapping stands.
    """

    shape = dict

    def __init__(self, cases: dict[str, Form], otherwise: Record, texts: dict[str, str]) -> None:
        self.cases, self.otherwise, self.texts = cases, otherwise, texts

    def single_keys(self) -> Iterator[tuple[str, Key]]:
        """Yield the telling keys under which no mapping stands, by name."""
        for name, case in self.cases.items():
            if not isinstance(case, Record):
                yield name, Key(case, self.texts.get(name, ""))

    def expected(self) -> str:
        keys = self.otherwise.expected().removeprefix("a mapping with ")
        return f"a mapping with {keys}; or with one of {', '.join(self.cases)}"

    def schema(self, definitions: Schema) -> Schema:
        one = {"type": "object", "additionalProperties": False}
        cases = [
            {**one, "required": [name], "properties": {name: form.schema(definitions)}}
            for name, form in self.cases.items()
        ]
        return {"anyOf": [*cases, self.otherwise.schema(definitions)]}

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read a mapping by its telling key."""
        if not isinstance(value, dict):
            no_mapping(self, value)
        telling = next((name for name in value if name in self.cases), "")
        if not telling:
            return REFUSED if self._misspelt(reading, value, path) else self.otherwise.read(reading, value, path)
        for name in value:
            if name != telling:
                reading.fault(
                    (*path, name), f"cannot stand beside '{telling}'{self._home(reading, name, path)}", at_key=True
                )
        inner = self.cases[telling].read(reading, value[telling], (*path, telling))
        return inner if len(value) == 1 else REFUSED

    def _home(self, reading: Reading, name: str, path: Path) -> str:
        """Return where a key belongs that stands beside a telling one, or that one of both is too many."""
        if name in self.otherwise.keys or name in self.cases:
            return "; leave one of them out"
        return f"; {reading.where_it_belongs(name, path) or 'leave it out'}"

    def _misspelt(self, reading: Reading, mapping: Tree, path: Path) -> bool:
        """Note a fault where an unknown key is nearly a telling one, and return whether there was any."""
        known = tuple(self.otherwise.keys)
        strange = [name for name in mapping if name not in known and not reading.where_it_belongs(name, path)]
        found = {name: near(name, tuple(self.cases)) for name in strange if not near(name, known)}
        for name, meant in found.items():
            if meant:
                reading.fault((*path, name), f"unknown key; did you mean '{meant}'?", at_key=True)
        return any(found.values())

    def parts(self) -> Iterable[tuple[str, Form]]:
        return (*self.cases.items(), ("", self.otherwise))

    def records(self, word: str) -> Iterator[tuple[str, Record]]:
        return super().records("card")


class Inline(Form):
    """Keys of another record that stand in the same mapping: those of the piston in its cylinder.

    With the key `unless`, a list of such records, they stand in its items instead, or of equal ones below its `each`;
    rules of the outer record speak of an inline record as an item of that list.
    """

    shared = True

    def __init__(self, record: Record, unless: str = "") -> None:
        self.record, self.unless = record, unless

    @property
    def _item(self) -> str:
        return f"to a {self.unless.removesuffix('s')}"

    def expected(self) -> str:
        return self.record.expected()

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read the record out of the mapping."""
        return self.record.build(reading, value, path, inline=True)

    def find(self, reading: Reading, name: str, mapping: Tree, rest: Tree, path: Path) -> Any:
        """Read the record where any of its keys is given."""
        return self.read(reading, rest, path) if rest.keys() & set(self.names(name, mapping)) else ABSENT

    def names(self, name: str, mapping: Tree) -> Iterable[str]:
        return () if self.unless in mapping else self.record.all_names(mapping)

    def moved(self, name: str, mapping: Tree) -> dict[str, str]:
        if self.unless not in mapping:
            return {}
        there = f"'{self.unless}.each'" if isinstance(mapping[self.unless], dict) else f"the items of '{self.unless}'"
        message = f"belongs {self._item}; move it into {there}"
        return dict.fromkeys(self.record.all_names(mapping), message)

    def called_from(self, words: str, mapping: Tree) -> str:
        if self.unless not in mapping:
            return words
        item = f"{self.unless}.{'each' if isinstance(mapping[self.unless], dict) else 0}"
        own = self.record.all_names(mapping)
        return re.sub(r"under '(\w+)", lambda one: f"under '{item}.{one[1]}" if one[1] in own else one[0], words)

    def flat(self, fault: Fault, mapping: Tree) -> Fault:
        if len(fault.path) < 2 or fault.path[0] != self.unless or not isinstance(fault.path[1], int):
            return fault
        listed = mapping.get(self.unless)
        head = () if listed is None else (self.unless, "each") if isinstance(listed, dict) else fault.path[:2]
        return fault._replace(path=(*head, *fault.path[2:]))

    def inline(self) -> Iterable[Record]:
        return (self.record,)

    def places_of(self, name: str, path: str, words: str) -> Iterator[tuple[str, str]]:
        return self.record.places(path, self._item if self.unless else words)

    def records(self, word: str) -> Iterator[tuple[str, Record]]:
        yield word, self.record

    def schema(self, definitions: Schema) -> Schema:
        return self.record.schema(definitions)

    def describe(self, name: str, key: Key, properties: Schema, rules: list[Schema], definitions: Schema) -> None:
        """Add the keys of the record, and that they do not stand beside the list."""
        before = set(properties)
        self.record.describe_all(properties, rules, definitions)
        added = [[inner] for inner in properties if inner not in before]
        if required(self.record.keys):
            given = {"anyOf": [{"required": group} for group in added]}
            rules.append({"if": given, "then": demands(self.record.keys)})
        if self.unless:
            rules.append({"if": {"required": [self.unless]}, "then": none_of(added)})


LIKE, _NAME = "like", "name"


class Alike(Listing):
    """A list of records with names; `like: NAME` in one takes over what stands in that one above it.

    What stands in the item itself comes first, also before what says the same thing there by another key. called: what
    an item without a name is called, before its number.
    """

    def __init__(self, item: Record, called: str) -> None:
        super().__init__(item)
        self.record, self.called = item, called

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read the list, its items completed."""
        items = value if isinstance(value, list) and len(value) <= MOST_ITEMS else []
        whole: dict[str, tuple[int, Tree]] = {}
        completed = []
        for index, item in enumerate(items):
            full = self._completed(reading, item, whole, (*path, index))
            if isinstance(full, dict):
                name = full.get(_NAME)
                whole.setdefault(name if isinstance(name, str) else f"{self.called} {index + 1}", (index, full))
            completed.append(full)
        return super().take(reading, completed or value, path)

    def _completed(self, reading: Reading, item: Any, above: dict[str, tuple[int, Tree]], path: Path) -> Any:
        """Return an item with what it takes over; its faults are those of the other one where they are the same."""
        if not isinstance(item, dict) or LIKE not in item or item[LIKE] is REFUSED:
            return item
        name = item[LIKE]
        if not isinstance(name, str) or name not in above:
            hint = did_you_mean(str(name), tuple(above)) or f"; above are {', '.join(map(shown, above))}"
            none_such = f"no {self.called} above this one is called '{shown(str(name))}'{hint if above else ''}"
            return reading.fault((*path, LIKE), none_such)
        index, other = above[name]
        reading.alike[path] = (*path[:-1], index)
        own = {key: value for key, value in item.items() if key != LIKE}
        replaced = {_NAME, *(key for pair in self.record.alternatives() if own.keys() & set(pair) for key in pair)}
        return {key: value for key, value in other.items() if key not in replaced} | own

    def schema(self, definitions: Schema) -> Schema:
        """Return the schema of the list; an item that is like another need not say everything."""
        properties: Schema = {}
        self.record.describe_all(properties, [], definitions)
        short = {"type": "object", "additionalProperties": False, "properties": properties}
        listing = super().schema(definitions)
        return listing | {"items": {"if": {"required": [LIKE]}, "then": short, "else": listing["items"]}}
