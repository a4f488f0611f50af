"""Key values of a measured trace besides forces: exponents, the pumping loop, and the spread of its cycles."""

import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.numerics.arithmetic import some, unless_cancelled, where
from kurbel.numerics.extreme import Extreme
from kurbel.quantity import Quantity, Row, key_value
from kurbel.solver.figures import Results
from kurbel.solver.gas import PistonGas
from kurbel.solver.trace import TracePressure
from kurbel.traces.correct import COMPRESSION, EXPANSION, exponent


class Cycles(NamedTuple):
    """The measured cycles, each (m,): p_i in Pa, largest pressure in Pa, gauge or
    absolute as the file says, with its angle in degrees, its rise."""

    mean_pressure: Array
    p_max: Array
    phi_p_max: Array
    p_rise_max: Array


CYCLE_ROWS = (
    Row(
        Quantity("mean_pressure", "p_i", "pressure", "Mean indicated pressure of the cycle"),
        lambda cycles: cycles.mean_pressure,
    ),
    Row(
        Quantity("p_max", "p_max", "pressure", "Largest gauge pressure of the cycle", gauge=True),
        lambda cycles: cycles.p_max,
    ),
    Row(
        Quantity("phi_p_max", "φ_p,max", "angle", "Crank angle of the largest pressure"),
        lambda cycles: cycles.phi_p_max,
    ),
    Row(
        Quantity("p_rise_max", "dp/dφ_max", "pressure_rise", "Largest rise of pressure over 1 deg"),
        lambda cycles: cycles.p_rise_max,
    ),
)
"""Columns of the table of all measured cycles."""


