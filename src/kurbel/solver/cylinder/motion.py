"""Motion of one cylinder's mechanism: dead centres, strokes, velocities, accelerations and their exact extremes."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property, partial
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
    does not have, as a stroke where nothing slides. What it offers itself is `offered(id)`.
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
    def phi_idc(self) -> float | None:
        """Inner dead centre in degrees, from 0 to 360; None where there is none."""
        return _within_turn(self.mechanism.dead_centres()[0]) if self.mechanism.has_dead_centres else None

    @cached_property
    def phi_odc(self) -> float | None:
        """Outer dead centre in degrees, from 0 to 360; None where there is none."""
        return _within_turn(self.mechanism.dead_centres()[1]) if self.mechanism.has_dead_centres else None

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
    def v(self) -> float | None:
        """Crank-pin speed Rω in m/s."""
        return None if self.omega is None else self.mechanism.crank * self.omega

    @cached_property
    def c_m(self) -> float | None:
        """Mean piston speed 2 s n in m/s, R 290."""
        return None if self.speed is None or self.stroke is None else 2 * self.stroke * self.speed

    @property
    def c_work_m(self) -> float | None:
        """Mean speed in m/s of the outstroke, or of the working stroke: s n · 360°/φ_w (R p. 617)."""
        return None if self.c_m is None else self.c_m * (180.0 / self.phi_work)

    @property
    def c_return_m(self) -> float | None:
        """Mean speed in m/s of the return stroke, positive."""
        return None if self.c_m is None else self.c_m * (180.0 / self.phi_return)

    @cached_property
    def _turn(self) -> Grid:
        """One revolution, cut at the landmarks of the mechanism only."""
        landmarks = (*self.mechanism.dead_centres(), *self.mechanism.landmarks(), *range(0, 361, 45))
        return Grid(ascending(np.array([angle if angle == 360 else angle % 360.0 for angle in landmarks])))

    @property
    def _moves(self) -> bool:
        """Whether there is a velocity: something slides, at a speed that is known."""
        return self.mechanism.slides and self.omega is not None

    @cached_property
    def _velocity(self) -> Extremes:
        return self._extremes(self.mechanism.slope, 1, self.mechanism.velocity_extremes())

    @cached_property
    def _acceleration(self) -> Extremes:
        return self._extremes(self.mechanism.curvature, 2, self.mechanism.acceleration_extremes())

    def _extremes(
        self, function: Callable[[CrankAngle], Any], order: int, closed: tuple[Extreme, ...] = ()
    ) -> Extremes:
        """Return the extremes over a turn of a function of the crank angle times ω^order; closed: where it has them."""
        # a power would raise where a product is inf, which is refused by name
        scale = math.prod((self.omega or 0.0,) * order)
        found = _of_closed(closed) if closed else self._searched(function)
        return Extremes(*(Extreme(one.value * scale, one.degrees) for one in found))

    def _searched(self, function: Callable[[CrankAngle], Any]) -> Extremes:
        """Search the extremes of a kinematic quantity over one revolution by the roots of its slope."""
        evaluate = _evaluated(function)
        return extremes(self._turn, evaluate(self._turn.degrees, self._turn.within), evaluate)["it"]

    @cached_property
    def _offered_extremes(self) -> dict[str, Extremes]:
        return {
            offer.quantity.id: self._extremes(partial(offer.factor, self.mechanism), len(offer.times))
            for offer in self.mechanism.OFFERS
            if "motion" in offer.quantity.extremes and self.omega is not None
        }

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes over a turn of a column that the mechanism offers; None for what does not vary."""
        found = self._offered_extremes.get(column)
        return None if found is None or found.largest.value == found.smallest.value else found

    def offered(self, id: str) -> Any:
        """Return a key value that the mechanism offers."""
        return self.mechanism.offered(id, self)

    @property
    def equal_strokes(self) -> bool:
        """Whether the strokes take equal times, so that nothing need be said of each."""
        return abs(self.time_ratio - 1) <= 1e-12

    @property
    def has_no_c_min(self) -> bool:
        """Whether the return stroke is as fast as the outstroke, or its speed is told as `c_return_max`."""
        return self.equal_strokes or self.mechanism.quick_return

    @cached_property
    def c_max(self) -> Extreme | None:
        """Largest velocity on the outstroke, of a piston toward the shaft, in m/s."""
        return self._velocity.largest if self._moves else None

    @cached_property
    def c_min(self) -> Extreme | None:
        """Largest velocity on the return stroke in m/s, negative."""
        return self._velocity.smallest if self._moves else None

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
        return self._acceleration.largest if self._moves else None

    @cached_property
    def b_min(self) -> Extreme | None:
        """Smallest acceleration in m/s²."""
        return self._acceleration.smallest if self._moves else None

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


def _within_turn(degrees: float) -> float:
    """Return an angle between −360° and 720° as one from 0 to 360."""
    return degrees + 360.0 if degrees < 0 else degrees - 360.0 if degrees >= 360.0 else degrees
