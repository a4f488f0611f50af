"""One cylinder among several, told at the angles of crank 1."""

import math

from kurbel.arrays import Array
from kurbel.numerics.grid import Cuts
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.cylinder.state import State


class Following:
    """A cylinder at the angles φ of crank 1: its own crank stands at φ − position.

    cuts: where something of it bends or jumps, over a cycle in degrees that may be longer than its own.
    """

    def __init__(self, forces: CylinderForces, cycle: float) -> None:
        self.forces = forces
        self.drive = forces.drive
        self.position = position(forces)
        self.cuts = own_cuts(forces).shifted(self.position, cycle)

    def jets_at(self, degrees: Array, within: Array) -> State:
        """Return the state with slopes at angles (n,) of crank 1 in degrees, on the sides that hold `within`."""
        return self.drive.jets_at(degrees - self.position, within - self.position)


def position(forces: CylinderForces) -> float:
    """Return by how many degrees the crank of a cylinder stands behind crank 1.

    Whole cycles are taken off, which is exact: beside a large position an angle would lose its digits.
    """
    return math.fmod(forces.drive.cylinder.crank_position, forces.drive.cycle)


def own_cuts(forces: CylinderForces) -> Cuts:
    """Return where something of a cylinder bends or jumps, over its own cycle."""
    return Cuts(forces.drive.cuts.smooth, forces.grid.breaks[:-1])
