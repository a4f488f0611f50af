"""The cycle of one cylinder, searched: extremes of every column, changes of sign, and the angles of a value."""

import math
from collections.abc import Iterable
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.machine.cylinder import may_lock
from kurbel.mechanisms import quantities_of
from kurbel.numerics.cycles import Flat
from kurbel.numerics.grid import Grid
from kurbel.numerics.search import (
    Curve,
    Extremes,
    Polynomials,
    Sampled,
    Samples,
    curves,
    extremes,
    lasting,
    zeros,
)
from kurbel.solver.cylinder.assembled import Assembled
from kurbel.solver.cylinder.drive import Drive
from kurbel.solver.cylinder.inside import Inside
from kurbel.solver.cylinder.motion import Motion
from kurbel.solver.cylinder.state import State

if TYPE_CHECKING:
    from kurbel.numerics.where import Where


_SURE = 4.0
"""Standard deviations that the noise of thousands of samples does not reach."""


class Quantities:
    """Columns of a drive with their slopes at any (degrees, within); see `search.Evaluate`.

    known: what is known already of all pieces of the grid on which they are searched.
    """

    def __init__(self, drive: Drive, names: tuple[str, ...], rubs: bool = True, known: Inside | None = None) -> None:
        self.drive = drive
        self.names = names
        self.rubs = rubs
        self.known = known

    def __call__(self, degrees: Array, within: Array | Inside) -> dict[str, Sampled]:
        state = self.drive.jets_at(degrees, within)
        state = state if self.rubs else state.unrubbed
        return {name: Sampled.of(getattr(state, name), degrees.shape) for name in self.names}

    def inside(self, grid: Grid, piece: Indices) -> Inside:
        """Return what all angles in these pieces (n,) share."""
        if self.known is None:
            return Inside(self.drive, grid.within[piece, 0])
        return Inside.of_pieces(self.drive, (self.known,), piece)

    def on(self, grid: Grid, state: State | Assembled) -> Samples:
        """Return them in the state at the nodes of a grid."""
        return {name: Polynomials(grid, getattr(state, name)) for name in self.names}

    def of(self, variant: Indices) -> "Quantities":
        """Return the same of these variants (n,)."""
        return Quantities(self.drive.taken(variant), self.names, self.rubs, self.known)


