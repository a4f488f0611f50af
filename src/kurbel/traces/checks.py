"""What is implausible in a measured trace: one table of checks, for the kinds of machine that each can judge.

A check returns None where nothing is wrong, or a doubt: what is seen, what to write, and p_i with and without that
correction, computed from the samples themselves. The trace is then judged again with the correction, since what comes
later may look wrong only because of what comes before: every doubt is shown, the one that misleads the others first.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.unit_systems import show_range
from kurbel.mechanisms.setting import Setting
from kurbel.traces.correct import (
    Exponent,
    Trace,
    drift_of,
    joined_in_pairs,
    noise_of,
    without_drift,
)
from kurbel.traces.lines import Best, best_clearance, least
from kurbel.traces.reading import (
    COMPRESSOR,
    ENGINES,
    EVERY,
    FIRED,
    MOTORED,
    PUMP,
    STEAM,
    UNKNOWN,
    TraceReading,
    in_bar,
)


class Doubt(NamedTuple):
    """A sentence, and the trace with what it asks for; None where that cannot be computed."""

    text: str
    cured: TraceReading | None = None


_MOST_DOUBTS = 4


def doubts(trace: Trace, setting: Setting, each: Array, role: str | None = None) -> list[str]:
    """Return what is implausible in a trace with the pressures `each` (m, n) of its cycles, the strongest first."""
    reading = TraceReading(trace, setting, each, role)
    texts: list[str] = []
    while len(texts) < _MOST_DOUBTS:
        doubt = _first_doubt(reading)
        if doubt is None or doubt.text in texts:
            break
        texts.append(doubt.text)
        if doubt.cured is None:
            break
        reading = doubt.cured
    return texts


def _first_doubt(reading: TraceReading) -> Doubt | None:
    """Return the first doubt of the table on a trace."""
    for check in CHECKS:
        if reading.kind not in check.kinds:
            continue
        doubt = check.judge(reading)
        if doubt is not None:
            return doubt
    return None


# the samples

_PAIRS_DIFFER = 0.5
"""Root mean square by which the turns of a pair differ, over that of their swing: one fires, the other does not."""
_OVER_SCATTER = 4.0
"""The same over what turns scatter by."""
_WANDERED = 10.0
"""Degrees by which the cycles of one engine never move from the first to the last."""
_TWICE = 0.25
"""Share of samples at the angle of the one before, from which on angles are rounded."""
_RANGE = 0.06
"""Share of the pressure where the cycle closes, above the low level, that one cycle and the next may differ by."""
_LEAST = 0.2
"""Share of the ambient by which the ends of a cycle differ from one to the next in any gas exchange."""
_WORTH_IT = 0.01
"""Share of p_i below which a drift is not reported."""
_SURE_OF_NOISE = 6.0
"""Standard deviations of the noise that a drift must exceed."""
_STEEP = 3.0
"""Steps between the samples next to the closing one that a drift must exceed: an admission begins there."""


def _rms(values: Array) -> float:
    """Return the root of the mean square."""
    return float(np.sqrt(np.mean(values**2)))


def _turns_in_pairs(reading: TraceReading) -> Doubt | None:
    """Laps that differ in pairs are the turns of a four-stroke cycle, taken for two strokes, or each for a cycle."""
    trace = reading.trace
    laps = reading.each
    if len(laps) % 2 or trace.timed:
        return None

    # the difference of both means, over their swings and the scatter of the laps
    odd = laps[0::2].mean(axis=0)
    even = laps[1::2].mean(axis=0)
    difference = _rms(odd - even)
    swing = max(_rms(odd - odd.mean()), _rms(even - even.mean()))
    scatter = max(_rms(laps[0::2] - odd), _rms(laps[1::2] - even))
    if difference <= max(_PAIRS_DIFFER * swing, _OVER_SCATTER * scatter):
        return None

    seen = f"differ in pairs, with peaks of {in_bar(odd.max())} and {in_bar(even.max())}"
    if reading.setting.cycle == 360:
        effect = reading.effect(reading, times=2)
        return Doubt(
            f"its turns {seen}: a four-stroke cycle? write 'cycle: four-stroke' at the top; {effect}"
        )
    if not trace.even:  # numbers of samples are
        return None
    joined = joined_in_pairs(laps)
    step = trace.period / (joined.shape[1] - 1)
    angles = trace.angles[0] + step * np.arange(joined.shape[1])
    cured = reading.over(angles, joined)
    return Doubt(
        f"its cycles {seen}: does the angle number the samples of one turn? "
        f"write 'angle_step: {step:g} deg'; {reading.effect(cured)}",
        cured,
    )


_RECORDED_TIMES = 0.05
"""Relative difference of speeds from which on it is written as a factor."""


def _recorded_speed(reading: TraceReading) -> Doubt | None:
    """The period of the pressure shows the speed of a recording by time."""
    trace = reading.trace
    clock = trace.clock
    if clock is None or clock.speed is None or not clock.is_off:
        return None
    size = f"{abs(clock.off):.2%} {'higher' if clock.off > 0 else 'lower'}"
    if abs(clock.off) > _RECORDED_TIMES:
        size = f"{1 + clock.off:.3g} times as high"
    cured = reading.with_clock(clock._replace(recorded=clock.speed))
    return Doubt(
        f"its pressure repeats as at {60 * clock.speed:.6g} rpm (± {max(clock.error, 1e-5):.1g}), "
        f"the recorded speed is {size}: its cycles are cut by the pressure, with p_i "
        f"{in_bar(reading.p_i)}; write 'recorded_speed: {60 * clock.speed:.6g} rpm', or leave it out",
        cured,
    )


def _wandering_cycles(reading: TraceReading) -> Doubt | None:
    """Cycles of one engine do not wander against each other."""
    laps = reading.each
    trace = reading.trace
    if len(laps) < 3:
        return None
    wave = np.exp(-2j * np.pi * trace.angles / trace.period) * np.gradient(trace.angles)
    phases = np.unwrap(np.angle(laps[:, :-1] @ wave[:-1]))
    wandered = float(phases[0] - phases[-1]) * trace.period / (2 * np.pi)
    if abs(wandered) <= _WANDERED:
        return None
    side = "later" if wandered > 0 else "earlier"
    if trace.timed:
        return Doubt(
            f"the cycles wander {abs(wandered):.3g} deg {side} from the first to the last: the "
            "speed was not constant; record the angle"
        )
    return Doubt(
        f"the cycles wander {abs(wandered):.3g} deg {side} from the first to the last: does the "
        "angle count the same in each of them? Check 'angle_step' and lost samples"
    )


def _rounded_angles(reading: TraceReading) -> Doubt | None:
    """Many samples at the angle of the one before have rounded angles."""
    trace = reading.trace
    twins = int(np.count_nonzero(np.diff(reading.angles) == 0))
    if not trace.files or twins < _TWICE * len(reading.angles):
        return None
    begin = -trace.angles[-1] if trace.against else float(trace.angles[0])
    zero = trace.as_written(trace.angle_zero) - begin
    moved = f" and 'angle_zero: {zero:g} deg'" if trace.angles[0] else ""
    angles = trace.angles[0] + reading.step * np.arange(len(reading.angles))
    cured = reading.over(angles, reading.each)
    return Doubt(
        f"{twins} samples have the angle of the one before: rounded angles? "
        f"write 'angle_step: {reading.step:g} deg'{moved}; {reading.effect(cured)}",
        cured,
    )


def _drift(reading: TraceReading) -> Doubt | None:
    """Judge the jump where the cycle closes."""
    p = reading.p
    trace = reading.trace
    jump = float(drift_of(trace, p[np.newaxis])[0])

    # what one cycle and the next, noise, and the steps of the pressure there may differ by
    limits = [
        _RANGE * abs(float(p[0]) - reading.low),
        _LEAST * reading.setting.ambient,
    ]
    if trace.even:
        limits.append(_SURE_OF_NOISE * noise_of(p[:-1]))
    if trace.completed:
        steps = np.abs(np.diff(p))
        bends = np.abs(np.concatenate((np.diff(p[-5:-1], 2), np.diff(p[:4], 2))))
        nearest = np.abs(np.concatenate((np.diff(p[-5:-1]), np.diff(p[:4]))))
        usual = float(np.median(steps[steps > 0])) if steps.any() else 0.0
        limits += [1.5 * usual, 3.0 * float(bends.max())]
        if reading.kind not in ENGINES:
            limits.append(_STEEP * float(nearest.max()))
    if abs(jump) <= max(limits):
        return None

    cured = reading.with_pressures(without_drift(trace, reading.each))
    if abs(cured.p_i - reading.p_i) <= _WORTH_IT * abs(reading.p_i):
        return None
    # a closing sample alone gives way to the first one
    is_closing_sample = not trace.completed and abs(p[-1] - p[-2]) > abs(jump) / 2
    if is_closing_sample:
        closed = np.concatenate((reading.each[:, :-1], reading.each[:, :1]), axis=1)
        cured = reading.with_pressures(closed)
    return Doubt(
        f"the pressure jumps by {in_bar(jump)} where the cycle closes: does the sensor drift? "
        "write 'drift: linear', or leave the closing sample out if it is another cycle's; "
        f"{reading.effect(cured)}",
        cured,
    )


# sign and unit

_LEAST_SWING = 1e3
"""Range in Pa below which a trace is flat."""
_SWINGS = 8.0
"""Swing below the middle of the samples over that above, from which on a trace is inverted."""
_SMALLEST_PEAK = 1e5
_USUAL_PEAK = 60e5
_LARGEST_PEAK = 300e5
"""Absolute pressures in Pa at which cylinders peak, where no clearance gives more."""
_HIGHEST = 350e5
"""Absolute pressure in Pa that no cylinder exceeds."""
_LEVELS = 0.25, 4.0
"""Low level of an engine over the ambient, absolute: throttled, or supercharged."""
_TO_COMPRESSION = 0.25, 8.0
"""Peak over what the compression from the ambient gives: throttled by three quarters, or supercharged and fired."""
_AIR = 1.32
_NEAR_VACUUM = 0.1
"""Share of the ambient below which a low level cannot be an absolute pressure."""
_UNITS = {
    "Pa": 1.0,
    "mbar": 1e2,
    "kPa": 1e3,
    "psi": 6894.757293168,
    "bar": 1e5,
    "MPa": 1e6,
}
"""Unit -> Pa; a technical atmosphere is a bar for all that a pressure shows."""
_POWERS = (1e-3, 1e-2, 1e-1, 10.0, 1e2, 1e3)
"""Factors that convert no unit into another."""
_NO_UNIT = 0.5
"""By how much, in logarithms, such a factor must fit better than a unit."""
_NEARLY_AS_GOOD = 1.2
"""By how much, in logarithms, a unit may fit worse and be named as well."""
_SAME_UNIT = 0.05
"""Largest relative difference of units that cannot be distinguished, such as at and bar."""
_ENGINE = 8.0
"""Peak over low level, absolute, that four strokes have at least."""


def _inverted(reading: TraceReading) -> Doubt | None:
    """An inverted trace, as of a charge amplifier with the wrong polarity."""
    lowest, middle, highest = np.quantile(reading.p, (0.0, 0.5, 1.0)).tolist()
    if middle - lowest < _SWINGS * max(highest - middle, _LEAST_SWING):
        return None
    is_below_vacuum = lowest + reading.setting.lift < -_LEAST_SWING
    if reading.kind not in ENGINES and not is_below_vacuum:
        return None
    cured = reading.with_pressures(-reading.each)
    return Doubt(
        f"its swing from {in_bar(middle)} goes down to {in_bar(lowest)}: is it inverted? write "
        f"'scale: {-reading.trace.scale:g}'; {reading.effect(cured)}",
        cured,
    )


class Factor(NamedTuple):
    """What pressures are multiplied by; unit: which then fits, '' for none; away: from an engine, in logarithms."""

    value: float
    unit: str
    away: float


class _Sizes:
    """What a trace of an engine would be in other units: its level by the ambient, its peak by the clearance."""

    def __init__(self, reading: TraceReading) -> None:
        self.reading = reading
        self.ambient = reading.setting.ambient
        clearance = reading.trace.clearance
        four_strokes = reading.setting.cycle == 720 and reading.setting.head_end

        # the range of peaks; four strokes compress more than a little, whatever the clearance
        self.compressed = _USUAL_PEAK / 2
        self.least_of_all = _SMALLEST_PEAK + self.ambient if four_strokes else 0.0
        self.most = _LARGEST_PEAK
        self.least = self.least_of_all
        self.range = f"cylinders peak at {show_range(_SMALLEST_PEAK, _LARGEST_PEAK, 'pressure')}"
        if clearance:
            self.compressed = self.ambient * (1 + 1 / clearance) ** _AIR
            self.least = _TO_COMPRESSION[0] * self.compressed
            self.most = max(_TO_COMPRESSION[1] * self.compressed, _SMALLEST_PEAK)
            self.range = f"compression gives about {in_bar(self.compressed)}"

        # a pegged trace keeps its level in whatever unit
        self.level = reading.low if reading.trace.pegging else 0.0

    @property
    def has_level(self) -> bool:
        """Whether its low level is one of engines, which shows that the unit is right, whatever the clearance."""
        setting = self.reading.setting
        if not setting.absolute or self.reading.trace.pegging or not self.ambient:
            return False
        share = self.reading.low / self.ambient
        is_usual = _LEVELS[0] <= share <= _LEVELS[1]
        peak = self.reading.peak
        return is_usual and max(self.least_of_all, _ENGINE * self.reading.low) <= peak <= _HIGHEST

    def scaled(self, factor: float, pressure: float) -> float:
        """Return an absolute pressure in Pa with figures so many times as large."""
        return self.level + factor * (pressure - self.level) + self.reading.setting.lift

    def in_range(self, factor: float) -> bool:
        """Return whether the peak is then one of cylinders."""
        peak = self.scaled(factor, self.reading.peak)
        return self.least <= peak <= max(self.most, self.ambient)

    def compresses(self, factor: float) -> bool:
        """Return whether the peak is then high over the low level."""
        if self.reading.setting.cycle == 360:
            return True
        low = self.scaled(factor, self.reading.low)
        base = self.ambient if 0 < low < _NEAR_VACUUM * self.ambient else low
        return self.scaled(factor, self.reading.peak) > _ENGINE * base

    def away(self, factor: float) -> float:
        """Return by how much, in logarithms, the peak then is not the usual one, and a level not the ambient."""
        level = 1.0
        if not self.reading.setting.lift:
            level = max(self.scaled(factor, self.reading.low) / max(self.ambient, 1.0), 1e-3)
        peak = max(self.scaled(factor, self.reading.peak) / max(2 * self.compressed, 1.0), 1e-9)
        return abs(math.log(peak)) + abs(math.log(level))

    def factors(self) -> list[Factor]:
        """Return the factors other than 1 that give a peak in range, the most likely first."""
        factors = []
        for unit, size in _UNITS.items():
            factor = size / self.reading.trace.unit
            if abs(factor - 1) > _SAME_UNIT and self.in_range(factor):
                factors.append(Factor(factor, unit, self.away(factor)))
        for factor in _POWERS:
            if self.in_range(factor):
                factors.append(Factor(factor, "", self.away(factor) + _NO_UNIT))
        return sorted(factors, key=lambda factor: factor.away)


def _unit(reading: TraceReading) -> Doubt | None:
    """Judge the peak by what this clearance can compress to, or else by what cylinders withstand."""
    sizes = _Sizes(reading)
    if sizes.has_level:
        return None
    is_in_range = sizes.in_range(1.0)
    if is_in_range and sizes.compresses(1.0):
        return None
    # of what no unit makes an engine, a peak that no cylinder has is reported nevertheless
    possible = sizes.factors()
    likely = [factor for factor in possible if sizes.compresses(factor.value)]
    if not likely and not is_in_range:
        likely = possible
    if not likely:
        return None

    best = likely[0]
    lift = reading.setting.lift
    peak = reading.peak + lift
    can = sizes.range
    if sizes.least <= peak <= sizes.most:
        can = f"four strokes compress more than from {in_bar(reading.low + lift)}"
    times = max(best.value, 1 / best.value)
    size = "large" if best.value < 1 else "small"
    unit = f" (unit: {best.unit} fits)" if best.unit else ""
    level = sizes.level
    cured = reading.with_pressures(level + best.value * (reading.each - level))

    # a unit that would nearly do
    others = [factor for factor in likely[1:] if factor.unit]
    also = ""
    if not best.unit and others and others[0].away < best.away - _NO_UNIT + _NEARLY_AS_GOOD:
        also = f"; or is its unit {others[0].unit}?"
    return Doubt(
        f"the peak is {in_bar(peak)} absolute, where {can}: pressures {times:.4g} times too "
        f"{size}? correct 'unit'{unit}, or write 'scale: {reading.trace.scale * best.value:g}'; "
        f"{reading.effect(cured)}{also}",
        cured,
    )


# the place of the peak of an engine

_FIRED_AT = -15.0, 45.0
"""Degrees after the firing dead centre between which a fired four-stroke cycle peaks."""
_TWO_STROKE_AT = -50.0, 60.0
"""The same in two strokes, where the ports decide what burns."""
_AIMED = -2.0, 30.0
"""Where a peak is to be after quarter turns."""
_USUAL = 8.0
"""Degrees after the dead centre at which fired engines peak, more or less."""
_MOTORED_LEAD = 1.5
"""Degrees; heat loss and leakage put a motored peak up to about 1° before the dead centre."""
_MOTORED_SEARCH = -10.0, 30.0
"""Degrees after the dead centre; what peaks elsewhere is found as any other peak."""
_SURE = 3.0
"""Standard errors of the place of the peak, and what a crooked peak may be off."""
_OFF = 0.1
"""Degrees."""


def _usual_range(reading: TraceReading) -> tuple[float, float]:
    """Return the degrees after the dead centre between which such an engine peaks."""
    return _FIRED_AT if reading.setting.cycle == 720 else _TWO_STROKE_AT


def _backward(reading: TraceReading) -> Doubt | None:
    """A peak just before the dead centre, and work that is taken, are those of an angle in the other sense."""
    peak_at = reading.peak_at
    is_early = -60.0 < peak_at < -_MOTORED_LEAD - reading.step
    if not reading.is_engine or not is_early or reading.kind == MOTORED:
        return None
    first, last = _usual_range(reading)
    if not first <= -peak_at <= last or reading.p_i >= 0:
        return None
    clearance = reading.trace.clearance
    is_known = reading.setting.cycle == 720 or reading.role is not None or clearance is not None
    if not is_known:
        return None
    # where its lines are those of no gas another fault is likelier
    chamber = reading.worked
    if chamber is not None and clearance and chamber.misfit(reading.gas, clearance) > _STRANGE:
        return None
    cured = reading.turned()
    if cured.p_i <= 0:
        return None
    return Doubt(
        f"the peak is {-peak_at:.3g} deg before the dead centre and the cycle takes work: does its "
        f"angle count against the rotation? write '{_sense_key(reading)}'; {reading.effect(cured)}",
        cured,
    )


def _sense_key(reading: TraceReading) -> str:
    """Return the key that lets the angle count in the other sense."""
    return f"angle_sense: {'with' if reading.trace.against else 'against'}"


def _peak_elsewhere(reading: TraceReading) -> Doubt | None:
    """A peak that is nowhere near the dead centre: by quarter turns, or to where such a peak usually is."""
    peak_at = reading.peak_at
    first, last = _usual_range(reading)
    if not reading.is_engine or first <= peak_at <= last:
        return None
    later = 90.0 * round((peak_at - _USUAL) / 90.0)
    zero = reading.trace.angle_zero
    if reading.kind == MOTORED:
        later = peak_at
    elif not _AIMED[0] <= peak_at - later <= _AIMED[1]:
        later = round(zero + peak_at - _USUAL) - zero
        cured = reading.put_later(later)
        shift = _shift_by_lines(cured)
        later += 0.0 if shift is None else -shift.value
    cured = reading.put_later(later)
    cycle = reading.setting.cycle
    where = "firing dead centre" if cycle == 720 else "dead centre"
    gas_exchange = ", in the gas exchange" if abs(peak_at) > 180 else ""
    side = "after" if peak_at > 0 else "before"
    return Doubt(
        f"the peak is {abs(reading.top_at):.4g} deg {side} the {where}{gas_exchange}: "
        f"write {reading.zero_later(later)}; {reading.effect(cured)}",
        cured,
    )


def _motored_peak(reading: TraceReading) -> Doubt | None:
    """The peak of a motored engine is at the dead centre, or just before it."""
    peak = reading.vertex
    after = reading.peak_at
    if peak is None or not reading.is_engine:
        return None
    if not _MOTORED_SEARCH[0] <= after <= _MOTORED_SEARCH[1]:
        return None
    sure = _OFF + _SURE * peak.error
    if -_MOTORED_LEAD - sure <= after <= sure:
        return None
    cured = reading.put_later(after)
    side = "after" if after > 0 else "before"
    effect = reading.effect(cured).replace("is then", "is")
    return Doubt(
        f"no combustion shows, and the peak is {abs(after):.2g} deg {side} the dead centre; that "
        f"of a motored engine is at it or just before: check angle_zero; with "
        f"{reading.zero_later(after)} {effect}",
        cured,
    )


# the dead centre of what has valves, ports or slides

_AT_SMALLEST = 30.0
"""Degrees on either side of a dead centre over which pressures are compared."""
_PUMP_LATE = 2.0
_PUMP_OFF = 30.0
_STEAM_LEAD = 5.0
_STEAM_OFF = 35.0
_COMPRESSOR_LATE = 10.0
_COMPRESSOR_OFF = 30.0
"""Degrees by which the flanks are usually late, or early, and by which they are off at least where that is wrong."""
_QUARTER = 12.0
"""Degrees from quarter turns within which a dead centre that flanks show is one of these."""
_SHIFTED = 5.0
"""Degrees; what a dead centre by the lines of a compressor must be off at least."""


def _from_half_turn(degrees: float) -> float:
    """Return an angle between −180 and 180 degrees."""
    return math.remainder(degrees, 360.0)


def _other_sense(reading: TraceReading) -> Doubt | None:
    """A compressor rises slowly and falls quickly, a steam engine the other way: else time runs backward."""
    if reading.flanks is None or reading.role is None:
        return None
    rise, fall = reading.flanks
    slow, quick = rise.width, fall.width
    of_kind = "a compressor rises slowly, between its valves, and falls quickly"
    if reading.kind == STEAM:
        slow, quick = quick, slow
        of_kind = "a steam engine rises quickly, when steam is admitted, and falls slowly"
    if slow * _SLOWER > quick:
        return None
    cured = reading.turned()
    return Doubt(
        f"the pressure rises over {rise.width:.3g} deg and falls over {fall.width:.3g} deg; that "
        f"of {of_kind}: does its angle count against the rotation? write "
        f"'{_sense_key(reading)}'; {reading.effect(cured)}",
        cured,
    )


_SLOWER = 1.4
"""Width of the slower flank over that of the other one, from which on it is the slower."""


def _flanks_elsewhere(reading: TraceReading) -> Doubt | None:
    """Judge the dead centre by the flanks: each kind begins or ends one of them there."""
    if reading.flanks is None:
        return None
    rise, fall = reading.flanks
    if reading.kind == PUMP:
        # the fall begins at the smallest volume, the rise at the largest
        from_fall = _from_half_turn(fall.begin)
        from_rise = _from_half_turn(rise.begin - 180.0)
        off = from_fall + _from_half_turn(from_rise - from_fall) / 2 - _PUMP_LATE
        most = _PUMP_OFF
        event = "the delivery of a pump ends"
    elif reading.kind == STEAM:
        off = rise.end + _STEAM_LEAD
        most = _STEAM_OFF
        event = "the admission of a steam engine is"
    else:
        off = fall.begin - _COMPRESSOR_LATE
        most = _COMPRESSOR_OFF
        event = "the delivery of a compressor ends"
    off = _from_half_turn(off)
    if abs(off) <= most:
        return None

    # the lines are more exact where a clearance is known
    shift = _shift_by_lines(reading, 180.0)
    later = off
    error = 0.0
    if shift is not None:
        later = _from_half_turn(-shift.value)
        error = abs(reading.put_later(later + shift.error).p_i - reading.put_later(later).p_i)
    quarter = 90.0 * round(later / 90.0)
    if quarter and abs(later - quarter) <= _QUARTER:
        later = quarter
        error = 0.0
    cured = reading.put_later(later)
    other_end = _or_other_end(reading, later)
    return Doubt(
        f"{event} at the dead centre where its chamber is smallest, here {abs(off):.3g} deg "
        f"{'after' if off > 0 else 'before'} it: write {reading.zero_later(later)}"
        f"{other_end}; {reading.effect(cured, error)}",
        None if other_end else cured,
    )


def _or_other_end(reading: TraceReading, later: float) -> str:
    """Return a question where half a turn may be the other end of the cylinder."""
    if abs(abs(later) - 180.0) > 1.0:
        return ""
    other = "crank" if reading.setting.head_end else "head"
    return f", or is it the trace of the {other} end?"


def _high_at_largest(reading: TraceReading) -> Doubt | None:
    """In every chamber the pressure near its smallest volume exceeds that near its largest."""
    after = reading.after
    if reading.setting.cycle == 720:
        return None
    at_smallest = np.abs(after) <= _AT_SMALLEST
    at_largest = np.abs(after) >= 180.0 - _AT_SMALLEST
    if not at_smallest.any() or not at_largest.any():
        return None
    high = float(reading.p[at_smallest].mean())
    low = float(reading.p[at_largest].mean())
    swing = reading.peak - float(reading.p.min())
    if high >= low or low - high < max(0.1 * swing, _LEAST_SWING):
        return None
    cured = reading.put_later(180.0)
    return Doubt(
        f"near the dead centre where its chamber is smallest the pressure is {in_bar(high)}, near "
        f"the other one {in_bar(low)}: write {reading.zero_later(180.0)}"
        f"{_or_other_end(reading, 180.0)}; {reading.effect(cured)}",
    )


def _shift_by_lines(reading: TraceReading, most: float = 45.0) -> Best | None:
    """Return by how many degrees a trace must be later for its lines; None where it has no clearance or no lines."""
    chamber = reading.worked
    clearance = reading.trace.clearance
    if chamber is None or not clearance:
        return None

    def misfit(later: float) -> float:
        return chamber.misfit(reading.gas, clearance, later) + _peak_misfit(reading, later)

    shift = least(misfit, np.arange(-most, most + 1.0, 3.0).tolist())
    return shift if shift.misfit <= _STRANGE else None


_FIRED_PEAK = -3.0, 25.0
_FIRED_SPREAD = 5.0
_MOTORED_PEAK = -1.5, 0.3
_MOTORED_SPREAD = 0.5
"""Degrees after the dead centre between which peaks are usual, and what they may be off beyond."""


def _peak_misfit(reading: TraceReading, later: float) -> float:
    """Return the squared distance of the peak of an engine from where it usually is."""
    if not reading.is_engine:
        return 0.0
    first, last = _FIRED_PEAK
    spread = _FIRED_SPREAD
    if reading.kind == MOTORED:
        first, last = _MOTORED_PEAK
        spread = _MOTORED_SPREAD
    half = reading.setting.cycle / 2
    peak_at = math.remainder(reading.peak_at + later, 2 * half)
    beyond = max(first - peak_at, peak_at - last, 0.0)
    return (beyond / spread) ** 2


# level

_NEAR_AMBIENT = 0.7, 1.3
_BELOW = 0.8
"""Share of the ambient by which gauge pressures of an engine lie below it at most; what is lower has no level."""
_SENSIBLE = 1.2, 1.4
"""Exponents of a compression of air or mixture; less is wet or leaks, more than that of air cannot be."""
_SLACK = 0.02
_APART = 0.08
_APART_FIRED = 0.14
"""By which the exponent of the compression is below, or above, that of the expansion, in engines as they are: the loss
angle is worth 0.03, and burnt gas that loses no heat expands with 1.26 where air is compressed with 1.38."""
_VACUUM_NOISE = 0.02
"""Share of the swing below the vacuum that noise and pegging explain, of what is no engine."""


def _level(reading: TraceReading) -> Doubt | None:
    """Judge by the level below which the cycle lies for a while whether gauge and absolute are mixed up."""
    setting = reading.setting
    low = reading.low
    ambient = setting.ambient
    is_engine = reading.kind in ENGINES
    seen = f"for 15 % of the cycle the pressure lies below {in_bar(low)}"
    stays = f"p_i stays, P changes by {in_bar(ambient)} times the area"
    nearly_vacuum = _NEAR_VACUUM * ambient
    if not is_engine:
        nearly_vacuum = -_VACUUM_NOISE * (reading.peak - low)

    is_near_vacuum = -_BELOW * ambient <= low < nearly_vacuum
    if setting.absolute and is_near_vacuum:
        return Doubt(
            f"{seen} absolute: these look like gauge pressures; write 'pressures: gauge'; {stays}"
            f"{_or_another_unit(reading)}",
            reading.with_reference(),
        )
    vacuum = 0.0 if setting.absolute else -ambient
    noise = 0.0 if is_engine else _VACUUM_NOISE * (reading.peak - low)
    if low < vacuum - noise:
        remedy = "correct 'pegging'" if reading.trace.pegging else "write 'pegging: ambient'"
        return Doubt(f"{seen}, the perfect vacuum being at {in_bar(vacuum)}; {remedy}; {stays}")

    is_near_ambient = _NEAR_AMBIENT[0] < low / max(ambient, 1.0) < _NEAR_AMBIENT[1]
    if setting.absolute or not is_near_ambient or not is_engine or reading.trace.clearance:
        return None
    return Doubt(
        f"{seen} gauge, about the ambient: absolute? Then write 'pressures: absolute'; {stays}; "
        "a 'compression_ratio' would tell by the compression",
        reading.with_reference(),
    )


def _or_another_unit(reading: TraceReading) -> str:
    """Return a question where the level of an engine may be low by its unit alone."""
    low = reading.low
    if reading.kind not in ENGINES or low <= 0:
        return ""
    for unit, size in _UNITS.items():
        factor = size / reading.trace.unit
        share = factor * low / max(reading.setting.ambient, 1.0)
        is_likely = _LEVELS[0] <= share <= 1.5 and factor * reading.peak <= _HIGHEST
        if factor > 1 and is_likely:
            return f"; or is its unit {unit}?"
    return ""


# both lines: the dead centre, the clearance and the level

_STRANGE = 8.0
"""Misfit from which on lines are not those of a gas; of good traces it is below 3."""
_BETTER = 6.0
"""By how much the misfit falls at least with what is to be written."""
_FREE = 1.0
_FREE_CLEARANCE = 3.0
"""What a dead centre and a clearance that are found cost, against a word that is wrong: the former are off by a little
more often."""
_AS_LIKELY = 3.0
"""Misfits that differ by less leave the choice."""
_LATEST = 45.0
"""Largest error of a dead centre in degrees that is found here."""


class Cure(NamedTuple):
    """What makes both lines those of a gas: the misfit then, the words, the trace then, and how far p_i is sure."""

    misfit: float
    text: str
    cured: TraceReading
    error: float = 0.0


def _is_sensible(line: Exponent | None) -> bool:
    """Return whether there is an exponent, and one that the compression of an engine can have."""
    if line is None:
        return False
    slack = _SLACK + 2 * line.error
    return _SENSIBLE[0] - slack <= line.value <= _SENSIBLE[1] + slack


def _lines_of_no_gas(reading: TraceReading) -> Doubt | None:
    """Judge both lines: a dead centre, a clearance or a level that is wrong makes them none of a gas.

    A dead centre that is off moves their exponents apart, a clearance moves both the same way, and a wrong level that
    of the compression most.
    """
    lines = reading.lines
    clearance = reading.trace.clearance
    chamber = reading.worked
    if lines is None or chamber is None or not clearance:
        return _no_line(reading)
    if reading.kind in ENGINES and not reading.is_engine:
        return None
    misfit = chamber.misfit(reading.gas, clearance) + _peak_misfit(reading, 0.0)
    is_strange = misfit > _STRANGE
    error = 2 * math.hypot(lines.compression.error, lines.expansion.error)
    most = _APART_FIRED if reading.kind == FIRED else _APART
    is_beyond = not -_APART - error <= lines.apart <= most + error
    are_parted = reading.kind in ENGINES and is_beyond
    is_sensible = reading.kind == COMPRESSOR or _is_sensible(lines.compression)
    if not is_strange and not are_parted and is_sensible:
        return None

    seen = (
        f"its compression goes by p V^{lines.compression.value:.3g} and its expansion by "
        f"p V^{lines.expansion.value:.3g}"
    )
    if not are_parted and not is_sensible:
        seen = (
            f"its compression goes by p V^{lines.compression.value:.3g}, where air has 1.2 to 1.4"
        )

    # the cure that leaves the least misfit, and others that are as likely
    cures = sorted(_cures_of_lines(reading), key=lambda cure: cure.misfit)
    best = cures[0] if cures else None
    needs_cure = are_parted or not is_sensible
    least_gain = _FREE if needs_cure else _BETTER
    if best is None or misfit - best.misfit < least_gain or best.misfit > _STRANGE:
        if not is_strange and is_sensible:
            return None
        by_shape = reading.kind == COMPRESSOR and reading.role is None
        else_kind = ", or write what the machine is ('role')" if by_shape else ""
        return Doubt(
            f"{seen}: correct the level ('pegging', 'offset'; p_i stays), "
            f"or the clearance{else_kind}"
        )
    others = [cure.text for cure in cures[1:] if cure.misfit - best.misfit < _AS_LIKELY]
    also = "".join(f"; or {text}" for text in others)
    effect = reading.effect(best.cured, best.error)
    # where the choice is left, nothing is judged with one of them
    cured = None if others else best.cured
    return Doubt(f"{seen}: {best.text}; {effect}{also}", cured)


def _no_line(reading: TraceReading) -> Doubt | None:
    """Where absolute pressures are none at all on the compression, gauge pressures may be meant."""
    chamber = reading.worked
    clearance = reading.trace.clearance
    if chamber is None or not clearance or not reading.is_engine or not reading.setting.absolute:
        return None
    ambient = reading.setting.ambient
    if chamber.misfit(reading.gas, clearance, raised=ambient) > _STRANGE:
        return None
    return Doubt(
        "its compression is not above the vacuum: these look like gauge pressures; write "
        f"'pressures: gauge'; p_i stays, P changes by {in_bar(ambient)} times the area",
        reading.with_reference(),
    )


_LEVEL_SPREAD = 0.7
"""Standard deviation of the logarithm of the low level of an engine over the ambient: throttled or supercharged."""


def _level_misfit(low: float, ambient: float) -> float:
    """Return the squared distance of the low level of an engine, absolute, from the ambient."""
    if ambient <= 0:
        return 0.0
    share = max(low / ambient, 1e-3)
    return (math.log(share) / _LEVEL_SPREAD) ** 2


def _cures_of_lines(reading: TraceReading) -> list[Cure]:
    """Return what would make both lines those of a gas: each fault alone."""
    chamber = reading.worked
    clearance = reading.trace.clearance
    if chamber is None or not clearance:
        return []
    gas = reading.gas
    cures = []

    # gauge and absolute
    ambient = reading.setting.ambient
    is_absolute = reading.setting.absolute
    raised = ambient if is_absolute else -ambient
    reference = "gauge" if is_absolute else "absolute"
    misfit = chamber.misfit(gas, clearance, raised=raised) + _peak_misfit(reading, 0.0)
    if reading.kind in ENGINES:
        low = reading.low + reading.setting.lift
        misfit += _level_misfit(low + raised, ambient) - _level_misfit(low, ambient)
    cures.append(Cure(misfit, f"write 'pressures: {reference}'", reading.with_reference()))

    # the sense of the angle
    if reading.kind == FIRED and reading.p_i < 0:
        turned = reading.turned()
        if turned.worked is not None and turned.p_i > 0:
            misfit = turned.worked.misfit(gas, clearance) + _peak_misfit(turned, 0.0)
            text = f"does its angle count against the rotation? write '{_sense_key(reading)}'"
            cures.append(Cure(misfit, text, turned))

    # the dead centre, which never makes a fired engine take work
    shift = _shift_by_lines(reading, _LATEST)
    if shift is not None:
        later = round(-shift.value, 1)
        moved = reading.put_later(later)
        error = abs(reading.put_later(later + shift.error).p_i - moved.p_i)
        spoils = reading.kind == FIRED and reading.p_i > 0 > moved.p_i
        if not spoils:
            text = (
                f"a dead centre {abs(later):.2g} deg off does that; "
                f"write {reading.zero_later(later)}"
            )
            cures.append(Cure(shift.misfit + _FREE, text, moved, error))

    # the clearance
    best = best_clearance(chamber, gas)
    likely = math.exp(best.value)
    text = f"write 'compression_ratio: {1 + 1 / likely:.3g}'"
    if reading.kind == COMPRESSOR:
        text = f"write 'clearance: {likely:.3g}'"
    misfit = best.misfit + _FREE_CLEARANCE + _peak_misfit(reading, 0.0)
    text = f"{text} instead of the clearance of {clearance:.3g}"
    cures.append(Cure(misfit, text, reading.with_clearance(likely)))
    return cures


# the table


class Check(NamedTuple):
    """A row of the table: the kinds of machine that it can judge, and the function that does so."""

    kinds: frozenset[str]
    judge: Callable[[TraceReading], Doubt | None]


_MOTORED_ONLY = frozenset((MOTORED,))
_WITH_LINES = ENGINES | {COMPRESSOR}
_WITH_SENSE = frozenset((COMPRESSOR, STEAM))
_WITH_FLANKS = frozenset((COMPRESSOR, STEAM, PUMP))
_WITHOUT_SHAPE = frozenset((UNKNOWN, PUMP, STEAM, COMPRESSOR))

CHECKS: tuple[Check, ...] = (
    Check(EVERY, _recorded_speed),
    Check(EVERY, _turns_in_pairs),
    Check(EVERY, _wandering_cycles),
    Check(EVERY, _rounded_angles),
    Check(EVERY, _drift),
    Check(EVERY, _inverted),
    Check(ENGINES, _unit),
    Check(_WITH_SENSE, _other_sense),
    Check(_WITH_FLANKS, _flanks_elsewhere),
    Check(_WITHOUT_SHAPE, _high_at_largest),
    Check(ENGINES, _backward),
    Check(ENGINES, _peak_elsewhere),
    Check(_MOTORED_ONLY, _motored_peak),
    Check(EVERY, _level),
    Check(_WITH_LINES, _lines_of_no_gas),
)
"""What is judged, in this order: a fault before those that it misleads."""
