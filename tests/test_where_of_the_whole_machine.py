"""`kurbel flywheel --where`: exact crank angles at which a column of the whole machine has a value."""

from __future__ import annotations

import json
import math

import pytest
from click.testing import CliRunner, Result

from kurbel.cli import kurbel

pytestmark = pytest.mark.usefixtures("solved_once")
J = 5.0
HARMONIC = f"""
speed: 120 rpm
effort: {{unit: N m, mean: 100, harmonics: [[1, 0, 80]]}}
flywheel: {{inertia: {J} kg m2}}
"""
"""M = 100 + 80 sin φ, hence E = 80 (1 − cos φ) and α = 80 sin φ / J."""


def asked(condition: str, text: str = HARMONIC, *more: str) -> Result:
    return CliRunner().invoke(kurbel, ["flywheel", "--where", condition, *more, "-"], input=text)


def angles_of(condition: str) -> list[float]:
    result = asked(condition, HARMONIC, "-f", "json")
    assert result.exit_code == 0, result.output
    found: list[float] = json.loads(result.stdout)["machine_columns"][0]["values"]
    return found


@pytest.mark.parametrize(
    ("condition", "degrees"),
    [
        ("M = 140 N m", [30, 150]),
        ("M = M_m", [0, 180]),
        ("E = 80 J", [90, 270]),
        ("E = 1/4 E_max", [60, 300]),
        (f"alpha = {40 / J} rad/s2", [30, 150]),
        ("α = α_max", [90]),
        ("omega = omega_min", [0]),
        ("ω = ω_max", [180]),
    ],
)
def test_against_the_formulas(condition: str, degrees: list[float]) -> None:
    assert [angle % 360 for angle in angles_of(condition)] == pytest.approx(degrees, abs=1e-6)


def test_a_speed_against_the_kinetic_energy() -> None:
    """½ J (ω² − ω_min²) = 80 (1 − cos φ)."""
    slowest = float(
        json.loads(asked("omega = omega_min", HARMONIC, "-f", "json").stdout)["machine_columns"][3]["values"][0]
    )
    wanted = math.sqrt(slowest**2 + 2 * 80 * (1 - math.cos(math.radians(50))) / J)
    assert angles_of(f"omega = {wanted!r} rad/s") == pytest.approx([50, 310], rel=1e-11)


@pytest.mark.parametrize(
    ("condition", "status", "message"),
    [
        ("M = 1 kN m", 3, "M is nowhere 1 kN m"),
        ("T = 0", 2, "'T' is left out for this machine"),
        ("b = 0", 2, "'b' is no column"),
        ("M = 1 mm", 2, "neither a unit nor a key value of this kind"),
        ("M", 2, "expected a column and a value"),
    ],
)
def test_what_cannot_be_asked(condition: str, status: int, message: str) -> None:
    result = asked(condition)
    assert (result.exit_code, message in result.stderr) == (status, True), result.stderr


STAGES = """
speed: 600 rpm
cylinders:
  - {name: LP, stroke: 200 mm, rod: 450 mm, bore: 400 mm,
     indicator: {head_end: {constant: {expansion: 0 bar, compression: 3 bar}}}}
  - {name: HP, like: LP, indicator: {head_end: {constant: {expansion: 3 bar, compression: 9 bar}}}}
"""


def of_stages(*words: str) -> Result:
    return CliRunner().invoke(kurbel, ["forces", "-", *words], input=STAGES)


def test_one_cylinder_may_have_what_another_has_not() -> None:
    both = of_stages("--where", "p_head = 5 bar", "--columns", "p_head")
    assert both.exit_code == 0
    assert "LP: p_head is nowhere 5 bar: it goes from 0 mbar to 3 bar." in both.stdout
    rows = of_stages("--where", "p_head = 5 bar", "--columns", "p_head", "-f", "csv").stdout.splitlines()
    assert {row.split(",")[0] for row in rows[1:]} == {"HP"}
    assert of_stages("--where", "p_head = 5 bar", "--columns", "p_head", "--cylinder", "2").exit_code == 0
    for cylinder, condition in (("LP", "p_head = 5 bar"), ("HP", "p_head = 1 bar")):
        alone = of_stages("--where", condition, "--columns", "p_head", "--cylinder", cylinder)
        assert (alone.exit_code, f"{cylinder}: p_head is nowhere" in alone.stderr) == (3, True)
    neither = of_stages("--where", "p_head = 50 bar")
    assert (neither.exit_code, "LP: p_head is nowhere 50 bar" in neither.stderr) == (3, True)
