"""The rod load of a compressor after API 618: how hard its rod is pressed and pulled, and whether the load reverses.

Unless crosshead pin and bush part once in every turn, no oil comes between them on the loaded side: the standard asks
for 15° of crank angle and 3 % of the larger load in the other direction. It takes both every 5°, kurbel at the roots.
"""

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.numerics.extreme import Extreme
from kurbel.numerics.search import Extremes

if TYPE_CHECKING:
    from kurbel.solver.cylinder.forces import CylinderForces
    from kurbel.solver.cylinder.state import State


def rod_load(state: "State", without: float = 0.0) -> Any:
    """Return the force in N of the gas, with inertia and weight of the moving parts, toward the shaft.

    without: mass in kg that is left out beside the connecting rod's share. None without a gas force, and without a
    connecting rod, where it would be P.
    """
    drive, masses = state.drive, state.drive.cylinder.masses
    if state.P_gas is None or not drive.mechanism.has_rod:
        return None
    mass = masses.parts - without if masses else 0.0
    weight = drive.weight_of(mass)
    moved = state.P_gas - state.b * mass if drive.has_inertia else state.P_gas
    return moved + weight[0] if weight else moved


class RodLoad:
    """Loads of gas and moving parts on one rod. Attributes are named by the ids of the key values, in SI, or None."""

    def __init__(self, forces: "CylinderForces") -> None:
        self._forces = forces

    @property
    def no_compressor(self) -> bool:
        """Whether nobody asks for the rod load: an engine, also a motored one of four strokes, or no connecting rod."""
        work, drive = self._forces.work, self._forces.drive
        return work is None or work >= 0 or drive.revolutions > 1 or not drive.mechanism.has_rod

    @cached_property
    def _every(self) -> dict[str, Extremes]:
        return self._forces.extremes_over(("P_gas", "P_rod", "P_piston_rod"))

    def _extremes(self, column: str) -> Extremes | None:
        return self._every.get(column)

    def compression_max(self, column: str) -> Extreme | None:
        """Return the largest force in N toward the shaft; 0, where it comes nearest, if none."""
        found = self._extremes(column)
        return found and Extreme(max(found.largest.value, 0.0), found.largest.degrees)

    def tension_max(self, column: str) -> Extreme | None:
        """Return the size of the largest force in N away from the shaft; 0, where it comes nearest, if none."""
        found = self._extremes(column)
        return found and Extreme(max(-found.smallest.value, 0.0), found.smallest.degrees)

    @cached_property
    def phi_rod_reversal(self) -> tuple[float, ...] | None:
        """Crank angles in degrees at which the rod load takes the other sign; within the noise of a trace, once."""
        return self._forces.reversals_of("P_rod")

    @cached_property
    def _reversed(self) -> tuple[float, ...]:
        """Degrees of crank angle of every stretch of pressing, or of pulling, whichever lasts for less of the cycle."""
        turns = self.phi_rod_reversal
        if not turns:
            return ()
        ends = np.array([*turns, turns[0] + self._forces.drive.cycle])
        presses = np.asarray(self._forces.at((ends[:-1] + ends[1:]) / 2).P_rod) > 0
        each = (tuple(np.diff(ends)[way].tolist()) for way in (presses, ~presses))
        return min(each, key=math.fsum)

    @property
    def reversal_angle(self) -> float | None:
        """Degrees of crank angle per cycle of the reversed load; 0 where it does not reverse."""
        return None if self.phi_rod_reversal is None else math.fsum(self._reversed)

    @property
    def reversal_longest(self) -> float | None:
        """The longest of its stretches in degrees."""
        return None if self.phi_rod_reversal is None else max(self._reversed, default=0.0)

    @property
    def reversal_ratio(self) -> float | None:
        """Smaller peak of the rod load over the larger one; 0 where it does not reverse."""
        if self.phi_rod_reversal is None or not self._reversed:
            return self.reversal_angle
        peaks = sorted(abs(one.value) for one in self._extremes("P_rod") or ())
        return peaks[0] / peaks[1]
