"""The mechanism itself, to scale, with the forces on it as arrows; it moves where no angles are requested."""

from collections.abc import Iterator

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms import PIN, SHAFT, Point, Sketch
from kurbel.report.picture import Axis, Curve, Panel, Words
from kurbel.report.picture_source import PHI, Source

_MOMENTS = 72
_LONGEST = 1.1
"""Length of the arrow of the largest force over the crank radius."""
_BLOCK = 0.09
"""Half the length of a sliding block over the crank radius."""
_STILL = 60.0
"""Degrees at which it is shown at rest where nothing pushes it."""

_Drawn = tuple[str, Words, ComplexArray]
"""Kind and name of a curve with its points x + iy in m at n angles, (n, k); φ = 0 is to the right."""


def mechanism(source: Source) -> Iterator[Panel]:
    """The mechanism to scale, with the forces on it."""
    drive, angles = source.results.drive, source.angles
    if drive.mechanism.sketch(CrankAngle.of(0.0)) is None:
        return
    if angles is None:
        largest = source.extremes("T")
        rest = largest[0][1].degrees if largest else _STILL
        moving = np.append(rest, np.arange(_MOMENTS) * (drive.cycle / _MOMENTS))
        yield _panel(source, moving)._replace(title=f"φ = {round(rest, 2):.9g}°")
    else:
        standing = _panel(source, np.array(angles, dtype=float))
        for moment, angle in enumerate(angles):
            yield standing.at_moment(moment)._replace(title=f"φ = {round(angle, 6):.9g}°")


def _panel(source: Source, degrees: Array) -> Panel:
    """Return the mechanism at crank angles (n,) as a moving panel."""
    mechanism = source.results.drive.mechanism
    sketch = mechanism.sketch(CrankAngle.of(degrees))
    joints = {name: _places(point, degrees) for name, point in sketch.joints.items()}
    circle = joints[SHAFT][:, None] + mechanism.crank * np.exp(1j * np.linspace(0.0, 2 * np.pi, 73))
    guides = [np.stack([_places(end, degrees) for end in guide], axis=1) for guide in sketch.guides]
    drawn: list[_Drawn] = [
        ("faint", Words(""), circle),
        *(("guide", Words(""), guide) for guide in guides),
        *_members(sketch, joints, degrees, 2 * _BLOCK * mechanism.crank),
        *_arrows(source, sketch, joints, degrees),
    ]
    curves = []
    for kind, name, places in drawn:
        shown = places if (places != places[0]).any() else places[0]
        curves.append(Curve(name, shown.real, shown.imag, kind))
    axis = Axis(Words(""), "length")
    return Panel(axis, axis, tuple(curves), equal=True, plain=True)


def _places(point: Point, degrees: Array) -> ComplexArray:
    """Return a point or a direction as x + iy (n,)."""
    x, y = point
    return np.broadcast_to(x + 1j * y, degrees.shape)


def _members(sketch: Sketch, joints: dict[str, ComplexArray], degrees: Array, size: float) -> Iterator[_Drawn]:
    """Yield links, sliding blocks of this length, and joints."""
    for link in sketch.links:
        yield "member", Words(""), np.stack([joints[name] for name in link], axis=1)
    blocks = [(joints[joint], joints[last] - joints[first]) for joint, (first, last) in sketch.blocks]
    if sketch.output and sketch.toward:
        blocks.append((joints[sketch.output], _places(sketch.toward, degrees)))
    for middle, way in blocks:
        along = size * way / np.abs(way)
        yield "block", Words(""), np.stack([middle + along * corner for corner in _CORNERS], axis=1)
    for kind, fixed in (("joint", False), ("fixed", True)):
        names = [name for name in joints if (name in sketch.fixed) == fixed]
        yield kind, Words(""), np.stack([joints[name] for name in names], axis=1)


_CORNERS = (1 + 0.5j, 1 - 0.5j, -1 - 0.5j, -1 + 0.5j, 1 + 0.5j)


def _arrows(source: Source, sketch: Sketch, joints: dict[str, ComplexArray], degrees: Array) -> Iterator[_Drawn]:
    """Yield every force as an arrow, the largest over the cycle as long as any can be."""
    outward = np.exp(1j * np.radians(degrees))
    toward, across = sketch.toward, sketch.across
    acting = {
        "P": (sketch.output, toward and _places(toward, degrees)),
        "N": (sketch.output, across and _places(across, degrees)),
        "T": (PIN, 1j * outward),
        "D": (PIN, -outward),
    }
    ids = source.having(id for id, (_, direction) in acting.items() if direction is not None)
    if ids:
        largest = float(np.abs(source.samples((PHI, *ids)).values[1:]).max()) or 1.0
        scale = _LONGEST * source.results.drive.mechanism.crank / largest
        for id, force in zip(ids, source.values(ids, degrees, degrees)):
            joint, direction = acting[id]
            tail = joints[joint]
            yield "arrow", source.words(id), np.stack((tail, tail + scale * force * direction), axis=1)
