"""Measured traces over the crank angle in mpmath's numbers: straight lines between the samples.

The samples are those of kurbel after its level and pegging, which are data here; what is computed anew is where they
are, the pressure between them, and their work.
"""

from bisect import bisect_right

import numpy as np

from kurbel.accuracy.linkages import TextbookMotion
from kurbel.accuracy.methods import Precise, integrals, mp, mpf
from kurbel.arrays import Array
from kurbel.mechanisms.setting import Setting
from kurbel.traces.correct import Trace, corrected


class TracedChamber:
    """One end of a piston with a trace; sign, area: as of a `TextbookChamber`; cycle in degrees.

    corners: crank angles in degrees of the samples, over one cycle, at which the pressure bends or jumps.
    """

    def __init__(
        self,
        trace: Trace,
        setting: Setting,
        motion: TextbookMotion,
        sign: int,
        area: Precise,
    ) -> None:
        self.sign = sign
        self.area = area
        self._motion = motion
        self._cycle = mpf(setting.cycle)

        # where the samples are: from the dead centre that the trace counts from
        of_cycle = trace.over(setting.cycle)
        zero = motion.ends[1 if setting.mirrored else 0] - mpf(of_cycle.angle_zero)
        self._begin = mpf(float(of_cycle.angles[0])) + zero
        self._along = [mpf(float(angle)) + zero - self._begin for angle in of_cycle.angles]
        self.corners = [(self._begin + along) % self._cycle for along in self._along[:-1]]

        # what they are, absolute
        pressures = corrected(of_cycle, setting).mean(axis=0)
        self._pressures = [mpf(float(pressure)) + mpf(setting.lift) for pressure in pressures]

    def shares(self, stroke: int) -> set[Precise]:
        """Return no shares of a stroke: a trace bends at angles."""
        return set()

    def line_at(self, stroke: int, share: Precise, within: Precise) -> int:
        """Return the number of the sample before an angle."""
        after = (within - self._begin) % self._cycle
        return min(bisect_right(self._along, after), len(self._along) - 1) - 1

    def pressure(self, line: int, share: Precise, phi: Precise) -> Precise:
        """Return the absolute pressure on the straight line behind a sample, at a crank angle."""
        width = self._along[line + 1] - self._along[line]
        low = self._pressures[line]
        high = self._pressures[line + 1]
        past = phi - self._begin - self._along[line]
        # an angle that is before its sample by rounding only is not a cycle after it
        past = (past + self._cycle / 2) % self._cycle - self._cycle / 2
        return low + (high - low) * past / width

    @property
    def work(self) -> Precise:
        """The work in J over the stroke in m, of one process."""

        def power(phi: Precise, within: Precise) -> Precise:
            pressure = self.pressure(self.line_at(0, mpf(0), within), mpf(0), phi)
            return pressure * self._motion.at(phi).slope

        edges = np.array(sorted({*self.corners, mpf(0), self._cycle, *self._dead_centres()}))
        area: Precise = integrals(np.frompyfunc(power, 2, 1), edges, 12).sum()
        return self.sign * self.area * mp.radians(area) / self._motion.stroke

    def _dead_centres(self) -> Array:
        """Return the angles of the cycle in which the piston turns back."""
        turns = np.arange(0, round(self._cycle), 360)
        angles: Array = np.add.outer(self._motion.ends[:2], turns).ravel() % self._cycle
        return angles
