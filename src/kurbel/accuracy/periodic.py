"""The reference of the speed line: Lobatto IIIC of 14 stages in Decimal, shot from one end of the cycle to the other.

K is the kinetic energy ½ J(φ) ω², K′ = M(φ) − M_load(ω) per radian. The method is L-stable, but of another family than
the solver's, on another mesh, with other unknowns and 40 digits; floats only find where the decimals begin.
"""

import math
from collections.abc import Sequence
from decimal import Decimal, getcontext
from functools import cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from kurbel.accuracy.decimals import legendre, pi, precise
from kurbel.accuracy.oracle import apart
from kurbel.accuracy.references import MachineOracle
from kurbel.machine import Machine

STAGES = 14
SAMPLE_STEP = 30
"""Degrees between the angles at which speed lines are compared."""


class Rule(NamedTuple):
    """Lobatto IIIC on 0 … 1: nodes (s,) from 0 to 1, and the matrix (s, s) whose last row is the weights."""

    nodes: tuple[Decimal, ...]
    matrix: tuple[tuple[Decimal, ...], ...]


@cache
def _lobatto(stages: int, digits: int) -> Rule:
    """a_i1 = b_1, and Σ_j a_ij c_j^(k−1) = c_i^k/k for k < s (Hairer & Wanner, IV.5)."""
    with precise(digits + 20):
        degree = stages - 1
        inner = [_extreme_of_legendre(degree, k) for k in range(1, degree)]
        nodes = (Decimal(0), *((1 - z) / 2 for z in inner), Decimal(1))
        first = 1 / Decimal(stages * degree)
        powers = [[c**k if k else Decimal(1) for c in nodes[1:]] for k in range(degree)]
        rows = []
        for end in nodes:
            wanted = [end ** (k + 1) / (k + 1) - (first if k == 0 else 0) for k in range(degree)]
            rows.append((first, *(row[0] for row in solved(powers, [[w] for w in wanted]))))
        return Rule(nodes, tuple(rows))


def _extreme_of_legendre(degree: int, k: int) -> Decimal:
    z = Decimal(math.cos(math.pi * k / degree))
    for _ in range(9):
        value, slope = legendre(degree, z)
        bend = (2 * z * slope - degree * (degree + 1) * value) / (1 - z * z)
        z -= slope / bend
    return z


def solved(matrix: Sequence[Sequence[Any]], right: Sequence[Sequence[Any]]) -> list[list[Any]]:
    """Return the solution (n, m) of a linear system, by elimination with pivots, for any kind of number."""
    rows = [[*row, *more] for row, more in zip(matrix, right)]
    size = len(rows)
    for k in range(size):
        best = max(range(k, size), key=lambda i: abs(rows[i][k]))
        rows[k], rows[best] = rows[best], rows[k]
        pivot = rows[k]
        for i in range(k + 1, size):
            factor = rows[i][k] / pivot[k]
            if factor:
                row = rows[i]
                for j in range(k + 1, len(row)):
                    row[j] -= factor * pivot[j]
    for k in reversed(range(size)):
        row = rows[k]
        for j in range(size, len(row)):
            row[j] = (row[j] - sum(row[i] * rows[i][j] for i in range(k + 1, size))) / row[k]
    return [row[size:] for row in rows]


class _Element(NamedTuple):
    """An element: width in radians, effort without inertia in N m and ½ J ω_n² in J at its nodes (s,)."""

    width: Any
    effort: list[Any]
    energy: list[Any]


class _Law(NamedTuple):
    """The load over r = (ω/ω_n)²: mean · r^half, or mean + steepness (√r − 1)."""

    mean: Any
    half: Any = None
    steepness: Any = None

    def torque(self, ratio: Any) -> tuple[Any, Any]:
        """Return the torque and its slope by r."""
        if self.half is not None:
            power = ratio ** (self.half - 1)
            return self.mean * power * ratio, self.mean * self.half * power
        root = _root(ratio)
        return self.mean + self.steepness * (root - 1), self.steepness / (2 * root)


def _root(value: Any) -> Any:
    return value.sqrt() if isinstance(value, Decimal) else value**0.5


class NoReference(Exception):
    """The reference could not be computed; the text says why."""


def why_no_speed(machine: Machine) -> str:
    """Return why there is no independent speed line for a machine, or an empty text."""
    load = machine.load
    if not machine.speed or machine.flywheel is None or machine.flywheel.inertia is None:
        return "no speed, or no flywheel with its inertia given"
    if load is None or load.diagram is not None or not (load.slip or load.power):
        return "the load does not depend on the speed"
    return "no independent calculation of an elastic coupling" if machine.coupling else ""


