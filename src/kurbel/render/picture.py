"""The layout of a panel, for paper and terminal: scales, ticks, and labels in free space."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray, Number
from kurbel.pictures.picture import Axis, Curve, PageFigure, Panel, Picture, Words
from kurbel.render import Look
from kurbel.render.text import cell, folded, head_scale, width

_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
_DEGREES = (15.0, 30.0, 45.0, 90.0, 180.0, 360.0)
_ROUNDING = 1e-9
"""Height of a curve, relative to its size, that is only rounding error."""
_AIR = 0.12
"""Free space of a panel above and below its curves, relative to their height."""
_MOST_MARKED = 12
_TAKEN = 1e6
"""What it costs a label to cover another one."""
LOOKS = 6
"""Different colours and strokes of curves."""


# texts


def symbol(words: Words, look: Look) -> str:
    """Return a symbol in the characters of the output."""
    return look.text(look.symbol(words.symbol, words.ascii_symbol or words.symbol))


def axis_text(axis: Axis, look: Look) -> str:
    """Return the title of an axis: words, symbol, unit."""
    words, unit = look.text(axis.name.words), look.unit(axis.unit)
    name = f"{words[:1].upper()}{words[1:]} {symbol(axis.name, look)}".strip()
    return f"{name} in {unit}" if name and unit else name or unit


def legend_text(words: Words, look: Look) -> str:
    """Return a symbol with its words."""
    return f"{symbol(words, look)} {look.text(words.words)}".strip()


def figure_text(figure: PageFigure, look: Look) -> str:
    """Return a figure: symbol, value, unit, and its crank angle."""
    name, at = (
        symbol(figure.name, look),
        "" if figure.at_deg is None else look.degrees(figure.at_deg),
    )
    if figure.value is None:
        return f"{name} {at}".strip()
    value, unit = look.measured(figure.value, figure.unit)
    text = f"{name} {look.fine(value)} {unit}".strip()
    return f"{text}, {at}" if at else text


def picture_text(picture: Picture, look: Look) -> str:
    """Return a picture in words: what it shows, and every figure in it."""
    figures = [
        mark.figure for panel in picture.panels for mark in panel.marks if mark.figure.name.symbol
    ]
    figures += [shade.figure for panel in picture.panels for shade in panel.shades if shade.figure]
    texts = "; ".join(dict.fromkeys(figure_text(figure, look) for figure in figures))
    sentence = f"{look.text(picture.heading)}. {look.text(picture.text)}"
    return f"{sentence} {texts}." if texts else sentence


# scales


class AxisScale(NamedTuple):
    """The places `start` and `end` of the values `low` and `high` on an axis."""

    axis: Axis
    low: float
    high: float
    start: float = 0.0
    end: float = 1.0

    def place(self, values: Number) -> Array:
        """Return the places of values."""
        low, high, at = (
            np.log10(one) if self.axis.log else np.asarray(one)
            for one in (self.low, self.high, values)
        )
        # what is between two dots goes to the same one on every processor, whose sines differ in the last digit
        return np.round(self.start + (at - low) / (high - low) * (self.end - self.start), 9)


def axis_scale(axis: Axis, drawn: list[Array], air: bool, level: bool) -> AxisScale:
    """Return the scale from 0 to 1 of an axis, which includes all that is drawn.

    air: with free space around it; level: a level line is in the middle.
    """
    every = np.concatenate(
        [*map(np.ravel, drawn), [one for one in (axis.low, axis.high) if one is not None]]
    )
    low, high = (float(np.nanmin(every)), float(np.nanmax(every))) if len(every) else (0.0, 0.0)
    if axis.log:
        low, high = 10.0 ** math.floor(math.log10(low)), 10.0 ** math.ceil(math.log10(high) or 1)
    elif level and high - low <= _ROUNDING * max(abs(low), abs(high)):
        low, high = low - (0.1 * abs(low) or 1.0), high + (0.1 * abs(high) or 1.0)
    elif air:
        below = 0.0 if low == axis.low else _AIR * (high - low)
        low, high = low - below, high + _AIR * (high - low)
    return AxisScale(axis, high, low) if axis.falling else AxisScale(axis, low, high)


def ticks(scale: AxisScale, most: int, look: Look) -> list[tuple[float, str]]:
    """Return the ticks of an axis, at most so many or a few more: place and text, with the decimals that all need."""
    axis, (low, high) = scale.axis, sorted((scale.low, scale.high))
    if axis.names:
        values = [float(number) for number in range(len(axis.names)) if low <= number <= high]
        texts = [axis.names[int(value)] for value in values]
    elif axis.log:
        powers = range(round(math.log10(low)), round(math.log10(high)) + 1)
        values = [10.0**power for power in powers[:: max(1, -(-len(powers) // most))]]
        texts = [f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e") for value in values]
    else:
        least = (high - low) / max(most, 1)
        power = 10.0 ** math.floor(math.log10(least))
        steps = [step for step in _DEGREES if step >= least > 10.0] if axis.unit == "deg" else []
        step = (steps or [one * power for one in _STEPS if one * power >= least * (1 - 1e-9)])[0]
        first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
        values = [float(f"{number * step:.12g}") for number in range(first, last + 1)]
        small = len(values) > 1 and values[-1] - values[0] < 1e-4
        short = small or max(map(abs, values), default=0.0) >= 1e6
        texts = [
            look.fine(f"{value:.4g}" if short else cell(value, head_scale(values)))
            for value in values
        ]
    return [(float(scale.place(value)), text) for value, text in zip(values, texts)]


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
    """The label of a point x + iy in its place, between left and right, below top.

    look: of the curve that it names; lead: the end of the line to its point, if that is far away.
    """

    text: str
    point: complex
    look: int | None
    left: float
    right: float
    top: float
    lead: complex | None


class PanelFrame:
    """A panel in a rectangle; places x + iy count rightward and downward from its upper left corner.

    tall: its height; with equal scales the height follows from the width.
    """

    def __init__(self, panel: Panel, look: Look, medium: Medium, wide: float, tall: float) -> None:
        self.panel, self.look, self.medium, self.wide = panel, look, medium, wide
        across, up = panel.places
        bare = not panel.bodies  # which leave no air around them
        x = axis_scale(panel.x, across, bare and (panel.plain or panel.equal), not panel.equal)
        y = axis_scale(panel.y, up, bare, not panel.equal)
        if panel.equal:
            sizes = np.array([x.high - x.low, y.high - y.low])
            least = (
                medium.shortest if panel.plain else min(0.8 * wide, 2 * medium.shortest)
            )  # a flat curve has room
            tall = min(max(wide * sizes[1] / sizes[0] if sizes[0] else 0.0, least), medium.tallest)
            room = np.array([wide, tall])
            spare = (max(*(sizes / room), _ROUNDING) * room - sizes) / 2
            x, y = (
                one._replace(low=one.low - more, high=one.high + more)
                for one, more in zip((x, y), spare)
            )
        self.tall, self.x, self.y = tall, x._replace(end=wide), y._replace(start=tall, end=0.0)
        names, between = panel.x.names, abs(self.points_per_unit)
        numeric = all(name.replace(".", "", 1).isdecimal() for name in names)
        if not numeric and any((width(name) + 1) * medium.letter > between for name in names):
            # names that do not fit below the axis have numbers there, and follow it
            key = ", ".join(
                f"{number} {name}".replace(" ", "\N{NO-BREAK SPACE}")
                for number, name in enumerate(names, 1)
            )
            numbers = tuple(str(number) for number, _ in enumerate(names, 1))
            self.x = self.x._replace(axis=panel.x._replace(name=Words(key), names=numbers))
        self.below = folded(axis_text(self.x.axis, look), int(wide / medium.letter))
        """What is written below the axis, line by line."""

    @property
    def points_per_unit(self) -> float:
        """How long one unit of the x-axis is."""
        return (self.x.end - self.x.start) / (self.x.high - self.x.low)

    def place(self, x: Array | float, y: Array | float) -> ComplexArray:
        """Return the places of points."""
        return self.x.place(x) + 1j * self.y.place(y)

    def ticks_across(self, most: int, start: float, end: float) -> list[tuple[float, float, str]]:
        """Return the ticks of the lower axis: place, left end of the text, and text, '' where it would meet another.

        start, end: how far texts may reach.
        """
        every, found = ticks(self.x, most, self.look), []
        wide = [width(text) * self.medium.letter for _, text in every]
        apart = min(np.abs(np.diff([place for place, _ in every])), default=math.inf)
        of_each = max(math.ceil((max(wide, default=0.0) + self.medium.grain[0]) / apart), 1)
        for number, (place, text) in enumerate(every):
            left = max(min(place - wide[number] / 2, end - wide[number]), start)
            found.append((place, left, "" if number % of_each else text))
        return found

    def labels(self, named: bool) -> list[Label]:
        """Return the labels of faint lines, marks and shades; named: of forces and of several curves, too.

        Each is on the nearest ground that no other label has and no curve crosses; without room it is left out. Marks
        far from theirs have a line to it; mere angles, which come after them, are only where there is room nearby.
        """
        panel, look, letter = self.panel.at_moment(0), self.look, self.medium.letter
        tracks = [self._track(curve) for curve in panel.curves]
        around = np.add.outer([-1.0, 0.0, 1.0], [-1j, 0j, 1j]).ravel() * self.medium.dot
        points = [(mark.x, mark.y) for mark in panel.marks]
        points += [(one.x[0], one.y[0]) for one in panel.curves if one.kind == "pole"]
        ground = self.medium.covering * self._cells(tracks)
        ground += _TAKEN * self._cells([self.place(*point) + around for point in points])
        placed: list[Label | None] = []

        def label(
            text: str,
            point: ComplexArray,
            of: int | None = None,
            led: bool = False,
            near: bool = False,
        ) -> None:
            placed.append(self._on_free_ground(ground, text, complex(point), of, led, near))

        symbols = [symbol(curve.name, look) for curve in panel.curves]
        for curve, text in zip(panel.curves, symbols):
            if text and (curve.kind == "faint" or (named and curve.kind in ("arrow", "force"))):
                label(text, self.place(curve.x[-1], curve.y[-1]))
        every = zip(panel.curves, symbols, looks_of(panel), (track[::4] for track in tracks))
        lines = [one for one in every if one[1] and one[0].kind in ("line", "dots")]
        for curve, text, number, own in lines if named and len(lines) > 1 else ():
            others = np.concatenate([track for other, _, _, track in lines if other is not curve])
            label(text, own[np.abs(own[:, None] - others).min(axis=1).round(6).argmax()], number)
        figures = [mark for mark in panel.marks if mark.figure.name.symbol][:_MOST_MARKED]
        for mark in (*figures, *(mark for mark in panel.marks if not mark.figure.name.symbol)):
            led = bool(mark.figure.name.symbol)
            label(figure_text(mark.figure, look), self.place(mark.x, mark.y), led=led, near=not led)
        shades = [
            (one, one.figure, figure_text(one.figure, look)) for one in panel.shades if one.figure
        ]
        # their names alone where not each figure has the room
        roomy = all(width(text) * letter <= np.ptp(self.x.place(one.x)) for one, _, text in shades)
        for shade, figure, text in shades:
            widest = int(np.argmax(np.abs(shade.high - shade.low)))
            middle = self.place(shade.x[widest], (shade.high[widest] + shade.low[widest]) / 2)
            label(text if roomy else symbol(figure.name, look), middle)
        return [one for one in placed if one]

    def _track(self, curve: Curve) -> ComplexArray:
        """Return places along a curve, no farther apart than a quarter of a cell of the grid."""
        wide, tall = (one / 4 for one in self.medium.grain)
        pieces = [self.place(*piece) for piece in (*curve.pieces(), *curve.jumps())]
        lines = [dense(one.real / wide, one.imag / tall) for one in pieces]
        return np.concatenate([x * wide + 1j * y * tall for x, y in lines])

    def _cells(self, lines: Sequence[ComplexArray]) -> Array:
        """Return 1 for the cells (rows, columns) of the grid in which one of these places is, else 0."""
        (wide, tall), dot = self.medium.grain, self.medium.dot
        rows, columns = math.ceil((self.tall - dot) / tall), math.ceil((self.wide - dot) / wide)
        places = np.concatenate([*lines, np.empty(0, dtype=complex)])
        bounds = (0.0, rows * tall), (0.0, columns * wide)
        return np.sign(np.histogram2d(places.imag, places.real, (rows, columns), bounds)[0])

    def _on_free_ground(
        self, ground: Array, text: str, point: complex, look: int | None, led: bool, near: bool
    ) -> Label | None:
        """Return a label in its place, whose cells are then taken, or None where labels leave no room for it.

        What it costs to be somewhere is the distance from its point, and what the ground that it covers costs.
        """
        x, y, grain = point.real, point.imag, self.medium.grain
        wide, tall = width(text) * self.medium.letter, self.medium.line
        rows, columns = math.ceil(tall / grain[1]), math.ceil(wide / grain[0])
        if rows > ground.shape[0] or columns > ground.shape[1]:
            return None
        sums = np.pad(ground.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
        strips = sums[rows:] - sums[:-rows]
        covered = strips[:, columns:] - strips[:, :-columns]
        left, top = (
            grain[0] * np.arange(covered.shape[1]),
            grain[1] * np.arange(covered.shape[0])[:, None],
        )
        across, down = np.clip(x, left, left + wide) - x, np.clip(y, top, top + tall) - y
        off_middle = np.abs(left + wide / 2 - x) + np.abs(top + tall / 2 - y)
        cost = (np.hypot(across, down) + 0.05 * off_middle + covered).round(6)
        row, column = np.unravel_index(cost.argmin(), cost.shape)
        if cost[row, column] >= (2 * tall if near else _TAKEN):
            return None
        ground[row : row + rows, max(column - 1, 0) : column + columns + 1] = _TAKEN
        start, height = float(left[column]), float(top[row, 0])
        end = point + complex(across[column], down[row, 0])
        far = led and abs(end - point) > 1.2 * tall
        return Label(text, point, look, start, start + wide, height, end if far else None)


def looks_of(panel: Panel) -> list[int]:
    """Return the number of the colour and stroke of each curve of a panel: lines take one after the other."""
    found, following = [], 0
    for curve in panel.curves:
        found.append((following if curve.look is None else curve.look) % LOOKS)
        following += curve.kind in ("line", "dots")
    return found


def dense(x: Array, y: Array) -> tuple[Array, Array]:
    """Return points along a line x, y (n,), neither coordinate of neighbours more than 1 apart."""
    steps = np.maximum(
        np.ceil(np.maximum(np.abs(np.diff(x)), np.abs(np.diff(y))) - 1e-6), 1
    ).astype(int)
    numbers, ends = np.arange(len(x)), np.append(0, steps.cumsum())
    along = np.interp(np.arange(ends[-1] + 1), ends, numbers)
    return np.interp(along, numbers, x), np.interp(along, numbers, y)
