"""Whether the peak of a trace stands where that of an engine can: dead centre, firing turn, and sense of the angle."""

import numpy as np

from kurbel.report.trace_readings import Reading, zero_text

_FIRED = -15.0, 45.0
"""Degrees after the firing dead centre between which a fired four-stroke cycle peaks."""
_TWO_STROKE = -50.0, 60.0
"""The same in two strokes, where a compressor delivers before the dead centre, and a steam engine admits."""
_AIMED = -2.0, 30.0
"""Where a peak is to come to stand by whole quarter turns."""
_USUAL = 8.0
"""Degrees after the dead centre at which fired engines peak, more or less."""
_MOTORED_LEAD = 1.5  # deg; heat loss and leakage put a motored peak up to about 1° before the dead centre
_MOTORED_SEARCH = 10.0, 30.0  # deg before and after the dead centre; what peaks elsewhere is a compressor or pump
_SURE = 3.0  # standard errors of the place of the peak, beside what a crooked peak may be off
_OFF = 0.1  # deg
_MOTORED_SIDES = 10.0, 20.0, 30.0, 45.0, 60.0, 75.0, 90.0  # deg from the peak at which both its sides are compared
_AROUND = 2.5  # deg on either side of such a place over which the pressures are a mean: one sample is noise
_MOTORED_RATIO = 0.6, 1.1  # of the pressures after and before the peak: what heat loss and leakage take, and noise
_MOTORED_RISE = 3.0  # least pressure of the peak over that at its feet; what is flat has no peak


def _backward(reading: Reading) -> str:
    judged = reading.engine and (reading.setting.cycle == 720 or reading.trace.clearance is not None)
    early = -60.0 < reading.peak_at < -_MOTORED_LEAD - reading.step
    if not judged or not early or reading.pressure.area >= 0 or _motored(reading):
        return ""
    other = reading.reversed()
    if other.pressure.area <= 0 or not _stands_well(other):
        return ""
    return (
        f"the peak stands {-reading.peak_at:.3g} deg before the dead centre and the cycle takes work: does its angle "
        f"count against the rotation? write 'angle_sense: against'; {reading.against(other)}"
    )


def _stands_well(reading: Reading) -> bool:
    low, high = _FIRED if reading.setting.cycle == 720 else _TWO_STROKE
    return low <= reading.peak_at <= high


def _elsewhere(reading: Reading) -> str:
    if not reading.engine or _stands_well(reading):
        return ""
    other = _brought_back(reading)
    away = "after" if reading.peak_at > 0 else "before"
    where = "firing dead centre" if reading.setting.cycle == 720 else "dead centre"
    gas_exchange = abs(reading.peak_at) > 180
    return (
        f"the peak stands {abs(reading.top_at):.4g} deg {away} the {where}"
        f"{', in the gas exchange' if gas_exchange else ''}: write {zero_text(other)}; {reading.against(other)}"
    )


def _brought_back(reading: Reading) -> Reading:
    """Return the reading whose peak stands as it may: by quarter turns, or else where such a peak usually is."""
    zero = reading.trace.angle_zero
    if _motored(reading):
        return reading.put_at(zero + reading.peak_at)
    for quarter in np.arange(90.0, reading.setting.cycle, 90.0).tolist():
        if _AIMED[0] <= (other := reading.put_at(zero + quarter)).peak_at <= _AIMED[1]:
            return other
    return reading.put_at(float(round(zero + reading.peak_at - _USUAL)))


def _motored_off(reading: Reading) -> str:
    peak, after = reading.vertex, reading.peak_at
    if peak is None or not -_MOTORED_SEARCH[0] <= after <= _MOTORED_SEARCH[1]:
        return ""
    sure = _OFF + _SURE * peak.error
    if -_MOTORED_LEAD - sure <= after <= sure or not _motored(reading):
        return ""
    other = reading.put_at(reading.trace.angle_zero + after)
    return (
        f"no combustion shows, and the peak stands {abs(after):.2g} deg {'after' if after > 0 else 'before'} "
        f"the dead centre; that of a motored engine stands at it or just before: check angle_zero; with "
        f"{zero_text(other)} {reading.against(other).replace('is then', 'is')}"
    )


def _motored(reading: Reading) -> bool:
    """Judge by the shape whether nothing burns: the two sides of the peak are alike.

    The sign of the work tells nothing, since a motored trace that stands too late does work.
    """
    trace, p, sides = reading.trace, reading.pressure.pressures + reading.setting.lift, np.array(_MOTORED_SIDES)
    around = trace.angles[reading.top] + np.linspace(-_AROUND, _AROUND, 21)
    before, after = (
        np.interp(np.add.outer(way, around), trace.angles, p, period=trace.period).mean(axis=1)
        for way in (-sides, sides)
    )
    low, high = _MOTORED_RATIO
    alike = bool(np.all((low * before <= after) & (after <= high * before)))
    return alike and bool(p[reading.top] > _MOTORED_RISE * max(before[-1], after[-1]))


JUDGES = (_backward, _elsewhere, _motored_off)
