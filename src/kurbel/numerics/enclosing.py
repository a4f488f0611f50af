"""The smallest circle round points in the plane, which are complex numbers, and round closed curves."""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray, Indices
from kurbel.numerics.lobatto import chebyshev, slope_of_series
from kurbel.numerics.pieces import Pieces

_AS_ONE = 1e-9
"""Share of a point in a circle that is 0 but for rounding."""
_NEAR = 1e-4
"""Of the squared radius: as near to the smallest circle leads the search among samples."""
_FLAT = 1e-9
"""Of the terms: a curve whose distance from a centre bends less is itself a circle about it."""
_SETTLED = 1e-7
"""Last step in radians, and of the radius: the next would be its square."""
_ROUNDS = 60


class Enclosing(NamedTuple):
    """Smallest circles round points (k, n): centre, complex, square of the radius (n,), and the share of each point.

    shares: (k, n), of sum 1, 0 of points that do not carry the circle; Σ share · point is the centre.
    """

    centre: ComplexArray
    square: Array
    shares: Array


@lru_cache
def _choices(count: int) -> Indices:
    """Return which points may carry a circle round so many: one, as (i, i, i), two, as (i, j, j), or three."""
    alone, pairs = ([(i, i, i) for i in range(count)], [(i, j, j) for i, j in combinations(range(count), 2)])
    columns = zip(*alone, *pairs, *combinations(range(count), 3))
    return np.array([*columns], dtype=np.intp)


def smallest_circle(points: ComplexArray, more: Any = 0.0) -> Enclosing:
    """Return the smallest circles round few points (k, n), for which max(|point − centre|² + more) is least.

    A circle through three points with u = b − a, v = c − a has w = centre − a with 2 w·u = |u|² + more_b − more_a, and
    so for v. It is the smallest of those carried by one, two or three points, between which it lies, that enclose all.

    >>> smallest_circle(np.array([[0j], [2 + 0j], [1 + 0.5j]]))[:2]
    (array([1.+0.j]), array([1.]))
    """
    choices, more = _choices(len(points)), np.broadcast_to(more, points.shape)
    (a, b, c), (more_a, more_b, more_c) = points[choices], more[choices]
    u, v = b - a, c - a
    p, q = np.abs(u) ** 2 + (more_b - more_a), np.abs(v) ** 2 + (more_c - more_a)
    alone, two = ((choices[i] == choices[2])[:, None] for i in (0, 1))
    with np.errstate(all="ignore"):
        area = (u.conj() * v).imag
        along = np.where(alone, 0.0, p / (2 * np.abs(u) ** 2))
        w = np.where(two, along * u, (p * v - q * u) / (2j * area))
        of_b = np.where(two, along, (w.conj() * v).imag / area)
        of_c = np.where(two, 0.0, (u.conj() * w).imag / area)
        square = (np.abs(points[:, None] - (a + w)) ** 2 + more[:, None]).max(axis=0)
        carried = np.minimum(1 - of_b - of_c, np.minimum(of_b, of_c)) >= -_AS_ONE
    best, each = np.where(carried, square, np.inf).argmin(axis=0), np.arange(points.shape[1])
    of_b, of_c = of_b[best, each], of_c[best, each]
    owners = choices[:, None, best] == np.arange(len(points))[:, None]
    shares = (owners * np.array([1 - of_b - of_c, of_b, of_c])[:, None]).sum(axis=0)
    return Enclosing((a + w)[best, each], square[best, each], shares)


