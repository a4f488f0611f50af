"""A picture laid out on paper: lines, areas and texts at places in points from the upper left corner."""

import re
from dataclasses import dataclass
from typing import Union

import numpy as np

from kurbel.arrays import Array, ComplexArray

Places = tuple[tuple[float, float], ...]


_DOTS = "[\u0307\u0308]"
"""What stands over the letter of a derivative by time."""
_SUBSCRIPT = re.compile(rf"(?:(?<=\b\w)|(?<=\b\w{_DOTS})|(?<=Δ\w))_([^\s|]+?)(?=,?\s|,?$|\|)")


@dataclass(frozen=True, eq=False)
class Line:
    """A line through places, of a class of the style; `parts`: several lines of one look; frames: how it moves."""

    parts: tuple[Places, ...]
    look: str
    closed: bool = False
    frames: tuple[tuple[Places, ...], ...] = ()


@dataclass(frozen=True, eq=False)
class Text:
    """A text at a place, by its start, middle or end; halo: it may stand on lines; frames: where it moves to.

    still: it is of one moment, and stands only where nothing moves; plain: it is a name or a
    number, of which nothing is lowered.
    """

    x: float
    y: float
    text: str
    look: str = "t"
    anchor: str = "start"
    halo: bool = False
    frames: Places = ()
    still: bool = False
    plain: bool = False

    @property
    def levels(self) -> list[str]:
        """What stands on the line and what below it as subscripts, in turn.

        >>> Text(0, 0, "T_max 5.1 kN").levels, Text(0, 0, "F_x, F_y in N").levels
        (['T', 'max', ' 5.1 kN'], ['F', 'x', ', F', 'y', ' in N'])
        >>> Text(0, 0, "my_engine").levels, Text(0, 0, "A_1", plain=True).levels
        (['my_engine'], ['A_1'])
        >>> Text(0, 0, "θ̇_max 6.3 rad/s").levels
        ['θ̇', 'max', ' 6.3 rad/s']
        """
        return [self.text] if self.plain else _SUBSCRIPT.split(self.text)


@dataclass(frozen=True, eq=False)
class Dots:
    """Small figures at places, of a class of the style; corners: of the figure, none for a circle."""

    places: Places
    look: str
    radius: float = 2.6
    frames: tuple[Places, ...] = ()
    corners: Places = ()


Item = Union[Line, Text, Dots]


@dataclass(frozen=True, eq=False)
class Scene:
    """A laid out picture: its size, what stands on it, the later over the earlier, and what it says in words."""

    width: float
    height: float
    items: tuple[Item, ...]
    words: str
    seconds: float = 0.0


def thinned(x: Array, y: Array, within: float = 0.12) -> Places:
    """Return places x, y (n,) without those that lie on a straight line between others, but for `within`."""
    places = x + 1j * y
    kept = np.zeros(len(x), dtype=bool)
    kept[[0, -1]] = True
    while True:
        ends = np.flatnonzero(kept)
        starts, spans = ends[:-1], ends[1:] - ends[:-1]
        start, chord = (np.repeat(each, spans) for each in (starts, places[ends[1:]] - places[starts]))
        far = _distances(places[: ends[-1]] - places[start], chord)
        farthest = np.repeat(np.maximum.reduceat(far, starts), spans)
        tops = np.flatnonzero((far == farthest) & (far > within))
        if not len(tops):
            return tuple(zip(x[kept].tolist(), y[kept].tolist()))
        # of several that lie equally far from a chord the first
        kept[tops[:1]] = kept[tops[1:][start[tops[1:]] != start[tops[:-1]]]] = True


def _distances(reached: ComplexArray, chord: ComplexArray) -> Array:
    """Return how far places x + iy (n,), from the beginnings of chords (n,), lie from these; a chord may be a point."""
    along = np.divide(reached, chord, out=np.zeros_like(reached), where=chord != 0).real
    return np.asarray(np.abs(reached - np.minimum(np.maximum(along, 0.0), 1.0) * chord))
