"""The oil film as a user meets it: tables, warnings, limits, first page, what is left out."""

import json

import pytest

from command import run
from representative import CONFIGS

ENGINE = CONFIGS["gas-engine"].read_text("utf-8")
FILM = ("film_thickness_min", "eccentricity_max", "film_pressure_max", "film_loss", "side_flow")


def output(*words: str, text: str = ENGINE) -> str:
    return str(run(*words, text=text).stdout)


def test_lengths_of_the_film_are_in_micrometres_for_people_and_in_metres_for_programs() -> None:
    shown = output("bearings", "-", "--cylinder", "crank pin")
    assert "h_0,min   13.10    µm         at 282.05°" in shown
    rows = output("bearings", "-", "--cylinder", "crank pin", "--step", "360", "-f", "csv")
    assert "film_thickness_m" in rows.splitlines()[0]
    parts = json.loads(output("bearings", "-", "-f", "json"))["bearings"]
    for part in parts:
        assert {value["id"] for value in part["key_values"]} >= set(FILM)


def test_units_of_inches_and_ascii() -> None:
    shown = output("bearings", "-", "--cylinder", "crank pin", "--units", "imperial")
    assert "h_0,min" in shown
    assert " in " in shown
    assert "13.10" in output("bearings", "-", "--cylinder", "crank pin", "--units", "technical")


def test_a_limit_is_a_minimum_and_holds_for_every_bearing() -> None:
    result = run("check", "-", text=ENGINE.replace("film_thickness_min: 3 um", "h_0,min: 5 um"))
    assert result.exit_code == 1
    assert "3.11669075 µm < 5 µm  FAIL  (crosshead pin)" in result.stdout
    assert "13.0979972 µm ≥ 5 µm  PASS  (crank pin)" in result.stdout


def test_the_first_page_has_the_thinnest_film() -> None:
    page = output("report", "-")
    assert "Thinnest oil film" in page
    assert "Path of the journal in its shell" in page


THIN = ENGINE.replace("viscosity: 30 mPa s", "viscosity: 2 mPa s")
WARNINGS = [
    (THIN, "thinner than any computed one that is known to run well (big ends 2 to 4 µm"),
    (
        ENGINE.replace("crank_pin: {clearance: 0.1 mm}", "crank_pin: {clearance: 1 mm}"),
        "a radial clearance of 1 mm makes 2c/D = 1/105; usual is about 1/1000",
    ),
    (
        ENGINE.replace(
            "journals: {clearance: 0.1 mm}", "journals: {clearance: 0.1 mm, length: 20 mm}"
        ),
        "L/D = 0.1 of a land is not within 1/8 to 1.6",
    ),
    (
        ENGINE.replace("bore: 400 mm", "bore: 650 mm").replace(
            "allowable_bending", "bearing_metal: white-metal\n  allowable_bending"
        ),
        "crank pin: a load of 22.1 N/mm² over d l is more than the guidance limit of tin white",
    ),
]


@pytest.mark.parametrize(("text", "warning"), WARNINGS)
def test_warnings(text: str, warning: str) -> None:
    assert warning in " ".join(output("check", "-", text=text).split())


def test_a_warning_is_with_the_loads_as_well() -> None:
    text, warning = WARNINGS[0]
    assert warning in " ".join(output("bearings", "-", "--step", "360", text=text).split())


def test_the_shipped_engine_has_no_warning_on_its_film() -> None:
    shown = output("check", "-")
    assert "oil film of crank pin, crosshead pin, bearing A, bearing B" in shown
    assert "\n  oil film" not in shown


def test_what_is_left_out_is_reported() -> None:
    still = ENGINE.replace("speed: 200 rpm\n", "")
    assert "oil film       no speed given" in output("bearings", "-", text=still)
    assert "oil film of crank pin: no speed given" in output("check", "-", text=still)
    sizeless = ENGINE.replace(", diameter: 120 mm, length: 150 mm", "")
    assert "oil film of crosshead pin: no diameter and length given" in output(
        "check", "-", text=sizeless
    )


def test_a_machine_without_the_key_is_searched_in_vain() -> None:
    result = run(
        "sweep", str(CONFIGS["waterworks"]), "--vary", "rod_ratio=4,5", "--columns", "h_0,min"
    )
    assert result.exit_code == 2
    assert "this machine has no h_0,min" in result.stderr
