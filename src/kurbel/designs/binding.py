"""From a machine file and the texts of some of its keys to a machine: only the records that hang on them are made anew.

Every record that is made anew keeps its rules as when it is read; what a row breaks is told as `--set` would tell it.
"""

from collections.abc import Sequence
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np

from kurbel.declared.keys import Form
from kurbel.declared.numerals import NUMBER
from kurbel.declared.reading import REFUSED, Birth, Plain, Reading, StopReading, Tree, shown
from kurbel.errors import Fault, Path, RuleError, Step, UsageError, path_text
from kurbel.machine import Machine
from kurbel.machine.origin import Origin
from kurbel.machine.variants import Lot, joined, one_kind, sort_of
from kurbel.machine_file.given import leaves, tree_of
from kurbel.machine_file.overrides import by_numbers, dotted, path_of
from kurbel.machine_file.reader import read_machine, reading_of
from kurbel.near_words import did_you_mean
from kurbel.numerics.varied import Parted

_Part = dict[int, tuple[Any, ...]]
"""Rows, each with the values of its slots."""


class Unbound(Exception):
    """The texts of a row make no machine; the message tells why."""


class Bound(NamedTuple):
    """What rows of texts make, counted from 0: machines, those of one kind in one record, or the reason why none."""

    lots: list[Lot]
    failures: dict[int, str]


class _Slot(NamedTuple):
    """A value of a record that is read anew: under which of its keys, and which varied keys stand there, and where."""

    birth: Birth
    name: str
    varied: list[tuple[int, Path]]

    def column(self, rows: Sequence[Sequence[str]], folder: str) -> list[Any]:
        """Return what the record gets in these rows of texts; Unbound, unraised, where it gets nothing."""
        texts = [tuple([row[number] for number, _ in self.varied]) for row in rows]
        different = list(dict.fromkeys(texts))
        known = dict(zip(different, self._numbers(different) or [self._read(one, folder) for one in different]))
        return [known[one] for one in texts]

    @property
    def _form(self) -> Form:
        return self.birth.form.keys[self.name].form  # type: ignore[no-any-return]

    def _numbers(self, texts: Sequence[tuple[str, ...]]) -> Sequence[Any] | None:
        """Return what texts become if one varied key is all that stands here, and all are plain numbers."""
        single = len(self.varied) == 1 and not self.varied[0][1]
        return self._form.numbers([text for (text,) in texts]) if single else None

    def _read(self, texts: Sequence[str], folder: str) -> Any:
        """Return what the record gets for texts of its varied keys, or Unbound."""
        tree = self.birth.mapping[self.name]
        reading = Reading(folder)
        try:
            for (_, inner), text in zip(self.varied, texts):
                tree = _with(tree, inner, Plain(text)) if inner else Plain(text)
        except Unbound as error:
            return error
        value = self._form.read(reading, tree, (self.name,))
        if value is REFUSED or reading.faults:
            return Unbound(_told([fault.below(self.birth.path) for fault in reading.faults]))
        return value


class _Step(NamedTuple):
    """A record that is made anew: which slots are its own, each with its key, and the keys of such records in it."""

    birth: Birth
    own: list[tuple[int, str]]
    inner: list[str]


class Binder:
    """Makes machines of a file from the texts of these keys, in their order.

    start: texts that make a machine, from which the others differ. Raises UsageError for a key that is none.
    """

    def __init__(self, origin: Origin, keys: Sequence[str], start: Sequence[str]) -> None:
        self._reading = reading_of(origin)
        births: list[Birth] = []
        self._reading.births = births
        begun = origin._replace(varied=tuple(f"{key}={text}" for key, text in zip(keys, start)))
        self.machine = read_machine(begun, self._reading)
        self.kinds: list[str] = []
        """Of the numbers that stand under the keys, '' of words."""
        self._slots: dict[tuple[int, str], _Slot] = {}
        for number, key in enumerate(keys):
            self._place(number, path_of(key), births)
        self._steps = self._planned(births)

    def _place(self, number: int, path: Path, births: list[Birth]) -> None:
        """Note in which slots a key stands: that of its record, and those of what is `like` that."""
        owner, name = _owner(path, births)
        inner = path[len(owner.path) + 1 :]
        bare = inner and NUMBER.fullmatch(_at(owner.mapping.get(name), inner) or "")  # the number of a point, say
        self.kinds.append(owner.form.keys[name].form.kind or ("ratio" if bare else ""))
        for birth in births:
            if _reads(birth, name) and birth.mapping.get(name) is owner.mapping.get(name):
                slot = self._slots.setdefault((id(birth), name), _Slot(birth, name, []))
                slot.varied.append((number, inner))

    def _planned(self, births: list[Birth]) -> list[_Step]:
        steps: list[_Step] = []
        anew: set[int] = set()
        for birth in births:
            own = [(number, slot.name) for number, slot in enumerate(self._slots.values()) if slot.birth is birth]
            inner = [key for key, value in birth.values.items() if anew.intersection(map(id, _parts(value)))]
            if own or inner:
                anew.add(id(birth.born))
                steps.append(_Step(birth, own, inner))
        return steps

    def bound(self, rows: Sequence[Sequence[str]]) -> Bound:
        """Return the machines of rows of texts, those of one kind in one record, and why the other rows make none."""
        found = Bound([], {})
        columns = [slot.column(rows, self._reading.folder) for slot in self._slots.values()]
        read: _Part = {}
        for row, values in enumerate(zip(*columns)):
            if failed := next((one for one in values if isinstance(one, Unbound)), None):
                found.failures[row] = str(failed)
            else:
                read[row] = values
        waiting = _of_one_sort(read)
        with np.errstate(all="ignore"):  # as floats do; what is beyond them is refused
            while waiting:
                waiting += self._bind(waiting.pop(), found)
        return found

    def _bind(self, part: _Part, found: Bound) -> list[_Part]:
        """Make the machines of these rows at once; return the parts that can only be made by themselves.

        These are the rows for which a rule holds, and those for which it does not; and each row where a rule is broken,
        to tell why, or is written for floats alone, and asks for what `Varied` has not.
        """
        try:
            machine = self._made(joined(list(part.values())))
            one_kind(machine)
        except Parted as parted:
            sides = parted.holds, ~parted.holds
            return [{row: part[row] for row, own in zip(part, side.tolist()) if own} for side in sides]
        except (Unbound, TypeError, AttributeError) as error:
            if len(part) > 1:
                return [{row: values} for row, values in part.items()]
            if not isinstance(error, Unbound):
                raise
            found.failures.update(dict.fromkeys(part, str(error)))
        else:
            found.lots.append(Lot(machine, list(part)))
        return []

    def _made(self, given: Sequence[Any]) -> Machine:
        """Return the machine with these values in the slots; raises Unbound with all that is wrong."""
        anew: dict[int, Any] = {}
        reading = Reading()
        reading.alike = self._reading.alike
        with suppress(StopReading):
            for step in self._steps:
                anew[id(step.birth.born)] = _born(step, given, anew, reading)
        if reading.faults:
            raise Unbound(_told(reading.faults))
        machine: Machine = anew[id(self._steps[-1].birth.born)] if self._steps else self.machine
        return machine


