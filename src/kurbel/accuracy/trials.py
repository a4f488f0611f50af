"""What `kurbel accuracy` measures on a machine: methods by error and time, and what leaving out saves."""

import math
import statistics
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from types import FrameType
from typing import NamedTuple, TypeVar

import numpy as np

from kurbel.accuracy.linkages import Stance, motion_of, stance
from kurbel.accuracy.methods import (
    MethodValue,
    Precise,
    by_fit,
    by_gauss,
    by_quad,
    by_simpson,
    equidistant,
    mp,
    mpf,
    over_the_turn,
    scipy_integrate,
)
from kurbel.accuracy.references import (
    NEEDED,
    Addends,
    Share,
    Textbook,
    TextbookMachine,
    needed,
    taking_part,
    unknown,
)
from kurbel.accuracy.textbook import DIGITS
from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.errors import KurbelError
from kurbel.machine import Machine
from kurbel.mechanisms import Mechanism
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces

OWN = "kurbel"
CORNERS = "between the corners"
ROUNDING = 2.0**-53
_LONG_ENOUGH = 40.0
"""Milliseconds of runs after which a time is known."""
Method = tuple[str, str, Callable[[], object]]
"""Name, how finely, and what computes one value, the largest and the smallest, or (n,)."""
T = TypeVar("T")


class Trial(NamedTuple):
    """A method; evaluations: crank angles of the motion; error: relative, and in units of the last place below 1e-12.

    median, least: of the time in ms; ratio: of the median over that of kurbel's own method.
    """

    quantity: str
    method: str
    points: str
    state: str
    evaluations: int
    error: float | None
    ulp: float | None
    median: float
    least: float
    ratio: float


class Saving(NamedTuple):
    """A machine with something left out; stages: functions of the solver that run for it; times as in `Trial`."""

    machine: str
    stages: int
    median: float
    least: float
    ratio: float


# methods: kurbel's own first


def examined(
    textbook: Textbook, degrees: Array, quick: bool
) -> tuple[list[Trial], dict[str, list[str]]]:
    """Return the trials of a machine, of its motion at these crank angles, and why which quantities are left out."""
    machine = textbook.machine
    rows: list[Trial] = []
    left_out: dict[str, list[str]] = {}
    motion = "xcb" if machine.cylinders and len(degrees) else ""
    with mp.workdps(DIGITS):
        for quantity in (*motion, *NEEDED):
            try:
                obstacle = _obstacle(machine, quantity)
                if obstacle is None:
                    continue
                if not obstacle:
                    truth, methods = compared(textbook, quantity, degrees)
                    obstacle = "it is zero, and no error is relative to that"
                    if np.abs(truth).max() > 1e-30:
                        rows += rows_of(quantity, truth, methods, quick)
                        continue
            except KurbelError as error:
                obstacle = str(error)
            left_out.setdefault(obstacle, []).append(quantity)
    return rows, left_out


def _obstacle(machine: Machine, quantity: str) -> str | None:
    """Return why a quantity cannot be compared, "" where it can; None where the machine has none."""
    if quantity in "xcb":
        return ""
    if kurbel_answer(machine, quantity) is None:
        return None
    part = next(unknown(machine, quantity), "")
    return f"no independent calculation of {part}" if part else ""


def compared(textbook: Textbook, quantity: str, degrees: Array) -> tuple[Array, Iterator[Method]]:
    """Return the exact values (n,) of a quantity, in mpmath's numbers, and the methods for it."""
    machine = textbook.machine
    if quantity in "xcb":
        order = "xcb".index(quantity)
        motion = motion_of(machine.cylinders[0].mechanism)
        values = [motion.at(mpf(float(angle)))[order] for angle in degrees]
        return np.array(values), motion_methods(machine, degrees, order)
    truth: Array = np.atleast_1d(np.array(textbook.reference(quantity), dtype=object))
    return truth, force_methods(machine, quantity, TextbookMachine(textbook, quantity))


