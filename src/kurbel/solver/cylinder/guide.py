"""The crosshead on its guide, in a state of a cylinder: what presses it there, rubs it, and wears it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.errors import NoSolutionError
from kurbel.numerics.cycles import Unlike
from kurbel.numerics.jet import value_of

if TYPE_CHECKING:
    from kurbel.solver.cylinder.drive import Drive
    from kurbel.solver.cylinder.state import State


def _guide_load(state: State) -> Any:
    """Return what rests on the guide beside the push of the rod in N: weight less the couples on the rod."""
    weight = state.drive.guide_weight
    return weight if state.rod_side is None else weight - state.rod_side


def guide_sense(state: State) -> Any:
    """Return the force whose sign is that of N: P sin ψ + G cos ψ with the load G on the guide, in N."""
    sin_psi, cos_psi = state.rod_angle or (0.0, 1.0)
    return state.after_steady_friction * sin_psi + cos_psi * _guide_load(state)


def guide_force(state: State) -> Any:
    """Return the force on the guide in N, D 3 with signs: N = (P sin ψ + G cos ψ)/(cos ψ + f sin ψ sgn c sgn N).

    With f = 0 and no weight this is R 301, N = P tan ψ. Raises NoSolutionError where the crosshead locks itself.
    """
    drive = state.drive
    if state.P is None:
        return None
    if state.rod_angle is None:
        alone = drive.weight if drive.mechanism.known_across else None
        return alone and np.full_like(state.phi, alone[1])
    sin_psi, cos_psi = state.rod_angle
    if not drive.rubs:
        return state.after_steady_friction * (sin_psi / cos_psi) + _guide_load(state)
    below = cos_psi + sin_psi * (state.inside.guide_side(state) * state.direction * drive.crosshead_friction)
    locked = value_of(below) <= 0
    if not locked.any():
        return state.guide_sense / below
    if drive.variant is not None:
        raise Unlike(np.broadcast_to(drive.variant, locked.shape)[locked])
    raise NoSolutionError(_locks(drive, float(state.phi[locked][0])))


def _locks(drive: Drive, degrees: float) -> str:
    f = drive.crosshead_friction
    bound = 1 / np.sqrt(1 + f * f)
    return (
        f"{drive.name}: the crosshead locks itself near φ = {degrees % 360:.4g}°, where the machine is driven "
        f"and f tan ψ ≥ 1 (f = {f:g}); a driven machine needs (R + |e|)/L < 1/√(1 + f²) = {bound:.6g}"
    )


def crosshead_drag(state: State) -> Any:
    """Return the crosshead friction f |N| in N, against the motion."""
    drive = state.drive
    return state.N * (state.inside.guide_side(state) * drive.crosshead_friction) if drive.rubs else 0.0


def shoe_pressure(state: State) -> Any:
    """Return |N| over the area of the shoe in Pa; None where its size is not given."""
    area = state.drive.guide_area
    return None if area is None or state.N is None else abs(state.N) / area


def wear(state: State) -> Any:
    """Return f |N| |c| in W, the wear line of the guide (D); None without a shoe or a speed."""
    return None if state.p_guide is None or state.c is None else state.crosshead_drag * state.c * state.direction


def crosshead_power(state: State) -> Any:
    """Return crosshead friction times way by crank angle in J per radian, positive."""
    return state.crosshead_drag * (state.slope * state.direction)
