"""`kurbel bearings`: loads on crank pins, crosshead pins and main bearings."""

import click

from kurbel.cli.output_options import Asked, machine_table


@click.command()
@machine_table
def bearings(asked: Asked) -> None:
    """Print the loads on crank pins, crosshead pins and main bearings over the cycle.

    The direction of each load is told in the frames of throw, engine and rod; key values are the largest, smallest
    and mean load, pressures, p v, and what of the surfaces is never loaded. Main bearings need 'crankshaft', whose
    throw stands for every throw of a machine with several. --cylinder takes the name of a pin or bearing. Key values
    are exact and do not depend on --step. FILE may be - for standard input.
    """
    from kurbel.report.loads import bearings_report

    case = asked.case()
    asked.write(bearings_report(case, asked.frame("bearings", 360.0 * case.machine.revolutions)))
