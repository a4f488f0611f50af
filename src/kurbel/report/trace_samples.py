"""What looks wrong with the samples of a trace: drift, angles that stand twice, turns that belong together."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from kurbel.report.trace_readings import Reading, in_bar
from kurbel.solver.pressure.corrected import drift_of

_RANGE = 0.02
"""Share of the range of a trace that the ends of its cycle may differ by."""
_WORK = 0.01
"""Share of p_i below which a drift is not worth a word."""
_SURE = 6.0
"""Standard deviations of the noise that a drift must stand out by."""
_TWICE = 0.25
"""Share of samples that stand at the angle of the one before, from which on angles are rounded."""
_OTHER = 0.2
"""Share of the range by which the turns of a two-stroke cycle never differ by twos."""


def sample_notes(reading: Reading) -> Iterable[str]:
    """Yield what looks wrong with the samples."""
    yield from _of_turns(reading)
    yield from _of_twins(reading)
    yield from _of_drift(reading)


def _of_turns(reading: Reading) -> Iterable[str]:
    """A four-stroke record of which only the angle of one turn is told may be meant for two strokes by mistake."""
    pressure = reading.pressure
    each = pressure.each
    if pressure.setting.cycle != 360 or len(each) < 2:
        return
    odd, even = each[0::2].mean(axis=0), each[1::2].mean(axis=0)
    if np.abs(odd - even).max() > _OTHER * max(np.ptp(odd), np.ptp(even)) and len(each) % 2 == 0:
        yield (
            f"its turns differ by twos, with peaks of {in_bar(odd.max())} and {in_bar(even.max())}: a four-stroke "
            f"cycle? write 'cycle: four-stroke' at the top; p_i is then {in_bar(2 * pressure.area)} instead of "
            f"{in_bar(pressure.area)}"
        )


def _of_twins(reading: Reading) -> Iterable[str]:
    trace = reading.pressure.trace
    twins = int(np.count_nonzero(np.diff(trace.angles) == 0))
    if twins < _TWICE * len(trace.angles):
        return
    step = trace.period / (len(trace.angles) - 1)
    even = trace.angles[0] + step * np.arange(len(trace.angles))
    even[-1] = trace.angles[-1]
    other = reading.otherwise(angles=even)
    zero = trace.written_zero - (-trace.angles[-1] if trace.against else float(trace.angles[0]))
    moved = f" and 'angle_zero: {zero:g} deg'" if trace.angles[0] else ""
    key = f"write 'angle_step: {step:g} deg'{moved}" if trace.files else "give each point an angle of its own"
    yield f"{twins} samples stand at the angle of the one before: rounded angles? {key}; {reading.against(other)}"


def _of_drift(reading: Reading) -> Iterable[str]:
    pressure = reading.pressure
    trace, p = pressure.trace, pressure.pressures
    jump = float(drift_of(trace, p[np.newaxis])[0])
    if abs(jump) <= max(_RANGE * float(np.ptp(p)), _doubt(reading)):
        return
    other = reading.otherwise(level=True)
    change = abs(other.pressure.area - pressure.area)
    if change > _WORK * abs(pressure.area):
        yield (
            f"the pressure jumps by {in_bar(jump)} where the cycle closes: does the sensor drift? write "
            f"'drift: linear'; {reading.against(other)}"
        )


def _doubt(reading: Reading) -> float:
    """Return in Pa what noise, and the bend of the pressure, may do to the jump where the cycle closes."""
    pressure = reading.pressure
    if not pressure.trace.completed:
        return _SURE * pressure.noise
    p = pressure.pressures[:-1]
    bends = np.abs(np.diff(np.concatenate((p[-4:], p[:4])), 2))
    middle = np.sort(bends)[len(bends) // 2]  # that across the ends is a jump itself
    return max(_SURE * pressure.noise, 3.0 * float(middle))
