"""One cylinder as it is drawn in section: where its joints and cylinders are, and its parts as bodies that move.

Bodies are in the frame of the stroke line, which runs from the shaft along +x. Joints are where the mechanism has them;
what a file does not give follows from the crank radius, the stroke or the bore by the shares below.
"""

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.crank_angle import CrankAngle
from kurbel.machine import CYCLES, Machine
from kurbel.machine.parts import Piston
from kurbel.mechanisms import PIN, SHAFT
from kurbel.pictures.picture import MOMENTS_PER_TURN, Body, Shape
from kurbel.solver.forces import CylinderForces
from kurbel.solver.gas import PistonGas

BORE = 0.9
"""Bore relative to the stroke, if none is given."""
_CLEARANCE = 0.05  # of the stroke, between piston and cover in the dead centre
_TRUNK, _DISC, _PLUNGER = 0.9, 0.32, 0.6  # heights of pistons over the bore
WALL, _COVER, _ROD = 0.06, 0.1, 0.08  # of the bore; the last is the radius of a piston rod
_GLAND = 2.6  # length of cover and stuffing box over that of the cover
_PIN, _JOURNAL = 0.2, 0.27  # radii over the crank radius
_WEIGHT = 0.95  # radius of a counterweight over that of the crank
EYE, _HUB = 1.55, 1.45  # radii of eye and hub over those of pin and journal
SHOE = 0.36  # half the length and height of a crosshead over the crank radius


class Barrel(NamedTuple):
    """A cylinder with its piston; lengths in m along the stroke line from the shaft, toward it and away from it.

    gas: what is in it, if there is an indicator; shift: from the output of the mechanism to the middle of the piston;
    faces: inner ends; covers: outer faces of the covers, where it is open the inner end; rods: radii of the piston rods
    through the ends, both 0 of a trunk piston.
    """

    gas: PistonGas | None
    bore: float
    height: float
    shift: float
    faces: tuple[float, float]
    covers: tuple[float, float]
    rods: tuple[float, float]

    @property
    def glands(self) -> list[float]:
        """Outer ends of the stuffing boxes."""
        return [face + _GLAND * (cover - face) for face, cover in zip(self.faces, self.covers)]


