"""Rod loads after API 618: unless crosshead pin and bush part once in every turn, no oil comes to the loaded side.

The standard asks for 15° of crank angle and 3 % of the larger load in the other direction; it takes both every 5°,
kurbel at the roots.
"""

from __future__ import annotations

from functools import cached_property, partial
from typing import Any

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.numerics.arithmetic import some, where
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.numerics.pieces import Pieces
from kurbel.quantity import for_each, key_value
from kurbel.solver.cycle import reversals
from kurbel.solver.drive import Drive
from kurbel.solver.figures import Results, told

_LOADS = {
    "rod_compression": ("P_G,d", "rod load at the crosshead pin in compression"),
    "rod_tension": ("P_G,z", "rod load at the crosshead pin in tension"),
    "piston_rod_compression": ("P_KS,d", "load on the piston rod in compression"),
    "piston_rod_tension": ("P_KS,z", "load on the piston rod in tension"),
    "gas_compression": ("P_gas,d", "gas load in compression"),
    "gas_tension": ("P_gas,z", "gas load in tension"),
}
"""Column P_… and the way it loads the rod -> symbol, and what it is called."""


class RodLoads(Results):
    """Key values of the load on piston rod and crosshead pin of a cylinder, in SI; None without a gas force.

    loads: the columns P_gas, P_rod and P_piston_rod in N, as far as there are any, at the nodes of pieces.
    """

    def __init__(self, drive: Drive, pieces: Pieces, loads: dict[str, Array]) -> None:
        self.drive, self.pieces, self.loads = drive, pieces, loads

    @cached_property
    def _peaks(self) -> dict[str, Extremes]:
        if not self.loads:
            return {}
        found = self.pieces.extremes(np.stack([*self.loads.values()]))
        return dict(zip(self.loads, found.each(partial(told, count=self.drive.count))))

    @for_each(
        _LOADS,
        "*_max",
        "*",
        "force",
        group=lambda load: load.rpartition("_")[0],
    )
    def rod_load_max(self, which: str) -> Extreme | None:
        """Largest *.

        In tension its size; 0, where it comes nearest, if it is never loaded so.
        """
        column, _, way = which.rpartition("_")
        found = self._peaks.get(f"P_{column}")
        if found is None:
            return None
        value, degrees = found.largest if way == "compression" else (-found.smallest.value, found.smallest.degrees)
        return Extreme(where(value > 0, value, 0.0), degrees)

    @key_value("φ_G=0", "angle", listed=True)
    def phi_rod_reversal(self) -> tuple[Any, ...] | None:
        """Crank angles at which the rod load at the crosshead pin reverses.

        Changes within the noise of a trace count once. For many machines one tuple each.
        """
        return reversals(self.drive, self.pieces, self.loads["P_rod"]) if "P_rod" in self.loads else None

    @cached_property
    def _reversed(self) -> Array | None:
        """Degrees of crank angle per cycle on which the rod is pressed, or pulled, whichever is less, (2, machines).

        All of them, and the longest stretch; 0 where the load does not reverse, None without one.
        """
        if self.phi_rod_reversal is None:
            return None
        each = [self.phi_rod_reversal] if self.drive.count is None else self.phi_rod_reversal
        machine = np.repeat(np.arange(len(each)), [len(one) for one in each])
        start = np.array([angle for one in each for angle in one])
        first, last = np.flatnonzero(np.diff(machine, prepend=-1)), np.flatnonzero(np.diff(machine, append=-1))
        end = np.append(start[1:], 0.0)[: len(start)]
        end[last] = start[first] + self.drive.cycle
        presses = self.pieces.at(self.loads["P_rod"], machine, (start + end) / 2) > 0
        pressed, pulled = (_stretches(machine[way], (end - start)[way], len(each)) for way in (presses, ~presses))
        return np.where(pulled[0] < pressed[0], pulled, pressed)

    @key_value("Δφ_G", "angle", wanted_large=True)
    def reversal_angle(self) -> Any:
        """Crank angle per cycle of a reversed rod load: pressed or pulled, whichever is less; a bound is the least."""
        return None if self._reversed is None else told(self._reversed[0], self.drive.count)

    @key_value("Δφ_G,1", "angle", wanted_large=True)
    def reversal_longest(self) -> Any:
        """The longest stretch of it; a bound is the least."""
        return None if self._reversed is None else told(self._reversed[1], self.drive.count)

    @key_value("P_G,min/max", "ratio", wanted_large=True)
    def reversal_ratio(self) -> Any:
        """Smaller over larger peak of the rod load, pressed and pulled; a bound is the least."""
        angle, peaks = self.reversal_angle, self._peaks.get("P_rod")
        if angle is None or peaks is None or not some(angle > 0):
            return angle
        pressed, pulled = (abs(one.value) for one in peaks)
        ratio = where(pressed < pulled, pressed, pulled) / where(pressed < pulled, pulled, pressed)
        return where(angle > 0, ratio, 0.0)


def _stretches(whose: Indices, degrees: Array, count: int) -> Array:
    """Return the sum of the stretches (n,) of each of `count` machines, and the longest, (2, count)."""
    longest = np.zeros(count)
    np.maximum.at(longest, whose, degrees)
    return np.stack((np.bincount(whose, degrees, count), longest))
