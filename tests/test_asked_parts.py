"""`--cylinder` and `--key-values`: four cylinders once printed 709 lines."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kurbel.cli import kurbel
from representative import few

pytestmark = pytest.mark.usefixtures("solved_once")
FOUR = str(Path(__file__).parent.parent / "configs" / "four-cylinder-generator.yaml")
GAS_ENGINE = str(Path(__file__).parent.parent / "configs" / "gas-engine.yaml")


def run(*arguments: str) -> Result:
    return CliRunner().invoke(kurbel, list(arguments))


@pytest.mark.parametrize("command", few(["motion", "forces"], ["motion"]))
def test_one_cylinder_has_the_figures_that_it_has_among_the_others(command: str) -> None:
    among = json.loads(run(command, FOUR, "-f", "json").stdout)["cylinders"][2]
    assert json.loads(run(command, FOUR, "-f", "json", "--cylinder", "cylinder 3").stdout)["cylinders"] == [among]


def test_the_page_says_which_cylinder() -> None:
    asked = run("forces", FOUR, "--cylinder", "cylinder 3", "--key-values")
    assert asked.stdout.splitlines()[0].endswith("Forces in the crank train: cylinder 3")
    assert "cylinder 1" not in asked.stdout
    assert len(asked.stdout.splitlines()) < 50


def test_key_values_as_csv_are_those_of_json() -> None:
    rows = list(csv.DictReader(run("forces", GAS_ENGINE, "-f", "csv", "--key-values").stdout.splitlines()))
    (cylinder,) = json.loads(run("forces", GAS_ENGINE, "-f", "json").stdout)["cylinders"]
    expected = [
        (one["id"], one["unit"], value)
        for one in cylinder["key_values"]
        for value in (one["value"] if isinstance(one["value"], list) else [one["value"]])
    ]
    assert [(row["key_value"], row["unit"], float(row["value"])) for row in rows] == expected
    at = {one["id"]: one["at_deg"] for one in cylinder["key_values"] if "at_deg" in one}
    assert {row["key_value"]: float(row["at_deg"]) for row in rows if row["at_deg"]} == at


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ("forces", FOUR, "--cylinder", "cylinder 5"),
            "it has those of cylinder 1, cylinder 2, cylinder 3",
        ),
        (("flywheel", FOUR, "--cylinder", "cylinder 1"), "has no results of 'cylinder 1'; it has those of the whole"),
        (("forces", FOUR, "--key-values", "--columns", "T"), "--columns names columns of the table that --key-values"),
    ],
)
def test_what_does_not_exist_is_refused(arguments: tuple[str, ...], message: str) -> None:
    asked = run(*arguments)
    assert asked.exit_code == 2
    assert message in asked.stderr


NAMED = 'speed: 1 rpm\ncylinders: [{name: "2", crank: 1 m, rod: 5 m}, {name: left, crank: 2 m, rod: 9 m}]\n'


@pytest.mark.parametrize("command", few(["motion", "forces"], ["motion"]))
def test_a_cylinder_by_its_number(command: str) -> None:
    for number in ("4",):
        by_name = run(command, FOUR, "--cylinder", f"cylinder {number}")
        assert run(command, FOUR, "--cylinder", number).stdout == by_name.stdout
    beyond = run(command, FOUR, "--cylinder", "5")
    assert beyond.exit_code == 2
    assert "no results of '5'; it has those of cylinder 1, cylinder 2, cylinder 3, cylinder 4" in beyond.stderr


def test_a_number_that_is_another_ones_name_is_refused() -> None:
    def asked(cylinder: str) -> Result:
        return CliRunner().invoke(kurbel, ["motion", "-", "--cylinder", cylinder, "--key-values"], input=NAMED)

    refused = asked("2")
    assert refused.exit_code == 2
    assert "'2' is the name of cylinder 1 and the number of 'left'; write '1' or 'left'" in refused.stderr
    for cylinder, stroke in (("1", 2.0), ("left", 4.0)):
        (line,) = (line.split() for line in asked(cylinder).stdout.splitlines() if line.startswith("  s "))
        assert (float(line[1]), line[2]) == (1000 * stroke, "mm")
