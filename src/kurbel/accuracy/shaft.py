"""The periodic speed of the shaft: collocation in mpmath's numbers, which shares nothing with the solver.

    w = ω/ω_n − 1     of a rigid shaft  r = (1 + w)² − 1 = z/(½ J(φ) ω_n²)     w = r/(1 + √(1 + r))

    rigid       z′ = M − M_load(w)                    z: kinetic energy beyond that of uniform rotation
    elastic     J₁ ω_n² w₁′ = M − T                   T = k ϑ + d ω_n (w₁ − w₂)
                J₂ ω_n² w₂′ = T − M_load(w₂)
                ϑ′ = w₁ − w₂

M is the torque at uniform rotation. A load that does not depend on the speed leaves its level free: then the mean of
ω_n/ω is 1, or with an elastic coupling that of w is 0. With an elastic coupling J₁ has the mean of the moving masses,
and time runs as at uniform rotation: the model of the solver. Primes are derivatives by φ in radians. Formulas have + − × ÷ and powers
only: they take floats, arrays and mpmath's numbers alike.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from functools import cache, cached_property
from typing import NamedTuple, Union

import numpy as np
from numpy.polynomial import chebyshev

from kurbel.accuracy.methods import Precise, integrals, largest_and_smallest, merged, mp, mpf
from kurbel.accuracy.references import Textbook, TextbookMachine, needed, unknown
from kurbel.accuracy.textbook import DIGITS, STEPS
from kurbel.arrays import Array
from kurbel.machine import Machine

EVERY = 30
"""Degrees between the crank angles at which ω is compared."""
_FIT = 24
"""Terms of the polynomials through torque and inertia, on pieces of at most 45°: as exact as floats."""
MOST = 200
"""Elements after which a solution counts as not resolved, for a machine of which the report is wanted at once."""


def without_reference(machine: Machine) -> Iterator[str]:
    """Yield why the speed of a machine has no independent calculation here."""
    wheel = machine.flywheel
    if not machine.speed or wheel is None or wheel.inertia is None:
        yield "there is no speed line without a speed, and a flywheel with an inertia"
    for obstacle in unknown(machine, "ΔE"):
        yield f"no independent calculation of {obstacle}"
    if machine.efficiency != 1:
        yield "no independent calculation of an efficiency"


class SpeedOfShaft(NamedTuple):
    """What is compared: ω in rad/s every 30° (n,), δ, ω_max, and the largest and smallest torque in a coupling."""

    omega: Array
    delta: Precise
    omega_max: Precise
    M_K: tuple[Precise, ...]


# the equations


class LoadLaw(NamedTuple):
    """The load torque in N m over w, by slip s or power k, 0 where it is constant; mean: at the nominal speed."""

    mean: Precise
    slip: float | None = None
    power: float = 0.0

    @property
    def is_constant(self) -> bool:
        """Whether it does not depend on the speed."""
        return self.slip is None and self.power == 0

    def torque(self, w: Precise) -> Precise:
        """Return M_load."""
        if self.slip is not None:
            return self.mean + abs(self.mean) / self.slip * w
        return self.mean * (1 + w) ** self.power

    def slope(self, w: Precise) -> Precise:
        """Return dM_load/dw."""
        if self.slip is not None:
            return abs(self.mean) / self.slip + 0 * w
        return self.mean * self.power * (1 + w) ** (self.power - 1)


class RigidShaft(NamedTuple):
    """y = (z,) in J; torque M in N m, and energy ½ J(φ) ω_n² in J; nominal: ω_n in rad/s."""

    load: LoadLaw
    nominal: Precise
    unknowns: int = 1

    def start(self, energy: Precise) -> list[Precise]:
        """Return y at uniform rotation."""
        return [0 * energy]

    def speed(self, energy: Precise, y: Sequence[Precise]) -> Precise:
        """Return w."""
        r = y[0] / energy
        return r / (1 + (1 + r) ** 0.5)

    def runs(self, energy: float, y: Sequence[float]) -> bool:
        """Return whether the shaft has kinetic energy, and not beyond all bounds."""
        return -1 < y[0] / energy < 1e12

    def rate(self, torque: Precise, energy: Precise, y: Sequence[Precise]) -> list[Precise]:
        """Return y′."""
        return [torque - self.load.torque(self.speed(energy, y))]

    def slopes(self, torque: Precise, energy: Precise, y: Sequence[Precise]) -> list[list[Precise]]:
        """Return the derivatives of y′ by y; dw/dz = 1/(J ω_n² (1 + w))."""
        w = self.speed(energy, y)
        return [[-self.load.slope(w) / (2 * energy * (1 + w))]]

    def leveled(self, energy: Array, y: Array, weights: Array) -> Array:
        """Return y plus the constant that makes the mean of ω_n/ω 1, by Newton's method; weights: of the mean.

        Raises ArithmeticError where the shaft would stop.
        """
        z = y[0]
        finest = 1e-32 if z.dtype == object else 1e-16
        swing = float(z.max() - z.min())
        for _ in range(80):
            r = z / energy
            if not bool((r > -1).all()):
                break
            slowness = (1 + r) ** -0.5
            excess = ((slowness - 1) * weights).sum()
            slope = (slowness**3 / energy * weights).sum() / 2
            step = excess / slope
            z = z + step
            if abs(float(step)) <= finest * swing:
                return z[np.newaxis]
        raise ArithmeticError("no level of the speed has the nominal mean")


class ElasticShaft(NamedTuple):
    """y = (ϑ in rad, w₁, w₂); stiffness in N m/rad, damping in N m s/rad, first, second: J₁ ω_n² and J₂ ω_n² in J."""

    load: LoadLaw
    nominal: Precise
    stiffness: Precise
    damping: Precise
    first: Precise
    second: Precise
    unknowns: int = 3

    def start(self, energy: Precise) -> list[Precise]:
        """Return the twist by the mean torque, without vibration."""
        still = 0 * energy
        return [self.load.mean / self.stiffness + still, still, still]

    def speed(self, energy: Precise, y: Sequence[Precise]) -> Precise:
        """Return w₁."""
        return y[1]

    def runs(self, energy: float, y: Sequence[float]) -> bool:
        """Return whether both masses turn forward, and not beyond all bounds."""
        return -1 < y[1] < 1e6 and -1 < y[2] < 1e6

    def torque(self, y: Sequence[Precise]) -> Precise:
        """Return T in N m."""
        return self.stiffness * y[0] + self.damping * self.nominal * (y[1] - y[2])

    def rate(self, torque: Precise, energy: Precise, y: Sequence[Precise]) -> list[Precise]:
        """Return y′."""
        passed = self.torque(y)
        return [
            y[1] - y[2],
            (torque - passed) / self.first,
            (passed - self.load.torque(y[2])) / self.second,
        ]

    def slopes(self, torque: Precise, energy: Precise, y: Sequence[Precise]) -> list[list[Precise]]:
        """Return the derivatives of y′ by y."""
        k = self.stiffness
        d = self.damping * self.nominal
        rise = self.load.slope(y[2])
        return [
            [0.0, 1.0, -1.0],
            [-k / self.first, -d / self.first, d / self.first],
            [k / self.second, d / self.second, -(d + rise) / self.second],
        ]

    def leveled(self, energy: Array, y: Array, weights: Array) -> Array:
        """Return y with speeds whose mean is nominal; weights: of the mean."""
        mean = (y[1] * weights).sum()
        return np.stack((y[0], y[1] - mean, y[2] - mean))


ShaftEquation = Union[RigidShaft, ElasticShaft]
"""y′ = rate(torque, energy, y) of unknowns y."""


def equation_in_floats(equation: ShaftEquation) -> ShaftEquation:
    """Return an equation with floats for mpmath's numbers."""
    load = equation.load._replace(mean=float(equation.load.mean))
    nominal = float(equation.nominal)
    if isinstance(equation, RigidShaft):
        return RigidShaft(load, nominal)
    springs = float(equation.stiffness), float(equation.damping)
    return ElasticShaft(load, nominal, *springs, float(equation.first), float(equation.second))


