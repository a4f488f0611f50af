"""Free force and free moment of a machine over ω², and which orders they have."""

from typing import NamedTuple

import numpy as np

from kurbel.solver.balance.circles import Circles
from kurbel.solver.balance.products import Products

_SHOWN = 1e-9
"""Orders that are smaller in every throw and weight, beside the largest one, are not told."""
_MOST = 24
"""Orders that are told one by one; a rod hardly longer than the crank has thousands, which die away ever so slowly."""


class Free(NamedTuple):
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
