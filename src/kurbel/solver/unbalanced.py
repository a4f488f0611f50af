"""Unbalanced forces and moments of the moving masses, order by order.

The unbalanced (shaking) force is minus the sum of mass times acceleration of all moving parts (d'Alembert), at uniform
rotation. It is a complex number in the plane square to the shaft, everywhere over ω², so that it is in kg m:

      F_y ↑   ∕ stroke line of a cylinder, at its bank angle γ      β    angle by which its crank follows crank 1
          │ ∕                                                       m, m_rot  mass to and fro, mass at the crank pin
    shaft O────→ F_x  stroke line of cylinder 1, outward            z, z_0    place along the shaft, of the moments

    F = Σ (m x″(φ − β) + m_rot R e^{i(φ − β)}) e^{iγ}     all angles in the sense of rotation, x″ = d²x/dφ²
    M = Σ (z − z_0) F                                     the vector turned back by 90°, so that it points as forces do
    F = Σ c_n e^{inφ}                                     circles of order n with the rotation, n < 0 against it
    u n² e^{±inφ}                                         pull of a weight u, mass times radius, that turns n times
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.errors import UsageError
from kurbel.machine.batch import values_of
from kurbel.mechanisms import Mechanism
from kurbel.numerics.arithmetic import some, unless_cancelled
from kurbel.numerics.enclosing import ClosedCurve
from kurbel.solver.weights import OwnThrow, Weight

_SAMPLES = 256
"""Equal angles of a turn from which the orders of a mechanism are found, four times as many where a rod is short, …"""
_MOST_SAMPLES = 1 << 20
"""… up to these of all machines together: a batch of more raises an error, and its machines are computed alone."""
_SHOWN = 1e-9
"""Of the largest order: smaller ones are not listed."""
_FEWEST = 8
"""Orders that are kept at least: those of balance shafts."""
_MOST = 24
"""Orders that are listed; a rod hardly longer than the crank has thousands, which die away slowly."""
_AT_ONCE = 1 << 20
"""Waves that are summed together."""
_EPS = float(np.finfo(float).eps)

Curvature = Callable[[Mechanism, CrankAngle], Any]
"""x″ = d²x/dφ² in m of a mechanism."""


def orders_of(throw: OwnThrow, curvature: Curvature, count: int) -> ComplexArray:
    """Return the orders c_n in m, n from 1 on, (k, count), with x″ = 2 Re Σ c_n e^{inφ}; what is rounding is exactly 0.

    The shorter the rod, the more orders: those above half of the last are to be zero. Raises UsageError for a rod with
    more of them than can be computed, L/R < 1.00000001.
    """
    samples = _SAMPLES
    while samples * count <= _MOST_SAMPLES:
        degrees: Array = np.arange(samples, dtype=float)[:, None] * (360.0 / samples)
        values = np.broadcast_to(curvature(throw.mechanism, CrankAngle.of(degrees)), (samples, count))
        waves, least = np.fft.rfft(values, axis=0)[1:] / samples, _EPS * np.abs(values).max(axis=0)
        # cosines and sines each: an even function is without sines
        cos, sin = (np.where(np.abs(part) > least, part, 0.0) for part in (waves.real, waves.imag))
        waves = cos + 1j * sin
        last = int(np.flatnonzero(waves.any(axis=1)).max(initial=0)) + 1
        if last <= samples // 4:
            return np.asarray(waves[:last])
        samples *= 4
    raise UsageError(f"{throw.name}: the rod is so little longer than the crank that its forces have no end of orders")


def book_curvature(mechanism: Mechanism, angle: CrankAngle) -> Any:
    """Return d²x/dφ² in m of first order, R 291; the true one where there is no rod, None where the book has none."""
    offer = next((one for one in mechanism.OFFERS if one.quantity.id == "b_book"), None)
    return offer.factor(mechanism, angle) if offer else mechanism.curvature(angle)


class Terms(NamedTuple):
    """What each throw and each weight gives to the force over ω²: its waves in kg m, (terms, 2k + 1, machines).

    places: of each along the shaft in m, None: not known.
    """

    waves: ComplexArray
    places: tuple[Any, ...]

    @classmethod
    def of(cls, throws: Sequence[OwnThrow], curvature: Curvature, count: int) -> Terms:
        """Return what throws give, masses to and fro and at the pin; of equal mechanisms the orders are found once."""
        known: dict[object, ComplexArray] = {}
        for throw in throws:
            if _key(throw.mechanism) not in known:
                known[_key(throw.mechanism)] = orders_of(throw, curvature, count)
        k = max(_FEWEST, *map(len, known.values()))
        numbers, waves = np.arange(-k, k + 1), []
        for throw in throws:
            orders = known[_key(throw.mechanism)]
            orders = np.concatenate((orders, np.zeros((k - len(orders), count))))
            of_mechanism = np.concatenate((orders[::-1].conj(), np.zeros((1, count)), orders))
            late = np.multiply.outer(numbers, np.broadcast_to(throw.late, count))
            waves.append(of_mechanism * throw.mass * unit_vector(throw.bank - late))
        own = cls(np.array(waves), tuple(throw.place for throw in throws))
        return own.with_weights(throw.weight(throw.rotating) for throw in throws)

    def with_weights(self, weights: Iterable[Weight]) -> Terms:
        """Return them with further weights, each of which turns `order` times and pulls with u n²."""
        given = [one for one in weights if some(one.product != 0)]
        more = np.zeros((len(given), *self.waves.shape[1:]), complex)
        for row, one in enumerate(given):
            more[row, one.order + self.waves.shape[1] // 2] = one.product * one.order**2
        return Terms(np.concatenate((self.waves, more)), (*self.places, *(one.place for one in given)))

    def summed(self, levers: Sequence[Any]) -> ClosedCurve:
        """Return the sum, each term times its lever; what cancels is exactly 0."""
        terms = self.waves * np.array([np.broadcast_to(one, self.waves.shape[2]) for one in levers])[:, None]
        return ClosedCurve(np.asarray(unless_cancelled(terms.sum(axis=0), np.abs(terms).sum(axis=0))))


def _key(mechanism: Mechanism) -> object:
    values = values_of(mechanism).values()
    return type(mechanism), *(one.tobytes() if isinstance(one, np.ndarray) else one for one in values)


class Free:
    """The unbalanced force over ω² in kg m, and the moment in kg m², None where a place is not known.

    z_0: from where moments are taken in m, None: not known.
    """

    def __init__(self, terms: Terms, z_0: Any) -> None:
        self._terms = terms
        self.force = terms.summed([1.0] * len(terms.places))
        known = z_0 is not None and all(place is not None for place in terms.places)
        self.moment = terms.summed([place - z_0 for place in terms.places]) if known else None

    @cached_property
    def _orders(self) -> tuple[int, ...]:
        sizes = np.abs(self._terms.waves[:, :, 0]).max(axis=0)
        k = len(sizes) // 2
        both = sizes[k + 1 :] + sizes[:k][::-1]
        return tuple((np.flatnonzero(both > _SHOWN * both.max()) + 1).tolist())

    @property
    def orders(self) -> tuple[int, ...]:
        """The lowest orders of one machine that some throw or weight has, whether or not they cancel."""
        return self._orders[:_MOST]

    @property
    def next_order(self) -> int | None:
        """The first order that is not among them; None where there is none."""
        return self._orders[_MOST] if len(self._orders) > _MOST else None

    def at_most(self, vector: ClosedCurve) -> float:
        """Return what the force or the moment of the higher orders is at most."""
        higher = np.abs(vector.numbers)[:, None] > self.orders[-1]
        return float(ClosedCurve(vector.waves * higher).farthest()[0][0])


def vector_at(curve: ClosedCurve, degrees: Array) -> ComplexArray:
    """Return the vectors (n,) of one machine at angles (n,) in degrees; what cancels is exactly 0."""
    parts = np.array_split(degrees, math.ceil(len(degrees) * len(curve.waves) / _AT_ONCE) or 1)
    return np.asarray(
        unless_cancelled(np.concatenate([curve.at(part)[0] for part in parts]), np.abs(curve.waves).sum())
    )
