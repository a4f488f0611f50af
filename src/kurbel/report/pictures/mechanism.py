"""The mechanism itself, to scale, with the forces on it as arrows; it moves, where no angles are asked for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.crank_angle import CrankAngle
from kurbel.declared.unit_systems import convert
from kurbel.mechanisms.sketch import PIN, Point, Sketch
from kurbel.report.pictures.picture import Arrow, Axis, Curve, Frame, Panel, Piece, Words
from kurbel.report.pictures.source import PHI, Source, words

if TYPE_CHECKING:
    from kurbel.arrays import Array

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
    angles = source.angles
    moving = np.arange(_FRAMES) * (drive.cycle / _FRAMES)
    drawn = _drawn(source, np.array([_chief_angle(source)] if angles is None else angles, dtype=float))
    if angles is None:
        still = drawn[0]
        yield still._replace(frames=tuple(Frame(one.curves, one.arrows) for one in _drawn(source, moving)))
    else:
        yield from drawn


def _chief_angle(source: Source) -> float:
    found = source.extremes("T")
    return found[0][1].degrees if found else _STILL


def _drawn(source: Source, degrees: Array) -> list[Panel]:
    """Return a panel for each crank angle (n,), all to one scale."""
    drive = source.results.drive
    sketch = drive.mechanism.sketch(CrankAngle.of(degrees))
    unit = source.unit("length", *(np.abs(part) for point in sketch.joints.values() for part in point))
    forces, longest = _forces(source, degrees, sketch)
    axis = Axis(Words("", ""), unit)
    panels = []
    for k, angle in enumerate(degrees.tolist()):
        curves = tuple(_members(_at(sketch, k, unit), drive.mechanism.crank, unit))
        arrows = tuple(_arrow(force, k, longest, drive.mechanism.crank, unit) for force in forces)
        panels.append(Panel(axis, axis, curves, arrows=arrows, equal=True, plain=True, title=f"φ = {angle:.4g}°"))
    return panels


def _at(sketch: Sketch, k: int, unit: str) -> Sketch:
    """Return the sketch at the k-th of its angles, its lengths as shown."""
    joints = {name: _shown(point, k, unit) for name, point in sketch.joints.items()}
    guides = tuple((_shown(start, k, unit), _shown(end, k, unit)) for start, end in sketch.guides)
    return sketch._replace(joints=joints, guides=guides)


def _shown(point: Point, k: int, unit: str) -> tuple[float, float]:
    x, y = (float(convert(np.ravel(part)[k if np.size(part) > 1 else 0], "length", unit)) for part in point)
    return x, y


def _members(sketch: Sketch, crank: float, unit: str) -> Iterator[Curve]:
    size = 0.09 * float(convert(crank, "length", unit))
    path = _circle(sketch.joints["shaft"], float(convert(crank, "length", unit)))
    yield _curve("faint", path)
    for start, end in sketch.guides:
        yield _curve("guide", (start, end))
    for link in sketch.links:
        yield _curve("member", [sketch.joints[name] for name in link])
    for joint, (first, last) in sketch.blocks:
        yield _curve("block", _box(sketch.joints[joint], sketch.joints[first], sketch.joints[last], size))
    if sketch.output and sketch.toward:
        along = (sketch.joints[sketch.output][0] + sketch.toward[0], sketch.joints[sketch.output][1] + sketch.toward[1])
        yield _curve("block", _box(sketch.joints[sketch.output], sketch.joints[sketch.output], along, size))
    yield _curve("joint", [point for name, point in sketch.joints.items() if name not in sketch.fixed])
    yield _curve("fixed", [sketch.joints[name] for name in sketch.fixed])


def _curve(kind: str, points: Sequence[tuple[float, float]]) -> Curve:
    x, y = np.array(points, dtype=float).T
    return Curve(Words("", ""), (Piece(x, y),), kind)


def _circle(centre: tuple[float, float], radius: float) -> list[tuple[float, float]]:
    around = CrankAngle.of(np.linspace(0.0, 360.0, 73))
    return [(centre[0] + radius * c, centre[1] + radius * s) for c, s in zip(around.cos.tolist(), around.sin.tolist())]


def _box(
    middle: tuple[float, float], start: tuple[float, float], end: tuple[float, float], size: float
) -> list[tuple[float, float]]:
    """Return a block round a point, along a line."""
    x, y = end[0] - start[0], end[1] - start[1]
    length = float(np.hypot(x, y))
    x, y = 2 * size * x / length, 2 * size * y / length
    corners = ((1, 0.5), (1, -0.5), (-1, -0.5), (-1, 0.5), (1, 0.5))
    return [(middle[0] + a * x - b * y, middle[1] + a * y + b * x) for a, b in corners]


Force = tuple[Words, Any, Any, Any, Any]
"""Its name, where it acts (x, y), and its parts along both axes, in N; each (n,) or a number."""


def _forces(source: Source, degrees: Array, sketch: Sketch) -> tuple[list[Force], float]:
    """Return the forces at crank angles (n,), and the size of the largest over the cycle."""
    angle = CrankAngle.of(degrees)
    directions = {
        "P": (sketch.output, sketch.toward),
        "N": (sketch.output, sketch.across),
        "T": (PIN, (-angle.sin, angle.cos)),
        "D": (PIN, (-angle.cos, -angle.sin)),
    }
    ids = source.having(id for id, (_, direction) in directions.items() if direction is not None)
    if not ids:
        return [], 1.0
    largest = float(np.abs(source.samples((PHI, *ids)).values[1:]).max()) or 1.0
    values = source.values(ids, degrees, degrees)
    found = []
    for id, force in zip(ids, values):
        at, direction = directions[id]
        assert direction is not None
        found.append((words(source.quantity(id)), *sketch.joints[at], force * direction[0], force * direction[1]))
    return found, largest


def _arrow(force: Force, k: int, longest: float, crank: float, unit: str) -> Arrow:
    name, *parts = force
    x, y, along, across = (float(np.ravel(part)[k if np.size(part) > 1 else 0]) for part in parts)
    scale = _LONGEST * crank / longest
    tail, head = (x, y), (x + scale * along, y + scale * across)
    tail_x, tail_y, head_x, head_y = (float(convert(one, "length", unit)) for one in (*tail, *head))
    return Arrow((tail_x, tail_y), (head_x, head_y), name)