class Searched:
    """Where the columns of a cylinder, or of many variants of it, are largest, smallest, and zero."""

    def __init__(self, drive: Drive, motion: Motion) -> None:
        self.drive = drive
        self.motion = motion

    @cached_property
    def grid(self) -> Grid:
        """The cycle in smooth pieces, cut also where the guide force changes sides, if friction makes that a kink."""
        return self.cut_at_bends(self.drive.pieces, self._uncut) if self._is_cut else self.drive.pieces

    @property
    def _is_cut(self) -> bool:
        return self.drive.rubs or (self.drive.pin_friction is not None and self.drive.has_force)

    @cached_property
    def _uncut(self) -> State:
        """The state at the nodes of the smooth pieces, before they are cut where the guide force changes sides."""
        return self.drive.on(self.drive.pieces)

    def cut_at_bends(self, grid: Grid, samples: State) -> Grid:
        """Return the grid of samples cut where the guide force changes sides, and near the least force on a pin."""
        pins = self.drive.pin_friction
        if self.drive.rubs:
            sense = Quantities(self.drive, ("guide_sense",), known=samples.inside)
            sampled: Samples = sense.on(grid, samples)
            if pins:
                # what makes pins rub bends where N changes sides without them; only beside that true turns are exact
                without = Quantities(self.drive, ("guide_sense",), rubs=False)
                found = zeros(grid, without(grid.degrees, grid.within), without)["guide_sense"]
                grid = grid.split_at(found)
                sense = Quantities(self.drive, ("guide_sense",))
                sampled = sense(grid.degrees, grid.within)
            grid = grid.split_at(zeros(grid, sampled, sense)["guide_sense"])
        return grid.split_at(pins.bends(grid)) if pins and self.drive.has_force else grid

    def quantities(self, *names: str) -> Quantities:
        """Return what gives these columns with their slopes."""
        return Quantities(self.drive, names, known=self.samples.inside)

    @cached_property
    def samples(self) -> State | Assembled:
        """The state at the nodes of the grid."""
        if self.grid is self.drive.pieces:
            return self._uncut
        return Assembled(self.drive, self.grid, self._uncut, self.drive.pieces)

    @cached_property
    def _extremes(self) -> dict[str, Extremes]:
        """Those of every column that is declared to have extremes, as far as there is one."""
        declared = quantities_of(self.drive.mechanism).all_columns
        return self.extremes_over(one.id for one in declared if "forces" in one.extremes)

    def extremes_over(self, columns: Iterable[str]) -> dict[str, Extremes]:
        """Return the extremes in SI of these columns, as far as there are any."""
        asked = self.quantities(*(name for name in columns if getattr(self.samples, name) is not None))
        return extremes(self.grid, asked.on(self.grid, self.samples), asked) if asked.names else {}

    def _whole(self, column: str) -> Curve:
        asked = self.quantities(column)
        return curves(self.grid, asked.on(self.grid, self.samples), asked)[column]

    def _changes(self, column: str) -> Any:
        """The crank angles in degrees at which a column takes the other sign."""
        asked = self.quantities(column)
        return zeros(self.grid, asked.on(self.grid, self.samples), asked)[column]

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes in SI of a column that is declared to have them, None where it is left out."""
        found = self._extremes.get(column) if self.drive.has_force else None
        return found or self.motion.extremes_of(column)

    def refuse_locking(self) -> None:
        """Raise NoSolutionError where the crosshead locks itself, with an angle that does not depend on a step."""
        if may_lock(self.drive.cylinder):
            self.extremes_of("N")

    def angles_where(self, column: str, value: float) -> "Where | None":
        """Return where in the cycle a column has a value in SI; None for a column that is left out."""
        if getattr(self.samples, column) is None:
            return None
        from kurbel.numerics.where import where

        asked = self.quantities(column)
        samples = asked.on(self.grid, self.samples)[column]
        return where(self.grid, samples, lambda *place: asked(*place)[column], value)

    @cached_property
    def phi_reversal(self) -> tuple[Any, ...] | None:
        """Druckwechsel: crank angles in degrees at which P takes the other sign, through zero or by a jump.

        Of those that are the noise of a trace alone the middle one stands for all. Of many variants one tuple each.
        """
        return self._lasting("P", self._reversals)

    def reversals_of(self, column: str) -> tuple[Any, ...] | None:
        """Return the crank angles in degrees at which a force of the gas takes the other sign for longer than noise.

        Of many variants one tuple each.
        """
        return None if getattr(self.samples, column) is None else self._lasting(column, self._changes(column))

    def _lasting(self, column: str, changes: Any) -> tuple[Any, ...] | None:
        if isinstance(changes, Flat):
            return changes.of_each(self.drive.count or 0)
        if changes is None or not self._noise:
            return None if changes is None else tuple(changes.tolist())
        return tuple(lasting(self._whole(column), changes, _SURE * self._noise).tolist())

    @property
    def reversals_in_noise(self) -> int:
        """How many changes of the sign of P are the noise of a trace alone, and not told."""
        # without noise nothing is within it, and no reversal need be searched to tell so
        return len(self._reversals) - len(self.phi_reversal or ()) if self._noise and self._reversals is not None else 0

    @cached_property
    def _reversals(self) -> Any:
        return self._changes("P") if self.drive.has_force and self.samples.P is not None else None

    @property
    def _noise(self) -> float:
        """Standard deviation in N of the noise that traces bring into P."""
        return math.hypot(*(gas.noise for gas in self.drive.gas))

    @cached_property
    def lifted(self) -> tuple[tuple[float, float], ...]:
        """Stretches of crank angle in degrees on which N presses on the upper guide, R p. 602.

        Empty, too, where there is no guide, no N, or no inclination that says which guide is the lower one.
        """
        down, side = self.drive.down, self.samples.N if self.drive.has_force else None
        if side is None or not down or not (self.drive.mechanism.guided and self.drive.mechanism.has_rod):
            return ()
        turns = self._changes("N").tolist() or [0.0]
        stretches = list(zip(turns, [*turns[1:], turns[0] + self.drive.cycle]))
        middles = np.array([(start + end) / 2 for start, end in stretches])
        pressing = np.asarray(self.drive.at(middles).N) * down
        return tuple(stretch for stretch, force in zip(stretches, pressing) if force < 0)