class SpeedOracle:
    """The periodic speed line of a machine whose load depends on the speed. `omega`: rad/s at every 30°."""

    def __init__(self, machine: Machine, stages: int = STAGES) -> None:
        self.stages = stages
        self.machine = machine
        self.effort = MachineOracle(machine)
        assert machine.speed is not None
        self._omega = 2 * pi() * Decimal(machine.speed)
        self._mean = self.effort.efficiency * self.effort.mean
        self._rule = _lobatto(stages, getcontext().prec)

    def law(self) -> _Law:
        """Return the load."""
        load = self.machine.load
        assert load is not None
        if load.slip is not None:
            return _Law(self._mean, steepness=abs(self._mean) / Decimal(load.slip))
        return _Law(self._mean, half=Decimal(load.power or 0) / 2)

    def inertia(self, degrees: Decimal) -> Decimal:
        """Return J(φ) = J + Σ (m x′² + (1 − s) m_r R²) in kg m²: what of a rod is no share s turns with the pin."""
        assert self.machine.flywheel is not None
        moving = (
            one.mass * one.motion.at(degrees - position).slope ** 2 + one.turning_inertia
            for one, position in self.effort.cylinders
        )
        return Decimal(self.machine.flywheel.inertia or 0.0) + sum(moving, Decimal(0))

    def turning(self, degrees: Decimal, within: Decimal) -> Decimal:
        """Return η (M − M_inertia) in N m: what the kinetic energy is fed by."""
        total = self.effort.torque(degrees, within)
        for one, position in self.effort.cylinders:
            at = one.motion.at(degrees - position)
            total += one.mass * self._omega**2 * at.slope * at.curvature
        return self.effort.efficiency * total

    def ends(self) -> list[Decimal]:
        """Return the ends of the elements in degrees: breaks, every 30°, and ever finer after each of them if stiff."""
        steps = {Decimal(angle) for angle in range(0, int(self.effort.cycle) + 1, SAMPLE_STEP)}
        corners = apart(sorted(steps | set(self.effort.breaks)))
        least = min(self.inertia(angle) for angle in corners) * self._omega**2 / 2
        settling = least / abs(self.law().torque(Decimal(1))[1]) * 180 / pi()  # degrees in which K settles to a third
        found = []
        for low, high in pairwise(corners):
            found.append(low)
            step = settling / 2
            while step < (high - low) / 3:
                found.append(low + step)
                step *= 3
        return [*found, corners[-1]]

    def _elements(self, ends: list[Decimal]) -> list[_Element]:
        elements = []
        for low, high in pairwise(ends):
            angles = [low + (high - low) * c for c in self._rule.nodes]
            within = (low + high) / 2
            energy = [self.inertia(angle) * self._omega**2 / 2 for angle in angles]
            effort = [self.turning(angle, within) for angle in angles]
            elements.append(_Element((high - low) * pi() / 180, effort, energy))
        return elements

    def _refined(self, ends: list[Decimal]) -> tuple[list[Decimal], list[_Element], list[list[float]]]:
        """Halve the elements until floats see the rates as polynomials; return ends, elements and the floats."""
        sketch = Sketch(self._rule, self.law())
        for _ in range(14):
            exact = self._elements(ends)
            stages, coarse = sketch.solved(exact)
            if not any(coarse):
                return ends, exact, stages
            middles = [(low + high) / 2 for (low, high), split in zip(pairwise(ends), coarse) if split]
            ends = sorted([*ends, *middles])
        raise NoReference("the mesh of the reference of the speed line did not become fine enough")

    def omega(self) -> list[Decimal]:
        """Return ω in rad/s at 0°, 30°, … of the cycle, its end left out. Raises NoReference."""
        ends, exact, guess = self._refined(self.ends())
        start = [[Decimal(value) for value in stages] for stages in guess]
        found = _periodic(exact, self.law(), self._rule.matrix, start)
        # the first stage of Lobatto IIIC is no value of the line; the last one of the element before is
        at = {end: found[k - 1][-1] / exact[k - 1].energy[-1] for k, end in enumerate(ends[:-1])}
        wanted = range(0, int(self.effort.cycle), SAMPLE_STEP)
        return [self._omega * at[Decimal(angle)].sqrt() for angle in wanted]


