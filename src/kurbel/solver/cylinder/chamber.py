"""What a state of a cylinder tells of its chambers beside the pressure: volumes, and the rise of pressure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from kurbel.solver.cylinder.state import State


def _head_volume(state: State) -> Any:
    """Return the volume of the head-end chamber in m³, with its clearance where that is given."""
    gas = state.drive.own_gas
    return gas.piston.head_area * state.way + gas.clearance_volumes[0] if gas and gas.head else None


def _crank_volume(state: State) -> Any:
    """Return the volume of the crank-end chamber in m³, with its clearance where that is given."""
    gas = state.drive.own_gas
    if not (gas and gas.crank):
        return None
    return gas.piston.crank_area * (state.drive.mechanism.stroke - state.way) + gas.clearance_volumes[1]


def _volume_change(state: State) -> Any:
    """Return the change of the volume of the head-end chamber in m³ per degree."""
    gas = state.drive.own_gas
    return gas.piston.head_area * np.radians(1.0) * state.slope if gas and gas.head else None


def _rise(state: State, end: str) -> Any:
    """Return the rise of the pressure at an end in Pa per degree; None without a trace."""
    rise = getattr(getattr(state.drive.own_gas, end, None), "rise", None)
    return rise(state.phi) if rise else None


OF_CHAMBERS = {
    "V": _head_volume,
    "V_crank": _crank_volume,
    "dV": _volume_change,
    "dp_head": lambda state: _rise(state, "head"),
    "dp_crank": lambda state: _rise(state, "crank"),
}
"""Attribute of `State` -> what finds it; None where the cylinder has no such chamber."""
