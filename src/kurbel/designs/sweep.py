"""A sweep: rows of inputs and answers, computed chunk by chunk in their order, here or by other processes."""

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from kurbel.declared.forms.figures import scoped
from kurbel.declared.unit_systems import SI, convert, shown_unit, units_of
from kurbel.declared.units import parse_quantity, plain_quantities
from kurbel.designs.answers import Answer, Values, answers_of, asked_answers, is_slow
from kurbel.designs.binding import Binder, CasesBinder, written_texts
from kurbel.designs.plan import Input, Plan, read_axis
from kurbel.errors import KurbelError, MachineFileError, NoSolutionError, UsageError
from kurbel.machine import Machine
from kurbel.machine.batch import Lot
from kurbel.machine.origin import Origin
from kurbel.machine_file.given import case_names
from kurbel.numerics.extreme import size_of
from kurbel.report.limits import breaks, holders, without
from kurbel.solver.case import Case

CHUNK = 1000
"""Rows that are computed together: what memory holds at once, and what a run computes anew that begins amid them."""
_FIRST = 20
"""Rows of the first chunk, so that a reader sees something at once."""
_SLOWLY = 10
"""Rows that are handed over together where they are answered one after another."""
_STARTS = 100
"""Rows that are tried for one that makes a machine."""
_GOLDEN = (5**0.5 - 1) / 2


