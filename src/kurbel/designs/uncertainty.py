"""Standard uncertainties of key values from those of the inputs, u² = Σ (∂y/∂x u_x)², and the share of each input.

The derivatives are central differences at two steps, extrapolated (Richardson); results of the solver are exact but for
rounding. Where a key value is too nonlinear over the width of an uncertainty, a sample replaces the first order.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from statistics import NormalDist
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.numerals import parse_ratio
from kurbel.declared.reading import shown
from kurbel.declared.unit_systems import convert, units_of
from kurbel.declared.units import parse_quantity
from kurbel.designs.answers import Answer, answers_at, is_slow
from kurbel.designs.binding import Binder, written
from kurbel.designs.plan import latin_hypercube
from kurbel.errors import Fault, Path, UnitError, UsageError
from kurbel.machine import Machine
from kurbel.machine.origin import Origin
from kurbel.machine_file.events import located
from kurbel.machine_file.overrides import path_of, tree_of
from kurbel.report.commands import subjects_of
from kurbel.report.tables import Column, Part, PlaceTable, Report
from kurbel.solver.case import Case

SAMPLE, SLOW_SAMPLE = 2000, 200
"""Sampled machines where the first order does not hold: computed in batches, and where each is computed alone."""
_HELD, _FEW_HELD = 200, 10
"""Of these the machines that are held, and counted, at once: a measured trace of each may be large."""
_STEP = 0.1
"""Outer step of the differences, as a share of an uncertainty; the inner step is half of it."""
_BEND = 0.1
"""Largest second-order part relative to the first."""
_ROUNDING = 1e-9
"""Second-order parts below this share of the value are not counted."""

Counted = Callable[[Sequence[Any]], Iterable[Any]]
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


class Inputs(NamedTuple):
    """Uncertain inputs: the binder of their machines, and key, value and uncertainty of each, in SI."""

    binder: Binder
    keys: tuple[str, ...]
    values: Array
    spreads: Array


def given_uncertainty(machine: Machine, more: Sequence[tuple[str, str]] = ()) -> Inputs | None:
    """Return the uncertain inputs of a machine's file, and those given outside it (`more`); None where there are none.

    Raises MachineFileError or UsageError with all faults.
    """
    outside, origin = dict(more), machine.origin
    if len(outside) < len(more):
        twice = max(outside, key=[key for key, _ in more].count)
        raise UsageError(f"--uncertainty {shown(twice)}: this key is given twice")
    spreads = dict(machine.uncertainty) | outside
    if not spreads or origin is None:
        return None
    inputs, wrong = read_inputs(origin, spreads)
    if faults := [f"--uncertainty {key}: {wrong[key]}" for key in outside if key in wrong]:
        raise UsageError("; ".join(faults))
    if wrong:
        raise origin.error(*located(origin.text, [Fault(("uncertainty", key), wrong[key]) for key in wrong]))
    return inputs


def read_inputs(origin: Origin, spreads: Mapping[str, str]) -> tuple[Inputs, dict[str, str]]:
    """Return the inputs that are uncertain by `0.2 mm` or `2 %`, by dotted key, and what is wrong with any, by key."""
    tree, wrong = tree_of(origin), dict[str, str]()
    texts: dict[str, str] = {}
    paths: set[Path] = set()
    for key in spreads:
        if path_of(key) in paths:
            wrong[key] = "this key is given twice"
        paths.add(path_of(key))
        try:
            texts[key] = written(tree, key)
        except UsageError as error:
            wrong[key] = str(error)
    binder = Binder(origin, tuple(texts), list(texts.values()))
    found = []
    for (key, text), kind in zip(texts.items(), binder.kinds):
        try:
            value = parse_quantity(text, kind)
        except (UnitError, KeyError):
            wrong[key] = f"{shown(text)!r} is not a number that could be uncertain"
            continue
        spread = spreads[key]
        try:
            size = abs(value) * parse_ratio(spread) if spread.endswith("%") else parse_quantity(spread, kind)
            found.append((value, size))
            if not size > 0:
                wrong[key] = f"it must be more than 0, got {spread}"
        except UnitError as error:
            wrong[key] = str(error)
    values, sizes = np.array(found).reshape(-1, 2).T
    return Inputs(binder, tuple(texts), values, sizes), wrong


def uncertainties(inputs: Inputs, requested: Sequence[Answer], counted: Counted = iter) -> list[Uncertain]:
    """Return the uncertainties of the key values that are numbers; counted: iterates over the parts of a sample."""
    steps = [sign * step for step in (_STEP, _STEP / 2, 1.0) for sign in (1, -1)]
    units = np.eye(len(inputs.keys))
    shifts = np.array([0 * units[0], *(unit * step for unit in units for step in steps)])
    found, _ = _answers(inputs, shifts, requested)
    there = np.flatnonzero(np.isfinite(found[0])).tolist()
    values, found = found[0, there], found[:, there]
    outer, inner, whole = np.moveaxis(found[1:].reshape(len(inputs.keys), 3, 2, -1), 1, 0)
    slopes = (outer[:, 0] - outer[:, 1]) / (2 * _STEP), (inner[:, 0] - inner[:, 1]) / _STEP
    first = (4 * slopes[1] - slopes[0]) / 3
    sizes = np.sqrt((first**2).sum(axis=0))
    shares = np.divide(first**2, sizes**2, out=np.zeros_like(first), where=sizes > 0)
    linear = [
        Uncertain(requested[place], *each)
        for place, *each in zip(there, values.tolist(), sizes.tolist(), map(tuple, shares.T.tolist()))
    ]
    bend = np.maximum(np.abs(whole.sum(axis=1) / 2 - values), np.abs(slopes[1] - slopes[0]))
    holds = (bend <= np.maximum(_BEND * sizes, _ROUNDING * np.abs(values))).all(axis=0)
    drawn = iter(_drawn(inputs, [one for one, straight in zip(linear, holds) if not straight], counted))
    return [one if straight else next(drawn) for one, straight in zip(linear, holds)]


def _drawn(inputs: Inputs, bent: Sequence[Uncertain], counted: Counted) -> list[Uncertain]:
    """Return the uncertainties of nonlinear key values from a sample; shares are the squares of correlations."""
    if not bent:
        return []
    requested = [one.answer for one in bent]
    slow = any(is_slow(inputs.binder.machine, one) for one in requested)
    count, held = (SLOW_SAMPLE, _FEW_HELD) if slow else (SAMPLE, _HELD)
    normal = np.vectorize(NormalDist().inv_cdf)
    shifts = normal(latin_hypercube(count, len(inputs.keys), 0))
    every = [shifts[start : start + held] for start in range(0, count, held)]
    parts = [_answers(inputs, part, requested) for part in counted(every)]
    found = np.concatenate([values for values, _ in parts])
    failures = [why for _, each in parts for why in each]
    failed = f"{len(failures)} of {count} sampled machines fail and are ignored ({failures[0]})." if failures else ""
    result = []
    for one, values in zip(bent, found.T):
        there = np.isfinite(values)
        spread = float(values[there].std(ddof=1)) if there.sum() > 1 else math.nan
        shares = (0.0,) * len(inputs.keys)
        if spread > 0:
            shares = tuple(float(np.corrcoef(own, values[there])[0, 1]) ** 2 for own in shifts[there].T)
        result.append(one._replace(spread=spread, shares=shares, sample=int(there.sum()), failed=failed))
    return result


def _answers(inputs: Inputs, shifts: Array, requested: Sequence[Answer]) -> tuple[Array, list[str]]:
    """Return the key values (machines, requested) with inputs shifted, nan where there is none, and the failures.

    shifts: (machines, inputs), in uncertainties.
    """
    every = answers_at(inputs.binder, inputs.values + shifts * inputs.spreads, requested)
    found = np.full((len(every), len(requested)), math.nan)
    for row, each in enumerate(every):
        if not isinstance(each, str):
            found[row] = [one if isinstance(one, (int, float)) else math.nan for one in each]
    return found, [why for why in every if isinstance(why, str)]


def with_uncertainty(
    report: Report, case: Case, more: Sequence[tuple[str, str]], system: str, counted: Counted = iter
) -> Report:
    """Return a report with a table of the uncertainties of its key values; more: those given outside the file.

    counted: see `uncertainties`; errors: see `given_uncertainty`.
    """
    inputs = given_uncertainty(case.machine, more)
    if inputs is None:
        return report
    found = uncertainties(inputs, _numeric_answers(case, report.command), counted)
    notes = ["Uncertainties are of first order: u² = Σ (∂y/∂x u_x)², inputs independent."]
    if any(one.sample for one in found):
        notes.append(
            "Those with a sample size are too nonlinear for that and come from so many sampled machines; their "
            "shares are squared correlations, which add up to less than 100 % where a key value is not monotonic."
        )
    notes += dict.fromkeys(one.failed for one in found if one.failed)
    report = report.changed(lambda part: _with_table(part, found, inputs.keys, system))
    return report._replace(notes=(*report.notes, *notes))


_COMPARED = (("forces", ("c_max", "b_max", "work", "T_max")), ("flywheel", ("dE",)))
"""Command -> ids of the quantities whose errors of data are compared with other errors."""


def data_uncertainty(machine: Machine) -> dict[str, float]:
    """Return the relative uncertainties of motion, work and torques that come from those in a machine's file.

    By symbol, of the first cylinder and of the whole machine; errors: see `given_uncertainty`.
    """
    inputs = given_uncertainty(machine)
    if inputs is None:
        return {}
    case = Case(machine)
    requested = [one for command, ids in _COMPARED for one in _numeric_answers(case, command) if one.quantity.id in ids]
    first = [one for one in requested if one.subject in (requested[0].subject, "whole machine")]
    found = [one for one in uncertainties(inputs, first) if one.spread > _NOISE * abs(one.value)]
    return {one.answer.quantity.symbol: one.spread / abs(one.value) for one in found if one.value}


def _numeric_answers(case: Case, command: str) -> list[Answer]:
    """Return the key values of a command that are numbers and depend on the inputs."""
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
    units = units_of([(one.answer.kind, one.answer.quantity.family, abs(one.value)) for one in own], system)
    kinds = [one.answer.quantity.kind for one in own]
    names = [(one.answer.quantity.id, one.answer.quantity.symbol, unit or "1") for one, unit in zip(own, units)]
    values, spreads = (
        tuple(convert(value, kind, unit) for value, kind, unit in zip(each, kinds, units))
        for each in ([one.value for one in own], [one.spread for one in own])
    )
    columns = [
        Column("value", "value", "value", "", values, alone=6),
        Column("uncertainty", "±", "+-", "", spreads, alone=2),
    ]
    for place, key in enumerate(keys):
        columns.append(Column(key, key, key, "%", tuple(round(100 * one.shares[place], 1) for one in own), alone=2))
    columns.append(Column("sample", "sample", "sample", "", tuple(one.sample or None for one in own), alone=2))
    title = "Standard uncertainty, and the share of each input in its square"
    heads = ("key_value", "symbol", "unit")
    table = PlaceTable("uncertainty", title, heads, tuple(names), tuple(columns), headed=True)
    return part._replace(place_tables=(*part.place_tables, table))
