"""The methods side by side for every quantity: kurbel's own, and what people do otherwise."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kurbel.accuracy import marching
from kurbel.accuracy.periodic import SAMPLE_STEP
from kurbel.accuracy.textbook import TextbookCylinder, TextbookMachine, alone
from kurbel.crank_angle import CrankAngle
from kurbel.machine import CYCLES, Cylinder, Machine
from kurbel.solver.case import Case
from kurbel.solver.cylinder.forces import CylinderForces

Array = NDArray[np.float64]
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


# motion

MOTIONS = ("x", "c", "b")
_COORDINATES = ("coordinate", "slope", "curvature")


def motion_methods(cylinder: Cylinder, quantity: str, angles: Sequence[float], quick: bool) -> Iterator[Method]:
    """Yield methods for x, c or b at crank angles (n,) in degrees, each as its derivative by φ in m."""
    order = MOTIONS.index(quantity)
    degrees = np.array(angles)
    mechanism: Any = cylinder.mechanism
    own = getattr(mechanism, _COORDINATES[order])
    yield Method(OWN, "closed", lambda: own(CrankAngle.of(degrees)), len(degrees))
    yield Method("textbook, radians", "closed", lambda: alone(mechanism, np.radians(degrees), order), len(degrees))
    for count in divisions(quick) if order else ():
        step = 2 * math.pi / count
        yield Method(
            "differences of x", str(count), _differences(mechanism, degrees, order, step), (order + 1) * len(degrees)
        )


def _differences(mechanism: Any, degrees: Array, order: int, step: float) -> Callable[[], Array]:
    def first() -> Array:
        phi = np.radians(degrees)
        return np.asarray((alone(mechanism, phi + step, 0) - alone(mechanism, phi - step, 0)) / (2 * step))

    def second() -> Array:
        phi = np.radians(degrees)
        around = alone(mechanism, phi + step, 0) - 2 * alone(mechanism, phi, 0) + alone(mechanism, phi - step, 0)
        return np.asarray(around / step**2)

    return first if order == 1 else second


# quadratures


def trapezoid(function: Callable[[Array], Array], count: int, turns: int) -> float:
    """Return ∮ function dφ by the trapezium rule with so many divisions to a turn."""
    return float(np.sum(function(_turn(count, turns))) * (2 * math.pi / count))


def simpson(function: Callable[[Array], Array], count: int, turns: int) -> float:
    """Return ∮ function dφ by Simpson's rule with so many divisions to a turn."""
    values = function(_turn(count, turns))
    return float((2 * np.sum(values[::2]) + 4 * np.sum(values[1::2])) / 3 * (2 * math.pi / count))


def _quadratures(machine: Machine, cylinder: Cylinder, quick: bool, power: str) -> Iterator[Method]:
    """Yield the book's and the usual quadratures of a power of TextbookCylinder."""

    def rule(how: Callable[..., float], count: int, formula: str = "exact") -> Callable[[], float]:
        def run() -> float:
            textbook = TextbookCylinder(machine, cylinder, formula)
            return how(getattr(textbook, power), count, textbook.turns)

        return run

    turns = CYCLES[machine.cycle_of(cylinder)]
    for parts in (9, 18):
        yield Method(
            f"book, {parts} divisions", str(2 * parts), rule(trapezoid, 2 * parts, "printed"), 2 * parts * turns
        )
    for name, how in (("trapezium rule", trapezoid), ("Simpson's rule", simpson)):
        for count in divisions(quick):
            yield Method(name, str(count), rule(how, count), count * turns)


def work_methods(machine: Machine, cylinder: Cylinder, quick: bool) -> Iterator[Method]:
    """Yield methods for the indicated work in J per cycle."""
    yield Method(OWN, "closed", lambda: CylinderForces(machine, cylinder).work)
    yield from _quadratures(machine, cylinder, quick, "gas_power")


def friction_methods(machine: Machine, cylinder: Cylinder, quick: bool) -> Iterator[Method]:
    """Yield methods for the work of friction in J per cycle."""
    yield Method(OWN, "Gauss 16", lambda: CylinderForces(machine, cylinder).friction_work)
    yield from _quadratures(machine, cylinder, quick, "friction_power")


def extreme_methods(machine: Machine, cylinder: Cylinder, quick: bool) -> Iterator[Method]:
    """Yield methods for the largest and the smallest T in N."""

    def own() -> Array:
        found = CylinderForces(machine, cylinder).extremes_of("T")
        assert found is not None
        return np.array([found.largest.value, found.smallest.value])

    def sampled(count: int, formula: str) -> Callable[[], Array]:
        def run() -> Array:
            textbook = TextbookCylinder(machine, cylinder, formula)
            values = textbook.torque(_turn(count, textbook.turns)) / textbook.mechanism.crank
            return np.array([values.max(), values.min()])

        return run

    turns = TextbookCylinder(machine, cylinder).turns
    yield Method(OWN, "roots of T′", own)
    for parts in (9, 18):
        yield Method(f"book, {parts} divisions", str(2 * parts), sampled(2 * parts, "printed"), 2 * parts * turns)
    for count in divisions(quick):
        yield Method("largest ordinate", str(count), sampled(count, "exact"), count * turns)


def excess_methods(machine: Machine, quick: bool) -> Iterator[Method]:
    """Yield methods for ΔE in J."""

    def summed(count: int, formula: str) -> Callable[[], float]:
        return lambda: summed_excess(TextbookMachine(machine, formula), count)

    yield Method(OWN, "closed", lambda: Case(machine).flywheel.dE)
    for parts in (9, 18):
        yield Method(
            f"book, {parts} divisions", str(2 * parts), summed(2 * parts, "printed"), 2 * parts * machine.revolutions
        )
    for count in divisions(quick):
        yield Method("trapezium rule", str(count), summed(count, "exact"), count * machine.revolutions)


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

    def problem() -> marching.SpeedProblem:
        return marching.SpeedProblem(machine, mean)

    for steps in (360,) if quick else (360, 3600):
        yield Method("Runge-Kutta 4, marched", str(steps), _bound(marching.runge_kutta, problem, steps, turns))
    for steps in (360, 3600) if quick else (360, 3600, 36_000):
        yield Method("implicit trapezium, periodic", str(steps), _bound(marching.implicit_trapezoid, problem, steps))
    if has_scipy():
        for name in ("LSODA",) if quick else ("Radau", "BDF", "LSODA"):
            for tolerance in (1e-8,) if quick else (1e-6, 1e-10):
                run = _bound(marching.scipy_march, problem, name, tolerance, turns)
                yield Method(f"scipy {name}, marched", f"{tolerance:.0e}", run)


def _bound(how: Callable[..., Any], problem: Callable[[], Any], *rest: Any) -> Callable[[], Any]:
    return lambda: how(problem(), *rest)


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
        self._counts = dict.fromkeys(_COORDINATES, 0)

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
