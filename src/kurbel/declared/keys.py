"""How a key of the machine file is declared: its form, symbol and sentence. Reader, schema and docs read it.

A record (`Cylinder`, `Piston`, …) carries a table `KEYS` of these.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields
from typing import Any, ClassVar, NamedTuple

from kurbel.declared.reading import REFUSED, Reading, Tree
from kurbel.errors import Fault, Path, RuleError, refuse

Schema = dict[str, Any]
ABSENT = object()
"""What is found of a key that is not given."""


class Form(ABC):
    """What may stand under a key. Every kind of form supplies `take`, `expected` and `schema`."""

    shape: ClassVar[type] = str
    """Of the tree: str, list or dict."""
    shared: ClassVar[bool] = False
    """Whether keys of another record stand in the mapping in place of the key."""
    kind: str = ""
    """Kind of quantity of the number that stands under a key, or of each one of a list; '' where none does."""

    @abstractmethod
    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Return what a value of the tree becomes; faults are noted, or raised as RuleError."""

    @abstractmethod
    def expected(self) -> str:
        """Return what stands under a key of this form, for 'expected …'."""

    @abstractmethod
    def schema(self, definitions: Schema) -> Schema:
        """Return the JSON Schema of a value of this form; what is used more than once goes into the definitions."""

    def example(self) -> str:
        """Return a value as a person would write it, or '…' for what is longer than a line."""
        return "…"

    def written(self) -> str:
        """Return in a few words what is written for a key, for the page of symbols."""
        return self.expected() if self.shape is str else "a mapping"

    def suits(self, value: Any) -> bool:
        """Return whether a value of the right shape looks like one of this form."""
        return True

    def out_of_bounds(self, value: Any) -> str:
        """Return in what way a value is too small or too large, with the bound; '' when it is not."""
        return ""

    def numbers(self, texts: Sequence[str]) -> list[float] | None:
        """Return what texts become that are plain numbers, all of them; None where each must be read by itself."""
        return None

    def read(self, reading: Reading, value: Any, path: Path) -> Any:
        """Return what a value of the tree becomes, or REFUSED after noting every fault."""
        if value is REFUSED:
            return REFUSED
        try:
            return self.take(reading, value, path)
        except RuleError as error:
            return reading.refuse(path, error)

    def find(self, reading: Reading, name: str, mapping: Tree, rest: Tree, path: Path) -> Any:
        """Return what a mapping has under a key; `rest` of it is what does not belong to the record of the key."""
        return self.read(reading, mapping[name], (*path, name)) if name in mapping else ABSENT

    def names(self, name: str, mapping: Tree) -> Iterable[str]:
        """Return the names of all keys of a mapping that a key of this form stands for."""
        return (name,)

    def moved(self, name: str, mapping: Tree) -> dict[str, str]:
        """Return the names that do not stand in this mapping but below this key or in a list, each with that place."""
        return {}

    def called_from(self, words: str, mapping: Tree) -> str:
        """Return words for the place of a key as that place is called from this mapping."""
        return words

    def flat(self, fault: Fault, mapping: Tree) -> Fault:
        """Return a fault of the record as one of its mapping, whatever list the record has made of it."""
        return fault

    def parts(self) -> "Iterable[tuple[str, Form]]":
        """Return the forms that this one is made of, each after the key that it stands under, '' for none."""
        return ()

    def places(self, path: str, words: str) -> Iterator[tuple[str, str]]:
        """Yield every key that may stand in a mapping of this form, each after the words for that mapping."""
        for name, form in self.parts():
            yield from form.places_of(name, path, words) if name else form.places(path, words)

    def places_of(self, name: str, path: str, words: str) -> Iterator[tuple[str, str]]:
        """Yield a key of this form after the words for its mapping, then what may stand below it."""
        yield words, name
        inner = f"{path}.{name}" if path else name
        yield from self.places(inner, f"under '{inner}'")

    def meant(self, name: str, key: "Key") -> "dict[str, tuple[str, Form]]":
        """Return what people try for what a key of this form stands for, each with the key that is meant and its form.

        Such are other words for it, and the symbol with which the books write it.
        """
        return dict.fromkeys(filter(None, (*key.also, key.symbol)), (name, self)) | {
            word: inner
            for record in self.inline()
            for other, one in record.keys.items()
            for word, inner in one.form.meant(other, one).items()
        }

    def inline(self) -> Iterable[Any]:
        """Return the records whose keys stand beside a key of this form, in the same mapping."""
        return ()

    def records(self, word: str) -> Iterator[tuple[str, Any]]:
        """Yield the records that a key leads to, each after the word that names it."""
        for name, form in self.parts():
            yield from form.records(name or word)

    def describe(self, name: str, key: "Key", properties: Schema, rules: list[Schema], definitions: Schema) -> None:
        """Add a key of this form to the schema of its mapping."""
        properties.setdefault(name, {**self.schema(definitions), "description": key.description})
        if key.instead:
            rules.append(none_of([[name, key.instead]]))
        if key.needs:
            rules.append({"dependencies": {name: [key.needs]}})


