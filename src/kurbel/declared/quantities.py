"""Quantities that are not yet rows of the class that computes them."""

from kurbel.declared.balance import BALANCE_COLUMNS, BALANCE_VALUES
from kurbel.declared.bearings import BEARING_COLUMNS, BEARING_VALUES
from kurbel.declared.shaft import STRENGTH_COLUMNS, STRENGTH_VALUES
from kurbel.quantity import PHI, Quantity, by_id

_TEXT = "Tangential force at the crank pin, positive when it drives"
_COLUMNS = (
    PHI,
    Quantity("D", "D", "force", "Radial force at the crank pin, positive toward the shaft", commands=("stress",)),
    Quantity("T", "T", "force", _TEXT, commands=("stress",)),
    *STRENGTH_COLUMNS,
    *BEARING_COLUMNS,
    *BALANCE_COLUMNS,
)
_VALUES = (
    *STRENGTH_VALUES,
    *BEARING_VALUES,
    *BALANCE_VALUES,
)


def columns(command: str) -> dict[str, Quantity]:
    """Return the columns of a command, by id."""
    return by_id(*(one for one in _COLUMNS if command in one.commands))


def key_values(command: str) -> list[Quantity]:
    """Return the key values of a command, which are printed after the extremes of its columns."""
    return [one for one in _VALUES if command in one.commands]
