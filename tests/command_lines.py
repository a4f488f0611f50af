"""A short run of every command."""

from __future__ import annotations

from pathlib import Path

from kurbel.cli import COMMANDS

_CONFIGS = Path(__file__).parent.parent / "configs"
_WITHOUT_FILE = ("table", "friction", "example", "keys", "units", "schema")
_MACHINES = {"stress": "gas-engine", "torsion": "marine-diesel"}
_OPTIONS = {
    "accuracy": ["--quick"],
    "forces": ["--key-values"],
    "sweep": ["--vary", "rod_ratio=4,5", "--columns", "T_max", "--jobs", "2"],
    "friction": ["--incline", "10", "--coefficient", "0.1"],
}


def _line(command: str) -> list[str]:
    file = [] if command in _WITHOUT_FILE else [str(_CONFIGS / f"{_MACHINES.get(command, 'waterworks')}.yaml")]
    return [command, *file, *_OPTIONS.get(command, [])]


LINES = {command: _line(command) for command in COMMANDS}
"""Command -> its name and arguments; each run ends with status 0."""
