"""Motion of one cylinder's mechanism: dead centres, strokes, velocities, accelerations and their exact extremes."""

from __future__ import annotations

import math
from functools import cached_property, partial
from typing import Any, ClassVar

import numpy as np

from kurbel import crank_formulas as formulas
from kurbel.arrays import Array, Number
from kurbel.crank_angle import CrankAngle
from kurbel.machine.batch import taken, varies
from kurbel.machine.parts import RodPoint
from kurbel.mechanisms import Mechanism, Offer, PointMotion
from kurbel.numerics.arithmetic import bearing, every, where
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.numerics.pieces import Angles, Pieces, Samples, refined
from kurbel.quantity import Heading, value
from kurbel.solver.figures import AtAngles, Results, Rows, result, result_rows


class MotionColumns(AtAngles):
    """The motion of a mechanism at crank angles; its columns in SI, shaped as the angles.

    angle: crank angles (n,), or those at the nodes of pieces, (nodes, n); within: angles in degrees (n,) on the side of
    every jump that is meant: for pieces their middles. omega: rad/s, None where no speed is given; of_point: of the
    rod, whose path is wanted.

    rod_angle: sin ψ and cos ψ, None without a rod; posed: the crank angles with them; rod_slope: dψ/dφ, 0 without a
    rod; displacement: in m from the inner dead centre; slope, curvature: dx/dφ in m per radian and d²x/dφ²; of what
    only swings, of θ.
    """

    commands: ClassVar[tuple[str, ...]] = ("motion", "forces")

    z = value(
        "z",
        "ratio",
        "Displacement as a fraction of the stroke, or of the swing, from the inner dead centre",
        lambda state: (
            None if state.mechanism.turns else state.displacement / state.mechanism.stroke
        ),
        on_request=("motion", "forces"),
    )
    psi = value(
        "ψ",
        "angle",
        "Angle between connecting rod and stroke line",
        lambda state: None if state.rod_angle is None else bearing(*state.rod_angle),
    )
    x = value(
        "x",
        "length",
        "Displacement from the inner dead centre toward the shaft; of a quick-return ram, from mid-stroke",
        lambda state: state.coordinate if state.mechanism.slides else None,
    )
    c = value(
        "c",
        "velocity",
        "Velocity, positive toward the shaft; of a quick-return ram, positive on the working stroke",
        lambda state: (
            state.slope * state.omega
            if state.mechanism.slides and state.omega is not None
            else None
        ),
    )
    b = value(  # a power would raise where the product is inf
        "b",
        "acceleration",
        "Acceleration, positive in the direction of positive velocity",
        lambda state: (
            state.curvature * (state.omega * state.omega)
            if state.mechanism.slides and state.omega is not None
            else None
        ),
    )
    x_point = value(
        "x_Q",
        "length",
        "Coordinate of the point of the rod from the shaft axis, along φ = 0",
        lambda state: state.point and state.point.x,
        on_request=("forces",),
    )
    y_point = value(
        "y_Q",
        "length",
        "Coordinate of the point of the rod from the shaft axis, along φ = 90°",
        lambda state: state.point and state.point.y,
        on_request=("forces",),
    )
    v_point = value(
        "v_Q",
        "velocity",
        "Speed of the point of the rod",
        lambda state: (
            None if state.point is None or state.omega is None else state.point.speed * state.omega
        ),
        on_request=("forces",),
    )
    b_point = value(
        "b_Q",
        "acceleration",
        "Magnitude of the acceleration of the point of the rod",
        lambda state: (
            None
            if state.point is None or state.omega is None
            else state.point.acceleration * (state.omega * state.omega)
        ),
        on_request=("forces",),
    )

    def __init__(
        self,
        mechanism: Mechanism,
        angle: CrankAngle,
        within: Array,
        omega: Number | None,
        of_point: RodPoint | None = None,
    ) -> None:
        self.mechanism, self.within, self.omega = mechanism, within, omega
        self.phi = np.asarray(angle.degrees)
        self.rod_angle: Any = mechanism.rod_angle(angle)
        self.angle, self.posed = angle, angle._replace(rod=self.rod_angle)
        self._of_point = of_point

    @cached_property
    def direction(self) -> Array:
        """+1 on the outstroke and for what turns on, −1 on the return stroke."""
        mechanism = self.mechanism
        inner, outer = (0.0, 360.0) if mechanism.turns else mechanism.dead_centres()
        is_outstroke = np.mod(self.within - inner, 360.0) < outer - inner
        return np.where(is_outstroke, 1.0, -1.0)

    @property
    def coordinate(self) -> Number:
        """Coordinate of the output in m, of what only swings in radians."""
        return self.mechanism.coordinate(self.posed)

    @property
    def displacement(self) -> Number:
        """Displacement from the inner dead centre in m, of what only swings in radians."""
        passed: Number = self.coordinate - self.mechanism.start
        return passed

    @cached_property
    def slope(self) -> Number:
        """Slope dx/dφ in m per radian."""
        return self.mechanism.slope(self.posed)

    @cached_property
    def curvature(self) -> Number:
        """Curvature d²x/dφ² in m per radian squared."""
        return self.mechanism.curvature(self.posed)

    @cached_property
    def rod_slope(self) -> Number:
        """Slope dψ/dφ of the rod."""
        cos_psi = self.rod_angle[1] if self.rod_angle else 1.0
        return formulas.rod_slope(self.angle.cos, cos_psi, self.mechanism.lam)

    @cached_property
    def point(self) -> PointMotion | None:
        """Motion of the point of the rod."""
        of = self._of_point
        if of is None:
            return None
        return self.mechanism.point_at(self.angle, of.from_crank_pin(self.mechanism), of.across)


