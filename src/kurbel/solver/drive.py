"""One cylinder with its crank mechanism, made ready for the solver: which forces act on it at all."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from kurbel.crank_angle import CrankAngle
from kurbel.errors import UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.solver.friction import ring_force
from kurbel.solver.gas import PistonGas
from kurbel.solver.grid import ascending
from kurbel.solver.jet import jet_angle
from kurbel.solver.state import GRAVITY, State

Array = NDArray[np.float64]


class Drive:
    """A cylinder of a machine: masses, weights, pressures and friction as the state needs them.

    cycle: degrees of crank angle per working cycle, 360 or 720; omega: rad/s or None.
    """

    def __init__(self, machine: Machine, cylinder: Cylinder) -> None:
        self.machine = machine
        self.cylinder = cylinder
        self.name = cylinder.name
        self.mechanism = cylinder.mechanism
        self.cycle = 360.0 * machine.revolutions

    @cached_property
    def omega(self) -> float | None:
        """Angular velocity in rad/s, None where no speed is given."""
        return None if self.machine.speed is None else 2 * math.pi * self.machine.speed

    @cached_property
    def mass(self) -> float:
        """Reciprocating mass in kg, 0 without masses."""
        masses = self.cylinder.masses
        if masses and masses.connecting_rod and masses.connecting_rod.exact:
            raise UsageError(
                "a connecting rod with 'center_of_gravity' is read and checked, but nothing computes it yet"
            )
        return masses.reciprocating if masses else 0.0

    @property
    def has_inertia(self) -> bool:
        """Whether inertia forces can be given: masses and a speed."""
        return self.cylinder.masses is not None and self.omega is not None

    @cached_property
    def weight(self) -> tuple[float, float] | None:
        """Weight of the reciprocating masses in N along the stroke line and on the guide; None where it is left out."""
        if self.cylinder.inclination is None or self.cylinder.masses is None:
            return None
        incline = CrankAngle.of(self.cylinder.inclination)
        return self.mass * GRAVITY * incline.sin, self.mass * GRAVITY * incline.cos

    @property
    def guide_weight(self) -> float:
        """Weight on the guide in N."""
        return self.weight[1] if self.weight else 0.0

    @cached_property
    def gas(self) -> tuple[PistonGas, ...]:
        """Pressures on the pistons that have an indicator."""
        return tuple(
            PistonGas(piston, self.mechanism, self.cycle, self.machine.ambient)
            for piston in self.cylinder.pistons
            if piston.indicator
        )

    @property
    def own_gas(self) -> PistonGas | None:
        """Pressures on the cylinder's own piston."""
        return next((gas for gas in self.gas if gas.piston is self.cylinder.pistons[0]), None)

    @cached_property
    def has_force(self) -> bool:
        """Whether any force acts along the stroke line."""
        return bool(self.gas) or self.has_inertia or self.weight is not None

    @cached_property
    def crosshead_friction(self) -> float:
        """f of the crosshead; 0 without one."""
        friction = self.cylinder.friction
        return (friction.crosshead or 0.0) if friction else 0.0

    @cached_property
    def ring_force(self) -> float:
        """Friction force of the piston rings in N; 0 without them."""
        friction = self.cylinder.friction
        return ring_force(friction.rings, self.cylinder.pistons[0].bore) if friction and friction.rings else 0.0

    @property
    def has_friction(self) -> bool:
        """Whether the machine names any friction."""
        return self.cylinder.friction is not None

    def at(self, degrees: Array) -> State:
        """Return the state at crank angles (n,) in degrees, just after a jump where there is one."""
        return State(self, CrankAngle.of(degrees))

    def jets_at(self, degrees: Array, within: Array, beyond: Array | float = 0.0) -> State:
        """Return the state with slopes by φ at crank angles (n,), on the sides of jumps that hold `within`."""
        return State(self, jet_angle(degrees, beyond), within)

    def breaks(self) -> Array:
        """Return the crank angles in degrees that cut the cycle into smooth pieces, from 0 to the full cycle."""
        landmarks = np.array(
            [*self.mechanism.dead_centres(), *self.mechanism.landmarks(), *np.arange(0.0, 360.0, 45.0)]
        )
        turns = [np.mod(landmarks, 360.0) + 360.0 * turn for turn in range(self.machine.revolutions)]
        angles = np.concatenate([*turns, *(start for gas in self.gas for start in gas.starts), [self.cycle]])
        # two angles that differ by rounding only would leave a piece without width
        angles = ascending(angles, apart=1e-10)
        angles[-1] = self.cycle
        return angles
