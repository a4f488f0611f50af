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
    if name and unit:
        return f"{name} in {unit}"
    return name or unit


def legend_text(words: Words, look: Look) -> str:
    """Return a symbol with its words."""
    return f"{symbol(words, look)} {look.text(words.words)}".strip()


def figure_text(figure: PageFigure, look: Look) -> str:
    """Return a figure: symbol, value, unit, and its crank angle."""
    name = symbol(figure.name, look)
    at = ""
    if figure.at_deg is not None:
        at = look.fine(look.degrees(figure.at_deg))
    if figure.value is None:
        return f"{name} {at}".strip()
    value, unit = look.measured(figure.value, figure.unit)
    text = f"{name} {look.fine(value)} {unit}".strip()
    if not at:
        return text
    return f"{text}, {at}"


def panel_title(panel: Panel, look: Look) -> str:
    """Return the title of a panel, its numbers as they are wanted."""
    return look.fine(look.text(panel.title))


def picture_text(picture: Picture, look: Look) -> str:
    """Return a picture in words: what it shows, and every figure in it."""
    figures = []
    for panel in picture.panels:
        figures += [mark.figure for mark in panel.marks if mark.figure.name.symbol]
    for panel in picture.panels:
        figures += [shade.figure for shade in panel.shades if shade.figure]
    texts = "; ".join(dict.fromkeys(figure_text(figure, look) for figure in figures))
    sentence = f"{look.text(picture.heading)}. {look.text(picture.text)}"
    if not texts:
        return sentence
    return f"{sentence} {texts}."


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
        run = np.log10 if self.axis.log else np.asarray
        low, high, value = run(self.low), run(self.high), run(values)
        share = (value - low) / (high - low)
        # what is between two dots goes to the same dot on every processor, whose sines differ in the last digit
        return np.round(self.start + share * (self.end - self.start), 9)


def axis_scale(axis: Axis, drawn: list[Array], air: bool, level: bool) -> AxisScale:
    """Return the scale from 0 to 1 of an axis, which includes all that is drawn.

    air: with free space around it; level: a level line is in the middle.
    """
    bounds = [bound for bound in (axis.low, axis.high) if bound is not None]
    values = np.concatenate([*map(np.ravel, drawn), bounds])
    low, high = 0.0, 0.0
    if len(values):
        low, high = float(np.nanmin(values)), float(np.nanmax(values))

    is_level = high - low <= _ROUNDING * max(abs(low), abs(high))
    if axis.log:
        low, high = _log_values(low, high)[[0, -1]].tolist()
    elif level and is_level:
        low -= 0.1 * abs(low) or 1.0
        high += 0.1 * abs(high) or 1.0
    elif air:
        height = high - low
        if low != axis.low:
            low -= _AIR * height
        high += _AIR * height
    if axis.falling:
        return AxisScale(axis, high, low)
    return AxisScale(axis, low, high)


