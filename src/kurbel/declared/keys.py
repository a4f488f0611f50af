"""How a key of the machine file is declared, and the records that are made of them: `Key`, `Rule`, `Record`.

Reader, schema and pages read the table `KEYS` of a record (`Cylinder`, `Piston`, …).
"""

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import Field, dataclass, fields
from types import MappingProxyType, NoneType
from typing import Any, ClassVar, NamedTuple, Union

import numpy as np

from kurbel.arrays import Flags
from kurbel.declared.forms.values import Form, NumberForm
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, Path, Step, refuse, refused

TOO_EXTREME = "these numbers are too large or too small to compute with"
Values = Mapping[str, Any]
"""Values by key: what their forms make of them; REFUSED where one could not be read."""


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
    gives: Callable[[Values], dict[str, Any]] | None = None

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
    """Return the names of the keys that must be given, and that no other key can replace."""
    replaced = {key.instead for key in keys.values()}
    return [name for name, key in keys.items() if key.required and name not in replaced]


def without(keys: Keys, name: str) -> str:
    """Return what holds without a key: that it must be given, it or one of others, or else what `absent` says."""
    key = keys[name]
    either = [name, *(other for other, one in keys.items() if one.instead == name)]
    alone = "must be given" if len(either) == 1 else f"{' or '.join(either)} must be given"
    return alone if key.required else key.absent


class Rule(NamedTuple):
    """What must not be: the entry or path that is wrong, where it is broken, the sentence, and its numbers.

    broken: true where it is, of one machine or of many, (machines,); comparisons with an unknown number, NaN, are not.
    The sentence has entries and numbers in braces: `{bore}` with its unit, `{x:length}` a number with that of a kind.
    """

    place: Union[str, Path]
    broken: Union[bool, Flags]
    sentence: str
    numbers: Values = MappingProxyType({})
    at_key: bool = False

    @classmethod
    def of(cls, fault: Fault) -> "Rule":
        """Return a fault that was found by itself as a rule that is broken."""
        return cls(fault.path, True, fault.message, at_key=fault.at_key)

    def below(self, *path: Step) -> "Rule":
        """Return it as seen from further up."""
        return self._replace(place=(*path, *self.path))

    @property
    def path(self) -> Path:
        """Where it is broken, from its record on."""
        return self.place if isinstance(self.place, tuple) else (self.place,)

    def fault(self, record: "Record | None" = None) -> Fault:
        """Return what is wrong with a machine, its numbers filled in, also from the entries of a record."""

        def filled(found: re.Match[str]) -> str:
            name, kind = found[1], found[2] or ""
            key = record.KEYS.get(name) if record else None
            if name in self.numbers:
                value = self.numbers[name]
            elif key:
                value, kind = vars(record)[key.attribute], kind or key.form.kind
            else:
                return found[0]
            return str(value) if isinstance(value, str) else show(value, kind) if kind else f"{value:g}"

        return Fault(self.path, re.sub(r"\{(\w+)(?::(\w+))?\}", filled, self.sentence), self.at_key)


def contradictions(keys: Keys, given: Collection[str]) -> Iterator[Rule]:
    """Yield which keys give the same quantity, or need another key."""
    for name, key in keys.items():
        other = key.instead
        if name in given and other in given:
            yield Rule(name, True, f"'{other}' and '{name}' mean the same; give only one of them")
        if name in given and key.needs and key.needs not in given:
            yield Rule(name, True, f"'{name}' needs '{key.needs}' beside it")
        if other in keys and keys[other].required and name not in given and other not in given:
            shown = other if keys[other].example else name
            yield Rule((), True, f"'{other}' or '{name}' is missing; {keys[shown].write(shown)}")


def _broken(rules: Iterable[Rule], record: "Record | None" = None) -> list[Fault]:
    """Return what is wrong with one machine; rules on the numbers of many are left to those who have them."""
    return [rule.fault(record) for rule in rules if np.ndim(rule.broken) == 0 and rule.broken]


def _out_of_bounds(keys: Keys, given: Values) -> list[Fault]:
    forms = {name: key.form for name, key in keys.items() if name in given}
    found = ((name, form.out_of_bounds(given[name])) for name, form in forms.items() if isinstance(form, NumberForm))
    return [Fault((name,), f"{given[name]:g} {wrong}") for name, wrong in found if wrong]


@dataclass(frozen=True, eq=False, repr=False)
class Record:
    """A record of the machine file; each entry is said once, by `field` or `alternative`."""

    KEYS: ClassVar[Keys] = {}

    def __init_subclass__(cls) -> None:
        own = {name: key for base in cls.__mro__[:0:-1] for name, key in vars(base).get("KEYS", {}).items()}
        for name, value in vars(cls).items():
            key = value.metadata.get("key") if isinstance(value, Field) else value
            if isinstance(key, Key):
                attribute = name if isinstance(value, Field) else ""
                own[key.attribute or name.lstrip("_")] = key._replace(attribute=attribute)
        cls.KEYS = own

    def __post_init__(self) -> None:
        try:
            refuse(*self.faults())
        except ArithmeticError:
            refused(TOO_EXTREME)

    def __repr__(self) -> str:
        """Return the call that makes the record, without what has its default value: a machine has many of these."""
        given = [(one.name, vars(self)[one.name]) for one in fields(self) if vars(self)[one.name] is not one.default]
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in given)})"

    def rules(self) -> Iterator[Rule]:
        """Yield what must not be, beside the bounds of the entries."""
        return iter(())

    @classmethod
    def rules_of_keys(cls, given: Values) -> Iterator[Rule]:
        """Yield what must not be of the values by key, before they become a record; some may be REFUSED."""
        return iter(())

    def faults(self) -> list[Fault]:
        """Return what is wrong with the record of one machine: the bounds, or else the rules, or what is no number."""
        default = {one.name: one.default for one in fields(self)}
        keys = {name: key for name, key in self.KEYS.items() if key.attribute}
        known = {name: (vars(self)[key.attribute], default.get(key.attribute)) for name, key in keys.items()}
        given = {name: value for name, (value, absent) in known.items() if value is not absent}
        scalars = {name: value for name, value in given.items() if not isinstance(value, (tuple, NoneType))}
        numbers = {name: value for name, value in scalars.items() if np.ndim(value) == 0}
        return (
            _out_of_bounds(keys, numbers)
            or _broken((*contradictions(keys, given), *self.rules()), self)
            or [Fault((name,), "nan is no number") for name, value in numbers.items() if value != value]
        )

    @classmethod
    def from_keys(cls, **values: Any) -> Any:
        """Return the record that the values of these keys make; None is a value that is not given.

        What holds for a machine file holds here. Raises RuleError for values that contradict or lack one another, or
        are out of the bounds of their keys, and for whatever the record refuses.
        """
        given = {name: value for name, value in values.items() if value is not None}
        refuse(*_broken(contradictions(cls.KEYS, given)), *_out_of_bounds(cls.KEYS, given))
        refuse(*_broken(cls.rules_of_keys(values)))
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
    def faults_of_keys(cls, given: Values) -> list[Fault]:
        """Return what is wrong with values by key, of which some are REFUSED: contradictions, and rules of others."""
        return _broken((*contradictions(cls.KEYS, given), *cls.rules_of_keys(given)))