def motion_methods(machine: Machine, degrees: Array, order: int) -> Iterator[Method]:
    """Yield methods for x, c or b at crank angles, order 0 to 2, as derivatives by φ in m."""
    mechanism = machine.cylinders[0].mechanism
    derivative = (mechanism.coordinate, mechanism.slope, mechanism.curvature)[order]
    yield OWN, "closed", lambda: derivative(CrankAngle.of(degrees))
    if isinstance(mechanism, (SliderCrank, ScotchYoke)):
        yield "textbook, radians", "closed", lambda: in_radians(mechanism, degrees)[order]
    for count in (16, 32, 64):
        yield "Chebyshev fit", str(count), partial(fitted_motion, mechanism, degrees, order, count)


def in_radians(mechanism: Mechanism, degrees: Array) -> Stance:
    """Return the motion of a slider-crank by the formulas of the books, in floats."""
    phi = np.radians(degrees)
    lengths = mechanism.crank, mechanism.rod_length, mechanism.offset
    return stance(*lengths, np.sin(phi), np.cos(phi), np.sqrt)


def fitted_motion(mechanism: Mechanism, degrees: Array, order: int, count: int) -> Array:
    """Return x, c or b of the polynomial of this degree through x of one turn."""

    def x(at: Array) -> Array:
        if isinstance(mechanism, (SliderCrank, ScotchYoke)):
            return np.asarray(in_radians(mechanism, at).x)
        return np.asarray(mechanism.coordinate(CrankAngle.of(at)))

    angles = 180 + 180 * np.polynomial.chebyshev.chebpts1(count + 1)
    series = np.polynomial.Chebyshev.fit(angles, x(angles), count, (0, 360))
    by_degree = np.asarray(series.deriv(order)(degrees % 360))
    return by_degree * math.degrees(1) ** order


def kurbel_answer(machine: Machine, quantity: str) -> object:
    """Return A_i, A_f, T_max and T_min of the first cylinder, or ΔE, by kurbel; None where a machine has none."""
    case = Case(machine)
    has_force = any(forces.drive.has_force for forces in case.cylinders)
    if quantity == "ΔE":
        has_torque = has_force or machine.effort is not None
        return case.flywheel.dE if has_torque else None
    if not has_force:
        return None
    forces = case.cylinders[0]
    if quantity == "A_i":
        return forces.work
    if quantity == "A_f":
        return forces.friction_work
    extremes = forces.extremes_of("T")
    return extremes and (extremes.largest.value, extremes.smallest.value)


_KURBEL_POINTS = {
    "A_i": "closed",
    "T_max, T_min": "roots of T′",
    "A_f": "Lobatto 16",
    "ΔE": "closed",
}
"""How kurbel computes a quantity."""


def force_methods(machine: Machine, quantity: str, book: TextbookMachine) -> Iterator[Method]:
    """Yield methods for what is computed from forces; book: has the edges of smooth pieces, unknown to kurbel."""
    edges = book.edges.astype(float)
    yield OWN, _KURBEL_POINTS[quantity], partial(kurbel_answer, machine, quantity)
    for name, method, counts in methods_for(quantity):
        for count in counts:
            run = partial(rival, machine, quantity, book, method, count)
            yield name, str(count or "default"), run
    if quantity[0] == "A":
        turns = round((edges[-1] - edges[0]) / 360)
        for count in (36, 360):
            rows = partial(spreadsheet, machine, quantity, turns, count)
            yield "spreadsheet", f"{count} rows", rows


def rival(
    machine: Machine,
    quantity: str,
    book: TextbookMachine,
    method: Callable[..., MethodValue],
    count: int,
) -> MethodValue:
    """Return a quantity by a method that is given the forces of kurbel, and what else the machine file gives."""
    cylinders = []
    for cylinder, share in zip(taking_part(machine, quantity), book.shares):
        floats = Share(float(share.of_all), float(share.of_driving))
        forces = CylinderForces(machine, cylinder)
        cylinders.append((forces.at, forces.drive.lag, floats))
    diagrams = [(torque_in_floats(torque), factor) for torque, factor in book.diagrams]
    function = partial(needed, quantity, Addends(cylinders, diagrams))
    return method(quantity, function, book.edges.astype(float), count)


