"""Many machines of one structure as one machine, whose numbers are arrays (machines,) where they differ.

The rules of each machine were checked when it was made, and are not checked again here. What formulas distinguish is
structure: words, whole numbers, whether a number is given, zero or infinite, how throws share their pins.
"""

import math
from collections.abc import Hashable, Sequence
from dataclasses import fields, is_dataclass
from itertools import combinations
from typing import Any

import numpy as np

from kurbel.arrays import Indices
from kurbel.machine import Machine
from kurbel.machine.indicator import Indicator
from kurbel.machine.turning import Effort, Harmonics
from kurbel.machine.variants import Chambers, Lot, one_of, record_of, values_of, varies
from kurbel.traces.correct import Trace

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
