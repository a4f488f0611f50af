"""Periodic solutions of z′ = f(φ, z) by collocation: Radau IIA of 11 stages on elements that refine themselves.

Radau IIA is L-stable: what relaxes within a hair of a turn is damped out, where Gauss or trapezium rules would ring.
The whole cycle is solved at once, so that it does not matter how many turns a marching method would need to settle.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from kurbel.errors import NoSolutionError
from kurbel.solver.legendre import legendre, legendre_slopes

if TYPE_CHECKING:
    from kurbel.arrays import Array, Flags

_STAGES = 11
_TOLERANCE = 1e-13
"""What the last two Legendre coefficients of an element may be, over the swing of z."""
_ROUNDS = 60
_MOST_ELEMENTS = 20_000


class Equation(Protocol):
    """z′ = f(φ, z), smooth between its breaks. z may not fall to `floor(φ)`; `noise` in z is not looked into."""

    noise: float

    def prepared(self, degrees: Array, within: Array) -> Array:
        """Return what f needs at crank angles (k, n) and does not change with z, as (m, k, n)."""
        ...

    def rate(self, prepared: Array, z: Array) -> tuple[Array, Array]:
        """Return f and ∂f/∂z, per radian."""
        ...

    def floor(self, prepared: Array) -> Array:
        """Return what z must stay above."""
        ...


class Rule(NamedTuple):
    """Radau IIA on 0 … 1: nodes (s,), matrix (s, s) of ∫ ℓⱼ from 0 to cᵢ, Legendre coefficients from nodal values."""

    nodes: Array
    matrix: Array
    to_legendre: Array


@cache
def rule(stages: int = _STAGES) -> Rule:
    """Return the rule with nodes at the roots of P_s − P_{s−1}, the last one at 1."""
    # Golub: Jacobi matrix of the Legendre polynomials whose last entry puts an eigenvalue at 1
    k = np.arange(1, stages, dtype=float)
    off = k / np.sqrt(4 * k * k - 1)
    last = np.zeros(stages)
    last[-1] = stages / (2 * stages - 1)
    x: Array = np.asarray(np.linalg.eigvalsh(np.diag(last) + np.diag(off, 1) + np.diag(off, -1)), dtype=float)
    for _ in range(3):
        p, slope = legendre(x, stages), legendre_slopes(x, stages)
        x = np.asarray(x - (p[:, -1] - p[:, -2]) / (slope[:, -1] - slope[:, -2]), dtype=float)
    x[-1] = 1.0
    p = legendre(x, stages)
    n = np.arange(stages)
    below = np.concatenate((-np.ones((stages, 1)), p[:, : stages - 1]), axis=1)
    integrals = (p[:, 1 : stages + 1] - below) / (2 * n + 1) / 2
    integrals[:, 0] = (x + 1) / 2
    matrix: Array = np.asarray(integrals @ np.linalg.inv(p[:, :stages]), dtype=float)
    whole = legendre(np.concatenate(([-1.0], x)), stages)
    return Rule((x + 1) / 2, matrix, np.asarray(np.linalg.inv(whole), dtype=float))


class Elements(NamedTuple):
    """Parts of smooth pieces of the cycle, in degrees; all (k,).

    piece, offset, width: start of the piece, way from there to the start of the element, and its width; the way is kept
    apart because a part may be thinner than the rounding of its angle. within: an angle inside the piece.
    """

    piece: Array
    offset: Array
    width: Array
    within: Array

    @property
    def low(self) -> Array:
        """Crank angles at which the elements begin."""
        return self.piece + self.offset

    @property
    def degrees(self) -> Array:
        """Crank angles (k, s) of the nodes."""
        return self.piece[:, None] + (self.offset[:, None] + self.width[:, None] * rule().nodes)

    def prepared(self, equation: Equation) -> Array:
        """Return what the equation prepares at the nodes, (m, k, s)."""
        degrees = self.degrees
        return equation.prepared(degrees, np.broadcast_to(self.within[:, None], degrees.shape))


class Periodic(NamedTuple):
    """A periodic solution: Legendre coefficients (k, s + 1) on elements, and its Floquet multiplier over the cycle.

    values: (k, s) at the nodes of the elements.
    """

    elements: Elements
    coefficients: Array
    values: Array
    multiplier: float

    def at(self, degrees: Array, within: Array) -> Array:
        """Return z at crank angles (n,) in degrees, from the elements that hold `within`."""
        k = np.clip(np.searchsorted(self.elements.low, within, side="right") - 1, 0, None)
        way = (degrees - self.elements.piece[k]) - self.elements.offset[k]
        x = 2 * way / self.elements.width[k] - 1
        return np.asarray((legendre(x, _STAGES) * self.coefficients[k]).sum(axis=-1))


def periodic(equation: Equation, breaks: Array) -> Periodic:
    """Return the solution of z′ = f(φ, z) with the period of the breaks (n + 1,) in degrees.

    Raises NoSolutionError, whose text is an angle in degrees, where z would fall to its floor.
    """
    low, high = breaks[:-1], breaks[1:]
    elements = Elements(low, np.zeros_like(low), high - low, (low + high) / 2)
    prepared = elements.prepared(equation)
    start, values = np.zeros_like(low), np.zeros_like(elements.degrees)
    for _ in range(_ROUNDS):
        start, values, multiplier = _newton(equation, elements, prepared, start, values)
        whole = np.concatenate((start[:, None], values), axis=1)
        coefficients = whole @ rule().to_legendre.T
        rough = np.abs(coefficients[:, -2:]).sum(axis=1) > _tolerance(whole) + equation.noise
        rough &= elements.width > 1e-16 * breaks[-1]
        if not rough.any():
            return Periodic(elements, coefficients, values, multiplier)
        elements, start, values, prepared = _refined(equation, elements, prepared, whole, coefficients, rough)
        if len(elements.width) > _MOST_ELEMENTS:
            break
    raise Unsettled


def _tolerance(values: Array) -> float:
    return float(_TOLERANCE * np.ptp(values) + 4e-15 * np.abs(values).max())


class Unsettled(Exception):
    """The refinement does not come to an end."""


class Standstill(NoSolutionError):
    """z falls to its floor near a crank angle."""

    def __init__(self, degrees: float) -> None:
        super().__init__(f"standstill near {degrees:.4g} deg")
        self.degrees = degrees


def _newton(
    equation: Equation, elements: Elements, prepared: Array, start: Array, values: Array
) -> tuple[Array, Array, float]:
    """Solve the collocation equations of all elements by Newton's method; returns starts, values and the multiplier."""
    height = np.radians(elements.width)[:, None]
    floor = equation.floor(prepared)
    least = -floor.max()
    previous = np.inf
    for _ in range(60):
        rate, slope = equation.rate(prepared, values)
        residual = start[:, None] + height * (rate @ rule().matrix.T) - values
        step_start, step, multiplier = _linear_step(height * slope, residual, start, values)
        share = _allowed(values - floor, step)
        start, values = start + share * step_start, values + share * step
        size = np.abs(step).max()
        # with a heavy flywheel rounding moves the mean level, though by nothing beside the whole energy
        near = max(1e-9 * np.ptp(values), 1e-14 * least)
        if share == 1 and (size <= 1e-6 * near or (size <= near and size >= previous / 4)):
            return start, values, multiplier
        if share < 1e-9:
            break
        previous = size if share == 1 else np.inf
    gap = (values - floor) / -floor
    raise Standstill(float(elements.degrees.ravel()[np.argmin(gap)]))


