"""The free force over ω², order by order: what every throw and every weight gives to it, a mass times a length."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.crank_angle import CrankAngle
from kurbel.errors import UsageError
from kurbel.mechanisms import Mechanism
from kurbel.numerics.arithmetic import unless_cancelled
from kurbel.numerics.fourier import coefficients
from kurbel.solver.balance.circles import Circles, unit_vectors
from kurbel.solver.shaft.weights import OwnThrow, Weight


class Products(NamedTuple):
    """Terms of a free force over ω² in kg m, by order: forward, backward, complex (terms, K); places in m or None."""

    forward: ComplexArray
    backward: ComplexArray
    places: tuple[float | None, ...]

    def summed(self, levers: Array | None = None) -> Circles:
        """Return the sum, each term times its lever; what cancels is exactly zero."""
        factors = np.ones(len(self.places)) if levers is None else levers
        return Circles(*(_sum(terms * factors[:, None]) for terms in (self.forward, self.backward)))

    def with_weights(self, weights: Iterable[Weight]) -> "Products":
        """Return them with further weights."""
        given = tuple(one for one in weights if one.product)
        orders = max((self.forward.shape[1], *(abs(one.order) for one in given)))
        forward = np.zeros((len(self.places) + len(given), orders), complex)
        backward = forward.copy()
        for new, terms in ((forward, self.forward), (backward, self.backward)):
            new[: terms.shape[0], : terms.shape[1]] = terms
        for row, one in enumerate(given, len(self.places)):
            (forward if one.order > 0 else backward)[row, abs(one.order) - 1] = one.product * one.order**2
        return Products(forward, backward, (*self.places, *(one.place for one in given)))


def _sum(terms: ComplexArray) -> ComplexArray:
    return np.asarray(unless_cancelled(terms.sum(axis=0), np.abs(terms).sum(axis=0)))


def of_throws(throws: Sequence[OwnThrow], book: bool = False) -> Products | None:
    """Return the products of the moving parts of these throws; None where the book has no formula for one of them.

    book: by its acceleration of first order, R 291, in place of the true one. Raises UsageError for a rod so short
    that its orders do not settle.
    """
    found: dict[object, ComplexArray] = {}
    lines = []
    for throw in throws:
        mechanism = throw.mechanism
        alike = (type(mechanism), *vars(mechanism).values())
        if alike not in found:
            bends = _coefficients(throw, book)
            if bends is None:
                return None
            found[alike] = bends
        lines.append(found[alike] * throw.mass)
    orders = np.arange(1, max(2, *map(len, lines)) + 1)
    masses = np.zeros((len(lines), len(orders)), complex)
    for row, line in zip(masses, lines):
        row[: len(line)] = line
    bank, late = (np.array([[getattr(throw, name)] for throw in throws]) for name in ("bank", "late"))
    products = Products(
        masses * unit_vectors(bank - late * orders),
        masses.conj() * unit_vectors(bank + late * orders),
        tuple(throw.place for throw in throws),
    )
    return products.with_weights(throw.weight(throw.rotating) for throw in throws)


def _coefficients(throw: OwnThrow, book: bool) -> ComplexArray | None:
    """Return c_n of d²x/dφ² in m; None where the book has no formula for this mechanism."""
    mechanism = throw.mechanism
    if book and _book_curvature(mechanism, CrankAngle.of(0.0)) is None:
        return None
    curvature = _book_curvature if book else type(mechanism).curvature
    found = coefficients(lambda degrees: np.asarray(curvature(mechanism, CrankAngle.of(degrees))))
    if found is None:
        raise UsageError(
            f"{throw.name}: the orders of so short a connecting rod do not settle (L/R = {1 / mechanism.lam:.9g})"
        )
    return found


def _book_curvature(mechanism: Mechanism, angle: CrankAngle) -> Array | None:
    """Return d²x/dφ² in m after the book; the true one where there is no rod, of which it would be the first order."""
    offer = next((one for one in mechanism.OFFERS if one.quantity.id == "b_book"), None)
    found: Array | None = offer.factor(mechanism, angle) if offer else mechanism.curvature(angle)
    return found
