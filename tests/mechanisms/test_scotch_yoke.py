"""Scotch yoke: R p. 615, and its place as the slider-crank's limit."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kurbel.crank_angle import CrankAngle
from kurbel.errors import RuleError
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank

TURN = CrankAngle.of(np.linspace(0, 360, 73))


def test_it_is_the_slider_crank_with_infinite_rod():
    yoke, crank = ScotchYoke(0.3), SliderCrank(0.3, math.inf)
    assert yoke.coordinate(TURN) == pytest.approx(crank.coordinate(TURN), rel=1e-15)
    assert yoke.slope(TURN) == pytest.approx(crank.slope(TURN), rel=1e-15)
    assert yoke.curvature(TURN) == pytest.approx(crank.curvature(TURN), rel=1e-15)


def test_a_rod_a_million_cranks_long_comes_near():
    yoke, crank = ScotchYoke(0.3), SliderCrank(0.3, 0.3e6)
    assert crank.coordinate(TURN) == pytest.approx(yoke.coordinate(TURN), abs=0.3e-6)
    assert crank.curvature(TURN) == pytest.approx(yoke.curvature(TURN), abs=0.31e-6)


def test_values_of_the_book():
    yoke = ScotchYoke(0.2)
    at = CrankAngle.of(60.0)
    assert yoke.coordinate(at) == pytest.approx(0.1, rel=1e-15)
    assert yoke.slope(at) == pytest.approx(0.1 * math.sqrt(3), rel=1e-15)
    assert yoke.curvature(at) == pytest.approx(0.1, rel=1e-15)
    assert yoke.block_slope(at) == pytest.approx(0.1, rel=1e-15)
    assert yoke.pin_force_factor(at) == 1
    assert yoke.rod_angle(at) is None


def test_the_block_and_the_yoke_share_the_speed_of_the_pin():
    yoke = ScotchYoke(0.2)
    assert np.hypot(yoke.slope(TURN), yoke.block_slope(TURN)) == pytest.approx(0.2, rel=1e-15)


def test_crank_or_stroke():
    assert ScotchYoke.from_keys(stroke=0.6).crank == 0.3
    assert ScotchYoke.from_keys(crank=0.3).stroke == 0.6
    with pytest.raises(RuleError, match="'crank' or 'stroke' is missing"):
        ScotchYoke.from_keys()
    with pytest.raises(RuleError, match="the same thing"):
        ScotchYoke.from_keys(crank=0.3, stroke=0.6)
