"""Loads as vectors in the plane square to the shaft, and what of a round surface none of them ever reaches."""

import math
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags
from kurbel.crank_angle import CrankAngle
from kurbel.numerics.arithmetic import bearing
from kurbel.solver.shaft.statics import Vector, norm

HALF_CONTACT = 60.0
"""Degrees to either side of a load over which pin and shell are taken to touch."""


class Plane(NamedTuple):
    """A load in N in a frame: along its axis, and 90° on in the sense of rotation; each (n,) or a jet."""

    along: Any
    across: Any

    @classmethod
    def of_throw(cls, force: Vector) -> "Plane":
        """Return a force as it stands in the frame of its throw, whose axis points outward: −D + iT."""
        return cls(-force.D, force.T)

    def turned(self, cos: Any, sin: Any) -> "Plane":
        """Return the load in a frame that stands behind this one by the angle of this cosine and sine."""
        return Plane(self.along * cos - self.across * sin, self.along * sin + self.across * cos)

    def turned_by(self, degrees: float) -> "Plane":
        """Return the same for an angle in degrees."""
        angle = CrankAngle.of(degrees)
        return self.turned(angle.cos, angle.sin) if degrees else self

    @property
    def size(self) -> Any:
        """The magnitude of the load in N."""
        return norm(self.along, self.across)

    @property
    def direction(self) -> Any:
        """Direction in degrees from the axis of the frame, from −180 to 180."""
        # each with the slopes of both: of a jet and what does not vary, both must be jets
        return bearing(self.across + self.along * 0.0, self.along + self.across * 0.0)


def axial(directions: Array, rounding: float) -> Array:
    """Return directions (n,) in degrees, those along their axis but for this rounding as 0 or 180."""
    along = np.rint(directions / 180.0) * 180.0
    return np.where(np.abs(directions - along) <= rounding, np.abs(along), directions)


_EQUAL = 1e-6  # degrees; by which rounding may move the ends of a piece, where next to no load tells them


class Unloaded(NamedTuple):
    """What of a surface no load reaches, in degrees: all of it, and the middle of its widest piece, if any.

    Of pieces equally wide it is the first from 0° on.
    """

    arc: float
    middle: float | None


def unloaded(direction: Array, joined: Flags) -> Unloaded:
    """Return what of a circle loads do not reach that press within 60° to either side of their direction.

    direction: of loads (n,) in degrees, in the order of time; joined: (n − 1,) where the load goes on from one to the
    next, by less than half a turn and without turning back between them.
    """
    step = np.remainder(np.diff(direction) + 180.0, 360.0) - 180.0
    start = np.concatenate((direction, (direction[:-1] + np.minimum(step, 0.0))[joined]))
    length = np.concatenate((np.zeros_like(direction), np.abs(step)[joined])) + 2 * HALF_CONTACT
    start = np.mod(start - HALF_CONTACT, 360.0)
    order = np.argsort(start)
    begins = np.concatenate([start[order] + turn for turn in (-360.0, 0.0, 360.0)])
    reached = np.maximum.accumulate(begins + np.tile(length[order], 3))
    gaps = begins[1:] - reached[:-1]
    free = (gaps > 0) & (begins[1:] > 0) & (begins[1:] <= 360.0)
    if not free.any():
        return Unloaded(0.0, None)
    widest = int(np.argmax(free & (gaps > gaps[free].max() - _EQUAL)))
    middle = math.remainder(begins[1 + widest] - gaps[widest] / 2, 360.0)
    return Unloaded(float(gaps[free].sum()), float(axial(np.asarray(middle), _EQUAL)))
