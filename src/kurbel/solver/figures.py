"""Results by name: the rows of a class of results, its key values by id or printed symbol, and all columns at once.

A class of results has its key values, and a class of columns its columns, as attributes with rows (`kurbel.quantity`).
They are printed in the order of their definition, for people below the `Heading` before them. In the place of a
`PartResults` are the rows of another class, in that of `ExtremesOfColumns` the extremes of the columns.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from itertools import chain
from typing import Any, ClassVar, NamedTuple, TypeVar

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.reading import text_in_one_line
from kurbel.declared.unit_systems import SI, convert, shown_unit
from kurbel.errors import UsageError
from kurbel.mechanisms import KeyOffer, Offer
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.quantity import (
    ITS_OWN,
    PHI,
    Computed,
    ForEach,
    Formula,
    Heading,
    Lists,
    Of,
    Quantity,
    QuantityRow,
    ResultCondition,
    ambiguity,
    called,
    refuse_other_meanings,
)

V = TypeVar("V")


class Figure(NamedTuple):
    """A key value: a number, or a tuple of them, in its SI unit, and the angle in degrees of an extreme, else None."""

    value: Any
    unit: str
    degrees: float | None
    quantity: Quantity

    def __str__(self) -> str:
        """Return it as people read it, with four digits in metric units.

        >>> str(Figure(10000.0, "N", 90.0, Quantity("T_max", "T_max", "force", "Largest tangential force")))
        '10.00 kN at 90.00°'
        """
        values = self.value if isinstance(self.value, tuple) else (self.value,)
        kind = self.quantity.kind
        unit = shown_unit(kind, "metric", max(map(abs, values), default=0.0))
        numbers = ", ".join(f"{convert(value, kind, unit):#.4g}".rstrip(".") for value in values)
        where = "" if self.degrees is None else f" at {self.degrees:.2f}°"
        return f"{numbers} {self.quantity.marked(unit)}".rstrip() + where

    def __repr__(self) -> str:
        """Return it with its id, in SI.

        >>> Figure(10000.0, "N", 90.0, Quantity("T_max", "T_max", "force", "Largest tangential force"))
        <T_max = 10000 N at 90°>
        """
        values = self.value if isinstance(self.value, tuple) else (self.value,)
        numbers = ", ".join(f"{value:.9g}" for value in values)
        where = "" if self.degrees is None else f" at {self.degrees:.6g}°"
        return f"<{self.quantity.id} = {numbers} {self.unit}".rstrip() + f"{where}>"


class NotebookView:
    """How a notebook shows results; `kurbel.notebook` sets it, since the solver may not import tables and pictures."""

    as_html: ClassVar[Of[str] | None] = None

    def _repr_html_(self) -> str | None:
        if not NotebookView.as_html:
            return None
        return NotebookView.as_html(self)


# columns


class AtAngles:
    """Columns at crank angles (n,) in degrees: attributes with rows, in SI, each (n,), None for what there is not."""

    commands: ClassVar[tuple[str, ...]] = ()
    """Those that print its columns, except columns with `commands` of their own."""

    def __init_subclass__(cls) -> None:
        # a column of several parts is an attribute for each of them
        for item in list(vars(cls).values()):
            if isinstance(item, ForEach):
                for row in item.rows:
                    setattr(cls, row.quantity.id, property(row.of, doc=row.quantity.text))

    def __repr__(self) -> str:
        ids = ", ".join(f".{id}" for id in list(self.rows)[:4])
        return f"<kurbel columns at crank angles: {ids}, … in SI>"

    @property
    def rows(self) -> Mapping[str, QuantityRow]:
        """The rows of its columns, by id."""
        return column_rows(type(self))

    def __getitem__(self, id: str) -> Any:
        """Return a column by its id; None for one that there is not."""
        row = self.rows.get(id)
        if row is None:
            return None
        return row.of(self)


_COLUMN_ROWS: dict[tuple[type, tuple[Offer, ...]], Mapping[str, QuantityRow]] = {}


def column_rows(state: type[AtAngles], offers: tuple[Offer, ...] = ()) -> Mapping[str, QuantityRow]:
    """Return the rows of a class of columns, and of what mechanisms add to it, in printed order."""
    if (state, offers) in _COLUMN_ROWS:
        return _COLUMN_ROWS[state, offers]
    rows = list[QuantityRow]()
    for owner in reversed(state.__mro__):
        if not issubclass(owner, AtAngles):
            continue
        for item in vars(owner).values():
            if isinstance(item, (Computed, ForEach)):
                rows += (_with_commands(row, owner.commands) for row in item.rows)
    rows += (QuantityRow(offer.quantity, offer.of, offer.unless) for offer in offers)

    # the angle is a column of every command that has another
    commands = dict.fromkeys(chain.from_iterable(row.quantity.commands for row in rows))
    phi = QuantityRow(PHI._replace(commands=tuple(commands)), lambda state: state.phi)
    return _COLUMN_ROWS.setdefault((state, offers), _in_order([phi, *rows], state))


def _with_commands(row: QuantityRow, commands: tuple[str, ...]) -> QuantityRow:
    """Return a row with the commands of its class, if it has none of its own."""
    if row.quantity.commands != ITS_OWN:
        return row
    return row._replace(quantity=row.quantity._replace(commands=commands))


def _in_order(rows: Sequence[QuantityRow], owner: type) -> dict[str, QuantityRow]:
    """Return rows by id in the order in which they are printed, the first of those with one id.

    Several `after` the same one keep their order; one without a heading has that of the one before it. Raises TypeError
    for an id that has two meanings.
    """
    refuse_other_meanings({}, (row.quantity for row in rows), owner.__name__)
    by_id: dict[str, QuantityRow] = {}
    for row in rows:
        by_id.setdefault(row.quantity.id, row)
    quantities = [row.quantity for row in by_id.values()]
    ordered = [quantity for quantity in quantities if quantity.after not in by_id]
    for quantity in quantities:
        if quantity.after not in by_id:
            continue
        index = [other.id for other in ordered].index(quantity.after) + 1
        while index < len(ordered) and ordered[index].after == quantity.after:
            index += 1
        heading = quantity.heading or ordered[index - 1].heading
        ordered.insert(index, quantity._replace(heading=heading))
    return {quantity.id: by_id[quantity.id]._replace(quantity=quantity) for quantity in ordered}


# key values


class Rows(NamedTuple):
    """The rows of a class of results, by id, in the order in which they are printed."""

    columns: Mapping[str, QuantityRow]
    key_values: Mapping[str, QuantityRow]

    @property
    def lists(self) -> Lists:
        """Their quantities."""
        return Lists(*(tuple(row.quantity for row in rows.values()) for rows in self))

    def changed(self, change: Callable[[Quantity], Quantity]) -> Rows:
        """Return the rows with other quantities."""

        def changed_rows(rows: Mapping[str, QuantityRow]) -> dict[str, QuantityRow]:
            return {id: row._replace(quantity=change(row.quantity)) for id, row in rows.items()}

        return Rows(*map(changed_rows, self))


ResultsDoor = Callable[[], "type[Results]"]
"""A function with one import inside, that of the class it returns."""


class PartResults(Computed[V]):
    """Results that are a part of others; their rows are printed in the place of the attribute."""

    def __init__(
        self,
        function: Of[V],
        kind: type[Results] | ResultsDoor,
        unless: ResultCondition | None,
        there: ResultCondition | None,
    ) -> None:
        super().__init__(function, Quantity("", "", "", function.__doc__ or ""))
        self._door: ResultsDoor = (lambda: kind) if isinstance(kind, type) else kind
        self.unless, self.there = unless, there

    @cached_property
    def kind(self) -> type[Results]:
        """The class of the results."""
        return self._door()

    def of_whole(self, rows: Iterable[QuantityRow]) -> Iterator[QuantityRow]:
        """Yield the rows of the part for the results that it is a part of; None where they have no such part."""

        def of_part(function: Formula, results: object) -> Any:
            part = self.__get__(results)
            if part is None:
                return None
            return function(part)

        for row in rows:
            unless = self.unless
            if unless is None and row.unless:
                unless = partial(of_part, row.unless)
            repeats = row.repeats and partial(of_part, row.repeats)
            yield QuantityRow(row.quantity, partial(of_part, row.of), unless, repeats)


def part(
    kind: type[Results] | ResultsDoor,
    unless: ResultCondition | None = None,
    there: ResultCondition | None = None,
) -> Callable[[Of[V]], PartResults[V]]:
    """Return a decorator for a method that returns results of this class, or None where there is no such part.

    kind: the class, or a door to it. unless: takes the results; where it is true, all of the part says nothing new.
    there: of a part behind a door, takes the results; where it is false, there is no such part: the door stays closed.
    """
    return lambda function: PartResults(function, kind, unless, there)


class ExtremesOfColumns:
    """The place of the extremes of columns among the key values of a class; without it they are printed last."""

    ENDS: ClassVar[dict[str, Callable[[Extremes], Extreme]]] = {
        "max": lambda extremes: extremes.largest,
        "min": lambda extremes: extremes.smallest,
        "peak": lambda extremes: extremes.peak,
    }

    def rows(self, columns: Iterable[Quantity]) -> Iterator[QuantityRow]:
        """Yield the key values that are extremes of columns, of results that have `extremes_of(id)`."""

        def extreme(column: str, end: str, results: Any) -> Extreme | None:
            extremes = results.extremes_of(column)
            if extremes is None:
                return None
            return self.ENDS[end](extremes)

        def repeats(column: str, end: str, results: Any) -> bool:
            # the largest magnitude is that of the largest or the smallest value
            return end == "peak" or results.repeats(column)

        for column in columns:
            for end in self.ENDS if column.peak else ("max", "min"):
                yield QuantityRow(
                    column.extreme(end),
                    partial(extreme, column.id, end),
                    repeats=partial(repeats, column.id, end),
                )


class Results(NotebookView):
    """Key values of a command, and its columns: attributes named by their ids, in SI, or results by name."""

    command: ClassVar[str] = ""
    state: ClassVar[type[AtAngles] | None] = None
    """The class of its columns."""
    DOORS: ClassVar[dict[str, PartResults[Any]]] = {}
    """Its parts behind doors, by name."""

    def __init_subclass__(cls) -> None:
        parts = (
            attribute for attribute in vars(cls).values() if isinstance(attribute, PartResults)
        )
        cls.DOORS = cls.DOORS | {part.name: part for part in parts if part.there}
        # what the class has through its parts, or as extremes, are attributes as well
        _name_attributes(cls, result_rows(cls, closed=doors_of(cls)))

    def __getattr__(self, name: str) -> Any:
        """Return what a part behind a door has by this name; Python asks here for what has no other attribute."""
        kind = type(self)
        may_be_behind_a_door = (
            bool(self.DOORS) and not name.startswith("_") and not hasattr(kind, name)
        )
        if not may_be_behind_a_door or name not in result_rows(kind).key_values:
            raise AttributeError(f"{kind.__name__!r} object has no attribute {name!r}")
        _name_attributes(kind, result_rows(kind))
        return object.__getattribute__(self, name)

    @property
    def closed(self) -> frozenset[str]:
        """The names of its parts behind doors that these results do not have."""
        return frozenset(
            name for name, part in self.DOORS.items() if part.there and not part.there(self)
        )

    @property
    def rows(self) -> Rows:
        """The rows that results of this kind may have."""
        return result_rows(type(self), closed=self.closed)

    @property
    def lists(self) -> Lists:
        """The quantities that results of this kind may have."""
        return self.rows.lists

    def __getitem__(self, name: str) -> Figure:
        """Return a key value by its id or printed symbol; raises UsageError where there is none."""
        rows = self.rows
        if self.closed and not called(name, rows.lists.all_key_values):
            rows = result_rows(
                type(self)
            )  # of a part that these results do not have: the message says what it is
        row = _only(name, rows.key_values, "key value")
        value = row.of(self)
        if value is None:
            raise UsageError(f"this machine has no {row.quantity.id}: {row.quantity.text}")
        return _figure(row.quantity, value)

    def key_values(self) -> dict[str, Figure]:
        """Return every key value that there is by its id, in the order in which they are printed."""
        figures = {}
        for row in self.rows.key_values.values():
            value = row.of(self)
            if value is not None:
                figures[row.quantity.id] = _figure(row.quantity, value)
        return figures

    def columns(self, degrees: object, *names: str) -> dict[str, Array]:
        """Return φ and these columns (n,), or all that there are, in SI by id, at crank angles (n,) in degrees.

        names: ids or printed symbols. Raises UsageError for angles that are no numbers and for what is no column here.
        """
        angles = np.atleast_1d(crank_angles(degrees))
        state = self.at(angles)
        declared = self._own_columns
        rows = [_only(name, declared, "column") for name in names] if names else declared.values()
        arrays: dict[str, Array] = {"phi": angles}
        for row in rows:
            values = angles if row.quantity.id == "phi" else row.of(state)
            if values is not None:
                arrays[row.quantity.id] = np.asarray(values, float)
            elif names:
                raise UsageError(f"this machine has no {row.quantity.id}: {row.quantity.text}")
        return arrays

    @cached_property
    def _own_columns(self) -> dict[str, QuantityRow]:
        """The rows of the columns of this command, by id."""
        columns = self.rows.columns
        return {id: row for id, row in columns.items() if self.command in row.quantity.commands}

    def at(self, degrees: object, within: Array | None = None) -> Any:
        """Return every column at crank angles (n,) in degrees; of the whole machine those of crank 1.

        At a jump the value on the side that holds `within` (n,) is meant, just after it where that is not given. Raises
        UsageError for results that have key values alone.
        """
        angles = crank_angles(degrees)
        return self._columns(angles, angles if within is None else within)

    def _columns(self, phi: Array, within: Array) -> AtAngles:
        """Return the columns at crank angles (n,) in degrees, on the sides of jumps that hold `within`."""
        raise UsageError("these results have key values, and no columns over the crank angle")

    def repeats(self, column: str) -> bool:
        """Return whether people read the extremes of a column in other rows, or they are 0."""
        extremes = self.extremes_of(column)
        return extremes is not None and extremes.largest.value == extremes.smallest.value == 0

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes in SI of a column that is declared to have them, None where it is left out."""
        return None

    @property
    def _of(self) -> str:
        """What the results are of."""
        return "the whole machine"

    def __repr__(self) -> str:
        return f"<kurbel {self.command} of {self._of}: ['id'], key_values(), columns(degrees)>"


