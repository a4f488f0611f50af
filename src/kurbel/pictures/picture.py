"""The parts of pictures and long reports, independent of the output: curves, shades and marks on panels with two axes.

Panels are made in SI; `in_units` of `picture_source` gives them the units in which they are shown.
"""

from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import NamedTuple, Union

import numpy as np

from kurbel.arrays import Array, ComplexArray, Number
from kurbel.quantity import Quantity
from kurbel.tables.tables import PlaceTable, Provenance, Report


class Words(NamedTuple):
    """A symbol as it is printed, its form without Greek letters if that is not each sign by itself, and its words."""

    symbol: str
    ascii_symbol: str = ""
    words: str = ""


class Axis(NamedTuple):
    """What runs along an axis, its kind of quantity and unit; log: by powers of ten.

    low, high: how far it must reach at least; falling: large values are on the left; names: texts at 0, 1, … instead of
    numbers.
    """

    name: Words
    kind: str = ""
    unit: str = ""
    log: bool = False
    low: float | None = None
    high: float | None = None
    falling: bool = False
    names: tuple[str, ...] = ()

    def shown(self, to: Callable[[float], float], unit: str) -> "Axis":
        """Return the axis in a unit, to which a function takes numbers."""
        low, high = (None if end is None else to(end) for end in (self.low, self.high))
        return self._replace(unit=unit, low=low, high=high)


class Curve(NamedTuple):
    """Points x, y (n,), one nan at a jump, more at a gap; of a moving curve (1 + m, n): at rest, then m in a loop.

    kind: `line`, `faint` (to compare with, such as a mean), `cycles` (of which a line is the mean), `dots` joined
    thinly, `beads`, `pole`; of mechanisms
    `guide`, `member`, `block`, the points `joint` and `fixed`, and `arrow`, a force from its first point to its second.
    look: its colour and stroke, where that is not its place among the lines of its panel.
    """

    name: Words
    x: Array
    y: Array
    kind: str = "line"
    look: int | None = None

    def pieces(self) -> list[tuple[Array, Array]]:
        """Return the points between jumps and gaps."""
        ends = [-1, *np.flatnonzero(np.isnan(self.x)).tolist(), len(self.x)]
        return [
            (self.x[start + 1 : end], self.y[start + 1 : end])
            for start, end in pairwise(ends)
            if end > start + 1
        ]

    def jumps(self) -> list[tuple[Array, Array]]:
        """Return the two points of each jump."""
        ends = np.flatnonzero(np.isnan(self.x[1:-1]))[:, None] + np.array([0, 2])
        return [(self.x[pair], self.y[pair]) for pair in ends if not np.isnan(self.x[pair]).any()]

    def closed(self) -> "Curve":
        """Return the curve of a cycle with a jump from its end to its beginning."""

        def with_jump(values: Array) -> Array:
            return np.concatenate((values, [np.nan], values[:2]))  # a piece has two points

        return self._replace(x=with_jump(self.x), y=with_jump(self.y))

    def at_moment(self, moment: int) -> "Curve":
        """Return the curve at one moment of its movement."""
        if self.x.ndim == 1:
            return self
        return self._replace(x=self.x[moment], y=self.y[moment])


class PageFigure(NamedTuple):
    """A figure written into a picture: symbol, value with unit, and its crank angle.

    kind: of quantity, if that is not the one of the upright axis.
    """

    name: Words
    value: float | None = None
    unit: str = ""
    at_deg: float | None = None
    kind: str = ""


class Mark(NamedTuple):
    """A point with its figure."""

    x: float
    y: float
    figure: PageFigure


class Shade(NamedTuple):
    """The area between two lines over the same places x (n,), positive or not; of two points a bar.

    figure: what is written into it, where it is widest.
    """

    x: Array
    low: Array
    high: Array
    gain: bool = True
    figure: PageFigure | None = None


_CIRCLE = np.exp(2j * np.pi * np.arange(25) / 24)
MOMENTS_PER_TURN = 48
"""Moments of one turn of the crank, through which bodies and arrows move."""


