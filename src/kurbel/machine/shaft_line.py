"""The shaft line: masses, shaft segments between them, gears, branches, and fixed ends.

In a machine file it is a list that is read along the shaft, with a list in it for each branch; it becomes a
`ShaftLine`, all of it referred to the shaft of the cranks.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from kurbel.declared.forms.structures import Listing, Nested, OneOf, RecordForm
from kurbel.declared.forms.values import TEXT, Choice
from kurbel.declared.reading import REFUSED, Reported
from kurbel.declared.record import Record, Rule, field
from kurbel.errors import Fault, Path, refuse
from kurbel.near_words import did_you_mean

STEEL, STEEL_DENSITY = 82e9, 7850.0
"""Shear modulus in Pa, and density in kg/m³, of steel."""
GROUNDED = -1
"""In place of the number of a mass: a fixed end."""
_SAME_SPEED = 1e-9
"""By how much the speeds of two cranks, which are products of ratios, may differ relatively by rounding."""
GROUND, FLYWHEEL = "ground", "flywheel"
"""Words in the list: an end that is held fast, and the flywheel of the machine."""

SEGMENT, BRANCH = "shaft segment", "branch"
_KEYS = {
    "mass": ("inertia", "cylinder", "load"),
    SEGMENT: ("stiffness", "diameter", "length", "bore", "shear_modulus", "density", "loss_factor"),
    "gear": ("gear",),
    BRANCH: (BRANCH,),
}
"""Kind of an item -> the keys that only such an item has."""


def _shaft() -> Listing:
    """Return the form of a list of items, which a branch has, too."""
    return Listing(OneOf(Choice((GROUND, FLYWHEEL)), RecordForm(ShaftPart)))


class ShaftPart(Record):
    """One item of the list: a mass, a piece of shaft, or a pair of gears; what is not given is None.

    word: `ground` or `flywheel`, which have no keys, else an empty text.
    """

    name: str | None = field(
        str, "What the table calls it", absent="the cylinder, or mass 1, mass 2, …"
    )
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
        gives=lambda keys: {
            "cylinder": (name,) if isinstance(name := keys["cylinder"], str) else name
        },
    )
    load: bool | None = field(
        bool,
        "Whether this mass takes the load",
        absent="the last; the first if cranks are at the last",
    )
    stiffness: float | None = field(
        "stiffness", "Stiffness of a shaft segment; or give `diameter` and `length`", "k", above=0
    )
    diameter: float | None = field(
        "length",
        "Diameter of a shaft segment; if a stiffness is given, used for the stress only",
        "d",
        above=0,
    )
    length: float | None = field(
        "length", "Length of a shaft segment", "l", above=0, instead="stiffness", needs="diameter"
    )
    bore: float | None = field(
        "length", "Bore of a hollow shaft segment", "d_i", least=0, absent="0", needs="diameter"
    )
    shear_modulus: float | None = field(
        "stress",
        "Shear modulus of a shaft segment",
        "G",
        above=0,
        absent="82 GPa, steel",
        needs="length",
    )
    density: float | None = field(
        "density",
        "Density of a shaft segment, whose inertia counts along its length; 0 kg/m3: without inertia",
        "ρ",
        least=0,
        absent="7850 kg/m3, steel",
        example="7850 kg/m3",
        needs="length",
    )
    loss_factor: float | None = field(
        "ratio",
        "Loss factor of a shaft segment, energy lost over 2π times that stored",
        "η",
        least=0,
        most=2,
        absent="0",
        example="0.01",
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
        "ratio",
        "Speed ratio: speed after the gear over speed before it, in the order of the list",
        "u",
        above=0,
        example="0.25",
    )
    branch: tuple[ShaftPart, ...] | None = field(
        Nested(_shaft, "a list of such items"),
        "A side line that begins at the mass before it in the list, with a shaft segment or a gear, and ends with a "
        "mass or `ground`; the list goes on behind it from that mass",
        gives=lambda values: {"branch": tuple(_of_words(values["branch"]))},
    )

    word: str = ""

    def _kinds_and_keys(self) -> list[tuple[str, str]]:
        """Return the keys that have a value, each after the kind of item to which it belongs."""
        pairs = []
        for kind, names in _KEYS.items():
            pairs += [(kind, name) for name in names if vars(self)[name] is not None]
        return pairs

    def rules(self) -> Iterator[Rule]:
        # an item is of one kind
        pairs = self._kinds_and_keys()
        piece = "'stiffness', or 'diameter' and 'length', of a shaft segment"
        nothing = f"give 'inertia' or 'cylinder' of a mass, {piece}, 'gear', or 'branch'"
        yield Rule((), not pairs and not self.word, nothing)
        for kind, key in pairs:
            first_kind, first_key = pairs[0]
            message = (
                f"'{first_key}' is of a {first_kind}, '{key}' of a {kind}; make two items of them"
            )
            yield Rule(key, kind != first_kind, message)

        # a segment has a stiffness, a mass an inertia
        kinds = {kind for kind, _ in pairs}
        if len(kinds) == 1:
            has_stiffness = self.stiffness is not None or self.length is not None
            message = "the segment has no stiffness: give 'stiffness', or 'diameter' and 'length'"
            yield Rule((), self.kind == SEGMENT and not has_stiffness, message)
            has_inertia = self.inertia is not None or self.cylinder is not None
            message = "the mass has no inertia: give 'inertia' or 'cylinder'"
            yield Rule("load", self.kind == "mass" and not has_inertia, message)

        # damping is of masses and segments alone
        is_damped = self.damping is not None
        is_damped_gear = is_damped and self.gear is not None
        yield Rule("damping", is_damped_gear, "is for a mass or a shaft segment; a gear has none")
        is_damped_branch = is_damped and self.branch is not None
        message = "is for a mass or a shaft segment; give it in the branch"
        yield Rule("damping", is_damped_branch, message)

        if self.bore is not None and self.diameter is not None:
            message = "{bore} is not less than the diameter ({diameter})"
            yield Rule("bore", self.bore >= self.diameter, message)

    @property
    def kind(self) -> str:
        """What it is: `mass`, `shaft segment`, `gear`, `branch` or `ground`.

        A mass, too, is the flywheel of the machine.
        """
        if self.word == GROUND:
            return GROUND
        pairs = self._kinds_and_keys()
        if not pairs:
            return "mass"
        return pairs[0][0]

    @property
    def has_inertia(self) -> bool:
        """Whether it is a shaft segment that has an inertia of its own."""
        return self.length is not None and self.stiffness is None and self.density != 0


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
    ratio: speed of this mass over that of the cranks; is_joint: that it has no inertia, and joins two shaft segments.
    """

    name: str
    inertia: float = 0.0
    cylinders: tuple[str, ...] = ()
    flywheel: float = 0.0
    damping: float = 0.0
    ratio: float = 1.0
    is_joint: bool = False


