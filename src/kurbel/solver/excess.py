"""Excess work: where the effort crosses the resistance, every lobe between, and the largest swing ΔE over all."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kurbel.solver.grid import Brackets, Extremes, Grid, Sampled, extremes, roots, sign_changes
from kurbel.solver.torques import Sum, Torque, total_work, total_works

if TYPE_CHECKING:
    from kurbel.arrays import Array, Indices


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

        def evaluate(degrees: Array, within: Array) -> dict[str, Sampled]:
            jet = self.effort.torque(degrees, within)
            return {"M": Sampled(jet.value, jet.slope)}

        return extremes(self.grid, evaluate(self.grid.degrees, self.grid.within), evaluate)["M"]

    @cached_property
    def crossings(self) -> tuple[float, ...]:
        """Crank angles in degrees, ascending, at which the effort crosses the resistance, by a jump or through zero."""
        degrees, within, values = self._signed_samples
        if len(values) < 2 or (values > 0).all() or (values < 0).all():
            return ()
        after = np.roll(np.arange(len(values)), -1)
        change = np.nonzero(values * values[after] < 0)[0]
        following = after[change]
        inside = (within[change] == within[following]) & (following > change)
        brackets = Brackets(*(of[at][inside] for of, at in _ends(degrees, within, values, change, following)))
        # otherwise it stands at the break before the piece in which the new sign is met first
        found = self.grid.breaks[np.searchsorted(self.grid.breaks, within[following]) - 1]
        found[inside] = roots(lambda phi, side: self.torque.torque(phi, side).value, brackets)
        return tuple(np.sort(np.mod(found, self.cycle)).tolist())

    @cached_property
    def _signed_samples(self) -> tuple[Array, Array, Array]:
        """Angles, pieces and excess torques in ascending order, at least one between any two crossings, without zeros.

        Beside the nodes of the grid these are the extremes that could reach across zero between two nodes.
        """
        jet = self.torque.torque(self.grid.degrees, self.grid.within)
        reach = np.maximum(np.abs(jet.slope[:, :-1]), np.abs(jet.slope[:, 1:])) * self._widths
        near = np.minimum(np.abs(jet.value[:, :-1]), np.abs(jet.value[:, 1:])) <= reach
        turning = sign_changes(self.grid, jet.slope, near)
        peaks = roots(lambda phi, side: self.torque.torque(phi, side).slope, turning)
        peak_values = self.torque.torque(peaks, turning.within).value if len(peaks) else peaks
        degrees = np.concatenate((self.grid.degrees.ravel(), peaks))
        within = np.concatenate((self.grid.within.ravel(), turning.within))
        values = np.concatenate((jet.value.ravel(), peak_values))
        order = np.lexsort((degrees, within))
        # an effort that equals the resistance over a while differs from it by rounding only
        noise = 8 * np.finfo(float).eps * max(map(abs, (e.value for e in self.effort_extremes)))
        kept = order[np.abs(values[order]) > noise]
        return degrees[kept], within[kept], values[kept]

    @property
    def _widths(self) -> Array:
        return np.asarray(np.radians(np.diff(self.grid.degrees, axis=1)))

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


def _ends(
    degrees: Array, within: Array, values: Array, low: Indices, high: Indices
) -> tuple[tuple[Array, Indices], ...]:
    """Return array and indices of each field of Brackets."""
    return (degrees, low), (degrees, high), (within, low), (values, low), (values, high)


def mean_torque(torque: Torque, cycle: float) -> float:
    """Return the mean of a torque in N m over a cycle in degrees, from its closed work."""
    return total_work(torque, 0.0, cycle) / math.radians(cycle)
