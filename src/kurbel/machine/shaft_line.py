"""The shaft line: masses, the pieces of shaft between them, one reduction of gears, and a fixed end if there is one.

In a machine file it is a list that is read along the shaft; it becomes a `ShaftLine`, all of it referred to the shaft
of the cranks.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, NamedTuple, Union

from kurbel.declared.forms import Listing, Number, OneOf, Physical, Text, Truth
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, refuse
from kurbel.near_words import did_you_mean

STEEL = 82e9
"""Shear modulus of steel in Pa."""
GROUND, FLYWHEEL = "ground", "flywheel"
"""Words in the list: an end that is held fast, and the flywheel of the machine."""

_OF_MASS = ("inertia", "cylinder", "load")
_OF_PIECE = ("stiffness", "diameter", "length", "bore", "shear_modulus", "loss_factor")


@dataclass(frozen=True, eq=False)
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
        "inertia": Key(
            Physical("inertia", above=0),
            "Moment of inertia of a mass; beside a cylinder, of what turns there besides its moving parts",
            "J",
        ),
        "cylinder": Key(
            OneOf(Text(), Listing(Text())),
            "Name of the cylinder whose crank stands here, or a list of those on one pin; its masses count by the mean "
            "of their reduced inertia over the turn",
        ),
        "load": Key(Truth(), "Whether this mass takes the load", absent="the last mass does"),
        "stiffness": Key(Physical("stiffness", above=0), "Stiffness of a piece; or give `diameter` and `length`", "k"),
        "diameter": Key(
            Physical("length", above=0), "Diameter of a piece; beside a stiffness it serves the stress alone", "d"
        ),
        "length": Key(Physical("length", above=0), "Length of a piece", "l", instead="stiffness", needs="diameter"),
        "bore": Key(Physical("length", least=0), "Bore of a hollow piece", "d_i", absent="0", needs="diameter"),
        "shear_modulus": Key(
            Physical("stress", above=0), "Shear modulus of a piece", "G", absent="82 GPa, steel", needs="length"
        ),
        "loss_factor": Key(
            Number(least=0, most=2), "Loss factor of a piece, energy lost over 2π times that stored", "η", absent="0"
        ),
        "damping": Key(
            Physical("damping", least=0),
            "Torque per speed of vibration: of a mass against uniform rotation, of a piece per speed of twist",
            "c, d",
            absent="0",
        ),
        "gear": Key(Number(above=0), "Speed of what follows in the list over the speed of what stands before it", "u"),
    }

    @classmethod
    def of_keys(cls, cylinder: str | tuple[str, ...] | None = None, **keys: object) -> ShaftPart:
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
            message = f"'{first[0]}' is of {one}, '{second[0]}' of {other}; make two items of them"
            yield Fault((second[0],), message)
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

    @classmethod
    def of_parts(cls, parts: Sequence[ShaftPart | str], cylinders: Sequence[str] = ()) -> ShaftLine:
        """Return the line that a list of a machine file describes; cylinders: the names of those of the machine.

        Raises RuleError.
        """
        refuse(*_of_cylinders(parts, cylinders), *_of_order(parts), *_of_load(parts))
        return _Builder(parts).line()


Part = Union[ShaftPart, str]


def _of_cylinders(parts: Sequence[Part], cylinders: Sequence[str]) -> Iterator[Fault]:
    seen: set[str] = set()
    for index, part in enumerate(parts):
        for name in (part.cylinder or ()) if isinstance(part, ShaftPart) else ():
            if name not in cylinders:
                there = f"the machine has {', '.join(cylinders)}" if cylinders else "the machine has none"
                yield Fault((index, "cylinder"), f"no cylinder '{name}'{did_you_mean(name, tuple(cylinders))}; {there}")
            elif name in seen:
                yield Fault((index, "cylinder"), f"'{name}' stands in the shaft line twice")
            seen.add(name)
    absent = [name for name in cylinders if name not in seen]
    if absent and not seen - set(cylinders):
        yield Fault((), f"{', '.join(absent)} stands nowhere in it; give its crank an item '{{cylinder: {absent[0]}}}'")


def _kind(part: Part) -> str:
    if isinstance(part, str):
        return GROUND if part == GROUND else "mass"
    return "mass" if part.is_mass else "piece" if part.is_piece else "gear"


def _of_order(parts: Sequence[Part]) -> Iterator[Fault]:
    """Yield what is wrong with the order of the items."""
    kinds = [_kind(part) for part in parts]
    for index, kind in enumerate(kinds):
        before = kinds[index - 1] if index else ""
        after = kinds[index + 1] if index + 1 < len(kinds) else ""
        if kind == "piece" and not (before and after):
            yield Fault((index,), "a shaft line begins and ends with a mass, or with 'ground'")
        if kind == before == "mass":
            yield Fault((index,), "no piece of shaft stands between this mass and the one before; give it, or one mass")
        if kind == before == "piece" and any(getattr(one, "damping", None) for one in parts[index - 1 : index + 1]):
            yield Fault((index,), "pieces in series with a damper are not one piece; give a mass between them")
        if kind == GROUND and before and after:
            yield Fault((index,), "'ground' is a fixed end; it stands first or last")
        if kind == "gear" and not (before and after):
            yield Fault((index, "gear"), "a gear stands between what it joins; give what comes before and after it")
        elif kind == "gear" and "mass" not in (before, after):
            yield Fault((index, "gear"), "gears have inertia; give it as a mass before or after the gear")
        if GROUND in (kind, before) and {kind, before} & {"mass", "gear"}:
            yield Fault((index,), "a piece of shaft stands between 'ground' and the first mass; give its stiffness")
    yield from _of_numbers(kinds)


def _of_numbers(kinds: Sequence[str]) -> Iterator[Fault]:
    gears = [index for index, kind in enumerate(kinds) if kind == "gear"]
    grounds = [index for index, kind in enumerate(kinds) if kind == GROUND]
    if len(gears) > 1:
        yield Fault((gears[1], "gear"), "one reduction is all that a shaft line may have; refer the others to it by u²")
    if len(grounds) > 1:
        yield Fault((grounds[1],), "a shaft that is held at both ends does not turn; leave one 'ground' out")
    if kinds.count("mass") + len(grounds) < 2:
        yield Fault(
            (), "one mass has nothing to vibrate against; give a second one and the piece of shaft between them"
        )


def _of_load(parts: Sequence[Part]) -> Iterator[Fault]:
    loads = [index for index, part in enumerate(parts) if isinstance(part, ShaftPart) and part.load]
    if len(loads) > 1:
        yield Fault((loads[1], "load"), "one mass takes the load; leave one of them out")
    gears = [index for index, part in enumerate(parts) if _kind(part) == "gear"]
    cranks = [index for index, part in enumerate(parts) if isinstance(part, ShaftPart) and part.cylinder]
    if gears and cranks and cranks[0] < gears[0] < cranks[-1]:
        yield Fault((gears[0], "gear"), "cranks stand before and behind the gear; they turn at one speed")


class _Builder:
    """Reads the list along the shaft. The gear's ratio is 1 on the side of the cranks."""

    def __init__(self, parts: Sequence[Part]) -> None:
        self._parts = parts
        kinds = [_kind(part) for part in parts]
        self._gear = kinds.index("gear") if "gear" in kinds else len(parts)
        self.grounds = [kind == GROUND for kind in kinds]

    def _ratio(self, index: int) -> float:
        """Return the speed of an item over that of the cranks."""
        if self._gear == len(self._parts):
            return 1.0
        gear = self._parts[self._gear]
        assert isinstance(gear, ShaftPart)
        assert gear.gear is not None
        behind = any(isinstance(part, ShaftPart) and part.cylinder for part in self._parts[self._gear :])
        if behind:
            return 1.0 if index > self._gear else 1 / gear.gear
        return gear.gear if index > self._gear else 1.0

    def line(self) -> ShaftLine:
        masses: list[ShaftMass] = []
        pieces: list[ShaftPiece] = []
        load, open_ = -1, False  # whether pieces stand behind the last mass
        for index, part in enumerate(self._parts):
            kind = _kind(part)
            if kind == "piece":
                piece = self._piece(index)
                if open_:
                    pieces[-1] = _in_series(pieces[-1], piece)
                else:
                    pieces.append(piece)
                open_ = True
            elif kind == "mass":
                mass = self._mass(index, len(masses) + 1)
                geared = index > 1 and self._gear == index - 1 and not open_
                if geared:
                    masses[-1] = _as_one(masses[-1], mass)
                else:
                    masses.append(mass)
                open_ = False
                if isinstance(part, ShaftPart) and part.load:
                    load = len(masses) - 1
        ground = "before" if self.grounds[0] else "after" if self.grounds[-1] else ""
        return ShaftLine(tuple(masses), tuple(pieces), ground, load if load >= 0 else len(masses) - 1)

    def _mass(self, index: int, number: int) -> ShaftMass:
        part, ratio = self._parts[index], self._ratio(index)
        if isinstance(part, str):
            return ShaftMass(FLYWHEEL, flywheel=ratio**2, ratio=ratio)
        cylinders = part.cylinder or ()
        name = part.name or " + ".join(cylinders) or f"mass {number}"
        square = ratio**2
        return ShaftMass(name, square * (part.inertia or 0.0), cylinders, 0.0, square * (part.damping or 0.0), ratio)

    def _piece(self, index: int) -> ShaftPiece:
        part, ratio = self._parts[index], self._ratio(index)
        assert isinstance(part, ShaftPart)
        sections = () if part.diameter is None else (Section(part.diameter, part.bore or 0.0),)
        square = ratio**2
        damping, loss = square * (part.damping or 0.0), part.loss_factor or 0.0
        return ShaftPiece(square * part.twist_stiffness, damping, loss, sections, ratio)


def _as_one(mass: ShaftMass, other: ShaftMass) -> ShaftMass:
    """Return two masses that a pair of gears joins, referred to the cranks' shaft already."""
    return replace(
        mass,
        name=f"{mass.name} + {other.name}",
        inertia=mass.inertia + other.inertia,
        cylinders=(*mass.cylinders, *other.cylinders),
        flywheel=mass.flywheel + other.flywheel,
        damping=mass.damping + other.damping,
    )


def _in_series(piece: ShaftPiece, other: ShaftPiece) -> ShaftPiece:
    """Return two pieces without a mass between them: 1/k = Σ 1/k; the loss factor is the mean over what they store."""
    softness = 1 / piece.stiffness + 1 / other.stiffness
    loss = (piece.loss_factor / piece.stiffness + other.loss_factor / other.stiffness) / softness
    sections = (*piece.sections, *other.sections)
    return replace(piece, stiffness=1 / softness, loss_factor=loss, sections=sections)
