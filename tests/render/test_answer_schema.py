"""What `-f json` prints keeps the schema that `kurbel schema --answers` hands out."""

import json
from pathlib import Path

import pytest
from jsonschema import Draft7Validator

from command import run
from kurbel.report.commands import REPORTS
from representative import CONFIGS

BROKEN = """\
name: Engine with five mistakes
speed: 50
crank: 400 mm
rod: 300 mm
boore: 450 mm
indicator: {head_end: {unit: at, expansion: [[0, 9,5], [1, 2.2]]}, crank_end: mirrord}
"""
"""A file whose check names no machine."""
MACHINES = [
    *(("motion", name) for name in ("shaper", "offset-engine")),
    *(
        ("forces", name)
        for name in ("waterworks", "diesel-trace", "coupled-axle", "waterworks-two-cranks")
    ),
    *(("flywheel", name) for name in ("punch", "coupled-blower")),
    *(("check", name) for name in ("waterworks", "compressor")),
    ("stress", "gas-engine"),
    ("bearings", "gas-engine"),
    ("balance", "boxer"),
    ("harmonics", "punch"),
    ("torsion", "torsional-damper"),
    ("delivery", "compressor-two-stage"),
    ("delivery", "triplex-pump"),
]
MACHINES += [(report.word, "waterworks") for report in REPORTS if report.word not in dict(MACHINES)]
ANSWERS = [
    ["table", "--compare"],
    ["friction", "--incline", "30", "--coefficient", "0.1"],
    *([command, str(CONFIGS[name])] for command, name in MACHINES),
    [
        "check",
        str(CONFIGS["waterworks"]),
        "--set",
        "limits.c_max=1 m/s",
        "--set",
        "expect.b_max=2 m/s2 ± 1 %",
    ],
    ["forces", str(CONFIGS["waterworks"]), "--uncertainty", "bore=0.1mm"],
]


@pytest.fixture(scope="module")
def validator() -> Draft7Validator:
    schema = json.loads(run("schema", "--answers").stdout)
    Draft7Validator.check_schema(schema)
    return Draft7Validator(schema)


@pytest.mark.parametrize("words", ANSWERS, ids=lambda words: f"{words[0]} {Path(words[1]).stem}")
def test_an_answer_keeps_the_schema(words: list[str], validator: Draft7Validator) -> None:
    ran = run(*words, "-f", "json")
    assert ran.exit_code in (0, 1)
    validator.validate(json.loads(ran.stdout))


def test_a_check_of_a_file_with_faults_keeps_it(validator: Draft7Validator) -> None:
    ran = run("check", "-", "-f", "json", text=BROKEN)
    result = json.loads(ran.stdout)
    assert (ran.exit_code, result["machine"], len(result["findings"]) >= 5) == (2, None, True)
    validator.validate(result)


def test_a_wrong_answer_does_not(validator: Draft7Validator) -> None:
    part = {"name": "one", "columns": [], "key_values": [], "left_out": [], "warnings": []}
    answer = {"kurbel": "0.1.0", "format": 1, "command": "forces", "cylinders": [part]}
    assert validator.is_valid(answer)
    assert not validator.is_valid(answer | {"format": 2})
    assert not validator.is_valid(answer | {"cylinders": [part | {"values": []}]})
    assert not validator.is_valid(answer | {"cylinders": [{"name": "one"}]})
