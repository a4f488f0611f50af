"""The report of `kurbel motion`."""

from collections.abc import Iterable
from functools import partial

from kurbel.machine import Machine
from kurbel.report.frame import Frame, Subject, refuse_without_cylinder
from kurbel.report.left_out import motion_left_out
from kurbel.report.tables import Report
from kurbel.solver.case import Case


def motion_report(case: Case, frame: Frame) -> Report:
    """Return the motion of every cylinder's mechanism."""
    machine = case.machine
    refuse_without_cylinder(machine, "motion")
    return frame.report(machine, "Bewegung des Kurbeltriebes", subjects(case), notes=mechanism_notes(machine))


def subjects(case: Case) -> Iterable[Subject]:
    """Yield every cylinder, with its motion."""
    for forces in case.cylinders:
        left_out = partial(motion_left_out, case.machine, forces.drive.cylinder)
        yield Subject(forces.drive.name, (forces.motion,), forces.at, forces.lists, left_out, source=forces)


def mechanism_notes(machine: Machine) -> tuple[str, ...]:
    """Return what a reader should know about the mechanisms of a machine, each sentence once."""
    return tuple(dict.fromkeys(note for cylinder in machine.cylinders for note in cylinder.mechanism.notes))
