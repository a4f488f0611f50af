"""What `kurbel find` does with its options: search, and draw or write what is found."""

import json

import click

from kurbel.cli.group import ProgressLine, to_stderr
from kurbel.cli.options import format_of, refuse_contradictions
from kurbel.designs.find import Solution, Solutions, find_solutions
from kurbel.machine.origin import Origin
from kurbel.machine_file import source
from kurbel.machine_file.overrides import rewritten
from kurbel.render import Look
from kurbel.render.drawing import check_file, draw_output
from kurbel.render.output import refuse_overwriting, write_out
from kurbel.render.solutions import as_json, as_rows, picture, remarks
from kurbel.render.sweep_rows import write_rows

_SUFFIXES = {".csv": "csv", ".json": "json", ".xlsx": "xlsx", ".md": "markdown"}
_DIGITS = 7
"""Significant digits of a table: values are found to be written into a file."""


def run_find(
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
    refuse_contradictions(
        (write and case_name, "--write prints FILE; leave --case out."),
        (write and format, "--write prints FILE; leave --format out."),
        (take and not write, "--take chooses the solution for --write; give --write too."),
        (plot and write, "--plot draws; leave --write out."),
        (plot and format, "--plot draws; leave --format out."),
        (plot and len(vary) > 1, "--plot draws a key value over one key, and two are varied."),
    )
    if plot and file_name:
        check_file(file_name)
    written = "table"
    if not write and not plot:
        written = format_of(format, file_name, _SUFFIXES, comma)
    refuse_overwriting(file_name, (file,))
    origin = source.read(file)._replace(case=case_name).set_over(overrides)
    with ProgressLine("find") as progress:
        solutions = find_solutions(origin, vary, equations, least, greatest, conditions, progress)
    if write:
        solution = _solution_to_write(solutions, take)
        write_out([_with_values(origin, solutions, solution)], file_name, "utf-8")
        return

    usual_system = "si" if written in ("csv", "json") else "metric"
    system = units or usual_system
    if plot:
        draw_output([picture(solutions, system)], Look(comma=comma, digits=digits), file_name)
    elif written == "json":
        text = json.dumps(as_json(solutions), ensure_ascii=False, allow_nan=False, indent=1)
        write_out([text + "\n"], file_name, "utf-8")
    else:
        usual_digits = None if written in ("csv", "xlsx") else _DIGITS
        look = Look(written, comma=comma, digits=digits or usual_digits)
        titles, rows = as_rows(solutions, system)
        write_rows(rows, titles, look, file_name, to_stderr)
    for remark in remarks(solutions):
        to_stderr(remark)


def _solution_to_write(solutions: Solutions, take: int | None) -> Solution:
    """Return the solution that is written. Raises click.UsageError where several are found, or none of this number."""
    count = len(solutions.found)
    if count > 1 and not take:
        choices = "; ".join(_in_words(solutions, solution) for solution in solutions.found)
        raise click.UsageError(f"--write: {count} solutions; choose one by --take N: {choices}")
    number = take or 1
    if number > count:
        verb = "are" if count > 1 else "is"
        raise click.UsageError(f"--take {take}: there {verb} {count}.")
    return solutions.found[number - 1]


def _in_words(solutions: Solutions, solution: Solution) -> str:
    """Return the values of the varied keys, as in `bore = 450 mm, stroke = 600 mm`."""
    equations = [
        f"{varied.key} = {varied.written(value, 9)}"
        for varied, value in zip(solutions.varied, solution.values)
    ]
    return ", ".join(equations)


def _with_values(origin: Origin, solutions: Solutions, solution: Solution) -> str:
    """Return the text of the machine file with what was set over it, and what was found."""
    texts = dict(text.split("=", 1) for text in origin.overrides)
    for varied, value in zip(solutions.varied, solution.values):
        texts[varied.key] = f"{varied.in_unit(value)!r} {varied.unit}".rstrip()
    return rewritten(origin.text, texts)
