"""The commands on a machine: its reports, made from the rows of `COMMANDS`; pictures, pages, checks; many designs."""

from collections.abc import Callable
from typing import Any

import click

from kurbel.cli.group import kurbel
from kurbel.cli.options import (
    Command,
    CommandWithKeyValues,
    angle_options,
    columns_option,
    complete_ids,
    complete_override,
    complete_picture,
    cylinder_option,
    format_of,
    format_option,
    frequency,
    key_value_option,
    machine_file,
    number,
    number_options,
    numbers,
    orders_option,
    output_option,
    output_options,
    part_options,
    row_options,
    set_options,
    speeds_option,
    stacked,
    uncertainty_option,
    units_option,
    where_option,
    width_option,
    words,
)
from kurbel.declared.unit_systems import messages_in
from kurbel.render.formats import Output
from kurbel.report.commands import REPORTS
from kurbel.report.commands import Command as Row

# those that report on it

_OF_EVERY = "Key values are exact, whichever rows are printed. FILE may be - for standard input."
_cases_option = click.option(
    "--cases", is_flag=True, help="A row of key values for every load case of FILE, those of --columns if given."
)


def _instead(name: str, text: str) -> Callable[[Command], Command]:
    """Return a flag that asks for other tables instead of that over the crank angle; its value is its name."""
    return click.option(name, "instead", is_flag=True, flag_value=name, default="", help=text)


_SHARED = {"where": stacked(where_option), "uncertainty": stacked(uncertainty_option)}
"""What the rows of commands call options that several commands take."""
_OWN = {
    "motion": row_options,
    "forces": stacked(
        row_options,
        click.option(
            "--cycle", type=click.IntRange(min=1), metavar="N", help="This measured cycle of a trace, not their mean."
        ),
        _instead("--each-cycle", "A line for every measured cycle instead of the table over the angle."),
    ),
    "stress": stacked(_instead("--places", "Only the stresses place by place; as csv one line each.")),
    "balance": stacked(
        click.option("--compare", is_flag=True, help="Also by the textbook formula cos phi + R/L cos 2phi (R 291)."),
        _instead("--orders", "Only the tables of orders and weights, and key values."),
    ),
    "harmonics": stacked(orders_option, speeds_option),
    "torsion": stacked(
        orders_option,
        speeds_option,
        click.option(
            "--modes", type=click.IntRange(1, 100), default=3, help="Critical speeds of so many modes; 3 if not given."
        ),
        click.option("--mode", type=click.IntRange(1), help="The mode of Holzer's table; 1 if not given."),
        click.option(
            "--at",
            type=frequency,
            metavar="'F Hz'",
            help="Holzer's table at this frequency, with its residual torque, instead of a mode.",
        ),
    ),
}
"""Options beyond those of every command; the report gets them by name, but for those that `print_report` has."""


def _command(row: Row) -> click.Command:
    """Return the command of a row, with FILE and the options that its report needs."""

    def run(units: str | None, output: Output, **options: Any) -> None:
        from kurbel.cli.request import print_report

        with messages_in(units or "metric"):
            system = units or ("si" if output.look.format in ("csv", "json") else "metric")
            print_report(row.word, output, units=system, **options)

    rows = (angle_options, columns_option) if row.over_angle else ()
    cases = (_cases_option,) if row.in_cases else ()
    shared = [_SHARED[word] for word in row.options]
    own = (_OWN[row.word],) if row.word in _OWN else ()
    with_options = stacked(machine_file, *rows, part_options, units_option, output_options, *cases, *shared, *own)
    return click.command(row.word, cls=CommandWithKeyValues, help=f"{row.of.__doc__}\n\n    {_OF_EVERY}")(
        with_options(run)
    )


for _row in REPORTS:
    kurbel.add_command(_command(_row))


# pictures, pages, checks


@kurbel.command()
@click.argument("files", metavar="FILE [FILE]", nargs=-1, required=True, type=click.Path(allow_dash=True))
@set_options
@click.option("--output", "-o", "file_name", metavar="FILE.html", help="Write to this file, not to standard output.")
@click.option("--step", type=number, default="15", metavar="DEGREES", help="Step of the tables; 15 if not given.")
@click.option("--title", help="Title of the page; the name of the machine if not given.")
@units_option
@number_options
def report(**options: Any) -> None:
    """Write a full report on the machine in FILE: input, pictures, tables, key values, limits, energy balance.

    The page needs no script and nothing from the net; it can be read, printed and sent. Two files are put side by side,
    with their differences. --set holds for each of them. FILE may be - for standard input.
    """
    from kurbel.cli.showing import write_page

    write_page(**options)


@kurbel.command()
@click.argument("file", metavar="FILE", required=False, type=click.Path(allow_dash=True))
@set_options
@click.argument("names", metavar="[PICTURE]...", nargs=-1, shell_complete=complete_picture)
@click.option("--list", "listed", is_flag=True, help="List the pictures of this machine; without FILE, all pictures.")
@click.option("--output", "-o", "file_name", metavar="FILE.svg|png|pdf", help="Draw to this file.")
@click.option("--angles", type=numbers, metavar="A,B,...", help="Mechanism and constructions at these crank angles.")
@click.option("--poster", "size", metavar="A0|...|A5", help="The machine in section as a wall sheet, to a pdf or svg.")
@cylinder_option
@units_option
@number_options
@width_option
def plot(**options: Any) -> None:
    """Draw pictures of the machine in FILE: those that are named, 'all', or the most informative picture.

    Curves are as exact as the tables, jumps are drawn as jumps, and extremes are marked. Without -o
    they are drawn in the terminal, with -o to a file; svg needs no other package, and there the mechanism moves; png
    and pdf need typst. FILE may be - for standard input.
    """
    from kurbel.cli.showing import draw_pictures

    draw_pictures(**options)


