"""A slider-crank table of the web page tlookup, λ = 0.28, s = 57 mm, at 1 rpm, every 10°: first-order formulas."""

from __future__ import annotations

import math

import pytest

from kurbel import crank_formulas as formulas
from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms.slider_crank import SliderCrank
from representative import law_of_each

CRANK, LAM, OMEGA = 0.0285, 0.28, math.pi / 30
# φ, displacement m, velocity m/s, acceleration m/s² as printed, and the exact three
TABLE = [
    (0, 0.0000, 0.0000, 0.00040, 0.0, 0.0, 0.000400048),
    (10, 0.0006, 0.0007, 0.00039, 0.000553363, 0.000661331, 0.000390321),
    (20, 0.0022, 0.0013, 0.00036, 0.00218658, 0.00129058, 0.000361754),
    (30, 0.0048, 0.0019, 0.00031, 0.00482071, 0.00185771, 0.000316181),
    (40, 0.0083, 0.0023, 0.00025, 0.00832988, 0.00233672, 0.000256614),
    (50, 0.0125, 0.0027, 0.00019, 0.0125495, 0.00270756, 0.000187122),
    (60, 0.0172, 0.0029, 0.00011, 0.0172878, 0.00295765, 0.000112576),
    (70, 0.0223, 0.0031, 0.00004, 0.0223389, 0.00308291, 3.81981e-05),
    (80, 0.0274, 0.0031, -0.00003, 0.0274972, 0.00308784, -3.10522e-05),
    (90, 0.0325, 0.0030, -0.00009, 0.0325714, 0.00298451, -9.11568e-05),
    (100, 0.0373, 0.0028, -0.00014, 0.0373952, 0.0027905, -0.000139595),
    (110, 0.0418, 0.0025, -0.00017, 0.041834, 0.00252614, -0.00017559),
    (120, 0.0457, 0.0022, -0.00020, 0.0457878, 0.00221168, -0.000199961),
    (130, 0.0492, 0.0019, -0.00022, 0.0491884, 0.00186498, -0.000214668),
    (140, 0.0520, 0.0015, -0.00022, 0.0519944, 0.00150009, -0.000222222),
    (150, 0.0542, 0.0011, -0.00023, 0.0541842, 0.0011268, -0.00022515),
    (160, 0.0557, 0.0008, -0.00023, 0.0557491, 0.000750946, -0.000225624),
    (170, 0.0567, 0.0004, -0.00023, 0.0566874, 0.000375179, -0.000225258),
    (180, 0.0570, 0.0000, -0.00022, 0.057, 0.0, -0.000225027),
]
LAST_DIGIT_OFF = {180}
"""The acceleration at 180° is −0.000225, printed −0.00022."""


@law_of_each((row,) for row in TABLE)
def test_exact_motion(row):
    degrees, *_, x, c, b = row
    machine, angle = SliderCrank(CRANK, CRANK / LAM), CrankAngle.of(float(degrees))
    assert machine.coordinate(angle) == pytest.approx(x, rel=5e-6)
    assert machine.slope(angle) * OMEGA == pytest.approx(c, rel=5e-6, abs=1e-18)
    assert machine.curvature(angle) * OMEGA**2 == pytest.approx(b, rel=5e-6)


@law_of_each((row,) for row in TABLE)
def test_printed_table_is_first_order(row):
    degrees, x, c, b, *_ = row
    angle = CrankAngle.of(float(degrees))
    assert CRANK * formulas.first_order_displacement(angle.sin, angle.cos, LAM) == pytest.approx(x, abs=0.5001e-4)
    assert CRANK * OMEGA * formulas.first_order_velocity(angle.sin, angle.cos, LAM) == pytest.approx(c, abs=0.5001e-4)
    unit = 1e-5 if degrees in LAST_DIGIT_OFF else 0.5001e-5
    printed = CRANK * OMEGA**2 * formulas.first_order_acceleration(angle.sin, angle.cos, LAM)
    assert printed == pytest.approx(b, abs=unit)
