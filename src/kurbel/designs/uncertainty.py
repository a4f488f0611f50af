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
from kurbel.designs.answers import Answer, DesignValue, answered, is_slow
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
"""Sampled machines where the first order does not hold; the second number where each of them is slow."""
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
    origin = machine.origin
    paths_outside = [path_of(key) for key, _ in more]
    spreads = [pair for pair in machine.uncertainty if path_of(pair[0]) not in paths_outside]
    spreads += more
    if not spreads or origin is None:
        return None

    # the texts of the keys in the file
    tree = tree_of(origin)
    faults: dict[str, str] = {}
    texts: dict[str, str] = {}
    paths = [path_of(key) for key, _ in spreads]
    for key, _ in spreads:
        try:
            texts[key] = text_at(tree, key)
        except UsageError as error:
            faults[key] = str(error)
        if paths.count(path_of(key)) > 1:
            faults[key] = "this key is given twice"

    # their values and uncertainties, in SI
    binder = Binder(origin, tuple(texts), list(texts.values()))
    values, sizes = [], []
    for (key, text), kind in zip(texts.items(), binder.kinds):
        spread = dict(spreads)[key]
        try:
            value = parse_quantity(text, kind)
            size = _size_of(spread, value, kind)
        except (UnitError, KeyError) as error:
            no_number = f"{text_in_one_line(text)!r} is not a number that could be uncertain"
            faults[key] = str(error) if kind else no_number
            continue
        values.append(value)
        sizes.append(size)
        if not size > 0:
            faults[key] = f"it must be more than 0, got {spread}"

    faults_outside = [key for key in dict(more) if key in faults]
    if faults_outside:
        messages = [
            f"--uncertainty {text_in_one_line(key)}: {faults[key]}" for key in faults_outside
        ]
        raise UsageError("; ".join(messages))
    if faults:
        in_file = [Fault(("uncertainty", key), fault) for key, fault in faults.items()]
        raise origin.error(*located(origin.text, in_file))
    return Inputs(binder, tuple(texts), np.array(values), np.array(sizes))


def _size_of(spread: str, value: float, kind: str) -> float:
    """Return an uncertainty in SI: with a unit, or in percent of the value."""
    if spread.endswith("%"):
        return abs(value) * parse_ratio(spread)
    return parse_quantity(spread, kind, is_difference=True)


def uncertainties(
    inputs: Inputs, requested: Sequence[Answer], counted: Counted = iter
) -> list[Uncertain]:
    """Return the uncertainties of the key values that are numbers; counted: iterates over the parts of a sample."""
    # each input shifted alone, by each step; the first row with none shifted
    units = np.eye(len(inputs.keys))
    steps = (_STEP, -_STEP, _STEP / 2, -_STEP / 2, 1.0, -1.0)
    shifts = np.concatenate([0 * units[:1], *(step * units for step in steps)])
    rows, _ = _answers(inputs, shifts, requested)
    is_number = np.isfinite(rows[0])
    values = rows[0, is_number]
    shifted = rows[1:, is_number].reshape(len(steps), len(units), -1)
    above, below, near_above, near_below, over, under = shifted

    # slopes in units of the uncertainties, extrapolated from both steps
    coarse = (above - below) / (2 * _STEP)
    fine = (near_above - near_below) / _STEP
    slopes = (4 * fine - coarse) / 3
    sizes = np.sqrt((slopes**2).sum(axis=0))
    shares = np.divide(slopes**2, sizes**2, out=np.zeros_like(slopes), where=sizes > 0)

    # a key value that bends over the width of an uncertainty needs a sample
    bend = np.maximum(np.abs((over + under) / 2 - values), np.abs(fine - coarse))
    allowed = np.maximum(_BEND * sizes, _ROUNDING * np.abs(values))
    is_straight = (bend <= allowed).all(axis=0)
    numeric = [answer for answer, counts in zip(requested, is_number) if counts]
    of_first_order = list(
        map(Uncertain, numeric, values.tolist(), sizes.tolist(), map(tuple, shares.T.tolist()))
    )
    bent = [uncertain for uncertain, straight in zip(of_first_order, is_straight) if not straight]
    sampled = _sampled(inputs, bent, counted)
    return [
        uncertain if straight else next(sampled)
        for uncertain, straight in zip(of_first_order, is_straight)
    ]


def _sampled(inputs: Inputs, bent: Sequence[Uncertain], counted: Counted) -> Iterator[Uncertain]:
    """Yield the uncertainties of nonlinear key values from a sample; shares are the squares of correlations."""
    requested = [uncertain.answer for uncertain in bent]
    count = _sample_size(inputs.binder.machine, requested)
    shifts = np.vectorize(NormalDist().inv_cdf)(latin_hypercube(count, len(inputs.keys), 0))
    rows = []
    failures: list[str] = []
    for part in counted(np.array_split(shifts, _PARTS)):
        part_rows, part_failures = _answers(inputs, part, requested)
        rows.append(part_rows)
        failures += part_failures
    failed = ""
    if failures:
        failed = (
            f"{len(failures)} of {count} sampled machines fail and are ignored ({failures[0]})."
        )

    for uncertain, column in zip(bent, np.concatenate(rows).T):
        is_number = np.isfinite(column)
        values = column[is_number]
        spread = float(values.std(ddof=1)) if len(values) > 1 else math.nan
        shares = [0.0] * len(inputs.keys)
        if spread > 0:
            for number, input_shifts in enumerate(shifts[is_number].T):
                shares[number] = float(np.corrcoef(input_shifts, values)[0, 1]) ** 2
        yield Uncertain(
            uncertain.answer, uncertain.value, spread, tuple(shares), len(values), failed
        )


