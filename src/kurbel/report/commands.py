"""Every command, one row each: help, completion, exit statuses, the whole report, sweeps and the documents read it.

A row of a command that reports on a machine has a function that imports its report, so that help needs none of them.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from kurbel.report.frame import Frame, Subject
    from kurbel.report.tables import Report
    from kurbel.solver.case import Case

    Reporting = tuple[Callable[[Case, Frame], Report], Callable[[Case], list[Subject]]]
    """The report of a command, and what it has key values of."""

BROKEN, NO_SOLUTION = 1, 3
"""Exit statuses that only some commands return."""


class Command(NamedTuple):
    """A command: its word, what `kurbel --help` says of it, and the statuses that only some commands return.

    title: of its section in the whole report, '' for none; reporting: returns its report and its subjects; turns:
    whether its table runs over the cycle, else over one turn.
    """

    word: str
    summary: str
    statuses: tuple[int, ...] = ()
    title: str = ""
    reporting: "Callable[[], Reporting] | None" = None
    turns: bool = True


def _motion() -> "Reporting":
    from kurbel.report.crank import motion_report, motion_subjects

    return motion_report, motion_subjects


def _forces() -> "Reporting":
    from kurbel.report.crank import forces_report, forces_subjects

    return forces_report, forces_subjects


def _flywheel() -> "Reporting":
    from kurbel.report.turning import flywheel_report, flywheel_subjects

    return flywheel_report, flywheel_subjects


def _stress() -> "Reporting":
    from kurbel.report.loads import stress_report, stress_subjects

    return stress_report, stress_subjects


def _bearings() -> "Reporting":
    from kurbel.report.loads import bearings_report, bearings_subjects

    return bearings_report, bearings_subjects


def _balance() -> "Reporting":
    from kurbel.report.balance import balance_report, balance_subjects

    return balance_report, balance_subjects


def _harmonics() -> "Reporting":
    from kurbel.report.turning import harmonics_report, harmonics_subjects

    return harmonics_report, harmonics_subjects


def _torsion() -> "Reporting":
    from kurbel.report.turning import torsion_report, torsion_subjects

    return torsion_report, torsion_subjects


_STALLS = (NO_SOLUTION,)
_ROWS = (
    Command("table", "Zusammenstellung 112 for any L/R; needs no machine file."),
    Command("motion", "Displacement, velocity, acceleration of any mechanism.", (), "Motion", _motion, False),
    Command("forces", "Forces, work and friction loss of every cylinder.", _STALLS, "Forces", _forces),
    Command(
        "flywheel",
        "Turning effort, flywheel and speed line of the machine.",
        _STALLS,
        "Turning effort and flywheel",
        _flywheel,
    ),
    Command("stress", "Bearing forces and stresses of the crankshaft.", _STALLS, "Strength of the crankshaft", _stress),
    Command("bearings", "Loads on pins and main bearings.", _STALLS, "Bearings", _bearings),
    Command("balance", "Free forces and moments, counterweights.", _STALLS, "Balance of the masses", _balance),
    Command(
        "harmonics",
        "Orders of the turning effort, gas and inertia apart.",
        (),
        "Orders of the turning effort",
        _harmonics,
    ),
    Command("torsion", "Torsional vibration of the shaft line.", _STALLS, "Torsional vibration", _torsion),
    Command("plot", "Pictures, in the terminal or as SVG, PNG, PDF.", _STALLS),
    Command("report", "Everything on one page of HTML; two machines side by side."),
    Command("sweep", "Key values of many designs of a machine."),
    Command("find", "The value of a key that gives a wanted key value.", _STALLS),
    Command("accuracy", "Error against run time; stiff and extreme cases.", (BROKEN, NO_SOLUTION)),
    Command("friction", "Body on an inclined plane; needs no machine file."),
    Command("check", "Read and check a machine file and its limits.", (BROKEN, NO_SOLUTION)),
    Command("example", "List the shipped machines, or print one."),
    Command("keys", "The keys of the machine file, or one of them in full."),
    Command("units", "The units of every kind of quantity."),
    Command("schema", "JSON Schema of the machine file, for editors, or of the answers."),
)
COMMANDS = {one.word: one for one in _ROWS}
"""By its word, in the order in which `kurbel --help` lists them."""
REPORTS = {word: one for word, one in COMMANDS.items() if one.reporting}
"""Those that report on a machine, in the order of the whole report."""


def report_of(case: "Case", frame: "Frame") -> "Report":
    """Return the report of the command that the frame is of."""
    return _reporting(frame.command)[0](case, frame)


def subjects_of(case: "Case", command: str) -> "list[Subject]":
    """Return what a command has results of, with their key values."""
    return _reporting(command)[1](case)


def _reporting(word: str) -> "Reporting":
    reporting = COMMANDS[word].reporting
    assert reporting
    return reporting()
