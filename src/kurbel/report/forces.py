"""The report of `kurbel forces`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache
from typing import Any

from kurbel.declared.unit_systems import show
from kurbel.errors import UsageError
from kurbel.machine.cylinder import may_lock
from kurbel.report.frame import Answer, Frame, Subject, of_state
from kurbel.report.guide import guide_notes
from kurbel.report.left_out import left_out
from kurbel.report.motion import mechanism_notes
from kurbel.report.notes import Note, machine_notes, of_cylinder
from kurbel.report.tables import LeftOut, Report
from kurbel.solver.case import Case
from kurbel.solver.cylinder.forces import CylinderForces


def forces_report(case: Case, angles: Sequence[float], columns: Sequence[str] | None, system: str) -> Report:
    """Return the forces of every cylinder; angles, columns, system: see `Frame`."""
    machine = case.machine
    if not machine.cylinders:
        raise UsageError(f"{machine.name} has no cylinder; kurbel forces needs one")
    frame = Frame("forces", angles, columns, system)
    return frame.report(
        machine, "Kräfte im Kurbeltriebe", subjects(case), notes=(*mechanism_notes(machine), *guide_notes(case))
    )


def subjects(case: Case) -> Iterable[Subject]:
    """Yield every cylinder, with its forces and its motion."""
    found = cache(lambda: machine_notes(case.machine, case))
    for forces in case.cylinders:
        yield _subject(case, forces, found)


def _subject(case: Case, forces: CylinderForces, found: Callable[[], Sequence[Note]]) -> Subject:
    cylinder = forces.drive.cylinder

    def at(degrees: Any) -> Answer:
        if may_lock(cylinder):
            # first, so that a crosshead that locks itself is told with an angle that does not depend on the step
            forces.extremes_of("N")
        return of_state(forces.at(degrees))

    def warnings() -> Iterable[str]:
        yield from of_cylinder(found(), case.machine, cylinder)
        yield from _balance_warnings(forces)
        yield from _bound_warnings(forces)

    def left() -> Iterable[LeftOut]:
        yield from left_out(case.machine, cylinder)
        yield from _no_loss(forces)

    return Subject(cylinder.name, (forces, forces.motion), at, cylinder.mechanism, left, warnings)


_CLOSED = 1e-9
"""An energy residual beyond this is no rounding."""
_COARSE = 0.01
"""An energy residual beyond this is more than an indicator may miss by its spacing."""


def _balance_warnings(forces: CylinderForces) -> Iterable[str]:
    residual = forces.energy_residual or 0.0
    if any(gas.traced for gas in forces.drive.gas):
        # with a measured trace it shows the spacing of the samples
        if abs(residual) > _COARSE:
            yield (
                "the samples stand too far apart: the indicated work, by the trapezoid rule, and that of T, by "
                f"straight lines between them, differ by {abs(residual):.1%} of what goes to and fro"
            )
    elif abs(residual) > _CLOSED:
        yield f"the energy balance of the cycle does not close (residual {residual:.1e}); trust no figure beyond that"


def _bound_warnings(forces: CylinderForces) -> Iterable[str]:
    """Yield what of the mechanism's own key values is above that to which the sources let it go."""
    for quantity, _, bound in forces.drive.mechanism.KEY_OFFERS:
        found = forces.offered(quantity.id) if bound else None
        if bound and found and found.value > bound:
            shown, most = show(found.value, quantity.kind), show(bound, quantity.kind)
            yield f"{quantity.text[0].lower()}{quantity.text[1:]}: {shown} is above {most}"


def _no_loss(forces: CylinderForces) -> tuple[LeftOut, ...]:
    if forces.friction_work is None or forces.work_driving:
        return ()
    return (LeftOut("friction loss as a share", "no piston drives"),)
