"""The crank pin of a mechanism whose block slides in a slot: speed of the block, force and pressure on the pin."""

from typing import Any

from kurbel.crank_angle import CrankAngle
from kurbel.declared.quantity import Quantity
from kurbel.declared.record import field
from kurbel.mechanisms import KeyOffer, Offer, own_force, own_motion
from kurbel.numerics.arithmetic import where
from kurbel.numerics.extreme import Extreme


def pin_diameter() -> Any:
    """Return the field of the diameter of the crank pin."""
    text = "Diameter of the crank pin; needs `pin_length`"
    return field("length", text, "d_z", above=0, absent="no pin pressure", needs="pin_length")


def pin_length() -> Any:
    """Return the field of the length of the crank pin."""
    text = "Length of the crank pin in its block; needs `pin_diameter`"
    return field("length", text, "l_z", above=0, absent="same", needs="pin_diameter")


NO_PIN = ("pin pressure", "no pin_diameter and pin_length given")
"""What such a mechanism lacks without its pin, and why."""


_SPEED = "Speed at which the block on the crank pin slides along its slot"
_FORCE = "force of the sliding block on the crank pin"
BLOCK_OFFERS = (
    Offer(own_motion("c_block", "c_b", "velocity", _SPEED), lambda one, angle: one.block_slope(angle), ("omega",)),
    Offer(
        own_force("F_pin", "F_z", "force", f"{_FORCE.capitalize()}, in the sense of P", called=_FORCE),
        lambda one, angle: one.pin_force_factor(angle),
        ("along_rod",),
    ),
)
"""Of a mechanism with `block_slope`, the speed of the block over ω in m, and `pin_force_factor`, its force over P."""


def _pressure(mechanism: Any, forces: Any) -> Extreme | None:
    """Return the largest force on the pin over d_z l_z."""
    found = None if mechanism.pin_diameter is None else forces.extremes_of("F_pin")
    if not found:
        return None
    return Extreme(found.peak.value / (mechanism.pin_diameter * mechanism.pin_length), found.peak.degrees)


def pin_pressure(bound: float | None = None) -> KeyOffer:
    """Return the pressure between pin and block; bound: in Pa, up to which the sources let such a pin go."""
    text = "Largest pressure of the sliding block on the crank pin"
    quantity = Quantity("pin_pressure", "p_z", "pressure", text, commands=("forces",), after="T_min")
    return KeyOffer(quantity, _pressure, bound)


def sum_along(base: float, arm: float, gap: float, angle: CrankAngle) -> Any:
    """Return base + arm cos φ; where that is a difference, from gap = base − arm, as they were given."""
    return where(angle.cos >= -0.5, base + arm * angle.cos, gap + arm * angle.vercosine)
