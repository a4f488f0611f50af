"""What a state of a cylinder tells of its chambers beside the pressures; None where it has no such chamber."""

from __future__ import annotations

from functools import reduce
from operator import add
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.numerics.jet import value_of
from kurbel.solver.cylinder.inside import GasLine

if TYPE_CHECKING:
    from kurbel.arrays import Array
    from kurbel.solver.cylinder.state import State


def gas_force(state: State) -> Any:
    """Return the force of gas, steam or water on all pistons in N, R 296."""
    if not state.drive.gas:
        return None
    at_nodes = state.phi.shape != state.inside.degrees.shape
    if at_nodes and all(gas.straight for gas in state.drive.gas):
        return _at_nodes(state)
    line = state.inside.gas_line
    return line.at(state.z) if line else _force(state, state.z, state.phi)


def driving_force(state: State) -> Any:
    """Return the force of gas or steam on the pistons that drive in N; None where none does."""
    forces = [gas.force(state.pressure) for gas in state.drive.driving]
    return reduce(add, forces) if forces else None


def _at_nodes(state: State) -> Any:
    """Return it on pieces on which it is straight over the stroke, and let all others inside these know."""
    ends = np.s_[:, :: state.phi.shape[1] - 1]
    z = value_of(state.z)[ends]
    force = _force(state, z, state.phi[ends])  # at a corner of a card that of the card
    way = np.diff(z)
    # through both ends as they are: over a steep line a rounding of z is many of the force
    rise = np.diff(force) / np.where(way == 0, 1.0, way)
    line = state.inside.gas_line = GasLine(force[:, :1], rise, z[:, :1])
    found = line.at(state.z)
    value_of(found)[ends] = force
    return found


def _force(state: State, z: Any, degrees: Array) -> Any:
    """Return the force in N at shares z of the stroke and crank angles in degrees, by the pressures."""
    return reduce(add, (gas.force(lambda end: end(z, degrees, state.inside.held(end))) for gas in state.drive.gas))


def head_volume(state: State) -> Any:
    """Return the volume of the head-end chamber in m³, with its clearance where that is given."""
    gas = state.drive.own_gas
    return gas.piston.head_area * state.way + gas.clearance_volumes[0] if gas and gas.head else None


def crank_volume(state: State) -> Any:
    """Return the volume of the crank-end chamber in m³, with its clearance where that is given."""
    gas = state.drive.own_gas
    if not (gas and gas.crank):
        return None
    return gas.piston.crank_area * (state.drive.mechanism.stroke - state.way) + gas.clearance_volumes[1]


def head_volume_change(state: State) -> Any:
    """Return the change of the volume of the head-end chamber in m³ per degree."""
    gas = state.drive.own_gas
    return gas.piston.head_area * np.radians(1.0) * state.slope if gas and gas.head else None


def head_rise(state: State) -> Any:
    """Return the rise of the head-end pressure in Pa per degree; None without a trace."""
    return _rise(state, "head")


def crank_rise(state: State) -> Any:
    """Return the rise of the crank-end pressure in Pa per degree; None without a trace."""
    return _rise(state, "crank")


def _rise(state: State, end: str) -> Any:
    rise = getattr(getattr(state.drive.own_gas, end, None), "rise", None)
    return rise(state.phi) if rise else None
