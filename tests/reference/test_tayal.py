"""A. K. Tayal, Engineering Mechanics (Python companion): examples 21.12 and 21.13."""

from __future__ import annotations

import cmath
import math

import pytest

from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms.four_bar import closed_loop
from kurbel.mechanisms.slider_crank import SliderCrank


def test_example_21_12_slider_crank():
    """Printed 2.213062 m/s and 5.468436 rad/s, from a rod angle rounded to 5.7°."""
    machine, angle, omega = SliderCrank(0.12, 0.6), CrankAngle.of(30.0), 2 * math.pi * 300 / 60
    assert machine.slope(angle) * omega == pytest.approx(2.21308424322, rel=1e-11)
    _, cos_psi = machine.rod_angle(angle)
    assert machine.lam * angle.cos / cos_psi * omega == pytest.approx(5.46881085105, rel=1e-11)


def test_example_21_13_four_bar_by_its_instantaneous_centre():
    """AB 0.2 m at 30°, BC 0.15 m horizontal, CD 0.3 m at 60°; printed 7.698004 and 1.924501 rad/s.

    The crank cannot turn fully (0.2 + 0.5 m is more than 0.15 + 0.3 m), but the loop closes as drawn.
    """
    pin = 0.2 * cmath.exp(1j * math.radians(30))
    joint = pin + 0.15
    pivot = joint - 0.3 * cmath.exp(1j * math.radians(120))
    tilt = math.degrees(cmath.phase(pivot))
    at = closed_loop(0.2, 0.15, 0.3, abs(pivot), CrankAngle.of(30.0 - tilt))
    sin, cos = at.sin, at.cos
    assert math.degrees(math.atan2(sin, cos)) + tilt == pytest.approx(120, abs=1e-10)
    rocker = 5 * at.slope
    assert abs(rocker) == pytest.approx(1.9245008973, rel=1e-10)
    coupler = (1j * rocker * (joint - pivot) - 5j * pin) / (1j * 0.15)
    assert abs(coupler.real) == pytest.approx(7.6980035892, rel=1e-10)
    assert coupler.imag == pytest.approx(0, abs=1e-9)
