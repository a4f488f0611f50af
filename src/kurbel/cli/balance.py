"""`kurbel balance`: free forces and moments of the whole machine, and the weights against them."""

import click

from kurbel.cli.output_options import Asked, machine_table


@click.command()
@machine_table
@click.option("--compare", is_flag=True, help="What the books' cos phi + R/L cos 2phi (R 291) gives, beside it.")
@click.option("--orders", "orders_only", is_flag=True, help="Only the tables of orders and weights, and key values.")
def balance(asked: Asked, orders_only: bool) -> None:
    """Print what the moving masses of FILE do to its frame, and which weights take that away.

    F_x is the free force along the stroke line of cylinder 1, outward from the shaft, F_y that across it, 90 degrees
    on in the sense of rotation; M_x and M_y are their moments along the shaft; M_roll rolls the frame about it. The
    orders tell them as circles that turn with the crank and against it; what cancels is exactly 0. The best weights
    stand for those of FILE. Key values are exact and do not depend on --step. FILE may be - for standard input.
    """
    from kurbel.report.balance import balance_report

    rows = {"--columns": asked.columns, "--angles": asked.angles}
    if orders_only and (given := [option for option, said in rows.items() if said is not None]):
        raise click.UsageError(f"--orders prints nothing over the crank angle; leave it or {' and '.join(given)} out.")
    case = asked.case()
    asked.write(balance_report(case, asked.frame("balance", case.balance.cycle), orders_only))
