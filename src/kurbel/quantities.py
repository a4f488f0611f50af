"""Every quantity that kurbel prints, from the classes that compute them: for limits, sweeps, JSON and the reference."""

from functools import cache

from kurbel.mechanisms.kinds import KINDS
from kurbel.quantity import Lists
from kurbel.solver.balance import MachineBalance
from kurbel.solver.bearings import Bearing
from kurbel.solver.delivery import CompressorStage, Delivery
from kurbel.solver.figures import Results, rows_of
from kurbel.solver.flywheel import DeadCentre, MachineTurning
from kurbel.solver.forces import CylinderForces
from kurbel.solver.harmonics import MachineOrders
from kurbel.solver.stress import CrankshaftStrength
from kurbel.solver.torsion import ShaftVibration

RESULTS: tuple[type[Results], ...] = (
    CylinderForces,
    MachineTurning,
    DeadCentre,
    CrankshaftStrength,
    Bearing,
    MachineBalance,
    MachineOrders,
    ShaftVibration,
    Delivery,
    CompressorStage,
)
"""The classes of results, in the order in which their quantities are listed; each includes those of its parts."""


@cache
def every_quantity() -> Lists:
    """Return all quantities that any machine may have; one that several classes declare is listed for each."""
    offers = dict.fromkeys(offer for one in KINDS for offer in one.OFFERS)
    key_offers = dict.fromkeys(offer for one in KINDS for offer in one.KEY_OFFERS)
    every = [rows_of(CylinderForces, (*offers,), (*key_offers,)).lists, *(rows_of(one).lists for one in RESULTS[1:])]
    columns = (quantity for one in every for quantity in one.all_columns)
    return Lists((*columns,), tuple(quantity for one in every for quantity in one.all_key_values))