@dataclass(frozen=True, eq=False)
class ShaftSegment:
    """A piece of shaft between two masses: stiffness in N m/rad and damping in N m s/rad referred to the cranks' shaft.

    before, behind: the masses by their numbers, or GROUNDED; sections: of those of its parts whose diameters are known;
    ratio: its speed over that of the cranks; inertia: J_s in kg m², uniform along it, referred to the cranks' shaft.
    """

    stiffness: float
    damping: float = 0.0
    loss_factor: float = 0.0
    sections: tuple[ShaftSection, ...] = ()
    ratio: float = 1.0
    inertia: float = 0.0
    before: int = 0
    behind: int = 1


@dataclass(frozen=True, eq=False)
class ShaftLine:
    """Masses along a shaft and the segments between them, or from a mass to a fixed end.

    load: which mass takes the load.
    """

    masses: tuple[ShaftMass, ...]
    segments: tuple[ShaftSegment, ...]
    load: int = -1

    @property
    def is_held(self) -> bool:
        """Whether an end is fixed."""
        return any(GROUNDED in (segment.before, segment.behind) for segment in self.segments)


def _of_words(parts: Sequence[Any]) -> list[Any]:
    """Return the items with a part in place of each word, `ground` or `flywheel`."""
    return [ShaftPart(word=part) if isinstance(part, str) else part for part in parts]


