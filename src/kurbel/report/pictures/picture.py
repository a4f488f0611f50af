"""What a picture is made of, whatever draws it: curves, shades and marks on panels with two axes, in units as shown."""

from dataclasses import dataclass
from typing import NamedTuple

from kurbel.arrays import Array


class Words(NamedTuple):
    """A symbol as it is printed, and where there are no Greek letters, if not by what stands for each of its signs."""

    symbol: str
    ascii_symbol: str = ""


@dataclass(frozen=True, eq=False)
class Axis:
    """What runs along an axis, and its unit; log: by powers of ten; names: what stands at 0, 1, … instead of numbers.

    low, high: how far the axis must reach at least, whatever is drawn; falling: large values stand on the left.
    """

    name: Words
    unit: str
    log: bool = False
    low: float | None = None
    high: float | None = None
    falling: bool = False
    names: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Piece:
    """Points of a curve without a jump, in the units of the axes, (n,).

    degrees, within: at which crank angles they were computed, and on which side of jumps; None where they have none.
    """

    x: Array
    y: Array
    degrees: Array | None = None
    within: Array | None = None


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve: pieces that follow one another, a jump between two of them.

    kind: `line`; `faint`, a line to compare with, such as a mean; of mechanisms `member`, `guide`, and the points
    `joint` and `fixed`; `dots`, points that are joined; look: which of the looks it has, where that is not its place
    among the lines of its panel.
    """

    name: Words
    pieces: tuple[Piece, ...]
    kind: str = "line"
    look: int | None = None


@dataclass(frozen=True, eq=False)
class Figure:
    """A figure that is written into a picture: symbol, value and unit, and the crank angle at which it stands."""

    name: Words
    value: float | None = None
    unit: str = ""
    at_deg: float | None = None


@dataclass(frozen=True, eq=False)
class Mark:
    """A point with its figure."""

    x: float
    y: float
    figure: Figure


@dataclass(frozen=True, eq=False)
class Shade:
    """The surface between two lines over the same places x (n,); `gain`: it counts positive.

    figure: what is written into it, at its widest place.
    """

    x: Array
    low: Array
    high: Array
    gain: bool = True
    figure: Figure | None = None


@dataclass(frozen=True, eq=False)
class Arrow:
    """A force that acts at a point: its ends, and what it is called."""

    tail: tuple[float, float]
    head: tuple[float, float]
    name: Words


class Panel(NamedTuple):
    """Two axes with what stands on them; equal: both have one scale; plain: nothing is written at the axes.

    title: what tells it from the other panels of its picture; frames: how it moves, round and round,
    by panels with as many curves, points and arrows.
    """

    x: Axis
    y: Axis
    curves: tuple[Curve, ...] = ()
    shades: tuple[Shade, ...] = ()
    marks: tuple[Mark, ...] = ()
    arrows: tuple[Arrow, ...] = ()
    equal: bool = False
    plain: bool = False
    title: str = ""
    frames: "tuple[Panel, ...]" = ()


@dataclass(frozen=True, eq=False)
class Picture:
    """A picture: its word on the command line, the printed title, and a sentence that says what is seen.

    machine: its name; of: the cylinder, '' where there is one only; across: how many panels stand side by side;
    legend: what the looks of its curves stand for, where that is told once for all panels.
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
        """What stands over the picture."""
        return ". ".join(filter(None, (self.machine, f"{self.title}: {self.of}" if self.of else self.title)))
