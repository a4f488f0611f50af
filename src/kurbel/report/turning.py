"""The reports of `kurbel flywheel`, `harmonics` and `torsion`: what turns the shaft, and how it twists."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.declared.quantity import Quantity
from kurbel.declared.torsion import CRITICAL_SPEEDS, HOLZER, MODES, PIECES, SPEEDS, TORQUE_ORDERS
from kurbel.declared.unit_systems import show
from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine import Machine
from kurbel.numerics.extreme import Extreme
from kurbel.report.frame import Frame, Subject, place_table, report_on
from kurbel.report.left_out import flywheel_left_out, left_out, missing
from kurbel.report.tables import LeftOut, PlaceTable, Report
from kurbel.report.warnings import of_machine
from kurbel.solver.case import Case
from kurbel.solver.flywheel import MachineTurning
from kurbel.solver.forces import CylinderForces
from kurbel.solver.harmonics import MachineOrders, Orders, Spectrum
from kurbel.solver.motion import every_dead_centre
from kurbel.solver.torsion import RUN_UP, Critical, ShaftVibration, Vibration, stress

_Values = Mapping[Quantity, Sequence[Any]]
"""Quantities with their values in SI, None for no value."""

# turning effort, excess work, flywheel and speed line


@np.errstate(all="ignore")  # what overflows is refused by name
def flywheel_report(case: Case, frame: Frame) -> Report:
    """Return the turning effort of the machine over the angle of crank 1.

    Raises UsageError if nothing turns the shaft, NoSolutionError if the machine stalls.
    """
    *cylinders, whole = flywheel_subjects(case)
    having = [one for one in cylinders if any(one.key_values("flywheel"))]
    if frame.prose:
        whole = replace(whole, left_out=tuple(flywheel_left_out(case.machine)), warnings=of_machine(case))
    notes = _flywheel_notes(case.machine, case.flywheel)
    return report_on(frame, case.machine, "Drehkraftlinie und Schwungrad", having, whole, notes)


@dataclass(frozen=True, eq=False)
class _DeadCentre:
    """The key value of a single cylinder: the force that its parts before a pump must carry."""

    turning: MachineTurning
    forces: CylinderForces

    @property
    def P_dead_centre(self) -> Extreme | None:
        """Largest force in N in a dead centre, without inertia."""
        return dead_centre_force(self.forces, self.turning.effort.cycle)


def flywheel_subjects(case: Case) -> list[Subject]:
    """Return every cylinder, and the whole machine last."""
    turning = case.flywheel
    cylinders = [Subject(one.drive.name, (_DeadCentre(turning, one),)) for one in case.cylinders]
    return [*cylinders, Subject("whole machine", tuple(turning.answering), turning.at, source=turning)]


def dead_centre_force(forces: CylinderForces, cycle: float) -> Extreme | None:
    """Return the largest force in N of steam and pump in a dead centre of a cylinder, without inertia (R p. 613).

    At the end of the stroke both oppose the motion, and the parts before the pump must carry their sum. None if the
    cylinder does not both drive and drive a pump.
    """
    driving, driven = forces.work_driving, forces.work_driven
    both = np.asarray(driving is not None and (driving > 0) & (driven < 0))
    if not both.any():
        return None
    drive, count = forces.drive, forces.drive.count or 1
    centres = every_dead_centre(drive.mechanism, count, drive.cycle)
    angles = np.repeat(centres, 2, axis=1)
    sides = angles + np.tile([-1e-6, 1e-6], centres.shape[1])
    machine = np.repeat(np.arange(count), angles.shape[1])
    values = drive.at(angles.ravel(), sides.ravel(), machine).P_gas.reshape(angles.shape)
    largest = np.arange(count), np.abs(values).argmax(axis=1)
    found = np.where(both, values[largest], np.nan), np.mod(angles[largest], cycle)
    return Extreme(*map(forces.told, found))


def _flywheel_notes(machine: Machine, turning: MachineTurning) -> Iterator[str]:
    effort = turning.effort
    if turning.crank is not None:
        over = "over" if any(term.factor > 1 for term in effort.terms) else "with"
        eta = f", {over} the efficiency {machine.efficiency:g}" if machine.efficiency != 1 else ""
        yield f"T and W are referred to the radius of crank 1, {show(turning.crank, 'length')}{eta}; φ is its angle."
    if turning.J is not None and turning.omega and not turning.elastic and turning.multiplier is None:
        yield "Such a load holds no speed of its own: the mean of ω over time is taken as the nominal speed."
    if machine.efficiency != 1 and any(effort.lost(group) for group in effort.groups):
        yield (
            "Where driving and driven pistons share a rod, the efficiency reduces the force of the driving pistons; "
            "driven pistons, inertia, weight and friction count in full (R p. 613)."
        )
    if machine.efficiency != 1 and any(term.factor != 1 for term in effort.inertia_terms) and turning.speed is not None:
        yield "As in the book the efficiency takes its share of all of T; in ω the moving masses count in full."
    if turning.rigid:
        yield (
            f"The coupling counts as rigid, its natural order {turning.natural_order:.4g} being above 100: "
            "the driven inertia turns with the flywheel."
        )


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
    cylinders = []
    for one in found.cylinders:
        cylinder = one.forces.drive.cylinder
        title = f"Orders of the torque of {cylinder.name}, φ from its own inner dead centre"
        table = _orders_table(title, one.own, one.area, (), frame.system)
        cylinders.append(Subject(cylinder.name, left_out=tuple(left_out(machine, cylinder)), tables=(table,)))
    title = "Orders of the turning effort, φ from the inner dead centre of crank 1"
    tables = [_orders_table(title, found.machine, None, found.major_orders or (), frame.system)]
    if speeds is not None:
        tables.append(_speeds_of_orders(machine, found, speeds, frame.system))
    said = _uniform(found.machine)
    no_masses = "no masses, or no speed given" if found.cylinders else "the effort is given as a torque"
    apart = {"gas and inertia apart": "" if found.machine.inertia else no_masses}
    whole = Subject(
        "whole machine",
        (found,),
        left_out=(*flywheel_left_out(machine), *missing(apart)),
        warnings=of_machine(case) if frame.prose else (),
        tables=tuple(table._replace(said=said) for table in tables),
    )
    return report_on(frame, machine, "Drehkraft nach Ordnungen", cylinders, whole, _orders_notes(found))


def harmonics_subjects(case: Case) -> list[Subject]:
    """Return the whole machine."""
    return [Subject("whole machine", (case.harmonics(),))]


def _orders(machine: Machine, requested: Sequence[float] | None) -> Array | None:
    """Return the requested orders (n,), ascending and each once; None for the usual ones.

    Raises UsageError for one that the cycle does not have.
    """
    for order in requested or ():
        if not 0 < order <= _HIGHEST_ORDER:
            raise UsageError(
                f"--orders {order:g}: an order is more than 0 and at most {_HIGHEST_ORDER} periods per turn"
            )
        if (order * machine.revolutions) % 1:
            known = "½, 1, 1½, …" if machine.revolutions == 2 else "1, 2, 3, …"
            degrees = 360 * machine.revolutions
            raise UsageError(
                f"--orders {order:g}: the cycle repeats after {degrees} degrees and has the orders {known}"
            )
    return None if requested is None else np.array(sorted(set(requested)), dtype=float)


def _orders_table(title: str, orders: Orders, area: float | None, major: Sequence[float], system: str) -> PlaceTable:
    """Return the orders of a torque; area: of the piston, for the tangential pressure; major: those to mark."""
    whole = orders.whole
    values = _of_spectrum(whole)
    if orders.inertia is not None:
        values[TORQUE_ORDERS["M_gas"]] = np.abs(orders.gas.amplitudes).tolist()
        values[TORQUE_ORDERS["M_inertia"]] = np.abs(orders.inertia.amplitudes).tolist()
    if area:
        values[TORQUE_ORDERS["t_order"]] = (np.abs(whole.amplitudes) / area).tolist()
    names = [("major" if order in major else "",) for order in whole.orders.tolist()]
    table = place_table("orders", title, ("kind",), names, values.items(), system)
    return table._replace(said=_uniform(orders))


def _of_spectrum(found: Spectrum) -> dict[Quantity, list[Any]]:
    amplitudes = found.amplitudes
    values = {
        "order": found.orders.tolist(),
        "M_cos": amplitudes.real.tolist(),
        "M_sin": (-amplitudes.imag).tolist(),
        "M_amplitude": np.abs(amplitudes).tolist(),
        "M_phase": _phase_degrees(amplitudes),
    }
    return {TORQUE_ORDERS[id]: each for id, each in values.items()}


def _phase_degrees(amplitudes: ComplexArray) -> list[float | None]:
    """Return ε in degrees, above −180 up to 180, with Re(M e^{iνφ}) = |M| cos(νφ − ε); None if M is zero."""
    phases = np.degrees(np.arctan2(-amplitudes.imag, amplitudes.real)) + 0.0
    return [phase if amplitude else None for phase, amplitude in zip(phases.tolist(), amplitudes.tolist())]


def _speeds_of_orders(machine: Machine, found: MachineOrders, speeds: Sequence[float], system: str) -> PlaceTable:
    if not machine.speed:
        raise UsageError("--speeds: the inertia forces are told from those at the 'speed' of the machine; give it one")
    columns: dict[Quantity, list[Any]] = {TORQUE_ORDERS["speed"]: [speed for speed in speeds for _ in found.orders]}
    for speed in speeds:
        for quantity, values in _of_spectrum(found.machine.at_speed(speed / machine.speed)).items():
            columns.setdefault(quantity, []).extend(values)
    names = [("",)] * len(speeds) * len(found.orders)
    title = "Orders of the turning effort at other speeds"
    return place_table("orders_by_speed", title, ("kind",), names, columns.items(), system)


def _uniform(found: Orders) -> bool:
    """Whether every order is zero, at every speed."""
    return not any(one.amplitudes.any() for one in found if one)


def _orders_notes(found: MachineOrders) -> Iterator[str]:
    torques = [(f"The torque of {one.forces.drive.cylinder.name}", one.own) for one in found.cylinders]
    torques.append(("The turning effort", found.machine))
    uniform = [what for what, orders in torques if _uniform(orders)]
    yield from (f"{what} has none of these orders: they are all zero." for what in uniform)
    if len(uniform) == len(torques):
        return
    yield "M = M_m + Σ (a_ν cos νφ + b_ν sin νφ) = M_m + Σ |M_ν| cos(νφ − ε_ν), ν periods per turn of the shaft."
    if found.machine.inertia is not None:
        yield "M_b goes with the square of the speed; M_g, of gas, weight and friction, counts the same at every speed."


# torsional vibration of the shaft line: natural vibrations, Holzer's table, critical speeds, forced vibration

_HIGHEST_CRITICAL = 12
"""Order up to which critical speeds are listed unless orders are requested."""
_MODES = 3
"""Modes whose critical speeds are listed unless others are requested."""
_Amplitude = tuple[float | None, float | None]
"""Largest vibratory torque in N m and stress in Pa of any piece, None if not known."""


class Wanted(NamedTuple):
    """What is requested of torsion: orders, how many modes, whose Holzer table, speeds in revolutions per second."""

    orders: Sequence[float] | None = None
    modes: int = _MODES
    mode: int = 1
    speeds: Sequence[float] | None = None


@np.errstate(all="ignore")
def torsion_report(case: Case, frame: Frame, wanted: Wanted = Wanted()) -> Report:  # noqa: B008 (immutable)
    """Return the torsional vibration of the shaft line; columns over the crank angle only if the frame has some.

    Raises UsageError without a shaft line, NoSolutionError if an undamped resonance has no limit.
    """
    found, system = case.torsion_of(_orders(case.machine, wanted.orders)), frame.system
    critical = found.critical_speeds(wanted.modes, _HIGHEST_CRITICAL if wanted.orders is None else math.inf)
    _refuse_endless(found)
    amplitudes = _at_critical(found, critical)
    tables = [
        _modes_table(found, system),
        _holzer_table(found, wanted.mode, system),
        _critical_table(critical, amplitudes, system),
        *([_pieces_table(found, system)] if found.pieces else []),
        *([] if wanted.speeds is None or found.obstacle else [_speeds_table(found, wanted.speeds, system)]),
    ]
    warnings = (*_near_speeds(found, critical), *of_machine(case)) if frame.prose else ()
    lacking = tuple(torsion_left_out(found))
    whole = Subject("shaft line", (found,), left_out=lacking, warnings=warnings, tables=tuple(tables))
    pieces = [Subject(one.name, (), one.at) for one in found.pieces] if frame.columns else []
    notes = _torsion_notes(found, wanted, critical, amplitudes)
    return report_on(frame, case.machine, "Drehschwingungen", pieces, whole, notes)


def torsion_subjects(case: Case) -> list[Subject]:
    """Return the shaft line; raises NoSolutionError if an undamped resonance has no limit."""
    _refuse_endless(case.torsion)
    return [Subject("shaft line", (case.torsion,))]


def torsion_warnings(case: Case) -> Iterator[str]:
    """Yield which of the usual critical speeds are near the working speed; raises as `torsion_subjects` does."""
    _refuse_endless(case.torsion)
    yield from _near_speeds(case.torsion, case.torsion.critical_speeds(_MODES, _HIGHEST_CRITICAL))


def _refuse_endless(found: ShaftVibration) -> None:
    if found.vibration is not None and found.vibration.endless.any():
        raise NoSolutionError(
            "an order of the torque meets a natural vibration that next to nothing damps: give it 'damping'; or pieces "
            "of the shaft are too unequal to compute with: look at the units of their stiffnesses"
        )


def _table(id: str, title: str, head: str, names: Iterable[str], values: _Values, system: str) -> PlaceTable:
    """Return a table of the quantities that any of its rows has."""
    found = ((quantity, each) for quantity, each in values.items() if any(one is not None for one in each))
    return place_table(id, title, (head,), ((name.replace(" ", "_"),) for name in names), found, system)


def _modes_table(found: ShaftVibration, system: str) -> PlaceTable:
    """Return the natural frequencies, with the nodes of each mode."""
    omegas = found.modes.omegas.tolist()
    values: _Values = {
        MODES["mode"]: [float(found.first + index) for index in range(len(omegas))],
        MODES["frequency"]: [omega / (2 * np.pi) for omega in omegas],
        MODES["omega_natural"]: omegas,
    }
    names = [_nodes(found, index) for index in range(len(omegas))]
    return _table("modes", "Natural frequencies", "nodes", names, values, system)


def _nodes(found: ShaftVibration, index: int) -> str:
    """Return how many nodes a mode has, and where if they are few."""
    if found.first + index == 0:
        return "rotation"
    names = [mass.name for mass in found.line.masses]
    held = ["at the ground"] if found.chain.ground else []
    nodes = found.modes.nodes(index)
    where = held + [f"{names[mass]} + {share:.2f}" if share else names[mass] for mass, share in nodes]
    count = f"{len(where)} node{'s' if len(where) > 1 else ''}"
    return f"{count}: {', '.join(where)}" if len(where) <= 2 else count


def _holzer_table(found: ShaftVibration, mode: int, system: str) -> PlaceTable:
    """Return Holzer's table of a mode, from the first mass to the last."""
    table, chain = found.holzer(mode), found.chain
    omega = float(found.modes.omegas[mode - found.first])
    before, after = (["ground"] if chain.ground == end else [] for end in ("before", "after"))

    def rows(of_masses: Array) -> list[float | None]:
        """Return the values of masses, with none at a fixed end."""
        return [*(None for _ in before), *of_masses.tolist(), *(None for _ in after)]

    values: _Values = {
        HOLZER["inertia"]: rows(chain.inertias),
        HOLZER["theta"]: [0.0 if angle is None else angle for angle in rows(table.angles)],
        HOLZER["inertia_torque"]: rows(omega**2 * chain.inertias * table.angles),
        HOLZER["torque_sum"]: [*table.torques.tolist(), None],
        HOLZER["stiffness"]: [*chain.stiffnesses.tolist(), None],
        HOLZER["twist"]: [*(table.torques / chain.stiffnesses).tolist(), None],
    }
    names = [*before, *(mass.name for mass in found.line.masses), *after]
    title = f"Holzer's table of mode {mode}, f = {omega / (2 * np.pi):.6g} Hz, ω² = {omega**2:.6g} 1/s²"
    return _table("holzer", title, "mass", names, values, system)


