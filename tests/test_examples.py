"""The machines that come with kurbel: each runs through every command that fits it, and keeps the figures it claims."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from kurbel.cli import COMMANDS, kurbel
from kurbel.machine import Machine
from kurbel.machine_file import load
from representative import SHIPPED, few

pytestmark = pytest.mark.usefixtures("solved_once")
FITS: dict[str, Callable[[Machine], bool]] = {
    "check": lambda machine: True,
    "motion": lambda machine: bool(machine.cylinders),
    "forces": lambda machine: bool(machine.cylinders),
    "flywheel": lambda machine: True,
    "stress": lambda machine: machine.crankshaft is not None,
    "balance": lambda machine: (
        any(one.masses for one in machine.cylinders)
        and not any(one.mechanism.quick_return for one in machine.cylinders)
    ),
}
MECHANISM_OF = {
    "shaper": "slotted-lever",
    "crank-rocker": "four-bar",
    "scotch-yoke-pump": "scotch-yoke",
    "coupled-axle": "parallel-crank",
    "yoke-frame-pump": "yoke-frame",
    "offset-engine": "slider-crank",
}


def answer(command: str, name: str, *more: str) -> dict[str, Any]:
    path = next(path for path in SHIPPED if path.stem == name)
    result = CliRunner().invoke(kurbel, [command, str(path), "-f", "json", *more])
    assert result.exit_code == 0, result.output
    parsed: dict[str, Any] = json.loads(result.stdout)
    return parsed


def key_values(parsed: dict[str, Any]) -> dict[str, dict[str, Any]]:
    return {one["id"]: one for one in parsed["cylinders"][0]["key_values"]}


def column(parsed: dict[str, Any], name: str) -> list[float]:
    return next(one["values"] for one in parsed["cylinders"][0]["columns"] if one["id"] == name)


EACH = [(command, path) for command in FITS if command in COMMANDS for path in SHIPPED]
FEW = [
    *(("check", name) for name in ("waterworks", "punch", "marine-diesel", "coupled-axle", "scotch-yoke-pump")),
    *(("motion", "shaper"), ("forces", "crank-rocker"), ("flywheel", "waterworks"), ("stress", "gas-engine")),
    ("balance", "locomotive"),
]


@pytest.mark.parametrize(
    ("command", "path"),
    few(
        EACH,
        [(command, path) for command, path in EACH if (command, path.stem) in FEW],
        [f"{command}-{path.stem}" for command, path in EACH],
    ),
)
def test_it_runs(command: str, path: Path) -> None:
    if not FITS[command](load(path)):
        pytest.skip(f"kurbel {command} is not for this machine")
    result = CliRunner().invoke(kurbel, [command, str(path)])
    assert (result.exit_code, result.stderr) == (0, "")
    assert "nan" not in result.stdout
    assert len(result.stdout.splitlines()) > 5


@pytest.mark.parametrize("name", MECHANISM_OF)
def test_every_mechanism_has_its_machine(name: str) -> None:
    (cylinder,) = load(next(path for path in SHIPPED if path.stem == name)).cylinders
    assert cylinder.mechanism.name == MECHANISM_OF[name]
    assert key_values(answer("forces", name))["energy_residual"]["value"] == pytest.approx(0, abs=1e-14)


def test_the_shaper_is_that_of_khurmi() -> None:
    """Khurmi & Gupta 7.7, recalculated: time ratio 1.6480056, lever 1.1423973 rad/s cutting, 2.5132741 returning."""
    values = key_values(answer("motion", "shaper"))
    assert values["time_ratio"]["value"] == pytest.approx(1.6480056, abs=5e-8)
    assert values["theta_dot_max"]["value"] == pytest.approx(1.1423973, abs=5e-8)
    assert values["theta_dot_min"]["value"] == pytest.approx(-2.5132741, abs=5e-8)
    # printed 1.015 rad/s from a drawing, 45° from the line of the pivots
    assert column(answer("motion", "shaper", "--angles", "45"), "theta_dot")[0] == pytest.approx(
        1.01724419252, rel=1e-11
    )


def test_the_crank_rocker_is_that_of_khurmi() -> None:
    """Khurmi & Gupta 7.1, recalculated: 4.78457094752 rad/s at 60°, the rocker at 80.410279°; printed 4.8 rad/s."""
    parsed = answer("motion", "crank-rocker", "--angles", "60")
    assert column(parsed, "theta_dot")[0] == pytest.approx(4.78457094752, rel=1e-11)
    assert column(parsed, "theta")[0] == pytest.approx(80.410279, abs=5e-7)


def test_the_coupled_axle_takes_its_moment_round_the_turn() -> None:
    values = key_values(answer("forces", "coupled-axle"))
    assert values["resistance_work"]["value"] == pytest.approx(-9000 * 2 * math.pi, rel=1e-14)


def test_the_pin_of_the_scotch_yoke_keeps_the_limit_of_the_book() -> None:
    result = CliRunner().invoke(kurbel, ["check", str(next(p for p in SHIPPED if p.stem == "scotch-yoke-pump"))])
    assert "kept" in result.stdout
    assert "pin_pressure" in result.stdout