class Train:
    """One cylinder at crank angles of its own in degrees, (1,) or (1 + m,): at rest, then over its working cycle.

    motion: the angles of one turn, after which it moves alike; angle: from the stroke line of cylinder 1 to its own,
    in degrees. R: crank radius; pin, journal, weight: radii of these and of the counterweight; yoke: half the height of
    a yoke on the piston rod, in whose slot the crank pin slides, or of a frame that holds rod and crank within, or 0;
    all in m. is_engine: whether a piston reciprocates on the stroke line; crosshead: whether there is one, or a yoke;
    forked: whether the end of a lever slides in a fork of what it drives.
    """

    def __init__(
        self, machine: Machine, results: CylinderForces, degrees: Array, alone: bool
    ) -> None:
        self.results, self.cylinder, mechanism = (
            results,
            results.drive.cylinder,
            results.drive.mechanism,
        )
        own = degrees if alone else degrees - results.drive.lag
        self.cycle = own[: 1 + MOMENTS_PER_TURN * CYCLES[machine.cycle_of(self.cylinder)]]
        self.motion = own[: 1 + MOMENTS_PER_TURN]
        self.angle = 0.0 if alone else self.cylinder.bank_angle
        sketch = mechanism.sketch(CrankAngle.of(self.motion))
        assert sketch is not None
        self.mechanism, self.sketch = mechanism, sketch
        self.joints: dict[str, ComplexArray] = {
            name: np.atleast_1d(np.asarray(x) + 1j * np.asarray(y))
            for name, (x, y) in sketch.joints.items()
        }
        self.R, shaft = mechanism.crank, machine.crankshaft
        self.pin = shaft.pin_diameter / 2 if shaft else _PIN * self.R
        self.journal = (
            shaft.journal_diameter / 2 if shaft and shaft.journal_diameter else _JOURNAL * self.R
        )
        self.has_counterweight = bool(machine.counterweights or self.cylinder.counterweights)
        hub = _HUB * self.journal
        self.weight = max(_WEIGHT * self.R, hub) if self.has_counterweight else hub

        self.is_engine = bool(mechanism.slides) and not mechanism.quick_return
        self.has_slot = self.is_engine and bool(sketch.blocks)
        framed = self.is_engine and not mechanism.guided
        self.yoke = self.R * (1.6 if self.has_slot else 1.8 if framed else 0.0)
        masses, pistons = self.cylinder.masses, self.cylinder.pistons
        piston_rod = any(
            piston.crank_end_rod or "crank_end" in piston.chambers for piston in pistons
        )
        self.crosshead = bool(
            self.yoke or piston_rod or machine.locomotive or (masses and masses.crosshead)
        )
        lever = self.joints[sketch.links[-1][0]]
        self.forked = (
            bool(sketch.output)
            and not self.is_engine
            and np.allclose((self.output - lever).imag, 0.0)
        )

    @property
    def output(self) -> ComplexArray:
        """Where the crosshead, or the pin of a trunk piston, is."""
        return self.joints[self.sketch.output]

    @property
    def outer_end(self) -> float:
        """Outer end of the outermost cylinder on the stroke line, in m."""
        return max([self.R, *(barrel.covers[1] for barrel in self.barrels)])

    @property
    def head(self) -> tuple[float, float]:
        """How far what is on the piston rod at the crosshead reaches from the output, toward the shaft and outward."""
        half, slot = SHOE * self.R, float((self.joints[PIN] - self.output).real[0])
        if self.has_slot:
            return slot - half, slot + half
        return (-self.mechanism.rod_length - 2.6 * self.R if self.yoke else -half), half

    @cached_property
    def barrels(self) -> tuple[Barrel, ...]:
        """The cylinders on the piston rod; those of a yoke or frame after the first are on the side of the shaft."""
        if not self.is_engine:
            return ()
        (near, _), (far, _) = self.sketch.guides[0]
        inner, outer = near + self.head[0], far + self.head[1]  # of what is on the rod already
        stroke, found, every = self.mechanism.stroke, list[Barrel](), self.results.drive.gas
        for piston in self.cylinder.pistons or (Piston(BORE * stroke),):
            if piston.lever_ratio != 1:
                continue
            gas, bore = next((one for one in every if one.piston is piston), None), piston.bore
            closed, topped = (bool(gas.crank), bool(gas.head)) if gas else (self.crosshead, True)
            trunk = not found and not self.crosshead
            height = (_TRUNK if trunk else _DISC if closed else _PLUNGER) * bore
            gaps = (
                [volume / area for volume, area in zip(gas.clearance_volumes, gas.areas)]
                if gas
                else [0.0, 0.0]
            )
            above, below = (height / 2 + (gap or _CLEARANCE * stroke) for gap in gaps)
            below = below if closed else 0.28 * height  # a liner that is open ends above the skirt
            room = 0.12 * self.R + _GLAND * _COVER * bore
            rods = piston.crank_end_rod / 2, piston.head_end_rod / 2
            if trunk:
                shift, rods = 0.08 * height, (0.0, 0.0)
            elif found and self.yoke:
                shift, rods = inner - room - above - far, (0.0, max(rods) or _ROD * bore)
            else:
                shift, rods = outer + room + below - near, (rods[0] or _ROD * bore, rods[1])
            faces = near + shift - below, far + shift + above
            covers = faces[0] - _COVER * bore * closed, faces[1] + _COVER * bore * topped
            found.append(Barrel(gas, bore, height, shift, faces, covers, rods))
            inner, outer = min(inner, found[-1].glands[0]), max(outer, found[-1].glands[1])
        return tuple(found)

    def is_crank(self, link: tuple[str, ...]) -> bool:
        """Whether a member from a pin to the frame turns on and on as the crank does."""
        return bool(self.mechanism.turns) and link[1] in self.sketch.fixed


# shapes


def _polygon(look: str, *corners: complex) -> Shape:
    return Shape(look, np.array(corners, dtype=complex))


def box(look: str, left: float, right: float, top: float, bottom: float | None = None) -> Shape:
    """Return a rectangle, on the stroke line if its bottom is not given."""
    low, high = 1j * (-top if bottom is None else bottom), 1j * top
    return _polygon(look, left + low, right + low, right + high, left + high)


def disc(look: str, radius: float, middle: complex = 0.0) -> Shape:
    """Return a circle."""
    return _polygon(look, middle)._replace(radius=radius)


def _both(look: str, left: float, right: float, near: float, far: float) -> list[Shape]:
    """Return a rectangle on each side of the stroke line."""
    return [box(look, left, right, side * near, side * far) for side in (-1, 1)]


def _directions(vectors: ComplexArray) -> Array:
    """Return the directions of vectors in degrees, at rest and through a turn without a jump."""
    found = np.angle(vectors)
    return np.degrees(np.append(found[:1], np.unwrap(found[1:])))


# cylinders and what reciprocates in them


def cylinders(train: Train) -> Iterator[Body]:
    """Yield cylinders, guides, and the reciprocating parts on the stroke line."""
    if not train.is_engine:
        return
    R, level = train.R, 1j * train.mechanism.offset
    yield Body.of([_polygon("axis", -1.4 * R, train.outer_end + 0.1 * R)], level)
    for barrel in train.barrels:
        yield from _chambers(train, barrel)
        yield Body.of(_walls(barrel), level)
    if train.crosshead and not train.yoke:
        (near, _), (far, _) = train.sketch.guides[0]
        yield Body.of(
            _both("wall", near - 1.4 * SHOE * R, far + 1.2 * SHOE * R, SHOE * R, 1.25 * SHOE * R),
            level,
        )
    yield Body.of(_on_the_rod(train), train.output)


