"""What `kurbel accuracy` does: methods compared in scenes or on a machine, or extreme machines run."""

import math

import click

from kurbel.cli.group import ProgressLine
from kurbel.cli.request import case_of
from kurbel.designs.api import find, sweep
from kurbel.machine import Machine
from kurbel.machine_file import loads
from kurbel.pictures.accuracy import accuracy_picture
from kurbel.render.drawing import check_file, draw_file
from kurbel.render.formats import Output
from kurbel.report.accuracy import accuracy_report, answer, extremes_report


def compare(
    file: str | None,
    case_name: str,
    overrides: tuple[str, ...],
    quick: bool,
    extremes: bool,
    picture: str | None,
    output: Output,
) -> int:
    """Write the report and the picture, and return the exit status: the options of the command."""
    if (case_name or overrides) and file is None:
        raise click.UsageError("--case and --set are values over those of FILE; give the FILE.")
    if extremes:
        if file is not None or picture is not None:
            raise click.UsageError(
                "--extremes has its own machines and no picture; leave FILE and --plot out."
            )
        report, passed = extremes_report(loads, answer_of)
        output.write(report)
        return int(not passed)
    if picture is not None:
        check_file(picture, "--plot")
    machine = None
    if file is not None:
        machine = case_of(file, case_name, overrides, output.file_name, picture).machine
    with ProgressLine("accuracy") as progress:
        report = accuracy_report(machine, quick, loads, progress)
    output.write(report)
    if picture is not None:
        draw_file([accuracy_picture(report)], output.look, picture)
    return 0


def answer_of(machine: Machine, request: str) -> float | None:
    """Return what the program gives for a request of `kurbel.accuracy.extremes`, in SI; None where it is left out."""
    command, _, arguments = request.partition(" ")
    if command not in ("find", "sweep"):
        return answer(machine, request)
    # 'find KEY=LOW:HIGH | EQUATION', 'sweep KEY=VALUES | COLUMN[ROW]'
    axis, _, wanted = arguments.partition(" | ")
    key, _, values = axis.partition("=")
    if command == "find":
        low, high = values.split(":")
        solutions = find(machine, {key: (low, high)}, wanted)
        return float(solutions.found[0].values[0])
    column, _, row = wanted.rstrip("]").partition("[")
    rows = sweep(machine, {key: values.split(",")}, column)
    value = float(rows[column][int(row)])
    return None if math.isnan(value) else value
