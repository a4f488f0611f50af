"""The report of `kurbel balance`: unbalanced forces and moments over the crank angle, orders, the best weights."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from kurbel.declared.balance import ELLIPSES, ORDERS, WEIGHTS
from kurbel.declared.unit_systems import show
from kurbel.numerics.enclosing import ClosedCurve
from kurbel.quantity import Quantity
from kurbel.report.frame import Frame, Subject, place_table, report_on, shown_column
from kurbel.report.left_out import balance_left_out
from kurbel.report.tables import Column, PlaceTable, Report
from kurbel.report.warnings import pin_warnings
from kurbel.solver.balance import MachineBalance
from kurbel.solver.case import Case
from kurbel.solver.weights import Weight

_Values = dict[Quantity, "list[float | None]"]
"""Quantities with their values in SI, None for no value."""
_DIGITS = 4
_NOTHING = 1e-6
"""Degrees by which a direction may miss another by rounding."""


@np.errstate(all="ignore")  # what overflows is refused by name
def balance_report(case: Case, frame: Frame, orders_only: bool = False) -> Report:
    """Return what is unbalanced and what balances it; orders_only: no columns over the crank angle.

    Raises UsageError if no masses move.
    """
    (whole,) = balance_subjects(case, frame.compare)
    whole = replace(
        whole,
        tables=tuple(_balance_tables(case.balance, frame.system, frame.compare)),
        at=None if orders_only or case.machine.speed is None else whole.at,
        left_out=tuple(balance_left_out(case, frame.compare)),
        warnings=tuple(pin_warnings(case.machine)),
    )
    return report_on(frame, case.machine, "Massenausgleich", (), whole, _notes(case.balance))


def balance_subjects(case: Case, compare: bool = False) -> list[Subject]:
    """Return the whole machine; compare: with what the acceleration of first order gives, next to the true figures."""
    balance = MachineBalance(case.machine, case.cylinders, compare=True) if compare else case.balance
    return [Subject("whole machine", (balance,), balance.at)]


def _notes(balance: MachineBalance) -> Iterator[str]:
    free = balance.free
    yield "φ is the angle of crank 1; F_x and M_x count along the stroke line of cylinder 1, F_y and M_y across it."
    if free.moment is not None and balance.z_0 is not None:
        yield f"Moments are taken about z = {show(balance.z_0, 'length')}."
    if free.next_order and balance.omega is not None:
        square = balance.omega * balance.omega
        most = show(free.at_most(free.force) * square, "force")
        if free.moment is not None:
            most += f", of the moment {show(free.at_most(free.moment) * square, 'torque')}"
        yield (
            f"More orders follow, from n = {free.next_order} on, which the rod brings, hardly longer than the crank: "
            f"of the force they are at most {most}, together."
        )
    if balance.counterweights or balance.machine.balance_shafts:
        yield "Counterweights and shafts of the file count in all that is free; the best weights stand in their place."
    if balance.effort is not None:
        yield "M_roll is −M of kurbel flywheel, less what turns the masses themselves about the shaft."


def _balance_tables(balance: MachineBalance, system: str, compare: bool) -> Iterator[PlaceTable]:
    """Yield the orders of the unbalanced force and moment, as circles and as ellipses, and the best weights."""
    if balance.omega is not None:
        circles, ellipses = _orders(balance, balance.omega * balance.omega, compare)
        title = "Orders: circles with the crank (+) and against it (−)"
        yield _orders_table("orders", title, balance.free.orders, circles, system)
        title = "Orders: ellipses, and where the circles stand at φ = 0"
        yield _orders_table("ellipses", title, balance.free.orders, ellipses, system)
    yield from _weight_tables(balance, system)


def _orders(balance: MachineBalance, square: float, compare: bool) -> tuple[_Values, _Values]:
    """Return the orders of force and moment as circles and as ellipses; square: ω².

    An order is a circle with the crank, of complex radius f, and one against it, g; together they are an ellipse.
    """
    free, book = balance.free, balance.book if compare else None
    circles: _Values = {}
    ellipses: _Values = {}
    vectors = (("F", free.force, book.force if book else None), ("M", free.moment, book.moment if book else None))
    for name, vector, first_order in vectors:
        if vector is None:
            continue
        pairs = _pairs(vector, free.orders)
        for end, some in (("", pairs), ("_book", _pairs(first_order, free.orders) if first_order is not None else [])):
            if some:
                circles[ORDERS[f"{name}_forward{end}"]] = [abs(f) * square for f, _ in some]
                circles[ORDERS[f"{name}_backward{end}"]] = [abs(g) * square for _, g in some]
        whole = float((np.abs(vector.waves) ** 2).sum())
        circles[ORDERS[f"{name}_share"]] = [(abs(f) ** 2 + abs(g) ** 2) / whole if whole else None for f, g in pairs]
        ellipses[ELLIPSES[f"{name}_long"]] = [(abs(f) + abs(g)) * square for f, g in pairs]
        ellipses[ELLIPSES[f"{name}_short"]] = [abs(abs(f) - abs(g)) * square for f, g in pairs]
        ellipses[ELLIPSES[f"{name}_direction"]] = [_direction(f, g) for f, g in pairs]
        ellipses[ELLIPSES[f"{name}_forward_phase"]] = [_phase(f) for f, _ in pairs]
        ellipses[ELLIPSES[f"{name}_backward_phase"]] = [_phase(g) for _, g in pairs]
    return circles, ellipses


def _pairs(vector: ClosedCurve, orders: Sequence[int]) -> list[tuple[complex, complex]]:
    """Return both circles of each order, with their directions at φ = 0; 0 for none."""
    return [(complex(vector.of(order)[0]), complex(vector.of(-order)[0])) for order in orders]


def _orders_table(id: str, title: str, orders: Sequence[int], values: _Values, system: str) -> PlaceTable:
    """Return the table, with one unit for each kind of quantity, but a scale for every amplitude."""
    columns = [Column("order", "n", "n", "", orders, ORDERS["order"].text, alone=_DIGITS)]
    for quantity, each in values.items():
        alike = [abs(v) for other, some in values.items() if other.kind == quantity.kind for v in some if v is not None]
        column = shown_column(quantity, each, system, beside=max(alike, default=0.0))
        columns.append(column._replace(alone=0 if quantity.kind == "angle" else _DIGITS))
    return PlaceTable(id, title, (), ((),) * len(orders), tuple(columns))


def _direction(forward: complex, backward: complex) -> float | None:
    """Return the direction in degrees, 0 to below 180, in which both circles meet; None for a circle or nothing."""
    if not forward or not backward:
        return None
    degrees = _degrees(forward * backward) / 2
    return degrees + 180.0 if degrees < -_NOTHING else max(degrees, 0.0)


def _phase(circle: complex) -> float | None:
    """Return a direction in degrees, above −180 and up to 180; None for nothing."""
    degrees = _degrees(circle)
    return None if not circle else degrees if degrees > _NOTHING - 180 else degrees + 360


def _degrees(circle: complex) -> float:
    return math.degrees(math.atan2(circle.imag, circle.real))


def _weight_tables(balance: MachineBalance, system: str) -> Iterator[PlaceTable]:
    """Yield the best weights, and what the wheels of a locomotive carry besides the rotating masses."""
    best = {f"counterweight_{end}": one for end, one in zip("AB", balance.best_in_planes) if one.product}
    for one in balance.best_shafts:
        best[f"shaft_n_=_{abs(one.order)},_{'with' if one.order > 0 else 'against'}_the_crank"] = one
    if best:
        title, values = "Counterweights in two planes, and balance shafts", _weights(list(best.values()))
        yield place_table("best_weights", title, ("weight",), ((name,) for name in best), values.items(), system)
    if balance.locomotive:
        wheels = [Weight(one, 1, place) for one, place in zip(balance.locomotive.unbalanced, balance.wheels)]
        values = _weights(wheels)
        if square := (balance.omega or 0.0) ** 2:
            values[WEIGHTS["hammer_blow"]] = [abs(one.product) * square for one in wheels]
        title = "Beyond what turns, in the wheels"
        yield place_table("wheels", title, ("wheel",), (("A",), ("B",)), values.items(), system)


def _weights(weights: Sequence[Weight]) -> _Values:
    places = [one.place for one in weights]
    return {
        **({WEIGHTS["axial_position"]: places} if any(place is not None for place in places) else {}),
        WEIGHTS["product"]: [abs(one.product) for one in weights],
        WEIGHTS["angle"]: [_phase(one.product) for one in weights],
    }
