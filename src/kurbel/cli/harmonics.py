"""`kurbel harmonics`: the orders of the turning effort."""

import click

from kurbel.cli.output_options import Asked, machine_places, orders_option, speeds_option


@click.command()
@machine_places
@orders_option
@speeds_option
def harmonics(asked: Asked, orders: tuple[float, ...] | None, speeds: tuple[float, ...] | None) -> None:
    """Print the orders of the torque of every cylinder, and of the turning effort of the whole machine.

    Orders count periods per turn of the shaft, so that a four-stroke cycle has halves. They are integrated piece by
    piece between the corners of the cards. t is the tangential pressure |M|/(R A). Major orders are those in which all
    cranks pull together. FILE may be - for standard input.
    """
    from kurbel.report.turning import harmonics_report

    asked.write(harmonics_report(asked.case(), asked.frame("harmonics", 360.0), orders, speeds))
