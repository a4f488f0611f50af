"""The report of `kurbel stress`: stresses place by place, forces on the bearings over the crank angle, key values."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from kurbel.declared.quantities import COLUMNS, SHAFT_PARTS, STRESSES
from kurbel.declared.unit_systems import convert
from kurbel.machine import Machine
from kurbel.report.left_out import left_out, strength_left_out
from kurbel.report.motion import given, plain_values, refuse_absent
from kurbel.report.notes import machine_notes, of_machine
from kurbel.report.shown import shown_column, shown_columns, shown_key_value
from kurbel.report.tables import Column, Part, PlaceTable, Report
from kurbel.solver.case import Case
from kurbel.solver.strength.crankshaft import CrankshaftStrength, Strained

STRESS_COLUMNS = (
    *("phi", "D", "T", "A_D", "A_T", "B_D", "B_T"),
    *(f"{stress}_{part}" for stress in ("sigma", "mises") for part in SHAFT_PARTS),
)
"""Ids of the columns of `kurbel stress`, in the order in which they are printed."""

_PRESSED = {"pin": "pin", "journal_A": "A", "journal_B": "B"}
"""Parts that turn in a bearing, and what the solver calls the force on it."""

_TITLES = {
    "dead_centre": "Dead centre, full piston force without inertia",
    "largest_torque": "Position of the largest torque",
    "largest_stress": "Whole cycle: each place where its combined stress is largest",
}
_SHELLS = (
    (25, "bronze shells stand it (25)"),
    (30, "too much for bronze shells (25), white metal stands it (30)"),
    (35, "only the best white metal stands it (30 to 35)"),
    (float("inf"), "more than white metal stands (30 to 35)"),
)
"""p_m v of the crank pin in kgf m/(cm² s), and what G says of it up to there."""


def stress_report(
    case: Case, angles: Sequence[float], columns: Sequence[str] | None, system: str, places_only: bool = False
) -> Report:
    """Return the stresses of the crankshaft, with columns at the crank angles (n,) in degrees.

    columns: ids to show besides φ, None for all that the machine has; places_only: no columns over the crank angle.
    system: `si` or `technical`. Raises UsageError where the machine has no crankshaft that can be examined.
    """
    machine = case.machine
    with np.errstate(all="ignore"):  # what overflows is refused, by name
        strength = case.strength
        cylinder = machine.cylinders[0]
        values = tuple(key_values(strength))
        cool, verdict = _shell_verdict(strength)
        whole = Part(
            machine.name,
            () if places_only else _columns(strength, angles, columns or STRESS_COLUMNS, system),
            tuple(shown_key_value(name, value, system) for name, value in values),
            (*left_out(machine, cylinder), *strength_left_out(machine)),
            (*of_machine(machine_notes(machine, case), machine), *(() if cool else verdict)),
            tuple(_place_tables(strength, system)),
        )
    notes = (*_NOTES, *((_TURNING_ROD,) if strength.rod_pull else ()), *(verdict if cool else ()))
    refuse_absent((whole,), () if places_only else columns or (), "stress", STRESS_COLUMNS)
    title = f"{machine.name}. Festigkeit der Kurbelwelle"
    return Report(title, "stress", machine.name, "cylinders", (), whole, notes=notes)


_NOTES = (
    "A and B are the forces of the shaft on its bearings, told in the frame that turns with the throw: "
    "D toward the shaft, T in the sense of rotation.",
    "The dead centre is loaded as in starting (R p. 608); columns, largest stresses and pressures are those of the "
    "running machine.",
)

_TURNING_ROD = (
    "The part of the connecting rod that turns with the crank pin pulls it outward with C_rod: pin and bearings carry "
    "D less C_rod."
)


def _columns(
    strength: CrankshaftStrength, angles: Sequence[float], columns: Sequence[str], system: str
) -> tuple[Column, ...]:
    def values_at(degrees: Any) -> Callable[[str], Any]:
        at = strength.at(degrees)
        return lambda name: getattr(at, name) if name in STRESS_COLUMNS else None

    return shown_columns(columns, values_at, angles, system)


def _place_tables(strength: CrankshaftStrength, system: str) -> Iterable[PlaceTable]:
    found = (strength.at_dead_centre, strength.at_largest_torque, strength.at_worst)
    for (id, title), strained in zip(_TITLES.items(), found):
        names = tuple((one.place.part, one.place.name.replace(" ", "_")) for one in strained)
        yield PlaceTable(id, title, ("part", "place"), names, tuple(_place_columns(strained, system)))


def _place_columns(strained: tuple[Strained, ...], system: str) -> Iterable[Column]:
    yield shown_column(COLUMNS["phi"], [one.degrees for one in strained], system)
    for name, quantity in STRESSES.items():
        values = [getattr(one if name in ("combined", "von_mises") else one.stresses, name) for one in strained]
        yield shown_column(quantity, values, system)


def key_values(strength: CrankshaftStrength) -> Iterable[tuple[str, Any]]:
    """Yield (id, value in SI) of every key value that the crankshaft has; the value may be an Extreme."""
    yield "P_dc", strength.full_force
    yield from given("C_rod", strength.rod_pull or None)
    for part in strength.parts:
        yield f"sigma_{part}_dc", strength.sigma_dc(part).value
    for part in strength.parts:
        yield f"sigma_{part}_max", strength.sigma_max(part)
    for part in strength.parts:
        yield f"mises_{part}_max", strength.mises_max(part)
    for part in strength.parts:
        yield from given(f"safety_{part}_min", strength.safety(part))
    yield from _bearing_values(strength)
    yield "equilibrium_residual", strength.equilibrium_residual


def _bearing_values(strength: CrankshaftStrength) -> Iterable[tuple[str, Any]]:
    yield "A_max", strength.load_max("A")
    yield "B_max", strength.load_max("B")
    yield "p_pin_dc", strength.pin_pressure_dc
    for part, bearing in _PRESSED.items():
        yield from given(f"p_{part}_max", strength.pressure_max(bearing))
        yield from given(f"p_{part}_mean", strength.pressure_mean(bearing))
        yield from given(f"k_{part}", strength.pressure_velocity(bearing))


def _shell_verdict(strength: CrankshaftStrength) -> tuple[bool, tuple[str, ...]]:
    """Return whether all shells stand p_m v of the crank pin, and a sentence that tells (G); none without a speed."""
    found = strength.pressure_velocity("pin")
    if found is None:
        return True, ()
    shown = convert(found, "pressure_velocity", "kgf m/s/cm2")
    bound, verdict = next((shell for shell in _SHELLS if shown <= shell[0]), _SHELLS[-1])
    return bound == _SHELLS[0][0], (f"Crank pin: p_m v = {shown:.3g} kgf m/(cm² s); {verdict}.",)


def limited_values(machine: Machine) -> list[tuple[str, str, float]]:
    """Return ("crankshaft", id, value in SI) of all key values that a limit can be put on."""
    with np.errstate(all="ignore"):
        return [("crankshaft", *one) for one in plain_values(key_values(Case(machine).strength))]
