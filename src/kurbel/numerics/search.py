"""Searches over a cycle: the exact extremes between the nodes of a grid, and the exact zeros between the extremes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kurbel.numerics.extreme import Extreme, largest
from kurbel.numerics.grid import Grid
from kurbel.numerics.roots import bracketed_roots

if TYPE_CHECKING:
    from kurbel.arrays import Array, Flags, Indices

_ROUNDING = 8 * np.finfo(float).eps
"""What is no larger than this beside the largest value of its quantity is rounding and has no sign."""
_REPEATED = 64 * np.finfo(float).eps
"""By which, beside the largest value, equal summits of a curve differ that is summed over cylinders and the cycle."""


class Sampled(NamedTuple):
    """Values and slopes by φ (per radian) of one quantity at the same angles, of one shape."""

    value: Array
    slope: Array

    @classmethod
    def of(cls, jet: Any, shape: tuple[int, ...]) -> Sampled:
        """Return value and slope of a jet, or of what does not change, at angles of this shape."""
        value, slope = getattr(jet, "value", jet), getattr(jet, "slope", 0.0)
        return cls(np.broadcast_to(value, shape), np.broadcast_to(slope, shape))


Evaluate = Callable[["Array", "Array"], "dict[str, Sampled]"]
"""Quantities at any (degrees, within), each (n,). Of many variants it has `of(variant (n,))`: the same of those."""


class Curve(NamedTuple):
    """One quantity over the cycle, each (n,): nodes of a grid, and every angle between them where it turns round.

    They stand in order; between neighbouring angles of one piece, told by its row, it only rises or only falls.
    first: (v,) where each variant begins.
    """

    degrees: Array
    row: Indices
    value: Array
    first: Indices
    grid: Grid

    @property
    def following(self) -> Indices:
        """Which one follows each, (n,), round the cycle of its variant."""
        after = np.arange(1, len(self.value) + 1)
        after[np.append(self.first[1:], len(after))[: len(self.first)] - 1] = self.first
        return after

    def of_each(self, found: Array) -> Array:
        """Return what was found of every variant, (v,), spread over its angles, (n,)."""
        return np.repeat(found, np.diff(np.append(self.first, len(self.value))))


class Extremes(NamedTuple):
    """Largest and smallest value of one quantity over the cycle, with their angles."""

    largest: Extreme
    smallest: Extreme

    @property
    def peak(self) -> Extreme:
        """The largest magnitude, whichever sign the quantity has there."""
        return largest(self.largest, Extreme(-self.smallest.value, self.smallest.degrees))


class _Brackets(NamedTuple):
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

    def where(self, flags: Flags) -> _Brackets:
        """Return those for which a flag (n,) is set."""
        parts: list[Any] = [part[flags] for part in self]
        return _Brackets(*parts)

    @classmethod
    def joined(cls, parts: Iterable[_Brackets]) -> _Brackets:
        return cls(*map(np.concatenate, zip(*parts, strict=True)))


def extremes(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate) -> dict[str, Extremes]:
    """Return the exact extremes of several quantities over the grid, one-sided values at its breaks included.

    samples: the quantities on the grid, (pieces, nodes).
    """
    worth = {name: _may_be_extreme(grid, sampled) for name, sampled in samples.items()}
    return {name: extremes_of(curve) for name, curve in curves(grid, samples, evaluate, worth).items()}


def zeros(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate, size: float | None = None) -> dict[str, Any]:
    """Return the angles of `sign_changes` of quantities of which no extremes are wanted."""
    worth = {name: _may_be_zero(grid, sampled) for name, sampled in samples.items()}
    return sign_changes(grid, curves(grid, samples, evaluate, worth), evaluate, size)


def curves(
    grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate, worth: dict[str, Worth] | None = None
) -> dict[str, Curve]:
    """Return several quantities as curves; of pieces that are not worth a search only their ends.

    samples: the quantities on the grid, (pieces, nodes).
    """
    asked = [_slopes(grid, sampled, worth[name] if worth else None) for name, sampled in samples.items()]
    brackets = _slope_brackets(grid, asked, evaluate)
    peaks = _roots(grid, brackets, evaluate, "slope")
    heights = _at(grid, brackets, evaluate, "value")(peaks) if len(peaks) else peaks
    return {
        name: _with_peaks(grid, sampled.value, asked[k].rows, brackets, peaks, heights, brackets.owner == k)
        for k, (name, sampled) in enumerate(samples.items())
    }


class Worth(NamedTuple):
    """Where a quantity is worth a search: rows (k,) of pieces, and flags (k, nodes − 1) of the intervals in them."""

    rows: Indices
    intervals: Any


class _Slopes(NamedTuple):
    """Slopes and their derivatives on the pieces (k,) that are searched, (k, nodes), and which intervals are."""

    rows: Indices
    slope: Array
    bends: Array
    worth: Any


def _slopes(grid: Grid, sampled: Sampled, worth: Worth | None) -> _Slopes:
    rows, intervals = worth or Worth(np.arange(len(sampled.slope)), True)
    slope = sampled.slope[rows]
    return _Slopes(rows, slope, grid.slopes(slope, rows), intervals)


def _reach(grid: Grid, sampled: Sampled) -> Array:
    """Return what values in a piece (pieces,) may at most differ by from those at the nodes beside them.

    Slope times width is four times what a parabola with these slopes rises above its ends.
    """
    steepest = np.maximum(sampled.slope.max(axis=1), -sampled.slope.min(axis=1))
    return np.asarray(steepest * grid.half_widths * grid.widest)


def _between_nodes(grid: Grid, sampled: Sampled, rows: Indices) -> tuple[Array, Array, Array]:
    """Return values at both ends of the intervals of these rows, and the reach in each, (k, nodes − 1)."""
    value, slope = sampled.value[rows], np.abs(sampled.slope[rows])
    widths = grid.half_widths[rows][:, None] * np.diff(grid.nodes)
    return value[:, :-1], value[:, 1:], np.maximum(slope[:, :-1], slope[:, 1:]) * widths


def _may_be_extreme(grid: Grid, sampled: Sampled) -> Worth:
    """Return where a quantity may be larger or smaller than at every node of its variant."""
    reach, high, low = _reach(grid, sampled), sampled.value.max(axis=1), sampled.value.min(axis=1)
    pieces = np.diff(np.append(grid.first, len(high)))
    top = np.repeat(np.maximum.reduceat(high, grid.first), pieces)
    bottom = np.repeat(np.minimum.reduceat(low, grid.first), pieces)
    rows = np.flatnonzero((high + reach >= top) | (low - reach <= bottom))
    before, after, rise = _between_nodes(grid, sampled, rows)
    above = np.maximum(before, after) + rise >= top[rows][:, None]
    return Worth(rows, above | (np.minimum(before, after) - rise <= bottom[rows][:, None]))


def _may_be_zero(grid: Grid, sampled: Sampled) -> Worth:
    """Return where a quantity may reach zero, and turn back or not."""
    reach = _reach(grid, sampled)
    rows = np.flatnonzero((sampled.value.min(axis=1) <= reach) & (sampled.value.max(axis=1) >= -reach))
    before, after, rise = _between_nodes(grid, sampled, rows)
    return Worth(rows, np.minimum(np.abs(before), np.abs(after)) <= rise)


def _with_peaks(
    grid: Grid, value: Array, rows: Indices, brackets: _Brackets, peaks: Array, heights: Array, own: Flags
) -> Curve:
    """Return the values (pieces, nodes) as a curve with those of the peaks (n,) that are its own, each in its place.

    rows: of the pieces of which all nodes stand in it; of the others their ends do.
    """
    kept = np.zeros(value.shape, dtype=bool)
    kept[:, 0] = kept[:, -1] = True
    kept[rows] = True
    standing = np.flatnonzero(kept)
    nodes = value.shape[1]
    place = np.searchsorted(standing, brackets.row[own] * nodes + brackets.node[own]) + 1
    order = np.lexsort((peaks[own], place))
    into = place[order]
    parts = (
        (grid.degrees.ravel()[standing], peaks),
        (standing // nodes, brackets.row),
        (value.ravel()[standing], heights),
    )
    degrees, row, values = (np.insert(at_nodes, into, at_peaks[own][order]) for at_nodes, at_peaks in parts)
    first = np.searchsorted(standing, grid.first * nodes)
    return Curve(degrees, row, values, first + np.searchsorted(into, first, side="right"), grid)


def _slope_brackets(grid: Grid, asked: list[_Slopes], evaluate: Evaluate) -> _Brackets:
    """Return where slopes pass zero between two nodes, once or to and fro."""
    plain = _Brackets.joined(_crossing(grid, k, one) for k, one in enumerate(asked))
    over, share = zip(*(_dips(grid, k, one) for k, one in enumerate(asked)), strict=True)
    twice = _Brackets.joined(over)
    if not len(twice.low):
        return plain
    middle = twice.low + np.concatenate(share) * (twice.high - twice.low)
    f_middle = _at(grid, twice, evaluate, "slope")(middle)
    crossed = f_middle * twice.f_low < 0
    halves = twice._replace(high=middle, f_high=f_middle), twice._replace(low=middle, f_low=f_middle)
    return _Brackets.joined((plain, *(half.where(crossed) for half in halves)))


def _crossing(grid: Grid, owner: int, asked: _Slopes) -> _Brackets:
    before, after = asked.slope[:, :-1], asked.slope[:, 1:]
    # a zero at a node counts for the interval that it ends, so that it is found once
    once = (((before < 0) & (after >= 0)) | ((before > 0) & (after <= 0))) & asked.worth
    return _between(grid, owner, asked, *np.nonzero(once))


def _dips(grid: Grid, owner: int, asked: _Slopes) -> tuple[_Brackets, Array]:
    """Return the intervals in which the tangents to a slope of one sign at both ends meet beyond zero.

    Also where between the ends a line through its derivatives there is zero, (n,) as a share of the way.
    """
    ends = (part[:, side] for part in (asked.slope, asked.bends) for side in (slice(-1), slice(1, None)))
    low, high, bend, next_bend = ends
    toward = (low * high > 0) & (low * bend < 0) & (high * next_bend > 0) & asked.worth
    rows, nodes = np.nonzero(toward)
    low, high, bend, next_bend = (part[rows, nodes] for part in (low, high, bend, next_bend))
    width = grid.half_widths[asked.rows[rows]] * np.diff(grid.nodes)[nodes]
    lowest = low + bend * (high - low - next_bend * width) / (bend - next_bend)
    beyond = lowest * low <= 0
    share = bend / (bend - next_bend)
    return _between(grid, owner, asked, rows[beyond], nodes[beyond]), share[beyond]


def _between(grid: Grid, owner: int, asked: _Slopes, places: Indices, nodes: Indices) -> _Brackets:
    rows = asked.rows[places]
    f_low, f_high = asked.slope[places, nodes], asked.slope[places, nodes + 1]
    owners = np.full(len(rows), owner)
    return _Brackets(owners, grid.degrees[rows, nodes], grid.degrees[rows, nodes + 1], rows, nodes, f_low, f_high)


def _at(grid: Grid, brackets: _Brackets, evaluate: Evaluate, part: str) -> Callable[[Array], Array]:
    """Return what gives values or slopes of the quantities of brackets (n,) at angles (n,) in degrees inside them."""
    asked: Any = evaluate if grid.variant is None else evaluate.of(grid.variant[brackets.row])  # type: ignore[attr-defined]
    within, number = grid.within[brackets.row, 0], np.arange(len(brackets.row))

    def at(degrees: Array) -> Array:
        stacked = np.stack([getattr(sampled, part) for sampled in asked(degrees, within).values()])
        return np.asarray(stacked[brackets.owner, number])

    return at


def _roots(grid: Grid, brackets: _Brackets, evaluate: Evaluate, part: str) -> Array:
    """Return the roots in degrees of values or slopes in their brackets."""
    if not len(brackets.low):
        return brackets.low
    return bracketed_roots(
        _at(grid, brackets, evaluate, part), brackets.low, brackets.high, brackets.f_low, brackets.f_high
    )


def sign_changes(grid: Grid, found: dict[str, Curve], evaluate: Evaluate, size: float | None = None) -> dict[str, Any]:
    """Return the angles (n,) in degrees, ascending, at which several quantities take the other sign, round the cycle.

    What is zero but for rounding, beside `size` or its own largest value, has no sign: +, 0, − is one change, where the
    piece begins in which the new sign is met; +, 0, + is none. At a jump it is the angle of the jump.
    """
    parts = [_turns(k, curve, size) for k, curve in enumerate(found.values())]
    brackets = _Brackets.joined(part for part, _ in parts)
    roots = _roots(grid, brackets, evaluate, "value")
    changes = {}
    for k, name in enumerate(found):
        own, jumped = brackets.owner == k, parts[k][1]
        angles = np.mod(np.concatenate((roots[own], grid.low[jumped])), grid.cycle)
        changes[name] = grid.in_order(angles, np.concatenate((brackets.row[own], jumped)))
    return changes


def _turns(owner: int, curve: Curve, size: float | None) -> tuple[_Brackets, Indices]:
    """Return the brackets of the changes of sign inside pieces, and the rows of the pieces that begin with one."""
    magnitude = np.abs(curve.value)
    noise = _ROUNDING * (
        np.maximum.reduceat(magnitude, curve.first) if size is None else np.full(len(curve.first), size)
    )
    kept = np.flatnonzero(magnitude > curve.of_each(noise))
    beginning = np.searchsorted(kept, curve.first)
    begun = beginning[np.diff(np.append(beginning, len(kept))) > 0]  # of what has any sign at all
    signed = Curve(curve.degrees[kept], curve.row[kept], curve.value[kept], begun, curve.grid)
    value, row, following = signed.value, signed.row, signed.following
    last = np.flatnonzero(value * value[following] < 0)
    first = following[last]
    inside = (row[last] == row[first]) & (first > last)
    low, high = last[inside], first[inside]
    ends = signed.degrees[low], signed.degrees[high], row[low], np.zeros_like(low), value[low], value[high]
    return _Brackets(np.full(len(low), owner), *ends), row[first[~inside]]


def lasting(curve: Curve, changes: Array, noise: float) -> Array:
    """Return those of the changes of sign (n,) of a curve between which it leaves a band of noise on either side of 0.

    Of several that follow one another within the band, the middle one stands for a change that lasts beyond it, and
    none where they lead back to the sign before.
    """
    if not noise or not len(changes):
        return changes
    # which change each value follows: at a jump the side of the piece decides
    beside = curve.degrees + 1e-9 * (curve.grid.within[curve.row, 0] - curve.degrees)
    reach = np.zeros(len(changes))
    np.maximum.at(reach, np.searchsorted(changes, beside) - 1, np.abs(curve.value))
    clear = np.flatnonzero(reach > noise)
    if not len(clear):
        return changes[:0]
    groups = np.split(np.roll(changes, -clear[0] - 1), clear[1:] - clear[0])
    return np.sort([group[len(group) // 2] for group in groups if len(group) % 2])


def extremes_of(curve: Curve) -> Extremes:
    """Return the largest and smallest value of a curve, of every variant."""
    ends = np.maximum.reduceat(curve.value, curve.first), np.minimum.reduceat(curve.value, curve.first)
    size = np.maximum(np.abs(ends[0]), np.abs(ends[1]))
    return Extremes(_first_at(curve, ends[0], size, 1.0), _first_at(curve, ends[1], size, -1.0))


def _first_at(curve: Curve, best: Array, size: Array, sign: float) -> Extreme:
    """Return the extreme and the first angle that reaches it but for rounding: plateaus answer alike everywhere."""
    # a summit that comes back in every part of the cycle differs by the rounding of the sums that make the curve, ...
    level = curve.of_each(best * sign - _REPEATED * size)
    high = np.flatnonzero(curve.value * sign >= level)
    # ... and what only lies beside a summit, as high but for that, is none
    owner = np.searchsorted(curve.first, high, side="right") - 1
    first, end = curve.first[owner], np.append(curve.first[1:], len(curve.value))[owner]
    following = np.where(high + 1 == end, first, high + 1)
    preceding = np.where(high == first, end - 1, high - 1)
    value, slack = curve.value[high] * sign, 4 * np.finfo(float).eps * np.abs(best)[owner]
    beside = np.maximum(curve.value[following] * sign, curve.value[preceding] * sign)
    summit = high[value >= beside - slack]
    degrees = np.full(len(best), np.inf)
    np.minimum.at(degrees, owner[value >= beside - slack], curve.degrees[summit])
    # beside the values of the other sign this is the rounding of a dead centre, which is no float
    exact = np.abs(best) > _ROUNDING * size
    return Extreme(curve.grid.told(np.where(exact, best + 0.0, 0.0)), curve.grid.told(degrees))
