"""The swinging member of a mechanism: what a lever, a rocker or a second crank, and its coupler, offer."""

from collections.abc import Callable
from typing import Any, NamedTuple

from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms import KeyOffer, Offer, own_force
from kurbel.numerics.extreme import Extreme
from kurbel.quantity import Quantity


class Swing(NamedTuple):
    """The swinging member at a crank angle: θ in degrees, dθ/dφ and d²θ/dφ² (radian per radian), each as the angle."""

    degrees: Any
    slope: Any
    curvature: Any


_BOTH = ("motion", "forces")
_OF = "of the swinging member"


def _column(id: str, symbol: str, kind: str, text: str, called: str = "") -> Quantity:
    searched = ("motion",) if called else ()
    return Quantity(id, symbol, kind, text, "", _BOTH, searched, called, after="b")


def turning_offers(
    turning: Callable[[Any, CrankAngle], Any],
    angle: Quantity,
    velocity: Quantity,
    acceleration: Quantity,
    unless: Callable[[Any], bool] | None = None,
) -> tuple[Offer, ...]:
    """Return how a member turns; turning: takes a mechanism and a crank angle and returns angle and derivatives."""
    return (
        Offer(angle, lambda one, at: turning(one, at).degrees, unless=unless),
        Offer(velocity, lambda one, at: turning(one, at).slope, omega=1, unless=unless),
        Offer(acceleration, lambda one, at: turning(one, at).curvature, omega=2, unless=unless),
    )


def _slides(results: Any) -> bool:
    """Return whether x gives the position of what slides, in forces."""
    return results.command == "forces" and bool(results.mechanism.slides)


SWING_OFFERS = turning_offers(
    lambda one, at: one.swing_at(at),
    _column("theta", "θ", "angle", f"Angle {_OF}"),
    _column("theta_dot", "θ̇", "angular_velocity", f"Angular velocity {_OF}", "angular velocity of the swing"),
    _column("theta_ddot", "θ̈", "angular_acceleration", f"Angular acceleration {_OF}", "angular acceleration"),
    _slides,
)


def _ends(mechanism: Any) -> list[Extreme]:
    """θ in degrees at the dead centres; where the member turns fully, none."""
    centres = mechanism.dead_centres() if mechanism.swing is not None else ()
    return [Extreme(float(mechanism.swing_at(CrankAngle.of(end)).degrees), end % 360.0) for end in centres]


def _value(id: str, symbol: str, text: str, value: Callable[[Any], Any]) -> KeyOffer:
    return KeyOffer(Quantity(id, symbol, "angle", text, "", _BOTH, after="stroke"), lambda one, _: value(one))


SWING_VALUES = (
    _value("swing", "θ_s", "Angle through which the member swings", lambda one: one.swing),
    _value("theta_min", "θ_min", f"Smallest angle {_OF}", lambda one: min(_ends(one), default=None)),
    _value("theta_max", "θ_max", f"Largest angle {_OF}", lambda one: max(_ends(one), default=None)),
)
"""Of a mechanism with `swing_at`, and a `swing` in degrees, None where the member turns fully."""

_CALLED = "force in the coupler"
F_COUPLER = Offer(
    own_force("F_coupler", "F_K", "force", f"{_CALLED.capitalize()}, thrust positive", called=_CALLED, after="M_out"),
    lambda one, angle: one.coupler_force_factor(angle),
    force=lambda state: state.M_out,
)
"""Of a mechanism with `coupler_force_factor`, the force in 1/m over the moment on the swinging member."""
