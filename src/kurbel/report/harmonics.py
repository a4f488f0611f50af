"""The report of `kurbel harmonics`: the orders of every torque."""

import math
from collections.abc import Iterator, Sequence
from itertools import chain

import numpy as np

from kurbel.arrays import Array
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.notes.left_out import flywheel_left_out, left_out, missing
from kurbel.notes.subjects import whole_machine
from kurbel.notes.warnings import of_machine
from kurbel.numerics.arithmetic import is_whole
from kurbel.quantity import Quantity, by_id
from kurbel.solver.case import Case
from kurbel.solver.chapters.harmonics import CylinderOrders, MachineOrders, Orders
from kurbel.tables.frame import CommandReport, Frame, Subject
from kurbel.tables.shown import PlaceRow, Places

TORQUE_ORDERS = by_id(
    Quantity("speed", "n", "speed", "Speed of rotation"),
    Quantity("order", "ν", "ratio", "Order: periods per turn of the shaft"),
    Quantity("M_cos", "a_ν", "torque", "Coefficient of cos νφ"),
    Quantity("M_sin", "b_ν", "torque", "Coefficient of sin νφ"),
    Quantity("M_amplitude", "|M_ν|", "torque", "Amplitude of the order"),
    Quantity("M_phase", "ε_ν", "angle", "Phase: the order is |M_ν| cos(νφ − ε_ν)"),
    Quantity("M_gas", "|M_g|", "torque", "Amplitude of the part independent of speed"),
    Quantity(
        "M_inertia",
        "|M_b|",
        "torque",
        "Amplitude of the part from inertia forces, proportional to ω²",
    ),
    Quantity("t_order", "t_ν", "pressure", "Tangential-pressure coefficient |M_ν|/(R A)"),
)
"""Of one order of a torque, by id."""


_HIGHEST_ORDER = 1000


def _harmonics(
    case: Case,
    frame: Frame,
    orders: Sequence[float] | None = None,
    speeds: Sequence[float] | None = None,
) -> tuple[list[Subject], Iterator[str]]:
    """Return the subjects with the orders of the turning effort, and the notes; orders: those to show, None for all up to 24.

    speeds: in revolutions per second, at which the orders of the whole machine are shown, too. Raises UsageError if
    nothing turns the shaft.
    """
    machine = case.machine
    harmonics = case.harmonics(requested_orders(machine, orders))
    if speeds is not None and not machine.speed:
        raise UsageError(
            "--speeds: the inertia forces are scaled from those at the 'speed' of the machine; give one"
        )
    cylinders = []
    for cylinder in harmonics.cylinders:
        drive = cylinder.forces.drive
        reasons = left_out(machine, drive.cylinder)
        cylinders.append(
            Subject(drive.name, left_out=reasons, tables=_orders_of_cylinder(cylinder))
        )
    why_not_apart = ""
    if harmonics.machine.inertia is None:
        why_not_apart = (
            "no masses, or no speed given" if cylinders else "the effort is given as a torque"
        )
    machine_subject = Subject(
        "whole machine",
        harmonics,
        left_out=chain(
            flywheel_left_out(machine), missing({"gas and inertia apart": why_not_apart})
        ),
        warnings=of_machine(case),
        tables=_orders_of_machine(harmonics, speeds or (), machine.speed),
        whole=True,
    )
    return [*cylinders, machine_subject], _harmonics_notes(harmonics)


HARMONICS = CommandReport(
    "Harmonics of the turning effort", whole_machine("harmonics"), subjects_and_notes=_harmonics
)


def requested_orders(machine: Machine, requested: Sequence[float] | None) -> Array | None:
    """Return the requested orders (n,), ascending and each once; None for the usual ones.

    Raises UsageError for one that the cycle does not have.
    """
    turns = machine.revolutions
    for order in requested or ():
        if not 0 < order <= _HIGHEST_ORDER:
            most = f"at most {_HIGHEST_ORDER} periods per turn"
            raise UsageError(f"--orders {order:g}: an order is more than 0 and {most}")
        if not is_whole(order * turns):
            usual = {1: "1, 2, 3, …", 2: "½, 1, 1½, …"}
            listed = usual.get(turns, f"1/{turns}, 2/{turns}, 3/{turns}, …")
            cycle = f"the cycle repeats after {360 * turns} degrees"
            raise UsageError(f"--orders {order:g}: {cycle} and has the orders {listed}")
    if requested is None:
        return None
    return np.unique(requested)


