"""Where everything of a panel is placed, on paper and in a terminal alike: scales, ticks, and labels on free ground."""

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray, Indices
from kurbel.render import Look
from kurbel.render.numbers import angle, angle_scale, cell, decimal, single
from kurbel.render.text import width
from kurbel.report.picture import Axis, Curve, Figure, Panel, Picture, Shade, Words

_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
_DEGREES = (15.0, 30.0, 45.0, 90.0, 180.0, 360.0)
_AIR = 0.12
"""Share of its height that a panel leaves free above and below its curves."""
_MOST_MARKED = 12
_AROUND = np.array([-1.0, 0.0, 1.0])
LOOKS = 6
"""Different colours and strokes of curves."""

# texts


def symbol(words: Words, look: Look) -> str:
    """Return a symbol in the characters of the output."""
    return look.text(look.symbol(words.symbol, words.ascii_symbol or words.symbol))


def axis_text(axis: Axis, look: Look) -> str:
    """Return what is written at the end of an axis."""
    return " in ".join(filter(None, (symbol(axis.name, look), look.unit(axis.unit))))


def figure_text(figure: Figure, look: Look) -> str:
    """Return a figure: symbol, value, unit, and its crank angle."""
    text, place = symbol(figure.name, look), ""
    if figure.at_deg is not None:
        place = f"{angle(figure.at_deg, look.comma)}{look.text('°')}"
    if figure.value is None:
        return f"{text} {place}".rstrip()
    number, power = single(figure.value, look.digits, look.comma)
    number = look.counted(_signed(number, look), power)
    text = f"{text} {number} {look.unit(figure.unit)}".rstrip()
    return f"{text}, {place}" if place else text


def picture_text(picture: Picture, look: Look) -> str:
    """Return a picture in words: what it shows, and every figure in it."""
    figures = [mark.figure for panel in picture.panels for mark in panel.marks]
    figures += [shade.figure for panel in picture.panels for shade in panel.shades if shade.figure]
    texts = "; ".join(dict.fromkeys(figure_text(figure, look) for figure in figures))
    sentence = f"{look.text(picture.heading)}. {look.text(picture.text)}"
    return f"{sentence} {texts}." if texts else sentence


def _signed(number: str, look: Look) -> str:
    """Return a number with a minus sign in place of a hyphen."""
    return f"−{number[1:]}" if number.startswith("-") and look.has("−") else number


# scales


