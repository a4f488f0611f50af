"""A cylinder at crank angles: every column of `kurbel forces` and `kurbel motion`, computed on first use.

Forces on the crosshead on the outstroke, 0 < φ < 180°; cylinder on the left, shaft on the right, crank pin above the
stroke line:

            ↓ G, S sin ψ        P  gas, inertia, weight, loads;  G  weight across the stroke line
    P →  ───O───  ← S cos ψ     along it   S cos ψ = P − friction of crosshead, f |N|, and rings
            ↑ N   ← friction    across it  N = S sin ψ + G, from the lower guide, positive as drawn

    N (cos ψ + f sin ψ sgn c sgn N) = P sin ψ + G cos ψ        D 3, crosshead, with signs; f = 0: N = P tan ψ + G (R 301)
    S = P/cos ψ (R 300)   D = P cos(φ+ψ)/cos ψ (R 302)   T = P sin(φ+ψ)/cos ψ (R 303), by virtual work: T R dφ = P dx

T = M/R always: where pins and journals rub, it is less the moments of friction over R. T_Z, the force at the pin, is
not.

The P of N is less the friction of the rings, that of S, D and T less all friction along the stroke line. The couple of
an exact rod and the friction in the pins of a rod are balanced by side forces on guide and crank pin.

In a Scotch yoke P presses the block on the yoke, at R sin φ from the stroke line; two guides l_g apart take the couple.
Friction, to first order in f:

    of the guides  2 f_g |P R sin φ|/l_g along the stroke line, against c
    of the block   f_b |P| along the slot, against R ω cos φ: it drags the crank pin, and N = −f_b |P| sgn cos φ
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np

from kurbel import crank_formulas as formulas
from kurbel.arrays import Array, Indices, Number, Truth
from kurbel.crank_angle import CrankAngle
from kurbel.errors import NoSolutionError
from kurbel.numerics.arithmetic import some, spread, total
from kurbel.numerics.lobatto import rule
from kurbel.numerics.pieces import Pieces
from kurbel.quantity import QuantityRow, column, value
from kurbel.solver.chambers import Chambers
from kurbel.solver.drive import Drive, any_of
from kurbel.solver.figures import column_rows
from kurbel.solver.vector import CrossheadForce, PinForce

if TYPE_CHECKING:
    from kurbel.mechanisms.link_rod import LinkedPiston


class FrictionMoments(NamedTuple):
    """Friction moments f r |F| in N m, with the radius r of a pin or journal and its load F.

    A relative rotation dα dissipates f r |F| dα: dφ in the journals, dφ + dψ in the crank pin, dψ in the crosshead pin.
    The moments in the pins also act on the rod (positive in the sense of rotation), as a couple that guide and crank
    pin carry. F is computed without this friction, which neglects terms of second order in f, as the friction circles
    of the books do.
    """

    at_crank: Number
    at_crosshead: Number
    journals: Number


class State(Chambers):
    """Motion and forces of a cylinder at crank angles. What a machine does not have is None.

    drive: the parameters of the cylinder; angle: the crank angles; within: angles on the side that is meant where a
    value jumps; both as in `MotionColumns`, which also has the angles of the rod, `posed` and `rod_angle`.
    with_pin_friction: whether friction in pins and journals is included.
    """

    def __init__(
        self, drive: Drive, angle: CrankAngle, within: Array, with_pin_friction: bool = True
    ) -> None:
        super().__init__(drive, angle, within)
        self.with_pin_friction = with_pin_friction

    @classmethod
    def at(
        cls,
        drive: Drive,
        degrees: Array,
        within: Array | None = None,
        machine: Indices | None = None,
    ) -> State:
        """Return the state at crank angles (n,) in degrees.

        within: at a jump the value is taken on the side of these angles (n,), by default just after it. machine: index
        of the machine to which each angle belongs, where there are many.
        """
        drive = drive if machine is None else drive.taken(machine)
        return cls(drive, CrankAngle.of(degrees), degrees if within is None else within)

    @classmethod
    def on(cls, drive: Drive, pieces: Pieces) -> State:
        """Return the state at the nodes of pieces, (nodes, pieces); at a jump each piece has the value on its side."""
        return cls(drive.taken(pieces.machine), CrankAngle.at_nodes(pieces), pieces.middle)

    @property
    def without_pin_friction(self) -> State:
        """The state before friction in pins and journals; from its loads that friction is computed."""
        if self.with_pin_friction and self.drive.pin_friction:
            return self._frictionless
        # not kept: a state that referred to itself would stay in memory, with all its arrays
        return self

    @cached_property
    def _frictionless(self) -> State:
        state = State(self.drive, self.posed, self.within, with_pin_friction=False)
        state.slope = self.slope
        state.curvature = self.curvature
        state.piston_forces = self.piston_forces
        return state

    @property
    def rows(self) -> Mapping[str, QuantityRow]:
        """The rows of its columns, those of the mechanism among them."""
        return column_rows(State, self.mechanism.OFFERS)

    def filled(self, number: Number) -> Array:
        """Return a number as an array of the shape of the angles."""
        return np.broadcast_to(np.asarray(number, dtype=float), self.phi.shape)

    @column("P_zw", "force", extremes=("forces",), called="force in the rod between the pistons")
    def P_between(self) -> Number | None:
        """Force in the rod between the cylinder's piston and those in tandem, thrust toward the shaft positive.

        Their gas force, with their inertia and weight where `masses.piston` is a list of the masses of all.
        """
        drive = self.drive
        # tandem pistons are on the rod itself, without a lever
        tandem = list[Truth]()
        for gas in drive.gas:
            is_own = gas is drive.own_gas
            tandem.append(False if is_own else gas.piston.lever_ratio == 1)
        if not some(any_of(tandem)):
            return None
        force = self.force_of(tandem)
        masses = drive.cylinder.masses.pistons if drive.cylinder.masses else ()
        pistons = drive.cylinder.pistons
        if force is None or len(masses) != len(pistons):
            return force

        # with the masses of those in tandem
        on_rod = [mass * (piston.lever_ratio == 1) for mass, piston in zip(masses[1:], pistons[1:])]
        carried = total(*on_rod)
        if drive.has_inertia:
            force = force - self.b * carried
        return force + drive.weight_of(carried)[0]

    # the piston force

    P_inertia = value(
        "P_b",
        "force",
        "Inertia force −m b of the reciprocating masses",
        lambda state: (
            state.curvature * (-state.drive.mass * state.omega * state.omega)
            if state.drive.has_inertia
            else None
        ),
    )
    P_weight = value(
        "P_w",
        "force",
        "Weight of the reciprocating masses along the stroke line",
        lambda state: state.filled(state.drive.weight[0]) if state.drive.weight else None,
    )
    P_ram = value(
        "P_r",
        "force",
        "Force opposing the motion of a ram",
        lambda state: state.resistance if state.mechanism.slides else None,
    )

    @column(
        "P_L",
        "force",
        extremes=("forces",),
        called="load on what slides or swings",
    )
    def P_load(self) -> Array | None:
        """Load `force` on what slides, positive as P is; on what swings at its lever, positive where θ rises."""
        load = self.drive.load
        if load is None:
            return None
        force = load.constant_and_spring(self.displacement, self.drive.index)
        if load.profile is not None:
            force = force + self.pressure(load.profile)
        return self.filled(force)

    P = value(
        "P",
        "force",
        "Force along the stroke line: gas, inertia, weight and loads",
        lambda state: _sum(state.P_inertia, state.P_start),
        extremes=("forces",),
        called="piston force",
        peak=True,
    )
    P_rod = value(
        "P_G",
        "force",
        "Rod load at the crosshead pin: gas, inertia and weight, without the connecting rod; compression positive",
        lambda state: state.rod_load(),
        unless=lambda forces: forces.no_compressor,
    )
    P_piston_rod = value(
        "P_KS",
        "force",
        "The same at the piston rod, without the crosshead",
        lambda state: state.rod_load(crosshead=False),
        unless=lambda forces: forces.no_compressor,
    )
    P_start = value(
        "P_0",
        "force",
        "Force along the stroke line without inertia",
        lambda state: _sum(_sum(state.P_gas, state.P_weight), state.sliding_load),
        commands=(),
        extremes=("forces",),
        called="piston force without inertia: starting and slow running",
    )

    @cached_property
    def resistance(self) -> Array | None:
        """Load on the output against its motion, in N, or in N m where the output swings or turns."""
        resistance = self.drive.resistance
        if resistance is None:
            return None
        working_direction = 1.0 if self.mechanism.works_outward else -1.0
        works = self.direction == working_direction
        return self.filled(-self.direction * np.where(works, resistance.work, resistance.back))

    @property
    def output_load(self) -> Number | None:
        """All loads on the output in N, or in N m where it swings or turns; positive where x or θ rises."""
        load = self.drive.load
        if load is None:
            return self.resistance
        return _sum(self.resistance, self.P_load * spread(load.lever, self.drive.index))

    @property
    def sliding_load(self) -> Number | None:
        """All loads in N on what slides along the stroke line; None where the output swings or turns."""
        return self.output_load if self.mechanism.slides else None

    @property
    def driving_force(self) -> Number:
        """Force in N (moment in N m) at the output of pistons that drive, and of loads that drive."""
        drive = self.drive
        force: Number = 0.0 if self.P_driving is None else self.P_driving
        if some(drive.load_drives):
            force = force + self.output_load * spread(drive.load_drives, drive.index)
        return force

    def rod_load(self, crosshead: bool = True) -> Array | None:
        """Return the force in N of the gas, with inertia and weight of the moving parts, toward the shaft (API 618).

        The connecting rod is left out. crosshead: whether the crosshead is included; without it its mass must be known.
        None without a gas force, and in a mechanism without a connecting rod, where it would be P.
        """
        if self.P_gas is None or not self.mechanism.has_rod:
            return None
        masses = self.drive.cylinder.masses
        mass: Number = masses.parts if masses else 0.0
        if not crosshead:
            if masses is None or masses.crosshead is None:
                return None
            mass = masses.parts - masses.crosshead
        moved = self.P_gas - self.b * mass if self.drive.has_inertia else self.P_gas
        return moved + self.drive.weight_of(mass)[0]

    # the rod

    @column("S", "force", extremes=("forces",), called="rod force", peak=True)
    def S(self) -> Any:
        """Force in the connecting rod, compression positive; of an exact rod, the force between its two end masses.

        R 300.
        """
        if self.P is None or self.rod_angle is None:
            return None
        return self.along_stroke / self.rod_angle[1] - self._side_force_of_rod * self.rod_angle[0]

    @column("S_H", "force", extremes=("forces",), called="force along the rod at the crosshead pin")
    def S_crosshead(self) -> Array | None:
        """Force along an exact rod at the crosshead pin, compression positive.

        Inertia and weight of the rod's own mass at this end are excluded: they do not pass through the pin.
        """
        if self.P is None or self.drive.rod is None:
            return None
        push, lift = crosshead_pin_force(self)
        return push * self.rod_angle[1] + lift * self.rod_angle[0]

    @column("S_Z", "force", extremes=("forces",), called="force along the rod at the crank pin")
    def S_crank(self) -> Array | None:
        """Force along an exact rod at the crank pin, compression positive.

        T sin(φ+ψ) + D cos(φ+ψ), with T at the pin.
        """
        if self.P is None or self.drive.rod is None:
            return None
        (sin_psi, cos_psi), sin, cos = self.rod_angle, self.angle.sin, self.angle.cos
        return self.tangential_at_pin * (sin * cos_psi + cos * sin_psi) + self.D * (
            cos * cos_psi - sin * sin_psi
        )

    @cached_property
    def rod_couple(self) -> Number:
        """Couple of an exact rod in N m, (I_r − m_r a (L − a)) ψ̈ at uniform rotation; 0 without one."""
        rod, (sin_psi, cos_psi) = self.drive.rod, self.rod_angle or (0.0, 1.0)
        if rod is None or self.omega is None:
            return 0.0
        bend = formulas.rod_curvature(
            self.angle.sin, sin_psi, cos_psi, self.rod_slope, self.mechanism.lam
        )
        return bend * (rod.excess_inertia * self.omega * self.omega)

    def _side_force_of(self, couple: Number) -> Number:
        """Return the reduction of the guide force in N by a couple in N m on the rod: couple/(L cos ψ)."""
        return couple / (self.rod_angle[1] * self.mechanism.rod_length)

    @cached_property
    def _forward_sign(self) -> Array:
        """Sign of cos φ, +1 from 270° to 90°: there the pin moves toward its side of the outstroke."""
        turned = np.mod(self.within, 360.0)
        return np.where((turned < 90.0) | (turned >= 270.0), 1.0, -1.0)

    @cached_property
    def _side_force_of_friction(self) -> Number:
        """Side force in N by friction in both pins of the rod, or of the block in a Scotch yoke; 0 without friction."""
        if self.rod_angle is None:
            if not self.drive.yoke_rubs:
                return 0.0
            block, _ = self.drive.yoke_friction
            return np.abs(self.along_stroke) * self._forward_sign * block
        rubbing = self.rubbing
        if rubbing is None:
            return 0.0
        return self._side_force_of(rubbing.at_crank + rubbing.at_crosshead)

    @cached_property
    def _side_force_of_rod(self) -> Number:
        """Side force in N of all couples on the rod: inertia couple of an exact rod, and friction in its pins."""
        if self.drive.rod is None:
            return self._side_force_of_friction
        return self._side_force_of(self.rod_couple) + self._side_force_of_friction

    @cached_property
    def rubbing(self) -> FrictionMoments | None:
        """Moments of friction in pins and journals; None where there is none.

        The journals carry the force on the crank pin, distributed by the statics of the crankshaft if its lengths are
        given. Where several cylinders share a throw, each is assigned an equal part of its bearing loads.
        """
        drive = self.drive
        friction = drive.pin_friction if self.with_pin_friction else None
        if friction is None or self.P is None:
            return None
        pin = crank_pin_force(self.without_pin_friction)
        bearings: Number = np.hypot(*pin)
        if friction.line is not None and some(friction.journals != 0):
            names = [cylinder.name for cylinder in drive.machine.cylinders]
            cylinder = names.index(drive.name)
            throw = friction.line.throw_of(cylinder)
            count = len(throw.cylinders)
            # as though all rods on the pin loaded it alike, in the place of this one
            rods = [0 * pin.complex for _ in throw.cylinders]
            rods[throw.cylinders.index(cylinder)] = count * pin.complex
            reactions = friction.line.reactions(throw, rods, drive.cylinder, self.angle)
            bearings = sum(np.abs(force) for force in reactions) / count
        at_crank = np.hypot(*pin) * friction.crank_pin
        at_crosshead: Number = 0.0
        if self.rod_angle is not None:  # the rod turns by −dψ, which friction opposes
            load = np.hypot(*crosshead_pin_force(self.without_pin_friction))
            at_crosshead = load * (self._forward_sign * friction.crosshead_pin)
        return FrictionMoments(at_crank, at_crosshead, bearings * friction.journals)

    # link rods

    @property
    def linked_piston(self) -> LinkedPiston:
        """Its mechanism, of a cylinder with a link rod."""
        return cast("LinkedPiston", self.mechanism)

    @cached_property
    def _knuckle_inertia(self) -> Any:
        """Inertia force −m_k ω² z″ in N of a link rod's mass at its knuckle pin, complex in the own frame."""
        mass, omega = self.drive.knuckle_mass, self.omega
        _, acceleration = self.linked_piston.knuckle_motion(self.angle)
        if omega is None:
            return 0.0 * acceleration
        return acceleration * (-mass * omega * omega)

    @property
    def _knuckle_inertia_on_pin(self) -> Any:
        """What reaches the crank pin of that force, in N, in the frame of the throw: −D + iT."""
        return self.linked_piston.force_on_pin(self.angle, self._knuckle_inertia)

    @property
    def knuckle_inertia_torque(self) -> Number:
        """Torque −m_k ω² Re(z′* z″) in N m of that force."""
        speed, _ = self.linked_piston.knuckle_motion(self.angle)
        torque: Number = (np.conj(speed) * self._knuckle_inertia).real
        return torque

    @property
    def knuckle_momentum_rate(self) -> Number:
        """Rate m_k ω² Im(z* z″) in N m of the moment of momentum of that mass about the shaft."""
        knuckle = self.linked_piston.knuckle_place(self.angle)
        rate: Number = -(np.conj(knuckle) * self._knuckle_inertia).imag
        return rate

    @cached_property
    def knuckle_force(self) -> Any:
        """Force Q = −P (1 − i tan ψ) − m_k ω² z″ in N of a link rod on its knuckle pin, complex in the own frame."""
        if self.P is None:
            return None
        sin_psi, cos_psi = self.rod_angle
        return self._knuckle_inertia - self.along_stroke * (1 - 1j * (sin_psi / cos_psi))

    @property
    def knuckle_moment(self) -> Any:
        """Moment M_K in N m of that force on the master rod about the crank pin."""
        if self.knuckle_force is None:
            return None
        return self.linked_piston.moment_on_master(self.angle, self.knuckle_force)

    @cached_property
    def _side_force_of_links(self) -> Number:
        """Side force ΣM_K/(L cos ψ) in N that the link rods take from the guide of a master; 0 without them."""
        if not self.drive.links:
            return 0.0
        return self._side_force_of(self._moment_of_links)

    @property
    def moment_on_master(self) -> Any:
        """Moment in N m on the master rod about the crank pin: of a link rod its own, of a master that of its links."""
        if self.P is None:
            return None
        if self.drive.cylinder.link_rod is not None:
            return self.knuckle_moment
        if not self.drive.links:
            return None
        return self._moment_of_links

    @cached_property
    def links(self) -> list[State]:
        """The states of the cylinders whose link rods are on this master rod, at the same angles of the shaft."""
        states = []
        for link in self.drive.links:
            lag = self.drive.lag_of(link)
            states.append(State(link, CrankAngle.of(self.phi - lag), self.within - lag))
        return states

    @cached_property
    def _moment_of_links(self) -> Number:
        """Moment ΣM_K in N m of the link rods on this master rod."""
        moments: Number = 0.0
        for link in self.links:
            moment = link.knuckle_moment
            if moment is not None:
                # not in place: the first may be an array of the link
                moments = moments + moment
        return moments

    # the guide

    @cached_property
    def pressure_difference(self) -> Number:
        """Pressure difference in Pa across the cylinder's own piston, head end less crank end."""
        gas = self.drive.own_gas
        if gas is None:
            return 0.0
        head: Number = self.pressure(gas.head) if gas.head else 0.0
        crank: Number = self.pressure(gas.crank) if gas.crank else 0.0
        return head - crank

    @cached_property
    def steady_friction(self) -> Number:
        """Friction force in N of the piston rings and of `friction: constant`, which are independent of N."""
        drive = self.drive
        if not some(drive.ring_surface != 0):
            return drive.constant_friction
        by_gas = np.abs(self.pressure_difference) * drive.ring_surface
        return drive.constant_friction + by_gas

    @cached_property
    def after_steady_friction(self) -> Number:
        """Piston force P in N less the steady friction; acts on the crosshead."""
        steady = self.steady_friction
        if some(steady != 0):
            return self.P - self.direction * steady
        return self.P

    @cached_property
    def guide_numerator(self) -> Number:
        """Numerator of N: P sin ψ + G cos ψ in N, G: weight on the guide less side forces of couples."""
        sin_psi, cos_psi = self.rod_angle or (0.0, 1.0)
        return (
            self.after_steady_friction * sin_psi
            + (self.drive.guide_weight - self._side_force_of_rod - self._side_force_of_links)
            * cos_psi
        )

    @cached_property
    def guide_sign(self) -> Array:
        """Sign of N, +1 for N = 0: one for each angle, or for each piece at the nodes of pieces."""
        numerator = self.guide_numerator
        if np.ndim(self.angle.sin) > 1:
            # of a piece, that of its mean
            numerator = rule(len(self.phi)).weights @ numerator
        elif self.within is not self.phi:
            # next to a jump, that of the angles on its side
            angle = CrankAngle.of(self.within)
            beside = State(self.drive, angle, self.within, self.with_pin_friction)
            numerator = beside.guide_numerator
        return np.where(numerator >= 0, 1.0, -1.0)

    @property
    def guide_denominator(self) -> Array:
        """Denominator of N: cos ψ + f sin ψ sgn c sgn N; ≤ 0 where the crosshead is self-locking."""
        sin_psi, cos_psi = self.rod_angle
        return cos_psi + sin_psi * (
            self.guide_sign * self.direction * self.drive.crosshead_friction
        )

    @cached_property
    def drag_of_guides(self) -> Number:
        """Friction 2 f_g |P R sin φ|/l_g in N of the guides of a Scotch yoke, magnitude; 0 for another mechanism."""
        _, f = self.drive.yoke_friction
        if not some(f != 0):
            return 0.0
        pair = self.mechanism.guide_pair_factor(self.angle)
        if pair is None:
            return 0.0
        return np.abs(self.after_steady_friction * pair) * (2 * f)

    @column("N", "force", extremes=("forces",), called="guide force", peak=True)
    def N(self) -> Any:
        """Force on the guide (yoke frame: on the piston rod), positive on the side loaded while an engine drives.

        D 3 with signs. Raises NoSolutionError where the crosshead is self-locking; one of many machines then has nan.
        """
        drive = self.drive
        if self.P is None:
            return None
        if self.rod_angle is None:
            if not self.mechanism.known_across or not (drive.weight or drive.yoke_rubs):
                return None
            return self.filled(drive.guide_weight - self._side_force_of_friction)
        if not drive.rubs:
            sin_psi, cos_psi = self.rod_angle
            of_couples = drive.guide_weight - self._side_force_of_rod - self._side_force_of_links
            return self.after_steady_friction * (sin_psi / cos_psi) + of_couples
        denominator = self.guide_denominator
        is_locked = denominator <= 0
        if is_locked.any():
            if drive.index is None:
                raise NoSolutionError(drive.locks(float(self.phi[is_locked][0])))
            denominator = np.where(is_locked, np.nan, denominator)
        return self.guide_numerator / denominator

    M_knuckle = value(
        "M_An",
        "torque",
        "Moment of the link rods on the master rod about the crank pin, of a link rod its own one",
        lambda state: state.moment_on_master,
        extremes=("forces",),
        called="moment of the link rods on the master rod",
    )

    @property
    def drag(self) -> Number:
        """Friction along the stroke line in N, magnitude."""
        return self.crosshead_drag + self.drag_of_guides + self.steady_friction

    @property
    def crosshead_drag(self) -> Number:
        """Crosshead friction f |N| in N, magnitude."""
        if not self.drive.rubs:
            return 0.0
        return self.N * (self.guide_sign * self.drive.crosshead_friction)

    p_guide = value(
        "p_g",
        "pressure",
        "Mean pressure of the crosshead shoe on its guide, |N| over its area",
        lambda state: (
            None
            if state.drive.guide_area is None or state.N is None
            else abs(state.N) / state.drive.guide_area
        ),
    )
    wear = value(
        "f N c",
        "power",
        "Friction power on the guide, the measure of its wear (Redtenbacher)",
        lambda state: (
            None
            if state.p_guide is None or state.c is None
            else state.crosshead_drag * state.c * state.direction
        ),
    )

    # the crank pin

    @column("D", "force")
    def D(self) -> Any:
        """Radial force at the crank pin, positive toward the shaft.

        R 302; for an exact rod less the centrifugal force of its mass at the crank pin, with its couple and weight.
        """
        rod = self.drive.rod
        radial = None if self.P is None else self.mechanism.radial(self.posed)
        if radial is None:
            return None
        push = self.along_stroke * radial + self._side_force_of_rod * self.angle.sin
        if self.drive.cylinder.link_rod is not None:
            push = push - self._knuckle_inertia_on_pin.real
        if rod is None:
            return push
        along, across = self.drive.weight_of(rod.pin_mass)
        weight = self.angle.cos * along + self.angle.sin * across
        return push - self.drive.centrifugal(rod.pin_mass) + weight

    M_out = value(
        "M_2",
        "torque",
        "Moment of the load on the rocker, or on the second crank",
        lambda state: None if state.mechanism.slides else state.output_load,
    )

    @property
    def _output(self) -> Any:
        """Force in N (moment in N m) at the output, less friction, from which virtual work gives T and M."""
        if self.mechanism.slides:
            return self.along_stroke
        return self.M_out

    @cached_property
    def _rod_tangential(self) -> Number:
        """Contribution to T in N of the couple and the weight at the crank pin of an exact rod; 0 for another.

        Of a link rod that of its mass at the knuckle pin.
        """
        if self.drive.cylinder.link_rod is not None:
            return self.knuckle_inertia_torque / self.mechanism.crank
        if self.drive.rod is None:
            return 0.0
        along, across = self.drive.weight_of(self.drive.rod.pin_mass)
        return (self.angle.sin * along - self.angle.cos * across) - self._side_force_of(
            self.rod_couple
        ) * self.angle.cos

    @cached_property
    def _pushed_along(self) -> Any:
        """Tangential force in N before friction in pins, journals and the block of a yoke; None without a force."""
        if self._output is None:
            return None
        return self._output * (self.slope / self.mechanism.crank) + self._rod_tangential

    @column("T", "force", extremes=("forces",), called="tangential force", peak=True)
    def T(self) -> Any:
        """Tangential force M/R: the torque on the shaft over the crank radius, positive when it drives.

        R 303: T R dφ = P dx, less the friction of pins and journals, where it is given.
        """
        if self._pushed_along is None:
            return None
        return self._pushed_along - sum(self.losses.values(), start=0.0) / self.mechanism.crank

    @column("T_Z", "force")
    def T_pin(self) -> Any:
        """Tangential force of the rod on the crank pin, the T of the books (R 303), where it is not M/R.

        It lacks the moments of friction in pin and journals, which T includes.
        """
        if not self.drive.pin_friction:
            return None
        return self.tangential_at_pin

    @cached_property
    def tangential_at_pin(self) -> Any:
        """Tangential force in N of the rod on the crank pin; None without a force."""
        if self._pushed_along is None:
            return None
        return self._pushed_along - self.angle.cos * self._side_force_of_friction

    F_friction = value(
        "F_f",
        "force",
        "Friction along the stroke line, opposing the motion",
        lambda state: (
            None
            if state.P is None or state.drive.cylinder.friction is None
            else state.filled(state.drag * -state.direction)
        ),
    )

    @column("N_f", "power")
    def friction_power(self) -> Number | None:
        """Power lost by friction at all places that are given."""
        omega = self.omega
        if (
            self.P is None
            or self.drive.cylinder.friction is None
            or self.c is None
            or omega is None
        ):
            return None
        sliding = self.drag * self.direction * self.c
        rubbing = sum(self.losses.values(), start=0.0) * omega
        return self.filled(sliding + rubbing)

    @cached_property
    def along_stroke(self) -> Number:
        """Component S cos ψ of the rod force along the stroke line in N: the piston force less all friction."""
        if self.P is None or self.drive.cylinder.friction is None:
            return self.P
        return self.P - self.drag * self.direction

    @cached_property
    def losses(self) -> dict[str, Number]:
        """Torque in N m lost by friction in pins, journals and the block of a yoke, by the keys in `friction`."""
        rubbing = self.rubbing
        lost = dict[str, Number]()
        if rubbing is not None:
            lost["crank_pin"] = rubbing.at_crank * (1 + self.rod_slope)
            lost["crosshead_pin"] = rubbing.at_crosshead * self.rod_slope
            lost["journals"] = rubbing.journals
        if self.drive.yoke_rubs:
            lost["block"] = self._side_force_of_friction * self.angle.cos * self.mechanism.crank
        return lost

    @column("M", "torque", repeats=lambda forces: True)  # R T
    def M(self) -> Any:
        """Torque on the shaft.

        By virtual work of the force at the output, less what is lost in pins, journals and the block of a yoke.
        """
        if self._output is None:
            return None
        push = self._output * self.slope + self._rod_tangential * self.mechanism.crank
        return push - sum(self.losses.values(), start=0.0)


