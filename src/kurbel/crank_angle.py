"""Crank angles in degrees, reduced exactly before any sine is taken, so that dead centres are exact zeros."""

import math
from typing import TYPE_CHECKING, Any, NamedTuple

from kurbel.numerics.arithmetic import where

if TYPE_CHECKING:
    from kurbel.arrays import Array
    from kurbel.numerics.pieces import Pieces

_RADIANS_PER_DEGREE = math.pi / 180


class CrankAngle(NamedTuple):
    """A crank angle, or an array of them, with its sine and cosine.

    degrees: angle in degrees, any size; sin, cos: of the same shape. The formulas of the mechanisms need only
    `sin` and `cos`, which may be floats, arrays or numbers of higher precision alike. rod: (sin ψ, cos ψ) at
    these angles of the one mechanism that they are used with, where known: most of its formulas need them.
    """

    degrees: Any
    sin: Any
    cos: Any
    rod: "tuple[Any, Any] | None" = None

    @classmethod
    def of(cls, degrees: "float | Array") -> "CrankAngle":
        """Return the angle for a number or an array of degrees.

        >>> CrankAngle.of(180.0)
        CrankAngle(degrees=180.0, sin=0.0, cos=-1.0, rod=None)

        Raises ValueError for nan or inf.
        """
        if isinstance(degrees, (int, float)):
            return cls(degrees, *_sin_cos_scalar(degrees))
        return cls(degrees, *_sin_cos_array(degrees))

    @classmethod
    def at_nodes(cls, pieces: "Pieces") -> "CrankAngle":
        """Return the angles of the nodes of pieces of a cycle, (nodes, pieces)."""
        return cls(pieces.degrees, *_turned(pieces.right_angle, pieces.offsets))

    @property
    def versine(self) -> Any:
        """1 − cos φ, without cancellation beside φ = 0."""
        return where(self.cos >= 0, self.sin * self.sin / (1 + abs(self.cos)), 1 + abs(self.cos))

    @property
    def vercosine(self) -> Any:
        """1 + cos φ, without cancellation beside φ = 180°."""
        return where(self.cos >= 0, 1 + abs(self.cos), self.sin * self.sin / (1 + abs(self.cos)))


def unit_vector(degrees: Any) -> Any:
    """Return e^{iφ}, complex, of an angle in degrees or an array of them, reduced exactly.

    >>> unit_vector(180.0)
    (-1+0j)
    """
    angle = CrankAngle.of(degrees)
    return angle.cos + 1j * angle.sin


def within_cycle(degrees: "Array", cycle: float) -> "Array":
    """Return angles (n,) in degrees as those of a cycle, from 0 on and less than its end."""
    import numpy as np

    if degrees.size and degrees.min() >= 0 and degrees.max() <= cycle:  # numpy.mod is slow
        return np.where(degrees == cycle, 0.0, degrees)
    return np.asarray(np.mod(degrees, cycle))


def _sin_cos_scalar(degrees: float) -> tuple[float, float]:
    if not math.isfinite(degrees):
        raise ValueError("a crank angle must be finite")
    rest = math.remainder(degrees, 360.0)
    quarter = round(rest / 90.0)
    rest = (rest - 90.0 * quarter) * _RADIANS_PER_DEGREE
    sin, cos = math.sin(rest), math.cos(rest)
    # adding 0.0 turns -0.0 into 0.0
    pair = ((sin, cos), (cos, -sin), (-sin, -cos), (-cos, sin))[quarter % 4]
    return pair[0] + 0.0, pair[1] + 0.0


def _sin_cos_array(degrees: "Array") -> "tuple[Array, Array]":
    import numpy as np

    if not np.isfinite(degrees).all():
        raise ValueError("a crank angle must be finite")
    degrees = degrees if np.abs(degrees).max(initial=0.0) <= 720.0 else np.fmod(degrees, 360.0)
    right_angle = 90.0 * np.rint(degrees / 90.0)
    return _turned(right_angle, degrees - right_angle)


def _turned(right_angle: "Array", offset: "Array") -> "tuple[Array, Array]":
    """Return sine and cosine of multiples of 90° and an offset in degrees."""
    import numpy as np

    rest = offset * _RADIANS_PER_DEGREE
    sin, cos = np.sin(rest), np.cos(rest)
    quarter = (right_angle / 90.0).astype(int) % 4
    swapped, signs = quarter % 2 == 1, np.array(((1.0, 1.0, -1.0, -1.0), (1.0, -1.0, -1.0, 1.0)))[:, quarter]
    if swapped.shape == sin.shape:
        sin, cos = np.where(swapped, cos, sin), np.where(swapped, sin, cos)
    else:  # of whole pieces, in place
        sin[:, swapped], cos[:, swapped] = cos[:, swapped], sin[:, swapped]
    sin *= signs[0]
    cos *= signs[1]
    # adding 0.0 turns −0.0 into 0.0
    return np.add(sin, 0.0, out=sin), np.add(cos, 0.0, out=cos)
