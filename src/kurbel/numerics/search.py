"""All roots, and the minimum, of functions over an interval or a square that are evaluated at many places at once.

A function maps places (n, k), each from 0 to 1, to values (n,); a value is nan where the function has none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices

_PLACES, _MOST = 65, 1000
"""Places of an interval at which a function is sampled first, and at most."""
_SIDE, _FINE_SIDE = 17, 33
"""Places along each side of a square: in the search for roots, and for the minimum."""
_LEAVES = 1e-3
"""Share of the spread of the samples: a sample farther from the cubic through its neighbours needs more around it."""
_ROUNDING = 1e-12
"""Share of the largest value: smaller differences of samples are rounding errors."""
_LEVEL = 1e-3
"""Width of an interval over which a function that is zero counts as level."""
_HALVES = 30
"""Times that the interval in which it ends to be level is halved."""
_NARROWEST = 2.0**-20
"""Width of the narrowest interval that is halved."""
_SAME = 1e-8
"""Distance below which roots of two functions are the same."""
_LEFT = 1e-7
"""Share of the spread of the samples: with a larger value at a change of sign, the function jumps there."""
_PARTS = 16
"""Parts of an interval that has no value at one end."""
_CANDIDATES, _MOST_GRIDS = 4, 150
"""Lowest places of the first grid, from each of which smaller grids start, and the most of these."""
_REACH = 1.6
"""Half the side of a grid over the standard deviation of the lowest places of the previous grid."""
_THIN = 1e-6
"""Least ratio of width to length of a grid."""
_CLOSE = 1e-12
"""Half the side of the last grid."""
_EQUAL = 1e-14
"""Relative difference of values that differ only by rounding."""

RealFunction = Callable[[Array], Array]


class Roots(NamedTuple):
    """Roots in order: places (n,); whether the function jumps there; until where it stays zero, nan for one place."""

    places: Array
    jumps: Flags
    until: Array


def roots(function: RealFunction, size: float = 0.0) -> Roots:
    """Return all places in the interval where a function changes sign, is zero, or ends at zero but for rounding.

    size: of the terms of which the function is the difference. Roots closer together than 1/64 may be missed where the
    function looks smooth between the samples.
    """
    x, y = _sampled(function)
    spread = np.nanmax(np.abs(y), initial=0.0)
    y = _zero_at_ends(y, _ROUNDING * size)

    # where it is zero at samples: a stretch counts as one root
    is_zero = np.abs(y) <= _ROUNDING * size
    starts, stops = _runs(is_zero)
    is_level = x[stops] - x[starts] > _LEVEL
    inside = np.zeros(len(x), dtype=bool)
    for start, stop in zip(starts[is_level], stops[is_level]):
        inside[start : stop + 1] = True
    alone = x[(y == 0) & ~inside]

    # where it changes sign between two samples
    passed = np.flatnonzero((y[:-1] * y[1:] < 0) & ~inside[:-1] & ~inside[1:])
    found: Array = np.empty(0)
    if len(passed):
        found = _closed(
            lambda places: np.nan_to_num(function(places[:, None])),
            x[passed],
            x[passed + 1],
            y[passed],
            y[passed + 1],
        )
    left = function(found[:, None]) if len(found) else found
    there = np.isfinite(left)
    found, left = found[there], left[there]

    # all of them in order
    begins, ends = starts[is_level], stops[is_level]
    levels = _edges(function, x[begins], x[np.maximum(begins - 1, 0)], _ROUNDING * size)
    last = _edges(function, x[ends], x[np.minimum(ends + 1, len(x) - 1)], _ROUNDING * size)
    places = np.concatenate((levels, alone, found))
    order = np.argsort(places, kind="stable")
    single = np.full(len(alone) + len(found), np.nan)
    until = np.concatenate((last, single))
    jumps = np.concatenate(
        (np.zeros(len(levels) + len(alone), dtype=bool), np.abs(left) > _LEFT * spread)
    )
    return Roots(places[order], jumps[order], until[order])


def _zero_at_ends(y: Array, rounding: float) -> Array:
    """Return samples that are exactly zero at either end where only rounding is left there and no root is beside it."""
    y = y.copy()
    for end, beside in ((0, 1), (-1, -2)):
        is_rounding = abs(y[end]) <= rounding
        if is_rounding and not y[end] * y[beside] < 0:
            y[end] = 0.0
    return y


def _edges(function: RealFunction, zero: Array, beyond: Array, rounding: float) -> Array:
    """Return how far from places (n,) toward others a function stays zero, by halves."""
    for _ in range(_HALVES if len(zero) else 0):
        middle = (zero + beyond) / 2
        is_zero = np.abs(function(middle[:, None])) <= rounding
        zero, beyond = np.where(is_zero, middle, zero), np.where(is_zero, beyond, middle)
    return zero


def _runs(flags: Flags) -> tuple[Indices, Indices]:
    """Return the first and the last index of every run of true flags."""
    padded = np.concatenate(([False], flags, [False]))
    return np.flatnonzero(padded[1:] & ~padded[:-1]), np.flatnonzero(padded[:-1] & ~padded[1:]) - 1


def _closed(function: RealFunction, low: Array, high: Array, f_low: Array, f_high: Array) -> Array:
    """Return a root in each bracket (n,): inverse quadratic steps where they are safe, else halves (Chandrupatla)."""
    a, b, fa, fb = high, low, f_high, f_low
    part = np.full_like(a, 0.5)
    for _ in range(100):
        width = np.maximum(np.abs(b - a), 1e-300)
        least = np.minimum(np.spacing(np.maximum(np.abs(a), np.abs(b))) / width, 0.5)
        if ((width * least >= width / 2) | (fa == 0) | (fb == 0)).all():
            break
        middle = a + np.clip(part, least, 1 - least) * (b - a)
        f_middle = function(middle)
        same = np.sign(f_middle) == np.sign(fa)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        b, fb = np.where(same, b, a), np.where(same, fb, fa)
        a, fa = middle, f_middle
        with np.errstate(all="ignore"):
            xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
            step = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (
                fc - fb
            )
        safe = (phi**2 < xi) & ((1 - phi) ** 2 < 1 - xi) & np.isfinite(step)
        part = np.where(safe, np.clip(step, 0.0, 1.0), 0.5)
    return np.where(np.abs(fa) < np.abs(fb), a, b)


def _sampled(function: RealFunction) -> tuple[Array, Array]:
    """Return places (n,) and values (n,): dense where the function bends, and near the ends of its domain."""
    x = np.linspace(0.0, 1.0, _PLACES)
    y = function(x[:, None])
    while len(x) < _MOST and len(halved := _to_halve(x, y)):
        more = (x[halved] + x[halved + 1])[: _MOST - len(x)] / 2
        x, y = _joined(x, y, more, function)
    for _ in range(8):  # until the intervals without a value at one end are 1/16⁸ as wide
        ends = np.flatnonzero(np.isfinite(y[:-1]) != np.isfinite(y[1:]))
        ends = ends[np.diff(x)[ends] > _NARROWEST**2]
        if not len(ends):
            break
        parts = np.arange(1, _PARTS) / _PARTS
        x, y = _joined(x, y, (x[ends, None] + np.diff(x)[ends, None] * parts).ravel(), function)
    return x, y


def _to_halve(x: Array, y: Array) -> Indices:
    """Return the intervals near which samples deviate from a cubic, or the function may touch zero in between."""
    nodes = np.stack([x[:-4], x[1:-3], x[3:-1], x[4:]])
    weights = np.ones_like(nodes)
    for one, other in product(range(4), repeat=2):
        if one != other:
            weights[one] *= (x[2:-2] - nodes[other]) / (nodes[one] - nodes[other])
    cubic = (weights * np.stack([y[:-4], y[1:-3], y[3:-1], y[4:]])).sum(axis=0)
    spread, size = (
        np.nanmax(y, initial=-np.inf) - np.nanmin(y, initial=np.inf),
        np.nanmax(np.abs(y), initial=0.0),
    )
    bent = np.zeros(len(x), dtype=bool)
    bent[2:-2] = np.abs(y[2:-2] - cubic) > _LEAVES * spread + _ROUNDING * size

    near, before, after = y[1:-1], y[:-2], y[2:]
    dips = (
        (near * before > 0)
        & (near * after > 0)
        & (np.abs(near) <= np.minimum(np.abs(before), np.abs(after)))
    )
    bent[1:-1] |= dips & (np.abs(near) < np.maximum(np.abs(before - near), np.abs(after - near)))
    return np.flatnonzero((bent[:-1] | bent[1:]) & (np.diff(x) > _NARROWEST))


def _joined(x: Array, y: Array, more: Array, function: RealFunction) -> tuple[Array, Array]:
    """Return samples with those at more places, in order."""
    x, y = np.append(x, more), np.append(y, function(more[:, None]))
    order = np.argsort(x)
    return x[order], y[order]


def common_roots(functions: RealFunction) -> Array:
    """Return the places (n, 2) in the unit square at which both of two functions are zero; functions: gives (n, 2).

    Newton's method starts in every cell of a grid of 16 a side in which both may be zero.
    """
    side = np.linspace(0.0, 1.0, _SIDE)
    grid = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1)
    values = functions(grid.reshape(-1, 2)).reshape(_SIDE, _SIDE, 2)
    corners = np.stack(
        [values[i : _SIDE - 1 + i, j : _SIDE - 1 + j] for i, j in product((0, 1), repeat=2)]
    )
    low, high = corners.min(axis=0), corners.max(axis=0)
    slack = (high - low) / 2  # zero may be passed between the corners
    starts = ((low - slack <= 0) & (high + slack >= 0)).all(
        axis=-1
    )  # false where a corner has no value
    places = grid[:-1, :-1][starts] + side[1] / 2
    spread = np.nanmax(np.abs(values), axis=(0, 1), initial=0.0)
    left = np.full(places.shape, np.nan)
    for _ in range(30 if len(places) else 0):
        left, slopes = _slopes(functions, places)
        with np.errstate(all="ignore"):
            determinant = slopes[:, 0, 0] * slopes[:, 1, 1] - slopes[:, 0, 1] * slopes[:, 1, 0]
            first = (slopes[:, 1, 1] * left[:, 0] - slopes[:, 0, 1] * left[:, 1]) / determinant
            second = (slopes[:, 0, 0] * left[:, 1] - slopes[:, 1, 0] * left[:, 0]) / determinant
        steps = np.nan_to_num(np.stack([first, second], axis=1), posinf=0.0, neginf=0.0)
        following = np.clip(places - np.clip(steps, -side[1], side[1]), 0.0, 1.0)
        if np.abs(following - places).max() < 1e-15:
            break
        places = following
    found = places[(np.abs(left) <= _ROUNDING * 10 * spread).all(axis=1)]
    found = found[np.lexsort(found.T[::-1])]
    kept: list[Array] = []
    for one in found:
        if all(np.abs(one - other).max() > _SAME for other in kept):
            kept.append(one)
    return np.array(kept).reshape(-1, 2)


def _slopes(functions: RealFunction, places: Array) -> tuple[Array, Array]:
    """Return two functions (n, 2) and their slopes (n, functions, places) by central differences."""
    step = 1e-6
    moved = [
        np.clip(places + sign * step * np.eye(2)[axis], 0.0, 1.0)
        for axis in (0, 1)
        for sign in (1, -1)
    ]
    values = functions(np.concatenate([places, *moved])).reshape(5, -1, 2)
    columns = [
        (values[1 + 2 * axis] - values[2 + 2 * axis])
        / (moved[2 * axis] - moved[2 * axis + 1])[:, axis, None]
        for axis in (0, 1)
    ]
    return values[0], np.stack(columns, axis=-1)


def lowest(function: RealFunction, sides: int) -> tuple[Array, float]:
    """Return the place (sides,) of the lowest value of a function over an interval or a square, and that value.

    A value is inf or nan where it does not count; so is the value returned where none counts. Grids shrink round the
    lowest places of a first one; each spreads as the lowest places of the one before do, along a narrow valley too,
    and stays as large while its lowest place is on its edge.
    """
    side = np.linspace(0.0, 1.0, _PLACES if sides == 1 else _FINE_SIDE)
    grid = np.stack(np.meshgrid(*[side] * sides, indexing="ij"), axis=-1)
    cost: Array = _cost(function, grid.reshape(-1, sides)).reshape(grid.shape[:-1])
    around = np.pad(cost, 1, constant_values=np.inf)
    shifts = [
        tuple(slice(1 + d, 1 + d + len(side)) for d in shift)
        for shift in product((-1, 0, 1), repeat=sides)
    ]
    valleys = np.isfinite(cost) & (cost <= np.min([around[shift] for shift in shifts], axis=0))
    centres = grid[valleys][np.argsort(cost[valleys], kind="stable")[:_CANDIDATES]]
    if not len(centres):
        return np.full(sides, np.nan), np.inf

    count, few = (17, 4) if sides == 1 else (9, 16)
    offsets = np.array([*product(np.linspace(-1.0, 1.0, count), repeat=sides)])
    axes: Array = np.tile(np.eye(sides) * side[1], (len(centres), 1, 1))  # of each grid, as rows
    values: Array = np.full(len(centres), np.inf)
    for _ in range(_MOST_GRIDS):
        places = np.clip(centres[:, None] + offsets @ axes, 0.0, 1.0)
        cost = _cost(function, places.reshape(-1, sides)).reshape(len(centres), -1)
        order = np.argsort(cost, axis=1, kind="stable")[:, :few]
        low, near = (
            np.take_along_axis(cost, order, axis=1),
            np.take_along_axis(places, order[..., None], axis=1),
        )
        lower = low[:, 0] < values
        edge = (np.abs(offsets[order[:, 0]]) == 1).any(axis=1) & lower
        centres, values = (
            np.where(lower[:, None], near[:, 0], centres),
            np.where(lower, low[:, 0], values),
        )
        kept, share = np.where(edge, 1.0, 0.0), np.where(lower, 1.0, 0.7)
        axes = kept[:, None, None] * axes + share[:, None, None] * _spread(near, low, centres)
        alike = low[:, -1] - values <= _EQUAL * np.abs(values)
        if (alike | (np.abs(axes).max(axis=(1, 2)) < _CLOSE)).all():
            break
        rivals = values <= values.min() + np.ptp(
            np.where(np.isfinite(cost), cost, values[:, None]), axis=1
        )
        centres, values, axes = centres[rivals], values[rivals], axes[rivals]
    first = int(np.argmin(values))
    return centres[first], float(values[first])


def _spread(near: Array, low: Array, centres: Array) -> Array:
    """Return the axes (n, sides, sides) of grids that spread as places (n, m, sides) do about the lowest ones."""
    apart = np.where(np.isfinite(low)[..., None], near - centres[:, None], 0.0)
    squares, directions = np.linalg.eigh(np.swapaxes(apart, 1, 2) @ apart / near.shape[1])
    sizes = _REACH * np.sqrt(np.maximum(squares, 0.0))
    return np.maximum(sizes, _THIN * sizes[:, -1:])[..., None] * np.swapaxes(directions, 1, 2)


def _cost(function: RealFunction, places: Array) -> Array:
    values = function(places)
    return np.where(np.isnan(values), np.inf, values)


# roots that are bracketed


def bracketed_roots(
    function: Callable[[Array], Sequence[Array] | Array],
    low: Array,
    high: Array,
    first: Array,
    last: Array,
    settled: float = 4e-16,
) -> Array:
    """Return one root in each bracket (n,), by Newton's method.

    function: maps all arguments (n,) at once to values and slopes (n,); first, last: its values at the ends, of which
    the signs differ, or one is zero; settled: the last step, relative to the argument or, of a small one, to 1.
    """
    rising = first < last
    places = low + (high - low) * (np.abs(first) / np.maximum(np.abs(first) + np.abs(last), 1e-300))
    size = settled * np.maximum(np.maximum(np.abs(low), np.abs(high)), 1.0)
    for _ in range(60):
        value, slope = function(places)
        below = (value < 0) == rising
        low, high = np.where(below, places, low), np.where(below, high, places)
        with np.errstate(all="ignore"):
            step = places - value / slope
        safe = (step >= low - 1e-10) & (step <= high + 1e-10)
        new = np.where(safe, np.clip(step, low, high), (low + high) / 2)
        left, places = np.where(safe, np.abs(new - places), high - low), new
        if not (left > size).any():
            break
    return places
