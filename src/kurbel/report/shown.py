"""From values in SI to columns and key values in the unit they are shown in; what overflows is refused by name."""

import math
from array import array
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from kurbel.declared.quantity import Quantity
from kurbel.declared.unit_systems import convert, shown_unit, units_of
from kurbel.errors import UsageError
from kurbel.numerics.extreme import Extreme, size_of
from kurbel.report.tables import Column, KeyValue, PlaceTable

_AT_ONCE = 8192
"""Crank angles computed at once: what a table of any length costs in memory beside its own numbers."""
_EVERYWHERE = np.arange(0.0, 720.0, 7.5)
"""Crank angles in degrees over the longest cycle, of which one shows the size of a curve."""
_ROUNDING = 1e-12
"""Values no larger than this beside the largest of their curve are the rounding of a zero."""


def shown_columns(
    phi: Quantity,
    columns: Sequence[Quantity],
    at: Callable[[Any], Any],
    angles: Sequence[float],
    system: str,
) -> tuple[Column, ...]:
    """Return φ and these columns as far as the machine has them, at crank angles (n,) in degrees.

    at: takes angles (k,) and returns a state whose attributes are the columns, (k,) in SI, or None.
    Raises UsageError where one is not finite.
    """
    wanted = dict.fromkeys((phi, *columns))
    found: dict[Quantity, array[float]] = {}
    sizes: dict[Quantity, float] = {}
    for start in range(0, len(angles), _AT_ONCE):
        degrees = np.append(angles[start : start + _AT_ONCE], _EVERYWHERE)
        state = at(degrees)
        for column in wanted:
            values = degrees if column is phi else state[column.id]
            if values is not None:
                rows, everywhere = np.split(np.asarray(values, dtype=float), [-len(_EVERYWHERE)])
                found.setdefault(column, array("d")).frombytes(rows.tobytes())
                sizes[column] = 0.0 if column is phi else float(np.abs(everywhere).max())
    return tuple(shown_column(column, values, system, sizes[column]) for column, values in found.items())


def shown_column(
    quantity: Quantity, values: Sequence[float | None], system: str, size: float = 0.0, beside: float = 0.0
) -> Column:
    """Return the column of a quantity; values (n,) in SI, None where there is none; size: of the largest of its curve.

    beside: the largest value in SI of what is to have the same unit. Raises UsageError where one is not finite.
    """
    given = np.frombuffer(values) if isinstance(values, array) else np.array([v for v in values if v is not None])
    if not (np.isfinite(given).all() and math.isfinite(size)):
        raise too_large(quantity)
    largest = max(given.max(initial=0.0), -given.min(initial=0.0))
    size = size if largest <= _ROUNDING * size else 0.0
    unit = shown_unit(quantity.kind, system, max(size or largest, beside))
    given[:] = convert(given, quantity.kind, unit)  # in place: a long table is held once
    given += 0.0
    following = map(float, given)
    shown = values if isinstance(values, array) else tuple(None if v is None else next(following) for v in values)
    size = convert(size, quantity.kind, unit)
    symbols = quantity.symbol, quantity.ascii_symbol
    return Column(quantity.id, *symbols, quantity.marked(unit), shown, quantity.text, size=size)


def place_table(
    id: str,
    title: str,
    heads: tuple[str, ...],
    names: Iterable[tuple[str, ...]],
    found: Iterable[tuple[Quantity, Sequence[float | None]]],
    system: str,
    headed: bool = False,
) -> PlaceTable:
    """Return a table of places; found: its quantities with their values in SI.

    Orders and numbers of modes are written as such, 1.5, but 1 and 2; a distance in thousandths.
    """

    def column(quantity: Quantity, values: Sequence[float | None]) -> Column:
        decimals = {"distance": 3}.get(quantity.id)
        if quantity.id in ("order", "mode"):
            decimals = int(any(value and value % 1 for value in values))
        return shown_column(quantity, values, system)._replace(decimals=decimals)

    return PlaceTable(id, title, heads, tuple(names), tuple(column(*one) for one in found), headed)


def shown_key_values(found: Iterable[tuple[Quantity, Any]], system: str) -> list[KeyValue]:
    """Return key values, the largest and the smallest of a column in one unit; found: as numbers in SI, or as below."""
    given = tuple(found)
    units = units_of([(quantity.kind, quantity.family, size_of(value)) for quantity, value in given], system)
    return [_key_value(*one, unit) for one, unit in zip(given, units)]


def _key_value(quantity: Quantity, value: Any, unit: str) -> KeyValue:
    """Return the key value; value: a number in SI, an Extreme, or a tuple. Raises UsageError as above."""
    at, raw = (value.degrees, value.value) if isinstance(value, Extreme) else (None, value)
    each: tuple[float, ...] = raw if isinstance(raw, tuple) else (raw,)
    if not all(math.isfinite(one) for one in each):
        raise too_large(quantity)
    shown = [float(convert(one, quantity.kind, unit)) + 0.0 for one in each]
    number = tuple(shown) if isinstance(raw, tuple) else raw if isinstance(raw, int) else shown[0]  # a count
    noise = any(map(quantity.is_noise, shown))
    symbols = (quantity.symbol, quantity.ascii_symbol)
    return KeyValue(quantity.id, *symbols, quantity.marked(unit), number, quantity.text, at, noise)


def too_large(quantity: Quantity) -> UsageError:
    """Return the error for a quantity that overflows."""
    return UsageError(f"{quantity.id} is too large to compute with: check the numbers and units of the machine file")
