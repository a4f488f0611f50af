"""From results and their declared quantities to the report of a command."""

import re
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from itertools import chain
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.forms.figures import MACHINE
from kurbel.declared.reading import text_in_one_line
from kurbel.errors import NoSolutionError, Nowhere, UsageError
from kurbel.machine import Machine
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import Extreme
from kurbel.quantities import every_quantity
from kurbel.quantity import Lists, Quantity, called, in_sentences
from kurbel.solver.case import Case
from kurbel.solver.figures import AtAngles, Results
from kurbel.tables.named_values import ChosenValue, choices_in
from kurbel.tables.shown import EVERYWHERE, ROUNDING, Places, shown_columns, shown_key_values
from kurbel.tables.tables import (
    BEFORE,
    Column,
    InputFile,
    KeyValue,
    LeftOut,
    Part,
    PlaceTable,
    Provenance,
    Report,
    equal_loads,
    grouped,
)

_UNCOMPARED = (
    "--compare: the approximations of the book (R 286-291, 297) are those of a slider-crank without offset and of a "
    "piston with pressures; this machine has neither."
)


# what a command has results of


class Subject(NamedTuple):
    """What a command has results of: a cylinder, a pin or bearing, or the whole machine.

    results: the object that has its key values, if any; at: a function of crank angles (n,) in degrees that returns the
    state with the columns, None without columns; of: the cylinder that a pin belongs to; pistons: those of a cylinder
    whose rod has several; whole: it is the whole machine; idle: why its table would have no results, so that people
    get a sentence instead. The rest is computed only for a report, and once: left_out, warnings, tables. part: its name
    in columns where `name` is a number that may mean another part of another machine; where: what it is next to, which
    distinguishes parts of one number; columns_alone: its key values are left out, as they count by another angle.
    """

    name: str
    results: Results | None = None
    at: Callable[[Array], AtAngles] | None = None
    left_out: Iterable[LeftOut] = ()
    warnings: Iterable[str] = ()
    tables: Iterable[Places] = ()
    of: str = ""
    pistons: "Sequence[Subject]" = ()
    whole: bool = False
    idle: str = ""
    part: str = ""
    where: str = ""
    columns_alone: bool = False

    @property
    def identity(self) -> str:
        """What it is in any machine: a part with the same identity in another design is the same part."""
        return f"{self.part or self.name} {self.where}".rstrip()

    @property
    def lists(self) -> Lists:
        """The quantities that it can have."""
        if self.results:
            return self.results.lists
        # columns alone are those of a shaft segment
        if self.at:
            return every_quantity()
        return Lists((), ())

    def is_printed(self, quantity: Quantity) -> bool:
        """Return whether a quantity is worth printing: a time ratio is not if both strokes take equally long."""
        if self.results is None:
            return True
        rows = self.results.rows
        row = rows.key_values.get(quantity.id) or rows.columns.get(quantity.id)
        return not (row and row.unless and row.unless(self.results))

    def answer(self, quantity: Quantity) -> object:
        """Return a key value in SI: a number, an Extreme, or a tuple of numbers; None if there is none."""
        row = self.results.rows.key_values.get(quantity.id) if self.results else None
        if row is None:
            return None
        return row.of(self.results)

    def named(self, choices: Iterable[ChosenValue]) -> Iterator[tuple[Quantity, object]]:
        """Yield the chosen ones of its key values in SI, in their order, with no heading."""
        rows = self.results.rows.key_values if self.results else {}
        for choice in choices:
            row = rows.get(choice.id)
            value = row.of(self.results) if row and choice.is_of(self) else None
            if row and value is not None:
                yield row.quantity._replace(heading=""), value

    def key_values(self, command: str) -> Iterator[tuple[Quantity, object]]:
        """Yield its key values of a command in SI, without those that are printed only on request."""
        if not self.results or self.columns_alone:
            return
        for row in self.results.rows.key_values.values():
            quantity = row.quantity
            is_printed = command in quantity.commands and command not in quantity.on_request
            if not is_printed or (row.unless and row.unless(self.results)):
                continue
            value = row.of(self.results)
            if value is not None:
                yield quantity, value

    def is_minor(self, id: str, compare: bool) -> bool:
        """Return whether a key value is for programs only, as people read it elsewhere.

        compare: with the approximations of the books.
        """
        row = self.results.rows.key_values.get(id) if self.results else None
        if row is None:
            return False
        if row.quantity.of_book:
            return not compare
        return row.repeats is not None and bool(row.repeats(self.results))