def _equal_strokes(motion: Motion) -> bool:
    """Return whether the strokes take equal times, so that nothing need be said of each."""
    return every(abs(motion.time_ratio - 1) <= 1e-12)


def _straight(motion: Motion) -> bool:
    """Return whether the dead centres are at 0 and 180 degrees, where everybody expects them."""
    return every(motion.phi_idc == 0) and every(motion.phi_odc == 180.0)


class Motion(Results):
    """What the mechanism does at a speed of rotation: key values in SI.

    speed: revolutions per second, or None: then velocities and accelerations are None. So is all that the mechanism
    does not have, as a stroke where nothing slides. count: of how many machines the numbers are, (machines,); None for
    one.
    """

    command = "motion"

    _motion = Heading("Motion")
    stroke = value("s", "length", "Stroke")
    phi_idc = value("φ_i", "angle", "Crank angle of the inner dead centre", repeats=_straight)
    phi_odc = value("φ_o", "angle", "Crank angle of the outer dead centre", repeats=_straight)
    phi_work = value(
        "φ_w",
        "angle",
        "Crank rotation during the outstroke (working stroke)",
        unless=_equal_strokes,
    )
    phi_return = value(
        "φ_r", "angle", "Crank rotation during the return stroke", unless=_equal_strokes
    )
    time_ratio = value(
        "t_w/t_r",
        "ratio",
        "Time ratio of the outstroke (working stroke) to the return stroke",
        lambda motion: motion.mechanism.time_ratio,
        unless=_equal_strokes,
    )
    v = value("v", "velocity", "Crank-pin speed")
    c_m = value("c_m", "velocity", "Mean piston speed 2 s n (R 290)")
    c_work_m = value(
        "c_a,m",
        "velocity",
        "Mean speed of the outstroke (working stroke, R p. 615)",
        unless=_equal_strokes,
    )
    c_return_m = value(
        "c_r,m", "velocity", "Mean speed of the return stroke (R p. 615)", unless=_equal_strokes
    )
    c_max = value("c_max", "velocity", "Largest velocity on the outstroke")
    c_min = value(
        "c_min",
        "velocity",
        "Largest velocity on the return stroke, negative",
        unless=lambda motion: _equal_strokes(motion) or motion.mechanism.quick_return,
    )
    c_work_max = value("c_a,max", "velocity", "Largest speed of the working stroke (R 304)")
    c_return_max = value("c_r,max", "velocity", "Largest speed of the return stroke (R 305)")
    b_max = value("b_max", "acceleration", "Largest acceleration")
    b_min = value("b_min", "acceleration", "Minimum acceleration (peak deceleration)")
    phi_b_zero = value(
        "φ_b=0", "angle", "Crank angles at which the acceleration passes zero", listed=True
    )
    phi_b_zero_book = value(
        "φ_b0=0",
        "angle",
        "The same by the acceleration of first order, cos φ + R/L cos 2φ = 0 (R 291)",
        lambda motion: motion.roots_of_the_book(),
        listed=True,
        on_request=("forces",),
        of_book=True,
    )

    def __init__(self, mechanism: Mechanism, speed: float | None, count: int | None = None) -> None:
        self.mechanism, self.speed = mechanism, speed
        self._count = count if varies(mechanism) else None
        self.omega: Any = None if speed is None else 2 * math.pi * speed

    @property
    def rows(self) -> Rows:
        """The rows that the motion of this mechanism may have."""
        return result_rows(Motion, self.mechanism.OFFERS, self.mechanism.KEY_OFFERS)

    @cached_property
    def answers(self) -> dict[str, object]:
        """The key values; None where there is none."""
        mechanism = self.mechanism
        answers = dict[str, object](phi_work=mechanism.phi_work, phi_return=mechanism.phi_return)
        if mechanism.has_dead_centres:
            inner, outer = mechanism.dead_centres()
            answers["phi_idc"] = _within_turn(inner)
            answers["phi_odc"] = _within_turn(outer)
        if self.omega is not None:
            answers["v"] = mechanism.crank * self.omega
        if not mechanism.slides:
            return answers

        pieces, (_, curvature, *_) = self._turn
        answers["stroke"] = mechanism.stroke
        answers["phi_b_zero"] = pieces.zeros(curvature).listed(self._count)
        if self.omega is None:
            return answers

        # both strokes together take the time of a turn
        mean = 2 * mechanism.stroke * self.speed
        answers["c_m"] = mean
        answers["c_work_m"] = mean * (180.0 / mechanism.phi_work)
        answers["c_return_m"] = mean * (180.0 / mechanism.phi_return)
        fastest, slowest = self._times_omega(self._searched[0], 1)
        answers["c_max"], answers["c_min"] = fastest, slowest
        if mechanism.quick_return:
            answers["c_work_max"] = fastest
            answers["c_return_max"] = Extreme(-slowest.value, slowest.degrees)
        answers["b_max"], answers["b_min"] = self._times_omega(self._searched[1], 2)
        return answers

    def roots_of_the_book(self) -> tuple[object, ...] | None:
        """Return where the acceleration of first order is zero, in degrees: cos φ = 2λ/(1 + √(1 + 8λ²)).

        None where the book has none, and with the infinite rod, of which it is exact.
        """
        mechanism, lam = self.mechanism, self.mechanism.lam
        factors = [
            offer.factor(mechanism, CrankAngle.of(0.0))
            for offer in mechanism.OFFERS
            if offer.quantity.id == "b_book"
        ]
        if not factors or factors[0] is None or every(lam == 0):
            return None
        first = np.degrees(np.arccos(2 * lam / (1 + np.sqrt(1 + 8 * lam * lam))))
        roots = np.broadcast_to(np.stack((first, 360.0 - first), axis=-1), (self._count or 1, 2))
        return Angles(np.repeat(np.arange(len(roots)), 2), roots.ravel()).listed(self._count)

    # the extremes over a turn

    @cached_property
    def _offers(self) -> list[Offer]:
        """Columns that the mechanism offers with extremes in `kurbel motion`, where it has them."""
        anywhere = CrankAngle.of(45.0)
        offers = []
        for offer in self.mechanism.OFFERS:
            is_searched = "motion" in offer.quantity.extremes
            if is_searched and offer.factor(self.mechanism, anywhere) is not None:
                offers.append(offer)
        return offers

    @cached_property
    def _turn(self) -> tuple[Pieces, Samples]:
        """One revolution, halved until all that the mechanism does is a polynomial on every piece, and its samples.

        These are dx/dφ, d²x/dφ², and what the mechanism offers besides, each (nodes, pieces).
        """

        def sampled(pieces: Pieces) -> Samples:
            mechanism = self.mechanism
            if self._count is not None:
                mechanism = taken(mechanism, pieces.machine)
            angle = CrankAngle.at_nodes(pieces)
            angle = angle._replace(rod=mechanism.rod_angle(angle))
            columns = [mechanism.slope(angle), mechanism.curvature(angle)]
            for offer in self._offers:
                factor = offer.factor(mechanism, angle)
                if factor is not None:
                    columns.append(factor)
            return [pieces.filled(column) for column in columns]

        count = self._count or 1
        centres = every_dead_centre(self.mechanism, count, 360.0)
        ends = Angles(np.repeat(np.arange(count), 2), centres.ravel())
        return refined(Pieces.between(ends, count, 360.0), sampled)

    @cached_property
    def _searched(self) -> list[Extremes]:
        """Largest and smallest values of what is sampled."""
        pieces, values = self._turn
        return pieces.extremes(values).each(partial(result, count=self._count))

    def _times_omega(self, extremes: Extremes, order: int) -> Extremes:
        """Return extremes over a turn times ω^order."""
        # a power would raise where a product is inf, which is refused by name
        scale = math.prod((self.omega,) * order)
        highest, lowest = extremes.largest, extremes.smallest
        return Extremes(
            Extreme(highest.value * scale, highest.degrees),
            Extreme(lowest.value * scale, lowest.degrees),
        )

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes over a turn of a column that the mechanism offers; None for what does not vary."""
        ids = [offer.quantity.id for offer in self._offers]
        if column not in ids:
            return None
        number = ids.index(column)
        order = self._offers[number].omega
        if order and self.omega is None:
            return None
        extremes = self._times_omega(self._searched[2 + number], order)
        highest, lowest = extremes.largest.value, extremes.smallest.value
        is_constant = every(highest - lowest <= 1e-14 * abs(highest))
        return None if is_constant else extremes


def _within_turn(degrees: Number) -> Number:
    """Return an angle from −360° to 720° as one from 0° to below 360°."""
    positive = where(degrees < 0, degrees + 360.0, degrees)
    return where(positive >= 360.0, positive - 360.0, positive)


def every_dead_centre(mechanism: Mechanism, count: int, cycle: float) -> Array:
    """Return the dead centres of machines in a cycle of so many degrees, (count, k), turn after turn."""
    centres = [np.broadcast_to(centre, count) for centre in mechanism.dead_centres()]
    of_first_turn = np.stack(centres, axis=1)
    turns: Array = of_first_turn[:, None, :] + np.arange(0.0, cycle, 360.0)[:, None]
    return turns.reshape(count, -1)
