"""The reports of `kurbel motion`, `forces`, `stress`, `bearings`, `balance`: the cylinders, and what they load."""

import cmath
import math
from collections.abc import Iterable, Iterator
from itertools import chain, groupby

import numpy as np

from kurbel.declared.unit_systems import show
from kurbel.errors import UsageError
from kurbel.quantity import PHI, Quantity, by_id
from kurbel.report.frame import Frame, Functions, Places, Row, Subject
from kurbel.report.left_out import (
    balance_left_out,
    bearing_left_out,
    bearings_left_out,
    forces_left_out,
    left_out,
    motion_left_out,
    strength_left_out,
)
from kurbel.report.warnings import (
    as_far_as_solved,
    bearing_warnings,
    by_cylinder,
    guide_notes,
    of_machine,
    pin_warnings,
    rod_ratio_notes,
    shells,
)
from kurbel.solver.balance import MachineBalance
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
            idle="" if one.drive.has_force else "no force acts; kurbel motion prints its motion",
        )
        for one in case.cylinders
    ]


def _forces_shown(case: Case, frame: Frame) -> tuple[list[Subject], Iterable[str]]:
    """Return the forces of every cylinder; without the table over the crank angle its measured cycles, one to a line.

    Raises UsageError without a cylinder, or without several cycles, NoSolutionError if its friction locks one.
    """
    cylinders, warnings = _with_forces(case), by_cylinder(case) if frame.prose and case.cylinders else {}
    cylinders = [one._replace(warnings=warnings.get(one.name, ())) for one in cylinders]
    if frame.table:
        for forces in case.cylinders:
            forces.refuse_locking()
        return cylinders, _forces_notes(case)
    if cylinders and not any(forces.indicated and forces.indicated.cycles for forces in case.cylinders):
        raise UsageError("--each-cycle: no trace of this machine has several cycles; leave it out")
    each = zip(cylinders, case.cylinders)
    return [one._replace(tables=_cycle_table(forces)) for one, forces in each], ()


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
    if any(forces.drive.pin_friction and forces.drive.has_force for forces in case.cylinders):
        yield (
            "T is M/R, less the friction of pins and journals, and W its mean; T_Z is the force at the crank pin, "
            "which the books call T."
        )
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


FORCES = Functions("Forces in the crank train", _with_forces, _forces_notes, own=_forces_shown)


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


# unbalanced forces and moments over the crank angle, their orders, the best weights

ORDERS = by_id(
    Quantity("order", "n", "ratio", "Order: turns of the components in one turn of the crank"),
    Quantity("F_forward", "F_+", "force", "Unbalanced force: component rotating with the crank"),
    Quantity("F_backward", "F_−", "force", "Unbalanced force: component rotating against the crank"),
    Quantity("F_forward_book", "F_+,0", "force", "The same by the acceleration of first order (R 291)"),
    Quantity("F_backward_book", "F_−,0", "force", "The same by the acceleration of first order (R 291)"),
    Quantity("F_share", "F_n²/F²", "ratio", "Share of the order in the mean square of the unbalanced force", "F_n2/F2"),
    Quantity("M_forward", "M_+", "torque", "Unbalanced moment: component rotating with the crank"),
    Quantity("M_backward", "M_−", "torque", "Unbalanced moment: component rotating against the crank"),
    Quantity("M_forward_book", "M_+,0", "torque", "The same by the acceleration of first order (R 291)"),
    Quantity("M_backward_book", "M_−,0", "torque", "The same by the acceleration of first order (R 291)"),
    Quantity(
        "M_share", "M_n²/M²", "ratio", "Share of the order in the mean square of the unbalanced moment", "M_n2/M2"
    ),
)
"""Columns of the table of orders; amplitudes."""


def _ellipse(name: str, kind: str, of: str) -> tuple[Quantity, ...]:
    return (
        Quantity(f"{name}_long", f"{name}_a", kind, f"{of}: longer half-axis of the ellipse of this order"),
        Quantity(f"{name}_short", f"{name}_b", kind, f"{of}: shorter half-axis"),
        Quantity(f"{name}_direction", f"∠{name}_a", "angle", "Direction of the major axis", f"arg {name}_a"),
        Quantity(
            f"{name}_forward_phase", f"∠{name}_+", "angle", "Phase of the forward component at φ = 0", f"arg {name}_+"
        ),
        Quantity(
            f"{name}_backward_phase", f"∠{name}_−", "angle", "Phase of the backward component at φ = 0", f"arg {name}_-"
        ),
    )


ELLIPSES = by_id(
    ORDERS["order"], *_ellipse("F", "force", "Unbalanced force"), *_ellipse("M", "torque", "Unbalanced moment")
)
"""Columns of the table of ellipses: what the two circles of an order make together."""

WEIGHTS = by_id(
    Quantity("axial_position", "z", "length", "Position along the shaft"),
    Quantity("product", "u", "unbalance", "Mass times radius"),
    Quantity("angle", "α", "angle", "Direction at φ = 0 from the stroke line of cylinder 1"),
    Quantity("hammer_blow", "H", "force", "Amplitude by which it loads and lifts its wheel"),
    Quantity("counterweight", "u_R", "unbalance", "The whole counterweight in the wheel, mass times radius"),
    Quantity("counterweight_angle", "α_R", "angle", "Its direction at φ = 0"),
)
"""Columns of the tables of weights."""


_DIGITS = 4
_NOTHING = 1e-6
"""Degrees by which a direction may miss another by rounding."""


