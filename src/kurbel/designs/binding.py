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

from kurbel.arrays import Array, Flags, Indices, Indivisible
from kurbel.declared.forms.making import Maker
from kurbel.declared.forms.structures import ReadMapping
from kurbel.declared.forms.values import NumberForm
from kurbel.declared.numerals import NUMBER
from kurbel.declared.reading import Reading, StopReading
from kurbel.declared.unit_systems import SI
from kurbel.declared.units import (
    parse_quantity,
    unit_factor,
    written_unit,
    zero_and_unit,
    zero_of,
)
from kurbel.designs.plan import Input
from kurbel.errors import KurbelError, MachineFileError, Path, UnitError, UsageError, path_text
from kurbel.machine import Machine
from kurbel.machine.batch import changed
from kurbel.machine.cylinder import pin_lag
from kurbel.machine.origin import Origin
from kurbel.machine_file.overrides import path_of, tree_of, value_at
from kurbel.machine_file.reader import read_values, reading_of
from kurbel.machine_file.zeros import zero_of_key

INFINITE = "infinite"
"""The word for the length of an infinite rod."""


class KeyColumn(NamedTuple):
    """The values of a key in rows: row k has value number `indices[k]` of the input.

    numbers: all values of the input, in the base of their kind, nan for a word.
    """

    input: Input
    numbers: Array
    indices: Indices

    def text(self, row: int) -> str:
        """Return the value in a row as the machine file would have it."""
        return self.input.text(int(self.indices[row]))


class Batch(NamedTuple):
    """Machines of one structure as one record, in which the numbers that differ are arrays (machines,).

    rows: the row of each machine.
    """

    machine: Machine
    rows: Sequence[int]

    def single(self, index: int) -> Machine:
        """Return a single machine, counted from 0."""
        return changed(self.machine, lambda numbers: numbers[index].item())


