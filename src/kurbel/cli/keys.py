"""`kurbel keys`: what a machine file may hold."""

import click

from kurbel.cli.completion import complete_key


@click.command()
@click.argument("key", required=False, shell_complete=complete_key)
def keys(key: str | None) -> None:
    """List the keys of a machine file: what is written, what it means, what holds without it; or KEY in full.

    \b
      kurbel keys
      kurbel keys masses.connecting_rod.share
    """
    from kurbel.render.page import write_entries
    from kurbel.report.keys import every_place, places_at

    if key is None:
        write_entries([(path, ones[0].line) for path, ones in every_place().items()])
    else:
        write_entries([line for one in places_at(key) for line in one.full])
