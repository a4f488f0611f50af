"""The machine in section, to scale and moving: seen along the shaft, and from the side where cylinders are in a row.

Bodies are made in the frame of their stroke line, which runs from the shaft along +x, and are then turned as the
machine stands. Joints are where the mechanism has them. What a file does not give follows from the crank radius, the
stroke or the bore by fixed shares.
"""

import math
from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.crank_angle import CrankAngle
from kurbel.machine import CYCLES, Machine
from kurbel.machine.parts import Piston
from kurbel.mechanisms import PIN, SHAFT, Sketch
from kurbel.report.picture import MOMENTS_PER_TURN, Axis, Body, Curve, Note, Panel, Shape, Words
from kurbel.report.picture_source import PHI, Source
from kurbel.solver.forces import CylinderForces

_STILL = 60.0
"""Crank angle in degrees at which a machine is shown at rest where nothing pushes it."""
_LONGEST = 1.1
"""Length of the arrow of the largest force over the crank radius."""
_MOST_IN_A_ROW = 16
_LETTERS = 50.0, 33.0
"""How many letters a picture is wide and high."""
_LEVEL = 0.1
"""Sine of the inclination below which a machine is a horizontal one."""

# shares by which parts are drawn whose size is not given
_BORE = 0.9  # of the stroke
_CLEARANCE = 0.05  # of the stroke, between piston and cover in the dead centre
_TRUNK, _DISC, _PLUNGER = 0.9, 0.32, 0.6  # height of a piston over the bore
_WALL, _COVER, _GLAND, _ROD = 0.06, 0.1, 0.16, 0.08  # of the bore; the last is the radius of a piston rod
_PIN, _JOURNAL, _WEIGHT, _WHEEL = 0.2, 0.27, 0.95, 2.2  # radii over the crank radius
_EYE = 1.55  # radius of the eye round a pin over that of the pin
_PITCH = 1.35  # distance of cylinders in a row over the widest bore
_SHOE = 0.36  # half the length and height of a crosshead over the crank radius


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
        self.crosshead = piston_rod or bool(masses and masses.crosshead) or machine.locomotive is not None

    @property
    def weight(self) -> float:
        """Radius of the counterweight over that of the crank, larger where some are given."""
        return _WEIGHT if self.machine.counterweights or self.cylinder.counterweights else 0.8 * _WEIGHT

    @property
    def is_engine(self) -> bool:
        """Whether a piston goes to and fro on the stroke line."""
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
    def head(self) -> tuple[float, float]:
        """How far what is on the piston rod at the crosshead reaches from the output, toward the shaft and outward."""
        R, slot = self.mechanism.crank, float((self.joints[PIN] - self.output).real[0])
        if self.has_slot:
            return slot - _SHOE * R, slot + _SHOE * R
        return (-self.mechanism.rod_length - 2.6 * R if self.has_frame else -_SHOE * R), _SHOE * R

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
                reach = found[-1].ends(_COVER + _GLAND)
                ends = (ends[0], reach[1]) if outward else (reach[0], ends[1])
        return tuple(found)

    def _barrel(
        self, piston: Piston | None, number: int, near: float, far: float, start: float, outward: bool
    ) -> Barrel:
        """Return a cylinder that begins beyond a place in m; outward: away from the shaft."""
        R, stroke = self.mechanism.crank, self.mechanism.stroke
        bore = piston.bore if piston else _BORE * stroke
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
        room = 0.12 * R + (_COVER + _GLAND) * bore
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


def mechanism(source: Source) -> Iterator[Panel]:
    """The machine in section, gas and liquid tinted by their pressure; of one cylinder also the forces, as arrows."""
    case, cylinders = source.results
    if not cylinders or any(one.drive.mechanism.sketch(CrankAngle.of(0.0)) is None for one in cylinders):
        return
    shown, alone = [np.array([float(one)]) for one in source.angles or ()], len(cylinders) == 1
    if source.angles is None:
        turning = np.arange(MOMENTS_PER_TURN * case.machine.revolutions) * (360.0 / MOMENTS_PER_TURN)
        shown = [np.append(_rest(cylinders[0], alone), turning)]
    for degrees in shown:
        trains = [Train(case.machine, one, degrees, alone) for one in cylinders]
        title = f"φ = {round(float(degrees[0]), 2 if source.angles is None else 6):.9g}°"
        yield _panel(case.machine, trains)._replace(title=title)


