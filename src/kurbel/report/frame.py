"""From results and their declared quantities to the tables of a report: what all commands on a machine share."""

import math
import sys
from array import array
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from hashlib import sha256
from typing import Any

import numpy as np

from kurbel.declared.reading import shown
from kurbel.declared.unit_systems import convert, shown_unit, units_of
from kurbel.errors import NoSolutionError, Nowhere, UsageError
from kurbel.machine import Machine
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import Extreme, size_of
from kurbel.quantities import every_quantity
from kurbel.quantity import Lists, Quantity, called
from kurbel.report.tables import Column, InputFile, KeyValue, LeftOut, Part, PlaceTable, Provenance, Report
from kurbel.solver.figures import Results

_AT_ONCE = 8192
"""Crank angles computed at once, so that a table of any length needs little memory besides its own numbers."""
_EVERYWHERE = np.arange(0.0, 720.0, 7.5)
"""Crank angles in degrees over the longest cycle, which show how large a curve is."""
_ROUNDING = 1e-12
"""Values no larger than this, relative to the largest of their curve, are the rounding of a zero."""


@dataclass(frozen=True, eq=False)
class Subject:
    """What a command has results of: a cylinder, a pin or bearing, or the whole machine.

    results: the objects that have its key values, searched in this order; at: takes crank angles (n,) in degrees and
    returns a state with its columns, None without columns; lists: the quantities that there may be; source: has
    `angles_where`, None for what has no rows; of: the cylinder that a pin belongs to. left_out, warnings, tables: what
    a report shows besides, empty where only figures are wanted.
    """

    name: str
    results: tuple[Any, ...] = ()
    at: Callable[[Any], Any] | None = None
    lists: Lists = field(default_factory=every_quantity)
    left_out: tuple[LeftOut, ...] = ()
    warnings: tuple[str, ...] = ()
    tables: tuple[PlaceTable, ...] = ()
    source: Any = None
    of: str = ""

    def says(self, quantity: Quantity) -> bool:
        """Whether a quantity adds something here: a time ratio does not if both strokes take equally long."""
        return not any(_says_nothing(one, quantity) for one in self.results)

    def answer(self, quantity: Quantity) -> Any:
        """Return a key value in SI: a number, an Extreme, or a tuple of numbers; None if there is none."""
        found = (_value(one, quantity) for one in self.results)
        return next((value for value in found if value is not None), None)

    def key_values(self, command: str) -> Iterator[tuple[Quantity, Any]]:
        """Yield the key values of a command that it has, in SI."""
        for quantity in self.lists.key_values(command).values():
            value = self.answer(quantity) if self.says(quantity) else None
            if value is not None:
                yield quantity, value


def _value(results: Results, quantity: Quantity) -> Any:
    """Return a key value of results, in SI; None where they have none."""
    row = results.rows.key_values.get(quantity.id)
    return None if row is None else row.of(results)


def _says_nothing(results: Results, quantity: Quantity) -> bool:
    """Return whether a quantity says nothing new of results."""
    row = results.rows.key_values.get(quantity.id) or results.rows.columns.get(quantity.id)
    return bool(row and row.unless and row.unless(results))


def column_of(state: Any, quantity: Quantity) -> Any:
    """Return a column (n,) of a state in SI, None if the machine does not have it."""
    return state.phi if quantity.id == "phi" else state[quantity.id]


@dataclass(frozen=True, eq=False)
class Frame:
    """What is requested of a report on a machine, whichever its command.

    angles: the crank angles (n,) of the rows in degrees, or a function that returns those of a subject; columns: ids
    to show besides φ, None for the usual ones; system: see `unit_systems`; over: another column for the rows;
    compare: with the approximations of the book next to the exact columns; prose: with key values, notes, warnings,
    and what is left out, none of which a CSV table shows.
    """

    command: str
    angles: Sequence[float] | Callable[[Subject], Sequence[float]]
    columns: Sequence[str] | None
    system: str
    over: str = ""
    compare: bool = False
    prose: bool = True


def refuse_without_cylinder(machine: Machine, command: str) -> None:
    """Raise UsageError if the machine has no cylinder."""
    if not machine.cylinders:
        raise UsageError(f"{machine.name} has no cylinder; kurbel {command} needs one")


