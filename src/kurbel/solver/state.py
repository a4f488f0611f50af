"""A cylinder at crank angles: every column of `kurbel forces` and `kurbel motion`, computed on first use.

What acts on the crosshead, drawn for a stroke line to the left, the shaft on the right, 0 < φ < 180°:

          N ↓ (on the upper guide here; positive as ψ is)
    P → ──O── S cos ψ ←     P  gas, inertia, weight, what the ram works against
        f|N|, rings →       along the rod S cos ψ = P less friction;  N = S sin ψ + weight on the guide

    N (cos ψ + f sin ψ sgn c sgn N) = P sin ψ + G cos ψ        D 3 with signs; f = 0: N = P tan ψ + G (R 301)
    S = P/cos ψ (R 300)   D = P cos(φ+ψ)/cos ψ (R 302)   T = P sin(φ+ψ)/cos ψ (R 303), by its work: T R dφ = P dx

P here is what friction leaves. An exact rod adds the side force of its couple, and so do pins that rub.
"""

from __future__ import annotations

from functools import cached_property, reduce
from operator import add, mul
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.declared.quantity import by_id
from kurbel.errors import NoSolutionError
from kurbel.mechanisms import PointMotion
from kurbel.mechanisms.kinds import every_quantity
from kurbel.numerics.arithmetic import bearing, some
from kurbel.numerics.lobatto import rule
from kurbel.solver.gas import Pressure
from kurbel.solver.trace import TracePressure, spread

if TYPE_CHECKING:
    from kurbel.solver.drive import Drive
    from kurbel.solver.pins import Rubbing


