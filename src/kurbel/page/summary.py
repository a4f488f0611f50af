"""The first page of a report: the machine, the most informative key values of its kind, verdicts, and warnings."""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import TypeVar

import numpy as np

from kurbel.checks.limits import (
    CheckEntry,
    compared_entries,
    load_cases_of,
    margin_text,
    margins,
    name_of,
)
from kurbel.declared.unit_systems import convert, show, shown_unit
from kurbel.errors import KurbelError
from kurbel.machine import Machine
from kurbel.machine.firing import firings
from kurbel.machine.indicator import Chamber
from kurbel.machine.several import intervals
from kurbel.numerics.extreme import Extreme, number_of
from kurbel.pictures.picture import Fact, Facts, FactValue, Grid, Notice, SectionItem
from kurbel.report.commands import subjects_of
from kurbel.solver.case import Case
from kurbel.tables.frame import Subject, before_jumps
from kurbel.tables.shown import PlaceRow, Places
from kurbel.tables.tables import BEFORE, grouped, joined_names

Thing = TypeVar("Thing")
_LABELS = {
    "flywheel": {
        "power_shaft": "Power at the shaft",
        "M_mean": "Mean torque",
        "M_max": "Largest torque",
        "M_min": "Smallest torque",
        "dE": "Excess work",
        "delta": "Speed fluctuation",
        "J": "Flywheel inertia",
        "J_needed": "Inertia required",
        "M_coupling_max": "Largest coupling torque",
    },
    "delivery": {
        "flow_mean": "Mean flow",
        "volume_fluctuation": "Fluctuating volume",
        "capacity": "Capacity",
        "discharge_temperature": "Discharge temperature",
    },
    "forces": {
        "mean_pressure": "Mean indicated pressure",
        "p_max": "Highest pressure",
        "P_peak": "Largest piston force",
        "N_peak": "Largest guide force",
        "rod_compression_max": "Rod load, compression",
        "rod_tension_max": "Rod load, tension",
        "reversal_angle": "Reversal of the rod load",
        "power": "Indicated power",
        "P_max": "Piston force, largest",
        "P_min": "Piston force, smallest",
        "N_max": "Guide force, largest",
        "N_min": "Guide force, smallest",
        "T_max": "Tangential force, largest",
        "T_min": "Tangential force, smallest",
        "friction_work": "Friction work per cycle",
        "friction_power": "Friction power",
        "friction_loss": "Friction loss",
        "friction_force_mean": "Mean crosshead friction",
    },
    "bearings": {"load_max": "Largest bearing load", "film_thickness_min": "Thinnest oil film"},
    "stress": {"safety_pin_min": "Safety of the crank pin"},
    "balance": {
        "F_free_max": "Largest unbalanced force",
        "M_free_max": "Largest unbalanced moment",
    },
    "torsion": {
        "natural_frequency": "Natural frequency",
        "M_vibratory": "Vibratory torque",
        "tau_vibratory": "Vibratory stress",
        "vibration_loss": "Power lost by damping",
    },
    "motion": {
        "stroke": "Stroke",
        "swing": "Angle of swing",
        "time_ratio": "Working over return time",
        "c_m": "Mean piston speed",
        "c_max": "Highest piston speed",
        "c_work_max": "Highest working speed",
        "c_return_max": "Highest return speed",
        "b_max": "Largest acceleration",
        "theta_dot_max": "Highest angular velocity",
        "theta_ddot_max": "Angular acceleration",
        "transmission_min": "Transmission angle",
    },
}
"""Command -> a short name of each key value that may be on the first page."""
_USUAL = (
    "power_shaft mean_pressure p_max P_peak M_max delta dE safety_pin_min load_max F_free_max M_free_max J N_peak "
    "natural_frequency c_m c_max b_max M_min stroke"
)
_KINDS = {
    "engine": (
        "power_shaft mean_pressure p_max P_peak M_max delta safety_pin_min film_thickness_min "
        "load_max F_free_max dE"
    ),
    "steam engine": (
        "power_shaft mean_pressure p_max flow_mean P_peak M_max delta film_thickness_min dE load_max"
    ),
    "pump": (
        "flow_mean power_shaft p_max volume_fluctuation P_peak M_max film_thickness_min load_max dE"
    ),
    "compressor": (
        "capacity power_shaft discharge_temperature p_max rod_compression_max reversal_angle M_max "
        "film_thickness_min load_max"
    ),
    "ram": "stroke time_ratio c_work_max c_return_max power_shaft P_peak M_max delta J",
    "linkage": "swing time_ratio theta_dot_max theta_ddot_max transmission_min power_shaft M_max dE",
    "shaft line": "natural_frequency M_vibratory tau_vibratory vibration_loss",
    "effort": "power_shaft M_mean M_max M_min dE delta J M_coupling_max natural_frequency",
    "masses": "P_peak M_max film_thickness_min load_max F_free_max M_free_max c_m c_max b_max",
}
"""Kind of machine -> its most informative key values, in order; then follow those of `_USUAL`."""
_OF_FORCES = (
    "b_max c_max friction_work friction_power friction_loss friction_force_mean power mean_pressure "
    "P_max P_min N_max N_min T_max T_min"
)
"""What the first selection of `kurbel forces` has; after the most informative key values on the first page."""
_SMALLEST = ("safety_pin_min", "reversal_angle", "transmission_min", "film_thickness_min")
"""Key values of which the smallest of all parts is shown, else the largest."""
_MOST_FACTS = 8
_CLAUSE = re.compile(r"[:;,(]| over the cycle")
"""End of the first words of a sentence, which name the quantity."""


