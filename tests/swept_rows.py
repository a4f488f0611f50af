"""`kurbel sweep` run in the process, and the rows that it tells as json."""

from __future__ import annotations

import json
from pathlib import Path

from click.testing import CliRunner, Result

from kurbel.cli import kurbel as command

CONFIGS = Path(__file__).parent.parent / "configs"
WATERWORKS = str(CONFIGS / "waterworks.yaml")


def run(*args: str, file: str = WATERWORKS) -> Result:
    return CliRunner().invoke(command, ["sweep", file, *args])


def rows(*args: str, file: str = WATERWORKS) -> list[dict[str, object]]:
    result = run(*args, "-f", "json", file=file)
    assert result.exit_code == 0, result.output
    return [json.loads(line) for line in result.stdout.splitlines()]
