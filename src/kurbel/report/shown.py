"""From values in SI to columns and key values in the unit they are shown in; what overflows is refused by name."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from kurbel.declared.quantities import COLUMNS, KEY_VALUES, Quantity
from kurbel.declared.units import SYSTEMS, convert
from kurbel.errors import UsageError
from kurbel.numerics.extreme import Extreme
from kurbel.report.tables import Column, KeyValue

_AT_ONCE = 8192
"""Crank angles computed at once: what a table of any length costs in memory beside its own numbers."""


def shown_columns(
    names: Iterable[str], values_at: Callable[[Any], Callable[[str], Any]], angles: Sequence[float], system: str
) -> tuple[Column, ...]:
    """Return φ and the columns of these ids as far as the machine has them, at crank angles (n,) in degrees.

    values_at: takes angles (k,) and returns what answers an id with values (k,) in SI, or None where there are none.
    Raises UsageError where one is not finite.
    """
    wanted = dict.fromkeys(("phi", *names))
    found: dict[str, array[float]] = {}
    for start in range(0, len(angles), _AT_ONCE):
        degrees = np.asarray(angles[start : start + _AT_ONCE], dtype=float)
        value_of = values_at(degrees)
        for name in wanted:
            values = degrees if name == "phi" else value_of(name)
            if values is not None:
                found.setdefault(name, array("d")).frombytes(_shown(name, values, system).tobytes())
    return tuple(_column(name, values, system) for name, values in found.items())


def shown_column(name: str, values: Any, system: str) -> Column:
    """Return the column of this id; values: array (n,) in SI. Raises UsageError where one is not finite."""
    return _column(name, tuple(_shown(name, values, system).tolist()), system)


def _shown(name: str, values: Any, system: str) -> Any:
    shown = convert(np.asarray(values, dtype=float), COLUMNS[name].kind, system)
    if not np.isfinite(shown).all():
        raise too_large(COLUMNS[name])
    return shown + 0.0


def _column(name: str, values: Sequence[float], system: str) -> Column:
    quantity = COLUMNS[name]
    return Column(name, quantity.symbol, quantity.ascii_symbol, SYSTEMS[system][quantity.kind], values, quantity.text)


def shown_key_value(name: str, value: Any, system: str) -> KeyValue:
    """Return the key value of this id; value: a number in SI, an Extreme, or a tuple. Raises UsageError as above."""
    quantity = KEY_VALUES[name]
    at, raw = (value.degrees, value.value) if isinstance(value, Extreme) else (None, value)
    each: tuple[float, ...] = raw if isinstance(raw, tuple) else (raw,)
    shown = [float(convert(one, quantity.kind, system)) + 0.0 for one in each]
    if not all(math.isfinite(one) for one in shown):
        raise too_large(quantity)
    unit = SYSTEMS[system][quantity.kind]
    number = tuple(shown) if isinstance(raw, tuple) else shown[0]
    noise = any(map(quantity.is_noise, shown))
    return KeyValue(name, quantity.symbol, quantity.ascii_symbol, unit, number, quantity.text, at, noise)


def too_large(quantity: Quantity) -> UsageError:
    """Return the error for a quantity that overflows."""
    return UsageError(f"{quantity.id} is too large to compute with: check the numbers and units of the machine file")