def _rest(first: CylinderForces, alone: bool) -> float:
    """Return the crank angle of the largest tangential force of the first cylinder."""
    marks = Source(first, None).marks("T", lambda angle: angle)
    return marks[0].x + (0.0 if alone else first.drive.cylinder.crank_position) if marks else _STILL


# the views


def _panel(machine: Machine, trains: Sequence[Train]) -> Panel:
    angle, mirrored = _standing(trains), machine.rotation == "under"
    front = list({round(one.angle % 360.0, 6): one for one in reversed(trains)}.values())[::-1]
    R = trains[0].mechanism.crank
    along = [*_wheel(machine, R), Body.of([_disc("axis", R)])]
    # the first cylinder is in front, and a yoke in front of its crank
    for parts in (_web, _engine, _links) if trains[0].has_slot else (_engine, _web, _links):
        along += [body.seen(one.angle) for one in reversed(front) for body in parts(one)]
    along = [body.seen(angle, mirrored) for body in along]

    row, notes = _row(trains), list[Note]()
    if row:
        along, notes = _with_side(machine, along, row, level=abs(math.sin(math.radians(angle))) < _LEVEL)
    elif len(trains) > 1:
        left, right, bottom, top = _bounds(along)
        em = _em(right - left, top - bottom)
        notes = [_number(one, trains.index(one) + 1, angle, mirrored, em) for one in front]
    arrows = tuple(_arrows(trains[0], angle, mirrored)) if len(trains) == 1 else ()
    axis, said = Axis(Words(""), "length"), _footnote(machine, trains, row)
    if arrows:  # which need room for their names
        ends = np.concatenate([one.x.ravel() for one in arrows])
        axis = axis._replace(low=ends.min() - 0.4 * R, high=ends.max() + 0.4 * R)
    return Panel(
        axis,
        axis._replace(low=None, high=None),
        arrows,
        equal=True,
        plain=True,
        bodies=tuple(along),
        notes=tuple(notes),
        footnote=said,
    )


def _standing(trains: Sequence[Train]) -> float:
    """Return the angle in degrees from the horizontal to the stroke line of the first cylinder, as it is drawn."""
    first = trains[0]
    if first.cylinder.inclination is not None and first.is_engine:
        return first.cylinder.inclination
    if not first.is_engine:  # a ram, which moves across the line of the pivots, is level
        return 90.0 if first.sketch.output else 0.0
    banks = sorted({one.angle for one in trains})
    if banks[-1] - banks[0] > 180.0:  # a radial engine
        return 90.0
    upright = len(banks) > 1 or not first.crosshead or len(trains) > 2
    return 90.0 - sum(banks) / len(banks) if upright else 0.0


def _row(trains: Sequence[Train]) -> list[tuple[float, Train]]:
    """Return the cylinders, each with its place along the shaft in m; none where all have stroke lines of their own.

    Places are those of the file where the cylinders then stand neither in each other nor far apart.
    """
    banks = {round(one.angle % 360.0, 6) for one in trains}
    plain = all(one.is_engine and not (one.has_slot or one.has_frame) for one in trains)
    if len(banks) == len(trains) or not plain or len(trains) > _MOST_IN_A_ROW:
        return []
    widest = max(barrel.bore for one in trains for barrel in one.barrels)
    given = [place for one in trains if (place := one.cylinder.axial_position) is not None]
    apart = np.diff(sorted(given)) / widest
    if len(given) == len(trains) and apart.min() >= 1.2 and apart.max() <= 4.5:
        return sorted(zip(given, trains), key=lambda one: one[0])
    return [(_PITCH * widest * number, one) for number, one in enumerate(trains)]


