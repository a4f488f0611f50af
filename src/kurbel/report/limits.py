"""What limits are compared with: key values of every command, computed only as far as they are asked for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from kurbel.errors import KurbelError
from kurbel.machine import Machine
from kurbel.mechanisms import every_quantity
from kurbel.numerics.extreme import Extreme
from kurbel.report.commands import subjects_of
from kurbel.solver.case import Case

Found = tuple[str, float]
"""What a key value belongs to, and its value in SI."""


def limited_values(machine: Machine, names: Iterable[str]) -> dict[str, list[Found] | KurbelError]:
    """Return by id what the machine has of these key values, or what keeps them from being computed."""
    case = Case(machine)
    found: dict[str, list[Found] | KurbelError] = {}
    with np.errstate(all="ignore"):
        for name in names:
            try:
                found[name] = [one for command in commands_for(machine, name) for one in _values(case, command, name)]
            except KurbelError as error:
                found[name] = error
    return found


def commands_for(machine: Machine, name: str) -> tuple[str, ...]:
    """Return the commands whose value the limit is for; one cylinder has it as the machine, but for the efficiency."""
    first, *others = every_quantity().commands_of(name)
    alike = len(machine.cylinders) == 1 and machine.efficiency == 1
    return (first, *(command for command in others if command == "flywheel" and not alike))


def _values(case: Case, command: str, name: str) -> Iterator[Found]:
    for subject in subjects_of(case, command):
        quantity = subject.lists.key_values(command).get(name)
        value = quantity and subject.answer(quantity)
        if isinstance(value, (Extreme, float)):
            yield subject.name, value.value if isinstance(value, Extreme) else value
