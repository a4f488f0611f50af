"""How a key of the machine file is declared, and the records made of such keys: `Key`, `Rule`, `Record`.

Reader, schema and pages read the table `KEYS` of a record (`Cylinder`, `Piston`, …).
"""

import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import MISSING, Field, dataclass, fields
from inspect import Parameter, Signature
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Union

import numpy as np

from kurbel.arrays import Truth
from kurbel.declared.forms.values import Form, NumberForm
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, NotANumber, Path, Step, refuse, refused
from kurbel.numerics.arithmetic import is_number

if TYPE_CHECKING:
    from typing_extensions import dataclass_transform
else:  # typing has it from Python 3.11 on

    def dataclass_transform(**_):
        """Return a decorator that changes nothing."""
        return lambda made: made


TOO_EXTREME = "these numbers are too large or too small to compute with"
ValuesByKey = Mapping[str, Any]
"""Values by key: what their forms make of them; REFUSED where one could not be read."""


class Key(NamedTuple):
    """One key: its form, its meaning in one sentence, the textbook symbol, and whether it is required.

    absent: what holds without it. instead: another key that gives the same quantity; both together are a contradiction,
    and if that one is required, one of the two is. needs: a key that must be given with it; or_else: what to write
    where that one is not known. also: other words that people try for it. attribute: of the record, which has the
    value; '' for a key that only determines others: `gives` takes the values by key and returns these attributes.
    compared: it may be given beside the key that it is instead of; a rule compares both. usual: the rule of thumb for
    its size, with its source.
    """

    form: Form
    text: str
    symbol: str = ""
    required: bool = False
    absent: str = ""
    instead: str = ""
    needs: str = ""
    or_else: str = ""
    example: str = ""
    also: tuple[str, ...] = ()
    attribute: str = ""
    gives: Callable[[ValuesByKey], dict[str, object]] | None = None
    compared: bool = False
    usual: str = ""

    @property
    def description(self) -> str:
        """What an editor shows."""
        text = f"{self.text} ({self.symbol})" if self.symbol else self.text
        if self.usual:
            text = f"{text}; usual: {self.usual}"
        if not self.absent:
            return text
        return f"{text}; absent: {self.absent}"

    @property
    def written(self) -> str:
        """How its value is written: as the form says, with the example of the key."""
        written = self.form.written
        if not self.example:
            return written
        return written.replace(self.form.example, self.example)

    def line(self, name: str) -> str:
        """Return a line of a file that gives it, such as `bore: 450 mm`; '' if it takes more than one line."""
        sample = self.example or self.form.example
        if sample == "…":
            return ""
        return f"{name}: {sample}"

    def write(self, name: str) -> str:
        """Return what to write where it is missing."""
        line = self.line(name) or f"{name}: …"
        return f"write for instance '{line}'"


Keys = dict[str, Key]


def required(keys: Keys, present: Collection[str] = ()) -> list[str]:
    """Return the names of the keys that must be given, and that no other key can replace.

    One that is compared with what it replaces does so where it is present: the message on what is missing names the
    usual key alone.
    """
    replaceable = set()
    for name, key in keys.items():
        if not key.compared or name in present:
            replaceable.add(key.instead)
    return [name for name, key in keys.items() if key.required and name not in replaceable]


def absent_text(keys: Keys, name: str) -> str:
    """Return what holds without a key: its `absent`, or that it (or an alternative) must be given."""
    if not keys[name].required:
        return keys[name].absent
    alternatives = [other for other, key in keys.items() if key.instead == name]
    if not alternatives:
        return "must be given"
    return f"{' or '.join([name, *alternatives])} must be given"