def shaft_faults(
    items: Sequence[ShaftPart | str | Reported], cylinders: Sequence[str]
) -> list[Fault]:
    """Return what is wrong with a list.

    If parts could not be read, only the faults of single other parts.
    """
    parts = _of_words(items)
    read = [part for part in parts if part is not REFUSED]
    faults = _crank_faults(parts, cylinders, is_complete=len(read) == len(parts))
    if len(read) == len(parts):
        rules = (*_of_order(read), *_of_whole_line(read))
        faults += (Fault(path, message) for is_broken, path, message in rules if is_broken)
    return [fault.below(("shaft",)) for fault in faults]


def _crank_faults(
    parts: Sequence[ShaftPart | Reported], cylinders: Sequence[str], is_complete: bool
) -> list[Fault]:
    """Return what is wrong with the names of cylinders; is_complete: whether all parts were read."""
    faults, seen = list[Fault](), set[str]()
    there = f"the machine has {', '.join(cylinders) or 'none'}"
    for item in _items(parts):
        path = (*item.path, "cylinder")
        for name in item.part.cylinder or ():
            if name not in cylinders:
                hint = did_you_mean(name, tuple(cylinders))
                faults.append(Fault(path, f"no cylinder '{name}'{hint}; {there}"))
            elif name in seen:
                faults.append(Fault(path, f"'{name}' is in the shaft line twice"))
            seen.add(name)

    # a name that is no cylinder may be one of those that are missing
    absent = [name for name in cylinders if name not in seen]
    are_all_cylinders = not seen - set(cylinders)
    if is_complete and absent and are_all_cylinders:
        remedy = f"give its crank an item '{{cylinder: {absent[0]}}}'"
        faults.append(Fault((), f"{', '.join(absent)} is missing in it; {remedy}"))
    return faults


class _Item(NamedTuple):
    """An item of a shaft line or of its branches: its path in the list, and its speed over that of the first item."""

    path: Path
    part: ShaftPart
    speed: float


def _items(
    parts: Sequence[ShaftPart | Reported], path: Path = (), speed: float = 1.0
) -> Iterator[_Item]:
    """Yield every item that could be read, those of a branch behind the branch itself."""
    for index, part in enumerate(parts):
        if part is REFUSED:
            continue
        if part.gear is not None:
            speed *= part.gear
        here = (*path, index)
        yield _Item(here, part, speed)
        yield from _items(part.branch or (), (*here, "branch"), speed)


