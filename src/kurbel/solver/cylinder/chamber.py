"""What a state of a cylinder tells of its chambers beside the pressure; None where it has no such chamber."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from kurbel.solver.cylinder.state import State


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