_ROWS: dict[tuple[type, tuple[Offer, ...], tuple[KeyOffer, ...], frozenset[str]], Rows] = {}


def doors_of(kind: type[Results]) -> frozenset[str]:
    """Return the names of the parts of a class of results that are behind doors."""
    return frozenset(kind.DOORS)


def _name_attributes(kind: type[Results], rows: Rows) -> None:
    """Make an attribute of each key value that is none yet."""
    for id, row in rows.key_values.items():
        if not hasattr(kind, id):
            setattr(kind, id, property(row.of, doc=row.quantity.text))


def result_rows(
    kind: type[Results],
    offers: tuple[Offer, ...] = (),
    key_offers: tuple[KeyOffer, ...] = (),
    closed: frozenset[str] = frozenset(),
) -> Rows:
    """Return the rows of a class of results, with the columns and key values that mechanisms add.

    closed: names of its parts whose rows are left out, so that what they are made of is not imported.
    """
    if (kind, offers, key_offers, closed) in _ROWS:
        return _ROWS[kind, offers, key_offers, closed]
    columns = column_rows(kind.state, offers) if kind.state else {}
    quantities = [row.quantity for row in columns.values()]
    if not quantities:
        quantities = [offer.quantity for offer in offers]
    # its own definitions and inherited ones, in the order in which each was defined first
    definitions: dict[str, object] = {}
    for owner in reversed(kind.__mro__):
        definitions |= vars(owner)

    # of rows with one id the first counts
    rows_in_order = list[QuantityRow]()
    heading = ""
    for item in (*definitions.values(), ExtremesOfColumns()):
        rows: Iterable[QuantityRow] = ()
        if isinstance(item, Heading):
            heading = item.text
        elif isinstance(item, PartResults):
            if item.name not in closed:
                key_values = result_rows(item.kind, offers, key_offers).key_values
                rows = item.of_whole(key_values.values())
        elif isinstance(item, ExtremesOfColumns):
            searched = [quantity for quantity in quantities if kind.command in quantity.extremes]
            rows = item.rows(searched)
        elif isinstance(item, (Computed, ForEach)):
            rows = item.rows
        for row in rows:
            printed = row.quantity.printed_by(kind.command, heading)
            rows_in_order.append(row._replace(quantity=printed))
    for offer in key_offers:
        if kind.command in offer.quantity.commands:
            rows_in_order.append(QuantityRow(offer.quantity.printed_by(kind.command), offer.of))
    rows_of_kind = Rows(columns, _in_order(rows_in_order, kind))
    return _ROWS.setdefault((kind, offers, key_offers, closed), rows_of_kind)


