"""Cards as processes in mpmath's numbers: what the gas does on each stroke, for cards by points and for ideal ones.

z is the fraction of the stroke from the chamber's smallest volume, V = z + c its volume over the stroke volume. All
pressures are absolute; with a diagram factor κ the card is drawn at p_b + κ (p − p_b) about the back pressure p_b.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple, Union

from kurbel.accuracy.methods import Precise, mp, mpf
from kurbel.machine.ideal_cards import Compressor, Diesel, IdealCard, Otto, Steam
from kurbel.machine.indicator import Card, Rectangle

KnownCard = Union[Card, Rectangle, Steam, Compressor, Otto, Diesel]
KNOWN_CARDS = (Card, Rectangle, Steam, Compressor, Otto, Diesel)


class Fractions(NamedTuple):
    """z of a steam card at the events that a valve sets, or that the card itself has."""

    cut_off: Precise
    release: Precise
    compression: Precise
    lead: Precise


class StrokeLine(NamedTuple):
    """A change of the gas on a stroke from z to z′, p to p′: straight, or with an exponent along p V^n."""

    stroke: int
    begin: Precise
    pressure: Precise
    end: Precise
    end_pressure: Precise
    exponent: Precise | None
    clearance: Precise

    def at(self, z: Precise) -> Precise:
        """Return the pressure at z."""
        if self.exponent is None:
            share = (z - self.begin) / (self.end - self.begin)
            return self.pressure + (self.end_pressure - self.pressure) * share
        return (
            self.pressure * ((self.begin + self.clearance) / (z + self.clearance)) ** self.exponent
        )


class CardProcess(NamedTuple):
    """The lines of a card, and the diagram factor about the back pressure."""

    lines: tuple[StrokeLine, ...]
    factor: Precise = 1
    back: Precise = 0

    def at(self, line: StrokeLine, z: Precise) -> Precise:
        """Return the pressure at z on one of the lines."""
        return self.back + self.factor * (line.at(z) - self.back)


def drawn(
    card: KnownCard,
    lift: Precise,
    is_four_stroke: bool,
    ambient: Precise = 0,
    events: Fractions | None = None,
) -> CardProcess:
    """Return the process of a card.

    lift: in Pa, makes the pressures of the card absolute; ambient: absolute, in Pa; events: those of a valve.
    """
    if isinstance(card, Card):
        return CardProcess(tuple(_by_points(card, lift)))
    if isinstance(card, Rectangle):
        return CardProcess(tuple(_rectangle(card, ambient, lift, is_four_stroke)))
    lines = tuple(_ideal(card, lift, is_four_stroke, events))
    lines = tuple(line for line in lines if line.begin != line.end)
    if isinstance(card, Compressor):
        return CardProcess(lines)
    return CardProcess(lines, mpf(card.diagram_factor), mpf(card.back_pressure) + lift)


def of_liquid(process: CardProcess, clearance: Precise, modulus: Precise) -> CardProcess:
    """Return the process of a pump whose liquid loses Δp/K of its volume at suction pressure; K: in Pa.

    Of what fills the chamber at first the volume is 1 + c, of what stays in the clearance it is c at last.
    """
    suction, delivery = process.lines
    is_level = (
        suction.pressure == suction.end_pressure and delivery.pressure == delivery.end_pressure
    )
    lost = (delivery.pressure - suction.pressure) / modulus
    if not is_level or lost <= 0:
        return process
    delivery_opens = (1 + clearance) * (1 - lost) - clearance
    suction_opens = clearance / (1 - lost) - clearance
    low = suction.pressure
    high = delivery.pressure
    corners = [
        (0, mpf(0), high, suction_opens, low),
        (0, suction_opens, low, mpf(1), low),
        (1, mpf(1), low, delivery_opens, high),
        (1, delivery_opens, high, mpf(0), high),
    ]
    lines = [StrokeLine(*corner, None, clearance) for corner in corners]
    return CardProcess(tuple(line for line in lines if line.begin != line.end))


def _rectangle(
    card: Rectangle, ambient: Precise, lift: Precise, is_four_stroke: bool
) -> Iterator[StrokeLine]:
    """Yield level lines: of the mean pressure the expansion of what drives, or the compression of what is driven."""
    level = ambient if card.level is None else mpf(card.level) + lift
    strokes = 4 if is_four_stroke else 2
    mean = mpf(card.mean)
    raised = 0 if mean > 0 else strokes - 1
    for stroke in range(strokes):
        pressure = level + abs(mean) if stroke == raised else level
        begin = mpf(stroke % 2)
        yield StrokeLine(stroke, begin, pressure, 1 - begin, pressure, None, mpf(0))


def _by_points(card: Card, lift: Precise) -> Iterator[StrokeLine]:
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
            yield StrokeLine(stroke, z, p, next_z, next_p, exponent, clearance)


def _ideal(
    card: IdealCard, lift: Precise, is_four_stroke: bool, events: Fractions | None
) -> Iterator[StrokeLine]:
    """Yield the lines of an ideal card, stroke by stroke."""
    clearance = mpf(card.clearance)

    def level(stroke: int, begin: Precise, pressure: Precise, end: Precise) -> StrokeLine:
        return StrokeLine(stroke, mpf(begin), pressure, mpf(end), pressure, None, clearance)

    def curve(
        stroke: int, begin: Precise, pressure: Precise, end: Precise, exponent: float
    ) -> StrokeLine:
        n = mpf(exponent)
        begin = mpf(begin)
        end = mpf(end)
        end_pressure = pressure
        if begin != end:  # without a distance there may be no volume
            end_pressure = pressure * ((begin + clearance) / (end + clearance)) ** n
        return StrokeLine(stroke, begin, pressure, end, end_pressure, n, clearance)

    if isinstance(card, Steam):
        if events is None:
            assert card.cut_off is not None
            of_card = card.cut_off, card.release, card.compression, card.lead
            events = Fractions(*map(mpf, of_card))
        admission = mpf(card.admission) + lift
        exhaust = mpf(card.exhaust) + lift
        yield level(0, 0, admission, events.cut_off)
        yield curve(0, events.cut_off, admission, events.release, card.exponent)
        yield level(0, events.release, exhaust, 1)
        yield level(1, 1, exhaust, events.compression)
        compression = curve(1, events.compression, exhaust, events.lead, card.exponent)
        yield compression
        yield StrokeLine(
            1, events.lead, compression.end_pressure, mpf(0), admission, None, clearance
        )
    elif isinstance(card, Compressor):
        yield from _compressor(card, lift)
    else:
        # the firing stroke, the strokes that change the gas, and compression
        intake = mpf(card.intake) + lift
        back = mpf(card.back_pressure) + lift
        compression = curve(3 if is_four_stroke else 1, 1, intake, 0, card.exponent)
        peak = compression.end_pressure if card.peak is None else mpf(card.peak) + lift
        cut_off = card.cut_off if isinstance(card, Diesel) else 0
        yield level(0, 0, peak, cut_off)
        yield curve(0, cut_off, peak, 1, card.expansion_exponent)
        if is_four_stroke:
            yield level(1, 1, back, 0)
            yield level(2, 0, intake, 1)
        yield compression


def _compressor(card: Compressor, lift: Precise) -> Iterator[StrokeLine]:
    """Yield what the valves make of expansion and compression: they open where p V^n meets the pressure outside."""
    clearance = mpf(card.clearance)
    suction = mpf(card.suction) + lift
    delivery = mpf(card.delivery) + lift
    if card.unloaded:
        yield StrokeLine(0, mpf(0), suction, mpf(1), suction, None, clearance)
        yield StrokeLine(1, mpf(1), suction, mpf(0), suction, None, clearance)
        return
    expansion = mpf(card.of_expansion)
    exponent = mpf(card.exponent)
    fills = clearance * (delivery / suction) ** (1 / expansion) - clearance
    empties = (1 + clearance) * (suction / delivery) ** (1 / exponent) - clearance
    yield StrokeLine(0, mpf(0), delivery, fills, suction, expansion, clearance)
    yield StrokeLine(0, fills, suction, mpf(1), suction, None, clearance)
    yield StrokeLine(1, mpf(1), suction, empties, delivery, exponent, clearance)
    yield StrokeLine(1, empties, delivery, mpf(0), delivery, None, clearance)
