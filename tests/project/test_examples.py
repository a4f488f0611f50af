"""The machines that come with kurbel: each runs through every command that fits it, and keeps the figures it claims."""

from collections.abc import Callable
from pathlib import Path

import pytest

from command import run
from kurbel.cli import COMMANDS
from kurbel.machine import Machine
from kurbel.machine_file import load
from representative import SHIPPED, few

FITS: dict[str, Callable[[Machine], bool]] = {
    "check": lambda machine: True,
    "motion": lambda machine: bool(machine.cylinders),
    "forces": lambda machine: bool(machine.cylinders),
    "flywheel": lambda machine: True,
    "stress": lambda machine: machine.crankshaft is not None,
    "balance": lambda machine: (
        any(cylinder.masses for cylinder in machine.cylinders)
        and not any(cylinder.mechanism.quick_return for cylinder in machine.cylinders)
    ),
}


EACH = [(command, path) for command in FITS if command in COMMANDS for path in SHIPPED]
FEW = [
    *(
        ("check", name)
        for name in ("waterworks", "punch", "marine-diesel", "coupled-axle", "scotch-yoke-pump")
    ),
    *(
        ("motion", "shaper"),
        ("forces", "crank-rocker"),
        ("flywheel", "waterworks"),
        ("stress", "gas-engine"),
    ),
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
    result = run(command, path)
    assert (result.exit_code, result.stderr) == (0, "")
    assert "nan" not in result.stdout
    assert len(result.stdout.splitlines()) > 5
