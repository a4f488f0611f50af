"""Periodic solutions of y′ = f(φ, y) by collocation: Radau IIA of 11 stages on elements that refine themselves.

Radau IIA is L-stable: what relaxes within a hair of a turn is damped out, where Gauss or trapezium rules would ring.
The whole cycle is solved at once, so that it does not matter how many turns a marching method would need to settle.
"""

import math
from typing import NamedTuple, Protocol

import numpy as np

from kurbel.arrays import Array, Flags
from kurbel.numerics.cyclic import around
from kurbel.numerics.elements import STAGES, Elements, Prepared, legendre, rule

_TOLERANCE = 1e-13
"""What the last two Legendre coefficients of an element may be, over the swing of the unknown."""
_ROUNDS = 60
_MOST_ELEMENTS = 20_000


class Equation(Prepared, Protocol):
    """y′ = f(φ, y) with m unknowns y of about one size, smooth between its breaks.

    y may not fall to `floor(φ)`; `noise` in y is not looked into.
    """

    noise: float

    def rate(self, prepared: Array, y: Array) -> tuple[Array, Array]:
        """Return f and ∂f/∂y, per radian, at y (k, n, m): (k, n, m) and (k, n, m, m)."""
        ...

    def floor(self, prepared: Array) -> Array:
        """Return what y must stay above, (k, n, m), −∞ where nothing bounds it."""
        ...

    def eased(self, by: float) -> "Equation":
        """Return the equation made tamer, from 0 on without end: its floor is lower by so much, and y moves it less."""
        ...


class Periodic(NamedTuple):
    """A periodic solution: Legendre coefficients (k, m, s + 1) on elements.

    start, values: y at the starts (k, m) and at the nodes (k, s, m) of the elements; growth: the logarithm of what is
    left of a small disturbance after the cycle (Floquet).
    """

    elements: Elements
    coefficients: Array
    start: Array
    values: Array
    growth: float

    def at(self, degrees: Array, within: Array) -> Array:
        """Return y at angles (n,) in degrees, from the elements that hold `within`, (n, m)."""
        return self.elements.at(self.coefficients, degrees, within)


def periodic(equation: Equation, elements: Elements, unknowns: int = 1) -> Periodic:
    """Return the solution of y′ = f(φ, y) with the period of these elements.

    Newton's method starts from y = 0; where that leads nowhere, from a solution of an eased equation, which is followed
    back to the given one. What a linear equation leaves open is as small as can be.
    Raises Standstill where y falls to its floor on that way, and Unsettled where the way ends before it does.
    """
    start, values = np.zeros((len(elements.low), unknowns)), np.zeros((*elements.degrees.shape, unknowns))
    guess = _Guess(elements, start, values)
    with np.errstate(all="ignore"):  # a step too far may overflow; it is taken back
        try:
            return _settled(equation, guess)
        except Unsettled:
            return _followed(equation, guess)


class Unsettled(Exception):
    """No solution is found; enough: how far to ease the equation for one, in the unit of y, or None if not known."""

    def __init__(self, enough: float | None = None) -> None:
        super().__init__("no periodic solution found")
        self.enough = enough


class Standstill(Unsettled):
    """y falls to its floor near an angle in degrees; enough: see `Unsettled`."""

    def __init__(self, degrees: float, enough: float | None = None) -> None:
        super().__init__(enough)
        self.degrees = degrees


class _Guess(NamedTuple):
    """Elements, with y at their starts (k, m) and at their nodes (k, s, m)."""

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
"""y − floor, over that of y = 0, that is taken for standing still where the way back ends."""


def _followed(equation: Equation, guess: _Guess) -> Periodic:
    """Follow the solution from a deep floor up to that of the equation."""
    own = -float(equation.floor(guess.elements.prepared(equation)).max())
    if not math.isfinite(own):
        raise Unsettled
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
    return Standstill(float(found.elements.degrees.ravel()[np.argmin(share.min(axis=2))]), enough)


