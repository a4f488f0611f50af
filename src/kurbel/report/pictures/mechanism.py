"""The mechanism itself, to scale, with the forces on it as arrows; it moves, where no angles are asked for."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.declared.unit_systems import convert
from kurbel.mechanisms import PIN, Point, Sketch
from kurbel.report.pictures.picture import Arrow, Axis, Curve, Panel, Piece, Words
from kurbel.report.pictures.source import PHI, Source

_FRAMES = 72
_LONGEST = 1.1
"""Length of the arrow of the largest force over the crank radius."""
_STILL = 60.0
"""Degrees at which it stands where nothing pushes it."""


def mechanism(source: Source) -> Iterator[Panel]:
    """Yield the mechanism at the angles that are asked for, or moving, with the forces that act on it."""
    drive = source.results.drive
    if drive.mechanism.sketch(CrankAngle.of(0.0)) is None:
        return
    angles = source.wish.angles
    moving = np.arange(_FRAMES) * (drive.cycle / _FRAMES)
    drawn = _drawn(source, np.array([_chief_angle(source)] if angles is None else angles, dtype=float))
    if angles is None:
        yield drawn[0]._replace(frames=tuple(_drawn(source, moving)))
    else:
        yield from drawn


def _chief_angle(source: Source) -> float:
    found = source.extremes("T")
    return found[0][1].degrees if found else _STILL


def _drawn(source: Source, degrees: Array) -> list[Panel]:
    """Return a panel for each crank angle (n,), all to one scale."""
    mechanism = source.results.drive.mechanism
    sketch = mechanism.sketch(CrankAngle.of(degrees))
    unit = source.unit("length", *(np.abs(part) for point in sketch.joints.values() for part in point))
    crank = float(convert(mechanism.crank, "length", unit))
    joints = {name: convert(_along(point, degrees), "length", unit) for name, point in sketch.joints.items()}
    guides = [[convert(_along(end, degrees), "length", unit) for end in guide] for guide in sketch.guides]
    arrows = list(_arrows(source, degrees, sketch, unit))
    axis, around = Axis(Words(""), unit), CrankAngle.of(np.linspace(0.0, 360.0, 73))
    way = crank * np.column_stack((around.cos, around.sin))
    panels = []
    for k, angle in enumerate(degrees.tolist()):
        here = {name: places[k] for name, places in joints.items()}
        lines = (_curve("guide", [end[k] for end in guide]) for guide in guides)
        circle = _curve("faint", [*(here["shaft"] + way)])
        curves = (circle, *lines, *_members(sketch, here, 0.09 * crank))
        panel = Panel(axis, axis, curves, arrows=tuple(one[k] for one in arrows), equal=True, plain=True)
        panels.append(panel._replace(title=f"φ = {round(angle, 2 if source.wish.angles is None else 6):.9g}°"))
    return panels


def _along(point: Point, degrees: Array) -> Array:
    """Return both parts of a point or a direction as (n, 2); each is (n,) or a number."""
    return np.stack([np.broadcast_to(np.asarray(part, dtype=float), degrees.shape) for part in point], axis=1)


def _members(sketch: Sketch, joints: dict[str, Array], size: float) -> Iterator[Curve]:
    for link in sketch.links:
        yield _curve("member", [joints[name] for name in link])
    for joint, (first, last) in sketch.blocks:
        yield _curve("block", _box(joints[joint], joints[last] - joints[first], size))
    if sketch.output and sketch.toward:
        end = joints[sketch.output] + np.array(sketch.toward)
        yield _curve("block", _box(joints[sketch.output], end - joints[sketch.output], size))
    yield _curve("joint", [point for name, point in joints.items() if name not in sketch.fixed])
    yield _curve("fixed", [joints[name] for name in sketch.fixed])


def _curve(kind: str, points: Sequence[Array]) -> Curve:
    x, y = np.array(points, dtype=float).T
    return Curve(Words(""), (Piece(x, y),), kind)


def _box(middle: Array, way: Array, size: float) -> list[Array]:
    """Return a block round a point, along a way (2,)."""
    along = 2 * size * way / float(np.hypot(*way))
    across = np.array([-along[1], along[0]])
    return [middle + a * along + b * across for a, b in ((1, 0.5), (1, -0.5), (-1, -0.5), (-1, 0.5), (1, 0.5))]


def _arrows(source: Source, degrees: Array, sketch: Sketch, unit: str) -> Iterator[list[Arrow]]:
    """Yield of every force its arrows at crank angles (n,), the largest over the cycle as long as any can be."""
    angle = CrankAngle.of(degrees)
    directions: dict[str, tuple[str, Any]] = {
        "P": (sketch.output, sketch.toward),
        "N": (sketch.output, sketch.across),
        "T": (PIN, (-angle.sin, angle.cos)),
        "D": (PIN, (-angle.cos, -angle.sin)),
    }
    ids = source.having(id for id, (_, direction) in directions.items() if direction is not None)
    if not ids:
        return
    largest = float(np.abs(source.samples((PHI, *ids)).values[1:]).max()) or 1.0
    scale = _LONGEST * source.results.drive.mechanism.crank / largest
    for id, force in zip(ids, source.values(ids, degrees, degrees)):
        at, direction = directions[id]
        tails = _along(sketch.joints[at], degrees)
        heads = tails + scale * (force[:, None] * _along(direction, degrees))
        ends = (convert(one, "length", unit).tolist() for one in (tails, heads))
        yield [Arrow((*tail,), (*head,), source.words(id)) for tail, head in zip(*ends)]
