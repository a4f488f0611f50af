"""`kurbel check`: reads a machine, says what will be computed, and holds it against its limits."""

from __future__ import annotations

import click

from kurbel.cli.exit_status import BROKEN, DONE, NO_SOLUTION, exit_statuses
from kurbel.cli.output_options import machine_file


@click.command(short_help="Read and check a machine file and its limits.", epilog=exit_statuses(BROKEN, NO_SOLUTION))
@machine_file
def check(file: str, overrides: tuple[str, ...]) -> int:
    """Read the machine in FILE and say what will be computed, what is left out and why.

    Where the file gives 'limits', compare the key values with them.
    """
    from kurbel.machine_file import load
    from kurbel.render import Look
    from kurbel.render.listing import listing
    from kurbel.render.output import stdout_charset, stdout_width, write_stdout
    from kurbel.report.check import checked

    result = checked(load(file, overrides))
    write_stdout((listing(result, Look(encoding=stdout_charset().encoding, width=stdout_width())),))
    if result.errors:  # all of them, as one of the gravest kind
        gravest = min(result.errors, key=lambda error: error.exit_status)
        raise type(gravest)("\n".join(map(str, result.errors)))
    return BROKEN if result.broken else DONE
