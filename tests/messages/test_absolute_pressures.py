"""Pressures that a file gives as absolute are shown, searched and limited as absolute; what depends on them is not."""

import csv
import math

import pytest

from command import answer, printed
from kurbel.errors import MachineFileError
from kurbel.machine_file import loads
from kurbel.solver.case import Case

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


def test_programs_are_informed_too() -> None:
    (head, *_) = csv.reader(
        printed(
            "forces", "-", "--columns", "p_head", "--angles", "90", "-f", "csv", text=ABSOLUTE
        ).splitlines()
    )
    assert head == ["phi_deg", "p_head_Pa_abs"]
    parsed = answer("forces", "-", "--columns", "p_head", "--angles", "90", text=ABSOLUTE)[
        "cylinders"
    ][0]
    assert parsed["columns"][1]["unit"] == "Pa abs"
    assert parsed["columns"][1]["values"] == pytest.approx([1e5], rel=1e-15)
    (p_max,) = (key_value for key_value in parsed["key_values"] if key_value["id"] == "p_max")
    assert (p_max["unit"], p_max["value"]) == ("Pa abs", pytest.approx(7e5, rel=1e-15))
    assert Case(loads(ABSOLUTE)).cylinders[0]["p_max"].unit == "Pa abs"


def test_forces_and_differences_hang_on_no_zero() -> None:
    """p_i is the work over the swept volume, P the difference of two pressures: 6 bar on the driven stroke."""
    absolute, gauge = (Case(loads(text)).cylinders[0] for text in (ABSOLUTE, GAUGE))
    assert absolute.mean_pressure == pytest.approx(-6e5, rel=1e-12)
    assert absolute["mean_pressure"].unit == "Pa"
    by_gauge, by_absolute = (one.at([90.0, 270.0]).P for one in (gauge, absolute))
    assert by_absolute == pytest.approx(by_gauge, rel=1e-9)


def test_places_count_as_the_file_does() -> None:
    result = printed(
        "forces",
        "-",
        "--where",
        "p_head = 7 bar",
        "--columns",
        "p_head",
        "-f",
        "csv",
        text=ABSOLUTE,
    )
    assert float(result.splitlines()[1].split(",")[1]) == pytest.approx(7e5, rel=1e-15)


# units that say which zero they have, of ISO 80000-4 and of DIN 1314 before 1977

PSI, AT = 0.45359237 * 9.80665 / 0.0254**2, 98066.5
ZEROED = {
    "psia": ("absolute", PSI),
    "psig": ("gauge", PSI),
    "bara": ("absolute", 1e5),
    "barg": ("gauge", 1e5),
    "ata": ("absolute", AT),
    "atü": ("gauge", AT),
}
SINGLE_ACTING = "crank: 400 mm\nrod: 2 m\nbore: 450 mm\nambient: 1 bar\n"
FORMS = [
    "head_end: 5 %s",
    "head_end: {constant: {expansion: 5 %s, compression: 5 %s}}",
    "head_end: {unit: %s, expansion: [[0, 5], [1, 5]], compression: [[1, 5], [0, 5]]}",
    "head_end: {trace: {unit: %s, points: [[0, 5], [180, 5], [360, 5]]}}",
]


def written_in(unit: str, counted: str, form: str) -> str:
    return f"{SINGLE_ACTING}indicator: {{pressures: {counted}, {form.replace('%s', unit)}}}\n"


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("unit", ZEROED)
def test_units_that_say_which_zero_they_have(unit: str, form: str) -> None:
    """5 units on the piston, against 1 bar outside where they count from the vacuum."""
    counted, size = ZEROED[unit]
    (cylinder,) = Case(loads(written_in(unit, counted, form))).cylinders
    over = 5 * size - (1e5 if counted == "absolute" else 0)
    assert cylinder.at([90.0]).P[0] == pytest.approx(over * math.pi / 4 * 0.45**2, rel=1e-12)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("unit", ZEROED)
def test_units_that_say_another_zero_than_the_machine_are_refused(unit: str, form: str) -> None:
    """Both readings are shown: the unit of the machine's zero, or the zero of the unit."""
    counted = ZEROED[unit][0]
    with pytest.raises(MachineFileError) as caught:
        loads(written_in(unit, "gauge" if counted == "absolute" else "absolute", form))
    assert f"'pressures: {counted}'" in str(caught.value)
    assert unit in str(caught.value)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("unit", ZEROED)
def test_units_that_all_name_their_zero_need_no_key(unit: str, form: str) -> None:
    counted, size = ZEROED[unit]
    text = written_in(unit, counted, form).replace(f"pressures: {counted}, ", "")
    (cylinder,) = Case(loads(text)).cylinders
    over = 5 * size - (1e5 if counted == "absolute" else 0)
    assert cylinder.at([90.0]).P[0] == pytest.approx(over * math.pi / 4 * 0.45**2, rel=1e-12)


def test_units_of_which_one_does_not_name_its_zero_are_refused() -> None:
    """Of 5 bara and 1 bar the second may be either."""
    with pytest.raises(MachineFileError) as caught:
        loads(
            f"{SINGLE_ACTING}indicator: {{head_end: {{constant: {{expansion: 5 bara, compression: 1 bar}}}}}}"
        )
    assert "'pressures: absolute'" in str(caught.value)
