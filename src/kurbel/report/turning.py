"""The reports of `kurbel flywheel`, `harmonics` and `torsion`: what turns the shaft, and how it twists."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.unit_systems import show
from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine import Machine
from kurbel.numerics.arithmetic import is_whole
from kurbel.quantity import Quantity, by_id
from kurbel.report.frame import ENDLESS, Frame, Row, Subject, place_table, report_on, subjects_of
from kurbel.report.left_out import flywheel_left_out, left_out, missing
from kurbel.report.tables import LeftOut, PlaceTable, Report
from kurbel.report.warnings import of_machine
from kurbel.solver.case import Case
from kurbel.solver.chain import holzer_at
from kurbel.solver.harmonics import MachineOrders, Orders
from kurbel.solver.torsion import RUN_UP, Critical, SegmentTorque, ShaftVibration, stress

TORQUE_ORDERS = by_id(
    Quantity("speed", "n", "speed", "Speed of rotation"),
    Quantity("order", "ν", "ratio", "Order: periods per turn of the shaft"),
    Quantity("M_cos", "a_ν", "torque", "Coefficient of cos νφ"),
    Quantity("M_sin", "b_ν", "torque", "Coefficient of sin νφ"),
    Quantity("M_amplitude", "|M_ν|", "torque", "Amplitude of the order"),
    Quantity("M_phase", "ε_ν", "angle", "Phase: the order is |M_ν| cos(νφ − ε_ν)"),
    Quantity("M_gas", "|M_g|", "torque", "Amplitude of the part independent of speed"),
    Quantity("M_inertia", "|M_b|", "torque", "Amplitude of the part from inertia forces, proportional to ω²"),
    Quantity("t_order", "t_ν", "pressure", "Tangential-pressure coefficient |M_ν|/(R A)"),
)
"""Of one order of a torque, by id."""

MODES = by_id(
    Quantity("mode", "i", "ratio", "Mode number; 0 is rigid-body rotation"),
    Quantity("frequency", "f", "frequency", "Natural frequency"),
    Quantity("omega_natural", "ω_e", "angular_velocity", "Natural angular frequency"),
)
"""Of one natural vibration, by id."""

PIECES = by_id(
    Quantity("M_shaft_mean", "M_w,m", "torque", "Mean torque in the shaft segment"),
    Quantity("M_shaft_max", "M_w,max", "torque", "Largest torque in the shaft segment, all orders together"),
    Quantity("M_shaft_min", "M_w,min", "torque", "Smallest torque in the shaft segment"),
    Quantity("M_vibratory", "M_w,a", "torque", "Vibratory torque amplitude (half peak-to-peak)"),
    Quantity("tau_mean", "τ_m", "stress", "Stress of the mean torque at the smallest section of the segment"),
    Quantity("tau_vibratory", "τ_a", "stress", "Vibratory stress amplitude (half peak-to-peak)"),
)
"""Of one piece of shaft at the working speed, by id."""

CRITICAL_SPEEDS = by_id(
    TORQUE_ORDERS["order"],
    MODES["mode"],
    Quantity("speed", "n_k", "speed", "Critical speed, at which the order excites the mode"),
    Quantity("phase_sum", "|ΣΘ|", "ratio", "Phase vector sum of the cranks, with Θ of the Holzer table"),
    Quantity("distance", "Δn/n", "ratio", "Separation from the working speed, relative to it"),
    Quantity("M_vibratory", "M_w,a", "torque", "Largest vibratory torque of any shaft segment when running there"),
    Quantity("tau_vibratory", "τ_a", "stress", "Largest vibratory stress of any shaft segment when running there"),
)
"""Of one critical speed, by id."""

HOLZER = by_id(
    Quantity("inertia", "J", "inertia", "Moment of inertia of the mass"),
    Quantity("theta", "Θ", "ratio", "Amplitude of the mass, relative to the first mass"),
    Quantity(
        "inertia_torque", "ω²JΘ", "torque", "Inertia torque of the mass per radian of the first mass", "w2 J Theta"
    ),
    Quantity(
        "torque_sum", "Σω²JΘ", "torque", "Torque in the segment after the mass, per radian of the first mass", "sum"
    ),
    Quantity("stiffness", "k", "stiffness", "Stiffness of the segment after the mass"),
    Quantity("twist", "ΔΘ", "ratio", "Twist of the segment after the mass"),
)
"""Of one mass in Holzer's table, by id."""

