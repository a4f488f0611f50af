"""What drives and what moves over the turn, whatever the flywheel: found once for all flywheels that are tried."""

from functools import cached_property

import numpy as np

from kurbel.arrays import Array
from kurbel.numerics.grid import Grid
from kurbel.numerics.jet import Jet
from kurbel.solver.turning.excess import Excess
from kurbel.solver.turning.machine_effort import MovingInertia


class Place:
    """Crank angles (…,) on the sides of jumps that hold `within`, with what no flywheel changes there, each (…,)."""

    def __init__(self, excess: Excess, moving: MovingInertia, degrees: Array, within: Array) -> None:
        self._excess = excess
        self._moving = moving
        self.degrees = degrees
        self.within = within

    @cached_property
    def torque(self) -> Jet:
        """The excess of the turning effort in N m with its slope."""
        return self._excess.line.at(self.degrees, self.within)

    @cached_property
    def work(self) -> Array:
        """The excess work E in J."""
        return self._excess.at(self.degrees)

    @cached_property
    def moving(self) -> Jet:
        """The moving inertia Σ m x′² + … in kg m² with its slope."""
        return self._moving.line.at(self.degrees, self.within)

    @cached_property
    def bending(self) -> Array:
        """The second derivative of that by φ."""
        return np.asarray(self._moving.bending.at(self.degrees, self.within).slope)


class Course:
    """What drives the speed line of a machine with any flywheel: the excess of its effort and its moving inertia."""

    def __init__(self, excess: Excess, moving: MovingInertia) -> None:
        self.excess = excess
        self.moving = moving

    def at(self, degrees: Array, within: Array) -> Place:
        """Return what there is at crank angles (…,) in degrees within the cycle, on the sides that hold `within`."""
        return Place(self.excess, self.moving, degrees, within)

    def on(self, grid: Grid) -> Place:
        """Return what there is at the nodes of a grid."""
        return self.at(grid.degrees, grid.within)

    @cached_property
    def fine(self) -> tuple[Grid, Place]:
        """The grid cut ever finer on both sides of the crossings, where a slow machine lingers, with its nodes."""
        grid = self.excess.grid
        if self.excess.crossings:
            steps = np.array([0.0, *(sign * 10.0 / 3.0**k for k in range(4) for sign in (1, -1))])
            angles = (np.array(self.excess.crossings)[:, None] + steps).ravel()
            grid = grid.split_at(np.mod(angles, self.excess.cycle))
        return grid, self.on(grid)


class Inertia:
    """The reduced moment of inertia J(φ) = J + Σ m x′² + … in kg m², at a nominal angular velocity ω_n in rad/s."""

    def __init__(self, flywheel: float, omega: float) -> None:
        self.flywheel = flywheel
        self.omega = omega

    def energy(self, place: Place) -> Jet:
        """Return ½ J(φ) ω_n² in J with its slope."""
        return (place.moving + self.flywheel) * (self.omega**2 / 2)

    def energy_curvature(self, place: Place) -> Array:
        """Return the second derivative of that by φ in J."""
        return np.asarray(place.bending * (self.omega**2 / 2))
