"""The pressure of a measured trace: straight over the crank angle between its samples."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kurbel.crank_angle import CrankAngle
from kurbel.machine.trace import Trace
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Cuts
from kurbel.numerics.jet import Jet, once_each
from kurbel.solver.pressure import Setting

if TYPE_CHECKING:
    from kurbel.arrays import Array, Indices


_OF_MEDIAN = 1.4826
"""Standard deviation over the median of the magnitude, of what is normally distributed."""
_ENOUGH = 72
"""Samples in a cycle below which differences show its shape instead of the noise."""


class Segments(NamedTuple):
    """The straight pieces between samples, each (n,): start and end in degrees, pressures there in Pa."""

    start: Array
    end: Array
    p: Array
    next_p: Array


class TracePressure:
    """Gauge pressure in one chamber from a trace.

    The angle 0 of the trace, after its `angle_zero`, is the inner dead centre for both ends; a mirrored trace at the
    crank end follows one stroke later. starts, bends: as `Pressure` says.
    """

    def __init__(self, trace: Trace, setting: Setting) -> None:
        self.trace = trace
        self.setting = setting
        inner, outer = setting.mechanism.dead_centres()
        # what is added to an angle of the trace to make it a crank angle
        self.shift = (outer if setting.mirrored else inner) - trace.angle_zero
        angles, pressures = trace.angles + self.shift, trace.pressures - setting.base
        wide = np.diff(angles) > 0
        segment = Segments(angles[:-1][wide], angles[1:][wide], pressures[:-1][wide], pressures[1:][wide])
        starts = np.mod(segment.start, setting.cycle)
        order = np.argsort(starts, kind="stable")
        self._segments = Segments(*(part[order] for part in segment))
        self.starts = starts[order]
        self._gradients = (self._segments.next_p - self._segments.p) / (self._segments.end - self._segments.start)
        self.bends: tuple[float, ...] = ()

    def __call__(self, x: Any, angle: CrankAngle, within: Array) -> Any:
        """Return the gauge pressure in Pa at crank angles (n,), on the segments that hold the angles `within`."""
        meant = once_each(within)
        turned = np.mod(meant, self.setting.cycle)
        segment = np.searchsorted(self.starts, turned, side="right") - 1
        since = np.mod(turned - self.starts[segment], self.setting.cycle) + (angle.degrees - meant)
        value = self._segments.p[segment] + self._gradients[segment] * since
        return Jet(value, self._gradients[segment] * (180 / math.pi)) if isinstance(x, Jet) else value

    def taken(self, index: Indices) -> TracePressure:
        """Return itself: a trace is of one machine."""
        return self

    @property
    def highest(self) -> Extreme:
        """The highest gauge pressure in Pa, and the first crank angle that has it: at a sample."""
        starts, ends, p, next_p = self._segments
        best = float(max(p.max(), next_p.max()))
        reached = np.where(p == best, self.starts, np.where(next_p == best, self.starts + (ends - starts), np.inf))
        return Extreme(best, float(reached.min()))

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
    def area(self) -> float:
        """∮ p dz over the stroke fraction z in Pa, per cycle.

        Samples at equal angles: trapezoid of p z′, z′ = dz/dφ exact, which for a periodic pressure converges far faster
        than the straight lines between the samples. Otherwise: the exact integral of those straight lines.
        """
        return self._trapezoid("slope") if self.trace.even else self.straight_area

    @cached_property
    def area_by_angle(self) -> float:
        """Change of the area in Pa per radian by which the trace is put later: ∮ p z″ dφ."""
        return self._trapezoid("curvature")

    def _trapezoid(self, derivative: str) -> float:
        segments = self._segments
        first, last = (self._fraction(derivative, angles) for angles in (segments.start, segments.end))
        terms = (segments.p * first + segments.next_p * last) * (segments.end - segments.start)
        return math.radians(math.fsum(terms.tolist())) / 2

    @cached_property
    def straight_area(self) -> float:
        """∮ p dz in Pa with straight lines between the samples, by a Gauss rule that is exact to rounding."""
        grid = Cuts.of_turns(self.setting.mechanism.cuts(), self.setting.cycle, [self.starts]).grid()
        angle = CrankAngle.of(grid.degrees, grid.beyond)
        pressure = self(None, angle, grid.within)
        return grid.integral(pressure * self._fraction("slope", grid.degrees))

    def _fraction(self, derivative: str, degrees: Array) -> Array:
        """Return a derivative of the stroke fraction z by φ."""
        mechanism = self.setting.mechanism
        by_angle = getattr(mechanism, derivative)(CrankAngle.of(degrees)) / mechanism.stroke
        return np.asarray(by_angle if self.setting.head_end else -by_angle)
