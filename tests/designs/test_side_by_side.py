"""Many machines at once answer as each alone: those of books and those that are shipped, with numbers that vary."""

import math
import re
from pathlib import Path
from typing import Any
from zlib import crc32

import numpy as np
import pytest

import kurbel
from kurbel import sweep
from kurbel.machine_file.source import read
from representative import SHIPPED, few
from swept_rows import CONFIGS, EXAMPLES, numbers_in

MOVING = re.compile(r"(.*\.)?(crank|stroke)")
FILES = [
    path
    for path in (*SHIPPED, *EXAMPLES)
    if any(MOVING.fullmatch(key) for key, *_ in numbers_in(read(path)))
]


def distance(found: Any, single: Any, name: str) -> float:
    """By how much two answers differ beside their size, inf for other kinds of answers; angles in turns."""
    if isinstance(single, tuple):
        pairs = zip(found, single) if len(found) == len(single) else [(0.0, math.inf)]
        return max((abs(a - b) / 360 for a, b in pairs), default=0.0)
    if single is None or single != single:  # a list that is not there, or a number
        return 0.0 if found is None or found != found else math.inf
    if not isinstance(single, float):
        return 0.0 if found == single else math.inf
    return float(abs(found - single) / (360 if name.endswith("_at") else abs(single) or 1))


def farthest(file: Path, inputs: dict[str, list[str]], columns: list[str]) -> tuple[float, str]:
    """The largest distance of what five rows answer together, and each by itself, and of which column."""
    together, worst = sweep(file, inputs, columns, with_angles=True), (0.0, "")
    answers = [(name, values) for name, values in together.items() if not name.endswith("residual")]
    for row in range(5):
        alone = sweep(
            file, {key: [texts[row]] for key, texts in inputs.items()}, columns, with_angles=True
        )
        worst = max(
            worst,
            *((distance(values[row], alone[name][0], name), name) for name, values in answers),
        )
    return worst


@pytest.mark.parametrize("file", few(FILES, FILES[::6], [path.stem for path in FILES]))
def test_numbers_of_a_file_vary(file: Path) -> None:
    """Up to four of them by a tenth, all that `forces` prints, and where a row fails, why."""
    random = np.random.default_rng(crc32(file.stem.encode()))
    keys = numbers_in(read(file))
    chosen = [keys[place] for place in random.permutation(len(keys))[:4]]
    inputs = {
        key: [f"{value * by:.9g} {unit}".strip() for by in random.uniform(0.9, 1.1, 5)]
        for key, value, unit in chosen
    }
    assert farthest(file, inputs, []) <= (1e-12, "~")


SPEEDS = [f"{speed} rpm" for speed in (237, 243, 251, 259, 263)]
GAS = "mass_flow isentropic_power discharge_temperature capacity_normal"
FLOWS = "flow_mean flow_max volume_fluctuation vessel_swing suction_lift_max acceleration_head_max"
STRESSES = "sigma_pin_max sigma_web_A_max safety_pin_min load_max load_mean unloaded_arc"
OTHER_COMMANDS = [
    ("gas-engine", "speed", SPEEDS, f"dE M_max {STRESSES} F_free_max"),
    (
        "four-cylinder-generator",
        "speed",
        SPEEDS,
        "dE delta J omega_max alpha_max M_max E_max work_shaft",
    ),
    ("four-in-line", "speed", SPEEDS, "F_free_max F_free_best M_free_max M_roll_max"),
    (
        "locomotive-two-cylinders",
        "speed",
        SPEEDS,
        "hammer_blow swaying_couple traction_variation F_free_best",
    ),
    ("waterworks", "speed", SPEEDS, "piston.power pump.power power"),
    ("generator-coupling", "speed", SPEEDS, "delta M_coupling_max amplification natural_order"),
    ("triplex-pump", "speed", ["50 rpm", "60 rpm", "70 rpm", "80 rpm", "90 rpm"], FLOWS),
    (
        "triplex-pump",
        "cylinders.each.bore",
        [f"{bore} mm" for bore in (76, 78, 80, 82, 84)],
        f"{FLOWS} work dE",
    ),
    ("compressor-two-stage", "gas.isentropic_exponent", ["1.3", "1.35", "1.4", "1.45", "1.5"], GAS),
    (
        "compressor-two-stage",
        "gas.molar_mass",
        [f"{mass} g/mol" for mass in (28, 28.5, 29, 29.5, 30)],
        GAS,
    ),
    (
        "compressor-two-stage",
        "gas.inlet_temperature",
        [f"{warm} °C" for warm in (10, 15, 20, 25, 30)],
        GAS,
    ),
    (
        "scotch-yoke-pump",
        "friction.block",
        ["0", "0.03", "0.07", "0.1", "0.2"],
        "work_block loss_guides T_max dE",
    ),
]
"""Key values of flywheel, stress, bearings, balance, delivery, single pistons; of a gas with arrays of numbers, too."""