class Shape(NamedTuple):
    """A closed polygon, or a circle of a radius round its only point, in the frame of a body; look: what it is made of.

    Looks: `wall` and `web` (solid), `metal`, `rod`, `hollow`, `gas`, `liquid`, and the lines `thin`, `axis`, `guess`.
    """

    look: str
    points: ComplexArray
    radius: float = 0.0

    @property
    def outline(self) -> ComplexArray:
        """The points of its outline."""
        if self.radius:
            return self.points + self.radius * _CIRCLE
        return np.append(self.points, self.points[:1])


class Body(NamedTuple):
    """Shapes that move together: x + iy of their frame is at place + e^{i turn} (stretch x + iy).

    place: complex; turn: in degrees; stretch: of what seems to become shorter; tint: opacity. Each is (1,) where it is
    always the same, else (1 + m,): at rest, then m moments, of which MOMENTS_PER_TURN make a turn of the crank.
    """

    shapes: tuple[Shape, ...]
    place: ComplexArray
    turn: Array
    stretch: Array
    tint: Array

    @classmethod
    def of(
        cls,
        shapes: Iterable[Shape],
        place: complex | Array | ComplexArray = 0.0,
        turn: Number = 0.0,
        stretch: Number = 1.0,
        tint: Number = 1.0,
    ) -> "Body":
        """Return the body of numbers or arrays."""
        return cls(tuple(shapes), *map(np.atleast_1d, (place, turn, stretch, tint)))

    @property
    def moves(self) -> bool:
        """Whether the body moves or changes."""
        return any(len(values) > 1 for values in self[1:])

    def seen(self, turned: float, mirrored: bool = False, moved: complex = 0.0) -> "Body":
        """Return the body mirrored about the x-axis, turned by degrees about the origin, and moved."""
        shapes, place, turn = self.shapes, self.place, self.turn
        if mirrored:
            shapes = tuple(shape._replace(points=shape.points.conj()) for shape in shapes)
            place, turn = place.conj(), -turn
        place = place * np.exp(1j * np.radians(turned)) + moved
        return self._replace(shapes=shapes, place=place, turn=turn + turned)

    def scaled(self, by: float) -> "Body":
        """Return the body in another unit of length."""
        shapes = tuple(
            shape._replace(points=shape.points * by, radius=shape.radius * by)
            for shape in self.shapes
        )
        return self._replace(shapes=shapes, place=self.place * by)

    def outlines(self) -> list[tuple[str, ComplexArray]]:
        """Return the look and the outline (moments, points) of each shape, wherever it moves."""
        centre, stretch = self.place[:, None], self.stretch[:, None]
        turn = np.exp(1j * np.radians(self.turn))[:, None]
        outlines = []
        for shape in self.shapes:
            line = shape.outline
            moved = centre + turn * (stretch * line.real + 1j * line.imag)
            outlines.append((shape.look, moved))
        return outlines


class Caption(NamedTuple):
    """A text with its middle at a place x + iy; half: half of its width; strong: as a heading."""

    text: str
    place: complex
    half: float
    strong: bool = False


class Panel(NamedTuple):
    """Two axes with what is on them; equal: both have one scale; plain: without axes.

    title: what distinguishes it from the other panels of its picture; bodies: parts of a machine, below the curves, in
    the order in which they cover each other; footnote: what of them is to scale. angle: the crank angle in degrees for
    which it is drawn, where it was chosen.
    """

    x: Axis
    y: Axis
    curves: tuple[Curve, ...] = ()
    shades: tuple[Shade, ...] = ()
    marks: tuple[Mark, ...] = ()
    equal: bool = False
    plain: bool = False
    title: str = ""
    bodies: tuple[Body, ...] = ()
    captions: tuple[Caption, ...] = ()
    footnote: str = ""
    angle: float | None = None

    @property
    def places(self) -> tuple[list[Array], list[Array]]:
        """All x and all y that are drawn."""
        drawn = [curve.x + 1j * curve.y for curve in self.curves]
        for shade in self.shades:
            drawn += [shade.x + 1j * shade.low, shade.x + 1j * shade.high]
        drawn += [np.array([complex(mark.x, mark.y)]) for mark in self.marks]
        for body in self.bodies:
            drawn += [line for _, line in body.outlines()]
        for caption in self.captions:
            left, right = caption.place - caption.half, caption.place + caption.half
            drawn.append(np.array([left, right]))
        return [line.real.ravel() for line in drawn], [line.imag.ravel() for line in drawn]

    def at_moment(self, moment: int) -> "Panel":
        """Return the panel at one moment of its movement."""
        return self._replace(curves=tuple(curve.at_moment(moment) for curve in self.curves))


