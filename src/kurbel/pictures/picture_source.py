"""The curves of pictures: results sampled so finely that straight lines between the points look like the curve."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from itertools import pairwise
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray, Indices
from kurbel.declared.unit_systems import convert, shown_unit
from kurbel.numerics.extreme import Extreme
from kurbel.pictures.picture import Axis, Curve, Mark, PageFigure, Panel, Shade, Words
from kurbel.quantity import Formula, Of, Quantity
from kurbel.solver.figures import AtAngles, Results
from kurbel.tables.shown import too_large

PHI = "phi"
FINENESS = 1 / 2000
"""Permissible distance of a line of points from its curve, relative to the height: invisible on paper."""
_WIDEST = 7.5  # degrees between two points at first: narrow enough that no wave hides between them
_HALVINGS = 12
_BEADS = 30.0
"""Degrees from one mark to the next along the locus of a tip; every third one has its angle."""
ZERO = "0 at every angle"
_CROSSING = 1e-9
"""Share of the largest distance between two lines that counts as rounding error, where they cross."""
_MOST_SHADES = 100
_CROWDED = 10_000
"""Angles, as those of the samples of a trace, of which a picture shows no more than there is room for."""
_STRETCHES = 2000
"""Stretches of a cycle with so many angles in which each quantity shows its lowest and highest point."""
_JUMP = 1e-9  # of the height of a curve; a smaller step at a break is rounding
NO_NAME = Words("")
AROUND = np.exp(2j * np.pi * np.linspace(0.0, 1.0, 121))
"""A circle."""
NO_WORDS: Mapping[str, str] = {}

CurveFormula = tuple[Words, Formula]
"""A name, and what takes the columns of results at crank angles (n,) and returns values (n,) in SI."""


class PictureOptions(NamedTuple):
    """The unit system; the one cylinder to draw; crank angles in degrees of a mechanism, None where it moves."""

    system: str = "metric"
    cylinder: str | None = None
    angles: Sequence[float] | None = None


class Sampled(NamedTuple):
    """Quantities (k, n) in SI at rising crank angles (n,) in degrees; a break is there twice, with both its sides."""

    degrees: Array
    values: Array

    def curve(self, name: Words, x: Array, y: Array) -> Curve:
        """Return the curve through points x, y (n,) at these angles, with a gap where either jumps."""
        breaks = np.flatnonzero(np.diff(self.degrees) == 0)
        points = np.stack((x, y))
        sizes = np.ptp(points, axis=1, keepdims=True)
        steps = np.abs(np.diff(points)[:, breaks])
        jumps = (steps > _JUMP * sizes).any(axis=0)
        return Curve(name, *np.insert(points, breaks[jumps] + 1, np.nan, axis=1))


def sampled(breaks: Array, values: Callable[[Array, Array], Array]) -> Sampled:
    """Return points so dense that straight lines between them miss no quantity by more than its height × FINENESS.

    breaks: crank angles (m,) in degrees between which all quantities are smooth; values: takes crank angles (n,), and
    angles (n,) that are on the same side of a break, and returns quantities (k, n). Intervals are halved where the
    point in their middle is off the line. Of a crowd of breaks the line goes from one telling break to the next.
    """
    middles = (breaks[:-1] + breaks[1:]) / 2
    shown: Indices = np.arange(len(breaks))
    if len(breaks) > _CROWDED:
        shown = _shown_breaks(breaks, values(breaks[:-1], middles))
        breaks = breaks[shown]
    # angles just after the beginning and just before the end of each piece
    after = middles[shown[:-1]]
    before = middles[shown[1:] - 1]

    # equal steps on each piece, both its ends included
    counts = np.ceil(np.diff(breaks) / _WIDEST).astype(int) + 1
    piece = np.repeat(np.arange(len(counts)), counts)
    first_of_piece = (counts.cumsum() - counts)[piece]
    share = (np.arange(len(piece)) - first_of_piece) / (counts - 1)[piece]
    degrees = np.interp(piece + share, np.arange(len(breaks)), breaks)
    within = np.where(share < 1, after[piece], before[piece])
    points = values(degrees, within)

    # how far a point may be off the line; a constant has only rounding for its height
    heights = np.ptp(points, axis=1) * FINENESS
    rounding = np.abs(points).max(axis=1) * _JUMP
    allowed = np.maximum(heights, rounding)[:, None]

    # left: the points before the intervals that are not known to be straight
    left = np.flatnonzero(np.diff(within) == 0)
    for _ in range(_HALVINGS):
        middle = (degrees[left] + degrees[left + 1]) / 2
        side = within[left]
        exact = values(middle, side)
        on_line = (points[:, left] + points[:, left + 1]) / 2
        is_off = (np.abs(exact - on_line) > allowed).any(axis=0)
        degrees = np.insert(degrees, left + 1, middle)
        within = np.insert(within, left + 1, side)
        points = np.insert(points, left + 1, exact, axis=1)
        # each insertion moves the points after it by one
        halves = (left + np.arange(len(left)))[is_off]
        left = np.sort(np.append(halves, halves + 1))
        if not len(left):
            break
    return Sampled(degrees, points)


def _in_order(angles: Array) -> Array:
    """Return different angles (n,) in ascending order."""
    # not numpy.unique, which loads numpy.ma, a fifth of the whole start-up
    ascending = np.sort(angles)
    return ascending[np.diff(ascending, prepend=-np.inf) > 0]


def _shown_breaks(breaks: Array, points: Array) -> Indices:
    """Return which of a crowd of breaks (m,) a picture needs: the others are between points that it shows.

    points: quantities (k, m - 1) just after each but the last.
    """
    is_shown = np.zeros(len(breaks), dtype=bool)
    is_shown[telling(points, _STRETCHES)] = True
    is_shown[-1] = True
    # what is as wide as a stretch has both its ends
    is_wide = np.diff(breaks) > (breaks[-1] - breaks[0]) / _STRETCHES
    is_shown[:-1] |= is_wide
    is_shown[1:] |= is_wide
    return np.flatnonzero(is_shown)


def telling(points: Array, stretches: int) -> Indices:
    """Return which of very many points (k, m) in order a picture needs: first, lowest and highest of each stretch."""
    # stretches of equally many points, the last one filled up with its last point
    count = points.shape[1]
    size = math.ceil(count / stretches)
    starts = np.arange(0, count, size)
    filled = np.pad(points, ((0, 0), (0, len(starts) * size - count)), mode="edge")
    parts = filled.reshape(len(points), len(starts), size)
    lowest = parts.argmin(axis=2) + starts
    highest = parts.argmax(axis=2) + starts

    is_telling = np.zeros(count, dtype=bool)
    is_telling[starts] = True
    is_telling[lowest] = True
    is_telling[highest] = True
    is_telling[-1] = True
    return np.flatnonzero(is_telling)


class Source:
    """The results of one cylinder, bearing or machine; angles: in degrees at which a mechanism is drawn, if any."""

    def __init__(self, results: Any, angles: Sequence[float] | None) -> None:
        self.results = results
        self.angles = angles
        self.quantities: dict[str, Quantity] = {}
        self.key_values: dict[str, Quantity] = {}
        # others have no columns
        if isinstance(results, Results):
            self.quantities = {column.id: column for column in results.lists.all_columns}
            self.key_values = results.lists.key_values(results.command)

    @cached_property
    def _start(self) -> AtAngles:
        """The columns just after crank angle 0."""
        return self.results.at(np.zeros(1), np.full(1, 1e-3))

    def having(self, *ids: str) -> tuple[str, ...]:
        """Return those of these columns that the results have."""
        return tuple(id for id in ids if id in self.quantities and self._start[id] is not None)

    def words(self, id: str) -> Words:
        """Return the symbol of a column, or of a key value."""
        quantity = self.quantities.get(id) or self.key_values[id]
        return Words(quantity.symbol, quantity.ascii_symbol, quantity.short)

    def axis(self, id: str) -> Axis:
        """Return the axis of a column."""
        return Axis(self.words(id), self.quantities[id].kind)

    def line(self, id: str, words: str = "") -> CurveFormula:
        """Return a column as a line; words: instead of its own."""
        name = self.words(id)
        return name._replace(words=words or name.words), itemgetter(id)

    def values(
        self, lines: Iterable[CurveFormula], degrees: object, within: Array | None = None
    ) -> Array:
        """Return lines (k, n) in SI at crank angles (n,)."""
        degrees = np.atleast_1d(np.asarray(degrees, dtype=float))
        state = self.results.at(degrees, degrees if within is None else within)
        rows = [np.broadcast_to(formula(state), degrees.shape) for _, formula in lines]
        return np.array(rows, dtype=float)

    def samples(
        self,
        id: str,
        lines: Sequence[CurveFormula],
        also: Iterable[float] = (),
        breaks: Sequence[float] | Array | None = None,
    ) -> Sampled:
        """Return lines over the cycle, with points at the angles `also`; id: of a column that is like them.

        breaks: instead of those of the results; beyond the end of the cycle it begins again. Raises UsageError where a
        line has left the range of floats.
        """
        ends = self.results.breaks
        cycle = ends[-1]

        def values(degrees: Array, within: Array) -> Array:
            turned = cycle * np.floor(within / cycle)
            return self.values(lines, degrees - turned, within - turned)

        breaks_of_lines = ends if breaks is None else np.asarray(breaks)
        points = np.array([angle for angle in also if 0 < angle < cycle])
        samples = sampled(_in_order(np.concatenate((breaks_of_lines, points))), values)
        if not np.isfinite(samples.values).all():
            raise too_large(self.quantities[id])
        return samples

    def key_value(self, id: str) -> Any:
        """Return a key value of the results in SI, as it is computed."""
        return self.results.rows.key_values[id].of(self.results)

    def extreme(self, id: str) -> Extreme | None:
        """Return the key value of this id, if there is one and it is an extreme."""
        if id not in self.key_values:
            return None
        value = self.key_value(id)
        return value if isinstance(value, Extreme) else None

    def marks(self, id: str, place: Callable[[float], float | complex] = float) -> tuple[Mark, ...]:
        """Return marks at the extremes of a column, none for a constant; place: see `mark`, at a crank angle."""
        extremes = {}
        for name in (f"{id}_max", f"{id}_min"):
            extreme = self.extreme(name)
            if extreme is not None:
                extremes[name] = extreme
        values = {extreme.value for extreme in extremes.values()}
        is_constant = len(values) < len(extremes)
        if is_constant:
            return ()
        return tuple(
            self.mark(name, extreme, place(extreme.degrees)) for name, extreme in extremes.items()
        )

    def mark(self, id: str, extreme: Extreme, spot: float | complex) -> Mark:
        """Return an extreme, which is the key value of this id, at x, with its value for y, or at a point x + iy."""
        point = spot if isinstance(spot, complex) else complex(spot, extreme.value)
        figure = PageFigure(self.words(id), extreme.value, at_deg=extreme.degrees)
        return Mark(point.real, point.imag, figure)

    def panel(
        self,
        lines: Sequence[str | CurveFormula],
        over: str = PHI,
        like: str = "",
        shaded: bool = False,
        faint: bool = False,
        zero: bool = False,
        also: Iterable[float] = (),
        breaks: Sequence[float] | Array | None = None,
        title: str = "",
        words: Mapping[str, str] = NO_WORDS,
    ) -> Panel:
        """Return a panel of lines over a column: columns of one kind, with their extremes, or others.

        words: of columns, instead of their own. like: column whose axis is the upright one, if that is not the only
        line. shaded: what is between the first line and the last, or zero, if there is one line; faint: the last line,
        to compare with; zero: with the line y = 0.
        """
        # the lines over the column, and the last one faint
        ids = [line for line in lines if isinstance(line, str)]
        named_lines: list[CurveFormula] = []
        for line in lines:
            if isinstance(line, str):
                line = self.line(line, words.get(line, ""))
            named_lines.append(line)
        has_no_common_name = len(ids) > 1 and not like
        like = like or ids[0]
        samples = self.samples(like, [self.line(over), *named_lines], also, breaks)
        x, *rows = samples.values
        curves = [samples.curve(name, x, row) for (name, _), row in zip(named_lines, rows)]
        curves[-1] = curves[-1]._replace(kind="faint" if faint else "line")
        if zero:
            curves.append(level(x))

        shades: Iterable[Shade] = ()
        if shaded:
            base = rows[-1] if len(rows) > 1 else np.zeros_like(x)
            shades = between(x, base, rows[0])

        def place(angle: float) -> float:
            if over == PHI:
                return float(angle)
            return float(self.values([self.line(over)], angle)[0, 0])

        marks: list[Mark] = []
        for id in ids:
            marks += self.marks(id, place)
        up = self.axis(like)
        if has_no_common_name:
            up = up._replace(name=Words("", words=up.kind.replace("_", " ")))
        return Panel(
            self.axis(over),
            up,
            tuple(curves),
            tuple(shades),
            tuple(marks),
            title=title if np.any(rows) else ZERO,
        )

    def panels(
        self, *groups: Sequence[str], words: Mapping[str, str] = NO_WORDS
    ) -> Iterator[Panel]:
        """Yield a panel for each group of columns of one kind, without columns that the results lack."""
        for group in groups:
            ids = self.having(*group)
            if ids:
                yield self.panel(ids, words=words)

    def point(self, tip: Of[ComplexArray], degrees: float, off: float = 0.0) -> complex:
        """Return where a tip is at a crank angle, at a jump on the side of the angle that is so far off."""
        at = np.array([degrees])
        return complex(tip(self.results.at(at, at + off))[0])

    def locus(
        self,
        tip: Of[ComplexArray],
        id: str,
        name: Words,
        title: str = "",
        cycle: float = math.inf,
        largest: tuple[str, Extreme | None] = ("", None),
    ) -> Panel:
        """Return the path of a point with one scale for both axes, and crank angles along it.

        tip: takes the columns of the results at crank angles (n,), returns points x + iy in SI; id: of a column that is
        like them. cycle: degrees after which it repeats, if before the end of the cycle of the machine. largest: its
        largest distance from the pole, with the id of that key value.
        """
        along: tuple[CurveFormula, CurveFormula] = (
            (name, lambda state: tip(state).real),
            (name, lambda state: tip(state).imag),
        )
        samples = self.samples(id, along)

        # beads at equal angles, every third one with its angle
        angles = np.arange(0.0, min(samples.degrees[-1], cycle), _BEADS)
        x, y = self.values(along, angles)
        marks = []
        for index in range(0, len(angles), 3):
            figure = PageFigure(NO_NAME, at_deg=float(angles[index]))
            marks.append(Mark(float(x[index]), float(y[index]), figure))
        key_value, extreme = largest
        if extreme and extreme.value:
            # at a jump it is on one of the two sides
            sides = [self.point(tip, extreme.degrees, off) for off in (-1e-6, 1e-6)]
            nearest = min(sides, key=lambda point: abs(abs(point) - extreme.value))
            marks.insert(0, self.mark(key_value, extreme, nearest))

        closed = samples.curve(name, *samples.values).closed()
        beads = Curve(NO_NAME, x, y, "beads")
        pole = Curve(NO_NAME, np.zeros(1), np.zeros(1), "pole")
        axis = Axis(Words("F"), "force")
        curves = (closed, beads, pole)
        return Panel(axis, axis, curves, marks=tuple(marks), equal=True, title=title)


def curve(kind: str, *corners: complex, name: Words = NO_NAME, look: int | None = None) -> Curve:
    """Return a line through corners x + iy."""
    points = np.array(corners)
    return Curve(name, points.real, points.imag, kind, look)


def level(x: Array, height: float = 0.0, name: Words = NO_NAME) -> Curve:
    """Return a faint horizontal line over the range of x (n,)."""
    return Curve(name, np.array([np.nanmin(x), np.nanmax(x)]), np.full(2, height), "faint")


def between(x: Array, base: Array, line: Array) -> Iterator[Shade]:
    """Yield the areas between two lines, cut at their crossings; if these are too many, all above and all below."""
    apart = line - base
    above = np.where(np.abs(apart) > _CROSSING * np.abs(apart).max(), np.sign(apart), 0.0)
    # a point on the base belongs to the area before it, and to the next one, too
    crossings = np.flatnonzero((above[1:-1] == 0) | (above[1:-1] * above[2:] < 0)) + 1
    if len(crossings) > _MOST_SHADES:
        yield Shade(x, base, np.maximum(line, base))
        yield Shade(x, base, np.minimum(line, base), gain=False)
        return
    for start, end in pairwise((0, *crossings.tolist(), len(x) - 1)):
        part = slice(start, end + 1)
        if above[part].any():
            yield Shade(x[part], base[part], line[part], bool(above[part].sum() > 0))


def in_units(panel: Panel, system: str) -> Panel:
    """Return a panel, which is in SI, in the units of a system: one for each axis, and one for the works in shades."""
    across, up = panel.places
    # bounds of an axis that several panels share
    for bound in (panel.y.low, panel.y.high):
        if bound is not None:
            up = [*up, np.array([bound])]
    if panel.equal:
        across = up = across + up
    works = [np.array([shade.figure.value]) for shade in panel.shades if shade.figure]

    # the unit of each kind, by its largest value
    values_of_kinds = {"energy": works, panel.x.kind: across, panel.y.kind: up}
    units: dict[str, str] = {}
    for kind, arrays in values_of_kinds.items():
        sizes = [float(np.nanmax(np.abs(values))) for values in arrays if values.size]
        units[kind] = shown_unit(kind, system, max(sizes, default=0.0)) if kind else ""
    for mark in panel.marks:
        kind = mark.figure.kind
        if kind and kind not in units:
            units[kind] = shown_unit(kind, system, abs(mark.figure.value or 0.0))
    x = partial(convert, kind=panel.x.kind, unit=units[panel.x.kind])
    y = partial(convert, kind=panel.y.kind, unit=units[panel.y.kind])

    def converted(figure: PageFigure) -> PageFigure:
        kind = figure.kind or panel.y.kind
        value = figure.value and convert(figure.value, kind, units[kind])
        return figure._replace(value=value, unit=units[kind])

    shades = []
    for shade in panel.shades:
        figure = shade.figure and converted(shade.figure)
        shades.append(Shade(x(shade.x), y(shade.low), y(shade.high), shade.gain, figure))
    captions = [
        caption._replace(place=x(caption.place), half=x(caption.half)) for caption in panel.captions
    ]
    return panel._replace(
        x=panel.x.shown(x, units[panel.x.kind]),
        y=panel.y.shown(y, units[panel.y.kind]),
        curves=tuple(curve._replace(x=x(curve.x), y=y(curve.y)) for curve in panel.curves),
        shades=tuple(shades),
        marks=tuple(Mark(x(mark.x), y(mark.y), converted(mark.figure)) for mark in panel.marks),
        bodies=tuple(body.scaled(x(1.0)) for body in panel.bodies),
        captions=tuple(captions),
    )
