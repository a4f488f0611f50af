"""What `kurbel accuracy` measures on a machine: methods by error and time, errors of model and data, what is saved."""

import math
import statistics
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from types import FrameType
from typing import Any, NamedTuple, TypeVar, Union

import numpy as np
from numpy.polynomial import chebyshev

from kurbel import crank_formulas
from kurbel.accuracy.textbook import DIGITS, Number, Stance, TextbookMotion, mp, mpf, reference, stance
from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.errors import KurbelError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Card
from kurbel.machine.parts import GasOnRings
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces

OWN = "kurbel"
Found = Union[float, tuple[float, float], Array, None]
"""What a method computes: one value, the largest and the smallest, or (n,); None for what a machine does not have."""
Method = tuple[str, str, Callable[[], Found]]
"""Name, how finely, and what computes the values."""
Function = Callable[[Array, Array], Array]
"""Takes angles (n,) in degrees, and for each one within its piece."""
Rival = Callable[[str, Function, Array, int], Found]
"""Takes a quantity, what it is computed from, the edges of its pieces in degrees, and how finely."""
T = TypeVar("T")


class Zero(Exception):
    """A reference is zero, and no error is relative to that."""


class Trial(NamedTuple):
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
    median: float
    least: float
    ratio: float


class Difference(NamedTuple):
    """How much a simpler model, or wrong data, change a quantity, relatively."""

    quantity: str
    cause: str
    error: float


class Saving(NamedTuple):
    """A machine with something left out; stages: functions of the solver that run for it; times as in `Trial`."""

    machine: str
    stages: int
    median: float
    least: float
    ratio: float


# what can be examined


def examined(machine: Machine, degrees: Array, quick: bool) -> tuple[list[Trial], list[tuple[str, str]]]:
    """Return the trials of a machine, with its motion at these crank angles, and (quantity, why) for omitted ones."""
    rows: list[Trial] = []
    lacking: list[tuple[str, str]] = []
    with mp.workdps(DIGITS):
        for quantity, why in _quantities(machine):
            try:
                if why:
                    lacking.append((quantity, why))
                elif quantity not in "xcb":
                    truth, edges = reference(machine, quantity)
                    rows += rows_of(quantity, truth, force_methods(quantity, machine, edges, quick), quick)
                elif len(degrees):
                    book, order = TextbookMotion(machine.cylinders[0].mechanism), "xcb".index(quantity)
                    truth = [book.at(mp.radians(mpf(float(one))))[order] for one in degrees]
                    rows += rows_of(quantity, truth, motion_methods(machine, degrees, order), quick)
            except KurbelError as error:
                lacking.append((quantity, str(error)))
            except Zero:
                lacking.append((quantity, "it is zero, and no error is relative to that"))
    return rows, lacking


def _quantities(machine: Machine) -> Iterator[tuple[str, str]]:
    """Yield the quantities that a machine has, and why one of them has no reference, or an empty text."""
    for first in machine.cylinders[:1]:
        if why := _motion_lacks(first):
            yield "x, c, b", why
        else:
            yield from ((quantity, "") for quantity in "xcb")
        moves = has_gas(first) or (first.masses is not None and machine.speed is not None)
        rubs = first.friction and first.friction.crosshead and first.mechanism.has_rod
        there = {"A_i": has_gas(first), "T_max, T_min": moves and first.mechanism.slides, "A_f": moves and rubs}
        if any(there.values()) and (why := _forces_lack(first)):
            yield "work, T, friction work", why
        else:
            yield from ((quantity, "") for quantity in there if there[quantity])
    if has_gas(*machine.cylinders):
        why = next(filter(None, map(_forces_lack, machine.cylinders)), "")
        if machine.efficiency != 1:
            why = "no independent calculation with an efficiency"
        elif machine.load and machine.load.diagram:
            why = "no independent calculation of a load given by points"
        yield "ΔE", why
    elif machine.effort is not None:
        yield "ΔE", "no independent calculation of a given turning effort"


def has_gas(*cylinders: Cylinder) -> bool:
    """Whether a piston of these cylinders has an indicator."""
    return any(piston.indicator for cylinder in cylinders for piston in cylinder.pistons)


def _motion_lacks(cylinder: Cylinder) -> str:
    known = cylinder.mechanism.name in ("slider-crank", "scotch-yoke", "yoke-frame")
    return "" if known else f"no independent calculation of the {cylinder.mechanism.name}"


