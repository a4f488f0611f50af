"""The machine in section, to scale and moving: seen along the shaft, and from the side where cylinders are in a row."""

import math
from collections.abc import Iterator, Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from kurbel.arrays import ComplexArray
from kurbel.crank_angle import CrankAngle
from kurbel.machine import Machine
from kurbel.mechanisms import PIN
from kurbel.pictures.picture import MOMENTS_PER_TURN, Axis, Body, Caption, Curve, Panel
from kurbel.pictures.picture_source import NO_NAME, Source
from kurbel.pictures.train import (
    BORE,
    EYE,
    SHOE,
    WALL,
    Train,
    box,
    cranks,
    cylinders,
    disc,
    members,
    throw,
)
from kurbel.solver.forces import CylinderForces

_STILL = 60.0
"""Crank angle in degrees at which a machine is shown at rest where nothing pushes it."""
_LONGEST = 1.1
"""Length of the arrow of the largest force, relative to the crank radius."""
_VANISHING = 0.005
"""A force that never exceeds this share of the largest force has no arrow."""
_CLEAR = 1e-9
"""Over the crank radius: a rod that is less off the direction of a force is square to it."""
_PITCH, _LEAST, _MOST = 1.35, 1.2, 4.5
"""Distance of cylinders in a row over the widest bore: the default, and the bounds for distances of the file."""
_WHEEL = 2.2
"""Radius of a flywheel, relative to the crank radius, if only its moment of inertia is known."""
_LEVEL = 0.1
"""Sine of the inclination below which a machine counts as horizontal."""
_LETTER = 0.6
"""Height of the letters of captions over the crank radius."""


def mechanism(source: Source) -> Iterator[Panel]:
    """The machine in section; gas and liquid are tinted by their pressure, forces on a single cylinder are arrows."""
    case, cylinders = source.results
    if not cylinders or any(_has_no_sketch(forces) for forces in cylinders):
        return
    is_alone = len(cylinders) == 1
    if source.angles is None:
        # it rests where the tangential force of the first cylinder is largest
        largest = Source(cylinders[0], None).extreme("T_max")
        rest = _STILL
        if largest:
            lag = cylinders[0].drive.lag
            rest = largest.degrees + (0.0 if is_alone else lag)
        moments = np.arange(MOMENTS_PER_TURN * case.machine.revolutions)
        drawn = [np.append(rest, moments * 360.0 / MOMENTS_PER_TURN)]
    else:
        drawn = [np.array([angle]) for angle in source.angles]
    for degrees in drawn:
        trains = [Train(case.machine, forces, degrees, is_alone) for forces in cylinders]
        decimals = 6 if source.angles else 2
        title = f"φ = {round(float(degrees[0]), decimals):.9g}°"
        chosen_angle = None if source.angles is None else float(degrees[0])
        yield _panel(case.machine, trains)._replace(title=title, angle=chosen_angle)


def _has_no_sketch(forces: CylinderForces) -> bool:
    return forces.drive.mechanism.sketch(CrankAngle.of(0.0)) is None


# the views


def _panel(machine: Machine, trains: Sequence[Train]) -> Panel:
    """Return all views with their texts."""
    first, angle = trains[0], _drawn_angle(trains)
    mirrored = machine.rotation == "under"
    R, (wheel, depth, look) = first.R, _wheel(machine, first.R)
    # the first cylinder of each stroke line is in front of those behind it
    front = list({round(train.angle % 360.0, 6): train for train in reversed(trains)}.values())

    discs = [disc("axis", R)]
    discs += [disc(look, radius) for radius in (wheel, wheel - depth) if radius > 0]
    bodies = [Body.of(discs)]
    # a yoke is in front of its crank
    layers = (cranks, cylinders, members) if first.has_slot else (cylinders, cranks, members)
    for layer in layers:
        for train in front:
            bodies += [body.seen(train.angle) for body in layer(train)]
    bodies = [body.seen(angle, mirrored) for body in bodies]

    row, captions, arrows = _row(trains), list[Caption](), list[Curve]()
    if row:
        is_level = abs(math.sin(math.radians(angle))) < _LEVEL
        radius = 0.0 if machine.locomotive else wheel
        side, captions = _from_the_side(row, radius, look, _bounds(bodies), is_level)
        bodies += side
    elif len(trains) > 1:
        for train in front:
            degrees = angle - train.angle if mirrored else angle + train.angle
            outward = np.exp(1j * np.radians(degrees))
            centre = outward * (train.outer_end + _LETTER * R)
            number = str(trains.index(train) + 1)
            captions.append(Caption(number, centre, 0.4 * _LETTER * R, strong=True))
    else:
        arrows = list(_arrows(first, angle, mirrored))

    left, right, bottom, top = _bounds(bodies, arrows)
    room = 0.4 * R if arrows else 0.0  # for the names of forces
    return Panel(
        Axis(NO_NAME, "length", low=left - room, high=right + room),
        Axis(NO_NAME, "length", low=bottom - room, high=top + room),
        tuple(arrows),
        equal=True,
        plain=True,
        bodies=tuple(bodies),
        captions=tuple(captions),
        footnote=_footnote(trains, row, look, len(trains) - len(front)),
    )


