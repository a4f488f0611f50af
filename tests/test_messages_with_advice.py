"""What is said to those who ask in a way that has no answer: it names what is wrong and what to write instead."""

from __future__ import annotations

from pathlib import Path

import pytest

from command import run
from kurbel.machine_file import loads
from schemas import whole_schema

pytestmark = pytest.mark.usefixtures("solved_once")

CONFIGS = Path(__file__).parent.parent / "configs"
ONE, TWO = str(CONFIGS / "waterworks.yaml"), str(CONFIGS / "waterworks-two-cranks.yaml")
NAMED, FOUR = str(CONFIGS / "compressor-two-stage.yaml"), str(CONFIGS / "four-in-line.yaml")


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("forces", ONE, "--set", "crank=["), "close the '[' or '{' that is open"),
        (("forces", TWO, "--set", "cylinders.-1.crank=3 m"), "its items are 0 to 1: write cylinders.1.crank=…"),
        (("forces", TWO, "--set", "cylinders.-2.crank=3 m"), "its items are 0 to 1: write cylinders.0.crank=…"),
        (("forces", TWO, "--set", "cylinders.7.crank=3 m"), "its items are 0 to 1: write cylinders.1.crank=…"),
        (
            ("forces", NAMED, "--set", "cylinders.low pressure.stroke=3 m"),
            "its items are 0 to 1: write cylinders.0.stroke=…",
        ),
        (
            ("forces", NAMED, "--set", "cylinders.high pressure.stroke=3 m"),
            "its items are 0 to 1: write cylinders.1.stroke=…",
        ),
        (
            ("sweep", NAMED, "--vary", "cylinders.low pressure.stroke=3,4 m"),
            "its items are 0 to 1: write cylinders.0.stroke=…",
        ),
        (
            ("forces", NAMED, "--uncertainty", "cylinders.low pressure.stroke=1 mm"),
            "no value stands under this key in the file; did you mean 'cylinders.0.stroke'?",
        ),
        (
            ("forces", NAMED, "--uncertainty", "stroke=1 mm"),
            "no value stands under this key in the file; did you mean 'cylinders.0.stroke'?",
        ),
        (
            ("sweep", NAMED, "--vary", "suction=0,1 bar"),
            "suction: does not belong here; it belongs under 'cylinders.0.indicator.head_end.compressor'",
        ),
        (
            ("forces", NAMED, "--set", "cylinders.1.suction=1 bar"),
            "cylinders[1].suction: does not belong here; it belongs under 'indicator.head_end.compressor'",
        ),
        (
            ("forces", FOUR, "--set", "suction=1 bar"),
            "it belongs under 'cylinders.each.indicator.head_end.compressor'",
        ),
        (("keys", ""), "no key is named; 'kurbel keys' without one lists them all"),
        (("keys", "."), "no key is named"),
    ],
)
def test_what_to_write_instead(words: tuple[str, ...], says: str) -> None:
    result = run(*words)
    assert (result.exit_code, says in result.stderr) == (2, True), result.stderr


@pytest.mark.parametrize(("load", "says"), [(150, "50 N m less resistance"), (50, "50 N m more resistance")])
def test_a_resistance_of_another_mean(load: int, says: str) -> None:
    text = (
        "speed: 60 rpm\nflywheel: {inertia: 10 kg m2}\n"
        "effort: {unit: N m, points: [[0, 0], [180, 200], [360, 0]]}\n"
        f"load: {{unit: N m, points: [[0, {load}], [360, {load}]]}}\n"
    )
    assert says in run("flywheel", "-", "--key-values", text=text).stdout


@pytest.mark.parametrize(
    ("length", "metres"),
    [("10/3.5 m", 10 / 3.5), ("10/3 m", 10 / 3), ("7.5 / 2.5 m", 3.0), ("120 1/2 in", 3.0607), ("1e1/4 m", 2.5)],
)
def test_quotients_before_a_unit(length: str, metres: float) -> None:
    text = f"crank: 100 mm\nrod: {length}\n"
    (cylinder,) = loads(text).cylinders
    assert cylinder.mechanism.rod == pytest.approx(metres, rel=1e-15)
    jsonschema = pytest.importorskip("jsonschema")
    jsonschema.Draft7Validator(whole_schema()).validate({"crank": "100 mm", "rod": length})