class State:
    """A cylinder at crank angles; its attributes are named by the ids of the columns, in SI, shaped as the angles.

    angle: crank angles (n,), or those at the nodes of pieces, (nodes, n); within: angles in degrees (n,) on the side of
    every jump that is meant: for pieces their middles. rubs: whether pins and journals rub. A quantity that the machine
    does not have is None.
    """

    def __init__(self, drive: Drive, angle: CrankAngle, within: Array, rubs: bool = True) -> None:
        self.drive, self.angle, self.within, self.rubs = drive, angle, within, rubs

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
    def unrubbed(self) -> State:
        """The state without friction in pins and journals: its loads are those that this friction is computed from."""
        return State(self.drive, self.angle, self.within, rubs=False) if self.rubs else self

    @property
    def _on_pieces(self) -> bool:
        return np.ndim(self.angle.sin) > 1

    def _filled(self, value: Any) -> Array:
        return np.broadcast_to(np.asarray(value, dtype=float), self.phi.shape)

    # motion

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
    def _coordinate(self) -> Any:
        return self.drive.mechanism.coordinate(self._posed)

    @property
    def x(self) -> Any:
        """Displacement in m; of what only swings, None."""
        return self._coordinate if self.drive.mechanism.slides else None

    @cached_property
    def way(self) -> Any:
        """Displacement in m from the inner dead centre, even where x counts from elsewhere: for the chambers."""
        return self.x - self.drive.mechanism.start

    @cached_property
    def slope(self) -> Any:
        """dx/dφ in m per radian; of what only swings, dθ/dφ."""
        return self.drive.mechanism.slope(self._posed)

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
        """Fraction of the stroke, or of the swing, from the inner dead centre; None where the output turns fully."""
        one = self.drive.mechanism
        return None if one.turns else (self._coordinate - one.start) / one.stroke

    @cached_property
    def direction(self) -> Array:
        """+1 on the outstroke, −1 on the return stroke; +1 for what turns on and on."""
        if self.drive.mechanism.turns:
            return np.ones_like(self.within)
        inner, outer = self.drive.mechanism.dead_centres()
        return np.where(np.mod(self.within - inner, 360.0) < outer - inner, 1.0, -1.0)

    # the chambers

    def pressure(self, end: Pressure) -> Array:
        """Return the gauge pressure in Pa at an end of a piston."""
        if isinstance(end, TracePressure):
            return end.at(self.phi, end.held(self.within))
        mechanism = self.drive.mechanism
        left = mechanism.remaining(self._posed) / mechanism.stroke if end.steep else None
        return end.at(self.z, self.phi, end.held(self.within, self.drive.index), left)

    def _counted(self, end: Pressure | None) -> Any:
        """Return a pressure as the machine file counts it."""
        return None if end is None else self.pressure(end) + spread(end.setting.base, self.drive.index)

    @cached_property
    def p_head(self) -> Any:
        """Pressure at the head end of the cylinder's own piston in Pa, counted as in the machine file."""
        gas = self.drive.own_gas
        return gas and self._counted(gas.head)

    @cached_property
    def p_crank(self) -> Any:
        """Pressure at the crank end of the cylinder's own piston in Pa, counted as in the machine file."""
        gas = self.drive.own_gas
        return gas and self._counted(gas.crank)

    def _force_on(self, shares: Any = None, alike: bool = False) -> Any:
        """Return Σ p_H A_H − p_C A_C in N, R 296; alike: with the mean of both areas, R 297; None without a piston.

        shares: of each piston, what counts of it; True or all of it, False or nothing.
        """
        terms: list[Any] = []
        for number, gas in enumerate(self.drive.gas):
            share = True if shares is None else spread(shares[number], self.drive.index)
            if share is False:
                continue
            areas = [spread(one, self.drive.index) * share for one in (gas.piston.head_area, gas.piston.crank_area)]
            head, crank = ((areas[0] + areas[1]) / 2,) * 2 if alike else areas
            terms += [self.pressure(gas.head) * head] if gas.head else []
            terms += [self.pressure(gas.crank) * -crank] if gas.crank else []
        return reduce(add, terms) if terms else None

    @cached_property
    def P_gas(self) -> Any:
        """Force of gas, steam or water on all pistons in N, R 296."""
        return self._force_on()

    @cached_property
    def P_driving(self) -> Any:
        """Force of gas or steam on the pistons that drive in N; None where none does."""
        return self._force_on(self.drive.driving)

    @property
    def P_gas_book(self) -> Any:
        """The same with both areas of a piston alike, in N, R 297."""
        return self._force_on(alike=True)

    @property
    def V(self) -> Any:
        """Volume of the head-end chamber in m³, with its clearance where that is given."""
        gas = self.drive.own_gas
        return gas.piston.head_area * self.way + gas.clearance_volumes[0] if gas and gas.head else None

    @property
    def V_crank(self) -> Any:
        """Volume of the crank-end chamber in m³, with its clearance where that is given."""
        gas = self.drive.own_gas
        if not (gas and gas.crank):
            return None
        return gas.piston.crank_area * (self.drive.mechanism.stroke - self.way) + gas.clearance_volumes[1]

    @property
    def dV(self) -> Any:
        """Change of the volume of the head-end chamber in m³ per degree."""
        gas = self.drive.own_gas
        return gas.piston.head_area * np.radians(1.0) * self.slope if gas and gas.head else None

    @property
    def dp_head(self) -> Any:
        """Rise of the head-end pressure in Pa per degree; None without a trace."""
        end = self.drive.own_gas.head if self.drive.own_gas else None
        return end.rise(self.phi) if isinstance(end, TracePressure) else None

    @property
    def dp_crank(self) -> Any:
        """Rise of the crank-end pressure in Pa per degree; None without a trace."""
        end = self.drive.own_gas.crank if self.drive.own_gas else None
        return end.rise(self.phi) if isinstance(end, TracePressure) else None

    # the piston force

    @cached_property
    def P_inertia(self) -> Any:
        """−m b in N, R 298."""
        return -self.drive.mass * self.b if self.drive.has_inertia else None

    @cached_property
    def P_weight(self) -> Any:
        """Weight along the stroke line in N, positive toward the shaft."""
        weight = self.drive.weight
        return self._filled(weight[0]) if weight else None

    @cached_property
    def _resistance(self) -> Any:
        """What the output works against, in N or N m, against the motion."""
        resistance = self.drive.resistance
        if resistance is None:
            return None
        working = self.direction == (1.0 if self.drive.mechanism.works_outward else -1.0)
        return self._filled(-self.direction * np.where(working, resistance.work, resistance.back))

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

    def rod_load(self, without: Any = 0.0) -> Any:
        """Return the force in N of the gas, with inertia and weight of the moving parts, toward the shaft (API 618).

        without: mass in kg that is left out, as the connecting rod's share is. None without a gas force, and without a
        connecting rod, where it would be P.
        """
        drive, masses = self.drive, self.drive.cylinder.masses
        if self.P_gas is None or not drive.mechanism.has_rod:
            return None
        mass = masses.parts - without if masses else 0.0
        weight = drive.weight_of(mass)
        moved = self.P_gas - self.b * mass if drive.has_inertia else self.P_gas
        return moved + weight[0] if weight else moved

    @cached_property
    def P_rod(self) -> Any:
        """Rod load in N: force at the crosshead pin of all but the connecting rod and friction."""
        return self.rod_load()

    @cached_property
    def P_piston_rod(self) -> Any:
        """The same without the crosshead, in N: force at the end of the piston rod; None where its mass is unknown."""
        masses = self.drive.cylinder.masses
        return None if not masses or masses.crosshead is None else self.rod_load(without=masses.crosshead)

    # the guide

    @cached_property
    def after_steady_friction(self) -> Any:
        """Force left for crosshead and rod after friction that is the same over the stroke, in N."""
        steady = self.drive.steady_friction
        return self.P - self.direction * steady if some(steady != 0) else self.P

    @cached_property
    def _guide_load(self) -> Any:
        """Load on the guide besides the push of the rod in N: weight less the side force of couples on the rod."""
        weight = self.drive.guide_weight
        return weight if self.rod_side is None else weight - self.rod_side

    @cached_property
    def guide_sense(self) -> Any:
        """The force whose sign is that of N: P sin ψ + G cos ψ with the load G on the guide, in N."""
        sin_psi, cos_psi = self.rod_angle or (0.0, 1.0)
        return self.after_steady_friction * sin_psi + cos_psi * self._guide_load

    @cached_property
    def guide_side(self) -> Array:
        """+1 where N ≥ 0, else −1; (n,), each piece having one."""
        if self._on_pieces:
            above = rule(len(self.phi)).weights @ self.guide_sense
        elif self.within is self.phi:
            above = self.guide_sense
        else:
            above = State(self.drive, CrankAngle.of(self.within), self.within, self.rubs).guide_sense
        return np.where(above >= 0, 1.0, -1.0)

    @cached_property
    def below(self) -> Any:
        """cos ψ + f sin ψ sgn c sgn N, the denominator of N; not positive where the crosshead locks itself."""
        sin_psi, cos_psi = self.rod_angle
        return cos_psi + sin_psi * (self.guide_side * self.direction * self.drive.crosshead_friction)

    @cached_property
    def N(self) -> Any:
        """Force on the guide in N, D 3 with signs; raises NoSolutionError where the crosshead locks itself.

        Of many machines those that lock have nan.
        """
        drive = self.drive
        if self.P is None:
            return None
        if self.rod_angle is None:
            alone = drive.weight if drive.mechanism.known_across else None
            return alone and self._filled(alone[1])
        sin_psi, cos_psi = self.rod_angle
        if not drive.rubs:
            return self.after_steady_friction * (sin_psi / cos_psi) + self._guide_load
        locked = self.below <= 0
        if locked.any() and drive.index is None:
            raise NoSolutionError(drive.locks(float(self.phi[locked][0])))
        return self.guide_sense / np.where(locked, np.nan, self.below)

    @cached_property
    def crosshead_drag(self) -> Any:
        """Crosshead friction f |N| in N, against the motion."""
        return self.N * (self.guide_side * self.drive.crosshead_friction) if self.drive.rubs else 0.0

    @cached_property
    def p_guide(self) -> Any:
        """|N| over the area of the shoe in Pa; None where its size is not given."""
        area = self.drive.guide_area
        return None if area is None or self.N is None else abs(self.N) / area

    @cached_property
    def wear(self) -> Any:
        """f |N| |c| in W, the wear line of the guide (D); None without a shoe or a speed."""
        return None if self.p_guide is None or self.c is None else self.crosshead_drag * self.c * self.direction

    @cached_property
    def crosshead_power(self) -> Any:
        """Work of crosshead friction by crank angle, f |N| |dx/dφ| in J per radian."""
        return self.crosshead_drag * (self.slope * self.direction)

    # rod and crank pin

    @cached_property
    def rubbing(self) -> Rubbing | None:
        """Moments of friction in pins and journals in N m; None where there is none."""
        friction = self.drive.pin_friction if self.rubs else None
        return None if friction is None or self.P is None else friction.moments(self.unrubbed)

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
        return self._filled((self.crosshead_drag + self.drive.steady_friction) * -self.direction)

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
    def _rod_tangential(self) -> Any:
        """What couple and weight of an exact rod give to T in N."""
        assert self.drive.rod is not None
        return self.drive.rod.tangential(self.rod_angle, self.angle)

    @cached_property
    def _free_torque(self) -> Any:
        """Torque in N m before friction in pins and journals, from the work of the force at the output."""
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
        """Torque T R in N m of the force on the pin, before friction in crank pin and journals; from the work, as M."""
        return self._free_torque if self.rubbing is None else self._free_torque - self.rubbing.by_couple

    # a point of the rod

    @cached_property
    def _point(self) -> PointMotion | None:
        point, mechanism = self.drive.cylinder.point, self.drive.mechanism
        return mechanism.point_at(self.angle, point.from_crank_pin(mechanism), point.across) if point else None

    @property
    def x_point(self) -> Any:
        """Place of the point in m from the shaft axis, along φ = 0."""
        return self._point and self._point.x

    @property
    def y_point(self) -> Any:
        """Its place in m along φ = 90°."""
        return self._point and self._point.y

    @property
    def v_point(self) -> Any:
        """Its speed in m/s."""
        return None if self._point is None or self.omega is None else self._point.speed * self.omega

    @property
    def b_point(self) -> Any:
        """The magnitude of its acceleration in m/s², at uniform rotation."""
        w = self.omega
        return None if self._point is None or w is None else self._point.acceleration * (w * w)


def reduced_inertia(state: State) -> Any:
    """Return m x′² + … in kg m²: what the moving masses of a cylinder, connecting rod included, add to the shaft."""
    rod = state.drive.rod
    inertia = state.slope * state.slope * state.drive.mass + state.drive.pin_inertia
    return inertia + rod.reduced_inertia(state.rod_angle, state.angle) if rod else inertia


def _sum(first: Any, second: Any) -> Any:
    return second if first is None else first if second is None else first + second
