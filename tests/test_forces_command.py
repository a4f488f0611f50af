"""`kurbel forces` and `kurbel check` as a user calls them."""

import pytest

from command import answer, run
from good_machines import DEMO
from representative import CONFIGS

pytestmark = pytest.mark.usefixtures("solved_once")

WATERWORKS = str(CONFIGS["waterworks"])


def cylinder(parsed: dict[str, object], index: int = 0) -> dict[str, list[dict[str, object]]]:
    return parsed["cylinders"][index]


def key_value(part: dict[str, list[dict[str, object]]], name: str) -> dict[str, object]:
    return next(one for one in part["key_values"] if one["id"] == name)


def test_demo_machine_of_the_contract() -> None:
    parsed = answer("forces", "-", text=DEMO)
    assert parsed["command"] == "forces"
    assert parsed["machine"] == "Demo steam engine"
    part = cylinder(parsed)
    assert [c["id"] for c in part["columns"]][:6] == ["phi", "psi", "x", "c", "b", "p_head"]
    assert part["columns"][0]["values"] == list(range(0, 361, 10))
    assert key_value(part, "b_max")["value"] == pytest.approx(13.16, abs=5e-3)
    assert key_value(part, "b_max")["at_deg"] == 0
    assert {"what": "friction", "why": "no friction given"} in part["left_out"]
    assert part["warnings"] == []


def test_key_values_do_not_depend_on_the_step() -> None:
    first, second = (cylinder(answer("forces", WATERWORKS, "--step", step)) for step in ("10", "0.7"))
    assert first["key_values"] == second["key_values"]


def test_technical_units_show_the_figures_of_the_book() -> None:
    """Waterworks engine: 1546,3 cm², about 1115 kg of inertia (with 826 kg instead of 830), pump 3490 and 3710 kg."""
    part = cylinder(answer("forces", WATERWORKS, "--units", "technical", "--angles", "90,270"))
    assert key_value(part, "A_head")["value"] == pytest.approx(1546.3, abs=0.05)
    assert key_value(part, "A_head")["unit"] == "cm^2"
    assert key_value(part, "P_inertia_min")["value"] == pytest.approx(-1115 * 826 / 830, rel=2e-3)
    assert key_value(part, "stroke")["value"] == pytest.approx(800, rel=1e-15)


def test_a_machine_without_forces_says_what_is_left_out() -> None:
    part = cylinder(answer("forces", "-", text="{crank: 1 m, rod: infinite}"))
    assert [column["id"] for column in part["columns"]] == ["phi", "psi", "x"]
    reasons = {entry["what"]: entry["why"] for entry in part["left_out"]}
    assert reasons["velocity, acceleration"] == "no speed given"
    assert reasons["forces in the crank train"] == "no force acts"


LOCKING = (
    "speed: 60 rpm\ncrank: 95 mm\nrod: 100 mm\nbore: 50 mm\nfriction: {crosshead: 0.5}\n"
    "indicator: {head_end: {constant: {expansion: 0 bar, compression: 5 bar}}}\n"
)


def test_check_tells_that_the_crosshead_locks_itself() -> None:
    result = run("check", "-", text=LOCKING + "limits: {c_max: 1 m/s, stroke: 190 mm}\n")
    assert result.exit_code == 0
    assert "the crosshead locks itself near φ = " in result.stdout
    assert "kurbel forces ends with status 3" in result.stdout
    assert result.stdout.count("PASS") == 2


@pytest.mark.parametrize("command", ["motion", "forces"])
def test_a_shaper_has_no_piston(command: str) -> None:
    """Its largest force was called that of a piston; what drives a pump by the same lever still has one."""
    shaper = str(CONFIGS["shaper"])
    told = run(command, shaper).stdout
    assert "piston" not in told
    assert "Mean ram speed" in told
    assert ("Largest force along the stroke line" in told) == (command == "forces")
    bore = ("--set", "bore=200 mm", "--set", "indicator={head_end: 3 bar}")
    assert "Mean piston speed" in run(command, shaper, *bore).stdout
