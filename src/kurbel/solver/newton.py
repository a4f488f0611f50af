"""A check of the forces of one cylinder that shares no formula with them: Newton's law for every body.

Plane of motion, from the shaft O: real toward the cylinder along the stroke line, imaginary where φ = 90° lies.

          k              k  crank pin, R e^{iφ};  c  crosshead pin, R cos φ + L cos ψ + i e
         ╱ ╲             the rod turns at −ψ̇, its centre of gravity stands at a from c
        O ─── c ── P ←   P counts toward the shaft, N from the crosshead onto the guide, toward −i

The crosshead gives F to the rod at c, the rod gives K to the crank pin at k:

    F − K + W = m z̈_G        (k − c) × (−K) + (z_G − c) × (W − m z̈_G) + M = −I ψ̈

At a few angles the accelerations follow from these places. What is left open, of moments over their arm, is relative to
the largest force of the cycle.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.solver.cycle import SampledCylinder
from kurbel.solver.drive import Drive
from kurbel.solver.state import State, on_crosshead_pin, on_pin, reduced_inertia

_ANGLES = np.random.default_rng(1927).uniform(0.0, 1.0, 7)
"""Of the cycle."""


def residual(cylinder: SampledCylinder) -> float | None:
    """Return what Newton's law leaves open of the forces, or the tail of their series if that is more, of one machine.

    Both over the largest value of the quantity; None where no force acts, or there is no connecting rod.
    """
    drive = cylinder.drive
    if not drive.has_force or drive.count is not None or not (drive.mechanism.has_rod and drive.mechanism.slides):
        return None
    state = State.at(drive, _ANGLES * drive.cycle)
    sizes = [np.abs(one).max() for one in map(cylinder.sampled, ("P", "N", "D", "T", "S")) if one is not None]
    if not any(sizes):
        return 0.0
    left = [_crosshead(drive, state), _shaft(drive, state)]
    if math.isfinite(drive.mechanism.rod_length):
        left += _rod(drive, state)
    return max(cylinder.tail, _energy(drive, state), *(float(np.abs(one).max() / max(sizes)) for one in left))


def _gravity(drive: Drive) -> complex:
    """Return the weight of 1 kg in N; 0 where weights are left out."""
    along, across = drive.weight_of(1.0)
    return complex(-along, -across)


def _crosshead(drive: Drive, state: State) -> Array:
    """Return what is left of P_gas + weight − friction − rod − m z̈ on piston, rod and crosshead, toward the shaft."""
    masses = drive.cylinder.masses
    parts = masses.parts if masses else 0.0
    along = on_crosshead_pin(state).D if math.isfinite(drive.mechanism.rod_length) else state.along_rod
    given = sum(one for one in (state.P_gas, state.P_ram) if one is not None)
    side = 0.0 if state.N is None else np.abs(state.N)
    rubs = state.direction * (drive.steady_friction + drive.crosshead_friction * side)
    inertia = parts * _Motion.of(drive, state).crosshead.real
    return np.asarray(given - _gravity(drive).real * parts - rubs - along + inertia)


def _shaft(drive: Drive, state: State) -> Array:
    """Return what is left of T R less the moments in crank pin and journals less M, over R."""
    rubbing, R = state.rubbing, drive.mechanism.crank
    lost = 0.0 if rubbing is None else rubbing.at_crank + rubbing.journals
    return np.asarray((state.T * R - lost - state.M) / R)


def _energy(drive: Drive, state: State) -> float:
    """Return what is left of J less 2E/ω² of the moving bodies, over J: their speeds are dz/dφ of their places."""
    masses, mechanism, angle = drive.cylinder.masses, drive.mechanism, state.angle
    if masses is None or not math.isfinite(mechanism.rod_length):
        return 0.0
    R, L, rod = mechanism.crank, mechanism.rod_length, masses.connecting_rod
    sin_psi, cos_psi = state.rod_angle
    turn = R * angle.cos / (L * cos_psi)
    pin = R * (-angle.sin + 1j * angle.cos)
    crosshead = pin.real - L * sin_psi * turn
    J = masses.parts * crosshead**2 + masses.rotating * R * R
    if rod is not None and rod.exact:
        share = (rod.center_of_gravity or 0.0) / L
        J = J + rod.mass * np.abs(crosshead * (1 - share) + pin * share) ** 2 + (rod.inertia or 0.0) * turn**2
    elif rod is not None:
        J = J + rod.mass * (rod.share * crosshead**2 + (1 - rod.share) * R * R)
    size = float(np.max(J))
    return float(np.abs(J - reduced_inertia(state)).max()) / size if size else 0.0


class _Motion(NamedTuple):
    """Accelerations of both pins, complex, in m/s², and dψ²/dt² in rad/s²; all 0 without masses or speed."""

    crosshead: ComplexArray
    pin: ComplexArray
    rod: Array

    @classmethod
    def of(cls, drive: Drive, state: State) -> _Motion:
        """Return them from the places of the pins."""
        mechanism, angle = drive.mechanism, state.angle
        R, L = mechanism.crank, mechanism.rod_length
        square = drive.omega**2 if drive.has_inertia and drive.omega else 0.0
        pin = -R * (angle.cos + 1j * angle.sin)
        if not math.isfinite(L):
            return cls(pin.real * square + 0j, pin * square, np.zeros_like(angle.sin))
        sin_psi, cos_psi = state.rod_angle
        turn = R * angle.cos / (L * cos_psi)
        bend = (turn * turn * sin_psi - R / L * angle.sin) / cos_psi
        crosshead = pin.real - L * (cos_psi * turn * turn + sin_psi * bend)
        return cls(crosshead * square + 0j, pin * square, bend * square)


def _rod(drive: Drive, state: State) -> list[Array]:
    """Return what is left of the forces on the rod, of their moments over L, and of S along it."""
    masses, angle, L = drive.cylinder.masses, state.angle, drive.mechanism.rod_length
    rod = masses.connecting_rod if masses else None
    sin_psi, cos_psi = state.rod_angle
    arm = L * (-cos_psi + 1j * sin_psi)  # from c to k
    at_crosshead, at_pin = on_crosshead_pin(state), on_pin(state)
    F = -at_crosshead.D + 1j * at_crosshead.T
    K = (angle.cos + 1j * angle.sin) * (-at_pin.D + 1j * at_pin.T)
    motion, gravity = _Motion.of(drive, state), _gravity(drive)
    mass = rod.mass if rod else 0.0
    share = (rod.center_of_gravity or 0.0) / L if rod and rod.exact else 1 - rod.share if rod else 0.0
    inertia = rod.inertia or 0.0 if rod and rod.exact else mass * share * (1 - share) * L * L
    # of a rod by its share the weight of what turns is left out
    weight, weighed_at = (mass * gravity, share) if rod and rod.exact else (mass * (1 - share) * gravity, 0.0)
    pull = mass * (motion.crosshead * (1 - share) + motion.pin * share)
    moment = (
        _cross(arm, -K) + _cross(arm * weighed_at, weight + 0 * K) - _cross(arm * share, pull) + inertia * motion.rod
    )
    if state.rubbing is not None:
        moment = moment + state.rubbing.at_crank + state.rubbing.at_crosshead
    lower = mass * (1 - share)  # of the two masses at its ends that of the crosshead pin
    between = F + lower * (gravity - motion.crosshead)
    along = arm.conjugate() / L
    left = [np.abs(F - K + weight - pull), moment / L, (between * along).real - state.S]
    if state.S_crank is not None:
        left += [(K * along).real - state.S_crank, (F * along).real - state.S_crosshead]
    return left


def _cross(one: ComplexArray, other: ComplexArray) -> Array:
    return np.asarray((one.conjugate() * other).imag)