def _at_critical(found: ShaftVibration, critical: Sequence[Critical]) -> list[_Amplitude]:
    """Return torque and stress at critical speeds: none at those the machine does not reach, and undamped ones."""
    amplitudes: list[_Amplitude] = [(None, None)] * len(critical)
    met = [index for index, one in enumerate(critical) if found.met(one)]
    if met:
        vibration = found.forced([critical[index].speed for index in met])
        there = zip(met, vibration.vibratory.max(axis=0).tolist(), _stresses(vibration), vibration.endless)
        for index, torque, tension, endless in there:
            if not endless:
                amplitudes[index] = torque, tension
    return amplitudes


def _stresses(vibration: Vibration) -> list[float | None]:
    """Return the largest vibratory stress of any piece in Pa, (s,); None if no section is known."""
    factors = [stress(vibration.line, piece) for piece in range(len(vibration.line.pieces))]
    if not any(factors):
        return [None] * len(vibration.omegas)
    each = np.array([factor or 0.0 for factor in factors])[:, None] * vibration.vibratory
    return list(each.max(axis=0).tolist())


def _critical_table(critical: Sequence[Critical], amplitudes: Sequence[_Amplitude], system: str) -> PlaceTable:
    values: _Values = {
        CRITICAL_SPEEDS["order"]: [one.order for one in critical],
        CRITICAL_SPEEDS["mode"]: [float(one.mode) for one in critical],
        CRITICAL_SPEEDS["speed"]: [one.speed for one in critical],
        CRITICAL_SPEEDS["phase_sum"]: [one.phase_sum for one in critical],
        CRITICAL_SPEEDS["distance"]: [one.distance for one in critical],
        CRITICAL_SPEEDS["M_vibratory"]: [torque for torque, _ in amplitudes],
        CRITICAL_SPEEDS["tau_vibratory"]: [tension for _, tension in amplitudes],
    }
    names = ["near" if one.near else "" for one in critical]
    return _table("critical_speeds", "Critical speeds", "note", names, values, system)


