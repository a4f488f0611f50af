"""The shaft line: masses, the pieces of shaft between them, one reduction of gears, and a fixed end if there is one.

In a machine file it is a list that is read along the shaft; it becomes a `ShaftLine`, all of it referred to the shaft
of the cranks.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

from kurbel.declared.forms import Listing, Number, OneOf, Text, Truth, not_negative, positive
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, refuse

STEEL = 82e9
"""Shear modulus of steel in Pa."""
GROUND, FLYWHEEL = "ground", "flywheel"
"""Words in the list: an end that is held fast, and the flywheel of the machine."""

_OF_MASS = ("inertia", "cylinder", "load")
_OF_PIECE = ("stiffness", "diameter", "length", "bore", "shear_modulus", "loss_factor")


@dataclass(frozen=True, eq=False, repr=False)
class ShaftPart(Described):
    """One item of the list: a mass, a piece of shaft, or a pair of gears; what is not given is None."""

    name: str | None = None
    inertia: float | None = None
    cylinder: tuple[str, ...] | None = None
    load: bool | None = None
    stiffness: float | None = None
    diameter: float | None = None
    length: float | None = None
    bore: float | None = None
    shear_modulus: float | None = None
    loss_factor: float | None = None
    damping: float | None = None
    gear: float | None = None

    KEYS: ClassVar[Keys] = {
        "name": Key(Text(), "What the table calls it", absent="the cylinder, or mass 1, mass 2, …"),
        "inertia": positive(
            "inertia",
            "Moment of inertia of a mass; beside a cylinder, of what turns there besides its moving parts",
            "J",
        ),
        "cylinder": Key(
            OneOf(Text(), Listing(Text())),
            "Name of the cylinder whose crank stands here, or a list of those on one pin; its masses count by the mean "
            "of their reduced inertia over the turn",
        ),
        "load": Key(
            Truth(), "Whether this mass takes the load", absent="the last; the first if cranks stand at the last"
        ),
        "stiffness": positive("stiffness", "Stiffness of a piece; or give `diameter` and `length`", "k"),
        "diameter": positive("length", "Diameter of a piece; beside a stiffness it serves the stress alone", "d"),
        "length": positive("length", "Length of a piece", "l", instead="stiffness", needs="diameter"),
        "bore": not_negative("length", "Bore of a hollow piece", "d_i", absent="0", needs="diameter"),
        "shear_modulus": positive("stress", "Shear modulus of a piece", "G", absent="82 GPa, steel", needs="length"),
        "loss_factor": Key(
            Number(least=0, most=2), "Loss factor of a piece, energy lost over 2π times that stored", "η", absent="0"
        ),
        "damping": not_negative(
            "damping",
            "Torque per speed of vibration: of a mass against uniform rotation, of a piece per speed of twist",
            "c, d",
            absent="0",
        ),
        "gear": Key(Number(above=0), "Speed of what follows in the list over the speed of what stands before it", "u"),
    }

    @classmethod
    def of_keys(cls, cylinder: str | tuple[str, ...] | None = None, **keys: object) -> "ShaftPart":
        """Return the item that these keys of a machine file describe; raises RuleError."""
        names = (cylinder,) if isinstance(cylinder, str) else cylinder
        return cls(cylinder=names, **keys)  # type: ignore[arg-type]

    def __post_init__(self) -> None:
        refuse(*self._faults())

    def _faults(self) -> Iterator[Fault]:
        kinds = {"a mass": _OF_MASS, "a piece of shaft": _OF_PIECE, "a gear": ("gear",)}
        each = [(kind, self._given(keys)) for kind, keys in kinds.items()]
        found = [(kind, keys) for kind, keys in each if keys]
        if len(found) > 1:
            (one, first), (other, second), *_ = found
            yield Fault((second[0],), f"'{first[0]}' is of {one}, '{second[0]}' of {other}; make two items of them")
        elif not found:
            piece = "'stiffness', or 'diameter' and 'length', of a piece of shaft"
            yield Fault((), f"give 'inertia' or 'cylinder' of a mass, {piece}, or 'gear'")
        elif self.is_piece and self.stiffness is None and self.length is None:
            yield Fault((), "the piece has no stiffness: give 'stiffness', or 'diameter' and 'length'")
        elif self.is_mass and self.inertia is None and self.cylinder is None:
            yield Fault(("load",), "the mass has no inertia: give 'inertia' or 'cylinder'")
        if self.gear is not None and self.damping is not None:
            yield Fault(("damping",), "belongs to a mass or a piece of shaft; a gear has none here")
        if self.bore is not None and self.diameter is not None and self.bore >= self.diameter:
            bore, diameter = show(self.bore, "length"), show(self.diameter, "length")
            yield Fault(("bore",), f"{bore} leaves nothing of the diameter ({diameter})")

    def _given(self, keys: Sequence[str]) -> list[str]:
        return [key for key in keys if getattr(self, key) is not None]

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