# the torque of the textbook


class Fits:
    """Torque and inertia as polynomials in floats, on pieces between edges (n + 1,) in degrees, which repeat."""

    def __init__(self, edges: Array, series: Array) -> None:
        self.edges = edges
        self.series = series

    def at(self, phi: Array, within: Array) -> Array:
        """Return both (2, …) at angles in degrees; within: any angle of the same piece."""
        piece = np.searchsorted(self.edges, within, side="right") - 1
        low = self.edges[piece]
        high = self.edges[piece + 1]
        shares = (2 * phi - low - high) / (high - low)
        return np.stack(
            [chebyshev.chebval(shares, terms[:, piece], tensor=False) for terms in self.series]
        )


class TextbookShaft:
    """Equation and torque of a machine; edges: in degrees, between which the torque is smooth."""

    def __init__(self, textbook: Textbook) -> None:
        machine = textbook.machine
        assert machine.speed is not None
        assert machine.flywheel is not None
        self._book = TextbookMachine(textbook, "ΔE")
        self.cycle = 360 * machine.revolutions
        self.nominal = 2 * mp.pi * mpf(machine.speed)
        self._rigid = mpf(machine.flywheel.inertia)
        starts = [mpf(angle) for angle in range(0, self.cycle + 1, EVERY)]
        self.edges = merged(np.append(self._book.edges, starts))

        # the equation
        mean = self._mean(self._torque)
        load = LoadLaw(mean)
        if machine.load is not None:
            load = LoadLaw(mean, machine.load.slip, machine.load.power or 0.0)
        self.equation: ShaftEquation = RigidShaft(load, self.nominal)
        if machine.coupling is not None:
            coupling = machine.coupling
            square = self.nominal**2
            first = self._mean(self._inertia) * square
            second = mpf(coupling.inertia) * square
            springs = mpf(coupling.stiffness), mpf(coupling.damping)
            self.equation = ElasticShaft(load, self.nominal, *springs, first, second)

    def _mean(self, function: Callable[[Precise, Precise], Precise]) -> Precise:
        """Return the mean of a function over the cycle."""
        areas = integrals(np.frompyfunc(function, 2, 1), self.edges, STEPS)
        return areas.sum() / self.cycle

    def _torque(self, phi: Precise, within: Precise) -> Precise:
        """Return M in N m at an angle in degrees."""
        return needed("ΔE", self._book.addends, phi, within)

    def _inertia(self, phi: Precise, within: Precise) -> Precise:
        """Return J(φ) in kg m²."""
        moving = [cylinder.inertia(phi - lag) for cylinder, lag in self._book.cylinders]
        return sum(moving, self._rigid)

    def energy(self, phi: Precise, within: Precise) -> Precise:
        """Return ½ J(φ) ω_n² in J."""
        return self._inertia(phi, within) * self.nominal**2 / 2

    def at(self, phi: Precise, within: Precise) -> tuple[Precise, Precise]:
        """Return torque and energy at an angle in degrees."""
        return self._torque(phi, within), self.energy(phi, within)

    @cached_property
    def fits(self) -> Fits:
        """Torque and energy in floats: for the mesh of the reference, and for the rivals."""
        nodes = chebyshev.chebpts1(_FIT)
        edges = self.edges
        middles = (edges[1:] + edges[:-1])[:, None] / 2
        phi = middles + np.diff(edges)[:, None] / 2 * nodes
        values = np.frompyfunc(self.at, 2, 2)(phi, np.broadcast_to(middles, phi.shape))
        series = [chebyshev.chebfit(nodes, part.astype(float).T, _FIT - 1) for part in values]
        return Fits(edges.astype(float), np.stack(series))


