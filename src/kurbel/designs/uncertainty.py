"""What standard uncertainties of the inputs make of the key values, u² = Σ (∂y/∂x u_x)², and which input it comes from.

The derivatives by an input are differences of the solver's answers, which are exact but for rounding: at four places
beside the value, extrapolated to none (Richardson).
Where an answer bends over the width of an uncertainty, so that its first order does not hold, a sample tells instead.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from statistics import NormalDist
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np

from kurbel.declared.numerals import parse_ratio
from kurbel.declared.reading import shown
from kurbel.declared.unit_systems import SI, convert, units_of
from kurbel.declared.units import parse_quantity
from kurbel.designs.answers import Answer, Values, answers_of, is_slow
from kurbel.designs.binding import Binder, written
from kurbel.designs.plan import latin_hypercube
from kurbel.errors import Fault, UnitError, UsageError
from kurbel.machine import Machine
from kurbel.machine.origin import Origin
from kurbel.machine_file.events import located
from kurbel.machine_file.given import tree_of
from kurbel.machine_file.overrides import path_of
from kurbel.report.frame import subjects_of
from kurbel.report.tables import Column, Part, PlaceTable, Report
from kurbel.solver.case import Case

if TYPE_CHECKING:
    from kurbel.accuracy.trials import Difference

SAMPLE, SLOW_SAMPLE = 2000, 200
"""Machines that are drawn where the first order does not hold: side by side, and where each is answered alone."""
_AT_ONCE, _SLOWLY = 200, 10
"""Of these the machines that are held, and told of, at once: a measured trace of each may be large."""
_STEP = 0.1
"""Of an uncertainty: the outer difference; the inner one is half of it."""
_BEND = 0.1
"""What the second order may be beside the first one."""
_ROUNDING = 1e-9
"""What is less than this beside the value itself bends nothing."""


Found = TypeVar("Found")
Counted = Callable[[Sequence[Any]], Iterable[Any]]
"""Yields what it is given, and may tell on the way how much of it is left."""

_NOISE = 1e-12
"""Of a value: what is less is no uncertainty but rounding."""


class Uncertain(NamedTuple):
    """The standard uncertainty of a key value in SI, and the share of each input in its square.

    sample: from how many drawn machines both are told, 0 where they are of first order; failed: of how many no answer
    came, and why, '' where all have one.
    """

    answer: Answer
    value: float
    spread: float
    shares: tuple[float, ...]
    sample: int = 0
    failed: str = ""


class WrongUncertainty(UsageError):
    """What is wrong with uncertainties; faults: dotted key -> message."""

    def __init__(self, faults: dict[str, str]) -> None:
        self.faults = faults
        super().__init__("; ".join(f"uncertainty of {key}: {message}" for key, message in faults.items()))


class Uncertainty:
    """What uncertain inputs make of key values; spreads: dotted key -> `0.2 mm` or `2 %`, its standard uncertainty.

    Raises WrongUncertainty for keys under which no number stands, and for units that do not fit: all of them.
    """

    def __init__(self, origin: Origin, spreads: Mapping[str, str]) -> None:
        tree, wrong = tree_of(origin), dict[str, str]()
        first = {path_of(key): key for key in reversed([*spreads])}
        wrong |= {key: "this key is given twice" for key in spreads if key not in first.values()}
        texts = _of_each(spreads, lambda key: written(tree, key), wrong)
        self.keys = tuple(texts)
        self._binder = Binder(origin, self.keys, list(texts.values()))
        kinds = dict(zip(self.keys, self._binder.kinds))
        values = _of_each(self.keys, lambda key: _number(texts[key], kinds[key]), wrong)
        self._values = list(values.values())
        widths = _of_each(values, lambda key: _spread(spreads[key], kinds[key], values[key]), wrong)
        self._spreads = list(widths.values())
        if wrong:
            raise WrongUncertainty(wrong)

    def _texts(self, shifts: Sequence[float]) -> list[str]:
        """Return the texts of the inputs where each is off by so many of its uncertainties."""
        values = (value + shift * spread for value, shift, spread in zip(self._values, shifts, self._spreads))
        return [f"{value!r} {SI[kind]}".rstrip() for value, kind in zip(values, self._binder.kinds)]

    def _found(self, shifts: Sequence[Sequence[float]], asked: Sequence[Answer]) -> list[Values]:
        """Return the answers of machines whose inputs are off by so many uncertainties, or why there are none."""
        bound = self._binder.bound([self._texts(one) for one in shifts])
        found = bound.failures | answers_of(bound.lots, asked)
        return [found[row] for row in range(len(shifts))]

    def _answers(self, shifts: Sequence[Sequence[float]], asked: Sequence[Answer]) -> Any:
        """Return the answers (machines, asked) as floats, nan where there are none."""
        blank = [math.nan] * len(asked)
        rows = self._found(shifts, asked)
        return np.array([blank if isinstance(row, str) else [_float(value) for value in row] for row in rows])

    def of(self, asked: Sequence[Answer], counted: Counted = iter) -> list[Uncertain]:
        """Return the uncertainties of those key values that are numbers; counted: goes through parts of a sample."""
        linear, bends = self._of_first_order(asked)
        beside = [place for place in bends if not is_slow(self._binder.machine, linear[place].answer)]
        alone = [place for place in bends if place not in beside]
        found = dict(enumerate(linear))
        for places, count, at_once in ((beside, SAMPLE, _AT_ONCE), (alone, SLOW_SAMPLE, _SLOWLY)):
            found |= zip(places, self._drawn([linear[place] for place in places], count, at_once, counted))
        return list(found.values())

    def _of_first_order(self, asked: Sequence[Answer]) -> tuple[list[Uncertain], list[int]]:
        """Return the uncertainties of first order, and the places of those that bend too much for it."""
        steps = [sign * step for step in (_STEP, _STEP / 2, 1.0) for sign in (1, -1)]
        units = np.eye(len(self.keys))
        places = [0 * units[0], *(unit * step for unit in units for step in steps)]
        found = self._answers([one.tolist() for one in places], asked)
        there = [place for place in range(len(asked)) if math.isfinite(found[0, place])]
        kept, found = [asked[place] for place in there], found[:, there]
        outer, inner, whole = (found[1:].reshape(len(self.keys), 3, 2, -1)[:, k] for k in range(3))
        slopes = [(pair[:, 0] - pair[:, 1]) / (2 * step) for pair, step in ((outer, _STEP), (inner, _STEP / 2))]
        first = (4 * slopes[1] - slopes[0]) / 3
        bend = np.maximum(np.abs(whole.sum(axis=1) / 2 - found[0]), np.abs(slopes[1] - slopes[0]))
        size = np.sqrt((first**2).sum(axis=0))
        holds = (bend <= np.maximum(_BEND * size, _ROUNDING * np.abs(found[0]))).all(axis=0)
        shares = [_shares(squares) for squares in (first**2).T]
        linear = map(Uncertain, kept, found[0].tolist(), size.tolist(), shares)
        return list(linear), np.flatnonzero(~holds).tolist()

    def _drawn(self, bent: Sequence[Uncertain], count: int, at_once: int, counted: Counted) -> list[Uncertain]:
        """Return by a sample the uncertainties of what bends; shares are the squares of correlations."""
        if not bent:
            return []
        points = latin_hypercube(count, len(self.keys), 0).tolist()
        shifts = [[NormalDist().inv_cdf(share) for share in point] for point in points]
        parts = [shifts[start : start + at_once] for start in range(0, count, at_once)]
        asked = [one.answer for one in bent]
        found = np.concatenate([self._answers(part, asked) for part in counted(parts)])
        failed = self._failed([shifts[row] for row in np.flatnonzero(np.isnan(found).all(axis=1))], asked, count)
        drawn = [_of_sample(one, np.array(shifts), found[:, k]) for k, one in enumerate(bent)]
        return [one._replace(failed=failed) for one in drawn]

    def _failed(self, shifts: Sequence[Sequence[float]], asked: Sequence[Answer], count: int) -> str:
        """Return how many of so many machines gave no answer, and why the first one did not."""
        if not shifts:
            return ""
        (why,) = self._found(shifts[:1], asked)
        return f"{len(shifts)} of {count} drawn machines fail and count for nothing ({why})."


def _of_sample(one: Uncertain, shifts: Any, values: Any) -> Uncertain:
    there = np.isfinite(values)
    spread = float(values[there].std(ddof=1)) if there.sum() > 1 else math.nan
    if not spread > 0:
        return one._replace(spread=spread, shares=(0.0,) * shifts.shape[1], sample=int(there.sum()))
    own = shifts[there]
    shares = tuple(float(np.corrcoef(own[:, k], values[there])[0, 1]) ** 2 for k in range(own.shape[1]))
    return one._replace(spread=spread, shares=shares, sample=int(there.sum()))


def _shares(squares: Any) -> tuple[float, ...]:
    whole = squares.sum()
    return tuple((squares / whole).tolist()) if whole > 0 else (0.0,) * len(squares)


def _float(value: Any) -> float:
    return value if isinstance(value, (int, float)) else math.nan


def _of_each(keys: Iterable[str], told: Callable[[str], Found], wrong: dict[str, str]) -> dict[str, Found]:
    """Return what is told of every key; what is wrong with one is noted."""
    found = {}
    for key in keys:
        try:
            found[key] = told(key)
        except UsageError as error:
            wrong[key] = str(error)
    return found


def _number(text: str, kind: str) -> float:
    try:
        return parse_quantity(text, kind)
    except (UnitError, KeyError):
        raise UsageError(f"{shown(text)!r} is no number that could be off") from None


def _spread(text: str, kind: str, value: float) -> float:
    try:
        spread = abs(value) * parse_ratio(text) if text.endswith("%") else parse_quantity(text, kind)
    except UnitError as error:
        raise UsageError(str(error)) from None
    if not spread > 0:
        raise UsageError(f"it must be more than 0, got {text}")
    return spread


def with_uncertainty(
    report: Report, case: Case, more: Sequence[tuple[str, str]], system: str, counted: Counted = iter
) -> Report:
    """Return a report with a table of the uncertainties of its key values; more: those that no file gives.

    counted: see `Uncertainty.of`.

    Raises what `given_uncertainty` does.
    """
    uncertainty = given_uncertainty(case.machine, more)
    if uncertainty is None:
        return report
    found = uncertainty.of(_asked(case, report.command), counted)
    parts = [_with_table(part, found, uncertainty.keys, system) for part in report.all_parts]
    last = parts.pop() if report.whole else None
    return report._replace(parts=tuple(parts), whole=last, notes=(*report.notes, *_notes(found)))


_COMPARED = (("forces", ("c_max", "b_max", "work", "T_max")), ("flywheel", ("dE",)))
"""Command -> ids of the quantities whose other errors stand beside those of the data."""


def data_uncertainty(machine: Machine) -> "tuple[Difference, ...]":
    """Return what the uncertainties in a machine's file make of motion, work and torques, relatively.

    Of the first cylinder and of the whole machine; errors: see `given_uncertainty`.
    """
    from kurbel.accuracy.trials import Difference

    uncertainty = given_uncertainty(machine)
    if uncertainty is None:
        return ()
    case = Case(machine)
    asked = [one for command, ids in _COMPARED for one in _asked(case, command) if one.quantity.id in ids]
    first = [one for one in asked if one.subject in (asked[0].subject, "whole machine")]
    found = [one for one in uncertainty.of(first) if one.spread > _NOISE * abs(one.value)]
    return tuple(
        Difference(one.answer.quantity.symbol, "standard uncertainties of the file", one.spread / abs(one.value))
        for one in found
        if one.value
    )


def given_uncertainty(machine: Machine, more: Sequence[tuple[str, str]] = ()) -> Uncertainty | None:
    """Return the uncertainties of a machine's file, and those that no file gives; None where there are none.

    Raises MachineFileError or UsageError with all that is wrong with them.
    """
    outside, origin = dict(more), machine.origin
    if len(outside) < len(more):
        twice = max(outside, key=[key for key, _ in more].count)
        raise UsageError(f"--uncertainty {shown(twice)}: this key is given twice")
    spreads = dict(machine.uncertainty) | outside
    if not spreads or origin is None:
        return None
    try:
        return Uncertainty(origin, spreads)
    except WrongUncertainty as error:
        wrong = error.faults
    if told := [f"--uncertainty {key}: {wrong[key]}" for key in outside if key in wrong]:
        raise UsageError("; ".join(told))
    raise origin.error(*located(origin.text, [Fault(("uncertainty", key), wrong[key]) for key in wrong]))


def _asked(case: Case, command: str) -> list[Answer]:
    """Return the key values of a command that are numbers which the inputs move."""
    return [
        Answer(quantity, command, subject.name)
        for subject in subjects_of(case, command)
        for quantity, _ in subject.key_values(command)
        if not (quantity.listed or quantity.residual)
    ]


def _with_table(part: Part, found: Iterable[Uncertain], keys: Sequence[str], system: str) -> Part:
    own = [one for one in found if one.answer.subject == part.name and one.spread > _NOISE * abs(one.value)]
    if not own:
        return part
    names, values, spreads = [], [], []
    units = units_of([(one.answer.kind, one.answer.quantity.family, abs(one.value)) for one in own], system)
    for one, unit in zip(own, units):
        quantity = one.answer.quantity
        names.append((quantity.id, quantity.symbol, unit or "1"))
        values.append(convert(one.value, quantity.kind, unit))
        spreads.append(convert(one.spread, quantity.kind, unit))
    columns = [
        Column("value", "value", "value", "", tuple(values), alone=6),
        Column("uncertainty", "±", "+-", "", tuple(spreads), alone=2),
    ]
    for place, key in enumerate(keys):
        columns.append(Column(key, key, key, "%", tuple(round(100 * one.shares[place], 1) for one in own), alone=2))
    columns.append(Column("sample", "sample", "sample", "", tuple(one.sample or None for one in own), alone=2))
    title = "Standard uncertainty, and the share of each input in its square"
    heads = ("key_value", "symbol", "unit")
    table = PlaceTable("uncertainty", title, heads, tuple(names), tuple(columns), headed=True)
    return part._replace(place_tables=(*part.place_tables, table))


def _notes(found: Sequence[Uncertain]) -> Iterable[str]:
    yield "Uncertainties are of first order: u² = Σ (∂y/∂x u_x)², inputs independent."
    if any(one.sample for one in found):
        yield (
            "Those with a sample bend too much for that and come from so many drawn machines; their shares are squares "
            "of correlations, which fall short of 100 % where an answer turns back."
        )
    yield from dict.fromkeys(one.failed for one in found if one.failed)