def _drawn_angle(trains: Sequence[Train]) -> float:
    """Return the angle in degrees from the horizontal to the stroke line of the first cylinder, as it is drawn."""
    first = trains[0]
    if first.mechanism.swings_cylinder:
        return 90.0
    if not first.is_engine:  # a ram, which moves across the line of the pivots, is level
        return 90.0 if first.sketch.output else 0.0
    if first.cylinder.inclination is not None:
        return first.cylinder.inclination
    banks = sorted({train.angle for train in trains})
    if banks[-1] - banks[0] > 180.0:  # a radial engine
        return 90.0
    is_upright = len(banks) > 1 or not first.crosshead or len(trains) > 2
    middle = sum(banks) / len(banks)
    if not is_upright:
        return 0.0
    return 90.0 - middle


def _row(trains: Sequence[Train]) -> dict[float, Train]:
    """Return the cylinders by their places along the shaft in m; none if each has its own stroke line.

    Places are those of the file if the cylinders then neither overlap nor are far apart.
    """
    banks = {round(train.angle % 360.0, 6) for train in trains}
    are_engines = all(train.is_engine and not train.has_slot for train in trains)
    if len(banks) == len(trains) or not are_engines:
        return {}
    barrels = chain.from_iterable(train.barrels for train in trains)
    widest = max(barrel.bore for barrel in barrels)
    of_file = {}
    for train in trains:
        if train.cylinder.axial_position is not None:
            of_file[train.cylinder.axial_position] = train
    positions = sorted(of_file)
    distances = np.diff(positions) / widest
    fits = bool(np.all((distances >= _LEAST) & (distances <= _MOST)))
    if len(of_file) == len(trains) and fits:
        return {position: of_file[position] for position in positions}
    return {_PITCH * widest * number: train for number, train in enumerate(trains)}


def _from_the_side(
    row: dict[float, Train], wheel: float, look: str, along: Sequence[float], level: bool
) -> tuple[list[Body], list[Caption]]:
    """Return the view from the side, below the view along the shaft if the machine is level, else at its right.

    wheel: its radius in m, or 0; along: left, right, bottom and top of the view along the shaft. In the coordinates of
    the side view the shaft is along −y, on the page downward or to the right.
    """
    positions = list(row)
    first = row[positions[0]]
    half = float(min(np.diff(positions))) / 2
    bore = min(train.barrels[0].bore for train in row.values())
    degrees, turn = (0.0, 1.0) if level else (90.0, 1j)

    # the shaft, with its wheel at the end
    end = -positions[-1] - half
    shaft = [box("metal", -first.journal, first.journal, half - positions[0], end)]
    if wheel:
        shaft.append(box(look, -wheel, wheel, end, end - half / 2))
    side = [Body.of(shaft).seen(degrees)]

    # each cylinder with its throw, its number above and its angle below
    em = _LETTER * first.R
    captions = []
    for number, (position, train) in enumerate(row.items(), 1):
        for body in (*cylinders(train), *throw(train, bore)):
            side.append(body.seen(degrees, moved=-1j * turn * position))
        above = turn * complex(train.outer_end + em, -position)
        below = turn * complex(-1.5 * train.R - (2.5 if level else 0.8) * em, -position)
        captions.append(Caption(str(number), above, 0.4 * em, strong=True))
        lag = f"{train.cylinder.crank_position % 360:.4g}°"
        captions.append(Caption(lag, below, 0.4 * em * len(lag)))

    # next to the view along the shaft
    left, right, _, top = _bounds(side)
    _, along_right, along_bottom, along_top = along
    if level:
        moved = 1j * (along_bottom - top - 0.1 * (along_top - along_bottom))
    else:
        moved = along_right - left + 0.06 * (right - left)
    captions = [caption._replace(place=caption.place + moved) for caption in captions]
    return [body.seen(0.0, moved=moved) for body in side], captions


def _bounds(
    bodies: Sequence[Body], arrows: Sequence[Curve] = ()
) -> tuple[float, float, float, float]:
    """Return left, right, bottom and top of all positions of the bodies and arrows."""
    lines = []
    for body in bodies:
        lines += [line.ravel() for _, line in body.outlines()]
    lines += [(arrow.x + 1j * arrow.y).ravel() for arrow in arrows]
    points = np.concatenate(lines)
    return points.real.min(), points.real.max(), points.imag.min(), points.imag.max()


def _wheel(machine: Machine, crank: float) -> tuple[float, float, str]:
    """Return radius and depth of the rim of a flywheel or driven wheel in m, and its look; 0 without."""
    locomotive, flywheel, shaft = machine.locomotive, machine.flywheel, machine.crankshaft
    if locomotive and locomotive.wheel_diameter:
        return locomotive.wheel_diameter / 2, 0.035 * locomotive.wheel_diameter, "thin"
    if flywheel and flywheel.rim:
        rim = flywheel.rim
        return (rim.mean_diameter + rim.depth) / 2, rim.depth, "thin"
    if flywheel or (shaft and shaft.flywheel_mass):
        return _WHEEL * crank, 0.12 * _WHEEL * crank, "guess"
    return 0.0, 0.0, ""


