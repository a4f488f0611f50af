"""The frame of every report on a machine: from the results of a command and its declared quantities to tables."""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kurbel.declared.reading import shown
from kurbel.errors import NoSolutionError, Nowhere, UsageError
from kurbel.machine import Machine
from kurbel.near_words import did_you_mean
from kurbel.quantities import every_quantity
from kurbel.quantity import Lists, Quantity, called
from kurbel.report.provenance import provenance
from kurbel.report.shown import shown_columns, shown_key_values
from kurbel.report.tables import Column, Later, LeftOut, Part, PlaceTable, Report
from kurbel.solver.figures import Results, answered


@dataclass(frozen=True, eq=False)
class Subject:
    """What a command speaks of: one cylinder, or the whole machine.

    results: what answers its key values, the first that knows one; at: takes crank angles (n,) in degrees and returns
    the state whose attributes are its columns, (n,) in SI or None; lists: the quantities that it may have. left_out,
    warnings, place_tables: are made when they are read; source: where its columns are told of, `angles_where`, None for
    what has no rows; of: the cylinder that a pin belongs to.
    """

    name: str
    results: tuple[Any, ...]
    at: Callable[[Any], Any] | None = None
    lists: Lists = field(default_factory=every_quantity)
    left_out: Callable[[], Iterable[LeftOut]] = tuple
    warnings: Callable[[], Iterable[str]] = tuple
    place_tables: tuple[PlaceTable, ...] = ()
    source: Any = None
    of: str = ""

    def says(self, quantity: Quantity) -> bool:
        """Whether a quantity says something new here."""
        return not any(_says_nothing(one, quantity) for one in self.results)

    def key_values(self, command: str) -> Iterator[tuple[Quantity, Any]]:
        """Yield the key values of a command that it has, with their values in SI: a number, an Extreme or a tuple."""
        for quantity in self.lists.key_values(command).values():
            value = self.answer(quantity) if self.says(quantity) else None
            if value is not None:
                yield quantity, value

    def answer(self, quantity: Quantity) -> Any:
        """Return what the results have for a key value, in SI; None where they have none."""
        found = (_value(one, quantity) for one in self.results)
        return next((value for value in found if value is not None), None)

    def has(self, command: str) -> list[str]:
        """Return the ids of the columns of a command that it has."""
        if self.at is None:
            return []
        state = self.at(np.zeros(1))
        return [id for id in self.lists.columns(command) if id == "phi" or state[id] is not None]


def _value(results: Any, quantity: Quantity) -> Any:
    """Return a key value of results, in SI; None where they have none."""
    if not isinstance(results, Results):
        return answered((results,), quantity)
    row = results.rows.key_values.get(quantity.id)
    return None if row is None else row.of(results)


def _says_nothing(results: Any, quantity: Quantity) -> bool:
    """Return whether a quantity says nothing new of results."""
    if not isinstance(results, Results):
        return False
    row = results.rows.key_values.get(quantity.id) or results.rows.columns.get(quantity.id)
    return bool(row and row.unless and row.unless(results))


def refuse_without_cylinder(machine: Machine, command: str) -> None:
    """Raise UsageError where a command has nothing to tell of."""
    if not machine.cylinders:
        raise UsageError(f"{machine.name} has no cylinder; kurbel {command} needs one")


def _nowhere(parts: Sequence[Part]) -> Iterator[str]:
    """Yield why parts have no row, in one sentence each; raises NoSolutionError where none has."""
    without = [part.nowhere for part in parts if part.nowhere]
    if without and not any(part.columns for part in parts):
        raise NoSolutionError(without[0])
    return (f"{one}." for one in without)


