"""Where the labels of a picture stand: beside what they name, and not on one another."""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from kurbel.arrays import Array
from kurbel.render import Look
from kurbel.render.charset import width
from kurbel.render.numbers import angle, single
from kurbel.render.pictures.scale import tick_text
from kurbel.report.pictures.picture import Axis, Figure, Shade, Words

CHARACTER, LINE = 5.8, 11.0
"""Width and height of a character of a label, in points."""


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


class Taken:
    """The places that labels have taken within a frame; where they can they stand on no place (n, 2) of a curve.

    ruled: they stand on whole lines from the top of the frame on, their characters half as wide as high, as in a
    terminal.
    """

    def __init__(self, frame: Box, curves: Array, ruled: bool = False) -> None:
        self._frame, self._curves, self._ruled = frame, curves, ruled
        self._boxes: list[Box] = []

    def take(self, box: Box) -> None:
        """Keep a place free of labels."""
        self._boxes.append(box)

    def _on_curves(self, box: Box) -> int:
        x, y = self._curves.T
        return int(((x > box.left) & (x < box.right) & (y > box.top) & (y < box.bottom)).sum())

    def place(self, x: float, y: float, text: str, upward: bool, clear: bool = False) -> tuple[float, float] | None:
        """Return where a label begins that names a point, above or below it first; None where all is taken.

        clear: it must not stand on a curve.
        """
        free = []
        for number, (left, base, box) in enumerate(self._tries(x, y, text, upward)):
            inside = box.top >= self._frame.top and box.bottom <= self._frame.bottom and left >= self._frame.left
            if inside and not any(box.meets(other) for other in self._boxes):
                free.append((self._on_curves(box), number, left, base, box))
        if not free:
            return None
        crossed, _, left, base, box = min(free)
        if clear and crossed:
            return None
        self._boxes.append(box)
        return left, base

    def _tries(self, x: float, y: float, text: str, upward: bool) -> Iterator[tuple[float, float, Box]]:
        """Yield where a label may stand, the best first: its left end, its base line, and what it covers."""
        wide = (LINE / 2 if self._ruled else CHARACTER) * width(text)
        first, second = (y - 6, y + LINE + 5) if upward else (y + LINE + 5, y - 6)
        shifts = (-wide / 2, 6.0, -wide - 6.0)
        tries = [(x + shift, base) for base in (first, second) for shift in shifts]
        tries += [(x + 7, y + 4), (x - wide - 7, y + 4)]
        lines = (-1, 1, -2, 2, -3, 3) if self._ruled else (-1, 1)
        tries += [(x + shift, base + n * LINE) for n in lines for base in (first, second) for shift in shifts]
        for start, base in tries:
            left = min(max(start, self._frame.left), self._frame.right - wide)
            if self._ruled:
                base = self._frame.top + LINE * round((base + 2 - self._frame.top) / LINE) - 2
            yield left, base, Box(left, base - LINE + 2, left + wide, base + 2)


def symbol(words: Words, look: Look) -> str:
    """Return a symbol in the characters of the output; what no character must do in it, does nothing."""
    return look.charset.text(look.charset.symbol(words.symbol, words.ascii_symbol))


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
        text += f"{',' if figure.value is not None else ''} {angle(figure.at_deg, look.comma)}{look.charset.degree}"
    return text


def shade_texts(shades: Sequence[Shade], look: Look, room: Callable[[Shade], float]) -> list[tuple[Shade, str]]:
    """Return what is written into shades: their figures, or the names alone where not each figure has the room.

    room: how many characters fit between the ends of a shade.
    """
    found = [(one, one.figure, figure_text(one.figure, look)) for one in shades if one.figure]
    fitting = all(width(text) <= room(one) for one, _, text in found)
    return [(one, text if fitting else symbol(figure.name, look)) for one, figure, text in found]
