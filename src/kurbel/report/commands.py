"""The commands that report on a machine, in the order of a whole report: word, title, report, and what it is on."""

from collections.abc import Callable
from typing import NamedTuple

from kurbel.report.balance import balance_report, balance_subjects
from kurbel.report.crank import forces_report, forces_subjects, motion_report, motion_subjects
from kurbel.report.frame import Frame, Subject
from kurbel.report.loads import bearings_report, bearings_subjects, stress_report, stress_subjects
from kurbel.report.tables import Report
from kurbel.report.turning import (
    flywheel_report,
    flywheel_subjects,
    harmonics_report,
    harmonics_subjects,
    torsion_report,
    torsion_subjects,
)
from kurbel.solver.case import Case


class Command(NamedTuple):
    """A command; subjects: what it has key values of; turns: its table runs over the cycle, else over one turn."""

    word: str
    title: str
    report: Callable[[Case, Frame], Report]
    subjects: Callable[[Case], list[Subject]]
    turns: bool = True


COMMANDS = {
    one.word: one
    for one in (
        Command("motion", "Motion", motion_report, motion_subjects, turns=False),
        Command("forces", "Forces", forces_report, forces_subjects),
        Command("flywheel", "Turning effort and flywheel", flywheel_report, flywheel_subjects),
        Command("stress", "Strength of the crankshaft", stress_report, stress_subjects),
        Command("bearings", "Bearings", bearings_report, bearings_subjects),
        Command("balance", "Balance of the masses", balance_report, balance_subjects),
        Command("harmonics", "Orders of the turning effort", harmonics_report, harmonics_subjects),
        Command("torsion", "Torsional vibration", torsion_report, torsion_subjects),
    )
}
"""By its word."""


def report_of(case: Case, frame: Frame) -> Report:
    """Return the report of the command that the frame is of."""
    return COMMANDS[frame.command].report(case, frame)


def subjects_of(case: Case, command: str) -> list[Subject]:
    """Return what a command has results of, with their key values."""
    return COMMANDS[command].subjects(case)