def machine_kind(case: Case) -> str:
    """Return the kind of a machine, which decides the key values on the first page."""
    machine = case.machine
    if not machine.cylinders:
        return "effort" if machine.effort else "shaft line"
    first = machine.cylinders[0]
    if not first.mechanism.slides:
        return "linkage"
    if first.mechanism.quick_return or first.ram_force:
        return "ram"
    chambers: list[Chamber] = []
    for cylinder in machine.cylinders:
        for piston in cylinder.pistons:
            chambers += piston.chambers.values()
    if not chambers:
        return "masses" if first.force is None else "ram"
    if firings(machine):
        return "engine"
    drives = any(cylinder.drive.drives for cylinder in case.cylinders)
    if drives or any(chamber.by_steam for chamber in chambers):
        return "steam engine"
    try:
        return "pump" if case.delivery.pump else "compressor"
    except KurbelError:
        return "engine"


def subtitle_of(machine: Machine) -> str:
    """Return number of cylinders, cycle, speed, stroke, rod and bores in a line."""
    texts = []
    mechanisms = [cylinder.mechanism for cylinder in machine.cylinders]
    has_pistons = any(mechanism.slides and not mechanism.quick_return for mechanism in mechanisms)
    if has_pistons:
        count = len(machine.cylinders)
        texts.append("1 cylinder" if count == 1 else f"{count} cylinders")
    if firings(machine):
        texts.append(machine.cycle)
    if machine.speed is not None:
        texts.append(show(machine.speed, "speed", 4))

    strokes = [
        mechanism.stroke for mechanism in mechanisms if mechanism.slides and not mechanism.turns
    ]
    rods = [mechanism.rod_length for mechanism in mechanisms]  # infinite where there is none
    bores = []
    for cylinder in machine.cylinders:
        bores += [piston.bore for piston in cylinder.pistons]
    for name, lengths in (("stroke", strokes), ("rod", rods), ("bore", bores)):
        finite = [float(length) for length in lengths if math.isfinite(length)]
        different = dict.fromkeys(show(length, "length", 4) for length in finite)
        if different:
            texts.append(f"{name} {', '.join(different)}")
    return ", ".join(texts)


