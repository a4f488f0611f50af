"""The tables of load cases: a row for each case, of the key values of a command."""

from collections.abc import Sequence

import numpy as np

from kurbel.declared.reading import shown
from kurbel.errors import KurbelError, UsageError
from kurbel.machine import Machine
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import number_of
from kurbel.quantities import every_quantity
from kurbel.quantity import called
from kurbel.report.commands import COMMANDS, subjects_of
from kurbel.report.frame import Frame, Places, Row, Subject, report_on
from kurbel.report.tables import Report
from kurbel.solver.case import Case


def name_of(case: Case) -> str:
    """Return the name of a load case, or of the machine itself."""
    return case.machine.origin.case if case.machine.origin else case.machine.name


@np.errstate(all="ignore")  # what overflows is refused by name
def cases_report(
    base: Machine, cases: Sequence[Case], command: str, system: str, names: Sequence[str] | None = None
) -> Report:
    """Return the key values of load cases, a row for each, of each part of the machine.

    base: the machine as it is without them; names: ids or symbols of the key values. Raises UsageError for a name that
    is none, and if no case has any.
    """
    declared = every_quantity().key_values(command)
    known = {name: called(name, declared.values()) for name in names or COMMANDS[command].in_cases.split()}
    for name in (name for name, ids in known.items() if not ids):
        near = did_you_mean(name, tuple(declared))
        raise UsageError(f"--columns: '{shown(name)}' is no key value of kurbel {command}{near}")
    ids = [ids[0] for ids in known.values()]
    rows: dict[str, list[Row]] = {}
    notes: list[str] = []
    for case in cases:
        try:
            for subject in subjects_of(case, command):
                answers = {id: number_of(subject.answer(declared[id])) for id in ids}
                values = {id: one for id, one in answers.items() if isinstance(one, float)}
                if values:
                    rows.setdefault(subject.name, []).append(((name_of(case),), values))
        except KurbelError as error:
            notes.append(f"{name_of(case)}: {error}")
    if not rows:
        raise UsageError("; ".join(notes) or f"{base.name}: no case has any of {', '.join(ids)}")
    chosen = {id: declared[id] for id in ids}

    parts = []
    for name, of_part in rows.items():
        title = f"Load cases: {name}" if len(rows) > 1 else "Load cases"
        parts.append(Subject(name, tables=[Places("cases", title, ("case",), chosen, of_part, headed=True)]))
    return report_on(Frame(command, (), None, system), base, "Load cases", parts, notes)
