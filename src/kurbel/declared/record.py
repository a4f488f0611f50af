"""How a record of the machine file declares its entries: one `field` or `alternative` each, and rules.

A record has `rules`, conditions on its values, and `rules_of_keys`, conditions on the keys of the file, checked before
the record is made. `faults` and `faults_of_keys` return the rules that one machine breaks; a sweep evaluates the rules
with arrays. Which keys contradict or require one another follows from `instead` and `needs` (`contradictions`).
"""

import dataclasses
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from kurbel.declared.forms.structures import form_of
from kurbel.declared.keys import Key, Record, Rule, Values

__all__ = ["Record", "Rule", "Values", "alternative", "field", "first_of", "record"]

if TYPE_CHECKING:
    from typing_extensions import dataclass_transform
else:  # typing has it from Python 3.11 on

    def dataclass_transform(**_):
        """Return a decorator that changes nothing."""
        return lambda made: made


Made = TypeVar("Made")


@dataclass_transform(frozen_default=True, eq_default=False)
def record(made: type[Made]) -> type[Made]:
    """Make a class of entries a record: frozen, compared by identity, and shown without its defaults."""
    return dataclasses.dataclass(frozen=True, eq=False, repr=False)(made)


def first_of(rules: Iterator[Rule]) -> Iterator[Rule]:
    """Yield rules so that only the first broken one counts."""
    before: Any = False
    for rule in rules:
        yield rule._replace(broken=rule.broken & np.logical_not(before))
        before = before | rule.broken


def field(form: Any, text: str, symbol: str = "", *, default: Any = ..., **more: Any) -> Any:
    """Declare an attribute of a record that is an entry of the machine file.

    form: see `form_of`; text: its meaning in one sentence; symbol: of the textbooks; default: its value if the file has
    none, None unless it is required; key: its name in the file, if not that of the attribute; more: of `Key`
    and `form_of`.

    >>> @record
    ... class Ring(Record):
    ...     height: float = field("length", "Height of the ring", "h", above=0, required=True)
    >>> Ring(height=-0.1)
    Traceback (most recent call last):
    kurbel.errors.RuleError: height: -0.1 is too small; it must be more than 0
    """
    declared = alternative(form, text, symbol, **more)
    if default is ... and declared.required:
        return dataclasses.field(metadata={"key": declared})
    return dataclasses.field(default=None if default is ... else default, metadata={"key": declared})


def alternative(form: Any, text: str, symbol: str = "", *, key: str = "", **more: Any) -> Key:
    """Declare an entry that is no attribute: `gives` takes all values by key and returns the attributes it determines.

    key: its name in the file, '' for that of the attribute, until the class of the record is made; more: of `Key`, and
    bounds of `form_of`.
    """
    of_key = {name: more.pop(name) for name in Key._fields if name in more}
    return Key(form_of(form, more), text, symbol, attribute=key, **of_key)
