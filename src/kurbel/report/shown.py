"""From values in SI to columns and key values in the unit they are shown in; what overflows is refused by name."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from kurbel.errors import UsageError
from kurbel.mechanisms import Extreme
from kurbel.quantities import COLUMNS, KEY_VALUES, Quantity
from kurbel.report.tables import Column, KeyValue
from kurbel.units import SYSTEMS, convert


def shown_column(name: str, values: Any, system: str) -> Column:
    """Return the column of this id; values: array (n,) in SI. Raises UsageError where one is not finite."""
    quantity = COLUMNS[name]
    shown = convert(np.asarray(values), quantity.kind, system)
    if not np.isfinite(shown).all():
        raise _too_large(quantity)
    unit = SYSTEMS[system][quantity.kind]
    return Column(name, quantity.symbol, quantity.ascii_symbol, unit, tuple((shown + 0.0).tolist()), quantity.text)


def shown_key_value(name: str, value: Any, system: str) -> KeyValue:
    """Return the key value of this id; value: a number in SI, an Extreme, or a tuple. Raises UsageError as above."""
    quantity = KEY_VALUES[name]
    at, raw = (value.degrees, value.value) if isinstance(value, Extreme) else (None, value)
    each: tuple[float, ...] = raw if isinstance(raw, tuple) else (raw,)
    shown = [float(convert(one, quantity.kind, system)) + 0.0 for one in each]
    if not all(math.isfinite(one) for one in shown):
        raise _too_large(quantity)
    unit = SYSTEMS[system][quantity.kind]
    number = tuple(shown) if isinstance(raw, tuple) else shown[0]
    noise = any(map(quantity.is_noise, shown))
    return KeyValue(name, quantity.symbol, quantity.ascii_symbol, unit, number, quantity.text, at, noise)


def _too_large(quantity: Quantity) -> UsageError:
    return UsageError(f"{quantity.id} is too large to compute with: check the numbers and units of the machine file")
