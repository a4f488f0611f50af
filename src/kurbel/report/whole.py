"""The report of `kurbel report`: all that a machine has, section by section; or two machines side by side."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import islice, zip_longest
from operator import itemgetter
from typing import TypeVar

import numpy as np

from kurbel.declared.unit_systems import convert, show, shown_unit, units_of
from kurbel.errors import KurbelError, NoSolutionError, UsageError
from kurbel.machine import Machine
from kurbel.numerics.extreme import Extreme, number_of, size_of
from kurbel.quantity import Quantity
from kurbel.report.alike import grouped, together
from kurbel.report.balance import balance_report
from kurbel.report.check import Checked, checked
from kurbel.report.commands import REPORTS, Command
from kurbel.report.crank import bearings_report, forces_report, motion_report, stress_report
from kurbel.report.delivery import IN_CASES, cases_report, delivery_report
from kurbel.report.frame import Frame, Subject, provenance, subjects_of
from kurbel.report.keys import every_place, meaning
from kurbel.report.picture import Document, Fact, Facts, Grid, Item, Pair, Section
from kurbel.report.picture_source import PictureOptions
from kurbel.report.pictures import PICTURES, pictures_if_any
from kurbel.report.tables import Report, stepped
from kurbel.report.turning import flywheel_report, harmonics_report, torsion_report
from kurbel.solver.case import Case
from kurbel.solver.forces import RUBBING, SLIDING, CylinderForces

Thing = TypeVar("Thing")
Given = Sequence[tuple[str, str]]
"""The keys of a machine file with their values, as they were read."""
Progress = Callable[[str], None]
"""Called with what is computed next."""
_VERDICTS = "Limits", "Expected"
_NONE = "–"
_SHORT = re.compile(r"[:;,(]| over | of the (?:cycle|turning)")
"""Where the first words of a sentence end."""
_REPORTS: dict[str, Callable[[Case, Frame], Report]] = {
    "motion": motion_report,
    "forces": forces_report,
    "flywheel": flywheel_report,
    "stress": stress_report,
    "bearings": bearings_report,
    "balance": balance_report,
    "harmonics": harmonics_report,
    "torsion": torsion_report,
    "delivery": delivery_report,
}


def report_of(case: Case, frame: Frame) -> Report:
    """Return the report of the command that the frame is of."""
    return _REPORTS[frame.command](case, frame)


_FACTS = {
    "flywheel": ("power_shaft", "M_max", "dE", "delta", "J"),
    "delivery": ("flow_mean", "capacity"),
    "forces": ("mean_pressure", "p_max", "P_peak", "N_peak", "T_max"),
    "bearings": ("load_max",),
    "stress": ("safety_pin_min",),
    "torsion": ("f_1",),
    "balance": ("F_free_max",),
    "motion": ("stroke", "swing", "c_m", "c_max", "b_max", "time_ratio", "theta_max", "theta_dot_max"),
}
"""Command -> ids of the key values that say most of a machine, the first ones first."""
_MOST_FACTS = 8
_ORDER = ("flywheel", "delivery", "forces", "bearings", "stress", "balance", "torsion", "harmonics", "motion")


@np.errstate(all="ignore")  # what overflows is refused by name
def whole_report(
    case: Case, given: Given, system: str, step: float, progress: Progress, cases: Sequence[Case] = ()
) -> Document:
    """Return all that a machine has: what says most of it, pictures and tables of each command, energy, input.

    given: the keys of its file; step: of the tables in degrees; cases: its load cases.
    """
    stepped(step, 360.0)  # a step that is none is refused at once
    found, places = checked(case), every_place()
    sections = [Section("summary", "Summary", tuple(_summary(case, found, system)))]

    left_out: list[tuple[str, str]] = []
    for word in _ORDER:
        command = REPORTS[word]
        progress(command.title.lower())
        try:
            made = _items(case, command, system, step)
            if cases and word in IN_CASES:
                made.append(cases_report(case.machine, cases, word, system))
            sections.append(Section(word, command.title, tuple(made)))
        except UsageError as error:
            left_out.append((command.title, str(error).removeprefix(f"{case.machine.name}: ")))

    rows = tuple((path, value, meaning(path, places)) for path, value in given)
    items: list[Item] = [Grid("Given", ("Key", "Value", "Meaning"), rows)] if rows else []
    for part in found.shown_once:
        if part.title not in (*_VERDICTS, "Warnings"):
            items.append(Grid(part.title, ("", ""), tuple((one.what, one.text) for one in part.entries)))
    sections += [
        Section("energy", "Energy balance", tuple(_energy(case, system))),
        Section("left-out", "Left out", (Grid("", ("Part", "Why"), tuple(left_out)),) if left_out else ()),
        Section("input", "Input as understood", tuple(items)),
    ]
    sources = (provenance(case.machine),)
    return Document(case.machine.name, sources, tuple(one for one in sections if one.items), subtitle_of(case.machine))


def subtitle_of(machine: Machine) -> str:
    """Return number of cylinders, cycle and speed in a line."""
    count = len(machine.cylinders)
    texts = [f"{count} cylinder{'s' * (count > 1)}", machine.cycle] if count else []
    return ", ".join(texts if machine.speed is None else [*texts, show(machine.speed, "speed", 4)])


def _summary(case: Case, found: Checked, system: str) -> Iterator[Item]:
    """Yield the mechanism, the key values that say most, limits and expectations with their verdicts, and warnings."""
    mechanism = next(one for one in PICTURES if one.id == "mechanism")
    for one in _if_any(partial(pictures_if_any, case, mechanism, PictureOptions(system)))[:1]:
        yield one._replace(machine="")
    if facts := tuple(islice(facts_of(case, system), _MOST_FACTS)):
        yield Facts(facts)
    for part in found.sections:
        if part.title in _VERDICTS:
            listed = tuple((one.what, one.text) for one in part.entries)
            colours = tuple("bad" if one.severity == "error" else "good" for one in part.entries)
            yield Grid(part.title, ("Key value", "Verdict"), listed, verdicts=colours)
    yield from map(str, found.errors)
    warnings = [entry for part in found.sections for entry in part.entries if entry.severity == "warning"]
    if warnings:
        yield Grid("Warnings", ("Part", "Warning"), tuple((one.what, one.text) for one in warnings))


def facts_of(case: Case, system: str) -> Iterator[Fact]:
    """Yield the key values that say most, each of the part where its magnitude is largest."""
    for command, ids in _FACTS.items():
        values: dict[str, list[tuple[float, Quantity, object, str]]] = {}
        for subject in _if_any(partial(subjects_of, case, command)):
            for quantity, value in _if_any(partial(subject.key_values, command)):
                if quantity.id in ids and isinstance(number := number_of(value), float):
                    values.setdefault(quantity.id, []).append((number, quantity, value, subject.name))
        for each in (values[id] for id in ids if id in values):
            number, quantity, value, name = max(each, key=lambda one: abs(one[0]))
            unit = shown_unit(quantity.kind, system, abs(number))
            at = f"at {value.degrees:.4g}°" if isinstance(value, Extreme) else ""
            where = f"{name} {at}".strip() if len(each) > 1 else at
            text = f"{convert(number, quantity.kind, unit):.4g}"
            yield Fact(_SHORT.split(quantity.text)[0], text, quantity.marked(unit), quantity.symbol, where)


def _items(case: Case, command: Command, system: str, step: float) -> list[Item]:
    """Return pictures and tables of one command; a sentence in place of those without a solution.

    Raises UsageError if the machine has none.
    """
    end = 360.0 * case.machine.revolutions if command.turns else 360.0
    angles = stepped(step, end, max(len(case.cylinders), 1))
    table: Item
    try:
        table = report_of(case, Frame(command.word, angles, None, system))
    except NoSolutionError as error:
        table = f"No solution: {error}"
    found: list[Item] = []
    for one in PICTURES:
        if one.command == command.word and one.id != "mechanism":  # which is in the summary
            try:
                found += (one._replace(machine="") for one in pictures_if_any(case, one, PictureOptions(system)))
            except NoSolutionError as error:
                found.append(f"{one.title}: {error}")
    return [*found, table]


def _energy(case: Case, system: str) -> Iterator[Grid]:
    """Yield for every cylinder where the energy of a cycle goes, and what an independent quadrature leaves open.

    Equal ones are there once, those without a solution not at all.
    """
    found = [(forces.drive.name, _energy_rows(forces, system)) for forces in case.cylinders]
    for equal in grouped((one for one in found if one[1]), itemgetter(1)):
        name = together([name for name, _ in equal])
        yield Grid(name, ("Per cycle", "Energy", "Unit"), equal[0][1], numbers=(1,), units=(2,))


def _energy_rows(forces: CylinderForces, system: str) -> tuple[tuple[str, str, str], ...]:
    try:
        left, residual, friction = forces.work_left, forces.energy_residual, forces.friction_works
        places = {name: place for name, (_, place) in {**SLIDING, **RUBBING}.items()}
        terms = [
            ("Indicated work of the driving pistons", forces.work_driving),
            ("Indicated work of the driven pistons", forces.work_driven),
            *((f"Friction {place}", -(friction.get(name) or 0.0)) for name, place in places.items()),
            ("Friction given as a force", -(friction.get("constant") or 0.0)),
            ("What the output works against", forces.resistance_work),
        ]
    except KurbelError:
        return ()
    if left is None:
        return ()
    known = [(text, value) for text, value in terms if value]
    unit = shown_unit("energy", system, max((abs(value) for _, value in known), default=abs(left)))
    known.append(("Reaches the shaft, 2π R W per turn", left))
    open_ = "below 1e-14" if residual is not None and abs(residual) < 1e-14 else f"{residual:.2g}"
    rows = [(text, f"{convert(value, 'energy', unit):.5g}", unit) for text, value in known]
    return (*rows, ("Left open by an independent quadrature, over the turnover", open_, ""))


# two machines side by side


@np.errstate(all="ignore")
def side_by_side(cases: Sequence[Case], given: Sequence[Given], system: str, progress: Progress) -> Document:
    """Return two machines side by side: input that differs, key values with their differences, pictures in pairs."""
    names = [case.machine.name for case in cases]
    names = names if names[0] != names[1] else [f"{names[0]} (A)", f"{names[1]} (B)"]
    files = [case.machine.origin.name for case in cases if case.machine.origin]
    items: list[Item] = []
    if len(files) == len(names):
        items.append("; ".join(f"{name} is that of {file}" for name, file in zip(names, files)) + ".")
    one, other = map(dict, given)
    keys = dict.fromkeys((*one, *other))
    rows = tuple((key, one.get(key, _NONE), other.get(key, _NONE)) for key in keys if one.get(key) != other.get(key))
    items.append(Grid("Keys", ("Key", *names), rows) if rows else "Nothing: both files give the same.")
    sections = [Section("input", "What was given differently", tuple(items))]

    for command in REPORTS.values():
        progress(command.title.lower())
        items = [*_key_values(cases, names, command.word, system)]
        for kind in PICTURES:
            if kind.command == command.word:
                drawn = [_if_any(partial(pictures_if_any, case, kind, PictureOptions(system))) for case in cases]
                # each picture is named as its machine is here
                drawn = [[one._replace(machine=name) for one in some] for some, name in zip(drawn, names)]
                items += [Pair(left, right) for left, right in zip_longest(*drawn)]
        sections.append(Section(command.word, command.title, tuple(items)))
    sources = tuple(provenance(case.machine) for case in cases)
    return Document(" and ".join(names), sources, tuple(one for one in sections if one.items))


def _if_any(found: Callable[[], Iterable[Thing]]) -> list[Thing]:
    """Return what a machine has, nothing if it has none of that."""
    try:
        return list(found())
    except KurbelError:
        return []


def _key_values(cases: Sequence[Case], names: Sequence[str], command: str, system: str) -> Iterator[Grid]:
    """Yield the key values of both machines, cylinder next to cylinder, equal ones once."""
    both = [_if_any(partial(subjects_of, case, command)) for case in cases]
    compared = [((one or other).name, _rows(one, other, command, system)) for one, other in zip_longest(*both)]
    for equal in grouped(compared, itemgetter(1)):
        if rows := equal[0][1]:
            title = together([name for name, _ in equal]) if len(compared) > 1 else "Key values"
            yield Grid(title, ("Symbol", *names, "Unit", "Difference", "Meaning"), rows, (1, 2, 4), (3,))


def _rows(left: Subject | None, right: Subject | None, command: str, system: str) -> tuple[tuple[str, ...], ...]:
    """Return the single key values of two subjects with their difference; no lists, and no residuals of rounding."""
    both: dict[Quantity, list[float | None]] = {}
    for place, subject in enumerate((left, right)):
        for quantity, value in _if_any(partial(subject.key_values, command)) if subject else ():
            number = number_of(value)
            if isinstance(number, (int, float)) and not quantity.residual:
                both.setdefault(quantity, [None, None])[place] = number
    units = units_of([(one.kind, one.family, max(map(size_of, values))) for one, values in both.items()], system)
    rows = []
    for (quantity, (first, second)), unit in zip(both.items(), units):
        texts = [_NONE if one is None else f"{convert(one, quantity.kind, unit):.5g}" for one in (first, second)]
        difference = _NONE
        if first is not None and second is not None and (first or not second):
            percent = 100 * (second - first) / abs(first) if first else 0.0
            difference = f"{percent:+.{2 if abs(percent) < 100 else 0}f} %" if percent else "0 %"
        rows.append((quantity.symbol, *texts, quantity.marked(unit), difference, quantity.text))
    return tuple(rows)
