"""`kurbel flywheel`: the turning effort of the whole machine, its flywheel and its speed."""

import click

from kurbel.cli.output_options import Asked, Spreads, machine_table, uncertainty_option, where_option


@click.command()
@machine_table
@where_option
@uncertainty_option
def flywheel(asked: Asked, spreads: Spreads) -> None:
    """Print the turning effort of the whole machine, its excess work, and what the flywheel makes of it.

    Every cylinder counts at the angle of its crank; T is referred to the radius of crank 1, T_b is the share of the
    inertia forces in it. E is the excess of the work over that of the resistance, omega the speed under the load of
    FILE, which may depend on it. Key values are exact and do not depend on --step. FILE may be - for standard input.
    """
    from kurbel.report.turning import flywheel_report

    case = asked.case()
    frame = asked.frame("flywheel", 360.0 * case.machine.revolutions)
    asked.write(flywheel_report(case, frame), case, spreads)