def _forces_lack(cylinder: Cylinder) -> str:
    """Return why there is no independent calculation of a cylinder's forces, or an empty text."""
    chambers = [chamber for piston in cylinder.pistons for chamber in piston.chambers.values()]
    rod = cylinder.masses.connecting_rod if cylinder.masses else None
    rubbing = cylinder.friction
    rings = rubbing.rings if rubbing else None
    reasons = {
        "traces and ideal cards": not all(isinstance(chamber, Card) for chamber in chambers),
        "a rod given by its centre of gravity": rod is not None and rod.exact,
        "pins that rub": rubbing is not None and bool(rubbing.of_pins),
        "a yoke that rubs": rubbing is not None and (rubbing.block is not None or rubbing.guides is not None),
        "rings that the gas presses": rings is not None and isinstance(rings.pressure, GasOnRings),
        "a ram force": bool(cylinder.ram_force),
    }
    found = [f"no independent calculation of {what}" for what in reasons if reasons[what]]
    return _motion_lacks(cylinder) or "".join(found[:1])


# methods: kurbel's own first


def motion_methods(machine: Machine, degrees: Array, order: int) -> Iterator[Method]:
    """Yield methods for x, c or b at crank angles, order 0 to 2, as derivatives by φ in m."""
    mechanism = machine.cylinders[0].mechanism

    def book(at: Array) -> Stance:
        phi = np.radians(at)
        return stance(mechanism.crank, mechanism.rod_length, mechanism.offset, np.sin(phi), np.cos(phi), np.sqrt)

    def fit(count: int) -> Array:
        series = np.polynomial.Chebyshev.interpolate(lambda at: book(at).x, count, (0, 360)).deriv(order)
        return np.asarray(series(degrees % 360) * math.degrees(1) ** order)

    own = (mechanism.coordinate, mechanism.slope, mechanism.curvature)[order]
    yield OWN, "closed", lambda: own(CrankAngle.of(degrees))
    yield "textbook, radians", "closed", lambda: book(degrees)[order]
    for count in (16, 32, 64):
        yield "Chebyshev fit", str(count), partial(fit, count)


def force_methods(quantity: str, machine: Machine, corners: Sequence[Number], quick: bool) -> Iterator[Method]:
    """Yield methods for A_i, A_f, T_max and T_min, or ΔE; all but kurbel's own know the corners, and sample columns."""
    edges = np.degrees(np.array(corners, dtype=float))

    def own() -> Any:
        case = Case(machine)
        if quantity == "ΔE":
            return case.flywheel.dE
        forces = case.cylinders[0]
        if quantity[0] == "T":
            found = forces.extremes_of("T")
            return found and (found.largest.value, found.smallest.value)
        return forces.work if quantity == "A_i" else forces.friction_work

    points = {"A_i": "closed", "A_f": "Lobatto 16", "ΔE": "closed", "T_max, T_min": "roots of T′"}[quantity]
    yield OWN, points, own
    rule, between = ("largest ordinate", "roots") if quantity[0] == "T" else ("trapezium rule", "Gauss")
    tries = [(rule, equidistant, count) for count in ((36, 360, 3600) if quick else (36, 360, 3600, 100_000))]
    for count in (8, 16, 32):
        tries += [(f"{between} between the corners", by_gauss, count), ("Chebyshev fit", by_fit, count)]
    for name, method, count in tries:
        yield name, str(count), partial(_sampled, method, quantity, machine, edges, count)


def _sampled(method: Rival, quantity: str, machine: Machine, edges: Array, count: int) -> Found:
    return method(quantity, sampler(quantity, machine), edges, count)


def sampler(quantity: str, machine: Machine) -> Function:
    """Return what a quantity is the integral over radians, the extremes or the swing of, from columns of kurbel."""
    cylinders = machine.cylinders if quantity == "ΔE" else machine.cylinders[:1]
    forces = [(CylinderForces(machine, one), one.crank_position) for one in cylinders]

    def function(degrees: Array, within: Array) -> Array:
        if quantity == "ΔE":
            return np.asarray(sum(one.at(degrees - place, within - place).M for one, place in forces))
        state = forces[0][0].at(degrees, within)
        if quantity[0] == "T":
            return np.asarray(state.T)
        return np.asarray(state.slope * (state.P_gas if quantity == "A_i" else -state.F_friction))

    return function


