"""The answers of many machines: those of one kind side by side, the others one after another."""

from collections.abc import Container, Sequence
from itertools import compress
from typing import Any, Union

import numpy as np

from kurbel.declared.quantity import Quantity
from kurbel.designs.columns import Answer, answered_alone
from kurbel.errors import KurbelError
from kurbel.machine import Machine
from kurbel.machine.side_by_side import Kinds, side_by_side
from kurbel.machine.variants import Lot
from kurbel.numerics.cycles import Unlike
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.cylinder.guide_load import GuideLoad
from kurbel.solver.cylinder.indicated import Indicated
from kurbel.solver.cylinder.motion import Motion
from kurbel.solver.cylinder.rod_load import RodLoad
from kurbel.solver.figures import answered

_ALONE = ("energy_residual",)
"""Key values whose quadrature cuts the pieces of each machine until they agree, and answers one machine at a time."""
_BESIDE = (CylinderForces, GuideLoad, Indicated, Motion, RodLoad)
"""What answers key values of a cylinder by formulas that take many machines."""
_FEWEST = 3
"""Machines of one kind; fewer are answered as quickly alone."""
AT_ONCE = 1000
"""Machines side by side: enough to share the overhead of one run; more would only take memory."""

Values = Union[Sequence[Any], str]
"""What a machine answers, in SI: a number, a tuple or None each; or why it answers nothing."""


def answers_of(lots: Sequence[Lot], asked: Sequence[Answer], rows: Container[int] | None = None) -> dict[int, Values]:
    """Return what each of many machines answers, by its row; rows: those that are wanted, all if None.

    Where rounding depends on the length of an array, as in older versions of numpy, it depends on the company in which
    a machine stands: whoever wants the same digits of a row at every time gives all lots of its company each time.
    """
    side_by_side = [one.of_cylinder and _stands_beside(one.quantity) for one in asked]
    with np.errstate(all="ignore"):
        together = _Answers(lots, [one for one, beside in zip(asked, side_by_side) if beside]).found(rows)
        if all(side_by_side):
            return together
        alone = _Answers(lots, [one for one, beside in zip(asked, side_by_side) if not beside], True).found(rows)
    return {row: _merged(first, alone[row], side_by_side) for row, first in together.items()}


def stands_beside(machine: Machine, asked: Answer) -> bool:
    """Return whether many such machines answer this side by side, in little more time than one of them."""
    return _stands_beside(asked.quantity) and not is_slow(machine, asked)


def is_slow(machine: Machine, asked: Answer) -> bool:
    """Return whether what is asked is of the whole machine, or of a cylinder that must be answered alone."""
    own = (one for one in machine.cylinders if one.name == asked.subject and asked.of_cylinder)
    return all(Kinds().of(machine, one) is None for one in own)


def _stands_beside(quantity: Quantity) -> bool:
    """Return whether a key value is one of a cylinder whose formulas take many machines."""
    name = quantity.asks[0] if quantity.asks else quantity.id
    return quantity.id not in _ALONE and any(hasattr(one, name) for one in _BESIDE)


def _merged(first: Values, second: Values, of_first: Sequence[bool]) -> Values:
    """Return two lots of values in their order, or why there are none."""
    if isinstance(first, str) or isinstance(second, str):
        return first if isinstance(first, str) else second
    lots = iter(first), iter(second)
    return [next(lots[0] if own else lots[1]) for own in of_first]


class _Answers:
    def __init__(self, lots: Sequence[Lot], asked: Sequence[Answer], alone: bool = False) -> None:
        self._lots, self._asked = lots, asked
        self._places = {row: (number, place) for number, lot in enumerate(lots) for place, row in enumerate(lot.rows)}
        self._found: dict[int, Values] = {}
        self._names = [] if alone else list(dict.fromkeys(one.subject for one in asked))

    def found(self, wanted: Container[int] | None) -> dict[int, Values]:
        for rows in self._alike() if self._names else ():
            for start in range(0, len(rows), AT_ONCE):
                self._together(rows[start : start + AT_ONCE])
        return {
            row: self._found[row] if row in self._found else self._alone(row)
            for row in self._places
            if wanted is None or row in wanted
        }

    def _alike(self) -> list[list[int]]:
        """Return the rows of machines of one kind; of others none."""
        kinds: dict[Any, list[int]] = {}
        known = Kinds()
        for lot in self._lots:
            own = {cylinder.name: cylinder for cylinder in lot.machine.cylinders}
            found = tuple(known.of(lot.machine, own[name]) if name in own else None for name in self._names)
            if None not in found:
                kinds.setdefault(found, []).extend(lot.rows)
        return list(kinds.values())

    def _together(self, rows: list[int]) -> None:
        """Answer these rows side by side; those that cannot be, and are left, are answered alone."""
        if len(rows) < _FEWEST:
            return
        try:
            found = self._columns(rows)
        except Unlike as error:
            odd = set(np.unique(error.variants).tolist())
            self._together([row for place, row in enumerate(rows) if place not in odd])
        except (KurbelError, ArithmeticError, RuntimeWarning):
            self._together(rows[: len(rows) // 2])
            self._together(rows[len(rows) // 2 :])
        else:
            fit = np.ones(len(rows), dtype=bool)
            for value in found:
                fit &= _is_finite(value)
            values = zip(rows, zip(*(_listed(value, len(rows)) for value in found)))
            self._found.update(compress(values, fit.tolist()))

    def _columns(self, rows: list[int]) -> list[Any]:
        cylinders = {name: self._stack(rows, name) for name in self._names}
        found = [one.part_of(answered(cylinders[one.subject].answering, one.quantity)) for one in self._asked]
        for one in cylinders.values():
            vars(one).clear()  # its parts point back: in a circle the arrays of a chunk would outlive many others
        return found

    def _stack(self, rows: list[int], name: str) -> CylinderForces:
        places: dict[int, list[int]] = {}
        for number, place in (self._places[row] for row in rows):
            places.setdefault(number, []).append(place)
        lots = [(self._lots[number], np.array(own)) for number, own in places.items()]
        return CylinderForces(*side_by_side(lots, name), len(rows))

    def _alone(self, row: int) -> Values:
        if not self._asked:
            return []
        number, place = self._places[row]
        try:
            return answered_alone(self._lots[number].one(place), self._asked)
        except KurbelError as error:
            return str(error)
        except ArithmeticError as error:
            return f"these numbers lead beyond what can be computed with ({error})"


def _listed(value: Any, count: int) -> Sequence[Any]:
    """Return the values of so many machines side by side, one by one."""
    if value is None or isinstance(value, tuple):
        return value if value and isinstance(value[0], tuple) else [value] * count
    return value.tolist() if np.ndim(value) else [float(value)] * count


def _is_finite(value: Any) -> Any:
    """Return whether a value, or that of every machine, can be told."""
    return value is None or isinstance(value, tuple) or np.isfinite(value)
