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
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.solver.cycle import SampledCylinder
from kurbel.solver.drive import Drive
from kurbel.solver.state import State, on_crosshead_pin, on_pin, reduced_inertia

_ANGLES: Array = np.mod(np.arange(1.0, 8.0) * 0.6180339887, 1.0)
"""Angles as fractions of the cycle, by the golden section, so that they avoid dead centres and corners of cards."""


class _Places(NamedTuple):
    """Positions of both pins and ψ, derived by φ, complex, in m; and ω² in 1/s², 0 without masses or speed."""

    crosshead_speed: ComplexArray
    pin_speed: ComplexArray
    turn: Array
    crosshead: ComplexArray
    pin: ComplexArray
    bend: Array
    square: float


def residual(cylinder: SampledCylinder) -> float | None:
    """Return the residual of Newton's law for one machine, or the tail of the series of the forces if that is larger.

    Both relative to the largest force; None where no force acts, or there is no connecting rod.
    """
    drive = cylinder.drive
    if not drive.has_force or drive.count is not None or not (drive.mechanism.has_rod and drive.mechanism.slides):
        return None
    state = State.at(drive, _ANGLES * drive.cycle)
    sizes = [np.abs(one).max() for one in map(cylinder.sampled, ("P", "N", "D", "T", "S")) if one is not None]
    if not any(sizes):
        return 0.0
    places, rigid = _places(state), math.isfinite(drive.mechanism.rod_length)
    along, across = drive.weight_of(1.0)
    gravity = complex(-along, -across)  # of 1 kg

    # piston, rod and crosshead, toward the shaft: gas + weight − friction − rod − m z̈
    masses, R = drive.cylinder.masses, drive.mechanism.crank
    parts = masses.parts if masses else 0.0
    given = sum(one for one in (state.P_gas, state.P_ram) if one is not None)
    side = 0.0 if state.N is None else np.abs(state.N)
    rubs = state.direction * (state.steady_friction + drive.crosshead_friction * side)
    push = on_crosshead_pin(state).D if rigid else state.along_rod
    left = [given - gravity.real * parts - rubs - push + parts * places.crosshead.real * places.square]
    # the shaft: T R less the moments in crank pin and journals less M, over R
    lost = state.rubbing.at_crank + state.rubbing.journals if state.rubbing else 0.0
    left.append((state.T * R - lost - state.M) / R)
    if rigid:
        left += _rod(drive, state, places, gravity)
    energy = _energy(drive, state, places) if masses and rigid else 0.0
    return max(cylinder.tail, energy, *(float(np.abs(one).max() / max(sizes)) for one in left))


def _places(state: State) -> _Places:
    """Return the motion of pins and rod, from the positions of the pins."""
    drive, angle = state.drive, state.angle
    R, L = drive.mechanism.crank, drive.mechanism.rod_length
    square = float(drive.omega**2) if drive.has_inertia and drive.omega else 0.0
    sin, cos = np.asarray(angle.sin), np.asarray(angle.cos)
    pin_speed, pin = R * (-sin + 1j * cos), -R * (cos + 1j * sin)
    if not math.isfinite(L):
        still = np.zeros_like(sin)
        return _Places(pin_speed.real.astype(complex), pin_speed, still, pin.real.astype(complex), pin, still, square)
    sin_psi, cos_psi = state.rod_angle
    turn = R * cos / (L * cos_psi)
    bend = (turn * turn * sin_psi - R / L * sin) / cos_psi
    crosshead = pin.real - L * (cos_psi * turn * turn + sin_psi * bend)
    return _Places(pin_speed.real - L * sin_psi * turn + 0j, pin_speed, turn, crosshead + 0j, pin, bend, square)


def _energy(drive: Drive, state: State, places: _Places) -> float:
    """Return the relative residual of J = 2E/ω² of the moving bodies, with speeds dz/dφ from their positions."""
    masses, R, L = drive.cylinder.masses, drive.mechanism.crank, drive.mechanism.rod_length
    assert masses is not None
    rod, crosshead = masses.connecting_rod, places.crosshead_speed
    J = masses.parts * crosshead.real**2 + masses.rotating * R * R
    if rod is not None and rod.exact:
        share = (rod.center_of_gravity or 0.0) / L
        J = J + rod.mass * np.abs(crosshead * (1 - share) + places.pin_speed * share) ** 2
        J = J + (rod.inertia or 0.0) * places.turn**2
    elif rod is not None:
        J = J + rod.mass * (rod.share * crosshead.real**2 + (1 - rod.share) * R * R)
    size = float(np.max(J))
    return float(np.abs(J - reduced_inertia(state)).max()) / size if size else 0.0


def _rod(drive: Drive, state: State, places: _Places, gravity: complex) -> list[Array]:
    """Return the residuals of the forces on the rod, of their moments over L, and of S along it."""
    masses, angle, L = drive.cylinder.masses, state.angle, drive.mechanism.rod_length
    rod = masses.connecting_rod if masses else None
    sin_psi, cos_psi = state.rod_angle
    arm = L * (-cos_psi + 1j * sin_psi)  # from c to k
    at_crosshead, at_pin = on_crosshead_pin(state), on_pin(state)
    F = -at_crosshead.D + 1j * at_crosshead.T
    K = (angle.cos + 1j * angle.sin) * (-at_pin.D + 1j * at_pin.T)

    exact, mass = bool(rod and rod.exact), rod.mass if rod else 0.0
    share = (rod.center_of_gravity or 0.0) / L if rod and exact else 1 - rod.share if rod else 0.0
    inertia = rod.inertia or 0.0 if rod and exact else mass * share * (1 - share) * L * L
    # of a rod by its share the weight of what turns is left out
    weight, weighed_at = (mass * gravity, share) if exact else (mass * (1 - share) * gravity, 0.0)
    pull = mass * (places.crosshead * (1 - share) + places.pin * share) * places.square
    forces = ((arm, -K), (arm * weighed_at, weight + 0 * K), (arm * share, -pull))
    moment = sum((at.conjugate() * force).imag for at, force in forces) + inertia * places.bend * places.square
    if state.rubbing is not None:
        moment = moment + state.rubbing.at_crank + state.rubbing.at_crosshead

    lower = mass * (1 - share)  # of the two masses at its ends that of the crosshead pin
    between = F + lower * (gravity - places.crosshead * places.square)
    along = arm.conjugate() / L
    left = [np.abs(F - K + weight - pull), moment / L, (between * along).real - state.S]
    if state.S_crank is not None:
        left += [(K * along).real - state.S_crank, (F * along).real - state.S_crosshead]
    return left
