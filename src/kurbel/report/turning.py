"""The reports of `kurbel flywheel`, `harmonics` and `torsion`: what turns the shaft, and how it twists."""

import math
from collections.abc import Iterator, Sequence
from itertools import chain

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.unit_systems import show
from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine import Machine
from kurbel.numerics.arithmetic import is_whole
from kurbel.quantity import Quantity, by_id
from kurbel.report.frame import Frame, Functions, Places, Row, Subject, whole_machine
from kurbel.report.left_out import flywheel_left_out, left_out, missing
from kurbel.report.tables import LeftOut
from kurbel.report.warnings import of_machine
from kurbel.solver.case import Case
from kurbel.solver.chain import holzer_at
from kurbel.solver.flywheel import DeadCentre
from kurbel.solver.harmonics import CylinderOrders, MachineOrders, Orders
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

SPEEDS = by_id(TORQUE_ORDERS["speed"], PIECES["M_vibratory"], PIECES["tau_vibratory"])
"""Of one piece at one speed, by id."""


# turning effort, excess work, flywheel and speed line


def _turned(case: Case) -> list[Subject]:
    turning, effort = case.flywheel, case.flywheel.effort
    whole = Subject(
        "whole machine",
        turning,
        turning.at if effort.swing is None else None,
        left_out=flywheel_left_out(case.machine),
        warnings=of_machine(case),
        whole=True,
    )
    return [*(Subject(one.drive.name, DeadCentre(one, effort.cycle)) for one in case.cylinders), whole]


def _flywheel_notes(case: Case) -> Iterator[str]:
    turning, effort, efficiency = case.flywheel, case.flywheel.effort, case.machine.efficiency
    if turning.crank is not None:
        over = "over" if any(term.factor > 1 for term in effort.terms) else "with"
        eta = f", {over} the efficiency {efficiency:g}" if efficiency != 1 else ""
        yield f"T and W are referred to the radius of crank 1, {show(turning.crank, 'length')}{eta}; φ is its angle."
    if effort.swing is not None:
        yield "Of the effort its swing of energy alone is known: ω_m is the mean of ω_max and ω_min, δ = ΔE/(J ω_m²)."
    elif turning.J is not None and turning.omega and not turning.elastic and turning.multiplier is None:
        yield "The load does not determine the speed: the mean of ω over time is taken as the nominal speed."
    if efficiency != 1 and any(effort.lost(group) for group in effort.groups):
        yield (
            "Where driving and driven pistons share a rod, the efficiency reduces the force of the driving pistons; "
            "driven pistons, inertia, weight and friction count in full (R p. 613)."
        )
    if efficiency != 1 and any(term.factor != 1 for term in effort.inertia_terms) and turning.speed is not None:
        yield "As in the book the efficiency applies to all of T; in ω the moving masses count in full."
    if turning.rigid:
        yield (
            f"The coupling counts as rigid, its natural order {turning.natural_order:.4g} being above 100: "
            "the driven inertia turns with the flywheel, and M_K is what it and the load take, J₂ α + M_load, without "
            "vibrations of the coupling itself."
        )


FLYWHEEL = Functions("Turning effort and flywheel", _turned, _flywheel_notes)


# orders of the torque

_HIGHEST_ORDER = 1000


def _harmonics(
    case: Case, frame: Frame, orders: Sequence[float] | None = None, speeds: Sequence[float] | None = None
) -> tuple[list[Subject], Iterator[str]]:
    """Return the orders of the turning effort; orders: those to show, None for all up to 24.

    speeds: in revolutions per second, at which the orders of the whole machine are shown, too. Raises UsageError if
    nothing turns the shaft.
    """
    machine, found = case.machine, case.harmonics(_orders(case.machine, orders))
    if speeds is not None and not machine.speed:
        raise UsageError("--speeds: the inertia forces are scaled from those at the 'speed' of the machine; give one")
    cylinders = [
        Subject(
            one.forces.drive.name,
            left_out=left_out(machine, one.forces.drive.cylinder),
            tables=_orders_of_cylinder(one),
        )
        for one in found.cylinders
    ]
    no_masses = "no masses, or no speed given" if cylinders else "the effort is given as a torque"
    apart = missing({"gas and inertia apart": no_masses if found.machine.inertia is None else ""})
    whole = Subject(
        "whole machine",
        found,
        left_out=chain(flywheel_left_out(machine), apart),
        warnings=of_machine(case),
        tables=_orders_of_machine(found, speeds or (), machine.speed),
        whole=True,
    )
    return [*cylinders, whole], _harmonics_notes(found)


