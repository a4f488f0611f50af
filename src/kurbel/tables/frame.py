"""From results and their declared quantities to the tables of a report, and the crank angles of its rows."""

import math
import re
from array import array
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.declared.forms.figures import MACHINE
from kurbel.declared.numerals import NUMBER, RATIO, keyboard_text, parse_ratio
from kurbel.declared.reading import LONGEST_VALUE, text_in_one_line
from kurbel.declared.unit_systems import convert, show, shown_unit, units_of
from kurbel.declared.units import kind_example, unit_factor
from kurbel.errors import NoSolutionError, Nowhere, UnitError, UsageError
from kurbel.machine import Machine
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import Extreme, number_of, size_of
from kurbel.quantities import every_quantity
from kurbel.quantity import Lists, Quantity, ambiguity, called, in_sentences
from kurbel.solver.case import Case
from kurbel.solver.cycle import Where
from kurbel.solver.figures import AtAngles, Results
from kurbel.solver.forces import CylinderForces
from kurbel.tables.named_values import Choice, choices_in
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
    stepped,
)

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


class Subject(NamedTuple):
    """What a command has results of: a cylinder, a pin or bearing, or the whole machine.

    results: the object that has its key values, if any; at: a function of crank angles (n,) in degrees that returns the
    state with the columns, None without columns; of: the cylinder that a pin belongs to; pistons: those of a cylinder
    whose rod has several; whole: it is the whole machine; idle: why its table would be one of no
    results, so that people get a sentence instead. The rest is computed only for a report, and once:
    left_out, warnings, tables. part: its name in columns where `name` is a number that may mean another
    part of another machine; where: what it is next to, which tells parts of one number from one another.
    """

    name: str
    results: Results | None = None
    at: Callable[[Array], AtAngles] | None = None
    left_out: Iterable[LeftOut] = ()
    warnings: Iterable[str] = ()
    tables: "Iterable[Places]" = ()
    of: str = ""
    pistons: "Sequence[Subject]" = ()
    whole: bool = False
    idle: str = ""
    part: str = ""
    where: str = ""

    @property
    def identity(self) -> str:
        """What it is in any machine: a part with the same identity in another design is the same part."""
        return f"{self.part or self.name} {self.where}".rstrip()

    @property
    def lists(self) -> Lists:
        """The quantities that it can have."""
        return self.results.lists if self.results else every_quantity()

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
        return row and row.of(self.results)

    def named(self, choices: Iterable[Choice]) -> Iterator[tuple[Quantity, object]]:
        """Yield the chosen ones of its key values in SI, in their order, with no heading."""
        rows = self.results.rows.key_values if self.results else {}
        for choice in choices:
            row = rows.get(choice.id)
            value = row.of(self.results) if row and choice.is_of(self) else None
            if row and value is not None:
                yield row.quantity._replace(heading=""), value

    def key_values(self, command: str) -> Iterator[tuple[Quantity, object]]:
        """Yield its key values of a command in SI, without those that are printed only on request."""
        for quantity, of, unless, _ in (
            self.results.rows.key_values.values() if self.results else ()
        ):
            printed = command in quantity.commands and command not in quantity.on_request
            if (
                printed
                and not (unless and unless(self.results))
                and (value := of(self.results)) is not None
            ):
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

    def load(one: Subject) -> Hashable:
        name, of = (one.name, one.of) if command == "bearings" else ("", "")
        return equal_loads(name, of, shown_key_values(one.key_values(command), "si"))

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
    having = list[tuple[Subject, tuple[PlaceTable, ...], tuple[Column, ...], str]]()
    for subject in subjects:
        tables = tuple(table.shown(frame.system) for table in subject.tables)
        if subject.whole or subject.at or tables or any(subject.key_values(frame.command)):
            having.append((subject, tables, *_columns(frame, subject)))
    printed = {column.id for _, _, columns, _ in having for column in columns}
    nowhere = [why for *_, why in having if why]
    for name in frame.columns or ():
        if name not in printed:
            raise UsageError(
                f"--columns: {_absent(name, frame.command, [one for one, *_ in having])}"
            )
    if nowhere and not printed:
        raise NoSolutionError(nowhere[0])

    with_values = frame.prose or not (printed or any(tables for _, tables, *_ in having))
    parts = [
        Part(
            one.name,
            columns,
            tuple(_key_values(one, frame)) if with_values else (),
            tuple(one.left_out) if frame.prose else (),
            tuple(one.warnings) if frame.prose else (),
            tables,
            why,
            one.of,
        )
        for one, tables, columns, why in having
    ]
    # the balance has its own note on what it cannot compare
    uncompared = (
        frame.compare
        and frame.command != "balance"
        and not any(id.endswith("_book") for id in printed)
    )
    idle = [] if frame.columns else [f"{one.name}: {one.idle}" for one, *_ in having if one.idle]
    added = ([_UNCOMPARED] if uncompared else []) + [f"{why}." for why in nowhere] + idle
    return Report(
        f"{machine.name}. {title}",
        frame.command,
        machine.name,
        _PARTS.get(frame.command, "cylinders"),
        whole=parts.pop() if having and having[-1][0].whole else None,
        parts=tuple(parts),
        notes=(*notes, *added) if frame.prose else (),
        provenance=partial(provenance, machine) if frame.prose else None,
        cylinders=tuple(cylinder.name for cylinder in machine.cylinders),
    )