SPEEDS = by_id(
    Quantity("speed", "n", "speed", "Speed of rotation"),
    Quantity("M_vibratory", "M_w,a", "torque", "Vibratory torque amplitude in the shaft segment at that speed"),
    Quantity("tau_vibratory", "τ_a", "stress", "Vibratory stress amplitude in the shaft segment at that speed"),
)
"""Of one piece at one speed, by id."""


# turning effort, excess work, flywheel and speed line


@np.errstate(all="ignore")  # what overflows is refused by name
def flywheel_report(case: Case, frame: Frame) -> Report:
    """Return the turning effort of the machine over the angle of crank 1.

    Raises UsageError if nothing turns the shaft, NoSolutionError if the machine stalls.
    """
    machine = case.machine
    *cylinders, whole = subjects_of(case, "flywheel")
    having = [one for one in cylinders if any(one.key_values("flywheel"))]
    if frame.prose:
        whole = replace(whole, left_out=flywheel_left_out(machine), warnings=of_machine(case))

    turning, effort, notes = case.flywheel, case.flywheel.effort, []
    if turning.crank is not None:
        over = "over" if any(term.factor > 1 for term in effort.terms) else "with"
        eta = f", {over} the efficiency {machine.efficiency:g}" if machine.efficiency != 1 else ""
        notes.append(
            f"T and W are referred to the radius of crank 1, {show(turning.crank, 'length')}{eta}; φ is its angle."
        )
    if effort.swing is not None:
        whole = replace(whole, at=None)
        notes.append(
            "Of the effort its swing of energy alone is known: ω_m is the mean of ω_max and ω_min, δ = ΔE/(J ω_m²)."
        )
    elif turning.J is not None and turning.omega and not turning.elastic and turning.multiplier is None:
        notes.append("The load does not determine the speed: the mean of ω over time is taken as the nominal speed.")
    if machine.efficiency != 1 and any(effort.lost(group) for group in effort.groups):
        notes.append(
            "Where driving and driven pistons share a rod, the efficiency reduces the force of the driving pistons; "
            "driven pistons, inertia, weight and friction count in full (R p. 613)."
        )
    if machine.efficiency != 1 and any(term.factor != 1 for term in effort.inertia_terms) and turning.speed is not None:
        notes.append("As in the book the efficiency applies to all of T; in ω the moving masses count in full.")
    if turning.rigid:
        notes.append(
            f"The coupling counts as rigid, its natural order {turning.natural_order:.4g} being above 100: "
            "the driven inertia turns with the flywheel."
        )
    return report_on(frame, machine, "Turning effort and flywheel", having, whole, notes)


# orders of the torque

_HIGHEST_ORDER = 1000


@np.errstate(all="ignore")  # what overflows is refused by name
def harmonics_report(
    case: Case, frame: Frame, orders: Sequence[float] | None = None, speeds: Sequence[float] | None = None
) -> Report:
    """Return the orders of the turning effort; orders: those to show, None for all up to 24.

    speeds: in revolutions per second, at which the orders of the whole machine are shown, too. Raises UsageError if
    nothing turns the shaft.
    """
    machine, found = case.machine, case.harmonics(_orders(case.machine, orders))
    cylinders, torques = [], []
    for one in found.cylinders:
        cylinder = one.forces.drive.cylinder
        torques.append((f"The torque of {cylinder.name}", one.own))
        title = f"Orders of the torque of {cylinder.name}, φ from its own inner dead centre"
        table = _orders_table(title, one.own, frame.system, one.area)
        cylinders.append(Subject(cylinder.name, left_out=left_out(machine, cylinder), tables=(table,)))
    torques.append(("The turning effort", found.machine))
    title = "Orders of the turning effort, φ from the inner dead centre of crank 1"
    tables = [_orders_table(title, found.machine, frame.system, major=found.major_orders or ())]
    if speeds is not None:
        tables.append(_speeds_of_orders(machine, found, speeds, frame.system))

    uniform = [what for what, torque in torques if _uniform(torque)]
    notes = [f"{what} has none of these orders: they are all zero." for what in uniform]
    if len(uniform) < len(torques):
        notes.append(
            "M = M_m + Σ (a_ν cos νφ + b_ν sin νφ) = M_m + Σ |M_ν| cos(νφ − ε_ν), ν periods per turn of the shaft."
        )
        if found.machine.inertia is not None:
            notes.append(
                "M_b grows with the square of the speed; M_g, of gas, weight and friction, is the same at every speed."
            )
    no_masses = "no masses, or no speed given" if found.cylinders else "the effort is given as a torque"
    apart = missing({"gas and inertia apart": no_masses if found.machine.inertia is None else ""})
    lacking, warnings = (*flywheel_left_out(machine), *apart), of_machine(case) if frame.prose else ()
    whole = Subject("whole machine", found, left_out=lacking, warnings=warnings, tables=tables)
    return report_on(frame, machine, "Harmonics of the turning effort", cylinders, whole, notes)


