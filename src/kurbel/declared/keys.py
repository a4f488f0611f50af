"""How a key of the machine file is declared: its form, symbol and sentence. Reader, schema and docs read it.

A record (`Cylinder`, `Piston`, …) carries a table `KEYS` of these.
"""

import dataclasses
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields
from types import MappingProxyType
from typing import Any, ClassVar, NamedTuple, Union

import numpy as np

from kurbel.arrays import Flags
from kurbel.declared.reading import REFUSED, Reading, Tree
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, Path, RuleError, refuse, refused

Schema = dict[str, Any]
ABSENT = object()
"""What is found of a key that is not given."""

TOO_EXTREME = "these numbers are too large or too small to compute with"


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

    @property
    def is_number(self) -> bool:
        """Whether what stands under a key becomes a number, so that many machines have an array there."""
        return False

    def of_numbers(self, numbers: Any) -> Any:
        """Return what a number in the base of its kind, or those of many machines, becomes."""
        return numbers

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
    other words that people try for it. attribute: of the record, that the value becomes; '' for one that only `gives`
    others: it takes the values by key, and returns those that follow from them.
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
    attribute: str = ""
    gives: Callable[[Mapping[str, Any]], dict[str, Any]] | None = None

    @property
    def description(self) -> str:
        """What an editor shows."""
        symbol = f" ({self.symbol})" if self.symbol else ""
        return f"{self.text}{symbol}" + (f"; absent: {self.absent}" if self.absent else "")

    def write(self, name: str) -> str:
        """Return what to write where it is missing."""
        return f"write for instance '{name}: {self._example}'"

    def line(self, name: str) -> str:
        """Return a line of a file that gives it, such as `bore: 450 mm`; '' where it takes more than a line."""
        return "" if self._example == "…" else f"{name}: {self._example}"

    @property
    def _example(self) -> str:
        return self.example or self.form.example()


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


class Rule(NamedTuple):
    """What must not be: the entry or path that is wrong, where it is broken, the sentence, and its numbers.

    broken: true where it is, of one machine or of many, (machines,); comparisons with an unknown number, NaN, are not.
    The sentence has entries and numbers in braces: `{bore}` with its unit, `{x:length}` a number with that of a kind.
    """

    place: Union[str, Path]
    broken: Union[bool, Flags]
    sentence: str
    numbers: Mapping[str, Any] = MappingProxyType({})
    at_key: bool = False

    @classmethod
    def of(cls, fault: Fault) -> "Rule":
        """Return a fault that was found by itself as a rule that is broken."""
        plain = fault.message.replace("{", "{{").replace("}", "}}")
        return cls(fault.path, True, plain, at_key=fault.at_key)

    def below(self, *path: Any) -> "Rule":
        """Return it as seen from further up."""
        return self._replace(place=(*path, *self.path))

    @property
    def path(self) -> Path:
        """Where it is broken, from its record on."""
        return self.place if isinstance(self.place, tuple) else (self.place,)

    def fault(self, record: "Described | None", row: int = 0) -> Fault:
        """Return what is wrong with one of the machines, its numbers filled in, also from the entries of a record."""
        return Fault(self.path, self.sentence.format_map(_Numbers(record, self.numbers, row)), self.at_key)


class _Numbers(dict[str, Any]):
    """The numbers of a sentence: its own, or entries of the record as they are shown."""

    def __init__(self, record: "Described | None", numbers: Mapping[str, Any], row: int) -> None:
        super().__init__(numbers)
        self._record, self._row = record, row

    def __getitem__(self, name: str) -> "_Shown":
        if name in self or self._record is None:
            value, kind = super().__getitem__(name), ""
        else:
            key = self._record.KEYS[name]
            value, kind = vars(self._record)[key.attribute], key.form.kind
        return _Shown(value[self._row] if getattr(value, "ndim", 0) else value, kind)


class _Shown(NamedTuple):
    """A number of a sentence, with the kind of its entry."""

    value: Any
    kind: str

    def __format__(self, kind: str) -> str:
        known = kind or self.kind
        if isinstance(self.value, str):
            return self.value
        return f"{self.value:g}" if known in ("", "ratio") else show(self.value, known)


