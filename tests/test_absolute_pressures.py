"""Pressures that a file gives as absolute are shown, asked for and limited as absolute; what hangs on them is not."""

from __future__ import annotations

import csv
import json

import pytest
from click.testing import CliRunner

from kurbel.cli import kurbel
from kurbel.machine_file import loads
from kurbel.solver.case import Case

pytestmark = pytest.mark.usefixtures("solved_once")

MACHINE = """
speed: 240 rpm
stroke: 300 mm
rod: 750 mm
bore: 320 mm
indicator:
  pressures: {counted}
  head_end: {{constant: {{expansion: {low}, compression: {high}}}}}
  crank_end: mirrored
"""
ABSOLUTE = MACHINE.format(counted="absolute", low="1 bar", high="7 bar")
GAUGE = MACHINE.format(counted="gauge", low="-0.01325 bar", high="5.98675 bar")


def run(*words: str, text: str = ABSOLUTE) -> str:
    result = CliRunner().invoke(kurbel, [*words, "-"], input=text)
    assert (result.exit_code, result.stderr) == (0, "")
    return result.stdout


@pytest.mark.parametrize(
    ("text", "unit", "sentence"),
    [(ABSOLUTE, "bar abs", "Largest absolute pressure"), (GAUGE, "bar", "Largest gauge pressure")],
)
def test_heading_and_key_value_say_which(text: str, unit: str, sentence: str) -> None:
    lines = run("forces", "--columns", "p_head,p_crank", "--angles", "90,270", text=text).splitlines()
    rows = {line[:3]: line.split("  ") for line in lines if line.startswith("p_")}
    assert all(unit in row for row in rows.values())
    (key_value,) = (line for line in lines if line.startswith("  p_max"))
    assert sentence in key_value
    assert f" {unit} " in key_value


@pytest.mark.parametrize(("text", "numbers"), [(ABSOLUTE, "1.000 7.000"), (GAUGE, "-0.013 5.987")])
def test_the_figures_are_those_of_the_file(text: str, numbers: str) -> None:
    (row,) = (
        line
        for line in run("forces", "--columns", "p_head", "--angles", "90,270", text=text).splitlines()
        if line.startswith("p_H")
    )
    assert row.split()[-2:] == numbers.split()


def test_programs_are_told_too() -> None:
    (head, *_) = csv.reader(run("forces", "--columns", "p_head", "--angles", "90", "-f", "csv").splitlines())
    assert head == ["phi_deg", "p_head_Pa_abs"]
    parsed = json.loads(run("forces", "--columns", "p_head", "--angles", "90", "-f", "json"))["cylinders"][0]
    assert parsed["columns"][1]["unit"] == "Pa abs"
    assert parsed["columns"][1]["values"] == pytest.approx([1e5], rel=1e-15)
    (p_max,) = (one for one in parsed["key_values"] if one["id"] == "p_max")
    assert (p_max["unit"], p_max["value"]) == ("Pa abs", pytest.approx(7e5, rel=1e-15))
    assert Case(loads(ABSOLUTE)).cylinders[0]["p_max"].unit == "Pa abs"


def test_forces_and_differences_hang_on_no_zero() -> None:
    """p_i is the work over the swept volume, P the difference of two pressures: 6 bar on the driven stroke."""
    absolute, gauge = (Case(loads(text)).cylinders[0] for text in (ABSOLUTE, GAUGE))
    assert absolute.mean_pressure == pytest.approx(-6e5, rel=1e-12)
    assert absolute["mean_pressure"].unit == "Pa"
    by_gauge, by_absolute = (one.at([90.0, 270.0]).P for one in (gauge, absolute))
    assert by_absolute == pytest.approx(by_gauge, rel=1e-9)


def test_limits_and_places_count_as_the_file_does() -> None:
    limited = f"{ABSOLUTE}limits: {{p_max: 6.5 bar}}\n"
    assert "7 bar > 6.5 bar  BROKEN" in CliRunner().invoke(kurbel, ["check", "-"], input=limited).stdout
    found = run("forces", "--where", "p_head = 7 bar", "--columns", "p_head", "-f", "csv")
    assert float(found.splitlines()[1].split(",")[1]) == pytest.approx(7e5, rel=1e-15)
