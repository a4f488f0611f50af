"""The pressure of a card: pieces over the stroke, found by crank angle."""

from __future__ import annotations

import math
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.crank_angle import CrankAngle
from kurbel.machine.indicator import Card, Line
from kurbel.mechanisms import fan
from kurbel.solver.jet import once_each
from kurbel.solver.pressure import Place
from kurbel.solver.pressure.pieces import Piece, Process, Stroke, polytropic_exponent

if TYPE_CHECKING:
    from kurbel.arrays import Array, Indices


class ProcessPressure:
    """Gauge pressure in one chamber from a process over the stroke.

    The pieces are found by crank angle, not by displacement, so that each side of a vertical jump can be asked for
    exactly. starts, bends: as `Pressure` says; pieces: those that begin at `starts`.
    """

    def __init__(self, process: Process, place: Place) -> None:
        self.process = process
        self.place = place
        self._stroke = place.mechanism.stroke
        begun = sorted(
            (float(start), piece)
            for index, stroke in enumerate(process.strokes)
            for start, piece in zip(_starts(stroke, index, place), stroke, strict=True)
        )
        self.starts = np.array([start for start, _ in begun])
        self.pieces = tuple(piece for _, piece in begun)
        self._z, self._p, next_z, next_p, self._exponents = np.array(self.pieces).T
        self._gradients = (next_p - self._p) / (next_z - self._z)

    def __call__(self, x: Any, angle: CrankAngle, within: Array) -> Any:
        """Return the gauge pressure in Pa at displacements x (n,) in m, on the pieces that hold the angles `within`."""
        piece = np.searchsorted(self.starts, np.mod(once_each(within), self.place.cycle), side="right") - 1
        share = x / self._stroke if self.place.head_end else 1 - x / self._stroke
        straight = (self._p[piece] - self.place.base) + self._gradients[piece] * (share - self._z[piece])
        return self._curved(straight, share, piece) if self.process.polytropic else straight

    def _curved(self, straight: Any, share: Any, piece: Indices) -> Any:
        """Return P (V/V′)^n less the ambient on polytropic pieces, and the straight value elsewhere."""
        clearance, exponents = self.process.clearance, self._exponents[piece]
        # beside a dead centre rounding may put x a hair outside the stroke; the clearance keeps the volume positive
        swelling = (share + clearance) / (self._z[piece] + clearance)
        power = (self._p[piece] + self.process.lift) * swelling**-exponents - self.place.ambient
        if hasattr(power, "where"):
            return power.where(exponents != 0, power, straight)
        return np.where(exponents != 0, power, straight)

    @cached_property
    def bends(self) -> Array:
        """Angles in degrees beside the dead centre of the smallest volume, where a polytropic line bends sharply."""
        if not self.process.polytropic:
            return np.array([])
        mechanism, cycle = self.place.mechanism, self.place.cycle
        dead_centre = mechanism.dead_centres()[0 if self.place.head_end else 1]
        curvature = abs(mechanism.curvature(CrankAngle.of(dead_centre)))
        width = math.degrees(math.sqrt(2 * self.process.clearance * self._stroke / curvature)) if curvature else 0.0
        marks = np.array(fan(dead_centre, width))
        return np.asarray(np.mod(np.concatenate([marks + turn for turn in np.arange(0.0, cycle, 360.0)]), cycle))

    @cached_property
    def area(self) -> float:
        """∮ p dz over the stroke fraction z in Pa, per cycle, closed."""
        return self.process.area


def _starts(stroke: Stroke, index: int, place: Place) -> Array:
    """Return the crank angles in degrees in [0, cycle) at which the pieces of one stroke begin."""
    # the crank end begins its process at the outer dead centre, one stroke later
    number = index + (0 if place.head_end else 1)
    inner, outer = place.mechanism.dead_centres()
    turn = 360.0 * (number // 2)
    begin = turn + (inner, outer)[number % 2]
    fractions = np.array([piece.z for piece in stroke[1:]])
    along = fractions if place.head_end else 1 - fractions
    way = along * place.mechanism.stroke
    angles = turn + place.mechanism.crank_angles_at(way, number % 2 == 0) if len(stroke) > 1 else []
    return np.asarray(np.mod(np.concatenate(([begin], angles)), place.cycle))


class CardPressure(ProcessPressure):
    """The pressure of a card drawn by points, joined as the card says."""

    def __init__(self, card: Card, place: Place) -> None:
        super().__init__(card_process(card, place.lift), place)


def card_process(card: Card, lift: float) -> Process:
    """Return the process of a card; lift makes its pressures absolute, in Pa."""
    clearance = math.inf if card.interpolate == "linear" or card.clearance is None else card.clearance
    return Process(tuple(_stroke(line, lift, clearance) for line in card.lines), lift, clearance)


def _stroke(line: Line, lift: float, clearance: float) -> Stroke:
    return tuple(
        Piece(z, p, next_z, next_p, _exponent(z, p + lift, next_z, next_p + lift, clearance))
        for (z, p), (next_z, next_p) in pairwise(zip(line.fractions, line.pressures, strict=True))
        if next_z != z
    )


def _exponent(z: float, p: float, next_z: float, next_p: float, clearance: float) -> float:
    return 0.0 if clearance == math.inf else polytropic_exponent(z, p, next_z, next_p, clearance)
