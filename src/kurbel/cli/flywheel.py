"""`kurbel flywheel`: the turning effort of the whole machine, its flywheel and its speed."""

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


@click.command(short_help="Turning effort, flywheel and speed line of the machine.")
@machine_file
@angle_options
@columns_option
@units_option
@output_options
def flywheel(
    file: str,
    step: float,
    angles: tuple[float, ...] | None,
    columns: tuple[str, ...] | None,
    units: str,
    output: Output,
) -> None:
    """Print the turning effort of the whole machine, its excess work, and what the flywheel makes of it.

    Every cylinder counts at the angle of its crank; T is referred to the radius of crank 1, T_b is the share of the
    inertia forces in it. E is the excess of the work over that of the resistance, omega the speed under the load of
    FILE, which may depend on it. Key values are exact and do not depend on --step. Exit status 3: the machine stalls,
    or its coupling is in resonance with nothing to damp it. FILE may be - for standard input.
    """
    from kurbel.machine_file import load
    from kurbel.report.flywheel import flywheel_report
    from kurbel.solver.case import Case

    case = Case(load(file))
    end = case.machine.revolutions * 360.0
    output.write(flywheel_report(case, crank_angles(step, angles, end), columns, units))
