"""Every quantity that kurbel prints, from the classes that compute them: for limits, sweeps, JSON and the reference."""

from functools import cache

from kurbel.mechanisms.kinds import KINDS
from kurbel.quantity import Lists
from kurbel.solver.case import CHAPTERS
from kurbel.solver.figures import rows_of
from kurbel.solver.forces import CylinderForces


@cache
def every_quantity() -> Lists:
    """Return all quantities that any machine may have; one that several classes declare is listed for each."""
    offers = tuple(dict.fromkeys(offer for one in KINDS for offer in one.OFFERS))
    key_offers = tuple(dict.fromkeys(offer for one in KINDS for offer in one.KEY_OFFERS))
    kinds = [one.kind for one in CHAPTERS]
    every = [(rows_of(one, offers, key_offers) if one is CylinderForces else rows_of(one)).lists for one in kinds]
    columns = (quantity for one in every for quantity in one.all_columns)
    return Lists((*columns,), tuple(quantity for one in every for quantity in one.all_key_values))