def equal_parts(subjects: Sequence[Subject], command: str) -> list[list[Subject]]:
    """Return cylinders, or pins and bearings, those together whose key values of a command are equal."""
    having = [subject for subject in subjects if subject.results]
    if len(having) < 2:
        return [having]

    def load(subject: Subject) -> Hashable:
        key_values = shown_key_values(subject.key_values(command), "si")
        if command == "bearings":
            return equal_loads(subject.name, subject.of, key_values)
        return equal_loads("", "", key_values)

    return grouped(having, load)


# the request and its report


class Frame(NamedTuple):
    """What is requested of the report of any command on a machine.

    angles: the crank angles (n,) of the rows in degrees, or a function that returns those of a subject; columns: ids
    to show in addition to φ, None for the usual ones; system: see `unit_systems`; over: the column in which the rows
    have even steps instead of φ, shown as well; compare: with the approximations of the book next to the exact columns;
    prose: with key values, notes, warnings, and what is left out, none of which a CSV table has; table: with columns
    over the crank angle, False where other tables are requested instead; names: of key values, separated by commas or
    blanks, which are requested instead of all else.
    """

    command: str
    angles: Sequence[float] | Callable[[Subject], Sequence[float]]
    columns: Sequence[str] | None
    system: str
    over: str = ""
    compare: bool = False
    prose: bool = True
    table: bool = True
    names: str = ""


_PARTS = {"bearings": "bearings", "stress": "throws"}
"""What the parts of a report are called where they are no cylinders."""


def _group_of(command: str) -> str:
    """Return what the parts of the report of a command are called, the JSON key of their list."""
    return _PARTS.get(command, "cylinders")


class _Rows(NamedTuple):
    """What a subject has over the crank angle and at its places; nowhere: why it has no row, if it has none."""

    subject: Subject
    tables: tuple[PlaceTable, ...]
    columns: tuple[Column, ...]
    nowhere: str


@np.errstate(all="ignore")
def report_on(
    frame: Frame,
    machine: Machine,
    title: str,
    subjects: Sequence[Subject],
    notes: Iterable[str] = (),
) -> Report:
    """Return the report on those of these subjects that have results; the last may be the whole machine.

    Raises UsageError without any, for a number that overflows or a column that no subject has, NoSolutionError if no
    row is found.
    """
    if not subjects:
        raise UsageError(f"{machine.name} has no cylinder; kurbel {frame.command} needs one")
    if frame.names:
        return _report_on_names(frame, machine, title, subjects)

    with_rows = _with_rows(frame, subjects)
    columns = chain.from_iterable(rows.columns for rows in with_rows)
    ids = {column.id for column in columns}
    _check_columns(frame, with_rows, ids)

    # a CSV table has key values only where it has nothing else
    has_tables = bool(ids) or any(rows.tables for rows in with_rows)
    with_values = frame.prose or not has_tables
    parts = [_part(rows, frame, with_values) for rows in with_rows]
    of_machine = parts.pop() if with_rows and with_rows[-1].subject.whole else None
    return Report(
        f"{machine.name}. {title}",
        frame.command,
        machine.name,
        _group_of(frame.command),
        whole=of_machine,
        parts=tuple(parts),
        notes=(*notes, *_added_notes(frame, with_rows, ids)) if frame.prose else (),
        provenance=partial(provenance, machine) if frame.prose else None,
        cylinders=tuple(cylinder.name for cylinder in machine.cylinders),
    )


def _with_rows(frame: Frame, subjects: Iterable[Subject]) -> list[_Rows]:
    """Return the subjects that have something to print."""
    with_rows = []
    for subject in subjects:
        tables = tuple(table.shown(frame.system) for table in subject.tables)
        has_rows = subject.whole or bool(subject.at) or bool(tables)
        if has_rows or any(subject.key_values(frame.command)):
            columns, nowhere = _columns(frame, subject)
            with_rows.append(_Rows(subject, tables, columns, nowhere))
    return with_rows


