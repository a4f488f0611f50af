"""A measured trace, and what corrects it: drift, level, and the dead centre found from a motored trace.

A trace counts crank angles and pressures as its file does. `Setting` is the chamber it was measured in: with it
angles count from the chamber's own (firing) dead centre, and pressures become absolute. Then the exponents of
p V^n = const of compression and expansion follow, and the indicated work.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple

import numpy as np

from kurbel.arrays import Array, Indivisible, Number, Truth
from kurbel.crank_angle import CYCLES, CrankAngle
from kurbel.declared.record import Record, Rule, field
from kurbel.errors import refused
from kurbel.mechanisms.setting import Setting
from kurbel.numerics.pieces import Angles, Pieces, refined
from kurbel.traces.period import Clock

if TYPE_CHECKING:
    from kurbel.traces.heat import HeatLaw

_EVEN = 1e-3  # of a step: what rounded angles may miss
_ROUNDING = 1e-9  # of a period


def period_of(span: float, most_turns: int = 2) -> float:
    """Return the fewest whole turns in degrees, 360 or more, that angles over so many degrees fit into; 0 for more."""
    turns = max(1, math.ceil(span / 360 / (1 + _ROUNDING)))
    return 360.0 * turns if turns <= most_turns else 0.0


def at_equal_steps(angles: Array) -> bool:
    """Return whether angles (n,) that rise over a cycle do so in equal steps, but for their rounding."""
    steps = np.diff(angles)
    return bool(np.abs(steps - steps.mean()).max() <= _EVEN * steps.mean())


class KnownLevel(Record):
    """Where the level of a trace is known, in degrees and Pa: piezoelectric sensors measure changes only."""

    angle: float = field("angle", "Crank angle from the (firing) dead centre")
    pressure: float = field("pressure", "Pressure there, gauge or absolute as in `pressures`")


class Strokes(NamedTuple):
    """What a trace has been measured over instead of angles.

    kind: volume or displacement; swept, smallest: range and smallest of its column, in m³ or m; against: its rows run
    against the time.
    """

    kind: str
    swept: float
    smallest: float
    against: bool


def _placed() -> "Callable[[Trace, Setting], Trace]":
    from kurbel.traces.strokes import placed

    return placed


@dataclass(frozen=True, eq=False)
class Trace(Indivisible):
    """A measured trace over one whole cycle, or over many.

    angles (n,) in degrees as the trace counts them, rising over 360 or 720; samples (m, n) in Pa, of m laps one after
    the other, each over these angles; two samples at one angle are a jump. Laps of 360 deg are cycles of two strokes,
    or in pairs of four. angle_zero: the angle, as the trace counts, of the firing or inner dead centre, in degrees.
    Both ends of a cylinder count from the same dead centre, as one encoder on the shaft does; a mirrored trace follows
    one stroke later. files: where the samples came from, if not from the machine file; notes: what was tidied up in
    them; completed: the last sample is the first one again; clearance: smallest volume over that of the stroke, None
    where it is not known; level: a line over the cycle is taken off so that it closes; pegging: where the level is
    known, as a text at the dead centre where the compression begins, the ambient; against: the file counts its angles
    against the rotation, those here are their negatives; unit: Pa for 1 of the unit, scale: what the figures of the
    file were multiplied by; clock: how times became its angles; suction, discharge: pressures in
    Pa in the lines of a compressor, where they are known; heat: by what its heat release is computed; strokes: what it
    was measured over instead of angles, which then are those of an infinite rod until it is in its chamber; placed: the
    same from then on, when no key moves its angles.
    Raises RuleError for samples that are no such cycle.
    """

    angles: Array
    samples: Array
    angle_zero: float = 0.0
    files: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    completed: bool = False
    clearance: float | None = None
    level: bool = False
    pegging: KnownLevel | str | None = None
    against: bool = False
    unit: float = 1.0
    scale: float = 1.0
    clock: Clock | None = None
    suction: float | None = None
    discharge: float | None = None
    heat: "HeatLaw | None" = None
    strokes: Strokes | None = None
    placed: Strokes | None = None
    burns: ClassVar[bool] = False
    by_steam: ClassVar[bool] = False
    compresses: ClassVar[bool] = False
    traced: ClassVar[Literal[True]] = True
    by_stroke: ClassVar[Literal[False]] = False
    exponents: ClassVar[tuple[Number, ...]] = ()

    def rules_of_events(self, valve_compresses: Truth | None) -> Iterator[Rule]:
        """Yield nothing: a trace has its events as they were measured."""
        return iter(())

    def loaded(self) -> "Trace":
        """Return the trace: as measured, its valves are at work."""
        return self

    def __post_init__(self) -> None:
        alike = (
            self.angles.ndim == 1
            and len(self.angles) > 1
            and self.samples.shape[1:] == self.angles.shape
        )
        rising = alike and (np.diff(self.angles) >= 0).all() and self.period  # nan is not
        if not rising or not np.isfinite(self.samples).all():
            refused(
                "a trace has as many finite pressures as angles, which rise over one whole cycle, 360 or 720 deg"
            )

    @cached_property
    def pressures(self) -> Array:
        """Mean (n,) in Pa of all laps."""
        return self.samples.mean(axis=0)

    def as_written(self, angle: float) -> float:
        """Return an angle of the trace with the sign that it has in the file."""
        return 0.0 - angle if self.against else angle

    @property
    def period(self) -> float:
        """360 or 720; 0 where the angles cover neither."""
        span = float(self.angles[-1] - self.angles[0])
        period = period_of(span)
        return period if span >= period * (1 - _ROUNDING) else 0.0

    @property
    def timed(self) -> bool:
        """Whether its angles come from times."""
        return self.clock is not None

    @property
    def is_free(self) -> bool:
        """Whether a lap is a cycle of whatever machine: cut from times by the period of the pressure alone."""
        return self.clock is not None and self.clock.is_free

    @property
    def even(self) -> bool:
        """Whether the samples are at equal angles."""
        return at_equal_steps(self.angles)

    @property
    def cycles(self) -> tuple[str, ...]:
        """The working cycles that its laps are, or make in pairs."""
        if self.is_free:
            return tuple(CYCLES)
        joins = (self.period, 2 * self.period) if len(self.samples) > 1 else (self.period,)
        return tuple(cycle for cycle, turns in CYCLES.items() if 360.0 * turns in joins)

    def rules_in(self, cycle: str, lift: Number) -> Iterator[Rule]:
        """Yield what does not fit the cycle of the machine."""
        other = next(name for name in CYCLES if name != cycle)
        covers = f"the trace covers {self.period:g} deg, a {cycle} cycle has {360.0 * CYCLES[cycle]:g} deg"
        yield Rule((), cycle not in self.cycles, f"{covers}; write 'cycle: {other}' at the top")

    def over(self, period: float) -> "Trace":
        """Return it with laps that are cycles of these degrees; a last turn that has no other is left out."""
        if self.period == period:
            return self
        if self.is_free:
            return replace(self, angles=self.angles * (period / self.period))
        angles = np.concatenate((self.angles[:-1], self.angles + self.period))
        joined = joined_in_pairs(self.samples)
        notes = self.notes + turns_left_out(len(self.samples), 2)
        return replace(self, angles=angles, samples=joined, completed=True, notes=notes)

    def in_chamber(self, setting: Setting) -> "Trace":
        """Return it over whole cycles of its chamber; what was measured over the stroke gets its crank angles."""
        if self.strokes is None:
            return self.over(setting.cycle)
        return _placed()(self, setting)

    def shift(self, setting: Setting) -> float:
        """Return the angle in degrees that is added to its angles to get crank angles."""
        inner, outer = setting.mechanism.dead_centres()
        return float((outer if setting.mirrored else inner) - self.angle_zero)

    def from_dead_centre(self, setting: Setting) -> Array:
        """Return the angles (n,) in degrees of samples from the chamber's own (firing) dead centre, −½ to ½ cycle."""
        return setting.after_dead_centre(self.angles + self.shift(setting))

    def of_cycle(self, number: int, period: float) -> "Trace":
        """Return one cycle of these degrees alone, counted from 1."""
        of_period = self.over(period)
        return replace(of_period, samples=of_period.samples[number - 1 : number])


