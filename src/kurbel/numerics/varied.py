"""Numbers of many machines in place of one float, so that rules and formulas written for one serve them all."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Sequence
from itertools import repeat
from typing import Any

import numpy as np

from kurbel.arrays import Flags


class Parted(Exception):
    """A condition holds for some of many machines and not for others; holds: for which, (machines,)."""

    def __init__(self, holds: Flags) -> None:
        super().__init__()
        self.holds = holds


def varied(numbers: Sequence[float]) -> Varied:
    """Return numbers of many machines."""
    return Varied(np.array(numbers))


def _done(operate: Callable[[Any, Any], Any], reflected: bool = False) -> Callable[[Varied, Any], Any]:
    def method(self: Varied, other: Any) -> Any:
        if not isinstance(other, (float, int, Varied)):
            return NotImplemented
        one, two = (other, self) if reflected else (self, other)
        return Varied(operate(_plain(one), _plain(two)))

    return method


def _asked(operate: Callable[[Any, Any], Any]) -> Callable[[Varied, Any], Any]:
    def method(self: Varied, other: Any) -> Any:
        if not isinstance(other, (float, int, Varied)):
            return NotImplemented
        return _decided(operate(self.values, _plain(other)))

    return method


def _plain(number: Any) -> Any:
    return number.values if isinstance(number, Varied) else number


def _decided(holds: Flags) -> bool:
    """Return whether a condition holds for all machines or for none; raises Parted where they differ."""
    if holds.all():
        return True
    if holds.any():
        raise Parted(holds)
    return False


def _divided(over: Any, under: Any) -> Any:
    if _decided(np.equal(under, 0)):
        raise ZeroDivisionError("division by zero")
    return over / under


def _power(base: Any, exponent: Any) -> Any:
    """Return what Python's floats have; numpy rounds otherwise."""
    count = max(np.size(base), np.size(exponent))
    pairs = zip(*(np.broadcast_to(one, count).tolist() for one in (base, exponent)))
    return np.array([one**two for one, two in pairs])


class Varied:
    """Numbers (machines,) in place of a float: each operation is that of floats, one by one and to the last bit.

    A comparison must hold for all machines or for none; else Parted is raised, so that the two groups can be computed
    separately. What is written for floats alone, such as the functions of `math`, raises TypeError.
    """

    __slots__ = ("values",)
    __array_ufunc__ = None  # numpy is to leave them alone
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, values: Any) -> None:
        self.values = values

    __add__, __radd__ = _done(operator.add), _done(operator.add, True)
    __sub__, __rsub__ = _done(operator.sub), _done(operator.sub, True)
    __mul__, __rmul__ = _done(operator.mul), _done(operator.mul, True)
    __truediv__, __rtruediv__ = _done(_divided), _done(_divided, True)
    __pow__, __rpow__ = _done(_power), _done(_power, True)
    __lt__, __le__, __gt__, __ge__ = map(_asked, (operator.lt, operator.le, operator.gt, operator.ge))
    __eq__, __ne__ = _asked(operator.eq), _asked(operator.ne)

    def __neg__(self) -> Varied:
        return Varied(-self.values)

    def __abs__(self) -> Varied:
        return Varied(abs(self.values))

    def __bool__(self) -> bool:
        return _decided(self.values != 0)

    def sqrt(self) -> Varied:
        """Return the square root of each."""
        if _decided(self.values < 0):
            raise ValueError("math domain error")
        return Varied(np.sqrt(self.values))

    def ulp(self) -> Varied:
        """Return the unit in the last place of each."""
        return Varied(np.spacing(abs(self.values)))

    @staticmethod
    def total(terms: Sequence[Any]) -> Varied:
        """Return the sum of numbers, some of them varied, rounded once."""
        each = (one.values.tolist() if isinstance(one, Varied) else repeat(one) for one in terms)
        return Varied(np.array([math.fsum(own) for own in zip(*each)]))

    def alike(self) -> None:
        """Raise Parted where some are 0, or infinite, and others not."""
        for special in (0.0, math.inf):
            _decided(self.values == special)
