"""What a command has results of, with the warnings that belong to them."""

from collections.abc import Callable

from kurbel.notes.warnings import of_machine
from kurbel.solver.case import Case
from kurbel.tables.frame import Subject


def whole_machine(command: str) -> Callable[[Case], list[Subject]]:
    """Return the function of a command that has results of the whole machine, and of no part of it."""

    def subjects(case: Case) -> list[Subject]:
        (results,) = case.results(command)
        at = results.at if results.state else None
        warnings = of_machine(case)
        return [Subject("whole machine", results, at, warnings=warnings, whole=True)]

    return subjects
