"""The cycle of one cylinder (of one or many machines) in smooth pieces, and the columns sampled on them.

The cycle is cut where a column has a kink or a jump, and halved until all forces are polynomials on every piece. With
friction it is also cut where the force on the guide, on a pin or on the block of a yoke changes sign.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from typing import Any, NamedTuple, TypeVar, overload

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.crank_angle import CrankAngle
from kurbel.errors import NoSolutionError
from kurbel.machine.batch import varies
from kurbel.machine.cylinder import may_lock
from kurbel.numerics.arithmetic import some
from kurbel.numerics.extreme import Extremes
from kurbel.numerics.pieces import NARROWEST, Angles, Pieces, Samples, joined_pieces, refined
from kurbel.solver.drive import Drive
from kurbel.solver.figures import result
from kurbel.solver.state import State, crank_pin_force, crosshead_pin_force

T = TypeVar("T")

_SURE = 4.0
"""Number of standard deviations that the noise of thousands of samples does not exceed."""


class Where(NamedTuple):
    """The angles in degrees at which a quantity has a value, ascending, and the range of its values."""

    angles: tuple[float, ...]
    span: tuple[float, float]


class shared(cached_property[T]):
    """A cached property that equal cylinders have in common: that of the twin, where a cylinder has one."""

    @overload
    def __get__(self, instance: None, owner: type | None = None) -> shared[T]: ...
    @overload
    def __get__(self, instance: object, owner: type | None = None) -> T: ...
    def __get__(self, instance: object | None, owner: type | None = None) -> shared[T] | T:
        if not isinstance(instance, SampledCylinder):
            return self
        return super().__get__(instance.twin or instance, owner)


class SampledCylinder:
    """A cylinder with its cycle in pieces, and the extremes and zeros of its columns.

    twin: an equal cylinder elsewhere along the shaft, whose `shared` properties are its own, too.
    """

    drive: Drive
    twin: SampledCylinder | None

    def result(self, values: Array) -> Any:
        """Return values (machines,) as they are for many machines, and as a float for one."""
        return result(values, self.drive.count)

    # the pieces

    @property
    def pieces(self) -> Pieces:
        """The cycle in pieces on which every column is a polynomial."""
        return self._cycle[0]

    @property
    def samples(self) -> State:
        """The state at the nodes of the pieces."""
        return self._cycle[1]

    @shared
    def _cycle(self) -> tuple[Pieces, State, Pieces]:
        """The pieces, the state at their nodes, and the longer pieces that end at kinks and jumps."""
        drive, pieces = self.drive, self.drive.pieces
        state = _state_on(drive, pieces)
        if drive.has_force:
            if drive.links:
                pieces, state = _cut(drive, pieces, state, _ring_pressures_of_links)
                pieces, state = _cut(drive, pieces, state, _senses_of_links)
            if some(drive.ring_surface != 0):
                pieces, state = _cut(drive, pieces, state, _ring_pressure)
            if drive.rubs or drive.yoke_rubs:
                pieces, state = _cut(drive, pieces, state, _sense_without_pins)
            _refuse_locking(state, pieces)
            if drive.pin_friction:
                pieces, state = _cut(drive, pieces, state, _loads_of_pins)
                if drive.rubs:
                    pieces, state = _cut(drive, pieces, state, _sense_with_pins)
        fine, state, _ = _halved(drive, pieces, state, _smooth)
        return fine, state, pieces

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees of the only machine between which every quantity is smooth."""
        return (self.drive.pieces if may_lock(self.drive.cylinder) else self._cycle[2]).ends

    @property
    def tail(self) -> float:
        """Largest last coefficients of the Chebyshev series on pieces that could be halved, over the largest value."""
        values = np.stack(_known(self.pieces, _smooth(self.samples)))
        size = np.maximum(np.abs(values).max(axis=(1, 2)), np.finfo(float).tiny)
        tails = np.abs(self.pieces.rule.tail @ values).max(axis=1)[:, self.pieces.half > NARROWEST]
        return float((tails.max(axis=1) / size).max())

    # extremes and zeros

    def sampled(self, column: str) -> Array | None:
        """Return a column at the nodes of the pieces, (nodes, pieces); None for one that is left out."""
        values = self.samples[column]
        if values is None:
            return None
        return self.pieces.filled(values)

    def extremes_over(self, columns: Mapping[str, Number | None]) -> dict[str, Extremes]:
        """Return the extremes in SI of columns of `samples` by id, without those that are None."""
        pieces = self.pieces
        names = [name for name, values in columns.items() if values is not None]
        if not names:
            return {}
        extremes = pieces.extremes(_known(pieces, columns.values())).each(self.result)
        return dict(zip(names, extremes))

    def angles_where(self, column: str, value: float) -> Where | None:
        """Return where in the cycle a column has a value in SI; None for a column that is left out."""
        values = self.sampled(column)
        if values is None:
            return None
        return where_is(self.pieces, values, value)