class Picture(NamedTuple):
    """A picture: its word on the command line, the printed title, and the caption.

    machine: its name; of: the cylinder or bearing, '' where there is one only; across: panels next to each other;
    legend: names of the looks of its curves, where all panels share them.
    """

    id: str
    title: str
    text: str
    panels: tuple[Panel, ...]
    machine: str = ""
    of: str = ""
    across: int = 1
    legend: tuple[tuple[Words, int], ...] = ()

    def __repr__(self) -> str:
        count = len(self.panels)
        panels = "1 panel" if count == 1 else f"{count} panels"
        return f"<kurbel picture {self.id}: {self.heading}, {panels}>"

    @property
    def heading(self) -> str:
        """The line above the picture."""
        title = f"{self.title}: {self.of}" if self.of else self.title
        if not self.machine:
            return title
        return f"{self.machine}. {title}"

    @property
    def rows(self) -> "list[Picture]":
        """Its rows of panels, each as a picture of its own, the last one with the legend."""
        rows = []
        for start in range(0, len(self.panels), self.across):
            row = self.panels[start : start + self.across]
            rows.append(self._replace(panels=row, legend=()))
        if rows:
            rows[-1] = rows[-1]._replace(legend=self.legend)
        return rows


# a long report


FactValue = Union[str, float, tuple[float, str]]
"""A text, a number, or a number with its unit."""


class Grid(NamedTuple):
    """A table of texts and numbers; numbers: its columns of these; verdicts: which rows are `good`, and which `bad`.

    Of each number four digits are shown, unless others are wanted.
    """

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[FactValue, ...], ...]
    numbers: tuple[int, ...] = ()
    verdicts: tuple[str, ...] = ()


class Fact(NamedTuple):
    """A key value on the first page, in SI until it has a unit; where: the parts that have it, if others have less.

    at_deg: its crank angle; side: see `KeyValue`.
    """

    title: str
    value: float
    quantity: Quantity
    where: str
    at_deg: float | None
    unit: str = ""
    side: str = ""

    @property
    def symbol(self) -> str:
        """Its symbol as it is printed."""
        return self.quantity.symbol


class Facts(NamedTuple):
    """Key values next to one another."""

    facts: tuple[Fact, ...]


class Notice(NamedTuple):
    """A highlighted sentence; kind: `good`, `bad` or `warning`."""

    text: str
    kind: str


class Pair(NamedTuple):
    """The same picture of two machines; None for one that does not have it."""

    left: Picture | None
    right: Picture | None


class ReportAnswers(NamedTuple):
    """The key values, tables of places and notes of a report, without what is left out, warnings, and its columns."""

    report: Report


class OverAngle(NamedTuple):
    """The columns of a report over the crank angle."""

    report: Report
    title: str


SectionItem = Union[str, Notice, Grid, Facts, PlaceTable, ReportAnswers, OverAngle, Picture, Pair]


class Section(NamedTuple):
    """A section: its word in links, its title, and its items."""

    id: str
    title: str
    items: tuple[SectionItem, ...]


class Document(NamedTuple):
    """A report on one machine, or on several next to one another.

    subtitles: what kind of machine each is; summary: what is on the first page; prints_tables: whether the tables over
    the crank angle are printed, too.
    """

    title: str
    subtitles: tuple[str, ...]
    summary: tuple[SectionItem, ...]
    sections: tuple[Section, ...]
    provenance: tuple[Provenance, ...]
    prints_tables: bool = False
