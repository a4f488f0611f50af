"""Weights that take away what is unbalanced: counterweights in one plane and in two, and balance shafts."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.numerics.enclosing import Circle, PlaneCurve, carried, smallest_circle
from kurbel.solver.balance.circles import Circles
from kurbel.solver.weights import Weight

_SETTLED = 1e-13  # the radius, relatively
_AT_ONCE = 6  # summits; of a curve that is a circle all points are
_ROUNDS = 100
_REAL = 1e-12  # what a lever in m may miss the plane of its force by, by rounding


@dataclass(frozen=True, eq=False)
class Least:
    """The counterweight that leaves the least largest product: it, complex in kg m, and what is left."""

    weight: complex
    left: Circles


def least(products: Circles) -> Least:
    """Return the counterweight u on the crank that leaves the least largest |P(φ) + u e^{iφ}|.

    In the frame of the crank P is the curve P(φ) e^{−iφ}, and −u the centre of the smallest circle round it. That round
    its farthest points grows, point by point, until nothing of the curve stands beyond it; Newton's method tells where
    those that carry it are to be sought. With even orders alone the curve is its own image about 0, where the centre
    then is.
    """
    if not (products.forward[::2].any() or products.backward[::2].any()):
        return Least(0j, products)
    curve = _in_crank_frame(products)
    angles, circle = np.array([]), Circle(complex(products.forward[0]), 0.0, ())
    for _ in range(_ROUNDS):
        left = products.turned_by(-circle.centre)
        far = [one.degrees for one in left.summits[:_AT_ONCE] if one.value > circle.radius * (1 + _SETTLED)]
        if not far:
            break
        circle, angles = _enclosed(curve, np.concatenate((angles, np.radians(far))))
        if len(angles) > 1:
            circle, angles = _enclosed(curve, np.concatenate((angles, carried(curve, angles, circle))))
    return Least(-circle.centre, left)


def _enclosed(curve: PlaneCurve, angles: Array) -> tuple[Circle, Array]:
    """Return the smallest circle round the points of a curve at these angles, and the angles of those that carry it."""
    points = curve(angles)[0].tolist()
    circle = smallest_circle(points)
    return circle, angles[[points.index(one) for one in circle.carriers]]


def _in_crank_frame(products: Circles) -> PlaneCurve:
    """Return P(φ) e^{−iφ} with its first and second derivatives, each (n,), at angles (n,) in radians."""
    orders = np.arange(1, len(products.forward) + 1)
    turns = np.concatenate((orders - 1, -orders - 1))
    sizes = np.concatenate((products.forward, products.backward))
    turns, sizes = turns[sizes != 0], sizes[sizes != 0]

    def curve(angles: Array) -> tuple[ComplexArray, ...]:
        turned = np.exp(1j * np.multiply.outer(angles, turns))
        return tuple(turned @ (sizes * (1j * turns) ** derivative) for derivative in range(3))

    return curve


def in_planes(force: complex, moment: complex, planes: Sequence[float]) -> tuple[Weight, Weight]:
    """Return the counterweights in two planes that take away a force and a moment that turn with the crank.

    force, moment: over ω², in kg m and kg m², with their directions at φ = 0; planes: in m, from where the moment is
    taken. u_a + u_b = −F and z_a u_a + z_b u_b = −M.
    """
    first, second = planes
    far = (first * force - moment) / (second - first)
    return Weight(-force - far, 1, first), Weight(far, 1, second)


def shafts(force: Circles, moment: Circles | None, z_0: float | None) -> tuple[Weight, ...]:
    """Return the weights on shafts that take away what no counterweight can: order 1 against, order 2 either way.

    force, moment: over ω², in kg m and kg m², the moment about z_0. Two of order 2 are those of Lanchester. Weights of
    nothing are left out; where a place makes one take the moment away as well, it stands there.
    """
    found = []
    for order in (-1, 2, -2):
        circle, lever = (_circle(one, order) for one in (force, moment or force))
        if circle:
            arm = lever / circle if moment else 1j
            place = None if z_0 is None or abs(arm.imag) > _REAL * (1 + abs(arm)) else z_0 + arm.real
            found.append(Weight(-circle / order**2, order, place))
    return tuple(found)


def _circle(vector: Circles, order: int) -> complex:
    return complex((vector.forward if order > 0 else vector.backward)[abs(order) - 1])