# collocation


@cache
def collocation(count: int) -> tuple[Array, Array]:
    """Return Chebyshev nodes (s,) on 0 … 1, the last of them 1, and the matrix (s, s) that integrates to them."""
    with mp.workdps(DIGITS):
        nodes = [(1 + mp.cos(2 * mp.pi * k / (2 * count - 1))) / 2 for k in reversed(range(count))]
        powers = mp.matrix(count)
        antiderivatives = mp.matrix(count)
        for row, node in enumerate(nodes):
            for k in range(count):
                powers[row, k] = node**k
                antiderivatives[row, k] = node ** (k + 1) / (k + 1)
        return np.array(nodes), np.array((antiderivatives * powers**-1).tolist())


class Mesh(NamedTuple):
    """Elements of the cycle: y at their beginnings and nodes (unknowns, elements, 1 + s), and which are too long."""

    edges: Array
    y: Array
    energy: Array
    is_long: Array


def periodic_solution(
    equation: ShaftEquation, at: Callable[[Array, Array], Array], edges: Array, count: int
) -> Mesh:
    """Return the periodic solution by collocation at so many nodes, in floats or, by the edges, in mpmath's numbers.

    Newton's method over the whole cycle. Its corrections are floats: in mpmath's numbers each gains a dozen digits.
    Raises ArithmeticError.
    """
    # nodes, and what is known at them
    is_precise = edges.dtype == object
    nodes, matrix = collocation(count)
    if not is_precise:
        nodes = nodes.astype(float)
        matrix = matrix.astype(float)
    degrees = edges[:-1, None] + np.diff(edges)[:, None] * nodes
    middles = np.broadcast_to((edges[1:] + edges[:-1])[:, None] / 2, degrees.shape)
    torque, energy = at(degrees, middles)
    widths = np.diff(edges)[:, None] * ((mp.pi if is_precise else math.pi) / 180)
    floats = [part.astype(float) for part in (torque, energy, widths, matrix)]
    y = np.stack(equation.start(energy))

    size_before = math.inf
    for _ in range(80):
        # what the equation misses, and the correction
        rate = np.stack(equation.rate(torque, energy, list(y)))
        arriving = np.roll(y[:, :, -1], 1, axis=1)[:, :, None]
        missing = (arriving + widths * (rate @ matrix.T) - y).astype(float)
        slopes = equation.slopes(floats[0], floats[1], list(y.astype(float)))
        step = _newton_step(missing, slopes, floats[2], floats[3], equation.load.is_constant)
        if not np.isfinite(step).all():
            break

        # a kinetic energy stays positive
        if isinstance(equation, RigidShaft):
            left = 1 + (y[0] / energy).astype(float)
            fall = float((-step[0] / floats[1] / left).max())
            step = step * min(1.0, 0.5 / max(1e-9, fall))
        y = y + step
        sizes = np.abs(y.astype(float)).max(axis=(1, 2), keepdims=True) + 1e-300
        size = float((np.abs(step) / sizes).max())
        is_exact = size < (1e-30 if is_precise else 1e-14)
        if is_exact or (size < 1e-9 and size > size_before / 2):
            if equation.load.is_constant:
                y = equation.leveled(energy, y, widths / widths.sum() * matrix[-1])
            arriving = np.roll(y[:, :, -1], 1, axis=1)[:, :, None]
            y = np.concatenate((arriving, y), axis=2)
            return Mesh(edges, y, energy, _too_long(y.astype(float), nodes))
        size_before = size
    raise ArithmeticError("no periodic solution is found")


