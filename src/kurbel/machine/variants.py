"""Records of many machines: numbers that differ among them are arrays (machines,)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Array, Indices, Indivisible

if TYPE_CHECKING:
    from kurbel.machine import Machine


@dataclass(frozen=True, eq=False)
class Lot:
    """Machines of one structure in one record, with arrays (machines,) for numbers that differ; rows: of each."""

    machine: "Machine"
    rows: Sequence[int]

    def one(self, place: int) -> "Machine":
        """Return one of them, counted from 0, alone."""
        return one_of(self.machine, place)  # type: ignore[no-any-return]


def values_of(record: Any) -> dict[str, Any]:
    """Return the values of a record by the names of its fields."""
    known = vars(record)
    return {one.name: known[one.name] for one in fields(record)}


def one_of(record: Any, place: int) -> Any:
    """Return the record of one of many machines."""
    return changed(record, lambda numbers: numbers[place].item(), {})


def changed(record: Any, change: Callable[[Array], Any], known: dict[int, Any]) -> Any:
    """Return a record with every array (machines,) changed; an object in several places stays one; known: by id."""
    if isinstance(record, np.ndarray):
        return change(record)
    if isinstance(record, Indivisible) or not (isinstance(record, tuple) or is_dataclass(record)):
        return record
    if id(record) not in known:
        known[id(record)] = record, _changed(record, change, known)  # with it, so that no other takes its place
    return known[id(record)][1]


def _changed(record: Any, change: Callable[[Array], Any], known: dict[int, Any]) -> Any:
    if isinstance(record, tuple):
        parts = [changed(one, change, known) for one in record]
        if all(one is other for one, other in zip(parts, record)):
            return record
        return type(record)(*parts) if hasattr(record, "_fields") else tuple(parts)
    held = values_of(record)
    found = {name: changed(one, change, known) for name, one in held.items()}
    return record if all(one is held[name] for name, one in found.items()) else _like(record, found)


def varies(record: Any, known: dict[int, Any]) -> bool:
    """Return whether anything differs among the machines of a record; known: cache, by id."""
    return changed(record, lambda numbers: None, known) is not record


@dataclass(frozen=True, eq=False)
class Chambers:
    """One end of a cylinder of many machines: the different chambers, and which one each machine has, (machines,)."""

    each: tuple[Any, ...]
    which: Indices

    @property
    def cycles(self) -> tuple[str, ...]:
        """The working cycles that the chambers can be part of, the same for all."""
        return self.each[0].cycles  # type: ignore[no-any-return]

    @property
    def clearance(self) -> Any:
        """Smallest volume over the stroke volume, (machines,), 0 where it is not known."""
        return np.array([getattr(one, "clearance", None) or 0.0 for one in self.each])[self.which]


def taken(record: Any, index: Indices) -> Any:
    """Return a record of many machines with the numbers of these, of the shape of the index."""
    if isinstance(record, np.ndarray):
        return record[index]
    if isinstance(record, tuple) and not hasattr(record, "_fields"):
        return tuple(taken(one, index) for one in record)
    varied = _varied(record)
    return record_of(record, {name: taken(getattr(record, name), index) for name in varied}) if varied else record


def count_of(record: Any) -> int | None:
    """Return the number of machines of a record; None for one machine, and where all machines have the same."""
    if isinstance(record, np.ndarray):
        return len(record)
    if isinstance(record, Chambers):
        return len(record.which)
    parts = record if isinstance(record, tuple) else (getattr(record, name) for name in _varied(record))
    return next((count for part in parts if (count := count_of(part)) is not None), None)


def record_of(like: Any, varied: dict[str, Any]) -> Any:
    """Return a record like another one, with these values of many machines, as the solver takes them."""
    return _like(like, varied | {"_varied": tuple(varied)})


def _like(record: Any, values: dict[str, Any]) -> Any:
    """Return a record with other values, without checking its rules again."""
    made = object.__new__(type(record))
    made.__dict__.update(values_of(record) | values)
    return made


def _varied(record: Any) -> tuple[str, ...]:
    """Return the names of the values that may differ among the machines of a record; () in a record of one machine."""
    varied: tuple[str, ...] = getattr(record, "__dict__", {}).get("_varied", ())
    return varied
