"""A measured trace as the pressure in a chamber: straight over the crank angle between its corrected samples."""

import math
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from kurbel.arrays import Array, Indices, Number
from kurbel.crank_angle import CrankAngle
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.pieces import Angles, Pieces, refined
from kurbel.traces.correct import Setting, Trace, corrected, noise_of


def spread(number: Any, machine: Indices | None) -> Any:
    """Return the numbers (machines,) of the machines in an index; a single number is returned as it is."""
    return number[machine] if isinstance(number, np.ndarray) and number.ndim and machine is not None else number


_CHORD = 1.0
"""Degrees over which a rate of pressure rise is measured: between two samples noise would dominate."""
_DENSE = 600
"""Number of breaks in a cycle above which its pieces are short enough for few nodes."""


class TracePressure:
    """Gauge pressure in one chamber from a trace.

    The angle 0 of the trace, after its `angle_zero`, is the inner dead centre for both ends; a mirrored trace at the
    crank end follows one stroke later. each: pressures (m, n) in Pa of every measured cycle, levelled and pegged, gauge
    or absolute as in the trace; pressures: their mean (n,); starts: where the straight lines between the samples
    begin; noise: standard deviation in Pa of the samples, 0 where they are not at equal angles.
    """

    def __init__(self, trace: Trace, setting: Setting) -> None:
        self.trace, self.setting = trace.over(setting.cycle), setting
        self.shift = setting.shift(trace)
        self.each = corrected(self.trace, setting)
        self.pressures = np.asarray(self.each.mean(axis=0))
        angles, pressures = self.trace.angles + self.shift, self.pressures - setting.base
        wide = np.flatnonzero(np.diff(angles) > 0)
        order = wide[np.argsort(np.mod(angles[:-1][wide], setting.cycle), kind="stable")]
        # the lines in the order of the angle: the sample where each begins, that angle, its width, both pressures
        self._first, self._starts = order, np.mod(angles[order], setting.cycle)
        self._widths, self._p, self._next_p = np.diff(angles)[order], pressures[order], pressures[order + 1]
        self._gradients = (self._next_p - self._p) / self._widths
        self.starts = Angles(np.zeros(len(order), dtype=np.intp), self._starts)

    @cached_property
    def noise(self) -> float:
        """Standard deviation in Pa of the noise of the samples."""
        return noise_of(self._p) if self.trace.even else 0.0

    def at(self, degrees: Array, within: Array) -> Array:
        """Return the gauge pressure in Pa at crank angles in degrees, on the lines that hold `within` (n,)."""
        turned = np.mod(within, self.setting.cycle)
        line = np.searchsorted(self._starts, turned, side="right") - 1
        since = np.mod(turned - self._starts[line], self.setting.cycle)
        return np.asarray(self._p[line] + self._gradients[line] * (since + (degrees - within)))

    @property
    def highest(self) -> Extreme:
        """The highest gauge pressure in Pa, and the first crank angle that has it: at a sample."""
        best = float(max(self._p.max(), self._next_p.max()))
        ends = np.where(self._next_p == best, self._starts + self._widths, np.inf)
        return Extreme(best, float(np.where(self._p == best, self._starts, ends).min()))

    # the rise of pressure

    def rise(self, degrees: Array) -> Array:
        """Return the rise of pressure (n,) in Pa per degree at crank angles (n,), over the degree around each."""
        ahead, behind = (self.at(at, at) for at in (degrees + _CHORD / 2, degrees - _CHORD / 2))
        return np.asarray((ahead - behind) / _CHORD)

    def rises(self, cycles: Array) -> tuple[Array, Array]:
        """Return the rises (m, k) in Pa per degree of cycles (m, n), and the angles (k,) in the middle of their chords.

        Of chords that begin or end at a sample: between these the rise over one degree is linear.
        """
        angles = self.trace.angles
        middles = np.concatenate((angles - _CHORD / 2, angles + _CHORD / 2))
        ahead, behind = (np.mod(middles + way - angles[0], self.trace.period) for way in (_CHORD / 2, -_CHORD / 2))
        along = angles - angles[0]
        found = [np.interp(ahead, along, one) - np.interp(behind, along, one) for one in cycles]
        return np.stack(found) / _CHORD, np.mod(middles + self.shift, self.setting.cycle)

    @cached_property
    def steepest(self) -> Extreme:
        """Largest rise of pressure in Pa per degree."""
        (rises,), middles = self.rises(self.pressures[np.newaxis])
        top = int(np.argmax(rises))
        return Extreme(float(rises[top]), float(middles[top]))

    # the work

    @property
    def area(self) -> float:
        """∮ p dz in Pa per cycle, of the mean of the measured cycles."""
        return math.fsum((self.weights * self.pressures).tolist())

    @property
    def area_by_angle(self) -> float:
        """Derivative of the area in Pa by a delay of the trace in radians: ∮ p z″ dφ."""
        return math.fsum((self._trapezoid(self.setting.mechanism.curvature) * self.pressures).tolist())

    @cached_property
    def weights(self) -> Array:
        """Weights (n,) of the samples in ∮ p dz over the stroke fraction z.

        Samples at equal angles: trapezoid of p z′, z′ = dz/dφ exact, which for a periodic pressure converges far faster
        than the straight lines between the samples. Otherwise: the exact integral of those straight lines.
        """
        return self._trapezoid(self.setting.mechanism.slope) if self.trace.even else self.straight_weights()

    @property
    def exchange_weights(self) -> Array | None:
        """Weights (n,) of the samples in ∫ p dz over exhaust and intake, along straight lines; None in two strokes."""
        if self.setting.cycle == 360:
            return None
        inner, outer = self.setting.mechanism.dead_centres()
        return self.straight_weights(outer if self.setting.head_end else inner + 360.0, 360.0)

    def _trapezoid(self, derivative: Callable[[CrankAngle], Number]) -> Array:
        """Return the weights of the samples by the trapezoid rule; derivative: dx/dφ or d²x/dφ²."""
        steps = np.radians(np.diff(self.trace.angles)) / 2
        widths = np.append(steps, 0.0) + np.append(0.0, steps)
        return np.asarray(widths * self._fraction(derivative, self.trace.angles + self.shift))

    def straight_weights(self, begin: float = 0.0, turn: float = 720.0) -> Array:
        """Return the weights (n,) of the samples in ∫ p dz along straight lines, by a Gauss rule exact to rounding.

        begin: a dead centre from which it is taken over `turn` degrees, at most over the cycle.
        """
        mechanism, cycle = self.setting.mechanism, self.setting.cycle
        turns = np.add.outer(mechanism.dead_centres(), np.arange(0.0, cycle, 360.0)).ravel()
        breaks = np.append(self._starts, turns)
        nodes = 16 if len(breaks) < _DENSE else 10
        whole = Pieces.between(Angles(np.zeros(len(breaks), dtype=np.intp), breaks), 1, cycle, nodes)
        pieces, (slope,) = refined(whole, lambda some: self._fraction(mechanism.slope, some.degrees)[None])

        line = np.searchsorted(self._starts, pieces.middle, side="right") - 1
        since = np.mod(pieces.middle - self._starts[line], cycle) + (pieces.degrees - pieces.middle)
        share = since / self._widths[line]
        meant = np.mod(pieces.middle - begin, cycle) < turn
        by_node = np.radians(pieces.half) * meant * pieces.rule.weights[:, None] * slope
        sample, count = self._first[line], len(self.pressures)
        of_start = np.bincount(sample, (by_node * (1 - share)).sum(axis=0), count)
        return np.asarray(of_start + np.bincount(sample + 1, (by_node * share).sum(axis=0), count))

    def _fraction(self, derivative: Callable[[CrankAngle], Number], degrees: Array) -> Array:
        """Return a derivative of the stroke fraction z by φ."""
        by_angle = derivative(CrankAngle.of(degrees)) / self.setting.mechanism.stroke
        return np.asarray(by_angle if self.setting.head_end else -by_angle)