class ClosedCurve:
    """A curve in the plane, complex, sampled on the pieces of a turn, (nodes, pieces), one of every machine (n,)."""

    def __init__(self, pieces: Pieces, points: ComplexArray) -> None:
        self.pieces, self.points = pieces, points
        self._each = np.arange(pieces.count)

    def at(self, degrees: Array) -> tuple[ComplexArray, ...]:
        """Return the points at angles (k, n) in degrees, with their first and second derivatives per radian."""
        row = self.pieces.holding(np.broadcast_to(self._each, degrees.shape), degrees)
        half, series = (
            self.pieces.half[row],
            self.pieces.rule.series @ self.points[:, row].reshape(len(self.points), -1),
        )
        places = (np.mod(degrees, self.pieces.cycle) - self.pieces.low[row]) / half - 1
        waves = np.moveaxis(chebyshev(np.clip(places, -1, 1), len(series)), -1, 0)
        found = []
        for order in range(3):
            values = (series.reshape(-1, *degrees.shape) * waves[: len(series)]).sum(axis=0)
            found.append(values / np.radians(half) ** order)
            series = slope_of_series(len(series)) @ series
        return tuple(found)

    def nearly_enclosed(self) -> Array:
        """Return the angles (4, n) in degrees of samples, of which two or three nearly carry the circle round all.

        A circle round four samples grows as the farthest sample takes the place of one that does not carry it.
        """
        ways = (self.points.real, self.points.imag, -self.points.real, -self.points.imag)
        points, degrees = (np.array(one) for one in zip(*map(self._farthest, ways)))
        for _ in range(_ROUNDS):
            circle = smallest_circle(points)
            arm = self.points - circle.centre[self.pieces.machine]
            far, far_at = self._farthest(arm.real**2 + arm.imag**2)
            if not (np.abs(far - circle.centre) ** 2 > circle.square * (1 + _NEAR)).any():
                break
            slot = circle.shares.argmin(axis=0)
            points[slot, self._each], degrees[slot, self._each] = far, far_at
        return degrees

    def _farthest(self, measure: Array) -> tuple[ComplexArray, Array]:
        """Return the samples (n,) at which a measure (nodes, pieces) is largest, and their angles in degrees."""
        pieces, tops = self.pieces, measure.max(axis=0)
        best = np.maximum.reduceat(tops, pieces.first)
        reached = np.flatnonzero(~(tops < best[pieces.machine]))  # of nan, too, there is one
        column = reached[np.searchsorted(pieces.machine[reached], self._each)]
        node = measure[:, column].argmax(axis=0)
        return self.points[node, column], pieces.degrees[node, column]

    def enclosed(self, degrees: Array) -> tuple[Enclosing, Array]:
        """Return the smallest circle round the curve near four of its points, and where it is farthest from the centre.

        degrees: of the points, (4, n). As the centre z moves, each stays where the distance of the curve c is largest:
        with arm d = c − z and τ = |c′|² + d·c″ < 0

            dφ = (c′·dz − d·c′)/τ      h(z) = |d|²/2 − (d·c′)²/2τ     h′ = −(d + c′dφ)     h″ = 1 − c′c′ᵀ/τ

        and min max h is found by Newton's method: with the mean h″ of the carrying points, H = LLᵀ, each step is the
        smallest circle round L⁻¹h′ with 2h − |L⁻¹h′|² more. It goes as fast where two points carry the circle.
        """
        circle = smallest_circle(self.at(degrees)[0])
        centre, shares, radius = circle.centre, circle.shares, np.sqrt(circle.square.max()) or 1.0
        for _ in range(_ROUNDS):
            point, slope, bend = self.at(degrees)
            arm = point - centre
            touching, speed, turn = (arm.conj() * slope).real, np.abs(slope) ** 2, (arm.conj() * bend).real
            summit = speed + turn < -_FLAT * (speed + np.abs(turn))
            yielding = np.where(summit, 1 / np.where(summit, speed + turn, 1.0), 0.0)  # 1/τ
            step = -touching * yielding
            twice_h, lean = np.abs(arm) ** 2 + touching * step, -(arm + slope * step)
            x, y, weight = slope.real, slope.imag, shares * yielding
            l_xx = np.sqrt(1 - (weight * x * x).sum(axis=0))
            l_xy = -(weight * x * y).sum(axis=0) / l_xx
            l_yy = np.sqrt(1 - (weight * y * y).sum(axis=0) - l_xy**2)
            scaled = lean.real / l_xx + 1j * (lean.imag - l_xy * lean.real / l_xx) / l_yy
            circle = smallest_circle(scaled, twice_h - np.abs(scaled) ** 2)
            up = -circle.centre.imag / l_yy
            moved = (-circle.centre.real - l_xy * up) / l_xx + 1j * up
            centre, shares = centre + moved, circle.shares
            step = np.clip(step + (slope.conj() * moved).real * yielding, -0.2, 0.2)
            degrees = np.mod(degrees + np.degrees(step), 360.0)
            if max(np.abs(step).max(), np.abs(moved).max() / radius) < _SETTLED:
                break
        return Enclosing(centre, circle.square, shares), degrees
