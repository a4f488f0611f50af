"""The report of `kurbel balance`: unbalanced forces and moments, their orders, the best weights."""

import cmath
import math
from collections.abc import Iterator
from itertools import chain, groupby

import numpy as np

from kurbel.declared.unit_systems import show
from kurbel.notes.left_out import (
    balance_left_out,
)
from kurbel.notes.warnings import (
    pin_warnings,
)
from kurbel.numerics.arithmetic import unless_cancelled
from kurbel.numerics.enclosing import ClosedCurve
from kurbel.quantity import Quantity, by_id
from kurbel.solver.case import Case
from kurbel.solver.chapters.balance import MachineBalance
from kurbel.tables.frame import CommandReport, Subject
from kurbel.tables.shown import PlaceRow, Places

ORDERS = by_id(
    Quantity("order", "n", "ratio", "Order: turns of the components in one turn of the crank"),
    Quantity("F_forward", "F_+", "force", "Unbalanced force: component rotating with the crank"),
    Quantity(
        "F_backward", "F_−", "force", "Unbalanced force: component rotating against the crank"
    ),
    Quantity(
        "F_forward_book", "F_+,0", "force", "The same by the acceleration of first order (R 291)"
    ),
    Quantity(
        "F_backward_book", "F_−,0", "force", "The same by the acceleration of first order (R 291)"
    ),
    Quantity(
        "F_share",
        "F_n²/F²",
        "ratio",
        "Share of the order in the mean square of the unbalanced force",
        "F_n2/F2",
    ),
    Quantity("M_forward", "M_+", "torque", "Unbalanced moment: component rotating with the crank"),
    Quantity(
        "M_backward", "M_−", "torque", "Unbalanced moment: component rotating against the crank"
    ),
    Quantity(
        "M_forward_book", "M_+,0", "torque", "The same by the acceleration of first order (R 291)"
    ),
    Quantity(
        "M_backward_book", "M_−,0", "torque", "The same by the acceleration of first order (R 291)"
    ),
    Quantity(
        "M_share",
        "M_n²/M²",
        "ratio",
        "Share of the order in the mean square of the unbalanced moment",
        "M_n2/M2",
    ),
)
"""Columns of the table of orders; amplitudes."""


def _ellipse(name: str, kind: str, of: str) -> tuple[Quantity, ...]:
    return (
        Quantity(
            f"{name}_long",
            f"{name}_a",
            kind,
            f"{of}: longer half-axis of the ellipse of this order",
        ),
        Quantity(f"{name}_short", f"{name}_b", kind, f"{of}: shorter half-axis"),
        Quantity(
            f"{name}_direction",
            f"∠{name}_a",
            "angle",
            "Direction of the major axis",
            f"arg {name}_a",
        ),
        Quantity(
            f"{name}_forward_phase",
            f"∠{name}_+",
            "angle",
            "Phase of the forward component at φ = 0",
            f"arg {name}_+",
        ),
        Quantity(
            f"{name}_backward_phase",
            f"∠{name}_−",
            "angle",
            "Phase of the backward component at φ = 0",
            f"arg {name}_-",
        ),
    )


ELLIPSES = by_id(
    ORDERS["order"],
    *_ellipse("F", "force", "Unbalanced force"),
    *_ellipse("M", "torque", "Unbalanced moment"),
)
"""Columns of the table of ellipses: what the two circles of an order make together."""

WEIGHTS = by_id(
    Quantity("axial_position", "z", "length", "Position along the shaft", for_entry=True),
    Quantity("product", "u", "unbalance", "Mass times radius", for_entry=True),
    Quantity(
        "angle",
        "α",
        "angle",
        "Direction at φ = 0 from the stroke line of cylinder 1",
        for_entry=True,
    ),
    Quantity("hammer_blow", "H", "force", "Amplitude by which it loads and lifts its wheel"),
    Quantity(
        "counterweight",
        "u_R",
        "unbalance",
        "The whole counterweight in the wheel, mass times radius",
        for_entry=True,
    ),
    Quantity("counterweight_angle", "α_R", "angle", "Its direction at φ = 0", for_entry=True),
)
"""Columns of the tables of weights."""


_DIGITS = 4
_NOTHING = 1e-6
"""Degrees by which a direction may miss another by rounding."""


def _balanced(case: Case, compare: bool = False) -> list[Subject]:
    balance = MachineBalance(case.effort, compare=True) if compare else case.balance
    return [
        Subject(
            "whole machine",
            balance,
            None if case.machine.speed is None else balance.at,
            left_out=balance_left_out(case, compare),
            warnings=pin_warnings(case.machine),
            tables=chain(_orders(case.balance, compare), _weights(case.balance)),
            whole=True,
        )
    ]


def _notes(case: Case) -> Iterator[str]:
    balance, free = case.balance, case.balance.free
    yield "φ is the angle of crank 1; F_x and M_x count along the stroke line of cylinder 1, F_y and M_y across it."
    if free.moment is not None and balance.z_0 is not None:
        yield f"Moments are taken about z = {show(balance.z_0, 'length')}."
    if free.next_order and balance.omega is not None:
        yield (
            f"The rod is hardly longer than the crank, so that more orders follow, from n = {free.next_order} on; "
            "all of them are in forces and moments."
        )
    if balance.counterweights or balance.machine.balance_shafts:
        yield "Counterweights and shafts of the file are included in all that is free; the best weights replace them."
    if balance.roll is not None:
        yield "M_roll is −M of kurbel flywheel, without the torque that accelerates the masses about the shaft."


