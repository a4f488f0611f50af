"""Key values of many designs, of any command: machines of the same structure in batches, others one by one.

A `Study` is a machine file of which keys vary: the key values that are requested of its designs, and the limits they
break.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple, Union

import numpy as np

from kurbel.arrays import Indices
from kurbel.checks.limits import breaks, holders, no_such_value
from kurbel.declared.forms.figures import MACHINE, scoped
from kurbel.declared.reading import text_in_one_line
from kurbel.declared.unit_systems import units_of
from kurbel.designs.binding import Batch, Binder, KeyColumn
from kurbel.errors import KurbelError, MachineFileError, UsageError
from kurbel.machine import Machine
from kurbel.machine.batch import changed
from kurbel.machine.cylinder import may_lock
from kurbel.machine.indicator import Card
from kurbel.machine.origin import Origin
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import Extreme, number_of, size_of
from kurbel.quantities import KEY_VALUES, every_quantity
from kurbel.quantity import Quantity, ambiguity, in_sentences
from kurbel.report.commands import subjects_of
from kurbel.solver.case import Case
from kurbel.tables.frame import Subject
from kurbel.tables.shown import too_large

_WHOLE = "whole machine"
"""The whole machine, as a report names it."""
_IN_BATCHES = ("slider-crank", "yoke-frame", "scotch-yoke")
"""Mechanisms whose formulas accept arrays as parameters."""
_MOST_POINTS = 40
"""Most points of a card in a batch."""
_FEWEST, _MOST = 3, 250
"""Fewest machines of a batch, fewer are computed as quickly one by one; and most: more would only need more memory."""
_LARGE, _MOST_LARGE = {"stress", "bearings"}, 100
"""Commands with many quantities at the nodes, and most machines of a batch for them: 1000 would need a gigabyte."""

DesignValue = Union[float, tuple[float, ...], None]
"""A key value in SI: a number, or a list; None where there is none."""


class Row(NamedTuple):
    """The key values of a machine in SI; other_parts: how its parts differ from those that are requested, or ''."""

    values: Sequence[DesignValue]
    other_parts: str = ""


DesignValues = Union[Row, str]
"""The key values of a machine, or the reason why it has none."""


class Answer(NamedTuple):
    """A key value of a command; subject: the cylinder, bearing or machine it belongs to, as the report names it.

    alone: requested for this subject only, as `LP.c_max`; angle: the crank angle of an extreme instead of its value;
    part: what the subject is, whatever its number, see `Subject.identity`; '' for a subject that is its name.
    """

    quantity: Quantity
    command: str
    subject: str
    alone: bool = False
    angle: bool = False
    part: str = ""

    @property
    def key(self) -> tuple[str, str]:
        """Which part of which command it is of."""
        return self.command, self.part or self.subject

    @property
    def kind(self) -> str:
        """The kind of the quantity, which decides the unit."""
        return "angle" if self.angle else self.quantity.kind

    @property
    def owner(self) -> str:
        """The word that requests it for this subject only: `machine` of `machine.T_max`, or the name of the subject.

        A part that is numbered by what it may be in one row only, such as a stage, has its own name.
        """
        if self.subject == _WHOLE:
            return MACHINE
        return self.part if self.part and not self.part.startswith(self.subject) else self.subject


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
        found = [
            answer for name in KEY_VALUES.names_of(names) for answer in _named(case, name, option)
        ]
    else:
        found = [*_holding(case, "forces" if machine.cylinders else "flywheel")]
    for one, value in found:
        # other designs may have a value with an angle where this one has an error
        with_angle = with_angles and isinstance(value, (Extreme, KurbelError))
        each = [one, one._replace(angle=True)] if with_angle else [one]
        once.setdefault((one.subject, one.quantity.id), each)
    return tuple(part for each in once.values() for part in each)


def _named(case: Case, name: str, option: str) -> list[tuple[Answer, object]]:
    """Return (key value, its value for this machine: see `_holding`) for `c_max`, `LP.c_max`, or `machine.T_max`."""
    prefix, _, own = name.rpartition(".")
    owner = _WHOLE if prefix == MACHINE else prefix
    ids = KEY_VALUES.ids_of(own)
    if not ids or ambiguity(own, ids):
        declared = every_quantity().all_key_values
        near = in_sentences(name, declared) or did_you_mean(name, tuple(one.id for one in declared))
        raise UsageError(
            f"{option}: {ambiguity(own, ids) or f'no key value {text_in_one_line(name)!r}{near}'}"
        )
    for command in _commands_with(case, ids[0]):
        if found := [*_holding(case, command, ids[0], owner)]:
            return found
    raise UsageError(
        f"{option}: this machine has no {text_in_one_line(name)}; kurbel check shows why"
    )


def _commands_with(case: Case, id: str) -> Iterator[str]:
    """Yield the commands that have a key value; that of cylinders first, if it has it and there are any."""
    if case.machine.cylinders and "forces" in KEY_VALUES[id].commands:
        yield "forces"
    yield from KEY_VALUES.commands_of(id)


def _holding(
    case: Case, command: str, id: str = "", owner: str = ""
) -> Iterator[tuple[Answer, object]]:
    """Yield a key value of every subject of a command that has it, or of its owner; without id all that it prints.

    Each comes with its value for this machine, or the error, since other designs may have a value.
    """
    for subject in subjects_of(case, command, pistons=bool(owner)):
        for quantity in subject.lists.key_values(command).values():
            if owner not in ("", subject.name, subject.identity) or (
                quantity.id != id if id else quantity.residual
            ):
                continue
            value: object
            try:
                value = subject.answer(quantity) if id or subject.is_printed(quantity) else None
            except KurbelError as error:
                value = error
            if value is not None:
                yield (
                    Answer(quantity, command, subject.name, bool(owner), part=subject.identity),
                    value,
                )


# their values


def answered(
    binder: Binder, columns: Sequence[KeyColumn], requested: Sequence[Answer]
) -> list[DesignValues]:
    """Return the key values of the designs with these values of the keys of a binder.

    In older versions of numpy rounding depends on the length of an array, and so on the designs that are computed
    together: for the same digits of a row in every run, give the same rows each time.
    """
    batches, failures = binder.bound(columns)
    found = failures | answers_of(batches, requested)
    return [found[row] for row in range(len(columns[0].indices))]


@np.errstate(all="ignore")
def answers_of(batches: Sequence[Batch], requested: Sequence[Answer]) -> dict[int, DesignValues]:
    """Return the key values of each of many machines, by its row."""
    found: dict[int, DesignValues] = {}
    most = _MOST_LARGE if any(one.command in _LARGE for one in requested) else _MOST
    for batch in batches:
        if not is_slow(batch.machine, requested):
            for start in range(0, len(batch.rows), most):
                found |= _together(
                    batch, np.arange(start, min(start + most, len(batch.rows))), requested
                )
        for place, row in enumerate(batch.rows):
            if row not in found:
                found[row] = answered_alone(batch.single(place), requested)
    return found


def is_slow(machine: Machine, requested: Sequence[Answer]) -> bool:
    """Return whether these key values are computed one machine after another, and not in batches.

    Torsion solves a matrix for each machine; formulas of some mechanisms take no arrays; a long card or a trace has
    so many pieces that it fills an array by itself.
    """
    if any(one.command == "torsion" for one in requested):
        return True
    return any(cylinder.mechanism.name not in _IN_BATCHES for cylinder in machine.cylinders) or any(
        chamber.traced
        or (
            isinstance(chamber, Card)
            and sum(len(line.fractions) for line in chamber.lines) > _MOST_POINTS
        )
        for chamber in machine.chambers
    )


def _together(
    batch: Batch, places: Indices, requested: Sequence[Answer]
) -> dict[int, DesignValues]:
    """Return the key values of a batch by its rows, without machines that fail or have a value that is not finite."""
    if len(places) < _FEWEST:
        return {}
    machine = changed(batch.machine, lambda numbers: numbers[places])
    try:
        columns, other_parts = _values(Case(machine, len(places)), requested)
    except (KurbelError, ArithmeticError, RuntimeWarning):
        half = len(places) // 2
        return _together(batch, places[:half], requested) | _together(
            batch, places[half:], requested
        )
    fit = np.ones(len(places), dtype=bool)
    for cylinder in machine.cylinders:
        fit &= ~np.asarray(may_lock(cylinder))  # whether it does is known of a single machine only
    each: list[Sequence[DesignValue]] = []
    for value in columns:
        if (
            isinstance(value, tuple) and value and isinstance(value[0], tuple)
        ):  # a list of each machine
            each.append(value)
        elif value is None or isinstance(value, tuple):
            each.append([value] * len(places))
        else:
            fit &= np.isfinite(value)
            each.append(np.broadcast_to(value, fit.shape).tolist())
    rows = zip(places.tolist(), zip(*each), fit.tolist())
    return {batch.rows[place]: Row(values, other_parts) for place, values, good in rows if good}


@np.errstate(all="ignore")
def answered_alone(machine: Machine, requested: Sequence[Answer]) -> DesignValues:
    """Return the key values of a machine by itself."""
    try:
        found, other_parts = _values(Case(machine), requested)
        for one, value in zip(requested, found):
            if value is not None and not np.isfinite(value).all():
                raise too_large(one.quantity)
    except KurbelError as error:
        return error.reason
    except ArithmeticError as error:
        return f"numeric overflow ({error})"
    return Row(found, other_parts)


def _values(case: Case, requested: Sequence[Answer]) -> tuple[list[Any], str]:
    """Return the values of a case of one machine or of many, in SI, and how its parts differ; raises KurbelError."""
    known: dict[tuple[str, str], Subject] = {}
    for command in dict.fromkeys(one.command for one in requested):
        known |= {
            (command, subject.identity): subject
            for subject in subjects_of(case, command, pistons=True)
        }
    values = []
    for one in requested:
        subject = known.get(one.key)
        value = subject.answer(one.quantity) if subject else None
        if one.angle:
            values.append(value.degrees if isinstance(value, Extreme) else None)
        else:
            values.append(number_of(value))
    return values, _other_parts(known, requested)


def _other_parts(known: Mapping[tuple[str, str], Subject], requested: Sequence[Answer]) -> str:
    """Return which of the requested parts a machine does not have, and which others have their key values; or ''.

    known: the subjects of a machine by command and identity.
    """
    missing = [answer.key[1] for answer in requested if answer.key not in known]
    keys = {answer.key for answer in requested}
    pistons = {id(piston) for subject in known.values() for piston in subject.pistons}
    others: list[str] = []
    for (command, identity), subject in known.items():
        if (command, identity) in keys or subject.whole or id(subject) in pistons:
            continue
        quantities = {
            answer.quantity.id: answer.quantity
            for answer in requested
            if answer.command == command and not answer.alone and answer.subject != _WHOLE
        }
        if any(subject.answer(quantity) is not None for quantity in quantities.values()):
            others.append(subject.identity)
    if not missing and not others:
        return ""
    lacking = f"no {_quoted(missing)}" if missing else ""
    more = f"but {_quoted(others)}" if others else ""
    return f"it has other parts: {', '.join(filter(None, (lacking, more)))}"


def _quoted(names: Iterable[str]) -> str:
    """Return names for a sentence, each once."""
    return ", ".join(f"'{name}'" for name in dict.fromkeys(names))


# the machine file of which keys vary

Cell = Union[DesignValue, str]
"""A value of a row; a text for an input that is a word."""


class Head(NamedTuple):
    """A column of a table of designs: its id, and the unit of its values, '' for none.

    kind: of the values, '' of texts; input: whether it is a key that varies; listed: each value is a list.
    """

    id: str
    unit: str = ""
    kind: str = ""
    input: bool = False
    listed: bool = False


class Design(NamedTuple):
    """A row of a table of designs: its number from 1, the values of the columns, and the texts after them."""

    number: int
    values: tuple[Cell, ...]
    texts: tuple[str, ...] = ()


class Limit(NamedTuple):
    """A limit: its name in the file, the key value, and the bound in SI."""

    name: str
    answer: Answer
    bound: float


class DesignResult(NamedTuple):
    """The key values of a design in SI, or why it fails.

    broken: names of the limits that it breaks; unjudged: the limits that cannot be judged, each with the reason;
    other_parts: how its parts differ from those of the columns, or ''.
    """

    values: Sequence[DesignValue] = ()
    failure: str = ""
    broken: tuple[str, ...] = ()
    unjudged: tuple[str, ...] = ()
    other_parts: str = ""


class Study:
    """Designs of a machine file by the texts under these keys, in their order.

    starts: rows of texts, of which the first that make a valid machine decide which key values there are; names: of
    those that are requested, see `requested_answers`; cases: the first of the keys is the load case. Of the first valid
    machine are `binder`, `answers`, `limits`, and `every`, the key values that are computed for both.
    Raises the error of the first texts if none are valid, or the first error that occurs for two of them.
    """

    def __init__(
        self,
        origin: Origin,
        keys: Sequence[str],
        starts: Iterable[Sequence[str]],
        names: Sequence[str],
        with_angles: bool = False,
        option: str = "--columns",
        cases: bool = False,
    ) -> None:
        failed: list[KurbelError] = []
        for texts in starts:
            try:
                self.binder = Binder(origin, keys, texts, cases)
                self.answers = requested_answers(self.binder.machine, names, with_angles, option)
                self.limits = list(_limits_of(self.binder.machine))
                self.every = (*self.answers, *(limit.answer for limit in self.limits))
                return
            except KurbelError as error:
                failed.append(error)
                if isinstance(error, UsageError) and str(error) in map(str, failed[:-1]):
                    raise  # the request is wrong, not these texts
        raise UsageError(str(failed[0])) if isinstance(failed[0], MachineFileError) else failed[0]

    @cached_property
    def first(self) -> Sequence[DesignValue]:
        """The key values of the first valid machine."""
        found = answered_alone(self.binder.machine, self.answers)
        return [None] * len(self.answers) if isinstance(found, str) else found.values

    def heads(self, system: str) -> list[Head]:
        """Return the heads of the key values in a system of units, which the values of the first machine decide.

        An id has the name of its subject before it if it is one of several, or was requested of this subject alone.
        """
        sizes = [0.0] * len(self.answers) if system == "si" else map(size_of, self.first)
        units = units_of(
            [(one.kind, one.quantity.family, size) for one, size in zip(self.answers, sizes)],
            system,
        )
        ids = [answer.quantity.id for answer in self.answers if not answer.angle]
        heads = []
        for one, unit in zip(self.answers, units):
            id = f"{one.quantity.id}_at" if one.angle else one.quantity.id
            owned = one.alone or ids.count(one.quantity.id) > 1
            heads.append(
                Head(
                    f"{one.owner}.{id}" if owned else id, unit, one.kind, listed=one.quantity.listed
                )
            )
        return heads

    def of(self, columns: Sequence[KeyColumn]) -> list[DesignResult]:
        """Return what the designs with these values of the keys give; for the same digits give the same rows."""
        count = len(self.answers)
        designs = []
        for row in answered(self.binder, columns, self.every):
            if isinstance(row, str):
                designs.append(DesignResult(failure=row))
                continue
            broken, unjudged = self._judged(row.values[count:])
            designs.append(DesignResult(row.values[:count], "", broken, unjudged, row.other_parts))
        return designs

    def _judged(self, values: Sequence[DesignValue]) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return the limits that are broken, and those that cannot be judged; values: one for each limit."""
        known = {limit.name for limit, value in zip(self.limits, values) if value is not None}
        broken = [
            name
            for (name, answer, bound), value in zip(self.limits, values)
            if isinstance(value, (int, float)) and breaks(answer.quantity, bound, value)
        ]
        unjudged = [
            f"limits.{name}: {no_such_value(name, answer.quantity.id)}"
            for name, answer, _ in self.limits
            if name not in known
        ]
        return tuple(dict.fromkeys(broken)), tuple(dict.fromkeys(unjudged))


def _limits_of(machine: Machine) -> Iterator[Limit]:
    """Yield the limits of the file, each for every subject that it applies to; raises UsageError if there is none."""
    case = Case(machine)
    for name, bound in machine.limits:
        try:
            with np.errstate(all="ignore"):
                found = holders(case, name)
        except UsageError as error:
            raise UsageError(f"limits.{name}: {error}") from None
        if not found:
            raise UsageError(f"limits.{name}: {no_such_value(name, scoped(name)[1])}")
        for one in found:
            answer = Answer(
                one.quantity, one.command, one.subject.name, alone=True, part=one.subject.identity
            )
            yield Limit(name, answer, bound)