def torque_in_floats(
    torque: Callable[[Precise, Precise], Precise],
) -> Callable[[Array, Array], Array]:
    """Return a torque over the angle that takes floats (n,)."""
    at = np.frompyfunc(torque, 2, 1)
    return lambda phi, within: np.asarray(at(phi, within), dtype=float)


def methods_for(quantity: str) -> Iterator[tuple[str, Callable[..., MethodValue], tuple[int, ...]]]:
    """Yield the rivals for a quantity and their numbers of points: between the corners, then without the corners."""
    if quantity[0] == "T":
        yield f"roots {CORNERS}", by_gauss, (8, 16, 32)
        yield f"Chebyshev fit {CORNERS}", by_fit, (8, 16, 32)
        yield "largest ordinate", equidistant, (36, 360, 3600)
        return
    yield f"Gauss {CORNERS}", by_gauss, (8, 16, 32)
    yield f"Chebyshev fit {CORNERS}", by_fit, (8, 16, 32)
    yield "trapezium rule", equidistant, (36, 360, 3600)
    yield "Simpson's rule", by_simpson, (36, 360, 3600)
    yield "Gauss over the turn", over_the_turn, (36, 360)
    if quantity == "A_i" and scipy_integrate():  # two thousand calls, one angle each, take a second
        yield "scipy quad", by_quad, (0,)


def spreadsheet(machine: Machine, quantity: str, turns: int, rows: int) -> float:
    """Return the work of the first cylinder as one has it of so many rows a turn: mean forces times displacements."""
    cylinder = machine.cylinders[0]
    degrees = np.linspace(0.0, 360.0, rows + 1)
    dx = np.diff(cylinder.mechanism.coordinate(CrankAngle.of(degrees)))
    work = 0.0
    for turn in range(turns):
        angles = degrees + 360 * turn
        state = CylinderForces(machine, cylinder).at(angles, angles)
        force = state.P_gas if quantity == "A_i" else -state.F_friction
        work += float((force[1:] + force[:-1]) @ dx) / 2
        if quantity == "A_f":
            lost = np.zeros(len(degrees)) + sum(state.losses.values(), start=0.0)
            work += float((lost[1:] + lost[:-1]).sum()) * math.pi / rows
    return work


# rows, and their times


def rows_of(quantity: str, truth: Array, methods: Iterator[Method], quick: bool) -> Iterator[Trial]:
    """Yield the rows of one quantity, kurbel's own first."""
    kurbel_median = None
    for name, points, run in methods:
        values, _, evaluations = watched(run)
        error, ulp = errors(np.atleast_1d(np.asarray(values, dtype=float)), truth)
        state = "blow-up" if error is None else "ok"
        median, least = timed(run, quick)
        kurbel_median = kurbel_median or median
        ratio = median / kurbel_median
        exactness = (state, evaluations, error, ulp)
        yield Trial(quantity, name, points, *exactness, median, least, ratio)


def errors(values: Array, truth: Array) -> tuple[float | None, float | None]:
    """Return the largest relative error, and the same in units of the last place where it is below 1e-12.

    Where an exact value is zero, or is so but for the rounding of the lengths, relative to the largest one. None for
    what is not finite.
    """
    if not np.isfinite(values).all():
        return None, None
    missed = np.abs(truth - values)
    sizes = np.abs(truth)
    largest = sizes.max()
    sizes = np.where(sizes > 2**-52 * largest, sizes, largest)
    error = float((missed / sizes).max())
    if error >= 1e-12:
        return error, None
    return error, float((missed / np.spacing(sizes.astype(float))).max())


def timed(run: Callable[[], object], quick: bool) -> tuple[float, float]:
    """Return the median and the least time in ms of 15 runs, or those of 0.04 s (quick: of 5 at most)."""
    most = 5 if quick else 15
    times: list[float] = []
    while len(times) < most and sum(times) < _LONG_ENOUGH:
        begin = time.perf_counter()
        run()
        times.append(1e3 * (time.perf_counter() - begin))
    return statistics.median(times), min(times)


