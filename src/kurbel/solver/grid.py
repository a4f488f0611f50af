"""A cycle cut into smooth pieces: samples for searches, Gauss points for integrals, each on its side of every jump."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kurbel.mechanisms import Extreme
from kurbel.solver.gauss import NODES, WEIGHTS
from kurbel.solver.roots import bracketed_roots

Array = NDArray[np.float64]
_NODES = np.array([-1.0, *NODES, 1.0])


class Sampled(NamedTuple):
    """Values and slopes of one quantity on a grid, each (pieces, nodes)."""

    value: Array
    slope: Array


class Grid:
    """Smooth pieces between the angles `breaks` (n + 1,) in degrees, each with 16 Gauss points and both its ends.

    degrees, within: crank angles of the nodes and the middles of their pieces, (pieces, nodes). beyond: what the
    rounding of `degrees` took from the nodes; with R/L near 1 the rod swings round within a hair of 90°, and it counts.
    """

    def __init__(self, breaks: Array) -> None:
        self.breaks = breaks
        low, high = breaks[:-1, None], breaks[1:, None]
        self.within = np.broadcast_to((low + high) / 2, (len(breaks) - 1, len(_NODES)))
        right_angle = 90.0 * np.rint(self.within / 90.0)
        offset = ((low - right_angle) + (high - right_angle)) / 2 + (high - low) / 2 * _NODES
        self.degrees = right_angle + offset
        self.degrees[:, 0], self.degrees[:, -1] = breaks[:-1], breaks[1:]
        self.beyond = offset - (self.degrees - right_angle)
        self.beyond[:, 0] = self.beyond[:, -1] = 0.0

    @cached_property
    def _half_widths(self) -> Array:
        return np.asarray(np.radians(np.diff(self.breaks)) / 2)

    def integral(self, value: Array) -> float:
        """Return ∫ value dφ (φ in radians) over all pieces by the 16-point Gauss rule; value (pieces, nodes)."""
        return float(self._half_widths @ (value[:, 1:-1] @ WEIGHTS))

    def split_at(self, angles: Array) -> Grid:
        """Return the grid cut at further angles in degrees."""
        return Grid(ascending(np.concatenate((self.breaks, angles)))) if len(angles) else self


class Brackets(NamedTuple):
    """Intervals that hold one root each: ends in degrees, piece middles, function values at the ends; all (n,)."""

    low: Array
    high: Array
    within: Array
    f_low: Array
    f_high: Array


def sign_changes(grid: Grid, values: Array, worth: Any = True) -> Brackets:
    """Return the node intervals over which values (pieces, nodes) change sign, where `worth` holds."""
    before, after = values[:, :-1], values[:, 1:]
    # a zero at a node counts for the interval that it ends, so that it is found once
    rows, nodes = np.nonzero((((before < 0) & (after >= 0)) | ((before > 0) & (after <= 0))) & worth)
    return Brackets(
        grid.degrees[rows, nodes],
        grid.degrees[rows, nodes + 1],
        grid.within[rows, nodes],
        values[rows, nodes],
        values[rows, nodes + 1],
    )


def roots(function: Callable[[Array, Array], Array], brackets: Brackets) -> Array:
    """Return the roots in degrees of function(degrees, within) in the brackets (n,)."""
    if not len(brackets.low):
        return brackets.low
    low, high, within, f_low, f_high = brackets
    return bracketed_roots(lambda degrees: function(degrees, within), low, high, f_low, f_high)


class Extremes(NamedTuple):
    """Largest and smallest value of one quantity over the cycle, with their crank angles."""

    largest: Extreme
    smallest: Extreme


def extremes(
    grid: Grid, samples: dict[str, Sampled], evaluate: Callable[[Array, Array], dict[str, Sampled]]
) -> dict[str, Extremes]:
    """Return the exact extremes of several quantities over the grid, one-sided values at its breaks included.

    samples: the quantities on the grid; evaluate: the same at any (degrees, within), each (n,). Interior extremes are
    roots of the slope; only those intervals are searched whose cubic through both ends promises to beat the samples.
    """
    brackets = {name: sign_changes(grid, sampled.slope, _promising(grid, sampled)) for name, sampled in samples.items()}
    counts = [len(bracket.low) for bracket in brackets.values()]
    owner = np.repeat(np.arange(len(samples)), counts)
    stacked = Brackets(*(np.concatenate(parts) for parts in zip(*brackets.values(), strict=True)))

    def slope(degrees: Array, within: Array) -> Array:
        return np.stack([sampled.slope for sampled in evaluate(degrees, within).values()])[owner, np.arange(len(owner))]

    found = roots(slope, stacked)
    values = {name: s.value for name, s in evaluate(found, stacked.within).items()} if len(found) else {}
    return {
        name: _pick(
            np.concatenate((grid.degrees.ravel(), found[owner == k])),
            np.concatenate((sampled.value.ravel(), values[name][owner == k] if values else found)),
        )
        for k, (name, sampled) in enumerate(samples.items())
    }


def _promising(grid: Grid, sampled: Sampled) -> NDArray[np.bool_]:
    """Return the intervals (pieces, nodes − 1) whose ends could hide an extreme of the whole cycle between them."""
    value, slope = sampled
    width = np.radians(np.diff(grid.degrees, axis=1))
    # between two nodes a smooth function leaves its chord by no more than about the slopes times a quarter of the width
    reach = np.maximum(np.abs(slope[:, :-1]), np.abs(slope[:, 1:])) * width / 2
    top = np.maximum(value[:, :-1], value[:, 1:]) + reach
    bottom = np.minimum(value[:, :-1], value[:, 1:]) - reach
    return np.asarray((top >= value.max()) | (bottom <= value.min()))


def _pick(degrees: Array, values: Array) -> Extremes:
    return Extremes(_first_at(degrees, values, 1.0), _first_at(degrees, values, -1.0))


def _first_at(degrees: Array, values: Array, sign: float) -> Extreme:
    """Return the extreme and the first angle that reaches it but for rounding: plateaus answer alike everywhere."""
    best = (values * sign).max()
    level = best - 4 * np.finfo(float).eps * abs(best)
    return Extreme(float(best * sign) + 0.0, float(degrees[values * sign >= level].min()))


def distinct_angles(found: Array, cycle: float) -> tuple[float, ...]:
    """Return angles in degrees within the cycle, ascending, each once."""
    return tuple(ascending(np.mod(found, cycle), apart=1e-9).tolist())


def ascending(angles: Array, apart: float = 0.0) -> Array:
    """Return the angles (n,) in degrees sorted, without those that are no more than `apart` beyond the one before.

    (numpy.unique would do for apart = 0, but imports numpy.ma, a fifth of the whole start-up.)
    """
    angles = np.sort(angles)
    return angles[np.concatenate(([True], np.diff(angles) > apart))] if len(angles) else angles
