"""Motion of one cylinder's mechanism: dead centres, strokes, velocities, accelerations and their exact extremes."""

from __future__ import annotations

import math
from functools import cached_property, partial
from typing import Any, ClassVar

import numpy as np

from kurbel import crank_formulas as formulas
from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.machine.batch import taken
from kurbel.machine.parts import RodPoint
from kurbel.mechanisms import Mechanism, Offer, PointMotion
from kurbel.numerics.arithmetic import bearing, every, where
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.numerics.pieces import Angles, Pieces, refined
from kurbel.quantity import column, key_value
from kurbel.solver.figures import AtAngles, Results, Rows, Searched, rows_of, told


class MotionColumns(AtAngles):
    """The motion of a mechanism at crank angles; its columns in SI, shaped as the angles.

    angle: crank angles (n,), or those at the nodes of pieces, (nodes, n); within: angles in degrees (n,) on the side of
    every jump that is meant: for pieces their middles. omega: rad/s, None where no speed is given; point: of the rod,
    whose path is wanted.
    """

    commands: ClassVar[tuple[str, ...]] = ("motion", "forces")

    def __init__(
        self, mechanism: Mechanism, angle: CrankAngle, within: Array, omega: Any, point: RodPoint | None = None
    ) -> None:
        self.mechanism, self.angle, self.within, self.omega, self.point = mechanism, angle, within, omega, point
        self.phi = angle.degrees

    @cached_property
    def rod_angle(self) -> Any:
        """sin ψ and cos ψ; None without a rod."""
        return self.mechanism.rod_angle(self.angle)

    @cached_property
    def posed(self) -> CrankAngle:
        """The crank angles with what the mechanism's rod does there."""
        return self.angle._replace(rod=self.rod_angle)

    @cached_property
    def rod_slope(self) -> Any:
        """dψ/dφ = λ cos φ/cos ψ; 0 without a rod."""
        _, cos_psi = self.rod_angle or (0.0, 1.0)
        return formulas.rod_slope(self.angle.cos, cos_psi, self.mechanism.lam)

    @cached_property
    def _coordinate(self) -> Any:
        return self.mechanism.coordinate(self.posed)

    @cached_property
    def way(self) -> Any:
        """Displacement in m from the inner dead centre, even where x counts from elsewhere: for the chambers."""
        return self._coordinate - self.mechanism.start

    @cached_property
    def slope(self) -> Any:
        """dx/dφ in m per radian; of what only swings, dθ/dφ."""
        return self.mechanism.slope(self.posed)

    @cached_property
    def curvature(self) -> Any:
        """d²x/dφ² in m per radian squared; of what only swings, d²θ/dφ²."""
        return self.mechanism.curvature(self.posed)

    @cached_property
    def direction(self) -> Array:
        """+1 on the outstroke, −1 on the return stroke; +1 for what turns on and on."""
        if self.mechanism.turns:
            return np.ones_like(self.within)
        inner, outer = self.mechanism.dead_centres()
        return np.where(np.mod(self.within - inner, 360.0) < outer - inner, 1.0, -1.0)

    @column("z", "ratio", on_request=("motion", "forces"))
    def z(self) -> Any:
        """Fraction of the stroke, or of the swing, from the inner dead centre."""
        one = self.mechanism
        return None if one.turns else (self._coordinate - one.start) / one.stroke

    @column("ψ", "angle")
    def psi(self) -> Any:
        """Angle between connecting rod and stroke line."""
        return None if self.rod_angle is None else bearing(*self.rod_angle)

    @column("x", "length")
    def x(self) -> Any:
        """Displacement from the inner dead centre toward the shaft; of a quick-return ram, from mid-stroke."""
        return self._coordinate if self.mechanism.slides else None

    @column("c", "velocity")
    def c(self) -> Any:
        """Velocity, positive toward the shaft; of a quick-return ram, on the working stroke."""
        return self.slope * self.omega if self.mechanism.slides and self.omega is not None else None

    @column("b", "acceleration")
    def b(self) -> Any:
        """Acceleration, positive as the velocity."""
        w = self.omega if self.mechanism.slides else None
        return None if w is None else self.curvature * (w * w)  # a power would raise where the product is inf

    # a point of the rod

    @cached_property
    def _point(self) -> PointMotion | None:
        point, mechanism = self.point, self.mechanism
        return mechanism.point_at(self.angle, point.from_crank_pin(mechanism), point.across) if point else None

    @column("x_Q", "length", on_request=("forces",))
    def x_point(self) -> Any:
        """Place of the point of the rod from the shaft axis, along φ = 0."""
        return self._point and self._point.x

    @column("y_Q", "length", on_request=("forces",))
    def y_point(self) -> Any:
        """Place of the point of the rod from the shaft axis, along φ = 90°."""
        return self._point and self._point.y

    @column("v_Q", "velocity", on_request=("forces",))
    def v_point(self) -> Any:
        """Speed of the point of the rod."""
        return None if self._point is None or self.omega is None else self._point.speed * self.omega

    @column("b_Q", "acceleration", on_request=("forces",))
    def b_point(self) -> Any:
        """Magnitude of the acceleration of the point of the rod."""
        w = self.omega
        return None if self._point is None or w is None else self._point.acceleration * (w * w)


