"""What each design answers: key values of any command; machines of one structure in batches, the others one by one."""

from collections.abc import Container, Iterator, Sequence
from itertools import compress
from typing import Any, NamedTuple, Union

import numpy as np

from kurbel.declared.reading import shown
from kurbel.errors import KurbelError, UsageError
from kurbel.machine import Machine
from kurbel.machine.batch import Lot, Structures, batch
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import Extreme, number_of
from kurbel.quantities import every_quantity
from kurbel.quantity import Quantity, ambiguity, called, joined
from kurbel.report.frame import subjects_of, too_large
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


class Answer(NamedTuple):
    """A key value of a command; subject: whose it is, as the report of that command names it.

    alone: it was asked of this subject alone, `LP.c_max`; angle: where an extreme stands, not its size.
    """

    quantity: Quantity
    command: str
    subject: str
    alone: bool = False
    angle: bool = False

    @property
    def kind(self) -> str:
        """Of which kind it is, which decides the unit."""
        return "angle" if self.angle else self.quantity.kind

    def part_of(self, found: Any) -> Any:
        """Return of a value what is asked: a number, a tuple or None."""
        if self.angle:
            return found.degrees if isinstance(found, Extreme) else None
        return number_of(found)


def asked_answers(machine: Machine, names: Sequence[str], with_angles: bool = False) -> tuple[Answer, ...]:
    """Return the key values that are asked for by id or symbol, of every cylinder that has them; none: the usual ones.

    Those are all of `forces`; of a machine without a cylinder, whose turning effort is given, all of `flywheel`.
    with_angles: beside each that is an extreme the angle where it stands.

    Raises UsageError for one that there is not, or that this machine has not.
    """
    case = Case(machine)
    once: dict[Answer, tuple[Answer, ...]] = {}
    with np.errstate(all="ignore"):
        declared = every_quantity().all_key_values
        found = (one for name in joined(names, declared) for one in _named(case, name)) if names else _usual(case)
        for one, value in found:
            angle = (one._replace(angle=True),) if with_angles and _stands(value) else ()
            once.setdefault(one._replace(alone=False), (one, *angle))
    return tuple(part for parts in once.values() for part in parts)


def _stands(value: Any) -> bool:
    """Return whether a value stands at an angle, or other designs may have one that does."""
    return isinstance(value, (Extreme, KurbelError))


def _usual(case: Case) -> Iterator[tuple[Answer, Any]]:
    """Yield who answers what a command tells unasked, each with what this machine has there: see `_answer`."""
    command = "forces" if case.machine.cylinders else "flywheel"
    for subject in subjects_of(case, command):
        for quantity in subject.lists.key_values(command).values():
            value = None if quantity.residual else _answer(subject, quantity, unasked=True)
            if value is not None:
                yield Answer(quantity, command, subject.name), value


def _named(case: Case, name: str) -> list[tuple[Answer, Any]]:
    """Return who answers a key value, each with what this machine has there: see `_answer`."""
    declared = every_quantity().all_key_values
    ids = called(name, declared)
    owner, _, own = name.rpartition(".")
    of_owner = _named(case, own) if not ids and called(own, declared) else ()
    if found := [(one._replace(alone=True), value) for one, value in of_owner if one.subject == owner]:
        return found
    if not ids or ambiguity(name, ids):
        near = did_you_mean(name, tuple(one.id for one in declared))
        raise UsageError(f"--columns: {ambiguity(name, ids) or f'no key value {shown(name)!r}{near}'}")
    command = every_quantity().commands_of(ids[0])
    command = ("forces", *command) if "forces" in command and case.machine.cylinders else command
    for word in dict.fromkeys(command):
        found = [
            (Answer(quantity, word, subject.name), value)
            for subject in subjects_of(case, word)
            if (quantity := subject.lists.key_values(word).get(ids[0]))
            and (value := _answer(subject, quantity)) is not None
        ]
        if found:
            return found
    raise UsageError(f"--columns: this machine has no {ids[0]}; kurbel check says why")


def _answer(subject: Any, quantity: Quantity, unasked: bool = False) -> Any:
    """Return what a machine has for a key value, None for nothing; or the error, where other designs may have it."""
    try:
        return None if unasked and not subject.says(quantity) else subject.answer(quantity)
    except KurbelError as error:
        return error


def answered_alone(machine: Machine, answers: Sequence[Answer]) -> list[Any]:
    """Return the values of a machine alone, in SI, a number, a tuple or None; raises KurbelError."""
    found = answers_in(Case(machine), answers)
    for one, value in zip(answers, found):
        if value is not None and not np.isfinite(value).all():
            raise too_large(one.quantity)
    return found


def answers_in(case: Case, answers: Sequence[Answer]) -> list[Any]:
    """Return the values of a case of one machine or of many, in SI; raises KurbelError."""
    known: dict[tuple[str, str], Any] = {}
    for command in dict.fromkeys(one.command for one in answers):
        known |= {(command, subject.name): subject for subject in subjects_of(case, command)}
    found = ((one, known.get((one.command, one.subject))) for one in answers)
    return [one.part_of(subject.answer(one.quantity)) if subject else None for one, subject in found]


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
