"""What is implausible in a measured trace: one table of checks, each a condition and a sentence with its figures.

A check returns '' where nothing is wrong, or what is seen, what to write, and p_i with and without that correction,
computed from the samples themselves. The first check that finds something is shown alone: what comes later may look
wrong only because of what comes before.
"""

import math
from collections.abc import Callable

import numpy as np

from kurbel.arrays import Array
from kurbel.mechanisms.setting import Setting
from kurbel.numerics.arithmetic import unless_cancelled
from kurbel.traces.correct import (
    COMPRESSION,
    EXPANSION,
    Exponent,
    Trace,
    drift_of,
    exponent,
    joined_in_pairs,
    noise_of,
    parabola_peak,
    sides_of,
    without_drift,
    work_weights,
)

_LOW = 0.15
"""Share of the cycle that is below the low level, so that a few noisy samples do not define it."""
_PARABOLA = 6.0
"""Degrees on either side of the top sample through which a parabola goes."""
_ENGINE = 8.0
"""Peak over low level, absolute, from which on something is compressed, or burns, in a small space."""
_NARROW = 90.0
"""Degrees for which the upper half of such a peak lasts at most; what lasts longer is an admission or a delivery."""
_MOTORED_RATIO = 0.6, 1.1
"""Pressure after the peak over that before, if nothing burns: what heat loss and leakage take, and noise."""
_MOTORED_RISE = 3.0
"""Least pressure of such a peak over that at its feet; what is flat has no peak."""
_CANCELLED = 1e-13
"""Share of the terms of a sum below which the sum is only rounding error."""


class TraceReading:
    """A trace in its chamber: what checks judge it by, pressures in Pa, angles in degrees.

    each: pressures (m, n) of every cycle, corrected; angles (n,): crank angles; place (n,): degrees after the chamber's
    own (firing) dead centre, within ± half a cycle; low: level below which the cycle lies for 15 % of it; ratio: of the
    peak over it, absolute; engine: whether something is compressed, or burns, in a small space; usual: where such a
    peak is; motored: whether nothing burns, since both sides of the peak are alike. (The sign of the work does not show
    that: a motored trace that is too late does work.)
    """

    def __init__(self, trace: Trace, setting: Setting, each: Array) -> None:
        self.trace, self.setting, self.each = trace, setting, each
        self.p: Array = each.mean(axis=0)
        self.angles: Array = trace.angles + trace.shift(setting)
        self.place = trace.from_dead_centre(setting)
        self.step = trace.period / (len(self.p) - 1)
        widths = np.convolve(np.diff(trace.angles), [1.0, 1.0])
        order = np.argsort(self.p)
        share = np.cumsum(widths[order]) / (2 * trace.period)
        self.low = float(self.p[order[np.searchsorted(share, _LOW)]])
        top = int(np.argmax(self.p))
        self.peak, self.top_at = float(self.p[top]), float(self.place[top])
        # a single top sample may be noise; the closing one would count twice
        self.vertex = parabola_peak(self.place[:-1], self.p[:-1], self.top_at, _PARABOLA)
        self.peak_at = self.vertex.place if self.vertex else self.top_at
        half_width = float(widths[self.p > (self.peak + self.low) / 2].sum()) / 2
        # of a trace that goes down to the vacuum, the ratio as over a good vacuum
        self.ratio = (self.peak + setting.lift) / max(
            self.low + setting.lift, 0.2 * setting.ambient, 1.0
        )
        self.engine = half_width <= _NARROW and self.ratio > _ENGINE
        self.usual = _FIRED if setting.cycle == 720 else _TWO_STROKE
        before, after = sides_of(
            float(trace.angles[top]), trace.angles, self.p + setting.lift, trace.period
        )
        alike = (_MOTORED_RATIO[0] * before <= after) & (after <= _MOTORED_RATIO[1] * before)
        self.motored = bool(
            alike.all() and self.peak + setting.lift > _MOTORED_RISE * max(before[-1], after[-1])
        )

    def exponent(
        self, stretch: tuple[float, float], later: float = 0.0, raised: float = 0.0
    ) -> Exponent | None:
        """Return the exponent of a stretch if the trace were so many degrees later, and raised by Pa."""
        absolute = self.p + self.setting.lift + raised
        return exponent(self.setting, self.trace.clearance, self.place + later, absolute, stretch)

    def p_i(self, angles: Array | None = None, pressures: Array | None = None) -> float:
        """Return ∮ p dz in Pa of other crank angles, or other pressures, than those of the trace."""
        weights = work_weights(self.setting, self.angles if angles is None else angles)
        terms = weights * (self.p if pressures is None else pressures)
        return float(unless_cancelled(terms.sum(), np.abs(terms).sum(), _CANCELLED))

    def then(
        self, angles: Array | None = None, pressures: Array | None = None, times: float = 1.0
    ) -> str:
        """Return p_i of other angles, or other pressures, or multiplied, and as it is."""
        now, then = in_bar(self.p_i()), in_bar(times * self.p_i(angles, pressures))
        return f"p_i is then {then} instead of {now}" if now != then else f"p_i stays {now}"

    def put_later(self, degrees: float) -> tuple[str, str]:
        """Return the key that puts the dead centre so many degrees later, and what it does to p_i."""
        zero, period = self.trace.as_written(self.trace.angle_zero + degrees), self.trace.period
        shown = round((zero + 180) % period - 180, 3)
        return f"'angle_zero: {shown:g} deg'", self.then(self.angles - degrees)


