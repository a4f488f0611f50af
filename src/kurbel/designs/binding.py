"""Many machines from one machine file and values of some of its keys; machines of one structure are one record.

Rows that differ only in numbers are read once, with arrays (machines,) instead of numbers; the rules of records hold
for arrays, too. Words, counts and points of cards are structure: rows that differ in these are read one by one, and so
is each row that breaks a rule, for its message.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices, Indivisible
from kurbel.declared.forms.structures import Given, Maker
from kurbel.declared.forms.values import NumberForm
from kurbel.declared.numerals import NUMBER
from kurbel.declared.reading import Plain, Reading, StopReading, Tree, shown
from kurbel.errors import KurbelError, MachineFileError, Path, UsageError, path_text
from kurbel.machine import Machine
from kurbel.machine.batch import changed
from kurbel.machine.origin import Origin
from kurbel.machine_file.events import parse
from kurbel.machine_file.overrides import dotted, leaves, path_of, set_over, tree_of, value_at
from kurbel.machine_file.reader import read_tree, read_values, reading_of
from kurbel.near_words import did_you_mean


class Batch(NamedTuple):
    """Machines of the same structure as one record, with arrays (machines,) of numbers that differ; rows: of each."""

    machine: Machine
    rows: Sequence[int]

    def one(self, place: int) -> Machine:
        """Return a single machine, counted from 0."""
        return changed(self.machine, lambda numbers: numbers[place].item())


class Batches(NamedTuple):
    """The machines of rows, in batches, and the reasons why other rows have none; rows are counted from 0."""

    batches: list[Batch]
    failures: dict[int, str]


class Binder:
    """Makes machines of a file from values of these keys, in their order.

    start: texts that make a valid machine; cases: the first of the keys is the load case.
    Raises UsageError for an unknown key.
    """

    def __init__(self, origin: Origin, keys: Sequence[str], start: Sequence[str], cases: bool = False) -> None:
        self._origin, self._keys, self._start, self._cases = origin, keys, start, cases
        root = read_values(self._with(start), reading_of(origin))
        self.machine: Machine = root.made
        self.kinds: list[str] = [""] * cases
        """The kind of number of each key, '' for words."""
        self._numeric = [False] * cases
        every = list(_every(root))
        for key in keys[cases:]:
            owner, name, inner = _owner(path_of(key), every)
            form = owner.form.keys[name].form
            text = value_at(owner.mapping.get(name), inner)
            bare = inner and isinstance(text, str) and NUMBER.fullmatch(text)  # the number of a point, say
            self.kinds.append(form.kind_as_written(owner.mapping.get(name)) or ("ratio" if bare else ""))
            self._numeric.append(not inner and form.number is not None and not isinstance(owner.made, Indivisible))

    def bound(self, rows: Sequence[Sequence[str]]) -> Batches:
        """Return the machines of rows of texts, in batches, and why other rows have none."""
        found = Batches([], {})
        groups: dict[tuple[str, ...], list[int]] = {}
        for place, row in enumerate(rows):
            words = tuple(text for text, number in zip(row, self._numeric) if not number)
            groups.setdefault(words, []).append(place)
        for places in groups.values():
            apart = places
            if len(places) > 1:
                batches, apart = self._together(np.array(places), rows)
                found.batches.extend(batches)
            for place in apart:
                self._bind_alone(place, rows[place], found)
        return found

    def _with(self, texts: Sequence[str]) -> Origin:
        """Return the file with these texts under the keys."""
        given = tuple(f"{key}={text}" for key, text in zip(self._keys, texts))
        case = texts[0] if self._cases else self._origin.case
        return self._origin._replace(case=case, varied=given[self._cases :])

    def _bind_alone(self, row: int, texts: Sequence[str], found: Batches) -> None:
        """Add the machine of one row, or the reason why there is none."""
        reading = reading_of(self._origin)
        try:
            machine = read_values(self._with(texts), reading).made
        except UsageError as error:
            found.failures[row] = str(error)
        except MachineFileError:
            faults = (f"{path_text(one.path)}: {one.message}" if one.path else one.message for one in reading.faults)
            found.failures[row] = "; ".join(dict.fromkeys(faults))  # identical cylinders have the same fault
        else:
            found.batches.append(Batch(machine, [row]))

    def _together(self, places: Indices, rows: Sequence[Sequence[str]]) -> tuple[list[Batch], list[int]]:
        """Return the machines of rows with the same words, and the rows that must be read one by one."""
        words = rows[places[0]]
        origin = self._with([one if number else word for one, number, word in zip(self._start, self._numeric, words)])
        columns = {
            key: [rows[place][column] for place in places]
            for column, key in enumerate(self._keys)
            if self._numeric[column]
        }
        reading = reading_of(origin)
        try:
            tree = parse(origin.text, reading)
            set_over(tree, origin)
            every = list(_every(read_tree(tree, origin, reading)))
            read = _put(columns, every, len(places))
            maker = Maker(reading, int(read.sum()))
            with np.errstate(all="ignore"):
                machine = maker.made(every[-1])
            if reading.faults or not read.any():
                return [], places.tolist()
        # a formula works for a single machine only
        except (KurbelError, StopReading, TypeError, ValueError, AttributeError, ArithmeticError, IndexError):
            return [], places.tolist()
        batches = []
        for fit in _structures(machine, np.flatnonzero(~maker.broken)):
            # a value that all machines have in common becomes a number
            batch = changed(machine, lambda numbers, fit=fit: _column(numbers[fit]))  # type: ignore[misc]
            batches.append(Batch(batch, places[read][fit].tolist()))
        return batches, [*places[~read].tolist(), *places[read][maker.broken].tolist()]


def _put(columns: Mapping[str, Sequence[str]], every: Sequence[Given], count: int) -> Flags:
    """Put arrays in place of numbers, of the rows that have all of them; return which rows these are.

    columns: texts (count,) by dotted key. A cylinder that is `like` the one of a key gets its numbers, too. Raises
    UsageError for a key whose value is not a number.
    """
    slots: list[tuple[Given, str, NumberForm, Array]] = []
    read = np.ones(count, dtype=bool)
    for key, texts in columns.items():
        owner, name, _ = _owner(path_of(key), every)
        form = owner.form.keys[name].form
        if form.number is None:
            raise UsageError(f"{key}: no number")
        plain = form.number.numbers(texts)
        if plain is None:  # one by one, nan for a text that is no number
            known = {text: form.read(Reading(), Plain(text), ()) for text in dict.fromkeys(texts)}
            plain = [one if isinstance(one := known[text], float) else np.nan for text in texts]
        alike = [one for one in every if _reads(one, name) and one.mapping.get(name) is owner.mapping.get(name)]
        slots += [(one, name, form.number, np.array(plain)) for one in alike]
        read &= ~np.isnan(plain)
    for one, name, number, numbers in slots:
        one.values[name] = number.of_numbers(numbers[read])
    return read


def _structures(machine: Machine, fit: Indices) -> Iterator[Indices]:
    """Yield places, among those that fit, of machines that take the same branches in the solver.

    The same numbers are 0 or infinite in them, and the same throws share their crank angle, their stroke line and their
    axial position.
    """
    codes: list[Array] = []

    def coded(numbers: Array) -> Array:
        codes.append((numbers == 0) + 2.0 * np.isinf(numbers))
        return numbers

    changed(machine, coded)
    for one, other in combinations(machine.cylinders, 2):
        places = [0.0 if each.axial_position is None else each.axial_position for each in (one, other)]
        turned = one.bank_angle - other.bank_angle
        for apart in map(np.abs, (one.crank_position - other.crank_position - turned, turned, places[0] - places[1])):
            if np.ndim(apart):
                codes.append(np.minimum(apart, np.abs(apart - 360.0)) < 1e-9)
    if not codes:
        yield from (fit,) if len(fit) else ()
        return
    kinds = np.unique(np.stack(codes)[:, fit], axis=1, return_inverse=True)[1].ravel()
    for kind in range(kinds.max(initial=-1) + 1):
        yield fit[kinds == kind]


def _column(values: Array) -> Array | list[object]:
    """Return an array of many machines, or the number if all have the same."""
    bits = values.view(np.int64)  # 0 and −0 are different
    return values if (bits != bits[0]).any() else values[0].item()


# the place of a key


def _every(value: object) -> Iterator[Given]:
    """Yield every mapping as read, inner ones first."""
    if isinstance(value, Given):
        for one in value.values.values():
            yield from _every(one)
        yield value
    elif isinstance(value, tuple):
        for one in value:
            yield from _every(one)


def _reads(given: Given, name: object) -> bool:
    """Return whether a key is one of the record itself, and given."""
    return name in given.values and name in given.form.keys


def _owner(path: Path, every: Sequence[Given]) -> tuple[Given, str, Path]:
    """Return what reads a key itself, the innermost one, the name of its own key on the way, and what follows it."""
    owner = None
    for one in every:
        depth = len(one.path)
        if one.path == path[:depth] and depth < len(path) and _reads(one, path[depth]):
            owner = one if owner is None or depth > len(owner.path) else owner
    if owner is None:
        raise UsageError(f"--vary {path_text(path)}: this key has no value that could be varied")
    if len(owner.path) < len(path) - 1:  # a key next to the deciding one belongs to its mapping
        for one in every:
            if len(one.path) == len(path) and one.path[:-1] == path[:-1] and _reads(one, path[-1]):
                return one, str(path[-1]), ()
    return owner, str(path[len(owner.path)]), path[len(owner.path) + 1 :]


def written(tree: Tree, key: str) -> str:
    """Return the text of a dotted key; raises UsageError where it has no value, with the key probably meant."""
    text = value_at(tree, path_of(key))
    if isinstance(text, str):
        return text
    paths = [path for path, value in leaves(tree) if isinstance(value, str) and path[0] != "uncertainty"]
    meant = did_you_mean(key, tuple(map(dotted, paths)))
    for path in reversed(paths):
        names = ".".join(step for step in path if isinstance(step, str))
        if f".{names}".endswith(f".{key}"):
            meant = f"; did you mean '{dotted(path)}'?"
    raise UsageError(f"the file has no value for this key{meant}")


def written_texts(origin: Origin, keys: Sequence[str]) -> list[str]:
    """Return the texts that a file has for these dotted keys; raises UsageError for a key without a value."""
    tree, texts = tree_of(origin), []
    for key in keys:
        try:
            texts.append(written(tree, key))
        except UsageError as error:
            raise UsageError(f"{shown(key)}: {error}") from None
    return texts
