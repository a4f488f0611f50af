"""Periodic solutions of y′ = f(φ, y) by collocation: Radau IIA of 11 stages on elements that refine themselves.

Radau IIA is L-stable: what relaxes within a hair of a turn is damped out, where Gauss or trapezium rules would ring.
The whole cycle is solved at once, so that it does not matter how many turns a marching method would need to settle.
"""

import math
from typing import NamedTuple, Protocol

import numpy as np

from kurbel.arrays import Array, Flags
from kurbel.numerics.cyclic import around
from kurbel.numerics.elements import STAGES, Elements, legendre, rule

_TOLERANCE = 1e-13
"""What the last two Legendre coefficients of an element may be, over the swing of the unknown."""
_ROUNDS = 60
_MOST_ELEMENTS = 20_000


class Equation(Protocol):
    """y′ = f(φ, y) with m unknowns y of about one size, smooth between its breaks.

    y may not fall to `floor(φ)`; `noise` in y is not looked into.
    """

    noise: float

    def prepared(self, degrees: Array, within: Array) -> Array:
        """Return what hangs on the angle alone at angles (k, n), as (…, k, n)."""
        ...

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

    y: at the starts and the nodes of the elements, (k, s + 1, m); growth: the logarithm of what is left of a small
    disturbance after the cycle (Floquet).
    """

    elements: Elements
    coefficients: Array
    y: Array
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
    still = np.zeros((len(elements.low), STAGES + 1, unknowns))
    with np.errstate(all="ignore"):  # a step too far may overflow; it is taken back
        try:
            return _settled(equation, elements, still)
        except Unsettled:
            return _followed(equation, elements, still)


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


_TAMEST = 12
"""Hundredfolds of the depth of the floor that are tried for a first solution."""
_STEP = 0.1
_SHORTEST = 0.998
"""Largest and smallest cut of that depth, on the way back."""
_MOST_STEPS = 60
_STANDING = 0.05
"""y − floor, over that of y = 0, that is taken for standing still where the way back ends."""


def _followed(equation: Equation, elements: Elements, y: Array) -> Periodic:
    """Follow the solution from a deep floor up to that of the equation."""
    own = -float(equation.floor(_prepared(equation, elements)).max())
    if not math.isfinite(own):
        raise Unsettled
    found, depth = _tame(equation, elements, y, own)
    factor = _STEP
    for _ in range(_MOST_STEPS):
        if depth <= own:
            return found
        nearer = max(depth * factor, own)
        try:
            found = _settled(equation.eased(nearer - own), found.elements, found.y)
            depth, factor = nearer, max(factor**1.5, _STEP)
        except Unsettled:
            factor = math.sqrt(factor)
            if factor > _SHORTEST:
                break
    raise _end_of(equation.eased(depth - own), found, depth - own)


def _tame(equation: Equation, elements: Elements, y: Array, own: float) -> tuple[Periodic, float]:
    for hundredfolds in range(1, _TAMEST + 1):
        depth = own * 100.0**hundredfolds
        try:
            return _settled(equation.eased(depth - own), elements, y), depth
        except Unsettled:
            continue
    raise Unsettled


def _end_of(equation: Equation, found: Periodic, enough: float) -> Unsettled:
    """Return why the way back ends at this solution: because z is all but at its floor, or not."""
    floor = equation.floor(_prepared(equation, found.elements))
    share = 1 - found.y[:, 1:] / floor
    if share.min() > _STANDING:
        return Unsettled(enough)
    return Standstill(float(found.elements.degrees.ravel()[np.argmin(share.min(axis=2))]), enough)


def _settled(equation: Equation, elements: Elements, y: Array) -> Periodic:
    """Solve and refine until every element is smooth; raises Unsettled."""
    prepared = _prepared(equation, elements)
    for _ in range(_ROUNDS):
        y = _newton(_Equations(equation, elements, prepared), y)
        coefficients = np.asarray(np.einsum("ns,ksm->kmn", rule().to_legendre, y))
        least = _tolerance(y) + equation.noise
        rough = (np.abs(coefficients[..., -2:]).sum(axis=2) > least).any(axis=1)
        rough &= elements.width > 1e-16 * float(elements.low[-1] + elements.width[-1])
        if not rough.any():
            growth = _growth(np.radians(elements.width), equation.rate(prepared, y[:, 1:])[1])
            return Periodic(elements, coefficients, y, growth)
        elements, y, prepared = _refined(equation, elements, prepared, coefficients, rough)
        if len(elements.width) > _MOST_ELEMENTS:
            break
    raise Unsettled


def _prepared(equation: Equation, elements: Elements) -> Array:
    """Return what the equation prepares at the nodes, (…, k, s)."""
    degrees = elements.degrees
    return equation.prepared(degrees, np.broadcast_to(elements.within[:, None], degrees.shape))


def _tolerance(values: Array) -> Array:
    return np.asarray(_TOLERANCE * np.ptp(values, axis=(0, 1)) + 4e-15 * np.abs(values).max())


def _growth(width: Array, slope: Array) -> float:
    """Return the logarithm of the largest Floquet multiplier; slope: ∂f/∂y at the nodes (k, s, m, m)."""
    if slope.shape[-1] == 1:  # ∮ ∂f/∂z dφ, which holds however fast a disturbance dies
        return float((width[:, None] * slope[..., 0, 0] @ rule().matrix[-1]).sum())
    whole, size = np.eye(slope.shape[-1]), 0.0
    stiffness = width[:, None, None, None] * slope
    for gain in _answers(stiffness, np.zeros(stiffness.shape[:-1]))[1]:
        whole = gain[-1] @ whole
        largest = float(np.abs(whole).max()) or 1.0
        whole, size = whole / largest, size + math.log(largest)
    return size + math.log(float(np.abs(np.linalg.eigvals(whole)).max()) or 5e-324)


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
    """Where Newton's method stands: y, the slope of its rate times the width, and what the equations still lack.

    That is, (k, s + 1, m), of y at the start of an element what its end before has more, and of y at its nodes what the
    rate makes of the start.
    """

    y: Array
    stiffness: Array
    lacking: Array

    @property
    def lack(self) -> float:
        """Size of what is lacking; not a number where the rate overflows."""
        return math.sqrt(float(np.square(self.lacking).sum()))


class _Equations:
    """The collocation equations of all elements, and a floor that y must not reach."""

    def __init__(self, equation: Equation, elements: Elements, prepared: Array) -> None:
        self._equation, self._prepared = equation, prepared
        self._height = np.radians(elements.width)[:, None, None]
        self._floor = equation.floor(prepared)
        height_above = -self._floor.max(axis=(0, 1))
        self._least = float(height_above[np.isfinite(height_above)].max(initial=0.0))

    def state(self, y: Array) -> _State:
        """Return what the equations lack where y has these values at starts and nodes."""
        start, nodes = y[:, :1], y[:, 1:]
        rate, slope = self._equation.rate(self._prepared, nodes)
        jump = np.roll(nodes[:, -1:], 1, axis=0) - start
        lacking = np.concatenate((jump, start + self._height * (rule().matrix @ rate) - nodes), axis=1)
        return _State(y, self._height[..., None] * slope, lacking)

    def near(self, y: Array) -> float:
        """Return the size of a step that is small beside what y swings by.

        High above its floor y is moved as a whole by rounding, though by nothing beside that height.
        """
        return max(1e-9 * float(np.ptp(y, axis=(0, 1)).max()), 1e-14 * self._least)

    def after(self, at: _State, step: Array, halved: bool) -> tuple[_State, float]:
        """Return where a step leads, and the share of it that stays above the floor.

        halved: that share is halved until less is lacking.
        """
        share = _allowed(at.y[:, 1:] - self._floor, step[:, 1:])
        after = self.state(at.y + share * step)
        while halved and not after.lack <= (1 - share / 8) * at.lack and share > 1e-6:
            share /= 2
            after = self.state(at.y + share * step)
        return after, share


def _newton(equations: _Equations, y: Array) -> Array:
    """Solve the collocation equations of all elements by Newton's method, with steps that make what is lacking less."""
    at, previous = equations.state(y), np.inf
    for _ in range(100):
        if not math.isfinite(at.lack):
            break
        step = _linear_step(at)
        size, near = float(np.abs(step).max()), equations.near(at.y + step)
        after, share = equations.after(at, step, halved=size > near)
        # the next step answers what is left lacking: of a linear equation nothing but rounding
        left = size * after.lack / at.lack if at.lack else 0.0
        at = after
        settled = size <= 1e-6 * near or left <= 1e-5 * near or (size <= near and size >= previous / 4)
        if share == 1 and settled:
            return at.y
        if share <= 1e-6 or not math.isfinite(size):
            break
        previous = size if share == 1 else np.inf
    raise Unsettled