def in_bar(pressure: float) -> str:
    """Write a pressure in Pa for a note."""
    return f"{pressure / 1e5 + 0.0:.4g} bar"


def doubt(trace: Trace, setting: Setting, each: Array) -> str:
    """Return what is implausible in a trace with the pressures `each` (m, n) of its cycles, or ''."""
    reading = TraceReading(trace, setting, each)
    return next(filter(None, (check(reading) for check in CHECKS)), "")


# the samples

_TURNS_DIFFER = 0.2
"""Share of the range by which the turns of a two-stroke cycle never differ in pairs."""
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


def _turns_in_pairs(reading: TraceReading) -> str:
    """Laps that differ in pairs are the turns of a four-stroke cycle, taken for two strokes, or each for a cycle."""
    each, trace = reading.each, reading.trace
    if len(each) % 2:
        return ""
    odd, even = each[0::2].mean(axis=0), each[1::2].mean(axis=0)
    if np.abs(odd - even).max() <= _TURNS_DIFFER * max(np.ptp(odd), np.ptp(even)):
        return ""
    seen = f"differ in pairs, with peaks of {in_bar(odd.max())} and {in_bar(even.max())}"
    if reading.setting.cycle == 360:
        return f"its turns {seen}: a four-stroke cycle? write 'cycle: four-stroke' at the top; {reading.then(times=2)}"
    if not trace.even:  # numbers of samples are
        return ""
    joined = joined_in_pairs(trace.samples).mean(axis=0)
    step = trace.period / (len(joined) - 1)
    then = reading.then(reading.angles[0] - trace.angles[0] + step * np.arange(len(joined)), joined)
    return f"its cycles {seen}: does the angle number the samples of one turn? write 'angle_step: {step:g} deg'; {then}"


def _wandering_cycles(reading: TraceReading) -> str:
    """Cycles of one engine do not wander against each other; those by time and a wrong speed do."""
    each, trace = reading.each, reading.trace
    wave = np.exp(-2j * np.pi * trace.angles / trace.period) * np.gradient(trace.angles)
    phases = np.unwrap(np.angle(each[:, :-1] @ wave[:-1]))
    wandered = float(phases[0] - phases[-1]) * trace.period / (2 * np.pi)
    if len(each) < 3 or abs(wandered) <= _WANDERED:
        return ""
    off = wandered / (trace.period * (len(each) - 1))
    return (
        f"the cycles wander {abs(wandered):.3g} deg {'later' if off > 0 else 'earlier'} from the first to the last: "
        "was the speed another, or not constant? If the file counts time: a 'recorded_speed' about "
        f"{abs(1 / (1 + off) - 1):.2%} {'lower' if off > 0 else 'higher'} brings both together"
    )


def _rounded_angles(reading: TraceReading) -> str:
    trace, angles = reading.trace, reading.angles
    twins = int(np.count_nonzero(np.diff(angles) == 0))
    if not trace.files or twins < _TWICE * len(angles):
        return ""
    zero = trace.as_written(trace.angle_zero) - (
        -trace.angles[-1] if trace.against else float(trace.angles[0])
    )
    moved = f" and 'angle_zero: {zero:g} deg'" if trace.angles[0] else ""
    return (
        f"{twins} samples have the angle of the one before: rounded angles? write 'angle_step: {reading.step:g} deg'"
        f"{moved}; {reading.then(angles[0] + reading.step * np.arange(len(angles)))}"
    )


