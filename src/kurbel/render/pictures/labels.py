"""Where the labels of a picture stand: beside what they name, and not on one another."""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from kurbel.arrays import Array
from kurbel.render import Look
from kurbel.render.numbers import angle, single
from kurbel.render.pictures.scale import tick_text
from kurbel.render.text import width
from kurbel.report.pictures.picture import Axis, Figure, Shade, Words

CHARACTER, LINE = 5.8, 11.0
"""Width and height of a character of a label, in points."""

_COVERED = 6
"""Places of curves that a label may cover beside its point; of more it keeps clear, and a line leads to it."""
_AWAY, _ROWS = (24.0, 44.0, 70.0, 100.0, 140.0), 5
"""How far from its point such a label stands, across in points and up or down in rows."""
_STEPS = 20
"""Along a line that leads to a label, in which it is looked at."""


class Box(NamedTuple):
    """A place that is taken: left, top, right, bottom."""

    left: float
    top: float
    right: float
    bottom: float

    def meets(self, other: "Box") -> bool:
        """Whether two boxes share a place."""
        return (
            self.left < other.right and other.left < self.right and self.top < other.bottom and other.top < self.bottom
        )

    def cuts(self, *line: tuple[float, float]) -> bool:
        """Whether a line from a place to another runs through the box, but for its beginning."""
        return any(self.left < x < self.right and self.top < y < self.bottom for x, y in _along(*line))


class Free(NamedTuple):
    """A place for a label: how much of the curves it covers, its number in the order of preference, and where it is."""

    crossed: int
    number: int
    left: float
    base: float
    box: Box


Try = tuple[float, float, Box]
Pointer = tuple[tuple[float, float], ...]


class Taken:
    """The places that labels have taken within a frame; where they can they stand on no place (n, 2) of a curve.

    ruled: they stand on whole lines from the top of the frame on, their characters half as wide as high, as in a
    terminal.
    """

    def __init__(self, frame: Box, curves: Array, ruled: bool = False) -> None:
        self._frame, self._curves, self._ruled = frame, curves, ruled
        self._character = LINE / 2 if ruled else CHARACTER
        self._boxes: list[Box] = []

    def take(self, box: Box) -> None:
        """Keep a place free of labels."""
        self._boxes.append(box)

    def place(self, x: float, y: float, text: str, upward: bool, clear: bool = False) -> tuple[float, float] | None:
        """Return where a label begins that names a point, above or below it first; None where all is taken.

        clear: it must not stand on a curve.
        """
        found = self._best(self._tries(x, y, text, upward))
        if found is None or (clear and found.crossed):
            return None
        self._boxes.append(found.box)
        return found.left, found.base

    def pointed(self, x: float, y: float, text: str, upward: bool) -> tuple[tuple[float, float], Pointer] | None:
        """Return the same, and the line that leads to a label that would cover much of the curves beside its point."""
        near = self._best(self._tries(x, y, text, upward))
        if near is None or near.crossed > _COVERED:
            away = self._best(self._tries_away(x, y, text), (x, y))
            if away and (near is None or not away.crossed):
                line = _pointer(x, y, away.box)
                self._boxes += [away.box, *(Box(x - 2, y - 2, x + 2, y + 2) for x, y in _along(*line))]
                return (away.left, away.base), line
        if near is None:
            return None
        self._boxes.append(near.box)
        return (near.left, near.base), ()

    def _best(self, tries: Iterator[Try], point: tuple[float, float] | None = None) -> Free | None:
        """Return the first of the free places that cover least of the curves; point: to which a line must lead."""
        free, (x, y) = [], self._curves.T
        for number, (left, base, box) in enumerate(tries):
            inside = box.top >= self._frame.top and box.bottom <= self._frame.bottom and left >= self._frame.left
            if inside and not any(
                box.meets(other) or (point and other.cuts(*_pointer(*point, box))) for other in self._boxes
            ):
                crossed = int(((x > box.left) & (x < box.right) & (y > box.top) & (y < box.bottom)).sum())
                free.append(Free(crossed, number, left, base, box))
                if not crossed:
                    break
        return min(free, default=None)

    def _tries(self, x: float, y: float, text: str, upward: bool) -> Iterator[Try]:
        """Yield where a label may stand, the best first: its left end, its base line, and what it covers."""
        wide = self._character * width(text)
        first, second = (y - 6, y + LINE + 5) if upward else (y + LINE + 5, y - 6)
        shifts = (-wide / 2, 6.0, -wide - 6.0)
        tries = [(x + shift, base) for base in (first, second) for shift in shifts]
        tries += [(x + 7, y + 4), (x - wide - 7, y + 4)]
        lines = (-1, 1, -2, 2, -3, 3) if self._ruled else (-1, 1)
        tries += [(x + shift, base + n * LINE) for n in lines for base in (first, second) for shift in shifts]
        yield from (self._standing(start, base, wide) for start, base in tries)

    def _tries_away(self, x: float, y: float, text: str) -> Iterator[Try]:
        """Yield where a label may stand with a line that leads to it, the nearest first."""
        wide = self._character * width(text)
        ways = [(across, step * LINE) for across in _AWAY for step in range(-_ROWS, _ROWS + 1)]
        for across, down in sorted(ways, key=lambda way: math.hypot(*way)):
            for start in (x + across, x - across - wide):
                if self._frame.left <= start <= self._frame.right - wide:
                    yield self._standing(start, y + 4 + down, wide)

    def _standing(self, start: float, base: float, wide: float) -> Try:
        """Return a label of this width, moved into the frame sideways, and to the nearest line if there are any."""
        left = min(max(start, self._frame.left), self._frame.right - wide)
        if self._ruled:
            base = self._frame.top + LINE * round((base + 2 - self._frame.top) / LINE) - 2
        return left, base, Box(left, base - LINE + 2, left + wide, base + 2)


