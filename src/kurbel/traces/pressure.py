"""A measured trace as the pressure in a chamber: straight over the crank angle between its corrected samples."""

import math
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from kurbel.arrays import Array, Indices, Number
from kurbel.crank_angle import within_cycle
from kurbel.mechanisms.setting import Setting
from kurbel.numerics.arithmetic import unless_cancelled
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.pieces import Angles
from kurbel.traces.correct import (
    Trace,
    by_angle,
    by_straight_lines,
    by_trapezoid,
    corrected,
    noise_of,
    work_weights,
)
from kurbel.traces.period import wandered

if TYPE_CHECKING:
    from kurbel.traces.heat import Released

_CHORD = 1.0
"""Degrees over which a rate of pressure rise is measured: between two samples noise would dominate."""


class TracePressure:
    """Gauge pressure in one chamber from a trace.

    The angle 0 of the trace, after its `angle_zero`, is the inner dead centre for both ends; a mirrored trace at the
    crank end follows one stroke later. each: pressures (m, n) in Pa of every measured cycle, levelled and pegged, gauge
    or absolute as in the trace; pressures: their mean (n,); angles: the crank angles of the samples (n,) in degrees;
    starts: where the straight lines between them begin.
    """

    traced: ClassVar[Literal[True]] = True
    by_stroke: ClassVar[Literal[False]] = False

    def __init__(self, trace: Trace, setting: Setting) -> None:
        self.trace, self.setting = trace.in_chamber(setting), setting
        self.angles = self.trace.angles + self.trace.shift(setting)
        self.each = corrected(self.trace, setting)
        self.pressures = np.asarray(self.each.mean(axis=0))
        self._p, widths = self.pressures - setting.base, np.diff(self.angles)
        self._gradients = np.divide(
            np.diff(self._p), widths, out=np.zeros_like(widths), where=widths > 0
        )
        self.starts = Angles(
            np.zeros(len(widths), dtype=np.intp), within_cycle(self.angles[:-1], setting.cycle)
        )

    @cached_property
    def noise(self) -> float:
        """Standard deviation in Pa of the noise of the samples, 0 where they are not at equal angles."""
        return noise_of(self._p[:-1]) if self.trace.even else 0.0

    def at(self, degrees: Array, within: Array) -> Array:
        """Return the gauge pressure in Pa at crank angles in degrees, on the lines that hold `within` (n,)."""
        along, turned = (
            self.angles - self.angles[0],
            within_cycle(within - self.angles[0], self.setting.cycle),
        )
        line = np.minimum(
            np.searchsorted(along, turned, side="right") - 1, len(self._gradients) - 1
        )
        return self._p[line] + self._gradients[line] * (turned - along[line] + (degrees - within))

    @property
    def highest(self) -> Extreme:
        """The highest gauge pressure in Pa, and the first crank angle that has it: at a sample."""
        best = self._p.max()
        return Extreme(
            float(best), float(within_cycle(self.angles[self._p == best], self.setting.cycle).min())
        )

    @cached_property
    def wanders(self) -> bool:
        """Whether its cycles wander against each other, so that they cannot be compared."""
        return bool(wandered(self.trace.angles, self.trace.period, self.each))

    # the rise of pressure

    def rise(self, degrees: Array, machine: Indices | None = None) -> Array:
        """Return the rise of pressure (n,) in Pa per degree at crank angles (n,), over the degree around each.

        A trace is of one machine.
        """
        ahead, behind = (self.at(at, at) for at in (degrees + _CHORD / 2, degrees - _CHORD / 2))
        return (ahead - behind) / _CHORD

    def rises(self, cycles: Array) -> tuple[Array, Array]:
        """Return the rises (m, k) in Pa per degree of cycles (m, n), and the angles (k,) in the middle of their chords.

        Of chords that begin or end at a sample: between these the rise over one degree is linear.
        """
        middles = np.concatenate((self.angles - _CHORD / 2, self.angles + _CHORD / 2))
        along, cycle = self.angles - self.angles[0], self.setting.cycle
        ahead, behind = (
            within_cycle(middles + way - self.angles[0], cycle) for way in (_CHORD / 2, -_CHORD / 2)
        )
        rises_of_cycles = [
            np.interp(ahead, along, pressures) - np.interp(behind, along, pressures)
            for pressures in cycles
        ]
        return np.stack(rises_of_cycles) / _CHORD, within_cycle(middles, cycle)

    @cached_property
    def steepest(self) -> Extreme:
        """Largest rise of pressure in Pa per degree."""
        (rises,), middles = self.rises(self.pressures[np.newaxis])
        top = int(np.argmax(rises))
        return Extreme(float(rises[top]), float(middles[top]))

    # the heat

    @property
    def releases(self) -> bool:
        """Whether its heat release is requested."""
        return self.trace.heat is not None

    def released(self, area: Number) -> "Released | None":
        """Return the heat that the mean cycle releases over a piston of this area in m²; None where it has none."""
        law = self.trace.heat
        if law is None:
            return None
        setting = self.setting
        stroke_volume = area * setting.mechanism.stroke

        # the closing sample is the first one again
        after = self.trace.from_dead_centre(setting)[:-1]
        order = np.argsort(after, kind="stable")
        after = after[order]
        absolute = self.pressures[:-1][order] + setting.lift
        clearance = self.trace.clearance or 0.0
        volumes = (setting.stroke_fraction(after) + clearance) * stroke_volume
        degrees = after + setting.own_dead_centre
        per_radian = by_angle(setting, setting.mechanism.slope, degrees) * stroke_volume
        return law.released(after, absolute, volumes, np.radians(per_radian))

    # the work

    @property
    def area(self) -> float:
        """∮ p dz in Pa per cycle, of the mean of the measured cycles."""
        terms = self.weights * self.pressures
        return float(unless_cancelled(math.fsum(terms.tolist()), np.abs(terms).sum()))

    @property
    def area_by_angle(self) -> float:
        """Derivative of the area in Pa by a delay of the trace in radians: ∮ p z″ dφ."""
        weights = by_trapezoid(self.setting, self.angles, self.setting.mechanism.curvature)
        return math.fsum((weights * self.pressures).tolist())

    @cached_property
    def weights(self) -> Array:
        """Weights (n,) of the samples in ∮ p dz over the stroke fraction z."""
        return work_weights(self.setting, self.angles)

    @cached_property
    def exchange_weights(self) -> Array | None:
        """Weights (n,) of the samples in ∫ p dz over exhaust and intake, along straight lines; None in two strokes."""
        if self.setting.cycle == 360:
            return None
        inner, outer = self.setting.mechanism.dead_centres()
        return by_straight_lines(
            self.setting, self.angles, outer if self.setting.head_end else inner + 360.0, 360.0
        )