@np.errstate(all="ignore")
def facts_of(case: Case, ids: Iterable[str] = ()) -> dict[str, Fact]:
    """Return key values for the first page by their ids; without ids, the eight most informative ones, none zero.

    Of several parts the one with the largest value is named, or with the smallest for those of `_SMALLEST`; a key value
    of the whole machine is taken from there.
    """
    kind = machine_kind(case)
    wanted = tuple(ids) or (*_KINDS[kind].split(), *_USUAL.split())
    facts: dict[str, Fact] = {}
    for command, labels in _LABELS.items():
        subjects = results_if_any(partial(subjects_of, case, command))
        for id in labels:
            fact = _largest(id, command, subjects) if id in wanted else None
            if fact is not None:
                facts[id] = fact
    if not ids and kind != "effort" and _turns_against(facts):
        wanted = tuple("M_min" if id == "M_max" else id for id in wanted)

    titles = {"P_peak": "Largest ram force"} if kind == "ram" else {}
    if "M_max" not in wanted:
        titles["M_min"] = _LABELS["flywheel"]["M_max"]
    chosen: dict[str, Fact] = {}
    sizes = {0.0}
    for id in dict.fromkeys(wanted):
        if id not in facts:
            continue
        # the most informative ones, each size once
        size = abs(facts[id].value)
        is_new = size not in sizes and len(chosen) < _MOST_FACTS
        if ids or is_new:
            chosen[id] = facts[id]._replace(title=titles.get(id, facts[id].title))
            sizes.add(size)
    return chosen


def _turns_against(facts: Mapping[str, Fact]) -> bool:
    """Return whether the torque is largest against the rotation, as that of a pump or a compressor."""
    if "M_max" not in facts or "M_min" not in facts:
        return False
    return abs(facts["M_min"].value) > abs(facts["M_max"].value)


def _largest(id: str, command: str, subjects: Sequence[Subject]) -> Fact | None:
    """Return a key value of the part that decides, named; None where no part prints it."""
    facts = []
    for subject in subjects:
        fact = _fact_of(id, command, subject)
        if fact is not None:
            facts.append(fact)
    if not facts:
        return None
    of_whole = [fact for fact in facts if fact.where == "whole machine"]
    decisive = min if id in _SMALLEST else max
    largest = decisive(of_whole or facts, key=lambda fact: abs(fact.value))
    equal = [fact.where for fact in facts if f"{fact.value:.6g}" == f"{largest.value:.6g}"]
    return largest._replace(where=joined_names(equal) if len(equal) < len(facts) else "")


def _fact_of(id: str, command: str, subject: Subject) -> Fact | None:
    """Return the key value of one part; None where it has none, or does not print it."""
    quantity = subject.lists.key_values(command).get(id)
    if quantity is None:
        return None
    try:
        if not subject.is_printed(quantity):
            return None
        value = subject.answer(quantity)
        is_before_a_jump = bool(before_jumps(subject, [(quantity, value)]))
    except KurbelError:
        return None
    number = number_of(value)
    if not isinstance(number, float) or not math.isfinite(number):
        return None
    degrees = value.degrees if isinstance(value, Extreme) else None
    side = BEFORE if is_before_a_jump else ""
    return Fact(_LABELS[command][id], number, quantity, subject.name, degrees, side=side)


def tiles(facts: Iterable[Fact], system: str) -> Facts:
    """Return key values for display as tiles, each in its unit."""
    in_units = []
    for fact in facts:
        kind = fact.quantity.kind
        unit = shown_unit(kind, system, abs(fact.value))
        value = float(convert(fact.value, kind, unit))
        in_units.append(fact._replace(value=value, unit=fact.quantity.marked(unit)))
    return Facts(tuple(in_units))


def results_if_any(results: Callable[[], Iterable[Thing]]) -> list[Thing]:
    """Return the results as a list, empty if the machine does not have them."""
    try:
        return list(results())
    except KurbelError:
        return []


def first_page(
    case: Case, cases: Sequence[Case], system: str, warnings: Iterable[str]
) -> Iterator[SectionItem]:
    """Yield the most informative key values, limits and expectations with their verdicts, load cases, and warnings."""
    facts = facts_of(case)
    yield tiles([*facts.values(), *_facts_of_forces(case, facts.values())], system)
    yield from limit_verdicts(case, cases)
    if cases:
        rows: list[PlaceRow] = []
        for load_case in cases:
            of_case = facts_of(load_case, facts)
            rows.append(((name_of(load_case),), {id: fact.value for id, fact in of_case.items()}))
        declared = {id: fact.quantity for id, fact in facts.items()}
        table = Places("cases", "Load cases", ("case",), declared, rows, headed=True)
        yield table.shown(system)
    yield from (Notice(text, "warning") for text in warnings)
    if not warnings:
        yield Notice("No warnings.", "good")


