"""The rod load of a compressor after API 618: how hard its rod is pressed and pulled, and whether the load reverses.

Unless crosshead pin and bush part once in every turn, no oil comes between them on the loaded side: the standard asks
for 15° of crank angle and 3 % of the larger load in the other direction. It takes both every 5°, kurbel at the roots.
"""

from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.numerics.arithmetic import some, where
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
        return found and _at_least_zero(found.largest.value, found.largest.degrees)

    def tension_max(self, column: str) -> Extreme | None:
        """Return the size of the largest force in N away from the shaft; 0, where it comes nearest, if none."""
        found = self._extremes(column)
        return found and _at_least_zero(-found.smallest.value, found.smallest.degrees)

    @cached_property
    def phi_rod_reversal(self) -> tuple[Any, ...] | None:
        """Crank angles in degrees at which the rod load takes the other sign; within the noise of a trace, once.

        Of many variants one tuple each.
        """
        return self._forces.reversals_of("P_rod")

    @cached_property
    def _reversed(self) -> Array | None:
        """Degrees of crank angle per cycle on which the rod is pressed, or pulled, whichever is less, (2, variants).

        All of them, and the longest stretch; 0 where the load does not reverse, None without one.
        """
        drive, turns = self._forces.drive, self.phi_rod_reversal
        if turns is None:
            return None
        each = [turns] if drive.count is None else turns
        whose = np.repeat(np.arange(len(each)), [len(one) for one in each])
        start = np.array([*chain.from_iterable(each)])
        first, last = np.flatnonzero(np.diff(whose, prepend=-1)), np.flatnonzero(np.diff(whose, append=-1))
        end = np.append(start[1:], 0.0)[: len(start)]
        end[last] = start[first] + drive.cycle
        presses = np.asarray((drive if drive.count is None else drive.taken(whose)).at((start + end) / 2).P_rod) > 0
        pressed, pulled = (_stretches(whose[way], (end - start)[way], len(each)) for way in (presses, ~presses))
        return np.where(pulled[0] < pressed[0], pulled, pressed)

    @property
    def reversal_angle(self) -> Any:
        """Degrees of crank angle per cycle of the reversed load; 0 where it does not reverse."""
        return None if self._reversed is None else self._forces.grid.told(self._reversed[0])

    @property
    def reversal_longest(self) -> Any:
        """The longest of its stretches in degrees."""
        return None if self._reversed is None else self._forces.grid.told(self._reversed[1])

    @property
    def reversal_ratio(self) -> Any:
        """Smaller peak of the rod load over the larger one; 0 where it does not reverse."""
        angle, peaks = self.reversal_angle, self._extremes("P_rod")
        if angle is None or peaks is None or not some(angle > 0):
            return angle
        pressed, pulled = (abs(one.value) for one in peaks)
        ratio = where(pressed < pulled, pressed, pulled) / where(pressed < pulled, pulled, pressed)
        return where(angle > 0, ratio, 0.0)


def _stretches(whose: Indices, degrees: Array, count: int) -> Array:
    """Return the sum of the stretches (n,) of each of so many variants, and the longest, (2, count)."""
    longest = np.zeros(count)
    np.maximum.at(longest, whose, degrees)
    return np.stack((np.bincount(whose, degrees, count), longest))


def _at_least_zero(value: Any, degrees: Any) -> Extreme:
    return Extreme(where(value > 0, value, 0.0), degrees)
