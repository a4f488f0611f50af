"""The commands that draw, write a whole page, check, or compare methods: plot, report, check, accuracy."""

import sys

import click

from kurbel.cli.group import Progress, kurbel
from kurbel.cli.options import (
    Output,
    complete_picture,
    cylinder_option,
    format_of,
    number,
    number_options,
    numbers,
    output_option,
    output_options,
    set_options,
    units_option,
    width_option,
)
from kurbel.render import Look
from kurbel.render.output import refuse_overwriting


@kurbel.command()
@click.argument("files", metavar="FILE [FILE]", nargs=-1, required=True, type=click.Path(allow_dash=True))
@set_options
@click.option("--output", "-o", "file_name", metavar="FILE.html", help="Write to this file, not to standard output.")
@click.option("--step", type=number, default=15.0, metavar="DEGREES", help="Step of the tables; 15 if not given.")
@click.option("--title", help="Title of the page; the name of the machine if not given.")
@units_option
@number_options
def report(
    files: tuple[str, ...],
    case_name: str,
    overrides: tuple[str, ...],
    file_name: str | None,
    step: float,
    title: str | None,
    units: str | None,
    decimal: str,
    digits: int | None,
) -> None:
    """Write a full report on the machine in FILE: input, pictures, tables, key values, limits.

    The page needs no script and nothing from the net; it can be read, printed and sent. Two files are put side by side,
    with their differences. --set holds for each of them. FILE may be - for standard input.
    """
    from kurbel.cli.showing import write_page

    if len(files) > 2 or files.count("-") > 1:
        raise click.UsageError("a report is of one machine, or of two side by side.")
    if file_name is not None and file_name != "-" and not file_name.lower().endswith((".html", ".htm")):
        raise click.UsageError(f"--output {file_name}: the name of a report ends in .html.")
    if file_name is None and sys.stdout and sys.stdout.isatty():  # a page of HTML is nothing to read there
        raise click.UsageError("a report is a page for the browser; give --output NAME.html, or - for this terminal.")
    refuse_overwriting(file_name, files)
    look = Look("html", comma=decimal == "comma", digits=digits)
    write_page(files, case_name, overrides, file_name, step, title, units or "metric", look)


@kurbel.command()
@click.argument("file", metavar="FILE", required=False, type=click.Path(allow_dash=True))
@set_options
@click.argument("names", metavar="[PICTURE]...", nargs=-1, shell_complete=complete_picture)
@click.option("--list", "listed", is_flag=True, help="List the pictures of this machine; without FILE, all pictures.")
@click.option("--output", "-o", "file_name", metavar="FILE.svg|png|pdf", help="Draw to this file.")
@click.option("--angles", type=numbers, metavar="A,B,...", help="Mechanism and constructions at these crank angles.")
@click.option(
    "--poster", "size", metavar="A0|...|A5", help="The machine in section as a sheet to hang, to a pdf or svg."
)
@cylinder_option
@units_option
@number_options
@width_option
def plot(
    file: str | None,
    case_name: str,
    overrides: tuple[str, ...],
    names: tuple[str, ...],
    listed: bool,
    file_name: str | None,
    angles: tuple[float, ...] | None,
    size: str | None,
    cylinder: str | None,
    units: str | None,
    decimal: str,
    digits: int | None,
    width: int | None,
) -> None:
    """Draw pictures of the machine in FILE: those that are named, 'all', or the most informative picture.

    Curves are as exact as the tables, jumps are drawn as jumps, and extremes are marked. Without -o
    they are drawn in the terminal, with -o to a file; svg needs no other package, and there the mechanism moves; png
    and pdf need typst. FILE may be - for standard input.
    """
    from kurbel.cli.showing import draw_pictures
    from kurbel.report.picture_source import PictureOptions

    if listed and file_name is not None:
        raise click.UsageError("--list draws nothing; leave --output out.")
    if file is None and not listed:
        raise click.MissingParameter(param_type="argument", param_hint="'FILE'")
    look = Look(comma=decimal == "comma", digits=digits, width=width)
    options = PictureOptions(units or "metric", cylinder, angles)
    draw_pictures(
        file, case_name, overrides, names, listed, None if file_name == "-" else file_name, size, options, look
    )


@kurbel.command()
@click.argument("files", metavar="FILE...", nargs=-1, required=True, type=click.Path(allow_dash=True))
@set_options
@click.option(
    "--format",
    "-f",
    "format",
    type=click.Choice(["table", "json", "junit"]),
    help="json: every finding with its place; junit: XML that CI services read. By the suffix of --output, or table, "
    "if not given.",
)
@output_option
@width_option
def check(
    files: tuple[str, ...],
    case_name: str,
    overrides: tuple[str, ...],
    format: str | None,
    file_name: str | None,
    width: int | None,
) -> int:
    """Check the machine in each FILE: list what will be computed, what is left out and why.

    Where the file gives 'limits', hold the key values to them, in every one of its 'cases'; where it gives 'expect',
    compare them with the figures there. As json every fault, limit, figure and warning has file, line, column, key,
    message and severity; as junit each is a test. Of several files all are checked; the exit status is the gravest one.
    """
    from kurbel.cli.checking import check_files

    written = format_of(format, file_name, {".json": "json", ".xml": "junit"})
    return check_files(files, case_name, overrides, written, file_name, width)


@kurbel.command()
@click.argument("file", metavar="[FILE]", required=False, type=click.Path(allow_dash=True))
@set_options
@click.option("--quick", is_flag=True, help="Fewer scenes, points and repeats: for CI.")
@click.option("--extremes", is_flag=True, help="Run stiff and extreme machines instead.")
@click.option("--plot", "picture", metavar="FILE.svg|png|pdf", help="Also draw the picture.")
@output_options
def accuracy(
    file: str | None,
    case_name: str,
    overrides: tuple[str, ...],
    quick: bool,
    extremes: bool,
    picture: str | None,
    output: Output,
) -> int:
    """Compare kurbel's own methods with others, quantity by quantity: error, time, and what went wrong.

    Without FILE for built-in scenes, with FILE for that machine (- for standard input). References have 40 digits
    and come from other methods than kurbel's. Numerical errors, errors of the model (the formulas of the book) and
    errors of the data (0.1 deg of dead centre, 0.5 % noise, what the file gives as 'uncertainty') are listed apart.
    """
    if (case_name or overrides) and file is None:
        raise click.UsageError("--case and --set are values over those of FILE; give the FILE.")
    from kurbel.machine_file import loads
    from kurbel.report.accuracy import accuracy_picture, accuracy_report, extremes_report

    if extremes:
        if file is not None or picture is not None:
            raise click.UsageError("--extremes has its own machines and no picture; leave FILE and --plot out.")
        report, passed = extremes_report(loads)
        output.write(report)
        return int(not passed)

    from kurbel.cli.request import case_of
    from kurbel.designs.uncertainty import data_uncertainty
    from kurbel.render.drawing import check_file, draw_file

    if picture is not None:
        check_file(picture, "--plot")
    machine = None if file is None else case_of(file, case_name, overrides, output.file_name, picture).machine
    uncertain = data_uncertainty(machine) if machine and machine.uncertainty else {}
    with Progress("accuracy") as progress:
        report = accuracy_report(machine, quick, loads, uncertain, progress)
    output.write(report)
    if picture is not None:
        draw_file([accuracy_picture(report)], output.look, picture)
    return 0
