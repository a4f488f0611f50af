"""The smallest circle round points in the plane, which are complex numbers."""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

_ROUNDING = 1e-14


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
