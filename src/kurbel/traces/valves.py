"""What the trace of a compressor shows of its valves: volumetric efficiencies, and what suction and discharge lose."""

from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.traces.correct import work_weights
from kurbel.traces.lines import Flank
from kurbel.traces.reading import COMPRESSOR, TraceReading


class ValveFigures(NamedTuple):
    """Efficiencies over the stroke volume, and lost mean pressures in Pa; None without a pressure in the line."""

    suction_efficiency: float
    discharge_efficiency: float
    suction_loss: float | None
    discharge_loss: float | None


def valve_figures(reading: TraceReading) -> ValveFigures | None:
    """Return what the trace of a compressor shows of its valves; None of any other, or without clear lines.

    Efficiencies are by the stroke fractions at which compression and re-expansion pass the pressure in the line, or
    without one that in the cylinder at the dead centre. Losses are ∫ |p − p_line| dz between these.
    """
    if reading.kind != COMPRESSOR or reading.flanks is None:
        return None
    rise, fall = reading.flanks
    trace = reading.trace
    cycle = reading.setting.cycle
    order = np.argsort(reading.after[:-1])
    after = reading.after[:-1][order]
    p = reading.p[:-1][order]

    # pressures in the lines
    at_largest, at_smallest = np.interp([180.0, 0.0], after, p, period=cycle).tolist()
    suction = at_largest if trace.suction is None else trace.suction
    discharge = at_smallest if trace.discharge is None else trace.discharge

    # where compression and re-expansion pass them: the suction ends at the largest volume at the latest
    opening = _passes(after, p, rise, discharge, cycle, (-180.0, 0.0))
    end_of_delivery = _passes(after, p, fall, discharge, cycle, (0.0, 180.0))
    intake = _passes(after, p, fall, suction, cycle, (0.0, 180.0))
    closing = _passes(after, p, rise, suction, cycle, (-180.0, 0.0))
    events = np.array([closing, intake, opening, end_of_delivery])
    z = reading.setting.stroke_fraction(events)

    # the work between the line and the cylinder
    weights = work_weights(reading.setting, reading.angles)
    suction_loss = None
    discharge_loss = None
    if trace.suction is not None:
        turned = np.remainder(reading.after - intake, cycle)
        is_suction = turned <= (closing - intake) % cycle
        suction_loss = float((weights * (trace.suction - reading.p))[is_suction].sum())
    if trace.discharge is not None:
        turned = np.remainder(reading.after - opening, cycle)
        is_delivery = turned <= (end_of_delivery - opening) % cycle
        discharge_loss = float((weights * (trace.discharge - reading.p))[is_delivery].sum())
    return ValveFigures(float(z[0] - z[1]), float(z[2] - z[3]), suction_loss, discharge_loss)


def _passes(
    after: Array,
    p: Array,
    flank: Flank,
    level: float,
    cycle: float,
    stroke: tuple[float, float],
) -> float:
    """Return the angle on a stroke nearest the middle of a flank at which the pressure passes a level.

    after: degrees after the dead centre, rising. Where it does not, the end of the stroke that is nearest to the level:
    the pressure rises on the return stroke, before 0°, and falls after it.
    """
    middle = (flank.begin + flank.end) / 2
    grid = np.linspace(stroke[0], stroke[1], 721)
    pressures = np.interp(grid, after, p, period=cycle)
    above = pressures >= level
    changes = np.flatnonzero(above[1:] != above[:-1])
    if not len(changes):
        is_rise = stroke[0] < 0
        is_low = bool(pressures.max() < level)
        # too low on a rise, or too high on a fall: it would pass after the end
        return stroke[1] if is_low == is_rise else stroke[0]
    share = (level - pressures[changes]) / (pressures[changes + 1] - pressures[changes])
    angles = grid[changes] + share * (grid[1] - grid[0])
    half = cycle / 2
    away = np.abs(np.remainder(angles - middle + half, cycle) - half)
    return float(angles[int(np.argmin(away))])
