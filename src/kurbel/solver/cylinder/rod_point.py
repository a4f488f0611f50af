"""What a state of a cylinder tells of a point of its connecting rod or coupler; None where it names none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kurbel.mechanisms.coupler import PointMotion
    from kurbel.solver.cylinder.state import State


def motion_of_point(state: State) -> PointMotion | None:
    """Return how the point moves."""
    point, mechanism = state.drive.cylinder.point, state.drive.mechanism
    coupler = mechanism.coupler_at(state.angle) if point else None
    if point is None or coupler is None:
        return None
    from kurbel.mechanisms.coupler import point_motion

    return point_motion(mechanism, coupler, state.angle, point.from_crank_pin(mechanism), point.across)


def place_along(state: State) -> Any:
    """Return the place of the point in m from the shaft axis, along φ = 0."""
    return state.point and state.point.x


def place_across(state: State) -> Any:
    """Return its place in m along φ = 90°."""
    return state.point and state.point.y


def speed(state: State) -> Any:
    """Return its speed in m/s."""
    return None if state.point is None or state.omega is None else state.point.speed * state.omega


def acceleration(state: State) -> Any:
    """Return the magnitude of its acceleration in m/s², at uniform rotation."""
    w = state.omega
    return None if state.point is None or w is None else state.point.acceleration * (w * w)
