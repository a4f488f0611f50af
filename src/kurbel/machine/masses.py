"""Masses of the moving parts."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from kurbel.declared.forms import Listing, OneOf, Physical
from kurbel.declared.forms import Record as RecordForm
from kurbel.declared.keys import Form
from kurbel.declared.record import Record, Rule, alternative, field
from kurbel.numerics.arithmetic import total


@dataclass(frozen=True, eq=False, repr=False)
class ConnectingRod(Record):
    """The connecting rod and how it moves: by the share that reciprocates or, exactly, as the rigid body that it is."""

    mass: float = field("mass", "Mass of the rod", least=0, required=True)
    share: float = field("ratio", "Reciprocating share of the mass", default=0.5, least=0, most=1, absent="1/2")
    center_of_gravity: float | None = field(
        "length",
        "Distance of its centre of gravity from the crosshead pin",
        "a",
        least=0,
        instead="share",
        needs="inertia",
    )
    inertia: float | None = field(
        "inertia", "Moment of inertia about the centre of gravity", "I_r", least=0, needs="center_of_gravity"
    )

    def rules(self) -> Iterator[Rule]:
        yield from self.contradictions()

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


_ONE_OR_MORE: Form = OneOf(Physical("mass", least=0), Listing(Physical("mass", least=0)))
_PARTS = ("reciprocating", "piston", "piston_rod", "crosshead", "other")


def _sum(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the sum of the parts, what of it is the crosshead's, and whether it was given as one."""
    each = {name: given[name] for name in _PARTS if given.get(name) is not None}
    sums = {name: total(*one) if isinstance(one, tuple) else one for name, one in each.items()}
    return {
        "parts": total(*sums.values()),
        "crosshead": sums.get("crosshead"),
        "undivided": "reciprocating" in sums,
    }


def _rod(given: Mapping[str, Any]) -> dict[str, Any]:
    rod = given["connecting_rod"]
    return {"connecting_rod": rod if isinstance(rod, ConnectingRod) else ConnectingRod(rod)}


def _part(text: str, key: str) -> Any:
    return alternative(_ONE_OR_MORE, text, instead="reciprocating", gives=_sum, key=key)


@dataclass(frozen=True, eq=False, repr=False)
class Masses(Record):
    """Moving masses in kg: what reciprocates besides the connecting rod, the connecting rod, and what turns.

    parts: the sum of piston, piston rod, crosshead and others; rotating: at the radius of the crank pin, beside what of
    the connecting rod turns with it; crosshead: what of the sum is the crosshead's, None where that is not known;
    undivided: the sum was given as one and includes the connecting rod's share.
    """

    _sum_given = alternative(
        "mass",
        "All that goes to and fro, with its share of the connecting rod; instead of the parts",
        "m",
        least=0,
        gives=_sum,
        key="reciprocating",
    )
    _piston = _part("Piston, or a list of pistons", "piston")
    _piston_rod = _part("Piston rod", "piston_rod")
    _crosshead = _part("Crosshead", "crosshead")
    _other = _part("Whatever else goes to and fro", "other")
    _connecting_rod = alternative(
        OneOf(Physical("mass", least=0), RecordForm(ConnectingRod)),
        "Connecting rod: its mass, of which one half goes to and fro, or a mapping",
        instead="reciprocating",
        also=("con_rod", "conrod"),
        gives=_rod,
        key="connecting_rod",
    )

    parts: float = 0.0
    connecting_rod: ConnectingRod | None = None
    rotating: float = field(
        "mass",
        "Unbalanced mass of the crank, as one at its pin, without the connecting rod",
        "m_rot",
        default=0.0,
        least=0,
        absent="0",
    )
    crosshead: float | None = None
    undivided: bool = False

    @classmethod
    def rules_of_keys(cls, given: Mapping[str, Any]) -> Iterator[Rule]:
        none = "no mass is given; leave 'masses' out or give 'reciprocating', or 'piston', 'crosshead', …"
        yield Rule((), not given, none)

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
