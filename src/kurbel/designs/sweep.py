"""A sweep: rows of inputs and key values, computed in order, chunk by chunk, here or by other processes."""

import re
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import cached_property, lru_cache
from itertools import chain, pairwise
from typing import NamedTuple, TypeVar, Union

import numpy as np

from kurbel.declared.forms.figures import scoped
from kurbel.declared.unit_systems import SI, convert, shown_unit, units_of
from kurbel.declared.units import parse_quantity, plain_quantities
from kurbel.designs.answers import Answer, Value, answers_of, is_slow, requested_answers
from kurbel.designs.binding import Batch, Binder, written_texts
from kurbel.designs.plan import Input, Plan, read_axis
from kurbel.errors import KurbelError, MachineFileError, UsageError
from kurbel.machine import Machine
from kurbel.machine.cylinder import gathered, work_alike
from kurbel.machine.origin import Origin
from kurbel.machine_file.overrides import case_names
from kurbel.numerics.extreme import size_of
from kurbel.report.alike import grouped, together
from kurbel.report.limits import breaks, holders, without
from kurbel.solver.case import Case

CHUNK = 1000
"""Rows computed together; a run that starts within a chunk computes the chunk from its beginning."""
_FIRST = 20
"""Rows of the first chunk, so that the first lines appear soon."""
_SLOWLY = 10
"""Rows returned together if machines are computed one after another."""
_STARTS = 100
"""Rows in which the first valid machine is searched for."""
_GOLDEN = (5**0.5 - 1) / 2

Found = TypeVar("Found")
Cell = Union[Value, str]
"""A value of a row; a text for an input that is a word."""


class Spec(NamedTuple):
    """All that defines a sweep, as texts, so that it can be passed to other processes.

    vary: one or several `KEY=…` each that change together; given: further inputs. columns: ids or symbols; with_angles:
    next to each extreme its crank angle; system: of units; most: largest number of rows, None for any; cases: all load
    cases of the file; the others: see `Plan`.
    """

    origin: Origin
    vary: tuple[str, ...] = ()
    side_by_side: bool = False
    sample: int | None = None
    seed: int = 0
    columns: tuple[str, ...] = ()
    with_angles: bool = False
    system: str = "si"
    given: tuple[Input, ...] = ()
    most: int | None = None
    cases: bool = False


class Head(NamedTuple):
    """A column of the table: its id, and the unit of its values, '' for none.

    input: whether it is an input of the sweep; kind: of the values, '' of texts; listed: each value is a list.
    """

    id: str
    unit: str
    input: bool
    kind: str = ""
    listed: bool = False


class Design(NamedTuple):
    """One design: its number from 1, and the values of the columns (texts, numbers, tuples or None).

    keeps: whether all limits of the file are kept, None if it has none or one cannot be judged; broken: the first limit
    that is not kept; failure: why there are no values, or which limits cannot be judged.
    """

    number: int
    values: tuple[Cell, ...]
    keeps: bool | None = None
    broken: str = ""
    failure: str = ""

    def text(self, name: str) -> str:
        """Return the text of the column `keeps`, `broken` or `failure`."""
        return KEPT[self.keeps] if name == "keeps" else str(getattr(self, name))


KEPT = {True: "yes", False: "no", None: ""}
"""The text for limits that are kept, are not kept, and cannot be judged."""


class Limit(NamedTuple):
    """A limit: its name in the file, the key value, and the bound in SI."""

    name: str
    answer: Answer
    bound: float