def _settled(equation: Equation, guess: _Guess) -> Periodic:
    """Solve and refine until every element is smooth; raises Unsettled."""
    elements, start, values = guess
    prepared = elements.prepared(equation)
    for _ in range(_ROUNDS):
        start, values = _newton(equation, elements, prepared, start, values)
        whole = np.concatenate((start[:, None], values), axis=1)
        coefficients = np.asarray(np.einsum("ns,ksm->kmn", rule().to_legendre, whole))
        least = _tolerance(whole) + equation.noise
        rough = (np.abs(coefficients[..., -2:]).sum(axis=2) > least).any(axis=1)
        rough &= elements.width > 1e-16 * float(elements.low[-1] + elements.width[-1])
        if not rough.any():
            growth = _growth(np.radians(elements.width), equation.rate(prepared, values)[1])
            return Periodic(elements, coefficients, start, values, growth)
        elements, start, values, prepared = _refined(equation, elements, prepared, coefficients, rough)
        if len(elements.width) > _MOST_ELEMENTS:
            break
    raise Unsettled


def _tolerance(values: Array) -> Array:
    return np.asarray(_TOLERANCE * np.ptp(values, axis=(0, 1)) + 4e-15 * np.abs(values).max())


def _growth(width: Array, slope: Array) -> float:
    """Return the logarithm of the largest Floquet multiplier; slope: ∂f/∂y at the nodes (k, s, m, m)."""
    if slope.shape[-1] == 1:  # ∮ ∂f/∂z dφ, which holds however fast a disturbance dies
        return float((width[:, None] * slope[..., 0, 0] @ rule().matrix[-1]).sum())
    whole, size = np.eye(slope.shape[-1]), 0.0
    for gain in _gains(width[:, None, None, None] * slope):
        whole = gain[-1] @ whole
        largest = float(np.abs(whole).max()) or 1.0
        whole, size = whole / largest, size + math.log(largest)
    return size + math.log(float(np.abs(np.linalg.eigvals(whole)).max()) or 5e-324)


def _gains(stiffness: Array) -> Array:
    """Return what unit changes at the start of each element make of the nodes, (k, s, m, m)."""
    return _answers(stiffness, np.zeros(stiffness.shape[:-1]))[1]


def _answers(stiffness: Array, residual: Array) -> tuple[Array, Array]:
    """Return the changes at the nodes that answer a residual (k, s, m), and to unit changes at the start."""
    count, stages, size = residual.shape
    coupled = rule().matrix[None, :, None, :, None] * np.moveaxis(stiffness, 2, 1)[:, None]
    systems = np.eye(stages * size) - coupled.reshape(count, stages * size, stages * size)
    starts = np.broadcast_to(np.eye(size), (count, stages, size, size))
    sides = np.concatenate((residual[..., None], starts), axis=3).reshape(count, stages * size, size + 1)
    found: Array = np.asarray(np.linalg.solve(systems, sides), dtype=float).reshape(count, stages, size, size + 1)
    return found[..., 0], found[..., 1:]


class _State(NamedTuple):
    """Where Newton's method stands: y, the slope of its rate times the width, and what the equations still lack."""

    start: Array
    values: Array
    stiffness: Array
    residual: Array
    jump: Array

    @property
    def lack(self) -> float:
        """Size of what is lacking; not a number where the rate overflows."""
        return math.sqrt(float(np.square(self.residual).sum() + np.square(self.jump).sum()))


