"""The report of `kurbel forces`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache
from typing import Any

from kurbel.report.frame import Answer, Frame, Rows, Subject, of_state, refuse_without_cylinder, rows_of
from kurbel.report.guide import guide_notes
from kurbel.report.left_out import left_out
from kurbel.report.motion import mechanism_notes
from kurbel.report.notes import Note, machine_notes, of_cylinder
from kurbel.report.tables import LeftOut, Report
from kurbel.solver.case import Case
from kurbel.solver.cylinder.forces import CylinderForces


def forces_report(
    case: Case,
    angles: Sequence[float] | Rows,
    columns: Sequence[str] | None,
    system: str,
    also: Sequence[str] = (),
) -> Report:
    """Return the forces of every cylinder; angles: crank angles, or what finds them; see `Frame`."""
    machine = case.machine
    refuse_without_cylinder(machine, "forces")
    frame = Frame("forces", rows_of(angles, 360.0 * machine.revolutions), columns, system, also)
    notes = (*mechanism_notes(machine), *guide_notes(case), *_rod_notes(case))
    return frame.report(machine, "Kräfte im Kurbeltriebe", subjects(case), notes=notes)


def _rod_notes(case: Case) -> Iterable[str]:
    if any(forces.drive.rod and forces.drive.has_force for forces in case.cylinders):
        yield (
            "S of an exact rod stands between the masses at its ends and is the force along it at neither pin: "
            "S_H is that at the crosshead pin, S_Z that at the crank pin; S_max, S_min and S_peak are of both pins."
        )


def subjects(case: Case) -> Iterable[Subject]:
    """Yield every cylinder, with its forces and its motion."""
    found = cache(lambda: machine_notes(case.machine, case))
    for forces in case.cylinders:
        yield _subject(case, forces, found)


def _subject(case: Case, forces: CylinderForces, found: Callable[[], Sequence[Note]]) -> Subject:
    cylinder = forces.drive.cylinder

    def at(degrees: Any) -> Answer:
        forces.refuse_locking()  # first, with an angle that does not depend on the step
        return of_state(forces.at(degrees))

    def warnings() -> Iterable[str]:
        yield from of_cylinder(found(), case.machine, cylinder)

    def left() -> Iterable[LeftOut]:
        yield from left_out(case.machine, cylinder)
        yield from _no_loss(forces)

    return Subject(cylinder.name, (forces, forces.motion), at, forces.lists, left, warnings, source=forces)


def _no_loss(forces: CylinderForces) -> tuple[LeftOut, ...]:
    if forces.friction_work is None or forces.work_driving:
        return ()
    return (LeftOut("friction loss as a share", "no piston drives"),)
