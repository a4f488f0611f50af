"""Orders of the turning effort: against integrals with 40 digits, by laws, and the same effort given by its orders."""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np
import pytest

from kurbel.accuracy.references import Textbook, TextbookMachine
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Indicator
from kurbel.machine.parts import Masses, Piston
from kurbel.machine_file import load
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.chapters.harmonics import MachineOrders
from machines import STEAM_CARD
from representative import CONFIGS
from turning_machines import of_points

mp = mpmath.mp
NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)


def steam(**more: Any) -> Cylinder:
    card = Piston(
        0.45, head_end_rod=0.075, crank_end_rod=0.1, indicator=Indicator(STEAM_CARD, STEAM_CARD)
    )
    return Cylinder(SliderCrank(0.4, 2.0), **{"pistons": (card,), "masses": Masses(826.0), **more})


def orders_of(machine: Machine, orders: list[float] | None = None) -> MachineOrders:
    return Case(machine).harmonics(None if orders is None else np.array(orders))


def gauss(torque: Callable[[float], Any], edges: list[float], orders: list[float]) -> list[complex]:
    """M_ν = (2/Φ) ∫ M e^{−iνφ} dφ of a torque over degrees, at 24 Gauss points of every piece."""
    total = np.zeros(len(orders), dtype=complex)
    for low, high in pairwise(edges):
        for node, weight in zip(NODES, WEIGHTS) if high - low > 1e-9 else ():
            angle = (low + high) / 2 + (high - low) / 2 * float(node)
            share = float(torque(angle)) * weight * (high - low) / edges[-1]
            total += share * np.exp(-1j * np.radians(np.array(orders) * angle))
    return total.tolist()


def by_integrals(machine: Machine, orders: list[float]) -> list[complex]:
    """M_ν of one cylinder: its torque with 40 digits, written as the textbooks have it."""
    with mp.workdps(40):
        book = TextbookMachine(Textbook(machine), "ΔE")
        edges = sorted(
            {
                *np.asarray(book.edges, dtype=float),
                *np.arange(0.0, 360.0 * machine.revolutions, 15.0),
            }
        )

        def torque(degrees: float) -> Any:
            angle = np.array([mpmath.mpf(degrees)])
            return book.function("ΔE")(angle, angle)[0]

        return gauss(torque, edges, orders)


@pytest.mark.parametrize(
    ("name", "orders"),
    [
        ("steam", [1, 2, 7, 24]),
        ("gas-engine", [0.5, 2.5, 24]),
    ],
)
def test_against_torques_of_40_digits(name: str, orders: list[float]) -> None:
    """Cards with corners and jumps: 1e-12 of the largest torque."""
    machine = Machine((steam(),), speed=50 / 60) if name == "steam" else load(CONFIGS[name])
    machine = replace(
        machine,
        cylinders=(replace(machine.cylinders[0], friction=None, inclination=None),),
        efficiency=1.0,
    )
    result = orders_of(machine, orders)
    largest = Case(machine).flywheel.M_max.value
    assert result.machine.whole == pytest.approx(by_integrals(machine, orders), abs=1e-12 * largest)


def test_a_diagram_with_jumps_in_closed_form() -> None:
    """Straight pieces by parts with mpmath: ∫ (a + bφ) e^{−iνφ} dφ."""
    points = [(0, 100), (60, 900), (60, 500), (180, 100), (240, 700), (360, 100)]
    orders = [1, 2, 5, 24, 200]
    result = Case(of_points(points).machine).harmonics(np.array(orders, dtype=float)).machine.whole
    with mpmath.workdps(40):
        for order, amplitude in zip(orders, result):
            exact = mpmath.mpc(0)
            for (low, first), (high, last) in pairwise(points):
                if low == high:
                    continue
                a, b = mp.radians(low), mp.radians(high)
                rise, k = (mpmath.mpf(last) - first) / (b - a), mpmath.mpc(0, -order)

                def primitive(x: Any, value: float, k: Any = k, rise: Any = rise) -> Any:
                    return mp.exp(k * x) * (mpmath.mpf(value) / k - rise / k**2)

                exact += (primitive(b, last) - primitive(a, first)) / mp.pi
            assert complex(amplitude) == pytest.approx(complex(exact), abs=1e-12 * 900)


