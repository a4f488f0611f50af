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
    up_to_two = [(i, j, j) for i, j in combinations_with_replacement(range(count), 2)]
    three = combinations(range(count), 3)
    return np.array([*up_to_two, *three], dtype=np.intp).T


def smallest_circle(points: ComplexArray, more: Number = 0.0) -> Enclosing:
    """Return the smallest circles round few points (k, n), for which max(|point − centre|² + more) is least.

    A circle through three points with u = b − a, v = c − a has w = centre − a with 2 w·u = |u|² + more_b − more_a, and
    so for v. It is the smallest of those carried by one, two or three points, between which it lies, that enclose all.

    >>> smallest_circle(np.array([[0j], [2 + 0j], [1 + 0.5j]]))[:2]
    (array([1.+0.j]), array([1.]))
    """
    choices = _choices(len(points))
    more = np.broadcast_to(more, points.shape)
    a, b, c = points[choices]
    more_a, more_b, more_c = more[choices]
    u = b - a
    v = c - a
    p = np.abs(u) ** 2 + (more_b - more_a)
    q = np.abs(v) ** 2 + (more_c - more_a)

    # centre and shares of the circle that each choice carries
    is_pair = (choices[1] == choices[2])[:, None]
    with np.errstate(all="ignore"):
        area = (u.conj() * v).imag
        along = p / np.where(u == 0, np.inf, 2 * np.abs(u) ** 2)
        w = np.where(is_pair, along * u, (p * v - q * u) / (2j * area))
        share_b = np.where(is_pair, along, (w.conj() * v).imag / area)
        share_c = np.where(is_pair, 0.0, (u.conj() * w).imag / area)
        centre = a + w
        square = (np.abs(points[:, None] - centre) ** 2 + more[:, None]).max(axis=0)
        share_a = 1 - share_b - share_c
        is_between = np.minimum(share_a, np.minimum(share_b, share_c)) >= -_AS_ONE

    # the smallest of those whose centre is between the points that carry it
    choice = np.where(is_between, square, np.inf).argmin(axis=0)
    column = np.arange(points.shape[1])
    best = choice, column
    is_owner = choices[:, None, choice] == np.arange(len(points))[:, None]
    best_shares = np.array([share_a[best], share_b[best], share_c[best]])
    shares = (is_owner * best_shares[:, None]).sum(axis=0)
    return Enclosing(centre[best], square[best], shares)


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
        present_waves, n = self._present
        numbers = n.reshape(-1, *(1 for _ in degrees.shape))
        amplitudes = present_waves[:, np.broadcast_to(machine, degrees.shape)]
        waves = amplitudes * np.exp(1j * np.radians(numbers * degrees))
        weights = np.stack((np.ones(len(waves)), 1j * n, -(n**2)))
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
        # high samples no lower than their neighbours; of a circle every angle is as far, and the first one counts
        distances = np.abs(self.samples)
        highest = distances.max(axis=0)
        is_peak = distances >= np.roll(distances, 1, axis=0)
        is_peak &= distances >= np.roll(distances, -1, axis=0)
        is_peak &= distances >= _HIGH * highest
        is_circle = ~(highest - distances.min(axis=0) > _ROUNDING * highest)
        is_peak[:, is_circle] = np.arange(len(distances))[:, None] == 0
        machine, number = np.nonzero(is_peak.T)

        # Newton's method to the summit next to each sample: d|c|²/dφ = 0
        step = 360.0 / len(self.samples)
        sample = number.astype(float) * step
        degrees = sample
        for _ in range(_STEPS):
            point, slope, bend = self.at(degrees, machine)
            speed = np.abs(slope) ** 2
            turn = (point.conj() * bend).real
            is_summit = speed + turn < -_SETTLED * (speed + np.abs(turn))
            shift = (point.conj() * slope).real / np.where(is_summit, -speed - turn, np.inf)
            degrees = np.clip(degrees + np.degrees(shift), sample - step, sample + step)
        is_sample = np.abs(degrees - sample) < 1e-9
        degrees = np.mod(np.where(is_sample, sample, degrees), 360.0)

        # the first of the summits that are as far but for rounding
        lengths = np.abs(self.at(degrees, machine)[0])
        first = np.searchsorted(machine, np.arange(len(highest)))
        largest = np.maximum.reduceat(lengths, first)
        is_farthest = ~(lengths < (1 - _EQUAL) * largest[machine])
        return largest, np.minimum.reduceat(np.where(is_farthest, degrees, np.inf), first)

    def least_circle(self) -> tuple[ComplexArray, Array, Array]:
        """Return centre and radius of the smallest circle round it, and the first angle in degrees that touches it.

        Each (machines,). A curve without even waves is its own image about 0, its centre.
        """
        is_even = self.numbers % 2 == 0
        is_centred = ~(self.waves[is_even] != 0).any(axis=0)
        size = np.abs(self.samples).max(axis=0)
        machine = np.arange(len(size))
        degrees = np.zeros((4, len(size))) if is_centred.all() else self._nearly_enclosed()
        for _ in range(_ROUNDS):
            # the circle round four points of the curve, and how far the curve reaches beyond it
            circle, degrees = self._enclosed(degrees)
            is_at_origin = is_centred | (np.abs(circle.centre) <= _ROUNDING * size)
            centre = np.where(is_at_origin, 0.0, circle.centre)
            radius, farthest = self.plus(0, -centre).farthest()
            least = np.sqrt(circle.square) * (1 + _SETTLED) + _ROUNDING * size
            reaches_beyond = ~is_centred & (radius > least)
            if not reaches_beyond.any():
                break
            # the farthest point takes the place of the one that carries the circle least
            degrees[circle.shares.argmin(axis=0), machine] = farthest
        return centre, radius, farthest

    def _nearly_enclosed(self) -> Array:
        """Return the angles (4, n) in degrees of samples, of which two or three nearly carry the circle round all.

        A circle round four samples grows as the farthest sample takes the place of one that does not carry it.
        """
        # the samples farthest to the right, above, to the left and below
        samples = self.samples
        machine = np.arange(samples.shape[1])
        directions = (samples.real, samples.imag, -samples.real, -samples.imag)
        rows = np.array([distance.argmax(axis=0) for distance in directions])
        for _ in range(_ROUNDS):
            circle = smallest_circle(samples[rows, machine])
            square = np.abs(samples - circle.centre) ** 2
            farthest = square.argmax(axis=0)
            reaches_beyond = square[farthest, machine] > circle.square * (1 + _NEAR)
            if not reaches_beyond.any():
                break
            rows[circle.shares.argmin(axis=0), machine] = farthest
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
        centre = circle.centre
        shares = circle.shares
        radius = np.sqrt(circle.square.max()) or 1.0
        for _ in range(_ROUNDS):
            # 1/τ; 0 where the curve is a circle about the centre
            point, slope, bend = self.at(degrees, machine)
            arm = point - centre
            arm_slope = (arm.conj() * slope).real  # d·c′
            speed = np.abs(slope) ** 2
            turn = (arm.conj() * bend).real
            is_summit = speed + turn < -_FLAT * (speed + np.abs(turn))
            inverse_tau = np.where(is_summit, 1 / np.where(is_summit, speed + turn, 1.0), 0.0)

            # dφ of a centre that stays, 2h and h′
            step = -arm_slope * inverse_tau
            twice_h = np.abs(arm) ** 2 + arm_slope * step
            h_slope = -(arm + slope * step)

            # L of the mean h″
            x = slope.real
            y = slope.imag
            weight = shares * inverse_tau
            l_xx = np.sqrt(1 - (weight * x * x).sum(axis=0))
            l_xy = -(weight * x * y).sum(axis=0) / l_xx
            l_yy = np.sqrt(1 - (weight * y * y).sum(axis=0) - l_xy**2)

            # the smallest circle round L⁻¹h′, and from its centre the shift of the centre
            scaled_x = h_slope.real / l_xx
            scaled = scaled_x + 1j * (h_slope.imag - l_xy * h_slope.real / l_xx) / l_yy
            circle = smallest_circle(scaled, twice_h - np.abs(scaled) ** 2)
            up = -circle.centre.imag / l_yy
            shift = (-circle.centre.real - l_xy * up) / l_xx + 1j * up
            centre = centre + shift
            shares = circle.shares

            # the points follow the centre
            step = np.clip(step + (slope.conj() * shift).real * inverse_tau, -0.2, 0.2)
            degrees = np.mod(degrees + np.degrees(step), 360.0)
            if max(np.abs(step).max(), np.abs(shift).max() / radius) < _CLOSE:
                break
        return Enclosing(centre, circle.square, shares), degrees