@kurbel.command()
@click.argument("files", metavar="FILE...", nargs=-1, required=True, type=click.Path(allow_dash=True))
@set_options
@format_option(
    "table",
    "json",
    "junit",
    said="json: every finding with its place; junit: XML that CI services read. ",
)
@output_option
@width_option
def check(format: str | None, file_name: str | None, **options: Any) -> int:
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


# many designs

_what_varies = stacked(
    click.option(
        "--vary",
        multiple=True,
        metavar="KEY=VALUES",
        shell_complete=complete_override,
        help="rod_ratio=3:6:0.25, speed=40,50,60 rpm, bore=normal(450 mm, 0.2 mm) or uniform(...); may be repeated, "
        "for all combinations; in one, 'bore=400,450 mm; head_end_rod=70,80 mm' go together.",
    ),
    click.option("--cases", is_flag=True, help="Every load case of FILE, by itself or with every --vary."),
    click.option("--zip", "side_by_side", is_flag=True, help="First values with first values; else all combinations."),
    click.option(
        "--sample", type=click.IntRange(1, 10**8), metavar="N", help="Points of a Latin hypercube of distributions."
    ),
    click.option("--seed", type=click.IntRange(0), default=0, help="Seed of the sample; 0 if not given."),
)
_what_is_printed = stacked(
    key_value_option(
        "--columns",
        "--key-values",
        "columns",
        type=words,
        metavar="ID,ID,...",
        help="Key values of any command, by id or symbol; those of forces if not given.",
    ),
    click.option("--angles", "with_angles", is_flag=True, help="Also the crank angle of every extreme."),
    key_value_option(
        "--where",
        "conditions",
        multiple=True,
        metavar="CONDITION",
        help="Only rows with 'c_max < 5 m/s' or 'keeps = yes'.",
    ),
    key_value_option("--sort", metavar="ID", help="The smallest of this column first; -ID: the largest."),
    click.option("--top", type=click.IntRange(1), metavar="N", help="Only the first N rows of --sort."),
    key_value_option(
        "--pareto",
        type=words,
        metavar="ID,ID",
        help="Only rows that no other row betters; less is better, of -ID more.",
    ),
    click.option(
        "--summary",
        "summarised",
        is_flag=True,
        help="Quantiles, and rank correlation with every input, instead of rows.",
    ),
)
_where_it_goes = stacked(
    format_option("table", "csv", "json", "markdown", "parquet"),
    output_option,
    number_options,
    click.option(
        "--resume", is_flag=True, help="Continue from the FILE.part of a run of --output FILE that ended early."
    ),
)
_who_computes = stacked(
    click.option("--shard", metavar="K/N", help="Only this part of the rows; all parts in order make the whole."),
    click.option(
        "--jobs",
        "-j",
        type=click.IntRange(1),
        metavar="N",
        help="Processes; if not given, one for each of up to 4 cores where there are many rows.",
    ),
    click.option(
        "--dask", metavar="ADDRESS", help="Scheduler of a Dask cluster that computes, such as tcp://node:8786."
    ),
    click.option("--yes", is_flag=True, help="Compute more than ten million rows."),
)


@kurbel.command()
@machine_file
@_what_varies
@_what_is_printed
@units_option
@_where_it_goes
@_who_computes
def sweep(**options: Any) -> None:
    """Compute key values for many designs of the machine in FILE: one row each, inputs and results.

    Any dotted key of the file that holds a value may vary. A design that fails keeps its row, with the reason; where
    the file gives 'limits', each row shows whether it keeps them, and the first one that it breaks.
    """
    from kurbel.cli.sweeping import run_sweep

    run_sweep(**options)


@kurbel.command()
@machine_file
@click.argument("equations", metavar="['KEY_VALUE = value']...", nargs=-1, shell_complete=complete_ids)
@click.option(
    "--vary",
    multiple=True,
    required=True,
    metavar="KEY=LOW:HIGH",
    shell_complete=complete_override,
    help="The key whose value is sought, and its range: rod_ratio=3:6, 'stroke=700:900 mm'; two with two equations.",
)
@key_value_option("--least", default="", metavar="ID", help="Minimise this key value within the limits of FILE.")
@key_value_option("--greatest", default="", metavar="ID", help="Maximise this key value within the limits of FILE.")
@key_value_option("--where", "conditions", multiple=True, metavar="CONDITION", help="Only where 'c_max < 5 m/s'.")
@click.option("--plot", is_flag=True, help="Draw the key value over the key, in the terminal or with -o to a file.")
@click.option("--write", is_flag=True, help="Print FILE with the values found in it, and nothing else.")
@click.option("--take", type=click.IntRange(1), metavar="N", help="With --write, the solution of this number.")
@units_option
@format_option("table", "csv", "json", "markdown")
@output_option
@number_options
def find(**options: Any) -> None:
    """Find the values of a key of FILE for which a key value has the wanted value: all solutions in its range.

    It takes any key value of any command, and any dotted key of a number. Two --vary need two equations; --least and
    --greatest need none. Places where the key value jumps over the wanted one, and parts of the range in which designs
    fail, are reported. With --write, FILE is printed with what was found; comments stay.
    """
    from kurbel.cli.sweeping import run_find

    run_find(**options)
