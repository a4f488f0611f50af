"""Rivals for the speed of the shaft: Runge and Kutta's method with fixed steps, and scipy's methods where installed.

Each is marched cycle by cycle until the speed repeats, or searches for the speed at φ = 0 with which one cycle repeats,
by Newton's method ("shooting"). Under a load that does not depend on the speed a rigid shaft is marched over one cycle,
and its level moved to the nominal mean. All are given the equation and the textbook's torque as polynomials: what those cost is
not in their times. None is given the corners. A method that needs too many evaluations gives up after a number of them, so
that a report has the same errors on every machine; in its first cycle after its share of them, since the goal takes more cycles.
"""

import math
from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from kurbel.accuracy.methods import scipy_integrate
from kurbel.accuracy.shaft import EVERY, ElasticShaft, Fits, RigidShaft, ShaftEquation, SpeedOfShaft
from kurbel.arrays import Array

_CYCLES = 20
"""Cycles that a march takes at most."""
_MOST = {"RK45": 12_000, "DOP853": 12_000, "Radau": 4_000, "LSODA": 12_000}
"""Evaluations that an adaptive method takes at most, all cycles together; Radau's take three times as long."""
_NEWTON = 12
"""Steps of Newton's method at most."""
_STEPS = (36, 360, 1800)
_TOLERANCES = (1e-3, 1e-6, 1e-9)
_CLOSE = 1e-9
"""Tolerance with which adaptive methods shoot."""


class Stopped(ArithmeticError):
    """A method failed; the message is the state in the table."""


class Marched(NamedTuple):
    """What a method returns: state, the speed, None where it failed, and evaluations of the equation."""

    state: str
    speed: SpeedOfShaft | None
    evaluations: int


class Course(NamedTuple):
    """One cycle: angles in degrees (n,), and y there (n, unknowns)."""

    degrees: Array
    y: Array


class Problem:
    """The equation in floats; cycle in degrees; least_cycles: that the goal takes."""

    def __init__(self, equation: ShaftEquation, fits: Fits, cycle: int) -> None:
        self.equation = equation
        self.fits = fits
        self.cycle = cycle
        self.evaluations = 0
        self.most_evaluations = 0
        self.least_cycles = 1
        self._edges = fits.edges.tolist()
        self._terms = fits.series.transpose(0, 2, 1)[:, :, ::-1].tolist()

    def torque_and_energy(self, degrees: float) -> tuple[float, float]:
        """Return torque and energy at an angle within the cycle, by Clenshaw's rule."""
        piece = min(bisect_right(self._edges, degrees), len(self._edges) - 1) - 1
        low = self._edges[piece]
        high = self._edges[piece + 1]
        share = (2 * degrees - low - high) / (high - low)
        twice = 2 * share
        values = []
        for series in self._terms:
            first = second = 0.0
            for coefficient in series[piece]:
                first, second = coefficient + twice * first - second, first
            values.append(first - share * second)
        return values[0], values[1]

    def drives_at(self, degrees: Array) -> Array:
        """Return torque and energy (2, n) at angles of the cycle."""
        return self.fits.at(degrees, np.clip(degrees, 1e-9, self.cycle - 1e-9))

    def rate(self, drive: tuple[float, float], y: Sequence[float]) -> list[float]:
        """Return y′ by radians; drive: torque and energy. Raises Stopped where the shaft stands still or its speed is beyond all bounds."""
        self.evaluations += 1
        torque, energy = drive
        if not self.equation.runs(energy, y):
            raise Stopped("blow-up")
        return self.equation.rate(torque, energy, y)

    def rate_at(self, radians: float, y: Array) -> list[float]:
        """Return y′ as scipy asks for it; raises Stopped after too many evaluations."""
        if self.evaluations >= self.most_evaluations:
            raise Stopped(f"gave up after {self.evaluations} evaluations")
        return self.rate(self.torque_and_energy(math.degrees(radians)), y.tolist())

    def start(self) -> Array:
        """Return y at uniform rotation."""
        return np.array(self.equation.start(self.torque_and_energy(0.0)[1]))

    def speed(self, course: Course) -> SpeedOfShaft:
        """Return what is compared of a cycle: extremes are those of its points."""
        _, energy = self.drives_at(course.degrees)
        w = np.asarray(self.equation.speed(energy, list(course.y.T)))
        slow = 1 / (1 + w)
        slowness = np.diff(course.degrees) @ (slow[1:] + slow[:-1]) / (2 * self.cycle)
        compared = np.arange(EVERY, self.cycle + 1, EVERY)
        numbers = np.searchsorted(course.degrees, compared - 1e-6)
        omega = self.equation.nominal * (1 + w)
        M_K: tuple[float, ...] = ()
        if isinstance(self.equation, ElasticShaft):
            passed = self.equation.torque(list(course.y.T))
            M_K = passed.max(), passed.min()
        return SpeedOfShaft(omega[numbers], np.ptp(w) * slowness, omega.max(), M_K)


Turn = Callable[[Array], Course]
"""Takes y at the beginning of a cycle, returns the cycle."""
Reach = Callable[[Problem, Turn, float], Marched]
"""Reaches the periodic state; the number: how closely it repeats, relative to its swing."""


# one cycle by a method