@dataclass(frozen=True, eq=False)
class Frame:
    """A report to be made: of which command, at which crank angles (n,) in degrees, with which columns, in which units.

    angles: of every subject, or what tells those of one. columns: ids to show besides φ, None for all that the machine
    has and shows unasked; system: see `unit_systems`; over: another column over which the rows stand; compare: with
    the approximations of the book beside the exact columns.
    """

    command: str
    angles: Sequence[float] | Callable[[Subject], Sequence[float]]
    columns: Sequence[str] | None
    system: str
    over: str = ""
    compare: bool = False

    @np.errstate(all="ignore")
    def report(
        self,
        machine: Machine,
        title: str,
        subjects: Iterable[Subject],
        whole: Subject | None = None,
        notes: Iterable[str] = (),
    ) -> Report:
        """Return the report on these subjects; what overflows is refused by name."""
        every = (*subjects, *((whole,) if whole else ()))
        parts = [self._part(one) for one in every]
        self._refuse_absent(every, parts)
        told = (*notes, *self._nothing_compared(parts), *_nowhere(parts))
        last = parts.pop() if whole else None
        name = machine.name
        report = Report(f"{name}. {title}", self.command, name, "cylinders", tuple(parts), last, notes=told)
        names = tuple(cylinder.name for cylinder in machine.cylinders)
        return report._replace(provenance=provenance(machine), cylinders=names)

    def _part(self, subject: Subject) -> Part:
        try:
            columns, nowhere = self._columns(subject), ""
        except Nowhere as error:
            columns, nowhere = (), str(error)
        return Part(
            subject.name,
            columns,
            self.later(lambda: shown_key_values(subject.key_values(self.command), self.system)),
            self.later(subject.left_out),
            self.later(subject.warnings),
            subject.place_tables,
            nowhere,
            subject.of,
        )

    def later(self, make: Callable[[], Iterable[Any]]) -> Collection[Any]:
        """Return what is made when it is read."""
        return Later(np.errstate(all="ignore")(lambda: tuple(make())))

    def _columns(self, subject: Subject) -> tuple[Column, ...]:
        if subject.at is None:
            return ()
        known = subject.lists.columns(self.command)
        if self.columns:
            chosen = [*(known[name] for name in self.columns if name in known), *filter(self._adds, known.values())]
        else:
            unasked = (one for one in known.values() if self.command not in one.on_request or self._adds(one))
            chosen = [*filter(subject.says, unasked)]
        angles = self.angles(subject) if callable(self.angles) else self.angles
        return shown_columns(known["phi"], chosen, subject.at, angles, self.system)

    def _adds(self, column: Quantity) -> bool:
        return column.id == self.over or (self.compare and column.id.endswith("_book"))

    def _nothing_compared(self, parts: Sequence[Part]) -> Iterator[str]:
        compared = any(column.id.endswith("_book") for part in parts for column in part.columns)
        # the balance tells itself what it leaves out
        if self.compare and not compared and self.command != "balance":
            yield (
                "--compare: the approximations of the book (R 286-291, 297) are those of a slider-crank without offset "
                "and of a piston with pressures; this machine has neither."
            )

    def _refuse_absent(self, subjects: Sequence[Subject], parts: Sequence[Part]) -> None:
        """Raise UsageError for a column that was asked for and that no part has."""
        printed = {column.id for part in parts for column in part.columns}
        for name in self.columns or ():
            if name not in printed:
                raise UsageError(f"--columns: {self._absent(name, subjects)}")

    def _absent(self, name: str, subjects: Sequence[Subject]) -> str:
        """Return why there is no such column, and which there are."""
        every = every_quantity()
        known = every.columns(self.command)
        there = {id: known[id] for subject in subjects for id in subject.has(self.command)}
        has = f"has {', '.join(map(_with_symbol, there.values()))}" if there else ""
        if name in known:
            return f"'{name}' is left out for this machine" + (f", which {has}" if has else "")
        key_values = every.key_values(self.command)
        for found in called(name, key_values.values()):
            symbol = key_values[found].symbol
            return f"'{name}' is a key value and no column: a line below the table, --key-values | grep '{symbol} '"
        others = [one for one in known if one not in there]
        near = (did_you_mean(name, _names(one)) for one in (there.values(), known.values()))
        also = f"other machines also {', '.join(others)}" if others else ""
        return (
            f"'{shown(name)}' is no column of kurbel {self.command}{next(filter(None, near), '')} "
            f"({'; '.join(filter(None, (has and f'this machine {has}', also)))})"
        )


def _with_symbol(one: Quantity) -> str:
    return one.id if one.id == one.symbol else f"{one.id} ({one.symbol})"


def _names(quantities: Iterable[Quantity]) -> tuple[str, ...]:
    return tuple(name for one in quantities for name in (one.id, one.symbol))