def _of_order(
    parts: Sequence[ShaftPart], path: Path = (), is_branch: bool = False
) -> Iterator[tuple[bool, Path, str]]:
    """Yield what may be wrong with the order of the items: whether it is, the place, the message.

    path: of the list; is_branch: whether it begins at a mass of another one.
    """
    # branches are looked at by themselves; along the line they are left out
    before = origin = "mass" if is_branch else ""
    along = list[tuple[Path, ShaftPart]]()
    for index, part in enumerate(parts):
        here = (*path, index)
        if part.kind == BRANCH:
            is_behind_mass = bool(along) and before == "mass"
            yield not is_behind_mass, here, "a branch begins at a mass; put it behind one"
            yield from _of_order(part.branch or (), (*here, "branch"), is_branch=True)
        else:
            along.append((here, part))
            before = part.kind

    kinds = [part.kind for _, part in along]
    if is_branch:
        yield not parts, path, "the branch has no items"
    following = [*kinds[1:], ""]
    for number, (here, part) in enumerate(along):
        before = kinds[number - 1] if number else origin
        kind, after, gear = kinds[number], following[number], (*here, "gear")
        is_inside = bool(before and after)
        ends = "a shaft line begins and ends with a mass, or with 'ground'"
        yield kind == SEGMENT and not is_inside, here, ends
        between = "this mass and the one before; give it, or one mass"
        twice = f"no shaft segment between {between}"
        if is_branch and not number:
            between = "this mass and the one that it branches from"
            twice = f"no shaft segment or gear between {between}"
        yield kind == before == "mass", here, twice
        if kind == before == SEGMENT:
            other = along[number - 1][1]
            is_combined = not (part.has_inertia or other.has_inertia)
            is_damped = bool(part.damping or other.damping)
            message = "segments in series with a damper cannot be combined"
            yield is_combined and is_damped, here, f"{message}; give a mass between them"
        last = "'ground' is a fixed end; it must be first or last"
        yield kind == GROUND and is_inside, here, last
        joins = "a gear joins two parts; give what comes before and after it"
        yield kind == "gear" and not is_inside, gear, joins
        is_massless = kind == "gear" and is_inside and "mass" not in (before, after)
        massless = "gears have inertia; give it as a mass before or after the gear"
        yield is_massless, gear, massless
        is_held = GROUND in (kind, before) and bool({kind, before} & {"mass", "gear"})
        held = "a shaft segment is missing between 'ground' and the first mass; give its stiffness"
        yield is_held, here, held


def _of_whole_line(parts: Sequence[ShaftPart]) -> Iterator[tuple[bool, Path, str]]:
    """Yield what may be wrong with a line and all its branches: whether it is, the place, the message."""
    items = list(_items(parts))
    cranks = [item for item in items if item.part.cylinder]
    grounds = [item for item in items if item.part.word == GROUND]
    loads = [item for item in items if item.part.load]
    kinds = [item.part.kind for item in items]

    if cranks:
        message = "a shaft that is held at both ends does not turn a crank; leave one 'ground' out"
        yield len(grounds) > 1, cranks[0].path, message
    single = "a single mass cannot vibrate; give a second one and the shaft segment between them"
    is_alone = kinds.count("mass") + min(len(grounds), 1) < 2
    is_geared_only = "gear" in kinds and SEGMENT not in kinds
    yield is_alone or is_geared_only, (), single
    if len(loads) > 1:
        yield True, (*loads[1].path, "load"), "one mass takes the load; leave one of them out"
    for crank in cranks:
        speed = crank.speed / cranks[0].speed
        if not math.isclose(speed, 1.0, rel_tol=_SAME_SPEED):
            unequal = f"cranks turn at different speeds (1 and {speed:g}); all must turn at one"
            yield True, (*crank.path, "cylinder"), unequal
            return


def line_of(parts: Sequence[ShaftPart | str], cylinders: Sequence[str] = ()) -> ShaftLine:
    """Return the shaft line that a list describes; cylinders: the names of those of the machine; raises RuleError.

    All is referred to the shaft of the cranks: inertia, damping and stiffness by the square of the ratio of speeds.
    """
    refuse(*shaft_faults(parts, cylinders))
    return _Assembly(_of_words(parts)).line


