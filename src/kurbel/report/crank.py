"""The reports of `kurbel motion`, `forces`, `stress` and `bearings`: each cylinder, and the shaft that it loads."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import chain

from kurbel.errors import UsageError
from kurbel.quantity import PHI, Quantity, by_id
from kurbel.report.frame import Frame, Functions, Places, Row, Subject, report_on
from kurbel.report.left_out import (
    bearing_left_out,
    bearings_left_out,
    forces_left_out,
    left_out,
    motion_left_out,
    strength_left_out,
)
from kurbel.report.tables import Report
from kurbel.report.warnings import (
    as_far_as_solved,
    bearing_warnings,
    by_cylinder,
    guide_notes,
    of_machine,
    rod_ratio_notes,
    shells,
)
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from kurbel.solver.indicated import OF_CYCLES
from kurbel.solver.stress import CrankshaftStrength
from kurbel.solver.trace import TracePressure

STRESSES = by_id(
    Quantity("compression", "σ_c", "stress", "Compressive stress of a web by the force along it, negative in tension"),
    Quantity("bending_in_plane", "σ_b1", "stress", "Bending in the plane of the throw"),
    Quantity("bending_out_of_plane", "σ_b2", "stress", "Bending perpendicular to the plane of the throw"),
    Quantity("torsion", "τ", "stress", "Torsion"),
    Quantity("combined", "σ_res", "stress", "Combined stress 0.35 σ + 0.65 √(σ² + 4(α₀τ)²) (Bach)"),
    Quantity("von_mises", "σ_v", "stress", "Equivalent stress √(σ² + 3τ²) (von Mises)"),
)
"""Stresses at one place of a crankshaft, by id."""


# motion and forces of every cylinder


def mechanism_notes(case: Case) -> Iterable[str]:
    """Return what a reader should know about the mechanisms, each sentence once."""
    return dict.fromkeys(note for cylinder in case.machine.cylinders for note in cylinder.mechanism.notes)


def _with_motion(case: Case) -> list[Subject]:
    return [
        Subject(one.drive.name, one, one.at, left_out=motion_left_out(case.machine, one.drive.cylinder))
        for one in case.cylinders
    ]


MOTION = Functions("Motion of the crank train", _with_motion, mechanism_notes, lambda case: 360.0)


def _with_forces(case: Case) -> list[Subject]:
    return [
        Subject(
            one.drive.name,
            one,
            one.at,
            left_out=forces_left_out(case.machine, one),
            tables=_piston_table(one),
            pistons=[Subject(piston.name, piston) for piston in one.pistons],
        )
        for one in case.cylinders
    ]


def forces_report(case: Case, frame: Frame) -> Report:
    """Return the forces of every cylinder; without the table over the crank angle its measured cycles, one to a line.

    Raises UsageError without a cylinder, or without several cycles, NoSolutionError if its friction locks one.
    """
    cylinders, warnings = _with_forces(case), by_cylinder(case) if frame.prose and case.cylinders else {}
    cylinders = [replace(one, warnings=warnings.get(one.name, ())) for one in cylinders]
    if frame.table:
        for forces in case.cylinders:
            forces.refuse_locking()
        return report_on(frame, case.machine, FORCES.title, cylinders, FORCES.notes(case))
    if cylinders and not any(forces.indicated and forces.indicated.cycles for forces in case.cylinders):
        raise UsageError("--each-cycle: no trace of this machine has several cycles; leave it out")
    each = zip(cylinders, case.cylinders)
    cylinders = [replace(one, tables=_cycle_table(forces)) for one, forces in each]
    return report_on(frame, case.machine, FORCES.title, cylinders)


def _piston_table(forces: CylinderForces) -> Iterator[Places]:
    """Yield work, power and mean pressure of each piston of a rod that has several."""
    if not forces.pistons:
        return
    declared, scope = forces.pistons[0].lists.key_values("forces"), f"{forces.drive.name}."
    each = ((one.name.removeprefix(scope), one.key_values()) for one in forces.pistons)
    rows: list[Row] = [((name,), {id: figure.value for id, figure in found.items()}) for name, found in each]
    yield Places("pistons", "Each piston", ("piston",), declared, rows, headed=True)


def _cycle_table(forces: CylinderForces) -> Iterator[Places]:
    cycles, gas = forces.indicated and forces.indicated.cycles, forces.drive.own_gas
    if not cycles:
        return
    declared = {one.id: one.absolute() if gas and gas.absolute else one for one in OF_CYCLES}
    columns = zip(*(one.tolist() for one in cycles))
    rows: list[Row] = [((str(number),), dict(zip(declared, values))) for number, values in enumerate(columns, 1)]
    yield Places("cycles", "Measured cycles", ("cycle",), declared, rows, headed=True)


def _forces_notes(case: Case) -> Iterator[str]:
    yield from mechanism_notes(case)
    yield from guide_notes(case)
    yield from rod_ratio_notes(case)
    if any(forces.drive.rod and forces.drive.has_force for forces in case.cylinders):
        yield (
            "S of an exact rod is the force between the masses at its ends and the force along it at neither pin: "
            "S_H is that at the crosshead pin, S_Z that at the crank pin; the rod must carry the largest of both."
        )
    compressors = [forces.drive.cylinder for forces in case.cylinders if not forces.no_compressor]
    if compressors:
        yield (
            "Rod load after API 618: P_G at the crosshead pin counts gas, inertia and weight of piston, piston rod, "
            "crosshead and other parts, P_KS at the piston rod the same without the crosshead; neither has the "
            "connecting rod's share or friction. d: in compression, z: in tension."
        )
    if any(cylinder.masses and cylinder.masses.undivided for cylinder in compressors):
        yield (
            "'reciprocating' is one sum, with the connecting rod's share: P_G counts all of it; give the parts to leave"
            " that share out."
        )
    ends = [end for forces in case.cylinders for gas in forces.drive.gas for end in (gas.head, gas.crank)]
    if any(isinstance(end, TracePressure) and end.trace.even for end in ends):
        yield (
            "ΔA/A of a trace is not a rounding error: the indicated work is by the trapezoid rule on the samples, "
            "the quadrature by straight lines between them; the difference shows the effect of the sample spacing."
        )


FORCES = Functions("Forces in the crank train", _with_forces, _forces_notes, own=forces_report)


# pins and bearings


def _loaded(case: Case) -> list[Subject]:
    for forces in case.cylinders:
        forces.refuse_locking()
    parts = [
        Subject(
            one.name,
            one,
            one.at,
            left_out=bearing_left_out(*one.size, one.omega),
            of=one.cylinders[0].drive.name if one.of_rod else "",
        )
        for one in case.bearings.parts
    ]
    warnings = chain(of_machine(case), as_far_as_solved(bearing_warnings(case), "bearings"))
    return [*parts, Subject("whole machine", left_out=bearings_left_out(case), warnings=warnings, whole=True)]


def _bearing_notes(case: Case) -> Iterator[str]:
    machine, line = case.machine, case.bearings.line
    yield (
        "Loads are those of a rod on its pin and of the shaft on its bearings. Directions are measured in the sense "
        "of rotation: ε_K from the throw outward (of a main bearing from that of crank 1), ε_M from the stroke line "
        "of cylinder 1 outward, ε_S from the rod's line, crank pin to crosshead. A surface counts as loaded 60° to "
        "either side of the load; crank pins and journals rotate with the throw, crosshead pins and main shells do "
        "not."
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


BEARINGS = Functions("Bearing loads", _loaded, _bearing_notes)


# stresses in the crankshaft


def _stressed(case: Case) -> list[Subject]:
    return [
        Subject(
            "crankshaft",
            case.stress,
            case.stress.at,
            left_out=chain(left_out(case.machine, case.machine.cylinders[0]), strength_left_out(case.machine)),
            warnings=of_machine(case),
            tables=_stress_tables(case.stress),
            whole=True,
        )
    ]


def _stress_tables(strength: CrankshaftStrength) -> Iterator[Places]:
    for id, title, places in (
        ("dead_centre", "Dead centre, full piston force without inertia", strength.at_dead_centre),
        ("largest_torque", "Position of the largest torque", strength.at_largest_torque),
        ("largest_stress", "Whole cycle: each place where its combined stress is largest", strength.at_worst),
    ):
        rows: list[Row] = []
        for one in places:
            stresses = (one.compression, one.bending_in_plane, one.bending_out_of_plane, one.torsion)
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
