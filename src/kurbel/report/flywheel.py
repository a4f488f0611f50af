"""The report of `kurbel flywheel`: turning effort, excess work, flywheel and speed line of the whole machine."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from kurbel.declared.unit_systems import show
from kurbel.machine import Machine
from kurbel.report.left_out import flywheel_left_out
from kurbel.report.motion import given, plain_values, refuse_absent
from kurbel.report.notes import machine_notes, of_machine
from kurbel.report.shown import shown_columns, shown_key_value
from kurbel.report.tables import Column, Part, Report
from kurbel.solver.case import Case
from kurbel.solver.turning.flywheel import MachineTurning

FLYWHEEL_COLUMNS = ("phi", "T", "T_inertia", "M", "E", "omega", "M_coupling")
"""Ids of the columns of `kurbel flywheel`, in the order in which they are printed."""

_KEY_VALUES = (
    *("W", "M_mean", "work_shaft", "power_shaft", "T_max", "T_min", "M_max", "M_min"),
    *("phi_crossing", "lobes", "E_max", "E_min", "dE", "energy_fluctuation"),
    *(
        "J",
        "GD2",
        "J_needed",
        "GD2_needed",
        "J_exact",
        "delta",
        "delta_book",
        "omega_max",
        "omega_min",
        "omega_mean",
        "multiplier",
    ),
)
_OF_COUPLING = ("M_coupling_max", "M_coupling_min", "amplification")
_BEYOND = 1e308
"""Floquet multiplier that is as large as a float can be."""
_LINEAR = 0.1
"""δ up to which a harmonic balance about the mean speed may be trusted."""


def flywheel_report(case: Case, angles: Sequence[float], columns: Sequence[str] | None, system: str) -> Report:
    """Return the turning effort of the machine at the crank angles (n,) of crank 1 in degrees, with its key values.

    columns: ids to show besides φ, None for all that the machine has; system: `si` or `technical`.
    Raises UsageError where nothing turns the shaft, NoSolutionError where the machine stalls.
    """
    machine = case.machine
    with np.errstate(all="ignore"):  # what overflows is refused, by name
        turning = case.flywheel
        whole = Part(
            "whole machine",
            _columns(turning, angles, columns or FLYWHEEL_COLUMNS, system),
            tuple(shown_key_value(name, value, system) for name, value in key_values(turning)),
            flywheel_left_out(machine),
            tuple(_warnings(case, turning)),
        )
        parts = tuple(_cylinder_parts(case, system))
        there = [column.id for column in _columns(turning, (0.0,), FLYWHEEL_COLUMNS, system)] if columns else []
    refuse_absent((whole,), columns or (), "flywheel", FLYWHEEL_COLUMNS, there)
    title = f"{machine.name}. Drehkraftlinie und Schwungrad"
    return Report(title, "flywheel", machine.name, "cylinders", parts, whole, notes=tuple(_notes(machine, turning)))


def _columns(
    turning: MachineTurning, angles: Sequence[float], columns: Sequence[str], system: str
) -> tuple[Column, ...]:
    def values_at(degrees: Any) -> Callable[[str], Any]:
        at = turning.at(degrees)
        return lambda name: getattr(at, name) if name in FLYWHEEL_COLUMNS else None

    return shown_columns(columns, values_at, angles, system)


def key_values(turning: MachineTurning, repeated: bool = False) -> Iterable[tuple[str, Any]]:
    """Yield (id, value in SI) of every key value that the machine has; the value may be an Extreme or a tuple.

    repeated: also the flywheel for the wanted δ where it is the flywheel.
    """
    for name in _KEY_VALUES:
        if repeated or not (name.endswith("_needed") and turning.J_needed == turning.J):
            yield from given(name, getattr(turning, name))
    yield from given("natural_order", turning.natural_order)
    if turning.elastic:
        for name in _OF_COUPLING:
            yield from given(name, getattr(turning.elastic, name))


def _cylinder_parts(case: Case, system: str) -> Iterable[Part]:
    """Yield what is to be said of a cylinder alone: the force that its parts before a pump must stand."""
    for forces in case.cylinders:
        found = case.flywheel.dead_centre_force(forces)
        if found is not None:
            yield Part(forces.drive.name, (), (shown_key_value("P_dead_centre", found, system),))


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


def limited_values(machine: Machine) -> list[tuple[str, str, float]]:
    """Return (what it belongs to, id, value in SI) of all key values that a limit can be put on."""
    with np.errstate(all="ignore"):
        case = Case(machine)
        found = [("whole machine", *one) for one in plain_values(key_values(case.flywheel, repeated=True))]
        for forces in case.cylinders:
            in_centre = given("P_dead_centre", case.flywheel.dead_centre_force(forces))
            found += [(forces.drive.name, *one) for one in plain_values(in_centre)]
    return found
