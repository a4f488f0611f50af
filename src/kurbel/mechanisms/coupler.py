"""The connecting rod or coupler of a mechanism: how it turns, and how any point of it moves."""

from typing import Any, NamedTuple

from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms import Mechanism
from kurbel.numerics.arithmetic import bearing, sqrt


class Coupler(NamedTuple):
    """The rod at a crank angle: its direction τ from the crank pin to its other pin, and how that turns.

    sin, cos: of τ, counted as φ from the line φ = 0; slope, curvature: dτ/dφ and d²τ/dφ²; each as the angle.
    """

    sin: Any
    cos: Any
    slope: Any
    curvature: Any

    @property
    def degrees(self) -> Any:
        """τ in degrees, from −180 to 180."""
        return bearing(self.sin, self.cos)


class PointMotion(NamedTuple):
    """Place in m of a point from the shaft axis: x along φ = 0, y along φ = 90°; its derivatives by φ, in m."""

    x: Any
    y: Any
    speed: Any
    acceleration: Any


def point_motion(mechanism: Mechanism, coupler: Coupler, angle: CrankAngle, along: float, across: float) -> PointMotion:
    """Return the motion of the point `along` from the crank pin toward the other one, and `across`, to y, in m.

    With r = R e^{iφ} + (along + i across) e^{iτ}: |dr/dφ| and |d²r/dφ²|.
    """
    R, turn = mechanism.crank, coupler.slope
    a, b = coupler.cos * along - coupler.sin * across, coupler.sin * along + coupler.cos * across
    speed = -R * angle.sin - b * turn, R * angle.cos + a * turn
    toward = turn * turn
    bend = -R * angle.cos - b * coupler.curvature - a * toward, -R * angle.sin + a * coupler.curvature - b * toward
    return PointMotion(R * angle.cos + a, R * angle.sin + b, *(sqrt(x * x + y * y) for x, y in (speed, bend)))