def _balanced(case: Case, compare: bool = False) -> list[Subject]:
    balance = MachineBalance(case.effort, compare=True) if compare else case.balance
    return [
        Subject(
            "whole machine",
            balance,
            None if case.machine.speed is None else balance.at,
            left_out=balance_left_out(case, compare),
            warnings=pin_warnings(case.machine),
            tables=chain(_orders(case.balance, compare), _weights(case.balance)),
            whole=True,
        )
    ]


def _notes(case: Case) -> Iterator[str]:
    balance, free = case.balance, case.balance.free
    yield "φ is the angle of crank 1; F_x and M_x count along the stroke line of cylinder 1, F_y and M_y across it."
    if free.moment is not None and balance.z_0 is not None:
        yield f"Moments are taken about z = {show(balance.z_0, 'length')}."
    if free.next_order and balance.omega is not None:
        yield (
            f"The rod is hardly longer than the crank, so that more orders follow, from n = {free.next_order} on; "
            "all of them are in forces and moments."
        )
    if balance.counterweights or balance.machine.balance_shafts:
        yield "Counterweights and shafts of the file are included in all that is free; the best weights replace them."
    if balance.roll is not None:
        yield "M_roll is −M of kurbel flywheel, without the torque that accelerates the masses about the shaft."


BALANCE = Functions(
    "Balancing",
    _balanced,
    _notes,
    lambda case: case.balance.cycle,
    lambda case, frame: (_balanced(case, frame.compare), _notes(case)),
)


def _orders(balance: MachineBalance, compare: bool) -> Iterator[Places]:
    """Yield the orders of the unbalanced force and moment, as two circles and as an ellipse; none without a speed.

    An order is a circle with the crank, of complex radius f at φ = 0, and one against it, g; together an ellipse.
    """
    if balance.omega is None:
        return
    square, free, book = balance.omega**2, balance.free, balance.book if compare else None
    rows: list[Row] = []
    for order in free.orders:
        values: dict[str, float | None] = {"order": order}
        for name, vector, of_book in (
            ("F", free.force, book.force if book else None),
            ("M", free.moment, book.moment if book else None),
        ):
            if vector is None:
                continue
            f, g = (complex(vector.of(one)[0]) * square for one in (order, -order))
            whole = float((np.abs(vector.waves * square) ** 2).sum())
            values |= {f"{name}_forward": abs(f), f"{name}_backward": abs(g)}
            values[f"{name}_share"] = (abs(f) ** 2 + abs(g) ** 2) / whole if whole else None
            if of_book is not None:
                values[f"{name}_forward_book"] = abs(complex(of_book.of(order)[0])) * square
                values[f"{name}_backward_book"] = abs(complex(of_book.of(-order)[0])) * square
            values |= {f"{name}_long": abs(f) + abs(g), f"{name}_short": abs(abs(f) - abs(g))}
            # both circles meet in the middle of their directions, here from 0 to below 180 degrees
            middle = math.degrees(cmath.phase(f * g)) / 2
            middle = middle + 180.0 if middle < -_NOTHING else max(middle, 0.0)
            values[f"{name}_direction"] = middle if f and g else None
            values |= {f"{name}_forward_phase": _direction(f), f"{name}_backward_phase": _direction(g)}
        rows.append(((), values))
    title = "Orders: circles with the crank (+) and against it (−)"
    yield Places("orders", title, (), ORDERS, rows, alone=_DIGITS)
    title = "Orders: ellipses, and phases of the rotating components at φ = 0"
    yield Places("ellipses", title, (), ELLIPSES, rows, alone=_DIGITS)


def _weights(balance: MachineBalance) -> Iterator[Places]:
    """Yield the best weights, and what the wheels of a locomotive carry besides the rotating masses."""

    def row(name: str, place: float | None, product: complex) -> tuple[tuple[str], dict[str, float | None]]:
        at: dict[str, float | None] = {} if place is None else {"axial_position": place}
        return (name,), {**at, "product": abs(product), "angle": _direction(product)}

    best = zip("AB", balance.best_in_planes)
    rows = [row(f"counterweight {end}", one.place, one.product) for end, one in best if one.product]
    for order, weights in groupby(balance.best_shafts, lambda one: one.order):
        name, given = f"shaft n = {abs(order)}, {'with' if order > 0 else 'against'} the crank", [*weights]
        for end, one in zip("AB", given):
            rows.append(row(f"{name}: {end}" if len(given) > 1 else name, one.place, one.product))
    if rows:
        title = "Counterweights in two planes, and balance shafts"
        yield Places("best_weights", title, ("weight",), WEIGHTS, rows)
    if balance.machine.locomotive:
        rows, square = [], (balance.omega or 0.0) ** 2
        wheels = zip("AB", balance.wheels, balance.in_wheels(), balance.in_wheels("counterweights"))
        for name, place, product, weight in wheels:
            head, values = row(name, place, product)
            values |= {"hammer_blow": abs(product) * square} if square else {}
            values |= {"counterweight": abs(weight), "counterweight_angle": _direction(weight)} if weight else {}
            rows.append((head, values))
        title = "In the wheels: what they carry beyond the rotating masses, and the whole counterweights"
        yield Places("wheels", title, ("wheel",), WEIGHTS, rows)


def _direction(circle: complex) -> float | None:
    """Return a direction in degrees, above −180 and up to 180; None for nothing."""
    degrees = math.degrees(cmath.phase(circle))
    return None if not circle else degrees if degrees > _NOTHING - 180 else degrees + 360
