"""The chamber at one end of a cylinder, and the reference of its pressures."""

from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms import Mechanism


class Setting(NamedTuple):
    """The chamber, and the reference of its pressures.

    cycle: degrees of crank angle, 360 or 720; ambient: absolute pressure in Pa; absolute: whether the chamber's own
    figures are; mirrored: the crank end repeats the head end's figures one stroke later. For many machines numbers are
    arrays (machines,); the annotations are those of one.
    """

    mechanism: Mechanism
    cycle: float
    head_end: bool
    ambient: float
    absolute: bool
    mirrored: bool = False

    @property
    def base(self) -> float:
        """Pressure in Pa that is subtracted from figures of the chamber to get gauge pressures."""
        if not self.absolute:
            return 0.0
        return self.ambient

    @property
    def lift(self) -> float:
        """Pressure in Pa that is added to figures of the chamber to get absolute pressures."""
        if self.absolute:
            return 0.0
        return self.ambient

    @property
    def own_dead_centre(self) -> float:
        """Crank angle in degrees at which the chamber is smallest."""
        inner, outer = self.mechanism.dead_centres()
        return inner if self.head_end else outer

    def after_dead_centre(self, degrees: Array) -> Array:
        """Return crank angles in degrees as those from the chamber's own (firing) dead centre, −½ to ½ cycle."""
        after = degrees - self.own_dead_centre
        return np.remainder(after + self.cycle / 2, self.cycle) - self.cycle / 2

    def stroke_fraction(self, after: Array) -> Array:
        """Return the fraction of the stroke from the chamber's smallest volume, so many degrees after it."""
        angle = CrankAngle.of(after + self.own_dead_centre)
        displaced = (
            self.mechanism.coordinate(angle) - self.mechanism.start
        ) / self.mechanism.stroke
        if self.head_end:
            return displaced
        return 1 - displaced
