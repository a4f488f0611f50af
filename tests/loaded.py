"""Which modules of kurbel runs of the command line load: each line of standard input is a list of runs, as JSON.

    python loaded.py [WORD...]

What does not belong to kurbel is imported once, and so is what a run of these words imports. Every list is a fork, so
that its first run starts without any other module; the other runs start with those of the first one.
"""

import gc
import json
import os
import sys
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout, suppress
from io import BytesIO, TextIOWrapper
from typing import Any

import click  # noqa: F401
import numpy  # noqa: F401
import yaml  # noqa: F401


def modules_of(words: list[str]) -> list[str]:
    """Return the modules of kurbel that are imported when a run ends."""
    from kurbel.cli import kurbel

    with (
        redirect_stdout(TextIOWrapper(BytesIO())),
        redirect_stderr(TextIOWrapper(BytesIO())),
        suppress(SystemExit),
    ):
        kurbel.main(words)
    return sorted(name for name in sys.modules if name.partition(".")[0] == "kurbel")


def modules_of_each(runs: list[list[str]]) -> list[list[str]]:
    """Return the modules of the first run, and those of each other one, which starts with them."""
    return [modules_of(runs[0]), *(in_fork(modules_of, run) for run in runs[1:])]


def in_fork(function: Callable[..., Any], argument: Any) -> Any:
    """Return what a function returns in a fork of this process, which stays as it is."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        gc.disable()  # or it would copy the pages of all that it looks at
        with open(writing, "w", encoding="utf-8") as pipe:
            json.dump(function(argument), pipe)
        os._exit(0)
    os.close(writing)
    with open(reading, encoding="utf-8") as pipe:
        answer = json.load(pipe)
    os.waitpid(child, 0)
    return answer


def main() -> None:
    if sys.argv[1:]:
        modules_of(sys.argv[1:])
    for line in sys.stdin:
        print(json.dumps(in_fork(modules_of_each, json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
