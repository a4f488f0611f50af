"""Unit systems: in which unit people read a value that kurbel holds in its base."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, Union

from kurbel.declared.units import KINDS, unit_factor, zero_of

SI = {name: kind.si for name, kind in KINDS.items()}
SYSTEMS: dict[str, Mapping[str, Union[str, tuple[str, ...]]]] = {
    "si": SI,
    "metric": {name: kind.metric or kind.si for name, kind in KINDS.items()},
    "technical": {name: kind.technical or kind.si for name, kind in KINDS.items()},
    "imperial": {name: kind.imperial or kind.si for name, kind in KINDS.items()},
}
"""Unit system -> kind -> the unit in which results are shown, or several, chosen by size."""
_TAKEN_FROM = {
    "m": 10.0,
    "t": 1e5,
    "mbar": 0.0,
    "bar": 1e3,
    "m^3": 1.0,
    "bar/deg": 1e3,
    "m^3/h": 10 / 3600,
}
"""Larger unit -> base value from which it is used, if that is not 1 of the unit itself."""

_OF_MESSAGES: ContextVar[str] = ContextVar("system of messages", default="")


@contextmanager
def messages_in(system: str) -> Iterator[None]:
    """Write values in messages in this unit system; messages arise in code to which no unit system is passed."""
    before = _OF_MESSAGES.set(system)
    try:
        yield
    finally:
        _OF_MESSAGES.reset(before)


def requested_system() -> str:
    """Return the unit system that was requested for messages, '' for none: then they are metric."""
    return _OF_MESSAGES.get()


def shown_unit(kind: str, system: str, largest: float = 0.0) -> str:
    """Return the unit in which a system shows values of a kind, the largest of which has this size in its base.

    >>> shown_unit("force", "metric", 950.0), shown_unit("force", "metric", 13200.0), shown_unit("force", "si", 1e9)
    ('N', 'kN', 'N')
    """
    units = SYSTEMS[system][kind]
    if isinstance(units, str):
        return units
    for unit in reversed(units[1:]):
        multiplier, divisor = unit_factor(unit, kind)
        if abs(largest) >= _TAKEN_FROM.get(unit, multiplier / divisor):
            return unit
    return units[0]


def units_of(sized: Sequence[tuple[str, str, float]], system: str) -> list[str]:
    """Return the units of values of which kind, family and size in their base are given; a family has one unit.

    >>> units_of([("force", "P", 600.0), ("force", "P", 6000.0), ("force", "T", 600.0)], "metric")
    ['kN', 'kN', 'N']
    """
    largest: dict[tuple[str, str], float] = {}
    for kind, family, size in sized:
        largest[kind, family] = max(size, largest.get((kind, family), 0.0))
    return [shown_unit(kind, system, largest[kind, family]) for kind, family, _ in sized]


def convert(value: Any, kind: str, unit: str, is_difference: bool = False) -> Any:
    """Return base values, a number or an array, in a unit of their kind; of differences 1 K is 1.8 °F.

    >>> round(convert(300.0, "temperature", "°F"), 9), round(convert(1.0, "temperature", "°F", is_difference=True), 9)
    (80.33, 1.8)
    """
    if not unit:
        return value
    multiplier, divisor = unit_factor(unit, kind)
    if multiplier != divisor:
        value = value / multiplier * divisor
    zero = 0.0 if is_difference else zero_of(unit)
    if not zero:
        return value
    return value - zero


def show(value: float, kind: str, figures: int = 6) -> str:
    """Write a base value for a message, in a unit of the system of messages (`messages_in`; else metric).

    >>> show(0.3, "length"), show(5e5, "pressure"), show(225.819, "torque", figures=2)
    ('300 mm', '5 bar', '230 N m')
    """
    unit = shown_unit(kind, _OF_MESSAGES.get() or "metric", value)
    return f"{rounded_text(convert(value, kind, unit), figures)} {unit}".rstrip()


def rounded_text(number: float, figures: int) -> str:
    """Write a number for a message with so many figures, and without a power of ten where people write none.

    >>> rounded_text(1407.7, 3), rounded_text(0.3, 6)
    ('1410', '0.3')
    """
    rounded = float(f"{number:.{figures}g}")
    return f"{rounded:.6g}"


def show_range(low: float, high: float, kind: str, figures: int = 3) -> str:
    """Write a range of base values for a message, as `show` does.

    >>> show_range(50.0, 60.0, "velocity")
    '50 to 60 m/s'
    """
    unit = shown_unit(kind, _OF_MESSAGES.get() or "metric", high)
    first, last = (rounded_text(convert(value, kind, unit), figures) for value in (low, high))
    return f"{first} to {last} {unit}".rstrip()
