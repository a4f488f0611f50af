"""Lobatto nodes on a piece, and constant matrices that act on the samples of a polynomial there."""

from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev as series_of
from numpy.polynomial import legendre

from kurbel.arrays import Array


class LobattoRule:
    """Lobatto nodes in [−1, 1], both ends included, and matrices that act on the values of a polynomial there.

    weights (n,): of its integral; series (n, n): turns values into Chebyshev coefficients; tail: its last rows, by
    which a function counts as a polynomial, two of them, of four nodes one; slope: coefficients into the
    coefficients of the derivative, (n − 1, n); area (n, n): values into integrals from −1 to every node; scan_positions
    (m,): where a scan for changes of sign looks; scan, scan_slope (m, n): values into values and slopes there; halving
    (2n, n): into values at the nodes of both halves.
    """

    def __init__(self, count: int) -> None:
        # the ends and the roots of P′ of the last Legendre polynomial P, with the weights 2/(n(n − 1)P²)
        last = np.eye(count)[-1]
        inner = np.sort(legendre.legroots(legendre.legder(last)).real)
        nodes = np.concatenate(([-1.0], inner, [1.0]))
        self.nodes = (nodes - nodes[::-1]) / 2
        self.weights = 2 / (count * (count - 1) * legendre.legval(self.nodes, last) ** 2)

        self.series = np.linalg.inv(chebyshev(self.nodes, count))
        self.tail = self.series[max(3, count - 2) :]
        self.slope = slope_of_series(count)
        self.area = chebyshev(self.nodes, count + 1) @ integral_of_series(count) @ self.series
        of_halves = np.concatenate((self.nodes - 1, self.nodes + 1)) / 2
        self.halving = chebyshev(of_halves, count) @ self.series
        self.scan_positions = np.sin(np.pi / 2 * np.linspace(-1, 1, 2 * count + 1))
        self.scan = chebyshev(self.scan_positions, count) @ self.series
        self.scan_slope = chebyshev(self.scan_positions, count - 1) @ self.slope @ self.series


rule = lru_cache(LobattoRule)
"""The rule of so many nodes; it integrates polynomials of degree 2n − 3 exactly."""


def chebyshev(positions: Array, count: int) -> Array:
    """Return the first Chebyshev polynomials T_0, T_1, … at positions (n,) in [−1, 1], (n, count)."""
    return np.asarray(series_of.chebvander(positions, count - 1), dtype=float)


def series_at(series: Array, positions: Array) -> Array:
    """Return Σ c_k T_k(t) by Clenshaw's recurrence; series (k, …), positions t (…,) in [−1, 1]."""
    b1 = np.zeros_like(positions)
    b2 = np.zeros_like(positions)
    twice = 2 * positions
    for coefficient in series[:0:-1]:
        # c + 2 t b₁ − b₂, written over b₂ without new arrays
        np.subtract(coefficient, b2, out=b2)
        b2 += twice * b1
        b1, b2 = b2, b1
    return series[0] + positions * b1 - b2


@lru_cache
def slope_of_series(count: int) -> Array:
    """Return what turns so many Chebyshev coefficients into those of the derivative."""
    return np.asarray(series_of.chebder(np.eye(count), axis=0), dtype=float)


def integral_of_series(count: int) -> Array:
    """Return what turns so many Chebyshev coefficients into those of the integral from −1 on."""
    return np.asarray(series_of.chebint(np.eye(count), lbnd=-1, axis=0), dtype=float)
