"""`kurbel forces`: the forces in the crank train of every cylinder."""

import click

from kurbel.cli.output_options import Asked, Spreads, machine_table, row_options, uncertainty_option


@click.command()
@machine_table
@uncertainty_option
@row_options
@click.option(
    "--cycle", type=click.IntRange(min=1), metavar="N", help="This measured cycle of a trace, not their mean."
)
@click.option("--each-cycle", is_flag=True, help="A line for every measured cycle instead of the table over the angle.")
def forces(asked: Asked, cycle: int | None, each_cycle: bool, spreads: Spreads) -> None:
    """Print the forces in the crank train over the working cycle, and the key values, for every cylinder of FILE.

    P acts along the stroke line, S in the rod, N on the guide, D and T at the crank pin; forces toward the shaft
    count positive. At a jump of the pressure the value just after it stands in the table. Key values are exact and
    do not depend on --step. FILE may be - for standard input.
    """
    from kurbel.report.crank import cycles_report, forces_report

    case = asked.case()
    if cycle is not None:
        from kurbel.machine.one_cycle import of_cycle

        case = type(case)(of_cycle(case.machine, cycle))
    if each_cycle:
        _refuse_columns(asked, cycle)
        asked.write(cycles_report(case, asked.units))
        return
    frame = asked.frame("forces", 360.0 * case.machine.revolutions, len(case.cylinders))
    asked.write(forces_report(case, frame), case, spreads)


def _refuse_columns(asked: Asked, cycle: int | None) -> None:
    """Raise UsageError for what only a table over the angle has."""
    ways = {"--columns": asked.columns, "--cycle": cycle, "--angles": asked.angles}
    for way, said in (ways | {"--where": asked.where, "--over": asked.over}).items():
        if said is not None:
            raise click.UsageError(f"--each-cycle has no table over the angle; leave out {way}.")
