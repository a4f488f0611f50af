"""The report of `kurbel flywheel`: turning effort, excess work, flywheel and speed line of the whole machine."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from kurbel.declared.unit_systems import show
from kurbel.machine import Machine
from kurbel.numerics.extreme import Extreme
from kurbel.report.frame import Frame, Subject, of_state
from kurbel.report.left_out import flywheel_left_out
from kurbel.report.notes import machine_notes, of_machine
from kurbel.report.tables import Report
from kurbel.solver.case import Case
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.turning.flywheel import MachineTurning

_BEYOND = 1e308
"""Floquet multiplier that is as large as a float can be."""
_LINEAR = 0.1
"""δ up to which a harmonic balance about the mean speed may be trusted."""


def flywheel_report(case: Case, angles: Sequence[float], columns: Sequence[str] | None, system: str) -> Report:
    """Return the turning effort of the machine over the angle of crank 1; angles, columns, system: see `Frame`.

    Raises UsageError where nothing turns the shaft, NoSolutionError where the machine stalls.
    """
    *cylinders, whole = subjects(case)
    having = [one for one in cylinders if list(one.key_values("flywheel"))]
    notes = _notes(case.machine, case.flywheel)
    frame = Frame("flywheel", angles, columns, system)
    return frame.report(case.machine, "Drehkraftlinie und Schwungrad", having, whole, notes)


class _DeadCentre(NamedTuple):
    """What is to be said of a cylinder alone: the force that its parts before a pump must stand."""

    turning: MachineTurning
    forces: CylinderForces

    @property
    def P_dead_centre(self) -> Extreme | None:
        """Largest force in N in a dead centre, without inertia."""
        return self.turning.dead_centre_force(self.forces)


def subjects(case: Case) -> Iterable[Subject]:
    """Yield every cylinder, and the whole machine last."""
    turning = case.flywheel
    for forces in case.cylinders:
        yield Subject(forces.drive.name, (_DeadCentre(turning, forces),))
    results = (turning, *((turning.elastic,) if turning.elastic else ()))

    yield Subject(
        "whole machine",
        results,
        lambda degrees: of_state(turning.at(degrees)),
        left_out=lambda: flywheel_left_out(case.machine),
        warnings=lambda: _warnings(case, turning),
    )


def _notes(machine: Machine, turning: MachineTurning) -> Iterable[str]:
    if turning.crank is not None:
        over = "over" if turning.turned.efficiency > 1 else "with"
        eta = f", {over} the efficiency {machine.efficiency:g}" if machine.efficiency != 1 else ""
        yield f"T and W are referred to the radius of crank 1, {show(turning.crank, 'length')}{eta}; φ is its angle."
    if turning.J is not None and turning.omega and not turning.elastic and turning.multiplier is None:
        yield "Such a load holds no speed of its own: the mean of ω over time is taken as the nominal speed."
    if machine.efficiency != 1 and turning.turned.masses and turning.speed is not None:
        yield "As in the book the efficiency takes its share of all of T; in ω the moving masses count in full."
    if turning.rigid:
        yield (
            f"The coupling counts as rigid, its natural order {turning.natural_order:.4g} being above 100: "
            "the driven inertia turns with the flywheel."
        )


def _warnings(case: Case, turning: MachineTurning) -> Iterable[str]:
    machine = case.machine
    yield from of_machine(machine_notes(machine, case), machine)
    if turning.deficit is not None:
        yield (
            f"mean effort {show(turning.M_mean, 'torque')} and mean resistance "
            f"{show(turning.M_mean - turning.deficit, 'torque')} differ: the machine does not run steadily like this; "
            f"E and ω count {show(turning.deficit, 'torque')} more resistance all the time"
        )
    if machine.efficiency != 1 and any(cylinder.friction for cylinder in machine.cylinders):
        yield "both 'efficiency' and 'friction' are given: friction is taken off twice"
    yield from _wish_warnings(turning)
    if turning.multiplier is not None and turning.multiplier > 1:
        least = "at least " if turning.multiplier > _BEYOND else ""
        yield f"unstable: a disturbance of the speed grows {least}{turning.multiplier:.4g} times in every cycle"
    if turning.load_ignored:
        yield "the mean torque is zero, so that a load in proportion to it does not hold the speed; it is left out"
    yield from _coupling_warnings(turning)
    rim = machine.flywheel.rim if machine.flywheel else None
    if rim and rim.allowable_tension and turning.rim_stress and turning.rim_stress > rim.allowable_tension:
        yield (
            f"the rim bears a hoop stress of {show(turning.rim_stress, 'stress')}, more than the allowable "
            f"{show(rim.allowable_tension, 'stress')}"
        )


def _wish_warnings(turning: MachineTurning) -> Iterable[str]:
    """Yield by how much the flywheel of the books misses the wish, which is for the speed under the true load."""
    if turning.J_needed is None or turning.delta_needed is None or not turning.misses_the_wish:
        return
    better = "" if turning.J_exact is None else f"; J = {show(turning.J_exact, 'inertia')} gives the wanted one"
    yield (
        f"with J = ΔE/(δ ω²) = {show(turning.J_needed, 'inertia')} of the books the speed line has δ = "
        f"{turning.delta_needed:.4g}{better}"
    )


def _coupling_warnings(turning: MachineTurning) -> Iterable[str]:
    if not turning.elastic:
        return
    for near in turning.elastic.resonances:
        yield (
            f"resonance: harmonic {near.order:g} of the torque ({near.amplitude:.4g} N m) lies "
            f"{100 * abs(near.distance):.2g} % from the natural order {turning.elastic.natural_order:.4g} and is "
            f"amplified {near.amplification:.3g} times"
        )
    if turning.elastic.delta > _LINEAR:
        yield "the speed varies so much that the harmonic balance of the coupling is only a rough guide"
