"""How a record of the machine file declares its entries: one `field` or `alternative` each, and rules.

The class `Record` itself is in `keys`, since the forms of entries need it.

A record has `rules`, conditions on its values, and `rules_of_keys`, conditions on the keys of the file, checked before
the record is made; a sweep evaluates both with arrays. Which keys contradict or require one another follows from
`instead` and `needs` (`contradictions`).
"""

import dataclasses
from collections.abc import Iterable, Iterator
from dataclasses import MISSING
from typing import Any

import numpy as np

from kurbel.arrays import Truth
from kurbel.declared.forms.structures import Likeness, form_of
from kurbel.declared.keys import Key, Record, Rule, ValuesByKey

__all__ = ["FieldValue", "Record", "Rule", "ValuesByKey", "alternative", "field", "first_of"]


FieldValue = Any
"""What `field` returns: to a type checker, a value of whatever type its attribute is said to have."""


def first_of(rules: Iterable[Rule]) -> Iterator[Rule]:
    """Yield rules so that only the first broken one counts."""
    is_broken_before: Truth = False
    for rule in rules:
        yield rule._replace(broken=rule.broken & np.logical_not(is_broken_before))
        is_broken_before = is_broken_before | rule.broken


def field(
    form: Likeness,
    text: str,
    symbol: str = "",
    *,
    default: object = MISSING,
    absent: str = "",
    **more: Any,
) -> FieldValue:
    """Declare an attribute of a record that is an entry of the machine file.

    form: see `form_of`; text: its meaning in one sentence; symbol: of the textbooks; default: its value if the file has
    none; without one it is None where the annotation allows that, else the entry is required; absent: what holds then,
    if not what the default says; key: its name in the file, if not that of the attribute; more: of `Key` and `form_of`.

    >>> class Ring(Record):
    ...     height: float = field("length", "Height of the ring", "h", above=0)
    >>> Ring(height=-0.1)
    Traceback (most recent call last):
    kurbel.errors.RuleError: height: -0.1 is too small; it must be more than 0
    """
    if not absent:
        absent = _default_text(default)
    declared = alternative(form, text, symbol, absent=absent, **more)
    return dataclasses.field(default=default, metadata={"key": declared})


def _default_text(default: object) -> str:
    """Return what holds without an entry of this default, for pages; '' where only its sentence can say it."""
    if isinstance(default, float):
        return f"{default:g}"
    if isinstance(default, int):  # a truth, too
        return str(default).lower()
    return "none" if default == () else ""


def alternative(form: Likeness, text: str, symbol: str = "", *, key: str = "", **more: Any) -> Key:
    """Declare an entry that is no attribute: `gives` takes all values by key and returns the attributes it determines.

    key: its name in the file, '' for that of the attribute, until the class of the record is made; more: of `Key`, and
    bounds of `form_of`.
    """
    key_options = {name: more.pop(name) for name in Key._fields if name in more}
    return Key(form_of(form, more), text, symbol, attribute=key, **key_options)
