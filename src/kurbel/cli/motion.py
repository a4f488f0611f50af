"""`kurbel motion`: displacement, velocity and acceleration over the crank angle, for any mechanism."""

from __future__ import annotations

import click

from kurbel.cli.output_options import (
    Output,
    angle_options,
    columns_option,
    crank_angles,
    machine_file,
    output_options,
    units_option,
)


@click.command(short_help="Displacement, velocity, acceleration of any mechanism.")
@machine_file
@angle_options
@columns_option
@units_option
@output_options
def motion(
    file: str,
    step: float,
    angles: tuple[float, ...] | None,
    columns: tuple[str, ...] | None,
    units: str,
    output: Output,
) -> None:
    """Print the motion of every cylinder's mechanism in FILE over one turn of the crank, and the key values.

    What slides has x, c, b; what swings has theta, theta_dot, theta_ddot. Without a speed in FILE only the
    positions are printed. Key values are exact and do not depend on --step. FILE may be - for standard input.
    """
    from kurbel.machine_file import load
    from kurbel.report.motion import motion_report
    from kurbel.solver.case import Case

    machine = load(file)
    output.write(motion_report(Case(machine), crank_angles(step, angles, 360.0), columns, units))
