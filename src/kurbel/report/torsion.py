"""The report of `kurbel torsion`: natural vibrations, Holzer's table, critical speeds, and forced vibration."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from kurbel.declared.quantity import Quantity
from kurbel.declared.torsion import CRITICAL_SPEEDS, HOLZER, MODES, PIECES, SPEEDS
from kurbel.declared.unit_systems import show
from kurbel.errors import NoSolutionError
from kurbel.report.frame import Frame, Subject
from kurbel.report.harmonics import orders_of
from kurbel.report.notes import of_machine
from kurbel.report.shown import place_table
from kurbel.report.tables import LeftOut, PlaceTable, Report
from kurbel.solver.case import Case
from kurbel.solver.torsion import RUN_UP, Critical, ShaftVibration, Vibration, stress

_Values = dict[Quantity, Sequence[Any]]
_Borne = tuple[float | None, float | None]
"""Largest vibratory torque in N m and stress in Pa of any piece, None where none is told."""
_HIGHEST = 12
"""Order up to which critical speeds are told unless orders are asked for."""
_MODES = 3
"""Modes whose critical speeds are told unless others are asked for."""


class Wanted(NamedTuple):
    """What is asked of torsion: orders, how many modes, whose Holzer table, and speeds in revolutions per second."""

    orders: Sequence[float] | None = None
    modes: int = _MODES
    mode: int = 1
    speeds: Sequence[float] | None = None


@np.errstate(all="ignore")  # what overflows is refused, by name
def torsion_report(case: Case, frame: Frame, wanted: Wanted = Wanted()) -> Report:  # noqa: B008 (immutable)
    """Return the torsional vibration of the shaft line; without columns of the frame only its tables are told.

    Raises UsageError without a shaft line, NoSolutionError where an undamped resonance has no end.
    """
    found = case.torsion_of(orders_of(case.machine, wanted.orders))
    critical = found.critical_speeds(wanted.modes, _HIGHEST if wanted.orders is None else math.inf)
    (whole,) = subjects(case, found, critical)
    borne = _borne(found, critical)
    whole = replace(whole, place_tables=tuple(_tables(found, critical, borne, wanted, frame.system)))
    pieces = found.pieces if frame.columns else ()
    each = [Subject(one.name, (), one.at) for one in pieces]
    return frame.report(case.machine, "Drehschwingungen", each, whole, _notes(found, wanted, critical, borne))


def subjects(
    case: Case, asked: ShaftVibration | None = None, critical: tuple[Critical, ...] | None = None
) -> Iterable[Subject]:
    """Yield the shaft line; asked: by other than the usual orders; critical: the critical speeds to warn of."""
    found = asked or case.torsion
    _refuse_endless(found)
    yield Subject(
        "shaft line",
        (found,),
        left_out=lambda: torsion_left_out(found),
        warnings=lambda: (*_warnings(found, critical or ()), *of_machine(case)),
    )


def torsion_warnings(case: Case) -> Iterable[str]:
    """Yield which of the usual critical speeds lie beside the working speed; refuses a vibration without an end."""
    _refuse_endless(case.torsion)
    yield from _warnings(case.torsion, case.torsion.critical_speeds(_MODES, _HIGHEST))


def _refuse_endless(found: ShaftVibration) -> None:
    if found.vibration is not None and found.vibration.endless.any():
        raise NoSolutionError(
            "an order of the torque meets a natural vibration that next to nothing damps: give it 'damping'; or pieces "
            "of the shaft are too unequal to compute with: look at the units of their stiffnesses"
        )


def _tables(
    found: ShaftVibration, critical: Sequence[Critical], borne: Sequence[_Borne], wanted: Wanted, system: str
) -> Iterable[PlaceTable]:
    yield _modes_table(found, system)
    yield _holzer_table(found, wanted.mode, system)
    yield _critical_table(critical, borne, system)
    if found.pieces:
        yield _pieces_table(found, system)
    if wanted.speeds is not None and not found.obstacle:
        yield _speeds_table(found, wanted.speeds, system)


def _table(id: str, title: str, head: str, names: Iterable[str], values: _Values, system: str) -> PlaceTable:
    """Return a table of what any of its rows has."""
    found = ((quantity, of) for quantity, of in values.items() if any(one is not None for one in of))
    return place_table(id, title, (head,), ((name.replace(" ", "_"),) for name in names), found, system)


def _modes_table(found: ShaftVibration, system: str) -> PlaceTable:
    """Return the natural frequencies, with what stands still in each mode."""
    omegas = found.modes.omegas.tolist()
    names = [_nodes(found, index) for index in range(len(omegas))]
    values: _Values = {
        MODES["mode"]: [float(found.first + index) for index in range(len(omegas))],
        MODES["frequency"]: [omega / (2 * np.pi) for omega in omegas],
        MODES["omega_natural"]: omegas,
    }
    return _table("modes", "Natural frequencies", "nodes", names, values, system)


def _nodes(found: ShaftVibration, index: int) -> str:
    """Return the nodes of a mode: how many, and of few of them where."""
    if found.first + index == 0:
        return "rotation"
    names = [mass.name for mass in found.line.masses]
    nodes = found.modes.nodes(index)
    held = ["at the ground"] if found.chain.ground else []
    where = held + [f"{names[mass]} + {share:.2f}" if share else names[mass] for mass, share in nodes]
    count = f"{len(where)} node{'s' if len(where) > 1 else ''}"
    return f"{count}: {', '.join(where)}" if len(where) <= 2 else count


def _holzer_table(found: ShaftVibration, mode: int, system: str) -> PlaceTable:
    """Return Holzer's table of a mode, from the first mass to the last."""
    table, chain = found.holzer(mode), found.chain
    omega = float(found.modes.omegas[mode - found.first])
    before, after = (["ground"] if chain.ground == end else [] for end in ("before", "after"))

    def rows(of_masses: Any) -> list[float | None]:
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


