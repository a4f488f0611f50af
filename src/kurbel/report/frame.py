"""From results and their declared quantities to the tables of a report: shared by all commands on a machine."""

from array import array
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.reading import shown
from kurbel.declared.unit_systems import convert, shown_unit, units_of
from kurbel.errors import NoSolutionError, Nowhere, UsageError
from kurbel.machine import Machine
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import Extreme, size_of
from kurbel.quantities import every_quantity
from kurbel.quantity import Lists, Quantity, called, in_sentences
from kurbel.report.alike import equal_loads, grouped
from kurbel.report.tables import Column, InputFile, KeyValue, LeftOut, Part, PlaceTable, Provenance, Report
from kurbel.solver.case import Case
from kurbel.solver.figures import Results

_AT_ONCE = 8192
"""Crank angles computed at once, so that a long table needs little memory apart from its own numbers."""
_EVERYWHERE = np.arange(0.0, 720.0, 7.5)
"""Crank angles in degrees over the longest cycle, at which the size of a curve is estimated."""
_ROUNDING = 1e-12
"""Values below this, relative to the largest of their curve, are rounding errors of a zero."""
_UNCOMPARED = (
    "--compare: the approximations of the book (R 286-291, 297) are those of a slider-crank without offset and of a "
    "piston with pressures; this machine has neither."
)


# what a command has results of


@dataclass(frozen=True, eq=False)
class Subject:
    """What a command has results of: a cylinder, a pin or bearing, or the whole machine.

    results: the object that has its key values, if any; at: a function of crank angles (n,) in degrees that returns the
    state with the columns, None without columns; lists: the quantities that it can have; source: has `angles_where`,
    which `--where` searches, None without rows; of: the cylinder that a pin belongs to; pistons: those of a cylinder
    whose rod has several; whole: it is the whole machine. Only a report asks for the rest, and once: left_out,
    warnings; tables: a function of the system of units that returns tables of places.
    """

    name: str
    results: Results | None = None
    at: Callable[[Array], Any] | None = None
    lists: Lists = field(default_factory=every_quantity)
    left_out: Iterable[LeftOut] = ()
    warnings: Iterable[str] = ()
    tables: Callable[[str], Iterable[PlaceTable]] = lambda system: ()
    source: Any = None
    of: str = ""
    pistons: "Sequence[Subject]" = ()
    whole: bool = False

    def is_printed(self, quantity: Quantity) -> bool:
        """Return whether a quantity is worth printing: a time ratio is not if both strokes take equally long."""
        if self.results is None:
            return True
        rows = self.results.rows
        row = rows.key_values.get(quantity.id) or rows.columns.get(quantity.id)
        return not (row and row.unless and row.unless(self.results))

    def answer(self, quantity: Quantity) -> Any:
        """Return a key value in SI: a number, an Extreme, or a tuple of numbers; None if there is none."""
        row = self.results.rows.key_values.get(quantity.id) if self.results else None
        return row and row.of(self.results)

    def key_values(self, command: str) -> Iterator[tuple[Quantity, Any]]:
        """Yield its key values of a command in SI, without those that are printed only on request."""
        for quantity in self.lists.key_values(command).values():
            value = self.answer(quantity) if command not in quantity.on_request and self.is_printed(quantity) else None
            if value is not None:
                yield quantity, value


def equal_parts(subjects: Sequence[Subject], command: str) -> list[list[Subject]]:
    """Return cylinders, or pins and bearings, those together whose key values of a command are equal."""
    having = [one for one in subjects if one.results]
    if len(having) < 2:
        return [having]
    kinds = {one: (one.name, one.of) if command == "bearings" else ("", "") for one in having}
    return grouped(having, lambda one: equal_loads(*kinds[one], shown_key_values(one.key_values(command), "si")))


def cycle_of(case: Case) -> float:
    """Return the working cycle of a machine in degrees."""
    return 360.0 * case.machine.revolutions


# the request and its report


