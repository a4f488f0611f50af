"""The report of `kurbel balance`: free forces and moments over the crank angle, their orders, the best weights."""

import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from kurbel.declared.balance import ELLIPSES, ORDERS, WEIGHTS
from kurbel.declared.unit_systems import show
from kurbel.numerics.enclosing import ClosedCurve
from kurbel.quantity import Quantity
from kurbel.report.frame import Frame, Subject
from kurbel.report.pin_notes import pin_notes
from kurbel.report.shown import place_table, shown_column
from kurbel.report.tables import Column, LeftOut, PlaceTable, Report
from kurbel.solver.balance import MachineBalance
from kurbel.solver.case import Case
from kurbel.solver.unbalanced import Free
from kurbel.solver.weights import Weight

_Entry = tuple[Quantity, "list[float | None]"]
_DIGITS = 4
_NOTHING = 1e-6
"""Degrees by which a direction may miss another by rounding."""


@np.errstate(all="ignore")  # what overflows is refused, by name
def balance_report(case: Case, frame: Frame, orders_only: bool = False) -> Report:
    """Return what is free and what balances it; orders_only: no columns over the crank angle.

    Raises UsageError where no masses move.
    """
    compare = frame.compare
    (whole,) = subjects(case, compare)
    tables = tuple(_balance_tables(case.balance, frame.system, compare))
    whole = replace(whole, place_tables=tables, at=None if orders_only or case.machine.speed is None else whole.at)
    return frame.report(case.machine, "Massenausgleich", (), whole, _notes(case.balance))


def subjects(case: Case, compare: bool = False) -> Iterable[Subject]:
    """Yield the whole machine; compare: with what the acceleration of first order gives, beside the true figures."""
    balance = MachineBalance(case.machine, case.cylinders, compare=True) if compare else case.balance
    yield Subject(
        "whole machine",
        (balance,),
        balance.at,
        left_out=lambda: _left_out(balance, compare),
        warnings=lambda: pin_notes(case.machine),
    )


def _left_out(balance: MachineBalance, compare: bool) -> Iterable[LeftOut]:
    moving = {throw.name for throw in balance.throws}
    for cylinder in balance.machine.cylinders:
        if cylinder.name not in moving:
            yield LeftOut(f"inertia of {cylinder.name}", "no masses given")
    if balance.omega is None:
        yield LeftOut("free forces and moments", "no speed given; the weights against them do not depend on it")
    if balance.free.moment is None:
        yield LeftOut("free moments", f"no axial_position given of {', '.join(_without_place(balance))}")
    if compare and balance.book is None:
        yield LeftOut("figures of first order", "the book has no such formula for a stroke line beside the shaft")


def _without_place(balance: MachineBalance) -> Iterable[str]:
    yield from (throw.name for throw in balance.throws if throw.place is None)
    if any(one.place is None for one in balance.counterweights):
        yield "counterweights of the machine"
    if any(one.axial_position is None for one in balance.machine.balance_shafts):
        yield "balance_shafts"


def _notes(balance: MachineBalance) -> Iterable[str]:
    yield "φ is the angle of crank 1; F_x and M_x count along the stroke line of cylinder 1, F_y and M_y across it."
    if balance.free.moment is not None and balance.z_0 is not None:
        yield f"Moments are taken about z = {show(balance.z_0, 'length')}."
    if balance.free.next_order and balance.omega is not None:
        yield _higher(balance.free, balance.omega * balance.omega)
    if balance.counterweights or balance.machine.balance_shafts:
        yield "Counterweights and shafts of the file count in all that is free; the best weights stand in their place."
    if balance.effort is not None:
        yield "M_roll is −M of kurbel flywheel, less what turns the masses themselves about the shaft."


def _higher(free: Free, square: float) -> str:
    """Say what the orders are together that no table lists; square: ω²."""
    most = show(free.at_most(free.force) * square, "force")
    if free.moment is not None:
        most += f", of the moment {show(free.at_most(free.moment) * square, 'torque')}"
    return (
        f"More orders follow, from n = {free.next_order} on, which the rod brings, hardly longer than the crank: "
        f"of the force they are at most {most}, together."
    )


def _balance_tables(balance: MachineBalance, system: str, compare: bool) -> Iterator[PlaceTable]:
    """Yield what there is of the tables; compare: see `subjects`."""
    if balance.omega is not None:
        square = balance.omega * balance.omega
        orders = Column("order", "n", "n", "", balance.free.orders, ORDERS["order"].text, alone=_DIGITS)
        circles, ellipses = _circles(balance, square, compare), _ellipses(balance.free, square)
        for id, title, found in (
            ("orders", "Orders: circles with the crank (+) and against it (−)", circles),
            ("ellipses", "Orders: ellipses, and where the circles stand at φ = 0", ellipses),
        ):
            yield PlaceTable(id, title, (), ((),) * len(orders.values), (orders, *_alone(tuple(found), system)))
    yield from _weights(balance, system)


