"""One cylinder with its crank mechanism: the masses, weights, pressures and frictions that act on it."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Indices
from kurbel.crank_angle import CrankAngle
from kurbel.declared.units import GRAVITY
from kurbel.machine import CYCLES, Cylinder, Machine
from kurbel.machine.batch import taken
from kurbel.machine.parts import RamForce
from kurbel.numerics.arithmetic import some
from kurbel.numerics.pieces import Angles, Pieces
from kurbel.solver.gas import PistonGas
from kurbel.solver.motion import every_dead_centre
from kurbel.solver.shaft import SupportedShaft, shaft_obstacle

_IDLE = 1e-4
"""Mean indicated pressure in Pa that is rounding: such a piston neither drives nor is driven."""
_DENSE = 600
"""Breaks of a cycle, as at the samples of a trace, from which on its pieces are short enough for 6 nodes."""


class ExactRod(NamedTuple):
    """A connecting rod of mass m_r, centre of gravity at a from the crosshead pin and moment of inertia I_r about it.

    It moves like a mass m_r a/L at the crank pin, m_r (1 − a/L) at the crosshead pin, in kg, and a couple
    (I_r − m_r a (L − a)) ψ̈ in N m: excess_inertia in kg m² (R 298). The first mass pulls at the pin with its
    centrifugal force and its weight, the second moves to and fro with the piston.
    """

    pin_mass: Any
    crosshead_mass: Any
    excess_inertia: Any


class PinFriction(NamedTuple):
    """f times the radius in m of the pins of a rod and the journals of its throw, 0 where one is not given.

    line: of the crankshaft, by which the journals carry the force on the pin; None where it is not known.
    """

    crank_pin: Any
    crosshead_pin: Any
    journals: Any
    line: SupportedShaft | None


class Drive:
    """A cylinder of a machine: its numbers as the state at crank angles needs them.

    revolutions, cycle: turns and degrees of crank angle per working cycle of this cylinder; omega: rad/s or None.
    count: number of machines, whose numbers are then arrays (machines,); None for one machine. index: in a copy made by
    `taken`, the machine of every angle or piece (n,), to which its numbers belong.
    """

    def __init__(
        self, machine: Machine, cylinder: Cylinder, count: int | None = None, index: Indices | None = None
    ) -> None:
        self.machine, self.cylinder, self.count, self.index = machine, cylinder, count, index
        self.name, self.mechanism = cylinder.name, cylinder.mechanism
        self.revolutions = CYCLES[machine.cycle_of(cylinder)]
        self.cycle = 360.0 * self.revolutions

    def taken(self, index: Indices) -> Drive:
        """Return a copy with the numbers of these machines, one for every angle or piece (n,)."""
        if self.count is None:
            return self
        other = Drive(taken(self.machine, index), taken(self.cylinder, index), self.count, index)
        other.gas, other.driving, other.driven = self.gas, self.driving, self.driven
        return other

    @cached_property
    def pieces(self) -> Pieces:
        """The cycle between the angles at which something bends or jumps: dead centres and the corners of cards."""
        count = self.count or 1
        centres = every_dead_centre(self.mechanism, count, self.cycle)
        breaks = Angles(np.repeat(np.arange(count), centres.shape[1]), centres.ravel())
        jumps = [breaks, *(starts for gas in self.gas for starts in gas.starts)]
        whole = Angles(*(np.concatenate(parts) for parts in zip(*jumps)))
        return Pieces.between(whole, count, self.cycle, 16 if len(whole.degrees) < _DENSE * count else 6)

    # masses and weights

    @cached_property
    def omega(self) -> Any:
        """Angular velocity in rad/s, None where no speed is given."""
        return None if self.machine.speed is None else 2 * math.pi * self.machine.speed

    @cached_property
    def mass(self) -> Any:
        """Reciprocating mass in kg, 0 without masses."""
        masses = self.cylinder.masses
        return masses.at_crosshead(self.mechanism.rod_length) if masses else 0.0

    @cached_property
    def rod(self) -> ExactRod | None:
        """The connecting rod, where it is described by centre of gravity and moment of inertia."""
        masses, length = self.cylinder.masses, self.mechanism.rod_length
        rod = masses.connecting_rod if masses else None
        if rod is None or not rod.exact:
            return None
        return ExactRod(rod.at_pin(length), rod.at_crosshead(length), rod.excess_inertia(length))

    @cached_property
    def rod_pull(self) -> Any:
        """Centrifugal force m R ω² in N of the connecting rod's part that turns with the pin, away from the shaft.

        Of a rod given by its `share` only: the D of an exact rod contains it already, that of R 302 does not.
        """
        rod = self.cylinder.masses.connecting_rod if self.cylinder.masses else None
        return 0.0 if rod is None or rod.exact else self.centrifugal(rod.mass * (1 - rod.share))

    def centrifugal(self, mass: Any) -> Any:
        """Return the centrifugal force m R ω² in N of a mass in kg at the crank pin; 0 where no speed is given."""
        # a float squared by ** raises where the product is infinite
        return 0.0 if self.omega is None else mass * self.mechanism.crank * self.omega * self.omega

    @cached_property
    def pin_inertia(self) -> Any:
        """Moment of inertia m R² in kg m² of what turns with the crank pin."""
        masses = self.cylinder.masses
        return masses.at_pin(self.mechanism.rod_length) * self.mechanism.crank**2 if masses else 0.0

    @cached_property
    def _incline(self) -> CrankAngle | None:
        inclination = self.machine.lean_of(self.cylinder)
        return None if inclination is None else CrankAngle.of(inclination)

    @property
    def down(self) -> float | None:
        """cos of the inclination as the throw sees it: where it is positive, N > 0 rests on the lower guide."""
        return None if self._incline is None else float(self._incline.cos)

    @property
    def has_inertia(self) -> bool:
        """Whether inertia forces are known: there are masses and a speed."""
        return self.cylinder.masses is not None and self.omega is not None

    @cached_property
    def weight(self) -> tuple[Any, Any] | None:
        """Weight of the reciprocating masses in N along the stroke line and on the guide; None where it is left out."""
        return self.weight_of(self.mass) if self.cylinder.masses else None

    def weight_of(self, mass: Any) -> tuple[Any, Any] | None:
        """Return the weight in N of a mass in kg along the stroke line and on the guide; None where it is left out."""
        incline = self._incline
        return None if incline is None else (mass * GRAVITY * incline.sin, mass * GRAVITY * incline.cos)

    @property
    def guide_weight(self) -> Any:
        """Weight on the guide in N."""
        return self.weight[1] if self.weight else 0.0

    # pressures, and what the output works against

    @cached_property
    def gas(self) -> tuple[PistonGas, ...]:
        """Pressures on the pistons that have an indicator."""
        return tuple(self._gas_on(number) for number, one in enumerate(self.cylinder.pistons) if one.indicator)

    def _gas_on(self, number: int) -> PistonGas:
        turns = CYCLES[self.machine.cycle_of_piston(self.cylinder, number)]
        piston, ambient = self.cylinder.pistons[number], self.machine.ambient
        return PistonGas(piston, self.mechanism, 360.0 * turns, ambient, self.revolutions // turns, self.count)

    @property
    def noise(self) -> float:
        """Standard deviation in N of the noise that traces bring into the gas force."""
        return math.hypot(*(gas.noise for gas in self.gas))

    @property
    def own_gas(self) -> PistonGas | None:
        """Pressures on the cylinder's own piston."""
        pistons = self.cylinder.pistons
        return self.gas[0] if pistons and pistons[0].indicator else None

    @cached_property
    def driving(self) -> tuple[Any, ...]:
        """Of the pistons that have an indicator, whether each drives: its indicated work is positive."""
        return tuple(gas.work > _IDLE * gas.swept_volume for gas in self.gas)

    @property
    def drives(self) -> Any:
        """Whether any piston drives."""
        return any_of(self.driving)

    @cached_property
    def driven(self) -> Any:
        """Whether a piston is driven, its indicated work being negative, or the output works against a resistance."""
        resisted = self.resistance_work is not None and self.resistance_work != 0
        return any_of((resisted, *(gas.work < -_IDLE * gas.swept_volume for gas in self.gas)))

    @property
    def resistance(self) -> RamForce | None:
        """What the output works against: a force on what slides, a moment on what only swings."""
        return self.cylinder.ram_force or self.cylinder.moment

    @cached_property
    def resistance_work(self) -> Any:
        """Work in J per cycle that the resistance takes out, negative; None without one."""
        if self.resistance is None:
            return None
        strokes = self.resistance.work if self.mechanism.turns else self.resistance.work + self.resistance.back
        return -strokes * self.mechanism.stroke * self.revolutions

    @property
    def has_gas(self) -> bool:
        """Whether any piston has an indicator."""
        return any(piston.indicator for piston in self.cylinder.pistons)

    @cached_property
    def has_force(self) -> bool:
        """Whether any force acts along the stroke line, or a moment on what swings."""
        return self.has_gas or self.has_inertia or self.weight is not None or self.resistance is not None

    # friction

    @property
    def has_friction(self) -> bool:
        """Whether the machine names any friction."""
        return self.cylinder.friction is not None

    @cached_property
    def crosshead_friction(self) -> Any:
        """f of the crosshead; 0 without one."""
        friction = self.cylinder.friction
        return 0.0 if friction is None or friction.crosshead is None else friction.crosshead

    @property
    def rubs(self) -> bool:
        """Whether the crosshead rubs on its guide."""
        return some(self.crosshead_friction != 0)

    @property
    def guide_area(self) -> Any:
        """Area in m² of the crosshead's shoe; None where its size is not given."""
        guide = self.cylinder.friction.guide if self.cylinder.friction else None
        return guide.length * guide.width if guide else None

    @cached_property
    def ring_force(self) -> Any:
        """Friction force n π d h p_r f in N of the piston rings (D, Kolbenreibung); 0 without them."""
        rings = self.cylinder.friction.rings if self.cylinder.friction else None
        if rings is None:
            return 0.0
        bore = self.cylinder.pistons[0].bore
        return rings.count * math.pi * bore * rings.height * rings.pressure * rings.coefficient

    @cached_property
    def steady_friction(self) -> Any:
        """Friction in N that is constant over the stroke: of the piston rings, and what is given as a force."""
        friction = self.cylinder.friction
        return self.ring_force + (0.0 if friction is None or friction.constant is None else friction.constant)

    @cached_property
    def pin_friction(self) -> PinFriction | None:
        """Friction in the pins of the rod and in the journals; None where no coefficient of it is given."""
        friction, shaft = self.cylinder.friction, self.machine.crankshaft
        if friction is None or not (friction.crank_pin or friction.crosshead_pin or friction.journals):
            return None
        pin, journal = (shaft.pin_diameter, shaft.journal_diameter) if shaft else (None, None)

        def arm(coefficient: Any, diameter: Any) -> Any:
            return 0.0 if coefficient is None or diameter is None else coefficient * diameter / 2

        return PinFriction(
            arm(friction.crank_pin, pin if friction.crank_pin_diameter is None else friction.crank_pin_diameter),
            arm(friction.crosshead_pin, friction.crosshead_pin_diameter),
            arm(friction.journals, journal if friction.journal_diameter is None else friction.journal_diameter),
            SupportedShaft(self.machine) if shaft and not shaft_obstacle(self.machine) else None,
        )

    def locks(self, degrees: float) -> str:
        """Return why no forces are computed for a crosshead that locks itself at this angle."""
        f = self.crosshead_friction
        bound = 1 / np.sqrt(1 + f * f)
        return (
            f"{self.name}: the crosshead locks itself near φ = {degrees % 360:.4g}°, where the machine is driven "
            f"and f tan ψ ≥ 1 (f = {f:g}); a driven machine needs (R + |e|)/L < 1/√(1 + f²) = {bound:.6g}"
        )


def any_of(conditions: Any) -> Any:
    """Return whether any of the conditions holds, each a bool or one of every machine, (machines,)."""
    found: Any = False
    for one in conditions:
        found = found | one
    return found
