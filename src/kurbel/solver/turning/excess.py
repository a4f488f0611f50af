"""Excess work: where the effort crosses the resistance, every lobe between, and the largest swing ΔE over all.

One sampling of both torques on the grid of their common pieces serves the mean, the extremes, the crossings and E.
"""

import math
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.numerics.arithmetic import unless_cancelled
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Grid
from kurbel.numerics.jet import Jet
from kurbel.numerics.piecewise import Piecewise
from kurbel.numerics.search import Extremes, Sampled, extremes, zeros
from kurbel.solver.turning.torques import Sum, Torque, Uniform

_ROUNDING = 1e-13
"""Beside the largest torque: a mean that is less is none, as that of masses without gas, but rounding."""
_BALANCED = 1e-9
"""Means of effort and resistance that differ by less, relatively, are equal."""


class Excess:
    """The excess of a turning effort over a resistance, over a common cycle.

    E(φ) = ∫ (M − M_load) dφ from φ = 0 is stationary at the crossings, so that an error of their place does not show.

    effort, given: the torques, in N m; without a given resistance it is the mean of the effort all the time, and one of
    another mean is brought to that of the effort.
    """

    def __init__(self, effort: Torque, given: Torque | None = None) -> None:
        self.effort = effort
        self.grid = (effort.cuts if given is None else Sum((1.0, effort), (1.0, given)).cuts).grid()
        self.cycle = float(self.grid.breaks[-1])
        self._sampled_effort = self._on_grid(effort)
        self.mean = self._mean_of(self._sampled_effort)
        self.deficit = self.mean if given is None else self.mean - self._mean_of(self._on_grid(given))
        if given is not None and abs(self.deficit) <= _BALANCED * max(abs(self.mean - self.deficit), abs(self.mean)):
            self.deficit = 0.0
        self.load = Sum((1.0, given or Uniform(0.0, self.cycle)), (1.0, Uniform(self.deficit, self.cycle)))
        self.torque = Sum((1.0, effort), (-1.0, self.load))

    def _on_grid(self, torque: Torque) -> Jet:
        return torque.torque(self.grid.degrees, self.grid.within)

    def _mean_of(self, sampled: Jet) -> float:
        mean = self.grid.integral(sampled.value) / math.radians(self.cycle)
        return mean if abs(mean) > _ROUNDING * float(np.abs(sampled.value).max()) else 0.0

    @cached_property
    def _sampled(self) -> Jet:
        return self._sampled_effort - self._on_grid(self.load)

    @cached_property
    def line(self) -> Piecewise:
        """The excess in N m as polynomials on the pieces of the grid."""
        return Piecewise(self.grid, self._sampled.value)

    @cached_property
    def effort_extremes(self) -> Extremes:
        """Largest and smallest turning effort in N m, one-sided values at jumps included."""
        return torque_extremes(Sum((1.0, self.effort)), self.grid, self._sampled_effort)

    @cached_property
    def crossings(self) -> tuple[float, ...]:
        """Crank angles in degrees, ascending, at which the effort crosses the resistance, by a jump or through zero.

        They are those of the polynomials whose integral E is.
        """
        # an effort that equals the resistance over a while differs from it by rounding only
        size = max(abs(extreme.value) for extreme in self.effort_extremes)
        sampled = Sampled.of(self._sampled, self.grid.degrees.shape)
        found = zeros(self.grid, {"M": sampled}, lambda *at: {"M": Sampled.of(self.line.at(*at), at[0].shape)}, size)
        return tuple(found["M"].tolist())

    def at(self, degrees: Array) -> Array:
        """Return E in J at crank angles (…,) in degrees, counted from φ = 0; an angle's E hangs on no other one."""
        if not self.crossings:
            return np.zeros_like(degrees)
        since = np.mod(degrees, self.cycle)
        found = self.line.integral_to(since) - self._gained * (since / self.cycle)
        return np.asarray(unless_cancelled(found, self._to_and_fro))

    @cached_property
    def _gained(self) -> float:
        """E in J at the end of the cycle: what the rounding of the mean leaves of 0."""
        return float(self.line.integral_to(np.array(self.cycle)))

    @cached_property
    def _to_and_fro(self) -> float:
        """The works in J that speed up and slow down, all counted positive: what E is the difference of."""
        return self.grid.integral(np.abs(self._sampled.value))

    @cached_property
    def _heights(self) -> Array:
        """E in J at the crossings."""
        return self.at(np.array(self.crossings))

    @cached_property
    def lobes(self) -> tuple[float, ...]:
        """Work in J of every lobe from one crossing to the next, cyclically; positive ones speed the machine up."""
        heights = self._heights.tolist()
        return tuple(high - low for low, high in pairwise([*heights, *heights[:1]]))

    @cached_property
    def extremes(self) -> Extremes | None:
        """Largest and smallest E in J with their crank angles, the first of equal ones; None where E is the same."""
        if not self.crossings:
            return None
        heights = self._heights
        level = 16 * np.finfo(float).eps * self._to_and_fro
        reached = np.argmax(heights >= heights.max() - level), np.argmax(heights <= heights.min() + level)
        return Extremes(*(Extreme(float(heights[k]), self.crossings[k]) for k in reached))

    @cached_property
    def dE(self) -> float:
        """ΔE in J, the largest swing of the excess work."""
        return self.extremes.largest.value - self.extremes.smallest.value if self.extremes else 0.0


def torque_extremes(torque: Sum, grid: Grid, sampled: Jet) -> Extremes:
    """Return largest and smallest value in N m of a torque, one-sided values at jumps included.

    sampled: the torque on the grid, which is the cycle or a part of it that comes back.
    """
    return extremes(grid, {"M": Sampled.of(sampled, grid.degrees.shape)}, _Evaluated(torque))["M"]


class _Evaluated:
    """A torque with its slope; see `search.Evaluate`."""

    def __init__(self, torque: Sum) -> None:
        self._torque = torque

    def inside(self, grid: Grid, piece: Indices) -> tuple[Any, ...]:
        """Return what the torque takes in place of angles in these pieces (n,)."""
        return self._torque.inside(grid.within[piece, 0])

    def __call__(self, degrees: Array, within: Any) -> dict[str, Sampled]:
        return {"M": Sampled.of(self._torque.torque(degrees, within), degrees.shape)}
