"""The crank pin of a mechanism whose block slides in a slot: its size, for the pressure between pin and block."""

from __future__ import annotations

from kurbel.declared.forms import Physical
from kurbel.declared.keys import Key, Keys, check
from kurbel.errors import Fault, RuleError

PIN_KEYS: Keys = {
    "pin_diameter": Key(
        Physical("length", above=0),
        "Diameter of the crank pin; needs `pin_length`",
        "d_z",
        absent="no pin pressure",
        needs="pin_length",
    ),
    "pin_length": Key(
        Physical("length", above=0),
        "Length of the crank pin in its block; needs `pin_diameter`",
        "l_z",
        absent="same",
        needs="pin_diameter",
    ),
}


NO_PIN = ("pin pressure", "no pin_diameter and pin_length given")
"""What such a mechanism lacks without its pin, and why."""


def projected_area(diameter: float | None, length: float | None) -> float | None:
    """Return d_z l_z in m², or None where the pin is not given.

    Raises RuleError where only one of both is given, or one is not positive and finite.
    """
    check(PIN_KEYS, {"pin_diameter": diameter, "pin_length": length})
    if diameter is None or length is None:
        return None
    for name, value in (("pin_diameter", diameter), ("pin_length", length)):
        if not 0 < value < float("inf"):
            raise RuleError(Fault((name,), "must be a positive, finite length"))
    return diameter * length
