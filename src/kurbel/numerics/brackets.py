"""Brackets of what a quantity does between the nodes of a grid: where it turns round, where that is worth a search."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices
from kurbel.numerics.grid import Grid
from kurbel.numerics.roots import bracketed_roots, roots_by_slope


class Sampled(NamedTuple):
    """Values and slopes by φ (per radian) of one quantity at the same angles, of one shape."""

    value: Array
    slope: Array

    @classmethod
    def of(cls, jet: Any, shape: tuple[int, ...]) -> "Sampled":
        """Return value and slope of a jet, or of what does not change, at angles of this shape."""
        value, slope = getattr(jet, "value", jet), getattr(jet, "slope", 0.0)
        return cls(np.broadcast_to(value, shape), np.broadcast_to(slope, shape))

    def on(self, grid: Grid, pieces: Indices) -> "Sampled":
        """Return those at the nodes of these pieces (n,) of a grid."""
        return Sampled(*(part.T.take(pieces, axis=1).T for part in self))

    def reach(self, grid: Grid, high: Array, low: Array) -> Array:
        """Return by what values between the nodes may pass the highest and lowest of those at the nodes, (pieces,).

        Slope times width is four times what a parabola with these slopes rises above its ends.
        """
        steepest = np.maximum(self.slope.max(axis=1), -self.slope.min(axis=1))
        return np.asarray(steepest * (grid.half_widths * grid.gaps.max()))


class Polynomials:
    """Values of one quantity at the nodes of a grid, (pieces, nodes); the polynomials through them have its slopes."""

    def __init__(self, grid: Grid, value: Any) -> None:
        self.value: Array = np.broadcast_to(value, grid.shape)

    def on(self, grid: Grid, pieces: Indices) -> Sampled:
        """Return values and slopes at the nodes of these pieces (n,) of a grid."""
        value = self.value.T.take(pieces, axis=1).T
        return Sampled(value, grid.slopes(value, pieces))

    def reach(self, grid: Grid, high: Array, low: Array) -> Array:
        """Return by what values between the nodes may pass the highest and lowest of those at the nodes, (pieces,)."""
        return np.asarray(grid.overshoot * (high - low))


OnNodes = Sampled | Polynomials
"""A quantity at the nodes of a grid, with slopes of its own, which may tell of a pole beside a piece, or without."""

Evaluate = Callable[["Array", "Array"], "dict[str, Sampled]"]
"""Quantities at any (degrees, within), each (n,). Of many variants it has `of(variant (n,))`: the same of those.

