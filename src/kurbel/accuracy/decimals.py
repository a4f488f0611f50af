"""High precision from the standard library: sine and cosine, roots, extremes and integrals in Decimal.

All functions work in the current decimal context; `precise` sets one. Nothing here comes from kurbel's own formulas.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from decimal import Decimal, getcontext, localcontext
from functools import cache

Function = Callable[[Decimal], Decimal]

PRECISION = 40
"""Digits of a reference where nothing cancels by more than twenty of them."""


@contextmanager
def precise(digits: int = PRECISION) -> Iterator[None]:
    """Compute with this many digits within the block."""
    with localcontext() as context:
        context.prec = digits
        yield


def unit() -> Decimal:
    """Return the rounding of the current context: what 1 is uncertain by."""
    return Decimal(1).scaleb(1 - getcontext().prec)


@cache
def _pi(digits: int) -> Decimal:
    """Machin: π = 16 arctan(1/5) − 4 arctan(1/239)."""
    with precise(digits + 5):
        value = 16 * _arctan_of_inverse(5) - 4 * _arctan_of_inverse(239)
    with precise(digits):
        return +value


def _arctan_of_inverse(n: int) -> Decimal:
    term = total = Decimal(1) / n
    k = 1
    while abs(term) > unit() * abs(total):
        term /= -n * n
        k += 2
        total += term / k
    return total


def pi() -> Decimal:
    """Return π to the digits of the current context."""
    return _pi(getcontext().prec)


def sin_cos(degrees: Decimal) -> tuple[Decimal, Decimal]:
    """Return sine and cosine of an angle in degrees, by quarters of a turn and the series beyond them.

    >>> sin_cos(Decimal(30))[0].quantize(Decimal("1e-20"))
    Decimal('0.50000000000000000000')
    """
    with localcontext() as context:
        context.prec += max(6, degrees.adjusted() + 6)
        quarter = (degrees / 90).to_integral_value()
        rest = (degrees - 90 * quarter) * pi() / 180
        sin = _sine(rest)
        cos = (1 - sin * sin).sqrt()  # of no more than 45°: nothing is lost
        turned = ((sin, cos), (cos, -sin), (-sin, -cos), (-cos, sin))[int(quarter) % 4]
    return +turned[0], +turned[1]


def _sine(rest: Decimal) -> Decimal:
    """Return r − r³/3! + … of an angle in radians."""
    square = rest * rest
    term = total = rest
    k = 2
    while term and term.adjusted() > total.adjusted() - getcontext().prec - 2:
        term = -term * square / (k * (k + 1))
        k += 2
        total += term
    return total


def root(function: Function, low: Decimal, high: Decimal) -> Decimal:
    """Return the root between low < high, where the function differs in sign: false position, Illinois, halvings."""
    f_low, f_high = function(low), function(high)
    if not f_low or not f_high:
        return high if f_low else low
    narrow = 4 * unit() * max(abs(low), abs(high))
    kept = 0
    for step in range(600):
        # every third step halves, so that a bent function cannot hold it up
        middle = (low + high) / 2 if step % 3 == 2 else (low * f_high - high * f_low) / (f_high - f_low)
        if high - low <= narrow or not low < middle < high:
            break
        value = function(middle)
        if (value > 0) == (f_high > 0):
            high, f_high, f_low, kept = middle, value, f_low / 2 if kept > 0 else f_low, 1
        else:
            low, f_low, f_high, kept = middle, value, f_high / 2 if kept < 0 else f_high, -1
    return low if abs(function(low)) < abs(function(high)) else high


def arcsin(sin: Decimal) -> Decimal:
    """Return the angle in degrees, from −90 to 90."""
    return root(lambda degrees: sin_cos(degrees)[0] - sin, Decimal(-90), Decimal(90))


_GOLD = Decimal("0.6180339887498948482045868343656381177203")


def largest(function: Function, low: Decimal, high: Decimal) -> Decimal:
    """Return the largest value of a function with one hill between low and high, by golden sections.

    The place is found to half the digits, which suffices for the value.
    """
    inner, outer = high - _GOLD * (high - low), low + _GOLD * (high - low)
    f_inner, f_outer = function(inner), function(outer)
    narrow = unit().sqrt() * max(abs(low), abs(high), Decimal(1)) / 100
    while high - low > narrow:
        if f_inner > f_outer:
            high, outer, f_outer = outer, inner, f_inner
            inner = high - _GOLD * (high - low)
            f_inner = function(inner)
        else:
            low, inner, f_inner = inner, outer, f_outer
            outer = low + _GOLD * (high - low)
            f_outer = function(outer)
    return max(f_inner, f_outer, function(low), function(high))


@cache
def _gauss(points: int, digits: int) -> tuple[tuple[Decimal, Decimal], ...]:
    """Nodes and weights of Gauss-Legendre on (−1, 1), by Newton on the Legendre polynomial."""
    import math

    with precise(digits):
        rule = []
        for k in range(points):
            node = Decimal(math.cos(math.pi * (k + 0.75) / (points + 0.5)))
            for _ in range(8):
                value, slope = legendre(points, node)
                node -= value / slope
            _, slope = legendre(points, node)
            rule.append((node, 2 / ((1 - node * node) * slope * slope)))
        return tuple(rule)


def legendre(degree: int, z: Decimal) -> tuple[Decimal, Decimal]:
    """Return the Legendre polynomial of this degree and its slope at z inside (−1, 1)."""
    before, value = Decimal(1), z
    for n in range(2, degree + 1):
        before, value = value, ((2 * n - 1) * z * value - (n - 1) * before) / n
    return value, degree * (z * value - before) / (z * z - 1)


_POINTS = 20


def _panel(function: Function, low: Decimal, high: Decimal) -> tuple[Decimal, Decimal]:
    """Return the integrals of the function and of its absolute value."""
    half, middle = (high - low) / 2, (high + low) / 2
    terms = [w * function(middle + half * z) for z, w in _gauss(_POINTS, getcontext().prec)]
    return half * sum(terms, Decimal(0)), half * sum(map(abs, terms), Decimal(0))


_AGREEMENT = Decimal("1e-22")


def integral(function: Function, low: Decimal, high: Decimal) -> Decimal:
    """Return ∫ function from low to high: 20-point Gauss, halved until whole and halves agree to 22 digits.

    low ≤ high; the function must be smooth between.
    """
    whole, size = _panel(function, low, high)
    return _halved(function, low, high, whole, _AGREEMENT * size, 0)


def _halved(function: Function, low: Decimal, high: Decimal, whole: Decimal, error: Decimal, depth: int) -> Decimal:
    middle = (low + high) / 2
    first, second = _panel(function, low, middle)[0], _panel(function, middle, high)[0]
    if abs(first + second - whole) <= error or depth > 60:
        return first + second
    return _halved(function, low, middle, first, error, depth + 1) + _halved(
        function, middle, high, second, error, depth + 1
    )
