"""Brackets of what a quantity does between the nodes of a grid: where it turns round, where that is worth a search."""

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices
from kurbel.numerics.grid import Grid
from kurbel.numerics.roots import bracketed_roots


class Sampled(NamedTuple):
    """Values and slopes by φ (per radian) of one quantity at the same angles, of one shape."""

    value: Array
    slope: Array

    @classmethod
    def of(cls, jet: Any, shape: tuple[int, ...]) -> "Sampled":
        """Return value and slope of a jet, or of what does not change, at angles of this shape."""
        value, slope = getattr(jet, "value", jet), getattr(jet, "slope", 0.0)
        return cls(np.broadcast_to(value, shape), np.broadcast_to(slope, shape))

    @classmethod
    def on(cls, grid: Grid, value: Any) -> "Sampled":
        """Return values at the nodes of a grid with the slopes of the polynomials through them."""
        value = np.broadcast_to(value, grid.shape)
        return cls(value, grid.slopes(value))


Evaluate = Callable[["Array", "Array"], "dict[str, Sampled]"]
"""Quantities at any (degrees, within), each (n,). Of many variants it has `of(variant (n,))`: the same of those.

It may have `inside(within)`: what it takes in their place, so that what all angles in a piece share is found once.
"""


class Brackets(NamedTuple):
    """Intervals that hold one root each: number of the quantity, ends in degrees, row of the piece, values at the ends.

    node: after which the interval begins. Each is (n,).
    """

    owner: Any
    low: Array
    high: Array
    row: Indices
    node: Indices
    f_low: Array
    f_high: Array

    def at(self, which: Flags | Indices) -> "Brackets":
        """Return those for which a flag (n,) is set, or those of these numbers."""
        parts: list[Any] = [part[which] for part in self]
        return Brackets(*parts)

    @classmethod
    def joined(cls, parts: "Iterable[Brackets]") -> "Brackets":
        return cls(*map(np.concatenate, zip(*parts, strict=True)))


class Worth(NamedTuple):
    """Where a quantity is worth a search: rows (k,) of pieces, and flags (k, nodes − 1) of the intervals in them."""

    rows: Indices
    intervals: Any


class Slopes(NamedTuple):
    """Slopes and their derivatives on the pieces (k,) that are searched, (k, nodes), and which intervals are."""

    rows: Indices
    slope: Array
    bends: Array
    worth: Any


def slopes_worth(grid: Grid, sampled: Sampled, worth: Worth) -> Slopes:
    slope = _of_rows(sampled.slope, worth.rows)
    return Slopes(worth.rows, slope, grid.slopes(slope, worth.rows), worth.intervals)


def _of_rows(values: Array, rows: Indices) -> Array:
    """Return the values (pieces, nodes) of these pieces, node by node in memory as they were."""
    return np.asarray(values.T.take(rows, axis=1).T)


def _reach(grid: Grid, sampled: Sampled) -> Array:
    """Return what values in a piece (pieces,) may at most differ by from those at the nodes beside them.

    Slope times width is four times what a parabola with these slopes rises above its ends.
    """
    steepest = np.maximum(sampled.slope.max(axis=1), -sampled.slope.min(axis=1))
    return np.asarray(steepest * grid.half_widths * grid.gaps.max())


def _between_nodes(grid: Grid, sampled: Sampled, rows: Indices) -> tuple[Array, Array, Array]:
    """Return values at both ends of the intervals of these rows, and the reach in each, (k, nodes − 1)."""
    value, slope = _of_rows(sampled.value, rows), np.abs(_of_rows(sampled.slope, rows))
    rise = np.maximum(slope[:, :-1], slope[:, 1:]) * grid.half_widths[rows, None] * grid.gaps
    return value[:, :-1], value[:, 1:], rise


_FLAT = 32 * np.finfo(float).eps
"""Beside its values, what a quantity that does not vary seems to by the rounding of its slopes."""


