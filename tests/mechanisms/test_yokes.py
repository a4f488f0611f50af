"""Scotch yoke and yoke frame: the values of the book, and their rules."""

from __future__ import annotations

import math

import pytest

from kurbel.crank_angle import CrankAngle
from kurbel.errors import RuleError
from kurbel.mechanisms.four_bar import FourBar
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.yoke_frame import YokeFrame


def test_values_of_the_book():
    yoke, at = ScotchYoke(0.2), CrankAngle.of(60.0)
    assert yoke.coordinate(at) == pytest.approx(0.1, rel=1e-15)
    assert yoke.slope(at) == pytest.approx(0.1 * math.sqrt(3), rel=1e-15)
    assert yoke.curvature(at) == yoke.block_slope(at) == pytest.approx(0.1, rel=1e-15)


def test_the_arm_grows_as_the_pin_leaves_the_stuffing_box():
    yoke = YokeFrame(0.1, 0.3, gland=0.25)
    assert [yoke.bending_arm(CrankAngle.of(degrees)) for degrees in (0.0, 180.0)] == [0.25, 0.45]
    with pytest.raises(RuleError, match="rod: 90 mm is shorter than the crank"):
        YokeFrame(0.1, 0.09)


def test_the_transmission_angle_is_that_of_the_cosine_rule():
    machine = FourBar(0.04, 0.15, 0.08, 0.15)
    for degrees in (0.0, 180.0):
        diagonal = 0.15 - 0.04 * math.cos(math.radians(degrees))
        cosine = (0.15**2 + 0.08**2 - diagonal**2) / (2 * 0.15 * 0.08)
        assert machine.transmission(degrees).value == pytest.approx(math.degrees(math.acos(cosine)), rel=1e-12)