def equidistant(quantity: str, function: Function, edges: Array, count: int) -> Found:
    """Return a quantity from so many equal divisions of each turn: by the trapezium rule, or the largest ordinates."""
    phi = np.arange(round((edges[-1] - edges[0]) * count / 360)) * (360 / count)
    values, step = function(phi, phi), 2 * math.pi / count
    if quantity[0] == "T":
        return values.max(), values.min()
    return _swing(values) * step if quantity == "ΔE" else values.sum() * step


def _swing(values: Array) -> float:
    """Return the largest swing of the running sum of equidistant values above their mean, by trapezia of width 1."""
    above = values - values.mean()
    return float(np.ptp(np.cumsum(above + np.roll(above, -1)))) / 2


def _on(function: Function, edges: Array, shares: Array) -> Array:
    """Return the values (n, m) at shares (m,) of the width of each of n pieces."""
    widths, middles = np.diff(edges)[:, None], (edges[1:] + edges[:-1])[:, None] / 2
    phi = edges[:-1, None] + widths * shares
    return function(phi.ravel(), np.broadcast_to(middles, phi.shape).ravel()).reshape(phi.shape)


def by_gauss(quantity: str, function: Function, edges: Array, count: int) -> Found:
    """Return a quantity by Gauss's rule on each piece, and roots looked for at as many steps."""
    nodes, weights = np.polynomial.legendre.leggauss(count)

    def integrals(edges: Array) -> Array:
        return np.asarray(_on(function, edges, (1 + nodes) / 2) @ weights * np.radians(np.diff(edges)) / 2)

    if quantity[0] == "A":
        return float(integrals(edges).sum())
    if quantity[0] == "T":
        step = 1e-4
        tops, within = float_roots(lambda phi, at: function(phi + step, at) - function(phi - step, at), edges, count)
        values = np.append(_on(function, edges, np.array([0.0, 1.0])).ravel(), function(tops, within))
        return values.max(), values.min()
    mean = integrals(edges).sum() / np.radians(edges[-1] - edges[0])
    crossings, _ = float_roots(lambda phi, at: function(phi, at) - mean, edges, count)
    cuts = np.unique([*edges, *crossings])
    return float(np.ptp(np.append(0.0, np.cumsum(integrals(cuts) - mean * np.radians(np.diff(cuts))))))


def float_roots(function: Function, edges: Array, parts: int) -> tuple[Array, Array]:
    """Return the roots inside the pieces (m,), looked for at equal steps, and the middle of the piece of each.

    False position, with a halving after every two steps, so that no bend of the function holds it up.
    """
    shares = np.arange(parts + 1) / parts
    at, values = edges[:-1, None] + np.diff(edges)[:, None] * shares, _on(function, edges, shares)
    piece, step = np.nonzero((values[:, :-1] > 0) != (values[:, 1:] > 0))
    within = (edges[piece] + edges[piece + 1]) / 2
    low, high, f_low, f_high = at[piece, step], at[piece, step + 1], values[piece, step], values[piece, step + 1]
    for count in range(60):
        found = (low + high) / 2 if count % 3 == 2 else (low * f_high - high * f_low) / (f_high - f_low)
        f_found = function(found, within)
        left = (f_found > 0) == (f_low > 0)
        low, f_low = np.where(left, found, low), np.where(left, f_found, f_low)
        high, f_high = np.where(left, high, found), np.where(left, f_high, f_found)
        if not (high - low > 1e-13 * np.abs(found)).any():
            break
    return np.asarray(found), np.asarray(within)


def by_fit(quantity: str, function: Function, edges: Array, count: int) -> Found:
    """Return a quantity from the polynomial through so many values on each piece, at the zeros of Chebyshev's."""
    nodes = chebyshev.chebpts1(count)
    fits = chebyshev.chebfit(nodes, _on(function, edges, (1 + nodes) / 2).T, count - 1).T
    halves, heights = np.radians(np.diff(edges)) / 2, [0.0]

    def inside(series: Array) -> list[float]:
        found = chebyshev.chebroots(series)
        return [float(root.real) for root in found if abs(root.imag) < 1e-9 and abs(root.real) < 1]

    if quantity[0] == "T":
        values = [chebyshev.chebval([-1.0, 1.0, *inside(chebyshev.chebder(series))], series) for series in fits]
        return max(map(max, values)), min(map(min, values))
    whole = [half * np.diff(chebyshev.chebval([-1, 1], chebyshev.chebint(fit)))[0] for fit, half in zip(fits, halves)]
    if quantity[0] == "A":
        return float(sum(whole))
    fits[:, 0] -= sum(whole) / (2 * halves.sum())
    for fit, half in zip(fits, halves):
        start, *sums = chebyshev.chebval([-1.0, *sorted(inside(fit)), 1.0], chebyshev.chebint(fit))
        heights += [heights[-1] + half * (one - start) for one in sums]
    return max(heights) - min(heights)