@pytest.mark.parametrize(("name", "key", "values", "columns"), OTHER_COMMANDS)
def test_key_values_of_other_commands(name: str, key: str, values: list[str], columns: str) -> None:
    assert farthest(CONFIGS[name], {key: values}, columns.split()) <= (1e-11, "~")


def test_one_that_locks_itself_fails_among_others_with_the_reason_that_it_has_alone(
    tmp_path: Path,
) -> None:
    file = tmp_path / "steam.yaml"
    machine = CONFIGS["waterworks"].read_text("utf-8").replace("crosshead: 0.1", "crosshead: 2")
    file.write_text(f"{machine}\ninclination: 0 deg\n", encoding="utf-8")
    inputs = {"rod_ratio": ["1.5", "2.2", "2.3", "3", "5"]}
    assert "locks itself near φ" in sweep(file, inputs)["failure"][0]
    assert farthest(file, inputs, []) <= (1e-12, "~")


def test_flywheels_on_both_sides_of_their_bearing(tmp_path: Path) -> None:
    """Other places of the shaft are examined beyond bearing B and before it."""
    lines = (
        CONFIGS["gas-engine"].read_text("utf-8").partition("limits:")[0].splitlines(keepends=True)
    )
    file = tmp_path / "engine.yaml"
    text = "".join(line for line in lines if "journal_length" not in line)
    file.write_text(text.replace("flywheel_mass: 4 t", "flywheel_mass: 400 t"), encoding="utf-8")
    inputs = {"crankshaft.flywheel_position": ["450 mm", "300 mm", "-100 mm", "-120 mm", "200 mm"]}
    assert farthest(file, inputs, ["sigma_journal_B_max", "mises_journal_B_max"]) <= (1e-12, "~")


def test_a_crosshead_that_locks_itself_has_no_forces_among_others() -> None:
    """f tan ψ ≥ 1 with f = 0.1 where R/L ≥ 1/√(1 + f²), L/R ≤ 1.00499."""
    result = sweep(
        CONFIGS["waterworks"], {"rod_ratio": ["1.002", "1.003", "1.004", "1.006", "5"]}, "S_max"
    )
    assert ["locks itself" in why for why in result["failure"]] == [True, True, True, False, False]
    assert np.isnan(result["S_max"]).tolist() == [True, True, True, False, False]


@pytest.mark.parametrize(
    "mechanism",
    [
        "mechanism: slotted-lever, frame: 800 mm, lever: 1300 mm",
        "mechanism: four-bar, coupler: 900 mm, rocker: 600 mm, frame: 800 mm",
    ],
)
def test_lengths_of_one_of_several_mechanisms_vary(mechanism: str) -> None:
    """The dead centres of these have formulas for a single machine: each row is that of its machine alone."""
    acting = "ram_force: {work: 6 kN, return: 0.6 kN}"
    if "four-bar" in mechanism:
        acting = "moment: {work: 900 N m, return: 200 N m}"
    text = (
        "kurbel: 1\nspeed: 40 rpm\ncylinders:\n"
        f"  - {{{mechanism}, crank: 300 mm, {acting}}}\n"
        f"  - {{{mechanism}, crank: 300 mm, {acting}, crank_position: 90 deg}}\n"
    )
    key = "cylinders.0.crank"
    swept = kurbel.sweep(kurbel.loads(text), {key: ["250 mm", "280 mm", "290 mm"]}, "M_max")
    for row, crank in enumerate(["250 mm", "280 mm", "290 mm"]):
        alone = kurbel.sweep(kurbel.loads(text), {key: [crank]}, "M_max")
        assert swept["M_max"][row] == alone["M_max"][0]