class Described:
    """A record of the machine file; each entry is said once, by `field` or `alternative`."""

    KEYS: ClassVar[Keys] = {}

    def __init_subclass__(cls) -> None:
        own: Keys = {name: key for base in cls.__mro__[:0:-1] for name, key in vars(base).get("KEYS", {}).items()}
        for name, value in vars(cls).items():
            if isinstance(value, dataclasses.Field) and "key" in value.metadata:
                key = value.metadata["key"]
                own[key.attribute or name] = key._replace(attribute=name)
            elif isinstance(value, Key):
                own[value.attribute or name] = value._replace(attribute="")
        cls.KEYS = own

    def __post_init__(self) -> None:
        try:
            refuse(*self.faults())
        except ArithmeticError:
            refused(TOO_EXTREME)

    def __repr__(self) -> str:
        """Return the call that makes the record, without what has its default value: a machine has many of these."""
        record: Any = self
        values = [(one, getattr(record, one.name)) for one in fields(record)]
        given = (f"{one.name}={value!r}" for one, value in values if value is not one.default)
        return f"{type(self).__name__}({', '.join(given)})"

    def rules(self) -> Iterator[Rule]:
        """Yield what must not be, beside the bounds of the entries."""
        return iter(())

    def contradictions(self) -> Iterator[Rule]:
        """Yield which entries say the same thing, or lack one another: for what is also made in Python."""
        given = {
            name: one.default is not vars(self)[one.name]
            for one in fields(self)  # type: ignore[arg-type]
            for name, key in self.KEYS.items()
            if key.attribute == one.name
        }
        known = {name: True for name, differs in given.items() if differs}
        return (Rule(one.path, True, one.message) for one in contradictions(self.KEYS, known))

    def faults(self) -> Iterator[Fault]:
        """Yield what is wrong with the record of one machine: the bounds, or else the rules, or what is no number."""
        numbers = list(self._numbers())
        found = [
            Fault((name,), f"{value:g} {wrong}")
            for name, form, value in numbers
            if (wrong := form.out_of_bounds(value))
        ]
        found = found or [rule.fault(self) for rule in self.rules() if np.ndim(rule.broken) == 0 and rule.broken]
        yield from found or (Fault((name,), "nan is no number") for name, _, value in numbers if value != value)

    def _numbers(self) -> Iterator[tuple[str, Form, Any]]:
        """Yield the entries that are given, but for arrays, with their forms."""
        defaults = {one.name: one.default for one in fields(self)}  # type: ignore[arg-type]
        for name, key in self.KEYS.items():
            value: Any = vars(self).get(key.attribute)
            if value is not None and value is not defaults.get(key.attribute) and np.ndim(value) == 0:
                yield name, key.form, value

    @classmethod
    def from_keys(cls, **values: Any) -> Any:
        """Return the record that the values of these keys make; absent keys are not passed.

        Raises RuleError for values that contradict one another, and for whatever the record refuses.
        """
        check(cls.KEYS, values)
        refuse(*cls.faults_of_keys(values))
        return cls.of_keys(**values)

    @classmethod
    def of_keys(cls, *args: Any, **values: Any) -> Any:
        """Return the record of the values of its keys: its fields, and what its alternatives give."""
        keys = cls.KEYS
        known = {keys[name].attribute if name in keys else name: value for name, value in values.items()}
        known.pop("", None)
        for name, key in keys.items():
            if key.gives and name in values:
                known |= key.gives({**known, **values})
        return cls(*args, **known)

    @classmethod
    def faults_of_keys(cls, values: Mapping[str, Any]) -> list[Fault]:
        """Return what is wrong with values by key, of which some may be REFUSED."""
        return [rule.fault(None) for rule in cls.rules_of_keys(values) if rule.broken]

    @classmethod
    def rules_of_keys(cls, given: Mapping[str, Any]) -> Iterator[Rule]:
        """Yield what must not be of the values by key, before they become a record; some may be REFUSED."""
        return iter(())