def _newton_step(
    missing: Array,
    slopes: list[list[Precise]],
    lengths: Array,
    matrix: Array,
    is_level_free: bool,
) -> Array:
    """Return the corrections (unknowns, elements, s) that a linear equation needs, periodic over all elements.

    is_level_free: whether the level of the speed is not determined; the correction then leaves it nearly as it is.
    """
    unknowns, elements, count = missing.shape
    system = np.zeros((elements, unknowns, count, unknowns, count))
    for row in range(unknowns):
        for column in range(unknowns):
            slope = np.broadcast_to(slopes[row][column], (elements, count))
            system[:, row, :, column, :] = -lengths[:, :, None] * matrix * slope[:, None, :]
        system[:, row, :, row, :] += np.eye(count)
    size = unknowns * count
    arriving = np.repeat(np.eye(unknowns), count, axis=0)
    sides = np.concatenate(
        (
            np.moveaxis(missing, 1, 0).reshape(elements, size, 1),
            np.broadcast_to(arriving, (elements, size, unknowns)),
        ),
        axis=2,
    )
    solved = np.linalg.solve(system.reshape(elements, size, size), sides)
    solved = solved.reshape(elements, unknowns, count, 1 + unknowns)

    # what each element sends on to the next one, the last one to the first
    offset = np.zeros(unknowns)
    passed = np.eye(unknowns)
    for last in solved[:, :, -1]:
        offset = last[:, 0] + last[:, 1:] @ offset
        passed = last[:, 1:] @ passed
    change = np.eye(unknowns) - passed
    if is_level_free:
        entering = np.linalg.lstsq(change, offset, rcond=1e-9)[0]
    else:
        entering = np.linalg.solve(change, offset)
    steps = np.empty((elements, unknowns, count))
    for number, element in enumerate(solved):
        steps[number] = element[:, :, 0] + element[:, :, 1:] @ entering
        entering = steps[number, :, -1]
    return np.moveaxis(steps, 0, 1)


