"""The methods side by side for every quantity: kurbel's own, and what people do otherwise."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from kurbel.accuracy import marching
from kurbel.accuracy.periodic import SAMPLE_STEP
from kurbel.accuracy.textbook import Moved, TextbookCylinder, TextbookMachine
from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.machine import CYCLES, Machine
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces

OWN = "kurbel"
_FULL = (36, 360, 3600, 100_000)
_QUICK = (36, 360, 3600)


class Method(NamedTuple):
    """One way to compute a quantity.

    points: how finely, as text: divisions of a turn, or a tolerance; run: returns the answer; evaluations: of the
    motion, None where they are counted while it runs.
    """

    name: str
    points: str
    run: Callable[[], Any]
    evaluations: int | None = None


def divisions(quick: bool) -> tuple[int, ...]:
    """Return the divisions of a turn that quadratures are tried with."""
    return _QUICK if quick else _FULL


def _turn(count: int, turns: int = 1) -> Array:
    return np.asarray(np.arange(count * turns) * (2 * math.pi / count))


def _tabled(answers: dict[str, Callable[[int, str], Any]], turns: int, quick: bool) -> Iterator[Method]:
    """Yield methods by divisions of a turn: the book's with its printed factors, then ever finer ones.

    answers: takes how many divisions, and by which formula of `Moved`; the book has the first.
    """
    by_book = next(iter(answers.values()))
    for parts in (18, 36):
        name, run = f"book, {parts // 2} divisions", partial(by_book, parts, "printed")
        yield Method(name, str(parts), run, parts * turns)
    for name, answer in answers.items():
        for count in divisions(quick):
            yield Method(name, str(count), partial(answer, count, "exact"), count * turns)


# motion

MOTIONS = {"x": "coordinate", "c": "slope", "b": "curvature"}
"""What is asked of a motion -> what mechanisms and `Moved` call it."""


def motion_methods(quantity: str, angles: Sequence[float], machine: Machine, quick: bool) -> Iterator[Method]:
    """Yield methods for x, c or b at crank angles (n,) in degrees, each as its derivative by φ in m."""
    asked, order, degrees = MOTIONS[quantity], list(MOTIONS).index(quantity), np.array(angles)
    mechanism: Any = machine.cylinders[0].mechanism
    own = getattr(mechanism, asked)
    yield Method(OWN, "closed", lambda: own(CrankAngle.of(degrees)), len(degrees))
    by_book = partial(_of_textbook, mechanism, degrees, asked)
    yield Method("textbook, radians", "closed", by_book, len(degrees))
    for count in divisions(quick) if order else ():
        run = partial(differences, mechanism, degrees, order, 2 * math.pi / count)
        yield Method("differences of x", str(count), run, (order + 1) * len(degrees))


def _of_textbook(mechanism: Any, degrees: Array, asked: str) -> Array:
    found: Array = getattr(Moved(mechanism, np.radians(degrees)), asked)
    return found


def differences(mechanism: Any, degrees: Array, order: int, step: float) -> Array:
    """Return dx/dφ (order 1) or d²x/dφ² (order 2) in m by differences of x over a step in radians."""
    phi = np.radians(degrees)
    before, after = (Moved(mechanism, phi + sign * step).coordinate for sign in (-1, 1))
    if order == 1:
        return np.asarray((after - before) / (2 * step))
    return np.asarray((after - 2 * Moved(mechanism, phi).coordinate + before) / step**2)


# quadratures


def trapezoid(function: Callable[[Array], Array], count: int, turns: int) -> float:
    """Return ∮ function dφ by the trapezium rule with so many divisions to a turn."""
    return float(np.sum(function(_turn(count, turns))) * (2 * math.pi / count))


def simpson(function: Callable[[Array], Array], count: int, turns: int) -> float:
    """Return ∮ function dφ by Simpson's rule with so many divisions to a turn."""
    values = function(_turn(count, turns))
    return float((2 * np.sum(values[::2]) + 4 * np.sum(values[1::2])) / 3 * (2 * math.pi / count))


def _quadratures(machine: Machine, quick: bool, power: str) -> Iterator[Method]:
    """Yield the book's and the usual quadratures of a power of the first cylinder's TextbookCylinder."""
    first = machine.cylinders[0]

    def by(rule: Callable[..., float]) -> Callable[[int, str], float]:
        def answer(count: int, formula: str) -> float:
            textbook = TextbookCylinder(machine, first, formula)
            return rule(getattr(textbook, power), count, textbook.turns)

        return answer

    rules = {"trapezium rule": by(trapezoid), "Simpson's rule": by(simpson)}
    return _tabled(rules, CYCLES[machine.cycle_of(first)], quick)


