"""One cylinder as it is drawn in section: where its joints and cylinders are, and its parts as bodies that move.

Bodies are in the frame of the stroke line, which runs from the shaft along +x. Joints are where the mechanism has them;
what a file does not give follows from the crank radius, the stroke or the bore by the shares below.
"""

import math
from collections.abc import Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.crank_angle import CrankAngle
from kurbel.machine import CYCLES, Machine
from kurbel.machine.parts import Piston
from kurbel.mechanisms import PIN, SHAFT, Sketch
from kurbel.report.picture import MOMENTS_PER_TURN, Body, Shape
from kurbel.solver.forces import CylinderForces

BORE = 0.9
"""Bore relative to the stroke, if none is given."""
_CLEARANCE = 0.05  # of the stroke, between piston and cover in the dead centre
_TRUNK, _DISC, _PLUNGER = 0.9, 0.32, 0.6  # heights of pistons over the bore
WALL, COVER, _GLAND, _ROD = 0.06, 0.1, 0.16, 0.08  # of the bore; the last is the radius of a piston rod
_PIN, _JOURNAL, _WEIGHT = 0.2, 0.27, 0.95  # radii over the crank radius
EYE, _HUB = 1.55, 1.45  # radii of eye and hub over those of pin and journal
SHOE = 0.36  # half the length and height of a crosshead over the crank radius


class Barrel(NamedTuple):
    """A cylinder with its piston; lengths in m along the stroke line from the shaft.

    shift: from the output of the mechanism to the middle of the piston; low, high: inner faces toward the shaft and
    away from it; closed: whether there are covers; rods: radii of the piston rods through these ends, 0 of none.
    """

    piston: Piston | None
    bore: float
    height: float
    shift: float
    low: float
    high: float
    closed: tuple[bool, bool]
    rods: tuple[float, float]
    trunk: bool = False

    def ends(self, share: float) -> tuple[float, float]:
        """Return how far what is `share` of the bore thick reaches beyond the inner faces, 0 where it is open."""
        return self.low - share * self.bore * self.closed[0], self.high + share * self.bore * self.closed[1]