def _orders(machine: Machine, requested: Sequence[float] | None) -> Array | None:
    """Return the requested orders (n,), ascending and each once; None for the usual ones.

    Raises UsageError for one that the cycle does not have.
    """
    for order in requested or ():
        if not 0 < order <= _HIGHEST_ORDER:
            raise UsageError(
                f"--orders {order:g}: an order is more than 0 and at most {_HIGHEST_ORDER} periods per turn"
            )
        if not is_whole(order * machine.revolutions):
            turns = machine.revolutions
            known = {1: "1, 2, 3, …", 2: "½, 1, 1½, …"}.get(turns, f"1/{turns}, 2/{turns}, 3/{turns}, …")
            degrees = 360 * machine.revolutions
            raise UsageError(
                f"--orders {order:g}: the cycle repeats after {degrees} degrees and has the orders {known}"
            )
    return None if requested is None else np.array(sorted(set(requested)), dtype=float)


def _orders_table(
    title: str, orders: Orders, system: str, area: float | None = None, major: Sequence[float] = ()
) -> PlaceTable:
    """Return the orders of a torque; area: of the piston, for the tangential pressure; major: those to mark."""
    rows: list[Row] = []
    for index, order in enumerate(orders.orders.tolist()):
        amplitude = complex(orders.whole[index])
        values = _of_order(order, amplitude)
        if orders.inertia is not None:
            values["M_gas"] = float(abs(orders.gas[index]))
            values["M_inertia"] = float(abs(orders.inertia[index]))
        if area:
            values["t_order"] = abs(amplitude) / area
        rows.append((("major" if order in major else "",), values))
    return place_table("orders", title, ("kind",), TORQUE_ORDERS, rows, system)._replace(in_note=_uniform(orders))


def _of_order(order: float, amplitude: complex) -> dict[str, float | None]:
    """Return one order: Re(M e^{iνφ}) = a cos νφ + b sin νφ = |M| cos(νφ − ε), ε above −180° up to 180°."""
    a, b = amplitude.real, -amplitude.imag
    phase = math.degrees(math.atan2(b, a)) + 0.0 if amplitude else None
    return {"order": order, "M_cos": a, "M_sin": b, "M_amplitude": abs(amplitude), "M_phase": phase}


def _speeds_of_orders(machine: Machine, found: MachineOrders, speeds: Sequence[float], system: str) -> PlaceTable:
    if not machine.speed:
        raise UsageError("--speeds: the inertia forces are scaled from those at the 'speed' of the machine; give one")
    rows: list[Row] = []
    for speed in speeds:
        at_speed = found.machine.at_speed(speed / machine.speed)
        for order, amplitude in zip(found.orders.tolist(), at_speed.tolist()):
            rows.append((("",), {"speed": speed, **_of_order(order, amplitude)}))
    title = "Orders of the turning effort at other speeds"
    table = place_table("orders_by_speed", title, ("kind",), TORQUE_ORDERS, rows, system)
    return table._replace(in_note=_uniform(found.machine))


def _uniform(found: Orders) -> bool:
    """Whether every order is zero, at every speed."""
    return not any(one.any() for one in (found.gas, found.inertia) if one is not None)


# torsional vibration of the shaft line: natural vibrations, Holzer's table, critical speeds, forced vibration

_HIGHEST_CRITICAL = 12
"""Order up to which critical speeds are listed unless orders are requested."""
_MODES = 3
"""Modes whose critical speeds are listed unless others are requested."""


class Wanted(NamedTuple):
    """What is requested of torsion: orders, how many modes, whose Holzer table, speeds in revolutions per second.

    at: frequency in Hz of Holzer's table, in place of a mode.
    """

    orders: Sequence[float] | None = None
    modes: int = _MODES
    mode: int = 1
    speeds: Sequence[float] | None = None
    at: float | None = None