def _facts_of_forces(case: Case, facts: Iterable[Fact]) -> Iterator[Fact]:
    """Yield the key values of the first selection of `kurbel forces`, but for those equal to a fact, and zeros."""
    sizes = {0.0, *(abs(fact.value) for fact in facts)}
    for fact in facts_of(case, _OF_FORCES.split()).values():
        if abs(fact.value) not in sizes:
            sizes.add(abs(fact.value))
            yield fact


def limit_verdicts(case: Case, cases: Sequence[Case] = ()) -> Iterator[SectionItem]:
    """Yield limits and expectations with their bounds and verdicts, and why some cannot be compared."""
    entries = compared_entries(case, cases)
    rows: list[tuple[FactValue, ...]] = []
    marks = []
    with_bound = [entry for entry in entries if entry.bound]
    same_bound = grouped(with_bound, lambda entry: (entry.path, entry.where, entry.bound))
    for group in same_bound:
        for entry in _decisive(group):
            fails = entry.severity == "error"
            rows.append(_verdict_row(entry, "FAIL" if fails else "PASS"))
            marks.append("bad" if fails else "good")
    table = margins(entries)
    load_cases = load_cases_of(table)
    if rows:
        # in this order: a narrow window shows the first columns
        heads = "Symbol", "Value", "Bound", "Verdict", "Limit or expectation", "Where"
        yield Grid("", heads, tuple(rows), numbers=(1,), verdicts=tuple(marks))
    if load_cases:
        margin_heads = ("Limit", *(name or case.machine.name for name in load_cases))
        lines = []
        for limit, of_limit in table.items():
            lines.append((limit, *(margin_text(of_limit.get(name)) for name in load_cases)))
        numbers = tuple(range(1, len(margin_heads)))
        yield Grid("Margins to the limits", margin_heads, tuple(lines), numbers=numbers)
    for entry in entries:
        if entry.error:
            yield Notice(str(entry.error), "bad")
    for entry in entries:
        if not entry.bound and not entry.error:
            yield Notice(f"{entry.what}: {entry.text}", "warning")


def _decisive(entries: Sequence[CheckEntry]) -> list[CheckEntry]:
    """Return of one bound in several load cases all that fail, or the one that is nearest to it."""
    failing = [entry for entry in entries if entry.severity == "error"]
    if failing:
        return failing
    nearest = min if entries[0].bound.startswith("≥") else max
    return [nearest(entries, key=lambda entry: entry.value or 0.0)]


def _verdict_row(entry: CheckEntry, verdict: str) -> tuple[FactValue, ...]:
    """Return symbol, value, bound, verdict, first words of the sentence, and the part."""
    value = (entry.value or 0.0, entry.unit)
    where = entry.where + entry.what.removeprefix(str(entry.path[-1]))
    if entry.quantity is None:
        return "", value, entry.bound, verdict, entry.what, where
    first_words = _CLAUSE.split(entry.quantity.text)[0]
    return entry.quantity.symbol, value, entry.bound, verdict, first_words, where


def firing_order(machine: Machine) -> Iterator[Grid]:
    """Yield the firing angles of an engine with several cylinders, and the intervals between ignitions."""
    ignitions = firings(machine)
    if len(machine.cylinders) < 2 or not ignitions:
        return
    cycle = 360.0 * machine.revolutions
    to_next = intervals([angle for angle, _ in ignitions], cycle)
    rows = []
    for (angle, number), interval in zip(ignitions, to_next):
        name = machine.cylinders[number - 1].name
        rows.append((name, f"{angle:g}°", f"{interval:g}°"))
    heads = ("Cylinder", "Fires at", "Interval to the next")
    yield Grid("Firing order", heads, tuple(rows), numbers=(1, 2))
