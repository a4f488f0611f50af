"""The cycle of one cylinder, or of that cylinder of many machines, in smooth pieces, and what is sampled on them.

The cycle is cut where something bends or jumps, and halved until all forces are polynomials on every piece. Where the
crosshead rubs, it is cut also where the guide force changes sides; where pins rub, where their loads turn.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.errors import NoSolutionError
from kurbel.machine.cylinder import may_lock
from kurbel.numerics.extreme import Extremes
from kurbel.numerics.pieces import NARROWEST, Angles, Pieces, refined
from kurbel.solver.drive import Drive
from kurbel.solver.figures import column_rows
from kurbel.solver.pins import on_crosshead_pin, on_pin
from kurbel.solver.state import State

_SURE = 4.0
"""Standard deviations: the noise of thousands of samples stays below."""


class Where(NamedTuple):
    """The angles in degrees at which a quantity has a value, ascending, and the range of its values."""

    angles: tuple[float, ...]
    span: tuple[float, float]


class SampledCylinder:
    """A cylinder with its cycle in pieces, and the extremes and zeros of its columns."""

    drive: Drive
    _last: tuple[Pieces, State]
    """Where columns were sampled last, so that `samples` need not compute them again."""

    def told(self, values: Array) -> Any:
        """Return values (machines,) as they are for many machines, and as a float for one."""
        return float(values[0]) if self.drive.count is None else values

    @cached_property
    def pieces(self) -> Pieces:
        """The cycle in pieces on which every column is a polynomial."""
        self._refuse_locking_on(self._unhalved)
        return refined(self._unhalved, self._smooth)[0]

    @cached_property
    def _unhalved(self) -> Pieces:
        """The cycle cut only where something bends or jumps, and at multiples of 45°."""
        drive, pieces = self.drive, self.drive.pieces
        return self._cut_at_sides(pieces) if drive.has_force and (drive.rubs or drive.pin_friction) else pieces

    def _cut_at_sides(self, pieces: Pieces) -> Pieces:
        """Return the pieces cut where the guide force changes sides, with and without friction in pins."""
        drive = self.drive

        def before(some: Pieces) -> Array:
            state = self.drive.on(some).unrubbed
            return _stacked(some, _sense(state), state.curvature, state.P_gas, state.P)

        def rubbed(some: Pieces) -> Array:
            state = self.drive.on(some)
            return _stacked(some, _sense(state), *_moments(state))

        pieces, (sense, *_) = refined(pieces, before)
        if drive.rubs:
            pieces = pieces.split(pieces.zeros(sense))
        if drive.pin_friction is None:
            return pieces
        self._refuse_locking_on(pieces)
        # where the load of a pin passes through zero, its magnitude has a kink
        unrubbed = drive.on(pieces).unrubbed
        passed = [pieces.zeros(load) for load in (on_pin(unrubbed).T, on_crosshead_pin(unrubbed).D)]
        pieces = pieces.split(Angles(*(np.concatenate(columns) for columns in zip(*passed))))
        pieces, (sense, *_) = refined(pieces, rubbed)
        return pieces.split(pieces.zeros(sense)) if drive.rubs else pieces

    def _smooth(self, pieces: Pieces) -> Array:
        """Return what is to be a polynomial on every piece."""
        state = self.drive.on(pieces)
        self._last = pieces, state
        offered = [one.of(state) for one in self.drive.mechanism.OFFERS if one.quantity.extremes]
        if not self.drive.has_force:
            return _stacked(pieces, state.curvature, *offered)
        forces = (state.P_gas, state.P, state.N, state.T, state.D)
        return _stacked(pieces, state.curvature, *forces, *_moments(state), *offered)

    def _refuse_locking_on(self, pieces: Pieces) -> None:
        """Raise NoSolutionError with the exact angle from which on the crosshead of the only machine locks."""
        if self.drive.count is None and self.drive.has_force and may_lock(self.drive.cylinder):
            below = self.drive.on(pieces).unrubbed.below
            if (below <= 0).any():
                at = pieces.zeros(below).degrees
                first = float(at[0]) if len(at) else float(pieces.degrees.T[(below <= 0).T][0])
                raise NoSolutionError(self.drive.locks(first))

    @property
    def tail(self) -> float:
        """Largest tail of the Chebyshev series on a piece that could be halved, relative to the largest value."""
        values = self._smooth(self.pieces)
        size = np.maximum(np.abs(values).max(axis=(1, 2)), np.finfo(float).tiny)
        tails = np.abs(self.pieces.rule.series[-2:] @ values).max(axis=1)[:, self.pieces.half > NARROWEST]
        return float((tails.max(axis=1) / size).max())

    @cached_property
    def samples(self) -> State:
        """The state at the nodes of the pieces."""
        pieces = self.pieces
        last, state = self._last  # known already if no piece was halved
        return state if last is pieces else self.drive.on(pieces)

    def sampled(self, column: str) -> Array | None:
        """Return a column at the nodes of the pieces, (nodes, pieces); None for one that is left out."""
        found = self.samples[column]
        return None if found is None else np.broadcast_to(found, self.pieces.degrees.shape)

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees of the only machine between which every quantity is smooth."""
        cut = self.drive.pieces if may_lock(self.drive.cylinder) else self._unhalved
        return np.append(cut.low, self.drive.cycle)

    @cached_property
    def _extremes(self) -> dict[str, Extremes]:
        """Those of every column that is declared to have extremes, as far as there is one."""
        declared = column_rows(State, self.drive.mechanism.OFFERS)
        return self.extremes_over(id for id, row in declared.items() if "forces" in row.quantity.extremes)

    def extremes_over(self, columns: Iterable[str]) -> dict[str, Extremes]:
        """Return the extremes in SI of these columns, as far as there are any."""
        found = {name: values for name in columns if (values := self.sampled(name)) is not None}
        if not found:
            return {}
        return dict(zip(found, self.pieces.extremes(np.stack([*found.values()])).each(self.told)))

    def angles_where(self, column: str, value: float) -> Where | None:
        """Return where in the cycle a column has a value in SI; None for a column that is left out."""
        values = self.sampled(column)
        return None if values is None else where_is(self.pieces, values, value)

    # reversals

    def reversals_of(self, column: str) -> tuple[Any, ...] | None:
        """Return the crank angles in degrees at which a force changes sign, not counting the noise of a trace."""
        values = self.sampled(column)
        if values is None:
            return None
        changes = self.pieces.zeros(values)
        if self.drive.count is not None:
            return tuple(tuple(one.tolist()) for one in changes.of_each(self.drive.count))
        return tuple(lasting(self.pieces, values, changes.degrees, _SURE * self._noise).tolist())

    @property
    def _noise(self) -> float:
        """Standard deviation in N of the noise that traces bring into P."""
        return math.hypot(*(gas.noise for gas in self.drive.gas))

    @cached_property
    def lifted(self) -> tuple[tuple[float, float], ...]:
        """Stretches of crank angle in degrees on which N presses on the upper guide, R p. 602.

        Empty, too, where there is no guide, no N, or no inclination, so that no guide is the lower one.
        """
        down, side = self.drive.down, self.sampled("N") if self.drive.has_force else None
        if side is None or not down or not (self.drive.mechanism.guided and self.drive.mechanism.has_rod):
            return ()
        turns = self.pieces.zeros(side).degrees.tolist() or [0.0]
        stretches = list(zip(turns, [*turns[1:], turns[0] + self.drive.cycle]))
        middles = np.array([(start + end) / 2 for start, end in stretches])
        pressing = self.pieces.at(side, np.zeros(len(middles), dtype=np.intp), middles) * down
        return tuple(stretch for stretch, force in zip(stretches, pressing) if force < 0)


