"""`kurbel find`: which value of a key gives a wanted key value, or the least or the greatest one."""

import json
from typing import TYPE_CHECKING

import click

from kurbel.cli.group import to_stderr
from kurbel.cli.options import (
    complete_override,
    format_of,
    machine_file,
    number_options,
    output_option,
    units_option,
)
from kurbel.render import Look

if TYPE_CHECKING:
    from kurbel.designs.find import Solution, Solutions
    from kurbel.machine.origin import Origin

_SUFFIXES = {".csv": "csv", ".json": "json", ".md": "markdown"}
_DIGITS = 7
"""Significant digits of a table: values are found to be written into a file."""


@click.command()
@machine_file
@click.argument("equations", metavar="['KEY_VALUE = value']...", nargs=-1)
@click.option(
    "--vary",
    multiple=True,
    required=True,
    metavar="KEY=LOW:HIGH",
    shell_complete=complete_override,
    help="The key whose value is sought, and its range: rod_ratio=3:6, 'stroke=700:900 mm'; two with two equations.",
)
@click.option("--least", metavar="ID", help="Where this key value is least, within the limits of FILE.")
@click.option("--greatest", metavar="ID", help="Where this key value is greatest, within the limits of FILE.")
@click.option("--where", "conditions", multiple=True, metavar="CONDITION", help="Only where 'c_max < 5 m/s'.")
@click.option("--plot", is_flag=True, help="Draw the key value over the key, in the terminal or with -o to a file.")
@click.option("--write", is_flag=True, help="Print FILE with the values found in it, and nothing else.")
@click.option("--take", type=click.IntRange(1), metavar="N", help="With --write, the solution of this number.")
@units_option
@click.option(
    "--format", "-f", "format", type=click.Choice(["table", "csv", "json", "markdown"]), help="As the suffix."
)
@output_option
@number_options
def find(
    file: str,
    case_name: str,
    overrides: tuple[str, ...],
    equations: tuple[str, ...],
    vary: tuple[str, ...],
    least: str | None,
    greatest: str | None,
    conditions: tuple[str, ...],
    plot: bool,
    write: bool,
    take: int | None,
    units: str | None,
    format: str | None,
    file_name: str | None,
    decimal: str,
    digits: int | None,
) -> None:
    """Find the values of a key of FILE for which a key value has the wanted value, all in the range.

    Any key value of any command, any dotted key of a number. Two --vary take two equations; --least and --greatest take
    none. Places where the key value jumps over the wanted one, and parts of the range in which designs fail, are
    reported. With --write, FILE is printed with what was found; comments stay.
    """
    from kurbel.designs.find import find as found_in
    from kurbel.machine_file import source
    from kurbel.render.drawing import check_file, draw
    from kurbel.render.findings import as_json, as_rows, heads, picture, remarks
    from kurbel.render.output import refuse_overwriting, write_out
    from kurbel.render.sweep_rows import Titles, write_rows

    if write and (case_name or format):
        raise click.UsageError(f"--write prints FILE; leave {'--case' if case_name else '--format'} out.")
    if take and not write:
        raise click.UsageError("--take chooses the solution for --write; give --write too.")
    if plot and (write or format):
        raise click.UsageError(f"--plot draws; leave {'--write' if write else '--format'} out.")
    if plot and len(vary) > 1:
        raise click.UsageError("--plot draws a key value over one key, and two are varied.")
    if plot and file_name:
        check_file(file_name)
    written = "table" if write or plot else format_of(format, file_name, _SUFFIXES)
    if decimal == "comma" and written == "json":
        raise click.UsageError("--decimal comma: JSON has the decimal point only.")
    refuse_overwriting(file_name, (file,))
    origin = source.read(file)._replace(case=case_name).set_over(overrides)
    found = found_in(origin, vary, equations, least or "", greatest or "", conditions)
    if write:
        write_out([_with_values(origin, found, _taken(found, take))], file_name, "utf-8")
        return
    system = units or ("si" if written in ("csv", "json") else "metric")
    if plot:
        draw([picture(found, system)], Look(comma=decimal == "comma", digits=digits), file_name)
    elif written == "json":
        write_out(
            [json.dumps(as_json(found), ensure_ascii=False, allow_nan=False, indent=1) + "\n"], file_name, "utf-8"
        )
    else:
        look = Look(written, comma=decimal == "comma", digits=digits or (None if written == "csv" else _DIGITS))
        write_rows(iter(as_rows(found, system)), Titles(heads(found, system)), look, file_name, to_stderr)
    for one in remarks(found):
        to_stderr(one)


def _taken(found: "Solutions", take: int | None) -> "Solution":
    """Return the solution that is written. Raises click.UsageError where several are found, or none of this number."""
    count = len(found.found)
    if count > 1 and not take:
        each = "; ".join(
            ", ".join(
                f"{key.key} = {key.in_unit(value):.9g} {key.unit}".rstrip()
                for key, value in zip(found.varied, one.values)
            )
            for one in found.found
        )
        raise click.UsageError(f"--write: {count} solutions; choose one by --take N: {each}")
    if take and take > count:
        raise click.UsageError(f"--take {take}: there {'are' if count > 1 else 'is'} {count}.")
    return found.found[(take or 1) - 1]


def _with_values(origin: "Origin", found: "Solutions", one: "Solution") -> str:
    """Return the text of the machine file with what was set over it, and what was found."""
    from kurbel.machine_file.rewrite import rewritten

    values = dict(text.split("=", 1) for text in origin.overrides)
    for key, value in zip(found.varied, one.values):
        values[key.key] = f"{key.in_unit(value)!r} {key.unit}".rstrip()
    return rewritten(origin.text, values)
