"""From values in SI to columns, key values and tables of places in the units in which they are shown."""

import re
from array import array
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.unit_systems import convert, shown_unit, units_of
from kurbel.errors import UsageError
from kurbel.numerics.extreme import Extreme, number_of, size_of
from kurbel.quantity import ENTRY_DECIMALS, Quantity
from kurbel.solver.figures import AtAngles
from kurbel.tables.tables import CellValue, Column, KeyValue, PlaceTable

EVERYWHERE = np.arange(0.0, 720.0, 7.5)
"""Crank angles in degrees over the longest cycle, at which the size of a curve is estimated."""
ROUNDING = 1e-12
"""Values below this, relative to the largest of their curve, are rounding errors of a zero."""
_AT_ONCE = 8192
"""Crank angles computed at once, so that a long table needs little memory apart from its own numbers."""


def too_large(quantity: Quantity) -> UsageError:
    """Return the error for a quantity that overflows."""
    return UsageError(
        f"{quantity.id} is too large to compute with: check the numbers and units of the machine file"
    )


def shown_columns(
    at: Callable[[Array], AtAngles],
    quantities: Sequence[Quantity],
    angles: Sequence[float],
    system: str,
) -> tuple[Column, ...]:
    """Return those of these columns that the machine has, at crank angles (n,) in degrees; at: see `Subject`.

    Raises UsageError if one is not finite.
    """
    batches: dict[Quantity, list[Array]] = {}
    sizes: dict[Quantity, float] = {}
    for start in range(0, len(angles), _AT_ONCE):
        # the rows of this batch, and the angles that show how large each curve is
        degrees = np.append(angles[start : start + _AT_ONCE], EVERYWHERE)
        state = at(degrees)
        for quantity in quantities:
            is_angle = quantity.id == "phi"
            values = degrees if is_angle else state[quantity.id]
            if values is not None:
                rows, everywhere = np.split(np.asarray(values, dtype=float), [-len(EVERYWHERE)])
                batches.setdefault(quantity, []).append(rows)
                sizes[quantity] = 0.0 if is_angle else float(np.abs(everywhere).max())

    columns = []
    for quantity in list(batches):
        # batches are given up as soon as they are joined
        rows = np.concatenate(batches.pop(quantity))
        columns.append(shown_column(quantity, rows, system, sizes[quantity]))
    return tuple(columns)


def shown_column(
    quantity: Quantity,
    values: Sequence[float | None] | Array,
    system: str,
    size: float = 0.0,
    largest: float = 0.0,
) -> Column:
    """Return the column of a quantity; values: (n,) in SI, None for no value; size: the largest value of its curve.

    largest: of all columns that are to have the same unit, in SI. Raises UsageError if a value is not finite.
    """
    gaps = list[int]()
    if not isinstance(values, np.ndarray):
        gaps = [row for row, value in enumerate(values) if value is None]
    numbers = np.array(values, dtype=float)
    numbers[gaps] = 0.0
    if not (np.isfinite(numbers).all() and np.isfinite(size)):
        raise too_large(quantity)

    # values that are all rounding errors of their curve keep its size and unit
    largest_shown = max(numbers.max(initial=0.0), -numbers.min(initial=0.0))
    is_rounding = largest_shown <= ROUNDING * size
    size = size if is_rounding else 0.0
    unit = shown_unit(quantity.kind, system, max(size or largest_shown, largest))

    # a negative zero loses its sign
    converted = array("d", (convert(numbers, quantity.kind, unit) + 0.0).tobytes())
    cells: Sequence[CellValue] = converted
    if gaps:
        with_gaps: list[CellValue] = list(converted)
        for row in gaps:
            with_gaps[row] = None
        cells = with_gaps
    return Column(
        quantity.id,
        quantity.symbol,
        quantity.ascii_symbol,
        quantity.marked(unit),
        cells,
        quantity.text,
        size=float(convert(size, quantity.kind, unit)),
    )


PlaceRow = tuple[tuple[str, ...], Mapping[str, float | None]]
"""A row of a table of places: its names, and its values in SI by the ids of their quantities."""