def may_be_extreme(grid: Grid, sampled: Sampled) -> Worth:
    """Return where a quantity may be larger or smaller than at every node of its variant."""
    reach, high, low = _reach(grid, sampled), sampled.value.max(axis=1), sampled.value.min(axis=1)
    varies = reach > _FLAT * np.maximum(high, -low)
    top = grid.of_each(np.maximum.reduceat(high, grid.first))
    bottom = grid.of_each(np.minimum.reduceat(low, grid.first))
    rows = np.flatnonzero(varies & ((high + reach >= top) | (low - reach <= bottom)))
    before, after, rise = _between_nodes(grid, sampled, rows)
    above = np.maximum(before, after) + rise >= top[rows, None]
    return Worth(rows, above | (np.minimum(before, after) - rise <= bottom[rows, None]))


def everywhere(grid: Grid) -> Worth:
    """Return that every interval is worth a search."""
    return Worth(np.arange(len(grid.low)), True)


def may_be_zero(grid: Grid, sampled: Sampled) -> Worth:
    """Return where a quantity may reach zero, and turn back or not."""
    reach = _reach(grid, sampled)
    rows = np.flatnonzero((sampled.value.min(axis=1) <= reach) & (sampled.value.max(axis=1) >= -reach))
    before, after, rise = _between_nodes(grid, sampled, rows)
    return Worth(rows, np.minimum(np.abs(before), np.abs(after)) <= rise)


def slope_brackets(grid: Grid, asked: list[Slopes], evaluate: Evaluate) -> Brackets:
    """Return where slopes pass zero between two nodes, once or to and fro."""
    plain = Brackets.joined(_crossing(grid, k, one) for k, one in enumerate(asked))
    over, share = zip(*(_dips(grid, k, one) for k, one in enumerate(asked)), strict=True)
    twice = Brackets.joined(over)
    if not len(twice.low):
        return plain
    middle = twice.low + np.concatenate(share) * (twice.high - twice.low)
    f_middle = at_brackets(grid, twice, evaluate)(middle).slope
    crossed = f_middle * twice.f_low < 0
    halves = twice._replace(high=middle, f_high=f_middle), twice._replace(low=middle, f_low=f_middle)
    return Brackets.joined((plain, *(half.at(crossed) for half in halves)))


def _crossing(grid: Grid, owner: int, asked: Slopes) -> Brackets:
    before, after = asked.slope[:, :-1], asked.slope[:, 1:]
    # a zero at a node counts for the interval that it ends, so that it is found once
    once = (((before < 0) & (after >= 0)) | ((before > 0) & (after <= 0))) & asked.worth
    return _between(grid, owner, asked, *np.nonzero(once))


def _dips(grid: Grid, owner: int, asked: Slopes) -> tuple[Brackets, Array]:
    """Return the intervals in which the tangents to a slope of one sign at both ends meet beyond zero.

    Also where between the ends a line through its derivatives there is zero, (n,) as a share of the way.
    """
    ends = (part[:, side] for part in (asked.slope, asked.bends) for side in (slice(-1), slice(1, None)))
    low, high, bend, next_bend = ends
    toward = (low * high > 0) & (low * bend < 0) & (high * next_bend > 0) & asked.worth
    rows, nodes = np.nonzero(toward)
    low, high, bend, next_bend = (part[rows, nodes] for part in (low, high, bend, next_bend))
    width = grid.half_widths[asked.rows[rows]] * grid.gaps[nodes]
    lowest = low + bend * (high - low - next_bend * width) / (bend - next_bend)
    beyond = lowest * low <= 0
    share = bend / (bend - next_bend)
    return _between(grid, owner, asked, rows[beyond], nodes[beyond]), share[beyond]


def _between(grid: Grid, owner: int, asked: Slopes, places: Indices, nodes: Indices) -> Brackets:
    rows = asked.rows[places]
    f_low, f_high = asked.slope[places, nodes], asked.slope[places, nodes + 1]
    owners = np.full(len(rows), owner)
    return Brackets(owners, grid.degrees[rows, nodes], grid.degrees[rows, nodes + 1], rows, nodes, f_low, f_high)


