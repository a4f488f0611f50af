"""Yoke-frame small crank drive (R p. 614): the slider-crank whose side force bends the piston rod."""

from __future__ import annotations

import numpy as np
import pytest

from kurbel.crank_angle import CrankAngle
from kurbel.errors import RuleError
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.mechanisms.yoke_frame import YokeFrame

TURN = CrankAngle.of(np.linspace(0, 360, 73))


def test_it_moves_as_the_slider_crank():
    yoke, crank = YokeFrame.from_keys(stroke=0.2, rod_ratio=3.0), SliderCrank.from_keys(stroke=0.2, rod_ratio=3.0)
    for name in ("coordinate", "slope", "curvature"):
        assert (getattr(yoke, name)(TURN) == getattr(crank, name)(TURN)).all()
    assert crank.guided
    assert not yoke.guided
    assert "bends the piston rod" in yoke.notes[0]


def test_the_arm_grows_as_the_pin_leaves_the_stuffing_box():
    yoke = YokeFrame(0.1, 0.3, gland=0.25)
    assert yoke.bending_arm(CrankAngle.of(0.0)) == 0.25
    assert yoke.bending_arm(CrankAngle.of(180.0)) == 0.45
    assert YokeFrame(0.1, 0.3).bending_arm(TURN) is None


@pytest.mark.parametrize("gland", [0.0, -0.1, float("inf")])
def test_a_gland_must_be_somewhere(gland):
    with pytest.raises(RuleError, match=r"gland: (.* too small; it must be more than 0|must be finite)"):
        YokeFrame(0.1, 0.3, gland=gland)


def test_the_rules_of_the_slider_crank_hold():
    with pytest.raises(RuleError, match="rod: 90 mm is shorter than the crank"):
        YokeFrame(0.1, 0.09)