class Train:
    """One cylinder at crank angles of its own in degrees, (1,) or (1 + m,): at rest, then over its working cycle.

    motion: the angles of one turn, after which it moves alike; angle: from the stroke line of cylinder 1 to its own,
    in degrees; crosshead: whether there is one between connecting rod and piston.
    """

    def __init__(self, machine: Machine, results: CylinderForces, degrees: Array, alone: bool) -> None:
        self.machine, self.results, self.cylinder = machine, results, results.drive.cylinder
        self.mechanism = self.cylinder.mechanism
        own = degrees if alone else degrees - self.cylinder.crank_position
        self.cycle = own[: 1 + MOMENTS_PER_TURN * CYCLES[machine.cycle_of(self.cylinder)]]
        self.motion = own[: 1 + MOMENTS_PER_TURN]
        self.angle = 0.0 if alone else self.cylinder.bank_angle
        sketch = self.mechanism.sketch(CrankAngle.of(self.motion))
        assert sketch is not None
        self.sketch: Sketch = sketch
        self.joints: dict[str, ComplexArray] = {
            name: np.broadcast_to(np.asarray(x) + 1j * np.asarray(y), self.motion.shape)
            for name, (x, y) in sketch.joints.items()
        }
        shaft = machine.crankshaft
        self.pin = shaft.pin_diameter / 2 if shaft else _PIN * self.mechanism.crank
        self.journal = (
            shaft.journal_diameter / 2 if shaft and shaft.journal_diameter else _JOURNAL * self.mechanism.crank
        )
        pistons, masses = self.cylinder.pistons, self.cylinder.masses
        piston_rod = any(one.crank_end_rod or "crank_end" in one.chambers for one in pistons)
        self.crosshead = bool(piston_rod or (masses and masses.crosshead) or machine.locomotive)
        self.crosshead |= self.has_slot or self.has_frame

    @property
    def weight(self) -> float:
        """Radius of the counterweight over that of the crank, larger where some are given."""
        return _WEIGHT if self.machine.counterweights or self.cylinder.counterweights else 0.8 * _WEIGHT

    @property
    def is_engine(self) -> bool:
        """Whether a piston reciprocates on the stroke line."""
        return bool(self.mechanism.slides) and not self.mechanism.quick_return

    @property
    def has_slot(self) -> bool:
        """Whether it is a Scotch yoke, in whose slot the crank pin slides."""
        return self.is_engine and bool(self.sketch.blocks)

    @property
    def has_frame(self) -> bool:
        """Whether a frame on the piston rod, which needs no guide, holds rod and crank within."""
        return self.is_engine and not self.mechanism.guided and not self.has_slot

    @property
    def output(self) -> ComplexArray:
        """Where the crosshead, or the pin of a trunk piston, is."""
        return self.joints[self.sketch.output]

    @property
    def forked(self) -> bool:
        """Whether the end of a lever slides in a fork of the part that it drives."""
        ends = self.joints.get("end")
        return bool(self.sketch.output) and ends is not None and np.allclose((self.output - ends).imag, 0.0)

    @property
    def outer_end(self) -> float:
        """Outer end of the outermost cylinder on the stroke line, in m."""
        return max(self.mechanism.crank, *(barrel.ends(COVER)[1] for barrel in self.barrels))

    @property
    def head(self) -> tuple[float, float]:
        """How far what is on the piston rod at the crosshead reaches from the output, toward the shaft and outward."""
        R, slot = self.mechanism.crank, float((self.joints[PIN] - self.output).real[0])
        if self.has_slot:
            return slot - SHOE * R, slot + SHOE * R
        return (-self.mechanism.rod_length - 2.6 * R if self.has_frame else -SHOE * R), SHOE * R

    @cached_property
    def barrels(self) -> tuple[Barrel, ...]:
        """The cylinders on the piston rod, those of a yoke on both of its sides."""
        (near, _), (far, _) = self.sketch.guides[0]
        ends = near + self.head[0], far + self.head[1]
        found = list[Barrel]()
        pistons: tuple[Piston | None, ...] = self.cylinder.pistons or (None,)
        for number, piston in enumerate(pistons):
            if piston is None or piston.lever_ratio == 1:
                outward = not (number and (self.has_slot or self.has_frame))
                found.append(self._barrel(piston, number, near, far, ends[outward], outward))
                reach = found[-1].ends(COVER + _GLAND)
                ends = (ends[0], reach[1]) if outward else (reach[0], ends[1])
        return tuple(found)

    def _barrel(
        self, piston: Piston | None, number: int, near: float, far: float, start: float, outward: bool
    ) -> Barrel:
        """Return a cylinder that begins beyond a place in m; outward: away from the shaft."""
        R, stroke = self.mechanism.crank, self.mechanism.stroke
        bore = piston.bore if piston else BORE * stroke
        chambers = piston.chambers if piston else {}
        closed = "crank_end" in chambers if chambers else self.crosshead, "head_end" in chambers or not chambers
        low_gap, high_gap = (
            (getattr(chambers.get(end), "clearance", None) or _CLEARANCE) * stroke for end in ("crank_end", "head_end")
        )
        if number == 0 and not self.crosshead:
            height = _TRUNK * bore
            shift, low = 0.08 * height, near - 0.2 * height
            return Barrel(
                piston, bore, height, shift, low, far + shift + height / 2 + high_gap, closed, (0.0, 0.0), True
            )
        height = (_DISC if closed[0] else _PLUNGER) * bore
        room = 0.12 * R + (COVER + _GLAND) * bore
        if outward:
            low = start + (room if closed[0] else 0.3 * R)
            shift = low + low_gap * closed[0] + height / 2 - near
        else:
            shift = start - room - high_gap - height / 2 - far
        low, high = near + shift - height / 2 - low_gap * closed[0], far + shift + height / 2 + high_gap
        thin = _ROD * bore
        given = (piston.crank_end_rod / 2, piston.head_end_rod / 2) if piston else (0.0, 0.0)
        rods = (given[0] or thin, given[1]) if outward else (0.0, max(given) or thin)
        return Barrel(piston, bore, height, shift, low, high, closed, rods)


# parts


def _polygon(look: str, corners: Any) -> Shape:
    return Shape(look, np.asarray(corners, dtype=complex))


