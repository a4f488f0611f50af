"""Where pictures take their curves from: results sampled so finely that no line of points leaves its curve visibly."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.quantity import Quantity
from kurbel.declared.unit_systems import convert, shown_unit
from kurbel.numerics.extreme import Extreme
from kurbel.report.frame import too_large
from kurbel.report.picture import Axis, Curve, Figure, Mark, Panel, Words
from kurbel.solver.figures import Results, answered

PHI = "phi"
FINENESS = 1 / 2000
"""By what of its height a line of points may miss a curve: less than can be seen on paper."""
_WIDEST = 7.5  # degrees between two points at first: narrow enough that no wave hides between them
_HALVINGS = 12
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
    allowed = np.ptp(np.concatenate((at_low, at_high), axis=1), axis=1)[:, None] * FINENESS
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
    """The results of one cylinder, bearing or machine, in the units of a system."""

    def __init__(self, results: Any, options: PictureOptions) -> None:
        self.results, self.options = results, options
        self.quantities: dict[str, Quantity] = {}
        self.key_values: dict[str, Quantity] = {}
        if isinstance(results, Results):  # others have no columns
            self.quantities = {one.id: one for one in results.lists.all_columns}
            self.key_values = results.lists.key_values(results.command)
            self._start = results.at(np.zeros(1), np.full(1, 1e-3))

    def having(self, ids: Iterable[str]) -> tuple[str, ...]:
        """Return those of these columns that there are."""
        return tuple(id for id in ids if id in self.quantities and getattr(self._start, id, None) is not None)

    def values(self, ids: Sequence[str], degrees: Array, within: Array) -> Array:
        """Return columns (k, n) in SI at crank angles (n,); φ is one of them."""
        state = self.results.at(degrees, within)
        found = [degrees if id == PHI else np.broadcast_to(getattr(state, id), degrees.shape) for id in ids]
        return np.stack([np.asarray(one, dtype=float) for one in found])

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

    def words(self, id: str) -> Words:
        """Return the symbol of a column."""
        return words(self.quantities[id])

    def unit(self, kind: str, *values: Any) -> str:
        """Return the unit in which values in SI of one kind are shown together."""
        return shown_unit(kind, self.options.system, max((float(np.max(np.abs(one))) for one in values), default=0.0))

    def extremes(self, id: str) -> list[tuple[Quantity, Extreme]]:
        """Return the key values that are the largest and the smallest value of a column, none of a level line."""
        named = [self.key_values[name] for name in (f"{id}_max", f"{id}_min") if name in self.key_values]
        found = [(quantity, answered(self.results.answering, quantity)) for quantity in named]
        found = [(quantity, extreme) for quantity, extreme in found if isinstance(extreme, Extreme)]
        return found if len({extreme.value for _, extreme in found}) == len(found) else []

    def axis(self, id: str, values: Array) -> Axis:
        """Return the axis for values of a column in SI."""
        return Axis(self.words(id), "deg" if id == PHI else self.unit(self.quantities[id].kind, values))

    def panel(self, ids: Sequence[str], over: str = PHI, zero: bool = False) -> Panel:
        """Return a panel of columns of one kind over another column, with their extremes; zero: with the line y = 0."""
        samples = self.samples((over, *ids))
        along, *lines = samples.values
        kind, run = self.quantities[ids[0]].kind, self.axis(over, along)
        unit, x = self.unit(kind, *lines), convert(along, self.quantities[over].kind, run.unit)
        curves = [samples.curve(self.words(id), x, convert(line, kind, unit)) for id, line in zip(ids, lines)]
        if zero:
            curves.append(level(x))
        marks = [mark for id in ids for mark in self.marks(id, unit, over, run.unit)]
        name = Words(*(", ".join(symbols) for symbols in zip(*map(self.words, ids))))
        title = "" if np.any(lines) else "0 at every angle"
        return Panel(run, Axis(name, unit), tuple(curves), marks=tuple(marks), title=title)

    def panels(self, *groups: tuple[str, ...], over: str = PHI) -> Iterator[Panel]:
        """Yield a panel for each group of columns of one kind, as far as there are any."""
        if over == PHI or self.having((over,)):
            for group in groups:
                if ids := self.having(group):
                    yield self.panel(ids, over)

    def marks(self, id: str, unit: str, over: str = PHI, over_unit: str = "deg") -> Iterable[Mark]:
        """Yield the extremes of a column as marks at their exact place."""
        for quantity, extreme in self.extremes(id):
            at = np.array([extreme.degrees])
            ((place,),) = self.values((over,), at, at)
            yield mark(quantity, extreme, unit, float(convert(place, self.quantities[over].kind, over_unit)))


def mark(quantity: Quantity, extreme: Extreme, unit: str, x: float, y: float | None = None) -> Mark:
    """Return an extreme at a place in the units of the axes; y: its value, where none is given."""
    value = float(convert(extreme.value, quantity.kind, unit))
    figure = Figure(words(quantity), value, quantity.marked(unit), extreme.degrees)
    return Mark(x, value if y is None else y, figure)


def words(quantity: Quantity) -> Words:
    """Return the symbol of a quantity as pictures show it."""
    return Words(quantity.symbol, quantity.ascii_symbol)


def level(x: Array, height: float = 0.0, name: Words = Words("")) -> Curve:  # noqa: B008 (immutable)
    """Return a faint level line as far as x (n,) reaches."""
    return Curve(name, np.array([x.min(), x.max()]), np.full(2, height), "faint")
