"""The report of `kurbel forces`: which quantities are shown, in which unit and order."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from kurbel.declared.unit_systems import show
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.cylinder import may_lock
from kurbel.report.left_out import left_out
from kurbel.report.motion import (
    columns_of,
    cylinder_columns,
    given,
    mechanism_notes,
    motion_key_values,
    plain_values,
    refuse_absent,
)
from kurbel.report.notes import Note, machine_notes, of_cylinder
from kurbel.report.shown import shown_key_value
from kurbel.report.tables import KeyValue, Later, LeftOut, Part, Report
from kurbel.solver.case import Case
from kurbel.solver.cylinder.forces import CylinderForces

FORCE_COLUMNS = (
    *("phi", "psi", "x", "c", "b", "p_head", "p_crank", "P_gas", "P_inertia", "P_weight", "P_ram"),
    *("P", "S", "N", "F_pin", "N_pair", "M_bend", "D", "M_out", "F_coupler", "T", "F_friction", "M"),
)
"""Ids of the columns of `kurbel forces`, in the order in which they are printed."""
_SWING_COLUMNS = ("theta", "theta_dot", "theta_ddot")
"""Printed too where nothing slides; elsewhere they belong to `kurbel motion`, and to who asks for them."""
_ALL_COLUMNS = (*FORCE_COLUMNS[:1], *_SWING_COLUMNS, *FORCE_COLUMNS[1:])

_EXTREMES = ("P", "P_start", "P_inertia", "S", "N", "F_pin", "N_pair", "M_bend", "F_coupler", "T")
_PARTICULAR = ("pin_pressure", "coupler_inertia")
_WORK = (
    *("work", "work_driving", "work_driven", "resistance_work", "power", "mean_pressure", "work_sensitivity"),
    *("W", "friction_work"),
    *("loss_crosshead", "loss_crosshead_redtenbacher", "loss_rings", "energy_residual"),
)


def forces_report(case: Case, angles: Sequence[float], columns: Sequence[str] | None, system: str) -> Report:
    """Return the forces of every cylinder at the crank angles (n,) in degrees.

    columns: ids to show besides φ, None for all that the machine has; system: `si` or `technical`.
    """
    machine = case.machine
    if not machine.cylinders:
        raise UsageError(f"{machine.name} has no cylinder; kurbel forces needs one")
    with np.errstate(all="ignore"):  # what overflows is refused below, by name
        found = machine_notes(machine, case)
        parts = tuple(_part(case, forces, found, angles, columns, system) for forces in case.cylinders)
    refuse_absent(parts, columns or (), "forces", _ALL_COLUMNS, columns_of(case, _ALL_COLUMNS) if columns else ())
    title = f"{machine.name}. Kräfte im Kurbeltriebe"
    return Report(title, "forces", machine.name, "cylinders", parts, notes=mechanism_notes(machine))


def _part(
    case: Case,
    forces: CylinderForces,
    found: Sequence[Note],
    angles: Sequence[float],
    columns: Sequence[str] | None,
    system: str,
) -> Part:
    cylinder = forces.drive.cylinder
    if may_lock(cylinder):
        # first, so that a crosshead that locks itself is told with an angle that does not depend on the step
        forces.extremes_of("N")
    fitting = FORCE_COLUMNS if cylinder.mechanism.slides else _ALL_COLUMNS
    return Part(
        cylinder.name,
        cylinder_columns(forces, angles, columns or fitting, _ALL_COLUMNS, system),
        Later(lambda: _shown_key_values(forces, system)),
        Later(lambda: (*left_out(case.machine, cylinder), *_no_loss(forces))),
        Later(lambda: _warnings(case.machine, forces, found)),
    )


def _shown_key_values(forces: CylinderForces, system: str) -> tuple[KeyValue, ...]:
    with np.errstate(all="ignore"):  # what overflows is refused by name
        return tuple(shown_key_value(name, value, system) for name, value in key_values(forces))


def _warnings(machine: Machine, forces: CylinderForces, found: Iterable[Note]) -> tuple[str, ...]:
    of_this = of_cylinder(found, machine, forces.drive.cylinder)
    return (*of_this, *_balance_warnings(forces), *_pin_warnings(forces))


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


def _pin_warnings(forces: CylinderForces) -> Iterable[str]:
    found, bound = forces.pin_pressure, forces.drive.mechanism.pin_pressure_bound
    if found is not None and bound is not None and found.value > bound:
        yield f"the pressure on the crank pin, {show(found.value, 'pressure')}, is above {show(bound, 'pressure')}"


def key_values(forces: CylinderForces) -> Iterable[tuple[str, Any]]:
    """Yield (id, value in SI) of every key value that this cylinder has; the value may be an Extreme or a tuple."""
    yield from motion_key_values(forces.motion)
    yield from _areas(forces)
    for column in _EXTREMES:
        found = forces.extremes_of(column)
        if found:
            yield f"{column}_max", found.largest
            yield f"{column}_min", found.smallest
    for name in _PARTICULAR:
        yield from given(name, getattr(forces, name))
    yield from given("phi_reversal", forces.phi_reversal)
    for name in _WORK:
        if _worth_showing(name, forces):
            yield from given(name, getattr(forces, name))


def _areas(forces: CylinderForces) -> Iterable[tuple[str, Any]]:
    cylinder = forces.drive.cylinder
    if cylinder.pistons:
        yield "A_head", cylinder.pistons[0].head_area
        yield "A_crank", cylinder.pistons[0].crank_area
    if cylinder.masses:
        yield "m", forces.drive.mass


def _worth_showing(name: str, forces: CylinderForces) -> bool:
    """Works of driving and driven pistons differ from the whole only where both kinds hang on the rod."""
    return name not in ("work_driving", "work_driven") or bool(forces.work_driving and forces.work_driven)


def _no_loss(forces: CylinderForces) -> tuple[LeftOut, ...]:
    if forces.friction_work is None or forces.work_driving:
        return ()
    return (LeftOut("friction loss as a share", "no piston drives"),)


def limited_values(machine: Machine) -> list[tuple[str, str, float]]:
    """Return (cylinder, id, value in SI) of all key values that a limit can be put on, of every cylinder."""
    with np.errstate(all="ignore"):
        return [
            (forces.drive.name, *one) for forces in Case(machine).cylinders for one in plain_values(key_values(forces))
        ]
