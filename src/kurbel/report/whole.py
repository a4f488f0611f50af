"""The report of `kurbel report`: all that a machine has, section by section; or two machines side by side."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import zip_longest
from operator import itemgetter
from typing import TypeVar

import numpy as np

from kurbel.declared.unit_systems import convert, shown_unit, units_of
from kurbel.errors import KurbelError, NoSolutionError, UsageError
from kurbel.numerics.extreme import number_of, size_of
from kurbel.quantity import Quantity
from kurbel.report.alike import grouped, together
from kurbel.report.angles import stepped
from kurbel.report.check import Checked, checked
from kurbel.report.commands import REPORTS, Command, report_of, subjects_of
from kurbel.report.document import Document, Grid, Item, Pair, Section
from kurbel.report.frame import Frame, Subject, provenance
from kurbel.report.keys import every_place, meaning
from kurbel.report.picture_source import PictureOptions
from kurbel.report.pictures import PICTURES, pictures_if_any
from kurbel.report.tables import LeftOut
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces

Given = Sequence[tuple[str, str]]
"""The keys of a machine file with their values, as they were read."""
Progress = Callable[[str], None]
"""Called with what is computed next."""
Thing = TypeVar("Thing")


@np.errstate(all="ignore")  # what overflows is refused by name
def whole_report(case: Case, given: Given, system: str, step: float, progress: Progress) -> Document:
    """Return all that a machine has: input, pictures and tables of each command, verdicts, energy, what is left out.

    given: the keys of its file; step: of the tables in degrees.
    """
    stepped(step, 360.0)  # a step that is none is refused at once
    found = checked(case)
    sections: list[Section | None] = [_input(given, found)]
    left_out: list[LeftOut] = []
    for command in REPORTS.values():
        progress(command.title.lower())
        try:
            sections.append(Section(command.word, command.title, tuple(_items(case, command, system, step))))
        except UsageError as error:
            left_out.append(LeftOut(command.title, str(error).removeprefix(f"{case.machine.name}: ")))
    sections += [_verdicts(found), _energy(case, system)]
    if left_out:
        grid = Grid("", ("Part", "Why"), tuple((one.what, one.why) for one in left_out))
        sections.append(Section("left-out", "Left out", (grid,)))
    return Document(case.machine.name, (provenance(case.machine),), tuple(one for one in sections if one))


def _input(given: Given, found: Checked) -> Section:
    places = every_place()
    rows = tuple((path, value, meaning(path, places)) for path, value in given)
    items: list[Item] = [Grid("Given", ("Key", "Value", "Meaning"), rows)] if rows else []
    for part in found.shown_once:
        if part.title not in _VERDICTS:
            items.append(Grid(part.title, ("", ""), tuple((one.what, one.text) for one in part.entries)))
    return Section("input", "Input as understood", tuple(items))


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
        if one.command == command.word:
            try:
                found += pictures_if_any(case, one, PictureOptions(system))
            except NoSolutionError as error:
                found.append(f"{one.title}: {error}")
    return [*found, table]


_VERDICTS = "Limits", "Expected"


def _verdicts(found: Checked) -> Section | None:
    """Return how the limits and the expectations of the machine file compare."""
    items: list[Item] = []
    for part in found.sections:
        if part.title in _VERDICTS:
            rows = tuple((one.what, one.text) for one in part.entries)
            verdicts = tuple("bad" if one.severity == "error" else "good" for one in part.entries)
            items.append(Grid(part.title, ("Key value", "Verdict"), rows, verdicts=verdicts))
    items += [str(error) for error in found.errors]
    return Section("verdicts", "Limits and expectations", tuple(items)) if items else None


def _energy(case: Case, system: str) -> Section | None:
    """Return for every cylinder where the energy of a cycle goes, equal ones once."""
    found = [(forces.drive.name, _energy_rows(forces, system)) for forces in case.cylinders]
    items = []
    for equal in grouped((one for one in found if one[1]), itemgetter(1)):
        name = together([name for name, _ in equal])
        items.append(Grid(name, ("Per cycle", "Energy", "Unit"), equal[0][1], numbers=(1,), units=(2,)))
    return Section("energy", "Energy balance", tuple(items)) if items else None


def _energy_rows(forces: CylinderForces, system: str) -> tuple[tuple[str, str, str], ...]:
    """Return the works of a cycle, and what an independent quadrature leaves open; nothing without a solution."""
    try:
        left, residual = forces.work_left, forces.energy_residual
        terms = [
            ("Indicated work of the driving pistons", forces.work_driving),
            ("Indicated work of the driven pistons", forces.work_driven),
            ("Friction of the crosshead", _lost(forces.friction_works.get("crosshead"))),
            ("Friction of the piston rings", _lost(forces.friction_works.get("rings"))),
            ("Friction given as a force", _lost(forces.friction_works.get("constant"))),
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


def _lost(work: float | None) -> float | None:
    return None if work is None else -work


# two machines side by side

_NONE = "–"


@np.errstate(all="ignore")
def side_by_side(cases: Sequence[Case], given: Sequence[Given], system: str, progress: Progress) -> Document:
    """Return two machines side by side: input that differs, key values with their differences, pictures in pairs."""
    first, second = (case.machine.name for case in cases)
    names = (first, second) if first != second else (f"{first} (A)", f"{second} (B)")
    sections = [Section("input", "What was given differently", (*_files(cases, names), _given(given, names)))]
    for command in REPORTS.values():
        progress(command.title.lower())
        items: tuple[Item, ...] = (*_key_values(cases, names, command, system), *_pairs(cases, names, command, system))
        sections.append(Section(command.word, command.title, items))
    sources = tuple(provenance(case.machine) for case in cases)
    return Document(" and ".join(names), sources, tuple(one for one in sections if one.items))


def _files(cases: Sequence[Case], names: Sequence[str]) -> Iterator[str]:
    files = [case.machine.origin.name for case in cases if case.machine.origin]
    if len(files) == len(names):
        yield "; ".join(f"{name} is that of {file}" for name, file in zip(names, files)) + "."


def _given(given: Sequence[Given], names: Sequence[str]) -> Grid | str:
    one, other = map(dict, given)
    keys = dict.fromkeys((*one, *other))
    rows = [(key, one.get(key, _NONE), other.get(key, _NONE)) for key in keys if one.get(key) != other.get(key)]
    return Grid("Keys", ("Key", *names), tuple(rows)) if rows else "Nothing: both files give the same."


def _key_values(cases: Sequence[Case], names: Sequence[str], command: Command, system: str) -> Iterator[Grid]:
    """Yield the key values of both machines, cylinder next to cylinder, equal ones once."""
    both = [_if_any(partial(subjects_of, case, command.word)) for case in cases]
    heads = ("Symbol", *names, "Unit", "Difference", "Meaning")
    found = [(one or other, one, other) for one, other in zip_longest(*both)]
    compared = [(some.name, tuple(_rows(one, other, command.word, system))) for some, one, other in found]
    for equal in grouped(compared, itemgetter(1)):
        if rows := equal[0][1]:
            title = together([name for name, _ in equal]) if len(compared) > 1 else "Key values"
            yield Grid(title, heads, rows, (1, 2, 4), (3,))


def _pairs(cases: Sequence[Case], names: Sequence[str], command: Command, system: str) -> Iterator[Pair]:
    for declared in PICTURES:
        if declared.command == command.word:
            drawn = [_if_any(partial(pictures_if_any, case, declared, PictureOptions(system))) for case in cases]
            # each picture is named as its machine is here
            drawn = [[one._replace(machine=name) for one in some] for some, name in zip(drawn, names)]
            yield from (Pair(left, right) for left, right in zip_longest(*drawn))


def _if_any(found: Callable[[], Iterable[Thing]]) -> list[Thing]:
    """Return what a machine has, nothing if it has none of that."""
    try:
        return list(found())
    except KurbelError:
        return []


def _rows(left: Subject | None, right: Subject | None, command: str, system: str) -> Iterator[tuple[str, ...]]:
    found = [_numbers(one, command) for one in (left, right)]
    both = {quantity: [one.get(quantity) for one in found] for quantity in (*found[0], *found[1])}
    units = units_of([(one.kind, one.family, max(map(size_of, values))) for one, values in both.items()], system)
    for (quantity, values), unit in zip(both.items(), units):
        texts = [_NONE if value is None else f"{convert(value, quantity.kind, unit):.5g}" for value in values]
        yield quantity.symbol, *texts, quantity.marked(unit), _difference(*values), quantity.text


def _numbers(subject: Subject | None, command: str) -> dict[Quantity, float]:
    """Return the single key values of a subject in SI; lists are not compared, nor is rounding."""
    values = _if_any(partial(subject.key_values, command)) if subject else []
    numbers = {quantity: number_of(value) for quantity, value in values if not quantity.residual}
    return {quantity: value for quantity, value in numbers.items() if isinstance(value, (int, float))}


def _difference(first: float | None, second: float | None) -> str:
    """Return by how many percent of the first the second is larger, if that is defined."""
    if first is None or second is None or (not first and second):
        return _NONE
    percent = 100 * (second - first) / abs(first) if first else 0.0
    return f"{percent:+.{2 if abs(percent) < 100 else 0}f} %" if percent else "0 %"
