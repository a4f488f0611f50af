"""Compression and expansion of a trace as lines p V^n = const, and where a dead centre or a clearance puts them.

Lines of an engine lie at fixed angles from its firing dead centre; those of a compressor between the events of its
valves, on the flanks of its pressure. A wrong dead centre, clearance or level bends both lines and parts their
exponents, each in its own way: what makes them lines of one gas again is the likeliest fault.
"""

import math
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.mechanisms.setting import Setting
from kurbel.traces.correct import COMPRESSION, EXPANSION, FEWEST, Exponent, polytrope

_LEVELS = 0.15, 0.85
"""Shares of the way from the low to the high level, in logarithms, between which a flank counts."""
_QUANTILES = 0.2, 0.95
"""Shares of the cycle below the low level, and below the high one."""
_MOST_RATIO = 20.0
"""High over low level at most: below, a vacuum or the noise of a pump would define the level."""
_LEAST_RATIO = 1.15
"""High over low level at least; what is flatter has no flanks."""


class Flank(NamedTuple):
    """A rise or a fall of the pressure: where it begins and ends, in degrees after the dead centre."""

    begin: float
    end: float

    @property
    def width(self) -> float:
        """Degrees from its begin to its end."""
        return self.end - self.begin


def flanks_of(after: Array, absolute: Array, cycle: float) -> tuple[Flank, Flank] | None:
    """Return the only rise and the only fall of a pressure; None for several, or where it is flat.

    after (n,): degrees from the dead centre, rising over one cycle; absolute (n,): pressures in Pa.
    """
    low, high = np.quantile(absolute, _QUANTILES).tolist()
    if high <= 0:
        return None
    low = max(low, high / _MOST_RATIO)
    if high < _LEAST_RATIO * low:
        return None
    share = np.log(np.maximum(absolute, low / 2) / low) / math.log(high / low)

    # samples at one of both levels, and where the level changes from one to the next of them
    is_high = share >= _LEVELS[1]
    ends = np.flatnonzero(is_high | (share <= _LEVELS[0]))
    states = is_high[ends]
    changes = np.flatnonzero(states != np.roll(states, -1))
    if len(changes) != 2:
        return None
    flanks = {}
    for change in changes.tolist():
        last = int(ends[change])
        first = int(ends[(change + 1) % len(ends)])
        begin = float(after[last])
        width = float(after[first] - after[last]) % cycle
        flanks[bool(states[change])] = Flank(begin, begin + width)
    return flanks[False], flanks[True]


class Lines(NamedTuple):
    """Both lines of a trace: exponents of compression and expansion."""

    compression: Exponent
    expansion: Exponent

    @property
    def difference(self) -> float:
        """Exponent of the compression less that of the expansion."""
        return self.compression.value - self.expansion.value


class Gas(NamedTuple):
    """Exponents that a gas has in a kind of machine: the usual one, its deviation, and that of their difference."""

    compression: float
    expansion: float
    deviation: float
    difference_deviation: float

    @property
    def difference(self) -> float:
        """The usual difference."""
        return self.compression - self.expansion


FIRED_GAS = Gas(1.33, 1.3, 0.06, 0.05)
"""Of an engine: burnt gas expands with a smaller exponent than air is compressed, 1.26 and 1.38 without any loss."""
MOTORED_GAS = Gas(1.32, 1.32, 0.06, 0.045)
COMPRESSOR_GAS = Gas(1.32, 1.27, 0.12, 0.1)
_STRAIGHT = 0.01
"""Standard deviation of ln p about a line, of a good trace without noise."""
_NO_LINES = 1e4
"""Misfit where there are no lines."""


