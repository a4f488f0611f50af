"""Closed curves in the plane as sums of waves: their farthest points, and the smallest circles round them."""

from __future__ import annotations

from functools import cached_property, lru_cache
from itertools import combinations, combinations_with_replacement
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray, Indices, Number

_AS_ONE = 1e-9
"""Share of a point in a circle that is 0 but for rounding."""
_NEAR = 1e-4
"""Of the squared radius: as near to the smallest circle leads the search among samples."""
_FLAT = 1e-9
"""Of the terms: a curve whose distance from a centre bends less is itself a circle about it."""
_CLOSE = 1e-7
"""Last step in radians, and of the radius: the next would be its square."""
_SETTLED = 1e-13
"""Of the radius: by what a curve may reach beyond the smallest circle round it."""
_ROUNDING = 1e-14
"""Of the size of a curve: a length that differs by less, and a centre that is nearer to 0, does so by rounding."""
_EQUAL = 1e-12
"""Of the largest length: summits that differ by less are equal; the first counts."""
_HIGH = 0.9
"""Of the largest sample: no summit between samples belongs to a lower one."""
_STEPS = 5
"""Newton's steps from a sample to the summit next to it."""
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
    few = [(i, j, j) for i, j in combinations_with_replacement(range(count), 2)]
    return np.array([*few, *combinations(range(count), 3)], dtype=np.intp).T


