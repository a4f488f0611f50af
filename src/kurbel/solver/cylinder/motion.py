"""Motion of one cylinder's mechanism: dead centres, strokes, velocities, accelerations and their exact extremes."""

import math
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.crank_angle import CrankAngle
from kurbel.machine.variants import count_of, taken
from kurbel.mechanisms import Mechanism
from kurbel.numerics.arithmetic import every, where
from kurbel.numerics.cycles import cycles_of_turns
from kurbel.numerics.extreme import Extreme, largest, smallest
from kurbel.numerics.grid import Grid, ascending
from kurbel.numerics.search import Extremes, Sampled, extremes, zeros


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
    def stroke(self) -> Any:
        """s in m."""
        return self.mechanism.stroke if self.mechanism.slides else None

    @cached_property
    def phi_idc(self) -> Any:
        """Inner dead centre in degrees, from 0 to 360; None where there is none."""
        return _within_turn(self.mechanism.dead_centres()[0]) if self.mechanism.has_dead_centres else None

    @cached_property
    def phi_odc(self) -> Any:
        """Outer dead centre in degrees, from 0 to 360; None where there is none."""
        return _within_turn(self.mechanism.dead_centres()[1]) if self.mechanism.has_dead_centres else None

    @cached_property
    def phi_work(self) -> Any:
        """Crank rotation in degrees of the outstroke, or of the working stroke."""
        return self.mechanism.phi_work

    @cached_property
    def phi_return(self) -> Any:
        """Crank rotation in degrees of the return stroke."""
        return self.mechanism.phi_return

    @cached_property
    def time_ratio(self) -> Any:
        """Time of the outstroke (working stroke) over that of the return stroke."""
        return self.mechanism.time_ratio

    @cached_property
    def v(self) -> Any:
        """Crank-pin speed Rω in m/s."""
        return None if self.omega is None else self.mechanism.crank * self.omega

    @cached_property
    def c_m(self) -> Any:
        """Mean piston speed 2 s n in m/s, R 290."""
        return None if self.speed is None or self.stroke is None else 2 * self.stroke * self.speed

    @property
    def c_work_m(self) -> Any:
        """Mean speed in m/s of the outstroke, or of the working stroke: s n · 360°/φ_w (R p. 615)."""
        return None if self.c_m is None else self.c_m * (180.0 / self.phi_work)

    @property
    def c_return_m(self) -> Any:
        """Mean speed in m/s of the return stroke, positive."""
        return None if self.c_m is None else self.c_m * (180.0 / self.phi_return)

    @cached_property
    def _turn(self) -> Grid:
        """One revolution, cut at the landmarks of the mechanism only."""
        landmarks = (*self.mechanism.dead_centres(), *self.mechanism.landmarks())
        if self._count is not None:
            return cycles_of_turns(landmarks, 360.0, (), self._count)
        return Grid(ascending(np.array([*range(0, 361, 45), *(angle % 360.0 for angle in landmarks)])))

    @cached_property
    def _count(self) -> int | None:
        return count_of(self.mechanism)

    @property
    def _moves(self) -> bool:
        """Whether there is a velocity: something slides, at a speed that is known."""
        return self.mechanism.slides and self.omega is not None

    @cached_property
    def _velocity(self) -> Extremes:
        return self._times_omega(_of_closed(self.mechanism.velocity_extremes()) or self._searched["slope"], 1)

    @cached_property
    def _acceleration(self) -> Extremes:
        return self._times_omega(_of_closed(self.mechanism.acceleration_extremes()) or self._searched["curvature"], 2)

    @cached_property
    def _evaluate(self) -> "_Evaluated":
        """What is searched where the mechanism has no closed extremes, which are as exact and take a quarter of it."""
        return _Evaluated(self.mechanism, {"slope": lambda one, angle: one.slope(angle), "curvature": _curvature})

    @cached_property
    def _samples(self) -> dict[str, Sampled]:
        return self._evaluate.on(self._turn)

    @cached_property
    def _searched(self) -> dict[str, Extremes]:
        return extremes(self._turn, self._samples, self._evaluate)

    def _times_omega(self, found: Extremes, order: int) -> Extremes:
        """Return extremes over a turn times ω^order."""
        # a power would raise where a product is inf, which is refused by name
        scale = math.prod((0.0 if self.omega is None else self.omega,) * order)
        return Extremes(*(Extreme(one.value * scale, one.degrees) for one in found))

    @cached_property
    def _offered_extremes(self) -> dict[str, Extremes]:
        offers = [one for one in self.mechanism.OFFERS if "motion" in one.quantity.extremes]
        if self.omega is None or not offers:
            return {}
        evaluate = _Evaluated(self.mechanism, {one.quantity.id: one.factor for one in offers})
        found = extremes(self._turn, evaluate.on(self._turn), evaluate)
        return {one.quantity.id: self._times_omega(found[one.quantity.id], len(one.times)) for one in offers}

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes over a turn of a column that the mechanism offers; None for what does not vary."""
        found = self._offered_extremes.get(column)
        return None if found is None or every(found.largest.value == found.smallest.value) else found

    def offered(self, id: str) -> Any:
        """Return a key value that the mechanism offers."""
        return self.mechanism.offered(id, self)

    @property
    def equal_strokes(self) -> bool:
        """Whether the strokes take equal times, so that nothing need be said of each."""
        return every(abs(self.time_ratio - 1) <= 1e-12)

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
    def phi_b_zero(self) -> tuple[Any, ...] | None:
        """Crank angles in degrees at which the acceleration is zero."""
        if not self.mechanism.slides:
            return None
        closed = self.mechanism.velocity_extremes()
        if closed:
            angles = np.sort(np.stack([extreme.degrees for extreme in closed], axis=-1))
            return tuple(angles.tolist() if angles.ndim == 1 else map(tuple, angles.tolist()))
        samples, alone = {"curvature": self._samples["curvature"]}, {"curvature": _curvature}
        found = zeros(self._turn, samples, _Evaluated(self.mechanism, alone))["curvature"]
        return tuple(found.tolist()) if self._count is None else found.of_each(self._count)


Kinematic = Callable[[Any, CrankAngle], Any]
"""What a mechanism does at a crank angle, by ω or ω²."""


def _curvature(mechanism: Mechanism, angle: CrankAngle) -> Any:
    return mechanism.curvature(angle)


class _Evaluated:
    """Functions of the mechanism by name, with their slopes; see `search.Evaluate`."""

    def __init__(self, mechanism: Mechanism, functions: Mapping[str, Kinematic]) -> None:
        self.mechanism = mechanism
        self.functions = functions

    def __call__(self, degrees: Array, within: Array) -> dict[str, Sampled]:
        angle = CrankAngle.of(degrees).jets
        return {
            name: Sampled.of(function(self.mechanism, angle), degrees.shape)
            for name, function in self.functions.items()
        }

    def of(self, variant: Indices) -> "_Evaluated":
        """Return the same of these variants."""
        return _Evaluated(taken(self.mechanism, variant), self.functions)

    def on(self, grid: Grid) -> dict[str, Sampled]:
        """Return them at the nodes of a grid."""
        asked = self if grid.variant is None else self.of(grid.variant[:, None])
        return asked(grid.degrees, grid.within)


def _of_closed(found: tuple[Extreme, ...]) -> Extremes | None:
    return Extremes(largest(*found), smallest(*found)) if found else None


def _within_turn(degrees: Any) -> Any:
    """Return an angle between −360° and 720° as one from 0 to 360."""
    return where(degrees < 0, degrees + 360.0, where(degrees >= 360.0, degrees - 360.0, degrees))