HARMONICS = Functions("Harmonics of the turning effort", whole_machine("harmonics"), own=_harmonics)


def _orders(machine: Machine, requested: Sequence[float] | None) -> Array | None:
    """Return the requested orders (n,), ascending and each once; None for the usual ones.

    Raises UsageError for one that the cycle does not have.
    """
    turns = machine.revolutions
    for order in requested or ():
        if not 0 < order <= _HIGHEST_ORDER:
            most = f"at most {_HIGHEST_ORDER} periods per turn"
            raise UsageError(f"--orders {order:g}: an order is more than 0 and {most}")
        if not is_whole(order * turns):
            known = {1: "1, 2, 3, …", 2: "½, 1, 1½, …"}.get(turns, f"1/{turns}, 2/{turns}, 3/{turns}, …")
            cycle = f"the cycle repeats after {360 * turns} degrees"
            raise UsageError(f"--orders {order:g}: {cycle} and has the orders {known}")
    return None if requested is None else np.unique(requested)


def _harmonics_notes(found: MachineOrders) -> Iterator[str]:
    torques = {f"The torque of {one.forces.drive.name}": one.own for one in found.cylinders}
    torques["The turning effort"] = found.machine
    yield from (
        f"{what} has none of these orders: they are all zero." for what, one in torques.items() if _uniform(one)
    )
    if not all(map(_uniform, torques.values())):
        yield "M = M_m + Σ (a_ν cos νφ + b_ν sin νφ) = M_m + Σ |M_ν| cos(νφ − ε_ν), ν periods per turn of the shaft."
        if found.machine.inertia is not None:
            yield (
                "M_b grows with the square of the speed; M_g, of gas, weight and friction, is the same at every speed."
            )


def _uniform(torque: Orders) -> bool:
    """Whether every order is zero, at every speed; then a note says so, in place of a table."""
    return not any(one.any() for one in (torque.gas, torque.inertia) if one is not None)


def _orders_of_cylinder(cylinder: CylinderOrders) -> Iterator[Places]:
    name, torque = cylinder.forces.drive.name, cylinder.own
    rows = _order_rows(torque, cylinder.area)
    title = f"Orders of the torque of {name}, φ from its own inner dead centre"
    yield Places("orders", title, ("kind",), TORQUE_ORDERS, rows, in_note=_uniform(torque))


def _orders_of_machine(found: MachineOrders, speeds: Sequence[float], working: float | None) -> Iterator[Places]:
    """Yield the orders of the turning effort at the working speed, and those at others, in revolutions per second."""
    torque, uniform = found.machine, _uniform(found.machine)
    title = "Orders of the turning effort, φ from the inner dead centre of crank 1"
    rows = _order_rows(torque, major=found.major_orders or ())
    yield Places("orders", title, ("kind",), TORQUE_ORDERS, rows, in_note=uniform)
    rows = []
    for speed in speeds:
        each = zip(torque.orders.tolist(), torque.at_speed(speed / (working or speed)).tolist())
        rows += [(("",), {"speed": speed, **_of_order(*order)}) for order in each]
    if speeds:
        title = "Orders of the turning effort at other speeds"
        yield Places("orders_by_speed", title, ("kind",), TORQUE_ORDERS, rows, in_note=uniform)


def _order_rows(torque: Orders, area: float | None = None, major: Sequence[float] = ()) -> list[Row]:
    """Return the orders of a torque; area: R A of its cylinder in m³, if it has a piston; major: those to mark."""
    rows = list[Row]()
    for index, order in enumerate(torque.orders.tolist()):
        values = _of_order(order, complex(torque.whole[index]))
        if torque.inertia is not None:
            values["M_gas"] = float(abs(torque.gas[index]))
            values["M_inertia"] = float(abs(torque.inertia[index]))
        if area:
            values["t_order"] = abs(torque.whole[index]) / area
        rows.append((("major" if order in major else "",), values))
    return rows


def _of_order(order: float, amplitude: complex) -> dict[str, float | None]:
    """Return one order: Re(M e^{iνφ}) = a cos νφ + b sin νφ = |M| cos(νφ − ε), ε above −180° up to 180°."""
    a, b = amplitude.real, -amplitude.imag
    phase = math.degrees(math.atan2(b, a)) + 0.0 if amplitude else None
    return {"order": order, "M_cos": a, "M_sin": b, "M_amplitude": abs(amplitude), "M_phase": phase}


