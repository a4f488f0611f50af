"""How a key of the machine file is declared, and the records that are made of them: `Key`, `Rule`, `Record`.

Reader, schema and pages read the table `KEYS` of a record (`Cylinder`, `Piston`, …).
"""

import dataclasses
import re
from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType, NoneType
from typing import Any, ClassVar, NamedTuple, Union

import numpy as np

from kurbel.arrays import Flags
from kurbel.declared.forms.values import Form, Number
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, Path, refuse, refused

TOO_EXTREME = "these numbers are too large or too small to compute with"


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

    def line(self, name: str) -> str:
        """Return a line of a file that gives it, such as `bore: 450 mm`; '' where it takes more than a line."""
        sample = self.example or self.form.example
        return "" if sample == "…" else f"{name}: {sample}"

    def write(self, name: str) -> str:
        """Return what to write where it is missing."""
        return f"write for instance '{self.line(name) or f'{name}: …'}'"


Keys = dict[str, Key]


def required(keys: Keys) -> list[str]:
    """Return the names of the keys that nothing else can stand for."""
    replaced = {key.instead for key in keys.values()}
    return [name for name, key in keys.items() if key.required and name not in replaced]


def contradictions(keys: Keys, given: Mapping[str, Any]) -> Iterator[Fault]:
    """Yield which keys say the same thing, or lack one another."""
    for name, key in keys.items():
        other = key.instead
        if name in given and other in given:
            yield Fault((name,), f"'{other}' and '{name}' mean the same; give only one of them")
        if name in given and key.needs and key.needs not in given:
            yield Fault((name,), f"'{name}' needs '{key.needs}' beside it")
        if other and keys[other].required and not {name, other} & given.keys():
            shown = other if keys[other].example else name
            yield Fault((), f"'{other}' or '{name}' is missing; {keys[shown].write(shown)}")


def out_of_bounds(keys: Keys, given: Mapping[str, Any]) -> Iterator[Fault]:
    """Yield which numbers are out of the bounds of their keys."""
    for name, value in given.items():
        form = keys[name].form if name in keys else None
        if isinstance(form, Number) and (wrong := form.out_of_bounds(value)):
            yield Fault((name,), f"{value:g} {wrong}")


class Rule(NamedTuple):
    """What must not be: the entry or path that is wrong, where it is broken, the sentence, and its numbers.

    broken: true where it is, of one machine or of many, (machines,); comparisons with an unknown number, NaN, are not.
    The sentence has entries and numbers in braces: `{bore}` with its unit, `{x:length}` a number with that of a kind;
    one without numbers, None, is shown as it is.
    """

    place: Union[str, Path]
    broken: Union[bool, Flags]
    sentence: str
    numbers: Mapping[str, Any] | None = MappingProxyType({})
    at_key: bool = False

    @classmethod
    def of(cls, fault: Fault) -> "Rule":
        """Return a fault that was found by itself as a rule that is broken."""
        return cls(fault.path, True, fault.message, None, fault.at_key)

    def below(self, *path: Any) -> "Rule":
        """Return it as seen from further up."""
        return self._replace(place=(*path, *self.path))

    @property
    def path(self) -> Path:
        """Where it is broken, from its record on."""
        return self.place if isinstance(self.place, tuple) else (self.place,)

    def fault(self, record: "Record | None", row: int = 0) -> Fault:
        """Return what is wrong with one of the machines, its numbers filled in, also from the entries of a record."""

        def filled(found: re.Match[str]) -> str:
            name, kind = found[1], found[2]
            if self.numbers and name in self.numbers:
                value = self.numbers[name]
            else:
                key = type(record).KEYS[name]  # type: ignore[union-attr]
                value, kind = vars(record)[key.attribute], kind or key.form.kind
            if isinstance(value, str):
                return value
            one = value[row] if isinstance(value, np.ndarray) and value.ndim else value
            return f"{one:g}" if kind in (None, "", "ratio") else show(one, kind)

        sentence = self.sentence
        if self.numbers is not None:
            sentence = re.sub(r"\{(\w+)(?::(\w+))?\}", filled, sentence)
        return Fault(self.path, sentence, self.at_key)


class Record:
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
        fields: Any = dataclasses.fields(self)  # type: ignore[arg-type]
        given = [(one.name, vars(self)[one.name]) for one in fields if vars(self)[one.name] is not one.default]
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in given)})"

    def rules(self) -> Iterator[Rule]:
        """Yield what must not be, beside the bounds of the entries."""
        return iter(())

    def _entered(self) -> dict[str, Any]:
        """Return the values of the entries that are not the default ones, by key."""
        defaults = {one.name: one.default for one in dataclasses.fields(self)}  # type: ignore[arg-type]
        values = {name: (vars(self).get(key.attribute), key.attribute) for name, key in self.KEYS.items()}
        return {name: value for name, (value, own) in values.items() if own and value is not defaults.get(own)}

    def contradictions(self) -> Iterator[Rule]:
        """Yield which entries say the same thing, or lack one another: for what is also made in Python."""
        return map(Rule.of, contradictions(self.KEYS, self._entered()))

    def faults(self) -> Iterator[Fault]:
        """Yield what is wrong with the record of one machine: the bounds, or else the rules, or what is no number."""
        scalars = ((name, value) for name, value in self._entered().items() if not isinstance(value, (tuple, NoneType)))
        given = {name: value for name, value in scalars if np.ndim(value) == 0}
        found = [*out_of_bounds(self.KEYS, given)]
        found = found or [rule.fault(self) for rule in self.rules() if np.ndim(rule.broken) == 0 and rule.broken]
        yield from found or (Fault((name,), "nan is no number") for name, value in given.items() if value != value)

    @classmethod
    def from_keys(cls, **values: Any) -> Any:
        """Return the record that the values of these keys make; None is a value that is not given.

        What holds for a machine file holds here. Raises RuleError for values that contradict or lack one another, or
        are out of the bounds of their keys, and for whatever the record refuses.
        """
        given = {name: value for name, value in values.items() if value is not None}
        refuse(*contradictions(cls.KEYS, given), *out_of_bounds(cls.KEYS, given))
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
