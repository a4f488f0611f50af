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

from collections.abc import Mapping
from functools import cached_property, reduce
from operator import add
from typing import Any, NamedTuple

import numpy as np

from kurbel import crank_formulas as formulas
from kurbel.arrays import Array, Indices
from kurbel.crank_angle import CrankAngle
from kurbel.errors import NoSolutionError
from kurbel.numerics.arithmetic import some
from kurbel.numerics.lobatto import rule
from kurbel.numerics.pieces import Pieces
from kurbel.quantity import Row, column
from kurbel.solver.drive import Drive
from kurbel.solver.figures import column_rows
from kurbel.solver.gas import Pressure
from kurbel.solver.motion import MotionColumns
from kurbel.solver.shaft import Vector
from kurbel.solver.trace import TracePressure, spread


class Rubbing(NamedTuple):
    """Moments of friction in N m: of both pins on the rod, in the sense of rotation, and of the journals.

    Each takes f r |F| on its radius r, and in a turn by dα the work f r |F| dα: the journals turn by dφ, the rod on the
    crank pin by dφ + dψ, on the crosshead pin by dψ. In each pin the moment also acts on the rod, as a couple that
    guide and crank pin carry. The forces F are those without this friction: what it changes in them is of second order
    in f, as with the friction circles of the books.
    """

    at_crank: Any
    at_crosshead: Any
    journals: Any

    @property
    def couple(self) -> Any:
        """Couple of both pins on the rod."""
        return self.at_crank + self.at_crosshead


