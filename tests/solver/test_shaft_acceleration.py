"""The angular acceleration of the shaft: by Newton's law where the inertia is constant, else as the slope of ω²/2."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from kurbel.machine_file import load, loads
from kurbel.solver.case import Case
from kurbel.solver.flywheel import MachineTurning
from representative import few
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


SCANNED = ["constant", "power law", "slip", "coupled-blower.yaml", "waterworks-two-cranks.yaml"]


@pytest.mark.parametrize("name", few(SCANNED, SCANNED[::2]))
def test_its_extremes_are_those_of_a_fine_scan(name: str) -> None:
    turning = _solved(name)
    cycle = turning.effort.cycle
    scan = turning.at(np.linspace(0.0, cycle, 20001)).alpha
    assert scan is not None
    for extreme, reached, sign in ((turning.alpha_max, scan.max(), 1), (turning.alpha_min, scan.min(), -1)):
        assert extreme is not None
        size = np.abs(scan).max()
        assert sign * (extreme.value - reached) >= -1e-9 * size
        assert extreme.value == pytest.approx(reached, abs=2e-3 * size)


def test_without_a_flywheel_there_is_none() -> None:
    turning = of_points(rectangles([60, -60], mean=10.0), rpm=200)
    assert turning.alpha_max is None
    assert turning.at(np.zeros(1)).alpha is None


EQUAL_CYLINDERS = """
speed: 1500 rpm
cycle: four-stroke
cylinders:
  count: {count}
  firing_order: {order}
  bank_angles: [{banks}]
  each:
    stroke: 100 mm
    rod: 175 mm
    bore: 90 mm
    masses: {{piston: 0.8 kg, connecting_rod: 1.2 kg}}
    indicator: {{head_end: {{otto: {{intake: 0 bar, compression_ratio: 9, peak: 50 bar}}}}}}
flywheel: {{fluctuation: 0.01}}
"""


@pytest.mark.parametrize(
    ("count", "order", "banks"),
    [
        (4, "1-3-4-2", "0 deg"),
        (4, "1-3-2-4", "0 deg, 180 deg"),
        (5, "1-3-5-2-4", "0 deg, 72 deg, 144 deg, 216 deg, 288 deg"),
        (8, "1-8-4-3-6-5-7-2", "0 deg, 90 deg"),
    ],
)
def test_of_summits_that_come_back_with_every_firing_the_first_is_told(count: int, order: str, banks: str) -> None:
    """Rounding decided: ω_max of the four in line stood at 598.8°, α_max at 201.01°, as high as at 58.8 and 21.01."""
    turning = Case(loads(EQUAL_CYLINDERS.format(count=count, order=order, banks=banks))).flywheel
    told = turning.omega_max, turning.omega_min, turning.alpha_max, turning.alpha_min
    assert [one.degrees for one in told if one and one.degrees >= 720 / count] == []
