"""`kurbel forces` and `kurbel check` as a user calls them."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from good_machines import DEMO
from kurbel.cli import kurbel
from kurbel.quantities import every_quantity
from kurbel.quantity import by_id
from representative import shipped

pytestmark = pytest.mark.usefixtures("solved_once")

CONFIGS = Path(__file__).parent.parent / "configs"
WATERWORKS = str(CONFIGS / "waterworks.yaml")


def run(*arguments: str, text: str | None = None) -> Result:
    return CliRunner().invoke(kurbel, list(arguments), input=text)


def answer(*arguments: str, text: str | None = None) -> dict[str, object]:
    result = run(*arguments, "-f", "json", text=text)
    assert result.exit_code == 0, result.output
    parsed: dict[str, object] = json.loads(result.stdout)
    return parsed


def cylinder(parsed: dict[str, object], index: int = 0) -> dict[str, list[dict[str, object]]]:
    return parsed["cylinders"][index]  # type: ignore[index,no-any-return]


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


@pytest.mark.parametrize("path", shipped("waterworks", "shaper", "crank-rocker", "diesel-four-stroke"))
def test_every_id_is_declared_and_every_number_finite(path: Path) -> None:
    result = run("forces", str(path), "-f", "json")
    if result.exit_code:
        pytest.skip("a machine for other commands, and tested there")
    for part in json.loads(result.stdout)["cylinders"]:
        for column in part["columns"]:
            assert column["id"] in by_id(*every_quantity().all_columns)
            assert all(math.isfinite(value) for value in column["values"])
        for one in part["key_values"]:
            assert one["id"] in by_id(*every_quantity().all_key_values)
            values = one["value"] if isinstance(one["value"], list) else [one["value"]]
            assert all(math.isfinite(value) for value in values)


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
    reasons = {entry["what"]: entry["why"] for entry in part["left_out"]}  # type: ignore[index]
    assert reasons["velocity, acceleration"] == "no speed given"
    assert reasons["forces in the crank train"] == "no force acts"


def test_self_locking_ends_with_status_3() -> None:
    text = (
        "crank: 95 mm\nrod: 100 mm\nbore: 50 mm\nfriction: {crosshead: 0.5}\n"
        "indicator: {head_end: {constant: {expansion: 0 bar, compression: 5 bar}}}\n"
    )
    result = run("forces", "-", text=text)
    assert result.exit_code == 3
    assert "the crosshead locks itself near φ = " in result.stderr
    assert result.stdout == ""


LOCKING = (
    "speed: 60 rpm\ncrank: 95 mm\nrod: 100 mm\nbore: 50 mm\nfriction: {crosshead: 0.5}\n"
    "indicator: {head_end: {constant: {expansion: 0 bar, compression: 5 bar}}}\n"
)


def test_check_tells_that_the_crosshead_locks_itself() -> None:
    result = run("check", "-", text=LOCKING + "limits: {c_max: 1 m/s, stroke: 190 mm}\n")
    assert result.exit_code == 0
    assert "the crosshead locks itself near φ = " in result.stdout
    assert "kurbel forces ends with status 3" in result.stdout
    assert result.stdout.count("kept") == 2


def test_check_says_nothing_of_a_driving_crosshead() -> None:
    """With this friction it would lock, were it driven."""
    result = run(
        "check", "-", text=LOCKING.replace("expansion: 0 bar, compression: 5", "expansion: 5 bar, compression: 0")
    )
    assert "locks" not in result.stdout


def test_an_absent_column_is_told_with_those_that_are_there() -> None:
    result = run(
        "forces",
        "-",
        "--columns",
        "N,D",
        text="mechanism: slotted-lever\ncrank: 100 mm\nframe: 250 mm\nlever: 600 mm\nram_force: {work: 1 kN}\n",
    )
    assert result.exit_code == 2
    assert (
        "'N' is left out for this machine, which has phi (φ), z, x, theta (θ), P_ram (P_r), P, F_pin (F_z), D, T, M"
        in result.stderr.replace("\n", " ")
    )


SLOTTED = (
    "mechanism: slotted-lever\ncrank: 100 mm\nframe: 250 mm\nlever: 600 mm\nram_force: {work: 1 kN}\nspeed: 30 rpm\n"
)


def test_the_forces_of_a_link_are_left_out_for_what_they_are() -> None:
    linked = run("check", "-", text=SLOTTED + "link: 400 mm\n").stdout
    assert "S, N: the forces of the link on the ram are not computed" in linked
    assert "S, N: a slotted-lever has no connecting rod" in run("check", "-", text=SLOTTED).stdout


def test_of_a_ram_without_a_piston_nobody_expects_an_indicated_work() -> None:
    stdout = run("check", "-", text=SLOTTED).stdout
    assert "no bore given" not in stdout.replace("gas force: no bore given", "")


@pytest.mark.parametrize("command", ["motion", "forces"])
def test_a_shaper_has_no_piston(command: str) -> None:
    """Its largest force was called that of a piston; what drives a pump by the same lever still has one."""
    shaper = str(CONFIGS / "shaper.yaml")
    told = run(command, shaper).stdout
    assert "piston" not in told
    assert "Mean ram speed" in told
    assert ("Largest force along the stroke line" in told) == (command == "forces")
    bore = ("--set", "bore=200 mm", "--set", "indicator={head_end: 3 bar}")
    assert "Mean piston speed" in run(command, shaper, *bore).stdout


@pytest.mark.parametrize(("missing", "why"), [("speed: 50 rpm\n", "no speed given"), (None, "no indicator given")])
def test_what_the_brake_measured_needs_an_indicated_power(missing: str | None, why: str) -> None:
    text = (
        DEMO.replace(missing, "")
        if missing
        else "crank: 1 m\nrod: 5 m\nbore: 1 m\nspeed: 9 rpm\nmasses: {piston: 1 kg}\n"
    )
    stdout = run("check", "-", text=text + "brake_power: 100 kW\n").stdout
    assert f"comparison with brake_power: {why}" in " ".join(stdout.split())


def test_numbers_too_large_are_refused_by_name() -> None:
    text = "speed: 1e200 rpm\ncrank: 1e200 m\nrod_ratio: 5\nmasses: {piston: 1e200 kg}\n"
    result = run("forces", "-", text=text)
    assert result.exit_code == 2
    assert result.stderr.count("is too large; a") == 3
    assert "nan" not in result.output.lower()


def test_check_names_what_is_computed_and_what_is_left_out() -> None:
    output = run("check", "-", text=DEMO).stdout
    assert "gas force" in output.split("computed")[1].splitlines()[0]
    assert "inertia: no masses given" in output
