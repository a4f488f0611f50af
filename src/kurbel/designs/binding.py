"""From a machine file and the texts of some of its keys to a machine: only the records that hang on them are made anew.

Every record that is made anew keeps its rules as when it is read; what a row breaks is told as `--set` would tell it.
"""

import re
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from kurbel.declared.keys import Form
from kurbel.declared.reading import REFUSED, Birth, Plain, Reading, Tree, shown
from kurbel.errors import Fault, MachineFileError, Path, RuleError, UsageError, path_text
from kurbel.machine import Machine
from kurbel.machine_file.events import parse
from kurbel.machine_file.overrides import by_numbers, overridden, read_override
from kurbel.machine_file.reader import read_machine
from kurbel.machine_file.source import Source
from kurbel.near_words import did_you_mean

_MOST_KNOWN = 10_000
"""Values of keys that are kept beside their texts."""


class Unbound(Exception):
    """The texts of a row make no machine; the message tells why."""


class _Link(NamedTuple):
    """Where the record of an earlier step stands in the values of a later one: key, and place in a tuple, or None."""

    key: str
    place: int | None
    step: int


class _Step(NamedTuple):
    """A record that is made anew: which of the varied keys it reads itself, and which records of earlier steps."""

    birth: Birth
    own: list[tuple[int, str, Path]]
    links: list[_Link]


class Binder:
    """Makes machines of a file from the texts of these keys, in their order.

    start: texts that make a machine, from which the others differ. Raises UsageError for a key that is none.
    """

    def __init__(self, source: Source, overrides: Sequence[str], keys: Sequence[str], start: Sequence[str]) -> None:
        self._source, self._overrides, self.keys = source, tuple(overrides), tuple(keys)
        births: list[Birth] = []
        self.machine = read_machine(source, self._set(start), births)
        self._paths = [read_override(f"{key}=0").path for key in keys]
        self._places = [_owner(path, births) for path in self._paths]
        self._steps = self._planned(births)
        self._known: dict[tuple[int, str], Any] = {}
        # a cylinder that is `like` another one takes over what that one has: who has what is told by reading alone
        self._whole = re.search(r"\blike\b", source.text) is not None

    def _set(self, texts: Sequence[str]) -> tuple[str, ...]:
        return (*self._overrides, *(f"{key}={text}" for key, text in zip(self.keys, texts)))

    def form(self, number: int) -> Form:
        """Return what stands under a key."""
        birth, name = self._places[number]
        form: Form = birth.form.keys[name].form
        return form

    def _planned(self, births: list[Birth]) -> list[_Step]:
        steps: list[_Step] = []
        made: dict[int, int] = {}
        for birth in births:
            own = [
                (number, name, self._paths[number][len(birth.path) + 1 :])
                for number, (owner, name) in enumerate(self._places)
                if owner is birth
            ]
            links = [link for key, value in birth.values.items() for link in _links(key, value, made)]
            if own or links:
                made[id(birth.born)] = len(steps)
                steps.append(_Step(birth, own, links))
        return steps

    def bound(self, texts: Sequence[str]) -> Machine:
        """Return the machine of these texts; raises Unbound."""
        if self._whole:
            return self.read_whole(texts)
        found: list[Any] = []
        for step in self._steps:
            birth = step.birth
            values = dict(birth.values)
            for number, name, inner in step.own:
                values[name] = self._value(number, name, inner, texts[number])
            for key, place, earlier in step.links:
                values[key] = _replaced(values[key], place, found[earlier])
            try:
                found.append(birth.form.born(values))
            except RuleError as error:
                raise Unbound(_told(birth.form.flattened(error, birth.mapping).faults, birth.path)) from None
        return found[-1] if found else self.machine

    def _value(self, number: int, name: str, inner: Path, text: str) -> Any:
        """Return what the record that reads a key gets for its text; texts that come again are read once."""
        if (number, text) not in self._known:
            if len(self._known) >= _MOST_KNOWN:
                self._known.clear()
            self._known[number, text] = self._read(self._places[number][0], name, inner, text)
        return self._known[number, text]

    def _read(self, birth: Birth, name: str, inner: Path, text: str) -> Any:
        reading = Reading(self._source.folder)
        tree = Plain(text) if not inner else _with(birth.mapping[name], inner, Plain(text))
        value = birth.form.keys[name].form.read(reading, tree, (name,))
        if value is REFUSED or reading.faults:
            raise Unbound(_told(reading.faults, birth.path))
        return value

    def read_whole(self, texts: Sequence[str]) -> Machine:
        """Return the machine of these texts by reading the whole file anew; raises Unbound."""
        try:
            return read_machine(self._source, self._set(texts))
        except MachineFileError as error:
            raise Unbound(_told(error.faults, ())) from None


