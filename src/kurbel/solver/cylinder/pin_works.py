"""The works of friction in the pins of a connecting rod and in the journals of its throw."""

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.numerics.grid import Pieces, integral
from kurbel.solver.cylinder.state import State

if TYPE_CHECKING:
    from kurbel.solver.cylinder.forces import CylinderForces


class PinWorks:
    """Works of friction in pins and journals of a cylinder. Attributes are named by the ids of the key values, in SI.

    None without the coefficient, or without a force.
    """

    def __init__(self, forces: "CylinderForces") -> None:
        self._forces = forces
        friction = forces.drive.cylinder.friction
        self._given = friction.of_pins if friction and forces.drive.has_force else ()

    @cached_property
    def _works(self) -> dict[str, float]:
        """Work in J per cycle by the key of the coefficient."""
        if not self._given or self._forces.drive.pin_friction is None:
            return dict.fromkeys(self._given, 0.0)
        found = integral(self._forces.grid, self._moments)
        return dict(zip(self._given, found.tolist()))

    def _moments(self, pieces: Pieces) -> Array:
        rubbing = State(self._forces.drive, CrankAngle.at_nodes(pieces)).rubbing
        every = [np.broadcast_to(getattr(rubbing, name), pieces.degrees.shape) for name in self._given]
        return np.stack(every)

    @property
    def all(self) -> tuple[float, ...]:
        """Works in J per cycle of those whose coefficient is given."""
        return tuple(self._works.values())

    def work_of(self, name: str) -> float | None:
        """Return the work in J per cycle of `crank_pin`, `crosshead_pin` or `journals`."""
        return self._works.get(name)

    def loss_of(self, name: str) -> float | None:
        """Return the same over the work of the driving pistons; None where none drives."""
        work, driving = self.work_of(name), self._forces.work_driving
        return None if work is None or not driving else work / driving
