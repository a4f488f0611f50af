"""The shaft line: masses, the pieces of shaft between them, one reduction of gears, and a fixed end if there is one.

In a machine file it is a list that is read along the shaft; it becomes a `ShaftLine`, all of it referred to the shaft
of the cranks.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from kurbel.declared.forms import Listing, OneOf, Text
from kurbel.declared.record import Record, Rule, field

STEEL = 82e9
"""Shear modulus of steel in Pa."""
GROUND, FLYWHEEL = "ground", "flywheel"
"""Words in the list: an end that is held fast, and the flywheel of the machine."""

_OF_MASS = ("inertia", "cylinder", "load")
_OF_PIECE = ("stiffness", "diameter", "length", "bore", "shear_modulus", "loss_factor")


@dataclass(frozen=True, eq=False, repr=False)
class ShaftPart(Record):
    """One item of the list: a mass, a piece of shaft, or a pair of gears; what is not given is None."""

    name: str | None = field(str, "What the table calls it", absent="the cylinder, or mass 1, mass 2, …")
    inertia: float | None = field(
        "inertia",
        "Moment of inertia of a mass; beside a cylinder, of what turns there besides its moving parts",
        "J",
        above=0,
    )
    cylinder: tuple[str, ...] | None = field(
        OneOf(Text(), Listing(Text())),
        "Name of the cylinder whose crank stands here, or a list of those on one pin; its masses count by the mean "
        "of their reduced inertia over the turn",
        gives=lambda given: {"cylinder": (one,) if isinstance(one := given["cylinder"], str) else one},
    )
    load: bool | None = field(
        bool, "Whether this mass takes the load", absent="the last; the first if cranks stand at the last"
    )
    stiffness: float | None = field("stiffness", "Stiffness of a piece; or give `diameter` and `length`", "k", above=0)
    diameter: float | None = field(
        "length", "Diameter of a piece; beside a stiffness it serves the stress alone", "d", above=0
    )
    length: float | None = field("length", "Length of a piece", "l", above=0, instead="stiffness", needs="diameter")
    bore: float | None = field("length", "Bore of a hollow piece", "d_i", least=0, absent="0", needs="diameter")
    shear_modulus: float | None = field(
        "stress", "Shear modulus of a piece", "G", above=0, absent="82 GPa, steel", needs="length"
    )
    loss_factor: float | None = field(
        "ratio",
        "Loss factor of a piece, energy lost over 2π times that stored",
        "η",
        least=0,
        most=2,
        absent="0",
    )
    damping: float | None = field(
        "damping",
        "Torque per speed of vibration: of a mass against uniform rotation, of a piece per speed of twist",
        "c, d",
        least=0,
        absent="0",
    )
    gear: float | None = field(
        "ratio", "Speed of what follows in the list over the speed of what stands before it", "u", above=0
    )

    def rules(self) -> Iterator[Rule]:
        kinds = {"a mass": _OF_MASS, "a piece of shaft": _OF_PIECE, "a gear": ("gear",)}
        each = [(kind, self._given(keys)) for kind, keys in kinds.items()]
        found = [(kind, keys) for kind, keys in each if keys]
        if len(found) > 1:
            (one, first), (other, second), *_ = found
            message = f"'{first[0]}' is of {one}, '{second[0]}' of {other}; make two items of them"
            yield Rule(second[0], True, message)
        elif not found:
            piece = "'stiffness', or 'diameter' and 'length', of a piece of shaft"
            yield Rule((), True, f"give 'inertia' or 'cylinder' of a mass, {piece}, or 'gear'")
        elif self.is_piece:
            none = self.stiffness is None and self.length is None
            yield Rule((), none, "the piece has no stiffness: give 'stiffness', or 'diameter' and 'length'")
        elif self.is_mass:
            none = self.inertia is None and self.cylinder is None
            yield Rule("load", none, "the mass has no inertia: give 'inertia' or 'cylinder'")
        both = self.gear is not None and self.damping is not None
        yield Rule("damping", both, "belongs to a mass or a piece of shaft; a gear has none here")
        if self.bore is not None and self.diameter is not None:
            yield Rule("bore", self.bore >= self.diameter, "{bore} leaves nothing of the diameter ({diameter})")

    def _given(self, keys: Sequence[str]) -> list[str]:
        return [key for key in keys if vars(self)[key] is not None]

    @property
    def is_mass(self) -> bool:
        """Whether it is a mass."""
        return bool(self._given(_OF_MASS))

    @property
    def is_piece(self) -> bool:
        """Whether it is a piece of shaft."""
        return bool(self._given(_OF_PIECE))

    @property
    def twist_stiffness(self) -> float:
        """Stiffness of a piece in N m/rad, G π (d⁴ − d_i⁴)/(32 l)."""
        if self.stiffness is not None:
            return self.stiffness
        assert self.diameter is not None
        assert self.length is not None
        modulus = STEEL if self.shear_modulus is None else self.shear_modulus
        return modulus * math.pi * (self.diameter**4 - (self.bore or 0.0) ** 4) / (32 * self.length)


class Section(NamedTuple):
    """A section of shaft: diameter and bore in m."""

    diameter: float
    bore: float

    @property
    def modulus(self) -> float:
        """Section modulus π (d⁴ − d_i⁴)/(16 d) in m³, by which a torque becomes a stress."""
        return math.pi * (self.diameter**4 - self.bore**4) / (16 * self.diameter)


@dataclass(frozen=True, eq=False)
class ShaftMass:
    """A mass: J in kg m² of what is no cylinder, damping in N m s/rad; both referred to the shaft of the cranks.

    cylinders: names of those whose cranks stand here; flywheel: how many times J of that of the machine counts here;
    ratio: speed of this mass over that of the cranks.
    """

    name: str
    inertia: float = 0.0
    cylinders: tuple[str, ...] = ()
    flywheel: float = 0.0
    damping: float = 0.0
    ratio: float = 1.0


@dataclass(frozen=True, eq=False)
class ShaftPiece:
    """A piece of shaft between two masses: stiffness in N m/rad and damping in N m s/rad referred to the cranks' shaft.

    sections: of those of its parts whose diameters are known; ratio: its speed over that of the cranks.
    """

    stiffness: float
    damping: float = 0.0
    loss_factor: float = 0.0
    sections: tuple[Section, ...] = ()
    ratio: float = 1.0


@dataclass(frozen=True, eq=False)
class ShaftLine:
    """Masses along a shaft and the pieces between them; the piece to a fixed end comes first or last.

    ground: `before` or `after` the masses, or empty; load: which mass takes the load.
    """

    masses: tuple[ShaftMass, ...]
    pieces: tuple[ShaftPiece, ...]
    ground: str = ""
    load: int = -1
