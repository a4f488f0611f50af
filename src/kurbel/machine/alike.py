"""Which cylinders work alike."""

from collections.abc import Callable, Iterable
from dataclasses import fields, is_dataclass
from typing import Any, TypeVar

import numpy as np

from kurbel.machine import Cylinder

Item = TypeVar("Item")

_PLACE = ("name", "crank_position", "bank_angle", "axial_position", "counterweights")
"""Keys of a cylinder that say where on the shaft it stands, and what the shaft carries there."""


def work_alike(one: Cylinder, other: Cylinder) -> bool:
    """Whether two cylinders move and are pushed alike, wherever on the shaft they stand."""
    keys = (field.name for field in fields(Cylinder) if field.name not in _PLACE)
    return all(_same(getattr(one, key), getattr(other, key)) for key in keys)


def gathered(items: Iterable[Item], equal: Callable[[Item, Item], bool]) -> list[list[Item]]:
    """Return the items in groups of equal ones, in the order of their first ones."""
    groups: list[list[Item]] = []
    for item in items:
        found = next((group for group in groups if equal(group[0], item)), None)
        groups.append([item]) if found is None else found.append(item)
    return groups


def _same(one: Any, other: Any) -> bool:
    if one is other or type(one) is not type(other):
        return one is other
    if is_dataclass(one):
        return all(_same(getattr(one, field.name), getattr(other, field.name)) for field in fields(one))
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(_same, one, other))
    return bool(np.array_equal(one, other))
