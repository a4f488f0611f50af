"""`kurbel check`: reads a machine, says what will be computed, and holds it against its limits."""

from dataclasses import replace
from typing import TYPE_CHECKING

import click

from kurbel.cli import BROKEN, DONE
from kurbel.cli.output_options import format_of, loaded, machine_file, output_option, width_option
from kurbel.errors import KurbelError
from kurbel.render import Look

if TYPE_CHECKING:
    from kurbel.machine import Machine


@click.command()
@machine_file
@click.option(
    "--format",
    "-f",
    "format",
    type=click.Choice(["table", "json"]),
    help="json: every finding with its place. By the suffix of --output, or table, if not given.",
)
@output_option
@width_option
def check(file: str, overrides: tuple[str, ...], format: str | None, file_name: str | None, width: int | None) -> int:
    """Read the machine in FILE and say what will be computed, what is left out and why.

    Where the file gives 'limits', hold the key values to them; where it gives 'expect', compare them with the figures
    there. As json every fault, limit, figure and warning has file, line, column, key, message and severity.
    """
    from kurbel.report.check import checked
    from kurbel.solver.case import Case

    written = format_of(format, file_name)
    if written == "json":
        return _as_json(file, overrides, file_name)
    if written != "table":
        raise click.UsageError(f"kurbel check writes table or json, no {written}; give {file_name} another suffix.")
    from kurbel.render.output import stdout_look, write_out
    from kurbel.render.page import listing

    result = checked(Case(_loaded(file, overrides, file_name)))
    look = Look() if file_name else stdout_look()
    look = replace(look, width=width or look.width)
    sections = [(one.title, [(entry.what, entry.text) for entry in one.entries]) for one in result.told_once]
    write_out((listing(result.title, sections, look),), file_name)
    if result.errors:  # all of them, as one of the gravest kind
        gravest = min(result.errors, key=lambda error: error.exit_status)
        raise type(gravest)("\n".join(map(str, result.errors)))
    return BROKEN if result.broken else DONE


def _loaded(file: str, overrides: tuple[str, ...], file_name: str | None = None) -> "Machine":
    """Read the machine, whose uncertainties are told of what stands in the file."""
    machine = loaded(file, overrides, file_name)
    if machine.uncertainty:
        from kurbel.designs.uncertainty import given_uncertainty

        given_uncertainty(machine)
    return machine


def _as_json(file: str, overrides: tuple[str, ...], file_name: str | None) -> int:
    """Write all findings, those of a file that cannot be read, too, and return the status."""
    from kurbel.machine_file.positions import located
    from kurbel.render.data import findings_json
    from kurbel.render.output import refuse_overwriting, stdout_look, write_out
    from kurbel.report.check import checked, faults_found, findings
    from kurbel.solver.case import Case

    refuse_overwriting(file_name, (file,))
    try:
        machine = _loaded(file, overrides)
    except KurbelError as error:
        found, status = faults_found(file, error), error.exit_status
    else:
        refuse_overwriting(file_name, machine.trace_files)
        result = checked(Case(machine))
        found = findings(machine, result, located)
        status = min((error.exit_status for error in result.errors), default=BROKEN if result.broken else DONE)
    listed = [one._asdict() for one in found.findings]
    write_out(findings_json(found.machine, found.provenance, listed, Look() if file_name else stdout_look()), file_name)
    return status