# rows, and their times


def rows_of(quantity: str, truth: Number | list[Number], methods: Iterator[Method], quick: bool) -> Iterator[Trial]:
    """Yield the rows of one quantity, kurbel's own first. Raises Zero."""
    reference = np.atleast_1d(np.array(truth, dtype=object))
    if all(abs(one) <= 1e-30 for one in reference):
        raise Zero
    own_median = None
    for name, points, run in methods:
        values, _, evaluations = watched(run)
        error, ulp = errors(np.atleast_1d(np.asarray(values, dtype=float)), reference)
        median, least = timed(run, quick)
        own_median = own_median or median
        state = "blow-up" if error is None else "ok"
        yield Trial(quantity, name, points, state, evaluations, error, ulp, median, least, median / own_median)


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


def timed(run: Callable[[], object], quick: bool) -> tuple[float, float]:
    """Return the median and the least time in seconds of 20 runs, or those of half a second (quick: 5, a tenth)."""
    times: list[float] = []
    while not times or (len(times) < (5 if quick else 20) and sum(times) < (0.1 if quick else 0.5)):
        begin = time.perf_counter()
        run()
        times.append(time.perf_counter() - begin)
    return statistics.median(times), min(times)


def watched(run: Callable[[], T]) -> tuple[T, int, int]:
    """Return what a computation gives, how many functions of the solver run, and of how many crank angles."""
    functions, evaluations = set(), 0

    def watch(frame: FrameType, event: str, result: object) -> None:
        nonlocal evaluations
        if event == "call" and frame.f_globals.get("__name__", "").startswith("kurbel.solver"):
            functions.add(frame.f_code)
        elif event == "return" and frame.f_code.co_name in ("of", "at_nodes", "stance"):
            evaluations += np.size(result[1]) if isinstance(result, (CrankAngle, Stance)) else 0

    before = sys.getprofile()
    sys.setprofile(watch)
    try:
        return run(), len(functions), evaluations
    finally:
        sys.setprofile(before)


def better(found: list[Trial]) -> list[Trial]:
    """Return the rows more exact and faster than kurbel's own, by more than 16 roundings and a fifth of the time."""
    own = {row.quantity: row for row in found if row.method == OWN}
    return [
        row
        for row in found
        if row.error is not None
        and row.error < (own[row.quantity].error or 0.0) - 16 * 2.0**-53
        and row.least < 0.8 * own[row.quantity].least
    ]


# errors of model and data: what a simpler machine, or other pressures, would give


def model_errors(machine: Machine) -> Iterator[Difference]:
    """Yield what the book's approximations change in the motion of the first cylinder, in T_max and in ΔE."""
    if not machine.cylinders or _motion_lacks(machine.cylinders[0]):
        return
    simpler, exact = {}, machine.cylinders[0].mechanism
    if not math.isinf(exact.rod_length):
        if all(one.mechanism.name == "slider-crank" for one in machine.cylinders):
            rodless = (replace(one, mechanism=SliderCrank(one.mechanism.crank, math.inf)) for one in machine.cylinders)
            simpler["infinite rod"] = replace(machine, cylinders=tuple(rodless), limits=())
        angle = CrankAngle.of(np.arange(361.0))
        book = (
            (exact.coordinate, crank_formulas.first_order_displacement),
            (exact.slope, crank_formulas.first_order_velocity),
            (exact.curvature, crank_formulas.first_order_acceleration),
        )
        for quantity, (function, formula) in zip("xcb", book):
            truth = function(angle)
            for cause, lam in (("first-order formulas", exact.lam), ("infinite rod", 0.0)):
                missed = np.abs(exact.crank * formula(angle.sin, angle.cos, lam) - truth)
                yield Difference(quantity, cause, float(missed.max() / np.abs(truth).max()))
    if machine.speed and any(cylinder.masses for cylinder in machine.cylinders):
        massless = (replace(one, masses=None, inclination=None) for one in machine.cylinders)
        simpler["inertia left out"] = replace(machine, cylinders=tuple(massless), limits=())
    if has_gas(machine.cylinders[0]):
        for cause, other in simpler.items():
            yield from _changes(_torques(machine), _torques(other), cause)