def ticks(scale: AxisScale, most: int, look: Look) -> list[tuple[float, str]]:
    """Return the ticks of an axis, at most so many or a few more: place and text, with the decimals that all need."""
    axis = scale.axis
    low, high = sorted((scale.low, scale.high))
    if axis.names:
        values = [float(number) for number in range(len(axis.names)) if low <= number <= high]
        texts = [axis.names[int(value)] for value in values]
    elif axis.log:
        round_values = _log_values(low, high)
        stride = max(1, math.ceil(len(round_values) / most))
        values = round_values[::stride].tolist()
        if high < _MOST_FEW * low:
            texts = [look.fine(f"{value:g}") for value in values]
        else:
            texts = [f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e") for value in values]
    else:
        values = _round_values(low, high, most, in_degrees=axis.unit == "deg")
        texts = _texts_of_ticks(values, look)
    return [(float(scale.place(value)), text) for value, text in zip(values, texts)]


_MOST_FEW = 1000.0
"""Largest over smallest value of a logarithmic axis below which it has 2 and 5 of each power of ten, too."""


def _log_values(low: float, high: float) -> Array:
    """Return the powers of ten from below to above two values; of few powers also 2 and 5 of each."""
    first = math.floor(math.log10(low))
    last = math.ceil(math.log10(high) or 1)
    powers: Array = np.asarray(10.0 ** np.arange(first, last + 1), dtype=float)
    if high >= _MOST_FEW * low:
        return powers
    values = np.sort(np.concatenate((powers, 2 * powers[:-1], 5 * powers[:-1])))
    begin = np.searchsorted(values, low * (1 + _ROUNDING), side="right") - 1
    end = np.searchsorted(values, high * (1 - _ROUNDING))
    return values[begin : max(end, begin + 1) + 1]


def _round_values(low: float, high: float, most: int, in_degrees: bool) -> list[float]:
    """Return the multiples of a round step between two values."""
    least = (high - low) / max(most, 1)
    power = 10.0 ** math.floor(math.log10(least))
    steps = [step * power for step in _STEPS if step * power >= least * (1 - 1e-9)]
    if in_degrees and least > 10.0:
        steps = [step for step in _DEGREES if step >= least] or steps
    step = steps[0]
    first = math.ceil(low / step - 1e-9)
    last = math.floor(high / step + 1e-9)
    return [float(f"{number * step:.12g}") for number in range(first, last + 1)]


def _texts_of_ticks(values: Sequence[float], look: Look) -> list[str]:
    """Return values with the decimals that all need; with powers of ten if they are tiny or huge."""
    are_tiny = len(values) > 1 and values[-1] - values[0] < 1e-4
    are_huge = max(map(abs, values), default=0.0) >= 1e6
    if are_tiny or are_huge:
        return [look.fine(f"{value:.4g}") for value in values]
    scale = head_scale(values)
    return [look.fine(cell(value, scale)) for value in values]


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
        self.panel = panel
        self.look = look
        self.medium = medium
        self.wide = wide

        # bodies leave no air around them
        across, up = panel.places
        is_bare = not panel.bodies
        has_air_across = is_bare and (panel.plain or panel.equal)
        x = axis_scale(panel.x, across, has_air_across, not panel.equal)
        y = axis_scale(panel.y, up, is_bare, not panel.equal)
        if panel.equal:
            x, y, tall = self._with_equal_scales(x, y)
        self.tall = tall
        self.x = x._replace(end=wide)
        self.y = y._replace(start=tall, end=0.0)
        if self._names_overlap():
            self._number_the_names()
        self.below = folded(axis_text(self.x.axis, look), int(wide / medium.letter))
        """What is written below the axis, line by line."""

    def _with_equal_scales(self, x: AxisScale, y: AxisScale) -> tuple[AxisScale, AxisScale, float]:
        """Return scales with the same length of a unit, and the height; a flat curve has room."""
        medium = self.medium
        sizes = np.array([x.high - x.low, y.high - y.low])
        least = medium.shortest
        if not self.panel.plain:
            least = min(0.8 * self.wide, 2 * medium.shortest)
        height = self.wide * sizes[1] / sizes[0] if sizes[0] else 0.0
        tall = min(max(height, least), medium.tallest)

        # what is smaller than its room gets the rest of it on both sides
        room = np.array([self.wide, tall])
        units_per_point = max(*(sizes / room), _ROUNDING)
        margin_x, margin_y = (units_per_point * room - sizes) / 2
        x = x._replace(low=x.low - margin_x, high=x.high + margin_x)
        y = y._replace(low=y.low - margin_y, high=y.high + margin_y)
        return x, y, tall

    def _names_overlap(self) -> bool:
        """Return whether names below the axis are wider than the space between them."""
        names = self.panel.x.names
        space = abs(self.points_per_unit)
        are_numbers = all(name.replace(".", "", 1).isdecimal() for name in names)
        are_wide = any((width(name) + 1) * self.medium.letter > space for name in names)
        return are_wide and not are_numbers

    def _number_the_names(self) -> None:
        """Put numbers below the axis, and the names with their numbers in its title."""
        axis = self.panel.x
        numbers = tuple(str(number) for number in range(1, len(axis.names) + 1))
        pairs = [f"{number} {name}" for number, name in zip(numbers, axis.names)]
        key = ", ".join(pair.replace(" ", "\N{NO-BREAK SPACE}") for pair in pairs)
        self.x = self.x._replace(axis=axis._replace(name=Words(key), names=numbers))

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
        axis_ticks = ticks(self.x, most, self.look)
        widths = [width(text) * self.medium.letter for _, text in axis_ticks]
        space = min(np.abs(np.diff([x for x, _ in axis_ticks])), default=math.inf)
        widest = max(widths, default=0.0) + self.medium.grain[0]
        # every n-th has its text
        stride = max(math.ceil(widest / space), 1)
        placed = []
        for number, ((x, text), wide) in enumerate(zip(axis_ticks, widths)):
            left = max(min(x - wide / 2, end - wide), start)
            placed.append((x, left, "" if number % stride else text))
        return placed

    def labels(self, named: bool) -> list[Label]:
        """Return the labels of faint lines, marks and shades; named: of forces and of several curves, too.

        Each is on the nearest ground that no other label has and no curve crosses; without room it is left out. Marks
        far from theirs have a line to it; mere angles, which come after them, are only where there is room nearby.
        """
        panel = self.panel.at_moment(0)
        tracks = [self._track(curve) for curve in panel.curves]
        ground = self._ground(panel, tracks)
        placed: list[Label | None] = []

        def label(
            text: str,
            point: ComplexArray,
            of: int | None = None,
            led: bool = False,
            near: bool = False,
        ) -> None:
            placed.append(self._on_free_ground(ground, text, complex(point), of, led, near))

        # faint lines, and forces, at their ends
        for curve in panel.curves:
            text = symbol(curve.name, self.look)
            is_named_force = named and curve.kind in ("arrow", "force")
            if text and (curve.kind == "faint" or is_named_force):
                label(text, self.place(curve.x[-1], curve.y[-1]))
        # of several curves each where it is farthest from the others
        if named:
            for text, number, point in self._names_of_curves(panel, tracks):
                label(text, point, number)

        # figures of marks, then mere angles
        with_symbol = [mark for mark in panel.marks if mark.figure.name.symbol][:_MOST_MARKED]
        mere_angles = [mark for mark in panel.marks if not mark.figure.name.symbol]
        for mark in with_symbol:
            label(figure_text(mark.figure, self.look), self.place(mark.x, mark.y), led=True)
        for mark in mere_angles:
            label(figure_text(mark.figure, self.look), self.place(mark.x, mark.y), near=True)

        for text, point in self._names_of_shades(panel):
            label(text, point)
        return [label for label in placed if label]

    def _ground(self, panel: Panel, tracks: Sequence[ComplexArray]) -> Array:
        """Return what it costs a label to cover each cell (rows, columns): curves, and more so points."""
        points = [(mark.x, mark.y) for mark in panel.marks]
        points += [(curve.x[0], curve.y[0]) for curve in panel.curves if curve.kind == "pole"]
        around = np.add.outer([-1.0, 0.0, 1.0], [-1j, 0j, 1j]).ravel() * self.medium.dot
        dots = [self.place(*point) + around for point in points]
        return self.medium.covering * self._cells(tracks) + _TAKEN * self._cells(dots)

    def _names_of_curves(
        self, panel: Panel, tracks: Sequence[ComplexArray]
    ) -> list[tuple[str, int, ComplexArray]]:
        """Return name, number and place of each of several curves: where it is farthest from the others."""
        lines = []
        for curve, number, track in zip(panel.curves, looks_of(panel), tracks):
            text = symbol(curve.name, self.look)
            if text and curve.kind in ("line", "dots"):
                lines.append((text, number, track[::4]))
        if len(lines) < 2:
            return []
        names = []
        for index, (text, number, track) in enumerate(lines):
            others = np.concatenate([line[2] for line in lines[:index] + lines[index + 1 :]])
            distances = np.abs(track[:, None] - others).min(axis=1).round(6)
            names.append((text, number, track[distances.argmax()]))
        return names

    def _names_of_shades(self, panel: Panel) -> list[tuple[str, ComplexArray]]:
        """Return the figures of areas, in their middles; their names alone where not each figure has the room."""
        shades = [shade for shade in panel.shades if shade.figure]
        texts = [figure_text(shade.figure, self.look) for shade in shades if shade.figure]
        letter = self.medium.letter
        have_room = all(
            width(text) * letter <= np.ptp(self.x.place(shade.x))
            for text, shade in zip(texts, shades)
        )
        if not have_room:
            texts = [symbol(shade.figure.name, self.look) for shade in shades if shade.figure]
        middles = []
        for shade in shades:
            widest = int(np.argmax(np.abs(shade.high - shade.low)))
            middle = (shade.high[widest] + shade.low[widest]) / 2
            middles.append(self.place(shade.x[widest], middle))
        return list(zip(texts, middles))

    def _track(self, curve: Curve) -> ComplexArray:
        """Return places along a curve, no farther apart than a quarter of a cell of the grid."""
        wide = self.medium.grain[0] / 4
        tall = self.medium.grain[1] / 4
        pieces = [self.place(*piece) for piece in (*curve.pieces(), *curve.jumps())]
        lines = []
        for piece in pieces:
            x, y = dense(piece.real / wide, piece.imag / tall)
            lines.append(x * wide + 1j * y * tall)
        return np.concatenate(lines)

    def _cells(self, lines: Sequence[ComplexArray]) -> Array:
        """Return 1 for the cells (rows, columns) of the grid in which one of these places is, else 0."""
        wide, tall = self.medium.grain
        dot = self.medium.dot
        rows = math.ceil((self.tall - dot) / tall)
        columns = math.ceil((self.wide - dot) / wide)
        points = np.concatenate([*lines, np.empty(0, dtype=complex)])
        bounds = (0.0, rows * tall), (0.0, columns * wide)
        counts = np.histogram2d(points.imag, points.real, (rows, columns), bounds)[0]
        return np.sign(counts)

    def _on_free_ground(
        self, ground: Array, text: str, point: complex, look: int | None, led: bool, near: bool
    ) -> Label | None:
        """Return a label in its place, whose cells are then taken, or None where labels leave no room for it.

        What it costs to be somewhere is the distance from its point, and what the ground that it covers costs.
        """
        cell_width, cell_height = self.medium.grain
        wide = width(text) * self.medium.letter
        tall = self.medium.line
        columns = math.ceil(wide / cell_width)
        rows = math.ceil(tall / cell_height)
        if rows > ground.shape[0] or columns > ground.shape[1]:
            return None

        # what a label covers at each place, by sums over all cells up to there
        sums = np.pad(ground.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
        strips = sums[rows:] - sums[:-rows]
        covered = strips[:, columns:] - strips[:, :-columns]

        # how far its edge, and its middle, are from the point
        left = cell_width * np.arange(covered.shape[1])
        top = cell_height * np.arange(covered.shape[0])[:, None]
        across = np.clip(point.real, left, left + wide) - point.real
        down = np.clip(point.imag, top, top + tall) - point.imag
        off_middle = np.abs(left + wide / 2 - point.real) + np.abs(top + tall / 2 - point.imag)
        cost = (np.hypot(across, down) + 0.05 * off_middle + covered).round(6)

        row, column = np.unravel_index(cost.argmin(), cost.shape)
        most = 2 * tall if near else _TAKEN
        if cost[row, column] >= most:
            return None
        ground[row : row + rows, max(column - 1, 0) : column + columns + 1] = _TAKEN
        start = float(left[column])
        end = point + complex(across[column], down[row, 0])
        is_far = abs(end - point) > 1.2 * tall
        lead = end if led and is_far else None
        return Label(text, point, look, start, start + wide, float(top[row, 0]), lead)


def looks_of(panel: Panel) -> list[int]:
    """Return the number of the colour and stroke of each curve of a panel: lines take one after the other."""
    looks = []
    next_look = 0
    for curve in panel.curves:
        look = next_look if curve.look is None else curve.look
        looks.append(look % LOOKS)
        if curve.kind in ("line", "dots"):
            next_look += 1
    return looks


def dense(x: Array, y: Array) -> tuple[Array, Array]:
    """Return points along a line x, y (n,), neither coordinate of neighbours more than 1 apart."""
    largest = np.maximum(np.abs(np.diff(x)), np.abs(np.diff(y)))
    steps = np.maximum(np.ceil(largest - 1e-6), 1).astype(int)
    numbers = np.arange(len(x))
    ends = np.append(0, steps.cumsum())
    along = np.interp(np.arange(ends[-1] + 1), ends, numbers)
    return np.interp(along, numbers, x), np.interp(along, numbers, y)
