"""`kurbel motion`: displacement, velocity and acceleration over the crank angle, for any mechanism."""

import click

from kurbel.cli.output_options import Asked, machine_table, row_options


@click.command()
@machine_table
@row_options
def motion(asked: Asked) -> None:
    """Print the motion of every cylinder's mechanism in FILE over one turn of the crank, and the key values.

    What slides has x, c, b; what swings has theta, theta_dot, theta_ddot. Without a speed in FILE only the
    positions are printed. Key values are exact and do not depend on --step. FILE may be - for standard input.
    """
    from kurbel.report.crank import motion_report

    case = asked.case()
    asked.write(motion_report(case, asked.frame("motion", 360.0, len(case.cylinders))))
