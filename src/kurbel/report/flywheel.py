"""The report of `kurbel flywheel`: turning effort, excess work, flywheel and speed line of the whole machine."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from kurbel.declared.unit_systems import show
from kurbel.machine import Machine
from kurbel.numerics.extreme import Extreme
from kurbel.report.frame import Frame, Subject
from kurbel.report.left_out import flywheel_left_out
from kurbel.report.notes import of_machine
from kurbel.report.tables import Report
from kurbel.solver.case import Case
from kurbel.solver.flywheel import MachineTurning
from kurbel.solver.forces import CylinderForces
from kurbel.solver.motion import every_dead_centre
from kurbel.solver.state import State


def flywheel_report(case: Case, frame: Frame) -> Report:
    """Return the turning effort of the machine over the angle of crank 1.

    Raises UsageError where nothing turns the shaft, NoSolutionError where the machine stalls.
    """
    *cylinders, whole = subjects(case)
    having = [one for one in cylinders if list(one.key_values("flywheel"))]
    notes = _notes(case.machine, case.flywheel)
    return frame.report(case.machine, "Drehkraftlinie und Schwungrad", having, whole, notes)


@dataclass(frozen=True, eq=False)
class _DeadCentre:
    """What is to be said of a cylinder alone: the force that its parts before a pump must stand."""

    turning: MachineTurning
    forces: CylinderForces

    @property
    def P_dead_centre(self) -> Extreme | None:
        """Largest force in N in a dead centre, without inertia."""
        return dead_centre_force(self.forces, self.turning.effort.cycle)


def subjects(case: Case) -> Iterable[Subject]:
    """Yield every cylinder, and the whole machine last."""
    turning = case.flywheel
    for forces in case.cylinders:
        yield Subject(forces.drive.name, (_DeadCentre(turning, forces),))
    yield Subject(
        "whole machine",
        turning.answering,
        turning.at,
        left_out=lambda: flywheel_left_out(case.machine),
        warnings=lambda: of_machine(case),
        source=turning,
    )


def dead_centre_force(forces: CylinderForces, cycle: float) -> Extreme | None:
    """Return the largest force in N of steam and pump in a dead centre of a cylinder, without inertia (R p. 613).

    At the end of the stroke both oppose the motion, and the parts before the pump must stand their sum. None where
    the cylinder does not both drive and drive a pump.
    """
    driving, driven = forces.work_driving, forces.work_driven
    both = np.asarray(driving is not None and (driving > 0) & (driven < 0))
    if not both.any():
        return None
    drive, count = forces.drive, forces.drive.count or 1
    centres = every_dead_centre(drive.mechanism, count, drive.cycle)
    angles = np.repeat(centres, 2, axis=1)
    sides = angles + np.tile([-1e-6, 1e-6], centres.shape[1])
    machine = np.repeat(np.arange(count), angles.shape[1])
    values = State.at(drive, angles.ravel(), sides.ravel(), machine).P_gas.reshape(angles.shape)
    largest = np.arange(count), np.abs(values).argmax(axis=1)
    found = np.where(both, values[largest], np.nan), np.mod(angles[largest], cycle)
    return Extreme(*map(forces.told, found))


def _efficiency_notes(turning: MachineTurning) -> Iterable[str]:
    effort = turning.effort
    if any(effort.lost(group) for group in effort.groups):
        yield (
            "Where driving and driven pistons share a rod, the efficiency reduces the force of the driving pistons; "
            "driven pistons, inertia, weight and friction count in full (R p. 613)."
        )
    if any(term.factor != 1 for term in effort.inertia_terms) and turning.speed is not None:
        yield "As in the book the efficiency takes its share of all of T; in ω the moving masses count in full."


def _notes(machine: Machine, turning: MachineTurning) -> Iterable[str]:
    if turning.crank is not None:
        over = "over" if any(term.factor > 1 for term in turning.effort.terms) else "with"
        eta = f", {over} the efficiency {machine.efficiency:g}" if machine.efficiency != 1 else ""
        yield f"T and W are referred to the radius of crank 1, {show(turning.crank, 'length')}{eta}; φ is its angle."
    if turning.J is not None and turning.omega and not turning.elastic and turning.multiplier is None:
        yield "Such a load holds no speed of its own: the mean of ω over time is taken as the nominal speed."
    if machine.efficiency != 1:
        yield from _efficiency_notes(turning)
    if turning.rigid:
        yield (
            f"The coupling counts as rigid, its natural order {turning.natural_order:.4g} being above 100: "
            "the driven inertia turns with the flywheel."
        )
