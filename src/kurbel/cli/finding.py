"""What `kurbel find` does with its options: searches, and prints, draws or writes what is found."""

import json
from typing import NamedTuple

import click

from kurbel.cli.group import Progress, to_stderr
from kurbel.cli.options import format_of
from kurbel.designs.find import Solution, Solutions
from kurbel.designs.find import find as found_in
from kurbel.machine.origin import Origin
from kurbel.machine_file import source
from kurbel.machine_file.overrides import rewritten
from kurbel.render import Look
from kurbel.render.drawing import check_file, draw
from kurbel.render.findings import as_json, as_rows, columns, picture, remarks
from kurbel.render.output import refuse_overwriting, write_out
from kurbel.render.sweep_rows import Titles, write_rows

_SUFFIXES = {".csv": "csv", ".json": "json", ".md": "markdown"}
_DIGITS = 7
"""Significant digits of a table: values are found to be written into a file."""


class FindOptions(NamedTuple):
    """The options of the command, by their names."""

    file: str
    case_name: str
    overrides: tuple[str, ...]
    equations: tuple[str, ...]
    vary: tuple[str, ...]
    least: str | None
    greatest: str | None
    conditions: tuple[str, ...]
    plot: bool
    write: bool
    take: int | None
    units: str | None
    format: str | None
    file_name: str | None
    decimal: str
    digits: int | None


def run(options: FindOptions) -> None:
    """Search for what is wanted, and print, draw or write it. Raises UsageError, NoSolutionError."""
    if options.write and (options.case_name or options.format):
        raise click.UsageError(f"--write prints FILE; leave {'--case' if options.case_name else '--format'} out.")
    if options.take and not options.write:
        raise click.UsageError("--take chooses the solution for --write; give --write too.")
    if options.plot and (options.write or options.format):
        raise click.UsageError(f"--plot draws; leave {'--write' if options.write else '--format'} out.")
    if options.plot and len(options.vary) > 1:
        raise click.UsageError("--plot draws a key value over one key, and two are varied.")
    if options.plot and options.file_name:
        check_file(options.file_name)
    written = "table" if options.write or options.plot else format_of(options.format, options.file_name, _SUFFIXES)
    if options.decimal == "comma" and written == "json":
        raise click.UsageError("--decimal comma: JSON has the decimal point only.")
    refuse_overwriting(options.file_name, (options.file,))
    origin = source.read(options.file)._replace(case=options.case_name).set_over(options.overrides)
    least, greatest = options.least or "", options.greatest or ""
    with Progress("find") as progress:
        found = found_in(origin, options.vary, options.equations, least, greatest, options.conditions, progress)
    if options.write:
        write_out([_with_values(origin, found, _taken(found, options.take))], options.file_name, "utf-8")
        return
    system = options.units or ("si" if written in ("csv", "json") else "metric")
    if options.plot:
        draw([picture(found, system)], Look(comma=options.decimal == "comma", digits=options.digits), options.file_name)
    elif written == "json":
        write_out(
            [json.dumps(as_json(found), ensure_ascii=False, allow_nan=False, indent=1) + "\n"],
            options.file_name,
            "utf-8",
        )
    else:
        look = Look(
            written, comma=options.decimal == "comma", digits=options.digits or (None if written == "csv" else _DIGITS)
        )
        titles = Titles(tuple((name, unit) for name, unit, _ in columns(found, system)))
        write_rows(iter(as_rows(found, system)), titles, look, options.file_name, to_stderr)
    for one in remarks(found):
        to_stderr(one)


def _taken(found: Solutions, take: int | None) -> Solution:
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


def _with_values(origin: Origin, found: Solutions, one: Solution) -> str:
    """Return the text of the machine file with what was set over it, and what was found."""
    values = dict(text.split("=", 1) for text in origin.overrides)
    for key, value in zip(found.varied, one.values):
        values[key.key] = f"{key.in_unit(value)!r} {key.unit}".rstrip()
    return rewritten(origin.text, values)
