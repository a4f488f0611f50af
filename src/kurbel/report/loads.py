"""The reports of `kurbel bearings` and `kurbel stress`: the loads on pins and bearings, and stresses in the shaft."""

from collections.abc import Hashable, Iterator
from dataclasses import replace

import numpy as np

from kurbel.quantity import PHI, Quantity, by_id
from kurbel.report.alike import equal_loads, grouped
from kurbel.report.frame import Frame, Row, Subject, place_table, report_on, shown_key_values
from kurbel.report.left_out import bearing_left_out, bearings_left_out, left_out, strength_left_out
from kurbel.report.tables import PlaceTable, Report
from kurbel.report.warnings import as_far_as_solved, bearing_warnings, of_machine, shell_verdict
from kurbel.solver.bearings import Bearing
from kurbel.solver.case import Case
from kurbel.solver.stress import CrankshaftStrength

STRESSES = by_id(
    Quantity("compression", "σ_c", "stress", "Compression of a web by the force along it, negative where it is pulled"),
    Quantity("bending_in_plane", "σ_b1", "stress", "Bending in the plane of the throw"),
    Quantity("bending_out_of_plane", "σ_b2", "stress", "Bending square to the plane of the throw"),
    Quantity("torsion", "τ", "stress", "Torsion"),
    Quantity("combined", "σ_res", "stress", "Combined stress 0.35 σ + 0.65 √(σ² + 4(α₀τ)²) (Bach)"),
    Quantity("von_mises", "σ_v", "stress", "Equivalent stress √(σ² + 3τ²) (von Mises)"),
)
"""Stresses at one place of a crankshaft, by id."""


# pins and bearings


@np.errstate(all="ignore")  # what overflows is refused by name
def bearings_report(case: Case, frame: Frame) -> Report:
    """Return the loads on pins and main bearings over the angle of crank 1, each as a part.

    Raises UsageError if nothing loads them.
    """
    parts = [replace(_bearing(one), left_out=tuple(bearing_left_out(*one.size, one.omega))) for one in _bearings(case)]
    whole = Subject("whole machine")
    if frame.prose:
        warnings = (*of_machine(case), *as_far_as_solved(bearing_warnings(case), "bearings"))
        whole = Subject("whole machine", left_out=tuple(bearings_left_out(case)), warnings=warnings)
    report = report_on(frame, case.machine, "Bearing loads", parts, whole, _bearing_notes(case))
    return report._replace(group="bearings")


def bearings_subjects(case: Case) -> list[Subject]:
    """Return every pin and main bearing."""
    return [_bearing(one) for one in _bearings(case)]


def equal_bearings(case: Case) -> list[list[Bearing]]:
    """Return the pins and main bearings, those together that carry equal loads."""

    def load(part: Bearing) -> Hashable:
        one = _bearing(part)
        return equal_loads(one.name, one.of, shown_key_values(one.key_values("bearings"), "si"))

    return grouped(_bearings(case), load)


def _bearings(case: Case) -> list[Bearing]:
    for forces in case.cylinders:
        forces.refuse_locking()
    return list(case.bearings.parts)


def _bearing(part: Bearing) -> Subject:
    of = part.followed[0].cylinder.name if part.of_rod else ""
    return Subject(part.name, (part,), part.at, of=of)


def _bearing_notes(case: Case) -> Iterator[str]:
    machine, line = case.machine, case.bearings.line
    yield (
        "Loads are those of a rod on its pin and of the shaft on its bearings. Directions count in the sense of "
        "rotation: ε_K from the throw outward (of a main bearing from that of crank 1), ε_M from the stroke line of "
        "cylinder 1 outward, ε_S from the rod's line, crank pin to crosshead. A surface counts as loaded 60° to either "
        "side of where it is pressed; crank pins and journals turn with the throw, crosshead pins and main shells "
        "stand in the engine."
    )
    if len(machine.cylinders) > 1:
        yield "φ is the angle of crank 1."
    if line and len(line.throws) > 1:
        yield (
            "Statically determinate, throw by throw: the shaft counts as hinged in every bearing between two throws, "
            "and 'crankshaft' as the throw of every cylinder."
        )
    if line and any(len(throw.cylinders) > 1 for throw in line.throws):
        yield "Rods on one pin are side by side, each on an equal part of its length; all load the pin in its middle."
    if any(one.masses and one.masses.undivided for one in machine.cylinders):
        yield "'reciprocating' is one sum, all of which counts as pushing on the crosshead pin."


# stresses in the crankshaft

_TITLES = {
    "dead_centre": "Dead centre, full piston force without inertia",
    "largest_torque": "Position of the largest torque",
    "largest_stress": "Whole cycle: each place where its combined stress is largest",
}


@np.errstate(all="ignore")  # what overflows is refused by name
def stress_report(case: Case, frame: Frame, places_only: bool = False) -> Report:
    """Return the stresses of the crankshaft place by place, and its bearing forces over the crank angle.

    places_only: without the crank angle. Raises UsageError if no crankshaft can be examined.
    """
    machine = case.machine
    (whole,) = stress_subjects(case)
    whole = replace(whole, tables=tuple(_stress_tables(case.stress, frame.system)))
    if places_only:
        whole = replace(whole, at=None)
    if frame.prose:
        lacking = (*left_out(machine, machine.cylinders[0]), *strength_left_out(machine))
        whole = replace(whole, left_out=lacking, warnings=of_machine(case))
    return report_on(frame, machine, "Strength of the crankshaft", (), whole, _stress_notes(case.stress))


def stress_subjects(case: Case) -> list[Subject]:
    """Return the crankshaft."""
    return [Subject("crankshaft", (case.stress,), case.stress.at)]


def _stress_tables(strength: CrankshaftStrength, system: str) -> Iterator[PlaceTable]:
    found = (strength.at_dead_centre, strength.at_largest_torque, strength.at_worst)
    for (id, title), places in zip(_TITLES.items(), found):
        rows: list[Row] = []
        for one in places:
            values = {id: getattr(one, id) for id in STRESSES}
            rows.append(((one.part, one.name), {"phi": one.degrees, **values}))
        yield place_table(id, title, ("part", "place"), {"phi": PHI, **STRESSES}, rows, system)


def _stress_notes(strength: CrankshaftStrength) -> Iterator[str]:
    yield (
        "A and B are the forces of the shaft on its bearings, given in the frame that turns with the throw: "
        "D toward the shaft, T in the sense of rotation."
    )
    yield (
        "The dead centre is loaded as in starting (R p. 608); columns, largest stresses and pressures are those of the "
        "running machine."
    )
    if strength.C_rod:
        yield (
            "The part of the connecting rod that turns with the crank pin pulls it outward with C_rod: pin and "
            "bearings carry D less C_rod."
        )
    cool, verdict = shell_verdict(strength.pressure_velocity("pin"))
    if cool and verdict:
        yield verdict
