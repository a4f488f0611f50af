"""The commands on many designs of a machine: sweeps, and the search for a key value."""

from typing import Any

import click

from kurbel.cli.group import kurbel
from kurbel.cli.options import (
    KEY_VALUES,
    CommandWithKeyValues,
    complete_ids,
    complete_override,
    format_option,
    key_value_option,
    key_values,
    machine_file,
    number_options,
    output_option,
    stacked,
    units_option,
    words,
)

_what_varies = stacked(
    click.option(
        "--vary",
        multiple=True,
        metavar="KEY=VALUES",
        shell_complete=complete_override,
        help="rod_ratio=3:6:0.25, speed=40,50,60 rpm, bore=normal(450 mm, 0.2 mm) or uniform(...); may be repeated, "
        "for all combinations; in one, 'bore=400,450 mm; head_end_rod=70,80 mm' go together.",
    ),
    click.option(
        "--cases", is_flag=True, help="Every load case of FILE, by itself or with every --vary."
    ),
    click.option(
        "--zip",
        "side_by_side",
        is_flag=True,
        help="First values with first values; else all combinations.",
    ),
    click.option(
        "--sample",
        type=click.IntRange(1, 10**8),
        metavar="N",
        help="Points of a Latin hypercube of distributions.",
    ),
    click.option(
        "--seed", type=click.IntRange(0), default=0, help="Seed of the sample; 0 if not given."
    ),
)
_what_is_printed = stacked(
    key_value_option(
        "--columns",
        KEY_VALUES,
        "columns",
        type=key_values,
        metavar="IDS",
        help="Key values of any command, by id or symbol; those of forces if not given.",
    ),
    click.option(
        "--angles", "with_angles", is_flag=True, help="Also the crank angle of every extreme."
    ),
    key_value_option(
        "--where",
        "conditions",
        multiple=True,
        metavar="CONDITION",
        help="Only rows with 'c_max < 5 m/s' or 'keeps = yes'.",
    ),
    key_value_option(
        "--sort", metavar="ID", help="The smallest of this column first; -ID: the largest."
    ),
    click.option(
        "--top", type=click.IntRange(1), metavar="N", help="Only the first N rows of --sort."
    ),
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
    format_option("table", "csv", "json", "xlsx", "markdown"),
    output_option,
    number_options,
    click.option(
        "--resume",
        is_flag=True,
        help="Continue from the FILE.part of a run of --output FILE that ended early.",
    ),
)
_who_computes = stacked(
    click.option(
        "--shard",
        metavar="K/N",
        help="Only this part of the rows; all parts in order make the whole.",
    ),
    click.option(
        "--jobs",
        "-j",
        type=click.IntRange(1),
        metavar="N",
        help="Processes; if not given, one for each of up to 4 cores where there are many rows.",
    ),
    click.option(
        "--dask",
        metavar="ADDRESS",
        help="Scheduler of a Dask cluster that computes, such as tcp://node:8786.",
    ),
    click.option("--yes", is_flag=True, help="Compute more than ten million rows."),
)


@kurbel.command(cls=CommandWithKeyValues)
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
@click.argument(
    "equations", metavar="['KEY_VALUE = value']...", nargs=-1, shell_complete=complete_ids
)
@click.option(
    "--vary",
    multiple=True,
    required=True,
    metavar="KEY=LOW:HIGH",
    shell_complete=complete_override,
    help="The key whose value is sought, and its range: rod_ratio=3:6, 'stroke=700:900 mm'; two with two equations.",
)
@key_value_option(
    "--least", default="", metavar="ID", help="Minimise this key value within the limits of FILE."
)
@key_value_option(
    "--greatest",
    default="",
    metavar="ID",
    help="Maximise this key value within the limits of FILE.",
)
@key_value_option(
    "--where", "conditions", multiple=True, metavar="CONDITION", help="Only where 'c_max < 5 m/s'."
)
@click.option(
    "--plot",
    is_flag=True,
    help="Draw the key value over the key, in the terminal or with -o to a file.",
)
@click.option(
    "--write", is_flag=True, help="Print FILE with the values found in it, and nothing else."
)
@click.option(
    "--take", type=click.IntRange(1), metavar="N", help="With --write, the solution of this number."
)
@units_option
@format_option("table", "csv", "json", "xlsx", "markdown")
@output_option
@number_options
def find(**options: Any) -> None:
    """Find the values of a key of FILE for which a key value has the wanted value: all solutions in its range.

    It takes any key value of any command, and any dotted key of a number. Two --vary need two equations; --least and
    --greatest need none. Places where the key value jumps over the wanted one, and parts of the range in which designs
    fail, are reported. With --write, FILE is printed with what was found; comments stay.
    """
    from kurbel.cli.finding import run_find

    run_find(**options)
