"""The report of `kurbel bearings`: the loads on pins and main bearings."""

from collections.abc import Iterator
from itertools import chain

from kurbel.notes.left_out import (
    bearing_left_out,
    bearings_left_out,
    film_left_out,
)
from kurbel.notes.machine_results import bearing_warnings, rods_on_pin
from kurbel.notes.warnings import as_far_as_solved, of_machine
from kurbel.solver.case import Case
from kurbel.solver.chapters.bearing import Bearing
from kurbel.tables.frame import CommandReport, Subject
from kurbel.tables.tables import joined_names


def _film_warnings(case: Case) -> Iterator[str]:
    from kurbel.notes.oil_film import film_warnings

    yield from film_warnings(case)  # imported only where warnings are printed


def _loaded(case: Case) -> list[Subject]:
    for forces in case.cylinders:
        forces.refuse_locking()
    parts = [
        Subject(
            part.name,
            part,
            part.at,
            left_out=chain(bearing_left_out(*part.size, part.omega), film_left_out(part)),
            of=part.cylinders[0].drive.name if part.of_rod else "",
            where="" if part.of_rod else _next_to(part),
        )
        for part in case.bearings.parts
    ]
    warnings = chain(
        of_machine(case),
        as_far_as_solved(bearing_warnings(case), "bearings"),
        _film_warnings(case) if case.machine.oil_film else (),
    )
    return [
        *parts,
        Subject("whole machine", left_out=bearings_left_out(case), warnings=warnings, whole=True),
    ]


def _next_to(bearing: Bearing) -> str:
    """Return the cylinders on the throws to either side of a main bearing, in words."""
    names = [cylinder.drive.name for cylinder in bearing.cylinders]
    return f"next to {joined_names(names)}"


def _bearing_notes(case: Case) -> Iterator[str]:
    machine, line = case.machine, case.bearings.line
    yield (
        "Loads are those of a rod on its pin and of the shaft on its bearings. Directions are measured in the sense "
        "of rotation: ε_K from the throw outward (of a main bearing from that of crank 1), ε_M from the stroke line "
        "of cylinder 1 outward, ε_S from the rod's line, crank pin to crosshead. A surface counts as loaded 60° to "
        "either side of the load; crank pins and journals rotate with the throw, crosshead pins and main shells do "
        "not."
    )
    if machine.oil_film:
        yield (
            "Oil film by the mobility method: rigid and aligned surfaces, constant viscosity, a clearance that is "
            "always full of oil. Films of real bearings are thinner and their pressures lower: compare designs by them. "
            "ε_h counts from the rod's line, of a main bearing from the stroke line of cylinder 1."
        )
    if len(machine.cylinders) > 1:
        yield "φ is the angle of crank 1."
    if line and len(line.throws) > 1:
        yield (
            "Statically determinate, throw by throw: the shaft counts as hinged in every bearing between two throws, "
            "and 'crankshaft' as the throw of every cylinder."
        )
    if line and any(len(throw.cylinders) > 1 for throw in line.throws):
        yield rods_on_pin(line.shaft.rod_spacing)
    if any(cylinder.masses and cylinder.masses.undivided for cylinder in machine.cylinders):
        yield "'reciprocating' is one sum, all of which counts as pushing on the crosshead pin."


BEARINGS = CommandReport("Bearing loads", _loaded, _bearing_notes)
