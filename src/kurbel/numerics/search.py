"""Searches over a cycle: the exact extremes between the nodes of a grid, and the exact zeros between the extremes."""

from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices
from kurbel.numerics.arithmetic import where
from kurbel.numerics.brackets import (
    Brackets,
    Worth,
    everywhere,
    may_be_extreme,
    may_be_zero,
    roots,
    slope_brackets,
    slopes_worth,
)
from kurbel.numerics.brackets import Evaluate as Evaluate
from kurbel.numerics.brackets import Sampled as Sampled
from kurbel.numerics.extreme import Extreme, chosen
from kurbel.numerics.grid import Grid

_ROUNDING = 8 * np.finfo(float).eps
"""What is no larger than this beside the largest value of its quantity is rounding and has no sign."""
_ALIKE = 4 * np.finfo(float).eps
"""By which values beside each other differ that are one but for rounding."""
_REPEATED = 64 * np.finfo(float).eps
"""By which, beside the largest value, equal summits of a curve differ that is summed over cylinders and the cycle."""


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
        alike = abs(low.value - high.value) <= _REPEATED * abs(high.value)
        return chosen(where(alike, low.degrees < high.degrees, low.value > high.value), low, high)


def extremes(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate) -> dict[str, Extremes]:
    """Return the exact extremes of several quantities over the grid, one-sided values at its breaks included.

    samples: the quantities on the grid, (pieces, nodes).
    """
    worth = [may_be_extreme(grid, sampled) for sampled in samples.values()]
    turns = _turning_points(grid, samples, evaluate, worth)
    return {
        name: extremes_of(_extreme_pieces(grid, sampled.value, turns.of(k)))
        for k, (name, sampled) in enumerate(samples.items())
    }


def zeros(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate, size: float | None = None) -> dict[str, Any]:
    """Return the angles of `sign_changes` of quantities of which no extremes are wanted."""
    worth = [may_be_zero(grid, sampled) for sampled in samples.values()]
    return sign_changes(grid, _curves(grid, samples, evaluate, worth), evaluate, size)


def curves(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate) -> dict[str, Curve]:
    """Return several quantities as curves.

    samples: the quantities on the grid, (pieces, nodes).
    """
    return _curves(grid, samples, evaluate, [everywhere(grid)] * len(samples))


def _curves(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate, worth: list[Worth]) -> dict[str, Curve]:
    """Return several quantities as curves; of pieces that are not worth a search only their ends."""
    turns = _turning_points(grid, samples, evaluate, worth)
    found = {}
    for k, (name, sampled) in enumerate(samples.items()):
        kept = np.zeros(sampled.value.shape, dtype=bool)
        kept[:, 0] = kept[:, -1] = True
        kept[worth[k].rows] = True
        row, node = np.nonzero(kept)
        found[name] = _curve(grid, sampled.value, row, node, turns.of(k))
    return found


class _Turns(NamedTuple):
    """Where quantities turn round between two nodes: which one, row of the piece, node before, angle, value, (n,)."""

    owner: Indices
    row: Indices
    node: Indices
    degrees: Array
    value: Array

    def at(self, which: Flags) -> "_Turns":
        """Return those for which a flag (n,) is set."""
        parts: list[Any] = [part[which] for part in self]
        return _Turns(*parts)

    def of(self, owner: int) -> "_Turns":
        """Return those of one quantity."""
        return self.at(self.owner == owner)


def _turning_points(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate, worth: list[Worth]) -> _Turns:
    asked = [slopes_worth(grid, sampled, one) for sampled, one in zip(samples.values(), worth)]
    brackets = slope_brackets(grid, asked, evaluate)
    found = roots(grid, brackets, evaluate, "slope", [sampled.slope for sampled in samples.values()])
    turns = _Turns(brackets.owner, brackets.row, brackets.node, *found)
    return turns.at(_apart_from_ends(samples, turns))


