"""The exponent of p V^n = const that a measured compression or expansion follows."""

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle

if TYPE_CHECKING:
    from kurbel.solver.pressure.trace import TracePressure

COMPRESSION = -90.0, -40.0
"""Degrees from the firing dead centre between which inlets are closed and nothing burns yet."""
EXPANSION = 60.0, 100.0
"""Degrees from it between which nothing burns any more and outlets are closed still."""
_FEWEST = 5


class Supposed(NamedTuple):
    """What a trace would be if it were read otherwise: put so many degrees later, raised by Pa."""

    later: float = 0.0
    raised: float = 0.0


class Exponent(NamedTuple):
    """An exponent and its standard error."""

    value: float
    error: float


AS_GIVEN = Supposed()


def exponent(pressure: "TracePressure", stretch: tuple[float, float], supposed: Supposed = AS_GIVEN) -> Exponent | None:
    """Return −d ln p/d ln V by least squares over a stretch of angle, with absolute pressures.

    None without a clearance, with fewer than five samples there, or where the pressure is not above the vacuum.
    """
    clearance, setting = pressure.trace.clearance, pressure.setting
    if clearance is None:
        return None
    after = from_dead_centre(pressure) + supposed.later
    inside = (after >= stretch[0]) & (after <= stretch[1])
    figures = pressure.pressures[inside] + setting.lift + supposed.raised
    if len(figures) < _FEWEST or not (figures > 0).all():
        return None
    volumes = np.log(stroke_fraction(pressure, after[inside]) + clearance)
    return _slope(volumes, np.log(figures))


def _slope(volumes: Array, pressures: Array) -> Exponent:
    from_mean = volumes - volumes.mean()
    square = float(from_mean @ from_mean)
    slope = float(from_mean @ pressures) / square
    left = pressures - pressures.mean() - slope * from_mean
    return Exponent(0.0 - slope, math.sqrt(float(left @ left) / (len(left) - 2) / square))


def from_dead_centre(pressure: "TracePressure") -> Array:
    """Return the angles (n,) in degrees of the samples from the chamber's own (firing) dead centre, −½ to ½ cycle."""
    inner, outer = pressure.setting.mechanism.dead_centres()
    own, cycle = (inner if pressure.setting.head_end else outer), pressure.setting.cycle
    return np.asarray(np.remainder(pressure.trace.angles + pressure.shift - own + cycle / 2, cycle) - cycle / 2)


def stroke_fraction(pressure: "TracePressure", after: Array) -> Array:
    """Return the fraction (n,) of the stroke from the chamber's smallest volume, so many degrees after it."""
    mechanism, head = pressure.setting.mechanism, pressure.setting.head_end
    inner, outer = mechanism.dead_centres()
    way = mechanism.coordinate(CrankAngle.of(after + (inner if head else outer))) - mechanism.start
    return np.asarray(way / mechanism.stroke if head else 1 - way / mechanism.stroke)
