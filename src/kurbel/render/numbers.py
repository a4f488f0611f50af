"""How numbers look: as many digits as an engineer reads, the same number of decimals along a row, no negative zero."""

import math
import re
from collections.abc import Iterable
from decimal import Decimal
from typing import NamedTuple

from kurbel.report.tables import Value

DIGITS = 4
"""Significant digits of the largest value of a row by default."""

_LARGE = 7  # from 1e7 on, and below 1e-4, a row gets its power of ten into the head
_SMALL = -4
_LONG = re.compile(r"(?<![\w.,^-])-?[1-9]\d{4,}(?=[.,]\d|[.,;]?(?:\s|$)|\))")


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
    largest = max((abs(value) for value in values if value is not None), default=0.0)
    if largest == 0:
        return Scale(0)
    power = _power(largest, digits or DIGITS)
    exponent = 0 if _SMALL <= power < _LARGE else 3 * math.floor(power / 3)
    decimals = (digits or DIGITS) - 1 - power + exponent
    return Scale(decimals if digits else max(0, decimals), exponent)


def angle_scale(values: Iterable[Value]) -> Scale:
    """Return the fewest decimals that distinguish all these angles, at most six."""
    texts = (angle(value, decimals=6) for value in values if value is not None)
    return Scale(max((len(text.partition(".")[2]) for text in texts), default=0))


def _power(value: float, digits: int) -> int:
    """Return the power of ten of the value as rounded: 3 for 999.96 at four digits."""
    return int(f"{abs(value):.{digits - 1}e}".partition("e")[2])


def cell(value: Value, scale: Scale) -> str:
    """Return the value as a table shows it; an exact zero is `0` as in the book, no value is empty.

    >>> cell(-0.0142, Scale(3)), cell(-0.0001, Scale(3)), cell(0.0, Scale(3)), cell(81134.0, Scale(-3))
    ('-0.014', '0.000', '0', '81000')
    """
    if not value:
        return "" if value is None else "0"
    if scale.exponent:
        value = float(Decimal(value).scaleb(-scale.exponent))
    # adding 0.0 turns -0.0 into 0.0
    return f"{round(value, scale.decimals) + 0.0:.{max(0, scale.decimals)}f}"


def in_thousands(text: str) -> str:
    """Return a text in which numbers from 10,000 on have thin spaces.

    >>> in_thousands("J = 18066.25, -1234567; 1234, 0.123456, run-10000.csv").replace("\N{NARROW NO-BREAK SPACE}", "_")
    'J = 18_066.25, -1_234_567; 1234, 0.123456, run-10000.csv'
    """
    return _LONG.sub(lambda found: f"{int(found[0]):_}".replace("_", "\N{NARROW NO-BREAK SPACE}"), text)


def single(value: float, digits: int | None = None, own: int = 0) -> tuple[str, int]:
    """Return a single value, and its power of ten.

    own: digits of a value among others of quite another size, which has a power of ten sooner.

    >>> single(0.8), single(2.4e7), single(-1.1e-16)
    (('0.8000', 0), ('2.400', 7), ('-1.100', -16))
    >>> single(0.0417, own=2), single(3.2e-16, own=2), single(1464, own=2), single(0, own=2)
    (('0.042', 0), ('3.2', -16), ('1464', 0), ('0', 0))
    """
    if not value or isinstance(value, int):
        return str(int(value)), 0
    count = digits or own or DIGITS
    power = _power(value, count)
    small, large = (-2, 5) if own else (_SMALL, _LARGE)
    exponent = 0 if small <= power < large else power
    decimals = count - 1 - power + exponent
    return cell(value, Scale(decimals if digits and not own else max(0, decimals), exponent)), exponent


def angle(value: float, decimals: int = 2) -> str:
    """Return an angle in degrees with so many decimals at most.

    >>> angle(79.10014), angle(180.0)
    ('79.1', '180')
    """
    text = f"{round(value, decimals) + 0.0:.{decimals}f}"
    return text.rstrip("0").rstrip(".")


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
