"""What a command has results of, with the warnings that belong to them."""

from collections.abc import Callable

from kurbel.notes.warnings import of_machine
from kurbel.solver.case import Case
from kurbel.tables.frame import Subject


def whole_machine(command: str) -> Callable[[Case], list[Subject]]:
    """Return the function of a command that has results of the whole machine, and of no part of it."""

    def subjects(case: Case) -> list[Subject]:
        (found,) = case.results(command)
        return [
            Subject(
                "whole machine",
                found,
                found.at if found.state else None,
                warnings=of_machine(case),
                whole=True,
            )
        ]

    return subjects
