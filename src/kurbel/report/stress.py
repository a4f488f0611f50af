"""The report of `kurbel stress`: the strength of the crankshaft, place by place."""

from collections.abc import Iterator
from itertools import chain

from kurbel.notes.left_out import left_out, strength_left_out
from kurbel.notes.machine_results import rods_on_pin, shells
from kurbel.notes.warnings import of_machine
from kurbel.quantity import PHI, Quantity, by_id
from kurbel.solver.case import Case
from kurbel.solver.chapters.stress import CrankshaftStrength, ThrowStrength
from kurbel.solver.chapters.stress_places import PARTS
from kurbel.tables.frame import CommandReport, Subject
from kurbel.tables.shown import PlaceRow, Places

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

THROWS = by_id(
    *(
        Quantity(
            f"sigma_{part}_max",
            f"σ_{index}",
            "stress",
            f"Largest combined stress of {words} over the cycle",
        )
        for part, (index, words) in PARTS.items()
    ),
    Quantity("safety_min", "S", "ratio", "Smallest safety of any part of the throw"),
    Quantity("M_B_peak", "M_B", "torque", "Largest torque in journal B, by magnitude"),
)
"""Of one throw of a crankshaft, by id."""


def _stressed(case: Case) -> list[Subject]:
    """Return the throws, if there are several, and the whole crankshaft, the worst of them."""
    strength = case.stress
    parts = list[Subject]()
    if strength.only is None:
        at = None
        tables = _throw_table(strength)
        for throw in strength.throws:
            called = f"{throw.name.capitalize()}. "
            parts.append(Subject(throw.name, throw, throw.at, tables=_stress_tables(throw, called)))
    else:
        at = strength.at
        tables = _stress_tables(strength.only)
    crankshaft = Subject(
        "crankshaft",
        strength,
        at,
        left_out=chain(
            left_out(case.machine, case.machine.cylinders[0]), strength_left_out(case.machine)
        ),
        warnings=of_machine(case),
        tables=tables,
        whole=True,
    )
    return [*parts, crankshaft]


def _stress_tables(throw: ThrowStrength, called: str = "") -> Iterator[Places]:
    """Yield the tables of the places of a throw; called: what begins their titles, where there are several throws."""
    for id, title, places in (
        ("dead_centre", "Dead centre, full piston force without inertia", throw.at_dead_centre),
        ("largest_torque", "Position of the largest torque", throw.at_largest_torque),
        (
            "largest_stress",
            "Whole cycle: each place where its combined stress is largest",
            throw.at_worst,
        ),
    ):
        rows: list[PlaceRow] = []
        for place in places:
            stresses = (
                place.compression,
                place.bending_in_plane,
                place.bending_out_of_plane,
                place.torsion,
            )
            values = (place.degrees, *stresses, place.combined, place.von_mises)
            numbers = (None if stress is None else float(stress) for stress in values)
            part = _name_of(place.part)
            rows.append(((part, place.name), dict(zip(("phi", *STRESSES), numbers))))
        yield Places(id, called + title, ("part", "place"), {"phi": PHI, **STRESSES}, rows)


def _throw_table(strength: CrankshaftStrength) -> Iterator[Places]:
    """Yield the table of the throws along the shaft."""
    rows: list[PlaceRow] = []
    for throw in strength.throws:
        values: dict[str, float | None] = {}
        for part in PARTS:
            stress = throw.answers.get(f"sigma_{part}_max")
            values[f"sigma_{part}_max"] = None if stress is None else float(stress.value)
        safeties = [throw.answers.get(f"safety_{part}_min") for part in PARTS]
        values["safety_min"] = min(
            (float(safety.value) for safety in safeties if safety is not None), default=None
        )
        values["M_B_peak"] = abs(float(throw.peak_torque.value))
        cylinders = ", ".join(forces.drive.name for forces in throw.rods)
        rows.append(((throw.name, cylinders), values))
    title = "Throws along the shaft: largest combined stresses over the cycle"
    yield Places("throws", title, ("throw", "cylinders"), THROWS, rows)


def _name_of(part: str) -> str:
    """Return what people call a part of a crankshaft: `web A`; the pin has no article in a table."""
    _, name = PARTS[part]
    return name if part != "pin" else part


def _stress_notes(case: Case) -> Iterator[str]:
    strength = case.stress
    yield (
        "A and B are the forces of the shaft on its bearings, given in the frame that turns with the throw: "
        "D toward the shaft, T in the sense of rotation."
    )
    yield (
        "The dead centre is loaded as in starting (R p. 608); columns, largest stresses and pressures are those of the "
        "running machine."
    )
    if strength.only is None:
        yield (
            "Statically determinate, throw by throw: the shaft counts as hinged in every bearing between two throws, "
            "and 'crankshaft' as the throw of every cylinder; torque is carried through from the free end. φ is the "
            "angle of crank 1, and bearings between two throws carry A and B of both: see 'kurbel bearings'."
        )
        yield "The torque is that of uniform rotation; compare it with the vibratory torque of 'kurbel torsion'."
    if any(len(throw.rods) > 1 for throw in strength.throws):
        yield f"{rods_on_pin(strength.shaft.rod_spacing)} In the dead centre each rod is loaded by itself."
    if strength.C_rod:
        yield (
            "The part of the connecting rod that turns with the crank pin pulls it outward with C_r: pin and "
            "bearings carry D less C_r."
        )
    cool, verdict = shells(case)
    if cool and verdict:
        yield verdict


STRESS = CommandReport("Strength of the crankshaft", _stressed, _stress_notes)