def _harmonics_notes(harmonics: MachineOrders) -> Iterator[str]:
    """Yield which torques are without orders, and what the symbols mean."""
    torques = {}
    for cylinder in harmonics.cylinders:
        torques[f"The torque of {cylinder.forces.drive.name}"] = cylinder.own
    torques["The turning effort"] = harmonics.machine
    for what, torque in torques.items():
        if _is_uniform(torque):
            yield f"{what} has none of these orders: they are all zero."
    if not all(map(_is_uniform, torques.values())):
        yield "M = M_m + Σ (a_ν cos νφ + b_ν sin νφ) = M_m + Σ |M_ν| cos(νφ − ε_ν), ν periods per turn of the shaft."
        if harmonics.machine.inertia is not None:
            yield (
                "M_b grows with the square of the speed; M_g, of gas, weight and friction, is the same at every speed."
            )


def _is_uniform(torque: Orders) -> bool:
    """Return whether every order is zero, at every speed; then a note says so, in place of a table."""
    has_inertia = torque.inertia is not None and bool(torque.inertia.any())
    return not (has_inertia or torque.gas.any())


def _orders_of_cylinder(cylinder: CylinderOrders) -> Iterator[Places]:
    name, torque = cylinder.forces.drive.name, cylinder.own
    rows = _order_rows(torque, cylinder.area)
    title = f"Orders of the torque of {name}, φ from its own inner dead centre"
    yield Places("orders", title, ("kind",), TORQUE_ORDERS, rows, in_note=_is_uniform(torque))


def _orders_of_machine(
    harmonics: MachineOrders, speeds: Sequence[float], working: float | None
) -> Iterator[Places]:
    """Yield the orders of the turning effort at the working speed, and those at others, in revolutions per second."""
    torque = harmonics.machine
    is_uniform = _is_uniform(torque)
    title = "Orders of the turning effort, φ from the inner dead centre of crank 1"
    rows = _order_rows(torque, major=harmonics.major_orders or ())
    yield Places("orders", title, ("kind",), TORQUE_ORDERS, rows, in_note=is_uniform)
    if not speeds:
        return
    rows = []
    for speed in speeds:
        amplitudes = torque.at_speed(speed / (working or speed)).tolist()
        for order, amplitude in zip(torque.orders.tolist(), amplitudes):
            rows.append((("",), {"speed": speed, **_of_order(order, amplitude)}))
    title = "Orders of the turning effort at other speeds"
    yield Places("orders_by_speed", title, ("kind",), TORQUE_ORDERS, rows, in_note=is_uniform)


def _order_rows(
    torque: Orders, area: float | None = None, major: Sequence[float] = ()
) -> list[PlaceRow]:
    """Return the orders of a torque; area: R A of its cylinder in m³, if it has a piston; major: those to mark."""
    rows = list[PlaceRow]()
    for index, order in enumerate(torque.orders.tolist()):
        values = _of_order(order, complex(torque.whole[index]))
        if torque.inertia is not None:
            values["M_gas"] = float(abs(torque.gas[index]))
            values["M_inertia"] = float(abs(torque.inertia[index]))
        if area:
            values["t_order"] = abs(torque.whole[index]) / area
        rows.append((("major" if order in major else "",), values))
    return rows


def _of_order(order: float, amplitude: complex) -> dict[str, float | None]:
    """Return one order: Re(M e^{iνφ}) = a cos νφ + b sin νφ = |M| cos(νφ − ε), ε above −180° up to 180°."""
    a = amplitude.real
    b = -amplitude.imag
    phase = math.degrees(math.atan2(b, a)) + 0.0 if amplitude else None
    return {"order": order, "M_cos": a, "M_sin": b, "M_amplitude": abs(amplitude), "M_phase": phase}
