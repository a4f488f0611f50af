"""`kurbel find`: which value of a key gives a required key value, or its minimum or maximum."""

from typing import Any

import click

from kurbel.cli.options import (
    complete_key_values,
    complete_override,
    key_value_option,
    machine_file,
    number_options,
    output_option,
    units_option,
)


@click.command()
@machine_file
@click.argument("equations", metavar="['KEY_VALUE = value']...", nargs=-1, shell_complete=complete_key_values)
@click.option(
    "--vary",
    multiple=True,
    required=True,
    metavar="KEY=LOW:HIGH",
    shell_complete=complete_override,
    help="The key whose value is sought, and its range: rod_ratio=3:6, 'stroke=700:900 mm'; two with two equations.",
)
@key_value_option("--least", metavar="ID", help="Minimise this key value within the limits of FILE.")
@key_value_option("--greatest", metavar="ID", help="Maximise this key value within the limits of FILE.")
@key_value_option("--where", "conditions", multiple=True, metavar="CONDITION", help="Only where 'c_max < 5 m/s'.")
@click.option("--plot", is_flag=True, help="Draw the key value over the key, in the terminal or with -o to a file.")
@click.option("--write", is_flag=True, help="Print FILE with the values found in it, and nothing else.")
@click.option("--take", type=click.IntRange(1), metavar="N", help="With --write, the solution of this number.")
@units_option
@click.option(
    "--format", "-f", "format", type=click.Choice(["table", "csv", "json", "markdown"]), help="As the suffix."
)
@output_option
@number_options
def find(**options: Any) -> None:
    """Find the values of a key of FILE for which a key value has the wanted value, all in the range.

    Any key value of any command, any dotted key of a number. Two --vary take two equations; --least and --greatest take
    none. Places where the key value jumps over the wanted one, and parts of the range in which designs fail, are
    reported. With --write, FILE is printed with what was found; comments stay.
    """
    from kurbel.cli.finding import FindOptions, run

    run(FindOptions(**options))
