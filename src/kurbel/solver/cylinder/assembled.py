"""The state of a cylinder at the nodes of a grid, put together from states on some of its pieces each."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.numerics.grid import Grid
from kurbel.numerics.jet import Jet
from kurbel.solver.cylinder.drive import Drive
from kurbel.solver.cylinder.state import State

_BLOCK = 2048
"""Pieces of many variants that are computed at once: their arrays stay in the cache of a processor."""


class _Known(NamedTuple):
    """Rows (k,) whose nodes other samples have already, and theirs there."""

    rows: Indices
    samples: "Assembled"
    there: Indices


class Assembled:
    """Columns at the nodes of a grid, (pieces, nodes), by the names that `State` has for them.

    together: names of columns that are computed with one another where the grid is of many variants. Pieces that a
    coarser grid has as well are taken from its samples.
    """

    def __init__(
        self, drive: Drive, grid: Grid, together: Sequence[str] = (), coarser: "Assembled | None" = None
    ) -> None:
        self.drive, self.grid, self._together = drive, grid, tuple(together)
        self._known = None if coarser is None else _shared(grid, coarser)
        rows = np.arange(len(grid.low))
        if self._known:
            rows = np.setdiff1d(rows, self._known.rows, assume_unique=True)
        step = _BLOCK if grid.variant is not None else max(len(rows), 1)
        self._blocks = [rows[start : start + step] for start in range(0, len(rows), step)]
        self._states: dict[int, State] = {}
        self._found: dict[str, Any] = {}

    @property
    def phi(self) -> Array:
        """Crank angles in degrees."""
        return self.grid.degrees

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._found:
            self._compute(self._together if name in self._together and self.grid.variant is not None else (name,))
        return self._found[name]

    def _compute(self, names: Sequence[str]) -> None:
        parts: dict[str, list[tuple[Indices, Any]]] = {name: [] for name in names}
        for number, rows in enumerate(self._blocks):
            state = self._state(number, rows)
            for name in names:
                parts[name].append((rows, getattr(state, name)))
        for name in names:
            if self._known:
                parts[name].append((self._known.rows, _taken(getattr(self._known.samples, name), self._known.there)))
            self._found[name] = self._joined(parts[name])

    def _state(self, number: int, rows: Indices) -> State:
        """Return the state on a block; of many variants it is not kept, or memory would hold all that it computed."""
        if number in self._states:
            return self._states[number]
        grid = self.grid
        drive = self.drive if grid.variant is None else self.drive.taken(grid.variant[rows][:, None])
        within = np.broadcast_to(grid.within[rows, :1], (len(rows), grid.degrees.shape[1]))
        state = drive.jets_at(grid.degrees[rows], within, grid.beyond[rows])
        if grid.variant is None:
            self._states[number] = state
        return state

    def _joined(self, parts: Sequence[tuple[Indices, Any]]) -> Any:
        if len(parts) == 1 or parts[0][1] is None:
            return parts[0][1]
        value, slope = np.empty(self.grid.degrees.shape), np.zeros(self.grid.degrees.shape)
        for rows, part in parts:
            value[rows] = getattr(part, "value", part)
            if isinstance(part, Jet):
                slope[rows] = part.slope
        return Jet(value, slope)


def _taken(found: Any, rows: Indices) -> Any:
    return (
        Jet(found.value[rows], found.slope[rows]) if isinstance(found, Jet) else found if found is None else found[rows]
    )


def _shared(grid: Grid, coarser: Assembled) -> _Known | None:
    """Return which pieces of a grid a coarser one has as well."""
    there = coarser.grid.piece_at(grid.low, grid.variant)
    rows = np.flatnonzero((coarser.grid.low[there] == grid.low) & (coarser.grid.high[there] == grid.high))
    return _Known(rows, coarser, there[rows]) if len(rows) else None
