"""The report of `kurbel motion`, and the key values of motion that `kurbel forces` prints as well."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.numerics.extreme import Extreme
from kurbel.report.left_out import motion_left_out
from kurbel.report.shown import shown_columns, shown_key_value
from kurbel.report.tables import Column, Part, Report
from kurbel.solver.case import Case
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.cylinder.motion import Motion

MOTION_COLUMNS = (
    *("phi", "psi", "x", "c", "b", "theta", "theta_dot", "theta_ddot"),
    *("c_block", "x_coupler", "y_coupler", "bx_coupler", "by_coupler"),
)
"""Ids of the columns of `kurbel motion`, in the order in which they are printed."""

_KEY_VALUES = (
    *("stroke", "swing", "theta_min", "theta_max", "phi_idc", "phi_odc", "phi_work", "phi_return", "time_ratio"),
    *("v", "c_m", "c_max", "c_min", "c_work_max", "c_return_max", "b_max", "b_min", "phi_b_zero"),
    *("theta_dot_max", "theta_dot_min", "theta_ddot_max", "theta_ddot_min", "b_coupler"),
    *("transmission_min", "transmission_max"),
)
_UNEQUAL_STROKES = ("phi_work", "phi_return", "time_ratio", "c_min")
"""Key values that say something new only where the two strokes differ."""


def motion_report(case: Case, angles: Sequence[float], columns: Sequence[str] | None, system: str) -> Report:
    """Return the motion of every cylinder's mechanism at the crank angles (n,) in degrees.

    columns: ids to show besides φ, None for all that the mechanism has; system: `si` or `technical`.
    """
    machine = case.machine
    if not machine.cylinders:
        raise UsageError(f"{machine.name} has no cylinder; kurbel motion needs one")
    with np.errstate(all="ignore"):  # what overflows is refused by name
        parts = tuple(_part(machine, forces, angles, columns, system) for forces in case.cylinders)
    refuse_absent(parts, columns or (), "motion", MOTION_COLUMNS, columns_of(case, MOTION_COLUMNS) if columns else ())
    title = f"{machine.name}. Bewegung des Kurbeltriebes"
    return Report(title, "motion", machine.name, "cylinders", parts, notes=mechanism_notes(machine))


def _part(
    machine: Machine, forces: CylinderForces, angles: Sequence[float], columns: Sequence[str] | None, system: str
) -> Part:
    cylinder = forces.drive.cylinder
    return Part(
        cylinder.name,
        cylinder_columns(forces, angles, columns, MOTION_COLUMNS, system),
        tuple(shown_key_value(name, value, system) for name, value in motion_key_values(forces.motion)),
        motion_left_out(machine, cylinder),
    )


def cylinder_columns(
    forces: CylinderForces, angles: Sequence[float], chosen: Sequence[str] | None, known: Sequence[str], system: str
) -> tuple[Column, ...]:
    """Return φ and the chosen columns, or all that are known, as far as the machine has them; angles (n,) in deg."""

    def values_at(degrees: Any) -> Callable[[str], Any]:
        state = forces.at(degrees)
        return lambda name: getattr(state, name) if name in known else None

    return shown_columns(chosen or known, values_at, angles, system)


def motion_key_values(motion: Motion) -> Iterable[tuple[str, Any]]:
    """Yield (id, value in SI) of every key value of motion that the mechanism has; an Extreme, a tuple or a number."""
    unequal = abs(motion.time_ratio - 1) > 1e-12
    for name in _KEY_VALUES:
        value = getattr(motion, name) if unequal or name not in _UNEQUAL_STROKES else None
        if value is not None and not (name == "c_min" and motion.mechanism.quick_return):
            yield name, value


def limited_values(machine: Machine) -> list[tuple[str, str, float]]:
    """Return (cylinder, id, value in SI) of all key values of motion that a limit can be put on, of every cylinder."""
    with np.errstate(all="ignore"):
        return [
            (forces.drive.name, *one)
            for forces in Case(machine).cylinders
            for one in plain_values(motion_key_values(forces.motion))
        ]


def given(name: str, value: Any) -> Iterable[tuple[str, Any]]:
    """Yield (id, value) unless the machine has no such value."""
    if value is not None:
        yield name, value


def plain_values(found: Iterable[tuple[str, Any]]) -> Iterable[tuple[str, float]]:
    """Yield (id, value in SI) of those key values that are one number."""
    for name, value in found:
        if isinstance(value, (Extreme, float)):
            yield name, value.value if isinstance(value, Extreme) else value


def mechanism_notes(machine: Machine) -> tuple[str, ...]:
    """Return what a reader should know about the mechanisms of a machine, each sentence once."""
    return tuple(dict.fromkeys(note for cylinder in machine.cylinders for note in cylinder.mechanism.notes))


def columns_of(case: Case, known: Sequence[str]) -> tuple[str, ...]:
    """Return the ids of the columns that any cylinder of a machine has."""
    states = [forces.at([0.0]) for forces in case.cylinders]
    return tuple(name for name in known if any(getattr(state, name) is not None for state in states))


def refuse_absent(
    parts: Sequence[Part], columns: Sequence[str], command: str, known: Sequence[str], there: Sequence[str] = ()
) -> None:
    """Raise UsageError for a column that was asked for and that no part has; there: ids of those that it has."""
    shown = {column.id for part in parts for column in part.columns}
    instead = f", which has {', '.join(there)}" if there else "; kurbel check says what is, and why"
    for name in columns:
        if name not in known:
            raise UsageError(f"--columns: '{name}' is no column of kurbel {command} (it has {', '.join(known)})")
        if name not in shown:
            raise UsageError(f"--columns: '{name}' is left out for this machine{instead}")
