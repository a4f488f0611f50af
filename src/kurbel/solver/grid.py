"""A cycle cut into smooth pieces: samples for searches, Gauss points for integrals, each on its side of every jump."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kurbel.mechanisms import Extreme, Mechanism
from kurbel.solver.gauss import LOBATTO, NODES, SIMPSON, WEIGHTS
from kurbel.solver.roots import bracketed_roots

if TYPE_CHECKING:
    from kurbel.arrays import Array, Flags

_NARROW = 2.0  # degrees; on pieces no wider the rule of Lobatto integrates as exactly as Gauss
_NARROWEST = 0.25  # and on these that of Simpson
_MANY = 300  # pieces; where there are no more, sixteen points cost nothing


class Sampled(NamedTuple):
    """Values and slopes of one quantity on a grid, each (pieces, nodes)."""

    value: Array
    slope: Array


class Grid:
    """Smooth pieces between the angles `breaks` (n + 1,) in degrees, each with 16 Gauss points and both its ends.

    A measured trace has thousands of pieces; on many and narrow ones there are fewer points. nodes, weights: the rule
    on (−1, 1); with Gauss points the weight of the ends is 0.
    degrees, within: crank angles of the nodes and the middles of their pieces, (pieces, nodes). beyond: what the
    rounding of `degrees` took from the nodes; with R/L near 1 the rod swings round within a hair of 90°, and it counts.
    """

    def __init__(self, breaks: Array) -> None:
        self.breaks = breaks
        low, high = breaks[:-1, None], breaks[1:, None]
        self.nodes, self.weights = _rule(len(breaks), float((high - low).max()))
        self.within = np.broadcast_to((low + high) / 2, (len(breaks) - 1, len(self.nodes)))
        right_angle = 90.0 * np.rint(self.within / 90.0)
        offset = ((low - right_angle) + (high - right_angle)) / 2 + (high - low) / 2 * self.nodes
        self.degrees = right_angle + offset
        self.degrees[:, 0], self.degrees[:, -1] = breaks[:-1], breaks[1:]
        self.beyond = offset - (self.degrees - right_angle)
        self.beyond[:, 0] = self.beyond[:, -1] = 0.0

    @cached_property
    def _half_widths(self) -> Array:
        return np.asarray(np.radians(np.diff(self.breaks)) / 2)

    def integral(self, value: Array) -> float:
        """Return ∫ value dφ (φ in radians) over all pieces by a rule of Gauss; value (pieces, nodes)."""
        return float(self._half_widths @ (value @ self.weights))

    def halved(self) -> Grid:
        """Return the grid with every piece cut in two; one of many narrow pieces, those of a trace, as it is."""
        return self if len(self.nodes) < len(NODES) else self.split_at((self.breaks[:-1] + self.breaks[1:]) / 2)

    def split_at(self, angles: Array) -> Grid:
        """Return the grid cut at further angles in degrees."""
        return Grid(ascending(np.concatenate((self.breaks, angles)))) if len(angles) else self


def _rule(count: int, widest: float) -> tuple[Array, Array]:
    """Return nodes, with both ends, and weights for so many pieces, the widest of which has this width in degrees."""
    rule: tuple[tuple[float, ...], tuple[float, ...]] = (-1.0, *NODES, 1.0), (0.0, *WEIGHTS, 0.0)
    if count > _MANY and widest <= _NARROW:
        rule = SIMPSON if widest <= _NARROWEST else LOBATTO
    return np.array(rule[0]), np.array(rule[1])


class Brackets(NamedTuple):
    """Intervals that hold one root each: ends in degrees, piece middles, function values at the ends; all (n,)."""

    low: Array
    high: Array
    within: Array
    f_low: Array
    f_high: Array


def sign_changes(grid: Grid, values: Array, worth: Any = True) -> Brackets:
    """Return the node intervals over which values (pieces, nodes) change sign, where `worth` holds."""
    before, after = values[:, :-1], values[:, 1:]
    # a zero at a node counts for the interval that it ends, so that it is found once
    rows, nodes = np.nonzero((((before < 0) & (after >= 0)) | ((before > 0) & (after <= 0))) & worth)
    return Brackets(
        grid.degrees[rows, nodes],
        grid.degrees[rows, nodes + 1],
        grid.within[rows, nodes],
        values[rows, nodes],
        values[rows, nodes + 1],
    )


def reversals(grid: Grid, values: Array) -> tuple[Brackets, Array]:
    """Return where values (pieces, nodes) take the other sign, round the cycle: intervals that hold a root, and angles.

    What is zero but for rounding has no sign: +, 0, − is one reversal, at the angle where the new sign begins; +, 0, +
    is none. At a jump it is the angle of the jump.
    """
    flat, degrees = values.ravel(), grid.degrees.ravel()
    signs = np.where(np.abs(flat) <= 8 * np.finfo(float).eps * np.abs(flat).max(), 0.0, np.sign(flat))
    signed = np.flatnonzero(signs)
    turned = signs[signed] != signs[np.roll(signed, -1)]
    last, first = signed[turned], np.roll(signed, -1)[turned]
    nodes = values.shape[1]
    crossing = (first == last + 1) & (first % nodes != 0)
    low, high = last[crossing], first[crossing]
    brackets = Brackets(degrees[low], degrees[high], grid.within.ravel()[low], flat[low], flat[high])
    other = first[~crossing]
    return brackets, degrees[np.where(other % nodes == 0, other, other - 1)]


def roots(function: Callable[[Array, Array], Array], brackets: Brackets) -> Array:
    """Return the roots in degrees of function(degrees, within) in the brackets (n,)."""
    if not len(brackets.low):
        return brackets.low
    low, high, within, f_low, f_high = brackets
    return bracketed_roots(lambda degrees: function(degrees, within), low, high, f_low, f_high)


class Extremes(NamedTuple):
    """Largest and smallest value of one quantity over the cycle, with their crank angles."""

    largest: Extreme
    smallest: Extreme


def extremes(
    grid: Grid, samples: dict[str, Sampled], evaluate: Callable[[Array, Array], dict[str, Sampled]]
) -> dict[str, Extremes]:
    """Return the exact extremes of several quantities over the grid, one-sided values at its breaks included.

    samples: the quantities on the grid; evaluate: the same at any (degrees, within), each (n,). Interior extremes are
    roots of the slope; only those intervals are searched that promise to beat the samples.
    """
    brackets = {name: sign_changes(grid, sampled.slope, _promising(grid, sampled)) for name, sampled in samples.items()}
    counts = [len(bracket.low) for bracket in brackets.values()]
    owner = np.repeat(np.arange(len(samples)), counts)
    stacked = Brackets(*(np.concatenate(parts) for parts in zip(*brackets.values(), strict=True)))

    def slope(degrees: Array, within: Array) -> Array:
        return np.stack([sampled.slope for sampled in evaluate(degrees, within).values()])[owner, np.arange(len(owner))]

    found = roots(slope, stacked)
    values = {name: s.value for name, s in evaluate(found, stacked.within).items()} if len(found) else {}
    return {
        name: _pick(
            np.concatenate((grid.degrees.ravel(), found[owner == k])),
            np.concatenate((sampled.value.ravel(), values[name][owner == k] if values else found)),
        )
        for k, (name, sampled) in enumerate(samples.items())
    }


def _promising(grid: Grid, sampled: Sampled) -> Flags:
    """Return the intervals (pieces, nodes − 1) whose ends could hide an extreme of the whole cycle between them."""
    value, slope = sampled
    width = np.radians(np.diff(grid.degrees, axis=1))
    # an estimate, not a bound: with eighteen nodes to a smooth piece, a hill between two of them shows in their slopes,
    # and half of slope times width is twice what a parabola with these slopes could rise
    reach = np.maximum(np.abs(slope[:, :-1]), np.abs(slope[:, 1:])) * width / 2
    top = np.maximum(value[:, :-1], value[:, 1:]) + reach
    bottom = np.minimum(value[:, :-1], value[:, 1:]) - reach
    return np.asarray((top >= value.max()) | (bottom <= value.min()))


def _pick(degrees: Array, values: Array) -> Extremes:
    return Extremes(_first_at(degrees, values, 1.0), _first_at(degrees, values, -1.0))


def _first_at(degrees: Array, values: Array, sign: float) -> Extreme:
    """Return the extreme and the first angle that reaches it but for rounding: plateaus answer alike everywhere."""
    best = (values * sign).max()
    level = best - 4 * np.finfo(float).eps * abs(best)
    # beside the values of the other sign this is the rounding of a dead centre, which is no float
    exact = abs(best) > 4 * np.finfo(float).eps * np.abs(values).max()
    return Extreme(float(best * sign) + 0.0 if exact else 0.0, float(degrees[values * sign >= level].min()))


def cycle_breaks(mechanism: Mechanism, cycle: float, starts: Iterable[Array]) -> Array:
    """Return the crank angles in degrees that cut a cycle (360 or 720 deg) into smooth pieces, from 0 to its end.

    starts: angles (n,) at which a pressure bends or jumps. Where they are many, the pieces between are kept narrow too.
    """
    landmarks = np.array([*mechanism.dead_centres(), *mechanism.landmarks(), *np.arange(0.0, 360.0, 45.0)])
    turns = [np.mod(landmarks, 360.0) + turn for turn in np.arange(0.0, cycle, 360.0)]
    given = list(starts)
    if sum(map(len, given)) > _MANY:
        given.append(np.arange(0.0, cycle, _NARROW))
    # two angles that differ by rounding only would leave a piece without width
    angles = ascending(np.concatenate([*turns, *given, [cycle]]), apart=1e-10)
    angles[-1] = cycle
    return angles


def distinct_angles(found: Array, cycle: float) -> tuple[float, ...]:
    """Return angles in degrees within the cycle, ascending, each once."""
    return tuple(ascending(np.mod(found, cycle), apart=1e-9).tolist())


def ascending(angles: Array, apart: float = 0.0) -> Array:
    """Return the angles (n,) in degrees sorted, without those that are no more than `apart` beyond the one before.

    (numpy.unique would do for apart = 0, but imports numpy.ma, a fifth of the whole start-up.)
    """
    angles = np.sort(angles)
    return angles[np.concatenate(([True], np.diff(angles) > apart))] if len(angles) else angles
