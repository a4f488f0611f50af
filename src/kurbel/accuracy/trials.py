"""What `kurbel accuracy` measures on a machine: methods by error and time, errors of model and data, what is saved."""

import copy
import math
import statistics
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial
from types import FrameType
from typing import Any, NamedTuple

import numpy as np

from kurbel.accuracy.methods import (
    DIGITS,
    FLOATS,
    PRECISE,
    Function,
    Integrals,
    Motor,
    NoAnswer,
    Number,
    Numbers,
    excess,
    extremes,
    fitted,
    gauss,
    merged,
    mp,
    periodic,
    precise_integrals,
    within,
)
from kurbel.accuracy.textbook import TextbookCylinder, TextbookMachine, TextbookMotion
from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.errors import KurbelError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Card
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces, share_of_driving
from kurbel.solver.friction import mean_friction_over_rod_angle, redtenbacher_logarithm, redtenbacher_loss

OWN = "kurbel"
Method = tuple[str, str, Callable[[Machine, Numbers], Any]]
"""Name, how finely, and what takes a machine and numbers and returns the values, (n,) or one."""


class Question(NamedTuple):
    """A quantity, its reference, (n,) or one, and its methods, kurbel's own first."""

    quantity: str
    reference: Callable[[], Any]
    methods: Iterable[Method]


class Lacking(NamedTuple):
    """A quantity that is not examined, and why."""

    what: str
    why: str


class Row(NamedTuple):
    """A method; evaluations: crank angles of the motion; error: relative, and in units of the last place below 1e-12.

    median, least: of the time in seconds; ratio: of the median over that of kurbel's own method.
    """

    quantity: str
    method: str
    points: str
    state: str
    evaluations: int
    error: float | None
    ulp: float | None
    median: float | None
    least: float | None
    ratio: float | None


class Difference(NamedTuple):
    """How much a simpler model, or wrong data, change a quantity, relatively."""

    quantity: str
    cause: str
    error: float


class Saving(NamedTuple):
    """A machine with something left out, the functions of the solver that run, and times as in `Row`."""

    machine: str
    stages: int
    median: float
    least: float
    ratio: float


# what can be examined


def questions(machine: Machine, degrees: Array, quick: bool) -> Iterator[Question | Lacking]:
    """Yield the quantities that can be examined, those of motion at crank angles, if any, and those that cannot."""
    for first in machine.cylinders[:1]:
        if why := why_no_motion(first):
            yield Lacking("x, c, b", why)
        elif len(degrees):
            for order, quantity in enumerate("xcb"):
                yield Question(
                    quantity, partial(motion, machine, degrees, order), motion_methods(degrees, order, quick)
                )
        moves = has_gas(first) or (first.masses is not None and machine.speed is not None)
        rubs = first.friction and first.friction.crosshead and first.mechanism.has_rod
        there = {"A_i": has_gas(first), "T_max, T_min": moves and first.mechanism.slides, "A_f": moves and rubs}
        asked = [quantity for quantity in there if there[quantity]]
        if asked and (why := why_no_forces(first)):
            yield Lacking("work, T, friction work", why)
        else:
            yield from (force_question(quantity, machine, quick) for quantity in asked)
    if not has_gas(*machine.cylinders):
        if machine.effort is not None:
            yield Lacking("ΔE, ω", "no independent calculation of a given turning effort")
    elif why := why_no_torque(machine):
        yield Lacking("ΔE, ω", why)
    else:
        yield force_question("ΔE", machine, quick)
        if not (why := why_no_speed(machine)):
            yield Question("ω", partial(speed_line, machine, PRECISE), speed_methods(quick))
        elif machine.flywheel is not None:
            yield Lacking("ω", why)


def has_gas(*cylinders: Cylinder) -> bool:
    """Whether a piston of these cylinders has an indicator."""
    return any(piston.indicator for cylinder in cylinders for piston in cylinder.pistons)


def why_no_motion(cylinder: Cylinder) -> str:
    """Return why there is no independent calculation of a cylinder's motion, or an empty text."""
    known = cylinder.mechanism.name in ("slider-crank", "scotch-yoke", "yoke-frame")
    return "" if known else f"no independent calculation of the {cylinder.mechanism.name}"


