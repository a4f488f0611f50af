"""The indicated work of a trace: weights of its samples in ∮ p dz over the stroke fraction z.

Samples at equal angles: trapezoid of p z′, z′ = dz/dφ exact, which for a periodic pressure converges far faster than
the straight lines between the samples. Otherwise the integral of those straight lines, by a rule exact to rounding.
"""

from collections.abc import Callable

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.crank_angle import CrankAngle
from kurbel.numerics.pieces import Angles, Pieces, refined
from kurbel.traces.correct import Setting, at_equal_steps

_DENSE = 600
"""Number of breaks in a cycle above which its pieces are short enough for few nodes."""


def by_angle(setting: Setting, derivative: Callable[[CrankAngle], Number], degrees: Array) -> Array:
    """Return a derivative of the stroke fraction z by φ, from that of the coordinate of the mechanism."""
    found = derivative(CrankAngle.of(degrees)) / setting.mechanism.stroke
    return found if setting.head_end else -found


def by_trapezoid(setting: Setting, angles: Array, derivative: Callable[[CrankAngle], Number]) -> Array:
    """Return the weights of the trapezoid rule at crank angles (n,) in degrees; derivative: dx/dφ or d²x/dφ²."""
    steps = np.radians(np.diff(angles)) / 2
    widths = np.append(steps, 0.0) + np.append(0.0, steps)
    return widths * by_angle(setting, derivative, angles)


def by_straight_lines(setting: Setting, angles: Array, begin: float = 0.0, turn: float = 720.0) -> Array:
    """Return the weights of samples at crank angles (n,) in degrees over one cycle in ∫ p dz along straight lines.

    begin: a dead centre from which it is taken over `turn` degrees, at most over the cycle.
    """
    along, slope = angles - angles[0], setting.mechanism.slope
    cycle = float(along[-1])
    turns = np.add.outer(setting.mechanism.dead_centres(), np.arange(0.0, cycle, 360.0)).ravel()
    breaks = np.append(along, turns - angles[0])
    nodes = 16 if len(breaks) < _DENSE else 10
    whole = Pieces.between(Angles(np.zeros(len(breaks), dtype=np.intp), breaks), 1, cycle, nodes)
    pieces, (slopes,) = refined(whole, lambda some: by_angle(setting, slope, some.degrees + angles[0])[None])

    line = np.searchsorted(along, pieces.middle, side="right") - 1
    share = (pieces.degrees - along[line]) / np.diff(along)[line]
    meant = np.mod(pieces.middle + angles[0] - begin, cycle) < turn
    by_node = np.radians(pieces.half) * meant * pieces.rule.weights[:, None] * slopes
    of_begin = np.bincount(line, (by_node * (1 - share)).sum(axis=0), len(angles))
    return np.asarray(of_begin + np.bincount(line + 1, (by_node * share).sum(axis=0), len(angles)))


def work_weights(setting: Setting, angles: Array) -> Array:
    """Return the weights (n,) of samples at crank angles (n,) in degrees over one cycle in ∮ p dz."""
    if at_equal_steps(angles):
        return by_trapezoid(setting, angles, setting.mechanism.slope)
    return by_straight_lines(setting, angles)
