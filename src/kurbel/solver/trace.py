"""A measured trace as the pressure in a chamber: straight over the crank angle between its corrected samples."""

import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.crank_angle import CrankAngle
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.pieces import Angles, Pieces, refined
from kurbel.traces.correct import Setting, Trace, corrected, noise_of


def spread(number: Any, machine: Indices | None) -> Any:
    """Return numbers of machines (machines,) for those of an index; one number stays one."""
    return number[machine] if isinstance(number, np.ndarray) and number.ndim and machine is not None else number


_CHORD = 1.0
"""Degrees over which a rise of pressure is measured: between two samples it would be their noise."""
_DENSE = 600
"""Breaks of a cycle from which on its pieces are short enough for few nodes."""


class Segments(NamedTuple):
    """The straight pieces between samples, each (n,): start and end in degrees, pressures there in Pa."""

    start: Array
    end: Array
    p: Array
    next_p: Array


class TracePressure:
    """Gauge pressure in one chamber from a trace.

    The angle 0 of the trace, after its `angle_zero`, is the inner dead centre for both ends; a mirrored trace at the
    crank end follows one stroke later. each: pressures (m, n) in Pa of every measured cycle, levelled and pegged, as
    the trace counts them, gauge or absolute; pressures: their mean (n,). starts, bends: as `Pressure` says.
    """

    def __init__(self, trace: Trace, setting: Setting) -> None:
        self.trace = trace.over(setting.cycle)
        self.setting = setting
        self.shift = setting.shift(trace)
        self.each = corrected(self.trace, setting)
        self.pressures = np.asarray(self.each.mean(axis=0))
        angles, pressures = self.trace.angles + self.shift, self.pressures - setting.base
        wide = np.diff(angles) > 0
        segment = Segments(angles[:-1][wide], angles[1:][wide], pressures[:-1][wide], pressures[1:][wide])
        starts = np.mod(segment.start, setting.cycle)
        order = np.argsort(starts, kind="stable")
        self._segments = Segments(*(part[order] for part in segment))
        self._first = np.flatnonzero(wide)[order]
        self._starts = starts[order]
        self._gradients = (self._segments.next_p - self._segments.p) / (self._segments.end - self._segments.start)

    @property
    def starts(self) -> Angles:
        """Where the segments begin; a trace is of one machine."""
        return Angles(np.zeros(len(self._starts), dtype=np.intp), self._starts)

    def at(self, degrees: Array, within: Array) -> Array:
        """Return the gauge pressure in Pa at crank angles in degrees, on the segments that hold `within` (n,)."""
        turned = np.mod(within, self.setting.cycle)
        segment = np.searchsorted(self._starts, turned, side="right") - 1
        since = np.mod(turned - self._starts[segment], self.setting.cycle)
        pressures: Array = self._segments.p[segment] + self._gradients[segment] * (since + (degrees - within))
        return pressures

    @property
    def highest(self) -> Extreme:
        """The highest gauge pressure in Pa, and the first crank angle that has it: at a sample."""
        starts, ends, p, next_p = self._segments
        best = float(max(p.max(), next_p.max()))
        reached = np.where(p == best, self._starts, np.where(next_p == best, self._starts + (ends - starts), np.inf))
        return Extreme(best, float(reached.min()))

    def rise(self, degrees: Array) -> Array:
        """Return the rise of pressure (n,) in Pa per degree at crank angles (n,), over the degree around each."""
        ahead, behind = (self.at(at, at) for at in (degrees + _CHORD / 2, degrees - _CHORD / 2))
        return np.asarray((ahead - behind) / _CHORD)

    @cached_property
    def steepest(self) -> Extreme:
        """Largest rise of pressure in Pa per degree: it bends only where an end of its degree passes a sample."""
        rises = self.rises(self.pressures[np.newaxis])[0]
        top = int(np.argmax(rises))
        return Extreme(float(rises[top]), float(self._chords[top] % self.setting.cycle))

    @cached_property
    def _chords(self) -> Array:
        """Crank angles (k,) in degrees of the middles of the chords that begin or end at a sample."""
        at = self.trace.angles + self.shift
        return np.concatenate((at - _CHORD / 2, at + _CHORD / 2))

    def rises(self, cycles: Array) -> Array:
        """Return the rises (m, k) in Pa per degree of cycles (m, n) over all chords that begin or end at a sample."""
        angles = self.trace.angles
        at = self._chords - self.shift
        ahead, behind = (np.mod(at + way - angles[0], self.trace.period) for way in (_CHORD / 2, -_CHORD / 2))
        along = angles - angles[0]
        return np.stack([np.interp(ahead, along, one) - np.interp(behind, along, one) for one in cycles]) / _CHORD

    @cached_property
    def noise(self) -> float:
        """Standard deviation in Pa of the noise of the samples; 0 where they are not at equal angles."""
        return noise_of(self._segments.p) if self.trace.even else 0.0

    @cached_property
    def weights(self) -> Array:
        """Weights (n,) of the samples in ∮ p dz over the stroke fraction z.

        Samples at equal angles: trapezoid of p z′, z′ = dz/dφ exact, which for a periodic pressure converges far faster
        than the straight lines between the samples. Otherwise: the exact integral of those straight lines.
        """
        return self._trapezoid("slope") if self.trace.even else self.straight_weights

    @property
    def area(self) -> float:
        """∮ p dz in Pa, per cycle: of the mean of the measured ones."""
        return math.fsum((self.weights * self.pressures).tolist())

    @cached_property
    def area_by_angle(self) -> float:
        """Change of the area in Pa per radian by which the trace is put later: ∮ p z″ dφ."""
        return math.fsum((self._trapezoid("curvature") * self.pressures).tolist())

    def _trapezoid(self, derivative: str) -> Array:
        angles = self.trace.angles
        steps = np.radians(np.diff(angles)) / 2
        widths = np.append(steps, 0.0) + np.append(0.0, steps)
        return np.asarray(widths * self._fraction(derivative, angles + self.shift))

    @cached_property
    def straight_weights(self) -> Array:
        """Weights (n,) of the samples in ∮ p dz along straight lines, by a Gauss rule that is exact to rounding."""
        return self._straight_weights(0.0, self.setting.cycle)

    @cached_property
    def exchange_weights(self) -> Array | None:
        """Weights (n,) of the samples in ∫ p dz over exhaust and intake, along straight lines; None in two strokes."""
        if self.setting.cycle == 360:
            return None
        inner, outer = self.setting.mechanism.dead_centres()
        return self._straight_weights(outer if self.setting.head_end else inner + 360.0, 360.0)

    def _straight_weights(self, begin: float, turn: float) -> Array:
        """Return the weights of the samples in ∫ p dz from a dead centre on over so many degrees."""
        mechanism, cycle = self.setting.mechanism, self.setting.cycle
        turns = np.add.outer(mechanism.dead_centres(), np.arange(0.0, cycle, 360.0)).ravel()
        breaks = np.append(self._starts, turns)
        nodes = 16 if len(breaks) < _DENSE else 10
        whole = Pieces.between(Angles(np.zeros(len(breaks), dtype=np.intp), breaks), 1, cycle, nodes)
        pieces, (slope,) = refined(whole, lambda some: self._fraction("slope", some.degrees)[None])
        number = np.searchsorted(self._starts, pieces.middle, side="right") - 1
        since = np.mod(pieces.middle - self._starts[number], cycle) + (pieces.degrees - pieces.middle)
        share = since / (self._segments.end - self._segments.start)[number]
        meant = np.mod(pieces.middle - begin, cycle) < turn
        by_node = np.radians(pieces.half) * meant * pieces.rule.weights[:, None] * slope
        sample, count = self._first[number], len(self.pressures)
        of_start = np.bincount(sample, (by_node * (1 - share)).sum(axis=0), count)
        return np.asarray(of_start + np.bincount(sample + 1, (by_node * share).sum(axis=0), count))

    def _fraction(self, derivative: str, degrees: Array) -> Array:
        """Return a derivative of the stroke fraction z by φ."""
        mechanism = self.setting.mechanism
        angle = CrankAngle.of(degrees)
        by_angle = (mechanism.slope(angle) if derivative == "slope" else mechanism.curvature(angle)) / mechanism.stroke
        return np.asarray(by_angle if self.setting.head_end else -by_angle)
