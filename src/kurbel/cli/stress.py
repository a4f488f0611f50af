"""`kurbel stress`: the strength of the crankshaft."""

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


@click.command(short_help="Bearing forces and stresses of the crankshaft.")
@machine_file
@angle_options
@columns_option
@click.option("--places", "places_only", is_flag=True, help="Only the stresses place by place; as csv one line each.")
@units_option
@output_options
def stress(
    file: str,
    step: float,
    angles: tuple[float, ...] | None,
    columns: tuple[str, ...] | None,
    places_only: bool,
    units: str,
    output: Output,
) -> None:
    """Print the forces on the bearings of a crankshaft with one throw, and the stresses in pin, webs and journals.

    Stresses are listed one by one in the dead centre under the full piston force, in the position of the largest
    torque, and where each place is strained most over the whole cycle; combined after Bach (sigma_res) and after
    von Mises (sigma_v). Key values are exact and do not depend on --step. FILE needs 'crankshaft', one cylinder and
    a pressure; it may be - for standard input.
    """
    from kurbel.machine_file import load
    from kurbel.report.stress import stress_report
    from kurbel.solver.case import Case

    case = Case(load(file))
    end = case.machine.revolutions * 360.0
    output.write(stress_report(case, crank_angles(step, angles, end), columns, units, places_only))
