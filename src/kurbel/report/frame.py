"""From results and their declared quantities to the tables of a report: shared by all commands on a machine."""

import math
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
from kurbel.quantity import Lists, Quantity, called, in_sentences
from kurbel.report.tables import Column, InputFile, KeyValue, LeftOut, Part, PlaceTable, Provenance, Report
from kurbel.solver.balance import MachineBalance
from kurbel.solver.case import Case
from kurbel.solver.figures import Results
from kurbel.solver.flywheel import DeadCentre

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
    which `--where` searches, None without rows; of: the cylinder that a pin belongs to. left_out, warnings, tables:
    further parts of a report, empty if only key values are needed.
    """

    name: str
    results: Results | None = None
    at: Callable[[Any], Any] | None = None
    lists: Lists = field(default_factory=every_quantity)
    left_out: Sequence[LeftOut] = ()
    warnings: Sequence[str] = ()
    tables: Sequence[PlaceTable] = ()
    source: Any = None
    of: str = ""

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


def subjects_of(case: Case, command: str, compare: bool = False, pistons: bool = False) -> list[Subject]:
    """Return what a command has results of: each cylinder or bearing, and the whole machine last.

    compare: the balance also by the approximate acceleration, next to the exact one; pistons: also each piston of a
    rod that has several. Raises UsageError if the machine has no such results, NoSolutionError if it jams, stalls, or
    vibrates without limit.
    """
    if command in ("motion", "forces"):
        each = [one for forces in case.cylinders for one in forces.pistons] if pistons and command == "forces" else []
        return [
            *(
                Subject(one.drive.name, one.motion if command == "motion" else one, one.at, one.lists, source=one)
                for one in case.cylinders
            ),
            *(Subject(one.name, one, lists=one.lists) for one in each),
        ]
    if command == "flywheel":
        turning = case.flywheel
        cylinders = [Subject(one.drive.name, DeadCentre(one, turning.effort.cycle)) for one in case.cylinders]
        return [*cylinders, Subject("whole machine", turning, turning.at, source=turning)]
    if command == "stress":
        return [Subject("crankshaft", case.stress, case.stress.at)]
    if command == "bearings":
        for forces in case.cylinders:
            forces.refuse_locking()
        return [
            Subject(one.name, one, one.at, of=one.followed[0].drive.name if one.of_rod else "")
            for one in case.bearings.parts
        ]
    if command == "balance":
        balance = MachineBalance(case.effort, compare=True) if compare else case.balance
        return [Subject("whole machine", balance, balance.at)]
    if command == "delivery":
        whole = [case.delivery.pump] if case.delivery.pump else []
        pumps = [Subject(one.name, one, one.at, source=one) for one in (*case.delivery.pistons, *whole)]
        return [*(Subject(one.name, one) for one in case.delivery.stages), *pumps]
    if command == "harmonics":
        return [Subject("whole machine", case.harmonics())]
    if case.torsion.vibration is not None and case.torsion.vibration.endless.any():
        raise NoSolutionError(ENDLESS)
    return [Subject("shaft line", case.torsion)]


ENDLESS = (
    "an order of the torque meets a natural vibration that is hardly damped: give 'damping'; or segments of the shaft "
    "are too unequal to compute with: check the units of their stiffnesses"
)


# the request and its report


@dataclass(frozen=True, eq=False)
class Frame:
    """What is requested of the report of any command on a machine.

    angles: the crank angles (n,) of the rows in degrees, or a function that returns those of a subject; columns: ids
    to show in addition to φ, None for the usual ones; system: see `unit_systems`; over: the column in which the rows
    have even steps instead of φ, shown as well; compare: with the approximations of the book next to the exact columns;
    prose: with key values, notes, warnings, and what is left out, none of which a CSV table has.
    """

    command: str
    angles: Sequence[float] | Callable[[Subject], Sequence[float]]
    columns: Sequence[str] | None
    system: str
    over: str = ""
    compare: bool = False
    prose: bool = True


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

    Raises UsageError for a number that overflows or a column that no subject has, NoSolutionError if no row is found.
    """
    every = (*subjects, *((whole,) if whole else ()))
    found: list[tuple[Subject, tuple[Column, ...], str]] = []
    for one in every:
        try:
            found.append((one, _columns(frame, one), ""))
        except Nowhere as error:
            found.append((one, (), str(error)))
    printed = {column.id for _, columns, _ in found for column in columns}
    nowhere = [why for _, _, why in found if why]
    for name in frame.columns or ():
        if name not in printed:
            raise UsageError(f"--columns: {_absent(name, frame.command, every)}")
    if nowhere and not printed:
        raise NoSolutionError(nowhere[0])

    with_values = frame.prose or not (printed or any(one.tables for one in every))
    parts = []
    for one, columns, why in found:
        values = shown_key_values(one.key_values(frame.command), frame.system) if with_values else ()
        sentences = tuple(one.left_out), tuple(one.warnings)
        parts.append(Part(one.name, columns, tuple(values), *sentences, tuple(one.tables), why, one.of))
    # the balance has its own note on what it cannot compare
    uncompared = frame.compare and frame.command != "balance" and not any(id.endswith("_book") for id in printed)
    return Report(
        f"{machine.name}. {title}",
        frame.command,
        machine.name,
        "cylinders",
        whole=parts.pop() if whole else None,
        parts=tuple(parts),
        notes=(*notes, *((_UNCOMPARED,) if uncompared else ()), *(f"{why}." for why in nowhere)),
        provenance=provenance(machine) if frame.prose else None,
        cylinders=tuple(cylinder.name for cylinder in machine.cylinders),
    )


