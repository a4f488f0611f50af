"""One cylinder with its crank mechanism, made ready for the solver: which forces act on it at all."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any

from kurbel.arrays import Array, Indices
from kurbel.crank_angle import CrankAngle
from kurbel.declared.units import GRAVITY
from kurbel.machine import CYCLES, Cylinder, Machine
from kurbel.machine.variants import taken
from kurbel.mechanisms import fan
from kurbel.numerics.arithmetic import arcsin, some, sqrt, where
from kurbel.numerics.gauss import LOBATTO_9
from kurbel.numerics.grid import Cuts, Grid, Pieces
from kurbel.solver.cylinder.inside import Inside
from kurbel.solver.cylinder.state import State

if TYPE_CHECKING:
    from kurbel.machine.resistance import RamForce
    from kurbel.solver.cylinder.gas import PistonGas
    from kurbel.solver.cylinder.pins import PinFriction
    from kurbel.solver.cylinder.rod import ExactRod

_IDLE = 1e-4
"""Mean indicated pressure in Pa that is rounding: such a piston neither drives nor is driven."""


class Drive:
    """A cylinder of a machine: masses, weights, pressures and friction as the state needs them.

    revolutions, cycle: turns and degrees of crank angle per working cycle of this cylinder; omega: rad/s or None.
    count: how many variants of a machine it is, whose numbers are then arrays (v,); None for one machine.
    """

    variant: Indices | None = None
    """Which variants its numbers are of, of the shape of the angles that it is asked for."""

    def __init__(self, machine: Machine, cylinder: Cylinder, count: int | None = None) -> None:
        self.machine = machine
        self.count = count
        self.cylinder = cylinder
        self.name = cylinder.name
        self.mechanism = cylinder.mechanism
        self.revolutions = CYCLES[machine.cycle_of(cylinder)]
        self.cycle = 360.0 * self.revolutions

    def taken(self, index: Indices) -> Drive:
        """Return these of the variants, with numbers of the shape of the index."""
        other = Drive(taken(self.machine, index), taken(self.cylinder, index))
        other.variant = index
        other.gas = tuple(gas.taken(index) for gas in self.gas)
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
        from kurbel.solver.cylinder.rod import ExactRod

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
        """Whether inertia forces can be given: masses and a speed."""
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
        from kurbel.solver.cylinder.gas import PistonGas

        turns = CYCLES[self.machine.cycle_of_piston(self.cylinder, number)]
        piston, ambient = self.cylinder.pistons[number], self.machine.ambient
        return PistonGas(piston, self.mechanism, 360.0 * turns, ambient, self.revolutions // turns)

    @cached_property
    def driving(self) -> tuple[PistonGas, ...]:
        """The gas on the pistons that drive: their indicated work is positive."""
        return tuple(gas for gas in self.gas if gas.work > _IDLE * gas.swept_volume)

    @cached_property
    def driven(self) -> bool:
        """Whether a piston is driven, its indicated work being negative, or the output works against a resistance."""
        return bool(self.resistance_work) or any(gas.work < -_IDLE * gas.swept_volume for gas in self.gas)

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
        from kurbel.solver.cylinder.friction import ring_force

        return ring_force(friction.rings, self.cylinder.pistons[0].bore)

    @cached_property
    def steady_friction(self) -> Any:
        """Friction in N that is the same over the stroke: of the piston rings, and what is given as a force."""
        friction = self.cylinder.friction
        return self.ring_force + (0.0 if friction is None or friction.constant is None else friction.constant)

    @cached_property
    def pin_friction(self) -> PinFriction | None:
        """Friction in the pins of the rod and in the journals; None where no coefficient of it is given."""
        friction = self.cylinder.friction
        if friction is None or not (friction.crank_pin or friction.crosshead_pin or friction.journals):
            return None
        from kurbel.solver.cylinder.pins import PinFriction

        return PinFriction(self)

    @property
    def has_friction(self) -> bool:
        """Whether the machine names any friction."""
        return self.cylinder.friction is not None

    def at(self, degrees: Array, within: Array | None = None) -> State:
        """Return the state at crank angles (n,) in degrees, on the sides of jumps that hold `within`, or just after."""
        return State(self, CrankAngle.of(degrees), within)

    def jets_at(self, degrees: Array, within: Array | Inside) -> State:
        """Return the state with slopes by φ at crank angles (n,), on the sides of jumps that hold `within`."""
        return State(self, CrankAngle.of(degrees).jets, within)

    def on(self, pieces: Pieces) -> State:
        """Return the state at the nodes of pieces, each on its side of every jump."""
        drive = self if pieces.variant is None else self.taken(pieces.variant[:, None])
        return State(drive, CrankAngle.at_nodes(pieces), pieces.within)

    @cached_property
    def cuts(self) -> Cuts:
        """The crank angles in degrees that cut the cycle into smooth pieces."""
        return Cuts.of_turns(self._smooth, self.cycle, self._jumps)

    @cached_property
    def pieces(self) -> Grid:
        """The cycle in smooth pieces, or the cycles of all variants."""
        if self.count is None:
            return self.cuts.grid(LOBATTO_9)
        from kurbel.numerics.cycles import cycles_of_turns

        return cycles_of_turns(self._smooth, self.cycle, self._jumps, self.count)

    @property
    def _jumps(self) -> list[Any]:
        return [starts for gas in self.gas for starts in gas.starts]

    @property
    def _smooth(self) -> list[Any]:
        # where the rod turns back, friction in its pins jumps
        turns = (90.0, 270.0) if self.pin_friction else ()
        bends = (angle for gas in self.gas for angle in gas.bends)
        return [*self.mechanism.cuts(), *turns, *self._near_locking(), *bends]

    def _near_locking(self) -> Iterator[Any]:
        """Yield angles, ever denser, round those at which a driven crosshead comes nearest to locking itself.

        There 1/(cos ψ − f |sin ψ|) of D 3 has a pole beside the real axis, at √(2 left/((tan ψ + f) λ)) from it. Of one
        that would lock, that of 1/(cos ψ + f |sin ψ|) is real: behind the dead centre, where |sin ψ| bends.
        """
        for centre in (90.0, 270.0) if self.rubs else ():
            sin_psi, cos_psi = self.mechanism.rod_angle(CrankAngle.of(centre)) or (0.0, 1.0)
            left = cos_psi - self.crosshead_friction * abs(sin_psi)
            near = (left > 0) & (sin_psi != 0)
            if some(near):
                bend = (abs(sin_psi) / cos_psi + self.crosshead_friction) * self.mechanism.lam
                yield from fan(centre, sqrt(where(near, 2 * left, 0.0) / where(near, bend, 1.0)) * (180 / math.pi))
            locks = left < 0
            if some(locks):
                sin_locked = 1 / sqrt(1 + self.crosshead_friction * self.crosshead_friction)
                behind = arcsin(where(locks, sin_locked, 0.0) / where(locks, abs(sin_psi), 1.0))
                yield from fan(centre - 90.0, behind * (180 / math.pi))