def _drift(reading: TraceReading) -> str:
    """Judge the jump where the cycle closes."""
    p, trace = reading.p, reading.trace
    jump = float(drift_of(trace, p[np.newaxis])[0])
    least = max(_RANGE * abs(float(p[0]) - reading.low), _LEAST * reading.setting.ambient)
    if trace.even:
        least = max(least, _SURE_OF_NOISE * noise_of(p[:-1]))
    if (
        trace.completed
    ):  # what resolution, and the bend of the pressure, may do to a jump between lines
        bends = np.abs(np.concatenate((np.diff(p[-5:-1], 2), np.diff(p[:4], 2))))
        steps = np.abs(np.diff(p))
        least = max(
            least,
            1.5 * float(np.median(steps[steps > 0])) if steps.any() else 0.0,
            3.0 * float(bends.max()),
        )
    (levelled,) = without_drift(trace, p[np.newaxis])
    if abs(jump) <= least or abs(reading.p_i(pressures=levelled - p)) <= _WORTH_IT * abs(
        reading.p_i()
    ):
        return ""
    return (
        f"the pressure jumps by {in_bar(jump)} where the cycle closes: does the sensor drift? write 'drift: linear', "
        f"or leave the closing sample out if it is another cycle's; {reading.then(pressures=levelled)}"
    )


# sign and unit

_LEAST_SWING = 1e3
"""Range in Pa below which a trace is flat."""
_SMALLEST_PEAK, _USUAL_PEAK, _LARGEST_PEAK = 1e5, 60e5, 300e5
"""Absolute pressures in Pa at which cylinders peak, where no clearance gives more."""
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
    "at": 98066.5,
    "bar": 1e5,
    "MPa": 1e6,
}
_POWERS = [(10.0**power, "", 0.5) for power in (-3, -2, -1, 1, 2, 3)]
"""Factors that convert no unit into another, with how much better, in logarithms, such a one must fit."""
_SAME_UNIT = 0.05
"""Largest relative difference of units that cannot be distinguished, such as at and bar."""


def _inverted(reading: TraceReading) -> str:
    """An inverted trace, as of a charge amplifier with the wrong polarity."""
    lowest, middle, highest = np.quantile(reading.p, (0.0, 0.5, 1.0)).tolist()
    if middle - lowest < _ENGINE * max(highest - middle, _LEAST_SWING):
        return ""
    return (
        f"its swing from {in_bar(middle)} goes down to {in_bar(lowest)}: is it inverted? write "
        f"'scale: {-reading.trace.scale:g}'; {reading.then(times=-1.0)}"
    )


def _unit(reading: TraceReading) -> str:
    """Judge the peak by what this clearance can compress to, or else by what cylinders withstand.

    Four strokes compress more than a little, whatever the clearance.
    """
    trace, setting, ambient = reading.trace, reading.setting, reading.setting.ambient
    compressed, most, can = _USUAL_PEAK / 2, _LARGEST_PEAK, "cylinders peak at 1 to 300 bar"
    least = _SMALLEST_PEAK + ambient if setting.cycle == 720 and setting.head_end else 0.0
    if trace.clearance:
        compressed = ambient * (1 + 1 / trace.clearance) ** _AIR
        least, most = (
            _TO_COMPRESSION[0] * compressed,
            max(_TO_COMPRESSION[1] * compressed, _SMALLEST_PEAK),
        )
        can = f"compression gives about {in_bar(compressed)}"

    # a pegged trace keeps its level in whatever unit
    kept = reading.low if trace.pegging else 0.0

    def then(factor: float, pressure: float) -> float:
        return kept + factor * (pressure - kept) + setting.lift

    def in_range(factor: float) -> bool:
        return least <= then(factor, reading.peak) <= max(most, ambient)

    def compresses(factor: float) -> bool:
        low = then(factor, reading.low)
        base = ambient if 0 < low < _NEAR_VACUUM * ambient else low
        return setting.cycle == 360 or then(factor, reading.peak) > _ENGINE * base

    def away(factor: float) -> float:
        """Return by how much, in logarithms, the peak then is not the usual one, and a level not the ambient."""
        level = 1.0 if setting.lift else max(then(factor, reading.low) / max(ambient, 1.0), 1e-3)
        peak = then(factor, reading.peak) / max(2 * compressed, 1.0)
        return abs(math.log(peak)) + abs(math.log(level))

    units = [(size / trace.unit, f" (unit: {name} fits)", 0.0) for name, size in _UNITS.items()]
    usable = [
        one for one in (*units, *_POWERS) if abs(one[0] - 1) > _SAME_UNIT and in_range(one[0])
    ]
    # of what no unit makes an engine, a peak that no cylinder has is reported nevertheless
    others = [one for one in usable if compresses(one[0])] or ([] if in_range(1.0) else usable)
    if (in_range(1.0) and compresses(1.0)) or not others:
        return ""
    factor, unit, _ = min(others, key=lambda one: away(one[0]) + one[2])
    peak = reading.peak + setting.lift
    if least <= peak <= most:
        can = f"four strokes compress more than from {in_bar(reading.low + setting.lift)}"
    return (
        f"the peak is {in_bar(peak)} absolute, where {can}: pressures {max(factor, 1 / factor):.4g} times too "
        f"{'large' if factor < 1 else 'small'}? correct 'unit'{unit}, or write 'scale: {trace.scale * factor:g}'; "
        f"{reading.then(times=factor)}"
    )


