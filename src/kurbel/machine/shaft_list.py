"""The list of a shaft line, read along the shaft: what may follow what, and the masses and pieces that it makes."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, Union

from kurbel.declared.reading import REFUSED
from kurbel.errors import Fault, refuse
from kurbel.machine.shaft_line import FLYWHEEL, GROUND, Section, ShaftLine, ShaftMass, ShaftPart, ShaftPiece
from kurbel.near_words import did_you_mean

Part = Union[ShaftPart, str]


def shaft_faults(parts: Sequence[Any], cylinders: Sequence[str]) -> list[Fault]:
    """Return what is wrong with a list; of one with parts that could not be read what can be told of the others."""
    if REFUSED in parts:
        return [fault for fault in _of_cylinders(parts, cylinders) if fault.path]
    return [*_of_cylinders(parts, cylinders), *_of_order(parts), *_of_load(parts)]


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
    refuse(*shaft_faults(parts, cylinders))
    kinds = [_kind(part) for part in parts]
    masses: list[ShaftMass] = []
    pieces: list[ShaftPiece] = []
    loads = []
    for index, (kind, part, ratio) in enumerate(zip(kinds, parts, _ratios(parts))):
        if kind == "piece":
            in_series = kinds[index - 1] == "piece"
            pieces.append(_in_series(pieces.pop(), _piece(part, ratio)) if in_series else _piece(part, ratio))
        elif kind == "mass":
            mass, geared = _mass(part, ratio, len(masses) + 1), kinds[:index][-2:] == ["mass", "gear"]
            masses.append(_as_one(masses.pop(), mass) if geared else mass)
            loads += [len(masses) - 1] if isinstance(part, ShaftPart) and part.load else []
    ground = "before" if kinds[0] == GROUND else "after" if kinds[-1] == GROUND else ""
    # what drives or is driven stands at an end, and is no crank
    usual = 0 if masses[-1].cylinders and not masses[0].cylinders else len(masses) - 1
    return ShaftLine(tuple(masses), tuple(pieces), ground, (*loads, usual)[0])


def _ratios(parts: Sequence[Part]) -> list[float]:
    """Return the speeds of the items over that of the cranks."""
    gears = [(index, part.gear) for index, part in enumerate(parts) if isinstance(part, ShaftPart) and part.gear]
    for place, gear in gears:
        if any(isinstance(part, ShaftPart) and part.cylinder for part in parts[place:]):
            return [1.0 if index > place else 1 / gear for index in range(len(parts))]
        return [gear if index > place else 1.0 for index in range(len(parts))]
    return [1.0] * len(parts)


def _mass(part: Part, ratio: float, number: int) -> ShaftMass:
    square = ratio**2
    if isinstance(part, str):
        return ShaftMass(FLYWHEEL, flywheel=square, ratio=ratio)
    cylinders = part.cylinder or ()
    name = part.name or " + ".join(cylinders) or f"mass {number}"
    return ShaftMass(name, square * (part.inertia or 0.0), cylinders, 0.0, square * (part.damping or 0.0), ratio)


def _piece(part: Part, ratio: float) -> ShaftPiece:
    assert isinstance(part, ShaftPart)
    sections = () if part.diameter is None else (Section(part.diameter, part.bore or 0.0),)
    damping, loss = ratio**2 * (part.damping or 0.0), part.loss_factor or 0.0
    return ShaftPiece(ratio**2 * part.twist_stiffness, damping, loss, sections, ratio)


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