It may have `inside(grid, piece (n,))`: what it takes in place of `within`, so that what all angles in a piece share is
found once.
"""


class Rows(NamedTuple):
    """Pieces of several quantities, those of one after those of another: what is searched of them is searched at once.

    owner, piece: number of the quantity and of the piece, (n,); value, slope: at the nodes, (n, nodes), node by node in
    memory; levels: the values that are searched for, (levels, n), nan where none is; None: every turning point is.
    """

    owner: Indices
    piece: Indices
    value: Array
    slope: Array
    levels: Array | None = None

    @classmethod
    def of(cls, grid: Grid, samples: Sequence[OnNodes], chosen: Flags) -> "Rows":
        """Return the pieces for which a flag (quantities, pieces) is set."""
        parts = [np.flatnonzero(own) for own in chosen]
        found = zip(*(one.on(grid, pieces) for one, pieces in zip(samples, parts)))
        values, slopes = (np.concatenate([one.T for one in part], axis=1).T for part in found)
        owner = np.repeat(np.arange(len(parts)), [len(pieces) for pieces in parts])
        return cls(owner, np.concatenate(parts), values, slopes)

    def worth(self, grid: Grid, places: Indices, nodes: Indices) -> Flags:
        """Return which of these intervals (k,) may reach a level; places: of the rows, nodes: those before."""
        if self.levels is None:
            return np.ones(len(places), dtype=bool)
        before, after = self.value[places, nodes], self.value[places, nodes + 1]
        slope = np.maximum(np.abs(self.slope[places, nodes]), np.abs(self.slope[places, nodes + 1]))
        rise = slope * grid.half_widths[self.piece[places]] * grid.gaps[nodes]
        levels = self.levels[:, places]
        reached = (np.maximum(before, after) + rise >= levels) & (np.minimum(before, after) - rise <= levels)
        return np.asarray(reached.any(axis=0))


class Brackets(NamedTuple):
    """Intervals that hold one root each: place of the row, node before, ends in degrees, values at the ends, (n,)."""

    place: Indices
    node: Indices
    low: Array
    high: Array
    f_low: Array
    f_high: Array

    def at(self, which: Flags | Indices) -> "Brackets":
        """Return those for which a flag (n,) is set, or those of these numbers."""
        parts: list[Any] = [part[which] for part in self]
        return Brackets(*parts)

    @classmethod
    def joined(cls, parts: "Iterable[Brackets]") -> "Brackets":
        return cls(*map(np.concatenate, zip(*parts, strict=True)))


def ranges(grid: Grid, samples: Iterable[OnNodes]) -> tuple[Array, Array, Array]:
    """Return largest and smallest values at the nodes of pieces, and what those between may differ by from these.

    Each is (quantities, pieces).
    """
    ends = [(one, one.value.max(axis=1), one.value.min(axis=1)) for one in samples]
    high, low, reach = map(np.stack, zip(*((high, low, one.reach(grid, high, low)) for one, high, low in ends)))
    return high, low, reach


_FLAT = 32 * np.finfo(float).eps
"""Beside its values, what a quantity that does not vary seems to by the rounding of its slopes."""
REPEATED = 1e-12
"""By which, beside the largest value, equal summits of a curve differ that is summed over cylinders, or solved for."""


def may_be_extreme(grid: Grid, samples: Sequence[OnNodes]) -> Rows:
    """Return where quantities may pass all nodes of their variant; of each at least one row."""
    high, low, reach = ranges(grid, samples)
    top, bottom = np.maximum.reduceat(high, grid.first, axis=1), np.minimum.reduceat(low, grid.first, axis=1)
    slack = REPEATED * np.maximum(np.abs(top), np.abs(bottom))
    within = (high + reach < grid.of_each(top - slack)) & (low - reach > grid.of_each(bottom + slack))
    rows = Rows.of(grid, samples, ~within)  # what is no number, too
    at, variant = (rows.owner, rows.piece), (rows.owner, grid.number[rows.piece])
    varies = reach[at] > _FLAT * np.maximum(high[at], -low[at])
    return rows._replace(levels=np.where(varies, (top[variant], bottom[variant]), np.nan))


def everywhere(grid: Grid, samples: Sequence[OnNodes]) -> Rows:
    """Return every piece."""
    return Rows.of(grid, samples, np.ones((len(samples), len(grid.low)), dtype=bool))


def may_be_zero(grid: Grid, samples: Sequence[OnNodes], high: Array, low: Array, reach: Array) -> Rows:
    """Return where quantities of these `ranges` may reach zero, and turn back or not."""
    rows = Rows.of(grid, samples, (low <= reach) & (high >= -reach))
    return rows._replace(levels=np.zeros((1, len(rows.owner))))


def slope_brackets(grid: Grid, rows: Rows, evaluate: Evaluate) -> Brackets:
    """Return where slopes pass zero between two nodes, once or to and fro."""
    plain = _crossing(grid, rows)
    bends = grid.slopes(rows.slope, rows.piece)
    toward = _toward(grid, rows, bends)
    twice, share = _dips(grid, rows, bends, *toward) if len(toward[0]) else (plain, ())
    if not len(share):
        return plain
    middle = twice.low + share * (twice.high - twice.low)
    f_middle = at_brackets(grid, rows, twice, evaluate)(middle).slope
    crossed = f_middle * twice.f_low < 0
    halves = twice._replace(high=middle, f_high=f_middle), twice._replace(low=middle, f_low=f_middle)
    return Brackets.joined((plain, *(half.at(crossed) for half in halves)))


def _crossing(grid: Grid, rows: Rows) -> Brackets:
    before, after = rows.slope[:, :-1], rows.slope[:, 1:]
    # a zero at a node counts for the interval that it ends, so that it is found once
    once = ((before < 0) & (after >= 0)) | ((before > 0) & (after <= 0))
    return _between(grid, rows, *_worth(grid, rows, once))


def _toward(grid: Grid, rows: Rows, bends: Array) -> tuple[Indices, Indices]:
    """Return the intervals at both ends of which a slope has one sign and comes nearer to zero inward."""
    rising, bending = rows.slope > 0, bends > 0
    before, after = rising[:, :-1], rising[:, 1:]
    return _worth(grid, rows, (before == after) & (before != bending[:, :-1]) & (after == bending[:, 1:]))


def _dips(grid: Grid, rows: Rows, bends: Array, places: Indices, nodes: Indices) -> tuple[Brackets, Array]:
    """Return those of these intervals in which the tangents to a slope at both ends meet beyond zero.

    Also where between the ends a line through its derivatives there is zero, (n,) as a share of the way.
    """
    low, high = rows.slope[places, nodes], rows.slope[places, nodes + 1]
    bend, next_bend = bends[places, nodes], bends[places, nodes + 1]
    width = grid.half_widths[rows.piece[places]] * grid.gaps[nodes]
    share = bend / (bend - next_bend)
    lowest = low + share * (high - low - next_bend * width)
    beyond = (lowest * low <= 0) & (low * high > 0)
    return _between(grid, rows, places[beyond], nodes[beyond]), share[beyond]


def _worth(grid: Grid, rows: Rows, flags: Flags) -> tuple[Indices, Indices]:
    """Return in which rows and after which nodes flags (n, nodes − 1) are set of intervals that are worth a search."""
    nodes, places = np.divmod(np.flatnonzero(flags.T), len(flags))
    worth = rows.worth(grid, places, nodes)
    return places[worth], nodes[worth]


def _between(grid: Grid, rows: Rows, places: Indices, nodes: Indices) -> Brackets:
    f_low, f_high = rows.slope[places, nodes], rows.slope[places, nodes + 1]
    pieces = rows.piece[places]
    return Brackets(places, nodes, grid.degrees[pieces, nodes], grid.degrees[pieces, nodes + 1], f_low, f_high)


def at_brackets(grid: Grid, rows: Rows, brackets: Brackets, evaluate: Evaluate) -> Callable[[Array], Sampled]:
    """Return what gives values and slopes of the quantities of brackets (n,) at angles (n,) in degrees inside them."""
    owner, piece = rows.owner[brackets.place], rows.piece[brackets.place]
    asked: Any = evaluate if grid.variant is None else evaluate.of(grid.variant[piece])  # type: ignore[attr-defined]
    within: Any = asked.inside(grid, piece) if hasattr(asked, "inside") else grid.within[piece, 0]

    def at(degrees: Array) -> Sampled:
        every = zip(*asked(degrees, within).values())
        return Sampled(*(np.stack(parts)[owner, np.arange(len(owner))] for parts in every))

    return at


_SETTLED = 1e-9
"""Of half a piece, where a polynomial through its nodes is as steep as high: a step so short leaves its square."""
_STEPS = 3
_POLYNOMIAL_STEPS = 6


def roots(grid: Grid, rows: Rows, brackets: Brackets, evaluate: Evaluate, part: str) -> tuple[Array, Array]:
    """Return the roots in degrees of values or slopes in their brackets, and the values there.

    part: "value" or "slope". The polynomial through those at the nodes has a root beside each, from which Newton's
    method needs a step or two; where it needs more, the bracket tells.
    """
    if not len(brackets.place):
        return brackets.low, brackets.low
    degrees, rise, size = _roots_of_polynomials(grid, rows, brackets, part)
    values, left = np.empty_like(degrees), np.arange(len(degrees))
    half = grid.half_degrees[rows.piece[brackets.place]]
    short = _SETTLED * half * np.minimum(np.abs(rise) * half / size, 1.0)
    for _ in range(_STEPS):
        if not len(left):
            return degrees, values
        own = brackets.at(left)
        found = at_brackets(grid, rows, own, evaluate)(degrees[left])
        with np.errstate(all="ignore"):  # no polynomial tells where a slope is none
            step = getattr(found, part) / rise[left]
        values[left] = found.value
        moved = np.clip(degrees[left] - step, own.low, own.high)
        degrees[left] = np.where(np.isnan(moved), degrees[left], moved)
        left = left[~(np.abs(step) <= short[left])]
    own = brackets.at(left)
    at = at_brackets(grid, rows, own, evaluate)
    ends = own.low, own.high, own.f_low, own.f_high
    degrees[left] = bracketed_roots(lambda angles: getattr(at(angles), part), *ends)
    values[left] = at(degrees[left]).value
    return degrees, values


def _roots_of_polynomials(grid: Grid, rows: Rows, brackets: Brackets, part: str) -> tuple[Array, Array, Array]:
    """Return where the polynomials through the nodes of pieces are zero in brackets, and their slopes by degree there.

    Also the largest size that they have at a node.
    """
    along = getattr(rows, part).T.take(brackets.place, axis=1)
    coefficients = grid.coefficients @ along

    def polynomials(place: Array) -> tuple[Array, Array]:
        value, slope = coefficients[0], np.zeros_like(place)
        for one in coefficients[1:]:  # the rule of Horner
            value, slope = value * place + one, slope * place + value
        return value, slope

    pieces = rows.piece[brackets.place]
    middle, half = grid.within[pieces, 0], grid.half_degrees[pieces]
    low, high = (brackets.low - middle) / half, (brackets.high - middle) / half
    place = roots_by_slope(polynomials, low, high, brackets.f_low, brackets.f_high, _POLYNOMIAL_STEPS)
    return middle + half * place, polynomials(place)[1] / half, np.abs(along).max(axis=0, initial=0.0)