def _chambers(train: Train, barrel: Barrel) -> Iterator[Body]:
    """Yield the gas or liquid at both ends of a piston, the darker the higher its pressure is."""
    gas = barrel.gas
    if gas is None:
        return
    # a picture at one angle has the tints of the moving one
    angles = np.append(train.cycle, np.arange(0.0, train.results.drive.cycle, 5.0))
    state, ends = (
        train.results.at(angles),
        [*zip((gas.crank, gas.head), barrel.faces, (0.0, 180.0))],
    )
    pressures = np.array(
        [np.broadcast_to(state.pressure(end), angles.shape) for end, _, _ in ends if end]
    )
    # a pump has one pressure on each stroke
    pumped = bool(gas.work < 0) and all(
        len(set(np.round(pressure).tolist())) <= 2 for pressure in pressures
    )
    tints = 0.08 + 0.72 * ((pressures - pressures.min()) / (np.ptp(pressures) or 1.0)) ** 0.7
    shape = box("liquid" if pumped else "gas", 0.0, 1.0, barrel.bore / 2)
    for (face, turn), tint in zip(
        [one[1:] for one in ends if one[0]], tints[:, : len(train.cycle)]
    ):
        length = abs(train.output.real + barrel.shift - face) - barrel.height / 2
        yield Body.of([shape], face + 1j * train.mechanism.offset, turn, length, tint)


def _walls(barrel: Barrel) -> Iterator[Shape]:
    """Yield liner, covers and stuffing boxes of a cylinder in section; rods are in front of them."""
    half, wall = barrel.bore / 2, WALL * barrel.bore
    yield from _both("wall", *barrel.covers, half, half + wall)
    for face, cover, gland, rod in zip(barrel.faces, barrel.covers, barrel.glands, barrel.rods):
        if cover != face:
            yield box("wall", cover, face, half + 1.7 * wall)
            yield from [box("wall", cover, gland, rod + 1.6 * wall)] if rod else ()


def _on_the_rod(train: Train) -> Iterator[Shape]:
    """Yield piston rods, pistons, and crosshead, yoke or frame, from the output of the mechanism."""
    R, (left, right), start = train.R, train.head, train.head[0]
    (near, _), _ = train.sketch.guides[0]
    for barrel in train.barrels:
        inner, outer = barrel.rods
        if barrel.shift < 0:
            yield box("rod", barrel.shift, left, outer)
            continue
        yield from [box("rod", start, barrel.shift, inner)] if inner else ()
        start = barrel.shift
        if outer:  # out of its stuffing box
            yield box("rod", start, barrel.glands[1] + 0.1 * barrel.bore - near, outer)
    for barrel in train.barrels:
        yield from _piston(barrel)
    if train.crosshead:
        yield box("metal", left, right, train.yoke or SHOE * R)
    if train.yoke:  # the pin of a rod is on solid ground
        yield box(
            "hollow",
            left + 0.15 * R,
            right - 0.15 * R if train.has_slot else -right,
            train.yoke - 0.2 * R,
        )


def _piston(barrel: Barrel) -> Iterator[Shape]:
    """Yield a piston with three rings, a trunk piston with its inside."""
    half, bottom, crown = (
        barrel.bore / 2,
        barrel.shift - barrel.height / 2,
        barrel.shift + barrel.height / 2,
    )
    yield box("metal", bottom, crown, half)
    if not any(barrel.rods):
        yield box("hollow", bottom, crown - 0.24 * barrel.height, 0.8 * half)
    apart = min(0.06 * barrel.bore, barrel.height / 6)
    first = crown - 1.3 * apart if barrel.covers[0] == barrel.faces[0] else barrel.shift + apart
    for place in (first, first - apart, first - 2 * apart):
        yield _polygon("thin", place - 1j * half, place + 1j * half)


# cranks and members


def cranks(train: Train) -> Iterator[Body]:
    """Yield the bearings on the frame, and what turns on and on with its counterweight."""
    sketch, joints = train.sketch, train.joints
    foot = (
        train.journal
        * np.array([-0.8j, 2.6 - 2.0j, 2.6 + 2.0j, 0.8j])
        * (-1.0 if sketch.output else -1j)
    )
    for name in () if train.is_engine else sketch.fixed:
        yield Body.of([_polygon("wall", *foot)], joints[name][0])
    for tip, centre in ((PIN, SHAFT), *filter(train.is_crank, sketch.links)):
        arm = joints[tip] - joints[centre]
        yield Body.of(_crank(train, float(abs(arm[0]))), joints[centre][0], _directions(arm))