def _linear_step(stiffness: Array, residual: Array, start: Array, values: Array) -> tuple[Array, Array, float]:
    """Return the Newton step of starts and values, with the periodic chain of elements eliminated element by element.

    In one element δ = response + gain δ_start; its last node is the start of the next one.
    """
    systems = np.eye(_STAGES) - rule().matrix * stiffness[:, None, :]
    sides = np.stack((residual, np.ones_like(residual)), axis=-1)
    response, gain = np.moveaxis(np.linalg.solve(systems, sides), -1, 0)
    jump = np.roll(values[:, -1], 1) - start  # what periodicity and continuity still lack
    ends, gains, jumps = response[:, -1].tolist(), gain[:, -1].tolist(), jump.tolist()
    # δ_start of element k + 1 is ends[k] + gains[k] δ_start(k) + jump(k + 1)
    offset, multiplier = 0.0, 1.0
    for k in range(len(ends)):
        offset = ends[k] + gains[k] * offset + jumps[(k + 1) % len(ends)]
        multiplier *= gains[k]
    first = offset / (1 - multiplier) if multiplier != 1 else 0.0
    steps = [first]
    for k in range(len(ends) - 1):
        steps.append(ends[k] + gains[k] * steps[-1] + jumps[k + 1])
    step_start = np.array(steps)
    return step_start, response + gain * step_start[:, None], multiplier


def _allowed(room: Array, step: Array) -> float:
    """Return the share of the step that leaves a tenth of the room above the floor everywhere."""
    falling = -step > 0.9 * room
    return float(np.min(0.9 * room[falling] / -step[falling])) if falling.any() else 1.0


def _refined(
    equation: Equation, elements: Elements, prepared: Array, whole: Array, coefficients: Array, rough: Flags
) -> tuple[Elements, Array, Array, Array]:
    """Cut the rough elements at 0.1 and 0.5; values on the new ones come from the polynomials of the old."""
    cuts = np.array([0.0, 0.1, 0.5])
    parts = np.array([0.1, 0.4, 0.5])
    offset = (elements.offset[rough, None] + elements.width[rough, None] * cuts).ravel()
    width = (elements.width[rough, None] * parts).ravel()
    new = Elements(np.repeat(elements.piece[rough], 3), offset, width, np.repeat(elements.within[rough], 3))
    places = 2 * (cuts[:, None] + parts[:, None] * np.concatenate(([0.0], rule().nodes))) - 1
    inside = np.einsum("pij,kj->kpi", legendre(places, _STAGES), coefficients[rough]).reshape(len(width), -1)
    index = np.nonzero(rough)[0]
    at = np.repeat(index, 3)
    keep = ~rough
    order = np.argsort(
        np.concatenate((np.nonzero(keep)[0] * 3.0, at * 3.0 + np.tile([0, 1, 2], len(index)))), kind="stable"
    )
    merged = Elements(*(np.concatenate((old[keep], fresh))[order] for old, fresh in zip(elements, new, strict=True)))
    new_prepared = new.prepared(equation)
    floor = equation.floor(new_prepared)
    inside[:, 1:] = np.maximum(inside[:, 1:], 0.99 * floor)
    all_whole = np.concatenate((whole[keep], inside))[order]
    all_prepared = np.concatenate((prepared[:, keep], new_prepared), axis=1)[:, order]
    return merged, all_whole[:, 0], all_whole[:, 1:], all_prepared
