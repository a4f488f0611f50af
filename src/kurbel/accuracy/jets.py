"""Numbers with their first and second derivatives by the crank angle: a mechanism's joints say how it moves."""

from __future__ import annotations

from dataclasses import dataclass

from kurbel.accuracy.methods import Precise, mp


@dataclass(frozen=True)
class Jet:
    """A real or complex number, and its first and second derivative by φ in radians."""

    value: Precise
    rate: Precise = 0
    bend: Precise = 0

    def __add__(self, other: Jet) -> Jet:
        return Jet(self.value + other.value, self.rate + other.rate, self.bend + other.bend)

    def __sub__(self, other: Jet) -> Jet:
        return Jet(self.value - other.value, self.rate - other.rate, self.bend - other.bend)

    def __mul__(self, other: Jet) -> Jet:
        value = self.value * other.value
        rate = self.rate * other.value + self.value * other.rate
        bend = self.bend * other.value + 2 * self.rate * other.rate + self.value * other.bend
        return Jet(value, rate, bend)

    def __truediv__(self, other: Jet) -> Jet:
        divisor = other.value
        return self * other.through(1 / divisor, -1 / divisor**2, 2 / divisor**3)

    def through(self, value: Precise, first: Precise, second: Precise) -> Jet:
        """Return a function of this number, from its value and its derivatives by the number."""
        return Jet(value, first * self.rate, second * self.rate**2 + first * self.bend)

    def root(self) -> Jet:
        """Return the square root."""
        root = mp.sqrt(self.value)
        return self.through(root, 1 / (2 * root), -1 / (4 * root**3))

    def real(self) -> Jet:
        """Return the real part."""
        return Jet(mp.re(self.value), mp.re(self.rate), mp.re(self.bend))

    def imaginary(self) -> Jet:
        """Return the imaginary part."""
        return Jet(mp.im(self.value), mp.im(self.rate), mp.im(self.bend))

    def size(self) -> Jet:
        """Return the distance from 0."""
        across = self.imaginary()
        along = self.real()
        return (along * along + across * across).root()

    def bearing(self) -> Jet:
        """Return the direction from 0, in radians: the imaginary part of the logarithm."""
        number = self.value
        return self.through(mp.log(number), 1 / number, -1 / number**2).imaginary()


def turned(phi: Precise) -> Jet:
    """Return the unit vector at a crank angle in degrees, as a complex number."""
    turn = mp.expjpi(phi / 180)
    return Jet(turn, 1j * turn, -turn)
