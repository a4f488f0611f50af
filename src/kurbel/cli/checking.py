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
from kurbel.render.output import (
    listing,
    look_at,
    refuse_overwriting,
    write_entries,
    write_out,
)
from kurbel.report.commands import BROKEN
from kurbel.shipped import file_of
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
        is_broken = self.checked is not None and self.checked.broken
        return BROKEN if is_broken else DONE

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
    quiet: bool = False,
) -> int:
    """Check machine files, write what is found as `table`, `json` or `junit`, and return the exit status.

    quiet: of a table only limits and expectations that FAIL.

    Raises UsageError where the output would overwrite what is read, and the error of an only file.
    """
    refuse_overwriting(file_name, files)
    outcomes = [_outcome(file, case_name, overrides, file_name) for file in files]
    look = look_at(file_name, Look(width=width))
    if format == "table":
        write_out(_as_text(outcomes, look, quiet), file_name)
        for outcome in outcomes:
            if outcome.error and len(files) == 1:
                raise outcome.error
            if outcome.error:
                to_stderr(message_of(outcome.error))
    else:
        _write_findings(outcomes, format, look, file_name)
    return min((outcome.status for outcome in outcomes), key=_GRAVEST.index)


def check_shipped(names: Sequence[str], file_name: str | None) -> int:
    """Compare the expected figures of shipped machines, write a line for each, and return the exit status."""
    entries = list[tuple[str, str]]()
    statuses = [DONE]
    for name in names:
        outcome = _outcome(file_of(name), "", (), file_name)
        statuses.append(outcome.status)
        figures = []
        for topic in outcome.checked.sections if outcome.checked else ():
            figures += [entry for entry in topic.entries if entry.path[:1] == ("expect",)]
        failing = [entry.what for entry in figures if entry.severity == "error"]
        verdict = "PASS" if outcome.status == DONE else "FAIL"
        count = {0: "no expected figure", 1: "1 expected figure"}
        text = f"{verdict}  {count.get(len(figures), f'{len(figures)} expected figures')}"
        if failing:
            text += f", off: {', '.join(failing)}"
        if outcome.error:
            text += f"; {outcome.error}"
        entries.append((name, text))
    write_entries(entries, file_name)
    return min(statuses, key=_GRAVEST.index)


def _write_findings(
    outcomes: Sequence[Outcome], format: str, look: Look, file_name: str | None
) -> None:
    """Write all findings as `json` or `junit`."""
    rows = []
    for outcome in outcomes:
        rows.append((outcome.file, [finding._asdict() for finding in outcome.findings]))
    if format == "junit":
        write_out(findings_junit(rows, look._replace(encoding="utf-8")), file_name, "utf-8")
        return
    # the machine is named where there is only one
    name = made_from = None
    machine = outcomes[0].machine
    if machine and len(outcomes) == 1:
        name = machine.name
        made_from = provenance(machine)
    all_rows = []
    for _, rows_of_file in rows:
        all_rows += rows_of_file
    write_out(findings_json(name, made_from, all_rows, look), file_name)


def _outcome(file: str, case_name: str, overrides: Sequence[str], file_name: str | None) -> Outcome:
    """Read and check one machine; raises UsageError where the output would overwrite a trace that it names."""
    try:
        machine = load(file, tuple(overrides), case_name)
        if machine.uncertainty:  # is judged by what is in the file
            given_uncertainty(machine)
        cases: list[Case] = []
        if machine.origin and not case_name:
            names = [case.name for case in machine.cases]
            cases = list(map(Case, load_cases(machine.origin, names)))
    except KurbelError as error:
        return Outcome(file, error)
    refuse_overwriting(file_name, machine.trace_files)
    results = checked(Case(machine), cases)
    # all errors of a machine as one of the gravest kind
    errors = [entry.error for entry in results.unjudged if entry.error]
    if not errors:
        return Outcome(file, None, machine, results)
    gravest = min(errors, key=lambda error: error.exit_status)
    joined = type(gravest)("\n".join(map(str, errors)))
    return Outcome(file, joined, machine, results)


def _as_text(outcomes: Sequence[Outcome], look: Look, quiet: bool) -> Iterator[str]:
    """Yield the listing of every machine that could be read; of several each after the name of its file.

    quiet: what FAILs alone, a line each.
    """
    for number, outcome in enumerate(outcomes):
        if outcome.checked is None:
            continue
        if quiet:
            for topic in outcome.checked.sections:
                for entry in topic.entries:
                    if entry.severity == "error":
                        yield f"{look.text(f'{outcome.file}: {entry.what}: {entry.text}')}\n"
            continue
        topics = []
        for topic in outcome.checked.shown_once:
            entries = [(entry.what, entry.text) for entry in topic.entries]
            topics.append((topic.title, entries))
        title = outcome.checked.title
        if len(outcomes) > 1:
            title = f"{outcome.file}: {title}"
        blank_line = "\n" if number > 0 else ""
        yield blank_line + listing(title, topics, look)
