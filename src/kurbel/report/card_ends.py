"""Whether the two cards of a double-acting piston look drawn from the same dead centre: said, as they may be right."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

from kurbel.machine.indicator import Card
from kurbel.machine.piston import Piston

_PLAIN = 0.02
"""Lean of a card, over its range of pressures, below which it has no high end; one open for half the stroke has ¼."""


def card_end_notes(piston: Piston) -> Iterable[str]:
    """Yield a note where both ends of a piston have their high pressure on the same side, at the same crank angle."""
    ends = (piston.indicator.head_end, piston.indicator.crank_end) if piston.indicator else ()
    leans = [_lean(end) for end in ends if isinstance(end, Card)]
    if len(leans) < 2 or min(leans) >= -_PLAIN or max(leans) <= _PLAIN:
        return
    end, centre = ("crank end", "outer") if leans[1] < 0 else ("head end", "inner")
    yield (
        f"{piston.name}, {end}: both ends have their high pressure at the same crank angle; a card counts from its own "
        f"dead centre, that of the {end} from the {centre} one: is it drawn from the other?"
    )


def _lean(card: Card) -> float:
    """Return the mean of p (1 − 2z) over both strokes by the range of p: positive where p is high at small volumes."""
    pressures = [p for line in card.lines for p in line.pressures]
    middle, span = (max(pressures) + min(pressures)) / 2, max(pressures) - min(pressures)
    points = [pairwise(zip(line.fractions, line.pressures)) for line in card.lines]
    parts = [_part(z, p - middle, z2, p2 - middle) for line in points for (z, p), (z2, p2) in line]
    return sum(parts) / (span * len(card.lines)) if span else 0.0


def _part(z: float, p: float, next_z: float, next_p: float) -> float:
    """Return ∫ p (1 − 2z) |dz| over a straight piece, by Simpson's rule, which is exact."""
    ends = p * (1 - 2 * z) + next_p * (1 - 2 * next_z)
    return abs(next_z - z) / 6 * (ends + 2 * (p + next_p) * (1 - z - next_z))
