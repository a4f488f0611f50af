"""The unbalanced forces and moments of throws, order by order, as vectors that turn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np

from kurbel.arrays import Array, ComplexArray, Number
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.errors import UsageError
from kurbel.mechanisms import Mechanism
from kurbel.numerics.arithmetic import some, unless_cancelled
from kurbel.numerics.enclosing import ClosedCurve
from kurbel.solver.shaft import CylinderThrow, Weight

if TYPE_CHECKING:
    from kurbel.mechanisms.link_rod import LinkedPiston


_SAMPLES = 256
"""Samples of a revolution to begin with; four times as many, again and again, until the orders converge."""
_MOST_SAMPLES = 1 << 20
"""Largest number of samples times machines; a batch of more raises UsageError, and its machines are computed singly."""
_SHOWN = 1e-9
"""Relative to the largest order: smaller ones are not listed."""
_FEWEST = 8
"""Smallest number of orders, so that those of balance shafts are included."""
_MOST = 24
"""Largest number of orders listed; a rod hardly longer than the crank has thousands, which decrease slowly."""
_AT_ONCE = 64
"""Orders that are computed at all angles together."""
_EPS = float(np.finfo(float).eps)


def orders_of(throw: CylinderThrow, book: bool, count: int) -> ComplexArray:
    """Return the Fourier coefficients c_n in m, n = 1 … k, (k, count): x″ = 2 Re Σ c_n e^{inφ}.

    Coefficients that are rounding are 0.

    Samples are added until all orders in the upper half of those resolved vanish; a short rod needs more. book: take
    the acceleration of first order instead of the exact one. Raises UsageError for a rod with more orders than can be computed, L/R < 1.00000001.
    """
    mechanism = throw.cylinder.mechanism
    samples = _SAMPLES
    while samples * count <= _MOST_SAMPLES:
        # d²x/dφ² at equal steps of a revolution
        degrees: Array = np.arange(samples, dtype=float)[:, None] * (360.0 / samples)
        angle = CrankAngle.of(degrees)
        curvature = book_curvature(mechanism, angle) if book else mechanism.curvature(angle)
        values = np.broadcast_to(curvature, (samples, count))
        waves = np.fft.rfft(values, axis=0)[1:] / samples
        rounding = _EPS * np.abs(values).max(axis=0)
        # cosines and sines each: an even function is without sines
        waves = unless_cancelled(waves, rounding, 1.0)
        order_count = int(np.flatnonzero(waves.any(axis=1)).max(initial=0)) + 1
        if order_count <= samples // 4:
            return waves[:order_count]
        samples *= 4
    raise UsageError(
        f"{throw.name}: the rod is so little longer than the crank that the orders of its forces do not converge"
    )


def book_curvature(mechanism: Mechanism, angle: CrankAngle) -> Any:
    """Return d²x/dφ² in m of first order, R 291; the true one where there is no rod, None where the book has none."""
    offer = next((offer for offer in mechanism.OFFERS if offer.quantity.id == "b_book"), None)
    if offer:
        return offer.factor(mechanism, angle)
    return mechanism.curvature(angle)


class Contribution(NamedTuple):
    """What a throw or weight adds to the unbalanced force over ω²; place: along the shaft in m, None if not known.

    waves: its Fourier coefficients in kg m from −k to k, (2k + 1, count).
    """

    waves: ComplexArray
    place: Number | None


def contributions_of(
    throws: Sequence[CylinderThrow], weights: Sequence[Weight], book: bool, count: int
) -> list[Contribution]:
    """Return (m x″(φ − δ) + m_rot R e^{i(φ − δ)}) e^{iγ} of each throw, and u n² e^{inφ} of each weight.

    book: with the acceleration of first order. Cylinders with the same mechanism share one analysis.
    """
    # one analysis for each mechanism
    throws_by_mechanism = {id(throw.cylinder.mechanism): throw for throw in throws}
    orders = {key: orders_of(throw, book, count) for key, throw in throws_by_mechanism.items()}
    k = max(_FEWEST, *map(len, orders.values()))
    contributions = list[Contribution]()
    # m x″(φ − δ) e^{iγ}: a real function has the conjugate waves backward
    for throw in throws:
        listed = orders[id(throw.cylinder.mechanism)]
        forward = np.concatenate((listed, np.zeros((k - len(listed), count))))
        waves = np.concatenate((forward[::-1].conj(), np.zeros((1, count)), forward))
        lag = np.broadcast_to(throw.lag, count)
        turned_back = np.multiply.outer(np.arange(-k, k + 1), lag)
        turned = waves * throw.mass * unit_vector(throw.bank - turned_back)
        contributions.append(Contribution(turned, throw.place))
    contributions += _of_knuckles(throws, k, count)
    # m_rot R of the throws, and the weights: u n² e^{inφ}
    rotating = [throw.weight(throw.rotating) for throw in throws]
    for weight in (*rotating, *weights):
        if some(weight.product != 0):
            waves = np.zeros((2 * k + 1, count), complex)
            waves[k + weight.order] = weight.product * weight.order**2
            contributions.append(Contribution(waves, weight.place))
    return contributions


def _of_knuckles(throws: Sequence[CylinderThrow], k: int, count: int) -> list[Contribution]:
    """Return −m_k z″(φ − δ) e^{iγ} of the mass of each link rod at its knuckle pin, from order −k to k."""
    contributions = list[Contribution]()
    for throw in throws:
        if not some(throw.knuckle_mass != 0):
            continue
        # z″ is complex: its waves forward and backward are not conjugate
        samples = max(_SAMPLES, 4 * k)
        degrees: Array = np.arange(samples, dtype=float)[:, None] * (360.0 / samples)
        linked_piston = cast("LinkedPiston", throw.cylinder.mechanism)
        _, acceleration = linked_piston.knuckle_motion(CrankAngle.of(degrees))
        values = np.broadcast_to(acceleration, (samples, count))
        transformed = np.fft.fft(values, axis=0) / samples
        orders = np.arange(-k, k + 1)
        waves = unless_cancelled(transformed[orders], _EPS * np.abs(values).max(axis=0), 1.0)
        lag = np.broadcast_to(throw.lag, count)
        turned_back = np.multiply.outer(orders, lag)
        turned = waves * -throw.knuckle_mass * unit_vector(throw.bank - turned_back)
        contributions.append(Contribution(turned, throw.place))
    return contributions


class Unbalanced:
    """The unbalanced force over ω² in kg m, and the moment over ω² in kg m², of the sum of all parts.

    z_0: reference plane of the moments in m; the moment is None where it, or a place, is not known. Orders that cancel
    are exactly 0. orders: of one machine, the lowest orders that any part has, whether or not they cancel in the sum;
    next_order: the first one that is not listed, None if all are.
    """

    def __init__(self, parts: Sequence[Contribution], z_0: Number | None) -> None:
        waves = np.array([part.waves for part in parts])
        self.force = _summed(waves, [1.0] * len(parts))
        # a moment needs the levers of all parts
        self.moment: ClosedCurve | None = None
        places = [part.place for part in parts if part.place is not None]
        if not parts:
            self.moment = _summed(waves, [])
        elif len(places) == len(parts) and z_0 is not None:
            self.moment = _summed(waves, [place - z_0 for place in places])
        # orders are those of the waves forward and backward together
        sizes = np.abs(waves[:, :, 0]).max(axis=0)
        middle = len(sizes) // 2
        forward = sizes[middle + 1 :]
        backward = sizes[:middle][::-1]
        sums = forward + backward
        orders = tuple((np.flatnonzero(sums > _SHOWN * sums.max()) + 1).tolist())
        self.orders = orders[:_MOST]
        self.next_order = orders[_MOST] if len(orders) > _MOST else None


def _summed(waves: ComplexArray, levers: Sequence[Number]) -> ClosedCurve:
    terms = waves * np.array([np.broadcast_to(lever, waves.shape[2]) for lever in levers])[:, None]
    return ClosedCurve(unless_cancelled(terms.sum(axis=0), np.abs(terms).sum(axis=0)))


def vector_at(curve: ClosedCurve, degrees: Array) -> ComplexArray:
    """Return the force or moment vectors (n,) of one machine at crank angles (n,) in degrees; rounding is set to 0."""
    waves = curve.waves[:, 0]
    present = np.flatnonzero(waves)
    vectors = np.zeros(degrees.shape, complex)
    offsets: Array = np.empty(0)
    within_block = np.empty(0, complex)
    for begin in range(0, len(present), _AT_ONCE):
        block = present[begin : begin + _AT_ONCE]
        # e^{inφ} = e^{iaφ} e^{i(n − a)φ}: the second factor is that of the block before; of few waves a = 0
        first = curve.numbers[block[0]] if len(present) > _AT_ONCE else 0
        apart = curve.numbers[block] - first
        if not np.array_equal(apart, offsets):
            offsets = apart
            within_block = unit_vector(np.multiply.outer(offsets, degrees))
        turned = waves[block, None] * (unit_vector(first * degrees) * within_block)
        # one after another, so that the sum at an angle does not depend on the others
        for wave in turned:
            vectors += wave
    return unless_cancelled(vectors, np.abs(waves).sum())
