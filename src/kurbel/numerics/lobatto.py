"""Lobatto nodes on a piece, and constant matrices that act on the samples of a polynomial there."""

from functools import lru_cache

import numpy as np

from kurbel.arrays import Array


class Rule:
    """Lobatto nodes in [−1, 1], both ends included, and matrices that act on the values of a polynomial there.

    weights (n,): of its integral; series (n, n): turns values into Chebyshev coefficients; slope: those into the
    coefficients of the derivative, (n − 1, n); area (n, n): values into integrals from −1 to every node; places (m,):
    where a scan for changes of sign looks; scan, scan_slope (m, n): values into values and slopes there; halving (2n,
    n): into values at the nodes of both halves.
    """

    def __init__(self, count: int) -> None:
        self.nodes, self.weights = _nodes_and_weights(count)
        self.series = np.linalg.inv(chebyshev(self.nodes, count))
        self.slope = slope_of_series(count)
        self.area = chebyshev(self.nodes, count + 1) @ integral_of_series(count) @ self.series
        self.halving = chebyshev(np.concatenate((self.nodes - 1, self.nodes + 1)) / 2, count) @ self.series
        self.places = np.sin(np.pi / 2 * np.linspace(-1, 1, 2 * count + 1))
        self.scan = chebyshev(self.places, count) @ self.series
        self.scan_slope = chebyshev(self.places, count - 1) @ self.slope @ self.series


rule = lru_cache(Rule)
"""The rule of so many nodes; it integrates polynomials of degree 2n − 3 exactly."""


def chebyshev(places: Array, count: int) -> Array:
    """Return the first Chebyshev polynomials T_0, T_1, … at places (n,) in [−1, 1], (n, count)."""
    columns = [np.ones_like(places), places]
    for _ in range(count - 2):
        columns.append(2 * places * columns[-1] - columns[-2])
    return np.stack(columns[:count], axis=-1)


def series_at(series: Array, places: Array) -> Array:
    """Return Σ c_k T_k(t) by Clenshaw's recurrence; series (k, …), places (…,)."""
    ahead, last, twice = np.zeros_like(places), np.zeros_like(places), 2 * places
    for coefficient in series[:0:-1]:  # c + 2 t b₁ − b₂, without new arrays
        np.subtract(coefficient, last, out=last)
        last += twice * ahead
        ahead, last = last, ahead
    return np.asarray(series[0] + places * ahead - last)


def _nodes_and_weights(count: int) -> tuple[Array, Array]:
    """Return the ends and the roots of P′ of the last Legendre polynomial P, and the weights 2/(n(n − 1)P²)."""
    nodes = -np.cos(np.pi * np.arange(count) / (count - 1))
    for _ in range(60):
        before, last = np.ones(count), nodes.copy()
        for k in range(2, count):
            before, last = last, ((2 * k - 1) * nodes * last - (k - 1) * before) / k
        nodes = nodes - (nodes * last - before) / (count * last)
    return (nodes - nodes[::-1]) / 2, 2 / (count * (count - 1) * last**2)


@lru_cache
def slope_of_series(count: int) -> Array:
    """Return what turns Chebyshev coefficients into those of the derivative: T_k′ = 2k (T_{k−1} + T_{k−3} + …)."""
    matrix = np.zeros((count - 1, count))
    for k in range(1, count):
        matrix[k - 1 :: -2, k] = 2 * k
    matrix[0] /= 2
    return matrix


def integral_of_series(count: int) -> Array:
    """Return what turns Chebyshev coefficients into those of the integral from −1 on."""
    matrix = np.zeros((count + 1, count))
    for k in range(count):
        matrix[k + 1, k] += 1 / (2 * (k + 1)) if k else 1.0
        if k > 1:
            matrix[k - 1, k] -= 1 / (2 * (k - 1))
    matrix[0] -= chebyshev(np.array([-1.0]), count + 1)[0] @ matrix
    return matrix