def _footnote(trains: Sequence[Train], row: dict[float, Train], wheel: str, behind: int) -> str:
    """Return the note on what is to scale, and what is assumed; behind: number of cylinders behind others."""
    first = trains[0]
    shares, hidden = list[str](), list[str]()
    scale = "all lengths between pins"
    if first.is_engine:
        scale, barrel = "crank, rod, stroke, offset, angles", first.barrels[0]
        if first.cylinder.pistons:
            scale += ", bore"
        else:
            shares.append(f"bore ({BORE:g} strokes)")
        shares.append(f"piston ({barrel.height / barrel.bore:.2g} bores high)")
    if any(train.cylinder.axial_position != position for position, train in row.items()):
        shares.append("distances of cylinders")
    if wheel == "guess":
        shares.append(f"flywheel ({_WHEEL:g} cranks)")
    if behind and not row:
        hidden.append(f"{behind} of {len(trains)} cylinders, behind the others")
    pistons = chain.from_iterable(train.cylinder.pistons for train in trains)
    if any(piston.lever_ratio != 1 for piston in pistons):
        hidden.append("pistons by a lever")
    note = f"To scale: {scale}. Drawn by shares: {', '.join((*shares, 'all else'))}."
    if not hidden:
        return note
    return f"{note} Not drawn: {', '.join(hidden)}."


# the forces


class _Arrow(NamedTuple):
    """Where the arrow of a force lies at crank angles (n,): its tail in m, clear of the members.

    direction: that of a positive force; away: to which side the arrow reaches from its tail, whatever its direction.
    """

    tail: ComplexArray
    direction: ComplexArray
    away: ComplexArray


def _acting(train: Train) -> dict[str, _Arrow]:
    """Return where the forces are drawn, by their ids."""
    sketch, R, gap = train.sketch, train.R, 0.12 * train.R

    def joint(name: str) -> ComplexArray:
        points = train.joints[name]
        return np.append(points[:1], np.resize(points[1:], len(train.cycle) - 1))

    # opposite the rod, on the other side of the pin or of the shaft; T and D are 0 where the side changes
    pin, outward = joint(PIN), np.exp(1j * np.radians(train.cycle))
    rod = -outward
    for start, end in sketch.links:
        if start == PIN:
            rod = joint(end) - pin
            break
    tangent = 1j * outward
    is_behind = (outward * rod.conj()).real > _CLEAR * R
    is_beside = (tangent * rod.conj()).real > _CLEAR * R
    off = EYE * train.pin + gap
    T_away = np.where(is_beside, -tangent, tangent)
    D_away = np.where(is_behind, -outward, outward)
    D_tail = np.where(is_behind, (train.weight + gap) * D_away, pin + off * D_away)
    acting = {
        "T": _Arrow(pin + off * T_away, tangent, T_away),
        "D": _Arrow(D_tail, -outward, D_away),
    }

    if sketch.toward:
        # beside the output, or beside the yoke
        output = joint(sketch.output) - 2.0 * R * train.has_slot
        toward = np.full(len(pin), complex(*sketch.toward))
        across = 1j * toward
        clear = _clear_of_output(train, gap)
        acting["P"] = _Arrow(output - across * (clear + gap), toward, toward)
        acting["N"] = _Arrow(output + across * clear, across, across)
    return acting


def _clear_of_output(train: Train, gap: float) -> float:
    """Return the distance of an arrow from the stroke line that is clear of yoke, crosshead or piston, in m."""
    if train.yoke:
        return train.yoke + gap
    if not train.is_engine:
        return 4.8 * train.pin
    if train.crosshead:
        return 1.5 * SHOE * train.R
    return (0.5 + 2.2 * WALL) * train.barrels[0].bore


def _arrows(train: Train, angle: float, mirrored: bool) -> Iterator[Curve]:
    """Yield every force as an arrow clear of the members; the largest force of the cycle has the longest arrow."""
    source, acting = Source(train.results, None), _acting(train)
    ids = source.having(*acting)
    if not ids:
        return
    lines = [source.line(id) for id in ids]
    largest = float(np.abs(source.samples(ids[0], lines).values).max()) or 1.0
    for id, force in zip(ids, source.values(lines, train.cycle)):
        if np.abs(force).max() < _VANISHING * largest and len(force) > 1:
            continue
        tail, direction, away = acting[id]
        arrow = direction * force * (_LONGEST * train.R / largest)
        points_back = (arrow * away.conj()).real < 0
        start = tail - np.where(points_back, arrow, 0.0)
        ends = np.stack((start, start + arrow), axis=1)
        if mirrored:
            ends = ends.conj()
        ends = ends * np.exp(1j * np.radians(angle))
        shown = ends if len(ends) > 1 else ends[0]
        yield Curve(source.words(id), shown.real, shown.imag, "force")