def work_methods(machine: Machine, quick: bool) -> Iterator[Method]:
    """Yield methods for the indicated work in J per cycle of the first cylinder."""
    yield Method(OWN, "closed", lambda: CylinderForces(machine, machine.cylinders[0]).work)
    yield from _quadratures(machine, quick, "gas_power")


def friction_methods(machine: Machine, quick: bool) -> Iterator[Method]:
    """Yield methods for its work of friction in J per cycle."""
    yield Method(OWN, "Lobatto 16", lambda: CylinderForces(machine, machine.cylinders[0]).friction_work)
    yield from _quadratures(machine, quick, "friction_power")


def extreme_methods(machine: Machine, quick: bool) -> Iterator[Method]:
    """Yield methods for its largest and its smallest T in N."""
    first = machine.cylinders[0]

    def own() -> Array:
        found = CylinderForces(machine, first).extremes_of("T")
        assert found is not None
        return np.array([found.largest.value, found.smallest.value])

    def ordinates(count: int, formula: str) -> Array:
        textbook = TextbookCylinder(machine, first, formula)
        values = textbook.torque(_turn(count, textbook.turns)) / textbook.mechanism.crank
        return np.array([values.max(), values.min()])

    yield Method(OWN, "roots of T′", own)
    yield from _tabled({"largest ordinate": ordinates}, CYCLES[machine.cycle_of(first)], quick)


def excess_methods(machine: Machine, quick: bool) -> Iterator[Method]:
    """Yield methods for ΔE in J."""

    def summed(count: int, formula: str) -> float:
        return summed_excess(TextbookMachine(machine, formula), count)

    yield Method(OWN, "closed", lambda: Case(machine).flywheel.dE)
    yield from _tabled({"trapezium rule": summed}, machine.revolutions, quick)


def summed_excess(textbook: TextbookMachine, count: int, **disturbed: Any) -> float:
    """Return ΔE in J by the trapezium rule with so many divisions to a turn."""
    turns = round(textbook.cycle / (2 * math.pi))
    values = textbook.torque(_turn(count, turns), **disturbed)
    excess = values - values.mean()
    heights = np.cumsum((excess + np.roll(excess, -1)) / 2) * (2 * math.pi / count)
    return float(heights.max() - heights.min())


# speed line

_TURNS = 12
_QUICK_TURNS = 4


def speed_methods(machine: Machine, quick: bool) -> Iterator[Method]:
    """Yield methods for ω at every 30°; the rivals answer with a `March`."""
    turns = _QUICK_TURNS if quick else _TURNS
    angles = np.arange(0.0, 360.0 * machine.revolutions, SAMPLE_STEP)

    yield Method(OWN, "1e-13", lambda: Case(machine).flywheel.at(angles).omega)
    mean = Case(machine).flywheel.M_mean

    def by(how: Callable[..., Any], *rest: Any) -> Callable[[], Any]:
        return lambda: how(marching.SpeedProblem(machine, mean), *rest)

    for steps in (360,) if quick else (360, 3600):
        yield Method("Runge-Kutta 4, marched", str(steps), by(marching.runge_kutta, steps, turns))
    for steps in (360, 3600) if quick else (360, 3600, 36_000):
        yield Method("implicit trapezium, periodic", str(steps), by(marching.implicit_trapezoid, steps))
    if has_scipy():
        for name in ("LSODA",) if quick else ("Radau", "BDF", "LSODA"):
            for tolerance in (1e-8,) if quick else (1e-6, 1e-10):
                run = by(marching.scipy_march, name, tolerance, turns)
                yield Method(f"scipy {name}, marched", f"{tolerance:.0e}", run)


def has_scipy() -> bool:
    """Whether scipy is installed."""
    from importlib.util import find_spec

    return find_spec("scipy") is not None


# counting


class Counted:
    """A mechanism that counts the crank angles at which its motion is asked for, and else is the one it stands for."""

    def __init__(self, mechanism: Any) -> None:
        self._mechanism = mechanism
        self.angles = 0
        self._counts = dict.fromkeys(MOTIONS.values(), 0)

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._mechanism, name)
        if name not in self._counts:
            return found

        def counting(angle: CrankAngle) -> Any:
            self._counts[name] += int(np.size(angle.degrees))
            self.angles = max(self._counts.values())
            return found(angle)

        return counting


def counted(machine: Machine) -> tuple[Machine, list[Counted]]:
    """Return the same machine with mechanisms that count."""
    counters = [Counted(cylinder.mechanism) for cylinder in machine.cylinders]
    cylinders = tuple(replace(one, mechanism=counter) for one, counter in zip(machine.cylinders, counters))  # type: ignore[arg-type]
    return replace(machine, cylinders=cylinders), counters