def _born(step: _Step, given: Sequence[Any], anew: dict[int, Any], reading: Reading) -> Any:
    """Return the record of a step, or REFUSED after noting its faults; anew: what came of records of earlier steps."""
    birth = step.birth
    values = birth.values | {name: given[number] for number, name in step.own}
    for key in step.inner:
        parts = [anew.get(id(part), part) for part in _parts(values[key])]
        if any(part is REFUSED for part in parts):
            return REFUSED
        values[key] = tuple(parts) if isinstance(values[key], tuple) else parts[0]
    try:
        return birth.form.born(values)
    except RuleError as error:
        return reading.refuse(birth.path, birth.form.flattened(error, birth.mapping))


def _of_one_sort(read: _Part) -> list[_Part]:
    """Return the rows with their values in parts that differ in numbers only."""
    parts: dict[Any, _Part] = {}
    for row, values in read.items():
        parts.setdefault(sort_of(values), {})[row] = values
    return list(parts.values())


def written_texts(origin: Origin, keys: Sequence[str]) -> list[str]:
    """Return what a file has under these dotted keys; raises UsageError for a key under which no value stands."""
    tree, texts = tree_of(origin), []
    for key in keys:
        try:
            texts.append(written(tree, key))
        except UsageError as error:
            raise UsageError(f"{shown(key)}: {error}") from None
    return texts


def written(tree: Tree, key: str) -> str:
    """Return what stands under a dotted key; raises UsageError where no value does."""
    text = _at(tree, path_of(key))
    if text is None:
        raise UsageError(f"no value stands under this key in the file{_meant(tree, key)}")
    return text


def _at(tree: Any, path: Path) -> str | None:
    """Return the text at a path in a tree; None where there is none."""
    try:
        for step in path:
            tree = tree[step]
    except (KeyError, IndexError, TypeError):
        return None
    return tree if isinstance(tree, str) else None


def _meant(tree: Tree, key: str) -> str:
    """Return which key with a value was probably meant by one without, or an empty text."""
    paths = [path for path, value in leaves(tree) if isinstance(value, str) and path[0] != "uncertainty"]
    for path in paths:
        names = ".".join(step for step in path if isinstance(step, str))
        if f".{names}".endswith(f".{key}"):
            return f"; did you mean '{dotted(path)}'?"
    return did_you_mean(by_numbers(tree, key), tuple(map(dotted, paths)))


def _owner(path: Path, births: list[Birth]) -> tuple[Birth, str]:
    """Return the record that reads a key itself, the innermost one, and the name of its own key on the way there."""
    fitting = [
        birth
        for birth in births
        if len(birth.path) < len(path)
        and birth.path == path[: len(birth.path)]
        and _reads(birth, path[len(birth.path)])
    ]
    if not fitting:
        raise UsageError(f"--vary {path_text(path)}: no value stands under this key that could be varied")
    birth = max(fitting, key=lambda one: len(one.path))
    return birth, str(path[len(birth.path)])


def _reads(birth: Birth, name: Step) -> bool:
    """Return whether a record reads the value of a key itself."""
    return name in birth.values and name in birth.form.keys


def _parts(value: Any) -> tuple[Any, ...]:
    """Return the items of a list, as what it was read into, or the value itself."""
    return value if isinstance(value, tuple) else (value,)


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


def _told(faults: Sequence[Fault]) -> str:
    texts = (f"{path_text(one.path)}: {one.message}" if one.path else one.message for one in faults)
    return "; ".join(dict.fromkeys(texts))  # equal cylinders have one fault in common