class Binder:
    """Makes machines of a file from values of these keys, in their order.

    start: texts that make a valid machine; cases: the first of the keys is the load case.
    Raises UsageError for an unknown key.
    """

    def __init__(
        self, origin: Origin, keys: Sequence[str], start: Sequence[str], cases: bool = False
    ) -> None:
        self._origin = origin
        self._keys = keys
        self._start = start
        self._cases = cases
        root = read_values(self._with(start), reading_of(origin))
        self.machine: Machine = root.made
        self.kinds: list[str] = [""] if cases else []
        """The kind of number of each key, '' for words."""
        self._is_numeric = [False] if cases else []
        mappings = list(_mappings(root))
        for key in keys[len(self.kinds) :]:
            owner, name, inner_path = _owner(path_of(key), mappings)
            form = owner.form.keys[name].form
            written = owner.mapping.get(name)
            kind = form.kind_as_written(written)
            if not kind and inner_path:
                # the number of a point, say, is bare
                text = value_at(written, inner_path)
                is_bare_number = isinstance(text, str) and NUMBER.fullmatch(text)
                kind = "ratio" if is_bare_number else ""
            self.kinds.append(kind)
            is_number = not inner_path and form.number is not None
            self._is_numeric.append(is_number and not _is_indivisible(owner, mappings))
        self._words = self._structure(start)
        self._root = root
        self.zeros = list(map(self._zero, keys, self.kinds))
        """What the pressures of each key count from: `absolute`, `gauge`, '' of other quantities and of differences."""
        self.units = list(map(_si_unit, self.kinds, start))
        """The unit of SI of each key, which names the zero of a pressure where its text does."""

    def columns(self, numbers: Array) -> list[KeyColumn]:
        """Return columns of numbers (rows, keys) in the base of the kinds of all keys."""
        rows = np.arange(len(numbers))
        columns = []
        for key, unit, values in zip(self._keys, self.units, numbers.T):
            input = Input(key, (), tuple(values.tolist()), unit)
            columns.append(KeyColumn(input, values, rows))
        return columns

    def bound(self, columns: Sequence[KeyColumn]) -> tuple[list[Batch], dict[int, str]]:
        """Return the machines of rows in batches, and why other rows have none; columns: the values of the keys."""
        batches: list[Batch] = []
        failures: dict[int, str] = {}
        rows = np.arange(len(columns[0].indices))

        # rows with the same words are read together
        words = []
        for column, is_numeric in zip(columns, self._is_numeric):
            if not is_numeric:
                texts = [column.text(row) for row in rows.tolist()]
                words.append(np.unique(texts, return_inverse=True)[1])
        for group in _groups_alike(words, rows):
            rows_alone = group
            if len(group) > 1:
                together, rows_alone = self._bound_together(columns, group)
                batches += together
            for row in rows_alone.tolist():
                machine = self._alone([column.text(row) for column in columns])
                if isinstance(machine, str):
                    failures[row] = machine
                else:
                    batches.append(Batch(machine, [row]))
        return batches, failures

    def _zero(self, key: str, kind: str) -> str:
        """Return what the pressures of a key count from, '' if it has others."""
        if kind != "pressure":
            return ""
        return zero_of_key(tree_of(self._with(self._start)), path_of(key))

    def _with(self, texts: Sequence[str]) -> Origin:
        """Return the file with these texts under the keys."""
        varied = tuple(f"{key}={text}" for key, text in zip(self._keys, texts))
        if self._cases:
            return self._origin._replace(case=texts[0], varied=varied[1:])
        return self._origin._replace(varied=varied)

    def _alone(self, texts: Sequence[str]) -> Machine | str:
        """Return the machine of one row, or the reason why there is none."""
        reading = reading_of(self._origin)
        try:
            machine: Machine = read_values(self._with(texts), reading).made
        except UsageError as error:
            return str(error)
        except MachineFileError:
            # identical cylinders have the same fault
            messages: dict[str, None] = {}
            for fault in reading.faults:
                where = f"{path_text(fault.path)}: " if fault.path else ""
                messages[f"{where}{fault.message}"] = None
            return "; ".join(messages)
        return machine

    def _structure(self, texts: Iterable[str]) -> list[str]:
        """Return the texts of a row with the numbers of the first machine: those of rows of one structure agree."""
        words = []
        for text, start, is_numeric in zip(texts, self._start, self._is_numeric):
            words.append(start if is_numeric else text)
        return words

    def _bound_together(
        self, columns: Sequence[KeyColumn], rows: Indices
    ) -> tuple[list[Batch], Indices]:
        """Return the machines of rows with the same words, and the rows that must be read one by one."""
        try:
            self._read_structure(columns, rows[0])
            numbers = self._numbers_in_place(columns, rows)
            if numbers is None:
                return [], rows
            are_within = self._put_in_place(numbers, len(rows))
            maker = Maker(Reading(), int(are_within.sum()))
            with np.errstate(all="ignore"):
                machine = maker.made(self._root)
            if maker.reading.faults or not are_within.any():
                return [], rows
            groups = _with_same_branches(machine, np.flatnonzero(~maker.broken))
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
            return [], rows

        rows_read = rows[are_within]
        batches = []
        for alike in groups:
            # a value that all machines have in common becomes a number
            batch = changed(machine, lambda values, alike=alike: _column(values[alike]))  # type: ignore[misc]
            batches.append(Batch(batch, rows_read[alike].tolist()))
        return batches, np.concatenate([rows[~are_within], rows_read[maker.broken]])

    def _read_structure(self, columns: Sequence[KeyColumn], row: int) -> None:
        """Read the machine with the words of a row, if these are others than those of the last one."""
        words = self._structure(column.text(row) for column in columns)
        if words != self._words:
            self._words = words
            self._root = read_values(self._with(words), reading_of(self._origin))

    def _numbers_in_place(
        self, columns: Sequence[KeyColumn], rows: Indices
    ) -> list[tuple[ReadMapping, str, NumberForm, Array]] | None:
        """Return mapping, key, form and values of each number that varies; None where a key has a word here."""
        numbers = []
        mappings = list(_mappings(self._root))
        for column, is_numeric in zip(columns, self._is_numeric):
            if not is_numeric:
                continue
            owner, name, _ = _owner(path_of(column.input.key), mappings)
            form = owner.form.keys[name].form.number
            if form is None:
                return None
            values = column.numbers[column.indices[rows]]
            # a cylinder that is `like` the one of a key gets its numbers, too
            text = owner.mapping.get(name)
            for mapping in mappings:
                if _reads(mapping, name) and mapping.mapping.get(name) is text:
                    numbers.append((mapping, name, form, values))
        return numbers

    def _put_in_place(
        self, numbers: Sequence[tuple[ReadMapping, str, NumberForm, Array]], count: int
    ) -> Flags:
        """Put arrays in the place of numbers, and return which rows (n,) are within all bounds."""
        are_within = np.ones(count, dtype=bool)
        for _, _, form, values in numbers:
            are_within &= form.within(values)
        for mapping, name, form, values in numbers:
            within_bounds = values[are_within]
            if form.becomes:
                mapping.values[name] = form.becomes(within_bounds, "")
            else:
                mapping.values[name] = within_bounds
        return are_within


def _si_unit(kind: str, text: str) -> str:
    """Return the unit of SI of a kind, with the zero that a text names.

    >>> _si_unit("length", "400 mm"), _si_unit("pressure", "7 bara"), _si_unit("", "mirrored")
    ('m', 'Pa abs', '')
    """
    unit = SI.get(kind, "")
    if kind != "pressure":
        return unit
    zero, _ = zero_and_unit(written_unit(text))
    return f"{unit} {zero.replace('absolute', 'abs')}".rstrip()


