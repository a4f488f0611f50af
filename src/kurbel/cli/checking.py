"""What `kurbel check` does with its files: each is read and checked, and all that is found is written."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from kurbel.checks.check import Checked, Finding, checked, faults_found, findings
from kurbel.cli.group import DONE, message_of, to_stderr
from kurbel.designs.uncertainty import given_uncertainty
from kurbel.errors import KurbelError
from kurbel.machine import Machine
from kurbel.machine_file import load
from kurbel.machine_file.events import located
from kurbel.machine_file.reader import load_cases
from kurbel.render import Look
from kurbel.render.json_text import findings_json, findings_junit
from kurbel.render.output import listing, look_at, refuse_overwriting, write_out
from kurbel.report.commands import BROKEN
from kurbel.solver.case import Case
from kurbel.tables.frame import provenance

_GRAVEST = 2, 3, BROKEN, DONE
"""Exit statuses, of which the first is that of several files."""


class Outcome(NamedTuple):
    """What is found of a file: a machine with its checks, or why it cannot be read; error: of its limits, too."""

    file: str
    error: KurbelError | None = None
    machine: Machine | None = None
    checked: Checked | None = None

    @property
    def status(self) -> int:
        """The exit status of a check of this file alone."""
        if self.error:
            return self.error.exit_status
        return BROKEN if self.checked and self.checked.broken else DONE

    @property
    def findings(self) -> list[Finding]:
        """All findings in the file, or why it cannot be read."""
        if self.machine and self.checked:
            return findings(self.machine, self.checked, located)
        return faults_found(self.file, self.error or KurbelError())


def check_files(
    files: Sequence[str],
    case_name: str,
    overrides: Sequence[str],
    format: str,
    file_name: str | None,
    width: int | None,
) -> int:
    """Check machine files, write what is found as `table`, `json` or `junit`, and return the exit status.

    Raises UsageError where the output would overwrite what is read, and the error of an only file.
    """
    refuse_overwriting(file_name, files)
    outcomes = [_outcome(file, case_name, overrides, file_name) for file in files]
    look = look_at(file_name, Look(width=width))
    if format == "table":
        write_out(_as_text(outcomes, look), file_name)
        for error in (outcome.error for outcome in outcomes if outcome.error):
            if len(files) == 1:
                raise error
            to_stderr(message_of(error))
    else:
        found = [
            (outcome.file, [finding._asdict() for finding in outcome.findings])
            for outcome in outcomes
        ]
        if format == "junit":
            write_out(findings_junit(found, look._replace(encoding="utf-8")), file_name, "utf-8")
        else:
            only = outcomes[0].machine if len(outcomes) == 1 else None
            name, made_from = (only.name, provenance(only)) if only else (None, None)
            listed = [finding for _, each in found for finding in each]
            write_out(findings_json(name, made_from, listed, look), file_name)
    return min((outcome.status for outcome in outcomes), key=_GRAVEST.index)


def _outcome(file: str, case_name: str, overrides: Sequence[str], file_name: str | None) -> Outcome:
    """Read and check one machine; raises UsageError where the output would overwrite a trace that it names."""
    try:
        machine = load(file, tuple(overrides), case_name)
        if machine.uncertainty:  # is judged by what is in the file
            given_uncertainty(machine)
        names = [case.name for case in machine.cases] if not case_name else []
        cases = (
            [Case(load_case) for load_case in load_cases(machine.origin, names)]
            if machine.origin
            else []
        )
    except KurbelError as error:
        return Outcome(file, error)
    refuse_overwriting(file_name, machine.trace_files)
    found = checked(Case(machine), cases)
    errors = [one.error for one in found.unjudged if one.error]
    # all errors of a machine as one of the gravest kind
    gravest = (
        type(min(errors, key=lambda error: error.exit_status))("\n".join(map(str, errors)))
        if errors
        else None
    )
    return Outcome(file, gravest, machine, found)


def _as_text(outcomes: Sequence[Outcome], look: Look) -> Iterator[str]:
    """Yield the listing of every machine that could be read; of several each after the name of its file."""
    for number, one in enumerate(outcomes):
        if one.checked:
            topics = [
                (topic.title, [(entry.what, entry.text) for entry in topic.entries])
                for topic in one.checked.shown_once
            ]
            several = f"{one.file}: " if len(outcomes) > 1 else ""
            yield "\n" * (number > 0) + listing(several + one.checked.title, topics, look)
