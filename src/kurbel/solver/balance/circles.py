"""A vector in the plane that returns after a turn, as a sum of circles that it runs through in either sense."""

import math
from functools import cached_property

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.crank_angle import unit_vector
from kurbel.numerics.arithmetic import unless_cancelled
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.roots import roots_by_slope

_ALIKE = 64 * np.finfo(float).eps
"""By which summits of one height differ by rounding, relatively."""
_ROUNDING = 8 * np.finfo(float).eps
"""Of samples, beside the sum of the sizes that make them."""


class Circles:
    """F(φ) = Σ f_n e^{inφ} + g_n e^{−inφ}, n = 1, 2, …; forward, backward: f and g, complex (K,)."""

    def __init__(self, forward: ComplexArray, backward: ComplexArray) -> None:
        self.forward, self.backward = forward, backward
        self._orders = np.flatnonzero((forward != 0) | (backward != 0)) + 1

    def turned_by(self, weight: complex) -> "Circles":
        """Return the sum of this and a vector that turns once with φ."""
        forward = self.forward.copy()
        forward[0] += weight
        return Circles(forward, self.backward)

    @property
    def along(self) -> "Circles":
        """The component along the real axis alone."""
        half = (self.forward + self.backward.conj()) / 2
        return Circles(half, half.conj())

    def at(self, degrees: Array) -> ComplexArray:
        """Return the vectors (m,) at angles (m,) in degrees; a component that cancels is exactly 0."""
        size = np.abs(self.forward).sum() + np.abs(self.backward).sum()
        return np.asarray(unless_cancelled(self._derivatives(degrees, 1)[0], size))

    def _derivatives(self, degrees: Array, count: int) -> ComplexArray:
        """Return the vectors and their derivatives by φ, per radian, at angles (m,) in degrees, (count, m)."""
        turned = unit_vector(np.multiply.outer(np.asarray(degrees, float), self._orders))
        rates = (1j * self._orders) ** np.arange(count)[:, None]
        forward, backward = self.forward[self._orders - 1] * rates, self.backward[self._orders - 1] * rates.conj()
        # either sense by itself, so that what is mirrored cancels to the last digit
        return np.asarray(forward @ turned.T + backward @ turned.T.conj())

    @cached_property
    def summits(self) -> tuple[Extreme, ...]:
        """Every angle in degrees at which the length of the vector turns from rising to falling, highest first.

        A length that never changes, or but for rounding, has one at 0°.
        """
        angles = np.concatenate(([0.0], self._turning_points))
        lengths = np.abs(self.at(angles))
        order = np.argsort(-lengths, kind="stable")
        return tuple(Extreme(float(lengths[k]), float(angles[k])) for k in order)

    @property
    def largest(self) -> Extreme:
        """The largest length, and the first angle in degrees at which it is reached but for rounding."""
        highest = self.summits[0].value
        return min((one for one in self.summits if one.value >= highest * (1 - _ALIKE)), key=lambda one: one.degrees)

    @property
    def _turning_points(self) -> Array:
        """The angles (k,) in degrees at which the length turns from rising to falling."""
        if not len(self._orders):
            return np.array([])
        # eight samples for each angle that |F|², of twice the order, may turn at
        count = 32 * 2 ** int(self._orders[-1]).bit_length()
        angles: Array = np.linspace(0.0, 360.0, count + 1)
        slopes = self._sampled_slopes(count)
        falling = np.flatnonzero((slopes[:-1] > 0) & (slopes[1:] <= 0))
        ends = (angles[falling], angles[falling + 1], slopes[falling], slopes[falling + 1])
        return roots_by_slope(self._slopes_of_square, *ends)

    def _slopes_of_square(self, degrees: Array) -> tuple[Array, Array]:
        """Return half the derivative by φ, in radians, of |F|², and its own derivative by φ in degrees."""
        vector, slope, bend = self._derivatives(degrees, 3)
        turning = np.abs(slope) ** 2 + (vector.conj() * bend).real
        return (vector.conj() * slope).real, turning * (math.pi / 180)

    def _sampled_slopes(self, count: int) -> Array:
        """Return the slopes of the square at equal angles, both ends of the turn included; 0 what is rounding."""
        orders = self._orders
        spectrum = np.zeros(count, complex)
        spectrum[orders], spectrum[-orders] = self.forward[orders - 1], self.backward[orders - 1]
        turns = np.fft.fftfreq(count, 1 / count)
        vectors, slopes = np.fft.ifft((spectrum, 1j * turns * spectrum), norm="forward")
        found = np.asarray((vectors.conj() * slopes).real)
        steepest = np.abs(spectrum).sum() * np.abs(turns * spectrum).sum()
        found = np.where(np.abs(found) > _ROUNDING * steepest, found, 0.0)
        return np.append(found, found[:1])
