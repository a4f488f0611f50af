"""Many machines of one structure as one machine, whose numbers are arrays (machines,) where they differ.

The rules of each machine were checked when it was made, and are not checked again here. What formulas distinguish is
structure: words, whole numbers, whether a number is given, zero or infinite, how throws share their pins.
"""

import math
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, fields, is_dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Array, Indices, Indivisible
from kurbel.machine import Machine
from kurbel.machine.indicator import Indicator
from kurbel.machine.turning import Effort, Harmonics
from kurbel.traces.correct import Trace

if TYPE_CHECKING:
    from kurbel.machine import Machine


@dataclass(frozen=True, eq=False)
class Lot:
    """Machines of one structure in one record, with arrays (machines,) for numbers that differ; rows: of each."""

    machine: "Machine"
    rows: Sequence[int]

    def one(self, place: int) -> "Machine":
        """Return one of them, counted from 0, alone."""
        return one_of(self.machine, place)  # type: ignore[no-any-return]


def values_of(record: Any) -> dict[str, Any]:
    """Return the values of a record by the names of its fields."""
    known = vars(record)
    return {one.name: known[one.name] for one in fields(record)}


def one_of(record: Any, place: int) -> Any:
    """Return the record of one of many machines."""
    return changed(record, lambda numbers: numbers[place].item(), {})


def changed(record: Any, change: Callable[[Array], Any], known: dict[int, Any]) -> Any:
    """Return a record with every array (machines,) changed; an object in several places stays one; known: by id."""
    if isinstance(record, np.ndarray):
        return change(record)
    if isinstance(record, Indivisible) or not (isinstance(record, tuple) or is_dataclass(record)):
        return record
    if id(record) not in known:
        known[id(record)] = record, _changed(record, change, known)  # with it, so that no other takes its place
    return known[id(record)][1]


def _changed(record: Any, change: Callable[[Array], Any], known: dict[int, Any]) -> Any:
    if isinstance(record, tuple):
        parts = [changed(one, change, known) for one in record]
        if all(one is other for one, other in zip(parts, record)):
            return record
        return type(record)(*parts) if hasattr(record, "_fields") else tuple(parts)
    held = values_of(record)
    found = {name: changed(one, change, known) for name, one in held.items()}
    return record if all(one is held[name] for name, one in found.items()) else _like(record, found)


def varies(record: Any, known: dict[int, Any]) -> bool:
    """Return whether anything differs among the machines of a record; known: cache, by id."""
    return changed(record, lambda numbers: None, known) is not record


@dataclass(frozen=True, eq=False)
class Chambers:
    """One end of a cylinder of many machines: the different chambers, and which one each machine has, (machines,)."""

    each: tuple[Any, ...]
    which: Indices

    @property
    def cycles(self) -> tuple[str, ...]:
        """The working cycles that the chambers can be part of, the same for all."""
        return self.each[0].cycles  # type: ignore[no-any-return]

    @property
    def clearance(self) -> Any:
        """Smallest volume over the stroke volume, (machines,), 0 where it is not known."""
        return np.array([getattr(one, "clearance", None) or 0.0 for one in self.each])[self.which]


def taken(record: Any, index: Indices) -> Any:
    """Return a record of many machines with the numbers of these, of the shape of the index."""
    if isinstance(record, np.ndarray):
        return record[index]
    if isinstance(record, tuple) and not hasattr(record, "_fields"):
        return tuple(taken(one, index) for one in record)
    varied = _varied(record)
    return record_of(record, {name: taken(getattr(record, name), index) for name in varied}) if varied else record


def count_of(record: Any) -> int | None:
    """Return the number of machines of a record; None for one machine, and where all machines have the same."""
    if isinstance(record, np.ndarray):
        return len(record)
    if isinstance(record, Chambers):
        return len(record.which)
    parts = record if isinstance(record, tuple) else (getattr(record, name) for name in _varied(record))
    return next((count for part in parts if (count := count_of(part)) is not None), None)


def record_of(like: Any, varied: dict[str, Any]) -> Any:
    """Return a record like another one, with these values of many machines, as the solver takes them."""
    return _like(like, varied | {"_varied": tuple(varied)})


def _like(record: Any, values: dict[str, Any]) -> Any:
    """Return a record with other values, without checking its rules again."""
    made = object.__new__(type(record))
    made.__dict__.update(values_of(record) | values)
    return made


def _varied(record: Any) -> tuple[str, ...]:
    """Return the names of the values that may differ among the machines of a record; () in a record of one machine."""
    varied: tuple[str, ...] = getattr(record, "__dict__", {}).get("_varied", ())
    return varied


_MECHANISMS = ("slider-crank", "yoke-frame", "scotch-yoke")
"""Mechanisms whose formulas take parameters that are arrays; machines with others are computed one by one."""
_MOST_LINES = 40
"""Most points of a card in a batch; a machine with more is computed alone, since its pieces fill an array."""
_SAID = ("name", "limits", "expect", "uncertainty", "origin")
"""Fields of a machine that no formula needs."""


class _Alone(Exception):
    """The machine must be computed alone."""


