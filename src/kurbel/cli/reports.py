"""The commands that report on a machine, each made from its row of `COMMANDS`."""

from collections.abc import Callable
from typing import Any

import click

from kurbel.cli.options import (
    Command,
    CommandWithKeyValues,
    angle_options,
    columns_option,
    frequency,
    machine_file,
    orders_option,
    output_options,
    part_options,
    row_options,
    speeds_option,
    stacked,
    uncertainty_option,
    units_option,
    where_option,
)
from kurbel.render.formats import Output
from kurbel.report.commands import Command as Row

_OF_EVERY = "Key values are exact, whichever rows are printed. FILE may be - for standard input."
_cases_option = click.option(
    "--cases",
    is_flag=True,
    help="A row of key values for every load case of FILE, those of --columns if given.",
)


def _instead(name: str, text: str) -> Callable[[Command], Command]:
    """Return a flag that asks for other tables instead of that over the crank angle; its value is its name."""
    return click.option(name, "instead", is_flag=True, flag_value=name, default="", help=text)


_SHARED = {"where": stacked(where_option), "uncertainty": stacked(uncertainty_option)}
"""What the rows of commands call options that several commands take."""
_shaft_angle_option = click.option(
    "--shaft-angle",
    is_flag=True,
    help="Rows of every cylinder at the same angles of crank 1, not of its own crank; no key values.",
)
_OF_COMMAND = {
    "motion": stacked(row_options, _shaft_angle_option),
    "forces": stacked(
        row_options,
        _shaft_angle_option,
        click.option(
            "--cycle",
            type=click.IntRange(min=1),
            metavar="N",
            help="This measured cycle of a trace, not their mean.",
        ),
        _instead(
            "--each-cycle", "A line for every measured cycle instead of the table over the angle."
        ),
    ),
    "stress": stacked(
        _instead("--places", "Only the stresses place by place; as csv one line each.")
    ),
    "balance": stacked(
        click.option(
            "--compare",
            is_flag=True,
            help="Also by the textbook formula cos phi + R/L cos 2phi (R 291).",
        ),
        _instead("--orders", "Only the tables of orders and weights, and key values."),
    ),
    "harmonics": stacked(orders_option, speeds_option),
    "torsion": stacked(
        orders_option,
        speeds_option,
        click.option(
            "--modes",
            type=click.IntRange(1, 100),
            default=3,
            help="Critical speeds of so many modes; 3 if not given.",
        ),
        click.option(
            "--mode", type=click.IntRange(1), help="The mode of Holzer's table; 1 if not given."
        ),
        click.option(
            "--at",
            type=frequency,
            metavar="'F Hz'",
            help="Holzer's table at this frequency, with its residual torque, instead of a mode.",
        ),
    ),
}
"""Options beyond those of every command; the report gets them by name, but for those that `print_report` has."""


def command_of(row: Row) -> click.Command:
    """Return the command of a row, with FILE and the options that its report needs."""

    def run(units: str | None, output: Output, **options: Any) -> None:
        from kurbel.cli.request import print_report

        usual_system = "si" if output.look.format in ("csv", "json") else "metric"
        print_report(row.word, output, units=units or usual_system, **options)

    # the options, in the order of the help
    options: list[Callable[..., Any]] = [machine_file]
    if row.over_angle:
        options += [angle_options, columns_option]
    options += [part_options, units_option, output_options]
    if row.in_cases:
        options.append(_cases_option)
    options += [_SHARED[word] for word in row.options]
    if row.word in _OF_COMMAND:
        options.append(_OF_COMMAND[row.word])
    text = f"{row.of.__doc__}\n\n    {_OF_EVERY}"
    command = click.command(row.word, cls=CommandWithKeyValues, help=text)
    return command(stacked(*options)(run))
