"""Many machines from one machine file and values of some of its keys; machines of one structure are one record.

Rows that differ only in numbers are read once, with arrays (machines,) instead of numbers; the rules of records hold
for arrays, too. Words, counts and points of cards are structure: rows that differ in these are read one by one, and so
is each row that breaks a rule, for its message.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from itertools import combinations
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, Indices, Indivisible
from kurbel.declared.forms.structures import Maker, ReadMapping
from kurbel.declared.forms.values import NumberForm
from kurbel.declared.numerals import NUMBER
from kurbel.declared.reading import Reading, StopReading
from kurbel.declared.unit_systems import SI
from kurbel.declared.units import parse_quantity, unit_factor, zero_of
from kurbel.designs.plan import Input
from kurbel.errors import KurbelError, MachineFileError, Path, UnitError, UsageError, path_text
from kurbel.machine import Machine
from kurbel.machine.batch import changed
from kurbel.machine.origin import Origin
from kurbel.machine_file.overrides import path_of, value_at
from kurbel.machine_file.reader import read_values, reading_of

INFINITE = "infinite"
"""The word for the length of an infinite rod."""


class KeyColumn(NamedTuple):
    """The values of a key in rows: row k has value number `places[k]` of the input.

    numbers: all values of the input, in the base of their kind, nan for a word.
    """

    input: Input
    numbers: Array
    places: Indices

    def text(self, row: int) -> str:
        """Return the value in a row as the machine file would have it."""
        return self.input.text(int(self.places[row]))


class Batch(NamedTuple):
    """Machines of one structure as one record, in which the numbers that differ are arrays (machines,).

    rows: the row of each machine.
    """

    machine: Machine
    rows: Sequence[int]

    def one(self, place: int) -> Machine:
        """Return a single machine, counted from 0."""
        return changed(self.machine, lambda numbers: numbers[place].item())


class Binder:
    """Makes machines of a file from values of these keys, in their order.

    start: texts that make a valid machine; cases: the first of the keys is the load case.
    Raises UsageError for an unknown key.
    """

    def __init__(
        self, origin: Origin, keys: Sequence[str], start: Sequence[str], cases: bool = False
    ) -> None:
        self._origin, self._keys, self._start, self._cases = origin, keys, start, cases
        root = read_values(self._with(start), reading_of(origin))
        self.machine: Machine = root.made
        self.kinds: list[str] = [""] * cases
        """The kind of number of each key, '' for words."""
        self._numeric = [False] * cases
        mappings = list(_mappings(root))
        for key in keys[cases:]:
            owner, name, inner = _owner(path_of(key), mappings)
            form = owner.form.keys[name].form
            text = value_at(owner.mapping.get(name), inner)
            bare = (
                inner and isinstance(text, str) and NUMBER.fullmatch(text)
            )  # the number of a point, say
            self.kinds.append(
                form.kind_as_written(owner.mapping.get(name)) or ("ratio" if bare else "")
            )
            self._numeric.append(
                not inner and form.number is not None and not _is_indivisible(owner, mappings)
            )
        self._words, self._root = self._structure(start), root

    def columns(self, numbers: Array) -> list[KeyColumn]:
        """Return columns of numbers (rows, keys) in the base of the kinds of all keys."""
        rows = np.arange(len(numbers))
        each = zip(self._keys, self.kinds, numbers.T)
        return [
            KeyColumn(Input(key, (), tuple(own.tolist()), SI[kind]), own, rows)
            for key, kind, own in each
        ]

    def bound(self, columns: Sequence[KeyColumn]) -> tuple[list[Batch], dict[int, str]]:
        """Return the machines of rows in batches, and why other rows have none; columns: the values of the keys."""
        found, failures, rows = list[Batch](), dict[int, str](), np.arange(len(columns[0].places))
        texts = (
            map(column.text, rows.tolist())
            for column, number in zip(columns, self._numeric)
            if not number
        )
        words = [np.unique(list(text), return_inverse=True)[1] for text in texts]
        for places in _alike(words, rows):
            batches, apart = self._together(columns, places) if len(places) > 1 else ([], places)
            found += batches
            for row in apart.tolist():
                alone = self._alone([column.text(row) for column in columns])
                if isinstance(alone, str):
                    failures[row] = alone
                else:
                    found.append(Batch(alone, [row]))
        return found, failures

    def _with(self, texts: Sequence[str]) -> Origin:
        """Return the file with these texts under the keys."""
        given = tuple(f"{key}={text}" for key, text in zip(self._keys, texts))
        case = texts[0] if self._cases else self._origin.case
        return self._origin._replace(case=case, varied=given[self._cases :])

    def _alone(self, texts: Sequence[str]) -> Machine | str:
        """Return the machine of one row, or the reason why there is none."""
        reading = reading_of(self._origin)
        try:
            machine: Machine = read_values(self._with(texts), reading).made
        except UsageError as error:
            return str(error)
        except MachineFileError:
            faults = (
                f"{path_text(fault.path)}: {fault.message}" if fault.path else fault.message
                for fault in reading.faults
            )
            return "; ".join(dict.fromkeys(faults))  # identical cylinders have the same fault
        return machine

    def _structure(self, texts: Iterable[str]) -> list[str]:
        """Return the texts of a row with the numbers of the first machine: those of rows of one structure agree."""
        return [
            one if number else text for text, one, number in zip(texts, self._start, self._numeric)
        ]

    def _together(
        self, columns: Sequence[KeyColumn], places: Indices
    ) -> tuple[list[Batch], Indices]:
        """Return the machines of rows with the same words, and the rows that must be read one by one."""
        within = np.ones(len(places), dtype=bool)
        slots: list[tuple[ReadMapping, str, NumberForm, Array]] = []
        try:
            words = self._structure(column.text(places[0]) for column in columns)
            if words != self._words:
                self._words, self._root = (
                    words,
                    read_values(self._with(words), reading_of(self._origin)),
                )
            mappings = list(_mappings(self._root))
            for column in (
                column for column, is_number in zip(columns, self._numeric) if is_number
            ):
                owner, name, _ = _owner(path_of(column.input.key), mappings)
                number = owner.form.keys[name].form.number
                if number is None:
                    return [], places
                numbers = column.numbers[column.places[places]]
                within &= number.within(numbers)
                # a cylinder that is `like` the one of a key gets its numbers, too
                text = owner.mapping.get(name)
                alike = (
                    mapping
                    for mapping in mappings
                    if _reads(mapping, name) and mapping.mapping.get(name) is text
                )
                slots += [(one, name, number, numbers) for one in alike]
            for one, name, number, numbers in slots:
                one.values[name] = (
                    number.becomes(numbers[within], "") if number.becomes else numbers[within]
                )
            maker = Maker(Reading(), int(within.sum()))
            with np.errstate(all="ignore"):
                machine = maker.made(self._root)
            if maker.reading.faults or not within.any():
                return [], places
        # a formula that works for a single machine only: these rows are read one by one
        except (
            KurbelError,
            StopReading,
            TypeError,
            ValueError,
            AttributeError,
            ArithmeticError,
            IndexError,
        ):
            return [], places
        read, batches = places[within], []
        for fit in _with_same_branches(machine, np.flatnonzero(~maker.broken)):
            # a value that all machines have in common becomes a number
            batch = changed(machine, lambda numbers, fit=fit: _column(numbers[fit]))  # type: ignore[misc]
            batches.append(Batch(batch, read[fit].tolist()))
        return batches, np.concatenate([places[~within], read[maker.broken]])


def numbers_of(one: Input, kind: str) -> Array:
    """Return the values (n,) of an input in the base of their kind; nan for words, and for what cannot be read."""
    if one.texts:
        known = {INFINITE: math.inf}
        for text in dict.fromkeys(one.texts):
            with suppress(UnitError):
                known[text] = parse_quantity(text, kind) if kind else math.nan
        return np.array([known.get(text, math.nan) for text in one.texts])
    with suppress(UnitError):
        if kind:
            share = kind == "ratio" and one.unit == "%"
            up, down = (1, 100) if share else unit_factor(one.unit, kind)
            return (np.array(one.numbers, dtype=float) + zero_of(one.unit)) * up / down
    return np.full(one.length, math.nan)


def _alike(columns: Sequence[Array | Indices], places: Indices) -> list[Indices]:
    """Return places in groups, in each of which every column has one value."""
    groups = [places] if len(places) else []
    for column in columns:
        groups = [
            group[column[group] == value] for group in groups for value in np.unique(column[group])
        ]
    return groups


def _with_same_branches(machine: Machine, fit: Indices) -> list[Indices]:
    """Return places, among those that fit, of machines that take the same branches in the solver.

    The same numbers are 0 or infinite in them, and the same throws share their crank angle, their stroke line and their
    axial position.
    """
    codes: list[Array] = []

    def coded(numbers: Array) -> Array:
        codes.append((numbers == 0) + 2.0 * np.isinf(numbers))
        return numbers

    changed(machine, coded)
    for one, other in combinations(machine.cylinders, 2):
        places = [
            0.0 if each.axial_position is None else each.axial_position for each in (one, other)
        ]
        turned = one.bank_angle - other.bank_angle
        for apart in map(
            np.abs,
            (one.crank_position - other.crank_position - turned, turned, places[0] - places[1]),
        ):
            if np.ndim(apart):
                codes.append(np.minimum(apart, np.abs(apart - 360.0)) < 1e-9)
    return _alike(codes, fit)


def _column(values: Array) -> Array | list[object]:
    """Return an array of many machines, or the number if all have the same."""
    bits = values.view(np.int64)  # 0 and −0 are different
    return values if (bits != bits[0]).any() else values[0].item()


# the place of a key


def _mappings(value: object) -> Iterator[ReadMapping]:
    """Yield every mapping as read, inner ones first."""
    if isinstance(value, ReadMapping):
        for one in value.values.values():
            yield from _mappings(one)
        yield value
    elif isinstance(value, tuple):
        for one in value:
            yield from _mappings(one)


def _reads(given: ReadMapping, name: object) -> bool:
    """Return whether a key is one of the record itself, and given."""
    return name in given.values and name in given.form.keys


def _is_indivisible(given: ReadMapping, mappings: Sequence[ReadMapping]) -> bool:
    """Return whether a mapping, or one that it is in, becomes a record whose arrays are those of one machine."""
    return any(
        isinstance(mapping.made, Indivisible) and given.path[: len(mapping.path)] == mapping.path
        for mapping in mappings
    )


def _owner(path: Path, mappings: Sequence[ReadMapping]) -> tuple[ReadMapping, str, Path]:
    """Return the innermost mapping whose record reads a key, its own key on the path, and the rest of the path."""
    owner = None
    for mapping in mappings:
        depth = len(mapping.path)
        if mapping.path == path[:depth] and depth < len(path) and _reads(mapping, path[depth]):
            owner = mapping if owner is None or depth > len(owner.path) else owner
    if owner is None:
        raise UsageError(f"--vary {path_text(path)}: this key has no value that could be varied")
    if len(owner.path) < len(path) - 1:  # a key next to the deciding one belongs to its mapping
        for mapping in mappings:
            if (
                len(mapping.path) == len(path)
                and mapping.path[:-1] == path[:-1]
                and _reads(mapping, path[-1])
            ):
                return mapping, str(path[-1]), ()
    return owner, str(path[len(owner.path)]), path[len(owner.path) + 1 :]
