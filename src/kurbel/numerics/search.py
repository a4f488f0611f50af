"""Searches over a cycle: the exact extremes between the nodes of a grid, and the exact zeros between the extremes."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices
from kurbel.numerics.arithmetic import where
from kurbel.numerics.brackets import (
    REPEATED,
    Brackets,
    Rows,
    everywhere,
    may_be_extreme,
    may_be_zero,
    ranges,
    roots,
    slope_brackets,
)
from kurbel.numerics.brackets import Evaluate as Evaluate
from kurbel.numerics.brackets import OnNodes as OnNodes
from kurbel.numerics.brackets import Polynomials as Polynomials
from kurbel.numerics.brackets import Sampled as Sampled
from kurbel.numerics.extreme import Extreme, chosen
from kurbel.numerics.grid import Grid

Samples = Mapping[str, OnNodes]
"""Quantities at the nodes of a grid, by their names."""
_ROUNDING = 8 * np.finfo(float).eps
"""What is no larger than this beside the largest value of its quantity is rounding and has no sign."""
_ALIKE = 4 * np.finfo(float).eps
"""By which values beside each other differ that are one but for rounding."""


class Turns(NamedTuple):
    """Where quantities turn round between two nodes: place of the row, node before, angle, value, (n,)."""

    place: Indices
    node: Indices
    degrees: Array
    value: Array

    def at(self, which: Flags) -> "Turns":
        """Return those for which a flag (n,) is set."""
        parts: list[Any] = [part[which] for part in self]
        return Turns(*parts)


class Curve(NamedTuple):
    """One quantity over the cycle, each (n,): nodes of a grid, and every angle between them where it turns round.

    They stand in order; between neighbouring angles of one piece, told by its row, it only rises or only falls.
    first: (v,) where each variant begins; turns: those that are no nodes; at_nodes: (pieces, nodes) values at all nodes
    of the grid.
    """

    degrees: Array
    row: Indices
    value: Array
    first: Indices
    grid: Grid
    turns: Turns
    at_nodes: Array

    def less(self, value: float) -> "Curve":
        """Return the curve of what is less by this value."""
        return self._replace(value=self.value - value, at_nodes=self.at_nodes - value)

    @property
    def within(self) -> Array:
        """The middles of the pieces, (n,)."""
        return np.asarray(self.grid.within[self.row, 0])

    @property
    def peaks(self) -> tuple[Array, Array]:
        """Angles (k,) between the nodes at which it turns round, and the middles of their pieces."""
        return self.turns.degrees, self.grid.within[self.turns.place, 0]

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
        """The largest magnitude, whichever sign it has; of two that are alike but for rounding the first."""
        high, low = self.largest, Extreme(-self.smallest.value, self.smallest.degrees)
        alike = abs(low.value - high.value) <= REPEATED * abs(high.value)
        return chosen(where(alike, low.degrees < high.degrees, low.value > high.value), low, high)


def extremes(grid: Grid, samples: Samples, evaluate: Evaluate) -> dict[str, Extremes]:
    """Return the exact extremes of several quantities over the grid, one-sided values at its breaks included.

    samples: the quantities on the grid, (pieces, nodes).
    """
    rows = may_be_extreme(grid, list(samples.values()))
    found = _ends(grid, rows, _turning_points(grid, rows, evaluate))
    count = len(grid.first)
    parts = (slice(number * count, (number + 1) * count) for number in range(len(samples)))
    return {name: _told(grid, found, part) for name, part in zip(samples, parts)}


def zeros(grid: Grid, samples: Samples, evaluate: Evaluate, size: float | None = None) -> dict[str, Any]:
    """Return the angles of `sign_changes` of quantities of which no extremes are wanted.

    size: beside which values are rounding, the largest one of a quantity if it is not given.
    """
    high, low, reach = ranges(grid, samples.values())
    rows = may_be_zero(grid, list(samples.values()), high, low, reach)
    largest = np.maximum.reduceat(np.maximum(high, -low), grid.first, axis=1)
    sizes = largest if size is None else np.full_like(largest, size)
    return sign_changes(grid, _curves(grid, samples, evaluate, rows, _ROUNDING * sizes), evaluate, sizes)


def curves(grid: Grid, samples: Samples, evaluate: Evaluate) -> dict[str, Curve]:
    """Return several quantities as curves.

    samples: the quantities on the grid, (pieces, nodes).
    """
    noise = np.full((len(samples), len(grid.first)), np.inf)
    return _curves(grid, samples, evaluate, everywhere(grid, list(samples.values())), noise)


def _curves(grid: Grid, samples: Samples, evaluate: Evaluate, rows: Rows, noise: Array) -> dict[str, Curve]:
    """Return several quantities as curves; of pieces that have one sign only the beginning.

    noise: what is no larger has no sign, of the quantities of every variant.
    """
    turns = _turning_points(grid, rows, evaluate)
    unsigned = noise[rows.owner, grid.number[rows.piece]]
    whole = (rows.value.min(axis=1) <= unsigned) & (rows.value.max(axis=1) >= -unsigned)
    whole[turns.place] = True
    found = {}
    for number, (name, sampled) in enumerate(samples.items()):
        own = turns.at(rows.owner[turns.place] == number)
        own = own._replace(place=rows.piece[own.place])
        counts = np.ones(len(grid.low), dtype=np.intp)
        counts[rows.piece[whole & (rows.owner == number)]] = len(grid.nodes)
        begins = np.cumsum(counts) - counts
        row = np.repeat(np.arange(len(counts)), counts)
        place = (np.arange(len(row)) - begins[row]) * len(counts) + row  # node by node
        at_nodes = grid.degrees.T.take(place), row, sampled.value.T.take(place)
        degrees, row, value = _inserted(at_nodes, begins[own.place] + own.node + 1, (own.degrees, own.place, own.value))
        found[name] = Curve(degrees, row, value, np.searchsorted(row, grid.first), grid, own, sampled.value)
    return found


def _turning_points(grid: Grid, rows: Rows, evaluate: Evaluate) -> Turns:
    brackets = slope_brackets(grid, rows, evaluate)
    turns = Turns(brackets.place, brackets.node, *roots(grid, rows, brackets, evaluate, "slope"))
    return turns.at(_apart_from_ends(rows, turns))


def _apart_from_ends(rows: Rows, turns: Turns) -> Flags:
    """Return which do not, but for rounding, turn at the end of a piece: a dead centre is told as the angle it is."""
    apart = np.ones(len(turns.place), dtype=bool)
    for end, node in ((0, 0), (-1, rows.value.shape[1] - 2)):
        value = rows.value[turns.place, end]
        apart &= (turns.node != node) | ~(np.abs(turns.value - value) <= _ALIKE * np.abs(value))
    return apart


def _inserted(points: Sequence[Any], into: Indices, turns: Sequence[Any]) -> tuple[Any, ...]:
    """Return angles and more (n,) of points in order, with those of turns before these places."""
    order = np.lexsort((turns[0], into))
    turning = into[order] + np.arange(len(into))
    nodal = np.ones(len(points[0]) + len(into), dtype=bool)
    nodal[turning] = False
    found = []
    for own, turned in zip(points, turns):
        both = np.empty(len(nodal), own.dtype)
        both[nodal], both[turning] = own, turned[order]
        found.append(both)
    return tuple(found)


def sign_changes(grid: Grid, found: dict[str, Curve], evaluate: Evaluate, size: Array | float) -> dict[str, Any]:
    """Return the angles (n,) in degrees, ascending, at which several quantities take the other sign, round the cycle.

    What is zero but for rounding, beside a size, or one of each quantity and variant, has no sign: +, 0, − is one
    change, where the piece begins in which the new sign is met; +, 0, + is none. At a jump it is the angle of the jump.
    """
    sizes = np.broadcast_to(size, (len(found), len(grid.first)))
    parts = [_turns(curve, own) for curve, own in zip(found.values(), sizes)]
    brackets = Brackets.joined(part for part, _ in parts)
    owner = np.repeat(np.arange(len(parts)), [len(part.place) for part, _ in parts])
    curved = [curve.at_nodes.T.take(part.place, axis=1) for curve, (part, _) in zip(found.values(), parts)]
    values = np.concatenate(curved, axis=1).T
    rows = Rows(owner, brackets.place, values, values)  # whose slopes nobody asks for
    inside, _ = roots(grid, rows, brackets._replace(place=np.arange(len(owner))), evaluate, "value")
    changes = {}
    for number, (name, (_, jumped)) in enumerate(zip(found, parts)):
        own = owner == number
        angles = np.mod(np.concatenate((inside[own], grid.low[jumped])), grid.cycle)
        changes[name] = grid.in_order(angles, np.concatenate((brackets.place[own], jumped)))
    return changes


def _turns(curve: Curve, size: Array) -> tuple[Brackets, Indices]:
    """Return the changes of sign inside pieces, with these as places, and the pieces that begin with one."""
    kept = np.flatnonzero(np.abs(curve.value) > curve.of_each(_ROUNDING * size))
    beginning = np.searchsorted(kept, curve.first)
    begun = beginning[np.diff(np.append(beginning, len(kept))) > 0]  # of what has any sign at all
    signed = curve._replace(degrees=curve.degrees[kept], row=curve.row[kept], value=curve.value[kept], first=begun)
    value, row, following = signed.value, signed.row, signed.following
    last = np.flatnonzero(value * value[following] < 0)
    first = following[last]
    inside = (row[last] == row[first]) & (first > last)
    low, high = last[inside], first[inside]
    ends = signed.degrees[low], signed.degrees[high], value[low], value[high]
    return Brackets(row[low], np.zeros_like(low), *ends), row[first[~inside]]


def lasting(curve: Curve, changes: Array, noise: float) -> Array:
    """Return those of the changes of sign (n,) of a curve between which it leaves a band of noise on either side of 0.

    Of several that follow one another within the band, the middle one stands for a change that lasts beyond it, and
    none where they lead back to the sign before.
    """
    if not noise or not len(changes):
        return changes
    # which change each value follows: at a jump the side of the piece decides
    beside = curve.degrees + 1e-9 * (curve.within - curve.degrees)
    reach = np.zeros(len(changes))
    np.maximum.at(reach, np.searchsorted(changes, beside) - 1, np.abs(curve.value))
    clear = np.flatnonzero(reach > noise)
    if not len(clear):
        return changes[:0]
    groups = np.split(np.roll(changes, -clear[0] - 1), clear[1:] - clear[0])
    return np.sort([group[len(group) // 2] for group in groups if len(group) % 2])


def extremes_of(curve: Curve) -> Extremes:
    """Return the largest and smallest value of a curve, of every variant."""
    pieces = np.arange(len(curve.at_nodes))
    rows = Rows(np.zeros_like(pieces), pieces, curve.at_nodes, curve.at_nodes)  # whose slopes nobody asks for
    return _told(curve.grid, _ends(curve.grid, rows, curve.turns), slice(None))


_Ends = tuple[tuple[Array, Array], tuple[Array, Array]]
"""Largest and smallest values of variants, each with their angles, (v,)."""


def _told(grid: Grid, ends: _Ends, variants: slice) -> Extremes:
    return Extremes(*(Extreme(*(grid.told(one[variants]) for one in end)) for end in ends))


class _Order(NamedTuple):
    """How rows follow one another in the cycle: whose each is, of the quantities of every variant, and what is beside.

    whose: (n,); first: the first row of each of those, (v,); before, after: the rows of the pieces before and after,
    (n,), −1 where that piece is left out.
    """

    whose: Indices
    first: Indices
    before: Indices
    after: Indices

    @classmethod
    def of(cls, grid: Grid, rows: Rows) -> "_Order":
        variant, numbers = grid.number[rows.piece], np.arange(len(rows.piece))
        whose = rows.owner * len(grid.first) + variant
        first = np.flatnonzero(np.append(True, whose[1:] != whose[:-1]))
        after = numbers + 1
        after[np.append(first[1:], len(after)) - 1] = first
        apart = (rows.piece[after] - rows.piece - 1) % grid.counts[variant] != 0
        before = np.empty_like(after)
        before[after] = np.where(apart, -1, numbers)
        return cls(whose, first, before, np.where(apart, -1, after))


def _ends(grid: Grid, rows: Rows, turns: Turns) -> _Ends:
    """Return the largest and smallest values of the quantities of every variant, each with the first of its angles."""
    order = _Order.of(grid, rows)
    mirrored = rows._replace(value=-rows.value), turns._replace(value=-turns.value)
    sides = [(*side, _highest(*side)) for side in ((rows, turns), mirrored)]
    best = [np.maximum.reduceat(highest, order.first) for _, _, highest in sides]
    size = np.maximum(*np.abs(best))
    degrees = [_first_at(grid, order, *side, most, size) for side, most in zip(sides, best)]
    # beside the values of the other sign this is the rounding of a dead centre, which is no float
    high, low = (np.where(np.abs(most) > _ROUNDING * size, most, 0.0) for most in best)
    return (high + 0.0, degrees[0]), (0.0 - low, degrees[1])


def _highest(rows: Rows, turns: Turns) -> Array:
    """Return the largest value in each row, (n,)."""
    highest = rows.value.max(axis=1)
    np.maximum.at(highest, turns.place, turns.value)
    return np.asarray(highest)


def _first_at(grid: Grid, order: _Order, rows: Rows, turns: Turns, highest: Array, best: Array, size: Array) -> Array:
    """Return the first angles (v,) that reach the best values but for rounding: plateaus answer alike everywhere."""
    # a summit that comes back in every part of the cycle differs by the rounding of the sums that make the curve, ...
    level, slack = best - REPEATED * size, _ALIKE * np.abs(best)
    reached = highest >= level[order.whose]
    near, own = np.flatnonzero(reached), turns.at(reached[turns.place])
    own = own._replace(place=(np.cumsum(reached) - 1)[own.place])
    # ... and what only lies beside a summit, as high but for that, is none
    nodes, whose = _with_neighbours(order, rows, near), order.whose[near]
    beside_nodes, beside_turns = _beside(nodes, own)
    node, row = np.nonzero((nodes[1:-1] >= level[whose]) & (nodes[1:-1] >= beside_nodes - slack[whose]))
    of = whose[own.place]
    turned = (own.value >= level[of]) & (own.value >= beside_turns - slack[of])
    degrees = np.full(len(best), np.inf)
    np.minimum.at(degrees, whose[row], grid.degrees[rows.piece[near[row]], node])
    np.minimum.at(degrees, of[turned], own.degrees[turned])
    return degrees


def _with_neighbours(order: _Order, rows: Rows, near: Indices) -> Array:
    """Return the values at the nodes of these rows (k,), and at those before and after, (nodes + 2, k); −∞ for none."""
    before, after, value = order.before[near], order.after[near], rows.value.T
    last = np.where(before < 0, -np.inf, value[-1, before])
    first = np.where(after < 0, -np.inf, value[0, after])
    return np.concatenate((last[None], value.take(near, axis=1), first[None]))


def _beside(nodes: Array, turns: Turns) -> tuple[Array, Array]:
    """Return the higher one of the points on both sides of each node, (nodes, k), and of each turning point, (t,).

    nodes: with those before and after, (nodes + 2, k); turns: of these k rows.
    """
    at = turns.node + 1, turns.place
    between = np.full((len(nodes) - 1, nodes.shape[1]), -np.inf)
    np.maximum.at(between, at, turns.value)
    turned = between > -np.inf
    before = np.where(turned[:-1], between[:-1], nodes[:-2])
    after = np.where(turned[1:], between[1:], nodes[2:])
    sides = np.maximum(nodes[at], nodes[turns.node + 2, turns.place])
    return np.maximum(before, after), np.maximum(between[at], sides)
