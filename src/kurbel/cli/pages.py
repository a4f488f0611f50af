"""The commands on a machine beyond its reports: pictures, the page of everything, checks, accuracy."""

from typing import Any

import click

from kurbel.cli.group import kurbel
from kurbel.cli.options import (
    complete_picture,
    complete_section,
    cylinder_option,
    format_of,
    format_option,
    number,
    number_options,
    numbers,
    output_option,
    output_options,
    paper_option,
    set_options,
    units_option,
    width_option,
    words,
)


@kurbel.command()
@click.argument(
    "files", metavar="FILE [FILE]", nargs=-1, required=True, type=click.Path(allow_dash=True)
)
@set_options
@click.option(
    "--output",
    "-o",
    "file_name",
    metavar="FILE.html",
    help="Write to this file, not to standard output.",
)
@click.option(
    "--step",
    type=number,
    default="15",
    metavar="DEGREES",
    help="Step of the tables; 15 if not given.",
)
@click.option(
    "--sections",
    "section_words",
    type=words,
    metavar="WORD,...",
    shell_complete=complete_section,
    help="Only these after the first page: commands, as bearings; answers or pictures of all; tables, which are then "
    "printed, too; energy, left-out, input; or all.",
)
@click.option(
    "--short", is_flag=True, help="First page, answers and input: --sections answers,input."
)
@paper_option("a4", "letter", text="Size of the printed page; a4 if not given.")
@click.option("--title", help="Title of the page; the name of the machine if not given.")
@units_option
@number_options
def report(**options: Any) -> None:
    """Write a full report on the machine in FILE: input, pictures, tables, key values, limits, energy balance.

    The page needs no script and nothing from the net; it can be read, printed and sent. Tables over the crank angle
    are printed only if the box above them is ticked, or --sections names them. Two files are put side by side, with
    their differences. --set holds for each of them. FILE may be - for standard input.
    """
    from kurbel.cli.showing import write_page

    write_page(**options)


@kurbel.command()
@click.argument("file", metavar="FILE", required=False, type=click.Path(allow_dash=True))
@set_options
@click.argument("names", metavar="[PICTURE]...", nargs=-1, shell_complete=complete_picture)
@click.option(
    "--list",
    "listed",
    is_flag=True,
    help="List the pictures of this machine; without FILE, all pictures.",
)
@click.option("--output", "-o", "file_name", metavar="FILE.svg|png|pdf", help="Draw to this file.")
@click.option(
    "--angles",
    type=numbers,
    metavar="A,B,...",
    help="Mechanism and constructions at these crank angles.",
)
@click.option(
    "--poster",
    "size",
    metavar="A0|...|A5",
    help="The machine in section as a wall sheet, to a pdf or svg.",
)
@paper_option(
    "a4",
    "letter",
    "fit",
    text="Sheets of a pdf, each with one picture or one crank angle: a4 if not given; fit: one sheet of its size.",
)
@cylinder_option
@units_option
@number_options
@width_option
def plot(**options: Any) -> None:
    """Draw pictures of the machine in FILE: those that are named, 'all', or the most informative picture.

    Curves are as exact as the tables, jumps are drawn as jumps, and extremes are marked. Without -o
    they are drawn in the terminal, with -o to a file; svg needs no other package, and there the mechanism moves; png
    and pdf, a page for each picture, need typst. FILE may be - for standard input.
    """
    from kurbel.cli.drawing import draw_pictures

    draw_pictures(**options)


@kurbel.command()
@click.argument(
    "files", metavar="FILE...", nargs=-1, required=True, type=click.Path(allow_dash=True)
)
@set_options
@format_option(
    "table",
    "json",
    "junit",
    said="table, json (every finding with its place) or junit (XML for CI services); ",
)
@click.option("--quiet", "-q", is_flag=True, help="Print what FAILs, and nothing else.")
@units_option
@output_option
@width_option
def check(format: str | None, file_name: str | None, units: str | None, **options: Any) -> int:
    """Check the machine in each FILE: list what will be computed, what is left out and why.

    Where the file gives 'limits', hold the key values to them, in every one of its 'cases'; where it gives 'expect',
    compare them with the figures there. As json every fault, limit, figure and warning has file, line, column, key,
    message and severity; as junit each is a test. Of several files all are checked; the exit status is the gravest one.
    """
    from kurbel.cli.checking import check_files

    written = format_of(format, file_name, {".json": "json", ".xml": "junit"})
    return check_files(format=written, file_name=file_name, **options)


@kurbel.command()
@click.argument("file", metavar="[FILE]", required=False, type=click.Path(allow_dash=True))
@set_options
@click.option("--quick", is_flag=True, help="Fewer scenes and repeats: for CI.")
@click.option("--extremes", is_flag=True, help="Run stiff and extreme machines instead.")
@click.option("--plot", "picture", metavar="FILE.svg|png|pdf", help="Also draw the picture.")
@output_options
def accuracy(**options: Any) -> int:
    """Compare kurbel's own methods with others, quantity by quantity: error, time, and what went wrong.

    Without FILE for built-in scenes, with FILE for that machine (- for standard input). References have 40 digits
    and come from other methods than kurbel's. A last table shows the time that leaving out friction, then masses,
    cards and speed, saves.
    """
    from kurbel.cli.comparing import compare

    return compare(**options)
