"""Bracketed roots of many functions at once, after Chandrupatla (1997): inverse quadratic steps, safe as bisection."""

from collections.abc import Callable

import numpy as np

from kurbel.arrays import Array


def bracketed_roots(function: Callable[[Array], Array], low: Array, high: Array, f_low: Array, f_high: Array) -> Array:
    """Return one root in each bracket (n,), to about two units in the last place of the argument.

    function: maps all arguments (n,) at once to values (n,); f_low and f_high differ in sign (or one is zero).
    """
    a, b, fa, fb = high.copy(), low.copy(), f_high.copy(), f_low.copy()
    c, fc = a, fa
    best = np.where(np.abs(fa) < np.abs(fb), a, b)
    part = np.full_like(a, 0.5)
    for _ in range(100):
        tolerance = 2 * np.finfo(float).eps * np.maximum(np.abs(best), 1e-3)
        width = np.abs(b - a)
        if ((width <= 2 * tolerance) | (fa == 0) | (fb == 0)).all():
            break
        middle = a + np.clip(part, tolerance / np.maximum(width, 1e-300), 1 - tolerance / np.maximum(width, 1e-300)) * (
            b - a
        )
        f_middle = function(middle)
        same = np.sign(f_middle) == np.sign(fa)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        b, fb = np.where(same, b, a), np.where(same, fb, fa)
        a, fa = middle, f_middle
        best = np.where(np.abs(fa) < np.abs(fb), a, b)
        part = _next_part(a, b, c, fa, fb, fc)
    return np.asarray(np.where(np.abs(fa) < np.abs(fb), a, b))


def _next_part(a: Array, b: Array, c: Array, fa: Array, fb: Array, fc: Array) -> Array:
    """Return how far from a toward b to step: inverse quadratic where the three points allow it, else one half."""
    with np.errstate(all="ignore"):
        xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
        quadratic = (phi**2 < xi) & ((1 - phi) ** 2 < 1 - xi)
        step = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
    return np.where(quadratic & np.isfinite(step), np.clip(step, 0.0, 1.0), 0.5)
