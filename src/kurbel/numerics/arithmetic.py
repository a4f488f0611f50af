"""The few operations besides + − × ÷ that formulas need, for floats, arrays and high-precision numbers."""

import math
from typing import Any

import numpy as np

from kurbel.arrays import Indices, N, Number, Truth


def is_number(value: object) -> bool:
    """Return whether a value is a float, or a number that brings its own operations."""
    return isinstance(value, (float, int)) or hasattr(value, "sqrt")


def sqrt(value: N) -> N:
    """Return the square root of a float, an array, or any number with its own `sqrt` (as those of mpmath)."""
    if isinstance(value, (float, int)):
        return math.sqrt(value)
    if hasattr(value, "sqrt"):
        return value.sqrt()
    return np.sqrt(value)


def where(condition: Truth, value: N, otherwise: N) -> N:
    """Return `value` where the condition holds and `otherwise` elsewhere; shapes as for numpy.where."""
    if not getattr(condition, "ndim", 0):
        return value if condition else otherwise
    return np.where(condition, value, otherwise)  # type: ignore[return-value]


def bearing(sin: N, cos: N) -> N:
    """Return the direction of (cos, sin) in degrees, from −180 to 180, of floats or arrays.

    >>> bearing(1.0, 0.0)
    90.0
    """
    if isinstance(sin, (float, int)) and isinstance(cos, (float, int)):
        return math.degrees(math.atan2(sin, cos))
    return np.degrees(np.arctan2(sin, cos))


def ulp(value: N) -> N:
    """Return the unit in the last place of a positive float or array."""
    if isinstance(value, (float, int)):
        return math.ulp(value)
    return np.spacing(value)


def magnitude(value: N) -> N:
    """Return the magnitude of a number, of the same kind."""
    return abs(value)  # type: ignore[return-value]


def every(condition: Truth) -> bool:
    """Return whether a condition holds: of an array, everywhere."""
    if isinstance(condition, bool):
        return condition
    return bool(condition.all())


def some(condition: Truth) -> bool:
    """Return whether a condition holds: of an array, anywhere."""
    if isinstance(condition, bool):
        return condition
    return bool(condition.any())


def is_whole(value: Number) -> Truth:
    """Return whether a float, or each of an array, is a whole number but for rounding."""
    return magnitude((value + 0.5) % 1 - 0.5) < 1e-9


def total(*terms: N) -> N:
    """Return the sum of floats, rounded once; with arrays among them, as good as that (Ogita, Rump, Oishi 2005).

    >>> total(1e16, 1.0, -1e16)
    1.0
    """
    if all(isinstance(term, (float, int)) for term in terms):
        return math.fsum(terms)  # type: ignore[return-value]
    result = terms[0]
    missed = terms[0] * 0
    for term in terms[1:]:
        before = result
        result = before + term
        missed = missed + lost(before, term, result)
    return result + missed


def lost(before: N, term: N, result: N) -> N:
    """Return by what a sum misses its two terms as it is rounded, exactly (Knuth)."""
    of_term = result - before
    return (before - (result - of_term)) + (term - of_term)


_ROUNDING = 16 * 2.0**-52
"""Relative to the sum of the sizes of terms: a smaller sum of them is rounding."""


def unless_cancelled(result: Any, sizes: Number, rounding: float = _ROUNDING) -> Any:
    """Return a sum, as an array; exactly 0 where nothing is left of its terms but rounding.

    sizes: the sum of the sizes of the terms; of complex terms either part may cancel by itself. rounding: relative to
    that, what may be left.

    >>> unless_cancelled(0.1 + 0.2 - 0.3, 0.6), unless_cancelled(0.1, 0.6)
    (array(0.), array(0.1))
    """
    if np.iscomplexobj(result):
        real = unless_cancelled(result.real, sizes, rounding)
        imaginary = unless_cancelled(result.imag, sizes, rounding)
        return real + 1j * imaginary
    return np.where(np.abs(result) > rounding * sizes, result, 0.0)


def spread(number: Any, machine: Indices | None) -> Any:
    """Return the numbers (machines,) of the machines in an index; a single number is returned as it is."""
    is_of_machines = isinstance(number, np.ndarray) and number.ndim > 0
    if is_of_machines and machine is not None:
        return number[machine]
    return number
