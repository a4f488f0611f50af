"""Records of many variants of a machine: what differs among them is `Varied`, or, for the solver, an array (v,)."""

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Indices
from kurbel.numerics.varied import Varied, varied

if TYPE_CHECKING:
    from kurbel.machine import Machine


@dataclass(frozen=True, eq=False)
class Lot:
    """Machines of one kind in one record, whose numbers are `Varied` where they differ; rows: what each is known by."""

    machine: "Machine"
    rows: Sequence[int]

    def one(self, place: int) -> "Machine":
        """Return one of them, counted from 0, alone."""
        return one_of(self.machine, place)  # type: ignore[no-any-return]


def values_of(record: Any) -> dict[str, Any]:
    """Return the values of a record by the names of its fields."""
    return {one.name: getattr(record, one.name) for one in fields(record)}


def sort_of(value: Any) -> Hashable:
    """Return what values must have in common to differ in numbers only, and to be joined."""
    if type(value) in (float, int):
        return type(value).__name__
    if isinstance(value, (tuple, list)):
        return (type(value), *map(sort_of, value))
    if is_dataclass(value):
        return (type(value), *map(sort_of, values_of(value).values()))
    return value if isinstance(value, str) else id(value)


def joined(values: Sequence[Any]) -> Any:
    """Return values of one sort as one of many variants, in which numbers are `Varied` where they differ."""
    first = values[0]
    if all(one is first for one in values):
        return first
    if isinstance(first, (float, int)):
        return varied(values)
    if isinstance(first, (tuple, list)):
        parts = map(joined, zip(*values))
        return type(first)(*parts) if hasattr(first, "_fields") else type(first)(parts)
    if is_dataclass(first):
        return _like(first, {name: joined([vars(one)[name] for one in values]) for name in values_of(first)})
    return first


def one_of(record: Any, place: int) -> Any:
    """Return a record of many variants as that of one of them."""
    return changed(record, lambda numbers: numbers.values[place].item(), {})


def one_kind(record: Any) -> None:
    """Raise Parted where a number is 0, or infinite, for some variants only: formulas tell these apart."""
    changed(record, Varied.alike, {})


def varies(record: Any, known: dict[int, Any]) -> bool:
    """Return whether anything differs among the variants of a record; known: what was seen before."""
    return changed(record, lambda numbers: None, known) is not record


def changed(record: Any, change: Callable[[Varied], Any], known: dict[int, Any]) -> Any:
    """Return a record with what varies changed; what is one in many places stays one; known: what was seen before."""
    if isinstance(record, Varied):
        return change(record)
    if not (isinstance(record, tuple) or is_dataclass(record)):
        return record
    if id(record) not in known:
        known[id(record)] = _changed(record, change, known)
    return known[id(record)]


def _changed(record: Any, change: Callable[[Varied], Any], known: dict[int, Any]) -> Any:
    if isinstance(record, tuple):
        parts = [changed(one, change, known) for one in record]
        if all(one is other for one, other in zip(parts, record)):
            return record
        return type(record)(*parts) if hasattr(record, "_fields") else tuple(parts)
    held = values_of(record)
    found = {name: changed(one, change, known) for name, one in held.items()}
    return record if all(one is held[name] for name, one in found.items()) else _like(record, found)


@dataclass(frozen=True, eq=False)
class Chambers:
    """What stands in one end of a cylinder of many variants: the different chambers, and which one each has, (v,)."""

    each: tuple[Any, ...]
    which: Indices | None

    @property
    def cycles(self) -> tuple[str, ...]:
        """The working cycles that they can be part of, which are the same for all of a kind."""
        return self.each[0].cycles  # type: ignore[no-any-return]

    @property
    def clearance(self) -> Any:
        """Smallest volume over the stroke volume of each, (v,), 0 where it is not known."""
        return np.array([getattr(one, "clearance", None) or 0.0 for one in self.each])[self.which]


def taken(record: Any, index: Indices) -> Any:
    """Return a record of many variants with the numbers of these ones, of the shape of the index."""
    if isinstance(record, np.ndarray):
        return record[index]
    if isinstance(record, tuple) and not hasattr(record, "_fields"):
        return tuple(taken(one, index) for one in record)
    varied = _varied(record)
    return record_of(record, {name: taken(getattr(record, name), index) for name in varied}) if varied else record


def count_of(record: Any) -> int | None:
    """Return how many variants a record is of; None for one machine, and where all variants have the same."""
    if isinstance(record, np.ndarray):
        return len(record)
    if isinstance(record, Chambers):
        return None if record.which is None else len(record.which)
    parts = record if isinstance(record, tuple) else (getattr(record, name) for name in _varied(record))
    return next((count for part in parts if (count := count_of(part)) is not None), None)


def record_of(like: Any, varied: dict[str, Any]) -> Any:
    """Return a record like another one but for these values of many variants, as the solver takes them."""
    return _like(like, varied | {"_varied": tuple(varied)})


def _like(record: Any, values: dict[str, Any]) -> Any:
    """Return a record with other values; what was checked when they were born is not again."""
    made = object.__new__(type(record))
    made.__dict__.update(values_of(record) | values)
    return made


def _varied(record: Any) -> tuple[str, ...]:
    """Return which values may differ among the variants of a record: records of machines alone tell of none."""
    varied: tuple[str, ...] = getattr(record, "__dict__", {}).get("_varied", ())
    return varied