def written_texts(source: Source, overrides: Sequence[str], keys: Sequence[str]) -> list[str]:
    """Return what a file has under these dotted keys; raises UsageError for a key under which no value stands."""
    tree = tree_of(source, overrides)
    return [_named(tree, key) for key in keys]


def _named(tree: Tree, key: str) -> str:
    try:
        return written(tree, key)
    except UsageError as error:
        raise UsageError(f"{shown(key)}: {error}") from None


def tree_of(source: Source, overrides: Sequence[str]) -> Tree:
    """Return a file as mappings, lists and texts, with what is set over it."""
    tree: Tree = parse(source.text, Reading(source.folder))
    overridden(tree, [read_override(one) for one in overrides])
    return tree


def written(tree: Tree, key: str) -> str:
    """Return what stands under a dotted key; raises UsageError where no value does."""
    node: Any = tree
    try:
        for step in read_override(f"{key}=0").path:
            node = node[step]
    except (KeyError, IndexError, TypeError):
        node = None
    if not isinstance(node, str):
        raise UsageError(f"no value stands under this key in the file{_meant(tree, key)}")
    return node


def _meant(tree: Tree, key: str) -> str:
    """Return which key with a value was probably meant by one without, or an empty text."""
    known = tuple(one for one in _keys_with_value(tree) if not one.startswith("uncertainty."))
    ending = next((f"; did you mean '{one}'?" for one in known if one.endswith(f".{key}")), "")
    return ending or did_you_mean(by_numbers(tree, key), known)


def _keys_with_value(tree: Tree, below: str = "") -> Iterator[str]:
    """Yield the dotted keys under which a value stands, but for those of points."""
    for step, node in tree.items():
        if isinstance(node, str):
            yield f"{below}{step}"
        elif isinstance(node, dict):
            yield from _keys_with_value(node, f"{below}{step}.")
        else:
            records = {str(place): one for place, one in enumerate(node) if isinstance(one, dict)}
            yield from _keys_with_value(records, f"{below}{step}.")


def _owner(path: Path, births: list[Birth]) -> tuple[Birth, str]:
    """Return the record that reads a key itself, the innermost one, and the name of its own key on the way there."""
    fitting = [
        birth
        for birth in births
        if len(birth.path) < len(path)
        and birth.path == path[: len(birth.path)]
        and path[len(birth.path)] in birth.values
        and path[len(birth.path)] in birth.form.keys
    ]
    if not fitting:
        raise UsageError(f"--vary {path_text(path)}: no value stands under this key that could be varied")
    birth = max(fitting, key=lambda one: len(one.path))
    return birth, str(path[len(birth.path)])


def _links(key: str, value: Any, made: dict[int, int]) -> list[_Link]:
    if id(value) in made:
        return [_Link(key, None, made[id(value)])]
    items = value if isinstance(value, tuple) else ()
    return [_Link(key, place, made[id(item)]) for place, item in enumerate(items) if id(item) in made]


def _replaced(value: Any, place: int | None, new: Any) -> Any:
    return new if place is None else (*value[:place], new, *value[place + 1 :])


def _with(tree: Any, path: Path, value: Any) -> Any:
    """Return a tree of a machine file with another value at a path in it."""
    step, rest = path[0], path[1:]
    try:
        new = _with(tree[step], rest, value) if rest else value
        if isinstance(tree, dict):
            return {**tree, step: new}
        return [*tree[:step], new, *tree[step + 1 :]]  # type: ignore[operator]
    except (TypeError, KeyError, IndexError):
        raise Unbound(f"{path_text(path)}: no value stands there") from None


def _told(faults: Sequence[Fault], path: Path) -> str:
    whole = [fault.below(path) for fault in faults]
    return "; ".join(f"{path_text(one.path)}: {one.message}" if one.path else one.message for one in whole)
