"""Where the segments of a process lie over the crank angle, of one machine or of many variants."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.machine.variants import taken
from kurbel.numerics.cycles import Flat, located
from kurbel.numerics.extreme import Extreme
from kurbel.solver.pressure import Setting
from kurbel.solver.pressure.segments import Processes, Segment

_NO_WIDTH = 1e-10
"""Degrees of crank angle; over less a line cannot be followed, and its segment is a jump."""


@dataclass(frozen=True, eq=False)
class Places:
    """Segments (n,), those of every variant in the order in which they begin: their figures, and the crank angles.

    variant: whose each is, None where all variants have the same; angles, ends: where each begins and ends, in degrees;
    cycle: degrees after which all repeat.
    """

    table: Segment
    variant: Indices | None
    angles: Array
    ends: Array
    cycle: float

    @property
    def _until(self) -> Array:
        """The angles at which segments end, those that end with the cycle at its end."""
        return np.where(self.ends > self.angles, self.ends, self.ends + self.cycle)

    @property
    def starts(self) -> Any:
        """The crank angles (n,) in degrees, or `Flat` of every variant, at which segments begin."""
        return self.angles if self.variant is None else Flat(self.variant, self.angles)

    def highest(self, base: Any) -> Extreme:
        """Return the highest pressure less the base in Pa, and the first angle in degrees of the cycle that has it."""
        high, angle = np.maximum(self.table.p, self.table.next_p), self.angles
        first = np.zeros(1, dtype=np.intp)
        if self.variant is not None:
            first = np.flatnonzero(np.append(True, self.variant[1:] != self.variant[:-1]))
        best = np.maximum.reduceat(high, first)
        spread = np.repeat(best, np.diff(np.append(first, len(high))))
        angle = np.where(self.table.p == spread, angle, np.where(self.table.next_p == spread, self._until, np.inf))
        degrees: Any = np.minimum.reduceat(angle, first)
        if self.variant is not None:
            return Extreme(best - base, degrees)
        return Extreme(float(best[0] - base) + 0.0, float(degrees[0]))

    def holding(self, angles: Array, variant: Indices | None) -> Indices:
        """Return the segments (…,) that hold angles in the cycle, of these variants."""
        if self.variant is None:
            return np.searchsorted(self.angles, angles, side="right") - 1
        assert variant is not None
        return located(Flat(self.variant, self.angles), np.broadcast_to(variant, angles.shape), angles)


def segments_over(processes: Processes, setting: Setting) -> Places:
    """Return the segments of processes over the crank angle; those over no width, being jumps, are left out."""
    count = processes.variants(setting)
    whose, stroke, table = processes.segments(count)
    begin, edges, ends = _edges(whose, stroke, table, setting, count)
    # beside the other end of the stroke rounding may turn two angles round
    wide = np.mod(ends - edges + 1, 360.0) - 1 > _NO_WIDTH
    whose, stroke, begin, edges = whose[wide], stroke[wide], begin[wide], edges[wide]
    begins = np.append(True, (stroke[1:] != stroke[:-1]) | (whose[1:] != whose[:-1]))
    angles = np.mod(np.where(begins, begin, edges), setting.cycle)
    order = np.lexsort((angles, whose))
    angles, whose = angles[order], whose[order]
    following = np.append(np.arange(1, len(angles)), 0)
    last = np.append(whose[1:] != whose[:-1], True)
    following[last] = np.flatnonzero(np.append(True, last[:-1]))
    table = Segment(*(part[wide][order] for part in table))
    return Places(table, None if count is None else whose, angles, angles[following], setting.cycle)


def _edges(
    whose: Indices, stroke: Indices, table: Segment, setting: Setting, count: int | None
) -> tuple[Array, Array, Array]:
    """Return the crank angles in degrees (n,) at which strokes begin, segments begin, and segments end."""
    # the crank end begins its process at the outer dead centre, one stroke later
    number = stroke + (0 if setting.head_end else 1)
    mechanism = setting.mechanism if count is None else taken(setting.mechanism, whose)
    begin, end = (_dead_centre(mechanism.dead_centres(), each) for each in (number, number + 1))
    edges = begin.copy()
    later = np.append(False, (stroke[1:] == stroke[:-1]) & (whose[1:] == whose[:-1]))
    along = table.z if setting.head_end else 1 - table.z
    for outstroke in (True, False):
        inside = np.flatnonzero(later & ((number % 2 == 0) == outstroke))
        if len(inside):
            own = mechanism if count is None else taken(setting.mechanism, whose[inside])
            angles = own.crank_angles_at(along[inside] * own.stroke, outstroke)
            edges[inside] = 360.0 * (number[inside] // 2) + angles
    return begin, edges, np.where(np.append(later[1:], False), np.append(edges[1:], 0.0), end)


def _dead_centre(centres: tuple[Any, Any], number: Indices) -> Array:
    """Return the crank angles in degrees (n,) at which strokes begin; strokes count from 0 on."""
    return np.asarray(360.0 * (number // 2) + np.where(number % 2 == 0, *centres))