def _linear_step(at: _State) -> Array:
    """Return the Newton step of y, with the periodic chain of elements eliminated element by element.

    In one element δ = response + gain δ_start; its last node is the start of the next one.
    """
    try:
        response, gain = _answers(at.stiffness, at.lacking[:, 1:])
        # δ_start of element k + 1 is more[k] + gain[k] δ_start(k)
        more = response[:, -1] + np.roll(at.lacking[:, 0], -1, axis=0)
        ends = gain[:, -1]
        start = around(-ends, np.broadcast_to(np.eye(ends.shape[-1]), ends.shape), more)
    except np.linalg.LinAlgError:  # singular, or beyond the range of floats
        raise Unsettled from None
    return np.concatenate((start[:, None], response + np.einsum("ksij,kj->ksi", gain, start)), axis=1)


def _allowed(room: Array, step: Array) -> float:
    """Return the share of the step that leaves a tenth of the room above the floor everywhere."""
    falling = -step > 0.9 * room
    return float(np.min(0.9 * room[falling] / -step[falling])) if falling.any() else 1.0


def _refined(
    equation: Equation, elements: Elements, prepared: Array, coefficients: Array, rough: Flags
) -> tuple[Elements, Array, Array]:
    """Cut the rough elements; y on the new ones comes from the polynomials of the old, and stays above its floor."""
    finer, old, places = elements.cut(rough)
    y = np.einsum("kin,kmn->kim", legendre(places, STAGES), coefficients[old])
    new, prepared = rough[old], prepared[:, old]
    prepared[:, new] = _prepared(equation, Elements(*(of[new] for of in finer)))
    y[new, 1:] = np.maximum(y[new, 1:], 0.99 * equation.floor(prepared[:, new]))
    return finer, y, prepared
