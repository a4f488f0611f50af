"""Blau 1905, § 6, examples 31–35: first-order formulas (22), (25), (26), to three figures."""

import math

import pytest

import kurbel
from kurbel import crank_formulas as formulas
from kurbel.crank_angle import CrankAngle
from kurbel.report.zusammenstellung import zusammenstellung

MINUTE = 1 / 60


def displacement(degrees, lam):
    angle = CrankAngle.of(degrees)
    return formulas.first_order_displacement(angle.sin, angle.cos, lam)


def acceleration(degrees, lam):
    angle = CrankAngle.of(degrees)
    return formulas.first_order_acceleration(angle.sin, angle.cos, lam)


@pytest.mark.parametrize(("degrees", "printed"), [(45.0, 0.343), (90.0, 1.1), (135.0, 1.757)])
def test_example_31(degrees, printed):
    assert displacement(degrees, 1 / 5) == pytest.approx(printed, abs=0.0005)


@pytest.mark.parametrize(
    ("degrees", "printed", "unit"), [(45.0, 0.356, 0.001), (90.0, 1.125, 0.001), (135.0, 1.77, 0.01)]
)
def test_example_32(degrees, printed, unit):
    # 45°: 0.35539; Blau rounds 1.0625 up to 1.063 on the way
    assert displacement(degrees, 1 / 4) == pytest.approx(printed, abs=unit * 0.62)


@pytest.mark.parametrize(
    ("ratio", "printed", "unit", "way"), [(5, 79 + 20 * MINUTE, 5 * MINUTE, 0.911), (4, 77.0, 1.0, 0.895)]
)
def test_example_33_in_table_and_motion(ratio, printed, unit, way):
    """cos α = (−5 + √33)/4 is 0.18614, α = 79°16′, printed 79°20′ from the cosine rounded to 0.186."""
    root = math.degrees(math.acos((math.sqrt(ratio**2 + 8) - ratio) / 4))
    (exact, first_order) = zusammenstellung((ratio,)).whole.place_tables[0].columns
    motion = kurbel.solve(f"{{crank: 1 m, rod_ratio: {ratio}, speed: 1 Hz}}").cylinders[0].motion
    assert [*first_order.values] == pytest.approx([root], rel=1e-14)
    assert motion.phi_b_zero_book == pytest.approx((root, 360 - root), rel=1e-13)
    assert (exact.values[0], 360 - exact.values[0]) == pytest.approx(motion.phi_b_zero, rel=1e-13)
    assert root == pytest.approx(printed, abs=unit)
    assert 0 < root - exact.values[0] < 0.3
    assert acceleration(root, 1 / ratio) == pytest.approx(0, abs=1e-15)
    assert displacement(root, 1 / ratio) == pytest.approx(way, abs=0.002)
    assert kurbel.solve("{crank: 1 m, rod: infinite, speed: 1 Hz}").cylinders[0].motion.phi_b_zero_book is None


def test_example_34_a_sixth_of_the_acceleration_at_the_dead_centre():
    cos = (math.sqrt(41) - 5) / 4
    degrees = math.degrees(math.acos(cos))
    assert acceleration(degrees, 1 / 5) == pytest.approx(acceleration(0.0, 1 / 5) / 6, rel=1e-14)
    assert cos == pytest.approx(0.3508, abs=0.00005)
    assert degrees == pytest.approx(69.5, abs=3 * MINUTE)
    assert displacement(degrees, 1 / 5) == pytest.approx(0.737, abs=0.0005)


def test_example_35_a_sixth_as_deceleration():
    assert acceleration(90.0, 1 / 5) == pytest.approx(-acceleration(0.0, 1 / 5) / 6, rel=1e-15)