def why_no_forces(cylinder: Cylinder) -> str:
    """Return why there is no independent calculation of a cylinder's forces, or an empty text."""
    chambers = [chamber for piston in cylinder.pistons for chamber in piston.chambers.values()]
    rod = cylinder.masses.connecting_rod if cylinder.masses else None
    reasons = {
        "traces and ideal cards": not all(isinstance(chamber, Card) for chamber in chambers),
        "a rod given by its centre of gravity": rod is not None and rod.exact,
        "pins that rub": cylinder.friction is not None and bool(cylinder.friction.of_pins),
        "a ram force": bool(cylinder.ram_force),
    }
    found = [f"no independent calculation of {what}" for what in reasons if reasons[what]]
    return why_no_motion(cylinder) or "".join(found[:1])


def why_no_torque(machine: Machine) -> str:
    """Return why there is no independent calculation of a machine's turning effort, or an empty text."""
    if machine.efficiency != 1:
        return "no independent calculation with an efficiency"
    if machine.load and machine.load.diagram:
        return "no independent calculation of a load given by points"
    return next(filter(None, map(why_no_forces, machine.cylinders)), "")


def why_no_speed(machine: Machine) -> str:
    """Return why there is no independent speed line for a machine, or an empty text."""
    load = machine.load
    if not machine.speed or machine.flywheel is None or machine.flywheel.inertia is None:
        return "no speed, or no flywheel with its inertia given"
    if load is None or load.diagram is not None or not (load.slip or load.power):
        return "the load does not depend on the speed"
    return "no independent calculation of an elastic coupling" if machine.coupling else ""


# methods, the one of the reference among them


def divisions(quick: bool) -> tuple[int, ...]:
    """Return the divisions of a turn that equidistant methods are tried with."""
    return (36, 360, 3600) if quick else (36, 360, 3600, 100_000)


def motion(machine: Machine, degrees: Array, order: int, numbers: Numbers = PRECISE) -> Number:
    """Return x, dx/dφ or d²x/dφ², order 0 to 2, of the first cylinder in m."""
    return TextbookMotion(machine.cylinders[0].mechanism, numbers).at(numbers.of(degrees) * numbers.pi / 180)[order]


def motion_methods(degrees: Array, order: int, quick: bool) -> Iterator[Method]:
    """Yield methods for x, c or b at crank angles, order 0 to 2, as derivatives by φ in m."""

    def own(machine: Machine, _: Numbers) -> Any:
        mechanism = machine.cylinders[0].mechanism
        return (mechanism.coordinate, mechanism.slope, mechanism.curvature)[order](CrankAngle.of(degrees))

    def differences(count: int, machine: Machine, numbers: Numbers) -> Any:
        step = 360 / count
        before, at, after = (motion(machine, degrees + shift, 0, numbers) for shift in (-step, 0, step))
        return ((after - before) / 2 if order == 1 else after - 2 * at + before) / math.radians(step) ** order

    def fit(count: int, machine: Machine, numbers: Numbers) -> Any:
        x = partial(motion, machine, order=0, numbers=numbers)
        return (
            np.polynomial.Chebyshev.interpolate(x, count, (0, 360)).deriv(order)(degrees % 360)
            * math.degrees(1) ** order
        )

    yield OWN, "closed", own
    yield "textbook, radians", "closed", lambda machine, numbers: motion(machine, degrees, order, numbers)
    for count in divisions(quick) if order else ():
        yield "differences of x", str(count), partial(differences, count)
    for count in (16, 32, 64):
        yield "Chebyshev fit", str(count), partial(fit, count)