# torsional vibration of the shaft line: natural vibrations, Holzer's table, critical speeds, forced vibration

_HIGHEST_CRITICAL = 12
"""Order up to which critical speeds are listed unless orders are requested."""
_MODES = 3
"""Modes whose critical speeds are listed unless others are requested."""


def _limited(found: ShaftVibration) -> ShaftVibration:
    """Return the vibration; raises NoSolutionError if it grows without limit."""
    if found.vibration is not None and found.vibration.endless.any():
        raise NoSolutionError(
            "an order of the torque meets a natural vibration that is hardly damped: give 'damping'; or segments of "
            "the shaft are too unequal to compute with: check the units of their stiffnesses"
        )
    return found


def _torsion(
    case: Case,
    frame: Frame,
    orders: Sequence[float] | None = None,
    modes: int = _MODES,
    mode: int | None = None,
    speeds: Sequence[float] | None = None,
    at: float | None = None,
) -> tuple[list[Subject], Iterator[str]]:
    """Return the torsional vibration of the shaft line; columns over the crank angle only if the frame has some.

    orders: those to count, None for the usual ones; modes: how many have critical speeds; mode, at: of Holzer's table,
    or a frequency in Hz in its place; speeds: in revolutions per second, at which amplitudes are listed. Raises
    UsageError without a shaft line, NoSolutionError if an undamped resonance has no limit.
    """
    if mode is not None and at is not None:
        raise UsageError("--mode and --at: Holzer's table is that of a mode or at a frequency; leave one of them out")
    found = case.torsion_of(_orders(case.machine, orders))
    critical = found.critical_speeds(modes, _HIGHEST_CRITICAL if orders is None else math.inf)
    _limited(found)
    rows = _critical_rows(found, critical)
    tables = [
        _modes_table(found),
        _holzer_table(found, mode or 1, at),
        Places("critical_speeds", "Critical speeds", ("note",), CRITICAL_SPEEDS, rows),
    ]
    if found.pieces:
        title = f"Torques and stresses at the working speed, all {'' if found.steady else 'these '}orders together"
        of_pieces: list[Row] = [((piece.name,), _of_piece(piece)) for piece in found.pieces]
        tables.append(Places("pieces", title, ("piece",), PIECES, of_pieces))
    if speeds is not None and not found.obstacle:
        by_speed: list[Row] = [
            ((found.piece_name(number),), {"speed": speed, **amplitudes})
            for number, piece in enumerate(zip(*_at_speeds(found, speeds)))
            for speed, amplitudes in zip(speeds, piece)
        ]
        title = "Vibratory torque over the speed, all these orders together"
        tables.append(Places("speeds", title, ("piece",), SPEEDS, by_speed))

    whole = Subject(
        "shaft line",
        found,
        left_out=torsion_left_out(found),
        warnings=chain(_near_speeds(found, critical), of_machine(case)),
        tables=tables,
        whole=True,
    )
    pieces = [Subject(one.name, at=one.at) for one in found.pieces] if frame.columns else []
    with_torque = ["M_vibratory" in values for _, values in rows]
    notes = _torsion_notes(found, orders is None, any(with_torque) and not all(with_torque))
    return [*pieces, whole], notes


TORSION = Functions("Torsional vibration", lambda case: [Subject("shaft line", _limited(case.torsion))], own=_torsion)


def _critical_rows(found: ShaftVibration, critical: Sequence[Critical]) -> list[Row]:
    """Return critical speeds, with the largest amplitudes of all pieces where one is reached and damped."""
    reached = [one for one in critical if found.met(one)]
    of_reached = dict(zip(reached, _at_speeds(found, [one.speed for one in reached])))
    rows: list[Row] = []
    for one in critical:
        values = {id: float(value) for id, value in one._asdict().items() if value is not None}
        for amplitudes in of_reached.get(one, ()):
            values |= {id: max(values.get(id, 0.0), amplitude) for id, amplitude in amplitudes.items()}
        rows.append((("near" if one.near else "",), values))
    return rows


def _modes_table(found: ShaftVibration) -> Places:
    """Return the natural frequencies, with how many nodes each mode has, and where if they are few."""
    rows: list[Row] = []
    names, modes = [mass.name for mass in found.line.masses], found.modes
    for index, omega in enumerate(modes.omegas.tolist()):
        mode, nodes = found.first + index, "rotation"
        if mode:
            between = [
                f"{names[mass]} + {share:.2f}" if share else names[mass] for mass, share in found.modes.nodes(index)
            ]
            where = ["at the ground"] * sum(found.chain.held) + between
            nodes = f"{len(where)} node{'s' if len(where) > 1 else ''}"
            nodes += f": {', '.join(where)}" if len(where) <= 2 else ""
        values = {"mode": float(mode), "frequency": omega / (2 * math.pi), "omega_natural": omega}
        rows.append(((nodes,), values))
    return Places("modes", "Natural frequencies", ("nodes",), MODES, rows)