def _too_long(y: Array, nodes: Array) -> Array:
    """Return on which elements the last coefficients of y (unknowns, elements, 1 + s) are more than its rounding."""
    shares = np.append(0.0, nodes.astype(float))
    basis = chebyshev.chebvander(2 * shares - 1, len(nodes))
    series = y @ np.linalg.inv(basis).T
    tail = np.abs(series[:, :, -2:]).max(axis=2)
    swing = np.ptp(y, axis=(1, 2))[:, None]
    return (tail > 1e-13 * swing).any(axis=0)


# the reference


def speed_of(shaft: TextbookShaft, most: int) -> SpeedOfShaft:
    """Return the exact speed in mpmath's numbers: a mesh found in floats, solved with 20 nodes in 40 digits.

    Raises ArithmeticError where there is none, or more than so many elements would be needed.
    """
    rough = equation_in_floats(shaft.equation)
    edges = shaft.edges
    while True:
        mesh = periodic_solution(rough, shaft.fits.at, edges.astype(float), 14)
        if not mesh.is_long.any():
            break
        middles = (edges[1:] + edges[:-1]) / 2
        edges = np.sort(np.append(edges, middles[mesh.is_long]))
        if len(edges) > most:
            raise ArithmeticError(f"the reference needs more than {most} elements")
    exact = periodic_solution(shaft.equation, np.frompyfunc(shaft.at, 2, 2), edges, 20)
    return _compared(shaft, exact)


def _compared(shaft: TextbookShaft, mesh: Mesh) -> SpeedOfShaft:
    """Return what is compared of a solution."""
    equation = shaft.equation
    edges = mesh.edges
    w = np.asarray(equation.speed(mesh.energy, list(mesh.y[:, :, 1:])))
    ends = [mpf(angle) for angle in range(EVERY, shaft.cycle + 1, EVERY)]
    at_ends = np.array([w[np.abs(edges[1:] - end).argmin(), -1] for end in ends])

    # the mean over time; with an elastic coupling time runs as at uniform rotation
    widths = np.diff(edges) / shaft.cycle
    weights = collocation(w.shape[1])[1][-1]
    mean = 1 / (widths @ ((1 / (1 + w)) @ weights))
    if isinstance(equation, ElasticShaft):
        mean = 1 + widths @ (w @ weights)

    def speed(y: Sequence[Precise], phi: Precise, within: Precise) -> Precise:
        return equation.speed(shaft.energy(phi, within), y)

    highest = _largest(mesh, w, speed)
    lowest = -_largest(mesh, -w, lambda *at: -speed(*at))
    delta = (highest - lowest) / mean
    M_K: tuple[Precise, ...] = ()
    if isinstance(equation, ElasticShaft):
        torque = equation.torque
        samples = np.asarray(torque(list(mesh.y[:, :, 1:])))
        greatest = _largest(mesh, samples, lambda y, *_: torque(y))
        least = -_largest(mesh, -samples, lambda y, *_: -torque(y))
        M_K = greatest, least
    return SpeedOfShaft(shaft.nominal * (1 + at_ends), delta, shaft.nominal * (1 + highest), M_K)


def _largest(
    mesh: Mesh, samples: Array, function: Callable[[Sequence[Precise], Precise, Precise], Precise]
) -> Precise:
    """Return the largest value of a function of y, φ and an angle within, near its largest sample (elements, s)."""
    count = len(samples)
    top = int(samples.max(axis=1).argmax())
    around = sorted({(top - 1) % count, top, (top + 1) % count})
    return max(_largest_on(mesh, number, function) for number in around)


def _largest_on(
    mesh: Mesh, number: int, function: Callable[[Sequence[Precise], Precise, Precise], Precise]
) -> Precise:
    """Return the largest value on one element, on which y is interpolated through its beginning and its nodes."""
    inner, _ = collocation(mesh.y.shape[2] - 1)
    nodes = np.append(mpf(0), inner)
    y = mesh.y[:, number]
    differences = nodes[:, None] - nodes
    np.fill_diagonal(differences, mpf(1))
    weights = 1 / differences.prod(axis=1)
    low = mesh.edges[number]
    high = mesh.edges[number + 1]

    def at(phi: Precise, within: Precise) -> Precise:
        distances = (phi - low) / (high - low) - nodes
        at_node = np.flatnonzero(distances == 0)
        if len(at_node):
            return function(list(y[:, at_node[0]]), phi, within)
        shares = weights / distances
        return function(list(y @ shares / shares.sum()), phi, within)

    highest, _ = largest_and_smallest(np.frompyfunc(at, 2, 1), np.array([low, high]), STEPS)
    return highest
