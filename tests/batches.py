"""Machines that were made one by one as a batch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import is_dataclass
from typing import Any

import numpy as np

from kurbel.machine.batch import values_of


def batch(values: Sequence[Any]) -> Any:
    """Records of one kind as one, in which numbers that differ are arrays (n,); shared parts stay shared."""
    return _joined(values, {})


def _joined(values: Sequence[Any], known: dict[tuple[int, ...], Any]) -> Any:
    first = values[0]
    if isinstance(first, (float, int)) and not isinstance(first, bool):
        return first if all(one == first for one in values) else np.array(values, dtype=float)
    if isinstance(first, tuple) and not hasattr(first, "_fields"):
        return tuple(_joined(each, known) for each in zip(*values, strict=True))
    if not is_dataclass(first) or all(one is first for one in values):
        return first
    ids = tuple(map(id, values))
    if ids not in known:
        assert {type(one) for one in values} == {type(first)}
        made = object.__new__(type(first))
        vars(made).update({name: _joined([vars(one)[name] for one in values], known) for name in values_of(first)})
        known[ids] = made
    return known[ids]