class _Equations:
    """The collocation equations of all elements, and a floor that y must not reach."""

    def __init__(self, equation: Equation, elements: Elements, prepared: Array) -> None:
        self._equation, self._prepared = equation, prepared
        self._height = np.radians(elements.width)[:, None, None]
        self._floor = equation.floor(prepared)
        height_above = -self._floor.max(axis=(0, 1))
        self._least = float(height_above[np.isfinite(height_above)].max(initial=0.0))

    def state(self, start: Array, values: Array) -> _State:
        """Return what the equations lack where y has these starts and values."""
        rate, slope = self._equation.rate(self._prepared, values)
        residual = start[:, None] + self._height * (rule().matrix @ rate) - values
        jump = np.roll(values[:, -1], 1, axis=0) - start
        return _State(start, values, self._height[..., None] * slope, residual, jump)

    def near(self, values: Array) -> float:
        """Return the size of a step that is small beside what y swings by.

        High above its floor y is moved as a whole by rounding, though by nothing beside that height.
        """
        return max(1e-9 * float(np.ptp(values, axis=(0, 1)).max()), 1e-14 * self._least)

    def after(self, at: _State, step_start: Array, step: Array, halved: bool) -> tuple[_State, float]:
        """Return where a step leads, and the share of it that stays above the floor.

        halved: that share is halved until less is lacking.
        """
        share = _allowed(at.values - self._floor, step)
        after = self.state(at.start + share * step_start, at.values + share * step)
        while halved and not after.lack <= (1 - share / 8) * at.lack and share > 1e-6:
            share /= 2
            after = self.state(at.start + share * step_start, at.values + share * step)
        return after, share


def _newton(
    equation: Equation, elements: Elements, prepared: Array, start: Array, values: Array
) -> tuple[Array, Array]:
    """Solve the collocation equations of all elements by Newton's method, with steps that make what is lacking less."""
    equations = _Equations(equation, elements, prepared)
    at, previous = equations.state(start, values), np.inf
    for _ in range(100):
        if not math.isfinite(at.lack):
            break
        step_start, step = _linear_step(at)
        size, near = float(np.abs(step).max()), equations.near(at.values + step)
        after, share = equations.after(at, step_start, step, halved=size > near)
        # the next step answers what is left lacking: of a linear equation nothing but rounding
        left = size * after.lack / at.lack if at.lack else 0.0
        at = after
        settled = size <= 1e-6 * near or left <= 1e-5 * near or (size <= near and size >= previous / 4)
        if share == 1 and settled:
            return at.start, at.values
        if share <= 1e-6 or not math.isfinite(size):
            break
        previous = size if share == 1 else np.inf
    raise Unsettled


def _linear_step(at: _State) -> tuple[Array, Array]:
    """Return the Newton step of starts and values, with the periodic chain of elements eliminated element by element.

    In one element δ = response + gain δ_start; its last node is the start of the next one.
    """
    try:
        response, gain = _answers(at.stiffness, at.residual)
        # δ_start of element k + 1 is more[k] + gain[k] δ_start(k)
        more = response[:, -1] + np.roll(at.jump, -1, axis=0)
        ends = gain[:, -1]
        step_start = around(-ends, np.broadcast_to(np.eye(ends.shape[-1]), ends.shape), more)
    except np.linalg.LinAlgError:  # singular, or beyond the range of floats
        raise Unsettled from None
    return step_start, response + np.einsum("ksij,kj->ksi", gain, step_start)


def _allowed(room: Array, step: Array) -> float:
    """Return the share of the step that leaves a tenth of the room above the floor everywhere."""
    falling = -step > 0.9 * room
    return float(np.min(0.9 * room[falling] / -step[falling])) if falling.any() else 1.0


def _refined(
    equation: Equation, elements: Elements, prepared: Array, coefficients: Array, rough: Flags
) -> tuple[Elements, Array, Array, Array]:
    """Cut the rough elements; values on the new ones come from the polynomials of the old."""
    finer, old, places = elements.cut(rough)
    whole = np.einsum("kin,kmn->kim", legendre(places, STAGES), coefficients[old])
    new = rough[old]
    prepared = prepared[:, old]
    prepared[:, new] = Elements(*(of[new] for of in finer)).prepared(equation)
    values = np.where(new[:, None, None], np.maximum(whole[:, 1:], 0.99 * equation.floor(prepared)), whole[:, 1:])
    return finer, whole[:, 0], values, prepared