@np.errstate(all="ignore")
def torsion_report(case: Case, frame: Frame, wanted: Wanted = Wanted()) -> Report:  # noqa: B008 (immutable)
    """Return the torsional vibration of the shaft line; columns over the crank angle only if the frame has some.

    Raises UsageError without a shaft line, NoSolutionError if an undamped resonance has no limit.
    """
    found, system = case.torsion_of(_orders(case.machine, wanted.orders)), frame.system
    critical = found.critical_speeds(wanted.modes, _HIGHEST_CRITICAL if wanted.orders is None else math.inf)
    if found.vibration is not None and found.vibration.endless.any():
        raise NoSolutionError(ENDLESS)
    tables = [_modes_table(found, system), _holzer_table(found, wanted, system)]

    # what is not reached, or hardly damped, has no amplitude
    reached = [one for one in critical if found.met(one)]
    of_reached = dict(zip(reached, _at_speeds(found, [one.speed for one in reached])))
    rows: list[Row] = []
    for one in critical:
        values: dict[str, float | None] = {"order": one.order, "mode": float(one.mode), "speed": one.speed}
        values |= {"phase_sum": one.phase_sum, "distance": one.distance}
        for amplitudes in of_reached.get(one, ()):
            for id, amplitude in amplitudes.items():
                values[id] = max(values.get(id) or 0.0, amplitude)
        known = {id: value for id, value in values.items() if value is not None}
        rows.append((("near" if one.near else "",), known))
    tables.append(place_table("critical_speeds", "Critical speeds", ("note",), CRITICAL_SPEEDS, rows, system))
    hidden = bool(reached) and any("M_vibratory" not in values for _, values in rows)

    if found.pieces:
        rows = [((piece.name,), _of_piece(piece)) for piece in found.pieces]
        title = f"Torques and stresses at the working speed, all {'' if found.steady else 'these '}orders together"
        tables.append(place_table("pieces", title, ("piece",), PIECES, rows, system))
    if wanted.speeds is not None and not found.obstacle:
        rows = [
            ((found.piece_name(number),), {"speed": speed, **amplitudes})
            for number, piece in enumerate(zip(*_at_speeds(found, wanted.speeds)))
            for speed, amplitudes in zip(wanted.speeds, piece)
        ]
        title = "Vibratory torque over the speed, all these orders together"
        tables.append(place_table("speeds", title, ("piece",), SPEEDS, rows, system))

    warnings = (*_near_speeds(found, critical), *of_machine(case)) if frame.prose else ()
    whole = Subject("shaft line", found, left_out=torsion_left_out(found), warnings=warnings, tables=tables)
    pieces = [Subject(one.name, at=one.at) for one in found.pieces] if frame.columns else []
    notes = _torsion_notes(found, wanted.orders is None, hidden)
    return report_on(frame, case.machine, "Torsional vibration", pieces, whole, notes)


def _modes_table(found: ShaftVibration, system: str) -> PlaceTable:
    """Return the natural frequencies, with how many nodes each mode has, and where if they are few."""
    rows: list[Row] = []
    names = [mass.name for mass in found.line.masses]
    for index, omega in enumerate(found.modes.omegas.tolist()):
        mode, where = found.first + index, ["at the ground"] * sum(found.chain.held)
        for mass, share in found.modes.nodes(index) if mode else ():
            where.append(f"{names[mass]} + {share:.2f}" if share else names[mass])
        nodes = f"{len(where)} node{'s' if len(where) > 1 else ''}" if mode else "rotation"
        nodes = f"{nodes}: {', '.join(where)}" if mode and len(where) <= 2 else nodes
        values = {"mode": float(mode), "frequency": omega / (2 * math.pi), "omega_natural": omega}
        rows.append(((nodes,), values))
    return place_table("modes", "Natural frequencies", ("nodes",), MODES, rows, system)


def _holzer_table(found: ShaftVibration, wanted: Wanted, system: str) -> PlaceTable:
    """Return Holzer's table of a mode or at a frequency, from the first mass to the last, each with its segment behind.

    At a frequency that is not a natural one the last row has what is left: a torque, or the angle of a fixed end.
    """
    chain, left, last = found.chain, 0.0, dict[str, float]()
    if wanted.at is None:
        table, omega = found.holzer(wanted.mode), float(found.modes.omegas[wanted.mode - found.first])
        of = f"of mode {wanted.mode}, f = {omega / (2 * math.pi):.6g} Hz"
    else:
        omega = 2 * math.pi * wanted.at
        table, of = holzer_at(chain, omega), f"at f = {wanted.at:.6g} Hz"
        left, last = (table.residual, {}) if chain.held[1] else (0.0, {"torque_sum": table.residual})
    masses: list[Row] = [
        ((mass.name,), {"inertia": inertia, "theta": theta, "inertia_torque": omega**2 * inertia * theta})
        for mass, inertia, theta in zip(found.line.masses, chain.inertias.tolist(), table.angles.tolist())
    ]
    masses = [(("ground",), {"theta": 0.0})] * chain.held[0] + masses + [(("ground",), {"theta": left})] * chain.held[1]
    pieces: list[dict[str, float]] = [
        {"torque_sum": torque, "stiffness": stiffness, "twist": torque / stiffness}
        for torque, stiffness in zip(table.torques.tolist(), chain.stiffnesses.tolist())
    ]
    rows = [(names, {**mass, **piece}) for (names, mass), piece in zip(masses, [*pieces, last])]
    return place_table("holzer", f"Holzer's table {of}, ω² = {omega**2:.6g} 1/s²", ("mass",), HOLZER, rows, system)