# the place of the peak

_FIRED = -15.0, 45.0
"""Degrees after the firing dead centre between which a fired four-stroke cycle peaks."""
_TWO_STROKE = -50.0, 60.0
"""The same in two strokes, where a compressor delivers before the dead centre, and a steam engine admits."""
_AIMED = -2.0, 30.0
"""Where a peak is to be after quarter turns."""
_USUAL = 8.0
"""Degrees after the dead centre at which fired engines peak, more or less."""
_MOTORED_LEAD = (
    1.5  # deg; heat loss and leakage put a motored peak up to about 1° before the dead centre
)
_MOTORED_SEARCH = (
    -10.0,
    30.0,
)  # deg after the dead centre; what peaks elsewhere is a compressor or pump
_SURE = 3.0  # standard errors of the place of the peak, and what a crooked peak may be off
_OFF = 0.1  # deg


def _backward(reading: TraceReading) -> str:
    peak_at, dead_centre = reading.peak_at, reading.setting.own_dead_centre
    judged = reading.engine and (
        reading.setting.cycle == 720 or reading.trace.clearance is not None
    )
    early = (
        -60.0 < peak_at < -_MOTORED_LEAD - reading.step
        and reading.usual[0] <= -peak_at <= reading.usual[1]
    )
    turned = 2 * dead_centre - reading.angles[::-1], reading.p[::-1]
    if (
        not judged
        or not early
        or reading.motored
        or reading.p_i() >= 0
        or reading.p_i(*turned) <= 0
    ):
        return ""
    return (
        f"the peak is {-peak_at:.3g} deg before the dead centre and the cycle takes work: does its angle "
        f"count against the rotation? write 'angle_sense: against'; {reading.then(*turned)}"
    )


def _peak_elsewhere(reading: TraceReading) -> str:
    peak_at, cycle, zero = reading.peak_at, reading.setting.cycle, reading.trace.angle_zero
    if not reading.engine or reading.usual[0] <= peak_at <= reading.usual[1]:
        return ""
    later = 90.0 * round((peak_at - _USUAL) / 90.0)
    if reading.motored:
        later = peak_at
    elif (
        not _AIMED[0] <= peak_at - later <= _AIMED[1]
    ):  # by quarter turns, or else to where such a peak usually is
        later = round(zero + peak_at - _USUAL) - zero
    key, effect = reading.put_later(later)
    where = "firing dead centre" if cycle == 720 else "dead centre"
    gas_exchange = ", in the gas exchange" if abs(peak_at) > 180 else ""
    side = "after" if peak_at > 0 else "before"
    return f"the peak is {abs(reading.top_at):.4g} deg {side} the {where}{gas_exchange}: write {key}; {effect}"


def _motored_peak(reading: TraceReading) -> str:
    peak, after = reading.vertex, reading.peak_at
    if peak is None or not reading.motored or not _MOTORED_SEARCH[0] <= after <= _MOTORED_SEARCH[1]:
        return ""
    sure = _OFF + _SURE * peak.error
    if -_MOTORED_LEAD - sure <= after <= sure:
        return ""
    key, effect = reading.put_later(after)
    return (
        f"no combustion shows, and the peak is {abs(after):.2g} deg {'after' if after > 0 else 'before'} "
        f"the dead centre; that of a motored engine is at it or just before: check angle_zero; with "
        f"{key} {effect.replace('is then', 'is')}"
    )