class Structures:
    """The structure that machines of a batch must share; objects that several of them share are examined once."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[Any, Any]] = {}

    def of(self, machine: Machine) -> Hashable | None:
        """Return the structure of a machine, or of several that share it; None where it must be computed alone."""
        try:
            parts = {name: one for name, one in values_of(machine).items() if name not in _SAID}
            return (*(self._part(one) for one in parts.values()), _arrangement(machine))
        except _Alone:
            return None

    def _part(self, value: Any) -> Any:
        if value is None or isinstance(value, (str, bool, int)):
            return value
        if isinstance(value, (float, np.ndarray)):
            first = value if isinstance(value, float) else value[0]
            return "0" if first == 0 else "inf" if first == math.inf else "number"
        if id(value) not in self._known:  # beside it, so that no other takes its place in memory
            self._known[id(value)] = value, self._looked_at(value)
        return self._known[id(value)][1]

    def _looked_at(self, value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(map(self._part, value))
        if isinstance(value, (Effort, Harmonics)):
            return id(value)
        if isinstance(value, Indicator):
            mirrored = value.crank_end is value.head_end
            return Indicator, _chamber(value.head_end), _chamber(value.crank_end), mirrored, value.absolute
        if getattr(value, "mechanism", None) is not None and value.mechanism.name not in _MECHANISMS:
            raise _Alone
        if is_dataclass(value):
            return (type(value), *(self._part(one) for name, one in values_of(value).items() if name != "name"))
        return value


def _chamber(chamber: Any) -> str | None:
    lines = getattr(chamber, "lines", ())
    if isinstance(chamber, Trace) or sum(len(one.fractions) for one in lines) > _MOST_LINES:
        raise _Alone
    return None if chamber is None else "process"


def _arrangement(machine: Machine) -> Hashable:
    """Return which pairs of cylinders share a crank angle, a line or a place; the same in all machines of a batch."""
    return tuple(
        _same(one.crank_position - one.bank_angle, other.crank_position - other.bank_angle)
        + 2 * _same(one.bank_angle, other.bank_angle)
        + 4 * _same(one.axial_position or 0.0, other.axial_position or 0.0)
        for one, other in combinations(machine.cylinders, 2)
    )


def _same(one: Any, other: Any) -> bool:
    apart = np.abs(one - other)
    near = np.asarray(np.minimum(apart, np.abs(apart - 360.0)) < 1e-9)
    if near.any() != near.all():
        raise _Alone
    return bool(near.all())


def batch(lots: Sequence[tuple[Lot, Indices]]) -> Machine:
    """Return machines of one structure as one of arrays.

    lots: each with the places (n,) in it of the machines that are taken.
    """
    stack = _Stack(lots)
    machines = [lot.machine for lot, _ in lots]
    named = [one.name for one in fields(Machine) if one.name not in _SAID]
    columns = {name: [getattr(one, name) for one in machines] for name in named}
    return record_of(machines[0], {name: stack.of(column) for name, column in columns.items()})  # type: ignore[no-any-return]


class _Stack:
    """Joins records of lots of one structure; an object that is shared stays shared."""

    def __init__(self, lots: Sequence[tuple[Lot, Indices]]) -> None:
        self._lots = lots
        self._made: dict[tuple[int, ...], Any] = {}
        self._seen: dict[int, Any] = {}

    def of(self, column: Sequence[Any]) -> Any:
        """Return the joined values of one field, given those of every lot."""
        first = column[0]
        if all(one is first for one in column) and not varies(first, self._seen):
            return first
        ids = tuple(map(id, column))
        if ids not in self._made:
            self._made[ids] = self._join(column)
        return self._made[ids]

    def _join(self, column: Sequence[Any]) -> Any:
        first = column[0]
        if isinstance(first, (float, int, np.ndarray)) and not isinstance(first, bool):
            return self._numbers(column)
        if isinstance(first, tuple) and not hasattr(first, "_fields"):
            return tuple(self.of(parts) for parts in zip(*column))
        if isinstance(first, Indicator):
            ends = {end: self._chambers([getattr(one, end) for one in column]) for end in ("head_end", "crank_end")}
            return record_of(first, ends)
        if is_dataclass(first):
            found = {one.name: self.of([getattr(each, one.name) for each in column]) for one in fields(first)}
            return record_of(first, {name: one for name, one in found.items() if one is not getattr(first, name)})
        return first

    def _numbers(self, column: Sequence[Any]) -> Any:
        if not any(isinstance(one, np.ndarray) or one != column[0] for one in column):
            return column[0]
        return np.concatenate(
            [
                one[places] if isinstance(one, np.ndarray) else np.full(len(places), one)
                for one, (_, places) in zip(column, self._lots)
            ]
        )

    def _chambers(self, column: Sequence[Any]) -> Any:
        ids = tuple(map(id, column))
        if ids not in self._made:
            whole = [each for one, (lot, places) in zip(column, self._lots) for each in _each(one, lot, places)]
            different = {id(one): one for one in whole}
            numbers = {key: number for number, key in enumerate(different)}
            chambers = Chambers(tuple(different.values()), np.array([numbers[id(one)] for one in whole]))
            self._made[ids] = chambers if len(different) > 1 else column[0]
        return self._made[ids]


def _each(chamber: Any, lot: Lot, places: Indices) -> list[Any]:
    """Return the chamber of each of these machines of a lot."""
    if len(lot.rows) > 1 and varies(chamber, {}):
        return [one_of(chamber, place) for place in places.tolist()]
    return [chamber] * len(places)
