"""Standard uncertainties of key values from those of the inputs, u² = Σ (∂y/∂x u_x)², and the share of each input.

The derivatives are central differences at two steps, extrapolated (Richardson); results of the solver are exact but for
rounding. Where a key value is too nonlinear over the width of an uncertainty, a sample replaces the first order.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from statistics import NormalDist
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.numerals import parse_ratio
from kurbel.declared.reading import text_in_one_line
from kurbel.declared.unit_systems import convert, units_of
from kurbel.declared.units import parse_quantity
from kurbel.designs.answers import Answer, answered, is_slow
from kurbel.designs.binding import Binder
from kurbel.designs.plan import latin_hypercube
from kurbel.errors import Fault, UnitError, UsageError
from kurbel.machine import Machine
from kurbel.machine_file.events import located
from kurbel.machine_file.overrides import path_of, text_at, tree_of
from kurbel.report.commands import subjects_of
from kurbel.solver.case import Case
from kurbel.tables.tables import Column, Part, PlaceTable, Report

SAMPLE, SLOW_SAMPLE = 2000, 200
"""Sampled machines where the first order does not hold: computed in batches, and where each is computed alone."""
_PARTS = 20
"""Parts of a sample, computed one after another: a measured trace of each machine may be large."""
_STEP = 0.1
"""Outer step of the differences, as a share of an uncertainty; the inner step is half of it."""
_BEND = 0.1
"""Largest second-order part relative to the first."""
_ROUNDING = 1e-9
"""Second-order parts below this share of the value are not counted."""

KeyUncertainties = Sequence[tuple[str, str]]
"""Dotted keys, each with its standard uncertainty as a text."""
Counted = Callable[[Sequence[Array]], Iterable[Array]]
"""Yields what it is given, and may report the progress."""

_NOISE = 1e-12
"""Share of a value below which an uncertainty is rounding."""


class Uncertain(NamedTuple):
    """The standard uncertainty of a key value in SI, and the share of each input in its square.

    sample: number of sampled machines that both come from, 0 where they are of first order; failed: how many sampled
    machines failed, and why, '' where none did.
    """

    answer: Answer
    value: float
    spread: float
    shares: tuple[float, ...]
    sample: int = 0
    failed: str = ""

    @property
    def counts(self) -> bool:
        """Whether the uncertainty is more than rounding."""
        return self.spread > _NOISE * abs(self.value)


class Inputs(NamedTuple):
    """Uncertain inputs: the binder of their machines, and key, value and uncertainty of each, in SI."""

    binder: Binder
    keys: tuple[str, ...]
    values: Array
    spreads: Array


def given_uncertainty(machine: Machine, more: KeyUncertainties = ()) -> Inputs | None:
    """Return the inputs that are uncertain by `0.2 mm` or `2 %`, in a machine's file or outside it; None without any.

    Raises MachineFileError or UsageError with all faults.
    """
    origin, outside = machine.origin, [path_of(key) for key, _ in more]
    spreads = [*(one for one in machine.uncertainty if path_of(one[0]) not in outside), *more]
    if not spreads or origin is None:
        return None
    tree, wrong, texts = tree_of(origin), dict[str, str](), dict[str, str]()
    paths = [path_of(key) for key, _ in spreads]
    for key, _ in spreads:
        try:
            texts[key] = text_at(tree, key)
        except UsageError as error:
            wrong[key] = str(error)
        if paths.count(path_of(key)) > 1:
            wrong[key] = "this key is given twice"
    binder, found = Binder(origin, tuple(texts), list(texts.values())), []
    for (key, text), kind in zip(texts.items(), binder.kinds):
        spread = dict(spreads)[key]
        try:
            value = parse_quantity(text, kind)
            size = (
                abs(value) * parse_ratio(spread)
                if spread.endswith("%")
                else parse_quantity(spread, kind)
            )
            found.append((value, size))
            if not size > 0:
                wrong[key] = f"it must be more than 0, got {spread}"
        except (UnitError, KeyError) as error:
            wrong[key] = (
                str(error)
                if kind
                else f"{text_in_one_line(text)!r} is not a number that could be uncertain"
            )
    if faults := [
        f"--uncertainty {text_in_one_line(key)}: {wrong[key]}" for key in dict(more) if key in wrong
    ]:
        raise UsageError("; ".join(faults))
    if wrong:
        raise origin.error(
            *located(origin.text, [Fault(("uncertainty", key), wrong[key]) for key in wrong])
        )
    return Inputs(binder, tuple(texts), *np.array(found).T)


def uncertainties(
    inputs: Inputs, requested: Sequence[Answer], counted: Counted = iter
) -> list[Uncertain]:
    """Return the uncertainties of the key values that are numbers; counted: iterates over the parts of a sample."""
    units = np.eye(len(inputs.keys))
    steps = (_STEP, -_STEP, _STEP / 2, -_STEP / 2, 1.0, -1.0)
    found, _ = _answers(
        inputs, np.concatenate([0 * units[:1], *(step * units for step in steps)]), requested
    )
    there = np.isfinite(found[0])
    values = found[0, there]
    above, below, near_above, near_below, over, under = found[1:, there].reshape(
        len(steps), len(units), -1
    )
    coarse, fine = (above - below) / (2 * _STEP), (near_above - near_below) / _STEP
    slopes = (4 * fine - coarse) / 3
    sizes = np.sqrt((slopes**2).sum(axis=0))
    shares = np.divide(slopes**2, sizes**2, out=np.zeros_like(slopes), where=sizes > 0)
    bend = np.maximum(np.abs((over + under) / 2 - values), np.abs(fine - coarse))
    straight = (bend <= np.maximum(_BEND * sizes, _ROUNDING * np.abs(values))).all(axis=0)
    numeric = [one for one, is_there in zip(requested, there) if is_there]
    linear = list(
        map(Uncertain, numeric, values.tolist(), sizes.tolist(), map(tuple, shares.T.tolist()))
    )
    sampled = _sampled(inputs, [one for one, holds in zip(linear, straight) if not holds], counted)
    return [one if holds else next(sampled) for one, holds in zip(linear, straight)]


def _sampled(inputs: Inputs, bent: Sequence[Uncertain], counted: Counted) -> Iterator[Uncertain]:
    """Yield the uncertainties of nonlinear key values from a sample; shares are the squares of correlations."""
    requested = [one.answer for one in bent]
    count = SLOW_SAMPLE if is_slow(inputs.binder.machine, requested) else SAMPLE
    shifts = np.vectorize(NormalDist().inv_cdf)(latin_hypercube(count, len(inputs.keys), 0))
    parts = [_answers(inputs, part, requested) for part in counted(np.array_split(shifts, _PARTS))]
    found = np.concatenate([values for values, _ in parts])
    failures = [why for _, each in parts for why in each]
    failed = (
        f"{len(failures)} of {count} sampled machines fail and are ignored ({failures[0]})."
        if failures
        else ""
    )
    for one, values in zip(bent, found.T):
        there = np.isfinite(values)
        spread = float(values[there].std(ddof=1)) if there.sum() > 1 else math.nan
        shares = (0.0,) * len(inputs.keys)
        if spread > 0:
            shares = tuple(
                float(np.corrcoef(own, values[there])[0, 1]) ** 2 for own in shifts[there].T
            )
        yield Uncertain(one.answer, one.value, spread, shares, int(there.sum()), failed)


def _answers(inputs: Inputs, shifts: Array, requested: Sequence[Answer]) -> tuple[Array, list[str]]:
    """Return the key values (machines, requested) with inputs shifted, nan where there is none, and the failures.

    shifts: (machines, inputs), in uncertainties.
    """
    columns = inputs.binder.columns(inputs.values + shifts * inputs.spreads)
    every = answered(inputs.binder, columns, requested)
    lacking = [None] * len(requested)
    rows = [lacking if isinstance(one, str) else one.values for one in every]
    values = [[math.nan if isinstance(one, tuple) else one for one in row] for row in rows]
    return np.array(values, dtype=float), [one for one in every if isinstance(one, str)]


def with_uncertainty(
    report: Report,
    case: Case,
    more: KeyUncertainties,
    system: str,
    counted: Counted = iter,
    named: bool = False,
) -> Report:
    """Return a report with a table of the uncertainties of its key values; more: those given outside the file.

    named: the report has key values chosen by name, and no others are wanted. counted: see `uncertainties`; errors: see
    `given_uncertainty`.
    """
    inputs = given_uncertainty(case.machine, more)
    if inputs is None:
        return report
    requested = list(_numeric_answers(case, report.command))
    if named:
        printed = {
            (part.name, key_value.id) for part in report.all_parts for key_value in part.key_values
        }
        requested = [
            answer for answer in requested if (answer.subject, answer.quantity.id) in printed
        ]
    found = uncertainties(inputs, requested, counted)
    notes = ["Uncertainties are of first order: u² = Σ (∂y/∂x u_x)², inputs independent."]
    if any(one.sample for one in found):
        notes.append(
            "Those with a sample size are too nonlinear for that and come from so many sampled machines; their "
            "shares are squared correlations, which add up to less than 100 % where a key value is not monotonic."
        )
    notes += dict.fromkeys(one.failed for one in found if one.failed)
    report = report.changed(lambda part: _with_table(part, found, inputs.keys, system))
    return report._replace(notes=(*report.notes, *notes))


def _numeric_answers(case: Case, command: str) -> list[Answer]:
    """Return the key values of a command that are numbers and depend on the inputs."""
    return [
        Answer(quantity, command, subject.name)
        for subject in subjects_of(case, command)
        for quantity, _ in subject.key_values(command)
        if not (quantity.listed or quantity.residual)
    ]


def _with_table(part: Part, found: Iterable[Uncertain], keys: Sequence[str], system: str) -> Part:
    own = [one for one in found if one.answer.subject == part.name and one.counts]
    if not own:
        return part
    units = units_of(
        [(one.answer.kind, one.answer.quantity.family, abs(one.value)) for one in own], system
    )
    values = (convert(one.value, one.answer.kind, unit) for one, unit in zip(own, units))
    spreads = (convert(one.spread, one.answer.kind, unit) for one, unit in zip(own, units))
    shares = (
        [round(100 * share, 1) for share in each] for each in zip(*(one.shares for one in own))
    )
    table = PlaceTable(
        "uncertainty",
        "Standard uncertainty, and the share of each input in its square",
        ("key_value", "symbol", "unit"),
        tuple(
            (one.answer.quantity.id, one.answer.quantity.symbol, unit or "1")
            for one, unit in zip(own, units)
        ),
        (
            Column("value", "value", "value", "", tuple(values), alone=6),
            Column("uncertainty", "±", "+-", "", tuple(spreads), alone=2),
            *(Column(key, key, key, "%", tuple(each), alone=2) for key, each in zip(keys, shares)),
            Column(
                "sample", "sample", "sample", "", tuple(one.sample or None for one in own), alone=2
            ),
        ),
        headed=True,
    )
    return part._replace(place_tables=(*part.place_tables, table))