def _columns(frame: Frame, subject: Subject) -> tuple[Column, ...]:
    """Return the requested columns of a subject, or the usual ones; raises Nowhere if it has no row."""
    if subject.at is None:
        return ()
    angles = frame.angles(subject) if callable(frame.angles) else frame.angles
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
    there: dict[str, Quantity] = {}
    for subject in subjects:
        if subject.at is not None:
            state = subject.at(np.zeros(1))
            there |= {id: known[id] for id in subject.lists.columns(command) if state[id] is not None}
    symbols = [one.id if one.id == one.symbol else f"{one.id} ({one.symbol})" for one in there.values()]
    has = f"has {', '.join(symbols)}" if there else ""
    if name in known:
        return f"'{name}' is left out for this machine" + (f", which {has}" if has else "")
    if found := called(name, key_values.values()):
        symbol = key_values[found[0]].symbol
        return f"'{name}' is a key value and no column: a line below the table, --key-values | grep '{symbol} '"
    near = in_sentences(name, there.values())
    for some in (there, known):
        near = near or did_you_mean(name, tuple(word for one in some.values() for word in (one.id, one.symbol)))
    others = ", ".join(id for id in known if id not in there)
    listed = [f"this machine {has}" if has else "", f"other machines also {others}" if others else ""]
    return f"'{shown(name)}' is no column of kurbel {command}{near} ({'; '.join(filter(None, listed))})"


def provenance(machine: Machine) -> Provenance:
    """Return what the results of a machine depend on: files with their SHA-256, overridden values, versions."""
    inputs, origin = [], machine.origin
    if origin:  # standard input cannot be read again
        inputs.append(InputFile(origin.name, sha256(origin.content).hexdigest()))
    for name in machine.trace_files:
        digest = None
        with suppress(OSError), open(name, "rb") as file:
            digest = sha256(file.read()).hexdigest()
        inputs.append(InputFile(name, digest))
    return Provenance(tuple(inputs), origin.overrides if origin else (), {"numpy": np.__version__})


# from values in SI to columns and key values in the unit in which they are shown


