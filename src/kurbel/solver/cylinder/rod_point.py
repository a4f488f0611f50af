"""What a state of a cylinder tells of a point of its connecting rod or coupler."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kurbel.mechanisms.coupler import PointMotion
    from kurbel.solver.cylinder.state import State


def _point(state: State) -> PointMotion | None:
    point, mechanism = state.drive.cylinder.point, state.drive.mechanism
    coupler = mechanism.coupler_at(state.angle) if point else None
    if point is None or coupler is None:
        return None
    from kurbel.mechanisms.coupler import point_motion

    return point_motion(mechanism, coupler, state.angle, point.from_crank_pin(mechanism), point.across)


def _speed(state: State) -> Any:
    """Return its speed in m/s."""
    return None if state.point is None or state.omega is None else state.point.speed * state.omega


def _acceleration(state: State) -> Any:
    """Return the magnitude of its acceleration in m/s², at uniform rotation."""
    w = state.omega
    return None if state.point is None or w is None else state.point.acceleration * (w * w)


OF_POINT = {
    "point": _point,
    "x_point": lambda state: state.point and state.point.x,
    "y_point": lambda state: state.point and state.point.y,
    "v_point": _speed,
    "b_point": _acceleration,
}
"""Attribute of `State` -> what finds it; None where the cylinder names no point. x_point, y_point: its place in m from
the shaft axis, along φ = 0 and along φ = 90°."""
