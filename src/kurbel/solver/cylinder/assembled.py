"""The state of a cylinder at the nodes of a grid, of which a coarser grid has most pieces already."""

from functools import cached_property
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
        self._there = before.piece_at(grid.low, grid.variant)
        new = (before.low[self._there] != grid.low) | (before.high[self._there] != grid.high)
        self._new = np.flatnonzero(new)
        self._coarser, self._finer = coarser, drive.on(grid.part(new))
        self._found: dict[str, Any] = {}
        self._drive = drive

    @cached_property
    def inside(self) -> Inside:
        """What all angles in each of the pieces share, as far as the columns that were asked for have found it."""
        place = self._there.copy()
        # the new ones stand after all of the coarser grid
        place[self._new] = len(self._coarser.phi) + np.arange(len(self._new))
        return Inside.of_pieces(self._drive, (self._coarser.inside, self._finer.inside), place[:, None])

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._found:
            self._found[name] = self._joined(getattr(self._coarser, name), getattr(self._finer, name))
        return self._found[name]

    def _joined(self, coarser: Any, finer: Any) -> Any:
        if coarser is None:
            return None
        joined = coarser.T.take(self._there, axis=1)  # node by node in memory
        joined[:, self._new] = finer.T
        return joined.T