class Key(NamedTuple):
    """One key: its form, what it means in one sentence, the textbook symbol, and whether it must stand there.

    `absent` says what holds without it. `instead` names another key that says the same thing, so that both together are
    a contradiction; where that one is required, one of both is. `needs` names a key that must stand beside it. `also`:
    other words that people try for it.
    """

    form: Form
    text: str
    symbol: str = ""
    required: bool = False
    absent: str = ""
    instead: str = ""
    needs: str = ""
    example: str = ""
    also: tuple[str, ...] = ()

    @property
    def description(self) -> str:
        """What an editor shows."""
        symbol = f" ({self.symbol})" if self.symbol else ""
        return f"{self.text}{symbol}" + (f"; absent: {self.absent}" if self.absent else "")

    def write(self, name: str) -> str:
        """Return what to write where it is missing."""
        return f"write for instance '{name}: {self.example or self.form.example()}'"


Keys = dict[str, Key]


def required(keys: Keys) -> list[str]:
    """Return the names of the keys that nothing else can stand for."""
    replaced = {key.instead for key in keys.values()}
    return [name for name, key in keys.items() if key.required and name not in replaced]


def none_of(groups: list[list[str]]) -> Schema:
    """Return a schema that forbids each of these groups of keys together."""
    return {"not": {"anyOf": [{"required": group} for group in groups]}}


def check(keys: Keys, values: Mapping[str, Any]) -> None:
    """Raise RuleError for values that contradict or lack one another, or are out of the bounds of their keys.

    What holds for a machine file holds for records that are made in Python. None is a value that is not given.
    """
    given = {name: value for name, value in values.items() if value is not None}
    wrong = {name: keys[name].form.out_of_bounds(value) for name, value in given.items() if name in keys}
    beyond = (Fault((name,), f"{given[name]:g} {how}") for name, how in wrong.items() if how)
    refuse(*contradictions(keys, given), *beyond)


def contradictions(keys: Keys, given: Mapping[str, Any]) -> Iterator[Fault]:
    """Yield which keys say the same thing, or lack one another."""
    for name, key in keys.items():
        other = key.instead
        if name in given and other in given:
            yield Fault((name,), f"'{other}' and '{name}' say the same thing; leave one of them out")
        if name in given and key.needs and key.needs not in given:
            yield Fault((name,), f"'{name}' needs '{key.needs}' beside it")
        if other and keys[other].required and not {name, other} & given.keys():
            shown = other if keys[other].example else name
            yield Fault((), f"'{other}' or '{name}' is missing; {keys[shown].write(shown)}")


class Described:
    """A record that a machine file describes by its `KEYS`."""

    KEYS: ClassVar[Keys]

    def __repr__(self) -> str:
        """Return the call that makes the record, without what has its default value: a machine has many of these."""
        record: Any = self
        values = [(one, getattr(record, one.name)) for one in fields(record)]
        given = (f"{one.name}={value!r}" for one, value in values if value is not one.default)
        return f"{type(self).__name__}({', '.join(given)})"

    @classmethod
    def from_keys(cls, **values: Any) -> Any:
        """Return the record that the values of these keys make; absent keys are not passed.

        Raises RuleError for values that contradict one another, and for whatever the record refuses.
        """
        check(cls.KEYS, values)
        return cls.of_keys(**values)

    @classmethod
    def of_keys(cls, *args: Any, **values: Any) -> Any:
        """Return the record; its fields are the keys, where it does not say otherwise."""
        return cls(*args, **values)

    @staticmethod
    def faults_of_keys(values: Mapping[str, Any]) -> Iterable[Fault]:
        """Return what is wrong with the values that could be read, where others could not be."""
        return ()