def _state_on(drive: Drive, pieces: Pieces) -> State:
    """Return the state on the pieces of all machines; machines with the same motion and pressures have the same pieces.

    These are computed once.
    """
    what_may_vary = (drive.mechanism, drive.pistons, drive.machine.ambient)
    if drive.count is None or varies(what_may_vary):
        return State.on(drive, pieces)
    first = State.on(drive, pieces.taken(pieces.machine == 0))
    repeated = [np.tile(values, drive.count) for values in _before_friction(first)]
    return _restored(drive, pieces, repeated)


def _halved(
    drive: Drive, pieces: Pieces, state: State, columns: Callable[[State], Iterable[Number | None]]
) -> tuple[Pieces, State, Samples]:
    """Return the pieces, halved until these columns are polynomials, with the state and the columns on them."""
    judged = _known(pieces, columns(state))
    if not judged:
        return pieces, state, []

    def sample(halves: Pieces) -> list[Array]:
        if halves is pieces:
            return [*judged, *_before_friction(state)]
        state_there = State.on(drive, halves)
        return [*_known(halves, columns(state_there)), *_before_friction(state_there)]

    fine, values = refined(pieces, sample, len(judged))
    finer = state
    if fine is not pieces:
        finer = _restored(drive, fine, values[len(judged) :])
    return fine, finer, values[: len(judged)]


def _cut(
    drive: Drive, pieces: Pieces, state: State, columns: Callable[[State], Iterable[Number | None]]
) -> tuple[Pieces, State]:
    """Return the pieces cut where one of these columns changes sign, and the state on them."""
    pieces, state, values = _halved(drive, pieces, state, columns)
    if not len(values):
        return pieces, state
    zeros = [pieces.zeros(value) for value in values]
    machine = np.concatenate([angles.machine for angles in zeros])
    degrees = np.concatenate([angles.degrees for angles in zeros])
    cut = pieces.split(Angles(machine, degrees))
    if cut is pieces:
        return pieces, state

    # of pieces that are not cut the values are kept
    source, new = cut.kept_of(pieces)
    fresh = cut.taken(new)
    kept = (pieces, source, _before_friction(state))
    computed = (fresh, np.arange(len(new)), _before_friction(State.on(drive, fresh)))
    joined, values = joined_pieces([kept, computed])
    return joined, _restored(drive, joined, values)


def _before_friction(state: State) -> list[Array]:
    """Return motion and gas forces, which are independent of friction and from which `_restored` makes a state."""
    angle = state.angle
    columns = [angle.sin, angle.cos, state.slope, state.curvature]
    columns += state.rod_angle or ()
    columns += state.piston_forces
    return [state.filled(column) for column in columns]


def _restored(drive: Drive, pieces: Pieces, samples: Samples) -> State:
    """Return the state on pieces from the values of `_before_friction` there, each (nodes, pieces)."""
    sin, cos, slope, curvature, *rest = samples
    pistons = len(rest) - len(drive.gas)
    angle = CrankAngle(pieces.degrees, sin, cos, (rest[0], rest[1]) if pistons else None)
    state = State(drive.taken(pieces.machine), angle, pieces.middle)
    state.slope, state.curvature, state.piston_forces = slope, curvature, rest[pistons:]
    return state


