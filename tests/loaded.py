"""Which modules of kurbel a run of the command line loads: each line of standard input is one, as JSON.

What does not belong to kurbel is imported once; every run is a fork, so that each starts without kurbel.
"""

import json
import os
import sys
from contextlib import redirect_stderr, redirect_stdout, suppress
from io import BytesIO, TextIOWrapper

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


def main() -> None:
    for line in sys.stdin:
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            answer = json.dumps(modules_of(json.loads(line)))
            with open(writing, "w", encoding="utf-8") as pipe:
                pipe.write(answer)
            os._exit(0)
        os.close(writing)
        with open(reading, encoding="utf-8") as pipe:
            print(pipe.read(), flush=True)
        os.waitpid(child, 0)


if __name__ == "__main__":
    main()
