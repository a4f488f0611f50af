"""The smallest circle round points in the plane, which are complex numbers, and round a closed curve."""

from collections.abc import Callable
from itertools import combinations
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray

_ROUNDING = 1e-14
_STEPS = 6
_SETTLED = 1e-8  # of a step beside the radius; the next would be its square

PlaneCurve = Callable[["Array"], "tuple[ComplexArray, ...]"]
"""Points of a curve, as complex numbers, with their first and second derivatives by the angle in radians, each (n,)."""


class Circle(NamedTuple):
    """A circle by its centre and its radius, and the one, two or three points that carry it."""

    centre: complex
    radius: float
    carriers: tuple[complex, ...]


def smallest_circle(points: list[complex]) -> Circle:
    """Return the smallest circle that encloses all points: two or three of them stand on it, or it is the only one.

    >>> smallest_circle([0j, 2 + 0j, 1 + 0.5j])
    Circle(centre=(1+0j), radius=1.0, carriers=(0j, (2+0j)))
    """
    found = [Circle(points[0], 0.0, (points[0],))]
    found += [Circle((a + b) / 2, abs(a - b) / 2, (a, b)) for a, b in combinations(points, 2)]
    found += [circle for three in combinations(points, 3) if (circle := _through(*three))]
    return min(found, key=lambda one: max(abs(point - one.centre) for point in points))


def _through(a: complex, b: complex, c: complex) -> Circle | None:
    """Return the circle through three points; None where two of them carry a smaller one, or all stand in line."""
    u, v = b - a, c - a
    angles = (u.conjugate() * v, (v - u) * -u.conjugate(), u.conjugate() * v - abs(v) ** 2)
    twice_area = angles[0].imag
    obtuse = angles[0].real < 0 or angles[1].real < 0 or angles[2].real > 0
    if obtuse or abs(twice_area) <= _ROUNDING * abs(u) * abs(v):
        return None
    centre = (abs(u) ** 2 * v - abs(v) ** 2 * u) / (2j * twice_area)
    return Circle(a + centre, abs(centre), (a, b, c))


def carried(curve: PlaneCurve, angles: Array, around: Circle) -> Array:
    """Return the angles in radians at which a curve carries the smallest circle round it, if these are near.

    around: the circle of the points at two or three `angles`.
    Newton's method for |d|² = 2 s and d·c′ = 0 of every d = c − z, with weights λ, of sum 1, that hold the centre:
    Σ λ d = 0. It goes as fast where two points carry the circle, or all but do, so that z could give way to a side.
    """
    count, found, size = len(angles), angles, around.radius
    ones, none = np.ones((count, 1)), np.zeros((count, count))
    z, s = around.centre / size, 0.5
    d = curve(found)[0] / size - z
    weights = np.linalg.lstsq(np.vstack((_pairs(d).T, ones.T)), np.array([0.0, 0.0, 1.0]), rcond=None)[0]
    for _ in range(_STEPS):
        point, slope, bend = (part / size for part in curve(found))
        d = point - z
        touching, turning = (d.conj() * slope).real, np.abs(slope) ** 2 + (d.conj() * bend).real
        rows = [
            [-_pairs(d), -ones, np.diag(touching), none],
            [-_pairs(slope), 0 * ones, np.diag(turning), none],
            [-np.eye(2), np.zeros((2, 1)), _pairs(slope * weights).T, _pairs(d).T],
            [np.zeros((1, 3 + count)), ones.T],
        ]
        matrix = np.vstack([np.hstack(row) for row in rows])
        missed = np.concatenate((np.abs(d) ** 2 / 2 - s, touching, _pairs(d).T @ weights, [weights.sum() - 1]))
        try:
            step = np.linalg.solve(matrix, -missed)
        except np.linalg.LinAlgError:  # a piece of the curve is itself a circle about z
            return angles
        z, s = z + complex(step[0], step[1]), s + step[2]
        found, weights = found + step[3 : 3 + count], weights + step[3 + count :]
        if np.abs(step).max() <= _SETTLED:
            break
    if (weights < 0).any():  # the circle rests on the others alone
        return carried(curve, angles[weights >= 0], around)
    return found if np.isfinite(found).all() else angles


def _pairs(vectors: ComplexArray) -> Array:
    return vectors[:, None].view(float)
