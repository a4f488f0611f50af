"""Bracketed roots of many functions at once: Newton's method, and bisection where its step leaves the bracket."""

from collections.abc import Callable

import numpy as np

from kurbel.arrays import Array


def bracketed_roots(
    function: Callable[[Array], tuple[Array, Array]], low: Array, high: Array, first: Array, last: Array
) -> Array:
    """Return one root in each bracket (n,), to the rounding of the function or of the argument.

    function: maps all arguments (n,) at once to values and slopes (n,); first, last: its values at the ends, of which
    the signs differ, or one is zero.
    """
    rising = first < last
    places = low + (high - low) * (np.abs(first) / np.maximum(np.abs(first) + np.abs(last), 1e-300))
    size = 4e-16 * np.maximum(np.maximum(np.abs(low), np.abs(high)), 1.0)
    for _ in range(60):
        value, slope = function(places)
        below = (value < 0) == rising
        low, high = np.where(below, places, low), np.where(below, high, places)
        with np.errstate(all="ignore"):
            step = places - value / slope
        new = np.where((step >= low - 1e-10) & (step <= high + 1e-10), np.clip(step, low, high), (low + high) / 2)
        moved, places = np.abs(new - places), new
        if not (moved > size).any():
            break
    return places
