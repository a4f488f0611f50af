"""The reports of `kurbel motion` and `kurbel forces`: every cylinder on its own."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.report.frame import Frame, Row, Subject, place_table, refuse_without_cylinder, report_on
from kurbel.report.left_out import forces_left_out, motion_left_out
from kurbel.report.tables import PlaceTable, Report
from kurbel.report.warnings import by_cylinder, guide_notes
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from kurbel.solver.indicated import OF_CYCLES
from kurbel.solver.trace import TracePressure

_TITLE = "Forces in the crank train"


def motion_report(case: Case, frame: Frame) -> Report:
    """Return the motion of every cylinder's mechanism; raises UsageError without a cylinder."""
    machine = case.machine
    refuse_without_cylinder(machine, "motion")
    cylinders = [
        replace(one, left_out=tuple(motion_left_out(machine, cylinder)))
        for one, cylinder in zip(motion_subjects(case), machine.cylinders)
    ]
    return report_on(frame, machine, "Motion of the crank train", cylinders, notes=_mechanism_notes(machine))


def motion_subjects(case: Case) -> list[Subject]:
    """Return every cylinder, with its motion."""
    return [Subject(one.drive.name, (one.motion,), one.at, one.lists, source=one) for one in case.cylinders]


@np.errstate(all="ignore")
def forces_report(case: Case, frame: Frame) -> Report:
    """Return the forces of every cylinder.

    Raises UsageError without a cylinder, NoSolutionError if its friction locks one.
    """
    refuse_without_cylinder(case.machine, "forces")
    for forces in case.cylinders:
        forces.refuse_locking()
    if not frame.prose:
        return report_on(frame, case.machine, _TITLE, forces_subjects(case))
    return report_on(frame, case.machine, _TITLE, _with_sentences(case), notes=_forces_notes(case))


def forces_subjects(case: Case) -> list[Subject]:
    """Return every cylinder, with its forces and its motion."""
    return [Subject(one.drive.name, (one,), one.at, one.lists, source=one) for one in case.cylinders]


def _with_sentences(case: Case) -> list[Subject]:
    warnings = by_cylinder(case)
    return [
        replace(one, left_out=tuple(forces_left_out(case.machine, forces)), warnings=tuple(warnings[one.name]))
        for one, forces in zip(forces_subjects(case), case.cylinders)
    ]


@np.errstate(all="ignore")
def cycles_report(case: Case, system: str) -> Report:
    """Return the measured cycles of every cylinder, one to a line, with the key values of their mean.

    Raises UsageError if no cylinder has several.
    """
    tables = [tuple(_cycle_table(forces, system)) for forces in case.cylinders]
    if not any(tables):
        raise UsageError("--each-cycle: no trace of this machine has several cycles; leave it out")
    cylinders = [replace(one, at=None, tables=of) for one, of in zip(_with_sentences(case), tables)]
    return report_on(Frame("forces", (), None, system), case.machine, _TITLE, cylinders)


def _cycle_table(forces: CylinderForces, system: str) -> Iterable[PlaceTable]:
    cycles, gas = forces.indicated and forces.indicated.cycles, forces.drive.own_gas
    if cycles:
        declared = {one.id: one.absolute() if gas and gas.absolute else one for one in OF_CYCLES}
        columns = zip(*(one.tolist() for one in cycles))
        rows: list[Row] = [((str(number),), dict(zip(declared, values))) for number, values in enumerate(columns, 1)]
        yield place_table("cycles", "Measured cycles", ("cycle",), declared, rows, system, headed=True)


def _mechanism_notes(machine: Machine) -> tuple[str, ...]:
    """Return what a reader should know about the mechanisms of a machine, each sentence once."""
    return tuple(dict.fromkeys(note for cylinder in machine.cylinders for note in cylinder.mechanism.notes))


def _forces_notes(case: Case) -> Iterable[str]:
    yield from _mechanism_notes(case.machine)
    yield from guide_notes(case)
    if any(forces.drive.rod and forces.drive.has_force for forces in case.cylinders):
        yield (
            "S of an exact rod is the force between the masses at its ends and the force along it at neither pin: "
            "S_H is that at the crosshead pin, S_Z that at the crank pin; the rod must carry the largest of both."
        )
    compressors = [forces.drive.cylinder for forces in case.cylinders if not forces.no_compressor]
    if compressors:
        yield (
            "Rod load after API 618: P_G at the crosshead pin counts gas, inertia and weight of piston, piston rod, "
            "crosshead and other parts, P_KS at the piston rod the same without the crosshead; neither has the "
            "connecting rod's share or friction. d: in compression, z: in tension."
        )
    if any(cylinder.masses and cylinder.masses.undivided for cylinder in compressors):
        yield (
            "'reciprocating' is one sum, with the connecting rod's share: P_G counts all of it; give the parts to leave"
            " that share out."
        )
    ends = [end for forces in case.cylinders for gas in forces.drive.gas for end in (gas.head, gas.crank)]
    if any(isinstance(end, TracePressure) and end.trace.even for end in ends):
        yield (
            "ΔA/A of a trace at equal angles is no rounding: the indicated work is that of the trapezoid rule on the "
            "samples, the quadrature follows straight lines between them; it shows what their spacing leaves open."
        )
