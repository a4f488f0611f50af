"""Physical traces made by hand: polytropic compression and expansion, heat by Wiebe's law, gas exchange, and noise."""

import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

RATIO = 0.25
"""R/L of every engine here."""


class Engine(NamedTuple):
    """What a trace is made of.

    clearance: over the stroke volume; exponent: of compression and expansion; heat: what the burning multiplies p V^n
    by, less 1; begin, lasts: of the burning, in degrees after the dead centre; inlet, outlet: absolute pressures in bar
    of the gas exchange; two_stroke: 360 deg, with ports.
    """

    clearance: float = 1 / 14
    exponent: float = 1.33
    heat: float = 1.6
    begin: float = -6.0
    lasts: float = 45.0
    inlet: float = 0.96
    outlet: float = 1.06
    two_stroke: bool = False


def fraction(degrees: Any) -> Any:
    """The stroke fraction of a slider-crank, from its own geometry."""
    phi = np.radians(degrees)
    return (1 - np.cos(phi) + (1 - np.sqrt(1 - (RATIO * np.sin(phi)) ** 2)) / RATIO) / 2


def absolute(engine: Engine, degrees: Any) -> Any:
    """The absolute pressure in bar at angles after the firing dead centre."""
    turn = 360.0 if engine.two_stroke else 720.0
    phi = np.remainder(np.asarray(degrees, dtype=float) + turn / 2, turn) - turn / 2
    volume = fraction(phi) + engine.clearance
    begun = engine.inlet * ((1 + engine.clearance) / volume) ** engine.exponent
    burnt = 1 - np.exp(-6.9 * np.clip((phi - engine.begin) / engine.lasts, 0, 1.3) ** 2.5)
    closed = begun * (1 + engine.heat * burnt)
    end = float(engine.inlet * (1 + engine.heat))
    blown = engine.outlet + (end - engine.outlet) * np.exp(-np.clip(phi - 150, 0, None) / 12) * (
        phi > 0
    )
    released = np.where(phi > 150, np.minimum(closed, blown), closed)
    if engine.two_stroke:
        return released
    exhaust = np.where(np.abs(phi) > 180, _exchange(engine, phi, blown), released)
    return exhaust


def _exchange(engine: Engine, phi: Any, blown: Any) -> Any:
    """Exhaust, then intake, joined smoothly round the dead centre between them."""
    since = np.remainder(phi, 720.0)  # 180 … 540
    mixed = 1 / (1 + np.exp(-(since - 360) / 8))
    return blown * (1 - mixed) + engine.inlet * mixed


def cycles(
    engine: Engine, count: int, step: float, noise: float = 0.0, spread: float = 0.0, seed: int = 1
) -> Any:
    """Angles (n,) after the firing dead centre, and absolute pressures (count, n) in bar with noise in each cycle."""
    rng = np.random.default_rng(seed)
    turn = 360.0 if engine.two_stroke else 720.0
    angles = np.arange(round(turn / step)) * step
    heats = engine.heat * (1 + spread * rng.standard_normal(count))
    each = np.stack([absolute(engine._replace(heat=float(heat)), angles) for heat in heats])
    return angles, each + noise * rng.standard_normal(each.shape)


def indicated(angles: Any, pressures: Any) -> float:
    """p_i in bar of pressures at equal angles over whole turns, by the trapezoid rule and dz/dφ in closed form."""
    phi = np.radians(angles)
    sine = RATIO * np.sin(phi)
    slope = (np.sin(phi) + sine * np.cos(phi) / np.sqrt(1 - sine**2)) / 2
    return math.fsum((pressures * slope).tolist()) * math.radians(float(angles[1] - angles[0]))


def columns_file(path: Path, rows: np.ndarray, format: str = "%.6f") -> None:
    """Write rows (n, m) as csv, in a third of the time of `numpy.savetxt`."""
    line = ",".join([format] * rows.shape[1]) + "\n"
    path.write_text(line * len(rows) % tuple(rows.ravel().tolist()))
