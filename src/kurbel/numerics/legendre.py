"""Legendre polynomials on −1 … 1, by their recurrence."""

import numpy as np

from kurbel.arrays import Array


def legendre(x: Array, degree: int) -> Array:
    """Return P_0 … P_degree at x (…,) as (…, degree + 1)."""
    p = [np.ones_like(x), x]
    for n in range(1, degree):
        p.append(((2 * n + 1) * x * p[n] - n * p[n - 1]) / (n + 1))
    return np.stack(p[: degree + 1], axis=-1)


def legendre_slopes(x: Array, degree: int) -> Array:
    """Return their derivatives at x (…,) as (…, degree + 1)."""
    p = legendre(x, degree)
    slopes = [np.zeros_like(x), np.ones_like(x)]
    for n in range(1, degree):
        slopes.append(slopes[n - 1] + (2 * n + 1) * p[..., n])
    return np.stack(slopes[: degree + 1], axis=-1)
