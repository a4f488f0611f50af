"""The speed of the shaft where it is stiff, and where it is not: kurbel and its rivals by error and time.

A line of `stiff.tsv` is a scene: `quick` if it is also in the quick run, the text of a machine file, and the reference,
ω every 30°, δ, ω_max and M_K: it takes minutes and was computed by benchmarks/stiff_scenes.py.
"""

import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from kurbel.accuracy.marching import Marched, Problem, rivals
from kurbel.accuracy.methods import Precise, mp, mpf
from kurbel.accuracy.references import Textbook
from kurbel.accuracy.shaft import (
    EVERY,
    MOST,
    SpeedOfShaft,
    TextbookShaft,
    equation_in_floats,
    speed_of,
    without_reference,
)
from kurbel.accuracy.textbook import DIGITS
from kurbel.accuracy.trials import OWN, timed, watched
from kurbel.errors import KurbelError
from kurbel.machine import Machine
from kurbel.solver.case import Case
from kurbel.solver.flywheel import MachineTurning

_AT_ONCE = 0.05
"""Seconds above which a method is run once."""


class SpeedTrial(NamedTuple):
    """A method; errors: relative, of ω the largest every 30°, of M_K the larger one; None where it failed.

    evaluations: of the equation, kurbel's own of the motion; times and ratio as in `Trial`.
    """

    method: str
    points: str
    state: str
    evaluations: int
    omega: float | None
    delta: float | None
    omega_max: float | None
    M_K: float | None
    median: float
    least: float
    ratio: float


def _numbers_of(column: str) -> list[Precise]:
    return [mpf(number) for number in column.split()]


def reference_of(columns: Sequence[str]) -> SpeedOfShaft:
    """Return the reference in the last columns of a line of `stiff.tsv`."""
    omega, delta, omega_max, M_K = map(_numbers_of, columns)
    return SpeedOfShaft(np.array(omega), delta[0], omega_max[0], tuple(M_K))


def examined_speed(
    textbook: Textbook, columns: Sequence[str], quick: bool
) -> tuple[list[SpeedTrial], str]:
    """Return the trials of the speed of a machine, or why there are none; columns: of its reference, if it is known."""
    machine = textbook.machine
    with mp.workdps(DIGITS):
        if why := next(without_reference(machine), ""):
            return [], why
        try:
            speed_by_kurbel(MachineTurning(Case(machine).effort))
            shaft = TextbookShaft(textbook)
            truth = reference_of(columns) if columns else speed_of(shaft, MOST)
        except (KurbelError, ArithmeticError) as error:
            return [], str(error)
        return _rows(machine, shaft, truth, quick), ""


def speed_by_kurbel(turning: MachineTurning) -> SpeedOfShaft:
    """Return what is compared of the results of kurbel."""
    angles = np.arange(EVERY, round(turning.effort.cycle) + 1.0, EVERY)
    line = turning.speed
    assert line is not None
    M_K = (
        ()
        if turning.elastic is None
        else tuple(end.value for end in turning.elastic.torque_extremes)
    )
    return SpeedOfShaft(turning.at(angles).omega, line.delta, line.omega_max.value, M_K)


def _rows(
    machine: Machine, shaft: TextbookShaft, truth: SpeedOfShaft, quick: bool
) -> list[SpeedTrial]:
    """Return the rows, kurbel's own first: the whole machine computed anew, and with its torque known, as rivals."""
    rows: list[SpeedTrial] = []

    def add(name: str, points: str, marched: Marched, times: Times) -> None:
        omega, delta, omega_max, M_K = _errors(marched.speed, truth)
        median, least = times
        ratio = median / rows[0].median if rows else 1.0
        evaluations = marched.evaluations
        errors = (omega, delta, omega_max, M_K)
        rows.append(
            SpeedTrial(name, points, marched.state, evaluations, *errors, median, least, ratio)
        )

    effort = Case(machine).effort
    of_kurbel: dict[str, Callable[[], SpeedOfShaft]] = {
        OWN: lambda: speed_by_kurbel(MachineTurning(Case(machine).effort)),
        f"{OWN}, torque known": lambda: speed_by_kurbel(MachineTurning(effort)),
    }
    for name, run in of_kurbel.items():
        speed, _, evaluations = watched(run)
        add(name, "adaptive", Marched("periodic", speed, evaluations), timed(run, quick))

    fits = shaft.fits
    equation = equation_in_floats(shaft.equation)
    for name, points, march in rivals(partial(Problem, equation, fits, shaft.cycle)):
        begin = time.perf_counter()
        marched = march()
        spent = time.perf_counter() - begin
        times = (1e3 * spent, 1e3 * spent)
        add(name, points, marched, times if spent > _AT_ONCE else timed(march, quick))
    return rows


Times = tuple[float, float]
"""Median and least in ms."""


Errors = tuple[float | None, float | None, float | None, float | None]


def _errors(speed: SpeedOfShaft | None, truth: SpeedOfShaft) -> Errors:
    """Return the relative errors of ω, δ, ω_max and M_K."""
    if speed is None:
        return None, None, None, None
    omega = max(map(_error, speed.omega, truth.omega))
    M_K = max(map(_error, speed.M_K, truth.M_K), default=None)
    return omega, _error(speed.delta, truth.delta), _error(speed.omega_max, truth.omega_max), M_K


def _error(value: float, truth: Precise) -> float:
    """Return a relative error."""
    return float(abs(mpf(float(value)) / truth - 1))