def _loads_of_pins(state: State) -> list[Number]:
    """Return the loads of the pins without their friction: where one passes through zero, its magnitude has a kink."""
    free = state.without_pin_friction
    loads = [crank_pin_force(free).T]
    if free.rod_angle:
        loads.append(crosshead_pin_force(free).along)
    return loads


def _ring_pressure(state: State) -> list[Number]:
    """Return the difference of pressures that presses the rings against the wall."""
    return [state.pressure_difference]


def _ring_pressures_of_links(state: State) -> list[Number]:
    """Return the differences of pressures that press the rings of the links of a master rod."""
    links = [link for link in state.links if some(link.drive.ring_surface != 0)]
    return [link.pressure_difference for link in links]


def _senses_of_links(state: State) -> list[Number]:
    """Return the forces whose signs decide which sides of the guides of links are loaded, where these rub."""
    return [link.guide_numerator for link in state.links if link.drive.rubs]


def _sense_without_pins(state: State) -> list[Number]:
    """Return the force whose sign decides which side of a guide is loaded, without friction in the pins."""
    return [_sense(state.without_pin_friction)]


def _sense_with_pins(state: State) -> list[Number]:
    """Return the force whose sign decides which side of a guide is loaded."""
    return [_sense(state)]


def _sense(state: State) -> Number:
    """Return the force in N whose sign decides which side of a guide, or of a Scotch yoke, is loaded."""
    if state.rod_angle:
        return state.guide_numerator
    return state.after_steady_friction


def _refuse_locking(state: State, pieces: Pieces) -> None:
    """Raise NoSolutionError, with the exact angle, if the crosshead of the only machine is self-locking."""
    drive = state.drive
    if drive.count is not None or not may_lock(drive.cylinder):
        return
    denominator = state.without_pin_friction.guide_denominator
    locks = denominator <= 0
    if locks.any():
        zeros = pieces.zeros(denominator).degrees
        first = float(zeros[0]) if len(zeros) else float(pieces.degrees.T[locks.T][0])
        raise NoSolutionError(drive.locks(first))


def _smooth(state: State) -> list[Number | None]:
    """Return the quantities that decide how often pieces are halved: they must be polynomials on every piece."""
    columns: list[Number | None] = [state.curvature]
    if state.drive.has_force:
        columns += [state.P_gas, state.P, state.N, state.T]
        columns += state.rubbing or ()
    for offer in state.mechanism.OFFERS:
        # no force depends on an approximation of the books
        if offer.quantity.extremes and not offer.quantity.of_book:
            columns.append(offer.of(state))
    return columns


def _known(pieces: Pieces, values: Iterable[Number | None]) -> list[Array]:
    """Return those of the columns that are not None, at the nodes of pieces, each (nodes, pieces)."""
    return [pieces.filled(value) for value in values if value is not None]


def reversals(drive: Drive, pieces: Pieces, values: Array) -> tuple[Any, ...]:
    """Return the crank angles in degrees at which a force changes sign, without those due to the noise of a trace.

    values: samples in N (nodes, pieces). For many machines one tuple each.
    """
    changes = pieces.zeros(values)
    if drive.count is not None:
        return changes.listed(drive.count)
    return tuple(lasting(pieces, values, changes.degrees, _SURE * drive.noise).tolist())


def where_is(pieces: Pieces, values: Array, value: float) -> Where:
    """Return the angles of the cycle of one machine at which samples pass a value, or reach it as their extreme.

    At a jump over the value it is the angle of the jump; one that only leads to the value does not pass it.
    """
    size = np.maximum(pieces.largest(values), abs(value))
    above = values - value
    rising = pieces.zeros(above, size).degrees
    falling = pieces.zeros(-above, size).degrees
    angles = set[float]()
    for degrees in rising.tolist():
        if (np.abs(falling - degrees) < 1e-6).any():
            angles.add(degrees)

    high, high_at, low, low_at = (float(extreme[0, 0]) for extreme in pieces.extremes(values[None]))
    for end, degrees in ((high, high_at), (low, low_at)):
        if math.isclose(end, value, rel_tol=1e-14):
            angles.add(degrees)
    return Where(tuple(sorted(angles)), (low, high))


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
