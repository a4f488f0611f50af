"""Key values of a measured trace besides forces: exponents, the pumping loop, and the spread of its cycles."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.numerics.arithmetic import unless_cancelled
from kurbel.numerics.extreme import Extreme
from kurbel.quantity import Quantity, value
from kurbel.solver.figures import Results
from kurbel.solver.gas import PistonGas
from kurbel.traces.pressure import TracePressure
from kurbel.traces.reading import COMPRESSOR, TraceReading
from kurbel.traces.valves import valve_figures


class Cycles(NamedTuple):
    """The measured cycles, each (m,): p_i in Pa, largest pressure in Pa, gauge or absolute as the file says, with its
    angle in degrees, and the largest rise of pressure in Pa per degree."""

    mean_pressure: Array
    p_max: Array
    phi_p_max: Array
    p_rise_max: Array


OF_CYCLES = (
    Quantity("mean_pressure", "p_i", "pressure", "Mean indicated pressure of the cycle"),
    Quantity("p_max", "p_max", "pressure", "Largest gauge pressure of the cycle", gauge=True),
    Quantity("phi_p_max", "φ_p,max", "angle", "Crank angle of the largest pressure"),
    Quantity("p_rise_max", "dp/dφ_max", "pressure_rise", "Largest rise of pressure over 1 deg"),
)
"""Columns of the table of all measured cycles, in the order of `Cycles`."""


def _mean(values: list[float], shares: Array) -> float:
    """Return the mean of values by their shares."""
    return float(np.dot(values, shares) / shares.sum())


class Indicated(Results):
    """The key values of the traces of a cylinder's own piston, in SI; None where it has none."""

    mean_pressure_gross = value("p_i,g", "pressure", "Gross part of p_i: compression and expansion")
    mean_pressure_exchange = value("p_i,w", "pressure", "Pumping part of p_i: exhaust and intake")
    n_compression = value(
        "n_c",
        "ratio",
        "Exponent of p V^n over the compression, 90 to 40 deg before its end, or between the valves",
    )
    n_expansion = value(
        "n_d",
        "ratio",
        "Exponent of p V^n over the expansion, 60 to 100 deg after its start, or between the valves",
    )
    n_compression_crank = value(
        "n_c,C",
        "ratio",
        "Exponent of the compression in the crank end, where both ends have traces",
    )
    n_expansion_crank = value(
        "n_d,C", "ratio", "Exponent of the expansion in the crank end, where both ends have traces"
    )
    suction_efficiency = value(
        "η_s", "ratio", "Volumetric efficiency of the suction by the trace, mean of the ends"
    )
    discharge_efficiency = value(
        "η_d", "ratio", "Volumetric efficiency of the discharge by the trace, mean of the ends"
    )
    suction_loss = value(
        "p_v,s", "pressure", "Mean pressure lost between suction line and cylinder"
    )
    discharge_loss = value(
        "p_v,d", "pressure", "Mean pressure lost between cylinder and discharge line"
    )
    cycles_measured = value("Z", "ratio", "Number of measured cycles averaged for the forces")
    mean_pressure_std = value("s_p_i", "pressure", "Standard deviation of p_i over the cycles")
    mean_pressure_cov = value(
        "COV", "ratio", "Coefficient of variation of p_i: standard deviation over mean"
    )
    p_max_mean = value(
        "p_max,m", "pressure", "Mean of the largest gauge pressures of the cycles", gauge=True
    )
    p_max_std = value(
        "s_p_max", "pressure", "Standard deviation of the largest pressures of the cycles"
    )
    p_max_most = value("p_max,Z", "pressure", "Largest gauge pressure of any cycle", gauge=True)
    cycle_worst = value(
        "Z_min", "ratio", "Number of the cycle with the smallest p_i, counted from 1"
    )

    def __init__(self, gas: PistonGas) -> None:
        self.gas = gas
        self._traces = [end for end in (gas.head, gas.crank) if end and end.traced]

    @cached_property
    def answers(self) -> dict[str, object]:
        """The key values; standard deviations are those of a sample, with m − 1."""
        answers = dict[str, object]()
        if not self._traces:
            return answers

        exchange = []
        for trace in self._traces:
            if trace.exchange_weights is not None:
                exchange.append(trace.exchange_weights * (self._share(trace) * trace.pressures))
        if exchange:
            terms = np.concatenate(exchange)
            lost = float(unless_cancelled(terms.sum(), np.abs(terms).sum()))
            answers["mean_pressure_exchange"] = lost
            answers["mean_pressure_gross"] = float(self.gas.work / self.gas.swept_volume) - lost
        return answers | self._of_lines() | self._scatter()

    def _of_lines(self) -> dict[str, object]:
        """Return the key values of compression and expansion: of the head end first, and of a compressor's valves."""
        figures = dict[str, object]()
        indicator = self.gas.piston.indicator
        role = indicator.role if indicator else None
        valves = []
        for number, pressure in enumerate(self._traces):
            reading = TraceReading(pressure.trace, pressure.setting, pressure.each, role)
            compression, expansion = reading.stroke_lines()
            end = "_crank" if number else ""
            figures[f"n_compression{end}"] = compression.value if compression else None
            figures[f"n_expansion{end}"] = expansion.value if expansion else None
            if reading.kind == COMPRESSOR:
                valves.append((self._share(pressure), valve_figures(reading)))

        # of both ends, each by its share of the swept volume
        shares = np.array([share for share, _ in valves])
        of_ends = [figure for _, figure in valves if figure is not None]
        if not of_ends or len(of_ends) < len(valves):
            return figures
        figures["suction_efficiency"] = _mean([end.suction_efficiency for end in of_ends], shares)
        figures["discharge_efficiency"] = _mean(
            [end.discharge_efficiency for end in of_ends], shares
        )
        for name in ("suction_loss", "discharge_loss"):
            losses = [end._asdict()[name] for end in of_ends]
            if None not in losses:
                figures[name] = float(np.dot(losses, shares))
        return figures

    def _scatter(self) -> dict[str, object]:
        """Return the key values of several cycles."""
        if not self.cycles:
            return {}
        p_i, highest, at, _ = self.cycles
        mean, deviation = abs(float(p_i.mean())), float(p_i.std(ddof=1))
        top = int(np.argmax(highest))
        # of cycles that wander each p_i is that of another dead centre
        is_comparable = not self.gas.wanders
        has_cov = is_comparable and mean > 0
        return {
            "cycles_measured": len(highest),
            "mean_pressure_std": deviation if is_comparable else None,
            "mean_pressure_cov": deviation / mean if has_cov else None,
            "p_max_mean": float(highest.mean()),
            "p_max_std": float(highest.std(ddof=1)),
            "p_max_most": Extreme(float(highest[top]), float(at[top])),
            "cycle_worst": int(np.argmin(p_i)) + 1 if is_comparable else None,
        }

    def _share(self, pressure: TracePressure) -> float:
        """Return the share of a chamber in the swept volume."""
        piston, setting = self.gas.piston, pressure.setting
        area = piston.head_area if setting.head_end else piston.crank_area
        return float(area * setting.mechanism.stroke / self.gas.swept_volume)

    @cached_property
    def cycles(self) -> Cycles | None:
        """The measured cycles, where there are several; an end with one cycle is the same in all."""
        counts = {len(trace.each) for trace in self._traces} - {1}
        if len(counts) != 1:
            return None
        (count,) = counts
        ends = []
        for trace in self._traces:
            angles = np.mod(trace.angles, trace.setting.cycle)
            rises = trace.rises(trace.each)[0]
            of_cycles = (
                self._share(trace) * (trace.each @ trace.weights),
                trace.each.max(axis=1),
                angles[trace.each.argmax(axis=1)],
                rises.max(axis=1),
            )
            ends.append([np.broadcast_to(values, count) for values in of_cycles])
        p_i, p_max, phi_p_max, p_rise_max = np.array(ends).transpose(1, 0, 2)
        traced = sum(self._share(trace) * trace.area for trace in self._traces)
        others = self.gas.work / self.gas.swept_volume - traced  # of an end that has a card, say
        highest = np.argmax(p_max, axis=0), np.arange(count)
        return Cycles(
            others + p_i.sum(axis=0), p_max[highest], phi_p_max[highest], p_rise_max.max(axis=0)
        )
