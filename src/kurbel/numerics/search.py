"""Searches over a cycle: the exact extremes between the nodes of a grid, and the exact zeros between the extremes."""

from collections.abc import Sequence
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
    roots,
    slope_brackets,
)
from kurbel.numerics.brackets import Evaluate as Evaluate
from kurbel.numerics.brackets import Sampled as Sampled
from kurbel.numerics.extreme import Extreme, chosen
from kurbel.numerics.grid import Grid

_ROUNDING = 8 * np.finfo(float).eps
"""What is no larger than this beside the largest value of its quantity is rounding and has no sign."""
_ALIKE = 4 * np.finfo(float).eps
"""By which values beside each other differ that are one but for rounding."""


class Curve(NamedTuple):
    """One quantity over the cycle, each (n,): nodes of a grid, and every angle between them where it turns round.

    They stand in order; between neighbouring angles of one piece, told by its row, it only rises or only falls.
    first: (v,) where each variant begins; turning: (k,) which of them are no nodes; at_nodes: (pieces, nodes) values at
    all nodes of the grid.
    """

    degrees: Array
    row: Indices
    value: Array
    first: Indices
    grid: Grid
    turning: Indices
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
        return self.degrees[self.turning], self.within[self.turning]

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


def extremes(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate) -> dict[str, Extremes]:
    """Return the exact extremes of several quantities over the grid, one-sided values at its breaks included.

    samples: the quantities on the grid, (pieces, nodes).
    """
    rows = may_be_extreme(grid, list(samples.values()))
    found = _ends(_extreme_pieces(grid, rows, _turning_points(grid, rows, evaluate)))
    count = len(grid.first)
    parts = (slice(number * count, (number + 1) * count) for number in range(len(samples)))
    return {name: _told(grid, found, part) for name, part in zip(samples, parts)}


def zeros(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate, size: float | None = None) -> dict[str, Any]:
    """Return the angles of `sign_changes` of quantities of which no extremes are wanted."""
    rows = may_be_zero(grid, list(samples.values()))
    return sign_changes(grid, _curves(grid, samples, evaluate, rows), evaluate, size)


def curves(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate) -> dict[str, Curve]:
    """Return several quantities as curves.

    samples: the quantities on the grid, (pieces, nodes).
    """
    return _curves(grid, samples, evaluate, everywhere(grid, list(samples.values())))


def _curves(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate, rows: Rows) -> dict[str, Curve]:
    """Return several quantities as curves; of intervals that are not worth a search only the ends of their piece."""
    turns = _turning_points(grid, rows, evaluate)
    owner, piece = rows.owner[turns.place], rows.piece[turns.place]
    found = {}
    for number, (name, sampled) in enumerate(samples.items()):
        kept = np.zeros(sampled.value.shape, dtype=bool)
        kept[:, 0] = kept[:, -1] = True
        mine = rows.owner == number
        beside = np.broadcast_to(rows.worth, (len(mine), len(grid.gaps)))[mine]
        kept[rows.piece[mine], :-1] |= beside
        kept[rows.piece[mine], 1:] |= beside
        nodes, own = len(grid.nodes), owner == number
        row, node = np.divmod(np.flatnonzero(kept), nodes)
        into = np.searchsorted(row * nodes + node, piece[own] * nodes + turns.node[own]) + 1
        at_nodes = grid.degrees[row, node], row, sampled.value[row, node]
        degrees, row, value, turning = _inserted(at_nodes, into, (turns.degrees[own], piece[own], turns.value[own]))
        found[name] = Curve(degrees, row, value, np.searchsorted(row, grid.first), grid, turning, sampled.value)
    return found


class _Turns(NamedTuple):
    """Where quantities turn round between two nodes: place of the row, node before, angle, value, (n,)."""

    place: Indices
    node: Indices
    degrees: Array
    value: Array

    def at(self, which: Flags) -> "_Turns":
        """Return those for which a flag (n,) is set."""
        parts: list[Any] = [part[which] for part in self]
        return _Turns(*parts)


def _turning_points(grid: Grid, rows: Rows, evaluate: Evaluate) -> _Turns:
    brackets = slope_brackets(grid, rows, evaluate)
    turns = _Turns(brackets.place, brackets.node, *roots(grid, rows, brackets, evaluate, "slope"))
    return turns.at(_apart_from_ends(rows, turns))


def _apart_from_ends(rows: Rows, turns: _Turns) -> Flags:
    """Return which do not, but for rounding, turn at the end of a piece: a dead centre is told as the angle it is."""
    apart = np.ones(len(turns.place), dtype=bool)
    for end, node in ((0, 0), (-1, rows.value.shape[1] - 2)):
        value = rows.value[turns.place, end]
        apart &= (turns.node != node) | ~(np.abs(turns.value - value) <= _ALIKE * np.abs(value))
    return apart