def numbers_of(input: Input, kind: str) -> Array:
    """Return the values (n,) of an input in the base of their kind; nan for words, and for what cannot be read."""
    if input.texts:
        numbers = {INFINITE: math.inf}
        for text in dict.fromkeys(input.texts):
            with suppress(UnitError):
                numbers[text] = parse_quantity(text, kind) if kind else math.nan
        return np.array([numbers.get(text, math.nan) for text in input.texts])
    with suppress(UnitError):
        if kind:
            is_percent = kind == "ratio" and input.unit == "%"
            up, down = (1, 100) if is_percent else unit_factor(input.unit, kind)
            values = np.array(input.numbers, dtype=float)
            return (values + zero_of(input.unit)) * up / down
    return np.full(input.length, math.nan)


def _groups_alike(columns: Sequence[Array | Indices], indices: Indices) -> list[Indices]:
    """Return indices in groups, in each of which every column has one value."""
    groups = [indices] if len(indices) else []
    for column in columns:
        parted = []
        for group in groups:
            values = column[group]
            parted += [group[values == value] for value in np.unique(values)]
        groups = parted
    return groups


def _with_same_branches(machine: Machine, indices: Indices) -> list[Indices]:
    """Return indices, among these, of machines that take the same branches in the solver.

    The same numbers are 0 or infinite in them, and the same throws share their crank angle, their stroke line and their
    axial position.
    """
    codes: list[Array] = []

    def coded(numbers: Array) -> Array:
        codes.append((numbers == 0) + 2.0 * np.isinf(numbers))
        return numbers

    changed(machine, coded)
    for cylinder, other in combinations(machine.cylinders, 2):
        first = machine.cylinders[0]
        bank_difference = cylinder.bank_angle - other.bank_angle
        first = machine.cylinders[0]
        pin_difference = pin_lag(cylinder, first) - pin_lag(other, first)
        axial_position = 0.0 if cylinder.axial_position is None else cylinder.axial_position
        other_position = 0.0 if other.axial_position is None else other.axial_position
        differences = (pin_difference, bank_difference, axial_position - other_position)
        for difference in map(np.abs, differences):
            if np.ndim(difference):
                apart = np.minimum(difference, np.abs(difference - 360.0))
                codes.append(apart < 1e-9)
    return _groups_alike(codes, indices)


def _column(values: Array) -> Array | list[object]:
    """Return an array of many machines, or the number if all have the same."""
    # bit by bit: 0 and −0 are different
    bits = values.view(np.int64)
    if (bits != bits[0]).any():
        return values
    return values[0].item()


# the place of a key


def _mappings(value: object) -> Iterator[ReadMapping]:
    """Yield every mapping as read, inner ones first."""
    if isinstance(value, ReadMapping):
        for inner in value.values.values():
            yield from _mappings(inner)
        yield value
    elif isinstance(value, tuple):
        for item in value:
            yield from _mappings(item)


def _reads(mapping: ReadMapping, name: object) -> bool:
    """Return whether a key is one of the record itself, and given."""
    return name in mapping.values and name in mapping.form.keys


def _is_indivisible(mapping: ReadMapping, mappings: Sequence[ReadMapping]) -> bool:
    """Return whether a mapping, or one that it is in, becomes a record whose arrays are those of one machine."""
    for outer in mappings:
        is_outer = mapping.path[: len(outer.path)] == outer.path
        if is_outer and isinstance(outer.made, Indivisible):
            return True
    return False


def _owner(path: Path, mappings: Sequence[ReadMapping]) -> tuple[ReadMapping, str, Path]:
    """Return the innermost mapping whose record reads a key, its own key on the path, and the rest of the path."""
    owner = None
    for mapping in mappings:
        depth = len(mapping.path)
        is_above = mapping.path == path[:depth] and depth < len(path)
        if is_above and _reads(mapping, path[depth]):
            is_deeper = owner is None or depth > len(owner.path)
            owner = mapping if is_deeper else owner
    if owner is None:
        raise UsageError(f"--vary {path_text(path)}: this key has no value that could be varied")

    # a key next to the deciding one belongs to its mapping
    depth = len(owner.path)
    if depth < len(path) - 1:
        for mapping in mappings:
            is_beside = len(mapping.path) == len(path) and mapping.path[:-1] == path[:-1]
            if is_beside and _reads(mapping, path[-1]):
                return mapping, str(path[-1]), ()
    return owner, str(path[depth]), path[depth + 1 :]