class AxisScale(NamedTuple):
    """The places `start` and `end` of the values `low` and `high` on an axis; log: by powers of ten."""

    low: float
    high: float
    start: float = 0.0
    end: float = 1.0
    log: bool = False

    def place(self, values: Any) -> Any:
        """Return the places of values."""
        low, high, at = (np.log10(one) if self.log else one for one in (self.low, self.high, values))
        # what is between two dots goes to the same one on every processor, whose sines differ in the last digit
        return np.round(self.start + (at - low) / (high - low) * (self.end - self.start), 9)

    def ticks(self, axis: Axis, most: int) -> list[float]:
        """Return the values, at most so many or a few more, at which an axis has ticks."""
        low, high = sorted((self.low, self.high))
        if axis.names:
            return [float(number) for number in range(len(axis.names)) if low <= number <= high]
        if self.log:
            powers = range(round(math.log10(low)), round(math.log10(high)) + 1)
            return [10.0**power for power in powers[:: max(1, -(-len(powers) // most))]]
        least = (high - low) / max(most, 1)
        power = 10.0 ** math.floor(math.log10(least))
        steps = [step for step in _DEGREES if step >= least > 10.0] if axis.unit == "deg" else []
        step = (steps or [one * power for one in _STEPS if one * power >= least * (1 - 1e-9)])[0]
        first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
        return [float(f"{number * step:.12g}") for number in range(first, last + 1)]


def scales(panel: Panel) -> tuple[AxisScale, AxisScale]:
    """Return the scales from 0 to 1 of both axes of a panel, which hold all that is drawn, with air around it."""
    across, up = panel.places
    return _scale(panel.x, across, panel.plain), _scale(panel.y, up, True)


def _scale(axis: Axis, drawn: Sequence[Array], air: bool) -> AxisScale:
    every = np.concatenate([*map(np.ravel, drawn), [one for one in (axis.low, axis.high) if one is not None]])
    low, high = (float(np.nanmin(every)), float(np.nanmax(every))) if len(every) else (0.0, 0.0)
    if axis.log:
        low, high = 10.0 ** math.floor(math.log10(low)), 10.0 ** math.ceil(math.log10(high) or 1)
    elif not high > low:  # a level line is in the middle
        low, high = low - (0.1 * abs(low) or 1.0), high + (0.1 * abs(high) or 1.0)
    elif air:
        low, high = low - _AIR * (high - low), high + _AIR * (high - low)
    return AxisScale(high, low, log=axis.log) if axis.falling else AxisScale(low, high, log=axis.log)


def tick_texts(axis: Axis, values: list[float], look: Look) -> list[str]:
    """Return what is written at the ticks of an axis, numbers with the decimals that all of them need."""
    if axis.names:
        return [axis.names[int(value)] for value in values]
    if axis.log:
        return [f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e") for value in values]
    if len(values) > 1 and (values[-1] - values[0] < 1e-4 or max(map(abs, values)) >= 1e6):
        texts = [decimal(f"{value:.4g}", look.comma) for value in values]
    else:
        texts = [cell(value, angle_scale(values), look.comma) for value in values]
    return [_signed(text, look) for text in texts]


# a panel in its place


class Medium(NamedTuple):
    """Sizes in the units of a medium, points or columns: width of a character, height of a line, radius of a mark.

    grain: width and height of the cells of a grid on which labels look for free ground; covering: how far a label moves
    away rather than cover one cell of a curve; shortest, tallest: bounds of the height of a panel with equal scales.
    """

    letter: float
    line: float
    dot: float
    grain: tuple[float, float]
    covering: float
    shortest: float
    tallest: float


class Label(NamedTuple):
    """A text that names a point x + iy; look: of the curve that it names; led: a line leads to it where it is far.

    Once it is placed it is between left and right, below top; lead: the end of that line.
    """

    text: str
    point: complex
    look: int | None = None
    led: bool = False
    left: float = 0.0
    right: float = 0.0
    top: float = 0.0
    lead: complex | None = None


class PanelFrame:
    """A panel in a rectangle; places x + iy count rightward and downward from its upper left corner.

    tall: its height; with equal scales the height follows from the width.
    """

    def __init__(self, panel: Panel, look: Look, medium: Medium, wide: float, tall: float) -> None:
        self.panel, self.look, self.medium, self.wide = panel, look, medium, wide
        x, y = scales(panel)
        if panel.equal:
            across, up = x.high - x.low, y.high - y.low
            tall = min(max(wide * up / across, medium.shortest), medium.tallest)
            spare = max(across / wide, up / tall) * np.array([wide, tall]) - (across, up)
            x, y = (one._replace(low=one.low - more / 2, high=one.high + more / 2) for one, more in zip((x, y), spare))
        self.tall, self.x, self.y = tall, x._replace(end=wide), y._replace(start=tall, end=0.0)

    def place(self, x: Array | float, y: Array | float) -> ComplexArray:
        """Return the places of points."""
        return np.asarray(self.x.place(x) + 1j * self.y.place(y))

    def ticks_across(self, most: int, start: float, end: float) -> list[tuple[float, float, str]]:
        """Return the ticks of the lower axis: place, left end of the text, and text, '' where it would meet another.

        start, end: how far texts may reach. Of two that meet the outer one is written.
        """
        values = self.x.ticks(self.panel.x, most)
        texts = tick_texts(self.panel.x, values, self.look)
        found: list[tuple[float, float, str]] = []
        spans: list[tuple[float, float]] = []
        for k in sorted(range(len(values)), key=lambda k: min(k, len(values) - 1 - k)):
            place, wide = float(self.x.place(values[k])), width(texts[k]) * self.medium.letter
            left = max(min(place - wide / 2, end - wide), start)
            if free := all(left >= right or left + wide <= other for other, right in spans):
                spans.append((left - self.medium.letter, left + wide + self.medium.letter))
            found.append((place, left, texts[k] if free else ""))
        return sorted(found)

    def ticks_up(self, most: int) -> list[tuple[float, str]]:
        """Return the ticks of the axis at the left: place and text."""
        values = self.y.ticks(self.panel.y, most)
        texts = tick_texts(self.panel.y, values, self.look)
        return [(float(self.y.place(value)), text) for value, text in zip(values, texts)]

    def labels(self, named: bool) -> list[Label]:
        """Return the labels of faint lines, marks and shades; named: of forces and of several curves, too.

        Each is on the nearest ground that no other label has and no curve crosses; without room it is left out.
        """
        panel, look, medium = self.panel.at_moment(0), self.look, self.medium
        tracks = [self._track(curve) for curve in panel.curves]
        faint = [curve for curve in panel.curves if curve.kind == "faint" and curve.name.symbol]
        wanted = [Label(symbol(one.name, look), complex(self.place(one.x[-1], one.y[-1]))) for one in faint]
        wanted += self._names(panel, tracks) if named else []
        points = [complex(self.place(mark.x, mark.y)) for mark in panel.marks]
        marks = [Label(figure_text(one.figure, look), point, led=True) for one, point in zip(panel.marks, points)]
        wanted += marks[:_MOST_MARKED]
        wanted += self._works(panel.shades)

        # on a grid: which cells curves cross, and which labels and marks have
        wide, tall = medium.grain
        shape = math.ceil((self.tall - medium.dot) / tall), math.ceil((self.wide - medium.dot) / wide)
        crossed, taken = np.zeros(shape, dtype=int), np.zeros(shape, dtype=int)
        reach = np.add.outer(_AROUND, 1j * _AROUND).ravel() * medium.dot
        for grid, places in ((crossed, tracks), (taken, [point + reach for point in points])):
            for one in places:
                row, column = np.floor(one.imag / tall).astype(int), np.floor(one.real / wide).astype(int)
                inside = (row >= 0) & (row < shape[0]) & (column >= 0) & (column < shape[1])
                grid[row[inside], column[inside]] = 1
        placed = [self._on_free_ground(label, crossed, taken) for label in wanted]
        return [label for label in placed if label]

    def _track(self, curve: Curve) -> ComplexArray:
        """Return places along a curve, no farther apart than a quarter of a cell."""
        across, down = (size / 4 for size in self.medium.grain)
        pieces = [self.place(*piece) for piece in (*curve.pieces(), *curve.jumps())]
        found = [dense(one.real / across, one.imag / down) for one in pieces if one.size]
        return np.concatenate([x * across + 1j * y * down for x, y in found])

    def _names(self, panel: Panel, tracks: list[ComplexArray]) -> Iterator[Label]:
        """Yield the symbol of each force, and of each of several curves where it is farthest from the others."""
        for curve in panel.curves:
            if curve.kind == "arrow":
                yield Label(symbol(curve.name, self.look), complex(self.place(curve.x[1], curve.y[1])))
        tracks = [track[::4] for track in tracks]
        lines = [one for one in zip(panel.curves, looks_of(panel), tracks) if one[0].kind in ("line", "dots")]
        for curve, look, own in lines if len(lines) > 1 else ():
            others = np.concatenate([track for other, _, track in lines if other is not curve])
            farthest = np.abs(own[:, None] - others).min(axis=1).round(6).argmax()
            yield Label(symbol(curve.name, self.look), complex(own[farthest]), look)

    def _works(self, shades: Sequence[Shade]) -> Iterator[Label]:
        """Yield what is written into shades: their figures, or the names alone where not each figure has the room."""
        written = [(shade, shade.figure) for shade in shades if shade.figure]
        texts = [figure_text(figure, self.look) for _, figure in written]
        rooms = [np.ptp(self.x.place(shade.x)) for shade, _ in written]
        if any(width(text) * self.medium.letter > room for text, room in zip(texts, rooms)):
            texts = [symbol(figure.name, self.look) for _, figure in written]
        for (shade, _), text in zip(written, texts):
            widest = int(np.argmax(np.abs(shade.high - shade.low)))
            yield Label(text, complex(self.place(shade.x[widest], (shade.high[widest] + shade.low[widest]) / 2)))

    def _on_free_ground(self, label: Label, crossed: Indices, taken: Indices) -> Label | None:
        """Return a label in its place, whose cells are then taken, or None where labels leave no room for it.

        What it costs to be somewhere is the distance from its point, and more for each cell of a curve that it covers.
        Sums over rectangles of the grid are differences of four of its summed areas.
        """
        x, y, grain = label.point.real, label.point.imag, self.medium.grain
        wide, tall = width(label.text) * self.medium.letter, self.medium.line
        rows, columns = math.ceil(tall / grain[1]), math.ceil(wide / grain[0])
        if rows > taken.shape[0] or columns > taken.shape[1]:
            return None
        areas = [np.pad(grid.cumsum(0).cumsum(1), ((1, 0), (1, 0))) for grid in (crossed, taken)]
        on_curves, on_labels = (
            area[rows:, columns:] - area[:-rows, columns:] - area[rows:, :-columns] + area[:-rows, :-columns]
            for area in areas
        )
        left, top = grain[0] * np.arange(on_curves.shape[1]), grain[1] * np.arange(on_curves.shape[0])[:, None]
        across = np.maximum(np.maximum(left - x, x - left - wide), 0.0)
        down = np.maximum(np.maximum(top - y, y - top - tall), 0.0)
        off_middle = np.abs(left + wide / 2 - x) + np.abs(top + tall / 2 - y)
        cost = np.hypot(across, down) + 0.05 * off_middle + self.medium.covering * on_curves
        cost = np.where(on_labels > 0, np.inf, cost.round(6))
        row, column = np.unravel_index(cost.argmin(), cost.shape)
        if np.isinf(cost[row, column]):
            return None
        taken[row : row + rows, max(column - 1, 0) : column + columns + 1] = 1
        start, height = float(left[column]), float(top[row, 0])
        end = complex(min(max(x, start), start + wide), min(max(y, height), height + tall))
        far = label.led and abs(end - label.point) > 1.2 * tall
        return label._replace(left=start, right=start + wide, top=height, lead=end if far else None)


def looks_of(panel: Panel) -> list[int]:
    """Return the number of the colour and stroke of each curve of a panel: lines take one after the other."""
    found, following = [], 0
    for curve in panel.curves:
        found.append((following if curve.look is None else curve.look) % LOOKS)
        following += curve.kind in ("line", "dots")
    return found


def dense(x: Array, y: Array) -> tuple[Array, Array]:
    """Return points along a line x, y (n,), neither coordinate of neighbours more than 1 apart."""
    steps = np.maximum(np.ceil(np.maximum(np.abs(np.diff(x)), np.abs(np.diff(y)))), 1).astype(int)
    numbers, ends = np.arange(len(x)), np.append(0, steps.cumsum())
    along = np.interp(np.arange(ends[-1] + 1), ends, numbers)
    return np.interp(along, numbers, x), np.interp(along, numbers, y)
