"""What limits are compared with: the key values of every command, computed by the commands that are asked for alone."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module

from kurbel.declared.quantities import OF_COMMAND, OF_WHOLE_MACHINE
from kurbel.errors import KurbelError
from kurbel.machine import Machine


def command_of(name: str) -> str:
    """Return the command that answers the key value of this id.

    >>> command_of("sigma_pin_max"), command_of("T_max"), command_of("c_max")
    ('stress', 'forces', 'motion')
    """
    return next((command for command, names in OF_COMMAND.items() if name in names), "forces")


def limited_values(
    machine: Machine, names: Iterable[str]
) -> tuple[list[tuple[str, str, float]], dict[str, KurbelError]]:
    """Return (what it belongs to, id, value in SI) of the key values with these ids, and what kept others from it.

    Every report of a command has a function `limited_values` of its own.
    """
    wanted = set(names)
    found: list[tuple[str, str, float]] = []
    errors: dict[str, KurbelError] = {}
    for command in ("motion", "forces", "flywheel", "stress"):
        asked = {name for name in wanted if command in _commands(machine, name)}
        try:
            values = import_module(f"kurbel.report.{command}").limited_values(machine) if asked else []
        except KurbelError as error:
            errors |= dict.fromkeys(asked, error)
        else:
            found += [value for value in values if value[1] in asked]
    return found, errors


def _commands(machine: Machine, name: str) -> set[str]:
    """Return the commands whose value the limit is for; one cylinder has it alike, but for the efficiency."""
    whole = len(machine.cylinders) != 1 or machine.efficiency != 1 or name.startswith("M_")
    return {command_of(name), *(("flywheel",) if whole and name in OF_WHOLE_MACHINE else ())}
