"""One row for every method of every quantity of a scene: error against the reference, time, state."""

import math
from collections.abc import Callable, Iterator, Sequence
from decimal import Decimal
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from kurbel.accuracy import references, rivals
from kurbel.accuracy.decimals import precise
from kurbel.accuracy.marching import BLOW_UP, OK, March
from kurbel.accuracy.oracle import CrankMotion, CylinderOracle, why_no_motion, why_not
from kurbel.accuracy.periodic import NoReference, SpeedOracle, why_no_speed
from kurbel.accuracy.rivals import OWN, Method
from kurbel.accuracy.scenes import Scene
from kurbel.accuracy.timing import Patience, timed
from kurbel.errors import KurbelError
from kurbel.machine import Cylinder, Machine

IN_ULP = 1e-12
"""Relative errors below this are also given in units of the last place."""


_ZERO = Decimal("1e-30")
"""In SI; a reference of 40 digits that is no larger is zero but for its rounding."""


class Row(NamedTuple):
    """One method: evaluations of the motion (None: not counted), relative error and ulp (None: no answer, or large).

    median, least: seconds; ratio: its median over that of kurbel's own method.
    """

    quantity: str
    method: str
    points: str
    state: str
    evaluations: int | None
    error: float | None
    ulp: float | None
    median: float
    least: float
    ratio: float


class Question(NamedTuple):
    """A quantity: its symbol, the reference, one or (n,), and its methods for a machine, kurbel's own first.

    methods: takes a machine, and whether the run is quick.
    """

    quantity: str
    reference: Callable[[], Any]
    methods: Callable[[Machine, bool], Iterator[Method]]


class Lacking(NamedTuple):
    """A quantity that is not examined, and why."""

    what: str
    why: str


def questions(scene: Scene) -> Iterator[Question | Lacking]:
    """Yield the quantities of a scene that can be examined, and those that cannot."""
    machine = scene.machine
    if machine.cylinders:
        first = machine.cylinders[0]
        if why := why_no_motion(first):
            yield Lacking("x, c, b", why)
        elif scene.moving:
            motion, angles = CrankMotion.of(first.mechanism), scene.angles
            for name in rivals.MOTIONS:
                truth = partial(references.motion_at, motion, angles, rivals.MOTIONS[name])
                yield Question(name, truth, partial(rivals.motion_methods, name, angles))
        yield from _of_forces(machine, first)
    yield from _of_machine(machine)


def _of_forces(machine: Machine, cylinder: Cylinder) -> Iterator[Question | Lacking]:
    """Yield what the forces of a cylinder give."""
    has_gas = any(piston.indicator for piston in cylinder.pistons)
    if not has_gas and (cylinder.masses is None or machine.speed is None):
        return
    rubs = cylinder.friction and cylinder.friction.crosshead and cylinder.mechanism.has_rod
    asked: tuple[tuple[Any, ...], ...] = (
        (has_gas, "A_i", references.work, rivals.work_methods),
        (cylinder.mechanism.slides, "T_max, T_min", references.tangential_extremes, rivals.extreme_methods),
        (rubs, "A_f", references.friction_work, rivals.friction_methods),
    )
    found = [each for there, *each in asked if there]
    if found and (why := why_not(cylinder)):
        yield Lacking("work, T, friction work", why)
        return
    for quantity, reference, methods in found:
        yield Question(quantity, _asked(reference, machine, cylinder), methods)


def _asked(reference: Callable[[CylinderOracle], Any], machine: Machine, cylinder: Cylinder) -> Callable[[], Any]:
    return lambda: reference(CylinderOracle(machine, cylinder))


