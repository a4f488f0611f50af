"""`kurbel bearings` as a user calls it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kurbel.cli import kurbel

pytestmark = pytest.mark.usefixtures("solved_once")
CONFIGS = Path(__file__).parents[1] / "configs"
ENGINE = (CONFIGS / "gas-engine.yaml").read_text("utf-8")
THREE = """
speed: 600 rpm
cylinders:
  count: 3
  firing_order: 1-2-3
  each: {crank: 300 mm, rod_ratio: 5, masses: {reciprocating: 20 kg}}
"""
TWO = THREE.replace("count: 3", "count: 2").replace("1-2-3", "1-2")
SHAFT = ENGINE[ENGINE.index("crankshaft:") : ENGINE.index("limits:")]


def run(*arguments: str, file: str = ENGINE) -> Result:
    return CliRunner().invoke(kurbel, list(arguments), input=file)


def test_json_has_one_part_for_each_pin_and_bearing() -> None:
    result, fine = (json.loads(run("bearings", "-", "-f", "json", "--step", step).stdout) for step in ("90", "7"))
    # key values do not hang on the step
    assert [part["key_values"] for part in result["bearings"]] == [part["key_values"] for part in fine["bearings"]]
    parts = {part["name"]: part for part in result["bearings"]}
    assert list(parts) == ["crank pin", "crosshead pin", "bearing A", "bearing B"]
    columns = {column["id"]: column for column in parts["crank pin"]["columns"]}
    assert list(columns) == ["phi", "load", "load_throw", "load_engine", "load_rod"]
    assert [columns[id]["unit"] for id in columns] == ["deg", "N", "deg", "deg", "deg"]
    assert columns["load_throw"]["values"][0] == 180  # in the dead centre the piston presses the pin toward the shaft
    assert [column["id"] for column in parts["bearing A"]["columns"]] == ["phi", "load", "load_throw", "load_engine"]
    values = {value["id"]: value for value in parts["bearing A"]["key_values"]}
    asked = {"load_max", "load_mean", "load_min", "unloaded_arc", "pressure_max", "pressure_velocity"}
    assert asked <= values.keys()
    assert values["load_max"]["value"] >= max(parts["bearing A"]["columns"][1]["values"])


def test_one_bearing_alone() -> None:
    text = run("bearings", "-", "--cylinder", "bearing B", "--key-values").stdout
    assert "Bearing loads: bearing B" in text
    assert "F_L,max" in text
    wrong = run("bearings", "-", "--cylinder", "cylinder 2")
    assert wrong.exit_code == 2
    assert "it has those of crank pin, crosshead pin, bearing A, bearing B" in wrong.stderr


@pytest.mark.parametrize(("asked", "name"), [("2", "b"), ("b", "b"), ("1", "a")])
def test_the_pins_of_one_cylinder_by_its_name_or_its_number(asked: str, name: str) -> None:
    """`--cylinder 2` was taken for the cylinder's name, of which bearings were said to have no results."""
    one = "name: a, crank: 0.1 m, rod: 0.4 m, masses: {reciprocating: 9 kg}"
    two = f"speed: 100 rpm\ncylinders: [{{{one}}}, {{like: a, name: b, crank_position: 90 deg}}]"
    found = json.loads(run("bearings", "-", "--cylinder", asked, "-f", "json", file=two).stdout)
    assert [part["name"] for part in found["bearings"]] == [f"crank pin of {name}", f"crosshead pin of {name}"]


def test_several_throws_are_said_to_be_statically_determinate() -> None:
    text = " ".join(run("bearings", "-", "--cylinder", "bearing 3", "--key-values", file=TWO + SHAFT).stdout.split())
    assert "Statically determinate, throw by throw" in text
    assert "Bearing loads: bearing 3" in text
    assert "do not fit bearings between them" not in run("check", "-", file=TWO + SHAFT).stdout


def test_throws_that_do_not_fit_their_bearings_are_told() -> None:
    spaced = TWO.replace("count: 2", "count: 2\n  spacing: 300 mm")
    text = " ".join(run("bearings", "-", "--key-values", file=spaced + SHAFT).stdout.split())
    assert (
        "throws 300 mm apart along the shaft do not fit bearings between them, by which they are a + b = 800 mm" in text
    )
    checked = " ".join(run("check", "-", file=spaced + SHAFT).stdout.split())
    assert "bearings throws 300 mm apart along the shaft do not fit bearings between them" in checked


def test_without_a_crankshaft_there_are_pins_only() -> None:
    text = run("bearings", "-", "--key-values", file=ENGINE[: ENGINE.index("crankshaft:")]).stdout
    assert "Key values: crosshead pin" in text
    assert "bearing A" not in text
    assert "main bearings  no 'crankshaft' given" in text


def test_three_throws_cannot_be_overhung() -> None:
    shaft = SHAFT.replace("b: 400 mm", "b: 1200 mm\n  overhung: true")
    text = " ".join(run("bearings", "-", "--key-values", file=THREE + shaft).stdout.split())
    assert "main bearings 3 throws cannot all be overhung; a shaft has two ends" in text


def test_a_machine_without_loads_is_refused() -> None:
    result = run("bearings", "-", file="crank: 100 mm\nrod: 500 mm\n")
    assert result.exit_code == 2
    assert "nothing loads a bearing" in result.stderr


def test_a_load_that_vanishes_has_no_direction_and_is_no_fault() -> None:
    """Where the rod turns from push to pull the load on its pin is 0; the slope of its direction there is no number."""
    file = (
        "{speed: 75.2264 rpm, cycle: four-stroke, crank: 0.0279293 m, rod: 0.112536 m, offset: 0.0069996 m, "
        "bore: 0.0724949 m, masses: {reciprocating: 250.351 kg}, indicator: {head_end: {unit: bar, "
        "expansion: [[0, 33.9459], [0.736884, 14.3125], [0.973384, 1.55112], [1, 0.261974]], "
        "compression: [[1, 0.261974], [0.973384, 27.7117], [0.736884, 8.18621], [0, 33.9459]], "
        "intake: [[0, 0.261974], [0.736884, 8.46171], [0.973384, 4.06221], [1, 0.261974]], "
        "exhaust: [[1, 0.261974], [0.973384, 25.3732], [0.736884, 19.6728], [0, 0.261974]]}}}"
    )
    result = run("bearings", "-", "-f", "json", file=file)
    assert result.exit_code == 0
    values = {one["id"]: one["value"] for one in json.loads(result.stdout)["bearings"][0]["key_values"]}
    assert values["load_min"] == 0
