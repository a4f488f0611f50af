"""The works of friction in the pins of a connecting rod and in the journals of its throw."""

from functools import cached_property

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.numerics.grid import Grid, Pieces, integral
from kurbel.solver.cylinder.drive import Drive
from kurbel.solver.cylinder.state import State


class PinWorks:
    """Works of friction in pins and journals of a cylinder. Attributes are named by the ids of the key values, in SI.

    None without the coefficient, or without a force. grid: the cycle of the drive, where anything rubs; driving: work
    of the driving pistons in J per cycle. (With these alone, nothing points back to the forces, which go when they are
    no longer needed.)
    """

    def __init__(self, drive: Drive, grid: Grid | None, driving: float | None) -> None:
        self._drive, self._grid, self._driving = drive, grid, driving
        friction = drive.cylinder.friction
        self._given = friction.of_pins if friction and drive.has_force else ()

    @cached_property
    def _works(self) -> dict[str, float]:
        """Work in J per cycle by the key of the coefficient."""
        if not self._given or self._grid is None:
            return dict.fromkeys(self._given, 0.0)
        found = integral(self._grid, self._moments)
        return dict(zip(self._given, found.tolist()))

    def _moments(self, pieces: Pieces) -> Array:
        rubbing = State(self._drive, CrankAngle.at_nodes(pieces)).rubbing
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
        work = self.work_of(name)
        return None if work is None or not self._driving else work / self._driving