class Rule(NamedTuple):
    """A condition that is an error: the key or path that is wrong, the condition, the message, and its numbers.

    broken: true if the condition holds, for many machines an array (machines,); an unknown number (NaN) breaks no rule.
    sentence: the message; braces hold entries and numbers: `{bore}` is written with its unit, `{x:length}` as a length.
    at_key: the key itself is wrong, where the message points, and not its value.
    """

    place: Union[str, Path]
    broken: Truth
    sentence: str
    numbers: ValuesByKey = MappingProxyType({})
    at_key: bool = False

    @property
    def path(self) -> Path:
        """The place as a path."""
        if isinstance(self.place, tuple):
            return self.place
        return (self.place,)

    def below(self, *path: Step) -> "Rule":
        """Return the rule with its place relative to an outer record."""
        return self._replace(place=(*path, *self.path))

    def fault(self, record: "Record | None" = None) -> Fault:
        """Return the fault, with numbers of the rule and entries of the record filled into its message."""

        def fill(brace: re.Match[str]) -> str:
            name, kind = brace[1], brace[2] or ""
            key = record.KEYS.get(name) if record else None
            if name in self.numbers:
                value = self.numbers[name]
            elif key:
                value = vars(record)[key.attribute]
                kind = kind or key.form.kind
            else:
                return brace[0]
            if isinstance(value, str):
                return value
            if kind:
                return show(value, kind)
            return f"{value:g}"

        message = re.sub(r"\{(\w+)(?::(\w+))?\}", fill, self.sentence)
        return Fault(self.path, message, self.at_key)


def contradictions(keys: Keys, present: Collection[str]) -> Iterator[Rule]:
    """Yield the rules on keys that give the same quantity, or that need another key; present: keys of the file."""
    for name, key in keys.items():
        other = key.instead
        # the same quantity twice
        if name in present and other in present and not key.compared:
            yield Rule(name, True, f"'{other}' and '{name}' mean the same; give only one of them")
        # a key without the one that it needs
        if name in present and key.needs and key.needs not in present:
            otherwise = f"; {key.or_else}" if key.or_else else ""
            yield Rule(name, True, f"'{name}' needs '{key.needs}' beside it{otherwise}")
        # neither of two, one of which is required
        is_required = other in keys and keys[other].required
        if is_required and name not in present and other not in present:
            advised = other if keys[other].example else name
            advice = keys[advised].write(advised)
            yield Rule((), True, f"'{other}' or '{name}' is missing; {advice}")


def broken(rules: Iterable[Rule], record: "Record | None" = None) -> list[Fault]:
    """Return the faults of one machine; rules with arrays of many machines are evaluated by the sweep."""
    return [rule.fault(record) for rule in rules if np.ndim(rule.broken) == 0 and rule.broken]


def _out_of_bounds(keys: Keys, values: ValuesByKey) -> list[Fault]:
    """Return the faults of numbers that break a bound of their key."""
    faults = []
    for name, value in values.items():
        form = keys[name].form
        if not is_number(value) or not isinstance(form, NumberForm):
            continue
        broken_bound = form.out_of_bounds(value)
        if broken_bound:
            faults.append(Fault((name,), f"{value:g} {broken_bound}"))
    return faults


