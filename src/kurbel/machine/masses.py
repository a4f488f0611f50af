"""Masses of the moving parts."""

import math
from dataclasses import dataclass
from typing import ClassVar

from kurbel.declared.forms import Listing, Number, OneOf, Physical, Record, not_negative
from kurbel.declared.keys import Described, Form, Key, Keys, check
from kurbel.errors import refused
from kurbel.numerics.arithmetic import total

_ONE_OR_MORE: Form = OneOf(Physical("mass", least=0), Listing(Physical("mass", least=0)))


def _part(text: str) -> Key:
    return Key(_ONE_OR_MORE, text, instead="reciprocating")


@dataclass(frozen=True, eq=False, repr=False)
class ConnectingRod(Described):
    """The connecting rod's mass in kg and how it moves.

    share: the part of it that counts as reciprocating; or, exactly, center_of_gravity: its distance
    in m from the crosshead pin, with inertia: moment of inertia in kg m² about the centre of gravity.
    """

    mass: float
    share: float = 0.5
    center_of_gravity: float | None = None
    inertia: float | None = None

    KEYS: ClassVar[Keys] = {
        "mass": not_negative("mass", "Mass of the rod", required=True),
        "share": Key(Number(least=0, most=1), "Reciprocating share of the mass", absent="1/2"),
        "center_of_gravity": not_negative(
            "length", "Distance of its centre of gravity from the crosshead pin", "a", instead="share", needs="inertia"
        ),
        "inertia": not_negative(
            "inertia", "Moment of inertia about the centre of gravity", "I_r", needs="center_of_gravity"
        ),
    }

    def __post_init__(self) -> None:
        # its default stands beside a centre of gravity, and is then not used
        check(self.KEYS, {**vars(self), "share": None if self.exact else self.share})

    @property
    def exact(self) -> bool:
        """Whether the rod is described by centre of gravity and moment of inertia."""
        return self.center_of_gravity is not None

    def at_crosshead(self, length: float) -> float:
        """Mass in kg that goes to and fro: the share, or m (1 − a/L) with the length L of the rod in m."""
        if self.center_of_gravity is None:
            return self.mass * self.share
        return self.mass * (1 - self.center_of_gravity / length)

    def at_pin(self, length: float) -> float:
        """Mass in kg that turns with the crank pin: what the share leaves, or m a/L with the length L in m."""
        if self.center_of_gravity is None:
            return self.mass * (1 - self.share)
        return self.mass * self.center_of_gravity / length

    def excess_inertia(self, length: float) -> float:
        """I_r − m a (L − a) in kg m²: what the two masses have too little of; for an exact rod of length L in m.

        >>> round(ConnectingRod(2.0, center_of_gravity=0.1, inertia=0.0242).excess_inertia(0.25) * 23000, 1)
        -133.4
        """
        assert self.center_of_gravity is not None
        assert self.inertia is not None
        return self.inertia - self.mass * self.center_of_gravity * (length - self.center_of_gravity)


@dataclass(frozen=True, eq=False, repr=False)
class Masses(Described):
    """Moving masses in kg: the sum of piston, piston rod, crosshead and others, the connecting rod, and what turns.

    rotating: at the radius of the crank pin, beside what of the connecting rod turns with it; crosshead: what of the
    sum is the crosshead's, None where that is not known; undivided: the sum was given as one and has the connecting
    rod's share in it.
    """

    parts: float
    connecting_rod: ConnectingRod | None = None
    rotating: float = 0.0
    crosshead: float | None = None
    undivided: bool = False

    KEYS: ClassVar[Keys] = {
        "reciprocating": not_negative(
            "mass", "All that goes to and fro, with its share of the connecting rod; instead of the parts", "m"
        ),
        "piston": _part("Piston, or a list of pistons"),
        "piston_rod": _part("Piston rod"),
        "crosshead": _part("Crosshead"),
        "other": _part("Whatever else goes to and fro"),
        "connecting_rod": Key(
            OneOf(Physical("mass", least=0), Record(ConnectingRod)),
            "Connecting rod: its mass, of which one half goes to and fro, or a mapping",
            instead="reciprocating",
            also=("con_rod", "conrod"),
        ),
        "rotating": not_negative(
            "mass", "Unbalanced mass of the crank, as one at its pin, without the connecting rod", "m_rot", absent="0"
        ),
    }

    @classmethod
    def of_keys(
        cls,
        connecting_rod: float | ConnectingRod | None = None,
        rotating: float | None = None,
        **parts: float | tuple[float, ...],
    ) -> "Masses":
        """Return the masses that these keys of a machine file describe."""
        sums = {name: total(*part) if isinstance(part, tuple) else part for name, part in parts.items()}
        if not sums and connecting_rod is None and rotating is None:
            refused("no mass is given; leave 'masses' out or give 'reciprocating', or 'piston', 'crosshead', …")
        if connecting_rod is not None and not isinstance(connecting_rod, ConnectingRod):
            connecting_rod = ConnectingRod(connecting_rod)
        crosshead, undivided = sums.get("crosshead"), "reciprocating" in sums
        return cls(total(*sums.values()), connecting_rod, rotating or 0.0, crosshead, undivided)

    def at_pin(self, rod_length: float) -> float:
        """Mass in kg that turns with the crank pin, with what of a connecting rod of this length in m does."""
        return self.rotating + (self.connecting_rod.at_pin(rod_length) if self.connecting_rod else 0.0)

    @property
    def reciprocating(self) -> float:
        """m in kg: all parts and the connecting rod's share (R 298); an exact rod needs `at_crosshead`."""
        assert self.connecting_rod is None or not self.connecting_rod.exact
        return self.at_crosshead(math.inf)

    def at_crosshead(self, rod_length: float) -> float:
        """m in kg: all parts and what of a connecting rod of this length in m goes to and fro with them."""
        return self.parts + (self.connecting_rod.at_crosshead(rod_length) if self.connecting_rod else 0.0)
