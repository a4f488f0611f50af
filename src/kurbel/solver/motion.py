"""Motion of one cylinder's mechanism: dead centres, velocities, accelerations and their exact extremes."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms import Extreme, Mechanism
from kurbel.solver.grid import Extremes, Grid, Sampled, ascending, distinct_angles, extremes, roots, sign_changes
from kurbel.solver.jet import jet_angle

Array = NDArray[np.float64]


class Motion:
    """What the mechanism does at a speed of rotation. Attributes are named by the ids of the key values, in SI.

    speed: revolutions per second, or None: then velocities and accelerations are None.
    """

    def __init__(self, mechanism: Mechanism, speed: float | None) -> None:
        self.mechanism = mechanism
        self.speed = speed

    @cached_property
    def omega(self) -> float | None:
        """Angular velocity in rad/s."""
        return None if self.speed is None else 2 * math.pi * self.speed

    @cached_property
    def stroke(self) -> float:
        """s in m."""
        return self.mechanism.stroke

    @cached_property
    def phi_idc(self) -> float:
        """Inner dead centre in degrees."""
        return self.mechanism.dead_centres()[0]

    @cached_property
    def phi_odc(self) -> float:
        """Outer dead centre in degrees."""
        return self.mechanism.dead_centres()[1]

    @cached_property
    def time_ratio(self) -> float:
        """Time of the outstroke over that of the return stroke."""
        out = self.phi_odc - self.phi_idc
        return out / (360.0 - out)

    @cached_property
    def v(self) -> float | None:
        """Crank-pin speed Rω in m/s."""
        return None if self.omega is None else self.mechanism.crank * self.omega

    @cached_property
    def c_m(self) -> float | None:
        """Mean piston speed 2 s n in m/s, R 290."""
        return None if self.speed is None else 2 * self.stroke * self.speed

    @cached_property
    def _turn(self) -> Grid:
        """One revolution, cut at the landmarks of the mechanism only."""
        landmarks = (*self.mechanism.dead_centres(), *self.mechanism.landmarks(), *range(0, 361, 45))
        return Grid(ascending(np.array([angle if angle == 360 else angle % 360.0 for angle in landmarks])))

    @cached_property
    def _slope_extremes(self) -> Extremes:
        closed = self.mechanism.velocity_extremes()
        return _of_closed(closed) if closed else self._searched("slope")

    @cached_property
    def _curvature_extremes(self) -> Extremes:
        closed = self.mechanism.acceleration_extremes()
        return _of_closed(closed) if closed else self._searched("curvature")

    def _searched(self, quantity: str) -> Extremes:
        """Search an extreme of a kinematic quantity over one revolution by the roots of its slope."""

        def evaluate(degrees: Array, within: Array) -> dict[str, Sampled]:
            jet = getattr(self.mechanism, quantity)(jet_angle(degrees))
            return {quantity: Sampled(jet.value, jet.slope)}

        return extremes(self._turn, evaluate(self._turn.degrees, self._turn.within), evaluate)[quantity]

    @cached_property
    def c_max(self) -> Extreme | None:
        """Largest velocity toward the shaft in m/s."""
        return _times(self._slope_extremes.largest, self.omega)

    @cached_property
    def c_min(self) -> Extreme | None:
        """Largest velocity away from the shaft in m/s, negative."""
        return _times(self._slope_extremes.smallest, self.omega)

    @cached_property
    def b_max(self) -> Extreme | None:
        """Largest acceleration in m/s²."""
        return _times(self._curvature_extremes.largest, _square(self.omega))

    @cached_property
    def b_min(self) -> Extreme | None:
        """Smallest acceleration in m/s²."""
        return _times(self._curvature_extremes.smallest, _square(self.omega))

    @cached_property
    def phi_b_zero(self) -> tuple[float, ...]:
        """Crank angles in degrees at which the acceleration is zero."""
        closed = self.mechanism.velocity_extremes()
        if closed:
            return tuple(sorted(extreme.degrees for extreme in closed))
        brackets = sign_changes(self._turn, self._curvature_at(self._turn.degrees, self._turn.within))
        return distinct_angles(roots(self._curvature_at, brackets), 360.0)

    def _curvature_at(self, degrees: Array, within: Array) -> Array:
        return np.asarray(self.mechanism.curvature(CrankAngle.of(degrees)))


def _of_closed(found: tuple[Extreme, ...]) -> Extremes:
    return Extremes(max(found, key=lambda e: e.value), min(found, key=lambda e: e.value))


def _times(extreme: Extreme, factor: float | None) -> Extreme | None:
    return None if factor is None else Extreme(extreme.value * factor, extreme.degrees)


def _square(omega: float | None) -> float | None:
    return None if omega is None else omega * omega
