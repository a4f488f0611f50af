"""Radau collocation on a piece: nodes, and the constant matrices of the polynomial through its start and its nodes.

Radau IIA is L-stable: what relaxes within a hair of a turn is damped out, where Lobatto or Gauss nodes would ring.
"""

from functools import lru_cache

import numpy as np

from kurbel.arrays import Array
from kurbel.numerics.lobatto import chebyshev, integral_of_series


class Radau:
    """k nodes in (−1, 1], the last at 1, and matrices.

    area (k, k): values at the nodes into integrals from −1 to every node; series (k + 1, k + 1): values at the start
    and the nodes into Chebyshev coefficients; halves (2, k + 1, k + 1): values at the start and the nodes into those of
    the first and of the second half of the piece.
    """

    def __init__(self, count: int) -> None:
        # Golub: the Jacobi matrix of the Legendre polynomials, whose last entry puts an eigenvalue at 1
        n = np.arange(1, count)
        off = n / np.sqrt(4.0 * n * n - 1)
        jacobi = np.diag(off, 1) + np.diag(off, -1)
        jacobi[-1, -1] = count / (2 * count - 1)
        self.nodes = np.append(np.linalg.eigvalsh(jacobi)[:-1], 1.0)
        values = chebyshev(self.nodes, count + 1)
        self.area = values @ integral_of_series(count) @ np.linalg.inv(values[:, :count])
        every = np.append(-1.0, self.nodes)
        self.series = np.linalg.inv(chebyshev(every, count + 1))
        self.halves = np.stack([chebyshev((every + side) / 2, count + 1) @ self.series for side in (-1, 1)])

    def at(self, places: Array) -> Array:
        """Return the matrix (n, k + 1) of values at the start and the nodes into values at places (n,) in [−1, 1]."""
        return np.asarray(chebyshev(places, len(self.nodes) + 1) @ self.series)


radau = lru_cache(Radau)
"""The rule of so many nodes."""
