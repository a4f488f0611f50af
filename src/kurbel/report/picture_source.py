"""The curves of pictures: results sampled so finely that straight lines between the points look like the curve."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.unit_systems import convert, shown_unit
from kurbel.numerics.extreme import Extreme
from kurbel.quantity import Quantity
from kurbel.report.frame import too_large
from kurbel.report.picture import Axis, Curve, Mark, PageFigure, Panel, Shade, Words
from kurbel.solver.figures import Results

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
_JUMP = 1e-9  # of the height of a curve; a smaller step at a break is rounding

Values = Callable[[Array, Array], Array]
"""Several quantities (k, n) in SI at crank angles (n,) in degrees, on the sides of jumps that hold `within` (n,)."""


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
        jumps = [np.abs(np.diff(line)[breaks]) > _JUMP * (np.ptp(line) or 1.0) for line in (x, y)]
        gaps = breaks[jumps[0] | jumps[1]] + 1
        return Curve(name, np.insert(x, gaps, np.nan), np.insert(y, gaps, np.nan))


def sampled(breaks: Array, values: Values) -> Sampled:
    """Return points so dense that straight lines between them miss no quantity by more than its height × FINENESS.

    breaks: crank angles (m,) in degrees between which all quantities are smooth. Intervals are halved where the point
    in their middle is off the line; every point is one of `values`.
    """
    counts = np.ceil(np.diff(breaks) / _WIDEST).astype(int)
    ends = np.append(0, counts.cumsum())
    edges = np.interp(np.arange(ends[-1] + 1), ends, breaks)
    low, high, within = edges[:-1], edges[1:], np.repeat((breaks[:-1] + breaks[1:]) / 2, counts)
    at_low, at_high = values(low, within), values(high, within)
    found = [(low, within, at_low), (high, within, at_high)]
    ends_of_all = np.concatenate((at_low, at_high), axis=1)
    height, size = np.ptp(ends_of_all, axis=1), np.abs(ends_of_all).max(axis=1)
    allowed = np.maximum(height * FINENESS, size * _JUMP)[:, None]  # a constant has only rounding for its height
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        at_middle = values(middle, within)
        found.append((middle, within, at_middle))
        off = (np.abs(at_middle - (at_low + at_high) / 2) > allowed).any(axis=0)
        if not off.any():
            break
        low, high = np.append(low[off], middle[off]), np.append(middle[off], high[off])
        at_low = np.concatenate((at_low[:, off], at_middle[:, off]), axis=1)
        at_high = np.concatenate((at_middle[:, off], at_high[:, off]), axis=1)
        within = np.tile(within[off], 2)
    degrees, within, points = (np.concatenate(parts, axis=-1) for parts in zip(*found))
    order = np.lexsort((degrees, within))
    degrees, within, points = degrees[order], within[order], points[:, order]
    new = np.append(True, (np.diff(degrees) != 0) | (np.diff(within) != 0))
    return Sampled(degrees[new], points[:, new])


class Source:
    """The results of one cylinder, bearing or machine; angles: in degrees at which a mechanism is drawn, if any."""

    def __init__(self, results: Any, angles: Sequence[float] | None) -> None:
        self.results, self.angles = results, angles
        self.quantities: dict[str, Quantity] = {}
        self.key_values: dict[str, Quantity] = {}
        if isinstance(results, Results):  # others have no columns
            self.quantities = {one.id: one for one in results.lists.all_columns}
            self.key_values = results.lists.key_values(results.command)
        if self.quantities:
            self._start = results.at(np.zeros(1), np.full(1, 1e-3))

    def having(self, *ids: str) -> tuple[str, ...]:
        """Return those of these columns that the results have."""
        return tuple(id for id in ids if id in self.quantities and self._start[id] is not None)

    def values(self, ids: Sequence[str], degrees: Any, within: Array | None = None) -> Array:
        """Return columns (k, n) in SI at crank angles (n,); φ is one of them."""
        degrees = np.atleast_1d(np.asarray(degrees, dtype=float))
        state = self.results.at(degrees, degrees if within is None else within)
        found = [degrees if id == PHI else np.broadcast_to(state[id], degrees.shape) for id in ids]
        return np.array(found, dtype=float)

    def samples(
        self, ids: Sequence[str], also: Iterable[float] = (), values: Values | None = None, breaks: Array | None = None
    ) -> Sampled:
        """Return columns over the cycle, or other `values` under these ids, with points at the angles `also`.

        breaks: instead of those of the results. Raises UsageError where one has left the range of floats.
        """
        breaks = self.results.breaks if breaks is None else breaks
        # not numpy.unique, which loads numpy.ma, a fifth of the whole start-up
        breaks = np.array(sorted({*breaks.tolist(), *(angle for angle in also if 0 < angle < breaks[-1])}))
        found = sampled(breaks, values or (lambda degrees, within: self.values(ids, degrees, within)))
        for id, line in zip(ids, found.values):
            if not np.isfinite(line).all():
                raise too_large(self.quantities[id])
        return found

    def axis(self, id: str) -> Axis:
        """Return the axis of a column."""
        return Axis(self.words(id), self.quantities[id].kind)

    def words(self, id: str) -> Words:
        """Return the symbol of a column, or of a key value."""
        quantity = self.quantities.get(id) or self.key_values[id]
        return Words(quantity.symbol, quantity.ascii_symbol, quantity.short)

    def marks(self, id: str, place: Callable[[float], Any]) -> tuple[Mark, ...]:
        """Return marks at the extremes of a column, none for a constant; place: crank angle -> x, or x and y.

        Without y the value is used.
        """
        rows = self.results.rows.key_values
        named = {name: rows[name].of(self.results) for name in (f"{id}_max", f"{id}_min") if name in self.key_values}
        found = {name: one for name, one in named.items() if isinstance(one, Extreme)}
        if len({one.value for one in found.values()}) < len(found):
            return ()
        return tuple(self.mark(name, one, *np.atleast_1d(place(one.degrees)).tolist()) for name, one in found.items())

    def mark(self, id: str, extreme: Extreme, x: float, y: float | None = None) -> Mark:
        """Return an extreme, which is the key value of this id, at a place; y: its value, if none is given."""
        figure = PageFigure(self.words(id), extreme.value, at_deg=extreme.degrees)
        return Mark(x, extreme.value if y is None else y, figure)

    def panel(self, ids: Sequence[str], over: str = PHI, zero: bool = False) -> Panel:
        """Return a panel of columns of one kind over another column, with their extremes; zero: with the line y = 0."""
        samples = self.samples((over, *ids))
        x, *lines = samples.values
        curves = [samples.curve(self.words(id), x, line) for id, line in zip(ids, lines)]
        curves += [level(x)] if zero else []
        marks = [mark for id in ids for mark in self.marks(id, lambda angle: self.values((over,), angle)[0])]
        axis, title = self.axis(ids[0]), "" if np.any(lines) else ZERO
        up = axis if len(ids) == 1 else axis._replace(name=Words("", words=axis.kind.replace("_", " ")))
        return Panel(self.axis(over), up, tuple(curves), (), tuple(marks), title=title)

    def panels(self, *groups: tuple[str, ...], over: str = PHI) -> Iterator[Panel]:
        """Yield a panel for each group of columns of one kind, without columns that the results lack."""
        if over == PHI or self.having(over):
            yield from (self.panel(ids, over) for group in groups if (ids := self.having(*group)))

    def locus(
        self,
        ids: Sequence[str],
        tip: Values,
        name: Words,
        marks: tuple[Mark, ...],
        title: str = "",
        cycle: float = math.inf,
    ) -> Panel:
        """Return the path of a point (2, n), made from these columns, with one scale for both axes and crank angles.

        cycle: degrees after which it repeats, if before the end of the cycle of the machine.
        """
        samples = self.samples(ids, values=tip)
        curve, axis = samples.curve(name, *samples.values).closed(), Axis(Words("F"), "force")
        angles = np.arange(0.0, min(samples.degrees[-1], cycle), _BEADS)
        x, y = tip(angles, angles)
        labelled = [Mark(*place) for place in zip(x[::3].tolist(), y[::3].tolist(), map(_at, angles[::3].tolist()))]
        curves = (curve, Curve(Words(""), x, y, "beads"), Curve(Words(""), np.zeros(1), np.zeros(1), "pole"))
        return Panel(axis, axis, curves, marks=(*marks, *labelled), equal=True, title=title)


def _at(degrees: float) -> PageFigure:
    return PageFigure(Words(""), at_deg=degrees)


def level(x: Array, height: float = 0.0, name: Words = Words("")) -> Curve:  # noqa: B008 (immutable)
    """Return a faint horizontal line over the range of x (n,)."""
    return Curve(name, np.array([np.nanmin(x), np.nanmax(x)]), np.full(2, height), "faint")


def in_units(panel: Panel, system: str) -> Panel:
    """Return a panel, which is in SI, in the units of a system: one for each axis, and one for the works in shades."""
    across, up = panel.places
    up.append(np.array([end for end in (panel.y.low, panel.y.high) if end is not None]))  # shared by several panels
    if panel.equal:
        across = up = [*across, *up]
    works = [np.array([shade.figure.value]) for shade in panel.shades if shade.figure]
    kinds = panel.x.kind, panel.y.kind, "energy"
    units = []
    for kind, values in zip(kinds, (across, up, works)):
        largest = max((float(np.nanmax(np.abs(one))) for one in values if one.size), default=0.0)
        units.append(shown_unit(kind, system, largest) if kind else "")

    def to(axis: int, values: Any) -> Any:
        return convert(values, kinds[axis], units[axis])

    def shown(figure: PageFigure, axis: int, unit: str) -> PageFigure:
        return figure._replace(value=None if figure.value is None else float(to(axis, figure.value)), unit=unit)

    def scaled(axis: Axis, number: int, unit: str) -> Axis:
        low, high = (None if end is None else float(to(number, end)) for end in (axis.low, axis.high))
        return axis._replace(unit=unit, low=low, high=high)

    y_unit = f"{units[1]} {panel.y.mark}".rstrip()
    return panel._replace(
        x=scaled(panel.x, 0, units[0]),
        y=scaled(panel.y, 1, y_unit),
        curves=tuple(one._replace(x=to(0, one.x), y=to(1, one.y)) for one in panel.curves),
        shades=tuple(
            Shade(to(0, x), to(1, low), to(1, high), gain, figure and shown(figure, 2, units[2]))
            for x, low, high, gain, figure in panel.shades
        ),
        marks=tuple(
            Mark(float(to(0, x)), float(to(1, y)), shown(of, 0, units[0]) if of_x else shown(of, 1, y_unit))
            for x, y, of, of_x in panel.marks
        ),
        bodies=tuple(one.scaled(to(0, 1.0)) for one in panel.bodies),
        captions=tuple(one._replace(place=to(0, one.place), half=to(0, one.half)) for one in panel.captions),
    )


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
        if end > start and (above[part] != 0).any():
            yield Shade(x[part], base[part], line[part], bool(above[part].sum() > 0))