def _extreme_pieces(grid: Grid, rows: Rows, turns: _Turns) -> Curve:
    """Return the curve of the pieces that reach the largest or the smallest value but for rounding.

    Every quantity of every variant is one of its variants.
    """
    variants = len(grid.first)
    whose = rows.owner * variants + grid.number[rows.piece]
    first = np.flatnonzero(np.append(True, whose[1:] != whose[:-1]))
    high, low = rows.value.max(axis=1), rows.value.min(axis=1)
    np.maximum.at(high, turns.place, turns.value)
    np.minimum.at(low, turns.place, turns.value)
    top, bottom = np.maximum.reduceat(high, first), np.minimum.reduceat(low, first)
    slack = REPEATED * np.maximum(np.abs(top), np.abs(bottom))
    reached = ~((high < (top - slack)[whose]) & (low > (bottom + slack)[whose]))
    kept, nodes = np.flatnonzero(reached), rows.value.shape[1]
    pieces = rows.piece[kept]
    own = reached[turns.place]
    into = (np.cumsum(reached) - 1)[turns.place[own]] * nodes + turns.node[own] + 1
    at_nodes = grid.degrees.T.take(pieces, axis=1).T.ravel(), np.repeat(pieces, nodes), rows.value[kept].ravel()
    turned = turns.degrees[own], rows.piece[turns.place[own]], turns.value[own]
    degrees, row, value, turning = _inserted(at_nodes, into, turned)
    begins = np.searchsorted(whose[kept], np.arange(len(first))) * nodes
    return Curve(degrees, row, value, begins + np.searchsorted(np.sort(into), begins), grid, turning, rows.value)


def _inserted(points: Sequence[Any], into: Indices, turns: Sequence[Any]) -> tuple[Any, ...]:
    """Return angles and more (n,) of points in order, with those of turns before these places, and where these are."""
    order = np.lexsort((turns[0], into))
    turning = into[order] + np.arange(len(into))
    nodal = np.ones(len(points[0]) + len(into), dtype=bool)
    nodal[turning] = False
    found = []
    for own, turned in zip(points, turns):
        both = np.empty(len(nodal), own.dtype)
        both[nodal], both[turning] = own, turned[order]
        found.append(both)
    return *found, turning


def sign_changes(grid: Grid, found: dict[str, Curve], evaluate: Evaluate, size: float | None = None) -> dict[str, Any]:
    """Return the angles (n,) in degrees, ascending, at which several quantities take the other sign, round the cycle.

    What is zero but for rounding, beside `size` or its own largest value, has no sign: +, 0, − is one change, where the
    piece begins in which the new sign is met; +, 0, + is none. At a jump it is the angle of the jump.
    """
    parts = [_turns(curve, size) for curve in found.values()]
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


def _turns(curve: Curve, size: float | None) -> tuple[Brackets, Indices]:
    """Return the changes of sign inside pieces, with these as places, and the pieces that begin with one."""
    magnitude = np.abs(curve.value)
    noise = _ROUNDING * (
        np.maximum.reduceat(magnitude, curve.first) if size is None else np.full(len(curve.first), size)
    )
    kept = np.flatnonzero(magnitude > curve.of_each(noise))
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
    return _told(curve.grid, _ends(curve), slice(None))


_Ends = tuple[tuple[Array, Array], tuple[Array, Array]]
"""Largest and smallest values of variants, each with their angles, (v,)."""


def _told(grid: Grid, ends: _Ends, variants: slice) -> Extremes:
    return Extremes(*(Extreme(*(grid.told(one[variants]) for one in end)) for end in ends))


def _ends(curve: Curve) -> _Ends:
    high, low = np.maximum.reduceat(curve.value, curve.first), np.minimum.reduceat(curve.value, curve.first)
    size = np.maximum(np.abs(high), np.abs(low))
    return _first_at(curve, high, size, 1.0), _first_at(curve, low, size, -1.0)


def _first_at(curve: Curve, best: Array, size: Array, sign: float) -> tuple[Array, Array]:
    """Return the extremes and the first angles that reach them but for rounding: plateaus answer alike everywhere."""
    # a summit that comes back in every part of the cycle differs by the rounding of the sums that make the curve, ...
    level = curve.of_each(best * sign - REPEATED * size)
    high = np.flatnonzero(curve.value * sign >= level)
    # ... and what only lies beside a summit, as high but for that, is none
    owner = np.searchsorted(curve.first, high, side="right") - 1
    first, last = curve.first[owner], np.append(curve.first[1:], len(curve.value))[owner] - 1
    following, preceding = np.where(high == last, first, high + 1), np.where(high == first, last, high - 1)
    round_it = curve.grid.counts[owner % len(curve.grid.first)]  # of several quantities as of variants
    ahead = curve.row[following] - curve.row[high] + np.where(high == last, round_it, 0)
    behind = curve.row[high] - curve.row[preceding] + np.where(high == first, round_it, 0)
    value, slack = curve.value[high] * sign, _ALIKE * np.abs(best)[owner]
    # pieces between which others are left out do not stand beside each other
    after = np.where(ahead <= 1, curve.value[following] * sign, -np.inf)
    beside = np.maximum(after, np.where(behind <= 1, curve.value[preceding] * sign, -np.inf))
    summit = high[value >= beside - slack]
    degrees = np.full(len(best), np.inf)
    np.minimum.at(degrees, owner[value >= beside - slack], curve.degrees[summit])
    # beside the values of the other sign this is the rounding of a dead centre, which is no float
    exact = np.abs(best) > _ROUNDING * size
    return np.where(exact, best + 0.0, 0.0), degrees
