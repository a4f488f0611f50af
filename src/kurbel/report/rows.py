"""The crank angles of the rows of a table that are given by a condition or by equal steps of the stroke."""

import re
from collections.abc import Callable, Sequence

import numpy as np

from kurbel.declared.numerals import NUMBER, RATIO, parse_ratio, plain
from kurbel.declared.reading import LONGEST_VALUE, shown
from kurbel.declared.unit_systems import show
from kurbel.declared.units import example, unit_factor
from kurbel.errors import Nowhere, UnitError, UsageError
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import number_of
from kurbel.quantities import every_quantity
from kurbel.quantity import Quantity, ambiguity, called
from kurbel.report.frame import Subject
from kurbel.report.tables import stepped
from kurbel.solver.flywheel import MachineTurning
from kurbel.solver.forces import CylinderForces

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
            raise UsageError(f"--over x: the output of a {mechanism.name} turns on and has no stroke")
        x = mechanism.stroke * fractions
        out = np.asarray(mechanism.crank_angles_at(x, True))
        back = np.asarray(mechanism.crank_angles_at(x[::-1], False))
        turn = np.concatenate((out, back[1:]))
        # the end of a turn is the beginning of the next one
        every = [turn[start > 0 :] + start for start in np.arange(0.0, end, 360.0).tolist()]
        return np.concatenate(every).tolist()

    return angles


def rows_where(text: str, command: str, end: float) -> Callable[[Subject], Sequence[float]]:
    """Return a function that finds the angles, up to `end`, at which a condition such as `b = 1/6 b_max` holds.

    They are exact except for rounding; the function raises Nowhere if there are none. Raises UsageError for a text that
    is no condition.
    """
    name, equals, value = (part.strip() for part in plain(text).partition("="))
    number = re.match(RATIO, value) or NUMBER.match(value)
    of = value[number.end() if number else 0 :].strip()
    if len(text) > LONGEST_VALUE or not (text.isprintable() and name and equals and (number or of)):
        raise UsageError(f"--where: expected a column and a value, such as 'b = 1/6 b_max', got '{shown(text)}'")
    try:
        factor = parse_ratio(number.group()) if number else None
    except UnitError as error:
        raise UsageError(f"--where: {error}") from None

    def angles(subject: Subject) -> Sequence[float]:
        own, every = subject.lists.columns(command), every_quantity().columns(command)
        ids = called(name, own.values()) or called(name, every.values())
        if not ids:
            near = did_you_mean(name, tuple(every))
            raise UsageError(f"--where: '{name}' is no column{near} (known: {', '.join(every)})")
        if wrong := ambiguity(name, ids):
            raise UsageError(f"--where: {wrong}")
        column = own.get(ids[0])  # None for one that only other machines have
        wanted = _value(subject, command, column, factor, of, text) if column else 0.0
        results = subject.results
        assert isinstance(results, (CylinderForces, MachineTurning))
        found = column and results.angles_where(column.id, wanted)
        if column is None or found is None:
            why = "; kurbel check shows why"
            if column and column.kind in _OF_SPEED and results.omega is None:
                why = ": no speed is given; add one by --set speed='60 rpm' (where it is zero, any speed will do)"
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


def _value(subject: Subject, command: str, column: Quantity, factor: float | None, of: str, text: str) -> float:
    """Return the value in SI: a number with a unit of the column's kind, or a fraction of a key value."""
    if not of:
        if factor and column.kind != "ratio":
            raise UsageError(f"--where: {text} has no unit; write for instance {example(column.kind)}")
        return factor or 0.0
    try:
        up, down = unit_factor(of, column.kind)
    except UnitError as error:
        no_unit = error
    else:
        if factor is None:
            raise UsageError(f"--where: {shown(of)} has no number before the unit; write {example(column.kind)}")
        return factor * up / down
    known = {id: one for id, one in subject.lists.key_values(command).items() if one.kind == column.kind}
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
