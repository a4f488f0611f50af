"""The shaft line: masses, shaft segments between them, one reduction of gears, and a fixed end if there is one.

In a machine file it is a list that is read along the shaft; it becomes a `ShaftLine`, all of it referred to the shaft
of the cranks.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Union

from kurbel.declared.forms.structures import Listing, OneOf
from kurbel.declared.forms.values import TEXT
from kurbel.declared.reading import REFUSED
from kurbel.declared.record import Record, Rule, field
from kurbel.errors import Fault, refuse
from kurbel.near_words import did_you_mean

STEEL = 82e9
"""Shear modulus of steel in Pa."""
GROUND, FLYWHEEL = "ground", "flywheel"
"""Words in the list: an end that is held fast, and the flywheel of the machine."""

_OF_MASS = ("inertia", "cylinder", "load")
_OF_PIECE = ("stiffness", "diameter", "length", "bore", "shear_modulus", "loss_factor")


class ShaftPart(Record):
    """One item of the list: a mass, a piece of shaft, or a pair of gears; what is not given is None."""

    name: str | None = field(str, "What the table calls it", absent="the cylinder, or mass 1, mass 2, …")
    inertia: float | None = field(
        "inertia",
        "Moment of inertia of a mass; with a cylinder, that of the rotating parts in addition to its crank train",
        "J",
        above=0,
    )
    cylinder: tuple[str, ...] | None = field(
        OneOf(TEXT, Listing(TEXT)),
        "Name of the cylinder whose crank is here, or a list of those on one pin; its masses count with the mean of "
        "their reduced inertia over one turn",
        gives=lambda given: {"cylinder": (one,) if isinstance(one := given["cylinder"], str) else one},
    )
    load: bool | None = field(
        bool, "Whether this mass takes the load", absent="the last; the first if cranks are at the last"
    )
    stiffness: float | None = field(
        "stiffness", "Stiffness of a shaft segment; or give `diameter` and `length`", "k", above=0
    )
    diameter: float | None = field(
        "length", "Diameter of a shaft segment; if a stiffness is given, used for the stress only", "d", above=0
    )
    length: float | None = field(
        "length", "Length of a shaft segment", "l", above=0, instead="stiffness", needs=("diameter")
    )
    bore: float | None = field("length", "Bore of a hollow shaft segment", "d_i", least=0, absent="0", needs="diameter")
    shear_modulus: float | None = field(
        "stress", "Shear modulus of a shaft segment", "G", above=0, absent="82 GPa, steel", needs="length"
    )
    loss_factor: float | None = field(
        "ratio",
        "Loss factor of a shaft segment, energy lost over 2π times that stored",
        "η",
        least=0,
        most=2,
        absent="0",
    )
    damping: float | None = field(
        "damping",
        "Damping torque per angular velocity: of a mass relative to uniform rotation, of a shaft segment per speed "
        "of twist",
        "c, d",
        least=0,
        absent="0",
    )
    gear: float | None = field(
        "ratio", "Speed ratio: speed after the gear over speed before it, in the order of the list", "u", above=0
    )

    def rules(self) -> Iterator[Rule]:
        each = {"a mass": _OF_MASS, "a shaft segment": _OF_PIECE, "a gear": ("gear",)}
        found = [(kind, key) for kind, keys in each.items() for key in keys if vars(self)[key] is not None]
        others = [(kind, key) for kind, key in found if kind != found[0][0]]
        if others:
            (one, first), (other, second) = found[0], others[0]
            message = f"'{first}' is of {one}, '{second}' of {other}; make two items of them"
            yield Rule(second, True, message)
        elif not found:
            piece = "'stiffness', or 'diameter' and 'length', of a shaft segment"
            yield Rule((), True, f"give 'inertia' or 'cylinder' of a mass, {piece}, or 'gear'")
        elif kind_of(self) == "piece":
            none = self.stiffness is None and self.length is None
            yield Rule((), none, "the segment has no stiffness: give 'stiffness', or 'diameter' and 'length'")
        elif kind_of(self) == "mass":
            none = self.inertia is None and self.cylinder is None
            yield Rule("load", none, "the mass has no inertia: give 'inertia' or 'cylinder'")
        both = self.gear is not None and self.damping is not None
        yield Rule("damping", both, "is for a mass or a shaft segment; a gear has none")
        if self.bore is not None and self.diameter is not None:
            yield Rule("bore", self.bore >= self.diameter, "{bore} is not less than the diameter ({diameter})")


Part = Union[ShaftPart, str]


def kind_of(part: Part) -> str:
    """Return the kind of an item of the list: `mass`, `piece`, `gear` or `ground`."""
    if isinstance(part, str):
        return GROUND if part == GROUND else "mass"
    for kind, keys in (("mass", _OF_MASS), ("piece", _OF_PIECE)):
        if any(vars(part)[key] is not None for key in keys):
            return kind
    return "gear"


class ShaftSection(NamedTuple):
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

    cylinders: names of those whose cranks are here; flywheel: how many times J of the machine's flywheel counts here;
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
    sections: tuple[ShaftSection, ...] = ()
    ratio: float = 1.0


@dataclass(frozen=True, eq=False)
class ShaftLine:
    """Masses along a shaft and the pieces between them; the piece to a fixed end comes first or last.

    ground: `before` or `after` the masses, `both`, or empty; load: which mass takes the load.
    """

    masses: tuple[ShaftMass, ...]
    pieces: tuple[ShaftPiece, ...]
    ground: str = ""
    load: int = -1


def shaft_faults(parts: Sequence[Any], cylinders: Sequence[str]) -> list[Fault]:
    """Return what is wrong with a list; if parts could not be read, only the faults of single other parts."""
    found = _of_cylinders(parts, cylinders)
    if REFUSED in parts:
        return [fault for fault in found if fault.path]
    return [*found, *_of_order(parts), *_of_whole(parts)]


def _of_cylinders(parts: Sequence[Part], cylinders: Sequence[str]) -> list[Fault]:
    faults, seen = [], set[str]()
    for index, part in enumerate(parts):
        for name in (part.cylinder or ()) if isinstance(part, ShaftPart) else ():
            place = index, "cylinder"
            if name not in cylinders:
                there = f"the machine has {', '.join(cylinders) or 'none'}"
                near = did_you_mean(name, tuple(cylinders))
                faults.append(Fault(place, f"no cylinder '{name}'{near}; {there}"))
            elif name in seen:
                faults.append(Fault(place, f"'{name}' is in the shaft line twice"))
            seen.add(name)
    absent = [name for name in cylinders if name not in seen]
    if absent and not seen - set(cylinders):
        item = f"give its crank an item '{{cylinder: {absent[0]}}}'"
        faults.append(Fault((), f"{', '.join(absent)} is missing in it; {item}"))
    return faults


def _of_order(parts: Sequence[Part]) -> Iterator[Fault]:
    """Yield the faults in the order of the items."""
    kinds = [kind_of(part) for part in parts]
    for index, (before, kind, after) in enumerate(zip(["", *kinds], kinds, [*kinds[1:], ""])):
        if kind == "piece" and not (before and after):
            yield Fault((index,), "a shaft line begins and ends with a mass, or with 'ground'")
        if kind == before == "mass":
            yield Fault((index,), "no shaft segment between this mass and the one before; give it, or one mass")
        damped = any(isinstance(one, ShaftPart) and one.damping for one in parts[max(index - 1, 0) : index + 1])
        if kind == before == "piece" and damped:
            yield Fault((index,), "segments in series with a damper cannot be combined; give a mass between them")
        if kind == GROUND and before and after:
            yield Fault((index,), "'ground' is a fixed end; it must be first or last")
        if kind == "gear" and not (before and after):
            yield Fault((index, "gear"), "a gear joins two parts; give what comes before and after it")
        elif kind == "gear" and "mass" not in (before, after):
            yield Fault((index, "gear"), "gears have inertia; give it as a mass before or after the gear")
        if GROUND in (kind, before) and {kind, before} & {"mass", "gear"}:
            yield Fault((index,), "a shaft segment is missing between 'ground' and the first mass; give its stiffness")


def _of_whole(parts: Sequence[Part]) -> Iterator[Fault]:
    """Yield faults of the whole list: items that are missing, or given too often."""
    kinds = [kind_of(part) for part in parts]
    gears = [index for index, kind in enumerate(kinds) if kind == "gear"]
    grounds = [index for index, kind in enumerate(kinds) if kind == GROUND]
    if len(gears) > 1:
        yield Fault((gears[1], "gear"), "one reduction is all that a shaft line may have; refer the others to it by u²")
    cranks = [index for index, part in enumerate(parts) if isinstance(part, ShaftPart) and part.cylinder]
    if len(grounds) > 1 and cranks:
        yield Fault((cranks[0],), "a shaft that is held at both ends does not turn a crank; leave one 'ground' out")
    if kinds.count("mass") + min(len(grounds), 1) < 2:
        second = "give a second one and the shaft segment between them"
        yield Fault((), f"a single mass cannot vibrate; {second}")
    loads = [index for index, part in enumerate(parts) if isinstance(part, ShaftPart) and part.load]
    if len(loads) > 1:
        yield Fault((loads[1], "load"), "one mass takes the load; leave one of them out")
    if gears and cranks and cranks[0] < gears[0] < cranks[-1]:
        yield Fault((gears[0], "gear"), "there are cranks before and after the gear; all must turn at one speed")


def line_of(parts: Sequence[Part], cylinders: Sequence[str] = ()) -> ShaftLine:
    """Return the shaft line that a list describes; cylinders: the names of those of the machine; raises RuleError.

    All is referred to the shaft of the cranks: inertia, damping and stiffness by the square of the ratio of speeds.
    """
    refuse(*shaft_faults(parts, cylinders))
    gear = next((index for index, part in enumerate(parts) if kind_of(part) == "gear"), len(parts))
    ratios = 1.0, next((part.gear for part in parts if isinstance(part, ShaftPart) and part.gear), 1.0)
    if any(isinstance(part, ShaftPart) and part.cylinder for part in parts[gear:]):
        ratios = 1 / ratios[1], 1.0
    masses: list[ShaftMass] = []
    pieces: list[ShaftPiece] = []
    loads: list[int] = []
    before = ""
    for index, part in enumerate(parts):
        kind, ratio = kind_of(part), ratios[index > gear]
        if kind == "mass":
            mass = _mass(part, ratio, len(masses) + 1)
            if before == "gear" and kind_of(parts[gear - 1]) == "mass":
                mass = _geared(masses.pop(), mass)
            masses.append(mass)
            if isinstance(part, ShaftPart) and part.load:
                loads.append(len(masses) - 1)
        elif kind == "piece":
            piece = _piece(part, ratio)
            pieces.append(_in_series(pieces.pop(), piece) if before == "piece" else piece)
        before = kind
    ground = {(True, True): "both", (True, False): "before", (False, True): "after"}.get(
        (parts[0] == GROUND, parts[-1] == GROUND), ""
    )
    # the driving or driven machine is at an end, and is no crank
    usual = 0 if masses[-1].cylinders and not masses[0].cylinders else len(masses) - 1
    return ShaftLine(tuple(masses), tuple(pieces), ground, (*loads, usual)[0])


def _mass(part: Part, ratio: float, number: int) -> ShaftMass:
    square = ratio**2
    if isinstance(part, str):
        return ShaftMass(FLYWHEEL, flywheel=square, ratio=ratio)
    cylinders = part.cylinder or ()
    name = part.name or " + ".join(cylinders) or f"mass {number}"
    return ShaftMass(name, square * (part.inertia or 0.0), cylinders, 0.0, square * (part.damping or 0.0), ratio)


def _geared(mass: ShaftMass, other: ShaftMass) -> ShaftMass:
    """Return one mass for the two that a pair of gears joins."""
    return replace(
        mass,
        name=f"{mass.name} + {other.name}",
        inertia=mass.inertia + other.inertia,
        cylinders=(*mass.cylinders, *other.cylinders),
        flywheel=mass.flywheel + other.flywheel,
        damping=mass.damping + other.damping,
    )


def _piece(part: Part, ratio: float) -> ShaftPiece:
    """Return a piece; where no stiffness is given, it is G π (d⁴ − d_i⁴)/(32 l) in N m/rad."""
    assert isinstance(part, ShaftPart)
    stiffness, bore = part.stiffness, part.bore or 0.0
    if stiffness is None:
        assert part.diameter is not None
        assert part.length is not None
        modulus = STEEL if part.shear_modulus is None else part.shear_modulus
        stiffness = modulus * math.pi * (part.diameter**4 - bore**4) / (32 * part.length)
    sections = () if part.diameter is None else (ShaftSection(part.diameter, bore),)
    square, loss = ratio**2, part.loss_factor or 0.0
    return ShaftPiece(square * stiffness, square * (part.damping or 0.0), loss, sections, ratio)


def _in_series(piece: ShaftPiece, other: ShaftPiece) -> ShaftPiece:
    """Return two pieces without a mass between them: 1/k = Σ 1/k; the loss factor is the mean over what they store."""
    softness = 1 / piece.stiffness + 1 / other.stiffness
    loss = (piece.loss_factor / piece.stiffness + other.loss_factor / other.stiffness) / softness
    sections = (*piece.sections, *other.sections)
    return replace(piece, stiffness=1 / softness, loss_factor=loss, sections=sections)
