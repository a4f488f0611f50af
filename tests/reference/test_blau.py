"""Blau 1905, § 6, examples 33 to 35, by first-order formulas; all of 31 to 35 are on the page of validation."""

import math

import pytest

import kurbel
from command import answer
from kurbel import crank_formulas as formulas
from kurbel.crank_angle import CrankAngle
from kurbel.report.zusammenstellung import zusammenstellung


def displacement(degrees, lam):
    angle = CrankAngle.of(degrees)
    return formulas.first_order_displacement(angle.sin, angle.cos, lam)


def acceleration(degrees, lam):
    angle = CrankAngle.of(degrees)
    return formulas.first_order_acceleration(angle.sin, angle.cos, lam)


@pytest.mark.parametrize(
    ("ratio", "printed", "unit", "way"), [(5, 79 + 20 / 60, 5 / 60, 0.911), (4, 77.0, 1.0, 0.895)]
)
def test_example_33_in_table_and_motion(ratio, printed, unit, way):
    """cos α = (−5 + √33)/4 is 0.18614, α = 79°16′, printed 79°20′ from the cosine rounded to 0.186."""
    root = math.degrees(math.acos((math.sqrt(ratio**2 + 8) - ratio) / 4))
    columns = {
        column.id: column for column in zusammenstellung((ratio,)).whole.place_tables[0].columns
    }
    exact, first_order = columns["phi_b_zero"], columns["phi_b_zero_book"]
    assert columns["x_b_zero_book"].values[0] == pytest.approx(way, abs=0.002)
    motion = kurbel.solve(f"{{crank: 1 m, rod_ratio: {ratio}, speed: 1 Hz}}").cylinders[0].motion
    assert [*first_order.values] == pytest.approx([root], rel=1e-14)
    assert motion.phi_b_zero_book == pytest.approx((root, 360 - root), rel=1e-13)
    assert (exact.values[0], 360 - exact.values[0]) == pytest.approx(motion.phi_b_zero, rel=1e-13)
    assert root == pytest.approx(printed, abs=unit)
    assert 0 < root - exact.values[0] < 0.3
    assert acceleration(root, 1 / ratio) == pytest.approx(0, abs=1e-15)
    assert displacement(root, 1 / ratio) == pytest.approx(way, abs=0.002)
    assert (
        kurbel.solve("{crank: 1 m, rod: infinite, speed: 1 Hz}").cylinders[0].motion.phi_b_zero_book
        is None
    )


@pytest.mark.parametrize(
    ("condition", "ratio", "printed", "within", "way"),
    [
        ("b_0 = 0", 5, 79 + 20 / 60, 5 / 60, 0.911),
        ("b_0 = 0", 4, 77.0, 1.0, 0.895),
        ("b_0 = 1/6 b_max", 5, 69.5, 0.05, 0.737),
        ("b_0 = -1/6 b_max", 5, 90.0, 1e-9, 1.1),
    ],
)
def test_examples_33_to_35_without_a_speed(tmp_path, condition, ratio, printed, within, way):
    """A fraction of the largest acceleration is at the same angles whatever the speed."""
    (tmp_path / "machine.yaml").write_text(f"{{crank: 1 m, rod_ratio: {ratio}}}")
    arguments = "motion", str(tmp_path / "machine.yaml"), "--where", condition
    phi, *_ = answer(*arguments)["cylinders"][0]["columns"]
    assert phi["values"][0] == pytest.approx(printed, abs=within)
    assert displacement(phi["values"][0], 1 / ratio) == pytest.approx(way, abs=0.002)
    at_speed = answer(*arguments, "--set", "speed=37 rpm")["cylinders"][0]["columns"][0]
    assert phi["values"] == pytest.approx(at_speed["values"], abs=1e-9)
