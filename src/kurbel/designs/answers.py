"""The answers of many machines: those of one structure in batches, the others one after another."""

from collections.abc import Container, Sequence
from itertools import compress
from typing import Any, Union

import numpy as np

from kurbel.designs.columns import Answer, answered_alone, answers_in
from kurbel.errors import KurbelError
from kurbel.machine import Machine
from kurbel.machine.batch import Structures, batch
from kurbel.machine.variants import Lot
from kurbel.solver.case import Case

_ALONE = ("torsion",)
"""Commands that answer one machine at a time: they turn matrices of its own size."""
_FEWEST = 3
"""Machines of one structure; fewer are answered as quickly alone."""
AT_ONCE = 1000
"""Machines of a batch: enough to share the overhead of one run; more would only take memory."""

_LARGE, _AT_ONCE_LARGE = ("stress", "bearings"), 200
"""Commands with many quantities at the nodes, and machines of a batch for them: 1000 would take a gigabyte."""

Values = Union[Sequence[Any], str]
"""What a machine answers, in SI: a number, a tuple or None each; or why it answers nothing."""


def answers_of(lots: Sequence[Lot], asked: Sequence[Answer], rows: Container[int] | None = None) -> dict[int, Values]:
    """Return what each of many machines answers, by its row; rows: those that are wanted, all if None.

    Where rounding depends on the length of an array, as in older versions of numpy, it depends on the company in which
    a machine stands: whoever wants the same digits of a row at every time gives all lots of its company each time.
    """
    in_batches = [one.command not in _ALONE for one in asked]
    with np.errstate(all="ignore"):
        together = _Answers(lots, [one for one, own in zip(asked, in_batches) if own]).found(rows)
        if all(in_batches):
            return together
        alone = _Answers(lots, [one for one, own in zip(asked, in_batches) if not own], True).found(rows)
    return {row: _merged(first, alone[row], in_batches) for row, first in together.items()}


def is_slow(machine: Machine, asked: Answer) -> bool:
    """Return whether many such machines answer this one after another, and not in batches."""
    return asked.command in _ALONE or Structures().of(machine) is None


def _merged(first: Values, second: Values, of_first: Sequence[bool]) -> Values:
    """Return two lots of values in their order, or why there are none."""
    if isinstance(first, str) or isinstance(second, str):
        return first if isinstance(first, str) else second
    lots = iter(first), iter(second)
    return [next(lots[0] if own else lots[1]) for own in of_first]


class _Answers:
    def __init__(self, lots: Sequence[Lot], asked: Sequence[Answer], alone: bool = False) -> None:
        self._lots, self._asked, self._one_by_one = lots, asked, alone
        self._places = {row: (number, place) for number, lot in enumerate(lots) for place, row in enumerate(lot.rows)}
        self._found: dict[int, Values] = {}

    def found(self, wanted: Container[int] | None) -> dict[int, Values]:
        at_once = min(AT_ONCE, _AT_ONCE_LARGE) if any(one.command in _LARGE for one in self._asked) else AT_ONCE
        for rows in () if self._one_by_one or not self._asked else self._of_one_structure():
            for start in range(0, len(rows), at_once):
                self._together(rows[start : start + at_once])
        return {
            row: self._found[row] if row in self._found else self._alone(row)
            for row in self._places
            if wanted is None or row in wanted
        }

    def _of_one_structure(self) -> list[list[int]]:
        """Return the rows of machines of each structure; of those that must be answered alone none."""
        found: dict[Any, list[int]] = {}
        structures = Structures()
        for lot in self._lots:
            if (structure := structures.of(lot.machine)) is not None:
                found.setdefault(structure, []).extend(lot.rows)
        return list(found.values())

    def _together(self, rows: list[int]) -> None:
        """Answer these rows in a batch; those that fail, or whose numbers are none, are left to be answered alone."""
        if len(rows) < _FEWEST:
            return
        try:
            found = answers_in(Case(self._batch(rows), len(rows)), self._asked)
        except (KurbelError, ArithmeticError, RuntimeWarning):
            self._together(rows[: len(rows) // 2])
            self._together(rows[len(rows) // 2 :])
            return
        fit = np.ones(len(rows), dtype=bool)
        for value in found:
            fit &= _is_finite(value)
        values = zip(rows, zip(*(_listed(value, len(rows)) for value in found)))
        self._found.update(compress(values, fit.tolist()))

    def _batch(self, rows: list[int]) -> Machine:
        places: dict[int, list[int]] = {}
        for number, place in (self._places[row] for row in rows):
            places.setdefault(number, []).append(place)
        return batch([(self._lots[number], np.array(own)) for number, own in places.items()])

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
    """Return the values of so many machines of a batch, one by one."""
    if value is None or isinstance(value, tuple):
        return value if value and isinstance(value[0], tuple) else [value] * count
    return value.tolist() if np.ndim(value) else [float(value)] * count


def _is_finite(value: Any) -> Any:
    """Return whether a value, or that of every machine, can be told."""
    return value is None or isinstance(value, tuple) or np.isfinite(value)