class Indicated(Results):
    """The key values of the traces of a cylinder's own piston, in SI; None where it has none."""

    def __init__(self, gas: PistonGas) -> None:
        self.gas = gas

    @cached_property
    def _traces(self) -> tuple[TracePressure, ...]:
        ends = (self.gas.head, self.gas.crank)
        return tuple(end for end in ends if isinstance(end, TracePressure))

    @property
    def _one(self) -> TracePressure | None:
        """The only trace of the piston."""
        return self._traces[0] if len(self._traces) == 1 else None

    def _share(self, pressure: TracePressure) -> float:
        """Return the share of a chamber in the swept volume."""
        area = self.gas.piston.head_area if pressure.setting.head_end else self.gas.piston.crank_area
        return float(area * pressure.setting.mechanism.stroke / self.gas.swept_volume)

    @key_value("p_i,g", "pressure")
    def mean_pressure_gross(self) -> float | None:
        """Share of p_i of compression and expansion."""
        if self.mean_pressure_exchange is None:
            return None
        return float(self.gas.work / self.gas.swept_volume) - self.mean_pressure_exchange

    @key_value("p_i,w", "pressure")
    def mean_pressure_exchange(self) -> float | None:
        """Share of p_i of exhaust and intake: the pumping loop.

        None in two strokes.
        """
        weighed = ((one, one.exchange_weights) for one in self._traces)
        each = [self._share(one) * weights * one.pressures for one, weights in weighed if weights is not None]
        if not each:
            return None
        parts = np.concatenate(each).tolist()
        return float(unless_cancelled(math.fsum(parts), math.fsum(map(abs, parts))))

    @key_value("V_c", "volume")
    def V_clearance(self) -> Any:
        """Clearance of the head-end chamber.

        None where it is not known, or nan among others.
        """
        volume = self.gas.clearance_volumes[0] if self.gas.head else 0.0
        return where(volume == 0, math.nan, volume) if some(volume != 0) else None

    def _exponent(self, stretch: tuple[float, float]) -> float | None:
        if not self._one:
            return None
        trace, setting = self._one.trace, self._one.setting
        absolute = self._one.pressures + setting.lift
        found = exponent(setting, trace.clearance, setting.from_dead_centre(trace), absolute, stretch)
        return found.value if found else None

    @key_value("n_c", "ratio")
    def n_compression(self) -> float | None:
        """Exponent of p V^n over the compression, 90 to 40 deg before its end."""
        return self._exponent(COMPRESSION)

    @key_value("n_d", "ratio")
    def n_expansion(self) -> float | None:
        """Exponent of p V^n over the expansion, 60 to 100 deg after its start."""
        return self._exponent(EXPANSION)

    @key_value("dp/dφ_max", "pressure_rise")
    def p_rise_max(self) -> Extreme | None:
        """Largest rise of pressure over 1 deg of angle.

        Of the mean of the cycles.
        """
        return max((one.steepest for one in self._traces), default=None)

    # the measured cycles

    @cached_property
    def cycles(self) -> Cycles | None:
        """The measured cycles, where there are several; an end with one cycle is the same in all."""
        counts = {len(one.each) for one in self._traces} - {1}
        if len(counts) != 1:
            return None
        count = counts.pop()
        ends = [_of_cycles(one, count) for one in self._traces]
        shares = [self._share(one) for one in self._traces]
        traced = math.fsum(share * one.area for one, share in zip(self._traces, shares))
        others = self.gas.work / self.gas.swept_volume - traced  # of an end that has a card, say
        highest: Indices = np.argmax([end.p_max for end in ends], axis=0)
        each = np.arange(count)
        together = np.sum([share * end.mean_pressure for share, end in zip(shares, ends)], axis=0)
        return Cycles(
            others + together,
            np.stack([end.p_max for end in ends])[highest, each],
            np.stack([end.phi_p_max for end in ends])[highest, each],
            np.max([end.p_rise_max for end in ends], axis=0),
        )

    @key_value("Z", "ratio")
    def cycles_measured(self) -> int | None:
        """Number of measured cycles, of whose mean the forces are."""
        return len(self.cycles.p_max) if self.cycles else None

    @key_value("s_p_i", "pressure")
    def mean_pressure_std(self) -> float | None:
        """Standard deviation of p_i over the cycles.

        Of a sample: with m − 1.
        """
        return float(self.cycles.mean_pressure.std(ddof=1)) if self.cycles else None

    @key_value("COV", "ratio")
    def mean_pressure_cov(self) -> float | None:
        """Coefficient of variation of p_i: standard deviation over mean."""
        if self.cycles is None or self.mean_pressure_std is None:
            return None
        mean = abs(float(self.cycles.mean_pressure.mean()))
        return self.mean_pressure_std / mean if mean else None

    @key_value("p_max,m", "pressure", gauge=True)
    def p_max_mean(self) -> float | None:
        """Mean of the largest gauge pressures of the cycles."""
        return float(self.cycles.p_max.mean()) if self.cycles else None

    @key_value("s_p_max", "pressure")
    def p_max_std(self) -> float | None:
        """Standard deviation of the largest pressures of the cycles."""
        return float(self.cycles.p_max.std(ddof=1)) if self.cycles else None

    @key_value("p_max,Z", "pressure", gauge=True)
    def p_max_most(self) -> Extreme | None:
        """Largest gauge pressure of any cycle."""
        if self.cycles is None:
            return None
        top = int(np.argmax(self.cycles.p_max))
        return Extreme(float(self.cycles.p_max[top]), float(self.cycles.phi_p_max[top]))

    @key_value("Z_min", "ratio")
    def cycle_worst(self) -> int | None:
        """Number of the cycle with the smallest p_i, counted from 1."""
        return int(np.argmin(self.cycles.mean_pressure)) + 1 if self.cycles else None


def _of_cycles(pressure: TracePressure, count: int) -> Cycles:
    """Return what one chamber alone shows in its cycles: its p_i is the area of its diagram over the stroke."""
    each = pressure.each
    at = np.mod(pressure.trace.angles + pressure.shift, pressure.setting.cycle)
    top = np.argmax(each, axis=1)
    found = Cycles(each @ pressure.weights, each.max(axis=1), at[top], pressure.rises(each).max(axis=1))
    return Cycles(*(np.broadcast_to(part, (count,)) for part in found))
