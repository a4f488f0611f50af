"""An independent check of the forces of one cylinder: Newton's law for each body, without their formulas.

Plane of motion, from the shaft O: real toward the cylinder along the stroke line, imaginary where φ = 90° lies.

          k              k  crank pin, R e^{iφ};  c  crosshead pin, R cos φ + L cos ψ + i e
         ╱ ╲             the rod turns at −ψ̇, its centre of gravity is at a from c
        O ─── c ── P ←   P counts toward the shaft, N from the crosshead onto the guide, toward −i

The crosshead gives F to the rod at c, the rod gives K to the crank pin at k:

    F − K + W = m z̈_G        (k − c) × (−K) + (z_G − c) × (W − m z̈_G) + M = −I ψ̈

Accelerations at a few crank angles are derivatives of these positions. Residuals, of moments divided by their arm, are
relative to the largest force of the cycle.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.solver.cycle import SampledCylinder
from kurbel.solver.drive import Drive
from kurbel.solver.state import State, crank_pin_force, crosshead_pin_force, reduced_inertia

_ANGLES: Array = np.mod(np.arange(1.0, 8.0) * 0.6180339887, 1.0)
"""Angles as fractions of the cycle, by the golden section, so that they avoid dead centres and corners of cards."""


class _Rod(NamedTuple):
    """Mass of a rod in kg, its centre of gravity from the crosshead pin over L, and its moment of inertia in kg m².

    A rod by its share is two masses at its ends; exact: it is none.
    """

    mass: float = 0.0
    centre: float = 0.0
    inertia: float = 0.0
    exact: bool = False


class _Motion(NamedTuple):
    """The arm k − c of the rod, and positions of both pins and ψ, derived by φ; complex, in m."""

    arm: ComplexArray
    pin_speed: ComplexArray
    crosshead_speed: ComplexArray
    turn: Array
    pin: ComplexArray
    crosshead: ComplexArray
    bend: Array


def residual(cylinder: SampledCylinder) -> float | None:
    """Return the residual of Newton's law for one machine, or the tail of the series of the forces if that is larger.

    Both relative to the largest force; None where no force acts, or there is no connecting rod. Left out of master
    rods and link rods, which push on each other.
    """
    drive, mechanism = cylinder.drive, cylinder.drive.mechanism
    if drive.links or drive.cylinder.link_rod is not None:
        return None
    is_slider_crank = mechanism.has_rod and bool(mechanism.slides)
    if not drive.has_force or drive.count is not None or not is_slider_crank:
        return None
    state = State.at(drive, _ANGLES * drive.cycle)
    sizes = []
    for column in ("P", "N", "D", "T", "S"):
        values = cylinder.sampled(column)
        if values is not None:
            sizes.append(np.abs(values).max())
    if not any(sizes):
        return 0.0
    motion = _motion_of(state) if math.isfinite(mechanism.rod_length) else None
    square = float(drive.omega**2) if drive.has_inertia and drive.omega else 0.0
    along, across = drive.weight_of(1.0)
    gravity = complex(-along, -across)  # of 1 kg

    # piston, rod and crosshead, toward the shaft: gas + weight − friction − rod − m z̈
    parts = drive.cylinder.masses.parts if drive.cylinder.masses else 0.0
    applied = (state.P_gas, state.P_ram, state.P_load)
    gas_and_loads = sum(force for force in applied if force is not None)
    side = 0.0 if state.N is None else np.abs(state.N)
    rubs = state.direction * (state.steady_friction + drive.crosshead_friction * side)
    push = state.along_stroke
    moved = -mechanism.crank * state.angle.cos
    if motion:
        push = crosshead_pin_force(state).along
        moved = motion.crosshead.real
    left = [gas_and_loads - gravity.real * parts - rubs - push + parts * moved * square]
    # the shaft: T R less the moments in crank pin and journals less M, over R
    lost = state.rubbing.at_crank + state.rubbing.journals if state.rubbing else 0.0
    left.append(state.tangential_at_pin - (lost + state.M) / mechanism.crank)
    energy = 0.0
    if motion:
        rod = _rod_of(drive)
        left += _of_rod(rod, state, motion, gravity, square)
        energy = _energy(rod, state, motion)
    residuals = [float(np.abs(force).max() / max(sizes)) for force in left]
    return max(cylinder.tail, energy, *residuals)


def _rod_of(drive: Drive) -> _Rod:
    rod = drive.cylinder.masses.connecting_rod if drive.cylinder.masses else None
    if rod is None:
        return _Rod()
    L = drive.mechanism.rod_length
    if rod.exact:
        return _Rod(rod.mass, (rod.center_of_gravity or 0.0) / L, rod.inertia or 0.0, exact=True)
    return _Rod(rod.mass, 1 - rod.share, rod.mass * (1 - rod.share) * rod.share * L * L)


def _motion_of(state: State) -> _Motion:
    """Return the motion of pins and rod, from the positions k = R e^{iφ} and k − c = −L e^{−iψ}."""
    mechanism, sin, cos, (sin_psi, cos_psi) = (
        state.mechanism,
        state.angle.sin,
        state.angle.cos,
        state.rod_angle,
    )
    R, L = mechanism.crank, mechanism.rod_length
    turn = R * cos / (L * cos_psi)
    bend = (turn * turn * sin_psi - R / L * sin) / cos_psi
    k: Any = R * (cos + 1j * sin)
    arm = L * (-cos_psi + 1j * sin_psi)
    return _Motion(
        arm, 1j * k, 1j * (k + turn * arm), turn, -k, -k + (turn * turn + 1j * bend) * arm, bend
    )


def _energy(rod: _Rod, state: State, motion: _Motion) -> float:
    """Return the relative residual of J = 2E/ω² of the moving bodies, with speeds dz/dφ from their positions."""
    masses, R = state.drive.cylinder.masses, state.mechanism.crank
    if masses is None:
        return 0.0
    J = masses.parts * np.abs(motion.crosshead_speed) ** 2 + masses.rotating * R * R
    centre = motion.crosshead_speed * (1 - rod.centre) + motion.pin_speed * rod.centre
    J = J + rod.mass * np.abs(centre) ** 2 + rod.inertia * motion.turn**2
    size = float(np.max(J))
    if not size:
        return 0.0
    return float(np.abs(J - reduced_inertia(state)).max()) / size


def _of_rod(
    rod: _Rod, state: State, motion: _Motion, gravity: complex, square: float
) -> list[Array]:
    """Return the residuals of the forces on the rod, of their moments over L, and of S along it; square: ω² in 1/s²."""
    arm, angle, L = motion.arm, state.angle, state.drive.mechanism.rod_length
    at_crosshead = crosshead_pin_force(state)
    at_pin = crank_pin_force(state)
    F = -at_crosshead.along + 1j * at_crosshead.across
    K = (angle.cos + 1j * angle.sin) * (-at_pin.D + 1j * at_pin.T)

    lower = rod.mass * (1 - rod.centre)  # of the two masses at its ends that of the crosshead pin
    # of a rod by its share the weight of what turns is left out
    weight, weighed_at = (rod.mass * gravity, rod.centre) if rod.exact else (lower * gravity, 0.0)
    pull = rod.mass * (motion.crosshead * (1 - rod.centre) + motion.pin * rod.centre) * square
    forces = ((arm, -K), (arm * weighed_at, weight + 0 * K), (arm * rod.centre, -pull))
    moment = (
        sum((at.conjugate() * force).imag for at, force in forces)
        + rod.inertia * motion.bend * square
    )
    if state.rubbing is not None:
        moment = moment + state.rubbing.at_crank + state.rubbing.at_crosshead

    between, along = F + lower * (gravity - motion.crosshead * square), arm.conjugate() / L
    left = [np.abs(F - K + weight - pull), moment / L, (between * along).real - state.S]
    if state.S_crank is not None:
        left += [(K * along).real - state.S_crank, (F * along).real - state.S_crosshead]
    return left