class _Assembly:
    """A shaft line as it is put together, item by item, from a list without faults."""

    def __init__(self, parts: Sequence[ShaftPart]) -> None:
        self.masses: list[ShaftMass] = []
        self.segments: list[ShaftSegment] = []
        self._written = 0
        self._joints = 0
        self._loads: list[int] = []
        speeds = [item.speed for item in _items(parts) if item.part.cylinder]
        self._crank_speed = speeds[0] if speeds else 1.0
        # a line begins at a fixed end, unless a mass is first
        last = self._follow(parts, 1.0, GROUNDED)
        # the driving or driven machine is at an end, and is no crank
        cranks_are_last = bool(self.masses[last].cylinders) and not self.masses[0].cylinders
        usual = 0 if cranks_are_last else last
        load = self._loads[0] if self._loads else usual
        self.line = ShaftLine(tuple(self.masses), tuple(self.segments), load)

    def _follow(self, parts: Sequence[ShaftPart], speed: float, mass: int) -> int:
        """Add the items along a shaft, and return the number of its last mass.

        speed: over that of the first item of the line; mass: the number of that at which the items begin, or GROUNDED.
        """
        last = mass
        segment: ShaftSegment | None = None
        for part in parts:
            if part.gear is not None:
                speed *= part.gear
            ratio = speed / self._crank_speed
            if part.kind == "gear":
                continue
            if part.kind == BRANCH:
                self._follow(part.branch or (), speed, mass)
            elif part.kind == SEGMENT:
                following = _segment(part, ratio)
                if segment is None:
                    segment = following
                elif segment.inertia or following.inertia:
                    mass = self._join(segment, mass, self._joint(ratio))
                    segment = following
                else:
                    segment = _in_series(segment, following)
            elif part.kind == GROUND:
                if segment is not None:
                    self._join(segment, mass, GROUNDED)
            else:
                other = self._mass(part, ratio)
                if segment is not None:
                    mass = self._join(segment, mass, self._added(other))
                elif mass == GROUNDED:
                    mass = self._added(other)
                else:  # a pair of gears is between them
                    self.masses[mass] = _geared(self.masses[mass], other)
                segment, last = None, mass
                if part.load:
                    self._loads.append(mass)
        return last

    def _mass(self, part: ShaftPart, ratio: float) -> ShaftMass:
        square = ratio**2
        cranks = part.cylinder or ()
        # masses that gears join count each, so that no two have one name
        self._written += 1
        return ShaftMass(
            name=part.word or part.name or " + ".join(cranks) or f"mass {self._written}",
            inertia=square * (part.inertia or 0.0),
            cylinders=cranks,
            flywheel=square * (part.word == FLYWHEEL),
            damping=square * (part.damping or 0.0),
            ratio=ratio,
        )

    def _joint(self, ratio: float) -> int:
        """Add a point without inertia between two segments, and return its number."""
        self._joints += 1
        return self._added(ShaftMass(f"joint {self._joints}", ratio=ratio, is_joint=True))

    def _added(self, mass: ShaftMass) -> int:
        self.masses.append(mass)
        return len(self.masses) - 1

    def _join(self, segment: ShaftSegment, before: int, behind: int) -> int:
        """Add a segment between two masses, and return the one behind it."""
        self.segments.append(replace(segment, before=before, behind=behind))
        return behind


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


def _segment(part: ShaftPart, ratio: float) -> ShaftSegment:
    """Return a segment; where no stiffness is given, k = G I_p/l in N m/rad and J_s = ρ I_p l in kg m²."""
    sections = () if part.diameter is None else (ShaftSection(part.diameter, part.bore or 0.0),)
    stiffness, inertia = part.stiffness, 0.0
    if stiffness is None:
        assert part.diameter is not None
        assert part.length is not None
        shear_modulus = STEEL if part.shear_modulus is None else part.shear_modulus
        density = STEEL_DENSITY if part.density is None else part.density
        fourth = part.diameter**4 - (part.bore or 0.0) ** 4
        stiffness = shear_modulus * math.pi * fourth / (32 * part.length)
        inertia = density * math.pi * fourth / 32 * part.length
    square = ratio**2
    return ShaftSegment(
        stiffness=square * stiffness,
        damping=square * (part.damping or 0.0),
        loss_factor=part.loss_factor or 0.0,
        sections=sections,
        ratio=ratio,
        inertia=square * inertia,
    )


def _in_series(segment: ShaftSegment, other: ShaftSegment) -> ShaftSegment:
    """Return two segments without inertia as one: 1/k = Σ 1/k; the loss factor is the mean over what they store."""
    softness = 1 / segment.stiffness + 1 / other.stiffness
    loss = (
        segment.loss_factor / segment.stiffness + other.loss_factor / other.stiffness
    ) / softness
    sections = (*segment.sections, *other.sections)
    return replace(segment, stiffness=1 / softness, loss_factor=loss, sections=sections)
