"""Periodic solutions of z′ = f(φ, z) by collocation: Radau IIA of 11 stages on elements that refine themselves.

Radau IIA is L-stable: what relaxes within a hair of a turn is damped out, where Gauss or trapezium rules would ring.
The whole cycle is solved at once, so that it does not matter how many turns a marching method would need to settle.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from kurbel.numerics.elements import STAGES, Elements, Prepared, rule
from kurbel.numerics.legendre import legendre
from kurbel.numerics.linear_collocation import around

if TYPE_CHECKING:
    from kurbel.arrays import Array, Flags

_TOLERANCE = 1e-13
"""What the last two Legendre coefficients of an element may be, over the swing of z."""
_ROUNDS = 60
_MOST_ELEMENTS = 20_000


class Equation(Prepared, Protocol):
    """z′ = f(φ, z), smooth between its breaks. z may not fall to `floor(φ)`; `noise` in z is not looked into."""

    noise: float

    def rate(self, prepared: Array, z: Array) -> tuple[Array, Array]:
        """Return f and ∂f/∂z, per radian."""
        ...

    def floor(self, prepared: Array) -> Array:
        """Return what z must stay above."""
        ...

    def eased(self, by: float) -> Equation:
        """Return the equation made tamer, from 0 on without end: its floor is lower by so much, and z moves it less."""
        ...


class Periodic(NamedTuple):
    """A periodic solution: Legendre coefficients (k, s + 1) on elements.

    start, values: z at the starts (k,) and at the nodes (k, s) of the elements; growth: ∮ ∂f/∂z dφ, the logarithm of
    what is left of a small disturbance after the cycle (Floquet).
    """

    elements: Elements
    coefficients: Array
    start: Array
    values: Array
    growth: float

    def at(self, degrees: Array, within: Array) -> Array:
        """Return z at angles (n,) in degrees, from the elements that hold `within`."""
        return self.elements.at(self.coefficients[:, None], degrees, within)[..., 0]


def periodic(equation: Equation, breaks: Array) -> Periodic:
    """Return the solution of z′ = f(φ, z) with the period of the breaks (n + 1,) in degrees.

    Newton's method starts from z = 0; where that leads nowhere, from a solution of an eased equation, which is followed
    back to the given one.
    Raises Standstill where z falls to its floor on that way, and Unsettled where the way ends before it does.
    """
    elements = Elements.over(breaks)
    guess = _Guess(elements, np.zeros_like(elements.low), np.zeros_like(elements.degrees))
    with np.errstate(all="ignore"):  # a step too far may overflow; it is taken back
        try:
            return _settled(equation, guess)
        except Unsettled:
            return _followed(equation, guess)


class Unsettled(Exception):
    """No solution is found; enough: how far to ease the equation for one, in the unit of z, or None if not known."""

    def __init__(self, enough: float | None = None) -> None:
        super().__init__("no periodic solution found")
        self.enough = enough


class Standstill(Unsettled):
    """z falls to its floor near an angle in degrees; enough: see `Unsettled`."""

    def __init__(self, degrees: float, enough: float | None = None) -> None:
        super().__init__(enough)
        self.degrees = degrees


class _Guess(NamedTuple):
    """Elements, with z at their starts (k,) and at their nodes (k, s)."""

    elements: Elements
    start: Array
    values: Array


_TAMEST = 12
"""Hundredfolds of the depth of the floor that are tried for a first solution."""
_STEP = 0.1
_SHORTEST = 0.998
"""Largest and smallest cut of that depth, on the way back."""
_MOST_STEPS = 60
_STANDING = 0.05
"""z − floor, over that of z = 0, that is taken for standing still where the way back ends."""


def _followed(equation: Equation, guess: _Guess) -> Periodic:
    """Follow the solution from a deep floor up to that of the equation."""
    own = -float(equation.floor(guess.elements.prepared(equation)).max())
    found, depth = _tame(equation, guess, own)
    factor = _STEP
    for _ in range(_MOST_STEPS):
        if depth <= own:
            return found
        nearer = max(depth * factor, own)
        try:
            found = _settled(equation.eased(nearer - own), _Guess(found.elements, found.start, found.values))
            depth, factor = nearer, max(factor**1.5, _STEP)
        except Unsettled:
            factor = math.sqrt(factor)
            if factor > _SHORTEST:
                break
    raise _end_of(equation.eased(depth - own), found, depth - own)


def _tame(equation: Equation, guess: _Guess, own: float) -> tuple[Periodic, float]:
    for hundredfolds in range(1, _TAMEST + 1):
        depth = own * 100.0**hundredfolds
        try:
            return _settled(equation.eased(depth - own), guess), depth
        except Unsettled:
            continue
    raise Unsettled


def _end_of(equation: Equation, found: Periodic, enough: float) -> Unsettled:
    """Return why the way back ends at this solution: because z is all but at its floor, or not."""
    floor = equation.floor(found.elements.prepared(equation))
    share = 1 - found.values / floor
    if share.min() > _STANDING:
        return Unsettled(enough)
    return Standstill(float(found.elements.degrees.ravel()[np.argmin(share)]), enough)


def _settled(equation: Equation, guess: _Guess) -> Periodic:
    """Solve and refine until every element is smooth; raises Unsettled."""
    elements, start, values = guess
    prepared = elements.prepared(equation)
    for _ in range(_ROUNDS):
        start, values = _newton(equation, elements, prepared, start, values)
        whole = np.concatenate((start[:, None], values), axis=1)
        coefficients = whole @ rule().to_legendre.T
        rough = np.abs(coefficients[:, -2:]).sum(axis=1) > _tolerance(whole) + equation.noise
        rough &= elements.width > 1e-16 * float(elements.low[-1] + elements.width[-1])
        if not rough.any():
            growth = np.radians(elements.width)[:, None] * equation.rate(prepared, values)[1]
            return Periodic(elements, coefficients, start, values, float((growth @ rule().matrix[-1]).sum()))
        elements, start, values, prepared = _refined(equation, elements, prepared, coefficients, rough)
        if len(elements.width) > _MOST_ELEMENTS:
            break
    raise Unsettled


def _tolerance(values: Array) -> float:
    return float(_TOLERANCE * np.ptp(values) + 4e-15 * np.abs(values).max())


class _State(NamedTuple):
    """Where Newton's method stands: z, its slope of the rate times the width, and what the equations still lack."""

    start: Array
    values: Array
    stiffness: Array
    residual: Array
    jump: Array

    @property
    def lack(self) -> float:
        """Size of what is lacking; not a number where the rate overflows."""
        return math.sqrt(float(np.square(self.residual).sum() + np.square(self.jump).sum()))


