"""H. N. Gupta, Fundamentals of Internal Combustion Engines (Python companion), example 16.1: motion."""

from __future__ import annotations

import math

import pytest

from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms.slider_crank import SliderCrank


def test_example_16_1_six_cylinder_engine():
    """3 dm³ in six cylinders, bore = stroke, rod 17.2 cm, 3000 rpm, ε = 9; all six answers printed right."""
    stroke = (3e-3 / 6 * 4 / math.pi) ** (1 / 3)
    assert stroke == pytest.approx(0.0860254013828, rel=1e-11)
    machine, angle, speed = SliderCrank.from_keys(stroke=stroke, rod=0.172), CrankAngle.of(20.0), 3000 / 60
    assert 2 * machine.stroke * speed == pytest.approx(8.60254013828, rel=1e-11)
    assert machine.slope(angle) * 2 * math.pi * speed == pytest.approx(5.71171368663, rel=1e-11)
    travel = machine.coordinate(angle)
    assert travel == pytest.approx(0.00322426510192, rel=1e-11)
    clearance = 0.5e-3 / (9 - 1)
    assert clearance == pytest.approx(62.5e-6, rel=1e-15)
    assert clearance + math.pi / 4 * stroke**2 * travel == pytest.approx(81.2401921414e-6, rel=1e-11)