_CLOSED = Decimal("1e-26")


def _periodic(elements: list[_Element], law: _Law, matrix: Any, start: list[list[Decimal]]) -> list[list[Decimal]]:
    """Return the stages of every element of the periodic solution: Newton over the whole cycle, begun beside it."""
    stages = start
    for _ in range(8):
        moves = [
            _linearised(element, law, matrix, own, stages[index - 1][-1])
            for index, (element, own) in enumerate(zip(elements, stages))
        ]
        steps = around(moves)
        stages = [[value + step for value, step in zip(own, moved)] for own, moved in zip(stages, steps)]
        size = max(
            abs(step) / energy for moved, element in zip(steps, elements) for step, energy in zip(moved, element.energy)
        )
        if size <= _CLOSED:
            return stages
    raise NoReference("the reference of the speed line did not converge")


def around(moves: Sequence[Sequence[Sequence[Any]]]) -> list[list[Any]]:
    """Return the corrections of all stages: d = part + slope · d_start, and the last of an element starts the next.

    Over the cycle d_end = α d_start + β, and the cycle closes with d_start = β/(1 − α).
    """
    alpha, beta = 1, 0
    for move in moves:
        alpha, beta = move[-1][1] * alpha, move[-1][1] * beta + move[-1][0]
    start = beta / (1 - alpha)
    found = []
    for move in moves:
        found.append([part + slope * start for part, slope in move])
        start = found[-1][-1]
    return found


def _linearised(element: _Element, law: _Law, matrix: Any, own: list[Any], before: Any) -> list[Any]:
    """Return for every stage the correction at d_start = 0, and its change with d_start."""
    rates, slopes = [], []
    for value, effort, energy in zip(own, element.effort, element.energy):
        torque, slope = law.torque(value / energy)
        rates.append(effort - torque)
        slopes.append(-slope / energy)
    system, right = [], []
    for i, row in enumerate(matrix):
        scaled = [element.width * a for a in row]
        system.append([(1 if i == j else 0) - a * slope for j, (a, slope) in enumerate(zip(scaled, slopes))])
        right.append([before + sum(a * rate for a, rate in zip(scaled, rates)) - own[i], 1])
    return solved(system, right)


_RESOLVED = 3e-15
"""Last two Legendre coefficients of the rates of an element that counts as none, over K."""


class Sketch:
    """The same equations in floats, all elements at once: where the decimals begin, and which elements are too long."""

    def __init__(self, rule: Rule, law: _Law) -> None:
        self._matrix = np.array(rule.matrix, dtype=float)
        self._law = _Law(*(None if value is None else float(value) for value in law))
        places = 2 * np.array(rule.nodes, dtype=float) - 1
        # turns values at the nodes into the last two Legendre coefficients of their polynomial
        self._leading = np.linalg.inv(np.polynomial.legendre.legvander(places, len(places) - 1))[-2:]

    def solved(self, elements: list[_Element]) -> tuple[list[list[float]], list[bool]]:
        """Return the stages of every element, and whether it is too long."""
        effort, energy = (np.array([getattr(e, name) for e in elements], dtype=float) for name in ("effort", "energy"))
        width = np.array([float(e.width) for e in elements])
        stages, before = energy.copy(), math.inf
        for _ in range(100):
            torque, slope = self._law.torque(stages / energy)
            rate, slope = effort - torque, -slope / energy
            scaled = width[:, None, None] * self._matrix
            system = np.eye(len(self._matrix)) - scaled * slope[:, None, :]
            left = np.roll(stages[:, -1], 1)[:, None] + np.einsum("kij,kj->ki", scaled, rate) - stages
            moves = np.linalg.solve(system, np.stack((left, np.ones_like(left)), axis=2))
            steps = np.array(around(moves.tolist()))
            stages = stages + steps * min(1.0, *(0.5 / np.maximum(-steps / stages, 1e-9)).ravel().tolist())
            size = float(np.abs(steps / energy).max())
            # a heavy flywheel amplifies rounding; where the steps shrink no more, the decimals take over
            if size < 1e-12 or (size < 1e-7 and size > before / 2):
                break
            before = size
        else:
            raise NoReference("the sketch of the reference of the speed line did not converge")
        scale = energy * (1 + 0.3 * width[:, None] * np.abs(slope))  # beyond that it is rounding
        tail = np.abs(rate @ self._leading.T).max(axis=1) * width
        return stages.tolist(), (tail > _RESOLVED * scale.min(axis=1)).tolist()
