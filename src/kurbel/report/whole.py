"""The report of `kurbel report`: all that a machine has, section by section; or two machines side by side."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import zip_longest
from operator import itemgetter

import numpy as np

from kurbel.declared.unit_systems import convert, shown_unit, units_of
from kurbel.errors import KurbelError, NoSolutionError, UsageError
from kurbel.numerics.extreme import number_of, size_of
from kurbel.quantities import every_quantity
from kurbel.quantity import Quantity
from kurbel.report.alike import grouped, shown_once, together
from kurbel.report.balance import balance_report
from kurbel.report.check import checked
from kurbel.report.commands import REPORTS, Command
from kurbel.report.crank import bearings_report, forces_report, motion_report, stress_report
from kurbel.report.delivery import IN_CASES, cases_report, delivery_report
from kurbel.report.frame import Frame, Subject, provenance, subjects_of
from kurbel.report.keys import every_place, meaning
from kurbel.report.picture import Answers, Document, Grid, Item, Notice, OverAngle, Pair, Picture, Section, Shown
from kurbel.report.picture_source import PictureOptions
from kurbel.report.pictures import PICTURES, pictures_if_any
from kurbel.report.summary import facts_of, firing_order, if_any, subtitle_of, summary, verdicts
from kurbel.report.tables import Part, Report, stepped
from kurbel.report.turning import flywheel_report, harmonics_report, torsion_report
from kurbel.report.warnings import of_machine
from kurbel.solver.case import Case
from kurbel.solver.forces import RUBBING, SLIDING, CylinderForces

Given = Sequence[tuple[str, str]]
"""The keys of a machine file with their values, as they were read."""
Progress = Callable[[str], None]
"""Called with what is computed next."""
_NONE = "–"
_REPORTS: dict[str, Callable[[Case, Frame], Report]] = {
    "flywheel": flywheel_report,
    "delivery": delivery_report,
    "forces": forces_report,
    "bearings": bearings_report,
    "stress": stress_report,
    "balance": balance_report,
    "torsion": torsion_report,
    "harmonics": harmonics_report,
    "motion": motion_report,
}
"""Command -> its report, in the order of the page."""


def report_of(case: Case, frame: Frame) -> Report:
    """Return the report of the command that the frame is of."""
    return _REPORTS[frame.command](case, frame)


@np.errstate(all="ignore")  # what overflows is refused by name
def whole_report(
    case: Case, given: Given, system: str, step: float, progress: Progress, cases: Sequence[Case] = ()
) -> Document:
    """Return the report on a machine: a first page, pictures and tables of each command, energy balance, input.

    given: the keys of its file; step: of the tables in degrees; cases: its load cases.
    """
    stepped(step, 360.0)  # an invalid step is rejected at once
    machine, sections, tables = case.machine, list[Section](), list[Item]()
    left_out: dict[tuple[str, str], list[str]] = {}
    warnings = dict.fromkeys(of_machine(case))
    for word in _REPORTS:
        command = REPORTS[word]
        progress(command.title.lower())
        items = list[Item](firing_order(machine) if word == "flywheel" else ())
        try:
            report = shown_once(report_of(case, Frame(word, _angles(case, command, step), None, system)))
        except NoSolutionError as error:
            items.append(f"No solution: {error}")
        except UsageError as error:
            left_out[command.title, str(error).removeprefix(f"{machine.name}: ")] = []
            continue
        else:
            items.append(Answers(_without_motion(report) if word == "forces" else report))
            tables += [OverAngle(report, command.title)] if any(part.columns for part in report.all_parts) else []
            for part in report.all_parts:
                for reason in part.left_out:
                    left_out.setdefault(reason, []).append(command.title.lower())
            # the warnings of a cylinder lack its name, and are among those of the machine
            warnings |= dict.fromkeys(text for part in report.all_parts[-1:] for text in part.warnings if report.whole)
        if cases and word in IN_CASES:
            items += if_any(lambda: [Answers(cases_report(machine, cases, word, system))])  # noqa: B023 (at once)
        sections.append(Section(word, command.title, (*_pictures(case, command, system), *items)))

    rows = tuple((what, why, ", ".join(dict.fromkeys(where))) for (what, why), where in left_out.items())
    sections += [
        Section("energy", "Energy balance", tuple(_energy(case, system))),
        Section("tables", "Over the crank angle", tuple(tables)),
        Section("left-out", "Left out", (Grid("", ("Part", "Why", "Of"), rows),) if rows else ()),
        Section("input", "Input as understood", tuple(_input(case, given))),
    ]
    first = (*_mechanism(case, system), *summary(case, cases, system, warnings))
    sections = [one for one in sections if one.items]
    return Document(machine.name, (subtitle_of(machine),), first, tuple(sections), (provenance(machine),))


def _without_motion(report: Report) -> Report:
    """Return the report on forces without the key values that the section on motion has."""
    declared = every_quantity()

    def of_forces(part: Part) -> Part:
        found = (one for one in part.key_values if declared.commands_of(one.id)[0] == "forces")
        return part._replace(key_values=tuple(found))

    return report._replace(parts=tuple(map(of_forces, report.parts)))


def _angles(case: Case, command: Command, step: float) -> Sequence[float]:
    end = 360.0 * case.machine.revolutions if command.turns else 360.0
    return stepped(step, end, max(len(case.cylinders), 1))


def _mechanism(case: Case, system: str) -> list[Picture]:
    """Return the picture of the machine itself, if it has one."""
    mechanism = next(one for one in PICTURES if one.id == "mechanism")
    drawn = if_any(partial(pictures_if_any, case, mechanism, PictureOptions(system)))
    return [one._replace(machine="") for one in drawn[:1]]


def _pictures(case: Case, command: Command, system: str) -> Iterator[Item]:
    """Yield the pictures of a command, except the mechanism; for one without a solution a sentence."""
    for one in PICTURES:
        if one.command == command.word and one.id != "mechanism":
            try:
                yield from (one._replace(machine="") for one in pictures_if_any(case, one, PictureOptions(system)))
            except NoSolutionError as error:
                yield f"{one.title}: {error}"


def _input(case: Case, given: Given) -> Iterator[Grid]:
    """Yield the keys of the file with their meanings, and the results of a check of the machine."""
    places = every_place()
    if given:
        rows = tuple((path, value, meaning(path, places)) for path, value in given)
        yield Grid("Given", ("Key", "Value", "Meaning"), rows)
    for part in checked(case).shown_once:
        listed = tuple((one.what, one.text) for one in part.entries if one.severity != "warning")
        if listed and part.title not in ("Limits", "Expected"):
            yield Grid(part.title, ("", ""), listed)


def _energy(case: Case, system: str) -> Iterator[Grid]:
    """Yield the energy balance of every cylinder over a cycle, with its residual by an independent quadrature.

    Identical cylinders are listed once, those without a solution are omitted.
    """
    found = [(forces.drive.name, _energy_rows(forces, system)) for forces in case.cylinders]
    for equal in grouped((one for one in found if one[1]), itemgetter(1)):
        name = together([name for name, _ in equal])
        yield Grid(name, ("Per cycle", "Energy", "Unit"), equal[0][1], (1,))


def _energy_rows(forces: CylinderForces, system: str) -> tuple[tuple[Shown, ...], ...]:
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
    rows = [(text, float(convert(value, "energy", unit)), unit) for text, value in known]
    return (*rows, ("Left open by an independent quadrature, over the turnover", open_, ""))


# two machines side by side


@np.errstate(all="ignore")
def side_by_side(cases: Sequence[Case], given: Sequence[Given], system: str, progress: Progress) -> Document:
    """Return the report on two machines: input that differs, key values with their differences, pictures in pairs."""
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

    for word in _REPORTS:
        command = REPORTS[word]
        progress(command.title.lower())
        items = []
        for kind in PICTURES:
            if kind.command == word and kind.id != "mechanism":
                drawn = [if_any(partial(pictures_if_any, case, kind, PictureOptions(system))) for case in cases]
                # pictures have the name of the machine in this report
                drawn = [[one._replace(machine=name) for one in some] for some, name in zip(drawn, names)]
                items += [Pair(left, right) for left, right in zip_longest(*drawn)]
        sections.append(Section(word, command.title, (*items, *_key_values(cases, names, word, system))))
    sections = [one for one in sections if one.items]
    subtitles = tuple(f"{name}: {subtitle_of(case.machine)}" for name, case in zip(names, cases))
    sources = tuple(provenance(case.machine) for case in cases)
    first = tuple(_both_first(cases, names, system))
    return Document(" and ".join(names), subtitles, first, tuple(sections), sources)


def _both_first(cases: Sequence[Case], names: Sequence[str], system: str) -> Iterator[Item]:
    """Yield both mechanisms, the key values that say most with their differences, verdicts and warnings of each."""
    left, right = ([one._replace(machine=name) for one in _mechanism(case, system)] for case, name in zip(cases, names))
    yield from (Pair(*both) for both in zip_longest(left, right))
    ids = dict.fromkeys(id for case in cases for id in facts_of(case))
    facts = [facts_of(case, ids).values() for case in cases]
    titles = {fact.quantity: fact.title for some in facts for fact in some}
    one, other = ({fact.quantity: fact.number for fact in some} for some in facts)
    yield Grid("", _heads(names), _compared(one, other, system, titles), (1, 2, 4))
    for case, name in zip(cases, names):
        found = (*verdicts(case), *(Notice(text, "warning") for text in of_machine(case)))
        yield from (f"{name}:", *found) if found else ()
        if not of_machine(case):
            yield Notice(f"{name}: no warnings.", "good")


def _heads(names: Sequence[str]) -> tuple[str, ...]:
    return "Symbol", *names, "Unit", "Difference", "Meaning"


def _key_values(cases: Sequence[Case], names: Sequence[str], command: str, system: str) -> Iterator[Grid]:
    """Yield the key values of both machines, cylinder by cylinder, identical ones once."""
    both = [if_any(partial(subjects_of, case, command)) for case in cases]
    compared = []
    for pair in zip_longest(*both):
        one, other = (_numbers(subject, command) for subject in pair)
        rows = _compared(one, other, system, {quantity: quantity.text for quantity in (*one, *other)})
        compared.append(((pair[0] or pair[1]).name, rows))
    for equal in grouped(compared, itemgetter(1)):
        if rows := equal[0][1]:
            title = together([name for name, _ in equal]) if len(compared) > 1 else "Key values"
            yield Grid(title, _heads(names), rows, (1, 2, 4))


def _numbers(subject: Subject | None, command: str) -> dict[Quantity, float]:
    """Return the key values of a subject in SI, without lists and residuals."""
    found = if_any(partial(subject.key_values, command)) if subject else []
    numbers = {quantity: number_of(value) for quantity, value in found if not quantity.residual}
    return {quantity: number for quantity, number in numbers.items() if isinstance(number, (int, float))}


def _compared(
    one: dict[Quantity, float], other: dict[Quantity, float], system: str, meanings: dict[Quantity, str]
) -> tuple[tuple[Shown, ...], ...]:
    """Return a row for each key value of two machines: symbol, both values, unit, difference, meaning."""
    pairs = {quantity: (one.get(quantity), other.get(quantity)) for quantity in (*one, *other)}
    units = units_of([(of.kind, of.family, max(map(size_of, pair))) for of, pair in pairs.items()], system)
    rows = []
    for (quantity, (first, second)), unit in zip(pairs.items(), units):
        shown = [_NONE if value is None else float(convert(value, quantity.kind, unit)) for value in (first, second)]
        difference = _NONE
        if first is not None and second is not None and (first or not second):
            percent = 100 * (second - first) / abs(first) if first else 0.0
            difference = f"{percent:+.{2 if abs(percent) < 100 else 0}f} %" if percent else "0 %"
        rows.append((quantity.symbol, *shown, quantity.marked(unit), difference, meanings[quantity]))
    return tuple(rows)
