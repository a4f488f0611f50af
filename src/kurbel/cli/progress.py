"""What a command is doing, told on standard error once it takes longer than a second."""

from __future__ import annotations

import sys
import time

import click

_PATIENCE = 1.0


class Progress:
    """Called with what is done next; a terminal is told so from the second on, a pipe is not."""

    def __init__(self, command: str) -> None:
        self._command = command
        self._begin = time.monotonic()

    def __call__(self, doing: str) -> None:
        if sys.stderr is not None and sys.stderr.isatty() and time.monotonic() - self._begin >= _PATIENCE:
            click.echo(f"{self._command}: {doing} …", err=True)
