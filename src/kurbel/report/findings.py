"""What a check has found, each finding with its place in the machine file: for programs."""

from collections.abc import Callable
from typing import NamedTuple

from kurbel.errors import Fault, KurbelError, MachineFileError, Path, path_text
from kurbel.machine import Machine
from kurbel.report.check import Checked
from kurbel.report.provenance import provenance
from kurbel.report.tables import Provenance


class Finding(NamedTuple):
    """One finding: file; line and column from 1 and the dotted key, None where it is about no key; severity.

    severity: `error`: a fault of the file, a limit that is broken, a figure that is off, or what cannot be judged;
    `warning`; `info`: what is kept, met or left out.
    """

    file: str
    line: int | None
    column: int | None
    key: str | None
    message: str
    severity: str


class Findings(NamedTuple):
    """The outcome of a check for programs; machine: its name, None where the file describes none."""

    machine: str | None
    findings: tuple[Finding, ...]
    provenance: Provenance | None = None


def faults_found(file: str, error: KurbelError) -> Findings:
    """Return what is wrong with a machine file that cannot be read."""
    if not isinstance(error, MachineFileError):
        return Findings(None, (Finding(file, None, None, None, str(error), "error"),))
    return Findings(
        None, tuple(_finding(error.file_name, fault.path, fault, fault.message, "error") for fault in error.faults)
    )


Locate = Callable[[str, "list[Fault]"], "list[Fault]"]


def findings(machine: Machine, checked: Checked, locate: Locate) -> Findings:
    """Return what was found of a machine; locate: returns faults with their places in the text of the file."""
    several = len(machine.cylinders) > 1
    said = [
        (
            one.path,
            f"{f'{section.title}: ' if several and section.cylinder else ''}{one.what}: {one.text}",
            one.severity,
        )
        for section in checked.sections
        for one in section.entries
        if one.severity
    ]
    said += [(path, str(error).removeprefix(f"{path_text(path)}: "), "error") for path, error in checked.unjudged]
    origin, paths = machine.origin, {path for path, _, _ in said if path}
    placed = locate(origin.text, [Fault(path, "", at_key=True) for path in paths]) if origin and paths else []
    places = {fault.path: fault for fault in placed}
    file = origin.name if origin else machine.name
    found = tuple(_finding(file, path, places.get(path), text, severity) for path, text, severity in said)
    return Findings(machine.name, found, provenance(machine))


def _finding(file: str, path: Path, place: Fault | None, message: str, severity: str) -> Finding:
    line, column = (place.line, place.column) if place else (None, None)
    return Finding(file, line, column, path_text(path) or None, message, severity)
