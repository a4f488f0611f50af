"""The works of friction in the pins of a connecting rod and in the journals of its throw."""

from collections.abc import Sequence

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.numerics.grid import Grid, Pieces, integral
from kurbel.solver.cylinder.drive import Drive
from kurbel.solver.cylinder.state import State


def pin_works(drive: Drive, grid: Grid, names: Sequence[str]) -> dict[str, float]:
    """Return the works of friction in J per cycle by these keys of coefficients: `crank_pin`, `crosshead_pin`, …"""

    def moments(pieces: Pieces) -> Array:
        rubbing = State(drive, CrankAngle.at_nodes(pieces)).rubbing
        return np.stack([np.broadcast_to(getattr(rubbing, name), pieces.degrees.shape) for name in names])

    return dict(zip(names, integral(grid, moments).tolist()))
