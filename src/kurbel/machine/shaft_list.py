"""The list of a shaft line, read along the shaft: what may follow what, and the masses and pieces that it makes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Union

from kurbel.errors import Fault, refuse
from kurbel.machine.shaft_line import FLYWHEEL, GROUND, Section, ShaftLine, ShaftMass, ShaftPart, ShaftPiece
from kurbel.near_words import did_you_mean

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


def line_of(parts: Sequence[Part], cylinders: Sequence[str] = ()) -> ShaftLine:
    """Return the shaft line that a list describes; cylinders: the names of those of the machine; raises RuleError."""
    refuse(*_of_cylinders(parts, cylinders), *_of_order(parts), *_of_load(parts))
    return _Builder(parts).line()


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
        load: int | None = None
        open_ = False  # whether pieces stand behind the last mass
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
        if load is None:  # what drives or is driven stands at an end, and is no crank
            load = 0 if masses[-1].cylinders and not masses[0].cylinders else len(masses) - 1
        return ShaftLine(tuple(masses), tuple(pieces), ground, load)

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
