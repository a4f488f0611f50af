"""`kurbel check`: reads machines, says what will be computed, and holds each against its limits."""

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

import click

from kurbel.cli.group import DONE, message_of, to_stderr
from kurbel.cli.options import format_of, loaded, output_option, set_options, width_option
from kurbel.errors import Fault, KurbelError, MachineFileError
from kurbel.render import Look
from kurbel.report.commands import BROKEN

if TYPE_CHECKING:
    from kurbel.machine import Machine
    from kurbel.machine.origin import Origin
    from kurbel.report.check import Checked

_GRAVEST = 2, 3, BROKEN, DONE
"""Exit statuses, of which the first is the answer to several files."""


class _Outcome(NamedTuple):
    """What is found of a file: a machine with its checks, or why it cannot be read."""

    file: str
    machine: "Machine | None" = None
    checked: "Checked | None" = None
    error: KurbelError | None = None

    @property
    def status(self) -> int:
        """The exit status that a run of this file alone ends with."""
        errors = [self.error] if self.error else self.checked.errors if self.checked else []
        broken = self.checked and self.checked.broken
        return min((error.exit_status for error in errors), default=BROKEN if broken else DONE)


@click.command()
@click.argument("files", metavar="FILE...", nargs=-1, required=True, type=click.Path(allow_dash=True))
@set_options
@click.option(
    "--format",
    "-f",
    "format",
    type=click.Choice(["table", "json"]),
    help="json: every finding with its place. By the suffix of --output, or table, if not given.",
)
@output_option
@width_option
def check(
    files: tuple[str, ...],
    case_name: str,
    overrides: tuple[str, ...],
    format: str | None,
    file_name: str | None,
    width: int | None,
) -> int:
    """Read the machine in each FILE and say what will be computed, what is left out and why.

    Where the file gives 'limits', hold the key values to them, in every one of its 'cases'; where it gives 'expect',
    compare them with the figures there. As json every fault, limit, figure and warning has file, line, column, key,
    message and severity. Of several files all are checked; the exit status is the gravest one.
    """
    from kurbel.render.output import refuse_overwriting, stdout_look, write_out

    written = format_of(format, file_name)
    if written not in ("table", "json"):
        raise click.UsageError(f"kurbel check writes table or json, no {written}; give {file_name} another suffix.")
    refuse_overwriting(file_name, files)
    outcomes = [_outcome(file, case_name, overrides, file_name) for file in files]
    look = Look(width=width) if file_name else stdout_look(Look(width=width))
    if written == "json":
        write_out(_as_json(outcomes, look), file_name)
    else:
        write_out(_as_text(outcomes, look), file_name)
        for error in filter(None, map(_error, outcomes)):
            if len(files) == 1:
                raise error
            to_stderr(message_of(error))
    return min((outcome.status for outcome in outcomes), key=_GRAVEST.index)


def _outcome(file: str, case_name: str, overrides: tuple[str, ...], file_name: str | None) -> _Outcome:
    """Read and check one machine; raises UsageError where the output would overwrite a trace that it names."""
    from kurbel.designs.uncertainty import given_uncertainty
    from kurbel.render.output import refuse_overwriting
    from kurbel.report.check import checked
    from kurbel.solver.case import Case

    try:
        machine = loaded(file, case_name, overrides)
        if machine.uncertainty:  # is judged by what is in the file
            given_uncertainty(machine)
        origin = machine.origin
        names = [one.name for one in machine.cases] if not case_name else []
        cases = [*map(Case, _of_cases(origin, names))] if origin else []
    except KurbelError as error:
        return _Outcome(file, error=error)
    refuse_overwriting(file_name, machine.trace_files)
    return _Outcome(file, machine, checked(Case(machine), cases))


def _of_cases(origin: "Origin", names: Iterable[str]) -> "list[Machine]":
    """Return the machine of each load case; raises MachineFileError with the faults of all of them."""
    from kurbel.machine_file.reader import read_machine

    machines: list[Machine] = []
    faults: list[Fault] = []
    for name in names:
        try:
            machines.append(read_machine(origin._replace(case=name)))
        except MachineFileError as error:
            faults += error.faults
    if faults:
        raise MachineFileError(origin.name, sorted(dict.fromkeys(faults), key=lambda one: (one.line, one.column)))
    return machines


def _error(outcome: _Outcome) -> KurbelError | None:
    """Return why a file cannot be read, or all errors of its machine as one of the gravest kind."""
    if not outcome.checked or not outcome.checked.errors:
        return outcome.error
    gravest = min(outcome.checked.errors, key=lambda error: error.exit_status)
    return type(gravest)("\n".join(map(str, outcome.checked.errors)))


def _as_text(outcomes: list[_Outcome], look: Look) -> Iterator[str]:
    """Yield the listing of every machine that could be read; of several each after the name of its file."""
    from kurbel.render.page import listing

    for number, outcome in enumerate(outcomes):
        if outcome.checked:
            sections = [
                (one.title, [(entry.what, entry.text) for entry in one.entries]) for one in outcome.checked.shown_once
            ]
            several = f"{outcome.file}: " if len(outcomes) > 1 else ""
            yield "\n" * (number > 0) + listing(several + outcome.checked.title, sections, look)


def _as_json(outcomes: list[_Outcome], look: Look) -> Iterator[str]:
    """Return all findings, those of files that cannot be read, too."""
    from kurbel.machine_file.events import located
    from kurbel.render.data import findings_json
    from kurbel.report.check import faults_found, findings

    found = [
        findings(one.machine, one.checked, located)
        if one.machine and one.checked
        else faults_found(one.file, one.error or KurbelError())
        for one in outcomes
    ]
    listed = [finding._asdict() for one in found for finding in one.findings]
    name, made_from = (found[0].machine, found[0].provenance) if len(found) == 1 else (None, None)
    return findings_json(name, made_from, listed, look)