class Motion(Results):
    """What the mechanism does at a speed of rotation: key values in SI.

    speed: revolutions per second, or None: then velocities and accelerations are None. So is all that the mechanism
    does not have, as a stroke where nothing slides. count: of how many machines the numbers are, (machines,); None for
    one.
    """

    command = "motion"

    def __init__(self, mechanism: Mechanism, speed: Any, count: int | None = None) -> None:
        self.mechanism, self.speed, self._count = mechanism, speed, count

    @property
    def rows(self) -> Rows:
        """The rows that the motion of this mechanism may have."""
        return rows_of(Motion, self.mechanism.OFFERS, self.mechanism.KEY_OFFERS)

    @property
    def equal_strokes(self) -> bool:
        """Whether the strokes take equal times, so that nothing need be said of each."""
        return every(abs(self.time_ratio - 1) <= 1e-12)

    @cached_property
    def omega(self) -> float | None:
        """Angular velocity in rad/s."""
        return None if self.speed is None else 2 * math.pi * self.speed

    @key_value("s", "length")
    def stroke(self) -> Any:
        """Stroke."""
        return self.mechanism.stroke if self.mechanism.slides else None

    @key_value("φ_i", "angle")
    def phi_idc(self) -> Any:
        """Crank angle of the inner dead centre."""
        return _within_turn(self.mechanism.dead_centres()[0]) if self.mechanism.has_dead_centres else None

    @key_value("φ_o", "angle")
    def phi_odc(self) -> Any:
        """Crank angle of the outer dead centre."""
        return _within_turn(self.mechanism.dead_centres()[1]) if self.mechanism.has_dead_centres else None

    @key_value("φ_w", "angle", unless=lambda motion: motion.equal_strokes)
    def phi_work(self) -> Any:
        """Crank rotation of the outstroke (working stroke)."""
        return self.mechanism.phi_work

    @key_value("φ_r", "angle", unless=lambda motion: motion.equal_strokes)
    def phi_return(self) -> Any:
        """Crank rotation of the return stroke."""
        return self.mechanism.phi_return

    @key_value("t_w/t_r", "ratio", unless=lambda motion: motion.equal_strokes)
    def time_ratio(self) -> Any:
        """Time of the outstroke (working stroke) over that of the return stroke."""
        return self.mechanism.time_ratio

    @key_value("v", "velocity")
    def v(self) -> Any:
        """Crank-pin speed."""
        return None if self.omega is None else self.mechanism.crank * self.omega

    @key_value("c_m", "velocity")
    def c_m(self) -> Any:
        """Mean piston speed 2 s n (R 290)."""
        return None if self.speed is None or self.stroke is None else 2 * self.stroke * self.speed

    @key_value("c_a,m", "velocity", unless=lambda motion: motion.equal_strokes)
    def c_work_m(self) -> Any:
        """Mean speed of the outstroke (of work, R p. 615).

        s n · 360°/φ_w.
        """
        return None if self.c_m is None else self.c_m * (180.0 / self.phi_work)

    @key_value("c_r,m", "velocity", unless=lambda motion: motion.equal_strokes)
    def c_return_m(self) -> Any:
        """Mean speed of the return stroke (R p. 615)."""
        return None if self.c_m is None else self.c_m * (180.0 / self.phi_return)

    # the extremes over a turn

    @cached_property
    def _turn(self) -> tuple[Pieces, Array]:
        """One revolution, halved until all that the mechanism does is a polynomial on every piece, and its samples."""
        count = self._count or 1
        centres = every_dead_centre(self.mechanism, count, 360.0)
        turn = Pieces.between(Angles(np.repeat(np.arange(count), 2), centres.ravel()), count, 360.0)
        return refined(turn, self._sampled)

    def _sampled(self, pieces: Pieces) -> Array:
        """Return velocity and acceleration factor, and what is offered besides, at the nodes, (q, nodes, pieces)."""
        mechanism = self.mechanism if self._count is None else taken(self.mechanism, pieces.machine)
        angle = CrankAngle.at_nodes(pieces)
        found = (
            mechanism.slope(angle),
            mechanism.curvature(angle),
            *(one.factor(mechanism, angle) for one in self._offers),
        )
        return np.stack([np.broadcast_to(one, pieces.degrees.shape) for one in found if one is not None])

    @cached_property
    def _offers(self) -> list[Offer]:
        """Columns that the mechanism offers with extremes in `kurbel motion`, where it has them."""
        here = CrankAngle.of(45.0)
        declared = [one for one in self.mechanism.OFFERS if "motion" in one.quantity.extremes]
        return [one for one in declared if one.factor(self.mechanism, here) is not None]

    @cached_property
    def _searched(self) -> list[Extremes]:
        """Largest and smallest values of what is sampled."""
        pieces, values = self._turn
        return pieces.extremes(values).each(partial(told, count=self._count))

    def _times_omega(self, found: Extremes, order: int) -> Extremes:
        """Return extremes over a turn times ω^order."""
        # a power would raise where a product is inf, which is refused by name
        scale = math.prod((0.0 if self.omega is None else self.omega,) * order)
        return Extremes(*(Extreme(one.value * scale, one.degrees) for one in found))

    @cached_property
    def _velocity(self) -> Extremes | None:
        """Of the velocity; None where nothing slides, or at no known speed."""
        if not self.mechanism.slides or self.omega is None:
            return None
        return self._times_omega(self._searched[0], 1)

    @cached_property
    def _acceleration(self) -> Extremes | None:
        """Of the acceleration."""
        if not self.mechanism.slides or self.omega is None:
            return None
        return self._times_omega(self._searched[1], 2)

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes over a turn of a column that the mechanism offers; None for what does not vary."""
        number = next((n for n, one in enumerate(self._offers) if one.quantity.id == column), None)
        if number is None or self.omega is None:
            return None
        found = self._times_omega(self._searched[2 + number], self._offers[number].omega)
        return None if every(found.largest.value - found.smallest.value <= 1e-14 * abs(found.largest.value)) else found

    @key_value("c_max", "velocity")
    def c_max(self) -> Extreme | None:
        """Largest velocity on the outstroke."""
        return self._velocity and self._velocity.largest

    @key_value("c_min", "velocity", unless=lambda motion: motion.equal_strokes or motion.mechanism.quick_return)
    def c_min(self) -> Extreme | None:
        """Largest velocity on the return stroke, negative."""
        return self._velocity and self._velocity.smallest

    @key_value("c_a,max", "velocity")
    def c_work_max(self) -> Extreme | None:
        """Largest speed of the working stroke (R 304)."""
        return self.c_max if self.mechanism.quick_return else None

    @key_value("c_r,max", "velocity")
    def c_return_max(self) -> Extreme | None:
        """Largest speed of the return stroke (R 305)."""
        if not self.mechanism.quick_return or self.c_min is None:
            return None
        return Extreme(-self.c_min.value, self.c_min.degrees)

    @key_value("b_max", "acceleration")
    def b_max(self) -> Extreme | None:
        """Largest acceleration."""
        return self._acceleration and self._acceleration.largest

    @key_value("b_min", "acceleration")
    def b_min(self) -> Extreme | None:
        """Smallest acceleration: the largest deceleration, negative."""
        return self._acceleration and self._acceleration.smallest

    @key_value("φ_b=0", "angle", listed=True)
    def phi_b_zero(self) -> tuple[Any, ...] | None:
        """Crank angles at which the acceleration passes zero."""
        if not self.mechanism.slides:
            return None
        pieces, (_, curvature, *_) = self._turn
        return self._angles(pieces.zeros(curvature))

    @key_value("φ_b0=0", "angle", listed=True, on_request=("forces",))
    def phi_b_zero_book(self) -> tuple[Any, ...] | None:
        """The same by the acceleration of first order, cos φ + R/L cos 2φ = 0 (R 291).

        None where the book has no such acceleration, and with the infinite rod, of which it is exact.
        """
        offer = next((one for one in self.mechanism.OFFERS if one.quantity.id == "b_book"), None)
        if offer is None or offer.factor(self.mechanism, CrankAngle.of(0.0)) is None or every(self.mechanism.lam == 0):
            return None
        turn = self._turn[0]
        mechanism = self.mechanism if self._count is None else taken(self.mechanism, turn.machine)
        return self._angles(turn.zeros(np.asarray(offer.factor(mechanism, CrankAngle.at_nodes(turn)))))

    def _angles(self, found: Angles) -> tuple[Any, ...]:
        """Return crank angles in degrees, of many machines a tuple of each."""
        if self._count is None:
            return tuple(found.degrees.tolist())
        return tuple(tuple(one.tolist()) for one in found.of_each(self._count))

    of_the_mechanism = Searched()


def every_dead_centre(mechanism: Mechanism, count: int, cycle: float) -> Array:
    """Return the dead centres of machines in a cycle of so many degrees, (count, k), turn after turn."""
    each = np.stack([np.broadcast_to(one, count) for one in mechanism.dead_centres()], axis=1)
    turns: Array = each[:, None, :] + np.arange(0.0, cycle, 360.0)[:, None]
    return turns.reshape(count, -1)


def _within_turn(degrees: Any) -> Any:
    """Return an angle between −360° and 720° as one from 0 to 360."""
    return where(degrees < 0, degrees + 360.0, where(degrees >= 360.0, degrees - 360.0, degrees))
