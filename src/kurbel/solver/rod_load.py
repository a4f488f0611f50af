"""Rod loads after API 618: the load on the crosshead pin must reverse in every revolution, to admit oil to both sides.

The standard requires 15° of crank angle and 3 % of the larger load in the opposite direction, evaluated every 5°;
kurbel finds the angles of reversal exactly.
"""

from __future__ import annotations

from functools import cached_property, partial

import numpy as np

from kurbel.arrays import Array
from kurbel.numerics.arithmetic import some, where
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.numerics.pieces import Pieces
from kurbel.quantity import ValuesById, value, values_for
from kurbel.solver.cycle import reversals
from kurbel.solver.drive import Drive
from kurbel.solver.figures import Results, result

LEAST_REVERSAL = 15.0, 0.03
"""Degrees of crank angle, and share of the larger load, that API 618 requires of the reversed rod load."""
_LOADS = {
    "rod_compression": ("P_G,d", "rod load at the crosshead pin in compression"),
    "rod_tension": ("P_G,z", "rod load at the crosshead pin in tension"),
    "piston_rod_compression": ("P_KS,d", "load on the piston rod in compression"),
    "piston_rod_tension": ("P_KS,z", "load on the piston rod in tension"),
    "gas_compression": ("P_gas,d", "gas load in compression"),
    "gas_tension": ("P_gas,z", "gas load in tension"),
}
"""Column P_… and how it loads the rod -> symbol, and what it is called."""


class RodLoads(Results):
    """Key values of the load on piston rod and crosshead pin of a cylinder, in SI; None without a gas force.

    loads: the columns P_gas, P_rod and P_piston_rod in N, as far as there are any, at the nodes of pieces. Loads are
    magnitudes; 0, at the angle that comes nearest, if the rod is never in tension, or compression.
    """

    rod_load_max = values_for(
        _LOADS, "*_max", "*", "force", "Largest *", group=lambda load: load.rpartition("_")[0]
    )
    phi_rod_reversal = value(
        "φ_G=0",
        "angle",
        "Crank angles at which the rod load at the crosshead pin reverses",
        listed=True,
    )
    reversal_angle = value(
        "Δφ_G",
        "angle",
        "Crank angle per cycle with the rod in compression or in tension, whichever is smaller; a bound is a minimum",
        wanted_large=True,
    )
    reversal_longest = value(
        "Δφ_G,1", "angle", "Its longest continuous range; a bound is a minimum", wanted_large=True
    )
    reversal_ratio = value(
        "P_G,min/max",
        "ratio",
        "Ratio of the smaller to the larger peak rod load, compression and tension; a bound is a minimum",
        wanted_large=True,
    )

    def __init__(self, drive: Drive, pieces: Pieces, loads: dict[str, Array]) -> None:
        self.drive, self.pieces, self.loads = drive, pieces, loads

    @cached_property
    def answers(self) -> ValuesById:
        """The key values."""
        count = self.drive.count
        answers = ValuesById()
        extremes = self.pieces.extremes([*self.loads.values()]).each(partial(result, count=count))
        peaks = dict(zip(self.loads, extremes))
        for load in _LOADS:
            column, _, side = load.rpartition("_")
            peak = peaks.get(f"P_{column}")
            if peak is None:
                continue
            size, degrees = peak.largest
            if side != "compression":
                size, degrees = -peak.smallest.value, peak.smallest.degrees
            answers[f"{load}_max"] = Extreme(where(size > 0, size, 0.0), degrees)
        if "P_rod" in self.loads:
            answers |= self._reversals(peaks["P_rod"])
        return answers

    def _reversals(self, peak: Extremes) -> ValuesById:
        """The key values of the reversals of the rod load: angles, how long, and the ratio of its extremes."""
        count = self.drive.count
        changes = reversals(self.drive, self.pieces, self.loads["P_rod"])
        reversed_in_all, longest = self._reversed([changes] if count is None else list(changes))
        angle = result(reversed_in_all, count)
        answers: ValuesById = {
            "phi_rod_reversal": changes,
            "reversal_angle": angle,
            "reversal_longest": result(longest, count),
            "reversal_ratio": angle,
        }
        if some(angle > 0):
            pressed, pulled = abs(peak.largest.value), abs(peak.smallest.value)
            is_pulled_more = pressed < pulled
            smaller = where(is_pulled_more, pressed, pulled)
            larger = where(is_pulled_more, pulled, pressed)
            answers["reversal_ratio"] = where(angle > 0, smaller / larger, 0.0)
        return answers

    def _reversed(self, changes: list[tuple[float, ...]]) -> Array:
        """Return the degrees per cycle on which the rod is pressed, or pulled, whichever is less, (2, machines).

        All of them, and the longest stretch; 0 where the load does not reverse. changes: of each machine, in degrees.
        """
        counts = [len(change) for change in changes]
        # the stretches from change to change, the last over the end of the cycle
        widths = []
        for change in changes:
            closed = [*change, *(first + self.drive.cycle for first in change[:1])]
            widths.append(np.diff(closed))
        middles = np.concatenate([*map(np.array, changes)]) + np.concatenate(widths) / 2
        machine = np.repeat(np.arange(len(changes)), counts)
        is_pressed = self.pieces.at(self.loads["P_rod"], machine, middles) > 0

        degrees = np.zeros((2, len(changes)))
        of_machines = np.split(is_pressed, np.cumsum(counts)[:-1])
        for number, (width, pressed) in enumerate(zip(widths, of_machines)):
            less = min(width[pressed], width[~pressed], key=np.sum)
            degrees[:, number] = less.sum(), less.max(initial=0.0)
        return degrees
