"""The report of `kurbel balance`: unbalanced forces and moments over the crank angle, orders, the best weights."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from kurbel.declared.unit_systems import show
from kurbel.numerics.enclosing import ClosedCurve
from kurbel.quantity import Quantity, by_id
from kurbel.report.frame import Frame, Row, Subject, place_table, report_on
from kurbel.report.left_out import balance_left_out
from kurbel.report.tables import PlaceTable, Report
from kurbel.report.warnings import pin_warnings
from kurbel.solver.balance import MachineBalance
from kurbel.solver.case import Case
from kurbel.solver.weights import Weight

ORDERS = by_id(
    Quantity("order", "n", "ratio", "Turns of the circles in one turn of the crank"),
    Quantity("F_forward", "F_+", "force", "Free force: circle that turns with the crank"),
    Quantity("F_backward", "F_−", "force", "Free force: circle that turns against it"),
    Quantity("F_forward_book", "F_+,0", "force", "The same by the acceleration of first order (R 291)"),
    Quantity("F_backward_book", "F_−,0", "force", "The same by the acceleration of first order (R 291)"),
    Quantity("F_share", "F_n²/F²", "ratio", "Share of the order in the mean square of the free force", "F_n2/F2"),
    Quantity("M_forward", "M_+", "torque", "Free moment: circle that turns with the crank"),
    Quantity("M_backward", "M_−", "torque", "Free moment: circle that turns against it"),
    Quantity("M_forward_book", "M_+,0", "torque", "The same by the acceleration of first order (R 291)"),
    Quantity("M_backward_book", "M_−,0", "torque", "The same by the acceleration of first order (R 291)"),
    Quantity("M_share", "M_n²/M²", "ratio", "Share of the order in the mean square of the free moment", "M_n2/M2"),
)
"""Columns of the table of orders; amplitudes."""


def _ellipse(name: str, kind: str, of: str) -> tuple[Quantity, ...]:
    return (
        Quantity(f"{name}_long", f"{name}_a", kind, f"{of}: longer half-axis of the ellipse of this order"),
        Quantity(f"{name}_short", f"{name}_b", kind, f"{of}: shorter half-axis"),
        Quantity(f"{name}_direction", f"∠{name}_a", "angle", "Direction of the longer axis", f"arg {name}_a"),
        Quantity(f"{name}_forward_phase", f"∠{name}_+", "angle", "Forward circle at φ = 0", f"arg {name}_+"),
        Quantity(f"{name}_backward_phase", f"∠{name}_−", "angle", "Backward circle at φ = 0", f"arg {name}_-"),
    )


ELLIPSES = by_id(ORDERS["order"], *_ellipse("F", "force", "Free force"), *_ellipse("M", "torque", "Free moment"))
"""Columns of the table of ellipses: what the two circles of an order make together."""

WEIGHTS = by_id(
    Quantity("axial_position", "z", "length", "Place along the shaft"),
    Quantity("product", "u", "unbalance", "Mass times radius"),
    Quantity("angle", "α", "angle", "Direction at φ = 0 from the stroke line of cylinder 1"),
    Quantity("hammer_blow", "H", "force", "By how much it loads and lifts its wheel"),
)
"""Columns of the tables of weights."""


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
    return report_on(frame, case.machine, "Balancing", (), whole, _notes(case.balance))


def balance_subjects(case: Case, compare: bool = False) -> list[Subject]:
    """Return the whole machine; compare: with what the acceleration of first order gives, next to the true figures."""
    balance = MachineBalance(case.effort, compare=True) if compare else case.balance
    return [Subject("whole machine", (balance,), balance.at)]


def _notes(balance: MachineBalance) -> Iterator[str]:
    free = balance.free
    yield "φ is the angle of crank 1; F_x and M_x count along the stroke line of cylinder 1, F_y and M_y across it."
    if free.moment is not None and balance.z_0 is not None:
        yield f"Moments are taken about z = {show(balance.z_0, 'length')}."
    if free.next_order and balance.omega is not None:
        square = balance.omega * balance.omega
        most = f"{show(free.at_most(free.force) * square, 'force')} of the force"
        if free.moment is not None:
            most += f", {show(free.at_most(free.moment) * square, 'torque')} of the moment"
        yield (
            f"The rod is hardly longer than the crank, so that more orders follow, from n = {free.next_order} on: "
            f"together at most {most}."
        )
    if balance.counterweights or balance.machine.balance_shafts:
        yield "Counterweights and shafts of the file are included in all that is free; the best weights replace them."
    if balance.roll is not None:
        yield "M_roll is −M of kurbel flywheel, less what turns the masses themselves about the shaft."


def _balance_tables(balance: MachineBalance, system: str, compare: bool) -> Iterator[PlaceTable]:
    """Yield the orders of the unbalanced force and moment, as circles and as ellipses, and the best weights."""
    if balance.omega is not None:
        circles, ellipses = [], []
        for order in balance.free.orders:
            as_circles, as_ellipse = _order(balance, order, balance.omega * balance.omega, compare)
            circles.append(as_circles)
            ellipses.append(as_ellipse)
        title = "Orders: circles with the crank (+) and against it (−)"
        yield place_table("orders", title, (), ORDERS, circles, system, alone=_DIGITS)
        title = "Orders: ellipses, and where the circles stand at φ = 0"
        yield place_table("ellipses", title, (), ELLIPSES, ellipses, system, alone=_DIGITS)
    yield from _weight_tables(balance, system)


def _order(balance: MachineBalance, order: int, square: float, compare: bool) -> tuple[Row, Row]:
    """Return an order of force and moment as two circles and as an ellipse; square: ω².

    It is a circle with the crank, of complex radius f at φ = 0, and one against it, g; together they are an ellipse.
    """
    free, book = balance.free, balance.book if compare else None
    circles: dict[str, float | None] = {"order": order}
    ellipse: dict[str, float | None] = {"order": order}
    vectors = (("F", free.force, book.force if book else None), ("M", free.moment, book.moment if book else None))
    for name, vector, first_order in vectors:
        if vector is None:
            continue
        f, g = _pair(vector, order)
        circles[f"{name}_forward"], circles[f"{name}_backward"] = abs(f) * square, abs(g) * square
        if first_order is not None:
            book_f, book_g = _pair(first_order, order)
            circles[f"{name}_forward_book"], circles[f"{name}_backward_book"] = (
                abs(book_f) * square,
                abs(book_g) * square,
            )
        whole = float((np.abs(vector.waves) ** 2).sum())
        circles[f"{name}_share"] = (abs(f) ** 2 + abs(g) ** 2) / whole if whole else None
        ellipse[f"{name}_long"] = (abs(f) + abs(g)) * square
        ellipse[f"{name}_short"] = abs(abs(f) - abs(g)) * square
        ellipse[f"{name}_direction"] = _direction(f, g)
        ellipse[f"{name}_forward_phase"], ellipse[f"{name}_backward_phase"] = _phase(f), _phase(g)
    return ((), circles), ((), ellipse)


def _pair(vector: ClosedCurve, order: int) -> tuple[complex, complex]:
    """Return both circles of an order, 0 for none."""
    return complex(vector.of(order)[0]), complex(vector.of(-order)[0])


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
    best = [_weight(f"counterweight {end}", one) for end, one in zip("AB", balance.best_in_planes) if one.product]
    for one in balance.best_shafts:
        sense = "with" if one.order > 0 else "against"
        best.append(_weight(f"shaft n = {abs(one.order)}, {sense} the crank", one))
    if best:
        title = "Counterweights in two planes, and balance shafts"
        yield place_table("best_weights", title, ("weight",), WEIGHTS, best, system)
    if balance.machine.locomotive:
        square = (balance.omega or 0.0) ** 2
        wheels = zip("AB", balance.in_wheels(), balance.wheels)
        rows = [_weight(name, Weight(product, 1, place), square) for name, product, place in wheels]
        yield place_table("wheels", "Beyond what turns, in the wheels", ("wheel",), WEIGHTS, rows, system)


def _weight(name: str, one: Weight, square: float = 0.0) -> Row:
    """Return the row of a weight; square: ω² of a wheel, which it loads and lifts."""
    place = {} if one.place is None else {"axial_position": one.place}
    blow = {"hammer_blow": abs(one.product) * square} if square else {}
    return (name,), {**place, "product": abs(one.product), "angle": _phase(one.product), **blow}
