"""Forms made of others: lists, alternatives, mappings with one telling key, records whose keys stand among others."""

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from kurbel.declared.forms.records import Record, demands, no_mapping
from kurbel.declared.forms.scalars import Choice
from kurbel.declared.keys import ABSENT, Form, Key, Schema, none_of, required
from kurbel.declared.kinds import MOST_ITEMS
from kurbel.declared.reading import REFUSED, Plain, Reading, Tree, is_nothing, kind_of
from kurbel.errors import Fault, Path, refused
from kurbel.near_words import near


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
