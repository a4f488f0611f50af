"""Units by their definitions, and what is said about texts that are no quantity."""

from pathlib import Path

import pytest

from command import run
from kurbel.declared.unit_systems import SI, SYSTEMS, shown_unit
from kurbel.declared.units import (
    KINDS,
    Kind,
    kinds,
    listed_units,
    parse_quantity,
    unit_factor,
    unit_names,
)
from kurbel.errors import UnitError
from representative import CONFIGS, case_of, law_of_each

G = 9.80665  # m/s², standard gravity by definition (3rd CGPM 1901)


UNITS = Path(__file__).with_name("units.txt").read_text("utf-8").splitlines()


@law_of_each(tuple(line.split(" | ")[:3]) for line in UNITS if line[0] != "#")
def test_values_by_definition_and_what_is_written_of_other_texts(
    text: str, kind: str, value: str
) -> None:
    mark, _, said = value.partition(" ")
    if mark in ("!", "…"):
        with pytest.raises(UnitError) as caught:
            parse_quantity(text, kind)
        assert str(caught.value) == said if mark == "!" else said in str(caught.value)
    else:
        wanted = float(said or mark)
        assert parse_quantity(text, kind) == (
            pytest.approx(wanted, rel=1e-15, abs=0) if mark == "≈" else wanted
        )


@law_of_each(kind for kind in SI if kind != "ratio")
def test_every_unit_has_a_factor(kind: str) -> None:
    for unit in unit_names(kind):
        up, down = unit_factor(unit, kind)
        assert up > 0
        assert down > 0


def test_a_unit_without_a_factor_reports_where_it_is_added(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(KINDS, "wear", Kind(0, 1, "m/h, furlong/h", "m/h"))
    assert unit_factor("m/h", "wear") == (1, 3600)
    with pytest.raises(
        LookupError, match=r"'furlong' .* add its multiplier and divisor to _FACTORS"
    ):
        unit_factor("furlong/h", "wear")


def test_products_that_nobody_writes_are_read_but_not_listed() -> None:
    listed = [unit for kind in kinds() for unit in listed_units(kind)]
    for unit in ("kN/in2", "um/h", "tf ft", "t ft2", "mg ft", "lbf mm", "m/mmHg", "mmHg/deg"):
        assert unit not in listed
    for unit in ("kN/cm2", "m/s", "m/s2", "km/h", "lbf ft", "lb ft2", "g mm", "in/psi", "mm/at"):
        assert unit in listed
    assert parse_quantity("1 kN/in2", "stress") == pytest.approx(1e3 / 0.0254**2, rel=1e-15)
    assert parse_quantity("3600 um/h", "velocity") == pytest.approx(1e-6, rel=1e-15)


@law_of_each(kind for kind in SI if kind != "ratio")
def test_every_shown_unit_can_be_read_back(kind: str) -> None:
    for units in (system[kind] for system in SYSTEMS.values()):
        for unit in (units,) if isinstance(units, str) else units:
            assert parse_quantity(f"1 {unit}", kind) > 0


def test_the_size_chooses_among_metric_units() -> None:
    results = [shown_unit("length", "metric", size) for size in (0.0, 0.4, 9.9, 12.0)]
    assert results == ["mm", "mm", "mm", "m"]
    assert [shown_unit("pressure", "metric", size) for size in (50.0, -931632.0)] == ["mbar", "bar"]
    assert [shown_unit("force", "metric", size) for size in (999.0, 1e3, -2e6)] == ["N", "kN", "MN"]
    assert [shown_unit("force", system, 1e9) for system in ("si", "technical", "imperial")] == [
        "N",
        "kgf",
        "lbf",
    ]


@pytest.mark.parametrize(
    ("words", "length", "metres", "force", "newtons"),
    [
        ((), "mm", 1e-3, "kN", 1e3),
        (("--units", "technical"), "mm", 1e-3, "kgf", G),
        (("--units", "imperial"), "in", 0.0254, "lbf", 0.45359237 * G),
        (("--units", "si"), "m", 1.0, "N", 1.0),
        (("-f", "json"), "mm", 1e-3, "kN", 1e3),
    ],
)
def test_messages_are_written_in_the_units_requested(
    words: tuple[str, ...], length: str, metres: float, force: str, newtons: float
) -> None:
    machine = CONFIGS["waterworks"]
    largest = case_of("waterworks").cylinders[0]["P_max"].value
    for condition, expected, unit in (
        ("x = 9 m", 0.8 / metres, length),
        ("P = 9 MN", largest / newtons, force),
    ):
        result = run("forces", machine, "--where", condition, *words)
        assert result.exit_code == 3
        number, reported = result.stderr.strip().rpartition(" to ")[2].split()
        assert (float(number), reported) == (pytest.approx(expected, rel=1e-5), unit)
