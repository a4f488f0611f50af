"""The report of `kurbel balance`: free forces and moments over the crank angle, their orders, the best weights."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from kurbel.declared.unit_systems import show
from kurbel.report.balance_tables import balance_tables
from kurbel.report.frame import Frame, Subject
from kurbel.report.pins import pin_notes
from kurbel.report.tables import LeftOut, Report
from kurbel.solver.balance.machine_balance import BookBalance, MachineBalance
from kurbel.solver.case import Case

_BOOK = ("F_x_book", "F_y_book", "M_x_book", "M_y_book")


def balance_report(
    case: Case,
    angles: Sequence[float],
    columns: Sequence[str] | None,
    system: str,
    compare: bool = False,
    orders_only: bool = False,
) -> Report:
    """Return what is free and what balances it; angles, columns, system: see `Frame`.

    compare: with what the acceleration of first order gives, beside the true figures; orders_only: no columns over the
    crank angle. Raises UsageError where no masses move.
    """
    with np.errstate(all="ignore"):  # what overflows is refused, by name
        (whole,) = subjects(case, compare)
        tables = tuple(balance_tables(case.balance, system, compare))
        whole = whole._replace(place_tables=tables, at=None if orders_only or case.machine.speed is None else whole.at)
    frame = Frame("balance", angles, columns, system, _BOOK if compare else ())
    return frame.report(case.machine, "Massenausgleich", (), whole, _notes(case.balance))


def subjects(case: Case, compare: bool = False) -> Iterable[Subject]:
    """Yield the whole machine; compare: see `balance_report`."""
    machine = case.machine
    balance = case.balance
    yield Subject(
        "whole machine",
        (*balance.answering, *((BookBalance(balance),) if compare else ())),
        balance.at,
        left_out=lambda: _left_out(balance, compare),
        warnings=lambda: pin_notes(machine),
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
    if any(one.place is None for one in balance.loose_counterweights):
        yield "counterweights of the machine"
    if any(one.axial_position is None for one in balance.machine.balance_shafts):
        yield "balance_shafts"


def _notes(balance: MachineBalance) -> Iterable[str]:
    yield "φ is the angle of crank 1; F_x and M_x count along the stroke line of cylinder 1, F_y and M_y across it."
    if balance.free.moment is not None and balance.z_0 is not None:
        yield f"Moments are taken about z = {show(balance.z_0, 'length')}."
    if balance.counterweights or balance.machine.balance_shafts:
        yield "Counterweights and shafts of the file count in all that is free; the best weights stand in their place."
    if balance.roll:
        yield "M_roll is −M of kurbel flywheel, less what turns the masses themselves about the shaft."
