"""Everything that can be said of one cylinder at given crank angles, each quantity computed when it is asked for."""

from functools import cached_property, reduce
from operator import mul
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.declared.quantity import by_id
from kurbel.mechanisms.kinds import every_quantity
from kurbel.numerics.arithmetic import bearing, some
from kurbel.numerics.jet import Jet, once_each, value_of
from kurbel.solver.cylinder import chamber, guide, rod_point
from kurbel.solver.cylinder.inside import Inside
from kurbel.solver.cylinder.rod_load import rod_load

if TYPE_CHECKING:
    from kurbel.solver.cylinder.drive import Drive
    from kurbel.solver.cylinder.pins import Rubbing
    from kurbel.solver.pressure import Pressure


class State:
    """A cylinder at crank angles (n,); its attributes are named by the ids of the columns, in SI, each of shape (n,).

    angle: the crank angles; with jets for sine and cosine every quantity becomes a jet with its slope by φ.
    within: angles in degrees (n,) that say on which side of a jump each one is meant, or what is known of them; the
    angles themselves mean the side just after it.
    A quantity that the machine does not have is None. What the mechanism offers is one of them.
    """

    def __init__(self, drive: "Drive", angle: CrankAngle, within: Array | Inside | None = None) -> None:
        self.drive = drive
        self.angle = angle
        if within is None:
            within = Inside.at(drive, angle)
        self.inside = within if isinstance(within, Inside) else Inside(drive, once_each(within))

    guide_sense = cached_property(guide.guide_sense)
    N = cached_property(guide.guide_force)
    crosshead_drag = cached_property(guide.crosshead_drag)
    crosshead_power = cached_property(guide.crosshead_power)
    p_guide = cached_property(guide.shoe_pressure)
    wear = cached_property(guide.wear)
    P_gas = cached_property(chamber.gas_force)
    P_driving = cached_property(chamber.driving_force)
    V = cached_property(chamber.head_volume)
    V_crank = cached_property(chamber.crank_volume)
    dV = cached_property(chamber.head_volume_change)
    dp_head = cached_property(chamber.head_rise)
    dp_crank = cached_property(chamber.crank_rise)
    point = cached_property(rod_point.motion_of_point)
    x_point = cached_property(rod_point.place_along)
    y_point = cached_property(rod_point.place_across)
    v_point = cached_property(rod_point.speed)
    b_point = cached_property(rod_point.acceleration)

    def __getattr__(self, id: str) -> Any:
        """Return a column that the mechanism offers; None for one that only others do."""
        if id.startswith("_") or "drive" not in vars(self):  # pickle and copy ask before the fields are there
            raise AttributeError(f"no column is called {id}")
        offer = next((one for one in self.drive.mechanism.OFFERS if one.quantity.id == id), None)
        if offer is None:
            if id not in by_id(*every_quantity().all_columns):
                raise AttributeError(f"no column is called {id}")
            return None
        times = [getattr(self, name) for name in offer.times]
        factor = offer.factor(self.drive.mechanism, self._posed)
        if factor is None or any(one is None for one in times):
            return None
        return reduce(mul, times) * factor if times else factor

    @property
    def omega(self) -> Any:
        """Angular velocity in rad/s."""
        return self.drive.omega

    @property
    def phi(self) -> Array:
        """Crank angle in degrees."""
        return self.angle.degrees  # type: ignore[no-any-return]

    @cached_property
    def _posed(self) -> CrankAngle:
        """The crank angles with what the mechanism's rod does there."""
        return self.angle._replace(rod=self.rod_angle)

    @cached_property
    def _plain(self) -> CrankAngle:
        """The same without the slopes of jets."""
        degrees, sin, cos, rod = self._posed
        return CrankAngle(degrees, value_of(sin), value_of(cos), rod and (value_of(rod[0]), value_of(rod[1])))

    @property
    def _is_jet(self) -> bool:
        return isinstance(self.angle.sin, Jet)

    @cached_property
    def _coordinate(self) -> Any:
        value = self.drive.mechanism.coordinate(self._plain)
        return Jet(value, self.slope.value) if self._is_jet else value

    @property
    def x(self) -> Any:
        """Displacement in m; of what only swings, None."""
        return self._coordinate if self.drive.mechanism.slides else None

    @cached_property
    def way(self) -> Any:
        """Displacement in m from the inner dead centre, wherever the book counts x from: what the chambers see."""
        return self.x - self.drive.mechanism.start

    @cached_property
    def slope(self) -> Any:
        """dx/dφ in m per radian; of what only swings, dθ/dφ."""
        value = self.drive.mechanism.slope(self._plain)
        return Jet(value, self.curvature.value) if self._is_jet else value

    @cached_property
    def curvature(self) -> Any:
        """d²x/dφ² in m per radian squared; of what only swings, d²θ/dφ²."""
        return self.drive.mechanism.curvature(self._posed)

    @cached_property
    def c(self) -> Any:
        """Velocity in m/s."""
        return self.slope * self.omega if self.drive.mechanism.slides and self.omega is not None else None

    @cached_property
    def b(self) -> Any:
        """Acceleration in m/s² at uniform rotation."""
        w = self.omega if self.drive.mechanism.slides else None
        return None if w is None else self.curvature * (w * w)  # a power would raise where the product is inf

    @cached_property
    def rod_angle(self) -> Any:
        """sin ψ and cos ψ; None without a rod."""
        return self.drive.mechanism.rod_angle(self.angle)

    @cached_property
    def psi(self) -> Any:
        """Rod angle in degrees."""
        return None if self.rod_angle is None else bearing(*self.rod_angle)

    @cached_property
    def z(self) -> Any:
        """What of the stroke, or of the swing, is passed from the inner dead centre; of what turns on, None."""
        one = self.drive.mechanism
        return None if one.turns else (self._coordinate - one.start) / one.stroke

    @property
    def direction(self) -> Array:
        """+1 on the outstroke, −1 on the return stroke; +1 for what turns on and on."""
        return self.inside.direction

    def pressure(self, end: "Pressure") -> Any:
        """Return the gauge pressure in Pa at an end of a piston."""
        return end(self.z, self.phi, self.inside.held(end))

    @cached_property
    def p_head(self) -> Any:
        """Pressure at the head end of the cylinder's own piston in Pa, counted as in the machine file."""
        gas = self.drive.own_gas
        return self.pressure(gas.head) + gas.base if gas and gas.head else None

    @cached_property
    def p_crank(self) -> Any:
        """Pressure at the crank end of the cylinder's own piston in Pa, counted as in the machine file."""
        gas = self.drive.own_gas
        return self.pressure(gas.crank) + gas.base if gas and gas.crank else None

    @property
    def P_gas_book(self) -> Any:
        """The same with both areas of a piston alike, in N, R 297."""
        with_equal_areas = [gas.force(self.pressure, alike=True) for gas in self.drive.gas]
        return sum(with_equal_areas) if with_equal_areas else None

    @cached_property
    def P_inertia(self) -> Any:
        """−m b in N, R 298."""
        return -self.drive.mass * self.b if self.drive.has_inertia else None

    @cached_property
    def P_weight(self) -> Any:
        """Weight along the stroke line in N, positive toward the shaft."""
        weight = self.drive.weight
        return np.full_like(self.phi, weight[0]) if weight else None

    @cached_property
    def _resistance(self) -> Any:
        """What the output works against, in N or N m, against the motion."""
        resistance = self.drive.resistance
        if resistance is None:
            return None
        working = self.direction == (1.0 if self.drive.mechanism.works_outward else -1.0)
        return -self.direction * np.where(working, resistance.work, resistance.back)

    @property
    def P_ram(self) -> Any:
        """Force on the ram against its motion in N."""
        return self._resistance if self.drive.mechanism.slides else None

    @property
    def M_out(self) -> Any:
        """Moment on what swings or turns against its motion in N m."""
        return None if self.drive.mechanism.slides else self._resistance

    @cached_property
    def P_start(self) -> Any:
        """Piston force without inertia in N: starting and slow running."""
        return _sum(_sum(self.P_gas, self.P_weight), self.P_ram)

    @cached_property
    def P(self) -> Any:
        """Force at the crosshead along the stroke line in N: gas, inertia, weight, and what the ram works against."""
        return _sum(self.P_inertia, self.P_start)

    @cached_property
    def P_rod(self) -> Any:
        """Rod load in N: force at the crosshead pin of all but the connecting rod and friction (API 618)."""
        return rod_load(self)

    @cached_property
    def P_piston_rod(self) -> Any:
        """The same without the crosshead, in N: force at the end of the piston rod; None where its mass is unknown."""
        masses = self.drive.cylinder.masses
        return None if not masses or masses.crosshead is None else rod_load(self, without=masses.crosshead)

    @cached_property
    def after_steady_friction(self) -> Any:
        """Force left for crosshead and rod after friction that is the same over the stroke, in N."""
        steady = self.drive.steady_friction
        return self.P - self.direction * steady if some(steady != 0) else self.P

    @cached_property
    def rubbing(self) -> "Rubbing | None":
        """Moments of friction in pins and journals in N m; None where there is none."""
        friction = self.drive.pin_friction if self.inside.rubs else None
        if friction is None or self.P is None:
            return None
        return friction.moments(self.unrubbed)

    @property
    def unrubbed(self) -> "State":
        """The state as it would be if pins and journals did not rub: the loads that make them rub."""
        return State(self.drive, self.angle, self.inside.unrubbed)

    @cached_property
    def rod_side(self) -> Any:
        """Side force in N of the couples on the rod: of an exact one, and of the friction in its pins; else None."""
        exact = self.drive.rod.side_force(self.rod_angle, self.angle) if self.drive.rod else None
        return exact if self.rubbing is None else _sum(exact, self._pin_side)

    @property
    def _pin_side(self) -> Any:
        """Side force in N of the friction in both pins of the rod."""
        assert self.rubbing is not None
        return self.rubbing.couple / self.drive.mechanism.rod_length / self.rod_angle[1]

    @cached_property
    def F_friction(self) -> Any:
        """All friction along the stroke line in N, positive toward the shaft."""
        if self.P is None or not self.drive.has_friction:
            return None
        return (self.crosshead_drag + self.drive.steady_friction) * -self.direction

    @cached_property
    def along_rod(self) -> Any:
        """The part of the rod force along the stroke line in N: the piston force less all friction."""
        friction = self.F_friction
        return self.P if friction is None else self.P + friction

    @cached_property
    def S(self) -> Any:
        """Rod force in N, compression positive, R 300; of an exact rod, between the masses at its ends."""
        if self.P is None or self.rod_angle is None:
            return None
        push = self.along_rod / self.rod_angle[1]
        return push if self.rod_side is None else push - self.rod_side * self.rod_angle[0]

    @cached_property
    def S_crosshead(self) -> Any:
        """Force along an exact rod at the crosshead pin in N."""
        if self.P is None or not self.drive.rod:
            return None
        b = self.b if self.drive.has_inertia else None
        return self.drive.rod.at_crosshead(self.rod_angle, self.along_rod, self.N - self.drive.guide_weight, b)

    @cached_property
    def S_crank(self) -> Any:
        """Force along an exact rod at the crank pin in N."""
        if self.P is None or not self.drive.rod:
            return None
        return self.drive.rod.at_crank(self.rod_angle, self.angle, self.T, self.D)

    @cached_property
    def D(self) -> Any:
        """Radial force at the crank pin in N, positive toward the shaft, R 302."""
        radial = None if self.P is None else self.drive.mechanism.radial(self._posed)
        if radial is None:
            return None
        push = self.along_rod * radial
        if self.drive.rod is not None and self.rod_angle is not None:
            push = push + self.drive.rod.radial(self.rod_angle, self.angle)
        return push if self.rubbing is None else push + self.angle.sin * self._pin_side

    @property
    def _output(self) -> Any:
        """What reaches the crank of the force, or of the moment, at the output."""
        return self.along_rod if self.drive.mechanism.slides else self.M_out

    @cached_property
    def T(self) -> Any:
        """Tangential force at the crank pin in N, R 303: T R dφ = P dx."""
        if self._output is None:
            return None
        push = self._output * (self.slope / self.drive.mechanism.crank)
        push = push + self._rod_tangential if self.drive.rod else push
        return push if self.rubbing is None else push - self.angle.cos * self._pin_side

    @cached_property
    def _free_torque(self) -> Any:
        """Torque in N m before pins and journals rub, from the work of the force at the output."""
        torque = self._output * self.slope
        return torque + self._rod_tangential * self.drive.mechanism.crank if self.drive.rod else torque

    @cached_property
    def M(self) -> Any:
        """Torque on the shaft in N m."""
        if self._output is None:
            return None
        return self._free_torque if self.rubbing is None else self._free_torque - self.rubbing.lost

    @property
    def torque(self) -> Any:
        """Torque T R in N m of the force on the pin, before crank pin and journals rub, from the work as M is."""
        return self._free_torque if self.rubbing is None else self._free_torque - self.rubbing.by_couple

    @cached_property
    def _rod_tangential(self) -> Any:
        """What couple and weight of an exact rod give to T in N."""
        assert self.drive.rod is not None
        return self.drive.rod.tangential(self.rod_angle, self.angle)


def _sum(first: Any, second: Any) -> Any:
    return second if first is None else first if second is None else first + second
