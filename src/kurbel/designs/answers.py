"""Key values of many designs, of any command: machines of the same structure in batches, others one by one."""

from collections.abc import Container, Iterator, Sequence
from typing import Any, NamedTuple, Union

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.declared.reading import shown
from kurbel.declared.unit_systems import SI
from kurbel.designs.binding import Batch, Binder
from kurbel.errors import KurbelError, UsageError
from kurbel.machine import Machine
from kurbel.machine.batch import changed
from kurbel.machine.indicator import Card
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import Extreme, number_of
from kurbel.quantities import every_quantity
from kurbel.quantity import Quantity, ambiguity, called, in_sentences, joined
from kurbel.report.commands import subjects_of
from kurbel.report.frame import Subject, too_large
from kurbel.solver.case import Case
from kurbel.traces.correct import Trace

_IN_BATCHES = ("slider-crank", "yoke-frame", "scotch-yoke")
"""Mechanisms whose formulas accept arrays as parameters."""
_MOST_POINTS = 40
"""Most points of a card in a batch."""
_FEWEST = 3
"""Fewest machines of a batch; fewer are computed as quickly one by one."""
AT_ONCE = 500
"""Most machines of a batch: enough to share the overhead of one run; more would only need more memory."""

_LARGE, _AT_ONCE_LARGE = ("stress", "bearings"), 200
"""Commands with many quantities at the nodes, and most machines of a batch for them: 1000 would need a gigabyte."""

Value = Union[float, tuple[float, ...], None]
"""A key value in SI: a number, or a list; None where there is none."""
Values = Union[Sequence[Value], str]
"""The key values of a machine, or the reason why it has none."""


class Answer(NamedTuple):
    """A key value of a command; subject: the cylinder, bearing or machine it belongs to, as the report names it.

    alone: requested for this subject only, as `LP.c_max`; angle: the crank angle of an extreme instead of its value.
    """

    quantity: Quantity
    command: str
    subject: str
    alone: bool = False
    angle: bool = False

    @property
    def kind(self) -> str:
        """The kind of the quantity, which decides the unit."""
        return "angle" if self.angle else self.quantity.kind

    def part_of(self, found: Any) -> Any:
        """Return the requested part of a value: a number, a tuple or None."""
        if self.angle:
            return found.degrees if isinstance(found, Extreme) else None
        return number_of(found)


def requested_answers(
    machine: Machine, names: Sequence[str], with_angles: bool = False, option: str = "--columns"
) -> tuple[Answer, ...]:
    """Return the key values requested by id or symbol, of every cylinder that has them; without names the usual ones.

    Those are all of `forces`; of a machine without a cylinder, whose turning effort is given, all of `flywheel`.
    with_angles: next to each extreme the crank angle at which it occurs; option: where the names are from, for errors.

    Raises UsageError for a key value that does not exist, or that this machine does not have.
    """
    case = Case(machine)
    once: dict[Answer, tuple[Answer, ...]] = {}
    with np.errstate(all="ignore"):
        declared = every_quantity().all_key_values
        found = (
            (one for name in joined(names, declared) for one in _named(case, name, option)) if names else _usual(case)
        )
        for one, value in found:
            # other designs may have a value with an angle where this one has an error
            angle = (one._replace(angle=True),) if with_angles and isinstance(value, (Extreme, KurbelError)) else ()
            once.setdefault(one._replace(alone=False), (one, *angle))
    return tuple(part for parts in once.values() for part in parts)


def _usual(case: Case) -> Iterator[tuple[Answer, Any]]:
    """Yield the key values that a command prints by default, each with its value for this machine: see `_answer`."""
    command = "forces" if case.machine.cylinders else "flywheel"
    for subject in subjects_of(case, command):
        for quantity in subject.lists.key_values(command).values():
            value = None if quantity.residual else _answer(subject, quantity, default=True)
            if value is not None:
                yield Answer(quantity, command, subject.name), value


def _named(case: Case, name: str, option: str, pistons: bool = False) -> list[tuple[Answer, Any]]:
    """Return (key value, its value for this machine: see `_answer`) for a name; pistons: also of single pistons."""
    declared = every_quantity().all_key_values
    ids = called(name, declared)
    owner, _, own = name.rpartition(".")
    of_owner = _named(case, own, option, pistons=True) if not ids and called(own, declared) else ()
    if found := [(one._replace(alone=True), value) for one, value in of_owner if one.subject == owner]:
        return found
    if not ids or ambiguity(name, ids):
        near = in_sentences(name, declared) or did_you_mean(name, tuple(one.id for one in declared))
        raise UsageError(f"{option}: {ambiguity(name, ids) or f'no key value {shown(name)!r}{near}'}")
    command = every_quantity().commands_of(ids[0])
    command = ("forces", *command) if "forces" in command and case.machine.cylinders else command
    for word in dict.fromkeys(command):
        found = [
            (Answer(quantity, word, subject.name), value)
            for subject in subjects_of(case, word, pistons=pistons)
            if (quantity := subject.lists.key_values(word).get(ids[0]))
            and (value := _answer(subject, quantity)) is not None
        ]
        if found:
            return found
    raise UsageError(f"{option}: this machine has no {ids[0]}; kurbel check shows why")


