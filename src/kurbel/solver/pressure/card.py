"""The pressure of a card: segments over the stroke, found by crank angle."""

import math
from copy import copy
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.crank_angle import CrankAngle, within_cycle
from kurbel.machine.cylinder import CYCLES
from kurbel.machine.indicator import STROKES, Card, Line
from kurbel.machine.rectangle import Rectangle
from kurbel.mechanisms import fan
from kurbel.numerics.arithmetic import exp, sqrt, where
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.jet import value_of
from kurbel.solver.pressure import Setting
from kurbel.solver.pressure.places import segments_over
from kurbel.solver.pressure.segments import Process, Processes, Segment, Stroke, growth, polytropic_exponent


class Held(NamedTuple):
    """Of segments that hold angles, each (n,): as `Segment`; rise of pressure in Pa over the whole stroke; angles."""

    z: Array
    p: Array
    next_z: Array
    exponent: Array
    gradient: Array
    begins: Array
    ends: Array


class ProcessPressure:
    """Gauge pressure in one chamber from a process over the stroke, or in that of many variants.

    The segments are found by crank angle, not by displacement, so that each side of a vertical jump can be asked for
    exactly. starts, bends: as `Pressure` says.
    """

    def __init__(self, processes: Processes, setting: Setting) -> None:
        self.processes = processes
        self.setting = setting
        self._lift, self._clearance = processes.lift, processes.clearance
        self._places = segments_over(processes, setting)
        self.starts = self._places.starts
        table = self._places.table
        gradients = (table.next_p - table.p) / (table.next_z - table.z)
        ends = self._places.angles, self._places.ends
        self._lines = np.stack((table.z, table.p, table.next_z, table.exponent, gradients, *ends))
        self.straight = not table.exponent.any()
        self._variant: Indices | None = None

    def taken(self, index: Indices) -> "ProcessPressure":
        """Return the pressure of these variants, at angles of the shape of the index."""
        from kurbel.machine.variants import taken

        other = copy(self)
        other._variant = index
        other.setting = self.setting.taken(index)
        other._lift, other._clearance = taken(self._lift, index), taken(self._clearance, index)
        return other

    def held(self, within: Array) -> Held:
        """Return the segments that hold angles (n,) in degrees."""
        segment = self._places.holding(within_cycle(within, self.setting.cycle), self._variant)
        return Held(*self._lines.take(segment, axis=1))

    def __call__(self, z: Any, degrees: Array, held: Held) -> Any:
        """Return the gauge pressure in Pa where z (n,) of the stroke is passed, on the segments that are held."""
        share = z + 0.0 if self.setting.head_end else 1 - z  # a new one
        self._put_corners(value_of(share), degrees, held)
        straight = (held.p - self.setting.base) + held.gradient * (share - held.z)
        return straight if self.straight else self._curved(straight, share, held)

    def _put_corners(self, share: Array, degrees: Array, held: Held) -> None:
        """Make stroke fractions at corners those of the card: their angles are rounded, lines may be steep."""
        # of a piece of a grid only the first and the last node may stand at a corner
        at = np.s_[:, :: degrees.shape[1] - 1] if held.begins.shape != degrees.shape else np.s_[:]
        turned = within_cycle(degrees[at], self.setting.cycle)
        for corner, z in ((held.ends, held.next_z), (held.begins, held.z)):
            met = np.abs(turned - corner) <= _ROUNDING
            share[at] = np.where(met, z, share[at])

    def _curved(self, straight: Any, share: Any, held: Held) -> Any:
        """Return P (V/V′)^n less the ambient on polytropic segments, and the straight value elsewhere."""
        curved, sense = held.exponent != 0, np.where(held.next_z < held.z, -1.0, 1.0)
        clearance = np.where(curved, self._clearance, 1.0)  # what is straight may begin without any volume
        power = (held.p + self._lift) * exp(growth(held.z, share, clearance, sense) * -held.exponent)
        return _chosen(curved, power - self.setting.ambient, straight)

    @cached_property
    def bends(self) -> tuple[Any, ...]:
        """Angles in degrees beside the dead centre of the smallest volume, where a polytropic line bends sharply."""
        if self.straight:
            return ()
        mechanism = self.setting.mechanism
        dead_centre = mechanism.dead_centres()[0 if self.setting.head_end else 1]
        curvature = abs(mechanism.curvature(CrankAngle.of(dead_centre)))
        flat = curvature == 0
        bent = sqrt(2 * self._clearance * mechanism.stroke / where(flat, 1.0, curvature)) * (180 / math.pi)
        return fan(dead_centre, where(flat, 0.0, bent))

    @property
    def highest(self) -> Extreme:
        """The highest gauge pressure in Pa, and the first crank angle that has it: at an end of a segment."""
        return self._places.highest(self.setting.base)

    @cached_property
    def area(self) -> Any:
        """∮ p dz over the stroke fraction z in Pa, per cycle, closed."""
        return self.processes.area


def _chosen(condition: Array, value: Any, otherwise: Any) -> Any:
    """Return an array or a jet that is `value` where the condition holds, and `otherwise` elsewhere."""
    return getattr(value, "where", np.where)(condition, value, otherwise)


_ROUNDING = 3e-13
"""Degrees of crank angle by which the angle of a corner may be off: a few units in the last place of 720."""


def rectangle_process(card: Rectangle, setting: Setting) -> Process:
    """Return the process of a rectangular card: the mean pressure stands on the stroke that drives, or is driven."""
    level = setting.base if card.level is None else card.level
    above = {"expansion": max(card.mean, 0.0), "compression": max(-card.mean, 0.0)}
    names = next(names for cycle, names in STROKES.items() if 360.0 * CYCLES[cycle] == setting.cycle)
    pressures = [level + above.get(name, 0.0) for name in names]
    return Process(tuple((Segment(float(i % 2), p, float(1 - i % 2), p),) for i, p in enumerate(pressures)))


def card_process(card: Card, setting: Setting) -> Process:
    """Return the process of a card drawn by points, joined as the card says, with absolute pressures."""
    lift = setting.lift
    clearance = math.inf if card.interpolate == "linear" or card.clearance is None else card.clearance
    return Process(tuple(_stroke(line, lift, clearance) for line in card.lines), lift, clearance)


def _stroke(line: Line, lift: float, clearance: float) -> Stroke:
    return tuple(
        Segment(z, p, next_z, next_p, _exponent(z, p + lift, next_z, next_p + lift, clearance))
        for (z, p), (next_z, next_p) in pairwise(zip(line.fractions, line.pressures, strict=True))
        if next_z != z
    )


def _exponent(z: float, p: float, next_z: float, next_p: float, clearance: float) -> float:
    return 0.0 if clearance == math.inf else polytropic_exponent(z, p, next_z, next_p, clearance)