BALANCE = CommandReport(
    "Balancing",
    _balanced,
    _notes,
    lambda case: case.balance.cycle,
    lambda case, frame: (_balanced(case, frame.compare), _notes(case)),
)


def _orders(balance: MachineBalance, compare: bool) -> Iterator[Places]:
    """Yield the orders of the unbalanced force and moment, as two circles and as an ellipse; none without a speed.

    An order is a circle with the crank, of complex radius f at φ = 0, and one against it, g; together an ellipse.
    """
    if balance.omega is None:
        return
    square, free = balance.omega**2, balance.free
    book = balance.book if compare else None
    rows: list[PlaceRow] = []
    for order in free.orders:
        values: dict[str, float | None] = {"order": order}
        for name, vector, of_book in (
            ("F", free.force, book.force if book else None),
            ("M", free.moment, book.moment if book else None),
        ):
            if vector is not None:
                values |= _order_of_vector(name, vector, of_book, order, square)
        rows.append(((), values))
    title = "Orders: circles with the crank (+) and against it (−)"
    yield Places("orders", title, (), ORDERS, rows, alone=_DIGITS)
    title = "Orders: ellipses, and phases of the rotating components at φ = 0"
    yield Places("ellipses", title, (), ELLIPSES, rows, alone=_DIGITS)


def _order_of_vector(
    name: str, vector: ClosedCurve, of_book: ClosedCurve | None, order: int, square: float
) -> dict[str, float | None]:
    """Return one order of a force F or a moment M: its two circles and its ellipse; square: ω²."""
    values: dict[str, float | None] = {}
    f = complex(vector.of(order)[0]) * square
    g = complex(vector.of(-order)[0]) * square
    total = float((np.abs(vector.waves * square) ** 2).sum())
    values[f"{name}_forward"] = abs(f)
    values[f"{name}_backward"] = abs(g)
    values[f"{name}_share"] = (abs(f) ** 2 + abs(g) ** 2) / total if total else None
    if of_book is not None:
        values[f"{name}_forward_book"] = abs(complex(of_book.of(order)[0])) * square
        values[f"{name}_backward_book"] = abs(complex(of_book.of(-order)[0])) * square
    longer = abs(f) + abs(g)
    values[f"{name}_long"] = longer
    values[f"{name}_short"] = float(unless_cancelled(abs(abs(f) - abs(g)), longer))

    # both circles meet in the middle of their directions, here from 0 to below 180 degrees
    middle = math.degrees(cmath.phase(f * g)) / 2
    is_rounding = abs(middle) <= _NOTHING
    middle = 0.0 if is_rounding else middle % 180.0
    values[f"{name}_direction"] = middle if f and g else None
    values[f"{name}_forward_phase"] = _direction(f)
    values[f"{name}_backward_phase"] = _direction(g)
    return values


def _weights(balance: MachineBalance) -> Iterator[Places]:
    """Yield the best weights, and what the wheels of a locomotive carry besides the rotating masses."""
    rows: list[PlaceRow] = []
    for end, weight in zip("AB", balance.best_in_planes):
        if weight.product:
            rows.append(_weight_row(f"counterweight {end}", weight.place, weight.product))
    for order, shafts in groupby(balance.best_shafts, lambda weight: weight.order):
        weights = list(shafts)
        direction = "with" if order > 0 else "against"
        name = f"shaft n = {abs(order)}, {direction} the crank"
        for end, shaft in zip("AB", weights):
            title = f"{name}: {end}" if len(weights) > 1 else name
            rows.append(_weight_row(title, shaft.place, shaft.product))
    if rows:
        title = "Counterweights in two planes, and balance shafts"
        yield Places("best_weights", title, ("weight",), WEIGHTS, rows)
    if balance.machine.locomotive:
        rows = list(_wheel_rows(balance))
        title = "In the wheels: what they carry beyond the rotating masses, and the whole counterweights"
        yield Places("wheels", title, ("wheel",), WEIGHTS, rows)


def _wheel_rows(balance: MachineBalance) -> Iterator[PlaceRow]:
    """Yield what each wheel carries beyond the rotating masses, its hammer blow, and its counterweight."""
    square = (balance.omega or 0.0) ** 2
    products, weights = balance.in_wheels(), balance.in_wheels("counterweights")
    for name, position, product, weight in zip("AB", balance.wheels, products, weights):
        head, values = _weight_row(name, position, product)
        if square:
            values["hammer_blow"] = abs(product) * square
        if weight:
            values["counterweight"] = abs(weight)
            values["counterweight_angle"] = _direction(weight)
        yield head, values


def _weight_row(
    name: str, position: float | None, product: complex
) -> tuple[tuple[str], dict[str, float | None]]:
    """Return the row of a weight: where it is along the shaft, its product m r, and its direction."""
    values: dict[str, float | None] = {}
    if position is not None:
        values["axial_position"] = position
    values["product"] = abs(product)
    values["angle"] = _direction(product)
    return (name,), values


def _direction(circle: complex) -> float | None:
    """Return a direction in degrees, above −180 and up to 180; None for nothing."""
    if not circle:
        return None
    degrees = math.degrees(cmath.phase(circle))
    if degrees > _NOTHING - 180:
        return degrees
    return degrees + 360
