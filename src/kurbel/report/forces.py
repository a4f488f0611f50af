"""The report of `kurbel forces`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache
from typing import Any

from kurbel.declared.indicated import CYCLE_VALUES
from kurbel.errors import UsageError
from kurbel.report.frame import Frame, Subject, refuse_without_cylinder
from kurbel.report.guide import guide_notes
from kurbel.report.left_out import left_out
from kurbel.report.motion import mechanism_notes
from kurbel.report.notes import Note, machine_notes, of_cylinder
from kurbel.report.shown import shown_column
from kurbel.report.tables import LeftOut, PlaceTable, Report
from kurbel.solver.case import Case
from kurbel.solver.cylinder.forces import CylinderForces


def forces_report(case: Case, frame: Frame) -> Report:
    """Return the forces of every cylinder."""
    machine = case.machine
    refuse_without_cylinder(machine, "forces")
    notes = (*mechanism_notes(machine), *guide_notes(case), *_rod_notes(case), *_rod_load_notes(case))
    return frame.report(machine, "Kräfte im Kurbeltriebe", subjects(case), notes=notes)


def cycles_report(case: Case, system: str) -> Report:
    """Return the measured cycles of every cylinder, one to a line, with the key values of their mean.

    Raises UsageError where no cylinder has several.
    """
    machine = case.machine
    tables = {forces.drive.name: tuple(_cycle_table(forces, system)) for forces in case.cylinders}
    if not any(tables.values()):
        raise UsageError("--each-cycle: no trace of this machine has several cycles; leave it out")
    parts = [one._replace(at=None, place_tables=tables[one.name]) for one in subjects(case)]
    return Frame("forces", (), None, system).report(machine, "Kräfte im Kurbeltriebe", parts)


def _cycle_table(forces: CylinderForces, system: str) -> Iterable[PlaceTable]:
    if cycles := forces.indicated.cycles:
        shown = [
            one.absolute() if forces.drive.own_gas and forces.drive.own_gas.absolute else one for one in CYCLE_VALUES
        ]
        names = tuple((str(number),) for number in range(1, len(cycles.p_max) + 1))
        columns = [shown_column(one, getattr(cycles, one.id).tolist(), system) for one in shown]
        yield PlaceTable("cycles", "Measured cycles", ("cycle",), names, tuple(columns), headed=True)


def _rod_notes(case: Case) -> Iterable[str]:
    if any(forces.drive.rod and forces.drive.has_force for forces in case.cylinders):
        yield (
            "S of an exact rod stands between the masses at its ends and is the force along it at neither pin: "
            "S_H is that at the crosshead pin, S_Z that at the crank pin; S_max, S_min and S_peak are of both pins."
        )


def _rod_load_notes(case: Case) -> Iterable[str]:
    compressors = [forces for forces in case.cylinders if not forces.rod_load.no_compressor]
    if compressors:
        yield (
            "Rod load after API 618: P_G at the crosshead pin counts gas, inertia and weight of piston, piston rod, "
            "crosshead and other parts, P_KS at the piston rod the same without the crosshead; neither has the "
            "connecting rod's share or friction. d: in compression, z: in tension."
        )
    masses = [forces.drive.cylinder.masses for forces in compressors]
    if any(one and one.undivided for one in masses):
        yield (
            "'reciprocating' is one sum, with the connecting rod's share: P_G counts all of it; give the parts to leave"
            " that share out."
        )


def subjects(case: Case) -> Iterable[Subject]:
    """Yield every cylinder, with its forces and its motion."""
    found = cache(lambda: machine_notes(case.machine, case))
    for forces in case.cylinders:
        yield _subject(case, forces, found)


def _subject(case: Case, forces: CylinderForces, found: Callable[[], Sequence[Note]]) -> Subject:
    cylinder = forces.drive.cylinder

    def at(degrees: Any) -> Any:
        forces.refuse_locking()  # first, with an angle that does not depend on the step
        return forces.at(degrees)

    def warnings() -> Iterable[str]:
        yield from of_cylinder(found(), case.machine, cylinder)

    def left() -> Iterable[LeftOut]:
        yield from left_out(case.machine, cylinder)
        yield from _no_loss(forces)
        yield from _no_piston_rod(forces)
        if forces.reversals_in_noise:
            why = "are within the noise of the trace and no Druckwechsel"
            yield LeftOut(f"{forces.reversals_in_noise} changes of the sign of P", why)

    return Subject(cylinder.name, forces.answering, at, forces.lists, left, warnings, source=forces)


def _no_loss(forces: CylinderForces) -> tuple[LeftOut, ...]:
    if forces.friction_work is None or forces.work_driving:
        return ()
    return (LeftOut("friction loss as a share", "no piston drives"),)


def _no_piston_rod(forces: CylinderForces) -> tuple[LeftOut, ...]:
    masses = forces.drive.cylinder.masses
    if forces.rod_load.no_compressor or masses is None or masses.crosshead is not None:
        return ()
    return (LeftOut("load on the piston rod", "no mass of the crosshead given"),)
