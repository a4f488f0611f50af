"""Key values of many designs, of any command: machines of the same structure in batches, others one by one."""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple, Union

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.declared.forms.figures import MACHINE
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

_WHOLE = "whole machine"
"""The whole machine, as a report names it."""
_IN_BATCHES = ("slider-crank", "yoke-frame", "scotch-yoke")
"""Mechanisms whose formulas accept arrays as parameters."""
_MOST_POINTS = 40
"""Most points of a card in a batch."""
_FEWEST, _MOST = 3, 500
"""Fewest machines of a batch, fewer are computed as quickly one by one; and most: more would only need more memory."""
_LARGE, _MOST_LARGE = {"stress", "bearings"}, 200
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

    @property
    def owner(self) -> str:
        """The word that requests it for this subject only: `machine` of `machine.T_max`, or the name of the subject."""
        return MACHINE if self.subject == _WHOLE else self.subject


# which key values are requested


@np.errstate(all="ignore")
def requested_answers(
    machine: Machine, names: Sequence[str], with_angles: bool = False, option: str = "--columns"
) -> tuple[Answer, ...]:
    """Return the key values requested by id or symbol, of every cylinder that has them; without names the usual ones.

    Those are all of `forces`; of a machine without a cylinder, whose turning effort is given, all of `flywheel`.
    with_angles: next to each extreme the crank angle at which it occurs; option: where the names are from, for errors.

    Raises UsageError for a key value that does not exist, or that this machine does not have.
    """
    case = Case(machine)
    once: dict[tuple[str, str], list[Answer]] = {}
    if names:
        known = joined(names, every_quantity().all_key_values)
        found = [one for name in known for one in _named(case, name, option)]
    else:
        found = [*_holding(case, "forces" if machine.cylinders else "flywheel")]
    for one, value in found:
        # other designs may have a value with an angle where this one has an error
        with_angle = with_angles and isinstance(value, (Extreme, KurbelError))
        each = [one, one._replace(angle=True)] if with_angle else [one]
        once.setdefault((one.subject, one.quantity.id), each)
    return tuple(part for each in once.values() for part in each)


def _named(case: Case, name: str, option: str) -> list[tuple[Answer, Any]]:
    """Return (key value, its value for this machine: see `_holding`) for `c_max`, `LP.c_max`, or `machine.T_max`."""
    declared = every_quantity().all_key_values
    prefix, _, own = name.rpartition(".")
    owner = _WHOLE if prefix == MACHINE else prefix
    ids = called(own, declared)
    if not ids or ambiguity(own, ids):
        near = in_sentences(name, declared) or did_you_mean(name, tuple(one.id for one in declared))
        raise UsageError(f"{option}: {ambiguity(own, ids) or f'no key value {shown(name)!r}{near}'}")
    commands = every_quantity().commands_of(ids[0])
    for command in ("forces", *commands) if "forces" in commands and case.machine.cylinders else commands:
        if found := [*_holding(case, command, ids[0], owner)]:
            return found
    raise UsageError(f"{option}: this machine has no {shown(name)}; kurbel check shows why")


def _holding(case: Case, command: str, id: str = "", owner: str = "") -> Iterator[tuple[Answer, Any]]:
    """Yield a key value of every subject of a command that has it, or of its owner; without id all that it prints.

    Each comes with its value for this machine, or the error, since other designs may have a value.
    """
    for subject in subjects_of(case, command, pistons=bool(owner)):
        for quantity in subject.lists.key_values(command).values():
            if owner not in ("", subject.name) or (quantity.id != id if id else quantity.residual):
                continue
            value: Any
            try:
                value = subject.answer(quantity) if id or subject.is_printed(quantity) else None
            except KurbelError as error:
                value = error
            if value is not None:
                yield Answer(quantity, command, subject.name, alone=bool(owner)), value


# their values


def answered(binder: Binder, rows: Sequence[Sequence[str]], requested: Sequence[Answer]) -> list[Values]:
    """Return the key values of the designs with these texts (rows, keys) under the keys of a binder.

    In older versions of numpy rounding depends on the length of an array, and so on the designs that are computed
    together: for the same digits of a row in every run, give the same rows each time.
    """
    bound = binder.bound(rows)
    found = bound.failures | answers_of(bound.batches, requested)
    return [found[row] for row in range(len(rows))]


def texts_of(binder: Binder, numbers: Array) -> list[list[str]]:
    """Return numbers (rows, keys) in SI as texts under the keys of a binder."""
    units = [SI[kind] for kind in binder.kinds]
    return [[f"{value!r} {unit}".rstrip() for value, unit in zip(row, units)] for row in numbers.tolist()]


@np.errstate(all="ignore")
def answers_of(batches: Sequence[Batch], requested: Sequence[Answer]) -> dict[int, Values]:
    """Return the key values of each of many machines, by its row."""
    found: dict[int, Values] = {}
    most = _MOST_LARGE if any(one.command in _LARGE for one in requested) else _MOST
    for batch in batches:
        if not is_slow(batch.machine, requested):
            for start in range(0, len(batch.rows), most):
                found |= _together(batch, np.arange(start, min(start + most, len(batch.rows))), requested)
        for place, row in enumerate(batch.rows):
            if row not in found:
                found[row] = answered_alone(batch.one(place), requested)
    return found


def is_slow(machine: Machine, requested: Sequence[Answer]) -> bool:
    """Return whether these key values are computed one machine after another, and not in batches.

    Torsion solves a matrix for each machine; formulas of some mechanisms take no arrays; a long card or a trace has
    so many pieces that it fills an array by itself.
    """
    if any(one.command == "torsion" for one in requested):
        return True
    pistons = [piston for one in machine.cylinders for piston in one.pistons]
    cards = [chamber for piston in pistons for chamber in piston.chambers.values()]
    return any(one.mechanism.name not in _IN_BATCHES for one in machine.cylinders) or any(
        isinstance(one, Trace)
        or (isinstance(one, Card) and sum(len(line.fractions) for line in one.lines) > _MOST_POINTS)
        for one in cards
    )


def _together(batch: Batch, places: Indices, requested: Sequence[Answer]) -> dict[int, Values]:
    """Return the key values of a batch by its rows, without machines that fail or have a value that is not finite."""
    if len(places) < _FEWEST:
        return {}
    try:
        columns = _values(Case(changed(batch.machine, lambda numbers: numbers[places]), len(places)), requested)
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


@np.errstate(all="ignore")
def answered_alone(machine: Machine, requested: Sequence[Answer]) -> Values:
    """Return the key values of a machine by itself."""
    try:
        found = _values(Case(machine), requested)
        for one, value in zip(requested, found):
            if value is not None and not np.isfinite(value).all():
                raise too_large(one.quantity)
    except KurbelError as error:
        return error.reason
    except ArithmeticError as error:
        return f"numeric overflow ({error})"
    return found


def _values(case: Case, requested: Sequence[Answer]) -> list[Any]:
    """Return the values of a case of one machine or of many, in SI; raises KurbelError."""
    known: dict[tuple[str, str], Subject] = {}
    for command in dict.fromkeys(one.command for one in requested):
        known |= {(command, subject.name): subject for subject in subjects_of(case, command, pistons=True)}
    values = []
    for one in requested:
        subject = known.get((one.command, one.subject))
        value = subject.answer(one.quantity) if subject else None
        if one.angle:
            values.append(value.degrees if isinstance(value, Extreme) else None)
        else:
            values.append(number_of(value))
    return values
