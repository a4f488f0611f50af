"""A measured trace as the pressure in a chamber: straight over the crank angle between its samples.

First the drift over the cycle is removed, and the level, which the sensor does not give, is set by pegging. At the end:
the exponents of p V^n = const that compression and expansion follow.
"""

import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.crank_angle import CrankAngle
from kurbel.machine.trace import Pegging, Trace
from kurbel.mechanisms import Mechanism
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.pieces import Angles, Pieces, refined


def spread(number: Any, machine: Indices | None) -> Any:
    """Return numbers of machines (machines,) for those of an index; one number stays one."""
    return number[machine] if isinstance(number, np.ndarray) and number.ndim and machine is not None else number


class Setting(NamedTuple):
    """Which chamber it is, and what its pressures count from.

    cycle: degrees of crank angle, 360 or 720; ambient: absolute pressure in Pa; absolute: whether the chamber's own
    figures are; mirrored: the crank end repeats the head end's figures one stroke later. For many machines numbers are
    arrays (machines,); the annotations are those of one.
    """

    mechanism: Mechanism
    cycle: float
    head_end: bool
    ambient: float
    absolute: bool
    mirrored: bool = False

    @property
    def base(self) -> float:
        """What the chamber's figures less this are gauge pressures, in Pa."""
        return self.ambient if self.absolute else 0.0

    @property
    def lift(self) -> float:
        """What the chamber's figures plus this are absolute pressures, in Pa."""
        return 0.0 if self.absolute else self.ambient


_OF_MEDIAN = 1.4826
"""Standard deviation over the median of the magnitude, of what is normally distributed."""
_CHORD = 1.0
"""Degrees over which a rise of pressure is measured: between two samples it would be their noise."""
_DENSE = 600
"""Breaks of a cycle from which on its pieces are short enough for few nodes."""
_ENOUGH = 72
"""Samples in a cycle below which differences show its shape instead of the noise."""


class Segments(NamedTuple):
    """The straight pieces between samples, each (n,): start and end in degrees, pressures there in Pa."""

    start: Array
    end: Array
    p: Array
    next_p: Array


class HeldSamples(NamedTuple):
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
        self._starts = starts[order]
        self._gradients = (self._segments.next_p - self._segments.p) / (self._segments.end - self._segments.start)

    @property
    def starts(self) -> Angles:
        """Where the segments begin; a trace is of one machine."""
        return Angles(np.zeros(len(self._starts), dtype=np.intp), self._starts)

    def held(self, within: Array) -> HeldSamples:
        """Return what holds on the segments in which angles (n,) in degrees lie."""
        turned = np.mod(within, self.setting.cycle)
        segment = np.searchsorted(self._starts, turned, side="right") - 1
        since = np.mod(turned - self._starts[segment], self.setting.cycle)
        return HeldSamples(within, since, self._segments.p[segment], self._gradients[segment])

    def at(self, degrees: Array, held: HeldSamples) -> Array:
        """Return the gauge pressure in Pa at crank angles in degrees, on the segments that are held."""
        return held.p + held.gradient * (held.since + (degrees - held.within))

    @property
    def highest(self) -> Extreme:
        """The highest gauge pressure in Pa, and the first crank angle that has it: at a sample."""
        starts, ends, p, next_p = self._segments
        best = float(max(p.max(), next_p.max()))
        reached = np.where(p == best, self._starts, np.where(next_p == best, self._starts + (ends - starts), np.inf))
        return Extreme(best, float(reached.min()))

    def rise(self, degrees: Array) -> Array:
        """Return the rise of pressure (n,) in Pa per degree at crank angles (n,), over the degree around each."""
        ahead, behind = (self.at(at, self.held(at)) for at in (degrees + _CHORD / 2, degrees - _CHORD / 2))
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


# drift and level

_AROUND = 2.5
"""Degrees on either side of the pegging angle over which a cycle's level is the mean: one sample is noise."""
LAST = 2.0
"""Degrees at either end of the cycle through which lines go, as far as there are three samples in them."""


def corrected(trace: Trace, setting: Setting, shift: float) -> Array:
    """Return the pressures (m, n) in Pa of all cycles, without drift, and pegged; as the trace counts them.

    shift: crank angle at the angle 0 of the trace, in degrees.
    """
    samples = trace.samples
    if trace.level:
        share = (trace.angles - trace.angles[0]) / trace.period
        samples = samples + drift_of(trace, samples)[:, np.newaxis] * share
        if trace.completed:
            samples = np.concatenate((samples[:, :-1], samples[:, :1]), axis=1)
    return samples if trace.pegging is None else samples + _lift(trace, samples, trace.pegging, setting, shift)


