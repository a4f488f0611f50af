"""The tables of `kurbel torsion`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from kurbel.declared.quantity import Quantity
from kurbel.declared.torsion import CRITICAL_SPEEDS, HOLZER, MODES, PIECES, SPEEDS
from kurbel.report.orders import counted
from kurbel.report.shown import shown_column
from kurbel.report.tables import PlaceTable
from kurbel.solver.torsion.forced import Vibration, stress
from kurbel.solver.torsion.vibration import Critical, ShaftVibration


def _table(
    id: str, title: str, head: str, names: Sequence[str], declared: dict[str, Quantity], system: str, **values: Any
) -> PlaceTable:
    columns = counted(
        shown_column(declared[name], of, system)
        for name, of in values.items()
        if of is not None and any(one is not None for one in of)
    )
    return PlaceTable(id, title, (head,), tuple((name.replace(" ", "_"),) for name in names), columns)


def modes_table(found: ShaftVibration, system: str) -> PlaceTable:
    """Return the natural frequencies, with what stands still in each mode."""
    omegas = found.modes.omegas.tolist()
    return _table(
        "modes",
        "Natural frequencies",
        "nodes",
        [_nodes(found, index) for index in range(len(omegas))],
        MODES,
        system,
        mode=[float(found.first + index) for index in range(len(omegas))],
        frequency=[omega / (2 * np.pi) for omega in omegas],
        omega_natural=omegas,
    )


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


def holzer_table(found: ShaftVibration, mode: int, system: str) -> PlaceTable:
    """Return Holzer's table of a mode, from the first mass to the last."""
    table, chain = found.holzer(mode), found.chain
    omega = float(found.modes.omegas[mode - found.first])
    before, after = chain.ground == "before", chain.ground == "after"
    angles, own = table.angles, omega**2 * chain.inertias * table.angles
    twists = table.torques / chain.stiffnesses

    def rows(values: Any) -> list[float | None]:
        """Return the values of masses, with none at a fixed end."""
        return [*([None] if before else []), *values.tolist(), *([None] if after else [])]

    names = [
        *(["ground"] if before else []),
        *(mass.name for mass in found.line.masses),
        *(["ground"] if after else []),
    ]
    title = f"Holzer's table of mode {mode}, f = {omega / (2 * np.pi):.6g} Hz, ω² = {omega**2:.6g} 1/s²"
    return _table(
        "holzer",
        title,
        "mass",
        names,
        HOLZER,
        system,
        inertia=rows(chain.inertias),
        theta=[0.0 if angle is None else angle for angle in rows(angles)],
        inertia_torque=rows(own),
        torque_sum=[*table.torques.tolist(), None],
        stiffness=[*chain.stiffnesses.tolist(), None],
        twist=[*twists.tolist(), None],
    )


def critical_table(found: ShaftVibration, critical: tuple[Critical, ...], system: str) -> PlaceTable:
    """Return the critical speeds, and what the pieces bear where the machine meets them."""
    torques: list[float | None] = [None] * len(critical)
    stresses: list[float | None] = [None] * len(critical)
    met = [index for index, one in enumerate(critical) if found.met(one)]
    if met:
        vibration = found.forced([critical[index].speed for index in met])
        found_there = zip(met, vibration.vibratory.max(axis=0).tolist(), _stresses(vibration), vibration.endless)
        for index, torque, strain, endless in found_there:
            if not endless:
                torques[index], stresses[index] = torque, strain
    return _table(
        "critical_speeds",
        "Critical speeds",
        "note",
        ["near" if one.near else "" for one in critical],
        CRITICAL_SPEEDS,
        system,
        order=[one.order for one in critical],
        mode=[float(one.mode) for one in critical],
        speed=[one.speed for one in critical],
        phase_sum=[one.phase_sum for one in critical],
        distance=[one.distance for one in critical],
        M_vibratory=torques,
        tau_vibratory=stresses,
    )


def _stresses(vibration: Vibration) -> list[float | None]:
    """Return the largest vibratory stress of any piece in Pa, (s,); None where no section is known."""
    factors = [stress(vibration.line, piece) for piece in range(len(vibration.line.pieces))]
    if not any(factors):
        return [None] * len(vibration.omegas)
    each = np.array([factor or 0.0 for factor in factors])[:, None] * vibration.vibratory
    return list(each.max(axis=0).tolist())


def pieces_table(found: ShaftVibration, system: str) -> PlaceTable:
    """Return torques and stresses in the pieces at the working speed."""
    values = {name: [getattr(piece, name) for piece in found.pieces] for name in PIECES}
    title = f"Torques and stresses at the working speed, all {'' if found.steady else 'these '}orders together"
    return _table("pieces", title, "piece", [piece.name for piece in found.pieces], PIECES, system, **values)


def speeds_table(found: ShaftVibration, speeds: Sequence[float], system: str) -> PlaceTable:
    """Return the vibratory torque in every piece over the speed."""
    vibration = found.forced(speeds)
    names, torques, stresses = [], [], []
    for piece, of_piece in enumerate(vibration.vibratory):
        factor = stress(found.line, piece)
        names += [found.piece_name(piece)] * len(speeds)
        told = [None if endless else torque for torque, endless in zip(of_piece.tolist(), vibration.endless)]
        torques += told
        stresses += [None if factor is None or torque is None else factor * torque for torque in told]
    title = "Vibratory torque over the speed, all these orders together"
    return _table(
        "speeds",
        title,
        "piece",
        names,
        SPEEDS,
        system,
        speed=list(speeds) * len(found.line.pieces),
        M_vibratory=torques,
        tau_vibratory=stresses,
    )
