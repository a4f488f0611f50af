"""The crank pin of a mechanism whose block slides in a slot: speed of the block, force and pressure on the pin."""

from typing import Any

from kurbel.crank_angle import CrankAngle
from kurbel.declared.forms import positive
from kurbel.declared.keys import Keys, check
from kurbel.mechanisms import KeyOffer, Offer, check_lengths, own_force, own_motion
from kurbel.numerics.arithmetic import where
from kurbel.numerics.extreme import Extreme
from kurbel.quantity import Quantity

PIN_KEYS: Keys = {
    "pin_diameter": positive(
        "length", "Diameter of the crank pin; needs `pin_length`", "d_z", absent="no pin pressure", needs="pin_length"
    ),
    "pin_length": positive(
        "length",
        "Length of the crank pin in its block; needs `pin_diameter`",
        "l_z",
        absent="same",
        needs="pin_diameter",
    ),
}


NO_PIN = ("pin pressure", "no pin_diameter and pin_length given")
"""What such a mechanism lacks without its pin, and why."""


def check_pin(diameter: float | None, length: float | None) -> None:
    """Raise RuleError where only one of both is given, or one is not positive and finite."""
    check(PIN_KEYS, {"pin_diameter": diameter, "pin_length": length})
    check_lengths(pin_diameter=diameter, pin_length=length)


_SPEED = "Speed at which the block on the crank pin slides along its slot"
_FORCE = "force of the sliding block on the crank pin"
BLOCK_OFFERS = (
    Offer(own_motion("c_block", "c_b", "velocity", _SPEED), lambda one, angle: one.block_slope(angle), omega=1),
    Offer(
        own_force("F_pin", "F_z", "force", f"{_FORCE.capitalize()}, in the sense of P", called=_FORCE),
        lambda one, angle: one.pin_force_factor(angle),
        force=lambda state: state.along_rod,
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