def runge_kutta(problem: Problem, steps: int, y: Array) -> Course:
    """Return a cycle by so many equal steps of the classical fourth-order method."""
    degrees = np.linspace(0.0, problem.cycle, 2 * steps + 1)
    drives = problem.drives_at(degrees).T.tolist()
    h = np.radians(problem.cycle) / steps
    state = y.tolist()
    rows = [state]
    for number in range(steps):
        begin, middle, end = drives[2 * number : 2 * number + 3]
        k1 = problem.rate(begin, state)
        k2 = problem.rate(middle, [v + h / 2 * k for v, k in zip(state, k1)])
        k3 = problem.rate(middle, [v + h / 2 * k for v, k in zip(state, k2)])
        k4 = problem.rate(end, [v + h * k for v, k in zip(state, k3)])
        state = [
            v + h / 6 * (a + 2 * b + 2 * c + d) for v, a, b, c, d in zip(state, k1, k2, k3, k4)
        ]
        rows.append(state)
    return Course(degrees[::2], np.array(rows))


def by_scipy(problem: Problem, solve: Any, method: str, tolerance: float, y: Array) -> Course:
    """Return a cycle by a method of scipy, as it is called without further options, every degree."""
    problem.most_evaluations = _MOST[method]
    if problem.evaluations == 0:
        problem.most_evaluations //= problem.least_cycles
    degrees = np.arange(problem.cycle + 1.0)
    radians = np.radians(degrees)
    size = max(np.abs(y).max(), abs(problem.equation.load.mean))
    absolute = 1e-3 * tolerance
    if problem.equation.unknowns == 1:
        absolute = size * tolerance
    course = solve(
        problem.rate_at,
        (0.0, radians[-1]),
        y,
        method=method,
        t_eval=radians,
        rtol=tolerance,
        atol=absolute,
    )
    if not course.success or not np.isfinite(course.y).all():
        raise Stopped("no step is small enough")
    return Course(degrees, course.y.T)


# the periodic state


def march(problem: Problem, turn: Turn, close: float) -> Marched:
    """March until y changes by no more than `close` in a cycle, relative to the swing of the cycle."""
    y = problem.start()
    problem.least_cycles = 2
    for _ in range(_CYCLES):
        course = turn(y)
        change = np.abs(course.y[-1] - y)
        y = course.y[-1]
        if (change <= close * np.ptp(course.y, axis=0)).all():
            return _marched("periodic", problem, course)
    return _marched(f"not periodic in {_CYCLES} cycles", problem, course)


def shoot(problem: Problem, turn: Turn, close: float) -> Marched:
    """Return the cycle that repeats, by Newton's method with slopes from differences."""
    y = problem.start()
    problem.least_cycles = 2 + len(y)
    for _ in range(_NEWTON):
        course = turn(y)
        missed = course.y[-1] - y
        swing = np.ptp(course.y, axis=0)
        if (np.abs(missed) <= close * swing).all():
            return _marched("periodic", problem, course)
        slopes = np.empty((len(y), len(y)))
        for number, width in enumerate(1e-5 * swing):
            moved = y.copy()
            moved[number] += width
            slopes[:, number] = (turn(moved).y[-1] - course.y[-1]) / width
        y = y - np.linalg.solve(slopes - np.eye(len(y)), missed)
    return _marched("no convergence", problem, course)


def march_once(problem: Problem, turn: Turn, close: float) -> Marched:
    """March one cycle: under a load that does not depend on the speed a rigid shaft repeats it at any level."""
    return _marched("periodic", problem, turn(problem.start()))


def _marched(state: str, problem: Problem, course: Course) -> Marched:
    """Return the speed of a cycle; where its level is free, at that of the nominal mean."""
    if problem.equation.load.is_constant:
        widths = np.diff(course.degrees) / problem.cycle
        weights = (np.append(widths, 0.0) + np.append(0.0, widths)) / 2
        _, energy = problem.drives_at(course.degrees)
        course = Course(course.degrees, problem.equation.leveled(energy, course.y.T, weights).T)
    return Marched(state, problem.speed(course), problem.evaluations)


def rivals(problem: Callable[[], Problem]) -> Iterator[tuple[str, str, Callable[[], Marched]]]:
    """Yield name, how finely, and what computes the speed anew."""
    equation = problem().equation
    if equation.load.is_constant and isinstance(equation, RigidShaft):
        yield from _with(problem, "over one cycle", march_once, _TOLERANCES)
        return
    yield from _with(problem, "marched", march, _TOLERANCES)
    # a cycle that repeats at any level is none to search for
    if not equation.load.is_constant:
        yield from _with(problem, "by shooting", shoot, (_CLOSE,))


def _with(
    problem: Callable[[], Problem], goal: str, reach: Reach, tolerances: tuple[float, ...]
) -> Iterator[tuple[str, str, Callable[[], Marched]]]:
    """Yield the rivals that reach the periodic state in one way."""
    for steps in _STEPS:
        run = partial(_reached, problem, reach, 1e-12, runge_kutta, steps)
        yield f"RK4 {goal}", str(steps), run
    integrate = scipy_integrate()
    if integrate is None:
        return
    for method in ("RK45", "DOP853", "Radau", "LSODA"):
        for tolerance in tolerances:
            options = (integrate.solve_ivp, method, tolerance)
            run = partial(_reached, problem, reach, tolerance, by_scipy, *options)
            yield f"{method} {goal}", f"{tolerance:.0e}", run


def _reached(
    problem: Callable[[], Problem],
    reach: Reach,
    close: float,
    method: Callable[..., Course],
    *options: Any,
) -> Marched:
    """Return the periodic state, reached in one of the ways by one of the methods."""
    fresh = problem()
    try:
        return reach(fresh, partial(method, fresh, *options), close)
    except ArithmeticError as stopped:
        return Marched(str(stopped), None, fresh.evaluations)
