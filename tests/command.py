"""Commands run in the process of the tests."""

import json
import subprocess
from threading import Timer
from typing import Any

from click.testing import CliRunner, Result

from kurbel.cli import kurbel


def run(*words: object, text: str | None = None) -> Result:
    """Return what a command prints and its exit status; text: its standard input."""
    return CliRunner().invoke(kurbel, [str(word) for word in words], input=text)


def answer(*words: object, text: str | None = None) -> dict[str, Any]:
    """Return the JSON that a command prints."""
    result = run(*words, "-f", "json", text=text)
    assert result.exit_code == 0, result.output
    parsed: dict[str, Any] = json.loads(result.stdout)
    return parsed


def printed(*words: object, text: str | None = None) -> str:
    """Return what a command prints that ends well, and says nothing beside it."""
    result = run(*words, text=text)
    assert (result.exit_code, result.stderr) == (0, "")
    return result.stdout


def limited(process: subprocess.Popen[Any], seconds: float = 60) -> None:
    """Kill a process that takes longer, so that nobody waits for what it does not say."""
    timer = Timer(seconds, process.kill)
    timer.daemon = True
    timer.start()