def turns_left_out(laps: int, parts: int) -> tuple[str, ...]:
    """Return the note on the last of some laps, which make no whole cycle of so many parts; () where none is left."""
    left = laps % parts
    if not left:
        return ()
    turns = "turn is" if left == 1 else f"{left} turns are"
    return (f"the last {turns} left out: {laps} turns are no whole number of cycles of {parts}",)


def joined_in_pairs(laps: Array) -> Array:
    """Return laps (m, n), each with its closing sample, as cycles (m // 2, 2n − 1) of two laps each."""
    even = laps[: len(laps) // 2 * 2]
    return np.concatenate((even[0::2, :-1], even[1::2, :-1], even[0::2, :1]), axis=1)


# drift and level

_AROUND = 2.5
"""Degrees on either side of the pegging angle over which a cycle's level is the mean: one sample is noise."""
LAST = 2.0
"""Degrees at either end of the cycle through which lines go, as far as there are three samples in them."""


def corrected(trace: Trace, setting: Setting) -> Array:
    """Return the pressures (m, n) in Pa of all cycles, without drift, and pegged; as the trace counts them.

    What is added to a cycle gives it the known pressure where that is known.
    """
    samples, pegging = (
        without_drift(trace, trace.samples) if trace.level else trace.samples,
        trace.pegging,
    )
    if pegging is None:
        return samples
    inner, outer = setting.mechanism.dead_centres()
    if isinstance(pegging, KnownLevel):
        angle, pressure = inner + pegging.angle, pegging.pressure
    else:
        angle, pressure = (
            (outer if setting.head_end else inner) + setting.cycle - 360.0,
            setting.base,
        )
    turned = trace.angles + trace.shift(setting) - angle
    away = np.abs(np.remainder(turned + trace.period / 2, trace.period) - trace.period / 2)
    near = away <= max(_AROUND, float(away.min()))
    return samples + (pressure - samples[:, near].mean(axis=1, keepdims=True))


def without_drift(trace: Trace, samples: Array) -> Array:
    """Return samples (m, n) from each of which a line over the cycle is taken off so that it closes."""
    share = (trace.angles - trace.angles[0]) / trace.period
    levelled = samples + drift_of(trace, samples)[:, np.newaxis] * share
    return (
        np.concatenate((levelled[:, :-1], levelled[:, :1]), axis=1) if trace.completed else levelled
    )


def drift_of(trace: Trace, samples: Array) -> Array:
    """Return by how much Pa each cycle (m,) ends too low to go on as it has begun.

    By lines through both ends where the closing sample is missing.
    """
    if not trace.completed:
        return samples[:, 0] - samples[:, -1]
    to_end, from_begin = trace.angles[:-1] - trace.angles[-1], trace.angles - trace.angles[0]
    last, first = max(3, int((to_end > -LAST).sum())), max(3, int((from_begin <= LAST).sum()))
    before = np.polyfit(to_end[-last:], samples[:, -1 - last : -1].T, 1)[1]
    after = np.polyfit(from_begin[:first], samples[:, :first].T, 1)[1]
    return after - before


_OF_MEDIAN = 1.4826
"""Standard deviation over the median of the magnitude, of what is normally distributed."""
_ENOUGH = 72
"""Samples in a cycle below which differences show its shape instead of the noise."""


def noise_of(pressures: Array) -> float:
    """Return the standard deviation in Pa of the noise of samples (n,) at equal angles over one cycle.

    From the median of the fourth differences, √70 times as large if noise is all they have; of a smooth pressure they
    are small.
    """
    if len(pressures) < _ENOUGH:
        return 0.0
    differences = np.diff(np.append(pressures, pressures[:4]), 4)
    return _OF_MEDIAN * float(np.median(np.abs(differences))) / math.sqrt(70.0)


# exponents

COMPRESSION = -90.0, -40.0
"""Degrees from the firing dead centre between which inlets are closed and nothing burns yet."""
EXPANSION = 60.0, 100.0
"""Degrees from it between which nothing burns any more and outlets are closed still."""
FEWEST = 5
"""Samples on a line, or on a parabola, at least."""


class Exponent(NamedTuple):
    """An exponent, its standard error, the scatter of ln p about the line, and the mean pressure on it in Pa.

    log_volume, log_pressure: means of ln V, over the stroke volume, and of ln p, through which the line goes.
    """

    value: float
    error: float
    scatter: float
    level: float
    log_volume: float
    log_pressure: float


def exponent(
    setting: Setting,
    clearance: float | None,
    after: Array,
    absolute: Array,
    stretch: tuple[float, float],
) -> Exponent | None:
    """Return −d ln p/d ln V by least squares over a stretch of angle.

    after (n,): degrees from the dead centre; absolute (n,): pressures in Pa. None without a clearance, with fewer than
    five samples there, or where the pressure is not above the vacuum.
    """
    inside = (after >= stretch[0]) & (after <= stretch[1])
    if clearance is None or np.count_nonzero(inside) < FEWEST:
        return None
    return polytrope(setting, clearance, after[inside], absolute[inside])


_ON_A_LINE = 4
"""Samples on a line at least, where a trial moves it between them."""


def polytrope(setting: Setting, clearance: float, after: Array, absolute: Array) -> Exponent | None:
    """Return −d ln p/d ln V by least squares of samples (n,); None for too few, or not above the vacuum."""
    if len(absolute) < _ON_A_LINE or not (absolute > 0).all():
        return None
    log_volumes = np.log(setting.stroke_fraction(after) + clearance)
    log_pressures = np.log(absolute)
    log_volume = float(log_volumes.mean())
    log_pressure = float(log_pressures.mean())
    x = log_volumes - log_volume
    y = log_pressures - log_pressure
    spread = float(x @ x)
    if spread <= 0:
        return None
    slope = float(x @ y) / spread
    rest = y - slope * x
    variance = float(rest @ rest) / (len(x) - 2)
    return Exponent(
        value=0.0 - slope,
        error=math.sqrt(variance / spread),
        scatter=math.sqrt(variance),
        level=float(absolute.mean()),
        log_volume=log_volume,
        log_pressure=log_pressure,
    )


# the dead centre from a motored trace: without combustion the pressure peaks just before it

_HALF = 6.0
"""Degrees on either side of the peak through which the parabola goes."""
_SIDES = np.array([np.linspace(near, near + 30.0, 61) for near in (10.0, 30.0, 60.0)])
"""Degrees from the peak at which both its sides are compared: where something burnt, they are not alike."""
_LOW = 0.15
"""Share of the cycle below the level from which pressures are compared."""
_ALIKE = 0.5, 1.15


class Peak(NamedTuple):
    """The peak of a parabola: its place, the standard error of that, and how many samples it goes through."""

    place: float
    error: float
    samples: int


def parabola_peak(positions: Array, values: Array, top: float, width: float) -> Peak | None:
    """Return the peak of the parabola of least squares through samples (n,) within `width` of the top one.

    None where they are fewer than five, or have no peak within that width. A single top sample may be noise: each
    parabola goes on from the peak of the one before.
    """
    for _ in range(3):
        near = np.abs(positions - top) <= width
        along = positions[near] - top
        if len(along) < FEWEST or len(np.unique(along.round(3))) < 3:
            return None
        (bend, slope, _), covariance = np.polyfit(along, values[near], 2, cov=True)
        if not bend < 0 or abs(slope / (2 * bend)) > width:
            return None
        top = top - slope / (2 * bend)
    by_parameters = np.array([slope / (2 * bend**2), -1 / (2 * bend), 0.0])
    return Peak(
        float(top), math.sqrt(max(0.0, by_parameters @ covariance @ by_parameters)), len(along)
    )


def sides_of(top: float, angles: Array, pressures: Array, period: float) -> Array:
    """Return the mean pressures before and after a peak at an angle, on three stretches from near to far, (2, 3)."""
    positions = np.multiply.outer([-1.0, 1.0], _SIDES) + top
    return np.interp(positions, angles, pressures, period=period).mean(axis=-1)


def motored_peak(angles: Array, laps: Array) -> tuple[Peak, float]:
    """Return the peak of a motored trace, and by how many degrees it is uncertain; raises RuleError.

    angles (n,) in degrees over one lap; laps (m, n) in Pa, of which the mean is taken, of turns in pairs.
    """
    if len(laps) % 2 == 0:
        angles, laps = (
            np.concatenate((angles[:-1], angles + angles[-1] - angles[0])),
            joined_in_pairs(laps),
        )
    pressures, period = laps.mean(axis=0)[:-1], float(angles[-1] - angles[0])
    top = float(angles[int(np.argmax(pressures))])
    positions = np.remainder(angles[:-1] - top + period / 2, period) - period / 2
    if np.count_nonzero(np.abs(positions) <= _HALF / 2) < FEWEST:
        refused(
            f"has fewer than five samples within {_HALF / 2:g} deg of its peak; measure it finer"
        )
    peak = parabola_peak(positions, pressures, 0.0, _HALF)
    if peak is None:
        refused("is no motored trace: it has no peak that a parabola could be laid through")
    low = float(np.quantile(pressures, _LOW))
    before, after = sides_of(peak.place, positions, pressures, period) - low
    if not ((_ALIKE[0] * before <= after) & (after <= _ALIKE[1] * before)).all():
        refused(
            "is no motored trace: before and after its peak the pressures differ; name one without combustion"
        )
    narrow_peak = parabola_peak(positions, pressures, peak.place, _HALF / 2)
    # of a peak that is no parabola the half of the samples gives another place; where their noise hides it, its
    # standard error, √8 times that of all, is the bound
    doubt = math.hypot(
        peak.error,
        math.sqrt(8) * peak.error if narrow_peak is None else peak.place - narrow_peak.place,
    )
    return peak._replace(place=top + peak.place), doubt


# The indicated work of a trace: weights of its samples in ∮ p dz over the stroke fraction z.
#
# Samples at equal angles: trapezoid of p z′, z′ = dz/dφ exact, which for a periodic pressure converges far faster than
# the straight lines between the samples. Otherwise the integral of those straight lines, by a rule exact to rounding.

_DENSE = 600
_DENSEST = 20_000
"""Numbers of breaks in a cycle above which its pieces are short enough for few nodes, and for the fewest."""


def by_angle(setting: Setting, derivative: Callable[[CrankAngle], Number], degrees: Array) -> Array:
    """Return a derivative of the stroke fraction z by φ, from that of the coordinate of the mechanism."""
    slope = derivative(CrankAngle.of(degrees)) / setting.mechanism.stroke
    return slope if setting.head_end else -slope


def by_trapezoid(
    setting: Setting, angles: Array, derivative: Callable[[CrankAngle], Number]
) -> Array:
    """Return the weights of the trapezoid rule at crank angles (n,) in degrees; derivative: dx/dφ or d²x/dφ²."""
    steps = np.radians(np.diff(angles)) / 2
    widths = np.append(steps, 0.0) + np.append(0.0, steps)
    return widths * by_angle(setting, derivative, angles)


def by_straight_lines(
    setting: Setting, angles: Array, begin: float = 0.0, turn: float = 720.0
) -> Array:
    """Return the weights of samples at crank angles (n,) in degrees over one cycle in ∫ p dz along straight lines.

    begin: a dead centre from which it is taken over `turn` degrees, at most over the cycle.
    """
    along, slope = angles - angles[0], setting.mechanism.slope
    cycle = float(along[-1])
    turns = np.add.outer(setting.mechanism.dead_centres(), np.arange(0.0, cycle, 360.0)).ravel()
    breaks = np.append(along, turns - angles[0])
    nodes = 16
    if len(breaks) > _DENSE:
        nodes = 10
    if len(breaks) > _DENSEST:
        nodes = 4
    pieces = Pieces.between(Angles(np.zeros(len(breaks), dtype=np.intp), breaks), 1, cycle, nodes)
    pieces, (slopes,) = refined(
        pieces, lambda some: by_angle(setting, slope, some.degrees + angles[0])[None]
    )

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