def _at_speeds(found: ShaftVibration, speeds: Sequence[float]) -> Iterator[list[dict[str, float]]]:
    """Yield for each speed vibratory torque and stress of every piece, nothing at an undamped resonance."""
    vibration = found.forced(speeds) if speeds else None
    factors = [stress(found.line, piece) for piece in range(len(found.line.pieces))]
    for torques, endless in zip(vibration.vibratory.T.tolist(), vibration.endless) if vibration else ():
        of_pieces: list[dict[str, float]] = []
        for torque, factor in zip(torques, factors):
            tension = {} if factor is None else {"tau_vibratory": factor * torque}
            of_pieces.append({} if endless else {"M_vibratory": torque, **tension})
        yield of_pieces


def _of_piece(piece: SegmentTorque) -> dict[str, float]:
    torques = piece.M_shaft_mean, piece.M_shaft_max, piece.M_shaft_min, piece.M_vibratory
    values = dict(zip(PIECES, (*torques, piece.tau_mean, piece.tau_vibratory)))
    return {id: value for id, value in values.items() if value is not None}


def torsion_left_out(found: ShaftVibration) -> list[LeftOut]:
    """Return what torsional vibration leaves out."""
    bare = [found.piece_name(index) for index, piece in enumerate(found.line.pieces) if not piece.sections]
    mean = "the mean is used; parametric excitation is not computed"
    return missing(
        {
            "forced vibration, torques and stresses": found.obstacle,
            f"stress in {', '.join(bare)}": "no diameter given" if bare and not found.obstacle else "",
            "change of the inertia over the turn": mean if found.machine.cylinders else "",
        }
    )


def torsion_warnings(case: Case) -> Iterator[str]:
    """Yield which of the usual critical speeds are near the working speed; raises as `subjects_of` does."""
    subjects_of(case, "torsion")
    yield from _near_speeds(case.torsion, case.torsion.critical_speeds(_MODES, _HIGHEST_CRITICAL))


def _near_speeds(found: ShaftVibration, critical: Sequence[Critical]) -> Iterator[str]:
    """Yield, mode by mode, the critical speeds near the working speed, the strongest first."""
    for mode in sorted({one.mode for one in critical}):
        near = sorted((one for one in critical if one.mode == mode and one.near), key=lambda one: -one.share)
        if near and found.machine.speed is not None:
            listed = ", ".join(f"{one.order:g} ({100 * (one.distance or 0.0):+.3g} %)" for one in near)
            plural = "s" if len(near) > 1 else ""
            yield (
                f"mode {mode}: critical speed{plural} of order{plural} {listed} within 10 % of the working speed "
                f"{show(found.machine.speed, 'speed')}"
            )


def _torsion_notes(found: ShaftVibration, usual: bool, hidden: bool) -> Iterator[str]:
    """Yield the notes; usual: no orders are requested; hidden: some critical speeds have no amplitude, others have."""
    line = found.line
    if usual:
        yield f"Critical speeds of orders up to {_HIGHEST_CRITICAL}; --orders lists others, --modes more modes."
    if hidden:
        yield (
            "Torques and stresses at a critical speed include all orders, when running there; – marks a speed that the "
            f"machine does not reach, beyond {RUN_UP:g} times the working speed, and a mode that is hardly damped."
        )
    if any(piece.ratio != 1 for piece in line.pieces):
        yield "Masses and stiffnesses beyond the gear are referred to the cranks' shaft by u²; torques are true ones."
    if not found.machine.cylinders and found.machine.effort:
        yield f"The effort acts on {line.masses[0].name}, the first mass."
    if not found.pieces:
        return
    orders = "all orders"
    if found.summed is not None:
        names = [f"{order:g}" for order in found.summed]
        orders = f"order{'s' if len(names) > 1 else ''} {', '.join(names)}"
        orders = orders if len(names) <= 4 else f"{len(names)} orders from {names[0]} to {names[-1]}"
    if found.remainder is not None:
        orders += f" together (higher ones add about {show(found.remainder, 'torque', figures=2)} or less)"
    else:
        orders += " together"
    taker = "what holds it" if found.chain.ground else line.masses[line.load].name
    yield f"Forced vibration: {orders}, about uniform rotation; the mean torque goes to {taker}."
