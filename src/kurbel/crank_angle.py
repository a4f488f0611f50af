"""Crank angles in degrees, reduced exactly before any sine is taken, so that dead centres are exact zeros."""

import math
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.numerics.arithmetic import magnitude, where
from kurbel.numerics.pieces import Pieces

_SINES = np.array([0.0, 1.0, 0.0, -1.0])
"""Of 0°, 90°, 180° and 270°."""

CYCLES = {"two-stroke": 1, "four-stroke": 2}
"""Working cycle -> revolutions of the shaft."""


class CrankAngle(NamedTuple):
    """A crank angle, or an array of them, with its sine and cosine.

    degrees: angle in degrees, any size; sin, cos: of the same shape. The formulas of the mechanisms need only
    `sin` and `cos`, which may be floats, arrays or numbers of higher precision. rod: (sin ψ, cos ψ) of the mechanism
    that is evaluated at these angles, if known: most of its formulas need them.
    """

    degrees: Number
    sin: Number
    cos: Number
    rod: tuple[Number, Number] | None = None

    @classmethod
    def of(cls, degrees: float | Array) -> "CrankAngle":
        """Return the angle for a number or an array of degrees.

        >>> CrankAngle.of(180.0)
        CrankAngle(degrees=180.0, sin=0.0, cos=-1.0, rod=None)

        Raises ValueError for nan or inf.
        """
        if isinstance(degrees, (int, float)):
            remainder = math.remainder(degrees, 360.0)
            quarter = round(remainder / 90.0)
            rest = math.radians(remainder - 90.0 * quarter)
            turn = complex(math.cos(rest), math.sin(rest)) * (1, 1j, -1, -1j)[quarter % 4]
            return cls(degrees, turn.imag + 0.0, turn.real + 0.0)  # adding 0.0 makes 0.0 of −0.0
        if not np.isfinite(degrees).all():
            raise ValueError("a crank angle must be finite")
        within_turn = np.fmod(degrees, 360.0)
        right_angle = 90.0 * np.rint(within_turn / 90.0)
        return cls(degrees, *_sin_cos(right_angle, within_turn - right_angle))

    @classmethod
    def at_nodes(cls, pieces: Pieces) -> "CrankAngle":
        """Return the angles of the nodes of pieces of a cycle, (nodes, pieces)."""
        return cls(pieces.degrees, *_sin_cos(pieces.right_angle, pieces.offsets))

    @property
    def versine(self) -> Number:
        """1 − cos φ, without cancellation near φ = 0."""
        size = magnitude(self.cos)
        return where(self.cos >= 0, self.sin * self.sin / (1 + size), 1 + size)

    @property
    def vercosine(self) -> Number:
        """1 + cos φ, without cancellation near φ = 180°."""
        size = magnitude(self.cos)
        return where(self.cos >= 0, 1 + size, self.sin * self.sin / (1 + size))


def unit_vector(degrees: Number) -> Any:
    """Return e^{iφ}, complex, of an angle in degrees or an array of them, reduced exactly.

    >>> unit_vector(180.0)
    (-1+0j)
    """
    angle = CrankAngle.of(degrees)
    return angle.cos + 1j * angle.sin


def within_cycle(degrees: Array, cycle: float) -> Array:
    """Return angles (n,) in degrees modulo the cycle, from 0 to less than its end."""
    if degrees.size and degrees.min() >= 0 and degrees.max() <= cycle:  # numpy.mod is slow
        return np.where(degrees == cycle, 0.0, degrees)
    return np.mod(degrees, cycle)


def _sin_cos(right_angle: Array, offset: Array) -> tuple[Array, Array]:
    """Return sine and cosine of multiples of 90°, (…, n), plus offsets in degrees of the same shape or (nodes, n)."""
    rest = np.radians(offset)
    sin, cos = np.sin(rest), np.cos(rest)
    # the last two bits of a whole number are what is left of it by 4, also where it is negative
    quarter = (right_angle / 90.0).astype(np.intp)
    own_sin, own_cos = _SINES[quarter & 3], _SINES[(quarter + 1) & 3]
    return sin * own_cos + cos * own_sin, cos * own_cos - sin * own_sin  # a zero is 0.0, never −0.0
