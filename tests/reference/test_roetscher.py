"""Rötscher, Die Maschinenelemente, ch. 14: what he says of the motion, beside the exact values."""

from __future__ import annotations

import math

import pytest

from kurbel import crank_formulas as formulas
from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank
from machines import largest_velocity


@pytest.mark.parametrize(
    ("rod_ratio", "printed", "exact", "degrees", "square_rod"),
    [(5, 1.02, 1.0198331, 79.10014, 78.69007), (4, 1.03, 1.0308827, 76.72098, 75.96376)],
)
def test_largest_velocity(rod_ratio, printed, exact, degrees, square_rod):
    """R p. 606: about 1.02 v and 1.03 v; his rule "rod square to the crank", tan φ = L/R, is near the true place."""
    machine = SliderCrank(1.0, float(rod_ratio))
    largest = largest_velocity(machine)
    assert largest.value == pytest.approx(exact, abs=5e-8)
    assert largest.value == pytest.approx(printed, abs=0.005)
    assert largest.degrees == pytest.approx(degrees, abs=5e-6)
    assert math.degrees(math.atan(rod_ratio)) == pytest.approx(square_rod, abs=5e-6)
    # the rule misses the place by half a degree, the velocity √(1 + λ²) there by little
    rule = machine.slope(CrankAngle.of(math.degrees(math.atan(rod_ratio))))
    assert rule == pytest.approx(math.hypot(1, 1 / rod_ratio), rel=1e-15)
    assert 0 < 1 - rule / largest.value < 1.1e-4


def test_mean_piston_speed():
    """R 290: c_m/v = 2/π = 1/1.5708."""
    machine = SliderCrank(0.4, 2.0)
    mean_over_pin = 2 * machine.stroke / (2 * math.pi * machine.crank)
    assert mean_over_pin == pytest.approx(0.6366, abs=5e-5)
    assert 1 / mean_over_pin == pytest.approx(1.5708, abs=5e-5)


@pytest.mark.parametrize("lam", [1 / 6, 1 / 5, 1 / 4])
def test_acceleration_at_the_dead_centres_and_between(lam):
    """R 292 and 294 are exact; R 293, −λ at 90°, is exact with √(1 − λ²) below it."""
    machine = SliderCrank(lam, 1.0)
    inner, middle, outer = (machine.curvature(CrankAngle.of(degrees)) / lam for degrees in (0.0, 90.0, 180.0))
    assert inner == pytest.approx(1 + lam, rel=1e-15)
    assert middle == pytest.approx(-lam / math.sqrt(1 - lam * lam), rel=1e-15)
    assert outer == pytest.approx(-(1 - lam), rel=1e-15)
    at_90 = CrankAngle.of(90.0)
    assert formulas.first_order_acceleration(at_90.sin, at_90.cos, lam) == -lam


def test_scotch_yoke():
    """R p. 615: x = R(1 − cos φ), c = v sin φ, b = (v²/R) cos φ; R 287, 289, 295."""
    yoke, angle = ScotchYoke(0.4), CrankAngle.of(120.0)
    assert yoke.coordinate(angle) == pytest.approx(0.6, rel=1e-15)
    assert yoke.slope(angle) == pytest.approx(0.4 * math.sqrt(3) / 2, rel=1e-15)
    assert yoke.curvature(angle) == pytest.approx(-0.2, rel=1e-14)
