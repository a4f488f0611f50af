"""`kurbel motion`: displacement, velocity and acceleration over the crank angle, for any mechanism."""

from __future__ import annotations

import click

from kurbel.cli.exit_status import exit_statuses
from kurbel.cli.output_options import Asked, machine_table
from kurbel.cli.row_options import AskedRows, row_options


@click.command(epilog=exit_statuses())
@machine_table
@row_options
def motion(asked: Asked, rows: AskedRows) -> None:
    """Print the motion of every cylinder's mechanism in FILE over one turn of the crank, and the key values.

    What slides has x, c, b; what swings has theta, theta_dot, theta_ddot. Without a speed in FILE only the
    positions are printed. Key values are exact and do not depend on --step. FILE may be - for standard input.
    """
    from kurbel.report.motion import motion_report

    case = asked.case()
    angles = rows.rows(asked) or asked.crank_angles(360.0, len(case.cylinders))
    asked.write(motion_report(case, angles, asked.columns, asked.units, rows.columns))
