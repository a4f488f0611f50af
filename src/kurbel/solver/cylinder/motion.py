"""Motion of one cylinder's mechanism: dead centres, strokes, velocities, accelerations and their exact extremes."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from kurbel.crank_angle import CrankAngle, jet_angle
from kurbel.mechanisms import Mechanism
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Grid, ascending
from kurbel.numerics.search import Evaluate, Extremes, Sampled, extremes, zeros


class Motion:
    """What the mechanism does at a speed of rotation. Attributes are named by the ids of the key values, in SI.

    speed: revolutions per second, or None: then velocities and accelerations are None. So is all that the mechanism
    does not have: a stroke where nothing slides, a swing where nothing swings, a transmission angle without a coupler.
    """

    def __init__(self, mechanism: Mechanism, speed: float | None) -> None:
        self.mechanism = mechanism
        self.speed = speed

    @cached_property
    def omega(self) -> float | None:
        """Angular velocity in rad/s."""
        return None if self.speed is None else 2 * math.pi * self.speed

    @cached_property
    def stroke(self) -> float | None:
        """s in m."""
        return self.mechanism.stroke if self.mechanism.slides else None

    @cached_property
    def swing(self) -> float | None:
        """Angle in degrees through which the member swings."""
        return self.mechanism.swing

    @cached_property
    def phi_idc(self) -> float:
        """Inner dead centre in degrees, from 0 to 360."""
        return _within_turn(self.mechanism.dead_centres()[0])

    @cached_property
    def phi_odc(self) -> float:
        """Outer dead centre in degrees, from 0 to 360."""
        return _within_turn(self.mechanism.dead_centres()[1])

    @cached_property
    def phi_work(self) -> float:
        """Crank rotation in degrees of the outstroke, or of the working stroke."""
        return self.mechanism.phi_work

    @cached_property
    def phi_return(self) -> float:
        """Crank rotation in degrees of the return stroke."""
        return self.mechanism.phi_return

    @cached_property
    def time_ratio(self) -> float:
        """Time of the outstroke (working stroke) over that of the return stroke."""
        return self.mechanism.time_ratio

    @cached_property
    def transmission_min(self) -> Extreme | None:
        """Smallest transmission angle in degrees."""
        return self.mechanism.transmission[0] if self.mechanism.transmission else None

    @cached_property
    def transmission_max(self) -> Extreme | None:
        """Largest transmission angle in degrees."""
        return self.mechanism.transmission[1] if self.mechanism.transmission else None

    @cached_property
    def v(self) -> float | None:
        """Crank-pin speed Rω in m/s."""
        return None if self.omega is None else self.mechanism.crank * self.omega

    @cached_property
    def c_m(self) -> float | None:
        """Mean piston speed 2 s n in m/s, R 290."""
        return None if self.speed is None or self.stroke is None else 2 * self.stroke * self.speed

    @cached_property
    def _turn(self) -> Grid:
        """One revolution, cut at the landmarks of the mechanism only."""
        landmarks = (*self.mechanism.dead_centres(), *self.mechanism.landmarks(), *range(0, 361, 45))
        return Grid(ascending(np.array([angle if angle == 360 else angle % 360.0 for angle in landmarks])))

    @cached_property
    def _slope_extremes(self) -> Extremes:
        return self._extremes(self.mechanism.velocity_extremes(), self.mechanism.slope)

    @cached_property
    def _curvature_extremes(self) -> Extremes:
        return self._extremes(self.mechanism.acceleration_extremes(), self.mechanism.curvature)

    @cached_property
    def _swing_slope_extremes(self) -> Extremes:
        return self._extremes(self.mechanism.swing_extremes(), self._swing("slope"))

    @cached_property
    def _swing_curvature_extremes(self) -> Extremes:
        return self._extremes((), self._swing("curvature"))

    def _swing(self, quantity: str) -> Callable[[CrankAngle], Any]:
        return lambda angle: getattr(self.mechanism.swing_at(angle), quantity)

    def _extremes(self, closed: tuple[Extreme, ...], function: Callable[[CrankAngle], Any]) -> Extremes:
        return _of_closed(closed) if closed else self._searched(function)

    def _searched(self, function: Callable[[CrankAngle], Any]) -> Extremes:
        """Search the extremes of a kinematic quantity over one revolution by the roots of its slope."""
        evaluate = _evaluated(function)
        return extremes(self._turn, evaluate(self._turn.degrees, self._turn.within), evaluate)["it"]

    def _sliding(self, order: int) -> Callable[[Extreme], Extreme] | None:
        """What turns a derivative by crank angle of this order into one by time; None where nothing slides or turns."""
        return _scaling(self.omega, order) if self.mechanism.slides else None

    def _swinging(self, order: int) -> Callable[[Extreme], Extreme] | None:
        """The same for what swings; None also for what turns as evenly as the crank."""
        if not self.mechanism.swings or _constant(self._swing_slope_extremes):
            return None
        return _scaling(self.omega, order)

    @cached_property
    def c_max(self) -> Extreme | None:
        """Largest velocity on the outstroke, of a piston toward the shaft, in m/s."""
        scaled = self._sliding(1)
        return scaled and scaled(self._slope_extremes.largest)

    @cached_property
    def c_min(self) -> Extreme | None:
        """Largest velocity on the return stroke in m/s, negative."""
        scaled = self._sliding(1)
        return scaled and scaled(self._slope_extremes.smallest)

    @cached_property
    def c_work_max(self) -> Extreme | None:
        """Largest speed of the working stroke in m/s, R 304."""
        return self.c_max if self.mechanism.quick_return else None

    @cached_property
    def c_return_max(self) -> Extreme | None:
        """Largest speed of the return stroke in m/s, R 305, positive."""
        if not self.mechanism.quick_return or self.c_min is None:
            return None
        return Extreme(-self.c_min.value, self.c_min.degrees)

    @cached_property
    def b_max(self) -> Extreme | None:
        """Largest acceleration in m/s²."""
        scaled = self._sliding(2)
        return scaled and scaled(self._curvature_extremes.largest)

    @cached_property
    def b_min(self) -> Extreme | None:
        """Smallest acceleration in m/s²."""
        scaled = self._sliding(2)
        return scaled and scaled(self._curvature_extremes.smallest)

    @cached_property
    def _swing_limits(self) -> tuple[Extreme, Extreme] | None:
        if self.swing is None:
            return None
        ends = [Extreme(self._tilt(end), _within_turn(end)) for end in self.mechanism.dead_centres()]
        return min(ends), max(ends)

    def _tilt(self, degrees: float) -> float:
        swing = self.mechanism.swing_at(CrankAngle.of(degrees))
        assert swing is not None
        return float(swing.degrees)

    @cached_property
    def theta_min(self) -> Extreme | None:
        """Smallest angle of the swinging member in degrees."""
        return self._swing_limits and self._swing_limits[0]

    @cached_property
    def theta_max(self) -> Extreme | None:
        """Largest angle of the swinging member in degrees."""
        return self._swing_limits and self._swing_limits[1]

    @cached_property
    def theta_dot_max(self) -> Extreme | None:
        """Largest angular velocity of the swinging member in rad/s."""
        scaled = self._swinging(1)
        return scaled and scaled(self._swing_slope_extremes.largest)

    @cached_property
    def theta_dot_min(self) -> Extreme | None:
        """Smallest angular velocity of the swinging member in rad/s."""
        scaled = self._swinging(1)
        return scaled and scaled(self._swing_slope_extremes.smallest)

    @cached_property
    def theta_ddot_max(self) -> Extreme | None:
        """Largest angular acceleration of the swinging member in rad/s²."""
        scaled = self._swinging(2)
        return scaled and scaled(self._swing_curvature_extremes.largest)

    @cached_property
    def theta_ddot_min(self) -> Extreme | None:
        """Smallest angular acceleration of the swinging member in rad/s²."""
        scaled = self._swinging(2)
        return scaled and scaled(self._swing_curvature_extremes.smallest)

    @cached_property
    def b_coupler(self) -> float | None:
        """Acceleration v²/R in m/s² of a coupler all of whose points move alike, toward the centre of their circles."""
        pair = self.mechanism.coupler_acceleration(CrankAngle.of(0.0))
        return None if pair is None or self.omega is None else math.hypot(*pair) * self.omega**2

    @cached_property
    def phi_b_zero(self) -> tuple[float, ...] | None:
        """Crank angles in degrees at which the acceleration is zero."""
        if not self.mechanism.slides:
            return None
        closed = self.mechanism.velocity_extremes()
        if closed:
            return tuple(sorted(extreme.degrees for extreme in closed))
        evaluate = _evaluated(self.mechanism.curvature)
        found = zeros(self._turn, evaluate(self._turn.degrees, self._turn.within), evaluate)["it"]
        return tuple(found.tolist())


def _evaluated(function: Callable[[CrankAngle], Any]) -> Evaluate:
    return lambda degrees, within: {"it": Sampled.of(function(jet_angle(degrees)), degrees.shape)}


def _of_closed(found: tuple[Extreme, ...]) -> Extremes:
    return Extremes(max(found, key=lambda e: e.value), min(found, key=lambda e: e.value))


def _constant(found: Extremes) -> bool:
    return found.largest.value == found.smallest.value


def _scaling(omega: float | None, order: int) -> Callable[[Extreme], Extreme] | None:
    if omega is None:
        return None
    factor = math.prod((omega,) * order)  # a power would raise where a product is inf, which is refused by name
    return lambda extreme: Extreme(extreme.value * factor, extreme.degrees)


def _within_turn(degrees: float) -> float:
    """Return an angle between −360° and 720° as one from 0 to 360."""
    return degrees + 360.0 if degrees < 0 else degrees - 360.0 if degrees >= 360.0 else degrees
