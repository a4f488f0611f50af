"""`kurbel units`: what units a machine file may use."""

import click


@click.command()
def units() -> None:
    """List the units that a machine file may use, a line for each kind of quantity.

    Products and powers are written as people write them: N m or N*m, kg m2 or kg m^2.
    """
    from kurbel.declared.units import kinds, unit_names
    from kurbel.render.listing import write_entries

    write_entries([(kind.replace("_", " "), ", ".join(unit_names(kind))) for kind in kinds()])