def _with_side(
    machine: Machine, along: list[Body], row: Sequence[tuple[float, Train]], level: bool
) -> tuple[list[Body], list[Note]]:
    """Return the view along the shaft with that from the side: below it where the machine lies, else at its right.

    In the frame of the view from the side the shaft runs along −y, in that of the page down or to the right.
    """
    places, pitch = [place for place, _ in row], float(min(np.diff([place for place, _ in row])))
    bore = min(barrel.bore for _, one in row for barrel in one.barrels[:1])
    first, last = row[0][1], max(places) + 0.5 * pitch
    side = [Body.of([box("metal", -first.journal, first.journal, -last, 0.5 * pitch - min(places))])]
    for place, one in row:
        side += [body.seen(0.0, moved=complex(0.0, -place)) for body in (*_engine(one), *_throw(one, bore))]
    if machine.flywheel:
        radius, width = _wheel_radius(machine, first.mechanism.crank), 0.25 * pitch
        look = "metal" if machine.flywheel.rim else "guess"
        side.append(Body.of([box(look, -radius, radius, -last - width, -last)]))
    side = [body.seen(0.0 if level else 90.0) for body in side]

    (left, right, bottom, top), (side_left, side_right, side_bottom, side_top) = map(_bounds, (along, side))
    if level:
        moved = 1j * (bottom - side_top - 0.1 * (top - bottom)) + 0j
    else:
        moved = complex(right - side_left + 0.06 * (side_right - side_left), 0.0)
    em = _em(max(right, side_right + moved.real) - left, top - min(bottom, side_bottom + moved.imag))
    notes = []
    for number, (place, one) in enumerate(row, 1):
        outer, inner = max(barrel.ends(_COVER)[1] for barrel in one.barrels), -1.5 * one.mechanism.crank
        turn = 1.0 if level else 1j
        for at, text in (
            (outer + 1.2 * em, str(number)),
            (inner - 0.8 * em, f"{one.cylinder.crank_position % 360:.4g}°"),
        ):
            notes.append(Note(text, turn * complex(at, -place) + moved, 0.4 * em * len(text), at > 0))
    return [*along, *(body.seen(0.0, moved=moved) for body in side)], notes


def _bounds(bodies: Sequence[Body]) -> tuple[float, float, float, float]:
    """Return left, right, bottom and top of all that bodies ever cover."""
    every = np.concatenate([line.ravel() for body in bodies for _, line in body.outlines()])
    return every.real.min(), every.real.max(), every.imag.min(), every.imag.max()


def _em(wide: float, tall: float) -> float:
    """Return about the height in m of a letter in a picture of this size."""
    return max(wide / _LETTERS[0], tall / _LETTERS[1])


def _number(one: Train, number: int, angle: float, mirrored: bool, em: float) -> Note:
    """Return the number of a cylinder, beyond its head."""
    outer = max(barrel.ends(_COVER)[1] for barrel in one.barrels) if one.is_engine else one.mechanism.crank
    turned = angle + (-one.angle if mirrored else one.angle)
    return Note(str(number), (outer + 1.6 * em) * np.exp(1j * np.radians(turned)), em, strong=True)


def _footnote(machine: Machine, trains: Sequence[Train], row: Sequence[tuple[float, Train]]) -> str:
    """Return what is to scale, and by which shares the rest is drawn."""
    first, scale, shares = trains[0], list[str](), list[str]()
    if first.is_engine:
        barrel = first.barrels[0]
        scale += ["crank", "stroke"] if math.isinf(first.mechanism.rod_length) else ["crank", "rod", "stroke"]
        scale += ["offset"] if first.mechanism.offset else []
        (scale if barrel.piston else shares).append("bore" if barrel.piston else f"bore ({_BORE:g} strokes)")
        shares.append(f"piston ({barrel.height / barrel.bore:.2g} bores high)")
    else:
        scale.append("all lengths between pins")
    if len({one.angle for one in trains}) > 1:
        scale.append("bank angles")
    if row:
        given = all(one.cylinder.axial_position == place for place, one in row)
        (scale if given else shares).append("distances along the shaft" if given else "distances of cylinders")
    if machine.locomotive and machine.locomotive.wheel_diameter:
        scale.append("wheel")
    elif machine.flywheel:
        rim = machine.flywheel.rim
        (scale if rim else shares).append("flywheel" if rim else f"flywheel ({_WHEEL:g} cranks)")
    return f"To scale: {', '.join(scale)}. Drawn by shares: {', '.join((*shares, 'all else'))}."


