"""The pressure of a measured trace: straight over the crank angle between its samples."""

import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.crank_angle import CrankAngle
from kurbel.machine.trace import Trace
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Cuts
from kurbel.numerics.jet import Jet
from kurbel.solver.pressure import Setting
from kurbel.solver.pressure.corrected import corrected

_OF_MEDIAN = 1.4826
"""Standard deviation over the median of the magnitude, of what is normally distributed."""
_CHORD = 1.0
"""Degrees over which a rise of pressure is told: between two samples it would be their noise."""
_ENOUGH = 72
"""Samples in a cycle below which differences show its shape instead of the noise."""


class Segments(NamedTuple):
    """The straight pieces between samples, each (n,): start and end in degrees, pressures there in Pa."""

    start: Array
    end: Array
    p: Array
    next_p: Array


class Held(NamedTuple):
    """The straight pieces that hold angles `within` in degrees, each (n,).

    since: degrees from their starts on; p: pressure in Pa there; gradient: Pa per degree.
    """

    within: Array
    since: Array
    p: Array
    gradient: Array


class TracePressure:
    """Gauge pressure in one chamber from a trace.

    The angle 0 of the trace, after its `angle_zero`, is the inner dead centre for both ends; a mirrored trace at the
    crank end follows one stroke later. each: pressures (m, n) in Pa of every measured cycle, levelled and pegged, as
    the trace counts them, gauge or absolute; pressures: their mean (n,). starts, bends: as `Pressure` says.
    """

    straight = False

    def __init__(self, trace: Trace, setting: Setting) -> None:
        self.trace = trace.over(setting.cycle)
        self.setting = setting
        inner, outer = setting.mechanism.dead_centres()
        # what is added to an angle of the trace to make it a crank angle
        self.shift = (outer if setting.mirrored else inner) - trace.angle_zero
        self.each = corrected(self.trace, setting, self.shift)
        self.pressures = np.asarray(self.each.mean(axis=0))
        angles, pressures = self.trace.angles + self.shift, self.pressures - setting.base
        wide = np.diff(angles) > 0
        segment = Segments(angles[:-1][wide], angles[1:][wide], pressures[:-1][wide], pressures[1:][wide])
        starts = np.mod(segment.start, setting.cycle)
        order = np.argsort(starts, kind="stable")
        self._segments = Segments(*(part[order] for part in segment))
        self._first = np.flatnonzero(wide)[order]
        self.starts = starts[order]
        self._gradients = (self._segments.next_p - self._segments.p) / (self._segments.end - self._segments.start)
        self.bends: tuple[float, ...] = ()

    def held(self, within: Array) -> Held:
        """Return what holds on the segments in which angles (n,) in degrees lie."""
        turned = np.mod(within, self.setting.cycle)
        segment = np.searchsorted(self.starts, turned, side="right") - 1
        since = np.mod(turned - self.starts[segment], self.setting.cycle)
        return Held(within, since, self._segments.p[segment], self._gradients[segment])

    def __call__(self, z: Any, degrees: Array, held: Held) -> Any:
        """Return the gauge pressure in Pa at crank angles (n,) in degrees, on the segments that are held."""
        value = held.p + held.gradient * (held.since + (degrees - held.within))
        return Jet(value, held.gradient * (180 / math.pi)) if isinstance(z, Jet) else value

    def taken(self, index: Indices) -> "TracePressure":
        """Return itself: a trace is of one machine."""
        return self

    @property
    def highest(self) -> Extreme:
        """The highest gauge pressure in Pa, and the first crank angle that has it: at a sample."""
        starts, ends, p, next_p = self._segments
        best = float(max(p.max(), next_p.max()))
        reached = np.where(p == best, self.starts, np.where(next_p == best, self.starts + (ends - starts), np.inf))
        return Extreme(best, float(reached.min()))

    def rise(self, degrees: Array) -> Array:
        """Return the rise of pressure (n,) in Pa per degree at crank angles (n,), over the degree around each."""
        ahead, behind = (self(None, at, self.held(at)) for at in (degrees + _CHORD / 2, degrees - _CHORD / 2))
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
        """Standard deviation in Pa of the noise of the samples; 0 where they do not stand at equal angles.

        From the medians of the second and of the fourth differences, √6 and √70 times as large if noise is all they
        have; the lesser of both, since of a smooth pressure the fourth ones are less.
        """
        if not self.trace.even:
            return 0.0
        around = np.append(self._segments.p, self._segments.p[:4])
        orders = ((2, 6.0), (4, 70.0)) if len(self._segments.p) >= _ENOUGH else ()
        spreads = [float(np.median(np.abs(np.diff(around, order)))) / math.sqrt(gain) for order, gain in orders]
        return _OF_MEDIAN * min(spreads, default=0.0)

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
        grid = Cuts.of_turns(self.setting.mechanism.cuts(), self.setting.cycle, [self.starts]).grid()
        turned = np.mod(grid.within, self.setting.cycle)
        number = np.searchsorted(self.starts, turned, side="right") - 1
        since = np.mod(turned - self.starts[number], self.setting.cycle) + (grid.degrees - grid.within)
        share = since / (self._segments.end - self._segments.start)[number]
        meant = np.mod(grid.within - begin, self.setting.cycle) < turn
        by_node = grid.half_widths[:, np.newaxis] * grid.weights * self._fraction("slope", grid.degrees) * meant
        sample, count = self._first[number].ravel(), len(self.pressures)
        of_start = np.bincount(sample, (by_node * (1 - share)).ravel(), count)
        return np.asarray(of_start + np.bincount(sample + 1, (by_node * share).ravel(), count))

    def _fraction(self, derivative: str, degrees: Array) -> Array:
        """Return a derivative of the stroke fraction z by φ."""
        mechanism = self.setting.mechanism
        by_angle = getattr(mechanism, derivative)(CrankAngle.of(degrees)) / mechanism.stroke
        return np.asarray(by_angle if self.setting.head_end else -by_angle)