def force_question(quantity: str, machine: Machine, quick: bool) -> Question:
    """Return the question for A_i, A_f, T_max and T_min, or ΔE."""
    points = {"A_i": "closed", "A_f": "Lobatto 16", "ΔE": "closed", "T_max, T_min": "roots of T′"}[quantity]
    found: list[Method] = [(OWN, points, partial(own, quantity))]
    rules = {"A": ("trapezium rule", "Simpson's rule"), "T": ("largest ordinate",), "Δ": ("trapezium rule",)}
    for rule in rules[quantity[0]]:
        found += [(rule, str(count), partial(equidistant, quantity, rule, count)) for count in divisions(quick)]
    for count in (8, 16, 32):
        found.append(("Gauss between the corners", str(count), partial(by_pieces, quantity, gauss(count), 0)))
        found.append(("Chebyshev fit", str(count), partial(by_pieces, quantity, gauss(count), count)))
    if quantity[0] == "T":  # which needs no integrals
        found = [one for one in found if one[0] != "Gauss between the corners"]
        found.append(("roots between the corners", "24", partial(by_pieces, quantity, gauss(1), 0)))
    return Question(quantity, partial(by_pieces, quantity, precise_integrals, 0, machine, PRECISE), found)


def own(quantity: str, machine: Machine, _: Numbers) -> Any:
    """Return a quantity as kurbel computes it."""
    if quantity == "ΔE":
        return Case(machine).flywheel.dE
    forces = CylinderForces(machine, machine.cylinders[0])
    if quantity[0] == "T":
        found = forces.extremes_of("T")
        return found and (found.largest.value, found.smallest.value)
    return forces.work if quantity == "A_i" else forces.friction_work


def function_of(quantity: str, machine: Machine, numbers: Numbers, formula: str = "exact") -> tuple[Function, Array]:
    """Return what a quantity is the integral, the extremes or the swing of, and the edges of its pieces."""
    if quantity == "ΔE":
        whole = TextbookMachine(machine, numbers, formula)
        return whole.torque, whole.edges
    book = TextbookCylinder(machine, machine.cylinders[0], numbers, formula)
    return (
        book.tangential if quantity[0] == "T" else book.gas_power if quantity == "A_i" else book.friction_power
    ), book.edges


def by_pieces(quantity: str, integrals: Integrals, points: int, machine: Machine, numbers: Numbers) -> Number:
    """Return a quantity by integrals and roots between the corners; points: of a Chebyshev fit to search, or 0."""
    function, edges = function_of(quantity, machine, numbers)
    if points:
        function = fitted(function, edges, points)
    if quantity == "ΔE":
        return excess(function, edges, numbers, integrals)
    return extremes(function, edges, numbers) if quantity[0] == "T" else integrals(function, edges).sum()


def equidistant(
    quantity: str, rule: str, count: int, machine: Machine, numbers: Numbers, formula: str = "exact", **disturbed: Any
) -> Any:
    """Return a quantity from so many equal divisions of each turn; formula, disturbed: see `TextbookCylinder`."""
    function, edges = function_of(quantity, machine, numbers, formula)
    step = 2 * math.pi / count
    phi = np.arange(round((edges[-1] - edges[0]) / step)) * step
    values = function(phi, phi, **disturbed)
    if quantity[0] == "T":
        return values.max(), values.min()
    if quantity == "ΔE":
        above = values - values.mean()
        return np.ptp(np.cumsum(above + np.roll(above, -1))) / 2 * step
    return (values.sum() if rule == "trapezium rule" else (2 * values[::2].sum() + 4 * values[1::2].sum()) / 3) * step


STEP = 30
"""Degrees between the angles at which speed lines are compared."""


def speed_methods(quick: bool) -> Iterator[Method]:
    """Yield methods for ω at every 30°."""

    def own_line(machine: Machine, _: Numbers) -> Any:
        return Case(machine).flywheel.at(np.arange(STEP, 360.0 * machine.revolutions + 1, STEP)).omega

    yield OWN, "1e-13", own_line
    for steps in (360,) if quick else (360, 3600):
        yield "implicit Euler, equal steps", str(steps), partial(speed_line, count=1, steps=steps)
    for count in (4, 8, 16):
        yield "collocation between the corners", str(count), partial(speed_line, count=count)


