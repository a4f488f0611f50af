"""Free force and free moment of a machine over ω², order by order: what every throw and every weight gives to them."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.errors import UsageError
from kurbel.machine.variants import values_of
from kurbel.mechanisms import Mechanism
from kurbel.numerics.arithmetic import unless_cancelled
from kurbel.numerics.fourier import coefficients
from kurbel.solver.balance.circles import Circles
from kurbel.solver.weights import OwnThrow, Weight

_SHOWN = 1e-9
"""Orders that are smaller in every throw and weight, beside the largest one, are not told."""
_MOST = 24
"""Orders that are told one by one; a rod hardly longer than the crank has thousands, which die away ever so slowly."""


@dataclass(frozen=True, eq=False)
class Products:
    """Terms of a free force over ω² in kg m, by order: forward, backward, complex (terms, K); places in m or None."""

    forward: ComplexArray
    backward: ComplexArray
    places: tuple[float | None, ...]

    def summed(self, levers: Array | float = 1.0) -> Circles:
        """Return the sum, each term times its lever; what cancels is exactly zero."""
        return Circles(*(_sum(terms * np.reshape(levers, (-1, 1))) for terms in (self.forward, self.backward)))

    def with_weights(self, weights: Iterable[Weight]) -> "Products":
        """Return them with further weights."""
        given = tuple(one for one in weights if one.product)
        orders = max((self.forward.shape[1], *(abs(one.order) for one in given)))
        more = (0, len(given)), (0, orders - self.forward.shape[1])
        forward, backward = np.pad(self.forward, more), np.pad(self.backward, more)
        for row, one in enumerate(given, len(self.places)):
            (forward if one.order > 0 else backward)[row, abs(one.order) - 1] = one.product * one.order**2
        return Products(forward, backward, (*self.places, *(one.place for one in given)))


def _sum(terms: ComplexArray) -> ComplexArray:
    return np.asarray(unless_cancelled(terms.sum(axis=0), np.abs(terms).sum(axis=0)))


@dataclass(frozen=True, eq=False)
class Free:
    """The force over ω² in kg m and the moment over ω² in kg m², None where a place along the shaft is not known.

    orders: the lowest of those that some throw or weight has, whether or not they cancel; higher: the others.
    """

    force: Circles
    moment: Circles | None
    orders: tuple[int, ...]
    higher: tuple[int, ...] = ()

    def at_most(self, vector: Circles) -> float:
        """Return what the force or the moment of the higher orders is at most, whatever the angle."""
        return float(sum(np.abs(part[self.orders[-1] :]).sum() for part in (vector.forward, vector.backward)))

    @classmethod
    def of(cls, products: Products, z_0: float | None) -> "Free":
        """Return the sum of products, with moments taken from a place in m."""
        places = [place for place in products.places if place is not None]
        known = z_0 is not None and len(places) == len(products.places)
        moment = products.summed(np.array(places) - z_0) if known else None
        sizes = (np.abs(products.forward) + np.abs(products.backward)).max(axis=0)
        orders = tuple((np.flatnonzero(sizes > _SHOWN * sizes.max()) + 1).tolist())
        return cls(products.summed(), moment, orders[:_MOST], orders[_MOST:])


Curvature = Callable[[Mechanism, CrankAngle], "Array | None"]
"""d²x/dφ² in m."""


def of_throws(throws: Sequence[OwnThrow], curvature: Curvature = lambda one, angle: one.curvature(angle)) -> Products:
    """Return the products of the moving parts of these throws.

    Raises UsageError for a rod so short that its orders do not settle.
    """
    found: dict[object, ComplexArray] = {}
    lines = []
    for throw in throws:
        alike = (type(throw.mechanism), *values_of(throw.mechanism).values())
        if alike not in found:
            found[alike] = _coefficients(throw, curvature)
        lines.append(found[alike] * throw.mass)
    orders = np.arange(1, max(2, *map(len, lines)) + 1)
    masses = np.zeros((len(lines), len(orders)), complex)
    for row, line in zip(masses, lines):
        row[: len(line)] = line
    bank, late = (np.array([[getattr(throw, name)] for throw in throws]) for name in ("bank", "late"))
    products = Products(
        masses * unit_vector(bank - late * orders),
        masses.conj() * unit_vector(bank + late * orders),
        tuple(throw.place for throw in throws),
    )
    return products.with_weights(throw.weight(throw.rotating) for throw in throws)


def _coefficients(throw: OwnThrow, curvature: Curvature) -> ComplexArray:
    """Return c_n of d²x/dφ² in m."""
    mechanism = throw.mechanism
    found = coefficients(lambda degrees: np.asarray(curvature(mechanism, CrankAngle.of(degrees))))
    if found is None:
        raise UsageError(
            f"{throw.name}: the orders of so short a connecting rod do not settle (L/R = {1 / mechanism.lam:.9g})"
        )
    return found


def of_book(mechanism: Mechanism, angle: CrankAngle) -> Array | None:
    """Return d²x/dφ² in m of first order, R 291; the true one where there is no rod, None where the book has none."""
    offer = next((one for one in mechanism.OFFERS if one.quantity.id == "b_book"), None)
    found: Array | None = offer.factor(mechanism, angle) if offer else mechanism.curvature(angle)
    return found