def test_the_series_of_the_inertia_torque() -> None:
    """Den Hartog's λ/4, −½, −3λ/4, −λ²/4 are its beginnings; λ = 1/4, with 12 digits."""
    machine = Machine(
        (Cylinder(SliderCrank(1.0, 4.0), masses=Masses(1.0)),), speed=1 / (2 * math.pi)
    )
    result = orders_of(machine).machine.inertia[:8]
    known = [0.063506260577, -0.500130140561, -0.192055573420, -0.016129031165]
    known += [0.002592310746, 0.000390320062, -4.3971084e-5, -8.396165e-6]
    assert result.real == pytest.approx(0, abs=1e-15)
    assert -result.imag == pytest.approx(known, abs=1e-12)


def test_a_crank_that_follows_turns_its_orders() -> None:
    """Both together have M_ν (1 + e^{−iνβ}); over its own angle every cylinder has the same ones."""
    alone = orders_of(Machine((steam(),), speed=50 / 60)).machine
    two = orders_of(Machine((steam(), steam(name="b", crank_position=73.0)), speed=50 / 60))
    turn = np.exp(-1j * np.radians(73.0 * alone.orders))
    assert two.machine.whole == pytest.approx(
        alone.whole * (1 + turn), abs=1e-12 * np.abs(alone.whole).max()
    )
    assert two.cylinders[1].own.whole == pytest.approx(
        alone.whole, abs=1e-12 * np.abs(alone.whole).max()
    )


@pytest.mark.parametrize(
    ("positions", "cycle", "major"),
    [
        ((0, 90), "two-stroke", (4, 8)),
        ((0, 120, 240), "two-stroke", (3, 6)),
        ((0, 180, 360, 540), "four-stroke", (2, 4, 6, 8)),
        ((0, 120, 240, 360, 480, 600), "four-stroke", (3, 6)),
    ],
)
def test_major_orders(positions: tuple[float, ...], cycle: str, major: tuple[float, ...]) -> None:
    """Den Hartog: multiples of half the number of cylinders in four strokes; the others of equal cylinders vanish."""
    line = tuple(steam(name=str(p), crank_position=float(p), pistons=()) for p in positions)
    result = orders_of(Machine(line, speed=1.0, cycle=cycle))
    assert result.major_orders[: len(major)] == major
    assert set(major) == {order for order in result.major_orders if order <= major[-1]}
    others = ~np.isin(result.orders, result.major_orders)
    if len(positions) != 2:
        assert not result.machine.whole[others].any()
    assert orders_of(Machine(line[:1], speed=1.0, cycle=cycle)).major_orders is None


@pytest.mark.parametrize(
    ("positions", "major"),
    [
        ((0, 180), 2),
        ((0, 120, 240), 3),
        ((0, 90, 270, 180), 4),
        ((0, 179), None),
        ((0, 119, 240), None),
    ],
)
def test_major_orders_are_those_in_which_all_cranks_agree(
    positions: tuple[int, ...], major: int | None
) -> None:
    """|Σ e^{−iνβ}| is the number of cranks for ν = 2, 4, … of two at 180°; a degree off no order up to 24 has it."""
    cylinders = tuple(steam(name=f"at {angle}", crank_position=float(angle)) for angle in positions)
    result = orders_of(Machine(cylinders=cylinders, speed=1.0)).major_orders
    assert result == (
        () if major is None else tuple(float(order) for order in range(major, 25, major))
    )


@pytest.mark.parametrize("ratio", [0.5, 2.0])
def test_orders_at_another_speed_are_those_of_the_machine_that_runs_so(ratio: float) -> None:
    orders = [1.0, 2.0, 3.0, 4.0]
    here = orders_of(Machine((steam(),), speed=1.5), orders).machine
    there = orders_of(Machine((steam(),), speed=1.5 * ratio), orders).machine
    size = np.abs(there.whole).max()
    assert np.abs(here.at_speed(ratio) - there.whole).max() <= 1e-12 * size
