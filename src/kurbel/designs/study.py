"""A machine file of which keys vary: the key values that are requested of its designs, and the limits they break."""

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from typing import NamedTuple, Union

import numpy as np

from kurbel.declared.forms.figures import scoped
from kurbel.declared.unit_systems import units_of
from kurbel.designs.answers import Answer, Value, answered, answered_alone, requested_answers
from kurbel.designs.binding import Binder
from kurbel.errors import KurbelError, MachineFileError, UsageError
from kurbel.machine import Machine
from kurbel.machine.origin import Origin
from kurbel.numerics.extreme import size_of
from kurbel.report.limits import breaks, holders, without
from kurbel.solver.case import Case

Cell = Union[Value, str]
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


class Found(NamedTuple):
    """The key values of a design in SI, or why it fails.

    broken: names of the limits that it breaks; unjudged: the limits that cannot be judged, each with the reason.
    """

    values: Sequence[Value] = ()
    failure: str = ""
    broken: tuple[str, ...] = ()
    unjudged: tuple[str, ...] = ()


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
                self.every = (*self.answers, *(one.answer for one in self.limits))
                return
            except KurbelError as error:
                failed.append(error)
                if isinstance(error, UsageError) and str(error) in map(str, failed[:-1]):
                    raise  # the request is wrong, not these texts
        raise UsageError(str(failed[0])) if isinstance(failed[0], MachineFileError) else failed[0]

    @cached_property
    def first(self) -> Sequence[Value]:
        """The key values of the first valid machine."""
        found = answered_alone(self.binder.machine, self.answers)
        return [None] * len(self.answers) if isinstance(found, str) else found

    def heads(self, system: str) -> list[Head]:
        """Return the heads of the key values in a system of units, which the values of the first machine decide.

        An id has the name of its subject before it if it is one of several, or was requested of this subject alone.
        """
        sizes = [0.0] * len(self.answers) if system == "si" else map(size_of, self.first)
        units = units_of([(one.kind, one.quantity.family, size) for one, size in zip(self.answers, sizes)], system)
        ids = [one.quantity.id for one in self.answers if not one.angle]
        heads = []
        for one, unit in zip(self.answers, units):
            id = f"{one.quantity.id}_at" if one.angle else one.quantity.id
            owned = one.alone or ids.count(one.quantity.id) > 1
            heads.append(Head(f"{one.owner}.{id}" if owned else id, unit, one.kind, listed=one.quantity.listed))
        return heads

    def of(self, rows: Sequence[Sequence[str]]) -> list[Found]:
        """Return what the designs with these texts (rows, keys) give; for the same digits give the same rows."""
        count = len(self.answers)
        return [
            Found(failure=values)
            if isinstance(values, str)
            else Found(values[:count], "", *self._judged(values[count:]))
            for values in answered(self.binder, rows, self.every)
        ]

    def _judged(self, values: Sequence[Value]) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return the limits that are broken, and those that cannot be judged; values: one for each limit."""
        known = {limit.name for limit, value in zip(self.limits, values) if value is not None}
        broken = [
            name
            for (name, answer, bound), value in zip(self.limits, values)
            if isinstance(value, (int, float)) and breaks(answer.quantity, bound, value)
        ]
        unjudged = [
            f"limits.{name}: {without(name, answer.quantity.id)}"
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
            raise UsageError(f"limits.{name}: {without(name, scoped(name)[1])}")
        yield from (Limit(name, Answer(one.quantity, one.command, one.subject.name), bound) for one in found)