def at_brackets(grid: Grid, brackets: Brackets, evaluate: Evaluate) -> Callable[[Array], Sampled]:
    """Return what gives values and slopes of the quantities of brackets (n,) at angles (n,) in degrees inside them."""
    asked: Any = evaluate if grid.variant is None else evaluate.of(grid.variant[brackets.row])  # type: ignore[attr-defined]
    within: Any = grid.within[brackets.row, 0]
    if hasattr(asked, "inside"):
        within = asked.inside(within)

    def at(degrees: Array) -> Sampled:
        value, slope = np.empty_like(degrees), np.empty_like(degrees)
        for owner, sampled in enumerate(asked(degrees, within).values()):
            own = brackets.owner == owner
            value[own], slope[own] = sampled.value[own], sampled.slope[own]
        return Sampled(value, slope)

    return at


_SETTLED = 1e-9
"""Of half a piece, where a polynomial through its nodes is as steep as high: a step so short leaves its square."""
_STEPS = 3


def roots(grid: Grid, brackets: Brackets, evaluate: Evaluate, part: str, nodal: list[Array]) -> tuple[Array, Array]:
    """Return the roots in degrees of values or slopes in their brackets, and the values there.

    nodal: those values or slopes at the nodes of the grid, (pieces, nodes), of every quantity. The polynomial through
    them has a root beside each, from which Newton's method needs a step or two; where it needs more, the bracket tells.
    """
    degrees, rise, size = _roots_of_polynomials(grid, brackets, nodal)
    values, left = np.empty_like(degrees), np.arange(len(degrees))
    half = (grid.high - grid.low)[brackets.row] / 2
    short = _SETTLED * half * np.minimum(np.abs(rise) * half / size, 1.0)
    for _ in range(_STEPS):
        if not len(left):
            return degrees, values
        own = brackets.at(left)
        found = at_brackets(grid, own, evaluate)(degrees[left])
        step = getattr(found, part) / rise[left]
        values[left] = found.value
        moved = np.clip(degrees[left] - step, own.low, own.high)
        degrees[left] = np.where(np.isnan(moved), degrees[left], moved)  # no polynomial tells where a slope is none
        left = left[~(np.abs(step) <= short[left])]
    own = brackets.at(left)
    at = at_brackets(grid, own, evaluate)
    ends = own.low, own.high, own.f_low, own.f_high
    degrees[left] = bracketed_roots(lambda angles: getattr(at(angles), part), *ends)
    values[left] = at(degrees[left]).value
    return degrees, values


def _roots_of_polynomials(grid: Grid, brackets: Brackets, nodal: list[Array]) -> tuple[Array, Array, Array]:
    """Return where the polynomials through the nodes of pieces are zero in brackets, and their slopes by degree there.

    Also the largest size that they have at a node.
    """
    along = np.empty((len(grid.nodes), len(brackets.low)))
    for owner, one in enumerate(nodal):
        own = brackets.owner == owner
        along[:, own] = one.T[:, brackets.row[own]]
    coefficients = grid.coefficients @ along
    middle, half = (grid.low + grid.high)[brackets.row] / 2, (grid.high - grid.low)[brackets.row] / 2
    low, high = (brackets.low - middle) / half, (brackets.high - middle) / half
    place = low + (high - low) * brackets.f_low / (brackets.f_low - brackets.f_high)
    for _ in range(6):
        value, slope = _of_polynomials(coefficients, place)
        before = value * brackets.f_low > 0
        low, high = np.where(before, place, low), np.where(before, high, place)
        place = place - value / slope
        place = np.where((low <= place) & (place <= high), place, (low + high) / 2)
    rise = _of_polynomials(coefficients, place)[1] / half
    return middle + half * place, rise, np.abs(along).max(axis=0, initial=0.0)


def _of_polynomials(coefficients: Array, place: Array) -> tuple[Array, Array]:
    """Return values and slopes (n,) of polynomials, from the highest power on, (powers, n), by the rule of Horner."""
    value, slope = coefficients[0], np.zeros_like(place)
    for one in coefficients[1:]:
        value, slope = value * place + one, slope * place + value
    return value, slope