def _check_columns(frame: Frame, with_rows: Sequence[_Rows], ids: set[str]) -> None:
    """Refuse a requested column that no subject has, and a condition that holds nowhere; ids: of all columns."""
    # without any row no column shows whether the machine has it
    if not ids:
        for rows in with_rows:
            if rows.nowhere:
                raise NoSolutionError(rows.nowhere)
    for name in frame.columns or ():
        if name not in ids:
            absent = _absent(name, frame.command, [rows.subject for rows in with_rows])
            raise UsageError(f"--columns: {absent}")


def _part(rows: _Rows, frame: Frame, with_values: bool) -> Part:
    """Return the part of the report that is about one subject."""
    subject = rows.subject
    part = Part(
        subject.name,
        rows.columns,
        place_tables=rows.tables,
        nowhere=rows.nowhere,
        of=subject.of,
    )
    if with_values:
        part = part._replace(key_values=tuple(_key_values(subject, frame)))
    if frame.prose:
        left_out = tuple(subject.left_out)
        part = part._replace(left_out=left_out, warnings=tuple(subject.warnings))
    return part


def _added_notes(frame: Frame, with_rows: Sequence[_Rows], ids: set[str]) -> Iterator[str]:
    """Yield what is said below the tables of any command: what was not compared, found, or computed."""
    has_approximations = any(id.endswith("_book") for id in ids)
    # the balance has its own note on what it cannot compare
    if frame.compare and frame.command != "balance" and not has_approximations:
        yield _UNCOMPARED
    for rows in with_rows:
        if rows.nowhere:
            yield f"{rows.nowhere}."
    for rows in with_rows:
        if rows.subject.idle and not frame.columns:
            yield f"{rows.subject.name}: {rows.subject.idle}"


def _report_on_names(
    frame: Frame, machine: Machine, title: str, subjects: Sequence[Subject]
) -> Report:
    """Return the report on the key values that are named, and nothing else but warnings.

    Raises UsageError for a name that is no key value of the command, and for a key value that the machine does not
    have.
    """
    # pistons of a rod are meant by their names alone
    pistons = list(chain.from_iterable(subject.pistons for subject in subjects))
    choices = choices_in(frame.names, frame.command, [*subjects, *pistons])
    scopes = {choice.scope for choice in choices}
    named_pistons = [piston for piston in pistons if piston.name in scopes]

    parts, of_machine = list[Part](), None
    printed = set[ChosenValue]()
    for subject in (*subjects, *named_pistons):
        chosen = list(subject.named(choices))
        if not chosen:
            continue
        ids = {quantity.id for quantity, _ in chosen}
        printed.update(choice for choice in choices if choice.id in ids and choice.is_of(subject))
        key_values = tuple(_with_sides(subject, shown_key_values(chosen, frame.system), chosen))
        part = Part(subject.name, (), key_values, (), tuple(subject.warnings), of=subject.of)
        if subject.whole:
            of_machine = part
        else:
            parts.append(part)

    for choice in choices:
        if choice not in printed:
            raise UsageError(f"--key-values: {_lacking(choice, frame.command)}")
    return Report(
        f"{machine.name}. {title}",
        frame.command,
        machine.name,
        _group_of(frame.command),
        tuple(parts),
        of_machine,
        provenance=partial(provenance, machine),
        cylinders=tuple(cylinder.name for cylinder in machine.cylinders),
    )


def _lacking(choice: ChosenValue, command: str) -> str:
    """Return the message for a key value that a machine, or a part of it, does not have."""
    quantity = every_quantity().key_values(command)[choice.id]
    owner = {"": "this machine", MACHINE: "the whole machine"}.get(choice.scope, choice.scope)
    return f"{owner} has no {choice.id}: {quantity.text[:1].lower()}{quantity.text[1:]}; kurbel check shows why"


def _key_values(subject: Subject, frame: Frame) -> Iterator[KeyValue]:
    """Yield the key values of a subject, those marked that are for programs only."""
    values = list(subject.key_values(frame.command))
    for key_value in _with_sides(subject, shown_key_values(values, frame.system), values):
        yield key_value._replace(minor=subject.is_minor(key_value.id, frame.compare))


