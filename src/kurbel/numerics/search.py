"""Searches over a cycle: the exact extremes between the nodes of a grid, and the exact zeros between the extremes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Grid
from kurbel.numerics.roots import bracketed_roots

if TYPE_CHECKING:
    from kurbel.arrays import Array, Flags

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
"""Quantities at any (degrees, within), each (n,)."""


class Curve(NamedTuple):
    """One quantity over the cycle, each (n,): nodes of a grid, and every angle between them where it turns round.

    Between neighbouring angles of one piece it only rises or only falls.
    """

    degrees: Array
    within: Array
    value: Array


class Extremes(NamedTuple):
    """Largest and smallest value of one quantity over the cycle, with their angles."""

    largest: Extreme
    smallest: Extreme

    @property
    def peak(self) -> Extreme:
        """The largest magnitude, whichever sign the quantity has there."""
        return max(self.largest, Extreme(-self.smallest.value, self.smallest.degrees), key=lambda one: one.value)


class _Brackets(NamedTuple):
    """Intervals that hold one root each: number of the quantity, ends in degrees, piece, values at the ends; (n,)."""

    owner: Any
    low: Array
    high: Array
    within: Array
    f_low: Array
    f_high: Array

    @classmethod
    def joined(cls, parts: Iterable[_Brackets]) -> _Brackets:
        return cls(*map(np.concatenate, zip(*parts, strict=True)))


def extremes(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate) -> dict[str, Extremes]:
    """Return the exact extremes of several quantities over the grid, one-sided values at its breaks included.

    samples: the quantities on the grid, (pieces, nodes).
    """
    return {name: extremes_of(curve) for name, curve in curves(grid, samples, evaluate).items()}


def zeros(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate, size: float | None = None) -> dict[str, Array]:
    """Return the angles of `sign_changes` of quantities of which no extremes are wanted."""
    near = np.stack([_near_zero(grid, sampled) for sampled in samples.values()])
    return sign_changes(grid, curves(grid, samples, evaluate, near), evaluate, size)


def curves(grid: Grid, samples: dict[str, Sampled], evaluate: Evaluate, worth: Any = True) -> dict[str, Curve]:
    """Return several quantities as curves; what they do between two nodes is searched where `worth` holds.

    samples: the quantities on the grid, (pieces, nodes); worth: (quantities, pieces, nodes − 1).
    """
    brackets = _slope_brackets(grid, np.stack([sampled.slope for sampled in samples.values()]), evaluate, worth)
    peaks = _roots(brackets, evaluate, "slope")
    heights = _of_owners(evaluate(peaks, brackets.within), "value", brackets.owner) if len(peaks) else peaks
    return {
        name: Curve(
            np.concatenate((grid.degrees.ravel(), peaks[brackets.owner == k])),
            np.concatenate((grid.within.ravel(), brackets.within[brackets.owner == k])),
            np.concatenate((sampled.value.ravel(), heights[brackets.owner == k])),
        )
        for k, (name, sampled) in enumerate(samples.items())
    }


def _slope_brackets(grid: Grid, slope: Array, evaluate: Evaluate, worth: Any) -> _Brackets:
    """Return where slopes (quantities, pieces, nodes) pass zero between two nodes, once or to and fro."""
    ends = slope[..., :-1], slope[..., 1:]
    # a zero at a node counts for the interval that it ends, so that it is found once
    once = np.nonzero((((ends[0] < 0) & (ends[1] >= 0)) | ((ends[0] > 0) & (ends[1] <= 0))) & worth)
    owner, rows, nodes = twice = np.nonzero(_dips(grid, slope) & worth)
    plain = _between(grid, once, *(end[once] for end in ends))
    if not len(owner):
        return plain
    bends = grid.slopes(slope)
    share = bends[twice] / (bends[twice] - bends[owner, rows, nodes + 1])
    over = _between(grid, twice, *(end[twice] for end in ends))
    middle = over.low + share * (over.high - over.low)
    f_middle = _of_owners(evaluate(middle, over.within), "slope", owner)
    crossed = f_middle * over.f_low < 0
    halves = over._replace(high=middle, f_high=f_middle), over._replace(low=middle, f_low=f_middle)
    return _Brackets.joined((plain, *(_Brackets(*(part[crossed] for part in half)) for half in halves)))


def _dips(grid: Grid, slope: Array) -> Flags:
    """Return the intervals between nodes in which the tangents to a slope of one sign at both ends meet beyond zero."""
    bends = grid.slopes(slope)
    width = np.radians(np.diff(grid.degrees))
    low, high, bend, next_bend = slope[..., :-1], slope[..., 1:], bends[..., :-1], bends[..., 1:]
    toward = (low * high > 0) & (low * bend < 0) & (high * next_bend > 0)
    gap = np.where(toward, bend - next_bend, 1.0)
    lowest = low + bend * (high - low - next_bend * width) / gap
    return np.asarray(toward & (lowest * low <= 0))


def _between(grid: Grid, index: tuple[Any, ...], f_low: Array, f_high: Array) -> _Brackets:
    owner, rows, nodes = index
    return _Brackets(
        owner, grid.degrees[rows, nodes], grid.degrees[rows, nodes + 1], grid.within[rows, nodes], f_low, f_high
    )


def _near_zero(grid: Grid, sampled: Sampled) -> Flags:
    """Return the intervals (pieces, nodes − 1) in which a quantity may reach zero and turn back.

    Slope times width is four times what a parabola with these slopes rises above its ends.
    """
    value, slope = np.abs(sampled.value), np.abs(sampled.slope)
    reach = np.maximum(slope[:, :-1], slope[:, 1:]) * np.radians(np.diff(grid.degrees))
    return np.asarray(np.minimum(value[:, :-1], value[:, 1:]) <= reach)


def _of_owners(found: dict[str, Sampled], part: str, owner: Any) -> Array:
    stacked = np.stack([getattr(sampled, part) for sampled in found.values()])
    return np.asarray(stacked[owner, np.arange(len(owner))])


def _roots(brackets: _Brackets, evaluate: Evaluate, part: str) -> Array:
    """Return the roots in degrees of values or slopes in their brackets."""
    owner, low, high, within, f_low, f_high = brackets
    if not len(low):
        return low
    return bracketed_roots(lambda degrees: _of_owners(evaluate(degrees, within), part, owner), low, high, f_low, f_high)


def sign_changes(
    grid: Grid, found: dict[str, Curve], evaluate: Evaluate, size: float | None = None
) -> dict[str, Array]:
    """Return the angles (n,) in degrees, ascending, at which several quantities take the other sign, round the cycle.

    What is zero but for rounding, beside `size` or its own largest value, has no sign: +, 0, − is one change, where the
    piece begins in which the new sign is met; +, 0, + is none. At a jump it is the angle of the jump.
    """
    parts = [_turns(grid, k, curve, size) for k, curve in enumerate(found.values())]
    brackets = _Brackets.joined(part for part, _ in parts)
    roots = _roots(brackets, evaluate, "value")
    return {
        name: np.sort(np.mod(np.concatenate((roots[brackets.owner == k], parts[k][1])), grid.breaks[-1]))
        for k, name in enumerate(found)
    }


def _turns(grid: Grid, owner: int, curve: Curve, size: float | None) -> tuple[_Brackets, Array]:
    """Return the brackets of the changes of sign inside pieces, and the angles of those at breaks."""
    noise = _ROUNDING * (np.abs(curve.value).max() if size is None else size)
    order = np.lexsort((curve.degrees, curve.within))
    degrees, within, value = (part[order[np.abs(curve.value[order]) > noise]] for part in curve)
    following = np.roll(np.arange(len(value)), -1)
    last = np.flatnonzero(value * value[following] < 0)
    first = following[last]
    inside = (within[last] == within[first]) & (first > last)
    at_breaks = grid.breaks[np.searchsorted(grid.breaks, within[first[~inside]]) - 1]
    low, high = last[inside], first[inside]
    owners = np.full(len(low), owner)
    return _Brackets(owners, degrees[low], degrees[high], within[low], value[low], value[high]), at_breaks


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
    """Return the largest and smallest value of a curve."""
    return Extremes(_first_at(curve, 1.0), _first_at(curve, -1.0))


def _first_at(curve: Curve, sign: float) -> Extreme:
    """Return the extreme and the first angle that reaches it but for rounding: plateaus answer alike everywhere."""
    values = curve.value * sign
    best, size = values.max(), np.abs(values).max()
    # a summit that comes back in every part of the cycle differs by the rounding of the sums that make the curve, ...
    high = values >= best - _REPEATED * size
    # ... and what only lies beside a summit, as high but for that, is none
    summit = values >= np.maximum(np.roll(values, 1), np.roll(values, -1)) - 4 * np.finfo(float).eps * abs(best)
    # beside the values of the other sign this is the rounding of a dead centre, which is no float
    exact = abs(best) > _ROUNDING * size
    return Extreme(float(best * sign) + 0.0 if exact else 0.0, float(curve.degrees[high & summit].min()))
