"""The crank angles of the rows of a table: at equal steps of the stroke, or where a column has a value."""

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np

from kurbel.arrays import Number
from kurbel.declared.numerals import NUMBER, keyboard_text, parse_ratio
from kurbel.declared.reading import LONGEST_VALUE, text_in_one_line
from kurbel.declared.unit_systems import show
from kurbel.declared.units import (
    kind_example,
    other_zero,
    split_quantity,
    unit_factor,
    zero_of,
)
from kurbel.errors import Nowhere, UnitError, UsageError
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import number_of
from kurbel.quantities import every_quantity
from kurbel.quantity import Quantity, ambiguity, called
from kurbel.solver.cycle import Where
from kurbel.solver.forces import CylinderForces
from kurbel.tables.frame import Subject
from kurbel.tables.tables import stepped

_SAME = 1e-9
"""Degrees by which angles differ by rounding only."""
_OF_SPEED = ("velocity", "acceleration", "angular_velocity", "angular_acceleration")
"""Kinds of quantities that need a speed."""
_ANY_SPEED = 1 / (2 * math.pi)
"""Revolutions per second: 1 rad/s."""


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
                f"--over x: the output of a {mechanism.name} rotates continuously and has no stroke"
            )
        # the way out, and the way back without the dead centre between them
        x = mechanism.stroke * fractions
        outward = np.asarray(mechanism.crank_angles_at(x, True))
        back = np.asarray(mechanism.crank_angles_at(x[::-1], False))
        turn = np.concatenate((outward, back[1:]))

        # the end of a turn is the beginning of the next one
        turns = []
        for start in np.arange(0.0, end, 360.0).tolist():
            is_later = start > 0
            turns.append(turn[int(is_later) :] + start)
        return np.concatenate(turns).tolist()

    return angles


@runtime_checkable
class Searchable(Protocol):
    """Results that `--where` searches; omega: of the crank in rad/s, None where no speed is given."""

    omega: Number | None

    def angles_where(self, column: str, value: float) -> Where | None:
        """Return where in the cycle a column has a value in SI; None for a column that is left out."""


class Condition(NamedTuple):
    """What `--where` asks for: a column that has a value, such as `b = 1/6 b_max`.

    text: as it was typed; name: of the column; factor: the number, None without one; of: what follows it, a unit or a
    key value.
    """

    text: str
    name: str
    factor: float | None
    of: str


def rows_where(text: str, command: str, end: float) -> Callable[[Subject], Sequence[float]]:
    """Return a function that finds the angles, up to `end`, at which a condition such as `b = 1/6 b_max` holds.

    They are exact except for rounding; the function raises Nowhere if there are none. Raises UsageError for a text that
    is no condition.
    """
    condition = _condition(text)

    def angles(subject: Subject) -> Sequence[float]:
        column = _searched_column(condition, subject, command)
        if column is None:  # only other machines have it
            raise _left_out(condition, None, subject)

        # at uniform rotation fractions of a velocity need no speed
        is_fraction = not _has_unit(condition.of, column)
        searched = _with_any_speed(subject, column) if is_fraction else subject
        value = _value(searched, command, column, condition)
        results = searched.results
        assert isinstance(results, Searchable)
        where = results.angles_where(column.id, value)
        if where is None:
            raise _left_out(condition, column, searched)
        if not where.angles:
            low, high = (show(limit, column.kind) for limit in where.span)
            raise Nowhere(
                f"{subject.name}: {column.id} is nowhere {show(value, column.kind)}: "
                f"it goes from {low} to {high}"
            )
        # a table over one turn has the rows of both turns of a cycle
        turned = np.sort(np.mod(where.angles, end))
        is_new = np.diff(turned, prepend=-1.0) > _SAME
        return turned[is_new].tolist()

    return angles


def _condition(text: str) -> Condition:
    """Return the condition that a text is; raises UsageError where it is none."""
    name, equals, value = (part.strip() for part in keyboard_text(text).partition("="))
    try:
        factor, of = _factor_and_rest(value)
    except UnitError as error:
        raise UsageError(f"--where: {error}") from None
    is_complete = name and equals and (factor is not None or of)
    if len(text) > LONGEST_VALUE or not text.isprintable() or not is_complete:
        raise UsageError(
            f"--where: expected a column and a value, such as 'b = 1/6 b_max', got '{text_in_one_line(text)}'"
        )
    return Condition(text, name, factor, of)


