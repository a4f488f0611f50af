"""Key values of many designs, of any command: machines of the same structure in batches, others one by one.

A `Study` is a machine file of which keys vary: the key values that are requested of its designs, and the limits they
break.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import chain
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
from kurbel.machine.indicator import Card, Chamber
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
        if self.angle:
            return "angle"
        return self.quantity.kind

    @property
    def owner(self) -> str:
        """The word that requests it for this subject only: `machine` of `machine.T_max`, or the name of the subject.

        A part that is numbered by what it may be in one row only, such as a stage, has its own name.
        """
        if self.subject == _WHOLE:
            return MACHINE
        if self.part and not self.part.startswith(self.subject):
            return self.part
        return self.subject


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
    if names:
        held = []
        for name in KEY_VALUES.names_of(names):
            held += _named(case, name, option)
    else:
        held = list(_holding(case, "forces" if machine.cylinders else "flywheel"))

    once: dict[tuple[str, str], list[Answer]] = {}
    for answer, value in held:
        # other designs may have a value with an angle where this one has an error
        has_angle = with_angles and isinstance(value, (Extreme, KurbelError))
        answers = [answer, answer._replace(angle=True)] if has_angle else [answer]
        once.setdefault((answer.subject, answer.quantity.id), answers)
    return tuple(chain.from_iterable(once.values()))


def _named(case: Case, name: str, option: str) -> list[tuple[Answer, object]]:
    """Return (key value, its value for this machine: see `_holding`) for `c_max`, `LP.c_max`, or `machine.T_max`."""
    prefix, _, bare_name = name.rpartition(".")
    owner = _WHOLE if prefix == MACHINE else prefix
    ids = KEY_VALUES.ids_of(bare_name)
    wrong = ambiguity(bare_name, ids)
    if not ids or wrong:
        declared = every_quantity().all_key_values
        all_ids = tuple(quantity.id for quantity in declared)
        near = in_sentences(name, declared) or did_you_mean(name, all_ids)
        raise UsageError(f"{option}: {wrong or f'no key value {text_in_one_line(name)!r}{near}'}")
    for command in _commands_with(case, ids[0]):
        held = list(_holding(case, command, ids[0], owner))
        if held:
            return held
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
        if owner not in ("", subject.name, subject.identity):
            continue
        for quantity in subject.lists.key_values(command).values():
            is_wanted = quantity.id == id if id else not quantity.residual
            if not is_wanted:
                continue
            value: object = None
            try:
                if id or subject.is_printed(quantity):
                    value = subject.answer(quantity)
            except KurbelError as error:
                value = error
            if value is not None:
                part = subject.identity
                yield Answer(quantity, command, subject.name, bool(owner), part=part), value


# their values


def answered(
    binder: Binder, columns: Sequence[KeyColumn], requested: Sequence[Answer]
) -> list[DesignValues]:
    """Return the key values of the designs with these values of the keys of a binder.

    In older versions of numpy rounding depends on the length of an array, and so on the designs that are computed
    together: for the same digits of a row in every run, give the same rows each time.
    """
    batches, failures = binder.bound(columns)
    by_row = failures | answers_of(batches, requested)
    return [by_row[row] for row in range(len(columns[0].indices))]


def answers_of(batches: Sequence[Batch], requested: Sequence[Answer]) -> dict[int, DesignValues]:
    """Return the key values of each of many machines, by its row."""
    by_row: dict[int, DesignValues] = {}
    is_large = any(answer.command in _LARGE for answer in requested)
    most = _MOST_LARGE if is_large else _MOST
    for batch in batches:
        if not is_slow(batch.machine, requested):
            for start in range(0, len(batch.rows), most):
                indices = np.arange(start, min(start + most, len(batch.rows)))
                by_row |= _values_of_batch(batch, indices, requested)
        for index, row in enumerate(batch.rows):
            if row not in by_row:
                by_row[row] = answered_alone(batch.single(index), requested)
    return by_row


def is_slow(machine: Machine, requested: Sequence[Answer]) -> bool:
    """Return whether these key values are computed one machine after another, and not in batches.

    Torsion solves a matrix for each machine; formulas of some mechanisms take no arrays; a long card or a trace has
    so many pieces that it fills an array by itself.
    """
    if any(answer.command == "torsion" for answer in requested):
        return True
    if any(cylinder.mechanism.name not in _IN_BATCHES for cylinder in machine.cylinders):
        return True
    return any(chamber.traced or _is_long(chamber) for chamber in machine.chambers)


def _is_long(chamber: Chamber) -> bool:
    """Return whether a chamber has a card of very many points."""
    if not isinstance(chamber, Card):
        return False
    return sum(len(line.fractions) for line in chamber.lines) > _MOST_POINTS


def _values_of_batch(
    batch: Batch, indices: Indices, requested: Sequence[Answer]
) -> dict[int, DesignValues]:
    """Return the key values of a batch by its rows, without machines that fail or have a value that is not finite."""
    if len(indices) < _FEWEST:
        return {}
    machine = changed(batch.machine, lambda numbers: numbers[indices])
    try:
        columns, other_parts = _values(Case(machine, len(indices)), requested)
    except (KurbelError, ArithmeticError, RuntimeWarning):
        half = len(indices) // 2
        first = _values_of_batch(batch, indices[:half], requested)
        return first | _values_of_batch(batch, indices[half:], requested)

    # whether a crosshead locks itself is known of a single machine only
    is_good = np.ones(len(indices), dtype=bool)
    for cylinder in machine.cylinders:
        is_good &= ~np.asarray(may_lock(cylinder))
    values: list[Sequence[DesignValue]] = []
    for column in columns:
        if isinstance(column, tuple) and column and isinstance(column[0], tuple):
            values.append(column)  # a list of each machine
        elif column is None or isinstance(column, tuple):
            values.append([column] * len(indices))
        else:
            is_good &= np.isfinite(column)
            values.append(np.broadcast_to(column, is_good.shape).tolist())
    by_row: dict[int, DesignValues] = {}
    for index, design, good in zip(indices.tolist(), zip(*values), is_good.tolist()):
        if good:
            by_row[batch.rows[index]] = Row(design, other_parts)
    return by_row


def answered_alone(machine: Machine, requested: Sequence[Answer]) -> DesignValues:
    """Return the key values of a machine by itself."""
    try:
        values, other_parts = _values(Case(machine), requested)
        for answer, value in zip(requested, values):
            if value is not None and not np.isfinite(value).all():
                raise too_large(answer.quantity)
    except KurbelError as error:
        return error.reason
    except ArithmeticError as error:
        return f"numeric overflow ({error})"
    return Row(values, other_parts)


def _values(case: Case, requested: Sequence[Answer]) -> tuple[list[Any], str]:
    """Return the values of a case of one machine or of many, in SI, and how its parts differ; raises KurbelError."""
    subjects: dict[tuple[str, str], Subject] = {}
    for command in dict.fromkeys(answer.command for answer in requested):
        for subject in subjects_of(case, command, pistons=True):
            subjects[command, subject.identity] = subject
    values = []
    for answer in requested:
        owner = subjects.get(answer.key)
        value = owner.answer(answer.quantity) if owner else None
        if answer.angle:
            values.append(value.degrees if isinstance(value, Extreme) else None)
        else:
            values.append(number_of(value))
    return values, _other_parts(subjects, requested)


def _other_parts(subjects: Mapping[tuple[str, str], Subject], requested: Sequence[Answer]) -> str:
    """Return which of the requested parts a machine does not have, and which others have their key values; or ''.

    subjects: those of a machine by command and identity.
    """
    keys = {answer.key for answer in requested}
    pistons = set[int]()
    for subject in subjects.values():
        pistons.update(map(id, subject.pistons))
    others: list[str] = []
    for (command, identity), subject in subjects.items():
        if (command, identity) in keys or subject.whole or id(subject) in pistons:
            continue
        quantities = {}
        for answer in requested:
            is_of_parts = not answer.alone and answer.subject != _WHOLE
            if answer.command == command and is_of_parts:
                quantities[answer.quantity.id] = answer.quantity
        if any(subject.answer(quantity) is not None for quantity in quantities.values()):
            others.append(subject.identity)

    missing = [answer.key[1] for answer in requested if answer.key not in subjects]
    texts = []
    if missing:
        texts.append(f"no {_quoted(missing)}")
    if others:
        texts.append(f"but {_quoted(others)}")
    if not texts:
        return ""
    return f"it has other parts: {', '.join(texts)}"


def _quoted(names: Iterable[str]) -> str:
    """Return names for a sentence, each once."""
    return ", ".join(f"'{name}'" for name in dict.fromkeys(names))


# the machine file of which keys vary

Cell = Union[DesignValue, str]
"""A value of a row; a text for an input that is a word."""


class Head(NamedTuple):
    """A column of a table of designs: its id, and the unit of its values, '' for none.

    kind: of the values, '' of texts; input: whether it is a key that varies; listed: each value is a list. zero: what
    pressures count from, see `Quantity.zero`.
    """

    id: str
    unit: str = ""
    kind: str = ""
    input: bool = False
    listed: bool = False
    zero: str = ""


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
        answered = answered_alone(self.binder.machine, self.answers)
        if isinstance(answered, str):
            return [None] * len(self.answers)
        return answered.values

    def heads(self, system: str) -> list[Head]:
        """Return the heads of the key values in a system of units, which the values of the first machine decide.

        An id has the name of its subject before it if it is one of several, or was requested of this subject alone.
        """
        values: Iterable[float] = [0.0] * len(self.answers)
        if system != "si":
            values = map(size_of, self.first)
        sizes = [
            (answer.kind, answer.quantity.family, size)
            for answer, size in zip(self.answers, values)
        ]
        ids = [answer.quantity.id for answer in self.answers if not answer.angle]
        heads = []
        for answer, unit in zip(self.answers, units_of(sizes, system)):
            quantity = answer.quantity
            id = f"{quantity.id}_at" if answer.angle else quantity.id
            if answer.alone or ids.count(quantity.id) > 1:
                id = f"{answer.owner}.{id}"
            head = Head(id, unit, answer.kind, listed=quantity.listed, zero=quantity.zero)
            heads.append(head)
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
        judged = {limit.name for limit, value in zip(self.limits, values) if value is not None}
        broken, unjudged = dict[str, None](), dict[str, None]()
        for (name, answer, bound), value in zip(self.limits, values):
            if isinstance(value, (int, float)) and breaks(answer.quantity, bound, value):
                broken[name] = None
            if name not in judged:
                unjudged[f"limits.{name}: {no_such_value(name, answer.quantity.id)}"] = None
        return tuple(broken), tuple(unjudged)


def _limits_of(machine: Machine) -> Iterator[Limit]:
    """Yield the limits of the file, each for every subject that it applies to; raises UsageError if there is none."""
    case = Case(machine)
    for name, bound in machine.limits:
        try:
            with np.errstate(all="ignore"):
                of_limit = holders(case, name)
        except UsageError as error:
            raise UsageError(f"limits.{name}: {error}") from None
        if not of_limit:
            raise UsageError(f"limits.{name}: {no_such_value(name, scoped(name)[1])}")
        for holder in of_limit:
            subject = holder.subject
            answer = Answer(
                holder.quantity, holder.command, subject.name, alone=True, part=subject.identity
            )
            yield Limit(name, answer, bound)