@np.errstate(all="ignore")
def report_on(
    frame: Frame,
    machine: Machine,
    title: str,
    subjects: Iterable[Subject],
    whole: Subject | None = None,
    notes: Iterable[str] = (),
) -> Report:
    """Return the report on these subjects, and on the whole machine.

    Raises UsageError for what overflows and for a column that no subject has, NoSolutionError if no row is found.
    """
    every = (*subjects, *((whole,) if whole else ()))
    rows = [_rows(frame, one) for one in every]
    printed = {column.id for columns, _ in rows for column in columns}
    for name in frame.columns or ():
        if name not in printed:
            raise UsageError(f"--columns: {_absent(name, frame.command, every)}")
    nowhere = [why for _, why in rows if why]
    if nowhere and not printed:
        raise NoSolutionError(nowhere[0])
    with_values = frame.prose or not (printed or any(one.tables for one in every))
    parts = [
        Part(
            one.name,
            columns,
            tuple(shown_key_values(one.key_values(frame.command), frame.system)) if with_values else (),
            one.left_out,
            one.warnings,
            one.tables,
            why,
            one.of,
        )
        for one, (columns, why) in zip(every, rows)
    ]
    last = parts.pop() if whole else None
    # the balance says itself what it leaves out
    uncompared = frame.compare and frame.command != "balance" and not any(id.endswith("_book") for id in printed)
    said = (*notes, *((_UNCOMPARED,) if uncompared else ()), *(f"{why}." for why in nowhere))
    return Report(
        f"{machine.name}. {title}",
        frame.command,
        machine.name,
        "cylinders",
        tuple(parts),
        last,
        notes=said,
        provenance=provenance(machine) if frame.prose else None,
        cylinders=tuple(cylinder.name for cylinder in machine.cylinders),
    )


_UNCOMPARED = (
    "--compare: the approximations of the book (R 286-291, 297) are those of a slider-crank without offset and of a "
    "piston with pressures; this machine has neither."
)
_Rows = tuple[tuple[Column, ...], str]
"""The columns of a subject, and why it has no row."""


def _rows(frame: Frame, subject: Subject) -> _Rows:
    if subject.at is None:
        return (), ""
    try:
        angles = frame.angles(subject) if callable(frame.angles) else frame.angles
    except Nowhere as error:
        return (), str(error)
    known = subject.lists.columns(frame.command)
    added = [one for one in known.values() if one.id == frame.over or (frame.compare and one.id.endswith("_book"))]
    if frame.columns:
        chosen = [*(known[name] for name in frame.columns if name in known), *added]
    else:
        usual = (one for one in known.values() if frame.command not in one.on_request or one in added)
        chosen = [one for one in usual if subject.says(one)]
    wanted = tuple(dict.fromkeys((known["phi"], *chosen)))
    return shown_columns(subject.at, wanted, angles, frame.system), ""


def _absent(name: str, command: str, subjects: Sequence[Subject]) -> str:
    """Return why there is no such column, and which there are."""
    every = every_quantity()
    known, key_values = every.columns(command), every.key_values(command)
    there: dict[str, Quantity] = {}
    for subject in subjects:
        if subject.at is not None:
            state, own = subject.at(np.zeros(1)), subject.lists.columns(command)
            there |= {id: known[id] for id, quantity in own.items() if column_of(state, quantity) is not None}
    symbols = [one.id if one.id == one.symbol else f"{one.id} ({one.symbol})" for one in there.values()]
    has = f"has {', '.join(symbols)}" if there else ""
    if name in known:
        return f"'{name}' is left out for this machine" + (f", which {has}" if has else "")
    if found := called(name, key_values.values()):
        symbol = key_values[found[0]].symbol
        return f"'{name}' is a key value and no column: a line below the table, --key-values | grep '{symbol} '"
    others = ", ".join(id for id in known if id not in there)
    near = [
        did_you_mean(name, tuple(word for one in some for word in (one.id, one.symbol)))
        for some in (there.values(), known.values())
    ]
    listed = [f"this machine {has}" if has else "", f"other machines also {others}" if others else ""]
    return f"'{shown(name)}' is no column of kurbel {command}{near[0] or near[1]} ({'; '.join(filter(None, listed))})"


def provenance(machine: Machine) -> Provenance:
    """Return what the results of a machine are made from: files with their SHA-256, values set over them, versions."""
    inputs, origin = [], machine.origin
    if origin:  # standard input cannot be read again
        inputs.append(InputFile(origin.name, sha256(origin.content).hexdigest()))
    for name in machine.trace_files:
        digest = None
        with suppress(OSError), open(name, "rb") as file:
            digest = sha256(file.read()).hexdigest()
        inputs.append(InputFile(name, digest))
    numpy = sys.modules.get("numpy")
    return Provenance(tuple(inputs), origin.overrides if origin else (), {"numpy": numpy.__version__} if numpy else {})


# from values in SI to columns and key values in the unit in which they are shown


def too_large(quantity: Quantity) -> UsageError:
    """Return the error for a quantity that overflows."""
    return UsageError(f"{quantity.id} is too large to compute with: check the numbers and units of the machine file")


