"""The period of a recording by time, from the pressure itself, and crank angles from a column of pulses."""

from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.errors import refused


class Period(NamedTuple):
    """After how many seconds a pressure repeats itself, and the relative error of that."""

    seconds: float
    error: float


class Clock(NamedTuple):
    """How times became crank angles.

    speed: by the period of the pressure, in revolutions per second, None where it has none; error: its relative error;
    recorded: speed of the machine file, None without one. Without one the period is one working cycle of the machine.
    """

    speed: float | None
    error: float
    recorded: float | None

    @property
    def is_free(self) -> bool:
        """Whether only the machine says how many turns a period has."""
        return self.recorded is None

    @property
    def off(self) -> float:
        """The recorded speed over that of the pressure, less 1; 0 where one is missing."""
        if self.speed is None or self.recorded is None:
            return 0.0
        return self.recorded / self.speed - 1.0

    @property
    def is_off(self) -> bool:
        """Whether the recorded speed is another one than that of the pressure, beyond its error."""
        return abs(self.off) > max(_SURE, 4 * self.error)


_SURE = 3e-4
"""Relative difference of speeds that is never doubted."""
_GRID = 2**17
"""Equally spaced samples, at most, in which a period is searched."""
_APART = 0.6
"""Mean squared difference, over that of samples at random, that must be passed before a period ends."""
_ALIKE = 0.5
"""The same at a period, at most."""
_FEWEST = 16
"""Samples in a period, at least."""


def period_of_pressure(times: Array, pressures: Array) -> Period | None:
    """Return the period of pressures (n,) at rising times (n,) in seconds; None for less than one and a half.

    By the mean squared difference of the recording and itself so much later, which for equal cycles is 0 at each whole
    number of periods, whatever part of a cycle is recorded besides.
    """
    if len(times) < 2 * _FEWEST or not (np.diff(times) > 0).all():
        return None
    count = min(len(times), _GRID)
    grid = np.linspace(float(times[0]), float(times[-1]), count)
    samples = np.interp(grid, times, pressures)
    differences = _differences(samples)
    first = _first_period(differences)
    if first is None:
        return None

    # each further period is found next to where those before put it, and is more exact
    lags = list[float]()
    lag = float(first)
    most = count - 1 - first / 2
    number = 1
    while number * lag <= most:
        best = _least_near(differences, number * lag, 0.02 * lag + 2)
        if best is None:
            break
        lag = best / number
        lags.append(lag)
        number += 1
    if not lags:
        return None
    step = float(grid[-1] - grid[0]) / (count - 1)
    return _refined(grid, samples, lag * step, 0.05 / len(lags) / lag)


_CYCLE_GRID = 2000
"""Samples of a cycle, at most, by which cycles are compared."""
_FEWEST_CYCLES = 3
_ROUNDS = 6
_QUIET = 1e-3
"""Standard deviation over the range of the pressure that counts as scatter where there is none."""


def _refined(times: Array, pressures: Array, seconds: float, error: float) -> Period:
    """Return the period by which cycles do not wander, where they scatter least.

    Each cycle is late by as much as its difference from the mean cycle shows, by least squares weighted with the slope
    of the mean and its scatter: the compression counts, and not the combustion that varies.
    """
    duration = float(times[-1] - times[0])
    count = int(duration / seconds * (1 + 1e-6))
    if count < _FEWEST_CYCLES:
        return Period(seconds, error)
    size = min(_CYCLE_GRID, max(_FEWEST, int(len(times) / count)))
    share = np.arange(size) / size
    numbers = np.arange(count)
    for _ in range(_ROUNDS):
        starts = times[0] + seconds * numbers
        cycles = np.stack(
            [np.interp(start + seconds * share, times, pressures) for start in starts]
        )
        mean = cycles.mean(axis=0)
        slope = np.gradient(np.concatenate((mean[-1:], mean, mean[:1])))[1:-1]
        rest = cycles - mean
        variance = (rest**2).mean(axis=0) + (_QUIET * float(np.ptp(mean))) ** 2
        weights = slope / variance
        early = rest @ weights / float(weights @ slope)

        # by how much each cycle is earlier than the one before
        centred = numbers - numbers.mean()
        spread = float(centred @ centred)
        drift = float(centred @ early) / spread
        left = early - early.mean() - drift * centred
        error = float(np.sqrt(left @ left / (count - 2) / spread)) / size
        if abs(drift) > 0.02 * size:
            break
        seconds *= 1 - drift / size
    return Period(seconds, error)


