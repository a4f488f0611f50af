"""`kurbel stress`: the strength of the crankshaft."""

import click

from kurbel.cli.output_options import Asked, Spreads, machine_table, uncertainty_option


@click.command()
@machine_table
@uncertainty_option
@click.option("--places", "places_only", is_flag=True, help="Only the stresses place by place; as csv one line each.")
def stress(asked: Asked, places_only: bool, spreads: Spreads) -> None:
    """Print the forces on the bearings of a crankshaft with one throw, and the stresses in pin, webs and journals.

    Stresses are listed one by one in the dead centre under the full piston force, in the position of the largest
    torque, and where each place is strained most over the whole cycle; combined after Bach (sigma_res) and after
    von Mises (sigma_v). Key values are exact and do not depend on --step. FILE needs 'crankshaft', one cylinder and
    a pressure; it may be - for standard input.
    """
    from kurbel.report.loads import stress_report

    case = asked.case()
    frame = asked.frame("stress", 360.0 * case.machine.revolutions)
    asked.write(stress_report(case, frame, places_only), case, spreads)
