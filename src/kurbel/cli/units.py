"""`kurbel units`: what units a machine file may use."""

from __future__ import annotations

import click

from kurbel.cli.exit_status import exit_statuses


@click.command(short_help="The units of every kind of quantity.", epilog=exit_statuses())
def units() -> None:
    """List the units that a machine file may use, a line for each kind of quantity.

    Products and powers are written as people write them: N m or N*m, kg m2 or kg m^2.
    """
    from kurbel.declared.units import kinds, unit_names
    from kurbel.render import Look
    from kurbel.render.listing import entries
    from kurbel.render.output import stdout_charset, stdout_width, write_stdout

    longest = max(map(len, kinds()))
    found = ((f"{kind.replace('_', ' '):<{longest}}  ", ", ".join(unit_names(kind))) for kind in kinds())
    look = Look(encoding=stdout_charset().encoding, width=stdout_width())
    write_stdout(line + "\n" for line in entries(found, look))