def box(look: str, left: float, right: float, bottom: float, top: float) -> Shape:
    """Return a rectangle."""
    return _polygon(look, (left + 1j * bottom, right + 1j * bottom, right + 1j * top, left + 1j * top))


def disc(look: str, radius: float, middle: complex = 0.0) -> Shape:
    """Return a circle."""
    return _polygon(look, (middle,))._replace(radius=radius)


def _strip(look: str, left: float, right: float, half: float) -> Shape:
    return box(look, left, right, -half, half)


def _both(look: str, left: float, right: float, near: float, far: float) -> list[Shape]:
    """Return a rectangle on each side of the stroke line."""
    return [box(look, left, right, side * near, side * far) for side in (-1, 1)]


def _directions(vectors: ComplexArray) -> Array:
    """Return the directions of vectors in degrees, at rest and through a turn without a jump."""
    found = np.angle(vectors)
    return np.degrees(np.append(found[:1], np.unwrap(found[1:])))


def cylinders(train: Train) -> Iterator[Body]:
    """Yield cylinders, guides, and the reciprocating parts on the stroke line."""
    if not train.is_engine:
        return
    R, level = train.mechanism.crank, 1j * train.mechanism.offset
    yield Body.of([_polygon("axis", (-1.4 * R, train.outer_end + 0.1 * R))], level)
    for barrel in train.barrels:
        yield from _chambers(train, barrel)
        yield Body.of(_walls(barrel), level)
    if train.crosshead and train.mechanism.guided and not train.has_slot:
        (near, _), (far, _) = train.sketch.guides[0]
        yield Body.of(_both("wall", near - 1.4 * SHOE * R, far + 1.2 * SHOE * R, SHOE * R, 1.25 * SHOE * R), level)
    yield Body.of(_on_the_rod(train), train.output)


def _chambers(train: Train, barrel: Barrel) -> Iterator[Body]:
    """Yield the gas or liquid at both ends of a piston, the darker the higher its pressure is."""
    gas = next((one for one in train.results.drive.gas if one.piston is barrel.piston), None)
    if gas is None:
        return
    piston, moments = train.output + barrel.shift, len(train.cycle)
    # a picture at one angle has the tints of the moving one
    angles = train.cycle if moments > 1 else np.append(train.cycle, np.arange(0.0, train.results.drive.cycle, 5.0))
    state = train.results.at(angles)
    ends = [(end, np.broadcast_to(state.pressure(end), angles.shape)) for end in (gas.crank, gas.head) if end]
    every = np.concatenate([pressure for _, pressure in ends])
    # a pump has one pressure on each stroke
    pumped = bool(gas.work < 0) and all(len(np.unique(np.round(one))) <= 2 for _, one in ends)
    shape = _strip("liquid" if pumped else "gas", 0.0, 1.0, barrel.bore / 2)
    for end, pressure in ((end, pressure[:moments]) for end, pressure in ends):
        face, turn = (barrel.low, 0.0) if end is gas.crank else (barrel.high, 180.0)
        tint = 0.08 + 0.72 * ((pressure - every.min()) / (np.ptp(every) or 1.0)) ** 0.7
        length = abs(piston.real - face) - barrel.height / 2
        yield Body.of([shape], face + 1j * train.mechanism.offset, turn, length, tint)


def _walls(barrel: Barrel) -> Iterator[Shape]:
    """Yield liner, covers and stuffing boxes of a cylinder in section."""
    half, wall, ends = barrel.bore / 2, WALL * barrel.bore, barrel.ends(COVER)
    yield from _both("wall", *ends, half, half + wall)
    for inner, cover, gland, rod in zip((barrel.low, barrel.high), ends, barrel.ends(COVER + _GLAND), barrel.rods):
        if cover != inner:
            flange = half + 1.7 * wall
            yield from _both("wall", cover, inner, rod, flange) if rod else [_strip("wall", cover, inner, flange)]
            yield from _both("wall", cover, gland, rod, rod + 1.6 * wall) if rod else ()


