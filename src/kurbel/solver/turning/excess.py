"""Excess work: where the effort crosses the resistance, every lobe between, and the largest swing ΔE over all."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kurbel.numerics.grid import Grid
from kurbel.numerics.search import Evaluate, Extremes, Sampled, extremes, zeros
from kurbel.solver.turning.torques import Sum, Torque, total_work, total_works

if TYPE_CHECKING:
    from kurbel.arrays import Array


class Excess:
    """The excess of a turning effort over a resistance with the same mean, over a common cycle.

    E(φ) = ∫ (M − M_load) dφ from φ = 0 is stationary at the crossings, so that an error of their place does not show.
    """

    def __init__(self, effort: Torque, load: Torque) -> None:
        self.torque = Sum(((1.0, effort), (-1.0, load)))
        self.grid = Grid(self.torque.breaks)
        self.cycle = float(self.torque.breaks[-1])
        self.effort = effort

    @cached_property
    def effort_extremes(self) -> Extremes:
        """Largest and smallest turning effort in N m, one-sided values at jumps included."""
        evaluate = _evaluated(self.effort)
        return extremes(self.grid, evaluate(self.grid.degrees, self.grid.within), evaluate)["M"]

    @cached_property
    def crossings(self) -> tuple[float, ...]:
        """Crank angles in degrees, ascending, at which the effort crosses the resistance, by a jump or through zero."""
        evaluate = _evaluated(self.torque)
        # an effort that equals the resistance over a while differs from it by rounding only
        size = max(abs(extreme.value) for extreme in self.effort_extremes)
        found = zeros(self.grid, evaluate(self.grid.degrees, self.grid.within), evaluate, size)["M"]
        return tuple(found.tolist())

    @cached_property
    def lobes(self) -> tuple[float, ...]:
        """Work in J of every lobe from one crossing to the next, cyclically; positive ones speed the machine up."""
        if not self.crossings:
            return ()
        ends = (*self.crossings[1:], self.crossings[0] + self.cycle)
        return tuple(total_works(self.torque, self.crossings, ends))

    @cached_property
    def _summits(self) -> tuple[float, float]:
        """Crank angles in degrees of the largest and the smallest E, the first ones where several are equal."""
        heights = total_works(self.torque, (0.0,) * len(self.crossings), self.crossings)
        size = max(map(abs, heights), default=0.0) + max(map(abs, self.lobes), default=0.0)
        level = 16 * np.finfo(float).eps * size
        top, bottom = max(heights) - level, min(heights) + level
        largest = next(a for a, e in zip(self.crossings, heights, strict=True) if e >= top)
        smallest = next(a for a, e in zip(self.crossings, heights, strict=True) if e <= bottom)
        return largest, smallest

    @property
    def phi_largest(self) -> float | None:
        """Crank angle in degrees at which E is largest; None where it is always the same."""
        return self._summits[0] if self.crossings else None

    @property
    def phi_smallest(self) -> float | None:
        """Crank angle in degrees at which E is smallest; None where it is always the same."""
        return self._summits[1] if self.crossings else None

    @cached_property
    def dE(self) -> float:
        """ΔE in J, the largest swing of the excess work, taken as one closed difference."""
        if not self.crossings:
            return 0.0
        largest, smallest = self._summits
        return total_work(self.torque, smallest, largest)

    def at(self, degrees: Array) -> Array:
        """Return E in J at crank angles (n,) in degrees, counted from φ = 0; an angle's E hangs on no other one."""
        if not self.crossings:
            return np.zeros_like(degrees)
        total = rest = np.zeros_like(degrees)
        for term in self.torque.work(total, degrees):
            # Neumaier's sum, so that the order in which numpy would add does not show
            raised = total + term
            rest = rest + np.where(np.abs(total) >= np.abs(term), (total - raised) + term, (term - raised) + total)
            total = raised
        return np.where(degrees == 0, 0.0, total + rest)


def _evaluated(torque: Torque) -> Evaluate:
    return lambda degrees, within: {"M": Sampled.of(torque.torque(degrees, within), degrees.shape)}


def mean_torque(torque: Torque, cycle: float) -> float:
    """Return the mean of a torque in N m over a cycle in degrees, from its closed work."""
    return total_work(torque, 0.0, cycle) / math.radians(cycle)
