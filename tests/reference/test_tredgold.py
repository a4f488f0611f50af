"""T. Tredgold, The Steam Engine (1838): rotary force, T/P = sin(φ + ψ)/cos ψ for L/R from 2 to 7, two decimals."""

from pathlib import Path

import pytest

from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms.slider_crank import SliderCrank
from representative import law_of_each

BOOK = Path(__file__).with_name("tredgold_1838.csv").read_text("utf-8").splitlines()


@law_of_each(tuple(line.split(",")) for line in BOOK if line[0] != "#")
def test_rotary_force(degrees, ratio, printed, exact):
    computed = SliderCrank(1.0, float(ratio)).slope(CrankAngle.of(float(degrees)))
    assert computed == pytest.approx(float(exact), abs=6e-9 * max(1, 10 * float(exact)))
    off_by_a_unit = abs(computed - float(printed.strip("*"))) < 0.01
    assert off_by_a_unit != printed.endswith("*")
