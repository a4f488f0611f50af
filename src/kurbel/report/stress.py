"""The report of `kurbel stress`: stresses place by place, forces on the bearings over the crank angle, key values."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from kurbel.declared.factors import PHI
from kurbel.declared.quantity import Quantity
from kurbel.declared.shaft import STRESSES
from kurbel.report.frame import Frame, Subject
from kurbel.report.left_out import left_out, strength_left_out
from kurbel.report.notes import of_machine
from kurbel.report.shown import place_table
from kurbel.report.tables import PlaceTable, Report
from kurbel.report.warnings import shell_verdict
from kurbel.solver.case import Case
from kurbel.solver.stress import CrankshaftStrength, Place

_TITLES = {
    "dead_centre": "Dead centre, full piston force without inertia",
    "largest_torque": "Position of the largest torque",
    "largest_stress": "Whole cycle: each place where its combined stress is largest",
}


@np.errstate(all="ignore")  # what overflows is refused, by name
def stress_report(case: Case, frame: Frame, places_only: bool = False) -> Report:
    """Return the stresses of the crankshaft; places_only: no columns over the crank angle.

    Raises UsageError where no crankshaft can be examined.
    """
    (whole,) = subjects(case)
    tables = tuple(_place_tables(case.stress, frame.system))
    whole = replace(whole, place_tables=tables, at=None if places_only else whole.at)
    cool, verdict = shell_verdict(case.stress)
    notes = (*_NOTES, *((_TURNING_ROD,) if case.stress.C_rod else ()), *(verdict if cool else ()))
    return frame.report(case.machine, "Festigkeit der Kurbelwelle", (), whole, notes)


def subjects(case: Case) -> Iterable[Subject]:
    """Yield the crankshaft."""
    machine, strength = case.machine, case.stress
    yield Subject(
        "crankshaft",
        (strength,),
        strength.at,
        left_out=lambda: (*left_out(machine, machine.cylinders[0]), *strength_left_out(machine)),
        warnings=lambda: of_machine(case),
    )


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


def _place_tables(strength: CrankshaftStrength, system: str) -> Iterable[PlaceTable]:
    found = (strength.at_dead_centre, strength.at_largest_torque, strength.at_worst)
    for (id, title), strained in zip(_TITLES.items(), found):
        names = ((one.part, one.name.replace(" ", "_")) for one in strained)
        yield place_table(id, title, ("part", "place"), names, _place_columns(strained), system)


def _place_columns(strained: tuple[Place, ...]) -> Iterable[tuple[Quantity, list[float]]]:
    yield PHI, [one.degrees for one in strained]
    for name, quantity in STRESSES.items():
        yield quantity, [getattr(one, name) for one in strained]