@dataclass_transform(frozen_default=True, eq_default=False)
class Record:
    """A record of the machine file; each entry is declared once, by `field` or `alternative`.

    A subclass is a dataclass whose one constructor is inherited, so that no code is generated for it; it cannot be
    changed, and is compared by identity.
    """

    KEYS: ClassVar[Keys] = {}
    UNWRITTEN: ClassVar[Mapping[str, str]] = {}
    """Words that people try for what no key describes -> what to write instead."""
    __dataclass_fields__: ClassVar[dict[str, Field[object]]]
    __signature__: ClassVar[Signature]

    def __init_subclass__(cls) -> None:
        # its keys, after those of the class that it extends
        keys = dict(cls.KEYS)
        for name, value in vars(cls).items():
            if isinstance(value, Key):
                keys[value.attribute or name.lstrip("_")] = value._replace(attribute="")
            elif isinstance(value, Field):
                if value.default is MISSING and "None" in str(cls.__annotations__[name]):
                    value.default = None
                key: Key = value.metadata["key"]
                # one of two alternatives, or a word with a default of its own, may be missing
                has_substitute = bool(key.instead or key.form.inline)
                is_required = value.default is MISSING and not has_substitute
                keys[key.attribute or name] = key._replace(attribute=name, required=is_required)
        cls.KEYS = keys
        dataclass(init=False, repr=False, eq=False)(cls)
        # positional arguments: first those without a default
        parameters = []
        for entry in sorted(fields(cls), key=lambda entry: entry.default is not MISSING):
            default = Parameter.empty if entry.default is MISSING else entry.default
            parameters.append(
                Parameter(
                    entry.name,
                    Parameter.POSITIONAL_OR_KEYWORD,
                    default=default,
                    annotation=entry.type,
                )
            )
        cls.__signature__ = Signature(parameters)

    def __init__(self, *values: object, **named: object) -> None:
        bound = self.__signature__.bind(*values, **named)
        bound.apply_defaults()
        vars(self).update(bound.arguments)
        try:
            refuse(*self._faults())
        except ArithmeticError:
            refused(TOO_EXTREME)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(
            f"a {type(self).__name__} cannot be changed; make another one by dataclasses.replace"
        )

    def __repr__(self) -> str:
        """Return the call that makes the record, without what has its default value: a machine has many of these."""
        arguments = [f"{name}={value!r}" for name, value in self._not_default().items()]
        return f"{type(self).__name__}({', '.join(arguments)})"

    def _not_default(self) -> dict[str, object]:
        """Return the values that are not their defaults, by attribute."""
        values = vars(self)
        return {
            entry.name: values[entry.name]
            for entry in fields(self)
            if values[entry.name] is not entry.default
        }

    def rules(self) -> Iterator[Rule]:
        """Yield the rules on the values, in addition to the bounds of the entries."""
        return iter(())

    @classmethod
    def completed(
        cls, values: dict[str, object], made: Callable[[object], Any]
    ) -> dict[str, object]:
        """Return values by key with what follows from those of several inner mappings, before these become records.

        made: makes the record of one of them.
        """
        return values

    @classmethod
    def rules_of_keys(cls, values: ValuesByKey) -> Iterator[Rule]:
        """Yield the rules on the values by key, before they become a record."""
        return iter(())

    def _faults(self) -> list[Fault]:
        """Return what is wrong with the record of one machine: bounds; if these hold, rules; if these hold, NaN."""
        # the values that are not their defaults, by key
        keys = {name: key for name, key in self.KEYS.items() if key.attribute}
        by_attribute = self._not_default()
        values = {
            name: by_attribute[key.attribute]
            for name, key in keys.items()
            if key.attribute in by_attribute
        }
        faults = _out_of_bounds(keys, values)
        if not faults:
            faults = broken((*contradictions(keys, values), *self.rules()), self)
        if not faults:
            for name, value in values.items():
                if isinstance(value, float) and math.isnan(value):
                    faults.append(NotANumber((name,), "nan is no number"))
        return faults

    @classmethod
    def from_keys(cls, **values: object) -> Any:
        """Return the record of these values by key; None for a key that is not given.

        The same checks as for a machine file: raises RuleError for keys that contradict or require one another, for
        values out of bounds, and for broken rules.
        """
        values = {name: value for name, value in values.items() if value is not None}
        refuse(*broken(contradictions(cls.KEYS, values)), *_out_of_bounds(cls.KEYS, values))
        refuse(*broken(cls.rules_of_keys(values)))
        return cls.of_keys(**values)

    @classmethod
    def of_keys(cls, *args: Any, **values: Any) -> Any:
        """Return the record of the values of its keys: its fields, and those that alternatives determine."""
        attributes = {cls.KEYS[name].attribute: value for name, value in values.items()}
        attributes.pop("", None)
        for name, key in cls.KEYS.items():
            if key.gives and name in values:
                attributes |= key.gives({**attributes, **values})
        return cls(*args, **attributes)

    @classmethod
    def faults_of_some(cls, values: ValuesByKey) -> list[Fault]:
        """Return what is wrong with values by key of which some are REFUSED: keys that contradict one another."""
        return broken(contradictions(cls.KEYS, values))
