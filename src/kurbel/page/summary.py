"""The first page of a report: the machine, the most informative key values of its kind, verdicts, and warnings."""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from typing import TypeVar

import numpy as np

from kurbel.checks.limits import compared_entries, name_of
from kurbel.declared.unit_systems import convert, show, shown_unit
from kurbel.errors import KurbelError
from kurbel.machine import Machine
from kurbel.machine.firing import firings
from kurbel.machine.several import intervals
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.numerics.extreme import Extreme, number_of
from kurbel.pictures.picture import Fact, Facts, FactValue, Grid, Notice, SectionItem
from kurbel.report.commands import subjects_of
from kurbel.solver.case import Case
from kurbel.tables.frame import PlaceRow, Places, Subject, before_jumps
from kurbel.tables.tables import BEFORE, grouped, together

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
    "bearings": {"load_max": "Largest bearing load"},
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
    "engine": "power_shaft mean_pressure p_max P_peak M_max delta safety_pin_min load_max F_free_max dE",
    "steam engine": "power_shaft mean_pressure p_max flow_mean P_peak M_max delta dE load_max",
    "pump": "flow_mean power_shaft p_max volume_fluctuation P_peak M_max load_max dE",
    "compressor": "capacity power_shaft discharge_temperature p_max rod_compression_max reversal_angle M_max load_max",
    "ram": "stroke time_ratio c_work_max c_return_max power_shaft P_peak M_max delta J",
    "linkage": "swing time_ratio theta_dot_max theta_ddot_max transmission_min power_shaft M_max dE",
    "shaft line": "natural_frequency M_vibratory tau_vibratory vibration_loss",
    "effort": "power_shaft M_mean M_max M_min dE delta J M_coupling_max natural_frequency",
    "masses": "P_peak M_max load_max F_free_max M_free_max c_m c_max b_max",
}
"""Kind of machine -> its most informative key values, in order; then follow those of `_USUAL`."""
_OF_FORCES = (
    "b_max c_max friction_work friction_power friction_loss friction_force_mean power mean_pressure "
    "P_max P_min N_max N_min T_max T_min"
)
"""What the first selection of `kurbel forces` has; after the most informative key values on the first page."""
_SMALLEST = ("safety_pin_min", "reversal_angle", "transmission_min")
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
    chambers = [
        chamber
        for cylinder in machine.cylinders
        for piston in cylinder.pistons
        for chamber in piston.chambers.values()
    ]
    if not chambers:
        return "masses"
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
    cylinders, texts = machine.cylinders, list[str]()
    mechanisms = [cylinder.mechanism for cylinder in cylinders]
    if any(
        mechanism.slides and not mechanism.quick_return for mechanism in mechanisms
    ):  # else no piston moves
        texts.append(f"{len(cylinders)} cylinder{'s' * (len(cylinders) > 1)}")
    texts += [machine.cycle] if firings(machine) else []
    texts += [] if machine.speed is None else [show(machine.speed, "speed", 4)]
    sizes = {
        "stroke": [
            mechanism.stroke for mechanism in mechanisms if mechanism.slides and not mechanism.turns
        ],
        "rod": [mechanism.rod for mechanism in mechanisms if isinstance(mechanism, SliderCrank)],
        "bore": [piston.bore for cylinder in cylinders for piston in cylinder.pistons],
    }
    for name, lengths in sizes.items():
        shown = dict.fromkeys(
            show(float(length), "length", 4) for length in lengths if math.isfinite(length)
        )
        texts += [f"{name} {', '.join(shown)}"] if shown else []
    return ", ".join(texts)


@np.errstate(all="ignore")
def facts_of(case: Case, ids: Iterable[str] = ()) -> dict[str, Fact]:
    """Return key values for the first page by their ids; without ids, the eight most informative ones, none zero.

    Of several parts the one with the largest value is named, or with the smallest for those of `_SMALLEST`; a key value
    of the whole machine is taken from there.
    """
    kind = machine_kind(case)
    wanted = tuple(ids) or (*_KINDS[kind].split(), *_USUAL.split())
    known: dict[str, Fact] = {}
    for command, labels in _LABELS.items():
        subjects = if_any(partial(subjects_of, case, command))
        for id in labels:
            if id in wanted and (one := _largest(id, command, subjects)):
                known[id] = one
    # against the rotation, as that of a pump or a compressor
    against = {"M_max", "M_min"} <= set(known) and abs(known["M_min"].value) > abs(
        known["M_max"].value
    )
    if against and not ids and kind != "effort":
        wanted = tuple("M_min" if id == "M_max" else id for id in wanted)
    titles = {"P_peak": "Largest ram force"} if kind == "ram" else {}
    if "M_max" not in wanted:
        titles["M_min"] = _LABELS["flywheel"]["M_max"]
    found: dict[str, Fact] = {}
    for id in dict.fromkeys(one for one in wanted if one in known):
        size, taken = abs(known[id].value), [0.0, *(abs(one.value) for one in found.values())]
        if ids or (size not in taken and len(found) < _MOST_FACTS):
            found[id] = known[id]._replace(title=titles.get(id, known[id].title))
    return found