def _along(*line: tuple[float, float]) -> Iterator[tuple[float, float]]:
    """Yield places along a line, if there is one, but for its beginning, where the mark stands that it leads from."""
    if line:
        (x, y), (to_x, to_y) = line
        yield from ((x + (to_x - x) * k / _STEPS, y + (to_y - y) * k / _STEPS) for k in range(_STEPS // 4, _STEPS + 1))


def _pointer(x: float, y: float, box: Box) -> Pointer:
    """Return the line from a point to the nearer end of a label, some way before it."""
    end = box.left - 3 if box.left > x else box.right + 3
    return (x, y), (end, (box.top + box.bottom) / 2)


def symbol(words: Words, look: Look) -> str:
    """Return a symbol in the characters of the output; what no character must do in it, does nothing."""
    return look.charset.text(look.charset.symbol(words.symbol, words.ascii_symbol or words.symbol))


def signed(number: str, look: Look) -> str:
    """Return a number with a minus sign, where there is one, in place of a hyphen."""
    return f"−{number[1:]}" if number.startswith("-") and look.charset.has("−") else number


def tick_texts(axis: Axis, values: list[float], look: Look) -> list[str]:
    """Return what stands at the ticks of an axis."""
    if axis.names:
        return [axis.names[int(value)] for value in values]
    if axis.log:
        return [f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e") for value in values]
    return [signed(tick_text(value, values, look.comma), look) for value in values]


def axis_text(words: Words, unit: str, look: Look) -> str:
    """Return what stands at the end of an axis."""
    return " in ".join(filter(None, (symbol(words, look), look.charset.unit(unit))))


def figure_text(figure: Figure, look: Look) -> str:
    """Return a figure: symbol, value, unit, and where it stands."""
    text = symbol(figure.name, look)
    if figure.value is not None:
        number, power = single(figure.value, look.digits, look.comma)
        number = look.charset.counted(signed(number, look), power)
        text += f" {number} {look.charset.unit(figure.unit)}".rstrip()
    if figure.at_deg is not None:
        comma = "," if figure.value is not None else ""
        text += f"{comma} {angle(figure.at_deg, look.comma)}{look.charset.text('°')}"
    return text


def shade_texts(shades: Sequence[Shade], look: Look, room: Callable[[Shade], float]) -> list[tuple[Shade, str]]:
    """Return what is written into shades: their figures, or the names alone where not each figure has the room.

    room: how many characters fit between the ends of a shade.
    """
    found = [(one, one.figure, figure_text(one.figure, look)) for one in shades if one.figure]
    fitting = all(width(text) <= room(one) for one, _, text in found)
    return [(one, text if fitting else symbol(figure.name, look)) for one, figure, text in found]
