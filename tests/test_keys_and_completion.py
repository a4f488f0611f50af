"""`kurbel keys`, and what TAB completes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from kurbel.cli import kurbel
from kurbel.report.keys import every_place

CONFIGS = Path(__file__).parent.parent / "configs"


def told(*arguments: str) -> str:
    result = CliRunner().invoke(kurbel, ["keys", *arguments])
    assert result.exit_code == 0, result.stderr
    return result.stdout


def completed(words: str) -> list[str]:
    """What bash is offered for a line that ends in an unfinished word."""
    environment = {
        "_KURBEL_COMPLETE": "bash_complete",
        "COMP_WORDS": words,
        "COMP_CWORD": str(len(words.split(" ")) - 1),
    }
    output = CliRunner().invoke(kurbel, [], env=environment, prog_name="kurbel").stdout
    return [line.partition(",")[2] for line in output.splitlines() if line]


def test_every_key_of_the_shipped_machines_is_listed() -> None:
    listed = {line.split()[0].rpartition(".")[2] for line in told().splitlines()}
    words = "\n".join(path.read_text("utf-8") for path in CONFIGS.glob("*.yaml"))
    used = set(re.findall(r"^ *-? *([a-z_]+):", words, re.MULTILINE)) - {"constant", "trace", "otto", "steam"}
    bounds = {"c_max", "delta"}
    telling = {"diesel", "compressor"}
    assert used - listed - bounds - telling - key_values() == set()


def key_values() -> set[str]:
    from kurbel.quantities import every_quantity

    return {one.id for one in every_quantity().all_key_values}


def test_one_key_in_full() -> None:
    assert told("masses.connecting_rod.share").splitlines() == [
        "meaning  Reciprocating share of the mass",
        "form     a number",
        "absent   1/2",
        "or give  center_of_gravity",
        "example  share: 0.1",
    ]
    assert "must be given" in told("crankshaft.a")
    rim = told("flywheel.rim.mean_diameter")
    assert "absent   mean_diameter or outer_diameter must be given\nor give  outer_diameter" in rim


@pytest.mark.parametrize(
    "path", ["cylinders.0.bore", "cylinders[0].bore", "cylinders.each.bore", "tandem.0.bore", "bore"]
)
def test_a_path_may_be_that_of_a_message(path: str) -> None:
    assert "Diameter of the cylinder" in told(path)


def test_a_key_that_is_not_there() -> None:
    result = CliRunner().invoke(kurbel, ["keys", "share"])
    assert (result.exit_code, "it is at masses.connecting_rod.share" in result.stderr) == (2, True)
    assert "did you mean 'bore'" in CliRunner().invoke(kurbel, ["keys", "boore"]).stderr


def test_every_key_says_what_it_means() -> None:
    told = [(path, dict(one.full)) for path, places in every_place().items() for one in places]
    assert len(told) > 250
    assert [path for path, lines in told if not (lines["meaning"] and lines["form"] and lines["absent"])] == []


@pytest.mark.parametrize(
    ("words", "some"),
    [
        ("kurbel fly", ["flywheel"]),
        ("kurbel example wat", ["waterworks", "waterworks-two-cranks"]),
        ("kurbel units press", ["pressure", "pressure_rise", "pressure_velocity"]),
        ("kurbel keys masses.connecting_rod.s", ["masses.connecting_rod.share"]),
        ("kurbel motion engine.yaml --columns x,theta_d", ["x,theta_dot", "x,theta_ddot"]),
        ("kurbel forces engine.yaml --set bo", ["bore="]),
        ("kurbel forces engine.yaml --set bore=4", []),
        ("kurbel forces engine.yaml --cylinder ", []),
    ],
)
def test_what_a_shell_completes(words: str, some: list[str]) -> None:
    assert completed(words) == some


def test_cylinders_are_completed_from_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(CONFIGS)
    found = completed("kurbel forces four-cylinder-generator.yaml --cylinder ")
    assert found == [f"cylinder {i}" for i in (1, 2, 3, 4)]


def test_no_unit_is_listed_that_nobody_writes() -> None:
    """Micrometres, kilometres and decimetres: lengths and what people make of them, speeds in km/h, and densities."""
    written = {"um", "km", "dm", "um2", "km2", "dm2", "dm3", "kg/dm3", "km/h", "km/s", "um/s"}
    listed = [line.split(None, 1)[1] for line in CliRunner().invoke(kurbel, ["units"]).stdout.splitlines()]
    units = {unit.strip() for line in listed for unit in line.split(",")}
    assert len(units) > 100
    assert sorted(unit for unit in units - written if re.search(r"\b(um|km|dm)[23]?\b", unit)) == []
