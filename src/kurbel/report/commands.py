"""The reports on a machine by the word of their command."""

from collections.abc import Callable, Iterable

from kurbel.report import balance, bearings, flywheel, forces, harmonics, motion, stress, torsion
from kurbel.report.frame import Frame, Subject
from kurbel.report.tables import Report
from kurbel.solver.case import Case

_REPORTS: dict[str, Callable[[Case, Frame], Report]] = {
    "balance": balance.balance_report,
    "bearings": bearings.bearings_report,
    "flywheel": flywheel.flywheel_report,
    "forces": forces.forces_report,
    "harmonics": harmonics.harmonics_report,
    "motion": motion.motion_report,
    "stress": stress.stress_report,
    "torsion": torsion.torsion_report,
}
_SUBJECTS: dict[str, Callable[[Case], Iterable[Subject]]] = {
    "balance": balance.subjects,
    "bearings": bearings.subjects,
    "flywheel": flywheel.subjects,
    "forces": forces.subjects,
    "harmonics": harmonics.subjects,
    "motion": motion.subjects,
    "stress": stress.subjects,
    "torsion": torsion.subjects,
}


def report_of(case: Case, frame: Frame) -> Report:
    """Return the report of the command that the frame is of."""
    return _REPORTS[frame.command](case, frame)


def subjects_of(case: Case, command: str) -> Iterable[Subject]:
    """Return what a command speaks of, with the key values that it has."""
    return _SUBJECTS[command](case)
