"""Balancing: what the moving masses do to the frame, order by order, and the weights that take it away.

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
from functools import cache, cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray, Flags, Indices
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.errors import UsageError
from kurbel.frozen import values_of
from kurbel.machine import Machine
from kurbel.machine.balance import Locomotive
from kurbel.machine.variants import taken
from kurbel.mechanisms import Mechanism
from kurbel.numerics.arithmetic import some, sqrt, unless_cancelled, where
from kurbel.numerics.enclosing import ClosedCurve
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.pieces import Angles, Pieces, refined
from kurbel.solver.effort import Term, TurningEffort
from kurbel.solver.figures import Columns, Results
from kurbel.solver.forces import CylinderForces
from kurbel.solver.state import State
from kurbel.solver.weights import (
    OwnThrow,
    Weight,
    counterweights_of,
    levered,
    middle_of,
    shafts_of,
    wheels_of,
)

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
_SETTLED = 1e-13
"""Of the radius: by what a curve may reach beyond the smallest circle round it."""
_ROUNDS = 60
_ROUNDING = 1e-14
"""Of a squared length: by what it changes by rounding."""
_EPS = float(np.finfo(float).eps)
_REAL = 1e-12
"""By what a direction, or a lever in m, may miss another by rounding."""

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
    back, wave, found = _turn(pieces).conj(), values.astype(complex), []
    for _ in range(_ORDERS):
        wave = wave * back
        found.append(pieces.mean(wave))
    return _told_apart(np.array(found), 16 * pieces.mean(np.abs(values)))


def _equal_pieces(parts: int, count: int) -> Pieces:
    """Return a turn of every machine in so many equal pieces, a multiple of 8."""
    breaks = np.arange(parts) * (360.0 / parts)
    return Pieces.between(Angles(np.repeat(np.arange(count), parts), np.tile(breaks, count)), count, 360.0)


def _turn(pieces: Pieces) -> ComplexArray:
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
    """What a short rod adds beside the circles: factor · rest(φ − late); numbers of the machines."""

    waves: Waves
    factor: Any
    late: Any

    def on(self, pieces: Pieces) -> ComplexArray:
        """Return it at the nodes of pieces; no digit at 90° is lost."""
        late = np.asarray(pieces.of(self.late))
        quarter = 90.0 * np.rint(late / 90.0)
        own = replace(pieces, right_angle=pieces.right_angle - quarter, offset=pieces.offset - (late - quarter))
        return np.asarray(pieces.of(self.factor) * self.waves.rest(CrankAngle.at_nodes(own), pieces.machine))

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
        found = _turned(_of(self.forward, pieces.machine), _of(self.backward, pieces.machine), _turn(pieces))
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
    turn = _turn(equal.taken(equal.machine == 0))
    waves = np.repeat(turn[..., None], used[-1] + 1, axis=-1).cumprod(axis=-1)[..., used]
    both = np.concatenate((waves, waves.conj()), axis=-1)
    values = both.reshape(-1, 2 * len(used)) @ orders[:, :, used].reshape(len(vectors), -1, count or 1)
    return equal, np.swapaxes(values.reshape(-1, *turn.shape, count or 1), 2, 3).reshape(-1, *equal.offsets.shape)


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
    most = (shares * (numbers + large) ** 14.0).max()
    half_width = 2 * (1e-13 * math.factorial(14) / 2 / max(most, 1.0)) ** (1 / 14)
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


# the counterweight that leaves the least largest force


class Least(NamedTuple):
    """The counterweight in kg m, complex, that leaves the least largest force, and the force that it leaves."""

    weight: Any
    left: Circles


def least_centres(
    pieces: Pieces, curve: ComplexArray, even: Flags, others: ComplexArray
) -> tuple[ComplexArray, Array, Array]:
    """Return the centres (n,) of the smallest circles round closed curves c(φ), sampled on the pieces of a turn.

    even: which curves (n,) are their own image about 0, their centre. With them the lengths of other vectors (q, nodes,
    pieces), and last that of c less its centre, are searched together; see `largest`.
    """
    closed, size, each = ClosedCurve(pieces, curve), pieces.largest(np.abs(curve)), np.arange(pieces.count)
    degrees = np.zeros((4, pieces.count)) if even.all() else closed.nearly_enclosed()
    for _ in range(_ROUNDS):
        circle, degrees = closed.enclosed(degrees)
        centre = np.where(even | (np.abs(circle.centre) <= _ROUNDING * size), 0.0, circle.centre)
        top, at = largest(pieces, np.concatenate((others, [curve - centre[pieces.machine]])))
        beyond = ~even & (top[-1] > np.sqrt(circle.square) * (1 + _SETTLED) + 4 * _EPS * size)
        if not beyond.any():
            break
        degrees[circle.shares.argmin(axis=0), each] = at[-1]
    return centre, top, at


# the whole machine


def _found(name: str, text: str) -> Any:
    """Return a key value of the balance that is found with the others; see `MachineBalance.searched`."""
    return property(lambda balance: balance.searched(name), doc=text)


_VECTORS: dict[str, tuple[str, str, Callable[[Any], Any]]] = {
    "F_x": ("free", "force", np.real),
    "F_y": ("free", "force", np.imag),
    "F_free": ("free", "force", np.abs),
    "M_x": ("free", "moment", np.real),
    "M_y": ("free", "moment", np.imag),
    "M_free": ("free", "moment", np.abs),
    "F_x_book": ("book", "force", np.real),
    "F_y_book": ("book", "force", np.imag),
    "M_x_book": ("book", "moment", np.real),
    "M_y_book": ("book", "moment", np.imag),
}
"""Column -> the part of the unbalanced force in N or moment in N m that it is, of the true one or of the book."""


class MachineBalance(Results):
    """The key values of the whole machine over a turn; `at(degrees)` gives the columns.

    Attributes are named by the ids of the key values, in SI; one that the machine does not have is None. Raises
    UsageError where nothing moves that could be balanced, and where a place of a weight is missing. count: of how many
    machines the numbers are, (machines,); then so are the key values, nan where a machine has none.

    z_0: place in m from where moments are taken; wheels: of the counterweights in the wheels of a locomotive, none of
    another machine; counterweights: those of the machine file.
    """

    command = "balance"

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces], count: int | None = None) -> None:
        self.machine, self.count = machine, count
        self._cylinders = cylinders
        first = machine.cylinders[0].bank_angle if machine.cylinders else 0.0
        own = (OwnThrow(number, one, first) for number, one in enumerate(machine.cylinders) if one.masses)
        self.throws = tuple(own)
        if not any(some(one.mass != 0) or some(one.rotating != 0) for one in self.throws):
            raise UsageError(f"{machine.name}: nothing moves that could be balanced; give 'masses' to its cylinders")
        for throw in self.throws:
            if throw.mechanism.quick_return:
                raise UsageError(f"{throw.name}: the masses of what drives a ram back quickly are not known")
        self.omega = None if machine.speed is None else 2 * math.pi * machine.speed
        self.z_0, self.wheels = middle_of(machine), wheels_of(machine)
        self.counterweights = tuple(counterweights_of(machine, self.throws))

    @property
    def answering(self) -> tuple[Any, ...]:
        """What has key values, the first that has one."""
        return (self, *((self.locomotive,) if self.locomotive else ()))

    def _columns(self, phi: Array, within: Array) -> Columns:
        @cache
        def vector(of: str, name: str) -> ComplexArray | None:
            free = self.free if of == "free" else self.book
            circles = None if free is None else free.force if name == "force" else free.moment
            return None if circles is None or self.omega is None else circles.at(phi) * (self.omega * self.omega)

        def part(of: str, name: str, component: Callable[[ComplexArray], Array]) -> Array | None:
            found = vector(of, name)
            return None if found is None else component(found)

        formulas = {id: partial(part, *each) for id, each in _VECTORS.items()}
        return Columns(phi, formulas | {"M_roll": lambda: self._roll_at(phi, within)})

    # what moves, all of it over ω²

    @cached_property
    def _throws_alone(self) -> Terms:
        return Terms.of(self.throws, lambda one, angle: one.curvature(angle), self.count)

    @cached_property
    def bare(self) -> Free:
        """What the throws give, without counterweights and balance shafts."""
        return Free(self._throws_alone, self.z_0)

    @cached_property
    def free(self) -> Free:
        """What is unbalanced, with the counterweights and balance shafts of the machine file."""
        return Free(self._throws_alone.with_weights(self._given), self.z_0) if self._given else self.bare

    @cached_property
    def _given(self) -> tuple[Weight, ...]:
        """The weights of the machine file, on the crank and on shafts."""
        return (*self.counterweights, *shafts_of(self.machine))

    @cached_property
    def book(self) -> Free | None:
        """The same by the acceleration of first order, R 291; None where the book has none for a mechanism."""
        if any(book_curvature(one.mechanism, CrankAngle.of(0.0)) is None for one in self.throws):
            return None
        return Free(Terms.of(self.throws, book_curvature, self.count).with_weights(self._given), self.z_0)

    # the largest of it, and the counterweight that leaves the least largest force

    @cached_property
    def _searched(self) -> tuple[Any, dict[str, Extreme]]:
        """The least counterweight in kg m, and the largest lengths over ω², all found in one search.

        In the frame of the crank the force without a counterweight is the closed curve F e^{−iφ} = f_1 + c(φ), to
        which a weight u on the crank adds u: the least largest |F + u e^{iφ}| has −u in the centre of the smallest
        circle round it. With even orders alone c(φ + 180°) = −c(φ), and the centre is 0.
        """
        bare, free = self.bare.force, self.free
        turning = bare.forward[0]
        vectors = {"force": free.force, "moment": free.moment, "bare": bare.turned_by(-turning)}
        given = {name: one for name, one in vectors.items() if one is not None}
        pieces, (*found, loose) = sampled([*given.values()], self.count)
        rows = dict(zip(given, found))
        if self.machine.locomotive:
            rows |= {f"{name} along": one.real.astype(complex) for name, one in rows.items()}
        odd = np.concatenate((given["bare"].forward[2::2], given["bare"].backward[::2], [turning]))
        even = ~(odd.reshape(len(odd), -1) != 0).any(axis=0) & (not bare.rests)
        curve = loose * _turn(pieces).conj()
        centre, top, at = least_centres(pieces, curve, np.broadcast_to(even, pieces.count), np.array([*rows.values()]))
        extremes = [Extreme(self._told(one), self._told(where_)) for one, where_ in zip(top, at)]
        weight = -(turning + (complex(centre[0]) if self.count is None else centre))
        return weight, dict(zip([*rows, "least"], extremes))

    def _told(self, values: Array) -> Any:
        """Return numbers of every machine (machines,), or that of the only one."""
        return float(values[0]) if self.count is None else values

    def _times_square(self, found: Extreme | None) -> Extreme | None:
        """Return an extreme over ω² times ω²; None without a speed."""
        if found is None or self.omega is None:
            return None
        return Extreme(found.value * self.omega * self.omega, found.degrees)

    def largest(self, vector: Circles | None) -> Extreme | None:
        """Return the largest length of a vector over ω², times ω², with its angle; None without a speed."""
        if vector is None:
            return None
        top, at = largest(*sampled([vector], self.count))
        return self._times_square(Extreme(self._told(top[0]), self._told(at[0])))

    def searched(self, name: str) -> Extreme | None:
        """Return the largest `force`, `moment`, or what of them is `along` the stroke lines, in N or N m."""
        return self._times_square(self._searched[1].get(name))

    F_free_max = _found("force", "Largest unbalanced force in N.")

    M_free_max = _found("moment", "Largest unbalanced moment in N m.")

    F_free_best = _found("least", "The least largest unbalanced force in N.")

    # the rolling moment on the frame about the shaft: −(M + dH/dt), H the moment of momentum about the shaft

    @cached_property
    def _effort(self) -> TurningEffort | None:
        """The turning effort of the machine, with its losses; None without a speed."""
        if self.omega is None or not some(self.omega != 0):
            return None
        return TurningEffort(self.machine, self._cylinders, self.count)

    @property
    def rolls(self) -> bool:
        """Whether a rolling moment is known. Raises UsageError where no force acts."""
        return self._effort is not None

    @cached_property
    def _swirls(self) -> list[Term]:
        """−dH/dt in N m of the masses whose moment of momentum changes."""
        return [Term(-1.0, group, swirl) for group in self._effort.groups if swirls(group[0])] if self._effort else []

    @property
    def rolls_as_it_turns(self) -> bool:
        """Whether the rolling moment is the turning effort of `kurbel flywheel` with the other sign."""
        return not any(map(swirls, self._cylinders))

    def _roll_at(self, phi: Array, within: Array) -> Array | None:
        """Return the rolling moment in N m at crank angles (k,), on the sides of jumps that hold `within`."""
        if self._effort is None:
            return None
        turned = -self._effort.M_at(phi, within)
        return turned + self._effort.sum_at(self._swirls, phi, within) if self._swirls else turned

    @cached_property
    def _roll_extremes(self) -> tuple[Extreme, Extreme] | None:
        if self._effort is None:
            return None
        effort = self._effort
        roll = sum((effort.sampled([one]) for one in self._swirls), -effort.M)
        high, high_at, low, low_at = (effort.told(one[0]) for one in effort.pieces.extremes(roll[None]))
        return Extreme(high, high_at), Extreme(low, low_at)

    @property
    def M_roll_max(self) -> Extreme | None:
        """Largest rolling moment on the frame in N m."""
        return self._roll_extremes and self._roll_extremes[0]

    @property
    def M_roll_min(self) -> Extreme | None:
        """Smallest rolling moment on the frame in N m."""
        return self._roll_extremes and self._roll_extremes[1]

    @property
    def cycle(self) -> float:
        """Degrees after which everything repeats: a turn, or with gas in the rolling moment that of the machine."""
        return 360.0 * (self.machine.revolutions if any(one.drive.has_gas for one in self._cylinders) else 1)

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees between which every quantity of the only machine is smooth."""
        low = self._effort.pieces.low if self._effort else np.zeros(1)
        return np.append(low[low < self.cycle], self.cycle)

    # counterweights

    def angle_of(self, product: Any) -> Any:
        """Return the direction of a weight from throw 1 in degrees, above −180 and up to 180; None, nan of nothing."""
        turned = product / self.throws[0].weight(1.0).product
        degrees = np.degrees(np.arctan2(turned.imag, turned.real))
        degrees = np.where(degrees > _REAL - 180, degrees, 180.0)
        if self.count is None:
            return float(degrees) if product else None
        return np.where(product != 0, degrees, np.nan)

    @property
    def counterweight_given(self) -> Any:
        """Size of the sum of the given counterweights in kg m."""
        return abs(sum(one.product for one in self.counterweights)) if self.counterweights else None

    @cached_property
    def _forward(self) -> Any:
        """The forward circle of order 1 over ω², in kg m."""
        first = self.bare.force.forward[0]
        return complex(first) if self.count is None else first

    @property
    def counterweight_best(self) -> Any:
        """Product in kg m of the counterweight that takes away the forward circle of order 1."""
        return abs(self._forward)

    @property
    def counterweight_best_angle(self) -> Any:
        """Its direction from throw 1 in degrees; None for a weight of nothing."""
        return self.angle_of(-self._forward)

    @cached_property
    def least(self) -> Least:
        """The counterweight that leaves the least largest force."""
        weight = self._searched[0]
        return Least(weight, self.bare.force.turned_by(weight))

    @property
    def counterweight_least(self) -> Any:
        """Product in kg m of the counterweight that leaves the least largest force."""
        return abs(self.least.weight)

    @property
    def counterweight_least_angle(self) -> Any:
        """Its direction from throw 1 in degrees; None for a weight of nothing."""
        return self.angle_of(self.least.weight)

    @property
    def share_best(self) -> Any:
        """Share of the reciprocating mass with which a counterweight opposite the only throw is the least one's."""
        throw, *others = self.throws
        if others or not some(throw.mass != 0):
            return None
        opposite = -self.least.weight / throw.weight(1.0).product
        aside = abs(opposite.imag) > _REAL * abs(opposite)
        if self.count is None:
            return None if aside else (opposite.real - throw.rotating) / throw.mass
        with np.errstate(all="ignore"):
            return np.where(aside | (throw.mass == 0), np.nan, (opposite.real - throw.rotating) / throw.mass)

    @cached_property
    def planes(self) -> tuple[Any, ...]:
        """Places in m of two planes for counterweights: those given, or of the outer cylinders; () if they are one."""
        given = self.machine.counterweights
        named = () if isinstance(given, tuple) else given.planes
        places = [one.place for one in self.throws if one.place is not None]
        outer = (min(places), max(places)) if places and min(places) < max(places) else ()
        return named or self.wheels or outer

    @cached_property
    def best_in_planes(self) -> tuple[Weight, ...]:
        """The counterweights in two planes that take away all that turns with the crank, force and moment.

        u_a + u_b = −F and (z_a − z_0) u_a + (z_b − z_0) u_b = −M, with F and M of the forward circles of order 1.
        """
        if not self.planes or self.bare.moment is None:
            return ()
        force, moment, (first, second) = self._forward, complex(self.bare.moment.forward[0]), self.planes
        far = ((first - self.z_0) * force - moment) / (second - first)
        return Weight(-force - far, 1, first), Weight(far, 1, second)

    @cached_property
    def best_shafts(self) -> tuple[Weight, ...]:
        """The weights on shafts that take away what no counterweight can: order 1 against, order 2 either way.

        Two of order 2 are those of Lanchester. Weights of nothing are left out; where a place makes one take the moment
        away as well, it has that place.
        """
        found = []
        for order in (-1, 2, -2):
            vectors = [
                one and (one.forward if order > 0 else one.backward) for one in (self.bare.force, self.bare.moment)
            ]
            circle, lever = (0j if one is None else complex(one[abs(order) - 1]) for one in vectors)
            if circle:
                arm = 1j if self.bare.moment is None else lever / circle
                place = None if self.z_0 is None or abs(arm.imag) > _REAL * (1 + abs(arm)) else self.z_0 + arm.real
                found.append(Weight(-circle / order**2, order, place))
        return tuple(found)

    @cached_property
    def locomotive(self) -> LocomotiveBalance | None:
        """What of it concerns the wheels of a locomotive; None of another machine."""
        return LocomotiveBalance(self, self.machine.locomotive) if self.machine.locomotive else None


