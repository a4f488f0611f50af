"""The state of a cylinder at the nodes of a grid, of which a coarser grid has most pieces already."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.numerics.grid import Grid
from kurbel.numerics.jet import Jet
from kurbel.solver.cylinder.drive import Drive

if TYPE_CHECKING:
    from kurbel.solver.cylinder.state import State


class Assembled:
    """Columns at the nodes of a grid, (pieces, nodes), by the names that `State` has for them.

    coarser: the state at the nodes of a grid `before` of which some pieces were cut; that of the others stays.
    """

    def __init__(self, drive: Drive, grid: Grid, coarser: State, before: Grid) -> None:
        there = before.piece_at(grid.low, grid.variant)
        whole = (before.low[there] == grid.low) & (before.high[there] == grid.high)
        self.phi = grid.degrees
        self._kept, self._there, self._new = np.flatnonzero(whole), there[whole], np.flatnonzero(~whole)
        self._coarser, self._finer = coarser, drive.on(grid, self._new)
        self._found: dict[str, Any] = {}

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._found:
            self._found[name] = self._joined(getattr(self._coarser, name), getattr(self._finer, name))
        return self._found[name]

    def _joined(self, coarser: Any, finer: Any) -> Any:
        if coarser is None or not len(self._new):
            return coarser
        if isinstance(coarser, Jet):
            return Jet(self._joined(coarser.value, finer.value), self._joined(coarser.slope, finer.slope))
        joined = np.empty_like(self.phi)
        joined[self._kept], joined[self._new] = coarser[self._there], finer
        return joined