def shown_columns(
    at: Callable[[Any], Any], quantities: Sequence[Quantity], angles: Sequence[float], system: str
) -> tuple[Column, ...]:
    """Return these columns as far as the machine has them, at crank angles (n,) in degrees; at: as of a Subject.

    Raises UsageError if one is not finite.
    """
    found: dict[Quantity, array[float]] = {}
    sizes: dict[Quantity, float] = {}
    for start in range(0, len(angles), _AT_ONCE):
        degrees = np.append(angles[start : start + _AT_ONCE], _EVERYWHERE)
        state = at(degrees)
        for quantity in quantities:
            values = degrees if quantity.id == "phi" else column_of(state, quantity)
            if values is not None:
                rows, everywhere = np.split(np.asarray(values, dtype=float), [-len(_EVERYWHERE)])
                found.setdefault(quantity, array("d")).frombytes(rows.tobytes())
                sizes[quantity] = 0.0 if quantity.id == "phi" else float(np.abs(everywhere).max())
    return tuple(shown_column(quantity, values, system, sizes[quantity]) for quantity, values in found.items())


def shown_column(
    quantity: Quantity, values: Sequence[float | None], system: str, size: float = 0.0, beside: float = 0.0
) -> Column:
    """Return the column of a quantity; values: (n,) in SI, None for no value; size: of the largest of its curve.

    beside: the largest value in SI that is to have the same unit. Raises UsageError if one is not finite.
    """
    given = (
        np.frombuffer(values)
        if isinstance(values, array)
        else np.array([v for v in values if v is not None], dtype=float)
    )
    if not (np.isfinite(given).all() and math.isfinite(size)):
        raise too_large(quantity)
    largest = max(given.max(initial=0.0), -given.min(initial=0.0))
    size = size if largest <= _ROUNDING * size else 0.0
    unit = shown_unit(quantity.kind, system, max(size or largest, beside))
    given[:] = convert(given, quantity.kind, unit)  # in place: a long table is held once
    given += 0.0
    numbers = map(float, given)
    texts = values if isinstance(values, array) else tuple(None if v is None else next(numbers) for v in values)
    size = convert(size, quantity.kind, unit)
    symbols = quantity.symbol, quantity.ascii_symbol
    return Column(quantity.id, *symbols, quantity.marked(unit), texts, quantity.text, size=size)


Row = tuple[tuple[str, ...], Mapping[str, float | None]]
"""The names of a row in a table of places, and its values in SI by the ids of their quantities."""


def place_table(
    id: str,
    title: str,
    heads: tuple[str, ...],
    declared: Mapping[str, Quantity],
    rows: Sequence[Row],
    system: str,
    headed: bool = False,
    alone: int = 0,
) -> PlaceTable:
    """Return a table of places; declared: its quantities by id, of which one is left out if no row has it.

    Orders and numbers of modes are written as such, 1.5, but 1 and 2; a distance in thousandths. alone: the digits of
    values of which each has a scale of its own, with one unit for each kind of quantity.
    """
    values = {quantity: [of.get(id) for _, of in rows] for id, quantity in declared.items()}
    columns = []
    for quantity, each in values.items():
        if any(quantity.id in of for _, of in rows):
            alike = [
                abs(v) for other, some in values.items() if other.kind == quantity.kind for v in some if v is not None
            ]
            column = shown_column(quantity, each, system, beside=max(alike, default=0.0) if alone else 0.0)
            decimals = 3 if quantity.id == "distance" else None
            if quantity.id in ("order", "mode"):
                decimals = int(any(value and value % 1 for value in each))
            columns.append(column._replace(decimals=decimals, alone=0 if quantity.kind == "angle" else alone))
    names = tuple(names if headed else tuple(name.replace(" ", "_") for name in names) for names, _ in rows)
    return PlaceTable(id, title, heads, names, tuple(columns), headed)


def shown_key_values(found: Iterable[tuple[Quantity, Any]], system: str) -> list[KeyValue]:
    """Return key values with the largest and the smallest of a column in one unit; found: as `Subject.key_values`."""
    given = tuple(found)
    units = units_of([(quantity.kind, quantity.family, size_of(value)) for quantity, value in given], system)
    return [_key_value(*one, unit) for one, unit in zip(given, units)]


def _key_value(quantity: Quantity, value: Any, unit: str) -> KeyValue:
    at, raw = (value.degrees, value.value) if isinstance(value, Extreme) else (None, value)
    each: tuple[float, ...] = raw if isinstance(raw, tuple) else (raw,)
    if not all(math.isfinite(one) for one in each):
        raise too_large(quantity)
    numbers = [float(convert(one, quantity.kind, unit)) + 0.0 for one in each]
    number = tuple(numbers) if isinstance(raw, tuple) else raw if isinstance(raw, int) else numbers[0]  # a count
    noise = any(map(quantity.is_noise, numbers))
    symbols = (quantity.symbol, quantity.ascii_symbol)
    return KeyValue(quantity.id, *symbols, quantity.marked(unit), number, quantity.text, at, noise)
