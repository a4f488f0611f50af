"""Scales: from the values of an axis to places on paper or in a terminal, and where its ticks stand."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kurbel.render.numbers import decimal
from kurbel.report.pictures.picture import Axis, Panel

_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
_DEGREES = (15.0, 30.0, 45.0, 90.0, 180.0, 360.0)
_AIR = 0.12
"""Share of its height that a panel leaves free above and below its curves."""


@dataclass(frozen=True, eq=False)
class Scale:
    """What values `low` and `high` stand for on an axis: the places `start` and `end`; log: by powers of ten."""

    low: float
    high: float
    start: float
    end: float
    log: bool = False

    def place(self, values: Any) -> Any:
        """Return the places of values."""
        if self.log:
            low, high = math.log10(self.low), math.log10(self.high)
            share = (np.log10(values) - low) / (high - low)
        else:
            share = (values - self.low) / (self.high - self.low)
        # what lies between two dots goes to the same one on every processor, whose sines differ in the last digit
        return np.round(self.start + share * (self.end - self.start), 9)

    def reach(self, start: float, end: float) -> "Scale":
        """Return the scale with other ends on paper."""
        return replace(self, start=start, end=end)


def scale_of(panel: Panel, part: str) -> Scale:
    """Return the scale from 0 to 1 that holds all that stands on an axis (x or y) of a panel."""
    axis: Axis = getattr(panel, part)
    low, high = _extent(panel, part)
    low = low if axis.low is None else min(low, axis.low)
    high = high if axis.high is None else max(high, axis.high)
    if axis.log:
        low, high = 10.0 ** math.floor(math.log10(low)), 10.0 ** math.ceil(math.log10(high) or 1)
    elif not high > low:  # a level line stands in the middle
        air = 0.1 * abs(high) or 1.0
        low, high = low - air, high + air
    elif part == "y" or panel.plain:
        air = _AIR * (high - low)
        low, high = low - air, high + air
    return Scale(high, low, 0.0, 1.0, axis.log) if axis.falling else Scale(low, high, 0.0, 1.0, axis.log)


def taller(scale: Scale, height: float) -> Scale:
    """Return a scale that reaches at least so far, its middle where it was."""
    spare = (height - (scale.high - scale.low)) / 2
    return scale if spare <= 0 else replace(scale, low=scale.low - spare, high=scale.high + spare)


def _extent(panel: Panel, part: str) -> tuple[float, float]:
    """Return the smallest and the largest value on an axis."""
    drawn = [np.array([getattr(mark, part)]) for mark in panel.marks]
    for shade in panel.shades:
        drawn += [shade.x] if part == "x" else [shade.low, shade.high]
    for moment in (panel, *panel.frames):
        drawn += [getattr(piece, part) for curve in moment.curves for piece in curve.pieces]
        drawn += [np.array([end["xy".index(part)] for end in (one.tail, one.head)]) for one in moment.arrows]
    every = [(float(np.min(one)), float(np.max(one))) for one in drawn if np.size(one)]
    return min((low for low, _ in every), default=0.0), max((high for _, high in every), default=0.0)


def ticks(scale: Scale, axis: Axis, most: int) -> list[float]:
    """Return the values, at most so many or a few more, at which an axis has ticks."""
    low, high = sorted((scale.low, scale.high))
    if axis.names:
        return [float(number) for number in range(len(axis.names)) if low <= number <= high]
    if axis.log:
        powers = range(round(math.log10(low)), round(math.log10(high)) + 1)
        return [10.0**power for power in powers[:: max(1, -(-len(powers) // most))]]
    step = _step((high - low) / max(most, 1), axis.unit)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [float(f"{number * step:.12g}") for number in range(first, last + 1)]


def _step(least: float, unit: str) -> float:
    if unit == "deg":
        fitting = [step for step in _DEGREES if step >= least and least > 10.0]
        if fitting:
            return fitting[0]
    power = 10.0 ** math.floor(math.log10(least))
    return next(step for step in _STEPS if step * power >= least * (1 - 1e-9)) * power


def tick_text(value: float, values: list[float], comma: bool) -> str:
    """Return what stands at a tick, with the decimals that all of them need."""
    if len(values) > 1 and (values[-1] - values[0] < 1e-4 or max(map(abs, values)) >= 1e6):
        text = f"{value:.4g}"
    else:
        decimals = max((len(f"{one:.9g}".partition(".")[2]) for one in values if "e" not in f"{one:.9g}"), default=0)
        text = f"{value:.{decimals}f}"
    return decimal(text, comma)
