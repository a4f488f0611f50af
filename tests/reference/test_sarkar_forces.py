"""B. K. Sarkar, Theory of Machines, ch. 5: forces. Figures: FOSSEE Python companion @d34b2ae7, Chapter5_1.ipynb.

The companion prints first-order values with pi = 3.141 and 57.3 deg/rad; the expectations are independent 30-digit
recalculations with exact accelerations and the book's g = 9.81 m/s².
"""

from __future__ import annotations

import math

import pytest

from kurbel.declared.units import GRAVITY
from kurbel.machine.indicator import Indicator
from kurbel.machine.parts import Masses, Piston
from kurbel.mechanisms.slider_crank import SliderCrank
from machines import constant_pressure, one_cylinder, single_acting

BOOK_G = 9.81


def double_acting(crank: float, rod: float, piston: Piston, rpm: float, mass: float | None) -> object:
    return one_cylinder(SliderCrank(crank, rod), rpm, pistons=(piston,), masses=None if mass is None else Masses(mass))


def test_example_5_3_turning_moment() -> None:
    piston = Piston(0.3, indicator=Indicator(constant_pressure(1.0e6), constant_pressure(35e3)))
    state = one_cylinder(SliderCrank(0.25, 1.0), 200, pistons=(piston,), masses=Masses(100)).at([45])
    assert state.P[0] == pytest.approx(60412.6107348, rel=1e-11)
    assert state.M[0] == pytest.approx(12597.6439889, rel=1e-11)


def test_example_5_4_vertical_engine() -> None:
    state = single_acting(0.06, 0.25, 0.1, 680e3, 1800, 1.2, vertical=True).at([25])
    weight = 1.2 * (GRAVITY - BOOK_G)
    assert state.P[0] - weight == pytest.approx(2631.99522845, rel=1e-11)
    ratio = 2631.99522845 / (2631.99522845 + weight)
    assert state.S[0] * ratio == pytest.approx(2645.639204, rel=1e-11)
    assert state.N[0] * ratio == pytest.approx(268.342905981, rel=1e-11)


def test_example_5_6_turning_moment_without_inertia() -> None:
    piston = Piston(0.25, crank_end_rod=0.05, indicator=Indicator(constant_pressure(0.58e6), constant_pressure(0.05e6)))
    state = one_cylinder(SliderCrank(0.2, 0.6), 180, pistons=(piston,)).at([40])
    assert state.M[0] == pytest.approx(4234.85458657, rel=1e-11)
    assert state.D[0] == pytest.approx(16322.7196019, rel=1e-11)


def test_example_5_7_gas_and_inertia_nearly_cancel() -> None:
    """The print, 2366.2 N m, is 1.9 % off: the near-cancellation amplifies the error of the first-order formula."""
    state = single_acting(0.225, 0.9, 0.25, 1.05e6, 360, 180, vertical=True).at([45])
    book = state.M[0] - 180 * (GRAVITY - BOOK_G) * state.slope[0]
    assert book == pytest.approx(2321.71756848, rel=1e-11)


def test_example_5_8_diesel_after_cut_off() -> None:
    """The pressure at 60° is worked out here by p V^1.35 from the data of the example."""
    mechanism = SliderCrank(0.2, 0.8)
    fraction = one_cylinder(mechanism, 300).at([60]).x[0] / mechanism.stroke
    clearance = 1 / 13
    pressure = 0.1e6 * 14**1.35 * ((clearance + 0.1) / (clearance + fraction)) ** 1.35
    state = single_acting(0.2, 0.8, 0.25, pressure - 0.1e6, 300, 200, vertical=True).at([60])
    book = state.M[0] - 200 * (GRAVITY - BOOK_G) * state.slope[0]
    assert book == pytest.approx(8824.91126743, rel=1e-11)


def test_gupta_13_1_side_thrust() -> None:
    """H. N. Gupta, Internal Combustion Engines, 13.1: 8000 N in the rod at 90°; the print takes atan for asin."""
    mechanism = SliderCrank(0.0375, 0.152)
    force = 8000 * math.sqrt(1 - (0.0375 / 0.152) ** 2)
    piston = Piston(0.08, indicator=Indicator(constant_pressure(force / (math.pi / 4 * 0.08**2))))
    state = one_cylinder(mechanism, pistons=(piston,)).at([90])
    assert state.S[0] == pytest.approx(8000, rel=1e-14)
    assert state.N[0] == pytest.approx(1973.68421053, rel=1e-11)