def drift_of(trace: Trace, samples: Array) -> Array:
    """Return by how much Pa each cycle (m,) ends too low to go on as it has begun.

    Where the closing sample is missing, straight lines through the samples at both ends estimate it.
    """
    if not trace.completed:
        return np.asarray(samples[:, 0] - samples[:, -1])
    angles, end = trace.angles, trace.angles[-1]
    last = max(3, int(np.searchsorted(-angles[:-1][::-1], LAST - end)))
    first = max(3, int(np.searchsorted(angles, angles[0] + LAST, side="right")))
    before = _line_at(angles[-1 - last : -1] - end, samples[:, -1 - last : -1])
    after = _line_at(angles[:first] - angles[0], samples[:, :first])
    return np.asarray(after - before)


def _line_at(angles: Array, samples: Array) -> Array:
    """Return the values (m,) at angle 0 of the lines of least squares through samples (m, k) at angles (k,)."""
    from_mean = angles - angles.mean()
    slopes = samples @ from_mean / (from_mean @ from_mean)
    return np.asarray(samples.mean(axis=1) - slopes * angles.mean())


def _lift(trace: Trace, samples: Array, pegging: Pegging, setting: Setting, shift: float) -> Array:
    """Return what is added (m, 1) in Pa to every cycle."""
    angle, pressure = _known(pegging, setting)
    away = np.remainder(trace.angles + shift - angle + trace.period / 2, trace.period) - trace.period / 2
    near = np.abs(away) <= max(_AROUND, float(np.abs(away).min()))
    return np.asarray(pressure - samples[:, near].mean(axis=1, keepdims=True))


def _known(pegging: Pegging, setting: Setting) -> tuple[float, float]:
    """Return the crank angle in degrees and the pressure in Pa there, as the trace counts it."""
    inner, outer = setting.mechanism.dead_centres()
    if pegging.angle is not None and pegging.pressure is not None:
        return inner + pegging.angle, pegging.pressure
    begin = (outer if setting.head_end else inner) + (360.0 if setting.cycle == 720 else 0.0)
    return begin, setting.ambient if setting.absolute else 0.0


# exponents

COMPRESSION = -90.0, -40.0
"""Degrees from the firing dead centre between which inlets are closed and nothing burns yet."""
EXPANSION = 60.0, 100.0
"""Degrees from it between which nothing burns any more and outlets are closed still."""
_FEWEST = 5


class Supposed(NamedTuple):
    """What a trace would be if it were read otherwise: put so many degrees later, raised by Pa."""

    later: float = 0.0
    raised: float = 0.0


class Exponent(NamedTuple):
    """An exponent and its standard error."""

    value: float
    error: float


AS_GIVEN = Supposed()


def exponent(pressure: TracePressure, stretch: tuple[float, float], supposed: Supposed = AS_GIVEN) -> Exponent | None:
    """Return −d ln p/d ln V by least squares over a stretch of angle, with absolute pressures.

    None without a clearance, with fewer than five samples there, or where the pressure is not above the vacuum.
    """
    clearance, setting = pressure.trace.clearance, pressure.setting
    if clearance is None:
        return None
    after = from_dead_centre(pressure) + supposed.later
    inside = (after >= stretch[0]) & (after <= stretch[1])
    figures = pressure.pressures[inside] + setting.lift + supposed.raised
    if len(figures) < _FEWEST or not (figures > 0).all():
        return None
    volumes = np.log(stroke_fraction(pressure, after[inside]) + clearance)
    return _slope(volumes, np.log(figures))


def _slope(volumes: Array, pressures: Array) -> Exponent:
    from_mean = volumes - volumes.mean()
    square = float(from_mean @ from_mean)
    slope = float(from_mean @ pressures) / square
    left = pressures - pressures.mean() - slope * from_mean
    return Exponent(0.0 - slope, math.sqrt(float(left @ left) / (len(left) - 2) / square))


def from_dead_centre(pressure: TracePressure) -> Array:
    """Return the angles (n,) in degrees of the samples from the chamber's own (firing) dead centre, −½ to ½ cycle."""
    inner, outer = pressure.setting.mechanism.dead_centres()
    own, cycle = (inner if pressure.setting.head_end else outer), pressure.setting.cycle
    return np.asarray(np.remainder(pressure.trace.angles + pressure.shift - own + cycle / 2, cycle) - cycle / 2)


def stroke_fraction(pressure: TracePressure, after: Array) -> Array:
    """Return the fraction (n,) of the stroke from the chamber's smallest volume, so many degrees after it."""
    mechanism, head = pressure.setting.mechanism, pressure.setting.head_end
    inner, outer = mechanism.dead_centres()
    way = mechanism.coordinate(CrankAngle.of(after + (inner if head else outer))) - mechanism.start
    return np.asarray(way / mechanism.stroke if head else 1 - way / mechanism.stroke)
