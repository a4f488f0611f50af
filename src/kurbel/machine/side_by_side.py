"""Machines of one kind side by side: the same records, in which what differs is an array over the variants.

Each machine has kept its own rules at birth, so that these records, made without them, keep them too.
"""

import math
from collections.abc import Hashable, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from kurbel.arrays import Indices
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Indicator
from kurbel.machine.variants import Chambers, Lot, one_of, record_of, values_of, varies
from kurbel.numerics.varied import Varied

_SIDE_BY_SIDE = ("slider-crank", "yoke-frame", "scotch-yoke")
"""Mechanisms whose formulas take numbers of many machines at once."""
_MOST_LINES = 40
"""Points of a card with more of which a machine is answered alone: its pieces are many enough to fill an array."""


class _Alone(Exception):
    """A machine has what must be answered alone."""


class Kinds:
    """Tells what machines that can stand side by side have in common; what several of them share is looked at once."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[Any, Any]] = {}

    def of(self, machine: Machine, cylinder: Cylinder) -> Hashable | None:
        """Return the kind of one cylinder of a machine; None where it must be answered alone."""
        if cylinder.mechanism.name not in _SIDE_BY_SIDE:
            return None
        cycles = tuple(machine.cycle_of_piston(cylinder, number) for number in range(len(cylinder.pistons)))
        kind = (_number(machine.speed), _number(machine.ambient), machine.rotation, machine.cycle_of(cylinder), cycles)
        try:
            return (*kind, self._kind(cylinder))
        except _Alone:
            return None

    def _kind(self, value: Any) -> Any:
        if value is None or isinstance(value, (str, bool)):
            return value
        if isinstance(value, (float, int, Varied)):
            return _number(value)
        if id(value) not in self._known:  # beside it, so that no other takes its place in memory
            self._known[id(value)] = value, self._looked_at(value)
        return self._known[id(value)][1]

    def _looked_at(self, value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(map(self._kind, value))
        if isinstance(value, Indicator):
            mirrored = value.crank_end is value.head_end
            return Indicator, _chamber(value.head_end), _chamber(value.crank_end), mirrored, value.absolute
        if getattr(value, "of_pins", ()):  # whose loads bend where they all but vanish
            raise _Alone
        if is_dataclass(value):
            return (type(value), *(self._kind(one) for name, one in values_of(value).items() if name != "name"))
        return value


def _number(value: Any) -> str | None:
    return None if value is None else "0" if value == 0 else "inf" if value == math.inf else "number"


def _chamber(chamber: Any) -> str | None:
    lines = getattr(chamber, "lines", ())
    measured = hasattr(chamber, "angles")  # over the crank angle, and no process over the stroke
    if measured or sum(len(one.fractions) for one in lines) > _MOST_LINES:
        raise _Alone
    return None if chamber is None else "process"


def side_by_side(lots: Sequence[tuple[Lot, Indices]], name: str) -> tuple[Machine, Cylinder]:
    """Return the cylinders of a name of machines of one kind as one machine and one cylinder of many variants.

    lots: with the places (n,) of the machines that are meant in each.
    """
    stack = _Stack(lots)
    machines = [lot.machine for lot, _ in lots]
    place = [one.name for one in machines[0].cylinders].index(name)
    numbers = {name: stack.of([getattr(one, name) for one in machines]) for name in ("speed", "ambient")}
    return record_of(machines[0], numbers), stack.of([one.cylinders[place] for one in machines])


class _Stack:
    """Puts records of lots of one kind together; what is one in many places stays one."""

    def __init__(self, lots: Sequence[tuple[Lot, Indices]]) -> None:
        self._lots = lots
        self._made: dict[tuple[int, ...], Any] = {}
        self._seen: dict[int, Any] = {}

    def of(self, column: Sequence[Any]) -> Any:
        """Return what stands for the values, one of each lot, of one field."""
        first = column[0]
        if all(one is first for one in column) and not varies(first, self._seen):
            return first
        ids = tuple(map(id, column))
        if ids not in self._made:
            self._made[ids] = self._join(column)
        return self._made[ids]

    def _join(self, column: Sequence[Any]) -> Any:
        first = column[0]
        if isinstance(first, (float, int, Varied)) and not isinstance(first, bool):
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
        if not any(isinstance(one, Varied) or one != column[0] for one in column):
            return column[0]
        return np.concatenate(
            [
                one.values[places] if isinstance(one, Varied) else np.full(len(places), one)
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
