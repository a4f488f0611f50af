"""The lines of the ideal cards."""

import math

from kurbel.machine.ideal_cards import Compressor, IdealCard, Otto, Steam, after_polytrope

IdealLine = tuple[int, float, float, float, float, float]
"""One of the lines of a `kurbel.solver.gas.Process`."""


def ideal_lines(card: IdealCard, lift: float, four_stroke: bool) -> tuple[float, list[IdealLine]]:
    """Return what makes its pressures absolute, in Pa, and the lines of an ideal card; see `_lines`."""
    lines = _lines(card, lift, four_stroke)
    if (
        not isinstance(card, Compressor) and card.diagram_factor != 1
    ):  # p V^n = const about another vacuum
        factor, back = card.diagram_factor, card.back_pressure
        lift = factor * lift - (1 - factor) * back
        lines = [
            (stroke, z, back + factor * (p - back), next_z, back + factor * (next_p - back), n)
            for stroke, z, p, next_z, next_p, n in lines
        ]
    return lift, lines


def _lines(card: IdealCard, lift: float, four_stroke: bool) -> list[IdealLine]:
    """Return the lines of an ideal card, in the order of the strokes from the inner dead centre where it fires or admits.

    four_stroke: of an engine, with strokes of exhaust and intake; lift: pressure in Pa to be added for absolute pressures.
    """
    clearance = card.clearance
    lines = list[IdealLine]()

    def run(stroke: int, z: float, p: float, next_z: float, exponent: float = 0.0) -> float:
        """Draw a line of constant pressure, or with an exponent along p V^n = const; return the pressure at its end.

        z, next_z: fractions of the stroke.
        """
        next_p = p
        if exponent and next_z != z:  # without a distance there may be no volume
            next_p = after_polytrope(p + lift, z + clearance, next_z + clearance, exponent) - lift
        lines.append((stroke, z, p, next_z, next_p, exponent))
        return next_p

    if isinstance(card, Steam):
        # admission, expansion, exhaust; exhaust, compression
        assert card.cut_off is not None
        run(0, 0.0, card.admission, card.cut_off)
        run(0, card.cut_off, card.admission, card.release, card.exponent)
        run(0, card.release, card.exhaust, 1.0)
        run(1, 1.0, card.exhaust, card.compression)
        compressed = run(1, card.compression, card.exhaust, card.lead, card.exponent)
        # the valve opens before the dead centre: a straight rise
        lines.append((1, card.lead, compressed, 0.0, card.admission, 0.0))
    elif isinstance(card, Compressor) and card.unloaded:
        run(0, 0.0, card.suction, 1.0)
        run(1, 1.0, card.suction, 0.0)
    elif isinstance(card, Compressor):
        # expansion of the clearance gas, suction; compression, delivery
        log_ratio = math.log((card.delivery + lift) / (card.suction + lift))
        expansion = card.of_expansion
        fills = clearance * math.expm1(log_ratio / expansion)
        empties = 1.0 + (1.0 + clearance) * math.expm1(-log_ratio / card.exponent)
        lines.append((0, 0.0, card.delivery, fills, card.suction, expansion))
        run(0, fills, card.suction, 1.0)
        lines.append((1, 1.0, card.suction, empties, card.delivery, card.exponent))
        run(1, empties, card.delivery, 0.0)
    else:
        # engines: compression, combustion, expansion; then exhaust and intake
        compression_stroke = 3 if four_stroke else 1
        compressed = run(compression_stroke, 1.0, card.intake, 0.0, card.exponent)
        if isinstance(card, Otto):
            run(0, 0.0, card.peak, 1.0, card.expansion_exponent)
        else:  # injection at constant pressure
            burning = compressed if card.peak is None else card.peak
            run(0, 0.0, burning, card.cut_off)
            run(0, card.cut_off, burning, 1.0, card.expansion_exponent)
        if four_stroke:
            run(1, 1.0, card.back_pressure, 0.0)
            run(2, 0.0, card.intake, 1.0)
    return sorted(lines, key=lambda line: line[0])