@dataclass(frozen=True, eq=False)
class Frame:
    """What is requested of the report of any command on a machine.

    angles: the crank angles (n,) of the rows in degrees, or a function that returns those of a subject; columns: ids
    to show in addition to φ, None for the usual ones; system: see `unit_systems`; over: the column in which the rows
    have even steps instead of φ, shown as well; compare: with the approximations of the book next to the exact columns;
    prose: with key values, notes, warnings, and what is left out, none of which a CSV table has; table: with columns
    over the crank angle, False where other tables are requested instead.
    """

    command: str
    angles: Sequence[float] | Callable[[Subject], Sequence[float]]
    columns: Sequence[str] | None
    system: str
    over: str = ""
    compare: bool = False
    prose: bool = True
    table: bool = True


@np.errstate(all="ignore")
def report_on(
    frame: Frame, machine: Machine, title: str, subjects: Sequence[Subject], notes: Iterable[str] = ()
) -> Report:
    """Return the report on those of these subjects that have results; the last may be the whole machine.

    Raises UsageError without any, for a number that overflows or a column that no subject has, NoSolutionError if no
    row is found.
    """
    if not subjects:
        raise UsageError(f"{machine.name} has no cylinder; kurbel {frame.command} needs one")
    tables_of = {one: tuple(one.tables(frame.system)) for one in subjects}
    subjects = [one for one in subjects if one.whole or one.at or tables_of[one] or any(one.key_values(frame.command))]
    columns = [_columns(frame, one) for one in subjects]
    printed = {column.id for of_subject in columns if not isinstance(of_subject, Nowhere) for column in of_subject}
    nowhere = [str(one) for one in columns if isinstance(one, Nowhere)]
    for name in frame.columns or ():
        if name not in printed:
            raise UsageError(f"--columns: {_absent(name, frame.command, subjects)}")
    if nowhere and not printed:
        raise NoSolutionError(nowhere[0])

    with_values = frame.prose or not (printed or any(tables_of.values()))
    parts = [
        Part(
            one.name,
            () if isinstance(found, Nowhere) else found,
            tuple(shown_key_values(one.key_values(frame.command), frame.system)) if with_values else (),
            tuple(one.left_out) if frame.prose else (),
            tuple(one.warnings) if frame.prose else (),
            tables_of[one],
            str(found) if isinstance(found, Nowhere) else "",
            one.of,
        )
        for one, found in zip(subjects, columns)
    ]
    # the balance has its own note on what it cannot compare
    uncompared = frame.compare and frame.command != "balance" and not any(id.endswith("_book") for id in printed)
    added = ([_UNCOMPARED] if uncompared else []) + [f"{why}." for why in nowhere]
    return Report(
        f"{machine.name}. {title}",
        frame.command,
        machine.name,
        "bearings" if frame.command == "bearings" else "cylinders",
        whole=parts.pop() if subjects[-1:] and subjects[-1].whole else None,
        parts=tuple(parts),
        notes=(*notes, *added) if frame.prose else (),
        provenance=partial(provenance, machine) if frame.prose else None,
        cylinders=tuple(cylinder.name for cylinder in machine.cylinders),
    )


class Functions(NamedTuple):
    """What a command on a machine consists of: a title, and functions of a case, which raise as `report` does.

    title: of its report; subjects: returns what it has results of, the whole machine last; notes: returns sentences
    below the tables; end: returns the crank angle at which the table ends; own: a function that returns a report of
    another layout than `report_on`, from the case, the frame, and options of the command by their names.
    """

    title: str
    subjects: Callable[[Case], list[Subject]]
    notes: Callable[[Case], Iterable[str]] = lambda case: ()
    end: Callable[[Case], float] = cycle_of
    own: Callable[..., Report] | None = None

    @np.errstate(all="ignore")  # what overflows is refused by name
    def report(self, case: Case, frame: Frame, **options: object) -> Report:
        """Return the report on a machine; options: those of this command alone.

        Raises UsageError without such results, NoSolutionError if the machine jams, stalls, or vibrates without limit.
        """
        if self.own:
            return self.own(case, frame, **options)
        return report_on(frame, case.machine, self.title, self.subjects(case), self.notes(case))


