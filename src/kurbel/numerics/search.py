"""All roots, and the minimum, of functions over an interval or a square that are evaluated at many places at once.

A function maps places (n, k), each from 0 to 1, to values (n,); a value is nan where the function has none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import permutations, product
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
    rounding = _ROUNDING * size
    y = _zero_at_ends(y, rounding)

    # where it is zero at samples: a stretch counts as one root
    starts, stops = _runs(np.abs(y) <= rounding)
    is_level = x[stops] - x[starts] > _LEVEL
    starts = starts[is_level]
    stops = stops[is_level]
    is_inside = np.zeros(len(x), dtype=bool)
    for start, stop in zip(starts, stops):
        is_inside[start : stop + 1] = True
    alone = x[(y == 0) & ~is_inside]

    # where it changes sign between two samples; at a zero nothing is left there, at a jump something is
    low = np.flatnonzero((y[:-1] * y[1:] < 0) & ~is_inside[:-1] & ~is_inside[1:])
    high = low + 1
    crossings: Array = np.empty(0)
    left: Array = np.empty(0)
    if len(low):

        def finite_values(points: Array) -> Array:
            return np.nan_to_num(function(points[:, None]))

        crossings = _closed(finite_values, x[low], x[high], y[low], y[high])
        left = function(crossings[:, None])
    has_value = np.isfinite(left)
    crossings = crossings[has_value]
    is_jump = np.abs(left[has_value]) > _LEFT * spread

    # all of them in order
    levels = _edges(function, x[starts], x[np.maximum(starts - 1, 0)], rounding)
    level_ends = _edges(function, x[stops], x[np.minimum(stops + 1, len(x) - 1)], rounding)
    points = np.concatenate((levels, alone, crossings))
    order = np.argsort(points, kind="stable")
    no_stretch = np.full(len(alone) + len(crossings), np.nan)
    until = np.concatenate((level_ends, no_stretch))
    no_jump = np.zeros(len(levels) + len(alone), dtype=bool)
    jumps = np.concatenate((no_jump, is_jump))
    return Roots(points[order], jumps[order], until[order])


def _zero_at_ends(y: Array, rounding: float) -> Array:
    """Return samples that are exactly zero at either end where only rounding is left there and no root is near it."""
    y = y.copy()
    for end, neighbour in ((0, 1), (-1, -2)):
        is_rounding = abs(y[end]) <= rounding
        if is_rounding and not y[end] * y[neighbour] < 0:
            y[end] = 0.0
    return y


def _edges(function: RealFunction, zero: Array, beyond: Array, rounding: float) -> Array:
    """Return how far from places (n,) toward others a function stays zero, by halves."""
    for _ in range(_HALVES if len(zero) else 0):
        middle = (zero + beyond) / 2
        is_zero = np.abs(function(middle[:, None])) <= rounding
        zero = np.where(is_zero, middle, zero)
        beyond = np.where(is_zero, beyond, middle)
    return zero


def _runs(flags: Flags) -> tuple[Indices, Indices]:
    """Return the first and the last index of every run of true flags."""
    padded = np.concatenate(([False], flags, [False]))
    starts = np.flatnonzero(padded[1:] & ~padded[:-1])
    stops = np.flatnonzero(padded[:-1] & ~padded[1:]) - 1
    return starts, stops


def _closed(function: RealFunction, low: Array, high: Array, f_low: Array, f_high: Array) -> Array:
    """Return a root in each bracket (n,): inverse quadratic steps where they are safe, else halves (Chandrupatla)."""
    # a: the newest point, b: that on the other side of the root, c: the one before
    a = high
    fa = f_high
    b = low
    fb = f_low
    part = np.full_like(a, 0.5)
    for _ in range(100):
        # until the brackets are as narrow as rounding
        width = np.maximum(np.abs(b - a), 1e-300)
        largest = np.maximum(np.abs(a), np.abs(b))
        least = np.minimum(np.spacing(largest) / width, 0.5)
        is_narrow = width * least >= width / 2
        if (is_narrow | (fa == 0) | (fb == 0)).all():
            break

        # the new point takes the place of the end with its sign
        middle = a + np.clip(part, least, 1 - least) * (b - a)
        f_middle = function(middle)
        has_sign_of_a = np.sign(f_middle) == np.sign(fa)
        c = np.where(has_sign_of_a, a, b)
        fc = np.where(has_sign_of_a, fa, fb)
        b = np.where(has_sign_of_a, b, a)
        fb = np.where(has_sign_of_a, fb, fa)
        a = middle
        fa = f_middle

        # the root of the inverse parabola through the three points, where it is monotonic
        with np.errstate(all="ignore"):
            xi = (a - b) / (c - b)
            phi = (fa - fb) / (fc - fb)
            from_b = fa / (fb - fa) * fc / (fb - fc)
            from_c = (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
            step = from_b + from_c
        is_safe = (phi**2 < xi) & ((1 - phi) ** 2 < 1 - xi) & np.isfinite(step)
        part = np.where(is_safe, np.clip(step, 0.0, 1.0), 0.5)
    return np.where(np.abs(fa) < np.abs(fb), a, b)


def _sampled(function: RealFunction) -> tuple[Array, Array]:
    """Return places (n,) and values (n,): dense where the function bends, and near the ends of its domain."""
    x = np.linspace(0.0, 1.0, _PLACES)
    y = function(x[:, None])
    # where it bends
    halved = _to_halve(x, y)
    while len(halved) and len(x) < _MOST:
        middles = (x[halved] + x[halved + 1])[: _MOST - len(x)] / 2
        x, y = _joined(x, y, middles, function)
        halved = _to_halve(x, y)

    # until the intervals without a value at one end are 1/16⁸ as wide
    parts = np.arange(1, _PARTS) / _PARTS
    for _ in range(8):
        widths = np.diff(x)
        has_value = np.isfinite(y)
        ends = np.flatnonzero(has_value[:-1] != has_value[1:])
        ends = ends[widths[ends] > _NARROWEST**2]
        if not len(ends):
            break
        inner = x[ends, None] + widths[ends, None] * parts
        x, y = _joined(x, y, inner.ravel(), function)
    return x, y


def _to_halve(x: Array, y: Array) -> Indices:
    """Return the intervals near which samples deviate from a cubic, or the function may touch zero in between."""
    # Lagrange's cubic through the two neighbours on either side
    nodes = np.stack([x[:-4], x[1:-3], x[3:-1], x[4:]])
    samples = np.stack([y[:-4], y[1:-3], y[3:-1], y[4:]])
    weights = np.ones_like(nodes)
    for i, j in permutations(range(4), 2):
        weights[i] *= (x[2:-2] - nodes[j]) / (nodes[i] - nodes[j])
    cubic = (weights * samples).sum(axis=0)
    spread = np.nanmax(y, initial=-np.inf) - np.nanmin(y, initial=np.inf)
    size = np.nanmax(np.abs(y), initial=0.0)
    is_bent = np.zeros(len(x), dtype=bool)
    is_bent[2:-2] = np.abs(y[2:-2] - cubic) > _LEAVES * spread + _ROUNDING * size

    # a sample nearer to zero than its neighbours, and about as near as it differs from them
    middle = y[1:-1]
    before = y[:-2]
    after = y[2:]
    has_no_crossing = (middle * before > 0) & (middle * after > 0)
    is_nearest = np.abs(middle) <= np.minimum(np.abs(before), np.abs(after))
    slopes = np.maximum(np.abs(before - middle), np.abs(after - middle))
    may_touch = has_no_crossing & is_nearest & (np.abs(middle) < slopes)
    is_bent[1:-1] |= may_touch
    is_wide = np.diff(x) > _NARROWEST
    return np.flatnonzero((is_bent[:-1] | is_bent[1:]) & is_wide)


def _joined(x: Array, y: Array, more: Array, function: RealFunction) -> tuple[Array, Array]:
    """Return samples with those at more places, in order."""
    x = np.append(x, more)
    y = np.append(y, function(more[:, None]))
    order = np.argsort(x)
    return x[order], y[order]


def common_roots(functions: RealFunction) -> Array:
    """Return the places (n, 2) in the unit square at which both of two functions are zero; functions: gives (n, 2).

    Newton's method starts in every cell of a grid of 16 a side in which both may be zero.
    """
    # cells whose corners have values on both sides of zero, or nearly; false where a corner has no value
    side = np.linspace(0.0, 1.0, _SIDE)
    grid = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1)
    values = functions(grid.reshape(-1, 2)).reshape(_SIDE, _SIDE, 2)
    corners = np.stack([values[:-1, :-1], values[:-1, 1:], values[1:, :-1], values[1:, 1:]])
    low = corners.min(axis=0)
    high = corners.max(axis=0)
    slack = (high - low) / 2  # zero may be passed between the corners
    may_be_zero = (low - slack <= 0) & (high + slack >= 0)
    is_start = may_be_zero.all(axis=-1)
    points = grid[:-1, :-1][is_start] + side[1] / 2

    # Newton's method in all of them at once
    spread = np.nanmax(np.abs(values), axis=(0, 1), initial=0.0)
    left = np.full(points.shape, np.nan)
    for _ in range(30 if len(points) else 0):
        left, slopes = _slopes(functions, points)
        with np.errstate(all="ignore"):
            determinant = slopes[:, 0, 0] * slopes[:, 1, 1] - slopes[:, 0, 1] * slopes[:, 1, 0]
            first = (slopes[:, 1, 1] * left[:, 0] - slopes[:, 0, 1] * left[:, 1]) / determinant
            second = (slopes[:, 0, 0] * left[:, 1] - slopes[:, 1, 0] * left[:, 0]) / determinant
        steps = np.nan_to_num(np.stack([first, second], axis=1), posinf=0.0, neginf=0.0)
        steps = np.clip(steps, -side[1], side[1])
        new = np.clip(points - steps, 0.0, 1.0)
        if np.abs(new - points).max() < 1e-15:
            break
        points = new

    # where both functions have vanished, in order, each root once
    is_root = (np.abs(left) <= _ROUNDING * 10 * spread).all(axis=1)
    points = points[is_root]
    points = points[np.lexsort(points.T[::-1])]
    distinct: list[Array] = []
    for point in points:
        distances = [np.abs(point - root).max() for root in distinct]
        if min(distances, default=np.inf) > _SAME:
            distinct.append(point)
    return np.array(distinct).reshape(-1, 2)


def _slopes(functions: RealFunction, points: Array) -> tuple[Array, Array]:
    """Return two functions (n, 2) and their slopes (n, functions, axes) by central differences."""
    step = 1e-6
    shifts = step * np.eye(2)
    right = np.clip(points + shifts[0], 0.0, 1.0)
    left = np.clip(points - shifts[0], 0.0, 1.0)
    above = np.clip(points + shifts[1], 0.0, 1.0)
    below = np.clip(points - shifts[1], 0.0, 1.0)
    values = functions(np.concatenate([points, right, left, above, below])).reshape(5, -1, 2)
    by_x = (values[1] - values[2]) / (right - left)[:, 0, None]
    by_y = (values[3] - values[4]) / (above - below)[:, 1, None]
    return values[0], np.stack([by_x, by_y], axis=-1)


def lowest(function: RealFunction, sides: int) -> tuple[Array, float]:
    """Return the place (sides,) of the lowest value of a function over an interval or a square, and that value.

    A value is inf or nan where it does not count; so is the value returned where none counts. Grids shrink round the
    lowest places of a first one; each spreads as the lowest places of the one before do, along a narrow valley too,
    and stays as large while its lowest place is on its edge.
    """
    side = np.linspace(0.0, 1.0, _PLACES if sides == 1 else _FINE_SIDE)
    centres = _valleys(function, side, sides)
    if not len(centres):
        return np.full(sides, np.nan), np.inf

    # a smaller grid about each valley; its axes are rows
    count, few = (17, 4) if sides == 1 else (9, 16)
    offsets = np.array([*product(np.linspace(-1.0, 1.0, count), repeat=sides)])
    axes: Array = np.tile(np.eye(sides) * side[1], (len(centres), 1, 1))
    values: Array = np.full(len(centres), np.inf)
    for _ in range(_MOST_GRIDS):
        # the few lowest points of each grid, in order
        points = np.clip(centres[:, None] + offsets @ axes, 0.0, 1.0)
        cost = _cost(function, points.reshape(-1, sides)).reshape(len(centres), -1)
        order = np.argsort(cost, axis=1, kind="stable")[:, :few]
        low = np.take_along_axis(cost, order, axis=1)
        near = np.take_along_axis(points, order[..., None], axis=1)

        # a lower point becomes the centre; on the edge of its grid, this stays as large
        is_lower = low[:, 0] < values
        is_on_edge = (np.abs(offsets[order[:, 0]]) == 1).any(axis=1) & is_lower
        centres = np.where(is_lower[:, None], near[:, 0], centres)
        values = np.where(is_lower, low[:, 0], values)
        old_share = np.where(is_on_edge, 1.0, 0.0)
        new_share = np.where(is_lower, 1.0, 0.7)
        new_axes = _spread(near, low, centres)
        axes = old_share[:, None, None] * axes + new_share[:, None, None] * new_axes

        # until all points are equal or close together
        is_equal = low[:, -1] - values <= _EQUAL * np.abs(values)
        is_close = np.abs(axes).max(axis=(1, 2)) < _CLOSE
        if (is_equal | is_close).all():
            break
        # a grid that cannot reach the lowest value is given up
        finite_cost = np.where(np.isfinite(cost), cost, values[:, None])
        is_rival = values <= values.min() + np.ptp(finite_cost, axis=1)
        centres = centres[is_rival]
        values = values[is_rival]
        axes = axes[is_rival]
    first = int(np.argmin(values))
    return centres[first], float(values[first])


def _valleys(function: RealFunction, side: Array, sides: int) -> Array:
    """Return the points (n, sides) of a grid that are lower than their neighbours, the few lowest, in order."""
    grid = np.stack(np.meshgrid(*[side] * sides, indexing="ij"), axis=-1)
    cost: Array = _cost(function, grid.reshape(-1, sides)).reshape(grid.shape[:-1])
    padded = np.pad(cost, 1, constant_values=np.inf)
    lowest_near = cost
    for shift in product((0, 1, 2), repeat=sides):
        window = tuple(slice(start, start + len(side)) for start in shift)
        lowest_near = np.minimum(lowest_near, padded[window])
    is_valley = np.isfinite(cost) & (cost <= lowest_near)
    order = np.argsort(cost[is_valley], kind="stable")[:_CANDIDATES]
    return grid[is_valley][order]


def _spread(near: Array, low: Array, centres: Array) -> Array:
    """Return the axes (n, sides, sides) of grids that spread as points (n, m, sides) do about the lowest ones."""
    counts = np.isfinite(low)[..., None]
    apart = np.where(counts, near - centres[:, None], 0.0)
    covariance = np.swapaxes(apart, 1, 2) @ apart / near.shape[1]
    squares, directions = np.linalg.eigh(covariance)
    sizes = _REACH * np.sqrt(np.maximum(squares, 0.0))
    sizes = np.maximum(sizes, _THIN * sizes[:, -1:])
    return sizes[..., None] * np.swapaxes(directions, 1, 2)


def _cost(function: RealFunction, points: Array) -> Array:
    """Return the values of a function, infinite where it has none."""
    values = function(points)
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
    # from where the chord is zero
    is_rising = first < last
    sum_of_ends = np.maximum(np.abs(first) + np.abs(last), 1e-300)
    points = low + (high - low) * (np.abs(first) / sum_of_ends)
    size = settled * np.maximum(np.maximum(np.abs(low), np.abs(high)), 1.0)
    for _ in range(60):
        value, slope = function(points)
        is_before_root = (value < 0) == is_rising
        low = np.where(is_before_root, points, low)
        high = np.where(is_before_root, high, points)
        # Newton's step; where it leaves the bracket, half of that
        with np.errstate(all="ignore"):
            step = points - value / slope
        is_safe = (step >= low - 1e-10) & (step <= high + 1e-10)
        new = np.where(is_safe, np.clip(step, low, high), (low + high) / 2)
        left = np.where(is_safe, np.abs(new - points), high - low)
        points = new
        if not (left > size).any():
            break
    return points
