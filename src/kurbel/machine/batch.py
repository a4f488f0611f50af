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
    attributes = vars(record)
    return {field.name: attributes[field.name] for field in fields(record)}


def varies(value: object) -> bool:
    """Return whether a value has arrays of many machines; a record remembers which of its fields do."""
    if isinstance(value, np.ndarray):
        return True
    if isinstance(value, tuple):
        return any(map(varies, value))
    if isinstance(value, Indivisible) or not is_dataclass(value):
        return False
    attributes = vars(value)
    if "_varied" not in attributes:
        names = [name for name, attribute in values_of(value).items() if varies(attribute)]
        attributes["_varied"] = tuple(names)
    return bool(attributes["_varied"])


def changed(
    record: Any, change: Callable[[Array], object], copies: dict[int, object] | None = None
) -> Any:
    """Return a record with every array (machines,) changed, without checking its rules again.

    Objects without arrays are not copied, and an object in several places stays one object; copies: changed objects by
    id, for the recursion.
    """
    if isinstance(record, np.ndarray):
        return change(record)
    if not varies(record):
        return record
    if copies is None:
        copies = {}
    if id(record) in copies:
        return copies[id(record)]
    if isinstance(record, tuple):
        items = [changed(item, change, copies) for item in record]
        is_named_tuple = hasattr(record, "_fields")
        copy = type(record)(*items) if is_named_tuple else tuple(items)
    else:
        copy = object.__new__(type(record))
        vars(copy).update(values_of(record))
        for name in vars(record)["_varied"]:
            vars(copy)[name] = changed(vars(record)[name], change, copies)
    copies[id(record)] = copy
    return copy


def taken(record: R, index: Indices) -> R:
    """Return a record of many machines with the numbers of these, of the shape of the index."""
    result: R = changed(record, lambda numbers: numbers[index])
    return result