def _answer(subject: Subject, quantity: Quantity, default: bool = False) -> Any:
    """Return the value of a key value, None if there is none; or the error, since other designs may have a value."""
    try:
        return None if default and not subject.is_printed(quantity) else subject.answer(quantity)
    except KurbelError as error:
        return error


def answered_alone(machine: Machine, answers: Sequence[Answer]) -> list[Value]:
    """Return the values of a machine alone, in SI, a number, a tuple or None; raises KurbelError."""
    found = answers_in(Case(machine), answers)
    for one, value in zip(answers, found):
        if value is not None and not np.isfinite(value).all():
            raise too_large(one.quantity)
    return found


def answers_in(case: Case, answers: Sequence[Answer]) -> list[Any]:
    """Return the values of a case of one machine or of many, in SI; raises KurbelError."""
    known: dict[tuple[str, str], Subject] = {}
    for command in dict.fromkeys(one.command for one in answers):
        known |= {(command, subject.name): subject for subject in subjects_of(case, command, pistons=True)}
    found = ((one, known.get((one.command, one.subject))) for one in answers)
    return [one.part_of(subject.answer(one.quantity)) if subject else None for one, subject in found]


def answers_of(
    batches: Sequence[Batch], requested: Sequence[Answer], rows: Container[int] | None = None
) -> dict[int, Values]:
    """Return the key values of each of many machines, by its row; rows: those needed, all if None.

    In older versions of numpy rounding depends on the length of an array, and so on the machines that are computed
    together: for the same digits of a row in every run, give the same batches each time.
    """
    at_once = _AT_ONCE_LARGE if any(one.command in _LARGE for one in requested) else AT_ONCE
    found: dict[int, Values] = {}
    with np.errstate(all="ignore"):
        for batch in batches:
            places = np.arange(len(batch.rows))
            if not any(is_slow(batch.machine, one) for one in requested):
                for start in range(0, len(places), at_once):
                    found |= _together(batch, places[start : start + at_once], requested)
            for place, row in enumerate(batch.rows):
                if row not in found and (rows is None or row in rows):
                    found[row] = _alone(batch.one(place), requested)
    return found


def answers_at(binder: Binder, numbers: Array, requested: Sequence[Answer]) -> list[Values]:
    """Return the key values of the machines with these numbers (n, keys) in SI under the keys of a binder."""
    units = [SI[kind] for kind in binder.kinds]
    rows = [[f"{value!r} {unit}".rstrip() for value, unit in zip(row, units)] for row in numbers.tolist()]
    bound = binder.bound(rows)
    found = bound.failures | answers_of(bound.batches, requested)
    return [found[row] for row in range(len(rows))]


def is_slow(machine: Machine, answer: Answer) -> bool:
    """Return whether this key value is computed one machine after another, and not in batches.

    Torsion solves a matrix for each machine; formulas of some mechanisms take no arrays; a long card or a trace has
    so many pieces that it fills an array by itself.
    """
    pistons = [piston for one in machine.cylinders for piston in one.pistons]
    cards = [chamber for piston in pistons for chamber in piston.chambers.values()]
    return (
        answer.command == "torsion"
        or any(one.mechanism.name not in _IN_BATCHES for one in machine.cylinders)
        or any(isinstance(one, Trace) for one in cards)
        or any(sum(len(line.fractions) for line in one.lines) > _MOST_POINTS for one in cards if isinstance(one, Card))
    )


def _together(batch: Batch, places: Indices, requested: Sequence[Answer]) -> dict[int, Values]:
    """Return the key values of a batch by its rows, without machines that fail or have a value that is not finite."""
    if len(places) < _FEWEST or not requested:
        return {}
    try:
        machine = changed(batch.machine, lambda numbers: numbers[places])
        columns = answers_in(Case(machine, len(places)), requested)
    except (KurbelError, ArithmeticError, RuntimeWarning):
        half = len(places) // 2
        return _together(batch, places[:half], requested) | _together(batch, places[half:], requested)
    fit = np.ones(len(places), dtype=bool)
    each: list[Sequence[Value]] = []
    for value in columns:
        if isinstance(value, tuple) and value and isinstance(value[0], tuple):  # a list of each machine
            each.append(value)
        elif value is None or isinstance(value, tuple):
            each.append([value] * len(places))
        else:
            fit &= np.isfinite(value)
            each.append(np.broadcast_to(value, fit.shape).tolist())
    return {batch.rows[place]: values for place, values, good in zip(places.tolist(), zip(*each), fit.tolist()) if good}


def _alone(machine: Machine, requested: Sequence[Answer]) -> Values:
    try:
        return answered_alone(machine, requested)
    except KurbelError as error:
        return error.reason
    except ArithmeticError as error:
        return f"numeric overflow ({error})"