def _newton(
    equation: Equation, elements: Elements, prepared: Array, start: Array, values: Array
) -> tuple[Array, Array]:
    """Solve the collocation equations of all elements by Newton's method, with steps that make what is lacking less."""
    height = np.radians(elements.width)[:, None]
    floor = equation.floor(prepared)
    least = -floor.max()

    def state(start: Array, values: Array) -> _State:
        rate, slope = equation.rate(prepared, values)
        residual = start[:, None] + height * (rate @ rule().matrix.T) - values
        return _State(start, values, height * slope, residual, np.roll(values[:, -1], 1) - start)

    at, previous = state(start, values), np.inf
    for _ in range(100):
        if not math.isfinite(at.lack):
            break
        step_start, step = _linear_step(at)
        size = float(np.abs(step).max())
        # high above its floor z is moved as a whole by rounding, though by nothing beside that height
        near = max(1e-9 * np.ptp(at.values + step), 1e-14 * least)
        share = _allowed(at.values - floor, step)
        after = state(at.start + share * step_start, at.values + share * step)
        while size > near and not after.lack <= (1 - share / 8) * at.lack and share > 1e-6:
            share /= 2
            after = state(at.start + share * step_start, at.values + share * step)
        at = after
        if share == 1 and (size <= 1e-6 * near or (size <= near and size >= previous / 4)):
            return at.start, at.values
        if share <= 1e-6 or not math.isfinite(size):
            break
        previous = size if share == 1 else np.inf
    raise Unsettled


def _linear_step(at: _State) -> tuple[Array, Array]:
    """Return the Newton step of starts and values, with the periodic chain of elements eliminated element by element.

    In one element δ = response + gain δ_start; its last node is the start of the next one.
    """
    systems = np.eye(STAGES) - rule().matrix * at.stiffness[:, None, :]
    sides = np.stack((at.residual, np.ones_like(at.residual)), axis=-1)
    try:
        response, gain = np.moveaxis(np.linalg.solve(systems, sides), -1, 0)
        # δ_start of element k + 1 is more[k] + gain[k] δ_start(k)
        more = response[:, -1:] + np.roll(at.jump, -1)[:, None]
        step_start = around(-gain[:, -1:, None], np.ones((len(more), 1, 1)), more)[:, 0]
    except np.linalg.LinAlgError:  # singular, or beyond the range of floats
        raise Unsettled from None
    return step_start, response + gain * step_start[:, None]


def _allowed(room: Array, step: Array) -> float:
    """Return the share of the step that leaves a tenth of the room above the floor everywhere."""
    falling = -step > 0.9 * room
    return float(np.min(0.9 * room[falling] / -step[falling])) if falling.any() else 1.0


def _refined(
    equation: Equation, elements: Elements, prepared: Array, coefficients: Array, rough: Flags
) -> tuple[Elements, Array, Array, Array]:
    """Cut the rough elements; values on the new ones come from the polynomials of the old."""
    finer, old, places = elements.cut(rough)
    whole = np.einsum("kin,kn->ki", legendre(places, STAGES), coefficients[old])
    new = rough[old]
    prepared = prepared[:, old]
    prepared[:, new] = Elements(*(of[new] for of in finer)).prepared(equation)
    values = np.where(new[:, None], np.maximum(whole[:, 1:], 0.99 * equation.floor(prepared)), whole[:, 1:])
    return finer, whole[:, 0], values, prepared
