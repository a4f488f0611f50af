"""One cylinder with its crank mechanism: the masses, weights, pressures and frictions that act on it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np

from kurbel.arrays import Indices, Number, Truth
from kurbel.crank_angle import CrankAngle
from kurbel.declared.units import GRAVITY
from kurbel.machine import CYCLES, Cylinder, Machine
from kurbel.machine.batch import taken
from kurbel.machine.cylinder import crank_lag
from kurbel.machine.parts import GasOnRings, Piston, Rings
from kurbel.numerics.arithmetic import some
from kurbel.numerics.pieces import Angles, Pieces
from kurbel.solver.gas import PistonGas
from kurbel.solver.motion import every_dead_centre

if TYPE_CHECKING:
    from kurbel.mechanisms.link_rod import LinkedPiston
    from kurbel.solver.output_load import OutputLoad
    from kurbel.solver.shaft import SupportedShaft

_IDLE = 1e-4
"""Mean indicated pressure in Pa that is rounding: such a piston neither drives nor is driven."""
_DENSE = 600
"""Breaks of a cycle, as at the samples of a trace, from which on its pieces are short enough for 6 nodes."""
_DENSEST = 200_000
"""The same for 4 nodes: what cubics miss on so short pieces is rounding."""


class ExactRod(NamedTuple):
    """A connecting rod of mass m_r, centre of gravity at a from the crosshead pin and moment of inertia I_r about it.

    It moves like a mass m_r a/L at the crank pin, m_r (1 − a/L) at the crosshead pin, in kg, and a couple
    (I_r − m_r a (L − a)) ψ̈ in N m: excess_inertia in kg m². It takes the place of the ½ to ⅔ of R 298. The first mass pulls at the pin with its
    centrifugal force and its weight, the second moves to and fro with the piston.
    """

    pin_mass: Number
    crosshead_mass: Number
    excess_inertia: Number


class PinFriction(NamedTuple):
    """f times the radius in m of the pins of a rod and the journals of its throw, 0 where one is not given.

    line: of the crankshaft, by which the journals carry the force on the pin; None where it is not known.
    """

    crank_pin: Number
    crosshead_pin: Number
    journals: Number
    line: SupportedShaft | None


class Drive:
    """A cylinder of a machine: its numbers as the state at crank angles needs them, in SI.

    count: number of machines, whose numbers are then arrays (machines,); None for one machine. index: in a copy made by
    `taken`, the machine of every angle or piece (n,).

    lag: δ in degrees, by which its own crank angle lags that of cylinder 1; see `crank_lag`.

    revolutions, cycle: turns and degrees of crank angle per working cycle of this cylinder; omega: rad/s or None.

    mass: reciprocating, 0 without masses; rod: a connecting rod given by centre of gravity and moment of inertia, else
    None; rod_centrifugal_force: m R ω² of the rotating part of another rod, which D of R 302 excludes (that of an exact
    rod is included); knuckle_mass: of a link rod at its knuckle pin; pin_inertia: m R² of what rotates with the crank pin;
    has_inertia: masses and a speed are given.

    weight: of the reciprocating masses along the stroke line and on the guide, None where it is left out; down: cos of
    the inclination i (180° − i if the machine turns under), None without one: if positive, N > 0 loads the lower guide.

    resistance: load on the output against its motion, a force, or a moment on what only swings; resistance_work: its
    work per cycle, negative but where it helps more; path: distance per cycle of what slides, there and back.

    crosshead_friction: f, 0 without one; rubs: whether it is not 0; guide_area: of the shoe, None where not given;
    yoke_friction: f of the block and of the guides of a Scotch yoke, 0 where not given; yoke_rubs: whether either is
    not 0; ring_force: n π d h p_r f in N (D, Kolbenreibung); ring_surface: n π d h k f in m² of rings that the gas
    presses; constant_friction: ring_force and the friction given as a force.
    """

    def __init__(
        self,
        machine: Machine,
        cylinder: Cylinder,
        count: int | None = None,
        index: Indices | None = None,
    ) -> None:
        self.machine, self.cylinder, self.count, self.index = machine, cylinder, count, index
        self.name, self.mechanism = cylinder.name, cylinder.mechanism
        self.lag = crank_lag(cylinder, machine.cylinders[0])
        self.revolutions = CYCLES[machine.cycle_of(cylinder)]
        self.cycle = 360.0 * self.revolutions
        self.omega = None if machine.speed is None else 2 * math.pi * machine.speed

        self._take_masses()
        self.has_inertia = cylinder.masses is not None and self.omega is not None
        self._take_weight()
        self._take_resistance()
        self.has_gas = any(piston.indicator for piston in cylinder.pistons)
        has_load = self.resistance is not None or cylinder.force is not None
        self.has_force = bool(self.has_gas or self.has_inertia or self.weight or has_load)
        self._take_friction()

    def _take_masses(self) -> None:
        """Set the masses that move: to and fro, at the crank pin, of an exact rod, and at a knuckle pin."""
        masses, length = self.cylinder.masses, self.mechanism.rod_length
        self.mass: Number = 0.0
        self.pin_inertia: Number = 0.0
        self.rod: ExactRod | None = None
        self.rod_centrifugal_force: Number = 0.0
        self.knuckle_mass: Number = 0.0
        if self.cylinder.link_rod is not None:
            self.knuckle_mass = self.cylinder.link_rod.knuckle_mass
        if not masses:
            return
        self.mass = masses.at_crosshead(length)
        self.pin_inertia = masses.at_pin(length) * self.mechanism.crank**2
        rod = masses.connecting_rod
        if rod is not None and rod.exact:
            self.rod = ExactRod(
                rod.at_pin(length), rod.at_crosshead(length), rod.excess_inertia(length)
            )
        elif rod is not None:
            self.rod_centrifugal_force = self.centrifugal(rod.mass * (1 - rod.share))

    def _take_weight(self) -> None:
        """Set the weight along the stroke line and on the guide, where the inclination is known."""
        inclination = self.machine.inclination_of(self.cylinder)
        self._incline = None if inclination is None else CrankAngle.of(inclination)
        self.down = self._incline and self._incline.cos
        self.weight: tuple[Number, Number] | None = None
        self.guide_weight: Number = 0.0
        if self._incline and self.cylinder.masses:
            self.weight = self.weight_of(self.mass)
            self.guide_weight = self.weight[1]

    def _take_resistance(self) -> None:
        """Set what the output works against, its work per cycle in J, and the path of the output per cycle in m."""
        stroke = self.mechanism.stroke
        self.resistance = self.cylinder.ram_force or self.cylinder.moment
        self.resistance_work: Number | None = None
        self.path: Number = 2 * stroke * self.revolutions
        if self.resistance:
            forces = self.resistance.work
            if not self.mechanism.turns:
                forces = forces + self.resistance.back
            self.resistance_work = -forces * stroke * self.revolutions

    def _take_friction(self) -> None:
        """Set coefficients of what slides, and forces of rings and of `friction: constant` in N."""
        friction = self.cylinder.friction
        self.crosshead_friction: Number = 0.0
        self.yoke_friction: tuple[Number, Number] = (0.0, 0.0)
        self.guide_area: Any = None
        self.ring_force: Number = 0.0
        self.ring_surface: Number = 0.0
        self.constant_friction: Number = 0.0
        if friction:
            self.crosshead_friction = _or_none_at_all(friction.crosshead)
            self.yoke_friction = (
                _or_none_at_all(friction.block),
                _or_none_at_all(friction.guides),
            )
            if friction.guide:
                self.guide_area = friction.guide.length * friction.guide.width
            if friction.rings:
                self._take_rings(friction.rings)
            self.constant_friction = self.ring_force + _or_none_at_all(friction.constant)
        self.rubs = some(self.crosshead_friction != 0)
        self.yoke_rubs = any(some(coefficient != 0) for coefficient in self.yoke_friction)

    def _take_rings(self, rings: Rings) -> None:
        """Set the force in N of the rings by their spring, or its ratio to the pressure in m² by the gas behind them."""
        bore = self.cylinder.pistons[0].bore
        surface: Number = rings.count * math.pi * bore * rings.height * rings.coefficient
        if isinstance(rings.pressure, GasOnRings):
            self.ring_surface = surface * rings.pressure.gas
        else:
            self.ring_force = surface * rings.pressure

    def taken(self, index: Indices) -> Drive:
        """Return a copy with the numbers of these machines, one for every angle or piece (n,)."""
        if self.count is None:
            return self
        other = Drive(taken(self.machine, index), taken(self.cylinder, index), self.count, index)
        other.gas = self.gas
        other.load = self.load
        other.driving, other.driven, other.pumping = self.driving, self.driven, self.pumping
        other.load_drives = self.load_drives
        return other

    @cached_property
    def links(self) -> tuple[Drive, ...]:
        """The cylinders whose link rods are on the master rod of this one; of many machines with their numbers."""
        links = []
        for cylinder in self.machine.cylinders:
            if cylinder.hangs_on(self.name):
                links.append(Drive(self.machine, cylinder, self.count, self.index))
        return tuple(links)

    def lag_of(self, link: Drive) -> Number:
        """Return the degrees by which the crank angle of a link lags that of this master: Γ, and turns of its firing."""
        between = cast("LinkedPiston", link.mechanism).between
        turns = np.round((link.lag - self.lag - between) / 360.0)
        lag: Number = between + 360.0 * turns
        return lag

    @property
    def pieces(self) -> Pieces:
        """The cycle between the angles at which something bends or jumps: dead centres and the corners of cards."""
        count = self.count or 1
        centres = every_dead_centre(self.mechanism, count, self.cycle)
        bends = [Angles(np.repeat(np.arange(count), centres.shape[1]), centres.ravel())]
        for gas in self.gas:
            bends += gas.starts
        if self.load is not None:
            bends += self.load.starts
        # the guide of a master rod feels where something bends or jumps in its links
        for link in self.links:
            ends = link.pieces.ends
            owners = np.repeat(np.arange(count), len(ends) // count)
            bends.append(Angles(owners, np.mod(ends + self.lag_of(link), self.cycle)))
        machine = np.concatenate([angles.machine for angles in bends])
        degrees = np.concatenate([angles.degrees for angles in bends])
        nodes = 16
        if len(degrees) >= _DENSE * count:
            nodes = 6
        if len(degrees) >= _DENSEST * count:
            nodes = 4
        return Pieces.between(Angles(machine, degrees), count, self.cycle, nodes)

    def centrifugal(self, mass: Number) -> Number:
        """Return the centrifugal force m R ω² in N of a mass in kg at the crank pin; 0 where no speed is given."""
        # a float squared by ** raises where the product is infinite
        if self.omega is None:
            return 0.0
        return mass * self.mechanism.crank * self.omega * self.omega

    def weight_of(self, mass: Number) -> tuple[Number, Number]:
        """Return the weight in N of a mass in kg along the stroke line and on the guide; 0 where it is left out."""
        incline = self._incline
        if not incline:
            return 0.0, 0.0
        return mass * GRAVITY * incline.sin, mass * GRAVITY * incline.cos

    # pressures

    @cached_property
    def pistons(self) -> tuple[Piston, ...]:
        """Its pistons, with the cards that a valve and a compressible liquid give them."""
        pistons = self.cylinder.timed_pistons
        if self.machine.pump is None:
            return pistons
        liquid = self.machine.pump.liquid
        return tuple(liquid.compressed(piston) for piston in pistons)

    @cached_property
    def gas(self) -> tuple[PistonGas, ...]:
        """Pressures on the pistons that have an indicator."""
        gases = []
        for number, piston in enumerate(self.pistons):
            if piston.indicator:
                turns = CYCLES[self.machine.cycle_of_piston(self.cylinder, number)]
                repeats, ambient = self.revolutions // turns, self.machine.ambient
                gas = PistonGas(
                    piston, self.mechanism, 360.0 * turns, ambient, repeats, self.count, number
                )
                gases.append(gas)
        return tuple(gases)

    @property
    def own_gas(self) -> PistonGas | None:
        """Pressures on the cylinder's own piston."""
        pistons = self.cylinder.pistons
        return self.gas[0] if pistons and pistons[0].indicator else None

    @property
    def noise(self) -> float:
        """Standard deviation in N of the noise that traces bring into the gas force."""
        return math.hypot(*(gas.noise for gas in self.gas))

    @cached_property
    def driving(self) -> tuple[Truth, ...]:
        """Of the pistons that have an indicator, whether each drives: its indicated work is positive."""
        return tuple(gas.work > _IDLE * gas.swept_volume for gas in self.gas)

    @cached_property
    def pumping(self) -> tuple[Truth, ...]:
        """Of the pistons that have an indicator, whether each is driven: its indicated work is negative."""
        return tuple(gas.work < -_IDLE * gas.swept_volume for gas in self.gas)

    # the load on the output

    @cached_property
    def load(self) -> OutputLoad | None:
        """The load `force` on what slides or swings; None without one."""
        force = self.cylinder.force
        if force is None:
            return None
        from kurbel.solver.output_load import OutputLoad

        return OutputLoad(force, self.mechanism, self.revolutions, self.count)

    @property
    def output_work(self) -> Number:
        """Work in J per cycle of all loads on the output, negative where the machine moves them."""
        work: Number = 0.0 if self.resistance_work is None else self.resistance_work
        return work if self.load is None else work + self.load.work

    @cached_property
    def load_drives(self) -> Truth:
        """Whether the loads on the output do more work on it than they take, as a load that is lowered."""
        drives: Truth = self.output_work > 0
        return drives

    @property
    def drives(self) -> Truth:
        """Whether any piston drives, or the load on the output."""
        return any_of((self.load_drives, *self.driving))

    @cached_property
    def driven(self) -> Truth:
        """Whether a piston is driven, its indicated work being negative, or the output works against a load."""
        return any_of((self.output_work < 0, *self.pumping))

    # friction

    @cached_property
    def pin_friction(self) -> PinFriction | None:
        """Friction in the pins of the rod and in the journals; None where no coefficient of it is given."""
        friction, shaft = self.cylinder.friction, self.machine.crankshaft
        if friction is None:
            return None
        coefficients = (friction.crank_pin, friction.crosshead_pin, friction.journals)
        if not any(some(_or_none_at_all(coefficient) != 0) for coefficient in coefficients):
            return None
        pin, journal = friction.crank_pin_diameter, friction.journal_diameter
        if self.mechanism.rubbing_pin is not None:
            pin = self.mechanism.rubbing_pin
        if shaft:
            pin = shaft.pin_diameter if pin is None else pin
            journal = shaft.journal_diameter if journal is None else journal
        at_pin = _moment_arm(friction.crank_pin, pin)
        at_crosshead = _moment_arm(friction.crosshead_pin, friction.crosshead_pin_diameter)
        at_journals = _moment_arm(friction.journals, journal)
        line = None
        if shaft:
            from kurbel.solver.shaft import SupportedShaft, shaft_obstacle

            line = None if shaft_obstacle(self.machine) else SupportedShaft(self.machine)
        return PinFriction(at_pin, at_crosshead, at_journals, line)

    def locks(self, degrees: float) -> str:
        """Return why no forces are computed for a crosshead that locks itself at this angle."""
        f = self.crosshead_friction
        bound = 1 / np.sqrt(1 + f * f)
        return (
            f"{self.name}: the crosshead locks itself near φ = {degrees % 360:.4g}°, where the machine is driven "
            f"and f tan ψ ≥ 1 (f = {f:g}); a driven machine needs (R + |e|)/L < 1/√(1 + f²) = {bound:.6g}"
        )


def _or_none_at_all(coefficient: Number | None) -> Number:
    """Return a coefficient or force of friction, 0 where it is not given."""
    return 0.0 if coefficient is None else coefficient


def _moment_arm(f: Number | None, diameter: Number | None) -> Number:
    """Return f d/2 in m, the moment of friction over the load; 0 where one of both is not given."""
    if f is None or diameter is None:
        return 0.0
    return f * diameter / 2


def any_of(conditions: Iterable[Truth]) -> Truth:
    """Return whether any of the conditions holds, each a bool or one of every machine, (machines,)."""
    holds: Truth = False
    for condition in conditions:
        holds = holds | condition
    return holds