def _on_the_rod(train: Train) -> Iterator[Shape]:
    """Yield pistons, piston rods, and crosshead, yoke or frame, from the output of the mechanism."""
    R, (left, right) = train.mechanism.crank, train.head
    start = min(0.0, right)
    for barrel in train.barrels:
        inner, outer = barrel.rods
        yield from [_strip("rod", start, barrel.shift, inner)] if inner else ()
        tail = left
        if barrel.shift > 0:  # through the head, to the next piston or out of its stuffing box
            further = [one.shift for one in train.barrels if one.shift > barrel.shift]
            tail = min(further, default=barrel.ends(COVER + 1.6 * _GLAND)[1] - train.sketch.guides[0][0][0])
            start = barrel.shift
        yield from [_strip("rod", barrel.shift, tail, outer)] if outer else ()
    for barrel in train.barrels:
        yield from _piston(barrel)
    if train.has_slot:
        yield _strip("metal", left, right, 1.6 * R)
        yield _strip("hollow", 0.78 * left + 0.22 * right, 0.22 * left + 0.78 * right, 1.35 * R)
    elif train.has_frame:
        yield _strip("metal", left, right, 1.8 * R)
        yield _strip("hollow", left + 0.4 * R, -right, 1.55 * R)
    elif train.crosshead:
        yield _strip("metal", left, right, SHOE * R)


def _piston(barrel: Barrel) -> Iterator[Shape]:
    half, bottom, crown = barrel.bore / 2, barrel.shift - barrel.height / 2, barrel.shift + barrel.height / 2
    yield _strip("metal", bottom, crown, half)
    if barrel.trunk:
        yield _strip("hollow", bottom, crown - 0.24 * barrel.height, 0.8 * half)
    apart = min(0.06 * barrel.bore, barrel.height / 6)
    first = crown - 1.3 * apart if not barrel.closed[0] else barrel.shift + apart
    for ring in range(3):
        yield _polygon("thin", first - ring * apart + half * np.array([1j, -1j]))


def cranks(train: Train) -> Iterator[Body]:
    """Yield the crank with its counterweight, other members that turn on and on, and the bearings on the frame."""
    fixed = () if train.is_engine else train.sketch.fixed
    foot = train.journal * np.array([-0.8j, 2.6 - 2.0j, 2.6 + 2.0j, 0.8j]) * (-1.0 if train.sketch.output else -1j)
    yield from (Body.of([_polygon("wall", foot)], train.joints[name][0]) for name in fixed)
    yield Body.of(_crank(train, train.mechanism.crank), 0.0, train.motion)
    for start, end in train.sketch.links:
        if end in fixed and train.mechanism.turns:
            arm = train.joints[start] - train.joints[end]
            yield Body.of(_crank(train, float(abs(arm[0]))), train.joints[end][0], _directions(arm))


def _crank(train: Train, R: float) -> Iterator[Shape]:
    hub, eye = _HUB * train.journal, EYE * train.pin
    tangent = np.exp(math.acos(min(max((hub - eye) / R, -1.0), 1.0)) * np.array([-1j, 1j]))
    yield _polygon("web", np.append(hub * tangent, R + eye * tangent[::-1]))
    yield disc("web", eye, complex(R))
    back = train.weight * R * np.exp(1j * np.radians(np.linspace(142.0, 218.0, 11)))
    yield _polygon("web", np.concatenate((hub * np.exp([1.8j]), back, hub * np.exp([-1.8j]))))
    yield from (disc("web", hub), disc("metal", train.journal), disc("web", 0.15 * train.journal))


