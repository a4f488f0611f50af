"""Quantities that are not yet rows of the class that computes them."""

from functools import partial

from kurbel.declared.bearings import BEARING_COLUMNS, BEARING_VALUES
from kurbel.declared.flywheel import EFFORT_VALUES, FLYWHEEL_COLUMNS, FLYWHEEL_VALUES
from kurbel.declared.shaft import STRENGTH_COLUMNS, STRENGTH_VALUES
from kurbel.declared.torsion import HARMONIC_VALUES, TORSION_COLUMNS, TORSION_VALUES
from kurbel.quantity import PHI, Quantity, by_id

_TEXT = "Tangential force at the crank pin, positive when it drives"
_brake = partial(Quantity, commands=("flywheel",))
_COLUMNS = (
    PHI,
    Quantity("D", "D", "force", "Radial force at the crank pin, positive toward the shaft", commands=("stress",)),
    Quantity("T", "T", "force", _TEXT, "", ("flywheel",), ("flywheel",), "tangential force", peak=True),
    Quantity("T", "T", "force", _TEXT, commands=("stress",)),
    *FLYWHEEL_COLUMNS,
    *STRENGTH_COLUMNS,
    *BEARING_COLUMNS,
    *TORSION_COLUMNS,
)
_FIRST = (
    _brake("mean_pressure_brake", "p_e", "pressure", "Mean effective pressure: brake work over the swept volume"),
    _brake("mean_pressure_friction", "p_r", "pressure", "Friction mean pressure, p_i less p_e"),
    _brake("eta_m", "η_m", "ratio", "Mechanical efficiency: brake power over indicated power"),
    _brake("W", "W", "force", "Mean tangential force over the cycle: the resistance"),
    *EFFORT_VALUES,
)
_OTHERS = (
    *FLYWHEEL_VALUES,
    *STRENGTH_VALUES,
    *BEARING_VALUES,
    *HARMONIC_VALUES,
    *TORSION_VALUES,
)


def columns(command: str) -> dict[str, Quantity]:
    """Return the columns of a command, by id."""
    return by_id(*(one for one in _COLUMNS if command in one.commands))


def key_values(command: str) -> tuple[list[Quantity], list[Quantity]]:
    """Return the key values of a command that are printed before the extremes of its columns, and after them."""
    first, others = ([one for one in some if command in one.commands] for some in (_FIRST, _OTHERS))
    return first, others
