"""Which parts of a cylinder fit its mechanism: no piston on what only swings, no crosshead without a connecting rod."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from kurbel.crank_angle import CrankAngle
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault

if TYPE_CHECKING:
    from kurbel.machine import Cylinder
    from kurbel.machine.masses import ConnectingRod
    from kurbel.mechanisms import Mechanism

_SLIDING = ("inclination", "masses", "friction", "ram_force")
"""Keys of a cylinder that only something that slides can have, besides those of its pistons."""


def misfits(cylinder: Cylinder) -> Iterator[Fault]:
    """Yield what stands in a cylinder that its mechanism cannot have, and what to do about it."""
    yield from _of_output(cylinder)
    if cylinder.mechanism.slides:
        yield from _of_rod(cylinder)


def may_lock(cylinder: Cylinder) -> bool:
    """Return whether the friction of the crosshead is great enough to lock it where it is driven: f tan ψ ≥ 1."""
    coefficient = cylinder.friction.crosshead if cylinder.friction else None
    widest = [rod for centre in (90.0, 270.0) if (rod := cylinder.mechanism.rod_angle(CrankAngle.of(centre)))]
    return bool(coefficient) and any(coefficient * abs(sin_psi) >= cos_psi for sin_psi, cos_psi in widest)


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
    elif masses is not None and masses.connecting_rod and (message := _off_rod(masses.connecting_rod, mechanism)):
        yield Fault(("masses", "connecting_rod", "center_of_gravity"), message)


def _off_rod(rod: ConnectingRod, mechanism: Mechanism) -> str:
    """Return what is wrong with the place of the centre of gravity of a rod, or an empty text."""
    if rod.center_of_gravity is None:
        return ""
    if math.isinf(mechanism.rod_length):
        return "an infinite rod has no centre of gravity; give its 'share', or the length of the rod"
    # a rod that reaches beyond a pin may have it there in theory; a slip of the unit is far more likely
    if rod.center_of_gravity > mechanism.rod_length:
        place, length = show(rod.center_of_gravity, "length"), show(mechanism.rod_length, "length")
        return f"{place} from the crosshead pin is beyond the crank pin: the rod is {length} long"
    return ""
