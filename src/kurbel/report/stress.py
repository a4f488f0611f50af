"""The report of `kurbel stress`: the strength of the crankshaft, place by place."""

from collections.abc import Iterator
from itertools import chain

from kurbel.notes.left_out import (
    left_out,
    strength_left_out,
)
from kurbel.notes.warnings import (
    of_machine,
    shells,
)
from kurbel.quantity import PHI, Quantity, by_id
from kurbel.solver.case import Case
from kurbel.solver.chapters.stress import CrankshaftStrength
from kurbel.tables.frame import Functions, PlaceRow, Places, Subject

STRESSES = by_id(
    Quantity(
        "compression",
        "σ_c",
        "stress",
        "Compressive stress of a web by the force along it, negative in tension",
    ),
    Quantity("bending_in_plane", "σ_b1", "stress", "Bending in the plane of the throw"),
    Quantity(
        "bending_out_of_plane", "σ_b2", "stress", "Bending perpendicular to the plane of the throw"
    ),
    Quantity("torsion", "τ", "stress", "Torsion"),
    Quantity("combined", "σ_res", "stress", "Combined stress 0.35 σ + 0.65 √(σ² + 4(α₀τ)²) (Bach)"),
    Quantity("von_mises", "σ_v", "stress", "Equivalent stress √(σ² + 3τ²) (von Mises)"),
)
"""Stresses at one place of a crankshaft, by id."""


def _stressed(case: Case) -> list[Subject]:
    return [
        Subject(
            "crankshaft",
            case.stress,
            case.stress.at,
            left_out=chain(
                left_out(case.machine, case.machine.cylinders[0]), strength_left_out(case.machine)
            ),
            warnings=of_machine(case),
            tables=_stress_tables(case.stress),
            whole=True,
        )
    ]


def _stress_tables(strength: CrankshaftStrength) -> Iterator[Places]:
    for id, title, places in (
        ("dead_centre", "Dead centre, full piston force without inertia", strength.at_dead_centre),
        ("largest_torque", "Position of the largest torque", strength.at_largest_torque),
        (
            "largest_stress",
            "Whole cycle: each place where its combined stress is largest",
            strength.at_worst,
        ),
    ):
        rows: list[PlaceRow] = []
        for one in places:
            stresses = (
                one.compression,
                one.bending_in_plane,
                one.bending_out_of_plane,
                one.torsion,
            )
            values = (one.degrees, *stresses, one.combined, one.von_mises)
            numbers = (None if value is None else float(value) for value in values)
            rows.append(((one.part, one.name), dict(zip(("phi", *STRESSES), numbers))))
        yield Places(id, title, ("part", "place"), {"phi": PHI, **STRESSES}, rows)


def _stress_notes(case: Case) -> Iterator[str]:
    yield (
        "A and B are the forces of the shaft on its bearings, given in the frame that turns with the throw: "
        "D toward the shaft, T in the sense of rotation."
    )
    yield (
        "The dead centre is loaded as in starting (R p. 608); columns, largest stresses and pressures are those of the "
        "running machine."
    )
    if case.stress.C_rod:
        yield (
            "The part of the connecting rod that turns with the crank pin pulls it outward with C_r: pin and "
            "bearings carry D less C_r."
        )
    cool, verdict = shells(case)
    if cool and verdict:
        yield verdict


STRESS = Functions("Strength of the crankshaft", _stressed, _stress_notes)
