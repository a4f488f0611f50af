"""The answers of many machines: those of one kind side by side, the others one after another."""

from collections.abc import Sequence
from typing import Any, Union

import numpy as np

from kurbel.declared.quantity import Quantity
from kurbel.designs.columns import Answer, answered_alone
from kurbel.errors import KurbelError
from kurbel.machine import Machine
from kurbel.machine.side_by_side import Kinds, side_by_side
from kurbel.numerics.cycles import Unlike
from kurbel.numerics.extreme import Extreme
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.cylinder.guide_load import GuideLoad
from kurbel.solver.cylinder.motion import Motion
from kurbel.solver.figures import answered

_ALONE = ("energy_residual",)
"""Key values whose quadrature cuts the pieces of each machine until they agree, and answers one machine at a time."""
_FEWEST = 3
"""Machines of one kind; fewer are answered as quickly alone."""
AT_ONCE = 1000
"""Machines side by side: enough to share the overhead of one run; more would only take memory."""

Values = Union[Sequence[Any], str]
"""What a machine answers, in SI: a number, an Extreme, a tuple or None each; or why it answers nothing."""


def answers_of(machines: Sequence[Machine], asked: Sequence[Answer]) -> list[Values]:
    """Return what each of many machines answers."""
    side_by_side = [one.of_cylinder and _stands_beside(one.quantity) for one in asked]
    with np.errstate(all="ignore"):
        together = _Answers(machines, [one for one, beside in zip(asked, side_by_side) if beside]).found()
        if all(side_by_side):
            return together
        alone = _Answers(machines, [one for one, beside in zip(asked, side_by_side) if not beside], True).found()
    return [_merged(first, second, side_by_side) for first, second in zip(together, alone)]


def _stands_beside(quantity: Quantity) -> bool:
    """Return whether a key value is one of forces, guide or motion themselves, whose formulas take many machines."""
    name = quantity.asks[0] if quantity.asks else quantity.id
    return quantity.id not in _ALONE and any(hasattr(one, name) for one in (CylinderForces, GuideLoad, Motion))


def _merged(first: Values, second: Values, of_first: Sequence[bool]) -> Values:
    """Return two lots of values in their order, or why there are none."""
    if isinstance(first, str) or isinstance(second, str):
        return first if isinstance(first, str) else second
    lots = iter(first), iter(second)
    return [next(lots[0] if own else lots[1]) for own in of_first]


class _Answers:
    def __init__(self, machines: Sequence[Machine], asked: Sequence[Answer], alone: bool = False) -> None:
        self._machines, self._asked = machines, asked
        self._found: list[Values | None] = [None] * len(machines)
        self._names = [] if alone else list(dict.fromkeys(one.subject for one in asked))

    def found(self) -> list[Values]:
        for rows in self._alike() if self._names else ():
            for start in range(0, len(rows), AT_ONCE):
                self._together(rows[start : start + AT_ONCE])
        return [self._alone(row) if values is None else values for row, values in enumerate(self._found)]

    def _alike(self) -> list[list[int]]:
        """Return the rows of machines of one kind; of others none."""
        kinds: dict[Any, list[int]] = {}
        known = Kinds()
        for row, machine in enumerate(self._machines):
            own = {cylinder.name: cylinder for cylinder in machine.cylinders}
            found = tuple(known.of(machine, own[name]) if name in own else None for name in self._names)
            if None not in found:
                kinds.setdefault(found, []).append(row)
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
            fit = np.all([np.broadcast_to(_is_finite(value), len(rows)) for value in found], axis=0)
            values = zip(*(_listed(value, len(rows)) for value in found))
            for row, finite, own in zip(rows, fit.tolist(), values):
                self._found[row] = own if finite else None

    def _columns(self, rows: list[int]) -> list[Any]:
        cylinders = {name: self._stack(rows, name) for name in self._names}
        return [answered(cylinders[one.subject].answering, one.quantity) for one in self._asked]

    def _stack(self, rows: list[int], name: str) -> CylinderForces:
        machines = [self._machines[row] for row in rows]
        place = [one.name for one in machines[0].cylinders].index(name)
        return CylinderForces(*side_by_side([(one, one.cylinders[place]) for one in machines]), len(rows))

    def _alone(self, row: int) -> Values:
        if not self._asked:
            return []
        try:
            return answered_alone(self._machines[row], self._asked)
        except KurbelError as error:
            return str(error)
        except ArithmeticError as error:
            return f"these numbers lead beyond what can be computed with ({error})"


def _listed(value: Any, count: int) -> Sequence[Any]:
    """Return the values of so many machines side by side, one by one."""
    if isinstance(value, Extreme):
        return list(map(Extreme, *(_listed(part, count) for part in value)))
    if value is None or isinstance(value, tuple):
        each = isinstance(value, tuple) and len(value) == count and all(isinstance(one, tuple) for one in value)
        return value if each else [value] * count  # type: ignore[return-value]
    return np.broadcast_to(np.asarray(value, dtype=float), (count,)).tolist()  # type: ignore[no-any-return]


def _is_finite(value: Any) -> Any:
    """Return whether a value, or that of every machine, can be told."""
    number = value.value if isinstance(value, Extreme) else value
    return number is None or isinstance(number, tuple) or np.isfinite(number)