class Chamber(NamedTuple):
    """What its lines are computed from: a trace in one end of a cylinder.

    after (n,): degrees from the dead centre, within ± half a cycle; absolute (n,): pressures in Pa; flanks: of a
    compressor, between its valves, None for an engine; noise: standard deviation in Pa.
    """

    setting: Setting
    after: Array
    absolute: Array
    flanks: tuple[Flank, Flank] | None = None
    noise: float = 0.0

    def lines(self, clearance: float, later: float = 0.0, raised: float = 0.0) -> Lines | None:
        """Return both lines if the trace were so many degrees later, and raised by Pa; None without them."""
        after = self.after + later
        absolute = self.absolute + raised
        if self.flanks is None:
            half = self.setting.cycle / 2
            after = np.remainder(after + half, self.setting.cycle) - half
            insides: list[Any] = [
                (after >= begin) & (after <= end) for begin, end in (COMPRESSION, EXPANSION)
            ]
        else:
            insides = [self._on(flank) for flank in self.flanks]
        exponents = []
        for inside in insides:
            line = polytrope(self.setting, clearance, after[inside], absolute[inside])
            if line is None:
                return None
            exponents.append(line)
        return Lines(*exponents)

    def _on(self, flank: Flank) -> Any:
        """Return whether samples (n,) are on a flank."""
        since = np.remainder(self.after - flank.begin, self.setting.cycle)
        return since <= flank.width

    def misfit(self, gas: Gas, clearance: float, later: float = 0.0, raised: float = 0.0) -> float:
        """Return the sum of squared deviations of both lines from those of such a gas, each over its usual size."""
        lines = self.lines(clearance, later, raised)
        if lines is None:
            return _NO_LINES
        errors = math.hypot(lines.compression.error, lines.expansion.error)
        squares = (
            (lines.difference - gas.difference) / math.hypot(gas.difference_deviation, errors)
        ) ** 2
        for line, exponent in zip(lines, (gas.compression, gas.expansion)):
            noise = self.noise / line.level
            deviation = math.hypot(gas.deviation, line.error)
            squares += ((line.value - exponent) / deviation) ** 2
            squares += (line.scatter / math.hypot(_STRAIGHT, noise)) ** 2
        return squares


class Best(NamedTuple):
    """The value with the least misfit, that misfit, and by how much the value is uncertain."""

    value: float
    misfit: float
    error: float


_HALVINGS = 6
_WIDEST_STEP = 10.0
"""In the unit of the values: one that may be so far off is not known."""


def least(misfit: Callable[[float], float], values: Iterable[float]) -> Best:
    """Return the best of values at equal steps, refined between its neighbours.

    Its error is where the misfit grows by 1, by the parabola through it and its neighbours.
    """
    scanned = [(misfit(value), value) for value in values]
    step = abs(scanned[1][1] - scanned[0][1])
    smallest, best = min(scanned)
    for _ in range(_HALVINGS):
        step /= 2
        neighbours = [(misfit(value), value) for value in (best - step, best + step)]
        smallest, best = min([(smallest, best), *neighbours])

    # the step is doubled until the misfit rises by 1
    rise = 0.0
    while step < _WIDEST_STEP and rise < 1:
        step *= 2
        rise = (misfit(best - step) + misfit(best + step)) / 2 - smallest
    error = step / math.sqrt(rise) if rise > 0 else step
    return Best(best, smallest, error)


_LOG_CLEARANCES = np.linspace(math.log(0.005), math.log(3.0), 60).tolist()
"""Logarithms of clearances over the stroke volume."""


def best_log_clearance(chamber: Chamber, gas: Gas) -> Best:
    """Return the logarithm of the clearance that gives the straightest lines."""
    return least(
        lambda log_clearance: chamber.misfit(gas, math.exp(log_clearance)), _LOG_CLEARANCES
    )


_MOTORED_SPAN = 60.0
"""Degrees to either side of the peak."""
_MOTORED_CLEARANCES = np.geomspace(0.03, 0.4, 25)
"""Over the stroke volume."""
_MOTORED_EXPONENTS = 1.15, 1.5
_MOTORED_SCATTER = 0.03


def goes_by_one_line(chamber: Chamber, clearance: float | None, peak: float) -> bool:
    """Return whether the pressure on both sides of its peak is one line p V^n = const: nothing burns.

    peak: degrees after the dead centre at which the pressure is largest; the line is taken about it. Without a
    clearance the one that suits best is taken.
    """
    after_peak = chamber.after - peak
    inside = np.abs(after_peak) <= _MOTORED_SPAN
    pressures = chamber.absolute[inside]
    if len(pressures) < 2 * FEWEST or not (pressures > 0).all():
        return False
    clearances = _MOTORED_CLEARANCES if clearance is None else (clearance,)
    fits = []
    for tried in clearances:
        fit = polytrope(chamber.setting, float(tried), after_peak[inside], pressures)
        if fit:
            fits.append(fit)
    if not fits:
        return False
    best = min(fits, key=lambda fit: fit.scatter)
    low, high = _MOTORED_EXPONENTS
    noise = chamber.noise / best.level
    return low <= best.value <= high and best.scatter <= math.hypot(_MOTORED_SCATTER, noise)