def _columns(frame: Frame, subject: Subject) -> tuple[Column, ...] | Nowhere:
    """Return the requested columns of a subject, or the usual ones; or why it has no row."""
    if subject.at is None or not frame.table:
        return ()
    try:
        angles = frame.angles(subject) if callable(frame.angles) else frame.angles
    except Nowhere as error:
        return error
    known = subject.lists.columns(frame.command)
    added = [one for one in known.values() if one.id == frame.over or (frame.compare and one.id.endswith("_book"))]
    if frame.columns:
        chosen = [*(known[name] for name in frame.columns if name in known), *added]
    else:
        usual = (one for one in known.values() if frame.command not in one.on_request or one in added)
        chosen = [one for one in usual if subject.is_printed(one)]
    return shown_columns(subject.at, tuple(dict.fromkeys((known["phi"], *chosen))), angles, frame.system)


def _absent(name: str, command: str, subjects: Sequence[Subject]) -> str:
    """Return the message for a column that does not exist, listing those that do."""
    known, key_values = every_quantity().columns(command), every_quantity().key_values(command)
    states = [(one.lists.columns(command), one.at(np.zeros(1))) for one in subjects if one.at]
    there = [one for id, one in known.items() if any(id in own and state[id] is not None for own, state in states)]
    listed = ", ".join(one.id if one.id == one.symbol else f"{one.id} ({one.symbol})" for one in there)
    if name in known:
        return f"'{name}' is left out for this machine" + (f", which has {listed}" if listed else "")
    if found := called(name, key_values.values()):
        symbol = key_values[found[0]].symbol
        return f"'{name}' is a key value and no column: a line below the table, --key-values | grep '{symbol} '"
    words = tuple(word for one in (*there, *known.values()) for word in (one.id, one.symbol))
    near = in_sentences(name, there) or did_you_mean(name, words)
    return f"'{shown(name)}' is no column of kurbel {command}{near} (this machine has {listed or 'none'})"


def provenance(machine: Machine) -> Provenance:
    """Return what the results of a machine depend on: files with their bytes, overridden values, versions."""
    inputs, origin = [], machine.origin
    if origin:  # standard input cannot be read again
        inputs.append(InputFile(origin.name, origin.content))
    for name in machine.trace_files:
        content = None
        with suppress(OSError), open(name, "rb") as file:
            content = file.read()
        inputs.append(InputFile(name, content))
    return Provenance(tuple(inputs), origin.overrides if origin else (), {"numpy": np.__version__})


# from values in SI to columns and key values in the unit in which they are shown


def too_large(quantity: Quantity) -> UsageError:
    """Return the error for a quantity that overflows."""
    return UsageError(f"{quantity.id} is too large to compute with: check the numbers and units of the machine file")


def shown_columns(
    at: Callable[[Array], Any], quantities: Sequence[Quantity], angles: Sequence[float], system: str
) -> tuple[Column, ...]:
    """Return those of these columns that the machine has, at crank angles (n,) in degrees; at: see `Subject`.

    Raises UsageError if one is not finite.
    """
    found: dict[Quantity, list[Array]] = {}
    sizes: dict[Quantity, float] = {}
    for start in range(0, len(angles), _AT_ONCE):
        degrees = np.append(angles[start : start + _AT_ONCE], _EVERYWHERE)
        state = at(degrees)
        for quantity in quantities:
            values = degrees if quantity.id == "phi" else state[quantity.id]
            if values is not None:
                rows, everywhere = np.split(np.asarray(values, dtype=float), [-len(_EVERYWHERE)])
                found.setdefault(quantity, []).append(rows)
                sizes[quantity] = 0.0 if quantity.id == "phi" else float(np.abs(everywhere).max())
    return tuple(shown_column(one, np.concatenate(found.pop(one)), system, sizes[one]) for one in [*found])


