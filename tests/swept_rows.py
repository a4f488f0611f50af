"""`kurbel sweep` run in the process, the rows that it prints as json, and the numbers in machine files that may vary."""

import json
import re
import subprocess
import time
from pathlib import Path

from click.testing import Result

import command
from kurbel.errors import KurbelError
from kurbel.machine.origin import Origin
from kurbel.machine_file.overrides import dotted, leaves, tree_of
from representative import CONFIGS

WATERWORKS = str(CONFIGS["waterworks"])
EXAMPLES = sorted(
    path for path in Path(__file__).parent.glob("examples/*.yaml") if path.stem != "answers"
)
NUMBER = re.compile(r"([0-9.]+(?:e[+-]?[0-9]+)?)(?: (.*))?")
NO_NUMBERS = {"uncertainty", "limits", "expect", "trace", "points", "name", "count"}


def run(*args: str, file: str = WATERWORKS) -> Result:
    return command.run("sweep", file, *args)


def rows(*args: str, file: str = WATERWORKS) -> list[dict[str, object]]:
    result = run(*args, "-f", "json", file=file)
    assert result.exit_code == 0, result.output
    return [json.loads(line) for line in result.stdout.splitlines()]


def numbers_in(origin: Origin) -> list[tuple[str, float, str]]:
    """Return every key of a machine file whose value is a positive number, the number, and its unit."""
    try:
        texts = [
            (path, NUMBER.fullmatch(text))
            for path, text in leaves(tree_of(origin))
            if isinstance(text, str)
        ]
    except KurbelError:
        return []
    known = [
        (path, result) for path, result in texts if result and not NO_NUMBERS & {*map(str, path)}
    ]
    return [
        (dotted(path), float(result[1]), result[2] or "")
        for path, result in known
        if float(result[1]) > 0
    ]


def until_written(process: subprocess.Popen[str], part: Path, size: int) -> None:
    """Wait until a sweep that runs has written so many bytes, or has ended; one that writes nothing is killed."""
    begin = time.monotonic()
    while process.poll() is None and not (part.exists() and part.stat().st_size > size):
        if time.monotonic() - begin > 120:
            process.kill()
        time.sleep(0.02)