# the forces


def _arrows(train: Train, angle: float, mirrored: bool) -> Iterator[Curve]:
    """Yield every force as an arrow clear of the members, the largest over the cycle as long as any can be."""
    source, sketch, R = Source(train.results, None), train.sketch, train.mechanism.crank
    degrees = train.cycle
    outward = np.exp(1j * np.radians(degrees))
    turns = -(-len(degrees) // max(len(train.motion) - 1, 1))

    def joint(name: str) -> ComplexArray:
        places: ComplexArray = train.joints[name]
        return np.concatenate((places[:1], np.tile(places[1:], turns)))[: len(degrees)]

    # joint, direction in which the force counts, and where the arrow is from there, at a distance
    clear, place = 1.5 * _SHOE * R, joint(sketch.output or PIN)
    if train.has_slot or train.has_frame:
        clear, place = 1.95 * R, joint(PIN).real.astype(complex) if train.has_slot else place
    elif not train.is_engine:
        clear = 4.8 * train.pin
    elif not train.crosshead:
        clear = (0.5 + 2.2 * _WALL) * train.barrels[0].bore
    acting = dict[str, tuple[ComplexArray, ComplexArray, ComplexArray | None, float]]()
    if sketch.toward:
        toward = np.full(len(degrees), complex(*sketch.toward))
        acting["P"] = place - 1j * toward * (clear + 0.12 * R), toward, toward, 0.25 * R
    if sketch.across:
        acting["N"] = place, np.full(len(degrees), complex(*sketch.across)), None, clear
    beyond = _EYE * train.pin + 0.12 * R
    acting["T"] = joint(PIN), 1j * outward, None, beyond
    acting["D"] = joint(PIN), -outward, outward, beyond
    ids = source.having(*acting)
    if not ids:
        return
    largest = float(np.abs(source.samples((PHI, *ids)).values[1:]).max()) or 1.0
    for id, force in zip(ids, source.values(ids, degrees)):
        place, direction, side, off = acting[id]
        arrow, along = direction * force * (_LONGEST * R / largest), direction * np.where(force < 0, -1.0, 1.0)
        away = along if side is None else side
        tail = place + off * away - np.where((along * away.conj()).real < 0, arrow, 0.0)
        ends = np.stack((tail, tail + arrow), axis=1)
        ends = (ends.conj() if mirrored else ends) * np.exp(1j * np.radians(angle))
        shown = ends if len(ends) > 1 else ends[0]
        yield Curve(source.words(id), shown.real, shown.imag, "force")


# the parts


def box(look: str, left: float, right: float, bottom: float, top: float) -> Shape:
    """Return a rectangle."""
    return Shape(look, np.array([left + 1j * bottom, right + 1j * bottom, right + 1j * top, left + 1j * top]))


def _strip(look: str, left: float, right: float, half: float) -> Shape:
    return box(look, left, right, -half, half)


def _disc(look: str, radius: float, middle: complex = 0.0) -> Shape:
    return Shape(look, np.array([middle], dtype=complex), radius)


def _bearing(angle: ComplexArray) -> Array:
    """Return the directions of vectors in degrees, through a turn without a jump."""
    found = np.degrees(np.angle(angle))
    found[1:] = np.degrees(np.unwrap(np.radians(found[1:])))
    return found


def _engine(train: Train) -> Iterator[Body]:
    """Yield cylinders, guides, and what goes to and fro on the stroke line."""
    if not train.is_engine:
        return
    R, place = train.mechanism.crank, train.output
    level = 1j * train.mechanism.offset
    ends = [barrel.ends(_COVER) for barrel in train.barrels]
    outer = max(0.0, *(high for _, high in ends)) + 0.1 * R
    yield Body.of([Shape("axis", np.array([-1.4 * R, outer], dtype=complex))], level)
    for barrel in train.barrels:
        yield from _chambers(train, barrel)
        yield Body.of(_walls(barrel), level)
    if train.crosshead and train.mechanism.guided and not train.has_slot:
        (near, _), (far, _) = train.sketch.guides[0]
        rails = near - 1.4 * _SHOE * R, far + 1.2 * _SHOE * R
        yield Body.of(
            [box("wall", *rails, *sorted(side * R * at for at in (_SHOE, 1.25 * _SHOE))) for side in (-1, 1)], level
        )
    yield Body.of(_on_the_rod(train), place)


def _chambers(train: Train, barrel: Barrel) -> Iterator[Body]:
    """Yield the gas or liquid at both ends of a piston, the darker the higher its pressure is."""
    gas = next((one for one in train.results.drive.gas if one.piston is barrel.piston), None)
    if gas is None:
        return
    state = train.results.at(train.cycle)
    ends = [(end, np.broadcast_to(state.pressure(end), train.cycle.shape)) for end in (gas.crank, gas.head) if end]
    every = np.concatenate([pressure for _, pressure in ends])
    low, high = float(every.min()), float(every.max())
    # a pump has one pressure on each stroke
    pumped = bool(gas.work < 0) and all(len(np.unique(np.round(one))) <= 2 for _, one in ends)
    middle, half = train.output.real + barrel.shift, barrel.bore / 2
    for end, pressure in ends:
        tint = 0.08 + 0.72 * ((pressure - low) / (high - low or 1.0)) ** 0.7
        if end is gas.crank:
            start, turn, length = barrel.low, 0.0, middle - barrel.height / 2 - barrel.low
        else:
            start, turn, length = barrel.high, 180.0, barrel.high - middle - barrel.height / 2
        yield Body.of(
            [_strip("liquid" if pumped else "gas", 0.0, 1.0, half)],
            start + 1j * train.mechanism.offset,
            turn,
            length,
            tint,
        )


def _walls(barrel: Barrel) -> Iterator[Shape]:
    """Yield liner, covers and stuffing boxes of a cylinder in section."""
    half, (left, right) = barrel.bore / 2, barrel.ends(_COVER)
    wall, flange = _WALL * barrel.bore, 1.7 * _WALL * barrel.bore
    for side in (-1, 1):
        yield box("wall", left, right, *sorted((side * half, side * (half + wall))))
    for cover, inner, rod, out in ((left, barrel.low, barrel.rods[0], -1), (right, barrel.high, barrel.rods[1], 1)):
        if cover == inner:
            continue
        gland = cover + out * _GLAND * barrel.bore
        for side in (-1, 1):
            yield box("wall", *sorted((cover, inner)), *sorted((side * rod, side * (half + flange))))
            if rod:
                yield box("wall", *sorted((cover, gland)), *sorted((side * rod, side * (rod + 1.6 * wall))))


def _on_the_rod(train: Train) -> Iterator[Shape]:
    """Yield pistons, piston rods, and crosshead, yoke or frame, from the output of the mechanism."""
    R, (left, right) = train.mechanism.crank, train.head
    for barrel in train.barrels:
        inner, outer = barrel.rods
        if inner:
            yield _strip("rod", min(0.0, right), barrel.shift, inner)
        if outer and barrel.shift > 0:  # through the head, to the next piston or out of its stuffing box
            tail = barrel.ends(_COVER + 1.6 * _GLAND)[1] - train.sketch.guides[0][0][0]
            further = [one.shift for one in train.barrels if one.shift > barrel.shift]
            yield _strip("rod", barrel.shift, min(further, default=tail), outer)
        if barrel.shift < 0:
            yield _strip("rod", barrel.shift, left, outer)
    for barrel in train.barrels:
        yield from _piston(barrel)
    if train.has_slot:
        middle, half = (left + right) / 2, (right - left) / 2
        yield _strip("metal", left, right, 1.6 * R)
        yield _strip("hollow", middle - 0.55 * half, middle + 0.55 * half, 1.35 * R)
    elif train.has_frame:
        yield _strip("metal", left, right, 1.8 * R)
        yield _strip("hollow", left + 0.4 * R, right - 2 * _SHOE * R, 1.55 * R)
    elif train.crosshead:
        yield _strip("metal", left, right, _SHOE * R)


def _piston(barrel: Barrel) -> Iterator[Shape]:
    half, bottom, crown = barrel.bore / 2, barrel.shift - barrel.height / 2, barrel.shift + barrel.height / 2
    yield _strip("metal", bottom, crown, half)
    if barrel.trunk:
        yield _strip("hollow", bottom, crown - 0.24 * barrel.height, 0.8 * half)
    step = min(0.06 * barrel.bore, barrel.height / 6)
    start = crown - 1.3 * step if barrel.trunk or not barrel.closed[0] else barrel.shift + step
    for ring in range(3):
        yield Shape("thin", np.array([start - ring * step + 1j * half, start - ring * step - 1j * half]))


def _web(train: Train) -> Iterator[Body]:
    """Yield the crank with its counterweight, other members that turn on and on, and the bearings on the frame."""
    fixed = () if train.is_engine else train.sketch.fixed
    down = -1j if train.sketch.output == "" else -1.0
    for name in fixed:
        foot = down * train.journal * np.array([-0.8j, -2.0 * 1j + 2.6, 2.0 * 1j + 2.6, 0.8j])
        yield Body.of([Shape("wall", foot)], train.joints[name][0])
    yield Body.of(_crank(train, train.mechanism.crank), 0.0, train.motion)
    for start, end in train.sketch.links:
        if end in fixed and train.mechanism.turns:
            arm = train.joints[start] - train.joints[end]
            yield Body.of(_crank(train, float(abs(arm[0]))), train.joints[end][0], _bearing(arm))


def _crank(train: Train, R: float) -> Iterator[Shape]:
    hub, eye = 1.45 * train.journal, _EYE * train.pin
    tangent: ComplexArray = np.arccos((hub - eye) / R) * np.array([-1j, 1j])
    arm: ComplexArray = np.concatenate((hub * np.exp(tangent), (R + eye * np.exp(tangent))[::-1]))
    yield Shape("web", arm)
    yield _disc("web", eye, complex(R))
    back = train.weight * R * np.exp(1j * np.radians(np.linspace(142.0, 218.0, 11)))
    yield Shape("web", np.concatenate((hub * np.exp([1.8j]), back, hub * np.exp([-1.8j]))))
    yield _disc("web", hub)
    yield _disc("metal", train.journal)
    yield _disc("web", 0.15 * train.journal)


def _links(train: Train) -> Iterator[Body]:
    """Yield the members between the joints, and the pins in front of them."""
    pin, sketch = train.pin, train.sketch
    slotted = {link: joint for joint, link in sketch.blocks}
    for link in () if train.has_slot else sketch.links:
        start, end = (train.joints[name] for name in link)
        length, turn = float(abs(end - start)[0]), _bearing(end - start)
        if link in slotted:
            reach = abs(train.joints[slotted[link]] - start)
            far = max(length, float(reach.max()) + 2.4 * pin)
            slot = _strip("hollow", float(reach.min()) - 1.8 * pin, far - 0.7 * pin, 1.05 * pin)
            yield Body.of([_strip("rod", 0.0, far, 1.9 * pin), _disc("rod", 1.9 * pin), slot], start, turn)
        elif train.is_engine and link != (SHAFT, PIN):
            yield Body.of(_rod(pin, length), end, turn)
        elif (
            link != (SHAFT, PIN)
            and link[1] != sketch.output
            and not (link[1] in sketch.fixed and train.mechanism.turns)
        ):
            yield Body.of(_bar(pin, length), start, turn)
    if sketch.output and not train.is_engine:
        yield from _ram(train)
    for joint, (first, last) in sketch.blocks:
        turn = _bearing(train.joints[last] - train.joints[first])
        yield Body.of([_strip("metal", -1.7 * pin, 1.7 * pin, 1.05 * pin)], train.joints[joint], turn)
    for name, place in train.joints.items():
        if name == PIN or not (name == SHAFT or train.has_slot or name == sketch.output == "ram"):
            radius = train.journal if name in sketch.fixed else pin if name == PIN else 0.72 * pin
            shown = place if (place != place[0]).any() else place[:1]
            yield Body.of([_disc("metal", radius), _disc("web", 0.15 * radius)], shown)


def _rod(pin: float, length: float) -> Iterator[Shape]:
    """Yield a connecting rod from the pin of the piston, at 0, back to the crank pin."""
    big, small = _EYE * pin, 1.15 * pin
    outline = np.array([-length - 0.8j * pin, -0.6j * pin, 0.6j * pin, -length + 0.8j * pin])
    yield Shape("rod", outline)
    flute = np.array(
        [-length + big - 0.38j * pin, -small - 0.26j * pin, -small + 0.26j * pin, -length + big + 0.38j * pin]
    )
    yield Shape("thin", flute)
    yield _disc("rod", big, complex(-length))
    yield _disc("rod", small)


def _bar(pin: float, length: float) -> Iterator[Shape]:
    """Yield a member with an eye at both ends."""
    yield _strip("rod", 0.0, length, 0.62 * pin)
    yield _strip("thin", _EYE * pin, length - _EYE * pin, 0.26 * pin)
    for end in (0.0, length):
        yield _disc("rod", 1.35 * pin, complex(end))


def _ram(train: Train) -> Iterator[Body]:
    """Yield the ram of a shaper on its guides, with the fork or link that the lever's end drives."""
    pin, (low, high) = train.pin, train.sketch.guides[0]
    line, stroke = low[0], high[1] - low[1]
    above, thick = 1.6 * pin, 2.2 * pin
    ends = low[1] - 0.35 * stroke, high[1] + 0.25 * stroke
    for at in (above - 0.5 * pin, above + thick):
        yield Body.of([box("wall", line + at, line + at + 0.5 * pin, *ends)])
    drop = float((train.output - train.joints["end"]).real.max())
    tool = complex(above + 0.2 * thick, 0.95 * stroke)
    nose = np.array([tool, tool + 0.8 * pin - 1.4j * pin, tool - 2.6 * pin - 0.3j * pin])
    yield Body.of(
        [
            Shape("web", nose),
            box("metal", above, above + thick, -0.75 * stroke, 0.95 * stroke),
            box("metal", -drop - 1.8 * pin, above, -1.9 * pin, 1.9 * pin),
            box("hollow", -drop - 1.2 * pin, 0.9 * pin, -0.8 * pin, 0.8 * pin),
        ],
        train.output,
    )


def _throw(train: Train, bore: float) -> Iterator[Body]:
    """Yield a throw of the crank with its rod from the side, the shaft along y: it seems as long as its cosine.

    bore: in m, of the narrowest cylinder of the row, by which the width of rods and webs is drawn.
    """
    R, pin, eye, hub = train.mechanism.crank, train.pin, _EYE * train.pin, 1.45 * train.journal
    inner, outer = 0.2 * bore, 0.34 * bore
    webs = [sorted((side * inner, side * outer)) for side in (-1, 1)]
    high = np.cos(np.radians(train.motion))
    shortest = math.sqrt(train.mechanism.rod_length**2 - (R + abs(train.mechanism.offset)) ** 2)
    yield Body.of([box("web", -train.weight * R, R, *web) for web in webs], 0.0, 0.0, high)
    yield Body.of([box("web", -hub, hub, *web) for web in webs])
    yield Body.of(
        [_strip("rod", -shortest, 0.0, 0.55 * inner), _strip("rod", -pin, pin, 0.8 * inner)], train.output.real
    )
    pins = [box("web", -eye, eye, *web) for web in webs]
    yield Body.of([_strip("metal", -pin, pin, inner), _strip("rod", -eye, eye, 0.8 * inner), *pins], R * high)


def _wheel_radius(machine: Machine, crank: float) -> float:
    rim = machine.flywheel.rim if machine.flywheel else None
    return (rim.mean_diameter + rim.depth) / 2 if rim else _WHEEL * crank


def _wheel(machine: Machine, crank: float) -> Iterator[Body]:
    """Yield the flywheel, dashed where its size is not given, or the driven wheel of a locomotive."""
    if machine.locomotive and machine.locomotive.wheel_diameter:
        radius = machine.locomotive.wheel_diameter / 2
        yield Body.of([_disc("thin", radius), _disc("thin", 0.93 * radius)])
    elif machine.flywheel:
        radius, rim = _wheel_radius(machine, crank), machine.flywheel.rim
        inner = radius - (rim.depth or 0.08 * radius) if rim else 0.88 * radius
        yield Body.of([_disc("thin" if rim else "guess", one) for one in (radius, inner) if one > 0])