def watched(run: Callable[[], T]) -> tuple[T, int, int]:
    """Return what a computation gives, how many functions of the solver run, and of how many crank angles."""
    functions = set()
    evaluations = 0

    def watch(frame: FrameType, event: str, result: object) -> None:
        nonlocal evaluations
        if event == "call":
            module = frame.f_globals.get("__name__", "")
            if module.startswith("kurbel.solver"):
                functions.add(frame.f_code)
            return
        is_motion = frame.f_code.co_name in ("of", "at_nodes", "stance")
        if event == "return" and is_motion and isinstance(result, (CrankAngle, Stance)):
            evaluations += np.size(result[1])

    before = sys.getprofile()
    sys.setprofile(watch)
    try:
        result = run()
    finally:
        sys.setprofile(before)
    return result, len(functions), evaluations


# what the rows show


class Rival(NamedTuple):
    """A rival of kurbel's own method in one scene: ratio of the least times."""

    row: Trial
    ratio: float


def with_corners(rows: Sequence[Trial]) -> list[Rival]:
    """Return for each quantity the fastest rival between the corners with all digits of kurbel.

    These are an error of 16 roundings, or that of kurbel's own where it is larger.
    """
    fastest = []
    for kurbel, others in _by_quantity(rows):
        enough = max(kurbel.error or 0.0, 16 * ROUNDING)
        equal: list[Trial] = []
        for row in others:
            if CORNERS in row.method and row.error is not None and row.error <= enough:
                equal.append(row)
        if equal:
            row = min(equal, key=lambda row: row.least)
            fastest.append(Rival(row, row.least / kurbel.least))
    return fastest


def without_corners(rows: Sequence[Trial]) -> list[Rival]:
    """Return for each quantity of forces the most exact rival without the corners that takes no longer than kurbel."""
    most_exact = []
    for kurbel, others in _by_quantity(rows):
        if kurbel.quantity not in NEEDED:
            continue
        as_fast: list[Trial] = []
        for row in others:
            if CORNERS not in row.method and row.error and row.least <= kurbel.least:
                as_fast.append(row)
        if as_fast:
            row = min(as_fast, key=lambda row: row.error or 0.0)
            most_exact.append(Rival(row, row.least / kurbel.least))
    return most_exact


def _by_quantity(rows: Sequence[Trial]) -> Iterator[tuple[Trial, list[Trial]]]:
    """Yield kurbel's own row of each quantity, and the others."""
    for kurbel in rows:
        if kurbel.method != OWN:
            continue
        of_quantity = [row for row in rows if row.quantity == kurbel.quantity]
        yield kurbel, [row for row in of_quantity if row.method != OWN]


# what leaving out saves


def savings(
    machine: Machine, compute: Callable[[Machine], object], quick: bool
) -> Iterator[Saving]:
    """Yield the machine with everything, then without friction, masses, cards and speed, one after another.

    compute: all that a command prints.
    """
    full_median = None
    for name, lighter in _lighter_machines(machine):
        run = partial(compute, lighter)
        _, count, _ = watched(run)
        median, least = timed(run, quick)
        full_median = full_median or median
        yield Saving(name, count, median, least, median / full_median)


def _lighter_machines(machine: Machine) -> Iterator[tuple[str, Machine]]:
    """Yield a machine, and what is left where one thing after another is left out, if it has it."""
    yield "everything", machine
    cylinders = machine.cylinders
    if any(cylinder.friction for cylinder in cylinders):
        cylinders = tuple(replace(cylinder, friction=None) for cylinder in cylinders)
        machine = replace(machine, cylinders=cylinders, limits=())
        yield "no friction", machine
    if any(cylinder.masses for cylinder in cylinders):
        cylinders = tuple(
            replace(cylinder, masses=None, inclination=None) for cylinder in cylinders
        )
        machine = replace(machine, cylinders=cylinders, limits=())
        yield "no masses either", machine
    if any(cylinder.pistons for cylinder in cylinders):
        cylinders = tuple(replace(cylinder, pistons=()) for cylinder in cylinders)
        machine = replace(machine, cylinders=cylinders, limits=())
        yield "no cards either: motion alone", machine
    if machine.speed is not None:
        yield "no speed either: positions alone", replace(machine, speed=None)
