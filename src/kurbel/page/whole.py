"""The report of `kurbel report`: all that a machine has, section by section; or two machines side by side."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from itertools import zip_longest
from operator import itemgetter

import numpy as np

from kurbel.checks.check import checked
from kurbel.checks.limits import cases_report
from kurbel.declared.unit_systems import convert, shown_unit, units_of
from kurbel.errors import KurbelError, NoSolutionError, UsageError
from kurbel.notes.warnings import of_machine
from kurbel.numerics.extreme import number_of, size_of
from kurbel.page.summary import (
    facts_of,
    firing_order,
    first_page,
    limit_verdicts,
    results_if_any,
    subtitle_of,
)
from kurbel.pictures.picture import (
    Document,
    FactValue,
    Grid,
    Notice,
    OverAngle,
    Pair,
    Picture,
    ReportAnswers,
    Section,
    SectionItem,
)
from kurbel.pictures.picture_source import PictureOptions
from kurbel.pictures.pictures import PICTURES, PictureKind, pictures_if_any
from kurbel.quantities import every_quantity
from kurbel.quantity import Quantity
from kurbel.report.commands import REPORTS, subjects_of
from kurbel.report.keys import every_place, meaning
from kurbel.solver.case import Case
from kurbel.solver.forces import RUBBING, SLIDING, CylinderForces
from kurbel.tables.frame import Frame, Subject, provenance
from kurbel.tables.tables import Report, for_people, grouped, stepped, together

KeyTexts = Sequence[tuple[str, str]]
"""The keys of a machine file with their values, as they were read."""
OnStep = Callable[[str], None]
"""Called with what is computed next."""
_NONE = "–"


def _pictures(case: Case, command: str, system: str) -> list[Picture | str]:
    """Return the pictures of the section of a command; without one that of the first page."""
    return [
        one for kind in PICTURES if kind.command == command for one in _drawn(case, kind, system)
    ]


def _drawn(case: Case, kind: PictureKind, system: str, name: str = "") -> list[Picture | str]:
    """Return one picture of a machine under this name, as often as it has it; without a solution a sentence."""
    try:
        return [
            one._replace(machine=name)
            for one in pictures_if_any(case, kind, PictureOptions(system))
        ]
    except NoSolutionError as error:
        return [f"{kind.title}: {error}"]


# one machine


@np.errstate(all="ignore")  # what overflows is refused by name
def whole_report(
    case: Case,
    given: KeyTexts,
    system: str,
    step: float,
    progress: OnStep,
    cases: Sequence[Case] = (),
) -> Document:
    """Return the report on a machine: a first page, pictures and tables of each command, energy balance, input.

    given: the keys of its file; step: of the tables in degrees; cases: its load cases.
    """
    stepped(step, 360.0)  # an invalid step is rejected at once
    machine, sections, tables = case.machine, list[Section](), list[SectionItem]()
    left_out: dict[tuple[str, str], list[str]] = {}
    warnings = dict.fromkeys(of_machine(case))
    for command in REPORTS:
        progress(command.title.lower())
        items = list[SectionItem](firing_order(machine) if command.word == "flywheel" else ())
        try:
            angles = stepped(step, command.functions.end(case), max(len(case.cylinders), 1))
            report = for_people(
                command.functions.report(case, Frame(command.word, angles, None, system))
            )
        except NoSolutionError as error:
            items.append(f"No solution: {error}")
        except UsageError as error:
            left_out[command.title, str(error).removeprefix(f"{machine.name}: ")] = []
            continue
        else:
            items.append(
                ReportAnswers(_without_motion(report) if command.word == "forces" else report)
            )
            tables += (
                [OverAngle(report, command.title)]
                if any(part.columns for part in report.all_parts)
                else []
            )
            for reason in (reason for part in report.all_parts for reason in part.left_out):
                left_out.setdefault(reason, []).append(command.title.lower())
            # the warnings of a cylinder lack its name, and are among those of the machine
            warnings |= dict.fromkeys(report.whole.warnings if report.whole else ())
        if cases and command.in_cases:
            with suppress(KurbelError):
                items.append(ReportAnswers(cases_report(machine, cases, command.word, system)))
        sections.append(
            Section(command.word, command.title, (*_pictures(case, command.word, system), *items))
        )

    rows = tuple(
        (what, why, ", ".join(dict.fromkeys(where))) for (what, why), where in left_out.items()
    )
    sections += [
        Section("energy", "Energy balance", tuple(_energy(case, system))),
        Section("tables", "Over the crank angle", tuple(tables)),
        Section("left-out", "Left out", (Grid("", ("Part", "Why", "Of"), rows),) if rows else ()),
        Section("input", "Input as understood", tuple(_input(case, given))),
    ]
    first = (*_pictures(case, "", system)[:1], *first_page(case, cases, system, warnings))
    sections = [section for section in sections if section.items]
    return Document(
        machine.name, (subtitle_of(machine),), first, tuple(sections), (provenance(machine),)
    )


def _without_motion(report: Report) -> Report:
    """Return the report on forces without the key values that the section on motion has."""
    own = {
        key_value.id
        for key_value in every_quantity().all_key_values
        if key_value.commands[:1] == ("forces",)
    }
    return report.changed(
        lambda part: part._replace(
            key_values=tuple(key_value for key_value in part.key_values if key_value.id in own)
        )
    )


def _input(case: Case, given: KeyTexts) -> Iterator[Grid]:
    """Yield the keys of the file with their meanings, and the results of a check of the machine."""
    places = every_place()
    if given:
        rows = tuple((path, value, meaning(path, places)) for path, value in given)
        yield Grid("Given", ("Key", "Value", "Meaning"), rows)
    for part in checked(case).shown_once:
        listed = tuple(
            (entry.what, entry.text) for entry in part.entries if entry.severity != "warning"
        )
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


def _energy_rows(forces: CylinderForces, system: str) -> tuple[tuple[FactValue, ...], ...]:
    try:
        left, residual, friction = forces.work_left, forces.energy_residual, forces.friction_works
        terms = [
            ("Indicated work of the driving pistons", forces.work_driving),
            ("Indicated work of the driven pistons", forces.work_driven),
            *(
                (f"Friction {place}", -(friction.get(name) or 0.0))
                for name, (_, place) in {**SLIDING, **RUBBING}.items()
            ),
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
def side_by_side(
    cases: Sequence[Case], given: Sequence[KeyTexts], system: str, progress: OnStep
) -> Document:
    """Return the report on two machines: input that differs, key values with their differences, pictures in pairs."""
    names = [case.machine.name for case in cases]
    names = names if names[0] != names[1] else [f"{names[0]} (A)", f"{names[1]} (B)"]
    files = [case.machine.origin.name for case in cases if case.machine.origin]
    items: list[SectionItem] = []
    if len(files) == len(names):
        items.append(
            "; ".join(f"{name} is that of {file}" for name, file in zip(names, files)) + "."
        )
    one, other = map(dict, given)
    keys = dict.fromkeys((*one, *other))
    rows = tuple(
        (key, one.get(key, _NONE), other.get(key, _NONE))
        for key in keys
        if one.get(key) != other.get(key)
    )
    items.append(
        Grid("Keys", ("Key", *names), rows) if rows else "Nothing: both files give the same."
    )
    sections = [Section("input", "What was given differently", tuple(items))]

    for command in REPORTS:
        progress(command.title.lower())
        items = [
            *_pairs(cases, command.word, names, system),
            *_key_values(cases, names, command.word, system),
        ]
        sections += [Section(command.word, command.title, tuple(items))] if items else []
    subtitles = tuple(f"{name}: {subtitle_of(case.machine)}" for name, case in zip(names, cases))
    sources = tuple(provenance(case.machine) for case in cases)
    first = tuple(_both_first(cases, names, system))
    return Document(" and ".join(names), subtitles, first, tuple(sections), sources)


def _pairs(
    cases: Sequence[Case], command: str, names: Sequence[str], system: str
) -> Iterator[Pair]:
    """Yield the pictures of a command of both machines, which have their names in this report."""
    for kind in (picture for picture in PICTURES if picture.command == command):
        for pair in zip_longest(
            *(_drawn(case, kind, system, name) for case, name in zip(cases, names))
        ):
            left, right = (one if isinstance(one, Picture) else None for one in pair)
            if left or right:
                yield Pair(left, right)


def _both_first(cases: Sequence[Case], names: Sequence[str], system: str) -> Iterator[SectionItem]:
    """Yield both mechanisms, the key values that say most with their differences, verdicts and warnings of each."""
    yield from _pairs(cases, "", names, system)
    ids = dict.fromkeys(id for case in cases for id in facts_of(case))
    facts = [facts_of(case, ids).values() for case in cases]
    titles = {fact.quantity: fact.title for some in facts for fact in some}
    numbers = [{fact.quantity: fact.value for fact in some} for some in facts]
    yield Grid("", _heads(names), _compared(numbers, system, titles), (1, 2, 4))
    for case, name in zip(cases, names):
        warnings = [*of_machine(case)]
        found = (*limit_verdicts(case), *(Notice(text, "warning") for text in warnings))
        yield from (f"{name}:", *found) if found else ()
        if not warnings:
            yield Notice(f"{name}: no warnings.", "good")


def _heads(names: Sequence[str]) -> tuple[str, ...]:
    return "Symbol", *names, "Unit", "Difference", "Meaning"


def _key_values(
    cases: Sequence[Case], names: Sequence[str], command: str, system: str
) -> Iterator[Grid]:
    """Yield the key values of both machines, cylinder by cylinder, identical ones once."""
    each = (
        [one for one in results_if_any(partial(subjects_of, case, command)) if one.results]
        for case in cases
    )
    pairs = [*zip_longest(*each)]
    compared = []
    for pair in pairs:
        numbers = [_numbers(subject, command) for subject in pair]
        meanings = {quantity: quantity.text for some in numbers for quantity in some}
        compared.append(((pair[0] or pair[1]).name, _compared(numbers, system, meanings)))
    for equal in grouped(compared, itemgetter(1)):
        if rows := equal[0][1]:
            title = together([name for name, _ in equal]) if len(pairs) > 1 else "Key values"
            yield Grid(title, _heads(names), rows, (1, 2, 4))


def _numbers(subject: Subject | None, command: str) -> dict[Quantity, float]:
    """Return the key values of a subject in SI, without lists and residuals."""
    found = results_if_any(partial(subject.key_values, command)) if subject else []
    numbers = {quantity: number_of(value) for quantity, value in found if not quantity.residual}
    return {
        quantity: number for quantity, number in numbers.items() if isinstance(number, (int, float))
    }


def _compared(
    numbers: Sequence[dict[Quantity, float]], system: str, meanings: dict[Quantity, str]
) -> tuple[tuple[FactValue, ...], ...]:
    """Return a row for each key value of two machines: symbol, both values, unit, difference, meaning."""
    one, other = numbers
    pairs = {quantity: (one.get(quantity), other.get(quantity)) for quantity in (*one, *other)}
    units = units_of(
        [(of.kind, of.family, max(map(size_of, pair))) for of, pair in pairs.items()], system
    )
    rows = []
    for (quantity, (first, second)), unit in zip(pairs.items(), units):
        shown = [
            _NONE if value is None else float(convert(value, quantity.kind, unit))
            for value in (first, second)
        ]
        difference = _NONE
        if first is not None and second is not None and (first or not second):
            percent = 100 * (second - first) / abs(first) if first else 0.0
            difference = f"{percent:+.{2 if abs(percent) < 100 else 0}f} %" if percent else "0 %"
        rows.append(
            (quantity.symbol, *shown, quantity.marked(unit), difference, meanings[quantity])
        )
    return tuple(rows)