def _crank(train: Train, R: float) -> Iterator[Shape]:
    """Yield a web with the counterweight that the file gives it, hub and eye."""
    hub, eye, around = (
        _HUB * train.journal,
        EYE * train.pin,
        np.radians(np.linspace(142.0, 218.0, 11)),
    )
    yield _polygon("web", hub * -1j, R - eye * 1j, R + eye * 1j, hub * 1j)
    if train.has_counterweight:
        yield _polygon("web", hub * 1j, *train.weight * np.exp(1j * around), hub * -1j)
    yield from (
        disc("web", eye, R),
        disc("web", hub),
        disc("metal", train.journal),
        disc("web", 0.15 * train.journal),
    )


def members(train: Train) -> Iterator[Body]:
    """Yield the members between the joints, blocks that slide on them, and the pins in front of them."""
    pin, sketch, joints = train.pin, train.sketch, train.joints
    slotted = {link: joints[joint] for joint, link in sketch.blocks}
    for link in sketch.links[1:]:
        start, end = (joints[name] for name in link)
        length, turn = float(abs(end - start)[0]), _directions(end - start)
        if link in slotted:
            reach = abs(slotted[link] - start)
            far = max(length, float(reach.max()) + 2.4 * pin)
            slot = box("hollow", float(reach.min()) - 1.8 * pin, far - 0.7 * pin, 1.05 * pin)
            if not train.has_slot:
                yield Body.of(
                    [box("rod", 0.0, far, 1.9 * pin), disc("rod", 1.9 * pin), slot], start, turn
                )
            yield Body.of([box("metal", -1.7 * pin, 1.7 * pin, 1.05 * pin)], slotted[link], turn)
        elif not (
            train.has_slot or train.is_crank(link) or (train.forked and link[1] == sketch.output)
        ):
            inside = box("thin", EYE * pin, length - EYE * pin, 0.28 * pin)
            eyes = disc("rod", EYE * pin), disc("rod", 1.25 * pin, length)
            yield Body.of([box("rod", 0.0, length, 0.65 * pin), inside, *eyes], start, turn)
    if sketch.output and not train.is_engine:
        yield from _ram(train)
    hidden = (SHAFT, sketch.output if train.forked else "")
    for name in (PIN,) if train.has_slot else [one for one in joints if one not in hidden]:
        yield Body.of([disc("metal", 0.9 * pin), disc("web", 0.15 * pin)], joints[name])


def _ram(train: Train) -> Iterator[Body]:
    """Yield the ram of a shaper between its guides, with a tool, and what hangs down to the lever, a fork or an eye."""
    pin, ((line, start), (_, end)) = train.pin, train.sketch.guides[0]
    under, over, stroke = 1.6 * pin, 3.8 * pin, end - start
    for at in (under - 0.5 * pin, over):
        yield Body.of(
            [
                box(
                    "wall",
                    line + at,
                    line + at + 0.5 * pin,
                    start - 0.35 * stroke,
                    end + 0.25 * stroke,
                )
            ]
        )
    lever = train.joints[train.sketch.links[-1][0]]
    low = -float((train.output - lever).real.max()) if train.forked else 0.0
    tool = complex(2.0 * pin, 0.95 * stroke) + pin * np.array([0.0, 0.8 - 1.4j, -2.6 - 0.3j])
    shapes = [_polygon("web", *tool), box("metal", under, over, -0.75 * stroke, 0.95 * stroke)]
    shapes.append(box("metal", low - 1.8 * pin, under, 1.9 * pin))
    if train.forked:
        shapes.append(box("hollow", low - 1.2 * pin, 0.9 * pin, 0.8 * pin))
    yield Body.of(shapes, train.output)


def throw(train: Train, bore: float) -> Iterator[Body]:
    """Yield a throw of the crank with its rod from the side, the shaft along y: it seems as long as its cosine.

    bore: in m, of the narrowest cylinder of the row, by which the widths of rods and webs are drawn.
    """
    R, pin, eye, hub, half = train.R, train.pin, EYE * train.pin, _HUB * train.journal, 0.2 * bore
    webs, high = (0.2 * bore, 0.34 * bore), np.cos(np.radians(train.motion))
    yield Body.of(_both("web", -train.weight, R, *webs), stretch=high)
    yield Body.of(_both("web", -hub, hub, *webs))
    # its end is hidden by the eye
    rod = (
        box("rod", -train.mechanism.rod_length, 0.0, 0.55 * half),
        box("rod", -pin, pin, 0.8 * half),
    )
    yield Body.of(rod, train.output.real)
    ends = [
        box("metal", -pin, pin, half),
        box("rod", -eye, eye, 0.8 * half),
        *_both("web", -eye, eye, *webs),
    ]
    yield Body.of(ends, R * high)
