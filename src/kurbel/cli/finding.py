"""What `kurbel find` does with its options: searches, and prints, draws or writes what is found."""

import json

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


def run(
    file: str,
    case_name: str,
    overrides: tuple[str, ...],
    equations: tuple[str, ...],
    vary: tuple[str, ...],
    least: str,
    greatest: str,
    conditions: tuple[str, ...],
    plot: bool,
    write: bool,
    take: int | None,
    units: str | None,
    format: str | None,
    file_name: str | None,
    comma: bool,
    digits: int | None,
) -> None:
    """Search, and print, draw or write what is found: the options of the command. Raises KurbelError."""
    for wrong, message in (
        (write and case_name, "--write prints FILE; leave --case out."),
        (write and format, "--write prints FILE; leave --format out."),
        (take and not write, "--take chooses the solution for --write; give --write too."),
        (plot and write, "--plot draws; leave --write out."),
        (plot and format, "--plot draws; leave --format out."),
        (plot and len(vary) > 1, "--plot draws a key value over one key, and two are varied."),
    ):
        if wrong:
            raise click.UsageError(message)
    if plot and file_name:
        check_file(file_name)
    written = "table" if write or plot else format_of(format, file_name, _SUFFIXES, comma)
    refuse_overwriting(file_name, (file,))
    origin = source.read(file)._replace(case=case_name).set_over(overrides)
    with Progress("find") as progress:
        found = found_in(origin, vary, equations, least, greatest, conditions, progress)
    if write:
        write_out([_with_values(origin, found, _taken(found, take))], file_name, "utf-8")
        return
    system = units or ("si" if written in ("csv", "json") else "metric")
    if plot:
        draw([picture(found, system)], Look(comma=comma, digits=digits), file_name)
    elif written == "json":
        text = json.dumps(as_json(found), ensure_ascii=False, allow_nan=False, indent=1) + "\n"
        write_out([text], file_name, "utf-8")
    else:
        look = Look(written, comma=comma, digits=digits or (None if written == "csv" else _DIGITS))
        titles = Titles(tuple((name, unit) for name, unit, _ in columns(found, system)))
        write_rows(as_rows(found, system), titles, look, file_name, to_stderr)
    for one in remarks(found):
        to_stderr(one)


def _taken(found: Solutions, take: int | None) -> Solution:
    """Return the solution that is written. Raises click.UsageError where several are found, or none of this number."""
    count = len(found.found)
    if count > 1 and not take:
        each = "; ".join(
            ", ".join(f"{key.key} = {key.written(value, 9)}" for key, value in zip(found.varied, one.values))
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
