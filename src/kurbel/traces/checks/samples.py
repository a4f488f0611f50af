"""Checks of the samples themselves: cycles that differ, wander or do not close, the speed, rounded angles."""

import numpy as np

from kurbel.arrays import Array
from kurbel.traces.checks.doubt import Doubt
from kurbel.traces.correct import drift_of, joined_in_pairs, noise_of, without_drift
from kurbel.traces.period import wandered
from kurbel.traces.reading import ENGINES, TraceReading, in_bar

_PAIRS_DIFFER = 0.5
"""Root mean square by which the turns of a pair differ, over that of their swing: one fires, the other does not."""
_OVER_SCATTER = 4.0
"""The same over what turns scatter by."""
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


def turns_in_pairs(reading: TraceReading) -> Doubt | None:
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
    may_number = trace.even and trace.placed is None
    if not may_number:
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


def recorded_speed(reading: TraceReading) -> Doubt | None:
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


def wandering_cycles(reading: TraceReading) -> Doubt | None:
    """Cycles of one engine do not wander against each other."""
    trace = reading.trace
    degrees = wandered(trace.angles, trace.period, reading.each)
    if not degrees:
        return None
    side = "later" if degrees > 0 else "earlier"
    if trace.timed:
        return Doubt(
            f"the cycles wander {abs(degrees):.3g} deg {side} from the first to the last: the "
            "speed was not constant; record the angle"
        )
    if trace.placed is not None:
        return Doubt(
            f"the pressures wander {abs(degrees):.3g} deg {side} against the {trace.placed.kind}s from the "
            "first cycle to the last: were both recorded at the same time? Check lost samples"
        )
    return Doubt(
        f"the cycles wander {abs(degrees):.3g} deg {side} from the first to the last: does the "
        "angle count the same in each of them? Check 'angle_step' and lost samples"
    )


def rounded_angles(reading: TraceReading) -> Doubt | None:
    """Many samples at the angle of the one before have rounded angles."""
    trace = reading.trace
    twins = int(np.count_nonzero(np.diff(reading.angles) == 0))
    is_of_angles = trace.files and trace.placed is None
    if not is_of_angles or twins < _TWICE * len(reading.angles):
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


def drift(reading: TraceReading) -> Doubt | None:
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