def crank_pin_force(state: State) -> PinForce:
    """Return the force of the rod on the crank pin in N, in the frame of the throw."""
    return PinForce(state.D - state.drive.rod_centrifugal_force, state.tangential_at_pin)


def crosshead_pin_force(state: State) -> CrossheadForce:
    """Return the force of the crosshead on its pin in N: components along P and along N, with their signs.

    Inertia and weight of the rod are excluded: along the stroke line it is the rod load less friction.
    """
    drive, masses = state.drive, state.drive.cylinder.masses
    of_rod = drive.mass - masses.parts if masses else 0.0
    along, across = drive.weight_of(of_rod)
    push = state.along_stroke + state.b * of_rod if drive.has_inertia else state.along_stroke
    return CrossheadForce(push - along, state.N - drive.guide_weight + across)


def reduced_inertia(state: State) -> Any:
    """Return the reduced moment of inertia of a cylinder's moving masses in kg m²: m x′² + m_pin R² + I_excess ψ′².

    Of a link rod also m_k |z′|² of its mass at the knuckle pin.
    """
    drive, rod = state.drive, state.drive.rod
    inertia = state.slope * state.slope * drive.mass + drive.pin_inertia
    if drive.cylinder.link_rod is not None:
        speed, _ = state.linked_piston.knuckle_motion(state.angle)
        inertia = inertia + drive.knuckle_mass * np.abs(speed) ** 2
    if rod is None:
        return inertia
    return inertia + state.rod_slope * state.rod_slope * rod.excess_inertia


def _sum(first: Any, second: Any) -> Any:
    """Return the sum of two forces, of which each may be None."""
    if first is None:
        return second
    if second is None:
        return first
    return first + second