def swirls(cylinder: CylinderForces) -> bool:
    """Return whether the moment of momentum of its masses about the shaft changes."""
    drive = cylinder.drive
    return drive.has_inertia and (some(drive.mechanism.offset != 0) or drive.rod is not None)


def swirl(state: State) -> Any:
    """Return dH/dt = m e b in N m, less the couple of an exact rod, which swings against the crank."""
    drive = state.drive
    moment = state.b * (drive.mass * drive.mechanism.offset)
    return moment - drive.rod.couple(state.rod_angle, state.angle) if drive.rod else moment


class BookBalance:
    """The key values by the book's acceleration of first order, which are shown only on request."""

    def __init__(self, balance: MachineBalance) -> None:
        self._balance = balance

    @property
    def F_free_max_book(self) -> Extreme | None:
        """Largest unbalanced force in N."""
        return self._balance.largest(self._balance.book.force if self._balance.book else None)

    @property
    def M_free_max_book(self) -> Extreme | None:
        """Largest unbalanced moment in N m."""
        return self._balance.largest(self._balance.book.moment if self._balance.book else None)


class LocomotiveBalance:
    """The key values of a locomotive, in SI, at the angular velocity of its machine; None what needs one not given.

    The counterweights balance all that turns; what they have more than that, so as to balance a share of what goes to
    and fro, loads and lifts the wheel that has it: its hammer blow.
    """

    def __init__(self, balance: MachineBalance, given: Locomotive) -> None:
        self._balance, self._given = balance, given
        self._square = balance.omega * balance.omega if balance.omega is not None and some(balance.omega != 0) else None

    @property
    def train_speed(self) -> Any:
        """Speed of the train in m/s; None without the diameter of the wheels."""
        return None if self._square is None else self._rolling(self._balance.omega)

    def _rolling(self, omega: Any) -> Any:
        diameter = self._given.wheel_diameter
        return None if diameter is None else diameter / 2 * omega

    @property
    def traction_variation(self) -> Extreme | None:
        """Largest unbalanced force in N along the stroke lines, by which the pull at the drawbar varies."""
        return self._balance.searched("force along")

    @property
    def swaying_couple(self) -> Extreme | None:
        """Largest moment in N m of the unbalanced forces along the stroke lines about the upright axis."""
        return self._balance.searched("moment along")

    def _in_wheels(self, weights: Iterable[tuple[str, Weight]]) -> tuple[Any, Any]:
        """Return the sums of weights in the two wheels, as by a lever, in kg m; each with what it is of."""
        parts = [levered(one, self._balance.wheels, owner) for owner, one in weights]
        return sum(part[0].product for part in parts), sum(part[1].product for part in parts)

    @cached_property
    def unbalanced(self) -> tuple[Any, Any]:
        """What turns in each wheel in kg m, counterweights and rotating masses together."""
        rotating = [(one.name, one.weight(one.rotating)) for one in self._balance.throws]
        return self._in_wheels((*rotating, *(("counterweights", one) for one in self._balance.counterweights)))

    @property
    def hammer_blow(self) -> Any:
        """Largest force in N by which a wheel is loaded and lifted."""
        return None if self._square is None else _larger(*self.unbalanced) * self._square

    @property
    def hammer_speed(self) -> Any:
        """Revolutions per second at which the hammer blow is the load of a wheel; None without that, or a blow."""
        most = _larger(*self.unbalanced)
        if self._given.wheel_load is None or not some(most != 0):
            return None
        return sqrt(self._given.wheel_load / where(most != 0, most, math.nan)) / (2 * math.pi)

    @property
    def hammer_train_speed(self) -> Any:
        """Speed of the train in m/s at which it is."""
        return None if self.hammer_speed is None else self._rolling(2 * math.pi * self.hammer_speed)

    @property
    def share_allowed(self) -> Any:
        """Largest share of the reciprocating masses of which the counterweights keep the limit of the hammer blow."""
        if self._given.hammer_limit is None or self._square is None:
            return None
        whole = self._in_wheels((one.name, one.weight(one.mass)) for one in self._balance.throws)
        blow = _larger(*whole) * self._square
        return self._given.hammer_limit / where(blow > self._given.hammer_limit, blow, self._given.hammer_limit)


def _larger(one: Any, other: Any) -> Any:
    return where(abs(one) >= abs(other), abs(one), abs(other))
