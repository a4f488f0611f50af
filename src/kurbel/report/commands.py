"""What every command has in the room of the reports, by its word: a report in a frame, and what it speaks of."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kurbel.report.frame import Frame, Subject
    from kurbel.report.tables import Report
    from kurbel.solver.case import Case


def report_of(case: Case, frame: Frame) -> Report:
    """Return the report of the command that the frame is of."""
    report: Report = getattr(_room(frame.command), f"{frame.command}_report")(case, frame)
    return report


def subjects_of(case: Case, command: str) -> Iterable[Subject]:
    """Return what a command speaks of, with the key values that it has."""
    subjects: Iterable[Subject] = _room(command).subjects(case)
    return subjects


def _room(command: str) -> Any:
    return import_module(f"kurbel.report.{command}")
