"""Key values chosen by name: ids, printed symbols, and scoped names such as `LP.T_max` or `machine.dE`."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple, Protocol

from kurbel.declared.forms.figures import MACHINE, scoped
from kurbel.declared.reading import text_in_one_line
from kurbel.errors import UsageError
from kurbel.near_words import did_you_mean
from kurbel.quantities import every_quantity, key_values_of
from kurbel.quantity import Quantity, ambiguity, called, in_sentences

_LONGEST = 4
"""Words of the longest name: the symbol `f N c_max` has three."""


class Owner(Protocol):
    """What may have key values: a cylinder, a pin or bearing, a piston, or the whole machine."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def of(self) -> str:
        """The cylinder that a pin belongs to, or ''."""

    @property
    def whole(self) -> bool:
        """Whether it is the whole machine."""


class ChosenValue(NamedTuple):
    """A key value chosen by name; scope: of what, '' for everything that has it."""

    scope: str
    id: str

    def is_of(self, owner: Owner) -> bool:
        """Return whether the key value of this owner is meant."""
        if not self.scope:
            return True
        return self.scope in (owner.name, owner.of) or (self.scope == MACHINE and owner.whole)


def split_names(
    text: str, is_name: Callable[[str], bool], is_id: Callable[[str], bool]
) -> Iterator[str]:
    """Yield the names in a text, separated by commas or blanks; a name may have commas or blanks itself.

    Words that are ids, as `p_max` and `m`, are those, whatever symbol they might be together.

    >>> list(split_names("T_max, P_b,max c_max", {"P_b,max"}.__contains__, {"T_max", "c_max"}.__contains__))
    ['T_max', 'P_b,max', 'c_max']
    """
    words = list(re.finditer(r"[^,\s]+", text))
    first = 0
    while first < len(words):
        # the longest run of words that is a name; a word that is none is yielded as it is
        last = first
        for end in range(min(first + _LONGEST, len(words)) - 1, first, -1):
            are_ids = all(is_id(word.group()) for word in words[first : end + 1])
            if not are_ids and is_name(text[words[first].start() : words[end].end()]):
                last = end
                break
        yield text[words[first].start() : words[last].end()]
        first = last + 1


def choices_in(text: str, command: str, owners: Sequence[Owner]) -> list[ChosenValue]:
    """Return the key values of a command that a text names, in its order, each once.

    owners: what the command has results of; without any a name has no scope. Raises UsageError for a name that is none,
    and for a scope that is not there.
    """
    # names that are ids of the command's own chapters open no others
    words = re.findall(r"[^,\s]+", text)
    declared = key_values_of(command, [scoped(word)[1] for word in words])
    scopes = _scopes(owners)

    def is_name(name: str) -> bool:
        scope, id = scoped(name)
        return bool(called(name, declared.values())) or (
            scope in scopes and bool(called(id, declared.values()))
        )

    def is_id(name: str) -> bool:
        return name in declared or scoped(name)[1] in declared

    names = split_names(text, is_name, is_id)
    choices = [_choice(name, command, declared, scopes) for name in names]
    if not choices:
        raise UsageError("--key-values names no key value; leave the names out for all of them")
    return list(dict.fromkeys(choices))


def _scopes(owners: Iterable[Owner]) -> list[str]:
    scopes = list[str]()
    for owner in owners:
        scopes += [MACHINE] if owner.whole else [owner.name]
        scopes += [owner.of] if owner.of else []
    return list(dict.fromkeys(scopes))


def _choice(
    name: str, command: str, declared: Mapping[str, Quantity], scopes: Sequence[str]
) -> ChosenValue:
    """Return the key value that a name means; raises UsageError where it means none, or several."""
    scope, id = "", name
    if not called(name, declared.values()) and "." in name:
        scope, id = scoped(name)
    ids = called(id, declared.values())
    if not ids:
        raise UsageError(f"--key-values: {_unknown(name, id, command, declared)}")
    if wrong := ambiguity(id, ids):
        raise UsageError(f"--key-values: {wrong}")
    if scope and not scopes:
        raise UsageError(
            f"--key-values: {text_in_one_line(name)}: every part has a table of its own here; write {ids[0]}"
        )
    if scope and scope not in scopes:
        near = did_you_mean(scope, tuple(scopes))
        raise UsageError(
            f"--key-values: {text_in_one_line(name)}: kurbel {command} has no "
            f"'{text_in_one_line(scope)}'{near} (it has {', '.join(scopes)})"
        )
    return ChosenValue(scope, ids[0])


def _unknown(name: str, id: str, command: str, declared: Mapping[str, Quantity]) -> str:
    """Return the message for a name that is no key value of a command: who has it, or what it may be."""
    quantities = every_quantity()
    shown_name = text_in_one_line(name)
    elsewhere = called(id, quantities.all_key_values)
    if elsewhere:
        words = quantities.commands_of(elsewhere[0])
        commands = " and ".join(f"kurbel {word}" for word in words)
        return f"'{shown_name}' is no key value of kurbel {command}; it is one of {commands}"
    columns = called(id, quantities.columns(command).values())
    if columns:
        return f"'{shown_name}' is a column and no key value; --columns {columns[0]} prints it"
    names = list[str]()
    for quantity in declared.values():
        names += (quantity.id, quantity.symbol)
    near = in_sentences(id, declared.values()) or did_you_mean(id, tuple(names))
    return f"'{shown_name}' is no key value of kurbel {command}{near}"