def _holzer_table(found: ShaftVibration, mode: int, at: float | None) -> Places:
    """Return Holzer's table of a mode, or at a frequency in Hz: each mass with the segment after it.

    At a frequency that is not a natural one the last row has what is left: a torque, or the angle of a fixed end.
    """
    chain, left = found.chain, 0.0
    if at is None:
        table, omega = found.holzer(mode), float(found.modes.omegas[mode - found.first])
        of = f"of mode {mode}, f = {omega / (2 * math.pi):.6g} Hz"
    else:
        table, omega = holzer_at(chain, 2 * math.pi * at), 2 * math.pi * at
        of, left = f"at f = {at:.6g} Hz", table.residual
    first, last = chain.held
    rows: list[tuple[tuple[str], dict[str, float]]] = [
        ((mass.name,), {"inertia": inertia, "theta": theta, "inertia_torque": omega**2 * inertia * theta})
        for mass, inertia, theta in zip(found.line.masses, chain.inertias.tolist(), table.angles.tolist())
    ]
    rows = [(("ground",), {"theta": 0.0})] * first + rows + [(("ground",), {"theta": left})] * last
    for (_, values), torque, stiffness in zip(rows, table.torques.tolist(), chain.stiffnesses.tolist()):
        values |= {"torque_sum": torque, "stiffness": stiffness, "twist": torque / stiffness}
    if at is not None and not last:
        rows[-1][1]["torque_sum"] = left
    return Places("holzer", f"Holzer's table {of}, ω² = {omega**2:.6g} 1/s²", ("mass",), HOLZER, rows)


def _at_speeds(found: ShaftVibration, speeds: Sequence[float]) -> Iterator[list[dict[str, float]]]:
    """Yield for each speed vibratory torque and stress of every piece, nothing at an undamped resonance."""
    if not speeds:
        return
    vibration = found.forced(speeds)
    factors = [stress(found.line, piece) for piece in range(len(found.line.pieces))]
    for torques, endless in zip(vibration.vibratory.T.tolist(), vibration.endless):
        yield [
            {} if endless else {"M_vibratory": torque} | ({} if factor is None else {"tau_vibratory": factor * torque})
            for torque, factor in zip(torques, factors)
        ]


def _of_piece(piece: SegmentTorque) -> dict[str, float]:
    torques = piece.M_shaft_mean, piece.M_shaft_max, piece.M_shaft_min, piece.M_vibratory
    values = zip(PIECES, (*torques, piece.tau_mean, piece.tau_vibratory))
    return {id: value for id, value in values if value is not None}


def torsion_left_out(found: ShaftVibration) -> Iterator[LeftOut]:
    """Yield what torsional vibration leaves out."""
    bare = [found.piece_name(index) for index, piece in enumerate(found.line.pieces) if not piece.sections]
    if found.obstacle:
        yield LeftOut("forced vibration, torques and stresses", found.obstacle)
    elif bare:
        yield LeftOut(f"stress in {', '.join(bare)}", "no diameter given")
    if found.machine.cylinders:
        why = "the mean is used; parametric excitation is not computed"
        yield LeftOut("change of the inertia over the turn", why)


def torsion_warnings(case: Case) -> Iterator[str]:
    """Yield which of the usual critical speeds are near the working speed; raises as the report does."""
    yield from _near_speeds(_limited(case.torsion), case.torsion.critical_speeds(_MODES, _HIGHEST_CRITICAL))


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
    if found.pieces:
        orders, more = "all orders", ""
        if found.summed is not None:
            names = [f"{order:g}" for order in found.summed]
            listed = f"order{'s' if len(names) > 1 else ''} {', '.join(names)}"
            orders = listed if len(names) <= 4 else f"{len(names)} orders from {names[0]} to {names[-1]}"
        if found.remainder is not None:
            more = f" (higher ones add about {show(found.remainder, 'torque', figures=2)} or less)"
        taker = "what holds it" if found.chain.ground else line.masses[line.load].name
        yield f"Forced vibration: {orders} together{more}, about uniform rotation; the mean torque goes to {taker}."
