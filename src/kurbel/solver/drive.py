"""One cylinder with its crank mechanism, made ready for the solver: which masses, pressures and frictions it has."""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.crank_angle import CrankAngle
from kurbel.declared.units import GRAVITY
from kurbel.machine import CYCLES, Cylinder, Machine
from kurbel.machine.resistance import RamForce
from kurbel.machine.variants import taken
from kurbel.numerics.arithmetic import some
from kurbel.numerics.pieces import Angles, Pieces
from kurbel.solver.friction import ring_force
from kurbel.solver.gas import PistonGas
from kurbel.solver.motion import every_dead_centre
from kurbel.solver.pins import PinFriction
from kurbel.solver.rod import ExactRod
from kurbel.solver.state import State

_IDLE = 1e-4
"""Mean indicated pressure in Pa that is rounding: such a piston neither drives nor is driven."""
_DENSE = 600
"""Breaks of a cycle, as at the samples of a trace, from which on its pieces are short enough for 6 nodes."""


class Drive:
    """A cylinder of a machine: masses, weights, pressures and friction as the state needs them.

    revolutions, cycle: turns and degrees of crank angle per working cycle of this cylinder; omega: rad/s or None.
    count: number of machines, whose numbers are then arrays (machines,); None for one machine. index: in a copy made by
    `taken`, the machine of every angle or piece (n,), to which its numbers belong.
    """

    def __init__(
        self, machine: Machine, cylinder: Cylinder, count: int | None = None, index: Indices | None = None
    ) -> None:
        self.machine, self.count, self.index = machine, count, index
        self.cylinder = cylinder
        self.name = cylinder.name
        self.mechanism = cylinder.mechanism
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
    def omega(self) -> float | None:
        """Angular velocity in rad/s, None where no speed is given."""
        return None if self.machine.speed is None else 2 * math.pi * self.machine.speed

    @cached_property
    def mass(self) -> float:
        """Reciprocating mass in kg, 0 without masses."""
        masses = self.cylinder.masses
        return masses.at_crosshead(self.mechanism.rod_length) if masses else 0.0

    @cached_property
    def rod(self) -> ExactRod | None:
        """The connecting rod, where it is described by centre of gravity and moment of inertia."""
        masses = self.cylinder.masses
        if not (masses and masses.connecting_rod and masses.connecting_rod.exact):
            return None
        length = self.mechanism.rod_length
        return ExactRod(masses.connecting_rod, length, self.mechanism.crank, self.omega, self._incline)

    @cached_property
    def rod_pull(self) -> float:
        """Centrifugal force m R ω² in N of the connecting rod's part that turns with the pin, away from the shaft.

        Of a rod given by its `share` only: the D of an exact rod contains it already, that of R 302 does not.
        """
        rod = self.cylinder.masses.connecting_rod if self.cylinder.masses else None
        if rod is None or rod.exact or self.omega is None:
            return 0.0
        # a float squared by ** raises where the product is infinite
        return rod.mass * (1 - rod.share) * self.mechanism.crank * self.omega * self.omega

    @cached_property
    def pin_inertia(self) -> Any:
        """Moment of inertia m R² in kg m² of what turns with the crank pin."""
        masses = self.cylinder.masses
        return masses.at_pin(self.mechanism.rod_length) * self.mechanism.crank**2 if masses else 0.0

    @property
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

    def weight_of(self, mass: float) -> tuple[float, float] | None:
        """Return the weight in N of a mass in kg along the stroke line and on the guide; None where it is left out."""
        incline = self._incline
        return None if incline is None else (mass * GRAVITY * incline.sin, mass * GRAVITY * incline.cos)

    @property
    def guide_weight(self) -> Any:
        """Weight on the guide in N."""
        return self.weight[1] if self.weight else 0.0

    @cached_property
    def gas(self) -> tuple[PistonGas, ...]:
        """Pressures on the pistons that have an indicator."""
        indicated = [number for number, piston in enumerate(self.cylinder.pistons) if piston.indicator]
        return tuple(self._gas_on(number) for number in indicated)

    @property
    def has_gas(self) -> bool:
        """Whether any piston has an indicator."""
        return any(piston.indicator for piston in self.cylinder.pistons)

    def _gas_on(self, number: int) -> PistonGas:
        turns = CYCLES[self.machine.cycle_of_piston(self.cylinder, number)]
        piston, ambient = self.cylinder.pistons[number], self.machine.ambient
        return PistonGas(piston, self.mechanism, 360.0 * turns, ambient, self.revolutions // turns, self.count)

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
    def own_gas(self) -> PistonGas | None:
        """Pressures on the cylinder's own piston."""
        pistons = self.cylinder.pistons
        return self.gas[0] if pistons and pistons[0].indicator else None

    @cached_property
    def has_force(self) -> bool:
        """Whether any force acts along the stroke line, or a moment on what swings."""
        return self.has_gas or self.has_inertia or self.weight is not None or self.resistance is not None

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
        """Friction force of the piston rings in N; 0 without them."""
        friction = self.cylinder.friction
        if not (friction and friction.rings):
            return 0.0
        return ring_force(friction.rings, self.cylinder.pistons[0].bore)

    @cached_property
    def steady_friction(self) -> Any:
        """Friction in N that is constant over the stroke: of the piston rings, and what is given as a force."""
        friction = self.cylinder.friction
        return self.ring_force + (0.0 if friction is None or friction.constant is None else friction.constant)

    @cached_property
    def pin_friction(self) -> PinFriction | None:
        """Friction in the pins of the rod and in the journals; None where no coefficient of it is given."""
        friction = self.cylinder.friction
        if friction is None or not (friction.crank_pin or friction.crosshead_pin or friction.journals):
            return None
        return PinFriction(self.machine, self.cylinder, friction)

    @property
    def has_friction(self) -> bool:
        """Whether the machine names any friction."""
        return self.cylinder.friction is not None

    def locks(self, degrees: float) -> str:
        """Return why no forces are computed for a crosshead that locks itself at this angle."""
        f = self.crosshead_friction
        bound = 1 / np.sqrt(1 + f * f)
        return (
            f"{self.name}: the crosshead locks itself near φ = {degrees % 360:.4g}°, where the machine is driven "
            f"and f tan ψ ≥ 1 (f = {f:g}); a driven machine needs (R + |e|)/L < 1/√(1 + f²) = {bound:.6g}"
        )

    def at(self, degrees: Array, within: Array | None = None, machine: Indices | None = None) -> State:
        """Return the state at crank angles (n,) in degrees, on the sides of jumps that hold `within`, or just after."""
        drive = self if machine is None else self.taken(machine)
        return State(drive, CrankAngle.of(degrees), degrees if within is None else within)

    def on(self, pieces: Pieces) -> State:
        """Return the state at the nodes of pieces, (nodes, pieces), each on its side of every jump."""
        return State(self.taken(pieces.machine), CrankAngle.at_nodes(pieces), pieces.middle)

    @cached_property
    def pieces(self) -> Pieces:
        """The cycle between the angles at which something bends or jumps: dead centres and the corners of cards."""
        count = self.count or 1
        centres = every_dead_centre(self.mechanism, count, self.cycle)
        breaks = Angles(np.repeat(np.arange(count), centres.shape[1]), centres.ravel())
        jumps = [breaks, *(starts for gas in self.gas for starts in gas.starts)]
        whole = Angles(*(np.concatenate(parts) for parts in zip(*jumps)))
        return Pieces.between(whole, count, self.cycle, 16 if len(whole.degrees) < _DENSE * count else 6)


def any_of(conditions: Any) -> Any:
    """Return whether any of the conditions holds, each a bool or one of every machine, (machines,)."""
    found: Any = False
    for one in conditions:
        found = found | one
    return found
