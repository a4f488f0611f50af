"""`kurbel plot`: the pictures of a machine, in the terminal or in a file."""

from typing import TYPE_CHECKING

import click

from kurbel.cli.completion import complete_cylinder, complete_picture
from kurbel.cli.output_options import loaded, number_options, set_option, units_option
from kurbel.cli.readings import numbers
from kurbel.render import Look

if TYPE_CHECKING:
    from kurbel.report.pictures import PictureKind


@click.command()
@click.argument("file", metavar="FILE", required=False, type=click.Path(allow_dash=True))
@set_option
@click.argument("names", metavar="[PICTURE]...", nargs=-1, shell_complete=complete_picture)
@click.option(
    "--list", "listed", is_flag=True, help="Say which pictures this machine has; without FILE, which there are."
)
@click.option("--output", "-o", "file_name", metavar="FILE.svg|png|pdf", help="Draw to this file.")
@click.option("--angles", type=numbers, metavar="A,B,...", help="The mechanism at these crank angles, not moving.")
@click.option(
    "--cylinder", metavar="NAME", help="Only of this cylinder, by name or number.", shell_complete=complete_cylinder
)
@units_option
@number_options
@click.option("--width", type=click.IntRange(20, 100_000), metavar="N", help="Columns to fill in the terminal.")
def plot(
    file: str | None,
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
    and pdf need typst. FILE may be - for standard input.
    """
    from kurbel.render.drawing import check_file, draw_file, draw_stdout
    from kurbel.report.picture_source import PictureOptions
    from kurbel.report.pictures import PICTURES, pictures, pictures_of
    from kurbel.solver.case import Case

    if listed and file_name is not None:
        raise click.UsageError("--list draws nothing; leave --output out.")
    if file is None:
        if not listed:
            raise click.MissingParameter(param_type="argument", param_hint="'FILE'")
        _write_list(PICTURES)
        return
    to_file = file_name is not None and file_name != "-"
    if to_file:
        check_file(file_name or "")
    case = Case(loaded(file, overrides, file_name))
    options = PictureOptions(units or "metric", cylinder, angles)
    if listed:
        _write_list(pictures_of(case, options))
        return
    look = Look(comma=decimal == "comma", digits=digits, width=width)
    drawn = pictures(case, names, options)
    if to_file:
        draw_file(list(drawn), look, file_name or "")
    else:
        draw_stdout(drawn, look)


def _write_list(declared: "tuple[PictureKind, ...]") -> None:
    from kurbel.render.page import write_entries

    write_entries([(one.id, f"{one.title}. {one.text}") for one in declared])