def shown_column(
    quantity: Quantity, values: Sequence[float | None] | Array, system: str, size: float = 0.0, largest: float = 0.0
) -> Column:
    """Return the column of a quantity; values: (n,) in SI, None for no value; size: the largest value of its curve.

    largest: of all columns that are to have the same unit, in SI. Raises UsageError if a value is not finite.
    """
    numbers, kind = np.array(values, dtype=float), quantity.kind
    lacking = [] if isinstance(values, np.ndarray) else [k for k, value in enumerate(values) if value is None]
    numbers[lacking] = 0.0
    if not (np.isfinite(numbers).all() and np.isfinite(size)):
        raise too_large(quantity)
    own = max(numbers.max(initial=0.0), -numbers.min(initial=0.0))
    size = size if own <= _ROUNDING * size else 0.0
    unit = shown_unit(kind, system, max(size or own, largest))
    given: array[float] | list[float | None] = array("d", (convert(numbers, kind, unit) + 0.0).tobytes())
    if lacking:
        given = [None if k in lacking else value for k, value in enumerate(given)]
    symbols = quantity.symbol, quantity.ascii_symbol
    return Column(
        quantity.id, *symbols, quantity.marked(unit), given, quantity.text, size=float(convert(size, kind, unit))
    )


Row = tuple[tuple[str, ...], Mapping[str, float | None]]
"""A row of a table of places: its names, and its values in SI by the ids of their quantities."""


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
    """Return a table of places; declared: its quantities by id; one that no row has is left out.

    Orders and mode numbers have as many decimals as they need (1.5, but 1 and 2), distances three. alone: the digits
    to which every value is rounded by itself; values of one kind then have one unit. headed: the names of the rows are
    texts for people; otherwise spaces in them become underscores.
    """
    found = {id: [values.get(id) for _, values in rows] for id in declared if any(id in values for _, values in rows)}
    largest: dict[str, float] = {}
    for id_, each in found.items() if alone else ():
        kind = declared[id_].kind
        largest[kind] = max(largest.get(kind, 0.0), *(abs(value or 0.0) for value in each))

    columns = []
    for id_, each in found.items():
        kind, decimals = declared[id_].kind, 3 if id_ == "distance" else None
        if id_ in ("order", "mode"):
            needed = (0 if value % 1 == 0 else 1 if value % 0.5 == 0 else 3 for value in each if value)
            decimals = max(needed, default=0)
        column = shown_column(declared[id_], each, system, largest=largest.get(kind, 0.0))
        columns.append(column._replace(decimals=decimals, alone=0 if kind == "angle" else alone))
    names = tuple(names if headed else tuple(name.replace(" ", "_") for name in names) for names, _ in rows)
    return PlaceTable(id, title, heads, names, tuple(columns), headed)


def shown_key_values(found: Iterable[tuple[Quantity, Any]], system: str) -> list[KeyValue]:
    """Return key values in the units of the system; found: see `Subject.key_values`.

    The maximum and the minimum of a column have the same unit. Raises UsageError if one is not finite.
    """
    given = tuple(found)
    units = units_of([(quantity.kind, quantity.family, size_of(value)) for quantity, value in given], system)
    shown_values = []
    for (quantity, value), unit in zip(given, units):
        raw, at = value if isinstance(value, Extreme) else (value, None)
        each = raw if isinstance(raw, tuple) else (raw,)
        if not np.isfinite(each).all():
            raise too_large(quantity)
        numbers = tuple(float(convert(one, quantity.kind, unit)) + 0.0 for one in each)
        number = numbers if isinstance(raw, tuple) else raw if isinstance(raw, int) else numbers[0]  # a count
        noise = any(map(quantity.is_noise, numbers))
        symbols = quantity.symbol, quantity.ascii_symbol
        shown_values.append(
            KeyValue(quantity.id, *symbols, quantity.marked(unit), number, quantity.text, at, noise, quantity.heading),
        )
    return shown_values