def _pieces_table(found: ShaftVibration, system: str) -> PlaceTable:
    """Return torques and stresses in the pieces at the working speed."""
    values: _Values = {quantity: [getattr(piece, id) for piece in found.pieces] for id, quantity in PIECES.items()}
    title = f"Torques and stresses at the working speed, all {'' if found.steady else 'these '}orders together"
    return _table("pieces", title, "piece", [piece.name for piece in found.pieces], values, system)


def _speeds_table(found: ShaftVibration, speeds: Sequence[float], system: str) -> PlaceTable:
    """Return the vibratory torque in every piece over the speed."""
    vibration = found.forced(speeds)
    names, torques, stresses = [], [], []
    for piece, of_piece in enumerate(vibration.vibratory):
        factor = stress(found.line, piece)
        names += [found.piece_name(piece)] * len(speeds)
        own = [None if endless else torque for torque, endless in zip(of_piece.tolist(), vibration.endless)]
        torques += own
        stresses += [None if factor is None or torque is None else factor * torque for torque in own]
    values: _Values = {
        SPEEDS["speed"]: list(speeds) * len(found.line.pieces),
        SPEEDS["M_vibratory"]: torques,
        SPEEDS["tau_vibratory"]: stresses,
    }
    title = "Vibratory torque over the speed, all these orders together"
    return _table("speeds", title, "piece", names, values, system)


