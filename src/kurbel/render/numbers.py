"""How numbers look: as many digits as an engineer reads, the same number of decimals along a row, no negative zero."""

import math
from collections.abc import Iterable
from typing import NamedTuple

from kurbel.report.tables import Value

DIGITS = 4
"""Significant digits of the largest value of a row by default."""

_LARGE = 7  # from 1e7 on, and below 1e-4, a row gets its power of ten into the head
_SMALL = -4


class Scale(NamedTuple):
    """How a row is written: each value over 10^exponent, with this many decimals."""

    decimals: int
    exponent: int = 0


def scale_of(values: Iterable[Value], digits: int | None = None) -> Scale:
    """Return the scale that shows so many significant digits of the largest value.

    By default there are four, and whole numbers keep all of theirs; with `digits` they are rounded, too.

    >>> scale_of([1.2, -0.014]), scale_of([81134.0]), scale_of([81134.0], 2)
    (Scale(decimals=3, exponent=0), Scale(decimals=0, exponent=0), Scale(decimals=-3, exponent=0))
    >>> scale_of([2.4e7, 1.0])
    Scale(decimals=2, exponent=6)
    """
    least = 0 if digits is None else -_LARGE
    digits = digits or DIGITS
    largest = max((abs(value) for value in values if value is not None), default=0.0)
    if largest == 0:
        return Scale(0)
    power = _power(largest, digits)
    exponent = 3 * math.floor(power / 3) if power >= _LARGE or power < _SMALL else 0
    return Scale(max(least, digits - 1 - power + exponent), exponent)


def _power(value: float, digits: int) -> int:
    """Return the power of ten of the value as rounded: 3 for 999.96 at four digits."""
    return int(f"{value:.{digits - 1}e}".partition("e")[2])


def angle_scale(values: Iterable[Value]) -> Scale:
    """Return the fewest decimals that distinguish all these angles, at most six."""
    texts = (_shortest(value, 6) for value in values if value is not None)
    return Scale(max((len(text.partition(".")[2]) for text in texts), default=0))


def cell(value: Value, scale: Scale, comma: bool = False) -> str:
    """Return the value as a table shows it; an exact zero is `0` as in the book, no value is empty.

    >>> cell(-0.0142, Scale(3)), cell(-0.0001, Scale(3)), cell(0.0, Scale(3)), cell(0.5, Scale(3), comma=True)
    ('-0.014', '0.000', '0', '0,500')
    >>> cell(81134.0, Scale(-3))
    '81000'
    """
    if value is None:
        return ""
    if value == 0:
        return "0"
    return decimal(f"{_rounded(_over(value, scale.exponent), scale.decimals):.{max(0, scale.decimals)}f}", comma)


def _over(value: float, exponent: int) -> float:
    if exponent < 0:  # two steps: 10.0 ** 324 is no float
        return value * 10.0 ** (-exponent // 2) * 10.0 ** (-exponent - -exponent // 2)
    return value / 10.0**exponent


def _rounded(value: float, decimals: int) -> float:
    return round(value, decimals) + 0.0  # adding 0.0 turns -0.0 into 0.0


def decimal(text: str, comma: bool) -> str:
    """Return a number with the decimal sign that is wanted."""
    return text.replace(".", ",") if comma else text


def _shortest(value: float, decimals: int) -> str:
    text = f"{_rounded(value, decimals):.{decimals}f}"
    return text.rstrip("0").rstrip(".")


def single(value: float, digits: int | None = None, comma: bool = False) -> tuple[str, int]:
    """Return a single value, and its power of ten.

    >>> single(0.8), single(2.4e7), single(-1.1e-16)
    (('0.8000', 0), ('2.400', 7), ('-1.100', -16))
    """
    if isinstance(value, int):
        return str(value), 0
    scale = scale_of((value,), digits)
    if scale.exponent:
        scale = Scale((digits or DIGITS) - 1, _power(abs(value), digits or DIGITS))
    return cell(value, scale, comma), scale.exponent


def alone(value: float, digits: int, comma: bool = False) -> tuple[str, int]:
    """Return a value among others of quite another size, with so many digits, and its power of ten.

    >>> alone(0.0417, 2), alone(3.2e-16, 2), alone(1464, 2), alone(0, 2)
    (('0.042', 0), ('3.2', -16), ('1464', 0), ('0', 0))
    """
    if not value or isinstance(value, int):
        return str(int(value)), 0
    power = _power(abs(value), digits)
    if -3 < power < 5:
        return decimal(f"{value:.{max(0, digits - 1 - power)}f}", comma), 0
    return decimal(f"{value / 10.0**power:.{digits - 1}f}", comma), power


def angle(value: float, comma: bool = False) -> str:
    """Return an angle in degrees with two decimals at most.

    >>> angle(79.10014), angle(180.0)
    ('79.1', '180')
    """
    return decimal(_shortest(value, 2), comma)


def rounded(value: Value, digits: int | None) -> Value:
    """Return the value to this many significant digits; counts and None, or without `digits` all, as they are.

    >>> rounded(0.1, None), rounded(5, 2), rounded(-0.0, None), rounded(0.12345, 2)
    (0.1, 5, 0.0, 0.12)
    """
    if value is None or isinstance(value, int):
        return value
    return float(value if digits is None else f"{value:.{digits}g}") + 0.0


def whole_if_integral(value: Value) -> Value:
    """Return 10 for 10.0, so that angles and ratios are written as people write them."""
    return int(value) if value is not None and abs(value) < 1e15 and value == int(value) else value