def _factor_and_rest(value: str) -> tuple[float | None, str]:
    """Return the number of a condition, None for none, and what follows it: a unit or a key value.

    >>> _factor_and_rest("1/4 c_max"), _factor_and_rest("50 % c_max"), _factor_and_rest("1 ft 6 in")
    ((0.25, 'c_max'), (0.5, 'c_max'), (18.0, 'in'))
    """
    percent = re.match(rf"{NUMBER.pattern}\s*%", value)
    if percent:
        return parse_ratio(percent.group()), value[percent.end() :].strip()
    return split_quantity(value) or (None, value)


def _searched_column(condition: Condition, subject: Subject, command: str) -> Quantity | None:
    """Return the column that a condition names, None if only other machines have it.

    Raises UsageError for a name that is no column, or that of several.
    """
    name = condition.name
    columns = subject.lists.columns(command)
    ids = called(name, columns.values())
    if not ids:
        all_columns = every_quantity().columns(command)
        ids = called(name, all_columns.values())
        if not ids:
            near = did_you_mean(name, tuple(all_columns))
            listed = ", ".join(all_columns)
            raise UsageError(f"--where: '{name}' is no column{near} (known: {listed})")
    if wrong := ambiguity(name, ids):
        raise UsageError(f"--where: {wrong}")
    return columns.get(ids[0])


def _left_out(condition: Condition, column: Quantity | None, subject: Subject) -> UsageError:
    """Return the error for a column that this machine does not have."""
    why = "; kurbel check shows why"
    if column and column.kind in _OF_SPEED:
        assert isinstance(subject.results, Searchable)
        if subject.results.omega is None:
            fraction = "a fraction of a key value, as in 'b = 1/6 b_max', needs none"
            why = f": no speed is given; add one by --set speed='60 rpm' ({fraction})"
    return UsageError(f"--where: '{condition.name}' is left out for this machine{why}")


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
    if not isinstance(forces, CylinderForces):
        return subject
    needs_speed = column.kind in _OF_SPEED and forces.omega is None
    if not needs_speed:
        return subject
    machine = replace(forces.drive.machine, speed=_ANY_SPEED)
    return subject._replace(results=CylinderForces(machine, forces.drive.cylinder))


def _value(subject: Subject, command: str, column: Quantity, condition: Condition) -> float:
    """Return the value in SI: a number with a unit of the column's kind, or a fraction of a key value."""
    factor, of = condition.factor, condition.of
    if not of:
        if factor and column.kind != "ratio":
            example = kind_example(column.kind)
            raise UsageError(f"--where: {condition.text} has no unit; write for instance {example}")
        # zero needs no unit
        return factor or 0.0
    try:
        numerator, denominator = unit_factor(of, column.kind)
    except UnitError as error:
        # reported below if it is no key value either
        why_no_unit = error
    else:
        if factor is None:
            raise UsageError(
                f"--where: {text_in_one_line(of)} has no number before the unit; "
                f"write {kind_example(column.kind)}"
            )
        zero_fault = column.kind == "pressure" and other_zero(of, column.zero, column.id)
        if zero_fault:
            raise UsageError(f"--where: {zero_fault}")
        return (factor + zero_of(of)) * numerator / denominator

    # no unit, so it must be a key value of the column's kind
    declared = subject.lists.key_values(command).items()
    candidates = {id: quantity for id, quantity in declared if quantity.kind == column.kind}
    ids = called(of, candidates.values())
    if not ids:
        single = ", ".join(id for id, quantity in candidates.items() if not quantity.listed)
        raise UsageError(
            f"--where: '{of}' is neither a unit nor a key value of this kind: {why_no_unit}; key values: {single}"
        )
    value = number_of(subject.answer(candidates[ids[0]]))
    if not isinstance(value, float):
        raise UsageError(f"--where: this machine has no {of}")
    return value * (1.0 if factor is None else factor)
