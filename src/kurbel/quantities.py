"""Every quantity that kurbel prints, from the classes that compute them: for limits, sweeps, JSON and the reference."""

from functools import cache

from kurbel.mechanisms.kinds import KINDS
from kurbel.quantity import Lists
from kurbel.solver.case import CHAPTERS
from kurbel.solver.figures import result_rows
from kurbel.solver.forces import CylinderForces


@cache
def every_quantity() -> Lists:
    """Return all quantities that any machine may have; one that several classes declare is listed for each."""
    offers = tuple(dict.fromkeys(offer for kind in KINDS for offer in kind.OFFERS))
    key_offers = tuple(dict.fromkeys(offer for kind in KINDS for offer in kind.KEY_OFFERS))
    kinds = [chapter.kind for chapter in CHAPTERS]
    every = [
        (
            result_rows(kind, offers, key_offers) if kind is CylinderForces else result_rows(kind)
        ).lists
        for kind in kinds
    ]
    columns = (quantity for one in every for quantity in one.all_columns)
    return Lists((*columns,), tuple(quantity for one in every for quantity in one.all_key_values))
