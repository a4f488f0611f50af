"""Whether cylinders work alike."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from kurbel.machine import Cylinder

_PLACE = ("name", "crank_position", "bank_angle", "axial_position", "counterweights")
"""Keys of a cylinder that say where on the shaft it stands, and what the shaft carries there."""


def work_alike(one: Cylinder, other: Cylinder) -> bool:
    """Whether two cylinders move and are pushed alike, wherever on the shaft they stand."""
    keys = (field.name for field in fields(Cylinder) if field.name not in _PLACE)
    return all(_same(getattr(one, key), getattr(other, key)) for key in keys)


def _same(one: Any, other: Any) -> bool:
    if one is other or type(one) is not type(other):
        return one is other
    if is_dataclass(one):
        return all(_same(getattr(one, field.name), getattr(other, field.name)) for field in fields(one))
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(_same, one, other))
    return bool(np.array_equal(one, other))