class State(MotionColumns):
    """A cylinder at crank angles: motion and forces; see `MotionColumns`.

    rubs: whether pins and journals rub. A quantity that the machine does not have is None.
    """

    commands = ("forces",)

    def __init__(self, drive: Drive, angle: CrankAngle, within: Array, rubs: bool = True) -> None:
        super().__init__(drive.mechanism, angle, within, drive.omega, drive.cylinder.point)
        self.drive, self.rubs = drive, rubs

    @classmethod
    def at(cls, drive: Drive, degrees: Array, within: Array | None = None, machine: Indices | None = None) -> State:
        """Return the state at crank angles (n,) in degrees, on the sides of jumps that hold `within`, or just after."""
        drive = drive if machine is None else drive.taken(machine)
        return cls(drive, CrankAngle.of(degrees), degrees if within is None else within)

    @classmethod
    def on(cls, drive: Drive, pieces: Pieces) -> State:
        """Return the state at the nodes of pieces, (nodes, pieces), each on its side of every jump."""
        return cls(drive.taken(pieces.machine), CrankAngle.at_nodes(pieces), pieces.middle)

    @property
    def unrubbed(self) -> State:
        """The state without friction in pins and journals: its loads are those that this friction is computed from."""
        return State(self.drive, self.angle, self.within, rubs=False) if self.rubs else self

    @property
    def rows(self) -> Mapping[str, Row]:
        """The rows of its columns, those of the mechanism among them."""
        return column_rows(State, self.mechanism.OFFERS)

    def _filled(self, value: Any) -> Array:
        return np.broadcast_to(np.asarray(value, dtype=float), self.phi.shape)

    # the chambers

    def pressure(self, end: Pressure) -> Array:
        """Return the gauge pressure in Pa at an end of a piston."""
        if isinstance(end, TracePressure):
            return end.at(self.phi, self.within)
        left = self.mechanism.remaining(self.posed) / self.mechanism.stroke if end.steep else None
        return end.at(self.z, self.phi, self.within, self.drive.index, left)

    @column("p_H", "pressure", gauge=True)
    def p_head(self) -> Any:
        """Gauge pressure in the head-end chamber, just after a jump."""
        gas = self.drive.own_gas
        return self.pressure(gas.head) + spread(gas.base, self.drive.index) if gas and gas.head else None

    @column("p_C", "pressure", gauge=True)
    def p_crank(self) -> Any:
        """Gauge pressure in the crank-end chamber, just after a jump."""
        gas = self.drive.own_gas
        return self.pressure(gas.crank) + spread(gas.base, self.drive.index) if gas and gas.crank else None

    @column("V", "volume", on_request=("forces",))
    def V(self) -> Any:
        """Volume of the head-end chamber, with its clearance where that is given."""
        gas = self.drive.own_gas
        return gas.piston.head_area * self.way + gas.clearance_volumes[0] if gas and gas.head else None

    @column("V_C", "volume", on_request=("forces",))
    def V_crank(self) -> Any:
        """Volume of the crank-end chamber, with its clearance where that is given."""
        gas = self.drive.own_gas
        if not (gas and gas.crank):
            return None
        return gas.piston.crank_area * (self.mechanism.stroke - self.way) + gas.clearance_volumes[1]

    @column("dV/dφ", "volume_rise", on_request=("forces",))
    def dV(self) -> Any:
        """Change of the volume of the head-end chamber over the angle."""
        gas = self.drive.own_gas
        return gas.piston.head_area * np.radians(1.0) * self.slope if gas and gas.head else None

    @column("dp_H/dφ", "pressure_rise", on_request=("forces",))
    def dp_head(self) -> Any:
        """Rise of the head-end pressure, over 1 deg."""
        end = self.drive.own_gas.head if self.drive.own_gas else None
        return end.rise(self.phi) if isinstance(end, TracePressure) else None

    @column("dp_C/dφ", "pressure_rise", on_request=("forces",))
    def dp_crank(self) -> Any:
        """Rise of the crank-end pressure, over 1 deg."""
        end = self.drive.own_gas.crank if self.drive.own_gas else None
        return end.rise(self.phi) if isinstance(end, TracePressure) else None

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

    @column("P_gas", "force")
    def P_gas(self) -> Any:
        """Force of gas, steam or water on all pistons of the rod.

        R 296.
        """
        return self._force_on()

    @cached_property
    def P_driving(self) -> Any:
        """Force of gas or steam on the pistons that drive in N; None where none does."""
        return self._force_on(self.drive.driving)

    @column("P_297", "force", on_request=("forces",))
    def P_gas_book(self) -> Any:
        """The same by the mean of both areas (R 297)."""
        return self._force_on(alike=True)

    # the piston force

    @column("P_b", "force")
    def P_inertia(self) -> Any:
        """Inertia force −m b of the reciprocating masses.

        R 298.
        """
        return -self.drive.mass * self.b if self.drive.has_inertia else None

    @column("P_w", "force")
    def P_weight(self) -> Any:
        """Weight of the reciprocating masses along the stroke line."""
        weight = self.drive.weight
        return self._filled(weight[0]) if weight else None

    @cached_property
    def _resistance(self) -> Any:
        """What the output works against, in N or N m, against the motion."""
        resistance = self.drive.resistance
        if resistance is None:
            return None
        working = self.direction == (1.0 if self.mechanism.works_outward else -1.0)
        return self._filled(-self.direction * np.where(working, resistance.work, resistance.back))

    @column("P_r", "force")
    def P_ram(self) -> Any:
        """Force on a ram against its motion."""
        return self._resistance if self.mechanism.slides else None

    @column("P", "force", extremes=("forces",), called="piston force", peak=True)
    def P(self) -> Any:
        """Force along the stroke line: gas, inertia, weight, and what a ram works against."""
        return _sum(self.P_inertia, self.P_start)

    def _rod_load(self, without: Any = 0.0) -> Any:
        """Return the force in N of the gas, with inertia and weight of the moving parts, toward the shaft (API 618).

        without: mass in kg that is left out, as the connecting rod's share is. None without a gas force, and without a
        connecting rod, where it would be P.
        """
        masses = self.drive.cylinder.masses
        if self.P_gas is None or not self.mechanism.has_rod:
            return None
        mass = masses.parts - without if masses else 0.0
        weight = self.drive.weight_of(mass)
        moved = self.P_gas - self.b * mass if self.drive.has_inertia else self.P_gas
        return moved + weight[0] if weight else moved

    @column("P_G", "force", unless=lambda forces: forces.no_compressor)
    def P_rod(self) -> Any:
        """Rod load at the crosshead pin: gas, inertia and weight of all but the connecting rod, compression
        positive.
        """
        return self._rod_load()

    @column("P_KS", "force", unless=lambda forces: forces.no_compressor)
    def P_piston_rod(self) -> Any:
        """The same at the piston rod, without the crosshead.

        None where its mass is unknown.
        """
        masses = self.drive.cylinder.masses
        return None if not masses or masses.crosshead is None else self._rod_load(without=masses.crosshead)

    @column(
        "P_0",
        "force",
        commands=(),
        extremes=("forces",),
        called="piston force without inertia: starting and slow running",
    )
    def P_start(self) -> Any:
        """Force along the stroke line without inertia."""
        return _sum(_sum(self.P_gas, self.P_weight), self.P_ram)

    # the rod

    @column("S", "force", extremes=("forces",), called="rod force", peak=True)
    def S(self) -> Any:
        """Force in the connecting rod, compression positive; of an exact rod, between the masses at its ends.

        R 300.
        """
        if self.P is None or self.rod_angle is None:
            return None
        push = self.along_rod / self.rod_angle[1]
        return push if self._rod_side is None else push - self._rod_side * self.rod_angle[0]

    @column("S_H", "force", extremes=("forces",), called="force along the rod at the crosshead pin")
    def S_crosshead(self) -> Any:
        """Force along an exact rod at the crosshead pin, compression positive.

        The rod's own mass at this pin, which the pin does not act on, is taken off.
        """
        drive = self.drive
        if self.P is None or drive.rod is None:
            return None
        weight = drive.weight_of(drive.rod.crosshead_mass) or (0.0, 0.0)
        push = self.along_rod + self.b * drive.rod.crosshead_mass if drive.has_inertia else self.along_rod
        push, lift = push - weight[0], self.N - drive.guide_weight + weight[1]
        return push * self.rod_angle[1] + lift * self.rod_angle[0]

    @column("S_Z", "force", extremes=("forces",), called="force along the rod at the crank pin")
    def S_crank(self) -> Any:
        """Force along an exact rod at the crank pin, compression positive.

        T sin(φ+ψ) + D cos(φ+ψ).
        """
        if self.P is None or self.drive.rod is None:
            return None
        (sin_psi, cos_psi), sin, cos = self.rod_angle, self.angle.sin, self.angle.cos
        return self.T * (sin * cos_psi + cos * sin_psi) + self.D * (cos * cos_psi - sin * sin_psi)

    @cached_property
    def rod_couple(self) -> Any:
        """Couple of an exact rod in N m, (I_r − m_r a (L − a)) ψ̈ at uniform rotation; 0 without one."""
        rod, (sin_psi, cos_psi) = self.drive.rod, self.rod_angle or (0.0, 1.0)
        if rod is None or self.omega is None:
            return 0.0
        bend = formulas.rod_curvature(self.angle.sin, sin_psi, cos_psi, self.rod_slope, self.mechanism.lam)
        return bend * (rod.excess_inertia * self.omega * self.omega)

    def _side(self, couple: Any) -> Any:
        """Return the force in N, square to the stroke line, by which a couple on the rod relieves the guide."""
        return couple / (self.rod_angle[1] * self.mechanism.rod_length)

    @cached_property
    def _rod_side(self) -> Any:
        """Side force in N of the couples on the rod: of an exact one, and of the friction in its pins; else None."""
        exact = None if self.drive.rod is None else self._side(self.rod_couple)
        return exact if self.rubbing is None else _sum(exact, self._side(self.rubbing.couple))

    @cached_property
    def rubbing(self) -> Rubbing | None:
        """Moments of friction in pins and journals; None where there is none."""
        friction = self.drive.pin_friction if self.rubs else None
        if friction is None or self.P is None:
            return None
        # the rod turns by −dψ: forward where it swings back
        turned = np.mod(self.within, 360.0)
        swings = np.where((turned < 90.0) | (turned >= 270.0), 1.0, -1.0)
        return Rubbing(
            np.hypot(*on_pin(self.unrubbed)) * friction.crank_pin,
            np.hypot(*on_crosshead_pin(self.unrubbed)) * (swings * friction.crosshead_pin),
            sum(np.hypot(*force) for force in self._on_journals(on_pin(self.unrubbed))) * friction.journals,
        )

    def _on_journals(self, pin: Vector) -> tuple[Vector, ...]:
        """Return the forces of the throw on its bearings; without a crankshaft, that on the pin stands for their sum.

        Of several cylinders each counts by itself, with an equal part of what else loads the bearings of its throw.
        """
        drive, friction = self.drive, self.drive.pin_friction
        if friction is None or friction.line is None or not some(friction.journals != 0):
            return (pin,)
        throw = friction.line.throw_of([one.name for one in drive.machine.cylinders].index(drive.name))
        count = len(throw.cylinders)
        found = friction.line.carried(throw, Vector(pin.D * count, pin.T * count), drive.cylinder, self.angle)
        return tuple(Vector(force.D / count, force.T / count) for force in found)

    # the guide

    @cached_property
    def _after_steady_friction(self) -> Any:
        """Force left for crosshead and rod after friction that is the same over the stroke, in N."""
        steady = self.drive.steady_friction
        return self.P - self.direction * steady if some(steady != 0) else self.P

    @cached_property
    def _guide_load(self) -> Any:
        """Load on the guide besides the push of the rod in N: weight less the side force of couples on the rod."""
        return self.drive.guide_weight if self._rod_side is None else self.drive.guide_weight - self._rod_side

    @cached_property
    def guide_sense(self) -> Any:
        """The force whose sign is that of N: P sin ψ + G cos ψ with the load G on the guide, in N."""
        sin_psi, cos_psi = self.rod_angle or (0.0, 1.0)
        return self._after_steady_friction * sin_psi + self._guide_load * cos_psi

    @cached_property
    def guide_side(self) -> Array:
        """+1 where N ≥ 0, else −1; (n,), each piece having one."""
        sense = self.guide_sense
        if np.ndim(self.angle.sin) > 1:
            sense = rule(len(self.phi)).weights @ sense
        elif self.within is not self.phi:
            sense = State(self.drive, CrankAngle.of(self.within), self.within, self.rubs).guide_sense
        return np.where(sense >= 0, 1.0, -1.0)

    @cached_property
    def below(self) -> Any:
        """cos ψ + f sin ψ sgn c sgn N, the denominator of N; not positive where the crosshead locks itself."""
        sin_psi, cos_psi = self.rod_angle
        return cos_psi + sin_psi * (self.guide_side * self.direction * self.drive.crosshead_friction)

    @column("N", "force", extremes=("forces",), called="guide force", peak=True)
    def N(self) -> Any:
        """Force on the guide (yoke frame: on the piston rod), positive on the side where it lies while an
        engine drives.

        D 3 with signs. Raises NoSolutionError where the crosshead locks itself; of many machines those that lock have
        nan.
        """
        drive = self.drive
        if self.P is None:
            return None
        if self.rod_angle is None:
            alone = drive.weight if self.mechanism.known_across else None
            return alone and self._filled(alone[1])
        if not drive.rubs:
            sin_psi, cos_psi = self.rod_angle
            return self._after_steady_friction * (sin_psi / cos_psi) + self._guide_load
        locked = self.below <= 0
        if locked.any() and drive.index is None:
            raise NoSolutionError(drive.locks(float(self.phi[locked][0])))
        return self.guide_sense / np.where(locked, np.nan, self.below)

    @cached_property
    def crosshead_drag(self) -> Any:
        """Crosshead friction f |N| in N, against the motion."""
        return self.N * (self.guide_side * self.drive.crosshead_friction) if self.drive.rubs else 0.0

    @column("p_g", "pressure")
    def p_guide(self) -> Any:
        """Mean pressure of the crosshead's shoe on its guide, |N| over its area."""
        area = self.drive.guide_area
        return None if area is None or self.N is None else abs(self.N) / area

    @column("f N c", "power")
    def wear(self) -> Any:
        """Work of friction on the guide over time, by which it wears (Redtenbacher)."""
        return None if self.p_guide is None or self.c is None else self.crosshead_drag * self.c * self.direction

    # the crank pin

    @column("D", "force")
    def D(self) -> Any:
        """Radial force at the crank pin, positive toward the shaft.

        R 302; an exact rod adds its couple, centrifugal force and weight.
        """
        radial = None if self.P is None else self.mechanism.radial(self.posed)
        if radial is None:
            return None
        push = self.along_rod * radial
        push = push if self._rod_side is None else push + self._rod_side * self.angle.sin
        if self.drive.rod is None:
            return push
        weight = self.drive.weight_of(self.drive.rod.pin_mass) or (0.0, 0.0)
        pull = self.drive.centrifugal(self.drive.rod.pin_mass)
        return push - pull + (self.angle.cos * weight[0] + self.angle.sin * weight[1])

    @column("M_2", "torque")
    def M_out(self) -> Any:
        """Moment on what swings, or on the second crank, against its motion."""
        return None if self.mechanism.slides else self._resistance

    @property
    def _output(self) -> Any:
        """What reaches the crank of the force, or of the moment, at the output."""
        return self.along_rod if self.mechanism.slides else self.M_out

    @cached_property
    def _rod_tangential(self) -> Any:
        """What couple and weight of an exact rod give to T in N."""
        assert self.drive.rod is not None
        weight = self.drive.weight_of(self.drive.rod.pin_mass) or (0.0, 0.0)
        couple = -self._side(self.rod_couple) * self.angle.cos
        return couple + (self.angle.sin * weight[0] - self.angle.cos * weight[1])

    @column("T", "force", extremes=("forces",), called="tangential force", peak=True)
    def T(self) -> Any:
        """Tangential force at the crank pin, positive when it drives.

        R 303: T R dφ = P dx.
        """
        if self._output is None:
            return None
        push = self._output * (self.slope / self.mechanism.crank)
        push = push + self._rod_tangential if self.drive.rod else push
        return push if self.rubbing is None else push - self.angle.cos * self._side(self.rubbing.couple)

    @column("F_f", "force")
    def F_friction(self) -> Any:
        """Friction along the stroke line, opposing the motion."""
        if self.P is None or not self.drive.has_friction:
            return None
        return self._filled((self.crosshead_drag + self.drive.steady_friction) * -self.direction)

    @cached_property
    def along_rod(self) -> Any:
        """The part of the rod force along the stroke line in N: the piston force less all friction."""
        return self.P if self.F_friction is None else self.P + self.F_friction

    @cached_property
    def _free_torque(self) -> Any:
        """Torque in N m before friction in pins and journals, from the work of the force at the output."""
        torque = self._output * self.slope
        return torque + self._rod_tangential * self.mechanism.crank if self.drive.rod else torque

    @property
    def torque(self) -> Any:
        """Torque T R in N m of the force on the pin, before friction in crank pin and journals; from the work, as M."""
        return self._free_torque if self.rubbing is None else self._free_torque - self.rubbing.couple * self.rod_slope

    @cached_property
    def crank_pin_loss(self) -> Any:
        """What friction in the crank pin takes of the torque, in N m; `crosshead_pin_loss` in the crosshead pin."""
        return self.rubbing and self.rubbing.at_crank * (1 + self.rod_slope)

    @cached_property
    def crosshead_pin_loss(self) -> Any:
        """What friction in the crosshead pin takes of the torque, in N m."""
        return self.rubbing and self.rubbing.at_crosshead * self.rod_slope

    @column("M", "torque")
    def M(self) -> Any:
        """Torque on the shaft."""
        if self._output is None or self.rubbing is None:
            return None if self._output is None else self._free_torque
        return self._free_torque - (self.crank_pin_loss + self.crosshead_pin_loss + self.rubbing.journals)


def on_pin(state: State) -> Vector:
    """Return the force of the rod on the crank pin in N, in the frame of the throw."""
    return Vector(state.D - state.drive.rod_pull, state.T)


def on_crosshead_pin(state: State) -> Vector:
    """Return the force of the crosshead on its pin in N, along as P and across as N, without inertia of the rod.

    Along it is the rod load less friction.
    """
    drive, masses = state.drive, state.drive.cylinder.masses
    of_rod = drive.mass - masses.parts if masses else 0.0
    weight = drive.weight_of(of_rod) or (0.0, 0.0)
    along = state.along_rod + state.b * of_rod if drive.has_inertia else state.along_rod
    return Vector(along - weight[0], state.N - drive.guide_weight + weight[1])


def reduced_inertia(state: State) -> Any:
    """Return m x′² + … in kg m²: what the moving masses of a cylinder, connecting rod included, add to the shaft."""
    drive, rod = state.drive, state.drive.rod
    inertia = state.slope * state.slope * drive.mass + drive.pin_inertia
    return inertia if rod is None else inertia + state.rod_slope * state.rod_slope * rod.excess_inertia


def _sum(first: Any, second: Any) -> Any:
    return second if first is None else first if second is None else first + second
