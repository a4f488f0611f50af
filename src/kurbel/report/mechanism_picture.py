"""The mechanism itself, to scale, with the forces on it as arrows; it moves where no angles are requested."""

from collections.abc import Iterator

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms import PIN, SHAFT, Point
from kurbel.report.picture import Axis, Curve, Panel, Words
from kurbel.report.picture_source import PHI, Source

_MOMENTS = 72
_LONGEST = 1.1
"""Length of the arrow of the largest force over the crank radius."""
_BLOCK = 0.09
"""Half the length of a sliding block over the crank radius."""
_STILL = 60.0
"""Degrees at which it is shown at rest where nothing pushes it."""
_CORNERS = (1 + 0.5j, 1 - 0.5j, -1 - 0.5j, -1 + 0.5j, 1 + 0.5j)


def mechanism(source: Source) -> Iterator[Panel]:
    """The mechanism to scale, with the forces on it."""
    drive, angles = source.results.drive, source.angles
    if drive.mechanism.sketch(CrankAngle.of(0.0)) is None:
        return
    if angles is None:
        marks = source.marks("T", lambda angle: angle)
        rest = marks[0].x if marks else _STILL
        moving = np.append(rest, np.arange(_MOMENTS) * (drive.cycle / _MOMENTS))
        yield _panel(source, moving)._replace(title=f"φ = {round(rest, 2):.9g}°")
    else:
        standing = _panel(source, np.array(angles, dtype=float))
        for moment, angle in enumerate(angles):
            yield standing.at_moment(moment)._replace(title=f"φ = {round(angle, 6):.9g}°")


def _panel(source: Source, degrees: Array) -> Panel:
    """Return the mechanism at crank angles (n,) as a moving panel; φ = 0 is to the right."""
    drive = source.results.drive
    mechanism, drawn = drive.mechanism, list[tuple[str, Words, ComplexArray]]()
    sketch = mechanism.sketch(CrankAngle.of(degrees))

    def draw(kind: str, *places: ComplexArray, name: Words = Words("")) -> None:  # noqa: B008 (immutable)
        """Add a curve through these places x + iy in m, each at all angles (n,)."""
        drawn.append((kind, name, np.stack(places, axis=1)))

    def place(point: Point) -> ComplexArray:
        return np.broadcast_to(point[0] + 1j * point[1], degrees.shape)

    joints = {name: place(point) for name, point in sketch.joints.items()}
    around = mechanism.crank * np.exp(1j * np.linspace(0.0, 2 * np.pi, 73))
    draw("faint", *(joints[SHAFT] + one for one in around))
    for guide in sketch.guides:
        draw("guide", *map(place, guide))
    for link in sketch.links:
        draw("member", *(joints[name] for name in link))
    blocks = [(joints[joint], joints[last] - joints[first]) for joint, (first, last) in sketch.blocks]
    if sketch.output and sketch.toward:
        blocks.append((joints[sketch.output], place(sketch.toward)))
    for middle, direction in blocks:
        along = 2 * _BLOCK * mechanism.crank * direction / np.abs(direction)
        draw("block", *(middle + along * corner for corner in _CORNERS))
    for kind, fixed in (("joint", False), ("fixed", True)):
        draw(kind, *(joints[name] for name in joints if (name in sketch.fixed) == fixed))

    # every force as an arrow, the largest over the cycle as long as any can be
    outward = np.exp(1j * np.radians(degrees))
    acting = {
        "P": (sketch.output, sketch.toward and place(sketch.toward)),
        "N": (sketch.output, sketch.across and place(sketch.across)),
        "T": (PIN, 1j * outward),
        "D": (PIN, -outward),
    }
    ids = source.having(*(id for id, (_, direction) in acting.items() if direction is not None))
    if ids:
        largest = float(np.abs(source.samples((PHI, *ids)).values[1:]).max()) or 1.0
        scale = _LONGEST * mechanism.crank / largest
        for id, force in zip(ids, source.values(ids, degrees)):
            joint, direction = acting[id]
            draw("arrow", joints[joint], joints[joint] + scale * force * direction, name=source.words(id))

    curves = []
    for kind, name, places in drawn:
        shown = places if (places != places[0]).any() else places[0]
        curves.append(Curve(name, shown.real, shown.imag, kind))
    axis = Axis(Words(""), "length")
    return Panel(axis, axis, tuple(curves), equal=True, plain=True)