class Places(NamedTuple):
    """A table of places with its values in SI; see `PlaceTable`.

    declared: its quantities by id; one that no row has is left out. headed: the names of the rows are texts for people;
    otherwise programs have them without spaces and punctuation. alone: the digits to which every value is rounded by
    itself; values of one kind then have one unit.
    """

    id: str
    title: str
    heads: tuple[str, ...]
    declared: Mapping[str, Quantity]
    rows: Sequence[PlaceRow]
    headed: bool = False
    alone: int = 0
    in_note: bool = False

    def shown(self, system: str) -> PlaceTable:
        """Return the table in units; orders and modes have as many decimals as they need, distances three."""
        columns = list[Column]()
        values_of = self._columns()
        largest = _largest_by_kind(values_of) if self.alone else {}
        for quantity, values in values_of.items():
            column = shown_column(quantity, values, system, largest=largest.get(quantity.kind, 0.0))
            columns.append(
                column._replace(
                    decimals=_decimals(quantity, values),
                    alone=0 if quantity.kind == "angle" else self.alone,
                    for_entry=quantity.for_entry,
                )
            )

        names = [row_names for row_names, _ in self.rows]
        words: dict[str, str] = {}
        if not self.headed:
            words = {_as_id(name): name for name in chain.from_iterable(names)}
            names = [tuple(map(_as_id, row_names)) for row_names in names]
        return PlaceTable(
            self.id,
            self.title,
            self.heads,
            tuple(names),
            tuple(columns),
            self.headed,
            self.in_note,
            words,
        )

    def _columns(self) -> dict[Quantity, list[float | None]]:
        """Return the values of every row by the quantities that a row has, in their declared order."""
        columns = {}
        for id, quantity in self.declared.items():
            if any(id in values for _, values in self.rows):
                columns[quantity] = [values.get(id) for _, values in self.rows]
        return columns


def _largest_by_kind(columns: Mapping[Quantity, Sequence[float | None]]) -> dict[str, float]:
    """Return the largest value of all columns of a kind, in SI."""
    largest: dict[str, float] = {}
    for quantity, values in columns.items():
        sizes = (abs(value or 0.0) for value in values)
        largest[quantity.kind] = max(largest.get(quantity.kind, 0.0), *sizes)
    return largest


def _decimals(quantity: Quantity, values: Iterable[float | None]) -> int | None:
    """Return the decimals of a column of places, None for those of its digits."""
    if quantity.id == "distance":
        return 3
    if quantity.kind == "angle" and quantity.for_entry:
        return _entry_decimals(values)
    if quantity.id not in ("order", "mode"):
        return None
    numbers = [value for value in values if value]
    if all(number % 1 == 0 for number in numbers):
        return 0
    return 1 if all(number % 0.5 == 0 for number in numbers) else 3


def _entry_decimals(degrees: Iterable[float | None]) -> int:
    """Return the decimals of angles that are written into a machine file again, fewer where none has so many.

    >>> _entry_decimals([150.0, None, 26.565051177]), _entry_decimals([150.0])
    (4, 0)
    """
    for decimals in range(ENTRY_DECIMALS):
        if all(abs(angle - round(angle, decimals)) < 1e-9 for angle in degrees if angle):
            return decimals
    return ENTRY_DECIMALS


_BETWEEN = re.compile(r"[\s,:;=–]+")
"""What parts the words of the name of a row."""


def _as_id(name: str) -> str:
    """Return the name of a row as programs have it.

    >>> _as_id("shaft n = 1, against the crank: A")
    'shaft_n_1_against_the_crank_A'
    """
    return _BETWEEN.sub("_", name)


def shown_key_values(values: Iterable[tuple[Quantity, object]], system: str) -> list[KeyValue]:
    """Return key values in the units of the system; values: in SI, see `Subject.key_values`.

    The maximum and the minimum of a column have the same unit. Raises UsageError if one is not finite.
    """
    values = tuple(values)
    sizes = [(quantity.kind, quantity.family, size_of(value)) for quantity, value in values]
    units = units_of(sizes, system)
    return [_shown(quantity, value, unit) for (quantity, value), unit in zip(values, units)]


def _shown(quantity: Quantity, value: object, unit: str) -> KeyValue:
    """Return a key value in a unit; value: in SI, a number, a tuple of numbers, or an Extreme."""
    raw = number_of(value)
    in_si = raw if isinstance(raw, tuple) else (raw,)
    if not np.isfinite(in_si).all():
        raise too_large(quantity)
    # a negative zero loses its sign
    numbers = tuple(float(convert(number, quantity.kind, unit)) + 0.0 for number in in_si)
    printed: CellValue | tuple[float, ...]
    if isinstance(raw, tuple):
        printed = numbers
    elif isinstance(raw, int):  # a count
        printed = raw
    else:
        printed = numbers[0]
    return KeyValue(
        quantity.id,
        quantity.symbol,
        quantity.ascii_symbol,
        quantity.marked(unit),
        printed,
        quantity.text,
        value.degrees if isinstance(value, Extreme) else None,
        any(map(quantity.is_noise, numbers)),
        quantity.heading,
        for_entry=quantity.for_entry,
    )
