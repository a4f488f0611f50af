"""Ideal cards: processes of exact polytropic lines and isobars, drawn from the few numbers of a theoretical cycle.

Every line is closed: pressures at its corners follow from p V^n = const with absolute pressures, and so does its area.
"""

import math
from collections.abc import Callable
from typing import Any

from kurbel.machine.ideal_cards import Compressor, Diesel, IdealCard, Otto, Steam, after_polytrope
from kurbel.solver.pressure import Setting
from kurbel.solver.pressure.segments import Process, Segment, Stroke


def process_in(card: IdealCard, setting: Setting) -> Process:
    """Return the process of an ideal card, where it stands."""
    return ideal_process(card, setting.lift, round(setting.cycle / 360))


def ideal_process(card: IdealCard, lift: float = 0.0, revolutions: int = 1) -> Process:
    """Return the process of an ideal card; lift makes its pressures absolute (Pa); revolutions per cycle."""
    drawing = _Drawing(lift, card.clearance, revolutions == 2)
    return Process(_DRAWN[type(card)](drawing, card), lift, card.clearance)


class _Drawing:
    """Draws segments of a card with one clearance; lift makes its pressures absolute; four_stroke: gas exchange too."""

    def __init__(self, lift: float, clearance: float, four_stroke: bool) -> None:
        self.four_stroke = four_stroke
        self.lift = lift
        self.clearance = clearance

    def polytrope(self, z: float, p: float, next_z: float, exponent: float) -> Segment:
        """Return p V^n = const from the point (z, p) to the stroke fraction next_z."""
        if next_z == z:  # even where there is no volume
            return _isobar(z, p, z)
        absolute = after_polytrope(p + self.lift, z + self.clearance, next_z + self.clearance, exponent)
        return Segment(z, p, next_z, absolute - self.lift, exponent)

    def fraction_after(self, z: float, p: float, next_p: float, exponent: float) -> float:
        """Return the stroke fraction at which p V^n = const from (z, p) reaches next_p."""
        volume = z + self.clearance
        ratio = (p + self.lift) / (next_p + self.lift)
        return z + volume * math.expm1(math.log(ratio) / exponent)

    def steam(self, card: Steam) -> tuple[Stroke, ...]:
        """Admission, expansion, exhaust; exhaust, compression."""
        expansion = self.polytrope(card.cut_off, card.admission, card.release, card.exponent)
        compression = self.polytrope(card.compression, card.exhaust, 0.0, card.exponent)
        return (
            _wide(
                _isobar(0.0, card.admission, card.cut_off),
                expansion,
                _isobar(card.release, card.exhaust, 1.0),
            ),
            _wide(_isobar(1.0, card.exhaust, card.compression), compression),
        )

    def compressor(self, card: Compressor) -> tuple[Stroke, ...]:
        """Expansion of the clearance gas, suction; compression, delivery."""
        fills = self.fraction_after(0.0, card.delivery, card.suction, card.exponent)
        empties = self.fraction_after(1.0, card.suction, card.delivery, card.exponent)
        return (
            _wide(
                Segment(0.0, card.delivery, fills, card.suction, card.exponent),
                _isobar(fills, card.suction, 1.0),
            ),
            _wide(
                Segment(1.0, card.suction, empties, card.delivery, card.exponent),
                _isobar(empties, card.delivery, 0.0),
            ),
        )

    def otto(self, card: Otto) -> tuple[Stroke, ...]:
        """Expansion from the peak; then as every engine."""
        return self._engine(card, (self.polytrope(0.0, card.peak, 1.0, card.expansion_exponent),))

    def diesel(self, card: Diesel) -> tuple[Stroke, ...]:
        """Injection at constant pressure, expansion; then as every engine."""
        burning = self._compression(card).next_p if card.peak is None else card.peak
        power = (
            _isobar(0.0, burning, card.cut_off),
            self.polytrope(card.cut_off, burning, 1.0, card.expansion_exponent),
        )
        return self._engine(card, power)

    def _compression(self, card: Otto | Diesel) -> Segment:
        return self.polytrope(1.0, card.intake, 0.0, card.exponent)

    def _engine(self, card: Otto | Diesel, power: Stroke) -> tuple[Stroke, ...]:
        compression = (self._compression(card),)
        if not self.four_stroke:
            return power, compression
        return power, (_isobar(1.0, card.leaving, 0.0),), (_isobar(0.0, card.intake, 1.0),), compression


_DRAWN: dict[type, Callable[[_Drawing, Any], tuple[Stroke, ...]]] = {
    Steam: _Drawing.steam,
    Compressor: _Drawing.compressor,
    Otto: _Drawing.otto,
    Diesel: _Drawing.diesel,
}


def _isobar(z: float, p: float, next_z: float) -> Segment:
    return Segment(z, p, next_z, p)


def _wide(*segments: Segment) -> Stroke:
    """Return the segments that have any width."""
    return tuple(segment for segment in segments if segment.next_z != segment.z)