def smallest_circle(points: ComplexArray, more: Number = 0.0) -> Enclosing:
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
    two = (choices[1] == choices[2])[:, None]
    with np.errstate(all="ignore"):
        area = (u.conj() * v).imag
        along = p / np.where(u == 0, np.inf, 2 * np.abs(u) ** 2)
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
    """Curves c(φ) = Σ c_n e^{inφ}, n from −k to k, one of every machine.

    waves: the amplitudes c_n, complex, (2k + 1, machines); numbers: n, (2k + 1,).
    """

    def __init__(self, waves: ComplexArray) -> None:
        self.waves, self.numbers = waves, np.arange(len(waves)) - len(waves) // 2

    def of(self, number: int) -> ComplexArray:
        """Return the amplitudes of a wave (machines,), 0 of one that there is not."""
        return self.waves[self.numbers == number].sum(axis=0)

    def plus(self, number: int, amplitude: complex | ComplexArray) -> ClosedCurve:
        """Return the sum of this curve and one more wave of a number that it has."""
        waves = self.waves.copy()
        waves[number + len(waves) // 2] += amplitude
        return ClosedCurve(waves)

    def turned_back(self) -> ClosedCurve:
        """Return c e^{−iφ}, the curve as it is seen from a frame that turns with φ."""
        return ClosedCurve(np.concatenate((self.waves, np.zeros_like(self.waves[:2]))))

    def at(
        self, degrees: Array, machine: Indices | int = 0
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """Return the points at angles (…) in degrees, and their first and second derivatives by φ in radians."""
        present, own = self._present
        numbers = own.reshape(-1, *(1 for _ in degrees.shape))
        waves = present[:, np.broadcast_to(machine, degrees.shape)] * np.exp(
            1j * np.radians(numbers * degrees)
        )
        weights = np.stack((np.ones(len(waves)), 1j * own, -(own**2)))
        point, slope, bend = np.tensordot(weights, waves, 1)
        return point, slope, bend

    @cached_property
    def _present(self) -> tuple[ComplexArray, Indices]:
        """The amplitudes and numbers of the waves that any machine has."""
        rows = np.flatnonzero(self.waves.any(axis=1))
        return self.waves[rows], self.numbers[rows]

    @cached_property
    def samples(self) -> ComplexArray:
        """The points at equal angles from 0 on, (count, machines); eight to a period of the shortest wave at least."""
        count = 1 << (4 * len(self.waves)).bit_length()
        spectrum = np.zeros((count, self.waves.shape[1]), complex)
        spectrum[self.numbers] = self.waves
        return np.fft.ifft(spectrum, axis=0) * count

    def farthest(self) -> tuple[Array, Array]:
        """Return the largest distances from 0, and the first angles in degrees that have them, each (machines,)."""
        step, sizes = 360.0 / len(self.samples), np.abs(self.samples)
        best = sizes.max(axis=0)
        top = (
            (sizes >= np.roll(sizes, 1, axis=0))
            & (sizes >= np.roll(sizes, -1, axis=0))
            & (sizes >= _HIGH * best)
        )
        level = ~(best - sizes.min(axis=0) > _ROUNDING * best)  # of a circle every angle is as far
        top[:, level] = np.arange(len(sizes))[:, None] == 0
        machine, place = np.nonzero(top.T)
        sample = place.astype(float) * step
        degrees = sample
        for _ in range(_STEPS):
            point, slope, bend = self.at(degrees, machine)
            speed, turn = np.abs(slope) ** 2, (point.conj() * bend).real
            summit = speed + turn < -_SETTLED * (speed + np.abs(turn))
            moved = (point.conj() * slope).real / np.where(summit, -speed - turn, np.inf)
            degrees = np.clip(degrees + np.degrees(moved), sample - step, sample + step)
        degrees = np.mod(np.where(np.abs(degrees - sample) < 1e-9, sample, degrees), 360.0)
        lengths, first = (
            np.abs(self.at(degrees, machine)[0]),
            np.searchsorted(machine, np.arange(len(best))),
        )
        largest = np.maximum.reduceat(lengths, first)
        reached = ~(lengths < (1 - _EQUAL) * largest[machine])
        return largest, np.minimum.reduceat(np.where(reached, degrees, np.inf), first)

    def least_circle(self) -> tuple[ComplexArray, Array, Array]:
        """Return centre and radius of the smallest circle round it, and the first angle in degrees that touches it.

        Each (machines,). A curve without even waves is its own image about 0, its centre.
        """
        even = ~(self.waves[self.numbers % 2 == 0] != 0).any(axis=0)
        size = np.abs(self.samples).max(axis=0)
        degrees = np.zeros((4, len(size))) if even.all() else self._nearly_enclosed()
        for _ in range(_ROUNDS):
            circle, degrees = self._enclosed(degrees)
            centre = np.where(
                even | (np.abs(circle.centre) <= _ROUNDING * size), 0.0, circle.centre
            )
            radius, at = self.plus(0, -centre).farthest()
            beyond = ~even & (radius > np.sqrt(circle.square) * (1 + _SETTLED) + _ROUNDING * size)
            if not beyond.any():
                break
            degrees[circle.shares.argmin(axis=0), np.arange(len(size))] = at
        return centre, radius, at

    def _nearly_enclosed(self) -> Array:
        """Return the angles (4, n) in degrees of samples, of which two or three nearly carry the circle round all.

        A circle round four samples grows as the farthest sample takes the place of one that does not carry it.
        """
        samples, each = self.samples, np.arange(self.samples.shape[1])
        rows = np.array(
            [
                measure.argmax(axis=0)
                for side in (samples, -samples)
                for measure in (side.real, side.imag)
            ]
        )
        for _ in range(_ROUNDS):
            circle = smallest_circle(samples[rows, each])
            distance = np.abs(samples - circle.centre) ** 2
            far = distance.argmax(axis=0)
            if not (distance[far, each] > circle.square * (1 + _NEAR)).any():
                break
            rows[circle.shares.argmin(axis=0), each] = far
        return rows * (360.0 / len(samples))

    def _enclosed(self, degrees: Array) -> tuple[Enclosing, Array]:
        """Return the smallest circle round the curve near four of its points, and where it is farthest from the centre.

        degrees: of the points, (4, n). As the centre z moves, each stays where the distance of the curve c is largest:
        with arm d = c − z and τ = |c′|² + d·c″ < 0

            dφ = (c′·dz − d·c′)/τ      h(z) = |d|²/2 − (d·c′)²/2τ     h′ = −(d + c′dφ)     h″ = 1 − c′c′ᵀ/τ

        and min max h is found by Newton's method: with the mean h″ of the carrying points, H = LLᵀ, each step is the
        smallest circle round L⁻¹h′ with 2h − |L⁻¹h′|² more. It goes as fast where two points carry the circle.
        """
        machine = np.arange(degrees.shape[1])
        circle = smallest_circle(self.at(degrees, machine)[0])
        centre, shares, radius = circle.centre, circle.shares, np.sqrt(circle.square.max()) or 1.0
        for _ in range(_ROUNDS):
            point, slope, bend = self.at(degrees, machine)
            arm = point - centre
            touching, speed, turn = (
                (arm.conj() * slope).real,
                np.abs(slope) ** 2,
                (arm.conj() * bend).real,
            )
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
            if max(np.abs(step).max(), np.abs(moved).max() / radius) < _CLOSE:
                break
        return Enclosing(centre, circle.square, shares), degrees