def _borne(found: ShaftVibration, critical: Sequence[Critical]) -> list[_Borne]:
    """Return what the pieces bear at critical speeds: nothing is told of those not met, and of those without an end."""
    borne: list[_Borne] = [(None, None)] * len(critical)
    met = [index for index, one in enumerate(critical) if found.met(one)]
    if met:
        vibration = found.forced([critical[index].speed for index in met])
        found_there = zip(met, vibration.vibratory.max(axis=0).tolist(), _stresses(vibration), vibration.endless)
        for index, torque, strain, endless in found_there:
            if not endless:
                borne[index] = torque, strain
    return borne


def _critical_table(critical: Sequence[Critical], borne: Sequence[_Borne], system: str) -> PlaceTable:
    """Return the critical speeds, and what the pieces bear where the machine meets them."""
    values: _Values = {
        CRITICAL_SPEEDS["order"]: [one.order for one in critical],
        CRITICAL_SPEEDS["mode"]: [float(one.mode) for one in critical],
        CRITICAL_SPEEDS["speed"]: [one.speed for one in critical],
        CRITICAL_SPEEDS["phase_sum"]: [one.phase_sum for one in critical],
        CRITICAL_SPEEDS["distance"]: [one.distance for one in critical],
        CRITICAL_SPEEDS["M_vibratory"]: [torque for torque, _ in borne],
        CRITICAL_SPEEDS["tau_vibratory"]: [strain for _, strain in borne],
    }
    names = ["near" if one.near else "" for one in critical]
    return _table("critical_speeds", "Critical speeds", "note", names, values, system)


def _stresses(vibration: Vibration) -> list[float | None]:
    """Return the largest vibratory stress of any piece in Pa, (s,); None where no section is known."""
    factors = [stress(vibration.line, piece) for piece in range(len(vibration.line.pieces))]
    if not any(factors):
        return [None] * len(vibration.omegas)
    each = np.array([factor or 0.0 for factor in factors])[:, None] * vibration.vibratory
    return list(each.max(axis=0).tolist())


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
        told = [None if endless else torque for torque, endless in zip(of_piece.tolist(), vibration.endless)]
        torques += told
        stresses += [None if factor is None or torque is None else factor * torque for torque in told]
    values: _Values = {
        SPEEDS["speed"]: list(speeds) * len(found.line.pieces),
        SPEEDS["M_vibratory"]: torques,
        SPEEDS["tau_vibratory"]: stresses,
    }
    title = "Vibratory torque over the speed, all these orders together"
    return _table("speeds", title, "piece", names, values, system)


def torsion_left_out(found: ShaftVibration) -> Iterable[LeftOut]:
    """Yield what torsional vibration leaves out, with the reason."""
    if found.obstacle:
        yield LeftOut("forced vibration, torques and stresses", found.obstacle)
    elif not all(piece.sections for piece in found.line.pieces):
        bare = [found.piece_name(i) for i, piece in enumerate(found.line.pieces) if not piece.sections]
        yield LeftOut(f"stress in {', '.join(bare)}", "no diameter given")
    if found.machine.cylinders:
        yield LeftOut("change of the inertia over the turn", "the mean counts; what its change excites is not told")


def _warnings(found: ShaftVibration, critical: tuple[Critical, ...]) -> Iterable[str]:
    """Yield, mode by mode, the critical speeds beside the working speed, the strongest first."""
    speed = found.machine.speed
    for mode in sorted({one.mode for one in critical}):
        near = sorted((one for one in critical if one.mode == mode and one.near), key=lambda one: -one.share)
        if not near or speed is None:
            continue
        listed = ", ".join(f"{one.order:g} ({100 * (one.distance or 0.0):+.3g} %)" for one in near)
        plural = "s" if len(near) > 1 else ""
        yield (
            f"mode {mode}: critical speed{plural} of order{plural} {listed} within 10 % of the working speed "
            f"{show(speed, 'speed')}"
        )


def _listed(orders: Sequence[str]) -> str:
    """Return orders in words: few of them by name, many by their first and last."""
    if len(orders) > 4:
        return f"{len(orders)} orders from {orders[0]} to {orders[-1]}"
    return f"order{'s' if len(orders) > 1 else ''} {', '.join(orders)}"


def _notes(
    found: ShaftVibration, wanted: Wanted, critical: Sequence[Critical], borne: Sequence[_Borne]
) -> Iterable[str]:
    if wanted.orders is None:
        yield f"Critical speeds of orders up to {_HIGHEST}; --orders tells others, --modes of more modes."
    if any(map(found.met, critical)) and None in {torque for torque, _ in borne}:
        yield (
            "What the shaft bears at a critical speed holds all orders, when running there; – stands where the machine "
            f"does not come, beyond {RUN_UP:g} times the working speed, and where next to nothing damps the mode."
        )
    if any(piece.ratio != 1 for piece in found.line.pieces):
        yield "Masses and stiffnesses beyond the gear are referred to the cranks' shaft by u²; torques are true ones."
    if not found.machine.cylinders and found.machine.effort:
        yield f"The effort acts on {found.line.masses[0].name}, the first mass."
    if found.pieces:
        orders = "all orders" if found.summed is None else _listed([f"{order:g}" for order in found.summed])
        orders += " together"
        if found.remainder is not None:
            orders += f" (higher ones add about {show(found.remainder, 'torque', figures=2)} or less)"
        taker = "what holds it" if found.chain.ground else found.line.masses[found.line.load].name
        yield f"Forced vibration: {orders}, about uniform rotation; the mean torque goes to {taker}."