def _torques(machine: Machine) -> dict[str, float]:
    """Return T_max of the first cylinder and ΔE."""
    case = Case(machine)
    found = case.cylinders[0].extremes_of("T")
    return {"T_max": found.largest.value if found else 0.0, "ΔE": case.flywheel.dE or 0.0}


def data_errors(machine: Machine) -> Iterator[Difference]:
    """Yield what 0.1° of dead centre and 0.5 % noise of the gas force change, with a sample every 0.1°.

    The friction is left as it is. Noise: the standard deviation over 20 draws, the same in every run.
    """
    if not has_gas(*machine.cylinders[:1]):
        return
    case, step = Case(machine), 0.1
    phi = np.arange(0.0, 360.0 * machine.revolutions, step)
    places = [phi - one.crank_position for one in machine.cylinders]
    states = [forces.at(place) for forces, place in zip(case.cylinders, places)]
    gas = [np.zeros_like(phi) if state.P_gas is None else state.P_gas for state in states]
    first, torque, crank = states[0], case.flywheel.at(phi).M, machine.cylinders[0].mechanism.crank

    def answers(changes: Sequence[Array]) -> dict[str, float]:
        found = {"A_i": float((first.slope * (gas[0] + changes[0])).sum()) * math.radians(step)}
        if first.T is not None:
            found["T_max"] = float((first.T + changes[0] * first.slope / crank).max())
        total = torque + sum(change * state.slope for change, state in zip(changes, states))
        return found | {"ΔE": _swing(total) * math.radians(step)}

    whole = answers([0 * force for force in gas])
    late = [forces.at(place - 0.1).P_gas for forces, place in zip(case.cylinders, places)]
    shifts = [0 * force if other is None else other - force for force, other in zip(gas, late)]
    yield from _changes(whole, answers(shifts), "dead centre 0.1° late")
    draws = []
    for seed in range(20):
        random = np.random.default_rng(seed)
        draws.append(answers([random.normal(0.0, 0.005 * float(np.abs(force).max()), len(phi)) for force in gas]))
    noisy = {
        quantity: value + math.sqrt(statistics.fmean((draw[quantity] - value) ** 2 for draw in draws))
        for quantity, value in whole.items()
    }
    yield from _changes(whole, noisy, "noise 0.5% of the gas force")


def _changes(whole: dict[str, float], other: dict[str, float], cause: str) -> Iterator[Difference]:
    """Yield relative differences, none of a quantity that is but a rounding of zero relative to the largest torque."""
    for quantity, value in whole.items():
        if abs(value) > 1e-12 * max(map(abs, whole.values())):
            yield Difference(quantity, cause, abs(other[quantity] / value - 1))


# what leaving out saves


def savings(machine: Machine, compute: Callable[[Machine], object], quick: bool) -> Iterator[Saving]:
    """Yield the whole machine, and the same without friction, masses, cards and speed, one after another.

    compute: all that a command prints.
    """
    stages, every = {"everything": machine}, machine.cylinders
    less: tuple[tuple[str, bool, dict[str, Any]], ...] = (
        ("no friction", any(one.friction for one in every), {"friction": None}),
        ("no masses either", any(one.masses for one in every), {"masses": None, "inclination": None}),
        ("no cards either: motion alone", any(one.pistons for one in every), {"pistons": ()}),
    )
    for name, given, change in less:
        if given:
            lighter = (replace(one, **change) for one in machine.cylinders)
            machine = stages[name] = replace(machine, cylinders=tuple(lighter), limits=())
    if machine.speed is not None:
        stages["no speed either: positions alone"] = replace(machine, speed=None)
    whole = None
    for name, one in stages.items():
        _, count, _ = watched(partial(compute, one))
        median, least = timed(partial(compute, one), quick)
        whole = whole or median
        yield Saving(name, count, median, least, median / whole)
