"""Checks of the dead centre and of the sense of the angle: by the peak of an engine, by the flanks of all others."""

import math

import numpy as np

from kurbel.traces.checks.doubt import LEAST_SWING, Doubt, sense_key
from kurbel.traces.checks.lines import STRANGE, dead_centre_error, shift_by_lines
from kurbel.traces.reading import MOTORED, PUMP, STEAM, TraceReading, in_bar

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


def backward(reading: TraceReading) -> Doubt | None:
    """A peak just before the dead centre, and work that is taken, are those of an angle in the other sense."""
    peak_at = reading.peak_at
    is_early = -60.0 < peak_at < -_MOTORED_LEAD - reading.step / 2
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
    if chamber is not None and clearance and chamber.misfit(reading.gas, clearance) > STRANGE:
        return None
    cured = reading.turned()
    if cured.p_i <= 0:
        return None
    return Doubt(
        f"the peak is {-peak_at:.3g} deg before the dead centre and the cycle takes work: does its "
        f"angle count against the rotation? write '{sense_key(reading)}'; {reading.effect(cured)}",
        cured,
    )


def peak_elsewhere(reading: TraceReading) -> Doubt | None:
    """A peak that is nowhere near the dead centre: by quarter turns, or to where such a peak usually is."""
    peak_at = reading.peak_at
    first, last = _usual_range(reading)
    if not reading.is_engine or first <= peak_at <= last:
        return None
    if reading.trace.placed is not None and abs(peak_at) > 270:  # the other turn, by the pressures
        return None
    later = 90.0 * round((peak_at - _USUAL) / 90.0)
    zero = reading.trace.angle_zero
    if reading.kind == MOTORED:
        later = peak_at
    elif not _AIMED[0] <= peak_at - later <= _AIMED[1]:
        later = round(zero + peak_at - _USUAL) - zero
        cured = reading.put_later(later)
        shift = shift_by_lines(cured)
        later += 0.0 if shift is None else -shift.value
    cured = reading.put_later(later)
    cycle = reading.setting.cycle
    where = "firing dead centre" if cycle == 720 else "dead centre"
    gas_exchange = ", in the gas exchange" if abs(peak_at) > 180 else ""
    side = "after" if peak_at > 0 else "before"
    return Doubt(
        f"the peak is {abs(reading.top_at):.4g} deg {side} the {where}{gas_exchange}: "
        f"{reading.dead_centre_later(later)}; {reading.effect(cured)}",
        cured,
    )


def motored_peak(reading: TraceReading) -> Doubt | None:
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
    if reading.trace.placed is not None:
        return Doubt(
            f"no combustion shows, and the peak is {abs(after):.2g} deg {side} the dead centre; that "
            f"of a motored engine is at it or just before: {reading.dead_centre_later(after)}; "
            f"{reading.effect(cured)}",
            cured,
        )
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


def other_sense(reading: TraceReading) -> Doubt | None:
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
        f"'{sense_key(reading)}'; {reading.effect(cured)}",
        cured,
    )


_SLOWER = 1.4
"""Width of the slower flank over that of the other one, from which on it is the slower."""


def flanks_elsewhere(reading: TraceReading) -> Doubt | None:
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
    shift = shift_by_lines(reading, 180.0)
    later = off
    error = 0.0
    if shift is not None:
        later = _from_half_turn(-shift.value)
        sure = dead_centre_error(reading, shift)
        error = abs(reading.put_later(later + sure).p_i - reading.put_later(later).p_i)
    # quarter turns are likelier, be they near what the lines show or near what the flanks do
    for shown in (later, off):
        quarter = 90.0 * round(shown / 90.0)
        if quarter and abs(shown - quarter) <= _QUARTER:
            later = quarter
            error = 0.0
            break
    cured = reading.put_later(later)
    other_end = _or_other_end(reading, later)
    return Doubt(
        f"{event} at the dead centre where its chamber is smallest, here {abs(off):.3g} deg "
        f"{'after' if off > 0 else 'before'} it: {reading.dead_centre_later(later)}"
        f"{other_end}; {reading.effect(cured, error)}",
        None if other_end else cured,
    )


def _or_other_end(reading: TraceReading, later: float) -> str:
    """Return a question where half a turn may be the other end of the cylinder."""
    if abs(abs(later) - 180.0) > 1.0:
        return ""
    if reading.trace.placed is not None:  # it is in question already
        return ""
    other = "crank" if reading.setting.head_end else "head"
    return f", or is it the trace of the {other} end?"


def high_at_largest(reading: TraceReading) -> Doubt | None:
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
    if high >= low or low - high < max(0.1 * swing, LEAST_SWING):
        return None
    cured = reading.put_later(180.0)
    return Doubt(
        f"near the dead centre where its chamber is smallest the pressure is {in_bar(high)}, near "
        f"the other one {in_bar(low)}: {reading.dead_centre_later(180.0)}"
        f"{_or_other_end(reading, 180.0)}; {reading.effect(cured)}",
    )
