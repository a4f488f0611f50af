"""The report of `kurbel report`: all that a machine has, section by section; or several machines side by side."""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from kurbel.declared.unit_systems import convert, shown_unit
from kurbel.errors import KurbelError, NoSolutionError, UsageError
from kurbel.machine.alike import gathered, work_alike
from kurbel.report.alike import together
from kurbel.report.angles import stepped
from kurbel.report.check import Checked, checked
from kurbel.report.commands import report_of
from kurbel.report.document import Document, Grid, Item, Section
from kurbel.report.frame import Frame
from kurbel.report.keys import every_place, meaning
from kurbel.report.picture_source import PictureOptions
from kurbel.report.pictures import PICTURES, pictures_if_any
from kurbel.report.provenance import provenance
from kurbel.report.tables import LeftOut, Report
from kurbel.solver.case import Case

Given = Sequence[tuple[str, str]]
"""The keys of a machine file with their values, as they were read."""
Progress = Callable[[str], None]


class Command(NamedTuple):
    """A command whose tables a report has: its word, a title, and whether its table runs over the whole cycle."""

    word: str
    title: str
    turns: bool = True


COMMANDS = (
    Command("motion", "Motion", False),
    Command("forces", "Forces"),
    Command("flywheel", "Turning effort and flywheel"),
    Command("stress", "Strength of the crankshaft"),
    Command("bearings", "Bearings"),
    Command("balance", "Balance of the masses"),
    Command("harmonics", "Orders of the turning effort"),
    Command("torsion", "Torsional vibration"),
)
"""In the order in which a report has them."""


def whole_report(case: Case, given: Given, system: str, step: float, progress: Progress) -> Document:
    """Return everything that a machine has. progress: is told what is being done."""
    stepped(step, 360.0)  # a step that is none is refused at once
    found = checked(case.machine, case)
    sections: list[Section | None] = [_input(case, given, found)]
    left_out: list[LeftOut] = []
    for command in COMMANDS:
        progress(command.title.lower())
        sections.append(_section(case, command, system, step, left_out))
    sections += [_verdicts(found), _energy(case, system)]
    if left_out:
        grid = Grid("", ("Part", "Why"), tuple((one.what, one.why) for one in left_out))
        sections.append(Section("left-out", "Left out", (grid,)))
    name = case.machine.name
    return Document(name, (provenance(case.machine),), tuple(one for one in sections if one))


def _input(case: Case, given: Given, found: Checked) -> Section:
    places = every_place()
    rows = [(path, value, meaning(path, places)) for path, value in given]
    items: list[Item] = [Grid("Given", ("Key", "Value", "Meaning"), tuple(rows))] if rows else []
    for part in found.told_once:
        if part.title not in ("Limits", "Expected"):
            items.append(Grid(part.title, ("", ""), tuple((one.what, one.text) for one in part.entries)))
    return Section("input", "Input as understood", tuple(items))


def _section(case: Case, command: Command, system: str, step: float, left_out: list[LeftOut]) -> Section | None:
    """Return pictures and tables of one command, or None where the machine has none, with the reason in `left_out`."""
    try:
        table = _table(case, command, system, step)
    except NoSolutionError as error:
        table = f"No solution: {error}"
    except UsageError as error:
        left_out.append(LeftOut(command.title, str(error).removeprefix(f"{case.machine.name}: ")))
        return None
    return Section(command.word, command.title, (*_pictures_of(case, command.word, PictureOptions(system)), table))


def _table(case: Case, command: Command, system: str, step: float) -> Report | str:
    end = 360.0 * case.machine.revolutions if command.turns else 360.0
    angles = stepped(step, end, max(len(case.cylinders), 1))
    report = report_of(case, Frame(command.word, angles, None, system))
    for part in report.all_parts:  # what cannot be computed is told now, not while the page is written
        len(part.key_values)
    return report


def _pictures_of(case: Case, command: str, options: PictureOptions) -> Iterator[Item]:
    """Yield the pictures of one command that the machine has; of one without a solution, why."""
    for one in PICTURES:
        if one.command == command:
            try:
                yield from pictures_if_any(case, one, options)  # what another would show is told among what is left out
            except NoSolutionError as error:
                yield f"{one.title}: {error}"


def _verdicts(found: Checked) -> Section | None:
    """Return how the limits and the expectations of the machine file stand."""
    items: list[Item] = []
    for part in found.sections:
        if part.title in ("Limits", "Expected"):
            rows = tuple((one.what, one.text) for one in part.entries)
            verdicts = tuple("bad" if one.severity == "error" else "good" for one in part.entries)
            items.append(Grid(part.title, ("Key value", "Verdict"), rows, verdicts=verdicts))
    items += [str(error) for error in found.errors]
    return Section("verdicts", "Limits and expectations", tuple(items)) if items else None


_TERMS = (
    ("work_driving", 1, "Indicated work of the driving pistons"),
    ("work_driven", 1, "Indicated work of the driven pistons"),
    ("crosshead_work", -1, "Friction of the crosshead"),
    ("ring_work", -1, "Friction of the piston rings"),
    ("constant_work", -1, "Friction given as a force"),
    ("resistance_work", 1, "What the output works against"),
)
"""Works of a cycle by their names in `CylinderForces`, the sign with which they reach the shaft, and what they are."""


@np.errstate(all="ignore")
def _energy(case: Case, system: str) -> Section | None:
    """Return for every cylinder where the energy of a cycle goes, and what an independent quadrature leaves open."""
    items: list[Item] = []
    for equal in gathered(case.cylinders, lambda one, other: work_alike(one.drive.cylinder, other.drive.cylinder)):
        forces = equal[0]
        try:
            left = forces.work_left
            terms = [(text, sign * value) for name, sign, text in _TERMS if (value := getattr(forces, name))]
            residual = forces.energy_residual
        except KurbelError:
            continue
        if left is None:
            continue
        unit = shown_unit("energy", system, max((abs(value) for _, value in terms), default=abs(left)))
        terms.append(("Reaches the shaft, 2π R W per turn", left))
        rows = [(text, f"{convert(value, 'energy', unit):.5g}", unit) for text, value in terms]
        open_ = "below 1e-14" if residual is not None and abs(residual) < 1e-14 else f"{residual:.2g}"
        rows.append(("Left open by an independent quadrature, over the turnover", open_, ""))
        name = together([one.drive.name for one in equal])
        items.append(Grid(name, ("Per cycle", "Energy", "Unit"), tuple(rows), numbers=(1,), units=(2,)))
    return Section("energy", "Energy balance", tuple(items)) if items else None
