"""`--key-values NAMES`: ids, symbols and scoped names, in the order given, in every command and format."""

import json
import math
from pathlib import Path

import pytest

from command import answer, printed, run

CONFIGS = Path(__file__).parents[2] / "configs"
WATERWORKS = str(CONFIGS / "waterworks.yaml")
TWO_STAGES = str(CONFIGS / "compressor-two-stage.yaml")
TWO_CRANKS = str(CONFIGS / "waterworks-two-cranks.yaml")


def ids_of(part: dict[str, object], key: str = "key_values") -> list[str]:
    values = part[key]
    assert isinstance(values, list)
    return [value["id"] for value in values]


@pytest.mark.parametrize(
    "words",
    [
        ["--key-values", "T_max,c_max,N_i"],
        ["--key-values", "T_max c_max N_i"],
        ["--key-values", "T_max", "c_max", "power"],
        ["--key-values=T_max, c_max,power"],
    ],
)
@pytest.mark.parametrize("file_first", [True, False])
def test_names_in_any_way_of_writing_and_in_their_order(words: list[str], file_first: bool) -> None:
    line = [WATERWORKS, *words] if file_first else [*words, WATERWORKS]
    (cylinder,) = answer("forces", *line)["cylinders"]
    assert ids_of(cylinder) == ["T_max", "c_max", "power"]
    assert cylinder["columns"] == cylinder["left_out"] == []


def test_the_same_values_as_among_all_in_every_format() -> None:
    (every,) = answer("forces", WATERWORKS, "--key-values")["cylinders"]
    (chosen,) = answer("forces", WATERWORKS, "--key-values", "N_max P_b,max")["cylinders"]
    assert chosen["key_values"] == [
        value
        for id in ("N_max", "P_inertia_max")
        for value in every["key_values"]
        if value["id"] == id
    ]
    csv = printed("forces", WATERWORKS, "--key-values", "N_max P_b,max", "-f", "csv").splitlines()
    assert [line.split(",")[0] for line in csv] == ["key_value", "N_max", "P_inertia_max"]
    assert float(csv[1].split(",")[2]) == chosen["key_values"][0]["value"]
    markdown = printed(
        "forces", WATERWORKS, "--key-values", "N_max P_b,max", "-f", "markdown"
    ).splitlines()
    assert [line.split(" | ")[0] for line in markdown if line.startswith("| ")][2:] == [
        "| N\\_max",
        "| P\\_b,max",
    ]
    text = printed("forces", WATERWORKS, "--key-values", "N_max P_b,max").splitlines()
    assert [line.split()[0] for line in text[3:]] == ["N_max", "P_b,max"]


def test_a_scope_means_one_part() -> None:
    cylinders = answer("forces", TWO_STAGES, "--key-values", "high pressure.T_max,c_max")[
        "cylinders"
    ]
    assert {cylinder["name"]: ids_of(cylinder) for cylinder in cylinders} == {
        "low pressure": ["c_max"],
        "high pressure": ["T_max", "c_max"],
    }
    flywheel = answer("flywheel", TWO_CRANKS, "--key-values", "machine.dE", "δ")
    assert ids_of(flywheel, "machine_key_values") == ["dE", "delta"]
    (pump,) = answer("forces", WATERWORKS, "--key-values", "pump.power")["cylinders"]
    assert (pump["name"], ids_of(pump)) == ("pump", ["power"])


@pytest.mark.parametrize(
    ("command", "file", "names"),
    [
        ("motion", WATERWORKS, ["b_max", "c_max"]),
        ("stress", "gas-engine", ["P_dc"]),
        ("bearings", "gas-engine", ["load_mean", "load_max"]),
        ("balance", "locomotive-two-cylinders", ["F_free_max"]),
        ("harmonics", WATERWORKS, ["M_mean"]),
        ("torsion", "marine-diesel", ["natural_frequency"]),
        ("delivery", "triplex-pump", ["flow_max", "flow_mean"]),
        ("flywheel", TWO_CRANKS, ["delta", "J"]),
    ],
)
def test_every_command_with_key_values(command: str, file: str, names: list[str]) -> None:
    path = file if "/" in file else str(CONFIGS / f"{file}.yaml")
    result = answer(command, path, "--key-values", *names)
    parts = [*result.get("cylinders", []), *result.get("bearings", [])]
    chosen = [ids_of(part) for part in parts]
    if "machine_key_values" in result:
        chosen.append(ids_of(result, "machine_key_values"))
    assert names in chosen
    assert all(set(ids) <= set(names) for ids in chosen)


def test_a_key_value_that_is_printed_on_request_only() -> None:
    (cylinder,) = answer("forces", WATERWORKS, "--key-values", "phi_b_zero_book")["cylinders"]
    root = math.degrees(math.acos((math.sqrt(1 + 8 / 25) - 1) / (4 / 5)))  # of cos φ + 1/5 cos 2φ
    assert cylinder["key_values"][0]["value"] == pytest.approx([root, 360 - root])


def test_of_load_cases_and_of_uncertainties_these_only() -> None:
    cases = json.loads(
        run(
            "forces", "-", "--cases", "--key-values", "N_max", "-f", "json", text=WITH_CASES
        ).stdout,
    )
    (table,) = cases["cylinders"][0]["place_tables"]
    assert [column["id"] for column in table["columns"]] == ["N_max"]
    text = printed("forces", WATERWORKS, "--key-values", "T_max", "--uncertainty", "bore=0.2 mm")
    assert "T_max" in text
    assert "N_max" not in text


WITH_CASES = """
{speed: 60 rpm, crank: 100 mm, rod: 400 mm, bore: 200 mm, indicator: {head_end: 3 bar},
 cases: [{name: slow, set: {speed: 30 rpm}}, {name: fast, set: {speed: 90 rpm}}]}
"""
