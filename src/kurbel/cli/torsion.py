"""`kurbel torsion`: torsional vibration of the shaft line."""

import click

from kurbel.cli.output_options import Asked, machine_table, orders_option, speeds_option


@click.command()
@machine_table
@orders_option
@speeds_option
@click.option(
    "--modes", type=click.IntRange(1, 100), default=3, help="Critical speeds of so many modes; 3 if not given."
)
@click.option("--mode", type=click.IntRange(1), default=1, help="The mode of Holzer's table; 1 if not given.")
def torsion(
    asked: Asked, orders: tuple[float, ...] | None, speeds: tuple[float, ...] | None, modes: int, mode: int
) -> None:
    """Print natural frequencies, Holzer's table, and critical speeds of the shaft line.

    Where damping and torques are given, also the steady vibration: torque and stress in every piece at the working
    speed, all orders together, and at the critical speeds that the machine meets, with orders up to 24; --columns
    M_shaft,tau prints them over the crank angle. FILE needs 'shaft', or a 'coupling' behind a 'flywheel'; it may be -
    for standard input.
    """
    from kurbel.report.turning import Wanted, torsion_report

    case = asked.case()
    frame = asked.frame("torsion", 360.0 * case.machine.revolutions)
    asked.write(torsion_report(case, frame, Wanted(orders, modes, mode, speeds)))
