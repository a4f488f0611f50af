"""How a key of the machine file is declared: its form, symbol and sentence. Reader, schema and docs read it.

A record (`Cylinder`, `Piston`, …) carries a table `KEYS` of these. It is built from the values of its keys by
`record.from_keys(**values)` where it has that method, otherwise by its constructor; absent keys are not passed.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Union

from kurbel.errors import Fault, RuleError


class Physical(NamedTuple):
    """A number with a unit of this kind, such as `450 mm`; becomes a float in the base of the kind.

    above: the value must be larger; least, most: it must not be smaller or larger. `words` are texts allowed instead,
    such as `infinite`, with the value they stand for.
    """

    kind: str
    above: float | None = None
    least: float | None = None
    most: float | None = None
    words: tuple[tuple[str, float], ...] = ()


class Number(NamedTuple):
    """A bare number (a ratio, a fraction, a coefficient) with its bounds; becomes a float."""

    above: float | None = None
    least: float | None = None
    below: float | None = None
    most: float | None = None
    words: tuple[tuple[str, float], ...] = ()


def out_of_bounds(value: float, form: Physical | Number) -> str:
    """Return in what way a value is too small or too large for its form, with the bound; '' when it is not.

    >>> out_of_bounds(-0.3, Physical("length", least=0.1))
    'is too small; it must be at least 100 mm'
    """
    below = form.below if isinstance(form, Number) else None
    kind = form.kind if isinstance(form, Physical) else "ratio"
    if form.above is not None and not value > form.above:
        return f"is too small; it must be more than {_bound(form.above, kind)}"
    if form.least is not None and not value >= form.least:
        return f"is too small; it must be at least {_bound(form.least, kind)}"
    if below is not None and not value < below:
        return f"is too large; it must be less than {_bound(below, kind)}"
    if form.most is not None and not value <= form.most:
        return f"is too large; it must be at most {_bound(form.most, kind)}"
    return ""


def _bound(value: float, kind: str) -> str:
    from kurbel.declared.unit_systems import show

    return "0" if value == 0 else show(value, kind)


class Count(NamedTuple):
    """A whole number; becomes an int."""

    least: int = 1
    most: int | None = None


class Text(NamedTuple):
    """Any text that is not empty."""


class Choice(NamedTuple):
    """One of these words."""

    words: tuple[str, ...]


class FilePath(NamedTuple):
    """The path of a file, relative to the machine file; becomes a path that can be opened."""


class UnitName(NamedTuple):
    """The name of a unit of this kind; becomes the factor pair that turns numbers into its base."""

    kind: str


class Points(NamedTuple):
    """A list of pairs of bare numbers, `[[x, y], …]`; becomes a list of (float, float)."""

    x: str
    y: str
    least: int = 2


class Record(NamedTuple):
    """A mapping that becomes a record; `target` names it as `module:Class`, so that it is imported only when needed."""

    target: str


class Listing(NamedTuple):
    """A list of items of one form, at least one; becomes a tuple."""

    item: Form


class OneOf(NamedTuple):
    """Several forms that differ in shape (text or number, list, mapping); the first of the right shape reads it."""

    forms: tuple[Form, ...]


class Keyed(NamedTuple):
    """A mapping whose single telling key decides what it becomes: `{constant: …}`, `{trace: …}`; else `otherwise`."""

    cases: tuple[tuple[str, Form], ...]
    otherwise: Form


class Limits(NamedTuple):
    """A mapping from ids of key values to bounds, each with the unit of its quantity."""


class Variant(NamedTuple):
    """Keys of the same mapping that depend on the word under `selector`: those of the mechanism, say."""

    selector: str
    default: str
    cases: tuple[tuple[str, Record], ...]


class Inline(NamedTuple):
    """Keys of another record that stand in the same mapping: those of the piston in its cylinder.

    With the key `unless`, a list of such records, they stand in its items instead; rules of the outer record speak of
    the one inline record as the first of that list.
    """

    record: Record
    unless: str = ""


Form = Union[
    Physical,
    Number,
    Count,
    Text,
    Choice,
    FilePath,
    UnitName,
    Points,
    Record,
    Listing,
    OneOf,
    Keyed,
    Limits,
    Variant,
    Inline,
]


class Key(NamedTuple):
    """One key: its form, what it means in one sentence, the textbook symbol, and whether it must stand there.

    `absent` says what holds without it; `commands` names the commands that use it, where not all do; `instead` names
    another key that says the same thing, so that both together are a contradiction.
    """

    form: Form
    text: str
    symbol: str = ""
    required: bool = False
    absent: str = ""
    commands: tuple[str, ...] = ()
    instead: str = ""


Keys = dict[str, Key]


def check_bounds(keys: Keys, **values: float | None) -> None:
    """Raise RuleError for the values, in the base of their kinds, that are out of the bounds of their keys.

    What a machine file gives has been held against them already; this is for records that are made in Python.
    """
    faults = [
        Fault((name,), f"{value:g} {wrong}")
        for name, value in values.items()
        if value is not None and isinstance(form := keys[name].form, (Physical, Number))
        if (wrong := out_of_bounds(value, form))
    ]
    if faults:
        raise RuleError(*faults)


def load(record: Record) -> Any:
    """Import and return the class that a record form names."""
    from importlib import import_module

    module, name = record.target.split(":")
    return getattr(import_module(module), name)
