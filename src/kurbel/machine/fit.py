"""Which parts of a cylinder fit its mechanism: no piston on what only swings, no crosshead without a connecting rod."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from kurbel.errors import Fault

if TYPE_CHECKING:
    from kurbel.machine import Cylinder

_SLIDING = ("inclination", "masses", "friction", "ram_force")
"""Keys of a cylinder that only something that slides can have, besides those of its pistons."""


def misfits(cylinder: Cylinder) -> Iterator[Fault]:
    """Yield what stands in a cylinder that its mechanism cannot have, and what to do about it."""
    yield from _of_output(cylinder)
    if cylinder.mechanism.slides:
        yield from _of_rod(cylinder)


def _of_output(cylinder: Cylinder) -> Iterator[Fault]:
    kind = cylinder.mechanism.name
    if cylinder.mechanism.slides:
        if cylinder.moment is not None:
            yield Fault(("moment",), f"a {kind} moves its output to and fro; give 'ram_force', a force, instead")
        return
    own = ("bore",) if cylinder.pistons else ()
    for key in (*own, *(key for key in _SLIDING if getattr(cylinder, key) is not None)):
        yield Fault((key,), f"nothing slides in a {kind}; leave '{key}' out{_instead(key)}")
    if cylinder.mechanism.turns and cylinder.moment and cylinder.moment.back:
        yield Fault(
            ("moment", "return"), f"the output of a {kind} turns on and has no return stroke; give 'work' alone"
        )


def _instead(key: str) -> str:
    return {
        "bore": ", with the indicator, or choose a mechanism with a piston",
        "ram_force": "; the resistance of what swings is a 'moment'",
    }.get(key, "")


def _of_rod(cylinder: Cylinder) -> Iterator[Fault]:
    """Friction of a crosshead needs a side force N and a guide for it; the mass of a rod needs a rod."""
    mechanism, masses, friction = cylinder.mechanism, cylinder.masses, cylinder.friction
    if friction is not None and friction.crosshead is not None and not (mechanism.has_rod and mechanism.guided):
        reason = "crosshead guide" if mechanism.has_rod else "connecting rod to press a crosshead on its guide"
        yield Fault(("friction", "crosshead"), f"a {mechanism.name} has no {reason}; leave 'crosshead' out")
    if masses is not None and masses.connecting_rod is not None and not mechanism.has_rod:
        message = f"a {mechanism.name} has no connecting rod; give what goes to and fro as 'other'"
        yield Fault(("masses", "connecting_rod"), message)
    elif (
        masses is not None
        and masses.connecting_rod
        and masses.connecting_rod.exact
        and math.isinf(getattr(mechanism, "rod", math.inf))
    ):
        message = "an infinite rod has no centre of gravity; give its 'share', or the length of the rod"
        yield Fault(("masses", "connecting_rod", "center_of_gravity"), message)
