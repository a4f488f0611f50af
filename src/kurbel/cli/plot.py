"""`kurbel plot`: the pictures of a machine, in the terminal or in a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from kurbel.cli.completion import complete_cylinder, complete_picture
from kurbel.cli.exit_status import NO_SOLUTION, exit_statuses
from kurbel.cli.output_options import Numbers, loaded, machine_file, units_option

if TYPE_CHECKING:
    from kurbel.report.pictures import Wish
    from kurbel.solver.case import Case


@click.command(epilog=exit_statuses(NO_SOLUTION))
@machine_file
@click.argument("names", metavar="[PICTURE]...", nargs=-1, shell_complete=complete_picture)
@click.option("--list", "listed", is_flag=True, help="Say which pictures this machine has.")
@click.option("--output", "-o", "file_name", metavar="FILE.svg|png|pdf", help="Draw to this file.")
@click.option("--angles", type=Numbers(), metavar="A,B,...", help="The mechanism at these crank angles, not moving.")
@click.option(
    "--cylinder", metavar="NAME", help="Only of this cylinder, by name or number.", shell_complete=complete_cylinder
)
@units_option
@click.option("--decimal", type=click.Choice(["point", "comma"]), default="point", help="Decimal sign.")
@click.option("--digits", type=click.IntRange(1, 17), help="Significant digits; 4 if not given.")
@click.option("--width", type=click.IntRange(20, 100_000), metavar="N", help="Columns to fill in the terminal.")
def plot(
    file: str,
    overrides: tuple[str, ...],
    names: tuple[str, ...],
    listed: bool,
    file_name: str | None,
    angles: tuple[float, ...] | None,
    cylinder: str | None,
    units: str | None,
    decimal: str,
    digits: int | None,
    width: int | None,
) -> None:
    """Draw pictures of the machine in FILE: those that are named, 'all', or the one that says most.

    Curves are as exact as the tables, jumps are drawn as jumps, and extremes are marked where they stand. Without -o
    they are drawn in the terminal, with -o to a file; svg needs no other package, and there the mechanism moves; png
    and pdf need matplotlib. FILE may be - for standard input.
    """
    from kurbel.render import Look
    from kurbel.render.pictures.drawing import check_file, draw_file, draw_stdout
    from kurbel.report.pictures import FILE, TERMINAL, Wish, pictures
    from kurbel.solver.case import Case

    if listed and file_name is not None:
        raise click.UsageError("--list draws nothing; leave --output out.")
    to_file = file_name is not None and file_name != "-"
    if to_file:
        check_file(file_name or "")
    case = Case(loaded(file, overrides, file_name))
    wish = Wish(units or "metric", FILE if to_file else TERMINAL, cylinder, angles)
    if listed:
        _list(case, wish)
        return
    look = Look(comma=decimal == "comma", digits=digits, width=width)
    drawn = pictures(case, names, wish)
    if to_file:
        draw_file(list(drawn), look, file_name or "")
    else:
        draw_stdout(drawn, look)


def _list(case: Case, wish: Wish) -> None:
    """Write a line for each picture that there is."""
    from kurbel.render.listing import entries
    from kurbel.render.output import stdout_look, write_stdout
    from kurbel.report.pictures import pictures_of

    having = pictures_of(case, wish)
    longest = max((len(one.id) for one in having), default=0)
    found = ((f"{one.id:<{longest}}  ", f"{one.title}. {one.text}") for one in having)
    look = stdout_look()
    write_stdout((line + "\n" for line in entries(found, look)), look.encoding)
