"""At which crank angles a cylinder has its rows, where they are asked for otherwise than by angles."""

import re
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from kurbel.declared.numerals import NUMBER, RATIO, parse_ratio, plain
from kurbel.declared.quantity import Quantity, ambiguity, called
from kurbel.declared.reading import LONGEST_VALUE, shown
from kurbel.declared.unit_systems import show
from kurbel.declared.units import example, unit_factor
from kurbel.errors import Nowhere, UnitError, UsageError
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import Extreme
from kurbel.quantities import every_quantity
from kurbel.report.angles import stepped
from kurbel.report.frame import Subject

_SAME = 1e-9
"""Degrees by which angles differ by rounding only."""
_OF_SPEED = ("velocity", "acceleration", "angular_velocity", "angular_acceleration")


def over_stroke(step: float, end: float) -> Callable[[Subject], Sequence[float]]:
    """Return what finds the angles, up to `end`, at which x passes 0, step, 2 step, … percent of the stroke both ways.

    Raises UsageError for a step that is not positive, and for what does not go to and fro.
    """
    fractions = np.asarray(stepped(step, 100.0)) / 100

    def angles(subject: Subject) -> Sequence[float]:
        mechanism = subject.source.drive.mechanism
        if mechanism.turns:
            raise UsageError(f"--over x: the output of a {mechanism.name} turns on and has no stroke")
        way = mechanism.stroke * fractions
        out = np.asarray(mechanism.crank_angles_at(way, True))
        back = np.asarray(mechanism.crank_angles_at(way[::-1], False))
        turn = np.concatenate((out, back[1:]))
        # what ends a turn begins the next one
        every = [turn[start > 0 :] + start for start in np.arange(0.0, end, 360.0).tolist()]
        return np.concatenate(every).tolist()  # type: ignore[no-any-return]

    return angles


class Place(NamedTuple):
    """A condition such as `b = 1/6 b_max`: a column of a command, and the value at which it is wanted, as written.

    end: of the table, in degrees.
    """

    command: str
    column: str
    factor: float | None
    of: str
    text: str
    end: float

    @classmethod
    def parsed(cls, text: str, command: str, end: float) -> "Place":
        """Return the condition that a text is. Raises UsageError that says what to write instead."""
        column, equals, value = plain(text).partition("=")
        number = re.match(RATIO, value.strip()) or NUMBER.match(value.strip())
        of = value.strip()[number.end() if number else 0 :].strip()
        if len(text) > LONGEST_VALUE or not (text.isprintable() and column.strip() and equals and (number or of)):
            raise UsageError(f"--where: expected a column and a value, such as 'b = 1/6 b_max', got '{shown(text)}'")
        try:
            return cls(command, column.strip(), parse_ratio(number.group()) if number else None, of, text, end)
        except UnitError as error:
            raise UsageError(f"--where: {error}") from None

    def angles(self, subject: Subject) -> Sequence[float]:
        """Return the crank angles in degrees, exact but for rounding. Raises NoSolutionError for none."""
        column = self._column(subject)
        value = self._value(subject, column) if column else 0.0
        found = column and subject.source.angles_where(column.id, value)
        if column is None or found is None:
            raise UsageError(f"--where: '{self.column}' is left out for this machine{self._why(subject, column)}")
        if not found.angles:
            low, high = (show(one, column.kind) for one in found.span)
            raise Nowhere(
                f"{subject.name}: {column.id} is nowhere {show(value, column.kind)}: it goes from {low} to {high}"
            )
        # a table over one turn has what a cycle of two has in either
        angles = np.sort(np.mod(found.angles, self.end))
        apart = np.diff(angles, prepend=-1.0) > _SAME
        return angles[apart].tolist()  # type: ignore[no-any-return]

    def _why(self, subject: Subject, column: Quantity | None) -> str:
        """Return why a column is left out, as far as the speed is the reason."""
        if column is None or column.kind not in _OF_SPEED or subject.source.omega is not None:
            return "; kurbel check says why"
        return ": no speed is given; add one by --set speed='60 rpm' (where it is zero, any speed will do)"

    def _column(self, subject: Subject) -> Quantity | None:
        """Return the column that is meant, by id or printed symbol; None for one of other machines alone."""
        own, every = (lists.columns(self.command) for lists in (subject.lists, every_quantity()))
        ids = called(self.column, own.values()) or called(self.column, every.values())
        if not ids:
            near = did_you_mean(self.column, tuple(every))
            raise UsageError(f"--where: '{self.column}' is no column{near} (known: {', '.join(every)})")
        if wrong := ambiguity(self.column, ids):
            raise UsageError(f"--where: {wrong}")
        return own.get(ids[0])

    def _value(self, subject: Subject, column: Quantity) -> float:
        """Return the value in SI: a number with a unit of the column's kind, or a fraction of a key value."""
        factor = 1.0 if self.factor is None else self.factor
        if not self.of:
            if factor and column.kind != "ratio":
                raise UsageError(f"--where: {self.text} has no unit; write for instance {example(column.kind)}")
            return factor
        try:
            up, down = unit_factor(self.of, column.kind)
        except UnitError as error:
            return factor * self._key_value(subject, column, str(error))
        if self.factor is None:
            raise UsageError(f"--where: {shown(self.text)} has no number before the unit; write {example(column.kind)}")
        return factor * up / down

    def _key_value(self, subject: Subject, column: Quantity, no_unit: str) -> float:
        known = subject.lists.key_values(self.command)
        quantity = next((known[id] for id in called(self.of, known.values()) if known[id].kind == column.kind), None)
        if quantity is None:
            alike = [one.id for one in known.values() if one.kind == column.kind and not one.listed]
            raise UsageError(
                f"--where: '{self.of}' is neither a unit nor a key value of this kind: {no_unit}; "
                f"key values: {', '.join(alike)}"
            )
        value: Any = subject.answer(quantity)
        if not isinstance(value, (Extreme, float)):
            raise UsageError(f"--where: this machine has no {self.of}")
        return value.value if isinstance(value, Extreme) else value