_EXTREME = re.compile(r"(.+)_(?:max|min|peak)")
_OF_SEVERAL = {"p_max": ("p_head", "p_crank")}
"""Key value -> the columns of which it is the extreme, where its id does not name it."""
_ANOTHER = 1e-6
"""Relative difference from which a value of a column is not the extreme, but what follows a jump."""


def _with_sides(
    subject: Subject, shown_values: Sequence[KeyValue], values: Sequence[tuple[Quantity, object]]
) -> Iterator[KeyValue]:
    """Yield key values as shown, those marked that are the limit of a column before a jump; values: the same in SI."""
    before = before_jumps(subject, values)
    for key_value in shown_values:
        yield key_value._replace(side=BEFORE if key_value.id in before else "")


def before_jumps(subject: Subject, values: Iterable[tuple[Quantity, object]]) -> set[str]:
    """Return the ids of those key values that are the limit of a column before a jump: just after it is another value.

    values: key values of the subject in SI.
    """
    extremes = {quantity.id: value for quantity, value in values if isinstance(value, Extreme)}
    if not (subject.at and extremes):
        return set()
    angles = np.array([extreme.degrees for extreme in extremes.values()], dtype=float)
    state = subject.at(angles)
    before = set[str]()
    for row, (id, extreme) in enumerate(extremes.items()):
        columns = list(_columns_of(id, state))
        is_there = any(_is_extreme(column[row], extreme) for column in columns)
        if columns and not is_there:
            before.add(id)
    return before


def _is_extreme(value: float, extreme: Extreme) -> bool:
    """Return whether a value of a column is this extreme; the sign of a largest magnitude is not known."""
    size = abs(extreme.value)
    return bool(abs(abs(value) - size) <= _ANOTHER * max(abs(value), size))


def _columns_of(id: str, state: AtAngles) -> Iterator[Array]:
    """Yield the columns (n,) whose extreme a key value is."""
    named = _EXTREME.fullmatch(id)
    for column in _OF_SEVERAL.get(id, (named[1],) if named else ()):
        values = state[column]
        if values is not None:
            yield np.broadcast_to(values, np.shape(state["phi"]))


class CommandReport(NamedTuple):
    """What a command on a machine consists of: a title, and functions of a case, which raise as `report` does.

    title: of its report; subjects: returns what it has results of, the whole machine last; notes: returns sentences
    below the tables; last_angle: returns the crank angle at which the table ends; subjects_and_notes: returns both, of a
    report that depends on the frame, or on options of the command, which it takes by their names.
    """

    title: str
    subjects: Callable[[Case], list[Subject]]
    notes: Callable[[Case], Iterable[str]] = lambda case: ()
    last_angle: Callable[[Case], float] = lambda case: 360.0 * case.machine.revolutions
    subjects_and_notes: Callable[..., tuple[Sequence[Subject], Iterable[str]]] | None = None

    @np.errstate(all="ignore")  # what overflows is refused by name
    def report(self, case: Case, frame: Frame, **options: object) -> Report:
        """Return the report on a machine; options: those of this command alone.

        Raises UsageError without such results, NoSolutionError if the machine jams, stalls, or vibrates without limit.
        """
        if self.subjects_and_notes:
            subjects, notes = self.subjects_and_notes(case, frame, **options)
        else:
            subjects = self.subjects(case)
            notes = self.notes(case)
        return report_on(frame, case.machine, self.title, subjects, notes)


def _columns(frame: Frame, subject: Subject) -> tuple[tuple[Column, ...], str]:
    """Return the requested columns of a subject, or the usual ones; and why it has no row, if it has none."""
    if subject.at is None or not frame.table:
        return (), ""
    try:
        angles = frame.angles(subject) if callable(frame.angles) else frame.angles
    except Nowhere as error:
        return (), str(error)

    declared = subject.lists.columns(frame.command)
    added = [quantity for quantity in declared.values() if _is_added(quantity, frame)]
    if frame.columns:
        chosen = [declared[name] for name in frame.columns if name in declared] + added
    else:
        chosen = _usual_columns(frame, subject, added)
    quantities = tuple(dict.fromkeys((declared["phi"], *chosen)))
    columns = shown_columns(subject.at, quantities, angles, frame.system)
    if frame.columns:
        return columns, ""

    # what is requested is shown to people, too
    minor = set(declared)
    if not subject.idle:
        minor = _minor_columns(subject, [column.id for column in columns])
    minor -= {quantity.id for quantity in added}
    return tuple(column._replace(minor=column.id in minor) for column in columns), ""


