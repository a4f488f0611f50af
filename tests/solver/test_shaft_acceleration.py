"""The angular acceleration of the shaft: by Newton's law where the inertia is constant, else as the slope of ω²/2."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from kurbel.machine_file import load, loads
from kurbel.solver.case import Case
from kurbel.solver.flywheel import MachineTurning
from turning_machines import of_points, rectangles

CONFIGS = Path(__file__).parents[2] / "configs"
ENGINE = """
speed: 300 rpm
crank: 100 mm
rod: 400 mm
bore: 200 mm
masses: {piston: 30 kg}
flywheel: {inertia: 4 kg m2}
indicator: {head_end: {constant: {expansion: 5 bar, compression: 0.5 bar}}}
"""


def test_over_a_constant_inertia_it_is_the_excess_torque() -> None:
    """Rectangles of ±60 J over a quarter turn each, J = 2 kg m²: α = ±60/(π/2)/2 rad/s², with jumps between."""
    turning = of_points(rectangles([60, -60, 60, -60], mean=100.0), rpm=200, inertia=2.0)
    expected = 60 / (np.pi / 2) / 2
    assert turning.at(np.array([10.0, 100.0, 190.0, 280.0])).alpha == pytest.approx(
        [expected, -expected, expected, -expected], rel=1e-11
    )
    assert turning.alpha_max is not None
    assert turning.alpha_min is not None
    assert (turning.alpha_max.value, turning.alpha_min.value) == pytest.approx((expected, -expected), rel=1e-11)


@cache
def _solved(name: str) -> MachineTurning:
    more = {"constant": "", "power law": "load: {power_law: 2}\n", "slip": "load: {slip: 2 %}\n"}
    return Case(loads(ENGINE + more[name])).flywheel if name in more else Case(load(str(CONFIGS / name))).flywheel


@pytest.mark.parametrize(
    "name",
    [
        "constant",
        "power law",
        "slip",
        "four-cylinder-generator.yaml",
        "coupled-blower.yaml",
        "waterworks-two-cranks.yaml",
    ],
)
def test_it_is_the_slope_of_half_the_square_of_the_speed(name: str) -> None:
    """α = ½ dω²/dφ by central differences; with an elastic coupling ω_n dω/dφ, its speed line being linear."""
    turning = _solved(name)
    degrees, step = np.arange(3.3, 360.0, 7.1), 1e-3
    before, here, after = (turning.at(degrees + by).omega for by in (-step, 0.0, step))
    alpha = turning.at(degrees).alpha
    assert before is not None
    assert after is not None
    assert here is not None
    assert alpha is not None
    slope = (after - before) / np.radians(2 * step)
    speed = turning.omega if turning.elastic else here
    assert alpha == pytest.approx(slope * speed, abs=1e-5 * np.abs(alpha).max())