def _report_on_names(
    frame: Frame, machine: Machine, title: str, subjects: Sequence[Subject]
) -> Report:
    """Return the report on the key values that are named, and nothing else but warnings.

    Raises UsageError for a name that is no key value of the command, and for a key value that the machine does not
    have.
    """
    # pistons of a rod are meant by their names alone
    owners = [*subjects, *(piston for subject in subjects for piston in subject.pistons)]
    choices = choices_in(frame.names, frame.command, owners)
    scopes = {choice.scope for choice in choices}
    parts, whole, given = list[Part](), None, set[Choice]()
    for subject in owners:
        if subject not in subjects and subject.name not in scopes:
            continue
        chosen = list(subject.named(choices))
        if not chosen:
            continue
        ids = {quantity.id for quantity, _ in chosen}
        given |= {choice for choice in choices if choice.id in ids and choice.is_of(subject)}
        key_values = tuple(_with_sides(subject, shown_key_values(chosen, frame.system), chosen))
        part = Part(subject.name, (), key_values, (), tuple(subject.warnings), of=subject.of)
        if subject.whole:
            whole = part
        else:
            parts.append(part)

    for choice in choices:
        if choice not in given:
            raise UsageError(f"--key-values: {_lacking(choice, frame.command)}")
    return Report(
        f"{machine.name}. {title}",
        frame.command,
        machine.name,
        "bearings" if frame.command == "bearings" else "cylinders",
        tuple(parts),
        whole,
        provenance=partial(provenance, machine),
        cylinders=tuple(cylinder.name for cylinder in machine.cylinders),
    )


def _lacking(choice: Choice, command: str) -> str:
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
    angles = np.array([extreme.degrees for extreme in extremes.values()], dtype=float)
    before = set[str]()
    if subject.at and len(angles):
        state = subject.at(angles)
        for number, (id, extreme) in enumerate(extremes.items()):
            after = [values[number] for values in _columns_of(id, state)]
            size = abs(extreme.value)
            # of a largest magnitude the sign is not known
            same = [abs(abs(value) - size) <= _ANOTHER * max(abs(value), size) for value in after]
            if after and not any(same):
                before.add(id)
    return before


def _columns_of(id: str, state: AtAngles) -> Iterator[Array]:
    """Yield the columns (n,) whose extreme a key value is."""
    named = _EXTREME.fullmatch(id)
    for column in _OF_SEVERAL.get(id, (named[1],) if named else ()):
        values = state[column]
        if values is not None:
            yield np.broadcast_to(values, np.shape(state["phi"]))


class Functions(NamedTuple):
    """What a command on a machine consists of: a title, and functions of a case, which raise as `report` does.

    title: of its report; subjects: returns what it has results of, the whole machine last; notes: returns sentences
    below the tables; end: returns the crank angle at which the table ends; own: returns subjects and notes of a report
    that depends on the frame, or on options of the command, which it takes by their names.
    """

    title: str
    subjects: Callable[[Case], list[Subject]]
    notes: Callable[[Case], Iterable[str]] = lambda case: ()
    end: Callable[[Case], float] = lambda case: 360.0 * case.machine.revolutions
    own: Callable[..., tuple[Sequence[Subject], Iterable[str]]] | None = None

    @np.errstate(all="ignore")  # what overflows is refused by name
    def report(self, case: Case, frame: Frame, **options: object) -> Report:
        """Return the report on a machine; options: those of this command alone.

        Raises UsageError without such results, NoSolutionError if the machine jams, stalls, or vibrates without limit.
        """
        found = (
            self.own(case, frame, **options)
            if self.own
            else (self.subjects(case), self.notes(case))
        )
        return report_on(frame, case.machine, self.title, *found)