class Sweep:
    """The rows of one machine file. Raises UsageError for options that define no sweep."""

    def __init__(self, spec: Spec) -> None:
        self.spec = spec
        cases = [(Input("case", case_names(spec.origin)),)] if spec.cases else []
        axes = [*cases, *map(read_axis, spec.vary), *((one,) for one in spec.given)]
        self.plan = Plan(axes, spec.side_by_side, spec.sample, spec.seed)
        self.rows = self.plan.rows
        if spec.most and self.rows > spec.most:
            raise UsageError(f"these are {self.rows} rows; --yes computes more than {spec.most}")
        self._keys = [one.key for one in self.plan.inputs]
        self._binder, self.requested, self._limits = self._started(self._keys)
        self._every = (*self.requested, *(one.answer for one in self._limits))
        self.limited = bool(self._binder.machine.limits)
        self.texts = ("keeps", "broken", "failure") if self.limited else ("failure",)
        """Names of the columns of texts after the values; see `Design.text`."""

    def _started(self, keys: Sequence[str]) -> tuple[Binder, tuple[Answer, ...], list[Limit]]:
        """Return the binder, the requested key values, and the limits.

        The first valid machine is searched for in the texts of the file itself and in rows of the whole plan.
        """
        rows: Iterable[int] = range(self.rows)
        if self.rows > _STARTS:
            # steps of the golden section: all over the plan, without repeating the same value of a key
            rows = (int(self.rows * (number * _GOLDEN % 1)) for number in range(_STARTS))
        starts = chain([written_texts(self.spec.origin, keys)] if self.spec.given else [], map(self.plan.texts, rows))

        def answers(machine: Machine) -> tuple[tuple[Answer, ...], list[Limit]]:
            return requested_answers(machine, self.spec.columns, self.spec.with_angles), list(limits_of(machine))

        binder, (requested, limits) = begun(self.spec.origin, keys, starts, answers, self.spec.cases)
        return binder, requested, limits

    @cached_property
    def heads(self) -> tuple[Head, ...]:
        """The heads of the columns."""
        ids = [one.quantity.id for one in self.requested if not one.angle]
        heads = []
        for key, text, kind in zip(self._keys, self.plan.texts(0), self._binder.kinds):
            first = _in_base([text], kind)[0] or 0.0
            heads.append(Head(key, shown_unit(kind, self.spec.system, first) if kind else "", True, kind))
        for one, unit in zip(self.requested, self._units):
            owned = one.alone or ids.count(one.quantity.id) > 1
            name = f"{one.subject}.{one.quantity.id}" if owned else one.quantity.id
            heads.append(Head(f"{name}_at" if one.angle else name, unit, False, one.kind, one.quantity.listed))
        return tuple(heads)

    @cached_property
    def shown(self) -> list[tuple[str, int]]:
        """The heads for people, each with the index of its column: one for the key values of identical cylinders.

        Identical cylinders have equal values in all rows, unless the load case or a key of a single cylinder varies.
        """
        heads = [(head.id, place) for place, head in enumerate(self.heads)]
        cylinders = self._binder.machine.cylinders
        if self.spec.cases or any(re.match(r"cylinders\W*\d", key) for key in self._keys):
            return heads
        alike = {one.name: number for number, group in enumerate(gathered(cylinders, work_alike)) for one in group}
        values = answers_of([Batch(self._binder.machine, (0,))], self.requested)[0]
        owned = dict(zip(range(len(self._keys), len(heads)), zip(self.requested, values)))

        def content(head: tuple[str, int]) -> Hashable:
            answer, value = owned.get(head[1], (None, None))
            if answer is None or not isinstance(value, float):
                return head
            what, _, owner = answer.subject.rpartition(" of ")
            return (what, alike[owner], answer.quantity.id, answer.angle, f"{value:.9g}") if owner in alike else head

        def called(group: list[tuple[str, int]]) -> str:
            names = [owned[place][0].subject for _, place in group]
            return f"{together(names)}.{group[0][0].rpartition('.')[2]}"

        groups = grouped(heads, content)
        return [(called(group) if len(group) > 1 else group[0][0], group[0][1]) for group in groups]

    def types(self) -> list[str]:
        """Return the type of each column: `number`, `list`, or `text`, also where words occur among numbers."""
        inputs = zip(self.plan.inputs, self._binder.kinds)
        wordy = [one.distribution is None and None in _in_base(one.texts, kind) for one, kind in inputs]
        answers = ["list" if one.quantity.listed else "number" for one in self.requested]
        return [*("text" if one else "number" for one in wordy), *answers]

    @cached_property
    def _units(self) -> tuple[str, ...]:
        """Units of the key values, chosen by their sizes for the first machine."""
        if self.spec.system == "si":
            return tuple(SI[one.kind] for one in self.requested)
        first = answers_of([Batch(self._binder.machine, (0,))], self.requested)[0]
        sizes = [0.0] * len(self.requested) if isinstance(first, str) else map(size_of, first)
        sized = [(one.kind, one.quantity.family, size) for one, size in zip(self.requested, sizes, strict=True)]
        return tuple(units_of(sized, self.spec.system))

    def chunk(self, together: range, wanted: range) -> list[Design]:
        """Return the wanted rows of a chunk, counted from 0."""
        own = range(wanted.start - together.start, wanted.stop - together.start)
        bound = self._binder.bound([self.plan.texts(row) for row in together], own)
        found = bound.failures | answers_of(bound.batches, self._every, own)
        answered = {row: each for row in own if not isinstance(each := found[row], str)}
        columns = zip(zip(*answered.values()), self.requested, self._units)
        values = dict(zip(answered, zip(*(_in_unit(column, one.kind, unit) for column, one, unit in columns))))
        rows = []
        for number, inputs in zip(wanted, self.inputs(wanted)):
            row = number - together.start
            if row in answered:
                keeps, broken, unjudged = self._judged(answered[row][len(self.requested) :])
                rows.append(Design(number + 1, (*inputs, *values[row]), keeps, broken, unjudged))
            else:
                rows.append(Design(number + 1, (*inputs, *[None] * len(self.requested)), failure=str(found[row])))
        return rows

    def inputs(self, rows: Iterable[int]) -> Iterable[tuple[Cell, ...]]:
        """Return the values of the inputs in these rows, counted from 0."""
        columns = []
        for head, texts in zip(self.heads, zip(*map(self.plan.texts, rows))):
            different = list(dict.fromkeys(texts))
            values = _in_unit(_in_base(different, head.kind), head.kind, head.unit)
            known = {text: text if value is None else value for text, value in zip(different, values)}
            columns.append([known[text] for text in texts])
        return zip(*columns)

    def _judged(self, found: Sequence[Value]) -> tuple[bool | None, str, str]:
        """Return whether the limits are kept, the first that is not, and which cannot be judged."""
        broken = next(broken_of(self._limits, found), "")
        known = {limit.name for limit, value in zip(self._limits, found) if value is not None}
        unknown = {name: one.quantity.id for name, one, _ in self._limits if name not in known}
        keeps = None if not self.limited or (unknown and not broken) else not broken
        return keeps, broken, "; ".join(f"limits.{name}: {without(name, id)}" for name, id in unknown.items())

    def chunks(self, rows: range) -> Iterator[tuple[range, range]]:
        """Yield the chunks in which these rows are computed, each with the rows that are wanted of it.

        A row is computed together with the same rows in every run, since its last digits may depend on their number.
        """
        for start in range(rows.start - rows.start % CHUNK, rows.stop, CHUNK):
            cuts = (start, start + CHUNK) if start else (0, _FIRST, CHUNK)
            for low, high in pairwise(cuts):
                for first in range(max(low, rows.start), min(high, rows.stop), self._at_once):
                    last = min(first + self._at_once, high, rows.stop)
                    yield range(low, min(high, self.rows)), range(first, last)

    @cached_property
    def _at_once(self) -> int:
        """Rows computed and returned together: few if each takes long."""
        return _SLOWLY if any(is_slow(self._binder.machine, one) for one in self._every) else CHUNK


