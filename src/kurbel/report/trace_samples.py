"""What looks wrong with the samples of a trace: drift, angles that stand twice, turns that belong together."""

import numpy as np

from kurbel.report.trace_readings import Reading, in_bar
from kurbel.solver.trace import LAST, drift_of

_RANGE = 0.06
"""Share of the pressure where the cycle closes, above the low level, that one cycle and the next may differ by."""
_LEAST = 0.2
"""Share of the ambient by which the ends of a cycle differ from one to the next in any gas exchange."""
_WORK = 0.01
"""Share of p_i below which a drift is not worth a word."""
_SURE = 6.0
"""Standard deviations of the noise that a drift must stand out by."""
_WANDERED = 10.0
"""Degrees by which the cycles of one engine never move from the first to the last."""
_LAPPED = 0.05
"""Share of a cycle by which each may wander against the one before; beyond, others lie over it."""
_TWICE = 0.25
"""Share of samples that stand at the angle of the one before, from which on angles are rounded."""
_OTHER = 0.2
"""Share of the range by which the turns of a two-stroke cycle never differ by twos."""


def _of_turns(reading: Reading) -> str:
    """Laps that differ by twos are the turns of a four-stroke cycle, taken for two strokes, or each for a cycle."""
    each, trace = reading.pressure.each, reading.trace
    if len(each) < 2 or len(each) % 2:
        return ""
    odd, even = each[0::2].mean(axis=0), each[1::2].mean(axis=0)
    if np.abs(odd - even).max() <= _OTHER * max(np.ptp(odd), np.ptp(even)):
        return ""
    peaks = f"differ by twos, with peaks of {in_bar(odd.max())} and {in_bar(even.max())}"
    if reading.setting.cycle == 360:
        return (
            f"its turns {peaks}: a four-stroke cycle? write 'cycle: four-stroke' at the top; p_i is then "
            f"{in_bar(2 * reading.pressure.area)} instead of {in_bar(reading.pressure.area)}"
        )
    step = trace.period / (len(trace.angles) - 1) / 2
    angles = np.arange(2 * len(trace.angles) - 1) * step
    joined = np.concatenate((each[0::2, :-1], each[1::2, :-1], each[0::2, :1]), axis=1)
    other = reading.otherwise(angles=angles, samples=joined, pegging=None, level=False)
    return (
        f"its cycles {peaks}: does the angle number the samples of one turn? write 'angle_step: {step:g} deg'; "
        f"{reading.against(other)}"
    )


def _of_speed(reading: Reading) -> str:
    """Cycles of one engine do not wander against each other; those that are told by time and a wrong speed do."""
    each, trace = reading.pressure.each, reading.trace
    if len(each) < 3:
        return ""
    wave = np.exp(-2j * np.pi * trace.angles / trace.period) * np.gradient(trace.angles)
    phases = np.unwrap(np.angle(each[:, :-1] @ wave[:-1]))
    wandered = float(phases[0] - phases[-1]) * trace.period / (2 * np.pi)
    if abs(wandered) <= _WANDERED:
        return ""
    off = wandered / (trace.period * (len(each) - 1))
    change = f"{abs(1 / (1 + off) - 1):.2%} {'lower' if off > 0 else 'higher'}"
    told = f" If it is told by time: a 'recorded_speed' about {change} brings both together"
    way = told if abs(off) < _LAPPED else ""
    first, last = (float(reading.pressure.weights @ one) for one in (each[0], each[-1]))
    return (
        f"the cycles wander {abs(wandered):.3g} deg {'later' if off > 0 else 'earlier'} from the first to the last, "
        f"and p_i goes from {in_bar(first)} to {in_bar(last)}: was the speed another, or not constant?{way}"
    )


def _of_twins(reading: Reading) -> str:
    trace = reading.trace
    twins = int(np.count_nonzero(np.diff(trace.angles) == 0))
    if twins < _TWICE * len(trace.angles):
        return ""
    step = trace.period / (len(trace.angles) - 1)
    even = trace.angles[0] + step * np.arange(len(trace.angles))
    even[-1] = trace.angles[-1]
    other = reading.otherwise(angles=even)
    zero = trace.written_zero - (-trace.angles[-1] if trace.against else float(trace.angles[0]))
    moved = f" and 'angle_zero: {zero:g} deg'" if trace.angles[0] else ""
    key = f"write 'angle_step: {step:g} deg'{moved}" if trace.files else "give each point an angle of its own"
    return f"{twins} samples stand at the angle of the one before: rounded angles? {key}; {reading.against(other)}"


def _of_drift(reading: Reading) -> str:
    pressure = reading.pressure
    jump = float(drift_of(reading.trace, pressure.pressures[np.newaxis])[0])
    closes = abs(float(pressure.pressures[0]) - reading.low)
    if abs(jump) <= max(_RANGE * closes, _LEAST * reading.setting.ambient, _doubt(reading)):
        return ""
    other = reading.otherwise(level=True)
    change = abs(other.pressure.area - pressure.area)
    if change <= _WORK * abs(pressure.area):
        return ""
    return (
        f"the pressure jumps by {in_bar(jump)} where the cycle closes: does the sensor drift? write "
        f"'drift: linear'; {reading.against(other)}"
    )


def _doubt(reading: Reading) -> float:
    """Return in Pa what noise, and the bend of the pressure, may do to the jump where the cycle closes."""
    noise = _SURE * reading.pressure.noise
    if not reading.trace.completed:
        return noise
    p, angles = reading.pressure.pressures, reading.trace.angles
    bends = np.sort(np.abs(np.concatenate((np.diff(p[-5:-1], 2), np.diff(p[:4], 2)))))
    coarse = angles[-1] - angles[-4] > LAST
    steps = np.abs(np.diff(p))
    resolution = 1.5 * float(np.median(steps[steps > 0])) if steps.any() else 0.0
    return max(noise, resolution, 3.0 * float(bends[-1] if coarse else bends[len(bends) // 2]))


JUDGES = (_of_turns, _of_speed, _of_twins, _of_drift)