def _apart_from_ends(samples: dict[str, Sampled], turns: _Turns) -> Flags:
    """Return which do not, but for rounding, turn at the end of a piece: a dead centre is told as the angle it is."""
    apart = np.ones(len(turns.row), dtype=bool)
    for owner, sampled in enumerate(samples.values()):
        own = np.flatnonzero(turns.owner == owner)
        for end, node in ((0, 0), (-1, sampled.value.shape[1] - 2)):
            value = sampled.value[turns.row[own], end]
            alike = np.abs(turns.value[own] - value) <= _ALIKE * np.abs(value)
            apart[own[alike & (turns.node[own] == node)]] = False
    return apart


def _extreme_pieces(grid: Grid, value: Array, turns: _Turns) -> Curve:
    """Return the curve of the pieces that reach the largest or the smallest value but for rounding."""
    high, low = value.max(axis=1), value.min(axis=1)
    np.maximum.at(high, turns.row, turns.value)
    np.minimum.at(low, turns.row, turns.value)
    top, bottom = np.maximum.reduceat(high, grid.first), np.minimum.reduceat(low, grid.first)
    slack = _REPEATED * np.maximum(np.abs(top), np.abs(bottom))
    reached = ~((high < grid.of_each(top - slack)) & (low > grid.of_each(bottom + slack)))
    rows, nodes = np.flatnonzero(reached), value.shape[1]
    row, node = np.repeat(rows, nodes), np.tile(np.arange(nodes), len(rows))
    return _curve(grid, value, row, node, turns.at(reached[turns.row]))


def _curve(grid: Grid, value: Array, row: Indices, node: Indices, turns: _Turns) -> Curve:
    """Return the values (pieces, nodes) at some nodes (n,), in order, as a curve with the turns, each in its place."""
    nodes = value.shape[1]
    place = np.searchsorted(row * nodes + node, turns.row * nodes + turns.node) + 1
    order = np.lexsort((turns.degrees, place))
    into = place[order]
    pieces = np.insert(row, into, turns.row[order])
    degrees = np.insert(grid.degrees[row, node], into, turns.degrees[order])
    values = np.insert(value[row, node], into, turns.value[order])
    turning = into + np.arange(len(into))
    return Curve(degrees, pieces, values, np.searchsorted(pieces, grid.first), grid, turning, value)


def sign_changes(grid: Grid, found: dict[str, Curve], evaluate: Evaluate, size: float | None = None) -> dict[str, Any]:
    """Return the angles (n,) in degrees, ascending, at which several quantities take the other sign, round the cycle.

    What is zero but for rounding, beside `size` or its own largest value, has no sign: +, 0, − is one change, where the
    piece begins in which the new sign is met; +, 0, + is none. At a jump it is the angle of the jump.
    """
    parts = [_turns(k, curve, size) for k, curve in enumerate(found.values())]
    brackets = Brackets.joined(part for part, _ in parts)
    zeros_inside, _ = roots(grid, brackets, evaluate, "value", [curve.at_nodes for curve in found.values()])
    changes = {}
    for k, name in enumerate(found):
        own, jumped = brackets.owner == k, parts[k][1]
        angles = np.mod(np.concatenate((zeros_inside[own], grid.low[jumped])), grid.cycle)
        changes[name] = grid.in_order(angles, np.concatenate((brackets.row[own], jumped)))
    return changes


def _turns(owner: int, curve: Curve, size: float | None) -> tuple[Brackets, Indices]:
    """Return the brackets of the changes of sign inside pieces, and the rows of the pieces that begin with one."""
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
    ends = signed.degrees[low], signed.degrees[high], row[low], np.zeros_like(low), value[low], value[high]
    return Brackets(np.full(len(low), owner), *ends), row[first[~inside]]


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
    first, last = curve.first[owner], np.append(curve.first[1:], len(curve.value))[owner] - 1
    following, preceding = np.where(high == last, first, high + 1), np.where(high == first, last, high - 1)
    round_it = curve.grid.counts[owner]
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
    return Extreme(curve.grid.told(np.where(exact, best + 0.0, 0.0)), curve.grid.told(degrees))