class Spec(NamedTuple):
    """All that a sweep is made of, in texts, so that any process can make it anew.

    vary: `KEY=…` each, or several that go together; given: inputs beside these. columns: ids or symbols; with_angles:
    beside extremes the angle where each stands; system: of units; most: rows, None for any number; cases: of every load
    case of the file; the others: see `Plan`.
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
    """A column of the table: its id, the unit of its values, '' for none; input: whether it is what varies.

    kind: of the values, '' of texts; listed: whether each is a list of values.
    """

    id: str
    unit: str
    input: bool
    kind: str = ""
    listed: bool = False


class Row(NamedTuple):
    """One design: its number from 1 on, values under the heads (texts, numbers, tuples or None), and why it has none.

    keeps: whether all limits of the file are kept, None where there are none; broken: the first one that is not.
    """

    number: int
    values: tuple[Any, ...]
    keeps: bool | None = None
    broken: str = ""
    failure: str = ""

    def text(self, name: str) -> str:
        """Return what stands in the row under `keeps`, `broken` or `failure`."""
        return KEPT[self.keeps] if name == "keeps" else str(getattr(self, name))


KEPT = {True: "yes", False: "no", None: ""}
"""What is told of limits that are kept, are not, and cannot be judged."""


class _Limit(NamedTuple):
    """A limit of the file by its name, and the answer that its bound is for."""

    name: str
    answer: Answer
    bound: float


class Sweep:
    """Rows of one machine; heads: what stands over their values. Raises UsageError for what makes none."""

    def __init__(self, spec: Spec) -> None:
        self.spec = spec
        cases = [(Input("case", case_names(spec.origin)),)] if spec.cases else []
        axes = [*cases, *map(read_axis, spec.vary), *((one,) for one in spec.given)]
        self.plan = Plan(axes, spec.side_by_side, spec.sample, spec.seed)
        self.rows = self.plan.rows
        if spec.most and self.rows > spec.most:
            raise UsageError(f"these are {self.rows} rows; --yes computes more than {spec.most}")
        self._binder, self.asked, self._limits = self._started()
        self.limited = bool(self._binder.machine.limits)
        self.texts = ("keeps", "broken", "failure") if self.limited else ("failure",)
        """Heads of the texts after the values, as `Row.text` tells them."""

    def _started(self) -> tuple[Binder | CasesBinder, tuple[Answer, ...], tuple["_Limit", ...]]:
        """Return what binds texts, starting from the first row whose machine tells what it answers, and who answers.

        That is what is asked for, and what limits are for, with their bounds.
        """
        keys = [one.key for one in self.plan.inputs]
        failed: list[KurbelError] = []
        for texts in self._starts(keys):
            try:
                binder = (CasesBinder if self.spec.cases else Binder)(self.spec.origin, keys, texts)
                asked = asked_answers(binder.machine, self.spec.columns, self.spec.with_angles)
                return binder, asked, tuple(limit_answers(binder.machine))
            except (MachineFileError, NoSolutionError) as error:
                failed.append(error)
        raise failed[0] if isinstance(failed[0], NoSolutionError) else UsageError(str(failed[0]))

    def _starts(self, keys: Sequence[str]) -> Iterator[Sequence[str]]:
        """Yield texts that may make a machine: those of the file of one that was read, and rows of the whole plan."""
        if self.spec.given:
            yield written_texts(self.spec.origin, keys)
        if self.rows <= _STARTS:
            yield from map(self.plan.texts, range(self.rows))
        else:  # by the golden section: all over the plan, and not at the same value of a key each time
            yield from (self.plan.texts(int(self.rows * (number * _GOLDEN % 1))) for number in range(_STARTS))

    @cached_property
    def heads(self) -> tuple[Head, ...]:
        """What stands over the values."""
        ids = [one.quantity.id for one in self.asked if not one.angle]
        heads = [self._input_head(number, one) for number, one in enumerate(self.plan.inputs)]
        for one, unit in zip(self.asked, self._units):
            owned = one.alone or ids.count(one.quantity.id) > 1
            name = f"{one.subject}.{one.quantity.id}" if owned else one.quantity.id
            heads.append(Head(f"{name}_at" if one.angle else name, unit, False, one.kind, one.quantity.listed))
        return tuple(heads)

    def _input_head(self, number: int, one: Input) -> Head:
        kind = self._binder.kinds[number]
        first = _in_base([self.plan.texts(0)[number]], kind)[0] or 0.0
        return Head(one.key, shown_unit(kind, self.spec.system, first) if kind else "", True, kind)

    def types(self) -> list[str]:
        """Return what stands under the heads: `number`, `list`, or `text`, also where words stand among numbers."""
        wordy = [
            one.distribution is None and None in _in_base(one.texts, kind)
            for one, kind in zip(self.plan.inputs, self._binder.kinds)
        ]
        answers = self.heads[len(wordy) :]
        return [
            *("text" if one else "number" for one in wordy),
            *("list" if one.listed else "number" for one in answers),
        ]

    @cached_property
    def _units(self) -> tuple[str, ...]:
        """Units of the answers, from the sizes that the first machine has."""
        if self.spec.system == "si":
            return tuple(SI[one.kind] for one in self.asked)
        first = answers_of([Lot(self._binder.machine, (0,))], self.asked)[0]
        sizes = [0.0] * len(self.asked) if isinstance(first, str) else map(size_of, first)
        sized = [(one.kind, one.quantity.family, size) for one, size in zip(self.asked, sizes, strict=True)]
        return tuple(units_of(sized, self.spec.system))

    def chunk(self, company: range, wanted: range) -> list[Row]:
        """Return the wanted rows of a chunk, counted from 0."""
        texts = [self.plan.texts(row) for row in company]
        bound = self._binder.bound(texts)
        own = range(wanted.start - company.start, wanted.stop - company.start)
        found = bound.failures | answers_of(bound.lots, (*self.asked, *(one.answer for one in self._limits)), own)
        inputs = list(self._inputs(texts))
        values = iter(self._values([found[row] for row in own if not isinstance(found[row], str)]))
        return [self._row(number + 1, inputs[row], found[row], values) for row, number in zip(own, wanted)]

    def _row(self, number: int, inputs: tuple[Any, ...], found: Values, values: Iterator[tuple[Any, ...]]) -> Row:
        if isinstance(found, str):
            return self._unanswered(number, inputs, found)
        return Row(number, (*inputs, *next(values)), *self._judged(found[len(self.asked) :]))

    def inputs(self, rows: Iterable[int]) -> Iterable[tuple[Any, ...]]:
        """Return what is under the heads of the inputs in these rows, counted from 0: it is known unsolved."""
        return self._inputs([self.plan.texts(row) for row in rows])

    def _unanswered(self, number: int, inputs: tuple[Any, ...], failure: str = "") -> Row:
        return Row(number, (*inputs, *[None] * (len(self.heads) - len(inputs))), failure=failure)

    def _inputs(self, rows: Sequence[Sequence[str]]) -> Iterable[tuple[Any, ...]]:
        """Return what stands under the heads of the inputs, row by row, of the texts (rows, inputs)."""
        return zip(*(_input_values(*one) for one in zip(self.heads, zip(*rows))))

    def _values(self, found: Sequence[Sequence[Any]]) -> Iterable[tuple[Any, ...]]:
        """Return what stands under the heads of the answers, row by row, of the answers (rows, asked) in SI."""
        columns = zip(self.asked, self._units, zip(*found))
        return zip(*(_column_in_unit(column, one.kind, unit) for one, unit, column in columns))

    def _judged(self, found: Sequence[Any]) -> tuple[bool | None, str, str]:
        """Return whether the limits are kept, the first that is not, and which cannot be judged."""
        there = [(one, value) for one, value in zip(self._limits, found) if value is not None]
        broken = next((one.name for one, value in there if breaks(one.answer.quantity, one.bound, value)), "")
        known = {one.name for one, _ in there}
        unknown = {one.name: one.answer.quantity.id for one in self._limits if one.name not in known}
        keeps = None if not self.limited or (unknown and not broken) else not broken
        return keeps, broken, "; ".join(f"limits.{name}: {without(name, id)}" for name, id in unknown.items())

    def chunks(self, rows: range) -> Iterator[tuple[range, range]]:
        """Yield the chunks that these rows are computed in, each with those rows that are wanted of it.

        A row has the same company in every run, since its last digits may hang on how many are computed with it.
        """
        for start in range(rows.start - rows.start % CHUNK, rows.stop, CHUNK):
            cuts = (start, start + CHUNK) if start else (0, _FIRST, CHUNK)
            for low, high in pairwise(cuts):
                for first in range(max(low, rows.start), min(high, rows.stop), self._at_once):
                    last = min(first + self._at_once, high, rows.stop)
                    yield range(low, min(high, self.rows)), range(first, last)

    @cached_property
    def _at_once(self) -> int:
        """Rows that are answered and handed over at once: few where each takes long."""
        every = (*self.asked, *(one.answer for one in self._limits))
        return _SLOWLY if any(is_slow(self._binder.machine, one) for one in every) else CHUNK


def _input_values(head: Head, texts: Sequence[str]) -> list[Any]:
    """Return what stands under the head of an input in rows of these texts: numbers in its unit, or words."""
    different = list(dict.fromkeys(texts))
    values = zip(different, _in_base(different, head.kind))
    known = {text: text if value is None else _in_unit(value, head.kind, head.unit) for text, value in values}
    return [known[text] for text in texts]


def _in_base(texts: Sequence[str], kind: str) -> Sequence[float | None]:
    """Return the values of texts in the base of their kind; None for a word, or what a row fails for."""
    if not kind:
        return [None] * len(texts)
    return plain_quantities(texts, kind) or [_one_in_base(text, kind) for text in texts]


def _one_in_base(text: str, kind: str) -> float | None:
    try:
        return parse_quantity(text, kind)
    except KurbelError:
        return None


def _column_in_unit(column: Sequence[Any], kind: str, unit: str) -> list[Any]:
    if set(map(type, column)) == {float}:  # as most are
        return (convert(np.array(column), kind, unit) + 0.0).tolist()  # type: ignore[no-any-return]
    return [_in_unit(value, kind, unit) for value in column]


def _in_unit(number: Any, kind: str, unit: str) -> Any:
    if isinstance(number, tuple):
        return tuple(convert(part, kind, unit) + 0.0 for part in number)
    return None if number is None else convert(number, kind, unit) + 0.0


def limit_answers(machine: Machine) -> Iterable[_Limit]:
    """Yield whose value each limit of the file is for, with its bound; raises UsageError where nobody has it."""
    case = Case(machine)
    for name, bound in machine.limits:
        try:
            with np.errstate(all="ignore"):
                found = holders(case, name)
        except UsageError as error:
            raise UsageError(f"limits.{name}: {error}") from None
        if not found:
            raise UsageError(f"limits.{name}: {without(name, scoped(name)[1])}")
        yield from (_Limit(name, Answer(one.quantity, one.command, one.subject.name), bound) for one in found)


_sweep = lru_cache(maxsize=4)(Sweep)


def computed(spec: Spec, company: range, wanted: range) -> list[Row]:
    """Return rows of a sweep, in whatever process; a sweep is made once in each."""
    return _sweep(spec).chunk(company, wanted)