def _stacked(pieces: Pieces, *values: Any) -> Array:
    """Return what there is of columns at the nodes of pieces, (q, nodes, pieces)."""
    return np.stack([np.broadcast_to(one, pieces.degrees.shape) for one in values if one is not None])


def _sense(state: State) -> Any:
    """Return what has the sign of the guide force in N; None without a connecting rod."""
    return None if state.rod_angle is None else state.guide_sense


def _moments(state: State) -> tuple[Any, ...]:
    """Return the moments of friction in pins and journals."""
    rubbing = state.rubbing
    return () if rubbing is None else (rubbing.at_crank, rubbing.at_crosshead, rubbing.journals)


def where_is(pieces: Pieces, values: Array, value: float) -> Where:
    """Return the angles of the cycle of one machine at which samples pass a value, or reach it as their extreme.

    At a jump over the value it is the angle of the jump; one that only leads to the value does not pass it.
    """
    size = np.maximum(pieces.largest(values), abs(value))
    rising, falling = (pieces.zeros(sign * (values - value), size).degrees.tolist() for sign in (1, -1))
    passed = [one for one in rising if any(abs(one - other) < 1e-6 for other in falling)]
    high, high_at, low, low_at = (float(one[0, 0]) for one in pieces.extremes(values[None]))
    ends = ((high, high_at), (low, low_at))
    reached = [degrees for end, degrees in ends if math.isclose(end, value, rel_tol=1e-14)]
    return Where(tuple(sorted({*passed, *reached})), (low, high))


def lasting(pieces: Pieces, values: Array, changes: Array, noise: float) -> Array:
    """Return the changes of sign (n,) that are more than noise: between them samples leave the band ±noise.

    Of several changes within the band the middle one is kept if the sign after the band is another than before it, and
    none otherwise.
    """
    if not noise or not len(changes):
        return changes
    # which change each value follows: at a jump the side of the piece decides
    beside = pieces.degrees + 1e-9 * (pieces.middle - pieces.degrees)
    reach = np.zeros(len(changes))
    np.maximum.at(reach, np.searchsorted(changes, beside) - 1, np.abs(values))
    clear = np.flatnonzero(reach > noise)
    if not len(clear):
        return changes[:0]
    groups = np.split(np.roll(changes, -clear[0] - 1), clear[1:] - clear[0])
    return np.sort([group[len(group) // 2] for group in groups if len(group) % 2])
