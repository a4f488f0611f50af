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
    assert cylinder.mechanism.rod == pytest.approx(metres, rel=1e-15)  # type: ignore[attr-defined]
    jsonschema = pytest.importorskip("jsonschema")
    jsonschema.Draft7Validator(whole_schema()).validate({"crank": "100 mm", "rod": length})


@pytest.mark.parametrize("length", ["1/0 m", "1/1e-400 m", "3.5/2", "5 1/min", "/2 m", "1//2 m"])
def test_what_is_no_quotient_with_a_unit(length: str) -> None:
    result = run("check", "-", text=f"crank: 100 mm\nrod: {length}\n")
    assert (result.exit_code, ": rod: " in result.stderr) == (2, True), result.stderr


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("n: 100 rpm\ncrank: 1 m\nrod: 5 m\n", "n: unknown key; did you mean 'speed'?"),
        ("R: 1 m\nL: 5 m\n", "R: unknown key; did you mean 'crank'?"),
        ("crank: 1 m\nrod: 5 m\nflywheel: {J: 3 kg m2}\n", "flywheel.J: unknown key; did you mean 'inertia'?"),
        ("crank: 1 m\nrod: 5 m\nflywheel: {rim: {material: x}}\n", "material: unknown key; did you mean 'density'?"),
    ],
)
def test_a_symbol_of_the_books_or_another_word_names_its_key(text: str, says: str) -> None:
    result = run("check", "-", text=text)
    assert (result.exit_code, says in result.stderr) == (2, True), result.stderr
