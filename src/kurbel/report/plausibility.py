"""What looks wrong with measured traces: said as warnings, since only who measured can know."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.declared.unit_systems import show
from kurbel.machine import Machine
from kurbel.solver.cylinder.forces import CylinderForces

if TYPE_CHECKING:
    from kurbel.solver.pressure.trace import TracePressure

_JUMP = 0.05  # of the range of a trace, between the ends of the cycle
_MOTORED_LEAD = 1.5  # deg; heat loss and leakage put a motored peak up to about 1° before the dead centre
_MOTORED_SEARCH = 10.0, 30.0  # deg before and after the dead centre; what peaks elsewhere is a compressor or pump
_MOTORED_SIDES = 10.0, 20.0, 30.0, 45.0, 60.0, 75.0, 90.0  # deg from the peak at which both its sides are compared
_MOTORED_RATIO = 0.6, 1.1  # of the pressures after and before the peak: what heat loss and leakage take, and noise
_MOTORED_RISE = 3.0  # least pressure of the peak over that at its feet; what is flat has no peak
_NEAR_AMBIENT = 0.7, 1.3


def trace_warnings(forces: CylinderForces) -> Iterable[str]:
    """Yield what is implausible in the traces of a cylinder."""
    for gas in forces.drive.gas:
        ends: tuple[tuple[str, Any], ...] = (("head end", gas.head), ("crank end", gas.crank))
        for end, pressure in ends:
            if hasattr(pressure, "trace"):
                for warning in (*_of_level(pressure), *_of_ends(pressure), *_of_peak(pressure)):
                    yield f"{gas.piston.name}, {end}: {warning}"


def brake_warnings(machine: Machine, cylinders: Sequence[CylinderForces]) -> Iterable[str]:
    """Yield a warning where the whole machine indicates less power than the brake has measured."""
    powers = [forces.power for forces in cylinders] if machine.brake_power is not None else [None]
    if machine.brake_power is None or None in powers:
        return
    indicated = math.fsum(power for power in powers if power is not None)
    if indicated < machine.brake_power:
        yield (
            f"the indicated power, {show(indicated, 'power')}, is below the brake power, "
            f"{show(machine.brake_power, 'power')}: check angle_zero, units and areas"
        )


def _of_level(pressure: TracePressure) -> Iterable[str]:
    """Judge by the lowest pressure whether gauge and absolute are mixed up."""
    place = pressure.setting
    lowest = float(pressure.trace.pressures.min())
    shown = show(lowest, "pressure")
    if place.absolute and lowest < 0.1 * place.ambient:
        yield f"the lowest absolute pressure is {shown}: these look like gauge pressures; write 'pressures: gauge'"
    elif not place.absolute and lowest < -place.ambient:
        yield f"the lowest gauge pressure is {shown}, below the perfect vacuum"
    elif not place.absolute and _NEAR_AMBIENT[0] < lowest / max(place.ambient, 1.0) < _NEAR_AMBIENT[1]:
        yield f"the lowest gauge pressure is {shown}, about the ambient: absolute? Then write 'pressures: absolute'"


def _of_ends(pressure: TracePressure) -> Iterable[str]:
    p = pressure.trace.pressures
    jump = float(p[0] - p[-1])
    if abs(jump) > _JUMP * float(p.max() - p.min()):
        yield f"the pressure jumps by {show(jump, 'pressure')} where the cycle closes"


def _of_peak(pressure: TracePressure) -> Iterable[str]:
    samples, place = pressure.trace, pressure.setting
    top = int(np.argmax(samples.pressures))
    at = float(samples.angles[top]) + pressure.shift
    inner, outer = place.mechanism.dead_centres()
    after = math.remainder(at - (inner if place.head_end else outer), 360.0)
    if place.head_end and place.cycle == 720 and 180 < (at - inner) % 720 < 540:
        yield (
            f"the peak stands at {at % 720:.4g} deg, in the gas exchange; the firing dead centre is angle 0: "
            f"write 'angle_zero: {pressure.trace.angle_zero + 360:g} deg'?"
        )
    step = float(np.diff(samples.angles)[max(0, top - 1) : top + 1].max())
    before_limit, after_limit = _MOTORED_SEARCH
    off = -before_limit <= after < -_MOTORED_LEAD - step or step < after <= after_limit
    if off and _motored(pressure, top):
        yield (
            f"no combustion shows, and the peak stands {abs(after):.3g} deg {'after' if after > 0 else 'before'} "
            "the dead centre; that of a motored engine stands at it or just before: check angle_zero"
        )


def _motored(pressure: TracePressure, top: int) -> bool:
    """Judge by the shape whether nothing burns: the two sides of the peak are alike.

    The sign of the work tells nothing, since a motored trace that stands too late does work.
    """
    samples, lift, sides = pressure.trace, pressure.setting.lift, np.array(_MOTORED_SIDES)
    before, after = (
        lift + np.interp(samples.angles[top] + side, samples.angles, samples.pressures, period=samples.period)
        for side in (-sides, sides)
    )
    low, high = _MOTORED_RATIO
    alike = bool(np.all((low * before <= after) & (after <= high * before)))
    return alike and bool(lift + samples.pressures[top] > _MOTORED_RISE * max(before[-1], after[-1]))
