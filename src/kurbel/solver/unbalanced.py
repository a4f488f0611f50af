"""Unbalanced forces and moments of the moving masses, order by order.

The unbalanced (shaking) force is minus the sum of mass times acceleration of all moving parts (d'Alembert), at uniform
rotation. It is a complex number in the plane square to the shaft, everywhere over ω², so that it is in kg m:

      F_y ↑   ∕ stroke line of a cylinder, at its bank angle γ      β    angle by which its crank follows crank 1
          │ ∕                                                       m, m_rot  mass to and fro, mass at the crank pin
    shaft O────→ F_x  stroke line of cylinder 1, outward            z, z_0    place along the shaft, of the moments

    F = Σ (m x″(φ − β) + m_rot R e^{i(φ − β)}) e^{iγ}     all angles in the sense of rotation, x″ = d²x/dφ²
    M = Σ (z − z_0) F                                     the vector turned back by 90°, so that it points as forces do
    F = Σ f_n e^{inφ} + g_n e^{−inφ}                      circles of order n with the rotation and against it
    u n² e^{±inφ}                                         pull of a weight u, mass times radius, that turns n times
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray, Indices
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.machine.batch import taken, values_of
from kurbel.mechanisms import Mechanism
from kurbel.numerics.arithmetic import some, unless_cancelled
from kurbel.numerics.pieces import Angles, Pieces, refined
from kurbel.solver.weights import OwnThrow, Weight

_ORDERS = 64
"""Orders that are circles; a rod with L/R < 1.17 has more, which are sampled together."""
_SHOWN = 1e-9
"""Of the largest order: smaller ones are not listed."""
_FEWEST = 8
"""Orders that are kept at least: those of balance shafts."""
_LARGE = 0.01
"""Of the largest order: such an order makes the waves of a square shorter."""
_MOST = 24
"""Orders that are listed; a rod hardly longer than the crank has thousands, which die away slowly."""
_CANCELLED = 64 * float(np.finfo(float).eps)
"""Of their terms: a sum of rests that is smaller all over the turn is rounding."""
_ROUNDING = 1e-14
"""Of a squared length: by what it changes by rounding."""
_EPS = float(np.finfo(float).eps)

Curvature = Callable[[Mechanism, CrankAngle], Any]
"""x″ = d²x/dφ² in m of a mechanism."""


# the waves of one mechanism


@dataclass(frozen=True, eq=False)
class Waves:
    """x″ = 2 Re Σ c_n e^{inφ} + rest of a mechanism; orders: c_n in m, n = 1 to 64, (64,) or (64, machines).

    short: whether the rod is so short that there is a rest, or of which machines (machines,).
    """

    mechanism: Mechanism
    curvature: Curvature
    orders: ComplexArray
    short: Any

    @classmethod
    def of(cls, mechanism: Mechanism, curvature: Curvature, shape: tuple[int, ...]) -> Waves:
        """Return the waves by 256 equal angles of the turn, those of short rods by means over halved pieces."""
        samples = 4 * _ORDERS
        degrees = np.reshape(np.arange(samples) * (360.0 / samples), (samples, *(1 for _ in shape)))
        values = np.broadcast_to(curvature(mechanism, CrankAngle.of(degrees)), (samples, *shape))
        found = _told_apart(np.fft.rfft(values, axis=0) / samples, np.abs(values).max(axis=0))
        short, orders = found[_ORDERS + 1 :].any(axis=0), found[1 : _ORDERS + 1]
        if short.any():
            rows = np.flatnonzero(short)
            means = _means(taken(mechanism, rows), curvature, len(rows))
            orders[:, short] = means if shape else means[:, 0, None]
        return cls(mechanism, curvature, orders, short)

    def rest(self, angle: CrankAngle, machine: Indices) -> Array:
        """Return x″ less its orders in m at crank angles (…, n) of these machines (n,)."""
        orders = _of(self.orders, machine)
        waves = _turned(orders, orders.conj(), angle.cos + 1j * angle.sin).real
        short = self.short[machine] if self.short.ndim else self.short
        return np.where(short, self.curvature(taken(self.mechanism, machine), angle) - waves, 0.0)


def _told_apart(orders: ComplexArray, size: Any) -> ComplexArray:
    """Return orders (…, n) without what is rounding of a size (n,), cosines and sines each: even is without sines."""
    parts = (np.where(np.abs(part) > _EPS * size, part, 0.0) for part in (orders.real, orders.imag))
    return np.asarray(next(parts) + 1j * next(parts))


def _means(mechanism: Mechanism, curvature: Curvature, count: int) -> ComplexArray:
    """Return c_n = mean of x″ e^{−inφ}, (64, count), by pieces narrow enough for the waves, halved where x″ bends."""

    def sample(pieces: Pieces) -> Array:
        values = curvature(taken(mechanism, pieces.machine), CrankAngle.at_nodes(pieces))
        return np.broadcast_to(values, (1, *pieces.degrees.shape))

    pieces, (values,) = refined(_equal_pieces(_ORDERS, count), sample)
    back, wave, found = turn_of(pieces).conj(), values.astype(complex), []
    for _ in range(_ORDERS):
        wave = wave * back
        found.append(pieces.mean(wave))
    return _told_apart(np.array(found), 16 * pieces.mean(np.abs(values)))


def _equal_pieces(parts: int, count: int) -> Pieces:
    """Return a turn of every machine in so many equal pieces, a multiple of 8."""
    breaks = np.arange(parts) * (360.0 / parts)
    return Pieces.between(Angles(np.repeat(np.arange(count), parts), np.tile(breaks, count)), count, 360.0)


def turn_of(pieces: Pieces) -> ComplexArray:
    """Return e^{iφ} at the nodes of pieces."""
    angle = CrankAngle.at_nodes(pieces)
    return np.asarray(angle.cos + 1j * angle.sin)


def _of(orders: ComplexArray, machine: Indices) -> ComplexArray:
    """Return orders (64, machines) of these machines (n,); those of one machine (64,) are of all."""
    return orders[:, machine] if orders.ndim > 1 else orders


def _turned(forward: ComplexArray, backward: ComplexArray, turn: ComplexArray) -> ComplexArray:
    """Return Σ f_n e^{inφ} + g_n e^{−inφ} (…, n); forward, backward: (64,) or (64, n); turn: e^{iφ} (…, n)."""
    used = ((forward != 0) | (backward != 0)).reshape(len(forward), -1).any(axis=1)
    whole, power, twice, reached = np.zeros_like(turn), turn, turn * turn, 1
    for order in (np.flatnonzero(used) + 1).tolist():
        power = power if order == reached else power * (twice if order == reached + 2 else turn ** (order - reached))
        reached = order
        whole = whole + forward[order - 1] * power + backward[order - 1] * power.conj()
    return whole


class Rest(NamedTuple):
    """What a short rod adds to the circles: factor · rest(φ − late); numbers of the machines."""

    waves: Waves
    factor: Any
    late: Any

    def on(self, pieces: Pieces) -> ComplexArray:
        """Return it at the nodes of pieces; no digit at 90° is lost."""
        late = np.asarray(pieces.of(self.late))
        quarter = 90.0 * np.rint(late / 90.0)
        own = replace(pieces, right_angle=pieces.right_angle - quarter, offset=pieces.offset - (late - quarter))
        factor: Any = pieces.of(self.factor)
        return np.asarray(factor * self.waves.rest(CrankAngle.at_nodes(own), pieces.machine), complex)

    def size(self) -> Any:
        """Return what the whole curvature is at most, but for its rest."""
        return np.abs(self.factor) * 2 * np.abs(self.waves.orders).sum(axis=0)


# a vector that repeats after a turn


class Circles:
    """F(φ) = Σ f_n e^{inφ} + g_n e^{−inφ} + rests; forward, backward: f and g in kg m, or kg m², (k,).

    Of a batch they are (k, machines), k up to 64.
    """

    def __init__(self, forward: ComplexArray, backward: ComplexArray, rests: Sequence[Rest] = ()) -> None:
        self.forward, self.backward, self.rests = forward, backward, tuple(rests)

    def of(self, order: int) -> Any:
        """Return the circle of an order, negative against the rotation, 0 of one that there is not."""
        side = self.forward if order > 0 else self.backward
        return side[abs(order) - 1] if abs(order) <= len(side) else 0.0

    def turned_by(self, weight: Any) -> Circles:
        """Return the sum of this and a vector that turns once with φ."""
        forward = self.forward.copy()
        forward[0] += weight
        return Circles(forward, self.backward, self.rests)

    def above(self, order: int) -> Circles:
        """Return what it is but for the orders up to this one."""
        low = (np.arange(1, len(self.forward) + 1) <= order).reshape(-1, *(1 for _ in self.forward.shape[1:]))
        return Circles(np.where(low, 0.0, self.forward), np.where(low, 0.0, self.backward), self.rests)

    def at(self, degrees: Array) -> ComplexArray:
        """Return the vectors (n,) of one machine at angles (n,) in degrees; what cancels is exactly 0."""
        size = np.abs(self.forward).sum() + np.abs(self.backward).sum()
        found = np.asarray(unless_cancelled(_turned(self.forward, self.backward, unit_vector(degrees)), size))
        machine = np.zeros(degrees.shape, dtype=np.intp)
        for rest in self.rests:
            found = found + rest.factor * rest.waves.rest(CrankAngle.of(degrees - rest.late), machine)
        return found

    def on(self, pieces: Pieces) -> ComplexArray:
        """Return the vectors at the nodes of pieces, (nodes, pieces)."""
        found = _turned(_of(self.forward, pieces.machine), _of(self.backward, pieces.machine), turn_of(pieces))
        return np.asarray(sum((rest.on(pieces) for rest in self.rests), found))


def sampled(vectors: Sequence[Circles], count: int | None = None, parts: int = 0) -> tuple[Pieces, ComplexArray]:
    """Return a turn in pieces on which vectors and their squares are polynomials, and them, (q, nodes, pieces).

    parts: of the turn at least, a multiple of 8, or 0.
    """

    def sample(pieces: Pieces) -> Any:
        found = np.stack([one.on(pieces) for one in vectors])
        return np.concatenate((found, np.abs(found) ** 2))

    if any(one.rests for one in vectors):
        found: Any
        pieces, found = refined(_equal_pieces(parts or 8, count or 1), sample)
        return pieces, found[: len(vectors)]
    orders = np.array([(one.forward, one.backward) for one in vectors]).reshape(len(vectors), 2, -1, count or 1)
    used = np.union1d(0, np.flatnonzero((orders != 0).any(axis=(0, 1, 3))))
    equal = _equal_pieces(parts or _parts(orders), count or 1)
    turn = turn_of(equal.taken(equal.machine == 0))
    waves = np.repeat(turn[..., None], used[-1] + 1, axis=-1).cumprod(axis=-1)[..., used]
    both = np.concatenate((waves, waves.conj()), axis=-1)
    # node by node: products of small matrices stay on one core
    values = both @ orders[:, :, used].reshape(len(vectors), 1, -1, count or 1)
    return equal, np.swapaxes(values, 2, 3).reshape(-1, *equal.offsets.shape)


def _parts(orders: ComplexArray) -> int:
    """Return in how many pieces the squares of vectors (q, 2, 64, machines) are polynomials of 16 nodes, but for 1e-13.

    With the largest orders, n_0, an order n of the share w makes waves of n + n_0 in the square; on a piece of half the
    width h the last coefficient of such a wave is 2 ((n + n_0) h/2)^14/14!.
    """
    sizes = np.abs(orders).sum(axis=1)
    shares = np.moveaxis(sizes / np.maximum(sizes.max(axis=1, keepdims=True), 1e-300), 1, -1).reshape(
        -1, sizes.shape[1]
    )
    numbers = np.arange(1, shares.shape[1] + 1)
    large = ((shares > _LARGE) * numbers).max(axis=1, keepdims=True)
    most = float((shares * (numbers + large) ** 14.0).max())
    half_width: float = 2 * (1e-13 * math.factorial(14) / 2 / max(most, 1.0)) ** (1 / 14)
    return 8 * math.ceil(math.pi / half_width / 8)


def largest(pieces: Pieces, vectors: ComplexArray) -> tuple[Array, Array]:
    """Return the largest lengths of vectors (q, nodes, pieces), and the first angles in degrees with them, (q, n)."""
    squares = vectors.real**2 + vectors.imag**2
    size, first = pieces.largest(squares), squares[:, 0, pieces.first]
    above = squares - first[:, None, pieces.machine]
    level = pieces.largest(above) <= _ROUNDING * size
    if level.any():  # a length that never changes rises and falls by rounding
        above = np.where(level[:, None, pieces.machine], 0.0, above)
    top, degrees = pieces.highest(above, size)
    return np.sqrt(np.maximum(first + top, 0.0)), degrees


def power(vector: Circles) -> float:
    """Return the mean square of the length of a vector of one machine: the sum of the squares of all its circles."""
    pieces, (found,) = sampled([vector])
    return float(pieces.mean(np.abs(found) ** 2)[0])


# the force and the moment of all that moves


class Terms(NamedTuple):
    """What throws and weights give to the force: forward, backward (terms, k), of a batch (terms, k, machines).

    places: of each term along the shaft in m, None: not known; rests: what short rods add, with the row of the term.
    """

    forward: ComplexArray
    backward: ComplexArray
    places: tuple[Any, ...]
    rests: tuple[tuple[int, Rest], ...] = ()

    @classmethod
    def of(cls, throws: Sequence[OwnThrow], curvature: Curvature, count: int | None) -> Terms:
        """Return what throws give, masses to and fro and at the pin; of equal mechanisms one is computed."""
        shape = () if count is None else (count,)
        known: dict[object, Waves] = {}
        found, rests = [], []
        for row, throw in enumerate(throws):
            values = values_of(throw.mechanism).values()
            key = (type(throw.mechanism), *(one.tobytes() if isinstance(one, np.ndarray) else one for one in values))
            waves = known[key] = known.get(key) or Waves.of(throw.mechanism, curvature, shape)
            found.append(waves.orders * throw.mass)
            if waves.short.any():
                rests.append((row, Rest(waves, throw.mass * unit_vector(throw.bank), throw.late)))
        last = max(_FEWEST, *(np.flatnonzero(one.reshape(_ORDERS, -1).any(axis=1)).max(initial=0) + 1 for one in found))
        orders = np.arange(1, last + 1)
        behind = [np.multiply.outer(orders, np.broadcast_to(throw.late, shape)) for throw in throws]
        forward, backward = (
            [own * unit_vector(throw.bank + sense * late) for own, throw, late in zip(sides, throws, behind)]
            for sense, sides in ((-1, [one[:last] for one in found]), (1, [one[:last].conj() for one in found]))
        )
        own = cls(np.array(forward), np.array(backward), tuple(throw.place for throw in throws), tuple(rests))
        return own.with_weights(throw.weight(throw.rotating) for throw in throws)

    def with_weights(self, weights: Iterable[Weight]) -> Terms:
        """Return them with further weights, each of which turns `order` times and pulls with u n²."""
        given = [one for one in weights if some(one.product != 0)]
        more = np.zeros((2, len(given), *self.forward.shape[1:]), complex)
        for row, one in enumerate(given):
            more[int(one.order < 0), row, abs(one.order) - 1] = one.product * one.order**2
        forward, backward = (np.concatenate(pair) for pair in zip(self[:2], more))
        return Terms(forward, backward, (*self.places, *(one.place for one in given)), self.rests)

    def summed(self, levers: Sequence[Any] | None = None) -> Circles:
        """Return the sum, each term times its lever; what cancels is exactly 0."""
        shape, times = self.forward.shape[2:], levers or [1.0] * len(self.places)
        column = np.array([np.broadcast_to(one, shape) for one in times])[:, None]
        sides = (terms * column for terms in (self.forward, self.backward))
        forward, backward = (unless_cancelled(one.sum(axis=0), np.abs(one).sum(axis=0)) for one in sides)
        rests = [rest._replace(factor=rest.factor * times[row]) for row, rest in self.rests]
        return Circles(np.asarray(forward), np.asarray(backward), _unless_cancelled(rests, shape))


def _unless_cancelled(rests: Sequence[Rest], shape: tuple[int, ...]) -> Sequence[Rest]:
    """Return rests without those of machines whose sum is rounding."""
    if not rests:
        return rests
    pieces = _equal_pieces(_ORDERS, *(shape or (1,)))
    left = pieces.largest(np.abs(sum(rest.on(pieces) for rest in rests)))
    lasting = left > _CANCELLED * sum(rest.size() for rest in rests)
    return [rest._replace(factor=rest.factor * np.reshape(lasting, shape)) for rest in rests] if lasting.any() else ()


class Free:
    """The unbalanced force over ω² in kg m, and the moment in kg m², None where a place is not known.

    z_0: from where moments are taken in m, None: not known.
    """

    def __init__(self, terms: Terms, z_0: Any) -> None:
        self._terms = terms
        self.force = terms.summed()
        known = z_0 is not None and all(place is not None for place in terms.places)
        self.moment = terms.summed([place - z_0 for place in terms.places]) if known else None

    @cached_property
    def _orders(self) -> tuple[int, ...]:
        sizes = (np.abs(self._terms.forward) + np.abs(self._terms.backward)).max(axis=0)
        return tuple((np.flatnonzero(sizes > _SHOWN * sizes.max()) + 1).tolist())

    @property
    def orders(self) -> tuple[int, ...]:
        """The lowest orders of one machine that some throw or weight has, whether or not they cancel."""
        return self._orders[:_MOST]

    @property
    def next_order(self) -> int | None:
        """The first order that is not among them; None where there is none."""
        return self._orders[_MOST] if len(self._orders) > _MOST else None

    def at_most(self, vector: Circles) -> float:
        """Return what the force or the moment of the higher orders is at most."""
        pieces = sampled([vector], parts=_ORDERS)[0]  # as narrow as their waves
        return float(largest(pieces, vector.above(self.orders[-1]).on(pieces)[None])[0][0, 0])


def book_curvature(mechanism: Mechanism, angle: CrankAngle) -> Any:
    """Return d²x/dφ² in m of first order, R 291; the true one where there is no rod, None where the book has none."""
    offer = next((one for one in mechanism.OFFERS if one.quantity.id == "b_book"), None)
    return offer.factor(mechanism, angle) if offer else mechanism.curvature(angle)
