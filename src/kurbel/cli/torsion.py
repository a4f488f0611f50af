"""`kurbel torsion`: torsional vibration of the shaft line."""

from __future__ import annotations

import click

from kurbel.cli.exit_status import NO_SOLUTION, exit_statuses
from kurbel.cli.order_options import orders_option, speeds_option
from kurbel.cli.output_options import Asked, machine_table


@click.command(epilog=exit_statuses(NO_SOLUTION))
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
    from kurbel.report.torsion import Wanted, torsion_report

    case = asked.case()
    wanted = Wanted(orders, modes, mode, speeds)
    angles = asked.crank_angles(360.0 * case.machine.revolutions)
    asked.write(torsion_report(case, wanted, angles, asked.columns, asked.units))
