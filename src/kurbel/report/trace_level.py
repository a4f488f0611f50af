"""Whether the pressures of a trace are those that an engine can have: level, unit, and the line of its compression."""

import math
from collections.abc import Callable

import numpy as np

from kurbel.numerics.roots import bracketed_roots
from kurbel.report.trace_readings import ENGINE, Reading, in_bar, zero_text
from kurbel.solver.trace import AS_GIVEN, COMPRESSION, Supposed, exponent

LARGEST_PEAK = 300e5  # Pa; of combustion engines
_NEAR_AMBIENT = 0.7, 1.3
_SENSIBLE = 1.2, 1.4
"""Exponents of a compression of air or mixture; less is wet or leaks, more than that of air cannot be."""
_AIMED = 1.32
_SLACK = 0.02
_SMALLEST_PEAK = 1e5
"""Pa above which cylinders peak, where no clearance tells more; and at most LARGEST_PEAK."""
_TO_COMPRESSION = 0.25, 8.0
"""Peak over what the compression from the ambient gives: throttled by three quarters, or supercharged and fired."""
_USUAL_PEAK = 60e5
_BELOW = 0.8
"""Share of the ambient by which gauge pressures of an engine lie below it at most; what is lower has no level."""
_LEAST_SWING = 1e3
"""Pa; what varies less is flat."""
_POWERS = 0.001, 0.01, 0.1, 10.0, 100.0, 1000.0
_LATEST = 10.0
"""Degrees by which a dead centre is found wrong; beyond, other notes speak."""


def _of_sign(reading: Reading) -> str:
    """Judge whether the trace stands on its head, as of a charge amplifier with the wrong polarity."""
    p = reading.pressure.pressures
    middle = float(np.median(p))
    if middle - float(p.min()) < ENGINE * max(float(p.max()) - middle, _LEAST_SWING):
        return ""
    other = reading.otherwise(samples=-reading.trace.samples)
    return (
        f"its swing from {in_bar(middle)} goes down to {in_bar(float(p.min()))}: does it stand on its head? write "
        f"'scale: {-reading.trace.scale:g}'; {reading.against(other)}"
    )


def _of_unit(reading: Reading) -> str:
    """Judge the peak by what this geometry can compress to, or else by what cylinders stand."""
    low, high, aimed = _peaks(reading)
    power = _power(reading)
    if power == 1:
        return ""
    trace = reading.trace
    other = reading.otherwise(samples=trace.samples * power)
    what = f"{1 / power:g} times too large" if power < 1 else f"{power:g} times too small"
    can = f"compression gives about {in_bar(aimed / 2)}" if trace.clearance else "cylinders peak at 1 to 300 bar"
    if low <= reading.absolute_peak <= high:
        can = f"four strokes compress more than from {in_bar(reading.absolute_low)}"
    return (
        f"the peak is {in_bar(reading.absolute_peak)} absolute, where {can}: pressures {what}? mend 'unit', or write "
        f"'scale: {trace.scale * power:g}'; {reading.against(other)}"
    )


def _power(reading: Reading) -> float:
    """Return the power of ten by which the pressures are likely to be too small; 1 where nothing speaks for one."""
    low, high, aimed = _peaks(reading)
    lift, ambient = reading.setting.lift, reading.setting.ambient
    if low <= reading.absolute_peak <= high:
        return _power_of_flat(reading) if reading.setting.cycle == 720 else 1.0
    found = min(_POWERS, key=lambda one: abs(_log((reading.peak * one + lift) / aimed)))
    return found if low <= reading.peak * found + lift <= max(high, ambient) else 1.0


def _power_of_flat(reading: Reading) -> float:
    """Return the power of a four-stroke trace that, as it is, hardly compresses, or only against a vacuum."""
    lift, ambient = reading.setting.lift, reading.setting.ambient
    if lift:  # gauge
        risen = ((reading.peak * one + lift) / max(reading.low * one + lift, 0.2 * ambient) for one in _POWERS[3:])
        return 1.0 if reading.ratio > ENGINE else next((one for one, r in zip(_POWERS[3:], risen) if r > ENGINE), 1.0)
    as_gauge = (reading.peak + ambient) / max(reading.low + ambient, 1.0)
    if not 0 < reading.low < 0.1 * ambient or as_gauge > ENGINE:
        return 1.0
    return min(_POWERS, key=lambda one: abs(_log(reading.low * one / ambient)))


def _log(ratio: float) -> float:
    return math.log(ratio) if ratio > 0 else math.inf


