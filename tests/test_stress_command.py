"""`kurbel stress` and what `kurbel check` says of a crankshaft, as a user calls them."""

from __future__ import annotations

import csv
import io
import json
import math
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kurbel.cli import kurbel

pytestmark = pytest.mark.usefixtures("solved_once")
ENGINE = (Path(__file__).parents[1] / "configs" / "gas-engine.yaml").read_text("utf-8")
EXACT_ROD = ENGINE.replace("share: 0.4", "center_of_gravity: 900 mm, inertia: 60 kg m2")
PLACES = [
    *(("pin", place) for place in ("middle", "at_web_A", "at_web_B")),
    *((web, place) for web in ("web_A", "web_B") for place in ("wide_face", "narrow_face", "corner")),
    *(("journal_A", "at_web"), ("journal_B", "at_web"), ("journal_B", "in_bearing")),
]


def run(*arguments: str, file: str = ENGINE) -> Result:
    return CliRunner().invoke(kurbel, list(arguments), input=file)


def without(*keys: str) -> str:
    return "".join(line for line in ENGINE.splitlines(True) if line.strip().split(":")[0] not in keys)


def test_text_lists_every_place_in_three_tables() -> None:
    text = run("stress", "-", "--step", "90").stdout
    titles = ["Dead centre", "Position of the largest torque", "Whole cycle"]
    places = [text.index(title) for title in titles]
    assert places == sorted(places)
    for name in ("wide face", "narrow face", "corner"):
        assert text.count(name) == 6
    assert text.count("journal B  at web") == 3
    assert "Key values" in text


def test_json() -> None:
    result = json.loads(run("stress", "-", "-f", "json", "--step", "45").stdout)
    columns = {column["id"]: column for column in result["machine_columns"]}
    assert columns["phi"]["values"][:2] == [0, 45]
    assert columns["phi"]["values"][-1] == 720
    assert {len(column["values"]) for column in columns.values()} == {17}
    values = {value["id"]: value for value in result["machine_key_values"]}
    assert max(columns["sigma_web_B"]["values"]) <= values["sigma_web_B_max"]["value"]
    assert values["sigma_web_B_max"]["unit"] == "Pa"
    assert 0 < values["sigma_web_B_max"]["at_deg"] < 90
    assert values["equilibrium_residual"]["value"] <= 1e-14
    dead_centre, torque, worst = result["machine_place_tables"]
    ids = [table["id"] for table in (dead_centre, torque, worst)]
    assert ids == ["dead_centre", "largest_torque", "largest_stress"]
    assert [(row["part"], row["place"]) for row in dead_centre["rows"]] == PLACES
    combined = next(column["values"] for column in worst["columns"] if column["id"] == "combined")
    assert max(combined[:3]) == pytest.approx(values["sigma_pin_max"]["value"], rel=1e-14)
    assert max(combined[3:6]) == pytest.approx(values["sigma_web_A_max"]["value"], rel=1e-14)
    assert "cylinders" not in result


def test_csv_over_the_crank_angle_and_by_place() -> None:
    rows = list(csv.DictReader(io.StringIO(run("stress", "-", "-f", "csv", "--angles", "0,35").stdout)))
    assert [row["phi_deg"] for row in rows] == ["0", "35"]
    pull = 0.6 * 260 * 0.3 * (200 * math.pi / 30) ** 2  # of the connecting rod's turning part
    assert float(rows[0]["D_N"]) - pull == pytest.approx(float(rows[0]["A_D_N"]) * 2, rel=1e-12)
    rows = list(csv.DictReader(io.StringIO(run("stress", "-", "--places", "-f", "csv").stdout)))
    assert [(row["part"], row["place"]) for row in rows] == PLACES * 3
    assert rows[0]["compression_Pa"] == ""
    assert float(rows[3]["torsion_Pa"]) > 0


def test_markdown_and_units() -> None:
    text = run("stress", "-", "--places", "-f", "markdown", "--units", "technical").stdout
    assert "| part | place | φ (°) | σ\\_c (kgf/cm²) |" in text
    assert "| web A | wide face |" in text