def _alone(found: Sequence[_Entry], system: str) -> Iterator[Column]:
    """Yield the columns, those of one kind in one unit, but with a scale for every amplitude."""
    for quantity, values in found:
        alike = [abs(v) for other, each in found if other.kind == quantity.kind for v in each if v is not None]
        column = shown_column(quantity, values, system, beside=max(alike, default=0.0))
        yield column._replace(alone=0 if quantity.kind == "angle" else _DIGITS)


def _circles(balance: MachineBalance, square: float, compare: bool) -> Iterator[_Entry]:
    book = balance.book if compare else None
    for name, vector, first in (
        ("F", balance.free.force, book.force if book else None),
        ("M", balance.free.moment, book.moment if book else None),
    ):
        if vector is None:
            continue
        for end, both in (("", vector), ("_book", first)):
            if both is not None:
                pairs = [_pair(both, order) for order in balance.free.orders]
                yield ORDERS[f"{name}_forward{end}"], [abs(one) * square for one, _ in pairs]
                yield ORDERS[f"{name}_backward{end}"], [abs(one) * square for _, one in pairs]
        yield ORDERS[f"{name}_share"], _shares(vector, balance.free.orders)


def _pair(vector: ClosedCurve, order: int) -> tuple[complex, complex]:
    """Return the circles of an order, with their directions at φ = 0; 0 of one that there is not."""
    return complex(vector.of(order)[0]), complex(vector.of(-order)[0])


def _shares(vector: ClosedCurve, orders: Iterable[int]) -> list[float | None]:
    whole = float((np.abs(vector.waves) ** 2).sum())
    squares = (sum(abs(circle) ** 2 for circle in _pair(vector, order)) for order in orders)
    return [one / whole if whole else None for one in squares]


def _ellipses(free: Free, square: float) -> Iterator[_Entry]:
    for name, vector in (("F", free.force), ("M", free.moment)):
        if vector is None:
            continue
        pairs = [_pair(vector, order) for order in free.orders]
        yield ELLIPSES[f"{name}_long"], [(abs(f) + abs(g)) * square for f, g in pairs]
        yield ELLIPSES[f"{name}_short"], [abs(abs(f) - abs(g)) * square for f, g in pairs]
        yield ELLIPSES[f"{name}_direction"], [_direction(f, g) for f, g in pairs]
        yield ELLIPSES[f"{name}_forward_phase"], [_phase(f) for f, _ in pairs]
        yield ELLIPSES[f"{name}_backward_phase"], [_phase(g) for _, g in pairs]


def _direction(forward: complex, backward: complex) -> float | None:
    """Return the direction in degrees, 0 to below 180, in which both circles meet; None of a circle or of nothing."""
    if not forward or not backward:
        return None
    degrees = _degrees(forward * backward) / 2
    return degrees + 180.0 if degrees < -_NOTHING else max(degrees, 0.0)


def _phase(circle: complex) -> float | None:
    """Return a direction in degrees, above −180 and up to 180; None of nothing."""
    degrees = _degrees(circle)
    return None if not circle else degrees if degrees > _NOTHING - 180 else degrees + 360


def _degrees(circle: complex) -> float:
    return math.degrees(math.atan2(circle.imag, circle.real))


def _weights(balance: MachineBalance, system: str) -> Iterator[PlaceTable]:
    """Yield the table of the best weights, and what turns in the wheels of a locomotive."""
    planes = {f"counterweight_{end}": one for end, one in zip("AB", balance.best_in_planes) if one.product}
    shafts = {f"shaft_{_sense(one)}": one for one in balance.best_shafts}
    if best := planes | shafts:
        title = "Counterweights in two planes, and balance shafts"
        yield place_table("best_weights", title, ("weight",), ((name,) for name in best), _of(best.values()), system)
    if balance.locomotive:
        wheels = [Weight(one, 1, place) for one, place in zip(balance.locomotive.unbalanced, balance.wheels)]
        found = [*_of(wheels)]
        if square := (balance.omega or 0.0) ** 2:
            found.append((WEIGHTS["hammer_blow"], [abs(one.product) * square for one in wheels]))
        yield place_table("wheels", "Beyond what turns, in the wheels", ("wheel",), (("A",), ("B",)), found, system)


def _sense(weight: Weight) -> str:
    return f"n = {abs(weight.order)}, {'with' if weight.order > 0 else 'against'} the crank".replace(" ", "_")


def _of(weights: Collection[Weight]) -> Iterator[_Entry]:
    if any(one.place is not None for one in weights):
        yield WEIGHTS["axial_position"], [one.place for one in weights]
    yield WEIGHTS["product"], [abs(one.product) for one in weights]
    yield WEIGHTS["angle"], [_phase(one.product) for one in weights]