def result(values: Array, count: int | None) -> Any:
    """Return values (machines,) as they are for many machines, and as a float for one, whose count is None."""
    if count is not None:
        return values
    return float(values[0])


def crank_angles(degrees: object) -> Array:
    """Return crank angles in degrees as an array; raises UsageError for what are no finite numbers."""
    try:
        angles = np.asarray(degrees, dtype=float)
    except (TypeError, ValueError):
        raise UsageError(
            f"crank angles are numbers of degrees, not {text_in_one_line(repr(degrees))}"
        ) from None
    if not np.isfinite(angles).all():
        raise UsageError("crank angles are finite numbers of degrees, not nan or inf")
    return angles


def _only(name: str, rows: Mapping[str, QuantityRow], what: str) -> QuantityRow:
    """Return the one row that a name means, its id first; raises UsageError for none and for several."""
    if name in rows:
        return rows[name]
    ids = called(name, (row.quantity for row in rows.values()))
    if len(ids) != 1:
        raise UsageError(
            ambiguity(name, ids)
            or f"no {what} '{text_in_one_line(name)}'{did_you_mean(name, tuple(rows))}"
        )
    return rows[ids[0]]


def _figure(quantity: Quantity, value: object) -> Figure:
    number, degrees = value if isinstance(value, Extreme) else (value, None)
    return Figure(number, quantity.marked(SI[quantity.kind]), degrees, quantity)
