"""The state of a cylinder at the nodes of a grid, of which a coarser grid has most pieces already."""

from typing import Any

import numpy as np

from kurbel.numerics.grid import Grid
from kurbel.solver.cylinder.drive import Drive
from kurbel.solver.cylinder.inside import Inside
from kurbel.solver.cylinder.state import State


class Assembled:
    """Columns at the nodes of a grid, (pieces, nodes), by the names that `State` has for them.

    coarser: the state at the nodes of a grid `before` of which some pieces were cut; that of the others stays.
    """

    def __init__(self, drive: Drive, grid: Grid, coarser: State, before: Grid) -> None:
        there = before.piece_at(grid.low, grid.variant)
        new = (before.low[there] != grid.low) | (before.high[there] != grid.high)
        # of each piece the place among those of the coarser grid with the new ones after them
        self._place = np.where(new, len(before.low) + np.cumsum(new) - 1, there)
        self._coarser, self._finer = coarser, drive.on(grid.part(new))
        self._found: dict[str, Any] = {}
        self.inside = Inside.of_pieces(drive, (coarser.inside, self._finer.inside), self._place[:, None])

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._found:
            self._found[name] = self._joined(getattr(self._coarser, name), getattr(self._finer, name))
        return self._found[name]

    def _joined(self, coarser: Any, finer: Any) -> Any:
        if coarser is None:
            return None
        return np.concatenate((coarser.T, finer.T), axis=1).take(self._place, axis=1).T