def _largest(id: str, command: str, subjects: Sequence[Subject]) -> Fact | None:
    each: list[Fact] = []
    for subject in subjects:
        quantity = subject.lists.key_values(command).get(id)
        with suppress(KurbelError):
            value = subject.answer(quantity) if quantity and subject.is_printed(quantity) else None
            if quantity and isinstance(number := number_of(value), float) and math.isfinite(number):
                degrees = value.degrees if isinstance(value, Extreme) else None
                side = BEFORE if before_jumps(subject, [(quantity, value)]) else ""
                each.append(
                    Fact(_LABELS[command][id], number, quantity, subject.name, degrees, side=side)
                )
    if not each:
        return None
    whole = [one for one in each if one.where == "whole machine"]
    found = (min if id in _SMALLEST else max)(whole or each, key=lambda one: abs(one.value))
    equal = [one.where for one in each if f"{one.value:.6g}" == f"{found.value:.6g}"]
    return found._replace(where=together(equal) if len(equal) < len(each) else "")


def tiles(facts: Iterable[Fact], system: str) -> Facts:
    """Return key values for display as tiles, each in its unit."""
    found = []
    for fact in facts:
        unit, kind = shown_unit(fact.quantity.kind, system, abs(fact.value)), fact.quantity.kind
        found.append(
            fact._replace(
                value=float(convert(fact.value, kind, unit)), unit=fact.quantity.marked(unit)
            )
        )
    return Facts(tuple(found))


def if_any(found: Callable[[], Iterable[Thing]]) -> list[Thing]:
    """Return the results as a list, empty if the machine does not have them."""
    try:
        return list(found())
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
        for one in cases:
            rows.append(
                ((name_of(one),), {id: found.value for id, found in facts_of(one, facts).items()})
            )
        declared = {id: one.quantity for id, one in facts.items()}
        yield Places("cases", "Load cases", ("case",), declared, rows, headed=True).shown(system)
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
    judged, rows, marks = compared_entries(case, cases), list[tuple[FactValue, ...]](), list[str]()
    for equal in grouped(
        (one for one in judged if one.bound), lambda one: (one.path, one.where, one.bound)
    ):
        # in several load cases all that fail, or the one that is nearest to its bound
        nearest = (min if equal[0].bound.startswith("≥") else max)(
            equal, key=lambda one: one.value or 0.0
        )
        for one in [one for one in equal if one.severity == "error"] or [nearest]:
            bad, of = one.severity == "error", one.quantity
            value, where = (
                (one.value or 0.0, one.unit),
                one.where + one.what.removeprefix(str(one.path[-1])),
            )
            symbol, text = (of.symbol, _CLAUSE.split(of.text)[0]) if of else ("", one.what)
            rows.append((symbol, value, one.bound, "FAIL" if bad else "PASS", text, where))
            marks.append("bad" if bad else "good")
    if rows:
        # in this order: a narrow window shows the first columns
        heads = "Symbol", "Value", "Bound", "Verdict", "Limit or expectation", "Where"
        yield Grid("", heads, tuple(rows), numbers=(1,), verdicts=tuple(marks))
    yield from (Notice(str(one.error), "bad") for one in judged if one.error)
    yield from (
        Notice(f"{one.what}: {one.text}", "warning")
        for one in judged
        if not (one.bound or one.error)
    )


def firing_order(machine: Machine) -> Iterator[Grid]:
    """Yield the firing angles of an engine with several cylinders, and the intervals between ignitions."""
    found, cycle = firings(machine), 360.0 * machine.revolutions
    if len(machine.cylinders) < 2 or not found:
        return
    rows = tuple(
        (machine.cylinders[number - 1].name, f"{angle:g}°", f"{after:g}°")
        for (angle, number), after in zip(found, intervals([angle for angle, _ in found], cycle))
    )
    yield Grid(
        "Firing order", ("Cylinder", "Fires at", "Interval to the next"), rows, numbers=(1, 2)
    )
