"""A quantity given at the points of a grid, as a polynomial on every piece: its values, slopes and integrals."""

from functools import cached_property

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.numerics.arithmetic import lost
from kurbel.numerics.grid import Grid
from kurbel.numerics.jet import Jet


class Piecewise:
    """The polynomials Σ c_k T_k through the values (pieces, nodes) of a quantity at the weighted points of a grid.

    Chebyshev's T_k are cosines: all of them take one call.
    """

    def __init__(self, grid: Grid, values: Array) -> None:
        self._grid = grid
        used = grid.weights != 0
        self._wholes = grid.integrals(values)
        at_nodes = _chebyshev(grid.nodes[used], int(used.sum()))
        self._coefficients = values[:, used] @ np.linalg.inv(at_nodes).T

    def _place(self, degrees: Array, within: Array) -> tuple[Indices, Array]:
        """Return the pieces that hold `within`, and where the angles lie in them, on −1 … 1."""
        piece = self._grid.piece_at(within, None)
        low, high = self._grid.low[piece], self._grid.high[piece]
        return piece, np.clip(2 * (degrees - low) / (high - low) - 1, -1.0, 1.0)

    def at(self, degrees: Array, within: Array) -> Jet:
        """Return values with slopes at angles (…,) in degrees within the cycle, on the sides that hold `within`."""
        piece, x = self._place(degrees, within)
        t = _chebyshev(x, self._coefficients.shape[1])
        slope = (t[..., :-1] * self._slopes[piece]).sum(axis=-1) / self._grid.half_widths[piece]
        return Jet((t * self._coefficients[piece]).sum(axis=-1), slope)

    @cached_property
    def _slopes(self) -> Array:
        """Coefficients of the derivatives: c′_{k−1} = c′_{k+1} + 2k c_k, the first one halved."""
        count = self._coefficients.shape[1]
        k = np.arange(count)
        matrix = np.where((k > k[:, None]) & ((k - k[:, None]) % 2 == 1), 2.0 * k, 0.0)[:-1]
        matrix[0] /= 2
        return np.asarray(self._coefficients @ matrix.T)

    @cached_property
    def _integrals(self) -> Array:
        """Coefficients of ∫ = Σ C_k (T_k − T_k(−1)), k > 0: C_k = (c_{k−1} − c_{k+1})/2k, the first c doubled."""
        c = np.pad(self._coefficients, ((0, 0), (0, 2)))
        c[:, 0] *= 2
        return np.asarray((c[:, :-2] - c[:, 2:]) / (2 * np.arange(1, c.shape[1] - 1)))

    @cached_property
    def _up_to(self) -> Array:
        """The integral up to the start of each piece and to the end, each as good as rounded once."""
        sums = np.append(0.0, self._wholes.cumsum())
        return np.append(0.0, sums[1:] + lost(sums[:-1], self._wholes, sums[1:]).cumsum())

    def integral_to(self, degrees: Array) -> Array:
        """Return the integral over φ in radians from the start of the cycle to angles (…,) in degrees within it."""
        piece, x = self._place(degrees, degrees)
        count = self._integrals.shape[1] + 1
        gained = (_chebyshev(x, count) - _chebyshev(np.array(-1.0), count))[..., 1:]
        part = (self._integrals[piece] * gained).sum(axis=-1)
        return np.asarray(self._up_to[piece] + self._grid.half_widths[piece] * part)


def _chebyshev(x: Array, count: int) -> Array:
    """Return T_0 … at x (…,) on −1 … 1 as (…, count)."""
    return np.asarray(np.cos(np.arccos(x)[..., None] * np.arange(count)))
