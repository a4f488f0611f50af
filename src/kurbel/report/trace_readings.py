"""A trace as it is, and as it would be if it were read otherwise: what notes on measured traces are judged by."""

from dataclasses import replace
from typing import Any

import numpy as np

from kurbel.declared.unit_systems import convert
from kurbel.numerics.vertex import vertex
from kurbel.solver.trace import COMPRESSION, Exponent, TracePressure, exponent, from_dead_centre

_LOW = 0.15
"""Share of the cycle below the low level: a noisy sample, or a few, are no level."""
_PARABOLA = 6.0
"""Degrees on either side of the top sample through which a parabola goes."""
ENGINE = 8.0
"""Peak over low level, absolute, from which on something is compressed, or burns, in a small space."""
_NARROW = 90.0
"""Degrees for which the upper half of such a peak lasts at most; what lasts longer is an admission or a delivery."""


class Reading:
    """What of a trace can be judged; pressures in Pa, angles in degrees from the chamber's own (firing) dead centre."""

    def __init__(self, pressure: TracePressure) -> None:
        self.pressure, self.trace, self.setting = pressure, pressure.trace, pressure.setting
        p, angles = pressure.pressures, pressure.trace.angles
        widths = np.append(np.diff(angles), 0.0) + np.append(0.0, np.diff(angles))
        order = np.argsort(p, kind="stable")
        passed = np.cumsum(widths[order])
        self.low = float(p[order][np.searchsorted(passed, _LOW * passed[-1])])
        self.top = int(np.argmax(p))
        self.peak = float(p[self.top])
        # the closing sample stands there once
        self.vertex = vertex(from_dead_centre(pressure)[:-1], p[:-1], self.top_at, _PARABOLA)
        self.half_width = float(widths[p > (self.peak + self.low) / 2].sum()) / 2
        self.step = float(np.diff(angles)[max(0, self.top - 1) : self.top + 1].max())

    @property
    def top_at(self) -> float:
        """Where the largest sample stands."""
        return float(from_dead_centre(self.pressure)[self.top])

    @property
    def peak_at(self) -> float:
        """Where the peak stands: the top sample of a flat and noisy one may stand degrees away."""
        return self.vertex.place if self.vertex else self.top_at

    @property
    def absolute_low(self) -> float:
        """The low level as an absolute pressure."""
        return self.low + self.setting.lift

    @property
    def absolute_peak(self) -> float:
        """The peak as an absolute pressure."""
        return self.peak + self.setting.lift

    @property
    def engine(self) -> bool:
        """Whether it peaks as an engine does; a steam engine, a pump, a Stirling engine do not."""
        return self.half_width <= _NARROW and self.ratio > ENGINE

    @property
    def ratio(self) -> float:
        """Peak over low level, both absolute; of a trace that goes down to the vacuum, as over a good one."""
        return self.absolute_peak / max(self.absolute_low, 0.2 * self.setting.ambient, 1.0)

    @property
    def compression(self) -> Exponent | None:
        """Exponent of the compression; None where the clearance is not known."""
        return exponent(self.pressure, COMPRESSION)

    def otherwise(self, **changes: Any) -> "Reading":
        """Return the reading of the trace with other fields."""
        return Reading(TracePressure(replace(self.trace, **changes), self.setting))

    def reversed(self) -> "Reading":
        """Return the reading of the trace as if it ran the other way."""
        return Reading(TracePressure(self.trace.turned_round(), self.setting))

    def put_at(self, angle_zero: float) -> "Reading":
        """Return the reading with another angle of the dead centre, as the trace counts."""
        return self.otherwise(angle_zero=angle_zero)

    def against(self, other: "Reading") -> str:
        """Return p_i of another reading, and of this one."""
        now, then = in_bar(self.pressure.area), in_bar(other.pressure.area)
        return f"p_i is then {then} instead of {now}" if now != then else f"p_i stays {now}"


def zero_text(reading: Reading) -> str:
    """Return the key that gives a trace the dead centre of this reading."""
    zero, period = reading.trace.written_zero, reading.trace.period
    return f"'angle_zero: {round((zero + 180) % period - 180, 3):g} deg'"


def in_bar(pressure: float) -> str:
    """Write a pressure for a note."""
    return f"{convert(pressure, 'pressure', 'bar') + 0.0:.4g} bar"
