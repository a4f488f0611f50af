"""`kurbel units`: what units a machine file may use."""

import click

from kurbel.cli.completion import complete_kind
from kurbel.errors import UsageError


@click.command()
@click.argument("kind", required=False, shell_complete=complete_kind)
def units(kind: str | None) -> None:
    """List the units that a machine file may use, a line for each kind of quantity; or only those of KIND.

    Products and powers are written as people write them: N m or N*m, kg m2 or kg m^2.
    """
    from kurbel.declared.units import kinds, unit_names
    from kurbel.near_words import did_you_mean
    from kurbel.render.page import write_entries

    named = {kind.replace("_", " "): ", ".join(unit_names(kind)) for kind in kinds()}
    if kind is None:
        write_entries(list(named.items()))
    elif found := named.get(kind.replace("_", " ")):
        write_entries([(kind.replace("_", " "), found)])
    else:
        hint = did_you_mean(kind, tuple(named)) or f"; there are {', '.join(named)}"
        raise UsageError(f"no kind of quantity '{kind}'{hint}")