def torsion_left_out(found: ShaftVibration) -> Iterator[LeftOut]:
    """Yield what torsional vibration leaves out."""
    bare = [found.piece_name(index) for index, piece in enumerate(found.line.pieces) if not piece.sections]
    if found.obstacle:
        yield LeftOut("forced vibration, torques and stresses", found.obstacle)
    elif bare:
        yield LeftOut(f"stress in {', '.join(bare)}", "no diameter given")
    if found.machine.cylinders:
        yield LeftOut("change of the inertia over the turn", "the mean counts; what its change excites is not told")


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


def _torsion_notes(
    found: ShaftVibration, wanted: Wanted, critical: Sequence[Critical], amplitudes: Sequence[_Amplitude]
) -> Iterator[str]:
    if wanted.orders is None:
        yield f"Critical speeds of orders up to {_HIGHEST_CRITICAL}; --orders tells others, --modes of more modes."
    if any(map(found.met, critical)) and any(torque is None for torque, _ in amplitudes):
        yield (
            "What the shaft bears at a critical speed holds all orders, when running there; – stands where the machine "
            f"does not come, beyond {RUN_UP:g} times the working speed, and where next to nothing damps the mode."
        )
    if any(piece.ratio != 1 for piece in found.line.pieces):
        yield "Masses and stiffnesses beyond the gear are referred to the cranks' shaft by u²; torques are true ones."
    if not found.machine.cylinders and found.machine.effort:
        yield f"The effort acts on {found.line.masses[0].name}, the first mass."
    if found.pieces:
        higher = ""
        if found.remainder is not None:
            higher = f" (higher ones add about {show(found.remainder, 'torque', figures=2)} or less)"
        taker = "what holds it" if found.chain.ground else found.line.masses[found.line.load].name
        orders = _listed(found.summed)
        yield f"Forced vibration: {orders} together{higher}, about uniform rotation; the mean torque goes to {taker}."


def _listed(orders: Array | None) -> str:
    """Return orders in words: few of them one by one, many by the first and the last."""
    if orders is None:
        return "all orders"
    names = [f"{order:g}" for order in orders]
    if len(names) > 4:
        return f"{len(names)} orders from {names[0]} to {names[-1]}"
    return f"order{'s' if len(names) > 1 else ''} {', '.join(names)}"
