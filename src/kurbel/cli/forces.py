"""`kurbel forces`: the forces in the crank train of every cylinder."""

from __future__ import annotations

import click

from kurbel.cli.exit_status import NO_SOLUTION, exit_statuses
from kurbel.cli.output_options import Asked, machine_table, uncertainty_option
from kurbel.cli.row_options import AskedRows, row_options


@click.command(short_help="Forces, work and friction loss of every cylinder.", epilog=exit_statuses(NO_SOLUTION))
@machine_table
@uncertainty_option
@row_options
def forces(asked: Asked, rows: AskedRows, spreads: tuple[tuple[str, str], ...]) -> None:
    """Print the forces in the crank train over the working cycle, and the key values, for every cylinder of FILE.

    P acts along the stroke line, S in the rod, N on the guide, D and T at the crank pin; forces toward the shaft
    count positive. At a jump of the pressure the value just after it stands in the table. Key values are exact and
    do not depend on --step. FILE may be - for standard input.
    """
    from kurbel.report.forces import forces_report

    case = asked.case()
    angles = rows.rows(asked) or asked.crank_angles(360.0 * case.machine.revolutions, len(case.cylinders))
    asked.write(forces_report(case, angles, asked.columns, asked.units, rows.columns), case, spreads)