def too_large(quantity: Quantity) -> UsageError:
    """Return the error for a quantity that overflows."""
    return UsageError(f"{quantity.id} is too large to compute with: check the numbers and units of the machine file")


def shown_columns(
    at: Callable[[Any], Any], quantities: Sequence[Quantity], angles: Sequence[float], system: str
) -> tuple[Column, ...]:
    """Return those of these columns that the machine has, at crank angles (n,) in degrees; at: see `Subject`.

    Raises UsageError if one is not finite.
    """
    found: dict[Quantity, array[float]] = {}
    sizes: dict[Quantity, float] = {}
    for start in range(0, len(angles), _AT_ONCE):
        degrees = np.append(angles[start : start + _AT_ONCE], _EVERYWHERE)
        state = at(degrees)
        for quantity in quantities:
            values = degrees if quantity.id == "phi" else state[quantity.id]
            if values is not None:
                rows, everywhere = np.split(np.asarray(values, dtype=float), [-len(_EVERYWHERE)])
                found.setdefault(quantity, array("d")).frombytes(rows.tobytes())
                sizes[quantity] = 0.0 if quantity.id == "phi" else float(np.abs(everywhere).max())
    return tuple(shown_column(quantity, values, system, sizes[quantity]) for quantity, values in found.items())


def shown_column(
    quantity: Quantity, values: Sequence[float | None], system: str, size: float = 0.0, largest: float = 0.0
) -> Column:
    """Return the column of a quantity; values: (n,) in SI, None for no value; size: the largest value of its curve.

    largest: of all columns that are to have the same unit, in SI. Raises UsageError if a value is not finite.
    """
    known = values if isinstance(values, array) else array("d", [v for v in values if v is not None])
    given = np.frombuffer(known)
    if not (np.isfinite(given).all() and math.isfinite(size)):
        raise too_large(quantity)
    own = float(max(given.max(initial=0.0), -given.min(initial=0.0)))
    size = size if own <= _ROUNDING * size else 0.0
    unit = shown_unit(quantity.kind, system, max(size or own, largest))
    given[:] = convert(given, quantity.kind, unit)  # in place: a long table is held once
    given += 0.0
    numbers = iter(known)
    texts = values if known is values else tuple(None if v is None else next(numbers) for v in values)
    symbols = quantity.symbol, quantity.ascii_symbol
    size = convert(size, quantity.kind, unit)
    return Column(quantity.id, *symbols, quantity.marked(unit), texts, quantity.text, size=size)


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
    largest: dict[str, float] = {}
    for of_row in (values for _, values in rows if alone):
        for name, value in of_row.items():
            kind = declared[name].kind
            largest[kind] = max(largest.get(kind, 0.0), abs(value or 0.0))

    columns = []
    for quantity in declared.values():
        if any(quantity.id in values for _, values in rows):
            each = [values.get(quantity.id) for _, values in rows]
            column = shown_column(quantity, each, system, largest=largest.get(quantity.kind, 0.0))
            decimals = 3 if quantity.id == "distance" else None
            if quantity.id in ("order", "mode"):
                needed = (0 if value % 1 == 0 else 1 if value % 0.5 == 0 else 3 for value in each if value)
                decimals = max(needed, default=0)
            columns.append(column._replace(decimals=decimals, alone=0 if quantity.kind == "angle" else alone))
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
        if not all(map(math.isfinite, each)):
            raise too_large(quantity)
        numbers = tuple(float(convert(one, quantity.kind, unit)) + 0.0 for one in each)
        number = numbers if isinstance(raw, tuple) else raw if isinstance(raw, int) else numbers[0]  # a count
        noise = any(map(quantity.is_noise, numbers))
        symbols = quantity.symbol, quantity.ascii_symbol
        shown_values.append(
            KeyValue(quantity.id, *symbols, quantity.marked(unit), number, quantity.text, at, noise, quantity.heading),
        )
    return shown_values
