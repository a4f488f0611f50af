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
from kurbel.mechanisms import quantities_of
from kurbel.numerics.extreme import Extremes
from kurbel.numerics.pieces import NARROWEST, Angles, Pieces, refined
from kurbel.solver.drive import Drive
from kurbel.solver.motion import Motion
from kurbel.solver.pins import on_crosshead_pin, on_pin
from kurbel.solver.state import State

_SURE = 4.0
"""Standard deviations: the noise of thousands of samples stays below."""
_SENSE = ("guide_sense", "curvature", "P_gas", "P")
"""Columns that are refined before the guide force is searched for changes of side; `guide_sense` is the first."""
_RUBBING = ("at_crank", "at_crosshead", "journals")
"""Moments of friction in pins and journals, attributes of `Rubbing`."""
_SMOOTH = ("curvature", "P_gas", "P", "N", "T", "D", *_RUBBING)
"""Columns, and moments of friction, that must be polynomials on every piece."""


class Where(NamedTuple):
    """The angles in degrees at which a quantity has a value, ascending, and the range of its values."""

    angles: tuple[float, ...]
    span: tuple[float, float]


class SampledCylinder:
    """A cylinder with its cycle in pieces, and the extremes and zeros of its columns."""

    drive: Drive
    motion: Motion
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
        pieces, (sense, *_) = refined(pieces, lambda some: self._values_on(some, _SENSE, rubs=False))
        if drive.rubs:
            pieces = pieces.split(pieces.zeros(sense))
        if drive.pin_friction is None:
            return pieces
        self._refuse_locking_on(pieces)
        # where the load of a pin passes through zero, its magnitude has a kink
        unrubbed = drive.on(pieces).unrubbed
        passed = [pieces.zeros(load) for load in (on_pin(unrubbed).T, on_crosshead_pin(unrubbed).D)]
        pieces = pieces.split(Angles(*(np.concatenate(columns) for columns in zip(*passed))))
        pieces, (sense, *_) = refined(pieces, lambda some: self._values_on(some, ("guide_sense", *_RUBBING)))
        return pieces.split(pieces.zeros(sense)) if drive.rubs else pieces

    def _values_on(self, pieces: Pieces, names: Iterable[str], rubs: bool = True) -> Array:
        state = self.drive.on(pieces)
        self._last = pieces, state
        state = state if rubs else state.unrubbed
        values = (_column(state, name) for name in names)
        return np.stack([np.broadcast_to(one, pieces.degrees.shape) for one in values if one is not None])

    def _smooth(self, pieces: Pieces) -> Array:
        """Return what is to be a polynomial on every piece."""
        offered = [one.quantity.id for one in self.drive.mechanism.OFFERS if one.quantity.extremes]
        return self._values_on(pieces, (*(_SMOOTH if self.drive.has_force else _SMOOTH[:1]), *offered))

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
        found = getattr(self.samples, column)
        return None if found is None else np.broadcast_to(found, self.pieces.degrees.shape)

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees of the only machine between which every quantity is smooth."""
        cut = self.drive.pieces if may_lock(self.drive.cylinder) else self._unhalved
        return np.append(cut.low, self.drive.cycle)

    @cached_property
    def _extremes(self) -> dict[str, Extremes]:
        """Those of every column that is declared to have extremes, as far as there is one."""
        declared = quantities_of(self.drive.mechanism).all_columns
        return self.extremes_over(one.id for one in declared if "forces" in one.extremes)

    def extremes_over(self, columns: Iterable[str]) -> dict[str, Extremes]:
        """Return the extremes in SI of these columns, as far as there are any."""
        found = {name: values for name in columns if (values := self.sampled(name)) is not None}
        if not found:
            return {}
        return dict(zip(found, self.pieces.extremes(np.stack([*found.values()])).each(self.told)))

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes in SI of a column that is declared to have them, None where it is left out."""
        found = self._extremes.get(column) if self.drive.has_force else None
        return found or self.motion.extremes_of(column)

    def refuse_locking(self) -> None:
        """Raise NoSolutionError where the crosshead locks itself, with an angle that does not depend on a step."""
        if self.drive.count is None and may_lock(self.drive.cylinder):
            self.extremes_of("N")

    def angles_where(self, column: str, value: float) -> Where | None:
        """Return where in the cycle a column has a value in SI; None for a column that is left out."""
        values = self.sampled(column)
        return None if values is None else where_is(self.pieces, values, value)

    # reversals

    @cached_property
    def phi_reversal(self) -> tuple[Any, ...] | None:
        """Force reversal (Druckwechsel): crank angles in degrees at which P changes sign, through zero or by a jump.

        Changes that are noise of a trace count once, at the middle one. For many machines one tuple each.
        """
        return self.reversals_of("P") if self.drive.has_force else None

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
    def reversals_in_noise(self) -> int:
        """How many changes of the sign of P are noise of a trace, and are not listed."""
        values = self.sampled("P") if self._noise and self.drive.has_force else None
        return 0 if values is None else len(self.pieces.zeros(values).degrees) - len(self.phi_reversal or ())

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


def _column(state: State, name: str) -> Any:
    """Return a column, or a moment of friction in pins and journals; None for what is left out."""
    if name not in _RUBBING:
        return None if name == "guide_sense" and state.rod_angle is None else getattr(state, name)
    rubbing = state.rubbing
    return None if rubbing is None else getattr(rubbing, name)


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