def _peaks(reading: Reading) -> tuple[float, float, float]:
    """Return the smallest and the largest absolute peak in Pa that there can be, and the usual one."""
    setting, clearance = reading.setting, reading.trace.clearance
    if clearance is not None:
        compressed = setting.ambient * (1 + 1 / clearance) ** _AIMED
        return _TO_COMPRESSION[0] * compressed, max(_TO_COMPRESSION[1] * compressed, _SMALLEST_PEAK), 2 * compressed
    four_stroke = setting.cycle == 720 and setting.head_end  # which always compresses; a Stirling engine hardly does
    return (_SMALLEST_PEAK + setting.ambient if four_stroke else 0.0), LARGEST_PEAK, _USUAL_PEAK


def _of_level(reading: Reading) -> str:
    """Judge by the level below which the cycle lies for a while whether gauge and absolute are mixed up."""
    setting, low = reading.setting, reading.low
    said = f"for 15 % of the cycle the pressure lies below {in_bar(low)}"
    stays = f"p_i stays, P changes by {in_bar(setting.ambient)} times the area"
    vacuum = 0.0 if setting.absolute else -setting.ambient
    if setting.absolute and -_BELOW * setting.ambient <= low < 0.1 * setting.ambient:
        return f"{said} absolute: these look like gauge pressures; write 'pressures: gauge'; {stays}"
    if low < vacuum:
        way = "mend 'pegging'" if reading.trace.pegging else "write 'pegging: ambient'"
        return f"{said}, the perfect vacuum being at {in_bar(vacuum)}; {way}; {stays}"
    known = "" if reading.trace.clearance else "; a 'compression_ratio' would tell by the compression"
    near = _NEAR_AMBIENT[0] < low / max(setting.ambient, 1.0) < _NEAR_AMBIENT[1]
    if not setting.absolute and near and not _sensible(reading):
        return f"{said} gauge, about the ambient: absolute? Then write 'pressures: absolute'; {stays}{known}"
    return ""


def _sensible(reading: Reading, supposed: Supposed = AS_GIVEN) -> bool:
    found = exponent(reading.pressure, COMPRESSION, supposed)
    slack = _SLACK + (2 * found.error if found else 0.0)
    return found is not None and _SENSIBLE[0] - slack <= found.value <= _SENSIBLE[1] + slack


def _of_compression(reading: Reading) -> str:
    """Judge the compression by its exponent; what would make it sensible is tried out."""
    found = reading.compression
    if found is None or not reading.engine or _sensible(reading):
        return ""
    begin = f"its compression goes by p V^{found.value:.3g}, where air has 1.2 to 1.4"
    ambient = reading.setting.ambient
    other_level = ambient if reading.setting.absolute else -ambient
    if _sensible(reading, Supposed(raised=other_level)):
        word = "absolute" if other_level < 0 else "gauge"
        return f"{begin}: as {word} pressures it would; write 'pressures: {word}'; p_i stays"
    ways = [one for one in (_by_dead_centre(reading), _by_level(reading)) if one]
    return f"{begin}: {', or '.join((*ways, 'mend the clearance'))}"


def _by_dead_centre(reading: Reading) -> str:
    later = _nearest_root(lambda shift: _off(reading, Supposed(later=shift)), _LATEST)
    if later is None:
        return ""
    other = reading.put_at(reading.trace.angle_zero - later)
    return f"write {zero_text(other)}, {abs(later):.2g} deg away ({reading.against(other)})"


def _by_level(reading: Reading) -> str:
    raised = _nearest_root(lambda lift: _off(reading, Supposed(raised=lift)), 2 * reading.setting.ambient)
    if raised is None:
        return ""
    return f"write 'offset: {in_bar(reading.trace.offset + raised)}' or 'pegging' (p_i stays)"


def _off(reading: Reading, supposed: Supposed) -> float:
    """Return by how much the exponent of the compression is off; not a number where it has none."""
    found = exponent(reading.pressure, COMPRESSION, supposed)
    return math.nan if found is None else found.value - _AIMED


def _nearest_root(off: Callable[[float], float], most: float) -> float | None:
    """Return the root nearest to 0 of what changes sign within ±most; None where there is none."""
    for number in range(10):
        for sign in (most, -most):
            ends = sign * number / 10, sign * (number + 1) / 10
            values = off(ends[0]), off(ends[1])
            if values[0] * values[1] <= 0:
                between = (np.array([one]) for one in (*ends, *values))
                return float(bracketed_roots(lambda x: np.array([off(float(x[0]))]), *between)[0])
    return None


JUDGES = (_of_sign, _of_unit, _of_level, _of_compression)
