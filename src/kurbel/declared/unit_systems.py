"""Unit systems: in which unit people read a value that kurbel holds in its base."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

from kurbel.declared.units import unit_factor

SI = {
    "length": "m",
    "area": "m^2",
    "mass": "kg",
    "force": "N",
    "pressure": "Pa",
    "stress": "Pa",
    "time": "s",
    "angle": "deg",
    "speed": "1/s",
    "frequency": "Hz",
    "angular_velocity": "rad/s",
    "angular_acceleration": "rad/s^2",
    "velocity": "m/s",
    "acceleration": "m/s^2",
    "torque": "N m",
    "energy": "J",
    "power": "W",
    "inertia": "kg m^2",
    "unbalance": "kg m",
    "gd2": "kg m^2",
    "stiffness": "N m/rad",
    "damping": "N m s/rad",
    "pressure_velocity": "W/m^2",
    "volume": "m^3",
    "volume_rise": "m^3/deg",
    "pressure_rise": "Pa/deg",
    "density": "kg/m^3",
    "spring": "m/Pa",
    "ratio": "",
}
TECHNICAL = SI | {
    "length": "mm",
    "area": "cm^2",
    "force": "kgf",
    "pressure": "at",
    "stress": "kgf/cm^2",
    "speed": "rpm",
    "torque": "kgf m",
    "energy": "kgf m",
    "power": "PS",
    "gd2": "kgf m^2",
    "pressure_velocity": "kgf m/s/cm^2",
    "volume": "dm^3",
    "volume_rise": "cm^3/deg",
    "pressure_rise": "at/deg",
    "spring": "mm/at",
}
_METRIC: dict[str, Any] = {
    **SI,
    "length": ("mm", "m"),
    "area": "cm^2",
    "mass": ("kg", "t"),
    "force": ("N", "kN", "MN"),
    "pressure": ("mbar", "bar"),
    "stress": "N/mm^2",
    "speed": "rpm",
    "torque": ("N m", "kN m"),
    "energy": ("J", "kJ", "MJ"),
    "power": ("W", "kW", "MW"),
    "pressure_velocity": "N/mm^2 m/s",
    "volume": ("cm^3", "m^3"),
    "volume_rise": "cm^3/deg",
    "pressure_rise": ("mbar/deg", "bar/deg"),
    "spring": "mm/bar",
}
_IMPERIAL: dict[str, Any] = {
    **SI,
    "length": "in",
    "area": "in^2",
    "mass": "lb",
    "force": "lbf",
    "pressure": "psi",
    "stress": "psi",
    "speed": "rpm",
    "velocity": "ft/s",
    "acceleration": "ft/s^2",
    "torque": "lbf ft",
    "energy": "lbf ft",
    "power": "hp",
    "inertia": "lb ft^2",
    "unbalance": "lb in",
    "gd2": "lb ft^2",
    "stiffness": "lbf ft/rad",
    "damping": "lbf ft s/rad",
    "pressure_velocity": "psi ft/s",
    "volume": "in^3",
    "volume_rise": "in^3/deg",
    "pressure_rise": "psi/deg",
    "spring": "in/psi",
}
SYSTEMS: dict[str, dict[str, Any]] = {"si": SI, "metric": _METRIC, "technical": TECHNICAL, "imperial": _IMPERIAL}
"""Unit system -> kind -> the unit in which results are shown, or several, of which the size decides."""
_TAKEN_FROM = {"m": 10.0, "t": 1e5, "mbar": 0.0, "bar": 1e3, "m^3": 1.0, "bar/deg": 1e3}
"""Base value from which a larger unit is taken, where that is not one of the unit itself."""

_TOLD: ContextVar[str] = ContextVar("told", default="metric")


@contextmanager
def told_in(system: str) -> Iterator[None]:
    """Let messages, too, tell values in a unit system: they arise where nobody knows of it, as numpy's warnings do."""
    before = _TOLD.set(system)
    try:
        yield
    finally:
        _TOLD.reset(before)


def shown_unit(kind: str, system: str, largest: float = 0.0) -> str:
    """Return the unit in which a system shows values of a kind, the largest of which has this size in its base.

    >>> shown_unit("force", "metric", 950.0), shown_unit("force", "metric", 13200.0), shown_unit("force", "si", 1e9)
    ('N', 'kN', 'N')
    """
    units = SYSTEMS[system][kind]
    if isinstance(units, str):
        return units
    fitting = [unit for unit in units[1:] if abs(largest) >= _TAKEN_FROM.get(unit, convert_back(1.0, kind, unit))]
    return fitting[-1] if fitting else str(units[0])


def convert(value: Any, kind: str, unit: str) -> Any:
    """Return base values, a number or an array, in a unit of their kind."""
    if not unit:
        return value
    up, down = unit_factor(unit, kind)
    return value if up == down else value / up * down


def convert_back(value: float, kind: str, unit: str) -> float:
    """Return a value in a unit of its kind in the base."""
    up, down = unit_factor(unit, kind)
    return value * up / down


def show(value: float, kind: str) -> str:
    """Write a base value for a message, in the unit in which people are told (`told_in`; metric otherwise).

    >>> show(0.3, "length"), show(5e5, "pressure")
    ('300 mm', '5 bar')
    """
    unit = shown_unit(kind, _TOLD.get(), value)
    return f"{convert(value, kind, unit):.6g} {unit}".rstrip()