def _columns(frame: Frame, subject: Subject) -> tuple[tuple[Column, ...], str]:
    """Return the requested columns of a subject, or the usual ones; and why it has no row, if it has none."""
    if subject.at is None or not frame.table:
        return (), ""
    try:
        angles = frame.angles(subject) if callable(frame.angles) else frame.angles
    except Nowhere as error:
        return (), str(error)
    known = subject.lists.columns(frame.command)
    added = [
        one
        for one in known.values()
        if one.id == frame.over or (frame.compare and one.id.endswith("_book"))
    ]
    if frame.columns:
        chosen = [*(known[name] for name in frame.columns if name in known), *added]
    else:
        usual = (
            one for one in known.values() if frame.command not in one.on_request or one in added
        )
        # what adds nothing to forces may be what motion is about
        elsewhere = subject.results and subject.results.command != frame.command
        chosen = [one for one in usual if elsewhere or subject.is_printed(one)]
    columns = shown_columns(
        subject.at, tuple(dict.fromkeys((known["phi"], *chosen))), angles, frame.system
    )
    if frame.columns:
        return columns, ""
    minor = (
        set(known) if subject.idle else _minor_columns(subject, [column.id for column in columns])
    )
    wanted = {quantity.id for quantity in added}
    return tuple(
        one._replace(minor=one.id in minor and one.id not in wanted) for one in columns
    ), ""


def _minor_columns(subject: Subject, ids: Iterable[str]) -> set[str]:
    """Return those of these columns that tell people nothing: 0 at every angle, or a force that another row has, too.

    Of equal forces the first one stays, but the piston force in any case.
    """
    assert subject.at is not None
    state, minor = subject.at(_EVERYWHERE), set[str]()
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
            forces[id] = np.broadcast_to(values, _EVERYWHERE.shape)
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
    return bool(np.abs(values - others).max() <= _ROUNDING * np.abs(values).max())


