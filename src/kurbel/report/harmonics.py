"""The report of `kurbel harmonics`: orders of the torque of every cylinder and of the whole machine."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.declared.quantity import Quantity
from kurbel.declared.torsion import TORQUE_ORDERS
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.report.frame import Frame, Subject
from kurbel.report.left_out import flywheel_left_out, left_out
from kurbel.report.notes import of_machine
from kurbel.report.shown import place_table
from kurbel.report.tables import LeftOut, PlaceTable, Report
from kurbel.solver.case import Case
from kurbel.solver.harmonics import CylinderOrders, MachineOrders, Orders, Spectrum

_HIGHEST = 1000


@np.errstate(all="ignore")  # what overflows is refused, by name
def harmonics_report(
    case: Case, frame: Frame, orders: Sequence[float] | None = None, speeds: Sequence[float] | None = None
) -> Report:
    """Return the orders of the turning effort; orders: those to tell, None for all up to 24.

    speeds: in revolutions per second, at which the orders of the whole machine are told besides. Raises UsageError
    where nothing turns the shaft.
    """
    found = case.harmonics(orders_of(case.machine, orders))
    each = [_cylinder(case.machine, one, frame.system) for one in found.cylinders]
    (whole,) = subjects(case, found)
    tables = (_machine_table(found, frame.system), *_speed_tables(case.machine, found, speeds, frame.system))
    tables = tuple(table._replace(said=_uniform(found.machine)) for table in tables)
    whole = replace(whole, place_tables=tables)
    return frame.report(case.machine, "Drehkraft nach Ordnungen", each, whole, _notes(found))


def orders_of(machine: Machine, asked: Sequence[float] | None) -> Array | None:
    """Return the orders (n,) that are asked for, ascending and each once; None for the usual ones.

    Raises UsageError for one that is none of the cycle.
    """
    if asked is None:
        return None
    for order in asked:
        if not 0 < order <= _HIGHEST:
            raise UsageError(f"--orders {order:g}: an order is more than 0 and at most {_HIGHEST} periods per turn")
        if (order * machine.revolutions) % 1:
            known = "½, 1, 1½, …" if machine.revolutions == 2 else "1, 2, 3, …"
            degrees = 360 * machine.revolutions
            raise UsageError(
                f"--orders {order:g}: the cycle repeats after {degrees} degrees and has the orders {known}"
            )
    return np.array(sorted(set(asked)), dtype=float)


def _cylinder(machine: Machine, one: CylinderOrders, system: str) -> Subject:
    cylinder = one.forces.drive.cylinder
    title = f"Orders of the torque of {cylinder.name}, φ from its own inner dead centre"
    table = _table(title, one.own, one.area, [""] * len(one.own.gas.orders), system)
    tables = (table._replace(said=_uniform(one.own)),)
    return Subject(cylinder.name, (), left_out=lambda: left_out(machine, cylinder), place_tables=tables)


def _machine_table(found: MachineOrders, system: str) -> PlaceTable:
    major = found.major_orders or ()
    marks = ["major" if order in major else "" for order in found.orders.tolist()]
    return _table(
        "Orders of the turning effort, φ from the inner dead centre of crank 1", found.machine, None, marks, system
    )


def subjects(case: Case, asked: MachineOrders | None = None) -> Iterable[Subject]:
    """Yield the whole machine; asked: by other than the usual orders."""
    found = asked or case.harmonics()
    yield Subject(
        "whole machine",
        (found,),
        left_out=lambda: (*flywheel_left_out(case.machine), *_no_cranks(found)),
        warnings=lambda: of_machine(case),
    )


def _no_cranks(found: MachineOrders) -> Iterable[LeftOut]:
    if found.machine.inertia is None:
        why = "the effort is given as a torque" if not found.cylinders else "no masses, or no speed given"
        yield LeftOut("gas and inertia apart", why)


def _table(title: str, orders: Orders, area: float | None, marks: list[str], system: str) -> PlaceTable:
    found = ((TORQUE_ORDERS[name], values) for name, values in _columns(orders, area))
    return place_table("orders", title, ("kind",), ((mark,) for mark in marks), found, system)


def _columns(orders: Orders, area: float | None) -> Iterable[tuple[str, Sequence[Any]]]:
    yield from _of_spectrum(orders.whole)
    if orders.inertia is not None:
        yield "M_gas", np.abs(orders.gas.amplitudes).tolist()
        yield "M_inertia", np.abs(orders.inertia.amplitudes).tolist()
    if area:
        yield "t_order", (np.abs(orders.whole.amplitudes) / area).tolist()


def _of_spectrum(found: Spectrum) -> Iterable[tuple[str, Sequence[Any]]]:
    yield "order", found.orders.tolist()
    yield "M_cos", found.amplitudes.real.tolist()
    yield "M_sin", (-found.amplitudes.imag).tolist()
    yield "M_amplitude", np.abs(found.amplitudes).tolist()
    yield "M_phase", _phase_degrees(found.amplitudes)


def _phase_degrees(amplitudes: ComplexArray) -> list[float | None]:
    """Return ε in degrees, above −180 up to 180, with Re(M e^{iνφ}) = |M| cos(νφ − ε); None of what is zero."""
    phases = np.degrees(np.arctan2(-amplitudes.imag, amplitudes.real)) + 0.0
    return [phase if amplitude else None for phase, amplitude in zip(phases.tolist(), amplitudes.tolist())]


def _speed_tables(
    machine: Machine, found: MachineOrders, speeds: Sequence[float] | None, system: str
) -> Iterable[PlaceTable]:
    if speeds is None:
        return
    if not machine.speed:
        raise UsageError("--speeds: the inertia forces are told from those at the 'speed' of the machine; give it one")
    spectra = [found.machine.at_speed(speed / machine.speed) for speed in speeds]
    columns: dict[Quantity, list[Any]] = {TORQUE_ORDERS["speed"]: [speed for speed in speeds for _ in found.orders]}
    for one in spectra:
        for name, values in _of_spectrum(one):
            columns.setdefault(TORQUE_ORDERS[name], []).extend(values)
    names = [("",)] * len(spectra) * len(found.orders)
    title = "Orders of the turning effort at other speeds"
    yield place_table("orders_by_speed", title, ("kind",), names, columns.items(), system)


def _uniform(found: Orders) -> bool:
    """Return whether no order is there, at no speed."""
    return not any(one.amplitudes.any() for one in (found.gas, found.inertia) if one)


def _notes(found: MachineOrders) -> Iterable[str]:
    torques = [(f"The torque of {one.forces.drive.cylinder.name}", one.own) for one in found.cylinders]
    torques.append(("The turning effort", found.machine))
    uniform = [what for what, orders in torques if _uniform(orders)]
    yield from (f"{what} has none of these orders: they are all zero." for what in uniform)
    if len(uniform) == len(torques):
        return
    yield "M = M_m + Σ (a_ν cos νφ + b_ν sin νφ) = M_m + Σ |M_ν| cos(νφ − ε_ν), ν periods per turn of the shaft."
    if found.machine.inertia is not None:
        yield "M_b goes with the square of the speed; M_g, of gas, weight and friction, counts the same at every speed."