def test_columns() -> None:
    result = run("stress", "-", "--columns", "B_T,sigma_pin", "-f", "csv", "--angles", "0")
    assert result.stdout.splitlines()[0] == "phi_deg,B_T_N,sigma_pin_Pa"
    refused = run("stress", "-", "--columns", "P")
    assert refused.exit_code == 2
    assert "'P' is no column of kurbel stress" in refused.stderr


def test_what_is_not_given_is_left_out_by_name() -> None:
    text = run(
        "stress", "-", "--step", "90", file=without("inclination", "journal_diameter", "allowable_bending", "speed")
    ).stdout
    left_out = text.partition("Left out")[2]
    for what in ("flywheel weight", "journals", "safety", "p_m v", "α₀ of the webs"):
        assert what in left_out
    assert "journal A" not in text.partition("Left out")[0]


@pytest.mark.parametrize(
    ("file", "message"),
    [
        (ENGINE.partition("crankshaft:")[0], "no 'crankshaft' is given"),
        (ENGINE.partition("indicator:")[0] + ENGINE[ENGINE.index("masses:") :], "no pressure loads the crankshaft"),
        (
            ENGINE.replace("web_width: 250 mm", "web_width: 1e-150 mm").replace("140 mm", "1e-160 mm"),
            "1e-160 mm is too small",
        ),
        (ENGINE.replace("210 mm", "1e-200 mm").replace("160 mm", "1e-200 mm"), "1e-200 mm is too small"),
        (ENGINE.replace("200 rpm", "1e170 rpm"), "1e170 rpm is too large"),
        (EXACT_ROD.replace("200 rpm", "1e170 rpm"), "1e170 rpm is too large"),
        (ENGINE.replace("pin_length: 160 mm", "pin_length: 400 mm"), "400 mm does not fit between the webs"),
        (ENGINE.replace("journal_length: 320 mm", "journal_length: 5 m"), "half of 5000 mm does not fit between"),
    ],
)
def test_refused_with_a_message(file: str, message: str) -> None:
    result = run("stress", "-", file=file)
    assert result.exit_code == 2
    assert message in result.stderr
    assert "Traceback" not in result.stderr


def test_turning_part_of_the_rod_is_told() -> None:
    """Once: the D of an exact rod has it already."""
    shared, exact = (json.loads(run("stress", "-", "-f", "json", file=file).stdout) for file in (ENGINE, EXACT_ROD))
    values = {value["id"]: value["value"] for value in shared["machine_key_values"]}
    assert values["C_rod"] == pytest.approx(0.6 * 260 * 0.3 * (200 * math.pi / 30) ** 2, rel=1e-14)
    assert "C_rod" not in {value["id"] for value in exact["machine_key_values"]}


def test_limits_work_on_strength() -> None:
    broken = run(
        "check", "-", file=ENGINE.replace("safety_pin_min: 1", "safety_pin_min: 1.5\n  sigma_web_B_max: 20 N/mm2")
    )
    assert broken.exit_code == 1
    assert "safety_pin_min" in broken.stdout
    assert (broken.stdout.count("BROKEN"), "kept" in broken.stdout) == (2, True)


def test_limits_of_a_machine_without_crankshaft_name_the_reason() -> None:
    result = run("check", "-", file=ENGINE.partition("crankshaft:")[0] + "limits: {sigma_pin_max: 60 N/mm2}\n")
    assert result.exit_code == 2
    assert "no 'crankshaft' is given" in result.stderr


def test_check_tells_what_of_the_crankshaft_is_left_out() -> None:
    text = run("check", "-", file=without("inclination").partition("limits:")[0]).stdout
    assert "flywheel weight: no inclination given" in text


def test_ascii() -> None:
    invoked = CliRunner(charset="ascii").invoke(kurbel, ["stress", "-", "--places"], input=ENGINE.encode())
    assert invoked.exit_code == 0
    assert "sigma_res  sigma_v" in invoked.stdout
    assert "carry D less C_rod" in invoked.stdout
    assert "?" not in invoked.stdout
