"""The pieces that lines of cards are made of: straight over the stroke, or polytropic, each with its closed area."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple


class Piece(NamedTuple):
    """Part of a line between two stroke fractions z, where the pressures p (Pa) are given.

    exponent: n of p V^n = const between them, with absolute pressures; 0 for a straight line.
    """

    z: float
    p: float
    next_z: float
    next_p: float
    exponent: float = 0.0


Stroke = tuple[Piece, ...]
"""The pieces of one line, in the order of the process, vertical jumps left out."""


class Process(NamedTuple):
    """What happens in a chamber during one cycle, stroke by stroke from the (firing) dead centre on.

    lift: what makes the pressures absolute, in Pa; clearance: smallest volume over the stroke volume. Straight pieces
    need neither.
    """

    strokes: tuple[Stroke, ...]
    lift: float = 0.0
    clearance: float = math.inf

    @property
    def polytropic(self) -> bool:
        """Whether any piece is."""
        return any(piece.exponent for stroke in self.strokes for piece in stroke)

    @property
    def area(self) -> float:
        """∮ p dz in Pa, closed: exact for straight pieces, to a few roundings of its terms for polytropic ones."""
        return math.fsum(term for stroke in self.strokes for piece in stroke for term in self.terms_of(piece))

    def terms_of(self, piece: Piece) -> tuple[float, ...]:
        """Return floats in Pa whose sum is ∫ p dz over a piece."""
        return self._polytropic_terms(piece) if piece.exponent else tuple(_straight_terms(piece))

    def _polytropic_terms(self, piece: Piece) -> tuple[float, float]:
        """Return P V ln(V′/V) (e^u − 1)/u with u = (1 − n) ln(V′/V) and P absolute, and what the lift takes off."""
        volume, way = piece.z + self.clearance, piece.next_z - piece.z
        growth = math.log1p(way / volume)
        u = (1 - piece.exponent) * growth
        mean = math.expm1(u) / u if u else 1.0
        return (piece.p + self.lift) * volume * growth * mean, -self.lift * way


def polytropic_exponent(z: float, p: float, next_z: float, next_p: float, clearance: float) -> float:
    """Return n of p V^n = const through two points: stroke fractions z, absolute pressures p, relative clearance.

    >>> polytropic_exponent(0.0, 8.0, 1.0, 4.0, 1.0)
    1.0
    """
    return math.log(p / next_p) / math.log1p((next_z - z) / (z + clearance))


def _straight_terms(piece: Piece) -> Iterable[float]:
    """Yield floats whose exact sum is (p + p′)(z′ − z)/2, so that nearly cancelling cards lose nothing."""
    for p in (piece.p / 2, piece.next_p / 2):
        yield from _exact_product(p, piece.next_z)
        yield from (-part for part in _exact_product(p, piece.z))


def _exact_product(a: float, b: float) -> tuple[float, float]:
    """Return a·b as two floats, whose sum is the exact product (Dekker)."""
    product = a * b
    a_high, b_high = (x * 134217729.0 - (x * 134217729.0 - x) for x in (a, b))
    a_low, b_low = a - a_high, b - b_high
    return product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low