def _of_machine(machine: Machine) -> Iterator[Question | Lacking]:
    """Yield what the turning effort of all cylinders gives."""
    if not any(piston.indicator for cylinder in machine.cylinders for piston in cylinder.pistons):
        if machine.effort is not None:
            yield Lacking("ΔE, ω", "no independent calculation of a given turning effort")
        return
    why = next((why for cylinder in machine.cylinders if (why := why_not(cylinder))), "")
    if machine.load and machine.load.diagram:
        why = why or "no independent calculation of a load given by points"
    if machine.efficiency != 1:
        why = why or "no independent calculation with an efficiency"
    if why:
        yield Lacking("ΔE, ω", why)
        return
    yield Question("ΔE", lambda: references.excess_energy(machine), rivals.excess_methods)
    if not (why := why_no_speed(machine)):
        yield Question("ω", lambda: SpeedOracle(machine).omega(), rivals.speed_methods)
    elif machine.flywheel is not None:
        yield Lacking("ω", why)


def rows(question: Question, machine: Machine, quick: bool) -> Iterator[Row]:
    """Yield the rows of one quantity, kurbel's own method first. Raises NoReference, KurbelError."""
    with precise():
        truth = question.reference()
    reference: Sequence[Decimal] = truth if isinstance(truth, (list, tuple)) else (truth,)
    if all(abs(truth) <= _ZERO for truth in reference):
        raise NoReference("it is zero, and no error is relative to that")
    own_median = 0.0
    for method in question.methods(machine, quick):
        with np.errstate(all="ignore"):
            answer, median, least = timed(method.run, Patience.of(quick))
        own_median = median if method.name == OWN else own_median
        values, state, used = _unpacked(answer, method)
        if method.name == OWN and used is None:
            used = _evaluations(question, machine)
        error, ulp = (None, None) if values is None else errors(values, reference)
        if error is None and state == OK:
            state = BLOW_UP
        yield Row(
            question.quantity, method.name, method.points, state, used, error, ulp, median, least, median / own_median
        )


def _unpacked(answer: Any, method: Method) -> tuple[Sequence[float] | None, str, int | None]:
    if isinstance(answer, March):
        return (None if answer.omega is None else answer.omega.tolist()), answer.state, answer.evaluations
    return np.atleast_1d(np.asarray(answer, dtype=float)).tolist(), OK, method.evaluations


def _evaluations(question: Question, machine: Machine) -> int:
    """Run kurbel's own method once more, on mechanisms that count."""
    counting, counters = rivals.counted(machine)
    next(question.methods(counting, True)).run()
    return sum(counter.angles for counter in counters)


def errors(values: Sequence[float], reference: Sequence[Decimal]) -> tuple[float | None, float | None]:
    """Return the largest relative error, and the same in units of the last place where it is below 1e-12.

    Where a reference is zero, the error counts relative to the largest one, which is not. None for what is not finite.
    """
    if not all(map(math.isfinite, values)):
        return None, None
    with precise():
        scale = max(map(abs, reference))
        zero = scale * Decimal("1e-30")
        worst, places = Decimal(0), 0.0
        for value, truth in zip(values, reference):
            missed = abs(Decimal(value) - truth)
            base = scale if abs(truth) <= zero else abs(truth)
            worst = max(worst, missed / base)
            places = max(places, float(missed / Decimal(math.ulp(float(base)))))
        error = float(worst)
    return error, places if error < IN_ULP else None


def examined(scene: Scene, quick: bool) -> tuple[list[Row], list[Lacking]]:
    """Return all rows of a scene, and what could not be examined."""
    asked = list(questions(scene))
    lacking = [one for one in asked if isinstance(one, Lacking)]
    found: list[Row] = []
    for question in (one for one in asked if isinstance(one, Question)):
        try:
            found += rows(question, scene.machine, quick)
        except (NoReference, KurbelError) as error:
            lacking.append(Lacking(question.quantity, str(error)))
    return found, lacking


def dominating(found: Sequence[Row]) -> list[Row]:
    """Return the rows that are both more exact and faster than kurbel's own for the quantity, by more than noise.

    Noise: a fifth of the time, and 16 roundings (2^-53) of the error.
    """
    own = next(row for row in found if row.method == OWN)
    assert own.error is not None
    return [
        row
        for row in found
        if row is not own
        and row.state == OK
        and row.error is not None
        and row.error < own.error - 16 * 2.0**-53
        and row.least < 0.8 * own.least
    ]
