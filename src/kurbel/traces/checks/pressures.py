"""Checks of the pressures: their sign, their unit, and whether they are gauge or absolute."""

import math
from typing import NamedTuple

import numpy as np

from kurbel.declared.unit_systems import show_range
from kurbel.traces.checks.doubt import LEAST_SWING, Doubt
from kurbel.traces.reading import ENGINES, TraceReading, in_bar

# sign and unit

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


def inverted(reading: TraceReading) -> Doubt | None:
    """An inverted trace, as of a charge amplifier with the wrong polarity."""
    lowest, middle, highest = np.quantile(reading.p, (0.0, 0.5, 1.0)).tolist()
    if middle - lowest < _SWINGS * max(highest - middle, LEAST_SWING):
        return None
    is_below_vacuum = lowest + reading.setting.lift < -LEAST_SWING
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


def unit_of_another_size(reading: TraceReading) -> Doubt | None:
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


# level

_NEAR_AMBIENT = 0.7, 1.3
_BELOW = 0.8
"""Share of the ambient by which gauge pressures of an engine lie below it at most; what is lower has no level."""
_VACUUM_NOISE = 0.02
"""Share of the swing below the vacuum that noise and pegging explain, of what is no engine."""


def level(reading: TraceReading) -> Doubt | None:
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
