"""What pictures and long reports are made of, whatever draws them: curves, shades and marks on panels with two axes.

Panels are made in SI; `in_units` of `picture_source` gives them the units in which they are shown.
"""

from itertools import pairwise
from typing import NamedTuple, Union

import numpy as np

from kurbel.arrays import Array
from kurbel.report.tables import PlaceTable, Provenance, Report


class Words(NamedTuple):
    """A symbol as it is printed, its form without Greek letters if that is not each sign by itself, and its words."""

    symbol: str
    ascii_symbol: str = ""
    words: str = ""


class Axis(NamedTuple):
    """What runs along an axis, its kind of quantity and unit; mark: text behind the unit; log: by powers of ten.

    low, high: how far it must reach at least; falling: large values are on the left; names: texts at 0, 1, … instead of
    numbers.
    """

    name: Words
    kind: str = ""
    unit: str = ""
    mark: str = ""
    log: bool = False
    low: float | None = None
    high: float | None = None
    falling: bool = False
    names: tuple[str, ...] = ()


class Curve(NamedTuple):
    """Points x, y (n,), one nan at a jump, more at a gap; of a moving curve (1 + m, n): at rest, then m in a loop.

    kind: `line`, `faint` (to compare with, such as a mean), `dots` joined thinly, `beads`, `pole`; of mechanisms
    `guide`, `member`, `block`, the points `joint` and `fixed`, and `arrow`, a force from its first point to its second.
    look: its colour and stroke, where that is not its place among the lines of its panel.
    """

    name: Words
    x: Array
    y: Array
    kind: str = "line"
    look: int | None = None

    def _parted(self) -> list[tuple[Array, Array]]:
        jumps = np.flatnonzero(np.isnan(self.x))
        starts, ends = [0, *(jumps + 1)], [*jumps, len(self.x)]
        return [(self.x[start:end], self.y[start:end]) for start, end in zip(starts, ends)]

    def pieces(self) -> list[tuple[Array, Array]]:
        """Return the points between jumps and gaps."""
        return [piece for piece in self._parted() if len(piece[0])]

    def jumps(self) -> list[tuple[Array, Array]]:
        """Return the two points of each jump."""
        return [
            (np.array([before[0][-1], after[0][0]]), np.array([before[1][-1], after[1][0]]))
            for before, after in pairwise(self._parted())
            if len(before[0]) and len(after[0])
        ]

    def at_moment(self, moment: int) -> "Curve":
        """Return the curve at one moment of its movement."""
        return self if self.x.ndim == 1 else self._replace(x=self.x[moment], y=self.y[moment])


class PageFigure(NamedTuple):
    """A figure written into a picture: symbol, value with unit, and its crank angle."""

    name: Words
    value: float | None = None
    unit: str = ""
    at_deg: float | None = None


class Mark(NamedTuple):
    """A point with its figure, a value of the upright axis or of the other one."""

    x: float
    y: float
    figure: PageFigure
    of_x: bool = False


class Shade(NamedTuple):
    """The area between two lines over the same places x (n,), positive or not; of two points a bar.

    figure: what is written into it, where it is widest.
    """

    x: Array
    low: Array
    high: Array
    gain: bool = True
    figure: PageFigure | None = None


class Panel(NamedTuple):
    """Two axes with what is on them; equal: both have one scale; plain: without axes.

    title: what distinguishes it from the other panels of its picture.
    """

    x: Axis
    y: Axis
    curves: tuple[Curve, ...] = ()
    shades: tuple[Shade, ...] = ()
    marks: tuple[Mark, ...] = ()
    equal: bool = False
    plain: bool = False
    title: str = ""

    @property
    def places(self) -> tuple[list[Array], list[Array]]:
        """All x and all y that are drawn."""
        across = [curve.x for curve in self.curves] + [shade.x for shade in self.shades]
        up = [curve.y for curve in self.curves] + [line for one in self.shades for line in (one.low, one.high)]
        marked = np.array([(mark.x, mark.y) for mark in self.marks]).reshape(-1, 2)
        return [*across, marked[:, 0]], [*up, marked[:, 1]]

    def at_moment(self, moment: int) -> "Panel":
        """Return the panel at one moment of its movement."""
        return self._replace(curves=tuple(curve.at_moment(moment) for curve in self.curves))


class Picture(NamedTuple):
    """A picture: its word on the command line, the printed title, and a sentence that says what is seen.

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

    @property
    def heading(self) -> str:
        """The line above the picture."""
        return ". ".join(filter(None, (self.machine, f"{self.title}: {self.of}" if self.of else self.title)))


# a long report


Shown = Union[str, float, tuple[float, str]]
"""A text, a number, or a number with its unit."""


class Grid(NamedTuple):
    """A table of texts and numbers; numbers: its columns of these; verdicts: which rows are `good`, and which `bad`.

    Of each number four digits are shown, unless others are wanted.
    """

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[Shown, ...], ...]
    numbers: tuple[int, ...] = ()
    verdicts: tuple[str, ...] = ()


class Fact(NamedTuple):
    """A key value that says much of a machine: title, number and unit, symbol, the part that has it, crank angle."""

    title: str
    value: float
    unit: str
    symbol: str
    where: str = ""
    at_deg: float | None = None


class Facts(NamedTuple):
    """Key values next to one another."""

    facts: tuple[Fact, ...]


class Notice(NamedTuple):
    """A sentence that is to be seen; kind: `good`, `bad` or `warning`."""

    text: str
    kind: str


class Pair(NamedTuple):
    """A picture of each of two machines, None of one that does not have it."""

    left: Picture | None
    right: Picture | None


class Answers(NamedTuple):
    """The key values, tables of places and notes of a report, without what is left out, warnings, and its columns."""

    report: Report


class OverAngle(NamedTuple):
    """The columns of a report over the crank angle."""

    report: Report
    title: str


Item = Union[str, Notice, Grid, Facts, PlaceTable, Answers, OverAngle, Picture, Pair]


class Section(NamedTuple):
    """A section: its word in links, its title, and its items."""

    id: str
    title: str
    items: tuple[Item, ...]


class Document(NamedTuple):
    """A report on one machine, or on several next to one another.

    subtitles: what kind of machine each is; summary: what is on the first page.
    """

    title: str
    subtitles: tuple[str, ...]
    summary: tuple[Item, ...]
    sections: tuple[Section, ...]
    provenance: tuple[Provenance, ...]