def members(train: Train) -> Iterator[Body]:
    """Yield the members between the joints, blocks that slide on them, and the pins in front of them."""
    pin, sketch, joints = train.pin, train.sketch, train.joints
    slotted = {link: joint for joint, link in sketch.blocks}
    for link in () if train.has_slot else sketch.links[1:]:
        start, end = (joints[name] for name in link)
        length, turn = float(abs(end - start)[0]), _directions(end - start)
        if link in slotted:
            reach = abs(joints[slotted[link]] - start)
            far = max(length, float(reach.max()) + 2.4 * pin)
            slot = _strip("hollow", float(reach.min()) - 1.8 * pin, far - 0.7 * pin, 1.05 * pin)
            yield Body.of([_strip("rod", 0.0, far, 1.9 * pin), disc("rod", 1.9 * pin), slot], start, turn)
        elif train.is_engine:
            yield Body.of(_rod(pin, length), end, turn)
        elif not (train.forked and end is train.output) and not (link[1] in sketch.fixed and train.mechanism.turns):
            yield Body.of(_bar(pin, length), start, turn)
    if sketch.output and not train.is_engine:
        yield from _ram(train)
    for joint, (first, last) in sketch.blocks:
        block = _strip("metal", -1.7 * pin, 1.7 * pin, 1.05 * pin)
        yield Body.of([block], joints[joint], _directions(joints[last] - joints[first]))
    hidden = (SHAFT, sketch.output if train.forked else "")
    for name in (PIN,) if train.has_slot else [one for one in joints if one not in hidden]:
        radius = train.journal if name in sketch.fixed else pin if name == PIN else 0.72 * pin
        moves = bool((joints[name] != joints[name][0]).any())
        yield Body.of([disc("metal", radius), disc("web", 0.15 * radius)], joints[name] if moves else joints[name][0])


def _rod(pin: float, length: float) -> Iterator[Shape]:
    """Yield a connecting rod from the pin of the piston, at 0, back to the crank pin."""
    big, small = EYE * pin, 1.15 * pin
    for look, start, end, wide, narrow in (("rod", 0.0, length, 0.8, 0.6), ("thin", small, length - big, 0.38, 0.26)):
        corners = -end - 1j * wide * pin, -start - 1j * narrow * pin, -start + 1j * narrow * pin, -end + 1j * wide * pin
        yield _polygon(look, corners)
    yield from (disc("rod", big, complex(-length)), disc("rod", small))


def _bar(pin: float, length: float) -> Iterator[Shape]:
    """Yield a member with an eye at both ends."""
    yield _strip("rod", 0.0, length, 0.62 * pin)
    yield _strip("thin", EYE * pin, length - EYE * pin, 0.26 * pin)
    yield from (disc("rod", 1.35 * pin, complex(end)) for end in (0.0, length))


def _ram(train: Train) -> Iterator[Body]:
    """Yield the ram of a shaper on its guides, with the fork in which the end of the lever slides."""
    pin, ((line, start), (_, end)) = train.pin, train.sketch.guides[0]
    under, over, stroke = 1.6 * pin, 3.8 * pin, end - start
    for at in (under - 0.5 * pin, over):
        yield Body.of([box("wall", line + at, line + at + 0.5 * pin, start - 0.35 * stroke, end + 0.25 * stroke)])
    tool = complex(2.0 * pin, 0.95 * stroke) + pin * np.array([0.0, 0.8 - 1.4j, -2.6 - 0.3j])
    shapes = [_polygon("web", tool), box("metal", under, over, -0.75 * stroke, 0.95 * stroke)]
    drop = float((train.output - train.joints["end"]).real.max()) if train.forked else 0.0
    shapes.append(box("metal", -drop - 1.8 * pin, under, -1.9 * pin, 1.9 * pin))
    if train.forked:
        shapes.append(box("hollow", -drop - 1.2 * pin, 0.9 * pin, -0.8 * pin, 0.8 * pin))
    yield Body.of(shapes, train.output)


def throw(train: Train, bore: float) -> Iterator[Body]:
    """Yield a throw of the crank with its rod from the side, the shaft along y: it seems as long as its cosine.

    bore: in m, of the narrowest cylinder of the row, by which the widths of rods and webs are drawn.
    """
    R, pin, eye, hub = train.mechanism.crank, train.pin, EYE * train.pin, _HUB * train.journal
    webs, half = (0.2 * bore, 0.34 * bore), 0.2 * bore
    high = np.cos(np.radians(train.motion))
    shortest = math.sqrt(train.mechanism.rod_length**2 - (R + abs(train.mechanism.offset)) ** 2)
    yield Body.of(_both("web", -train.weight * R, R, *webs), stretch=high)
    yield Body.of(_both("web", -hub, hub, *webs))
    yield Body.of([_strip("rod", -shortest, 0.0, 0.55 * half), _strip("rod", -pin, pin, 0.8 * half)], train.output.real)
    ends = [_strip("metal", -pin, pin, half), _strip("rod", -eye, eye, 0.8 * half), *_both("web", -eye, eye, *webs)]
    yield Body.of(ends, R * high)
