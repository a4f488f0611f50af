"""The report of `kurbel forces`: which quantities are shown, in which unit and order."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.mechanisms import Extreme
from kurbel.quantities import COLUMNS, KEY_VALUES, Quantity
from kurbel.report.left_out import left_out, warnings
from kurbel.report.tables import Column, KeyValue, LeftOut, Part, Report
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from kurbel.units import SYSTEMS, unit_factor

FORCE_COLUMNS = (
    *("phi", "psi", "x", "c", "b", "p_head", "p_crank", "P_gas", "P_inertia", "P_weight"),
    *("P", "S", "N", "D", "T", "F_friction", "M"),
)
"""Ids of the columns of `kurbel forces`, in the order in which they are printed."""

_MOTION = ("stroke", "phi_idc", "phi_odc", "time_ratio", "v", "c_m", "c_max", "c_min", "b_max", "b_min", "phi_b_zero")
_UNEQUAL_STROKES = ("time_ratio", "c_min")
"""Key values that say something new only where the two strokes differ."""
_EXTREMES = ("P", "P_start", "P_inertia", "S", "N", "T")
_WORK = (
    *("work", "work_driving", "work_driven", "power", "mean_pressure", "W", "friction_work"),
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
        parts = tuple(_part(case, forces, angles, columns, system) for forces in case.cylinders)
    _refuse_absent(parts, columns or ())
    return Report(f"{machine.name}. Kräfte im Kurbeltriebe", "forces", machine.name, "cylinders", parts)


def _refuse_absent(parts: Sequence[Part], columns: Sequence[str]) -> None:
    shown = {column.id for part in parts for column in part.columns}
    for name in columns:
        if name not in shown:
            raise UsageError(f"--columns: '{name}' is left out for this machine; kurbel check says what is, and why")


def _part(
    case: Case, forces: CylinderForces, angles: Sequence[float], columns: Sequence[str] | None, system: str
) -> Part:
    cylinder = forces.drive.cylinder
    return Part(
        cylinder.name,
        tuple(_columns(forces, angles, columns or FORCE_COLUMNS, system)),
        tuple(_key_value(KEY_VALUES[name], value, system) for name, value in key_values(forces)),
        (*left_out(case.machine, cylinder), *_no_loss(forces)),
        warnings(cylinder),
    )


def _columns(forces: CylinderForces, angles: Sequence[float], columns: Sequence[str], system: str) -> Iterable[Column]:
    state = forces.at(angles)
    for name in ("phi", *(name for name in dict.fromkeys(columns) if name != "phi")):
        values = getattr(state, name) if name in FORCE_COLUMNS else None
        if values is not None:
            yield _column(COLUMNS[name], np.asarray(values), system)


def _column(quantity: Quantity, values: Any, system: str) -> Column:
    unit = SYSTEMS[system][quantity.kind]
    shown = _in_unit(values, quantity, system)
    if not np.isfinite(shown).all():
        raise _too_large(quantity)
    return Column(
        quantity.id, quantity.symbol, quantity.ascii_symbol, unit, tuple((shown + 0.0).tolist()), quantity.text
    )


def _in_unit(value: Any, quantity: Quantity, system: str) -> Any:
    unit = SYSTEMS[system][quantity.kind]
    if not unit or system == "si":
        return value
    up, down = unit_factor(unit, quantity.kind)
    return value / up * down


def _too_large(quantity: Quantity) -> UsageError:
    return UsageError(f"{quantity.id} is too large to compute with: check the numbers and units of the machine file")


def key_values(forces: CylinderForces) -> Iterable[tuple[str, Any]]:
    """Yield (id, value in SI) of every key value that this cylinder has; the value may be an Extreme or a tuple."""
    motion = forces.motion
    unequal = abs(motion.time_ratio - 1) > 1e-12
    for name in _MOTION:
        if unequal or name not in _UNEQUAL_STROKES:
            yield from _given(name, getattr(motion, name))
    yield from _areas(forces)
    for column in _EXTREMES:
        found = forces.extremes_of(column)
        if found:
            yield f"{column}_max", found.largest
            yield f"{column}_min", found.smallest
    yield from _given("phi_reversal", forces.phi_reversal)
    for name in _WORK:
        if _worth_showing(name, forces):
            yield from _given(name, getattr(forces, name))


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


def _given(name: str, value: Any) -> Iterable[tuple[str, Any]]:
    if value is not None:
        yield name, value


def _key_value(quantity: Quantity, value: Any, system: str) -> KeyValue:
    at = value.degrees if isinstance(value, Extreme) else None
    raw = value.value if isinstance(value, Extreme) else value
    listed = isinstance(raw, tuple)
    each: tuple[float, ...] = raw if isinstance(raw, tuple) else (raw,)
    shown = [float(_in_unit(one, quantity, system)) + 0.0 for one in each]
    if not all(math.isfinite(one) for one in shown):
        raise _too_large(quantity)
    unit = SYSTEMS[system][quantity.kind]
    return KeyValue(
        quantity.id,
        quantity.symbol,
        quantity.ascii_symbol,
        unit,
        tuple(shown) if listed else shown[0],
        quantity.text,
        at,
    )


def _no_loss(forces: CylinderForces) -> tuple[LeftOut, ...]:
    if forces.friction_work is None or forces.work_driving:
        return ()
    return (LeftOut("friction loss as a share", "no piston drives"),)


def limited_values(machine: Machine) -> list[tuple[str, str, float]]:
    """Return (cylinder, id, value in SI) of all key values that a limit can be put on, of every cylinder."""
    with np.errstate(all="ignore"):
        return [
            (forces.drive.name, name, value.value if isinstance(value, Extreme) else value)
            for forces in Case(machine).cylinders
            for name, value in key_values(forces)
            if isinstance(value, (Extreme, float))
        ]
