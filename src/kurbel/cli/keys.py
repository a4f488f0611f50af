"""`kurbel keys`: what a machine file may hold."""

from __future__ import annotations

import click

from kurbel.cli.completion import complete_key
from kurbel.cli.exit_status import exit_statuses


@click.command(short_help="The keys of the machine file, or one of them in full.", epilog=exit_statuses())
@click.argument("key", required=False, shell_complete=complete_key)
def keys(key: str | None) -> None:
    """List the keys of a machine file: what is written, what it means, what holds without it; or KEY in full.

    \b
      kurbel keys
      kurbel keys masses.connecting_rod.share
    """
    from kurbel.render import Look
    from kurbel.render.listing import entries
    from kurbel.render.output import stdout_charset, stdout_width, write_stdout
    from kurbel.report.keys import every_place, places_at

    if key is None:
        found = [(path, ones[0].line) for path, ones in every_place().items()]
    else:
        found = [line for one in places_at(key) for line in one.full]
    longest = max(len(head) for head, _ in found)
    look = Look(encoding=stdout_charset().encoding, width=stdout_width())
    write_stdout(line + "\n" for line in entries(((f"{head:<{longest}}  ", text) for head, text in found), look))