def _absent(name: str, command: str, subjects: Sequence[Subject]) -> str:
    """Return the message for a column that does not exist, listing those that do."""
    known, key_values = every_quantity().columns(command), every_quantity().key_values(command)
    states = [
        (subject.lists.columns(command), subject.at(np.zeros(1)))
        for subject in subjects
        if subject.at
    ]
    there = [
        one
        for id, one in known.items()
        if any(id in own and state[id] is not None for own, state in states)
    ]
    listed = ", ".join(
        one.id if one.id == one.symbol else f"{one.id} ({one.symbol})" for one in there
    )
    if name in known:
        return f"'{name}' is left out for this machine" + (
            f", which has {listed}" if listed else ""
        )
    if found := called(name, key_values.values()):
        return f"'{name}' is a key value and no column; --key-values {found[0]} prints it"
    words = tuple(word for one in (*there, *known.values()) for word in (one.id, one.symbol))
    near = in_sentences(name, there) or did_you_mean(name, words)
    return f"'{text_in_one_line(name)}' is no column of kurbel {command}{near} (this machine has {listed or 'none'})"


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
    return tuple(
        shown_column(one, np.concatenate(found.pop(one)), system, sizes[one]) for one in [*found]
    )


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
    numbers, kind = np.array(values, dtype=float), quantity.kind
    lacking = (
        []
        if isinstance(values, np.ndarray)
        else [k for k, value in enumerate(values) if value is None]
    )
    numbers[lacking] = 0.0
    if not (np.isfinite(numbers).all() and np.isfinite(size)):
        raise too_large(quantity)
    own = max(numbers.max(initial=0.0), -numbers.min(initial=0.0))
    size = size if own <= _ROUNDING * size else 0.0
    unit = shown_unit(kind, system, max(size or own, largest))
    given: array[float] | list[float | None] = array(
        "d", (convert(numbers, kind, unit) + 0.0).tobytes()
    )
    if lacking:
        given = [None if k in lacking else value for k, value in enumerate(given)]
    symbols = quantity.symbol, quantity.ascii_symbol
    return Column(
        quantity.id,
        *symbols,
        quantity.marked(unit),
        given,
        quantity.text,
        size=float(convert(size, kind, unit)),
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
        found = {
            quantity: [values.get(id) for _, values in self.rows]
            for id, quantity in self.declared.items()
            if any(id in values for _, values in self.rows)
        }
        largest: dict[str, float] = {}
        for quantity, each in found.items() if self.alone else ():
            largest[quantity.kind] = max(
                largest.get(quantity.kind, 0.0), *(abs(value or 0.0) for value in each)
            )

        columns = []
        for quantity, each in found.items():
            decimals = 3 if quantity.id == "distance" else None
            if quantity.id in ("order", "mode"):
                needed = (
                    0 if value % 1 == 0 else 1 if value % 0.5 == 0 else 3 for value in each if value
                )
                decimals = max(needed, default=0)
            column = shown_column(quantity, each, system, largest=largest.get(quantity.kind, 0.0))
            columns.append(
                column._replace(
                    decimals=decimals, alone=0 if quantity.kind == "angle" else self.alone
                )
            )
        names = [names for names, _ in self.rows]
        words: dict[str, str] = {}
        if not self.headed:
            words = {_as_id(name): name for row in names for name in row}
            names = [tuple(map(_as_id, row)) for row in names]
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


_BETWEEN = re.compile(r"[\s,:;=–]+")
"""What parts the words of the name of a row."""


def _as_id(name: str) -> str:
    """Return the name of a row as programs have it.

    >>> _as_id("shaft n = 1, against the crank: A")
    'shaft_n_1_against_the_crank_A'
    """
    return _BETWEEN.sub("_", name)


def shown_key_values(found: Iterable[tuple[Quantity, object]], system: str) -> list[KeyValue]:
    """Return key values in the units of the system; found: see `Subject.key_values`.

    The maximum and the minimum of a column have the same unit. Raises UsageError if one is not finite.
    """
    given = tuple(found)
    units = units_of(
        [(quantity.kind, quantity.family, size_of(value)) for quantity, value in given], system
    )
    shown_values = []
    for (quantity, value), unit in zip(given, units):
        raw, at = number_of(value), value.degrees if isinstance(value, Extreme) else None
        each = raw if isinstance(raw, tuple) else (raw,)
        if not np.isfinite(each).all():
            raise too_large(quantity)
        numbers = tuple(float(convert(one, quantity.kind, unit)) + 0.0 for one in each)
        number = (
            numbers if isinstance(raw, tuple) else raw if isinstance(raw, int) else numbers[0]
        )  # a count
        noise = any(map(quantity.is_noise, numbers))
        symbols = quantity.symbol, quantity.ascii_symbol
        shown_values.append(
            KeyValue(
                quantity.id,
                *symbols,
                quantity.marked(unit),
                number,
                quantity.text,
                at,
                noise,
                quantity.heading,
            ),
        )
    return shown_values


# the crank angles of the rows of a table that are given by a condition or by equal steps of the stroke

_SAME = 1e-9
"""Degrees by which angles differ by rounding only."""
_OF_SPEED = ("velocity", "acceleration", "angular_velocity", "angular_acceleration")


def over_stroke(step: float, end: float) -> Callable[[Subject], Sequence[float]]:
    """Return a function that finds the angles, up to `end`, at which x is 0, step, 2 step, … percent of the stroke.

    Both strokes count. Raises UsageError for a step that is not positive, and for an output without a stroke.
    """
    fractions = np.asarray(stepped(step, 100.0)) / 100

    def angles(subject: Subject) -> Sequence[float]:
        assert isinstance(subject.results, CylinderForces)
        mechanism = subject.results.mechanism
        if mechanism.turns:
            raise UsageError(
                f"--over x: the output of a {mechanism.name} turns on and has no stroke"
            )
        x = mechanism.stroke * fractions
        out = np.asarray(mechanism.crank_angles_at(x, True))
        back = np.asarray(mechanism.crank_angles_at(x[::-1], False))
        turn = np.concatenate((out, back[1:]))
        # the end of a turn is the beginning of the next one
        every = [turn[start > 0 :] + start for start in np.arange(0.0, end, 360.0).tolist()]
        return np.concatenate(every).tolist()

    return angles


@runtime_checkable
class Searchable(Protocol):
    """Results that `--where` searches; omega: of the crank in rad/s, None where no speed is given."""

    omega: Number | None

    def angles_where(self, column: str, value: float) -> Where | None:
        """Return where in the cycle a column has a value in SI; None for a column that is left out."""


def rows_where(text: str, command: str, end: float) -> Callable[[Subject], Sequence[float]]:
    """Return a function that finds the angles, up to `end`, at which a condition such as `b = 1/6 b_max` holds.

    They are exact except for rounding; the function raises Nowhere if there are none. Raises UsageError for a text that
    is no condition.
    """
    name, equals, value = (part.strip() for part in keyboard_text(text).partition("="))
    number = re.match(RATIO, value) or NUMBER.match(value)
    of = value[number.end() if number else 0 :].strip()
    if len(text) > LONGEST_VALUE or not (text.isprintable() and name and equals and (number or of)):
        raise UsageError(
            f"--where: expected a column and a value, such as 'b = 1/6 b_max', got '{text_in_one_line(text)}'"
        )
    try:
        factor = parse_ratio(number.group()) if number else None
    except UnitError as error:
        raise UsageError(f"--where: {error}") from None

    def angles(subject: Subject) -> Sequence[float]:
        own = subject.lists.columns(command)
        ids = called(name, own.values())
        if not ids:
            every = every_quantity().columns(command)
            ids = called(name, every.values())
        if not ids:
            near = did_you_mean(name, tuple(every))
            raise UsageError(f"--where: '{name}' is no column{near} (known: {', '.join(every)})")
        if wrong := ambiguity(name, ids):
            raise UsageError(f"--where: {wrong}")
        column = own.get(ids[0])  # None for one that only other machines have
        is_fraction = column is not None and not _has_unit(of, column)
        searched = _with_any_speed(subject, column) if column and is_fraction else subject
        wanted = _value(searched, command, column, factor, of, text) if column else 0.0
        results = searched.results
        assert isinstance(results, Searchable)
        found = column and results.angles_where(column.id, wanted)
        if column is None or found is None:
            why = "; kurbel check shows why"
            if column and column.kind in _OF_SPEED and results.omega is None:
                fraction = "a fraction of a key value, as in 'b = 1/6 b_max', needs none"
                why = f": no speed is given; add one by --set speed='60 rpm' ({fraction})"
            raise UsageError(f"--where: '{name}' is left out for this machine{why}")
        if not found.angles:
            low, high = (show(one, column.kind) for one in found.span)
            raise Nowhere(
                f"{subject.name}: {column.id} is nowhere {show(wanted, column.kind)}: it goes from {low} to {high}"
            )
        # a table over one turn has the rows of both turns of a cycle
        turned = np.sort(np.mod(found.angles, end))
        return turned[np.diff(turned, prepend=-1.0) > _SAME].tolist()

    return angles


def _has_unit(of: str, column: Quantity) -> bool:
    """Return whether this is a unit of the column, not a key value."""
    try:
        unit_factor(of, column.kind)
    except UnitError:
        return False
    return bool(of)


def _with_any_speed(subject: Subject, column: Quantity) -> Subject:
    """Return a cylinder without a speed as it moves at any speed, if the column needs one; else the subject itself.

    At uniform rotation a velocity is a fraction of its largest at the same angles whatever the speed.
    """
    forces = subject.results
    needs_speed = (
        column.kind in _OF_SPEED and isinstance(forces, CylinderForces) and forces.omega is None
    )
    if not needs_speed:
        return subject
    assert isinstance(forces, CylinderForces)
    machine = replace(forces.drive.machine, speed=_ANY_SPEED)
    return subject._replace(results=CylinderForces(machine, forces.drive.cylinder))


_ANY_SPEED = 1 / (2 * math.pi)
"""Revolutions per second: 1 rad/s."""


def _value(
    subject: Subject, command: str, column: Quantity, factor: float | None, of: str, text: str
) -> float:
    """Return the value in SI: a number with a unit of the column's kind, or a fraction of a key value."""
    if not of:
        if factor and column.kind != "ratio":
            raise UsageError(
                f"--where: {text} has no unit; write for instance {kind_example(column.kind)}"
            )
        return factor or 0.0
    try:
        up, down = unit_factor(of, column.kind)
    except UnitError as error:
        no_unit = error
    else:
        if factor is None:
            raise UsageError(
                f"--where: {text_in_one_line(of)} has no number before the unit; write {kind_example(column.kind)}"
            )
        return factor * up / down
    known = {
        id: one for id, one in subject.lists.key_values(command).items() if one.kind == column.kind
    }
    ids = called(of, known.values())
    value = number_of(subject.answer(known[ids[0]])) if ids else None
    if not ids:
        single = ", ".join(id for id, one in known.items() if not one.listed)
        raise UsageError(
            f"--where: '{of}' is neither a unit nor a key value of this kind: {no_unit}; key values: {single}"
        )
    if not isinstance(value, float):
        raise UsageError(f"--where: this machine has no {of}")
    return value * (1.0 if factor is None else factor)
