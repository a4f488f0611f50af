"""Jets: arrays that carry their slope by the angle, so that one formula gives a value and its derivative.

The formulas of the mechanisms use only + − × ÷, √ and a choice by sign. Fed with the jets of sin φ and cos φ they
return the exact derivative of whatever they compute, with no second set of formulas to keep in step.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from kurbel.arrays import Array


class Jet:
    """Value and slope d/dφ (per radian), arrays of one shape."""

    __slots__ = ("slope", "value")
    __array_ufunc__ = None  # an array on the left lets the jet take over

    def __init__(self, value: Any, slope: Any) -> None:
        self.value = value
        self.slope = slope

    def __add__(self, other: Any) -> Jet:
        if isinstance(other, Jet):
            return Jet(self.value + other.value, self.slope + other.slope)
        return Jet(self.value + other, self.slope)

    __radd__ = __add__

    def __neg__(self) -> Jet:
        return Jet(-self.value, -self.slope)

    def __sub__(self, other: Any) -> Jet:
        if isinstance(other, Jet):
            return Jet(self.value - other.value, self.slope - other.slope)
        return Jet(self.value - other, self.slope)

    def __rsub__(self, other: Any) -> Jet:
        return Jet(other - self.value, -self.slope)

    def __mul__(self, other: Any) -> Jet:
        if isinstance(other, Jet):
            return Jet(self.value * other.value, self.slope * other.value + self.value * other.slope)
        return Jet(self.value * other, self.slope * other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Jet:
        if isinstance(other, Jet):
            quotient = self.value / other.value
            return Jet(quotient, (self.slope - quotient * other.slope) / other.value)
        return Jet(self.value / other, self.slope / other)

    def __rtruediv__(self, other: Any) -> Jet:
        quotient = other / self.value
        return Jet(quotient, -quotient * self.slope / self.value)

    def exp(self) -> Jet:
        """Return e to the power of the jet."""
        power = np.exp(self.value)
        return Jet(power, power * self.slope)

    def log1p(self) -> Jet:
        """Return ln(1 + jet)."""
        return Jet(np.log1p(self.value), self.slope / (1 + self.value))

    def __abs__(self) -> Jet:
        sign = 2.0 * (self.value >= 0) - 1.0
        return Jet(self.value * sign, self.slope * sign)

    def __ge__(self, other: float) -> Any:
        return self.value >= other

    def __lt__(self, other: float) -> Any:
        return self.value < other

    def sqrt(self) -> Jet:
        """Return √ of the jet."""
        root = np.sqrt(self.value)
        return Jet(root, self.slope / (2 * root))

    def bearing(self, cos: Jet) -> Jet:
        """Return the direction of (cos, self) in degrees, as `arithmetic.bearing`."""
        turning = (self.slope * cos.value - cos.slope * self.value) / (self.value**2 + cos.value**2)
        return Jet(np.degrees(np.arctan2(self.value, cos.value)), np.degrees(turning))

    @staticmethod
    def where(condition: Any, value: Any, otherwise: Any) -> Jet:
        """Return the jet that is `value` where the condition holds, and `otherwise` elsewhere."""
        first, second = (x if isinstance(x, Jet) else Jet(x, 0.0) for x in (value, otherwise))
        return Jet(np.where(condition, first.value, second.value), np.where(condition, first.slope, second.slope))


def once_each(within: Array) -> Array:
    """Return the angles of pieces (n, 1) that a grid has spread over its nodes, or (n,) angles as they are."""
    return within[:, :1] if within.ndim == 2 and within.strides[1] == 0 else within


def value_of(jet: Any) -> Any:
    """Return a jet, or an array as it is, without its slope."""
    return getattr(jet, "value", jet)
