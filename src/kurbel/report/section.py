"""The machine in section, to scale and moving: seen along the shaft, and from the side where cylinders are in a row."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from kurbel.arrays import ComplexArray
from kurbel.crank_angle import CrankAngle
from kurbel.machine import Machine
from kurbel.mechanisms import PIN
from kurbel.report.picture import MOMENTS_PER_TURN, Axis, Body, Caption, Curve, Panel, Words
from kurbel.report.picture_source import PHI, Source
from kurbel.report.train import BORE, EYE, SHOE, WALL, Train, box, cranks, cylinders, disc, members, throw
from kurbel.solver.forces import CylinderForces

_STILL = 60.0
"""Crank angle in degrees at which a machine is shown at rest where nothing pushes it."""
_LONGEST = 1.1
"""Length of the arrow of the largest force, relative to the crank radius."""
_VANISHING = 0.005
"""A force that never exceeds this share of the largest force has no arrow."""
_MOST_IN_A_ROW = 16
_PITCH, _LEAST, _MOST = 1.35, 1.2, 4.5
"""Distance of cylinders in a row over the widest bore: the default, and the bounds for distances of the file."""
_WHEEL = 2.2
"""Radius of a flywheel, relative to the crank radius, if only its moment of inertia is known."""
_LEVEL = 0.1
"""Sine of the inclination below which a machine counts as horizontal."""
_LETTERS = 50.0, 33.0
"""Width and height of a picture in letters."""
_Row = list[tuple[float, Train]]
_Text = tuple[str, complex, complex]
"""A text, a place in m, and the distance of the text from there in letters."""


def mechanism(source: Source) -> Iterator[Panel]:
    """The machine in section; gas and liquid are tinted by their pressure, forces on a single cylinder are arrows."""
    case, drawn = source.results
    if not drawn or any(one.drive.mechanism.sketch(CrankAngle.of(0.0)) is None for one in drawn):
        return
    shown, alone = [np.array([float(one)]) for one in source.angles or ()], len(drawn) == 1
    if source.angles is None:
        turning = np.arange(MOMENTS_PER_TURN * case.machine.revolutions) * (360.0 / MOMENTS_PER_TURN)
        shown = [np.append(_rest(drawn[0], alone), turning)]
    for degrees in shown:
        trains = [Train(case.machine, one, degrees, alone) for one in drawn]
        title = f"φ = {round(float(degrees[0]), 2 if source.angles is None else 6):.9g}°"
        yield _panel(case.machine, trains)._replace(title=title)


def _rest(first: CylinderForces, alone: bool) -> float:
    """Return the crank angle of the largest tangential force of the first cylinder."""
    marks = Source(first, None).marks("T", lambda angle: angle)
    return marks[0].x + (0.0 if alone else first.drive.cylinder.crank_position) if marks else _STILL


# the views


def _panel(machine: Machine, trains: Sequence[Train]) -> Panel:
    """Return all views with their texts."""
    angle, mirrored, R = _drawn_angle(trains), machine.rotation == "under", trains[0].mechanism.crank
    # the first cylinder of each stroke line, which is in front of those behind it; a yoke is in front of its crank
    front = list({round(one.angle % 360.0, 6): one for one in reversed(trains)}.values())
    bodies = [*_wheel(machine, R), Body.of([disc("axis", R)])]
    for parts in (cranks, cylinders, members) if trains[0].has_slot else (cylinders, cranks, members):
        bodies += [body.seen(one.angle) for one in front for body in parts(one)]
    bodies = [body.seen(angle, mirrored) for body in bodies]

    row, texts, arrows = _row(trains), list[_Text](), tuple[Curve, ...]()
    x = y = Axis(Words(""), "length")
    if row:
        side, texts = _from_the_side(machine, row, _bounds(bodies), level=abs(math.sin(math.radians(angle))) < _LEVEL)
        bodies += side
    elif len(trains) > 1:
        for one in front:
            outward = np.exp(1j * np.radians(angle - one.angle if mirrored else angle + one.angle))
            texts.append((str(trains.index(one) + 1), outward * one.outer_end, 1.6 * outward))
    else:
        arrows = tuple(_arrows(trains[0], angle, mirrored))
        x, y = (  # with room for their names
            one._replace(low=min(map(np.min, ends)) - 0.4 * R, high=max(map(np.max, ends)) + 0.4 * R) if ends else one
            for one, ends in ((x, [one.x for one in arrows]), (y, [one.y for one in arrows]))
        )
    left, right, bottom, top = _bounds(bodies)
    em = max((right - left) / _LETTERS[0], (top - bottom) / _LETTERS[1])
    captions = tuple(
        Caption(text, place + em * off, 0.4 * em * len(text), text.isdecimal()) for text, place, off in texts
    )
    note = _footnote(machine, trains, row, len(front))
    return Panel(x, y, arrows, equal=True, plain=True, bodies=tuple(bodies), captions=captions, footnote=note)


def _drawn_angle(trains: Sequence[Train]) -> float:
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


def _row(trains: Sequence[Train]) -> _Row:
    """Return the cylinders, each with its place along the shaft in m; none if each has its own stroke line.

    Places are those of the file if the cylinders then neither overlap nor are far apart.
    """
    banks = {round(one.angle % 360.0, 6) for one in trains}
    plain = all(one.is_engine and not (one.has_slot or one.has_frame) for one in trains)
    if len(banks) == len(trains) or not plain or len(trains) > _MOST_IN_A_ROW:
        return []
    widest = max(barrel.bore for one in trains for barrel in one.barrels)
    given = [place for one in trains if (place := one.cylinder.axial_position) is not None]
    apart = np.diff(sorted(given)) / widest
    if len(given) == len(trains) and apart.min() >= _LEAST and apart.max() <= _MOST:
        return sorted(zip(given, trains), key=lambda one: one[0])
    return [(_PITCH * widest * number, one) for number, one in enumerate(trains)]


def _from_the_side(machine: Machine, row: _Row, along: Sequence[float], level: bool) -> tuple[list[Body], list[_Text]]:
    """Return the view from the side, below the view along the shaft if the machine is horizontal, else at its right.

    along: left, right, bottom and top of the view along the shaft. In the coordinates of the side view the shaft is
    along −y, on the page downward or to the right.
    """
    places, first, R = [place for place, _ in row], row[0][1], row[0][1].mechanism.crank
    pitch, bore = float(min(np.diff(places))), min(one.barrels[0].bore for _, one in row)
    end = -max(places) - 0.5 * pitch
    side = [Body.of([box("metal", -first.journal, first.journal, end, 0.5 * pitch - min(places))])]
    for place, one in row:
        side += [body.seen(0.0, moved=-1j * place) for body in (*cylinders(one), *throw(one, bore))]
    if _has_wheel(machine):
        radius, look = _wheel_radius(machine, R), "metal" if machine.flywheel and machine.flywheel.rim else "guess"
        side.append(Body.of([box(look, -radius, radius, end - pitch / 4, end)]))
    turn = 1.0 if level else 1j
    side = [body.seen(0.0 if level else 90.0) for body in side]

    left, right, _, top = _bounds(side)
    moved = 1j * (along[2] - top - 0.1 * (along[3] - along[2])) if level else along[1] - left + 0.06 * (right - left)
    texts = list[_Text]()
    for number, (place, one) in enumerate(row, 1):
        lag, below = f"{one.cylinder.crank_position % 360:.4g}°", -1.5 * one.mechanism.crank
        texts.append((str(number), turn * complex(one.outer_end, -place) + moved, 1.2 * turn))
        texts.append((lag, turn * complex(below, -place) + moved, -2.6 if level else -0.9j))
    return [body.seen(0.0, moved=moved) for body in side], texts


def _bounds(bodies: Sequence[Body]) -> tuple[float, float, float, float]:
    """Return left, right, bottom and top of all positions of the bodies."""
    every = np.concatenate([line.ravel() for body in bodies for _, line in body.outlines()])
    return every.real.min(), every.real.max(), every.imag.min(), every.imag.max()


def _has_wheel(machine: Machine) -> bool:
    return bool(machine.flywheel or (machine.crankshaft and machine.crankshaft.flywheel_mass))


def _wheel_radius(machine: Machine, crank: float) -> float:
    rim = machine.flywheel.rim if machine.flywheel else None
    return (rim.mean_diameter + rim.depth) / 2 if rim else _WHEEL * crank


def _wheel(machine: Machine, crank: float) -> Iterator[Body]:
    """Yield the flywheel, dashed where its size is not given, or the driven wheel of a locomotive."""
    if machine.locomotive and machine.locomotive.wheel_diameter:
        radius = machine.locomotive.wheel_diameter / 2
        yield Body.of([disc("thin", radius), disc("thin", 0.93 * radius)])
    elif _has_wheel(machine):
        radius, rim = _wheel_radius(machine, crank), machine.flywheel and machine.flywheel.rim
        inner = radius - (rim.depth or 0.08 * radius) if rim else 0.88 * radius
        yield Body.of([disc("thin" if rim else "guess", one) for one in (radius, inner) if one > 0])


def _footnote(machine: Machine, trains: Sequence[Train], row: _Row, front: int) -> str:
    """Return the note on what is to scale, and what is assumed; front: number of cylinders not behind others."""
    first, scale, shares = trains[0], list[str](), list[str]()
    if first.is_engine:
        barrel = first.barrels[0]
        scale += ["crank", "stroke"] if math.isinf(first.mechanism.rod_length) else ["crank", "rod", "stroke"]
        scale += ["offset"] if first.mechanism.offset else []
        (scale if barrel.piston else shares).append("bore" if barrel.piston else f"bore ({BORE:g} strokes)")
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
    elif _has_wheel(machine):
        rim = machine.flywheel and machine.flywheel.rim
        (scale if rim else shares).append("flywheel" if rim else f"flywheel ({_WHEEL:g} cranks)")
    count, pistons = len(trains), [piston for one in trains for piston in one.cylinder.pistons]
    hidden = [] if row or front == count else [f"{count - front} of {count} cylinders, behind the others"]
    hidden += ["pistons by a lever"] if any(one.lever_ratio != 1 for one in pistons) else []
    note = f"To scale: {', '.join(scale)}. Drawn by shares: {', '.join((*shares, 'all else'))}."
    return f"{note} Not drawn: {', '.join(hidden)}." if hidden else note


# the forces


def _arrows(train: Train, angle: float, mirrored: bool) -> Iterator[Curve]:
    """Yield every force as an arrow clear of the members; the largest force of the cycle has the longest arrow."""
    source, sketch, R = Source(train.results, None), train.sketch, train.mechanism.crank
    degrees = train.cycle
    outward = np.exp(1j * np.radians(degrees))
    turns = -(-len(degrees) // max(len(train.motion) - 1, 1))

    def joint(name: str) -> ComplexArray:
        places: ComplexArray = train.joints[name]
        return np.concatenate((places[:1], np.tile(places[1:], turns)))[: len(degrees)]

    # id -> joint, positive direction of the force, side and distance of the arrow from the joint
    clear, place = 1.5 * SHOE * R, joint(sketch.output or PIN)
    if train.has_slot or train.has_frame:
        clear, place = 1.95 * R, joint(PIN).real.astype(complex) if train.has_slot else place
    elif not train.is_engine:
        clear = 4.8 * train.pin
    elif not train.crosshead:
        clear = (0.5 + 2.2 * WALL) * train.barrels[0].bore
    acting = dict[str, tuple[ComplexArray, ComplexArray, ComplexArray | None, float]]()
    if sketch.toward:
        toward = np.full(len(degrees), complex(*sketch.toward))
        acting["P"] = place - 1j * toward * (clear + 0.12 * R), toward, toward, 0.45 * R  # its name clear of N
    if sketch.across:
        acting["N"] = place, np.full(len(degrees), complex(*sketch.across)), None, clear
    # on the side of the pin, or of the shaft, opposite the rod; T and D are 0 where the side changes
    pin, tangent, off_pin = joint(PIN), 1j * outward, EYE * train.pin + 0.12 * R
    coupled = [joint(end) - pin for start, end in sketch.links if start == PIN]
    rod = coupled[0] if coupled else -outward
    acting["T"] = (
        pin,
        tangent,
        np.where((tangent * rod.conj()).real > 0, -tangent, tangent) if coupled else None,
        off_pin,
    )
    behind = (outward * rod.conj()).real > 0
    start = np.where(behind, -(train.weight + 0.12) * R * outward, pin + off_pin * outward)
    acting["D"] = start, -outward, np.where(behind, -outward, outward), 0.0
    ids = source.having(*acting)
    if not ids:
        return
    largest = float(np.abs(source.samples((PHI, *ids)).values[1:]).max()) or 1.0
    for id, force in zip(ids, source.values(ids, degrees)):
        if np.abs(force).max() < _VANISHING * largest and len(force) > 1:
            continue
        place, direction, side, off = acting[id]
        arrow, along = direction * force * (_LONGEST * R / largest), direction * np.where(force < 0, -1.0, 1.0)
        away = along if side is None else side
        tail = place + off * away - np.where((along * away.conj()).real < 0, arrow, 0.0)
        ends = np.stack((tail, tail + arrow), axis=1)
        ends = (ends.conj() if mirrored else ends) * np.exp(1j * np.radians(angle))
        shown = ends if len(ends) > 1 else ends[0]
        yield Curve(source.words(id), shown.real, shown.imag, "force")
