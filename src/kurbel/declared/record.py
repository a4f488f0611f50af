"""How a record of the machine file says its entries: one `field` or `alternative` each, and rules beside them.

A record says `rules`, conditions on its values, and `rules_of_keys`, conditions on what the file has, before there is a
record. `faults` and `faults_of_keys` are those that one machine breaks; a sweep asks the rules themselves, with arrays.
Which keys contradict or lack one another follows from `instead` and `needs`: the reader asks that of every file, and a
record that is also made in Python yields its `contradictions` among its rules.
"""

import dataclasses
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from kurbel.declared.forms import Choice, Count, Listing, Number, Physical, Text, Truth
from kurbel.declared.forms import Record as RecordForm
from kurbel.declared.keys import Described as Record
from kurbel.declared.keys import Form, Key, Rule

__all__ = ["Record", "Rule", "alternative", "entry", "field", "first_of"]


def first_of(rules: Iterator[Rule]) -> Iterator[Rule]:
    """Yield rules of which only the first that is broken counts."""
    before: Any = False
    for rule in rules:
        yield rule._replace(broken=rule.broken & np.logical_not(before))
        before = before | rule.broken


def field(form: Any, text: str, symbol: str = "", *, default: Any = ..., key: str = "", **more: Any) -> Any:
    """Declare an attribute of a record that is an entry of the machine file.

    form: see `form_of`; text: what it means, in one sentence; symbol: of the textbooks; default: its value where the
    file has none, None unless it is required; key: its name in the file, if not that of the attribute; more: of `Key`
    and `form_of`.

    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True, eq=False, repr=False)
    ... class Ring(Record):
    ...     height: float = field("length", "Height of the ring", "h", above=0, required=True)
    >>> Ring(height=-0.1)
    Traceback (most recent call last):
    kurbel.errors.RuleError: height: -0.1 is too small; it must be more than 0
    """
    declared = entry(form, text, symbol, attribute=key, **more)
    if default is not ...:
        return dataclasses.field(default=default, metadata={"key": declared})
    if declared.required:
        return dataclasses.field(metadata={"key": declared})
    return dataclasses.field(default=None, metadata={"key": declared})


def alternative(
    form: Any,
    text: str,
    symbol: str = "",
    *,
    gives: Callable[[Mapping[str, Any]], dict[str, Any]] | None = None,
    key: str = "",
    **more: Any,
) -> Any:
    """Declare an entry that is no attribute: `gives` returns those that follow from it, from all values by key."""
    return entry(form, text, symbol, gives=gives, attribute=key, **more)


def entry(
    form: Any,
    text: str,
    symbol: str = "",
    *,
    required: bool = False,
    absent: str = "",
    instead: str = "",
    needs: str = "",
    example: str = "",
    also: tuple[str, ...] = (),
    attribute: str = "",
    gives: Callable[[Mapping[str, Any]], dict[str, Any]] | None = None,
    **bounds: Any,
) -> Key:
    """Return the declaration of an entry; see `Key` and `form_of`.

    attribute: the key that it has in the file, '' for the name of the attribute, until the class of the record is made.
    """
    formed = form_of(form, bounds)
    return Key(formed, text, symbol, required, absent, instead, needs, example, also, attribute, gives)


def form_of(form: Any, bounds: Mapping[str, Any] = {}) -> Form:
    """Return what may stand under a key: a kind of quantity with its bounds, a type, words, a record, a list of one.

    bounds: `above`, `least`, `below`, `most` in SI, and `words` that stand for numbers.
    """
    if isinstance(form, str):
        return Number(**bounds) if form == "ratio" else Physical(form, **bounds)
    if isinstance(form, tuple):
        return Choice(form)
    if isinstance(form, list):
        return Listing(form_of(form[0], bounds))
    if form is int:
        return Count(**bounds)
    if form is bool:
        return Truth()
    if form is str:
        return Text()
    return RecordForm(form) if isinstance(form, type) else form