def _is_added(quantity: Quantity, frame: Frame) -> bool:
    """Return whether a column is shown in any case: that of the even steps, and approximations to compare with."""
    return quantity.id == frame.over or (
        frame.compare and quantity.id.endswith(("_book", "_error"))
    )


def _usual_columns(frame: Frame, subject: Subject, added: Sequence[Quantity]) -> list[Quantity]:
    """Return the columns of a command where none are named."""
    # what adds nothing to forces may be what motion is about
    results = subject.results
    is_elsewhere = results is not None and results.command != frame.command
    usual = []
    for quantity in subject.lists.columns(frame.command).values():
        if frame.command in quantity.on_request and quantity not in added:
            continue
        if is_elsewhere or subject.is_printed(quantity):
            usual.append(quantity)
    return usual


def _minor_columns(subject: Subject, ids: Iterable[str]) -> set[str]:
    """Return those of these columns that tell people nothing: 0 at every angle, or a force that another row has, too.

    Of equal forces the first one stays, but the piston force in any case.
    """
    assert subject.at is not None
    state = subject.at(EVERYWHERE)
    minor = set[str]()
    forces = dict[str, Array]()
    for id in ids:
        row = state.rows[id]
        if row.repeats is not None and row.repeats(subject.results):
            minor.add(id)
        values = None if id == "phi" else row.of(state)
        if values is None:
            continue
        if not np.any(values):
            minor.add(id)
        elif row.quantity.kind == "force":
            forces[id] = np.broadcast_to(values, EVERYWHERE.shape)
    if "P" in forces:
        forces = {"P": forces["P"], **forces}
    different = list[Array]()
    for id, values in forces.items():
        if any(_are_equal(values, others) for others in different):
            minor.add(id)
        else:
            different.append(values)
    return minor


def _are_equal(values: Array, others: Array) -> bool:
    """Return whether two columns (n,) are equal but for rounding."""
    return bool(np.abs(values - others).max() <= ROUNDING * np.abs(values).max())


def _absent(name: str, command: str, subjects: Sequence[Subject]) -> str:
    """Return the message for a column that does not exist, listing those that do."""
    declared = every_quantity().columns(command)
    present = _present_columns(declared.values(), command, subjects)
    listed = ", ".join(
        column.id if column.id == column.symbol else f"{column.id} ({column.symbol})"
        for column in present
    )
    if name in declared:
        others = f", which has {listed}" if listed else ""
        needs = declared[name].needs
        lacks = f"; it needs {needs}" if needs else ""
        return f"'{name}' is left out for this machine{others}{lacks}"
    key_values = called(name, every_quantity().key_values(command).values())
    if key_values:
        return f"'{name}' is a key value and no column; --key-values {key_values[0]} prints it"
    words = list[str]()
    for column in (*present, *declared.values()):
        words += (column.id, column.symbol)
    near = in_sentences(name, present) or did_you_mean(name, tuple(words))
    return (
        f"'{text_in_one_line(name)}' is no column of kurbel {command}{near} "
        f"(this machine has {listed or 'none'})"
    )


def _present_columns(
    declared: Iterable[Quantity], command: str, subjects: Iterable[Subject]
) -> list[Quantity]:
    """Return the columns that at least one of these subjects has."""
    present = set[str]()
    for subject in subjects:
        if subject.at:
            state = subject.at(np.zeros(1))
            columns = subject.lists.columns(command)
            present.update(id for id in columns if state[id] is not None)
    return [quantity for quantity in declared if quantity.id in present]


def provenance(machine: Machine) -> Provenance:
    """Return what the results of a machine depend on: files with their bytes, overridden values, versions."""
    inputs = []
    origin = machine.origin
    if origin:  # standard input cannot be read again
        inputs.append(InputFile(origin.name, origin.content))
    for name in machine.trace_files:
        content = None
        with suppress(OSError), open(name, "rb") as file:
            content = file.read()
        inputs.append(InputFile(name, content))
    return Provenance(tuple(inputs), origin.overrides if origin else (), {"numpy": np.__version__})