def _differences(samples: Array) -> Array:
    """Return the mean squared difference (n // …,) of samples and themselves so many later, over twice the variance."""
    count = len(samples)
    swing = samples - samples.mean()
    variance = float(np.mean(swing**2))
    if variance <= 0:
        return np.zeros(count)
    size = 1 << (2 * count - 1).bit_length()
    spectrum = np.fft.rfft(swing, size)
    products = np.fft.irfft(np.abs(spectrum) ** 2, size)[:count]
    squares = np.concatenate(([0.0], np.cumsum(swing**2)))
    lags = np.arange(count)
    overlaps = count - lags
    sums = squares[overlaps] + squares[count] - squares[lags]
    return np.maximum(sums - 2 * products, 0.0) / overlaps / (2 * variance)


def _first_period(differences: Array) -> int | None:
    """Return the first lag at which the samples are alike again, of those that overlap by half of it at least."""
    last = int(len(differences) / 1.5)
    rows = differences[:last]
    apart = np.flatnonzero(rows > _APART)
    if not len(apart):
        return None
    begin = int(apart[0])
    if not (rows[begin:] < _ALIKE).any():
        return None
    # the first stretch below, unless one later is far deeper: half a cycle may be a little alike
    limit = min(_ALIKE, 3 * float(rows[begin:].min()) + 0.1)
    below = np.flatnonzero(rows[begin:] < limit) + begin
    first = int(below[0])
    above = np.flatnonzero(rows[first:] >= limit)
    end = first + int(above[0]) if len(above) else last
    lag = first + int(np.argmin(rows[first:end]))
    return lag if lag >= _FEWEST else None


def _least_near(differences: Array, lag: float, width: float) -> float | None:
    """Return where differences are smallest near a lag, by the parabola through three; None at the end of it."""
    begin = max(1, round(lag - width))
    end = min(len(differences) - 1, round(lag + width) + 1)
    if end - begin < 3:
        return None
    best = begin + int(np.argmin(differences[begin:end]))
    if best in (begin, end - 1):
        return None
    before, at, after = differences[best - 1 : best + 2].tolist()
    bend = before - 2 * at + after
    if bend <= 0:
        return float(best)
    return best + (before - after) / (2 * bend)


_WANDERED = 10.0
"""Degrees by which the cycles of one engine never move from the first to the last."""


def wandered(angles: Array, period: float, cycles: Array) -> float:
    """Return by how many degrees cycles (m, n) are later from the first to the last; 0 where that is nothing.

    By the phase of their first harmonic; angles (n,): in degrees, over a period.
    """
    if len(cycles) < 3:
        return 0.0
    wave = np.exp(-2j * np.pi * angles / period) * np.gradient(angles)
    phases = np.unwrap(np.angle(cycles[:, :-1] @ wave[:-1]))
    later = float(phases[0] - phases[-1]) * period / (2 * np.pi)
    if abs(later) <= _WANDERED:
        return 0.0
    return later


# pulses of a toothed wheel

_HIGH = 0.5
"""Level of a pulse over the range of its column at which its edge counts."""


def angles_of_pulses(pulses: Array, teeth: int, missing: int) -> tuple[Array, slice]:
    """Return crank angles (k,) in degrees from pulses (n,), and of which samples: from the first reference on.

    teeth: of the wheel in one turn, with the missing ones; missing: teeth left out at the reference, 0 where the first
    edge counts as 0°. Between two edges the angle rises evenly. Raises RuleError where the teeth do not fit.
    """
    low = float(pulses.min())
    high = float(pulses.max())
    level = low + _HIGH * (high - low)
    is_high = pulses > level
    rising = np.flatnonzero(is_high[1:] & ~is_high[:-1])
    if len(rising) < 3 or len(rising) < teeth - missing:
        refused(f"has {len(rising)} pulses, less than one turn of {teeth} teeth", "pulse_column")
    share = (level - pulses[rising]) / (pulses[rising + 1] - pulses[rising])
    edges = rising + share

    # teeth from edge to edge: a gap is wider than its neighbours
    widths = np.diff(edges)
    passed = np.ones(len(widths))
    first = 0
    if missing:
        usual = np.median(widths)
        is_gap = widths > (1 + 0.5 * missing) * usual
        passed[is_gap] = missing + 1
        gaps = np.flatnonzero(is_gap)
        turns = np.diff(gaps)
        if len(gaps) < 2 or (turns != teeth - missing).any():
            between = "no two gaps" if len(gaps) < 2 else f"{int(turns[0])} teeth between two gaps"
            refused(
                f"has {between}, where a wheel of {teeth} teeth without {missing} has "
                f"{teeth - missing}",
                "pulse_column",
            )
        first = int(gaps[0]) + 1
    angles_of_edges = np.concatenate(([0.0], np.cumsum(passed[first:]))) * 360.0 / teeth
    begin = int(np.ceil(edges[first]))
    end = int(np.floor(edges[-1])) + 1
    rows = np.arange(begin, end)
    return np.interp(rows, edges[first:], angles_of_edges), slice(begin, end)
