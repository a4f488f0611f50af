"""Loads of the rods on their crank pins at the angles of crank 1, at any angles or on pieces of the cycle."""

from collections.abc import Sequence

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.numerics.pieces import Pieces
from kurbel.solver.effort import position
from kurbel.solver.forces import CylinderForces
from kurbel.solver.state import State, crank_pin_force
from kurbel.solver.vector import Force


def state_at(forces: CylinderForces, degrees: Array, within: Array) -> State:
    """Return the state of a cylinder at angles (n,) of crank 1, on the sides of jumps that hold `within`."""
    late = position(forces)
    return State.at(forces.drive, degrees - late, within - late)


def pin_load(state: State) -> Force:
    """Return the force of a rod on the crank pin in N, D + iT; 0 where no force acts in the cylinder."""
    if not state.drive.has_force:
        return 0j
    return crank_pin_force(state).complex


def resampled(pieces: Pieces, forces: CylinderForces, *values: Force) -> ComplexArray:
    """Return quantities of a cylinder, sampled on its own pieces, at the nodes of common pieces, (q, nodes, pieces)."""
    source = forces.pieces
    parts = pieces.resampled(real_parts(values, source.degrees.shape), source, position(forces))
    return parts[::2] + 1j * parts[1::2]


def real_parts(loads: Sequence[Force], shape: tuple[int, ...]) -> Array:
    """Return real and imaginary part of every load, (2 q, nodes, pieces)."""
    parts = []
    for load in loads:
        parts.append(np.broadcast_to(np.real(load), shape))
        parts.append(np.broadcast_to(np.imag(load), shape))
    return np.stack(parts)
