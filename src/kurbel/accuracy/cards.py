"""Cards as processes in mpmath's numbers: what the gas does on each stroke, for cards by points and for ideal ones.

z is the fraction of the stroke from the chamber's smallest volume, V = z + c its volume over the stroke volume. All
pressures are absolute; with a diagram factor κ the card is drawn at p_b + κ (p − p_b) about the back pressure p_b.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple, Union

from kurbel.accuracy.methods import Number, mp, mpf
from kurbel.machine.ideal_cards import Compressor, Diesel, IdealCard, Otto, Steam
from kurbel.machine.indicator import Card

KnownCard = Union[Card, Steam, Compressor, Otto, Diesel]
KNOWN_CARDS = (Card, Steam, Compressor, Otto, Diesel)


def without_process(chamber: object) -> str:
    """Return what keeps a chamber from having a process here; '' where it has one."""
    if not isinstance(chamber, KNOWN_CARDS):
        return "a trace or a card of a mean pressure"
    if isinstance(chamber, Steam) and chamber.cut_off is None:
        return "a card whose events a valve sets"
    return ""


class Line(NamedTuple):
    """A change of the gas on a stroke from z to z′, p to p′: straight, or with an exponent along p V^n."""

    stroke: int
    begin: Number
    pressure: Number
    end: Number
    end_pressure: Number
    exponent: Number | None
    clearance: Number

    def at(self, z: Number) -> Number:
        """Return the pressure at z."""
        if self.exponent is None:
            share = (z - self.begin) / (self.end - self.begin)
            return self.pressure + (self.end_pressure - self.pressure) * share
        return (
            self.pressure * ((self.begin + self.clearance) / (z + self.clearance)) ** self.exponent
        )


class Drawing(NamedTuple):
    """The lines of a card, and the diagram factor about the back pressure."""

    lines: tuple[Line, ...]
    factor: Number = 1
    back: Number = 0

    def at(self, line: Line, z: Number) -> Number:
        """Return the pressure at z on one of the lines."""
        return self.back + self.factor * (line.at(z) - self.back)


def drawn(card: KnownCard, lift: Number, is_four_stroke: bool) -> Drawing:
    """Return the process of a card; lift: in Pa, makes its pressures absolute."""
    if isinstance(card, Card):
        return Drawing(tuple(_by_points(card, lift)))
    lines = tuple(line for line in _ideal(card, lift, is_four_stroke) if line.begin != line.end)
    if isinstance(card, Compressor):
        return Drawing(lines)
    return Drawing(lines, mpf(card.diagram_factor), mpf(card.back_pressure) + lift)


def _by_points(card: Card, lift: Number) -> Iterator[Line]:
    """Yield the lines between the points of a card; p V^n runs through both ends."""
    clearance = mpf(card.clearance or 0)
    for stroke, line in enumerate(card.lines):
        points = [(mpf(z), mpf(p) + lift) for z, p in zip(line.fractions, line.pressures)]
        for (z, p), (next_z, next_p) in pairwise(points):
            if z == next_z:
                continue
            exponent = None
            if card.interpolate != "linear":
                exponent = mp.log(next_p / p) / mp.log((z + clearance) / (next_z + clearance))
            yield Line(stroke, z, p, next_z, next_p, exponent, clearance)


def _ideal(card: IdealCard, lift: Number, is_four_stroke: bool) -> Iterator[Line]:
    """Yield the lines of an ideal card, stroke by stroke."""
    clearance = mpf(card.clearance)

    def level(stroke: int, begin: float, pressure: Number, end: float) -> Line:
        return Line(stroke, mpf(begin), pressure, mpf(end), pressure, None, clearance)

    def curve(stroke: int, begin: float, pressure: Number, end: float, exponent: float) -> Line:
        n = mpf(exponent)
        begin, end = mpf(begin), mpf(end)
        end_pressure = pressure
        if begin != end:  # without a distance there may be no volume
            end_pressure = pressure * ((begin + clearance) / (end + clearance)) ** n
        return Line(stroke, begin, pressure, end, end_pressure, n, clearance)

    if isinstance(card, Steam):
        assert card.cut_off is not None
        admission, exhaust = mpf(card.admission) + lift, mpf(card.exhaust) + lift
        yield level(0, 0, admission, card.cut_off)
        yield curve(0, card.cut_off, admission, card.release, card.exponent)
        yield level(0, card.release, exhaust, 1)
        yield level(1, 1, exhaust, card.compression)
        compression = curve(1, card.compression, exhaust, card.lead, card.exponent)
        yield compression
        yield Line(1, mpf(card.lead), compression.end_pressure, mpf(0), admission, None, clearance)
    elif isinstance(card, Compressor):
        yield from _compressor(card, lift)
    else:
        # the firing stroke, the strokes that change the gas, and compression
        intake, back = mpf(card.intake) + lift, mpf(card.back_pressure) + lift
        compression = curve(3 if is_four_stroke else 1, 1, intake, 0, card.exponent)
        peak = compression.end_pressure if card.peak is None else mpf(card.peak) + lift
        cut_off = card.cut_off if isinstance(card, Diesel) else 0
        yield level(0, 0, peak, cut_off)
        yield curve(0, cut_off, peak, 1, card.expansion_exponent)
        if is_four_stroke:
            yield level(1, 1, back, 0)
            yield level(2, 0, intake, 1)
        yield compression


def _compressor(card: Compressor, lift: Number) -> Iterator[Line]:
    """Yield what the valves make of expansion and compression: they open where p V^n meets the pressure outside."""
    clearance, suction, delivery = (
        mpf(card.clearance),
        mpf(card.suction) + lift,
        mpf(card.delivery) + lift,
    )
    if card.unloaded:
        yield Line(0, mpf(0), suction, mpf(1), suction, None, clearance)
        yield Line(1, mpf(1), suction, mpf(0), suction, None, clearance)
        return
    expansion, exponent = mpf(card.of_expansion), mpf(card.exponent)
    fills = clearance * (delivery / suction) ** (1 / expansion) - clearance
    empties = (1 + clearance) * (suction / delivery) ** (1 / exponent) - clearance
    yield Line(0, mpf(0), delivery, fills, suction, expansion, clearance)
    yield Line(0, fills, suction, mpf(1), suction, None, clearance)
    yield Line(1, mpf(1), suction, empties, delivery, exponent, clearance)
    yield Line(1, empties, delivery, mpf(0), delivery, None, clearance)
