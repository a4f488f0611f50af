"""A quantity given at the points of a grid, as a polynomial on every piece: its values, slopes and integrals."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kurbel.numerics.arithmetic import running_sums
from kurbel.numerics.grid import Grid
from kurbel.numerics.jet import Jet
from kurbel.numerics.legendre import legendre, legendre_slopes

if TYPE_CHECKING:
    from kurbel.arrays import Array, Indices


class Piecewise:
    """The polynomials through the values (pieces, nodes) of a quantity at the weighted points of a grid.

    Up to the end of a piece their integral is the rule itself.
    """

    def __init__(self, grid: Grid, values: Array) -> None:
        self._grid = grid
        used = grid.weights != 0
        self._degree = int(used.sum()) - 1
        order = np.arange(self._degree + 1)
        squares = 2 / (2 * order + 1)
        if grid.weights[0]:
            squares[-1] = 2 / order[-1]  # the rule of Lobatto: P_{N−1}² summed over its points
        at_nodes = legendre(grid.nodes[used], self._degree) * grid.weights[used][:, None]
        self._coefficients = values[:, used] @ (at_nodes / squares)

    def _place(self, degrees: Array, within: Array) -> tuple[Indices, Array]:
        """Return the pieces that hold `within`, and where the angles lie in them, on −1 … 1."""
        breaks = self._grid.breaks
        piece = np.clip(np.searchsorted(breaks, within, side="right") - 1, 0, len(breaks) - 2)
        low, high = breaks[piece], breaks[piece + 1]
        return piece, 2 * (degrees - low) / (high - low) - 1

    def at(self, degrees: Array, within: Array) -> Jet:
        """Return values with slopes at angles (…,) in degrees within the cycle, on the sides that hold `within`."""
        piece, x = self._place(degrees, within)
        coefficients = self._coefficients[piece]
        value, slope = ((p(x, self._degree) * coefficients).sum(axis=-1) for p in (legendre, legendre_slopes))
        return Jet(value, slope / self._grid.half_widths[piece])

    @cached_property
    def _up_to(self) -> Array:
        """The integral up to the start of each piece, and over the whole cycle at the end."""
        wholes = 2 * self._coefficients[:, 0] * self._grid.half_widths
        return np.array([0.0, *running_sums(wholes.tolist())])

    def integral_to(self, degrees: Array) -> Array:
        """Return the integral over φ in radians from the start of the cycle to angles (…,) in degrees within it."""
        piece, x = self._place(degrees, degrees)
        p = legendre(x, self._degree + 1)
        # ∫ P_n from −1 to x is (P_{n+1} − P_{n−1})/(2n + 1), with P_{−1} = −1
        below = np.concatenate((-np.ones_like(p[..., :1]), p[..., :-2]), axis=-1)
        integrals = (p[..., 1:] - below) / (2 * np.arange(self._degree + 1) + 1)
        part = (self._coefficients[piece] * integrals).sum(axis=-1)
        return np.asarray(self._up_to[piece] + self._grid.half_widths[piece] * part)
