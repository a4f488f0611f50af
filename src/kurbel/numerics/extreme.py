"""An extreme: the value and its crank angle."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Truth
from kurbel.numerics.arithmetic import where


class Extreme(NamedTuple):
    """A value and the angle in degrees at which it occurs.

    For many machines both are arrays (machines,); the annotations are those of one machine.
    """

    value: float
    degrees: float


def number_of(answer: object) -> Any:
    """Return a key value without its angle: the value of an extreme, or the key value itself."""
    if not isinstance(answer, Extreme):
        return answer
    return answer.value


def size_of(answer: object) -> float:
    """Return the magnitude of a key value; of a list the largest; 0 for None."""
    number = number_of(answer)
    if isinstance(number, tuple):
        return max(map(abs, number), default=0.0)
    return abs(number or 0.0)


def largest(first: Extreme, *others: Extreme) -> Extreme:
    """Return the one with the largest value, the first of equal ones; nan is ignored."""
    for other in others:
        first = chosen(other.value > first.value, other, first)
    return first


def smallest(first: Extreme, *others: Extreme) -> Extreme:
    """Return the one with the smallest value, the first of equal ones; nan is ignored."""
    for other in others:
        first = chosen(other.value < first.value, other, first)
    return first


def chosen(condition: Truth, extreme: Extreme, otherwise: Extreme) -> Extreme:
    """Return the extreme where the condition holds, else the other one."""
    value = where(condition, extreme.value, otherwise.value)
    degrees = where(condition, extreme.degrees, otherwise.degrees)
    return Extreme(value, degrees)


_ALIKE = 1e-13
"""Relative difference of two values that differ only by rounding."""


class Extremes(NamedTuple):
    """Largest and smallest value of one quantity over the cycle, with their angles."""

    largest: Extreme
    smallest: Extreme

    @property
    def peak(self) -> Extreme:
        """The largest magnitude, of either sign; of two that differ only by rounding the first."""
        high = self.largest
        low = Extreme(-self.smallest.value, self.smallest.degrees)
        is_equal = abs(low.value - high.value) <= _ALIKE * abs(high.value)
        is_low = np.where(is_equal, low.degrees < high.degrees, low.value > high.value)
        return chosen(is_low, low, high)
