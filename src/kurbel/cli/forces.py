"""`kurbel forces`: the forces in the crank train of every cylinder."""

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


@click.command(short_help="Forces, work and friction loss of every cylinder.")
@machine_file
@angle_options
@columns_option
@units_option
@output_options
def forces(
    file: str,
    step: float,
    angles: tuple[float, ...] | None,
    columns: tuple[str, ...] | None,
    units: str,
    output: Output,
) -> None:
    """Print the forces in the crank train over the working cycle, and the key values, for every cylinder of FILE.

    P acts along the stroke line, S in the rod, N on the guide, D and T at the crank pin; forces toward the shaft
    count positive. At a jump of the pressure the value just after it stands in the table. Key values are exact and
    do not depend on --step. FILE may be - for standard input.
    """
    from kurbel.machine_file import load
    from kurbel.report.forces import forces_report
    from kurbel.solver.case import Case

    machine = load(file)
    chosen = crank_angles(step, angles, 360.0 * machine.revolutions)
    output.write(forces_report(Case(machine), chosen, columns, units))