def begun(
    origin: Origin,
    keys: Sequence[str],
    starts: Iterable[Sequence[str]],
    answers: Callable[[Machine], Found],
    cases: bool = False,
) -> tuple[Binder, Found]:
    """Return the binder of the first texts that give a valid machine, and the result of `answers` for that machine.

    Raises the error of the first texts if none are valid, or the first error that occurs for two of them.
    """
    failed: list[KurbelError] = []
    for texts in starts:
        try:
            binder = Binder(origin, keys, texts, cases)
            return binder, answers(binder.machine)
        except KurbelError as error:
            failed.append(error)
            if isinstance(error, UsageError) and str(error) in map(str, failed[:-1]):
                raise  # the request is wrong, not these texts
    raise UsageError(str(failed[0])) if isinstance(failed[0], MachineFileError) else failed[0]


def _in_base(texts: Sequence[str], kind: str) -> Sequence[float | None]:
    """Return the values of texts in the base unit of their kind; None for a word or an unreadable number."""
    found: list[float | None] = [None] * len(texts)
    if not kind:
        return found
    if plain := plain_quantities(texts, kind):
        return plain
    for place, text in enumerate(texts):
        with suppress(KurbelError):
            found[place] = parse_quantity(text, kind)
    return found


def _in_unit(column: Sequence[Value], kind: str, unit: str) -> list[Value]:
    """Return values of a kind in a unit; lists as tuples, None for a missing value."""
    if set(map(type, column)) == {float}:  # the usual case
        return (convert(np.array(column), kind, unit) + 0.0).tolist()

    def converted(value: Value) -> Value:
        if isinstance(value, tuple):
            return tuple(convert(part, kind, unit) + 0.0 for part in value)
        return None if value is None else convert(value, kind, unit) + 0.0

    return list(map(converted, column))


def limits_of(machine: Machine) -> Iterator[Limit]:
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


def broken_of(limits: Sequence[Limit], values: Sequence[Value]) -> Iterator[str]:
    """Yield the names of the limits that these values break; values: one for each limit, None if there is none."""
    for (name, one, bound), value in zip(limits, values):
        if not (value is None or isinstance(value, tuple)) and breaks(one.quantity, bound, value):
            yield name


_sweep = lru_cache(maxsize=4)(Sweep)


def computed(spec: Spec, together: range, wanted: range) -> list[Design]:
    """Return rows of a sweep, in any process; each process makes a sweep only once."""
    return _sweep(spec).chunk(together, wanted)