# level, and the exponents of compression and expansion

_NEAR_AMBIENT = 0.7, 1.3
_BELOW = 0.8
"""Share of the ambient by which gauge pressures of an engine lie below it at most; what is lower has no level."""
_SENSIBLE = 1.2, 1.4
"""Exponents of a compression of air or mixture; less is wet or leaks, more than that of air cannot be."""
_SLACK = 0.02
_APART = 0.08
"""By which the exponents of compression and expansion differ, in engines as they are: the loss angle is worth 0.03."""
_LATEST = 10.0
"""Largest error of a dead centre in degrees that is found here; other notes report larger ones."""


def _level(reading: TraceReading) -> str:
    """Judge by the level below which the cycle lies for a while whether gauge and absolute are mixed up."""
    setting, low = reading.setting, reading.low
    seen = f"for 15 % of the cycle the pressure lies below {in_bar(low)}"
    stays = f"p_i stays, P changes by {in_bar(setting.ambient)} times the area"
    vacuum = 0.0 if setting.absolute else -setting.ambient
    if setting.absolute and -_BELOW * setting.ambient <= low < _NEAR_VACUUM * setting.ambient:
        return (
            f"{seen} absolute: these look like gauge pressures; write 'pressures: gauge'; {stays}"
        )
    if low < vacuum:
        remedy = "correct 'pegging'" if reading.trace.pegging else "write 'pegging: ambient'"
        return f"{seen}, the perfect vacuum being at {in_bar(vacuum)}; {remedy}; {stays}"
    near = _NEAR_AMBIENT[0] < low / max(setting.ambient, 1.0) < _NEAR_AMBIENT[1]
    if setting.absolute or not near or _is_sensible(reading.exponent(COMPRESSION)):
        return ""
    known = (
        "" if reading.trace.clearance else "; a 'compression_ratio' would tell by the compression"
    )
    return f"{seen} gauge, about the ambient: absolute? Then write 'pressures: absolute'; {stays}{known}"


def _is_sensible(found: Exponent | None) -> bool:
    """Return whether there is an exponent, and one that a compression can have."""
    slack = _SLACK + (2 * found.error if found else 0.0)
    return found is not None and _SENSIBLE[0] - slack <= found.value <= _SENSIBLE[1] + slack


def _exponents(reading: TraceReading) -> str:
    """Judge compression and expansion together: a dead centre that is off moves their exponents apart.

    A wrong level moves that of the compression most, and both the same way.
    """
    compression, expansion = reading.exponent(COMPRESSION), reading.exponent(EXPANSION)
    if compression is None or not reading.engine:
        return ""
    seen, sensible = (
        f"its compression goes by p V^{compression.value:.3g}",
        _is_sensible(compression),
    )
    sure = _APART + 2 * math.hypot(compression.error, expansion.error if expansion else 0.0)
    parted = expansion if expansion and abs(compression.value - expansion.value) > sure else None
    if sensible and not parted:
        return ""
    seen += (
        f" and its expansion by p V^{parted.value:.3g}" if parted else ", where air has 1.2 to 1.4"
    )
    now, next_to = _apart(reading, 0.0), _apart(reading, 1.0)
    later = now / (now - next_to or math.nan)  # where both exponents would be one
    if abs(later) <= _LATEST and _is_sensible(reading.exponent(COMPRESSION, later)):
        key, effect = reading.put_later(-later)
        return f"{seen}: a dead centre {abs(later):.2g} deg off does that; write {key}; {effect}"
    return (
        ""
        if sensible
        else f"{seen}: correct the level ('pegging', 'offset'; p_i stays), or the clearance"
    )


def _apart(reading: TraceReading, later: float) -> float:
    """Return the exponent of the compression less that of the expansion, so many degrees later; nan without one."""
    compression, expansion = (
        reading.exponent(COMPRESSION, later),
        reading.exponent(EXPANSION, later),
    )
    return compression.value - expansion.value if compression and expansion else math.nan


CHECKS: tuple[Callable[[TraceReading], str], ...] = (
    _turns_in_pairs,
    _wandering_cycles,
    _rounded_angles,
    _drift,
    _inverted,
    _unit,
    _backward,
    _peak_elsewhere,
    _motored_peak,
    _level,
    _exponents,
)
