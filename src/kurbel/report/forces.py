"""The report of `kurbel forces`."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache
from typing import Any

from kurbel.declared.forces import CYCLE_VALUES
from kurbel.errors import UsageError
from kurbel.report.frame import Frame, Subject, refuse_without_cylinder
from kurbel.report.shown import place_table
from kurbel.report.tables import LeftOut, PlaceTable, Report
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces


def forces_report(case: Case, frame: Frame) -> Report:
    """Return the forces of every cylinder."""
    machine = case.machine
    refuse_without_cylinder(machine, "forces")
    report = frame.report(machine, "Kräfte im Kurbeltriebe", subjects(case))
    return report._replace(notes=frame.later(lambda: (*_notes(case), *report.notes)))


def cycles_report(case: Case, system: str) -> Report:
    """Return the measured cycles of every cylinder, one to a line, with the key values of their mean.

    Raises UsageError where no cylinder has several.
    """
    machine = case.machine
    tables = {forces.drive.name: tuple(_cycle_table(forces, system)) for forces in case.cylinders}
    if not any(tables.values()):
        raise UsageError("--each-cycle: no trace of this machine has several cycles; leave it out")
    parts = [replace(one, at=None, place_tables=tables[one.name]) for one in subjects(case)]
    return Frame("forces", (), None, system).report(machine, "Kräfte im Kurbeltriebe", parts)


def _cycle_table(forces: CylinderForces, system: str) -> Iterable[PlaceTable]:
    if forces.indicated and (cycles := forces.indicated.cycles):
        absolute = forces.drive.own_gas and forces.drive.own_gas.absolute
        names = ((str(number),) for number in range(1, len(cycles.p_max) + 1))
        found = ((one.absolute() if absolute else one, getattr(cycles, one.id).tolist()) for one in CYCLE_VALUES)
        yield place_table("cycles", "Measured cycles", ("cycle",), names, found, system, headed=True)


def _notes(case: Case) -> Iterable[str]:
    from kurbel.report.guide import guide_notes
    from kurbel.report.motion import mechanism_notes

    yield from mechanism_notes(case.machine)
    yield from guide_notes(case)
    yield from _rod_notes(case)
    yield from _rod_load_notes(case)
    yield from _trace_notes(case)


def _trace_notes(case: Case) -> Iterable[str]:
    ends = (end for forces in case.cylinders for gas in forces.drive.gas for end in (gas.head, gas.crank))
    if any(getattr(getattr(end, "trace", None), "even", False) for end in ends):
        yield (
            "ΔA/A of a trace at equal angles is no rounding: the indicated work is that of the trapezoid rule on the "
            "samples, the quadrature follows straight lines between them; it shows what their spacing leaves open."
        )


def _rod_notes(case: Case) -> Iterable[str]:
    if any(forces.drive.rod and forces.drive.has_force for forces in case.cylinders):
        yield (
            "S of an exact rod is the force between the masses at its ends and the force along it at neither pin: "
            "S_H is that at the crosshead pin, S_Z that at the crank pin; the rod must carry the largest of both."
        )


def _rod_load_notes(case: Case) -> Iterable[str]:
    compressors = [forces for forces in case.cylinders if not forces.no_compressor]
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
    """Return every cylinder, with its forces and its motion."""

    @cache
    def notes() -> dict[str, list[str]]:
        from kurbel.report.notes import by_cylinder

        return by_cylinder(case)

    return (_subject(case, forces, notes) for forces in case.cylinders)


def _subject(case: Case, forces: CylinderForces, notes: Callable[[], dict[str, list[str]]]) -> Subject:
    cylinder = forces.drive.cylinder

    def at(degrees: Any) -> Any:
        forces.refuse_locking()  # first, with an angle that does not depend on the step
        return forces.at(degrees)

    def left() -> Iterable[LeftOut]:
        from kurbel.report.left_out import left_out

        yield from left_out(case.machine, cylinder)
        if forces.friction_work is not None and not forces.work_driving:
            yield LeftOut("friction loss as a share", "no piston drives")
        masses = cylinder.masses
        if not forces.no_compressor and masses and masses.crosshead is None:
            yield LeftOut("load on the piston rod", "no mass of the crosshead given")
        if forces.reversals_in_noise:
            why = "are within the noise of the trace and no Druckwechsel"
            yield LeftOut(f"{forces.reversals_in_noise} changes of the sign of P", why)

    return Subject(cylinder.name, (forces,), at, forces.lists, left, lambda: notes()[cylinder.name], source=forces)
