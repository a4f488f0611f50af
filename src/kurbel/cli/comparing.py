"""What `kurbel accuracy` does: methods compared in scenes or on a machine, or extreme machines run."""

import click

from kurbel.cli.group import Progress
from kurbel.cli.request import case_of
from kurbel.machine_file import loads
from kurbel.pictures.accuracy import accuracy_picture
from kurbel.render.drawing import check_file, draw_file
from kurbel.render.formats import Output
from kurbel.report.accuracy import accuracy_report, extremes_report


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
            raise click.UsageError("--extremes has its own machines and no picture; leave FILE and --plot out.")
        report, passed = extremes_report(loads)
        output.write(report)
        return int(not passed)
    if picture is not None:
        check_file(picture, "--plot")
    machine = None if file is None else case_of(file, case_name, overrides, output.file_name, picture).machine
    with Progress("accuracy") as progress:
        report = accuracy_report(machine, quick, loads, progress)
    output.write(report)
    if picture is not None:
        draw_file([accuracy_picture(report)], output.look, picture)
    return 0
