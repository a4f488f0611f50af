"""Many machines of the same structure as one machine; numbers that differ are arrays (machines,).

The rules of each machine were checked when it was made, and are not checked again here.
"""

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any, TypeVar

import numpy as np

from kurbel.arrays import Array, Indices, Indivisible

R = TypeVar("R")


def values_of(record: Any) -> dict[str, Any]:
    """Return the values of a record by the names of its fields."""
    known = vars(record)
    return {field.name: known[field.name] for field in fields(record)}


def varies(value: object) -> bool:
    """Return whether a value has arrays of many machines; a record remembers which of its fields do."""
    if isinstance(value, np.ndarray):
        return True
    if isinstance(value, tuple):
        return any(map(varies, value))
    if isinstance(value, Indivisible) or not is_dataclass(value):
        return False
    known = vars(value)
    if "_varied" not in known:
        known["_varied"] = tuple(name for name, one in values_of(value).items() if varies(one))
    return bool(known["_varied"])


def changed(
    record: Any, change: Callable[[Array], object], known: dict[int, object] | None = None
) -> Any:
    """Return a record with every array (machines,) changed, without checking its rules again.

    Objects without arrays are not copied, and an object in several places stays one object; known: changed objects by
    id, for the recursion.
    """
    if isinstance(record, np.ndarray):
        return change(record)
    if not varies(record):
        return record
    known = {} if known is None else known
    if id(record) not in known:
        if isinstance(record, tuple):
            parts = [changed(one, change, known) for one in record]
            made = type(record)(*parts) if hasattr(record, "_fields") else tuple(parts)
        else:
            held = vars(record)
            made = object.__new__(type(record))
            vars(made).update(values_of(record))
            vars(made).update(
                {name: changed(held[name], change, known) for name in held["_varied"]}
            )
        known[id(record)] = made
    return known[id(record)]


def taken(record: R, index: Indices) -> R:
    """Return a record of many machines with the numbers of these, of the shape of the index."""
    found: R = changed(record, lambda numbers: numbers[index])
    return found
