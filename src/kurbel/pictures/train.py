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
        self.results = results
        self.cylinder = results.drive.cylinder
        self.mechanism = results.drive.mechanism
        crank_angles = degrees if alone else degrees - results.drive.lag
        turns = CYCLES[machine.cycle_of(self.cylinder)]
        self.cycle = crank_angles[: 1 + MOMENTS_PER_TURN * turns]
        self.motion = crank_angles[: 1 + MOMENTS_PER_TURN]
        self.angle = 0.0 if alone else self.cylinder.bank_angle
        sketch = self.mechanism.sketch(CrankAngle.of(self.motion))
        assert sketch is not None
        self.sketch = sketch
        self.joints: dict[str, ComplexArray] = {
            name: np.atleast_1d(np.asarray(x) + 1j * np.asarray(y))
            for name, (x, y) in sketch.joints.items()
        }

        # radii of crank, pin, journal and counterweight
        shaft = machine.crankshaft
        self.R = self.mechanism.crank
        self.pin = shaft.pin_diameter / 2 if shaft else _PIN * self.R
        self.journal = _JOURNAL * self.R
        if shaft and shaft.journal_diameter:
            self.journal = shaft.journal_diameter / 2
        self.has_counterweight = bool(machine.counterweights or self.cylinder.counterweights)
        hub = _HUB * self.journal
        self.weight = max(_WEIGHT * self.R, hub) if self.has_counterweight else hub

        # what kind of engine it is
        is_linkage = self.mechanism.quick_return or self.mechanism.swings_cylinder
        self.is_engine = bool(self.mechanism.slides) and not is_linkage
        self.has_slot = self.is_engine and bool(sketch.blocks)
        self.yoke = 0.0
        if self.has_slot:
            self.yoke = 1.6 * self.R
        elif self.is_engine and not self.mechanism.guided:
            self.yoke = 1.8 * self.R
        has_crosshead_mass = bool(self.cylinder.masses and self.cylinder.masses.crosshead)
        self.crosshead = bool(
            self.yoke or self._has_piston_rod or machine.locomotive or has_crosshead_mass
        )
        self.forked = False
        if sketch.output and not self.is_engine:
            lever = self.joints[sketch.links[-1][0]]
            self.forked = bool(np.allclose((self.output - lever).imag, 0.0))

    @property
    def _has_piston_rod(self) -> bool:
        """Whether a rod goes through the cover on the side of the shaft."""
        return any(
            piston.crank_end_rod or "crank_end" in piston.chambers
            for piston in self.cylinder.pistons
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
        half = SHOE * self.R
        if self.has_slot:
            slot = float((self.joints[PIN] - self.output).real[0])
            return slot - half, slot + half
        if self.yoke:
            return -self.mechanism.rod_length - 2.6 * self.R, half
        return -half, half

    @cached_property
    def barrels(self) -> tuple[Barrel, ...]:
        """The cylinders on the piston rod; those of a yoke or frame after the first are on the side of the shaft."""
        if not self.is_engine:
            return ()
        (near, _), (far, _) = self.sketch.guides[0]
        # the ends of what is on the rod already
        inner, outer = near + self.head[0], far + self.head[1]
        barrels = list[Barrel]()
        for piston in self.results.drive.pistons or (Piston(BORE * self.mechanism.stroke),):
            if piston.lever_ratio != 1:
                continue
            barrel = self._barrel(piston, inner, outer, is_first=not barrels)
            barrels.append(barrel)
            inner, outer = min(inner, barrel.glands[0]), max(outer, barrel.glands[1])
        return tuple(barrels)

    def _barrel(self, piston: Piston, inner: float, outer: float, is_first: bool) -> Barrel:
        """Return the cylinder of a piston, next to what reaches from `inner` to `outer` on the rod."""
        (near, _), (far, _) = self.sketch.guides[0]
        bore = piston.bore
        gas = next((gas for gas in self.results.drive.gas if gas.piston is piston), None)
        has_cover_below = bool(gas.crank) if gas else self.crosshead
        has_cover_above = bool(gas.head) if gas else True
        is_trunk = is_first and not self.crosshead

        # the piston, and its gaps to the covers in the dead centres
        share = _DISC if has_cover_below else _PLUNGER
        height = (_TRUNK if is_trunk else share) * bore
        gaps = [0.0, 0.0]
        if gas:
            gaps = [float(volume / area) for volume, area in zip(gas.clearance_volumes, gas.areas)]
        least = _CLEARANCE * self.mechanism.stroke
        above, below = (height / 2 + (gap or least) for gap in gaps)
        if not has_cover_below:  # a liner that is open ends above the skirt
            below = 0.28 * height

        # where it is on the rod, and radii of the rods to its sides
        room = 0.12 * self.R + _GLAND * _COVER * bore
        crank_end_rod, head_end_rod = piston.crank_end_rod / 2, piston.head_end_rod / 2
        if is_trunk:
            shift, rods = 0.08 * height, (0.0, 0.0)
        elif not is_first and self.yoke:
            shift = inner - room - above - far
            rods = (0.0, max(crank_end_rod, head_end_rod) or _ROD * bore)
        else:
            shift = outer + room + below - near
            rods = (crank_end_rod or _ROD * bore, head_end_rod)
        faces = near + shift - below, far + shift + above
        covers = (
            faces[0] - _COVER * bore * has_cover_below,
            faces[1] + _COVER * bore * has_cover_above,
        )
        return Barrel(gas, bore, height, shift, faces, covers, rods)

    def is_crank(self, link: tuple[str, ...]) -> bool:
        """Whether a member from a pin to the frame turns on and on as the crank does."""
        return bool(self.mechanism.turns) and link[1] in self.sketch.fixed


# shapes


def _polygon(look: str, *corners: complex) -> Shape:
    return Shape(look, np.array(corners, dtype=complex))


def box(look: str, left: float, right: float, top: float, bottom: float | None = None) -> Shape:
    """Return a rectangle, on the stroke line if its bottom is not given."""
    low = 1j * (-top if bottom is None else bottom)
    high = 1j * top
    return _polygon(look, left + low, right + low, right + high, left + high)


def disc(look: str, radius: float, middle: complex = 0.0) -> Shape:
    """Return a circle."""
    return _polygon(look, middle)._replace(radius=radius)


def _both(look: str, left: float, right: float, near: float, far: float) -> list[Shape]:
    """Return a rectangle on each side of the stroke line."""
    return [box(look, left, right, side * near, side * far) for side in (-1, 1)]


def _directions(vectors: ComplexArray) -> Array:
    """Return the directions of vectors in degrees, at rest and through a turn without a jump."""
    angles = np.angle(vectors)
    return np.degrees(np.append(angles[:1], np.unwrap(angles[1:])))


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
    state = train.results.at(angles)
    faces, pressures = list[tuple[float, float]](), []
    for end, face, turn in zip((gas.crank, gas.head), barrel.faces, (0.0, 180.0)):
        if end:
            faces.append((face, turn))
            pressures.append(np.broadcast_to(state.pressure(end), angles.shape))

    # a pump has one pressure on each stroke
    levels = [set(np.round(pressure).tolist()) for pressure in pressures]
    is_pump = bool(gas.work < 0) and all(len(values) <= 2 for values in levels)
    shape = box("liquid" if is_pump else "gas", 0.0, 1.0, barrel.bore / 2)
    rise = np.array(pressures) - np.min(pressures)
    tints = 0.08 + 0.72 * (rise / (np.ptp(pressures) or 1.0)) ** 0.7
    for (face, turn), tint in zip(faces, tints[:, : len(train.cycle)]):
        length = abs(train.output.real + barrel.shift - face) - barrel.height / 2
        yield Body.of([shape], face + 1j * train.mechanism.offset, turn, length, tint)


def _walls(barrel: Barrel) -> Iterator[Shape]:
    """Yield liner, covers and stuffing boxes of a cylinder in section; rods are in front of them."""
    half, wall = barrel.bore / 2, WALL * barrel.bore
    yield from _both("wall", *barrel.covers, half, half + wall)
    for face, cover, gland, rod in zip(barrel.faces, barrel.covers, barrel.glands, barrel.rods):
        if cover != face:
            yield box("wall", cover, face, half + 1.7 * wall)
            if rod:
                yield box("wall", cover, gland, rod + 1.6 * wall)


def _on_the_rod(train: Train) -> Iterator[Shape]:
    """Yield piston rods, pistons, and crosshead, yoke or frame, from the output of the mechanism."""
    R, (left, right) = train.R, train.head
    (near, _), _ = train.sketch.guides[0]
    start = left
    for barrel in train.barrels:
        inner, outer = barrel.rods
        if barrel.shift < 0:
            yield box("rod", barrel.shift, left, outer)
            continue
        if inner:
            yield box("rod", start, barrel.shift, inner)
        start = barrel.shift
        if outer:  # out of its stuffing box
            yield box("rod", start, barrel.glands[1] + 0.1 * barrel.bore - near, outer)
    for barrel in train.barrels:
        yield from _piston(barrel)
    if train.crosshead:
        yield box("metal", left, right, train.yoke or SHOE * R)
    if train.yoke:  # the pin of a rod is on solid ground
        end = right - 0.15 * R if train.has_slot else -right
        yield box("hollow", left + 0.15 * R, end, train.yoke - 0.2 * R)


def _piston(barrel: Barrel) -> Iterator[Shape]:
    """Yield a piston with three rings, a trunk piston with its inside."""
    half = barrel.bore / 2
    bottom = barrel.shift - barrel.height / 2
    crown = barrel.shift + barrel.height / 2
    yield box("metal", bottom, crown, half)
    if not any(barrel.rods):
        yield box("hollow", bottom, crown - 0.24 * barrel.height, 0.8 * half)
    spacing = min(0.06 * barrel.bore, barrel.height / 6)
    is_open_below = barrel.covers[0] == barrel.faces[0]
    first = crown - 1.3 * spacing if is_open_below else barrel.shift + spacing
    for ring in (first, first - spacing, first - 2 * spacing):
        yield _polygon("thin", ring - 1j * half, ring + 1j * half)


# cranks and members


def cranks(train: Train) -> Iterator[Body]:
    """Yield the bearings on the frame, and what turns on and on with its counterweight."""
    sketch, joints = train.sketch, train.joints
    if not train.is_engine:
        # a ram, and a cylinder that swings, are drawn on the page a right angle further on
        turn = -1.0 if sketch.output or train.mechanism.swings_cylinder else -1j
        foot = train.journal * turn * np.array([-0.8j, 2.6 - 2.0j, 2.6 + 2.0j, 0.8j])
        for name in sketch.fixed:
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
    swinging = _swinging(train) if train.mechanism.swings_cylinder else ()
    blocks = {link: joints[joint] for joint, link in sketch.blocks}
    for link in sketch.links[1:]:
        start, end = (joints[name] for name in link)
        if link in blocks:
            yield from _slotted(train, start, end, blocks[link])
        elif not _is_hidden(train, link):
            yield _rod(pin, start, end)
    if sketch.output and not train.is_engine:
        yield from _ram(train)
    yield from swinging

    # pins: of a yoke only that of the crank
    no_pins = [SHAFT]
    if train.forked:
        no_pins.append(sketch.output)
    if train.mechanism.swings_cylinder:
        no_pins.append("piston")
    with_pins = [PIN] if train.has_slot else [name for name in joints if name not in no_pins]
    for name in with_pins:
        yield Body.of([disc("metal", 0.9 * pin), disc("web", 0.15 * pin)], joints[name])


def _swinging(train: Train) -> Iterator[Body]:
    """Yield a cylinder that swings about its trunnions, and the piston in it."""
    R, joints = train.R, train.joints
    pistons = train.cylinder.pistons
    bore = pistons[0].bore if pistons else BORE * train.mechanism.stroke
    half, wall, height = bore / 2, WALL * bore, _PLUNGER * bore
    along = joints["trunnion"] - joints[PIN]
    turn = _directions(along)
    # the piston moves by a crank to both sides of the trunnions
    head = R + height / 2 + _CLEARANCE * train.mechanism.stroke
    foot = -R - height / 2
    walls = [
        *_both("wall", foot, head, half, half + wall),
        box("wall", head, head + wall, half + wall),
    ]
    yield Body.of(walls, joints["trunnion"], turn)
    piston = [box("metal", -height / 2, height / 2, half)]
    yield Body.of(piston, joints["piston"], turn)


def _is_hidden(train: Train, link: tuple[str, ...]) -> bool:
    """Return whether a link is no member of its own: a crank, a part of a yoke, or the fork of a ram."""
    is_fork = train.forked and link[1] == train.sketch.output
    return train.has_slot or train.is_crank(link) or is_fork


def _rod(pin: float, start: ComplexArray, end: ComplexArray) -> Body:
    """Return a rod with an eye at each joint."""
    length = float(abs(end - start)[0])
    shapes = [
        box("rod", 0.0, length, 0.65 * pin),
        box("thin", EYE * pin, length - EYE * pin, 0.28 * pin),
        disc("rod", EYE * pin),
        disc("rod", 1.25 * pin, length),
    ]
    return Body.of(shapes, start, _directions(end - start))


def _slotted(
    train: Train, start: ComplexArray, end: ComplexArray, block: ComplexArray
) -> Iterator[Body]:
    """Yield a lever with a slot, and the block in it; the slot of a yoke is drawn with the yoke."""
    pin, turn = train.pin, _directions(end - start)
    reach = abs(block - start)
    if not train.has_slot:
        far = max(float(abs(end - start)[0]), float(reach.max()) + 2.4 * pin)
        slot = box("hollow", float(reach.min()) - 1.8 * pin, far - 0.7 * pin, 1.05 * pin)
        lever = [box("rod", 0.0, far, 1.9 * pin), disc("rod", 1.9 * pin), slot]
        yield Body.of(lever, start, turn)
    yield Body.of([box("metal", -1.7 * pin, 1.7 * pin, 1.05 * pin)], block, turn)


def _ram(train: Train) -> Iterator[Body]:
    """Yield the ram of a shaper between its guides, with a tool, and what hangs down to the lever, a fork or an eye."""
    pin, ((line, start), (_, end)) = train.pin, train.sketch.guides[0]
    under, over = 1.6 * pin, 3.8 * pin
    stroke = end - start
    left, right = start - 0.35 * stroke, end + 0.25 * stroke
    for edge in (line + under - 0.5 * pin, line + over):
        yield Body.of([box("wall", edge, edge + 0.5 * pin, left, right)])

    lever = train.joints[train.sketch.links[-1][0]]
    low = -float((train.output - lever).real.max()) if train.forked else 0.0
    tool = complex(2.0 * pin, 0.95 * stroke) + pin * np.array([0.0, 0.8 - 1.4j, -2.6 - 0.3j])
    shapes = [
        _polygon("web", *tool),
        box("metal", under, over, -0.75 * stroke, 0.95 * stroke),
        box("metal", low - 1.8 * pin, under, 1.9 * pin),
    ]
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
