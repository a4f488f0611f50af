"""The machine in section, to scale and moving: seen along the shaft, and from the side where cylinders are in a row."""

import math
from collections.abc import Iterator, Sequence
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
    case, drawn = source.results
    if not drawn or any(one.drive.mechanism.sketch(CrankAngle.of(0.0)) is None for one in drawn):
        return
    alone, first = len(drawn) == 1, drawn[0]
    moments = np.array(source.angles or ())[:, None]
    if source.angles is None:
        # it rests where the tangential force of the first cylinder is largest
        largest = Source(first, None).extreme("T_max")
        rest = largest.degrees + first.drive.lag * (not alone) if largest else _STILL
        turning = np.arange(MOMENTS_PER_TURN * case.machine.revolutions) * 360.0 / MOMENTS_PER_TURN
        moments = np.append(rest, turning)[None]
    for degrees in moments:
        trains = [Train(case.machine, one, degrees, alone) for one in drawn]
        title = f"φ = {round(float(degrees[0]), 6 if source.angles else 2):.9g}°"
        yield _panel(case.machine, trains)._replace(title=title)


# the views


def _panel(machine: Machine, trains: Sequence[Train]) -> Panel:
    """Return all views with their texts."""
    first, angle, mirrored = trains[0], _drawn_angle(trains), machine.rotation == "under"
    # the first cylinder of each stroke line, which is in front of those behind it; a yoke is in front of its crank
    front = list({round(train.angle % 360.0, 6): train for train in reversed(trains)}.values())
    R, (wheel, depth, look) = first.R, _wheel(machine, first.R)
    bodies = [
        Body.of([disc("axis", R), *(disc(look, one) for one in (wheel, wheel - depth) if one > 0)])
    ]
    for parts in (cranks, cylinders, members) if first.has_slot else (cylinders, cranks, members):
        bodies += [body.seen(one.angle) for one in front for body in parts(one)]
    bodies = [body.seen(angle, mirrored) for body in bodies]

    row, captions, arrows = _row(trains), list[Caption](), list[Curve]()
    if row:
        level = abs(math.sin(math.radians(angle))) < _LEVEL
        side, captions = _from_the_side(
            row, 0.0 if machine.locomotive else wheel, look, _bounds(bodies), level
        )
        bodies += side
    elif len(trains) > 1:
        for one in front:
            outward = np.exp(1j * np.radians(angle - one.angle if mirrored else angle + one.angle))
            place = outward * (one.outer_end + _LETTER * R)
            captions.append(
                Caption(str(trains.index(one) + 1), place, 0.4 * _LETTER * R, strong=True)
            )
    else:
        arrows = [*_arrows(first, angle, mirrored)]
    left, right, bottom, top = _bounds(bodies, arrows)
    room = 0.4 * R if arrows else 0.0
    return Panel(
        Axis(NO_NAME, "length", low=left - room, high=right + room),  # room for the names of forces
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
    if not first.is_engine:  # a ram, which moves across the line of the pivots, is level
        return 90.0 if first.sketch.output else 0.0
    if first.cylinder.inclination is not None:
        return first.cylinder.inclination
    banks = sorted({train.angle for train in trains})
    if banks[-1] - banks[0] > 180.0:  # a radial engine
        return 90.0
    upright = len(banks) > 1 or not first.crosshead or len(trains) > 2
    return 90.0 - sum(banks) / len(banks) if upright else 0.0


def _row(trains: Sequence[Train]) -> dict[float, Train]:
    """Return the cylinders by their places along the shaft in m; none if each has its own stroke line.

    Places are those of the file if the cylinders then neither overlap nor are far apart.
    """
    banks = {round(train.angle % 360.0, 6) for train in trains}
    if len(banks) == len(trains) or not all(
        train.is_engine and not train.has_slot for train in trains
    ):
        return {}
    widest = max(barrel.bore for train in trains for barrel in train.barrels)
    given = {
        place: train for train in trains if (place := train.cylinder.axial_position) is not None
    }
    if len(given) == len(trains) and all(
        _LEAST <= one / widest <= _MOST for one in np.diff(sorted(given))
    ):
        return dict(sorted(given.items()))
    return {_PITCH * widest * number: one for number, one in enumerate(trains)}


def _from_the_side(
    row: dict[float, Train], wheel: float, look: str, along: Sequence[float], level: bool
) -> tuple[list[Body], list[Caption]]:
    """Return the view from the side, below the view along the shaft if the machine is level, else at its right.

    wheel: its radius in m, or 0; along: left, right, bottom and top of the view along the shaft. In the coordinates of
    the side view the shaft is along −y, on the page downward or to the right.
    """
    places, first = list(row), next(iter(row.values()))
    half, bore = float(min(np.diff(places))) / 2, min(one.barrels[0].bore for one in row.values())
    end, em, turn = -places[-1] - half, _LETTER * first.R, 1.0 if level else 1j
    on_shaft = [box("metal", -first.journal, first.journal, half - places[0], end)]
    on_shaft += [box(look, -wheel, wheel, end, end - half / 2)] if wheel else []
    side, captions = [Body.of(on_shaft).seen(0.0 if level else 90.0)], list[Caption]()
    for number, (place, one) in enumerate(row.items(), 1):
        bodies = *cylinders(one), *throw(one, bore)
        side += [body.seen(0.0 if level else 90.0, moved=-1j * turn * place) for body in bodies]
        above, below = one.outer_end + em, -1.5 * one.R - (2.5 if level else 0.8) * em
        captions.append(Caption(str(number), turn * complex(above, -place), 0.4 * em, strong=True))
        lag = f"{one.results.drive.lag % 360:.4g}°"
        captions.append(Caption(lag, turn * complex(below, -place), 0.4 * em * len(lag)))

    left, right, _, top = _bounds(side)
    moved = (
        1j * (along[2] - top - 0.1 * (along[3] - along[2]))
        if level
        else along[1] - left + 0.06 * (right - left)
    )
    captions = [caption._replace(place=caption.place + moved) for caption in captions]
    return [body.seen(0.0, moved=moved) for body in side], captions


def _bounds(
    bodies: Sequence[Body], arrows: Sequence[Curve] = ()
) -> tuple[float, float, float, float]:
    """Return left, right, bottom and top of all positions of the bodies and arrows."""
    every = [line.ravel() for body in bodies for _, line in body.outlines()]
    drawn = np.concatenate([*every, *((arrow.x + 1j * arrow.y).ravel() for arrow in arrows)])
    return drawn.real.min(), drawn.real.max(), drawn.imag.min(), drawn.imag.max()


def _wheel(machine: Machine, crank: float) -> tuple[float, float, str]:
    """Return radius and depth of the rim of a flywheel or driven wheel in m, and its look; 0 without."""
    locomotive, flywheel, shaft = machine.locomotive, machine.flywheel, machine.crankshaft
    if locomotive and locomotive.wheel_diameter:
        return locomotive.wheel_diameter / 2, 0.035 * locomotive.wheel_diameter, "thin"
    if flywheel and flywheel.rim:
        return (flywheel.rim.mean_diameter + flywheel.rim.depth) / 2, flywheel.rim.depth, "thin"
    guessed = flywheel or (shaft and shaft.flywheel_mass)
    return (_WHEEL * crank, 0.12 * _WHEEL * crank, "guess") if guessed else (0.0, 0.0, "")


def _footnote(trains: Sequence[Train], row: dict[float, Train], wheel: str, behind: int) -> str:
    """Return the note on what is to scale, and what is assumed; behind: number of cylinders behind others."""
    first, shares, hidden = trains[0], list[str](), list[str]()
    scale = "all lengths between pins"
    if first.is_engine:
        scale, barrel = "crank, rod, stroke, offset, angles", first.barrels[0]
        if first.cylinder.pistons:
            scale += ", bore"
        else:
            shares.append(f"bore ({BORE:g} strokes)")
        shares.append(f"piston ({barrel.height / barrel.bore:.2g} bores high)")
    if any(one.cylinder.axial_position != place for place, one in row.items()):
        shares.append("distances of cylinders")
    if wheel == "guess":
        shares.append(f"flywheel ({_WHEEL:g} cranks)")
    if behind and not row:
        hidden.append(f"{behind} of {len(trains)} cylinders, behind the others")
    if any(piston.lever_ratio != 1 for train in trains for piston in train.cylinder.pistons):
        hidden.append("pistons by a lever")
    note = f"To scale: {scale}. Drawn by shares: {', '.join((*shares, 'all else'))}."
    return f"{note} Not drawn: {', '.join(hidden)}." if hidden else note


# the forces


class _Arrow(NamedTuple):
    """Where the arrow of a force lies at crank angles (n,): from a place in m away from the members.

    direction: that of a positive force; away: to which side the arrow reaches from the place, whatever its direction.
    """

    place: ComplexArray
    direction: ComplexArray
    away: ComplexArray


def _acting(train: Train) -> dict[str, _Arrow]:
    """Return where the forces are drawn, by their ids."""
    sketch, R, gap = train.sketch, train.R, 0.12 * train.R

    def joint(name: str) -> ComplexArray:
        places = train.joints[name]
        return np.append(places[:1], np.resize(places[1:], len(train.cycle) - 1))

    # opposite the rod, on the other side of the pin or of the shaft; T and D are 0 where the side changes
    pin, outward = joint(PIN), np.exp(1j * np.radians(train.cycle))
    rod = next((joint(end) - pin for start, end in sketch.links if start == PIN), -outward)
    behind, beside = (
        (direction * rod.conj()).real > _CLEAR * R for direction in (outward, 1j * outward)
    )
    off, tangent = EYE * train.pin + gap, 1j * outward
    T_away, D_away = np.where(beside, -tangent, tangent), np.where(behind, -outward, outward)
    acting = {"T": _Arrow(pin + off * T_away, tangent, T_away)}
    acting["D"] = _Arrow(
        np.where(behind, (train.weight + gap) * D_away, pin + off * D_away), -outward, D_away
    )

    if sketch.toward:
        # beside the output, or beside the yoke
        output, toward = (
            joint(sketch.output) - 2.0 * R * train.has_slot,
            np.full(len(pin), complex(*sketch.toward)),
        )
        clear = train.yoke + gap if train.yoke else 4.8 * train.pin
        if train.is_engine and not train.yoke:
            clear = (
                1.5 * SHOE * R if train.crosshead else (0.5 + 2.2 * WALL) * train.barrels[0].bore
            )
        across = 1j * toward
        acting["P"] = _Arrow(output - across * (clear + gap), toward, toward)
        acting["N"] = _Arrow(output + across * clear, across, across)
    return acting


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
        place, direction, away = acting[id]
        arrow = direction * force * (_LONGEST * train.R / largest)
        tail = place - np.where((arrow * away.conj()).real < 0, arrow, 0.0)
        ends = np.stack((tail, tail + arrow), axis=1)
        ends = (ends.conj() if mirrored else ends) * np.exp(1j * np.radians(angle))
        shown = ends if len(ends) > 1 else ends[0]
        yield Curve(source.words(id), shown.real, shown.imag, "force")