def speed_line(machine: Machine, numbers: Numbers, count: int = 20, steps: int = 0) -> Array:
    """Return ω (n,) in rad/s at 30°, 60°, … of the cycle by collocation at so many Chebyshev nodes of each element.

    Elements lie between the corners and every 30°, or are so many equal steps a turn. Those of a reference are halved
    until floats and 14 nodes agree to 1e-12.
    """
    motor, edges = motor_of(machine, numbers)
    grid = numbers.pi * STEP / 180 * np.arange(1, 360 * machine.revolutions // STEP + 1)
    if steps:
        edges = numbers.pi * 2 / steps * np.arange(steps * machine.revolutions + 1)
    edges = merged([*edges, *grid], numbers)
    if numbers is PRECISE:
        edges = _fine_mesh(motor_of(machine, FLOATS)[0], edges)
    found, _ = periodic(motor, edges, count, numbers)
    return np.asarray(found[np.abs(edges[1:, None] - grid).argmin(axis=0)])


def _fine_mesh(motor: Motor, edges: Array) -> Array:
    """Return more edges: elements whose solution is no polynomial are halved, until ω agrees at the first edges."""
    kept = np.asarray(edges[1:], dtype=float)
    found = np.full(len(kept), math.inf)
    while len(edges) < 1000:
        floats, before = np.asarray(edges, dtype=float), found
        omega, rough = periodic(motor, floats, 14, FLOATS)
        found = omega[np.searchsorted(floats[1:], kept)]
        if not rough.any() or np.abs(found / before - 1).max() < 1e-12:
            return edges
        edges = np.sort([*edges, *within(edges)[rough, 0]])
    raise NoAnswer("the mesh of the reference of the speed line did not become fine enough")


def motor_of(machine: Machine, numbers: Numbers) -> tuple[Motor, Array]:
    """Return what accelerates the shaft of a machine, and the edges of its pieces."""
    load, wheel, whole = machine.load, machine.flywheel, TextbookMachine(machine, numbers)
    assert load
    assert wheel
    omega, integrals = (
        2 * numbers.pi * numbers.of(machine.speed),
        precise_integrals if numbers is PRECISE else gauss(24),
    )
    mean = integrals(whole.drive, whole.edges).sum() / (whole.edges[-1] - whole.edges[0])

    def torque(speed: Number) -> tuple[Number, Number]:
        if load.slip is not None:
            steepness = abs(mean) / numbers.of(load.slip) / omega
            return mean + steepness * (speed - omega), steepness + 0 * speed
        power = load.power or 0.0
        return mean * (speed / omega) ** power, mean * power / omega * (speed / omega) ** (power - 1)

    return Motor(
        whole.drive, lambda phi, at: numbers.of(wheel.inertia) + whole.inertia(phi, at), torque, omega
    ), whole.edges


# rows, and their times


def examined(machine: Machine, degrees: Array, quick: bool) -> tuple[list[Row], list[Lacking]]:
    """Return the rows of a machine, of its motion at crank angles, and what could not be examined."""
    found: list[Row] = []
    lacking: list[Lacking] = []
    for one in questions(machine, degrees, quick):
        if isinstance(one, Lacking):
            lacking.append(one)
            continue
        try:
            found += rows(one, machine, quick)
        except (NoAnswer, KurbelError) as error:
            lacking.append(Lacking(one.quantity, str(error)))
    return found, lacking


def rows(question: Question, machine: Machine, quick: bool) -> Iterator[Row]:
    """Yield the rows of one quantity, kurbel's own first. Raises NoAnswer where the reference is zero or not found."""
    with mp.workdps(DIGITS):
        reference = np.atleast_1d(np.array(question.reference(), dtype=object))
    if all(abs(truth) <= 1e-30 for truth in reference):
        raise NoAnswer("it is zero, and no error is relative to that")
    own_median = None
    for name, points, run in question.methods:
        watched, numbers, angles = counting(machine)
        try:
            error, ulp = errors(np.atleast_1d(np.asarray(run(watched, numbers), dtype=float)), reference)
        except (NoAnswer, np.linalg.LinAlgError):
            yield Row(question.quantity, name, points, "no solution", max(angles.values(), default=0), *[None] * 5)
            continue
        median, least = timed(partial(run, machine, FLOATS), quick)
        own_median = own_median or median
        state, used = "blow-up" if error is None else "ok", max(angles.values(), default=0)
        yield Row(question.quantity, name, points, state, used, error, ulp, median, least, median / own_median)


def errors(values: Array, reference: Array) -> tuple[float | None, float | None]:
    """Return the largest relative error, and the same in units of the last place where it is below 1e-12.

    Where a reference is zero, relative to the largest one. None for what is not finite.
    """
    if not np.isfinite(values).all():
        return None, None
    with mp.workdps(DIGITS):
        largest = max(map(abs, reference))
        bases = [abs(truth) if abs(truth) > 1e-30 * largest else largest for truth in reference]
        missed = [abs(float(value) - truth) for value, truth in zip(values, reference)]
        error = float(max(miss / base for miss, base in zip(missed, bases)))
        ulp = max(float(miss / math.ulp(float(base))) for miss, base in zip(missed, bases))
    return error, ulp if error < 1e-12 else None


def counting(machine: Machine) -> tuple[Machine, Numbers, Counter[str]]:
    """Return machine and numbers that count the crank angles at which motion is computed, and the counts."""
    angles: Counter[str] = Counter()

    def counted(function: Callable[[Any], Any], at: Any) -> Any:
        angles[function.__name__] += np.size(at.degrees if isinstance(at, CrankAngle) else at)
        return function(at)

    cylinders = []
    for one in machine.cylinders:
        mechanism = copy.copy(one.mechanism)
        for function in (mechanism.coordinate, mechanism.slope, mechanism.curvature):
            vars(mechanism)[function.__name__] = partial(counted, function)
        cylinders.append(replace(one, mechanism=mechanism))
    return replace(machine, cylinders=tuple(cylinders)), FLOATS._replace(sin=partial(counted, np.sin)), angles


def timed(run: Callable[[], Any], quick: bool) -> tuple[float, float]:
    """Return the median and the least time in seconds of 20 runs, or those of half a second (quick: 5, a tenth)."""
    times: list[float] = []
    while not times or (len(times) < (5 if quick else 20) and sum(times) < (0.1 if quick else 0.5)):
        begin = time.perf_counter()
        run()
        times.append(time.perf_counter() - begin)
    return statistics.median(times), min(times)


def better(found: list[Row]) -> list[Row]:
    """Return the rows more exact and faster than kurbel's own, by more than 16 roundings and a fifth of the time."""
    kurbels = {row.quantity: row for row in found if row.method == OWN}
    return [
        row
        for row in found
        if row.error is not None
        and row.error < (kurbels[row.quantity].error or 0.0) - 16 * 2.0**-53
        and (row.least or 0.0) < 0.8 * (kurbels[row.quantity].least or 0.0)
    ]


# errors of model and data, and what leaving out saves


def model_errors(machine: Machine) -> Iterator[Difference]:
    """Yield what the book's approximations change in the first cylinder and in the machine."""
    if not machine.cylinders or why_no_motion(machine.cylinders[0]):
        return
    first, causes = machine.cylinders[0], {}
    if not math.isinf(first.mechanism.rod_length):
        causes = {"first-order formulas": (machine, "first-order"), "infinite rod": (machine, "infinite")}
    phi = np.radians(np.arange(361.0))
    formulas = ("exact", *(formula for _, formula in causes.values()))
    exact, *others = (TextbookMotion(first.mechanism, FLOATS, formula).at(phi) for formula in formulas)
    for order, quantity in enumerate("xcb"):
        for cause, other in zip(causes, others):
            missed = np.abs(other[order] - exact[order]).max()
            yield Difference(quantity, cause, float(missed / np.abs(exact[order]).max()))
    if machine.speed and any(cylinder.masses for cylinder in machine.cylinders):
        causes["inertia left out"] = lighter(machine, masses=None, inclination=None), "exact"
    if has_gas(first) and not any(map(why_no_forces, machine.cylinders)):
        whole = sampled(machine)
        for cause, (simpler, formula) in causes.items():
            yield from (one for one in changes(whole, sampled(simpler, formula), cause) if one.quantity != "A_i")
    yield from _of_friction(machine, first)


def _of_friction(machine: Machine, cylinder: Cylinder) -> Iterator[Difference]:
    """Yield Redtenbacher's means over the rod angle against each other, and against the work truly lost."""
    lam, f = cylinder.mechanism.lam, cylinder.friction.crosshead if cylinder.friction else None
    if not f or not lam or cylinder.mechanism.offset:
        return
    mean = mean_friction_over_rod_angle(math.asin(lam), f)
    yield Difference("F_m", "Redtenbacher's logarithm, D 5", abs(redtenbacher_logarithm(lam, f) / mean - 1))
    yield Difference("F_m", "Redtenbacher's ½ λ f, D 6", abs(redtenbacher_loss(lam, f) / mean - 1))
    if loss := share_of_driving(CylinderForces(machine, cylinder), "crosshead"):
        yield Difference("e_K", "½ λ f for the work lost, D 7", abs(redtenbacher_loss(lam, f) / loss - 1))


def data_errors(machine: Machine) -> Iterator[Difference]:
    """Yield what 0.1° of dead centre and 0.5 % noise of the pressure change, with a sample every 0.1°.

    Noise: the standard deviation over 20 draws, the same in every run.
    """
    if not has_gas(*machine.cylinders[:1]) or any(map(why_no_forces, machine.cylinders)):
        return
    whole = sampled(machine)
    yield from changes(whole, sampled(machine, shift=math.radians(0.1)), "dead centre 0.1° late")
    draws = [sampled(machine, noise=_noise(np.random.default_rng(seed))) for seed in range(20)]
    spread = {
        quantity: value + math.sqrt(statistics.fmean((draw[quantity] - value) ** 2 for draw in draws))
        for quantity, value in whole.items()
    }
    yield from changes(whole, spread, "noise 0.5% of the pressure")


def _noise(random: np.random.Generator) -> Callable[[Array], Array]:
    return lambda pressure: random.normal(0.0, 0.005 * float(np.abs(pressure).max()), pressure.shape)


def sampled(machine: Machine, formula: str = "exact", **disturbed: Any) -> dict[str, float]:
    """Return A_i, T_max and ΔE from a sample every 0.1°."""
    return {
        quantity: float(np.max(equidistant(quantity, "trapezium rule", 3600, machine, FLOATS, formula, **disturbed)))
        for quantity in ("A_i", "T_max", "ΔE")
    }


def changes(whole: dict[str, float], other: dict[str, float], cause: str) -> Iterator[Difference]:
    """Yield relative differences, none of a quantity that is but a rounding of zero relative to the largest torque."""
    for quantity, value in whole.items():
        if abs(value) > 1e-12 * max(map(abs, whole.values())):
            yield Difference(quantity, cause, abs(other[quantity] / value - 1))


def lighter(machine: Machine, **less: Any) -> Machine:
    """Return the machine with something left out of all cylinders."""
    return replace(machine, cylinders=tuple(replace(one, **less) for one in machine.cylinders), limits=())


def savings(machine: Machine, answers: Callable[[Machine], Any], quick: bool) -> Iterator[Saving]:
    """Yield the whole machine, and the same without friction, masses, cards and speed, one after another.

    answers: computes all that a command prints.
    """
    stages = {"everything": machine}
    if any(one.friction for one in machine.cylinders):
        machine = stages["no friction"] = lighter(machine, friction=None)
    if any(one.masses or one.inclination for one in machine.cylinders):
        machine = stages["no masses either"] = lighter(machine, masses=None, inclination=None)
    if any(one.pistons for one in machine.cylinders):
        machine = stages["no cards either: motion alone"] = lighter(machine, pistons=())
    if machine.speed is not None:
        stages["no speed either: positions alone"] = replace(machine, speed=None)
    whole = None
    for name, one in stages.items():
        count = functions_run(partial(answers, one))
        median, least = timed(partial(answers, one), quick)
        whole = whole or median
        yield Saving(name, count, median, least, median / whole)


def functions_run(run: Callable[[], Any]) -> int:
    """Count the functions of the solver that run."""
    seen = set()

    def watch(frame: FrameType, event: str, _: Any) -> None:
        if event == "call" and frame.f_globals.get("__name__", "").startswith("kurbel.solver"):
            seen.add(frame.f_code)

    before = sys.getprofile()
    sys.setprofile(watch)
    try:
        run()
    finally:
        sys.setprofile(before)
    return len(seen)
