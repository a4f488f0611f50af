"""The pressure of a card: segments over the stroke, found by crank angle."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.crank_angle import CrankAngle
from kurbel.machine.angle_points import CYCLES
from kurbel.machine.indicator import STROKES, Card, Line
from kurbel.mechanisms import fan
from kurbel.numerics.jet import once_each
from kurbel.solver.pressure import Setting
from kurbel.solver.pressure.segments import Process, Segment, Stroke, polytropic_exponent

if TYPE_CHECKING:
    from kurbel.arrays import Array, Indices
    from kurbel.machine.rectangle import Rectangle


class ProcessPressure:
    """Gauge pressure in one chamber from a process over the stroke.

    The segments are found by crank angle, not by displacement, so that each side of a vertical jump can be asked for
    exactly. starts, bends: as `Pressure` says.
    """

    def __init__(self, process: Process, setting: Setting) -> None:
        self.process = process
        self.setting = setting
        self._stroke = setting.mechanism.stroke
        begun = sorted(
            (begun for index, stroke in enumerate(process.strokes) for begun in _begun(stroke, index, setting)),
            key=lambda begun: begun[0],
        )
        self.starts = np.array([start for start, _ in begun])
        self._z, self._p, self._next_z, next_p, self._exponents = np.array([segment for _, segment in begun]).T
        self._gradients = (next_p - self._p) / (self._next_z - self._z)
        self._polytropic = bool(self._exponents.any())
        self._ends = np.roll(self.starts, -1)

    def __call__(self, x: Any, angle: CrankAngle, within: Array) -> Any:
        """Return the gauge pressure in Pa at displacements x (n,) in m, on the segments that hold `within` (n,)."""
        segment = np.searchsorted(self.starts, np.mod(once_each(within), self.setting.cycle), side="right") - 1
        share = x / self._stroke if self.setting.head_end else 1 - x / self._stroke
        share = self._at_corners(share, angle, segment)
        straight = (self._p[segment] - self.setting.base) + self._gradients[segment] * (share - self._z[segment])
        return self._curved(straight, share, segment) if self._polytropic else straight

    def _at_corners(self, share: Any, angle: CrankAngle, segment: Indices) -> Any:
        """Return the stroke fractions, at corners those of the card: their angles are rounded, lines may be steep."""
        turned = np.mod(angle.degrees, self.setting.cycle)
        begins = np.abs(turned - self.starts[segment]) <= _ROUNDING
        ends = np.abs(turned - self._ends[segment]) <= _ROUNDING
        if not (begins.any() or ends.any()):
            return share
        value = getattr(share, "value", share)
        return share + (np.where(begins, self._z[segment], np.where(ends, self._next_z[segment], value)) - value)

    def _curved(self, straight: Any, share: Any, segment: Indices) -> Any:
        """Return P (V/V′)^n less the ambient on polytropic segments, and the straight value elsewhere."""
        exponents, clearance = self._exponents[segment], self.process.clearance
        curved = exponents != 0  # what is straight may begin without any volume
        # beside a dead centre rounding may put x a hair outside the stroke; the clearance keeps the volume positive
        swelling = _chosen(curved, share + clearance, 1.0) / np.where(curved, self._z[segment] + clearance, 1.0)
        power = (self._p[segment] + self.process.lift) * swelling**-exponents - self.setting.ambient
        return _chosen(curved, power, straight)

    @cached_property
    def bends(self) -> tuple[float, ...]:
        """Angles in degrees beside the dead centre of the smallest volume, where a polytropic line bends sharply."""
        if not self._polytropic:
            return ()
        mechanism = self.setting.mechanism
        dead_centre = mechanism.dead_centres()[0 if self.setting.head_end else 1]
        curvature = abs(mechanism.curvature(CrankAngle.of(dead_centre)))
        width = math.degrees(math.sqrt(2 * self.process.clearance * self._stroke / curvature)) if curvature else 0.0
        return fan(dead_centre, width)

    @cached_property
    def area(self) -> float:
        """∮ p dz over the stroke fraction z in Pa, per cycle, closed."""
        return self.process.area


def _chosen(condition: Array, value: Any, otherwise: Any) -> Any:
    """Return an array or a jet that is `value` where the condition holds, and `otherwise` elsewhere."""
    return getattr(value, "where", np.where)(condition, value, otherwise)


_ROUNDING = 3e-13
"""Degrees of crank angle by which the angle of a corner may be off: a few units in the last place of 720."""
_NO_WIDTH = 1e-10
"""Degrees of crank angle; over less a line cannot be followed, and its segment is a jump."""


def _begun(stroke: Stroke, index: int, setting: Setting) -> Iterator[tuple[float, Segment]]:
    """Yield the crank angles in degrees in [0, cycle) at which the segments of one stroke begin, jumps left out."""
    edges = _edges(stroke, index, setting)
    # beside the other end of the stroke rounding may turn two angles round
    widths = np.mod(np.diff(edges) + 1, 360.0) - 1
    wide = [(start, segment) for start, segment, width in zip(edges, stroke, widths, strict=False) if width > _NO_WIDTH]
    for number, (start, segment) in enumerate(wide):
        yield float((start if number else edges[0]) % setting.cycle), segment


def _edges(stroke: Stroke, index: int, setting: Setting) -> Array:
    """Return the crank angles in degrees at which the segments of one stroke begin, and that at which it ends."""
    # the crank end begins its process at the outer dead centre, one stroke later
    number = index + (0 if setting.head_end else 1)
    begin, end = (_dead_centre(setting, each) for each in (number, number + 1))
    fractions = np.array([segment.z for segment in stroke[1:]])
    along = fractions if setting.head_end else 1 - fractions
    angles = (
        setting.mechanism.crank_angles_at(along * setting.mechanism.stroke, number % 2 == 0) if len(stroke) > 1 else []
    )
    return np.concatenate(([begin], 360.0 * (number // 2) + np.asarray(angles), [end]))


def _dead_centre(setting: Setting, number: int) -> float:
    """Return the crank angle in degrees at which this stroke begins; strokes count from 0 on."""
    return 360.0 * (number // 2) + setting.mechanism.dead_centres()[number % 2]


class CardPressure(ProcessPressure):
    """The pressure of a card drawn by points, joined as the card says."""

    def __init__(self, card: Card, setting: Setting) -> None:
        super().__init__(card_process(card, setting.lift), setting)


def rectangle_pressure(card: Rectangle, setting: Setting) -> ProcessPressure:
    """Return the pressure of a rectangular card: the mean pressure stands on the stroke that drives, or is driven."""
    level = setting.base if card.level is None else card.level
    above = {"expansion": max(card.mean, 0.0), "compression": max(-card.mean, 0.0)}
    names = next(names for cycle, names in STROKES.items() if 360.0 * CYCLES[cycle] == setting.cycle)
    pressures = [level + above.get(name, 0.0) for name in names]
    strokes = tuple((Segment(float(i % 2), p, float(1 - i % 2), p),) for i, p in enumerate(pressures))
    return ProcessPressure(Process(strokes), setting)


def card_process(card: Card, lift: float) -> Process:
    """Return the process of a card; lift makes its pressures absolute, in Pa."""
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