def _sample_size(machine: Machine, requested: Sequence[Answer]) -> int:
    """Return how many machines are sampled: fewer where one takes long by itself.

    The speed under a load that depends on it is a periodic solution, by collocation.
    """
    load = machine.load
    load_varies = load is not None and (load.slip is not None or bool(load.power))
    solves_speed = load_varies and any(answer.command == "flywheel" for answer in requested)
    if solves_speed or is_slow(machine, requested):
        return SLOW_SAMPLE
    return SAMPLE


def _answers(inputs: Inputs, shifts: Array, requested: Sequence[Answer]) -> tuple[Array, list[str]]:
    """Return the key values (machines, requested) with inputs shifted, nan where there is none, and the failures.

    shifts: (machines, inputs), in uncertainties.
    """
    columns = inputs.binder.columns(inputs.values + shifts * inputs.spreads)
    rows = []
    failures = []
    for answers in answered(inputs.binder, columns, requested):
        if isinstance(answers, str):
            failures.append(answers)
            rows.append([math.nan] * len(requested))
        else:
            rows.append([_as_number(value) for value in answers.values])
    return np.array(rows, dtype=float), failures


def _as_number(value: DesignValue) -> float:
    """Return a key value as a number; a list, which has no uncertainty, and a missing value as nan."""
    if value is None or isinstance(value, tuple):
        return math.nan
    return value


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
        printed = set[tuple[str | float | None, str]]()
        for part in report.all_parts:
            printed.update((part.name, key_value.id) for key_value in part.key_values)
        requested = [
            answer for answer in requested if (answer.subject, answer.quantity.id) in printed
        ]
    uncertain_values = uncertainties(inputs, requested, counted)
    notes = ["Uncertainties are of first order: u² = Σ (∂y/∂x u_x)², inputs independent."]
    if any(uncertain.sample for uncertain in uncertain_values):
        notes.append(
            "Those with a sample size are too nonlinear for that and come from so many sampled machines; their "
            "shares are squared correlations, which add up to less than 100 % where a key value is not monotonic."
        )
    notes += dict.fromkeys(uncertain.failed for uncertain in uncertain_values if uncertain.failed)
    report = report.changed(lambda part: _with_table(part, uncertain_values, inputs.keys, system))
    return report._replace(notes=(*report.notes, *notes))


def _numeric_answers(case: Case, command: str) -> list[Answer]:
    """Return the key values of a command that are numbers and depend on the inputs."""
    answers = []
    for subject in subjects_of(case, command):
        for quantity, _ in subject.key_values(command):
            is_number = not quantity.listed and not quantity.residual
            if is_number:
                answers.append(Answer(quantity, command, subject.name))
    return answers


def _with_table(
    part: Part, uncertain_values: Iterable[Uncertain], keys: Sequence[str], system: str
) -> Part:
    """Return a part of a report with a table of the uncertainties of its key values, if there are any."""
    of_part = [
        uncertain
        for uncertain in uncertain_values
        if uncertain.answer.subject == part.name and uncertain.counts
    ]
    if not of_part:
        return part
    sized = [
        (uncertain.answer.kind, uncertain.answer.quantity.family, abs(uncertain.value))
        for uncertain in of_part
    ]

    # a row for each key value: names, value, uncertainty, shares, size of the sample
    names, values, spreads, samples = [], [], [], []
    for uncertain, unit in zip(of_part, units_of(sized, system)):
        quantity, kind = uncertain.answer.quantity, uncertain.answer.kind
        names.append((quantity.id, quantity.symbol, unit or "1"))
        values.append(convert(uncertain.value, kind, unit))
        spreads.append(convert(uncertain.spread, kind, unit, is_difference=True))
        samples.append(uncertain.sample or None)
    columns = [
        Column("value", "value", "value", "", tuple(values), alone=6),
        Column("uncertainty", "±", "+-", "", tuple(spreads), alone=2),
    ]
    for number, key in enumerate(keys):
        percent = tuple(round(100 * uncertain.shares[number], 1) for uncertain in of_part)
        columns.append(Column(key, key, key, "%", percent, alone=2))
    columns.append(Column("sample", "sample", "sample", "", tuple(samples), alone=2))
    table = PlaceTable(
        "uncertainty",
        "Standard uncertainty, and the share of each input in its square",
        ("key_value", "symbol", "unit"),
        tuple(names),
        tuple(columns),
        headed=True,
    )
    return part._replace(place_tables=(*part.place_tables, table))
