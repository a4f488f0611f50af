"""Columns and key values that several mechanisms have: of a swinging member, a block on the crank pin, a coupler."""

from typing import Any

from kurbel.crank_angle import CrankAngle
from kurbel.declared.record import field
from kurbel.mechanisms import KeyOffer, Offer, own_force, own_motion
from kurbel.numerics.extreme import Extreme
from kurbel.quantity import Quantity

_BOTH, _MEMBER = ("motion", "forces"), "of the swinging member"


def _slides(results: Any) -> bool:
    """Return whether x gives the position of what slides, in forces."""
    return results.command == "forces" and bool(results.mechanism.slides)


def _swing(id: str, symbol: str, kind: str, text: str, called: str = "") -> Quantity:
    searched = ("motion",) if called else ()
    return Quantity(id, symbol, kind, f"{text} {_MEMBER}", "", _BOTH, searched, called, after="b")


SWING_OFFERS = (
    Offer(_swing("theta", "θ", "angle", "Angle"), lambda one, angle: one.swing_at(angle).degrees, unless=_slides),
    Offer(
        _swing("theta_dot", "θ̇", "angular_velocity", "Angular velocity", "angular velocity of the swing"),
        lambda one, angle: one.swing_at(angle).slope,
        omega=1,
        unless=_slides,
    ),
    Offer(
        _swing("theta_ddot", "θ̈", "angular_acceleration", "Angular acceleration", "angular acceleration"),
        lambda one, angle: one.swing_at(angle).curvature,
        omega=2,
        unless=_slides,
    ),
)
"""Of a mechanism with `swing_at`, which returns how its swinging member turns."""


def _ends(mechanism: Any) -> list[Extreme]:
    """θ in degrees at the dead centres; where the member turns fully, none."""
    centres = mechanism.dead_centres() if mechanism.swing is not None else ()
    return [Extreme(float(mechanism.swing_at(CrankAngle.of(end)).degrees), end % 360.0) for end in centres]


SWING_VALUES = (
    KeyOffer(
        Quantity("swing", "θ_s", "angle", "Angle through which the member swings", "", _BOTH, after="stroke"),
        lambda one, _: one.swing,
    ),
    KeyOffer(
        Quantity("theta_min", "θ_min", "angle", f"Smallest angle {_MEMBER}", "", _BOTH, after="stroke"),
        lambda one, _: min(_ends(one), default=None),
    ),
    KeyOffer(
        Quantity("theta_max", "θ_max", "angle", f"Largest angle {_MEMBER}", "", _BOTH, after="stroke"),
        lambda one, _: max(_ends(one), default=None),
    ),
)
"""Of a mechanism with `swing_at`, and a `swing` in degrees, None where the member turns fully."""

F_COUPLER = Offer(
    own_force(
        "F_coupler",
        "F_K",
        "force",
        "Force in the coupler, thrust positive",
        called="force in the coupler",
        after="M_out",
    ),
    lambda one, angle: one.coupler_force_factor(angle),
    force=lambda state: state.M_out,
)
"""Of a mechanism with `coupler_force_factor`, the force in 1/m over the moment on the swinging member."""


def pin_diameter() -> Any:
    """Return the field of the diameter of the crank pin."""
    text = "Diameter of the crank pin; needs `pin_length`"
    return field("length", text, "d_z", above=0, absent="no pin pressure", needs="pin_length")


def pin_length() -> Any:
    """Return the field of the length of the crank pin."""
    text = "Length of the crank pin in its block; needs `pin_diameter`"
    return field("length", text, "l_z", above=0, absent="same", needs="pin_diameter")


NO_PIN = ("pin pressure", "no pin_diameter and pin_length given")
"""What a mechanism with a block lacks without its pin, and why."""


BLOCK_OFFERS = (
    Offer(
        own_motion("c_block", "c_b", "velocity", "Speed at which the block on the crank pin slides along its slot"),
        lambda one, angle: one.block_slope(angle),
        omega=1,
    ),
    Offer(
        own_force(
            "F_pin",
            "F_z",
            "force",
            "Force of the sliding block on the crank pin, in the sense of P",
            called="force of the sliding block on the crank pin",
        ),
        lambda one, angle: one.pin_force_factor(angle),
        force=lambda state: state.along_rod,
    ),
)
"""Of a mechanism with `block_slope`, the speed of the block over ω in m, and `pin_force_factor`, its force over P."""


def pin_pressure(bound: float | None = None) -> KeyOffer:
    """Return the pressure between pin and block; bound: in Pa, up to which the sources let such a pin go."""

    def largest(mechanism: Any, forces: Any) -> Extreme | None:
        found = None if mechanism.pin_diameter is None else forces.extremes_of("F_pin")
        if not found:
            return None
        return Extreme(found.peak.value / (mechanism.pin_diameter * mechanism.pin_length), found.peak.degrees)

    text = "Largest pressure of the sliding block on the crank pin"
    return KeyOffer(Quantity("pin_pressure", "p_z", "pressure", text, "", ("forces",), after="T_min"), largest, bound)
