"""Pressures in the chambers over the crank angle, and the closed work of cards."""

from __future__ import annotations

import math
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kurbel.errors import UsageError
from kurbel.machine.indicator import Card, Line
from kurbel.mechanisms import Mechanism

Array = NDArray[np.float64]


class CardPressure:
    """Gauge pressure in one chamber from its card, straight over the stroke between the points of the card.

    The pieces between two points are found by crank angle, not by displacement, so that each side of a jump can be
    asked for exactly: `within` names an angle inside the piece that is meant.

    starts: (n,) crank angles in degrees in [0, cycle) at which a piece begins, ascending.
    """

    def __init__(self, card: Card, mechanism: Mechanism, cycle: float, head_end: bool, ambient: float) -> None:
        if card.interpolate != "linear":
            raise UsageError("cards with 'interpolate: polytropic' are read and checked, but nothing computes them yet")
        self.card = card
        self.cycle = cycle
        self.head_end = head_end
        self._stroke = mechanism.stroke
        pieces = sorted(
            piece
            for index, line in enumerate(card.lines)
            for piece in _pieces(line, index, mechanism, cycle, head_end, ambient)
        )
        self.starts, self._fractions, self._pressures, self._gradients = np.array(pieces).T

    def __call__(self, x: Any, within: Array) -> Any:
        """Return the gauge pressure in Pa at displacements x (n,) in m, on the pieces that hold the angles `within`."""
        piece = np.searchsorted(self.starts, np.mod(within, self.cycle), side="right") - 1
        fraction = x / self._stroke if self.head_end else 1 - x / self._stroke
        return self._pressures[piece] + self._gradients[piece] * (fraction - self._fractions[piece])

    @cached_property
    def area(self) -> float:
        """∮ p dz over the stroke fraction z in Pa, per cycle: the exact area of the polygon, correctly rounded.

        Half the sum of p_i z_{i+1} − p_{i+1} z_i round the closed polygon; every product is split into two floats, so
        that nearly cancelling cards lose nothing.
        """
        z = np.array([fraction for line in self.card.lines for fraction in line.fractions])
        p = np.array([pressure for line in self.card.lines for pressure in line.pressures])
        terms = (*_exact_product(p, np.roll(z, -1)), *(-part for part in _exact_product(np.roll(p, -1), z)))
        return math.fsum(np.concatenate(terms).tolist()) / 2


def _exact_product(a: Array, b: Array) -> tuple[Array, Array]:
    """Return a·b as two floats each, whose sum is the exact product (Dekker)."""
    product = a * b
    a_high, b_high = (x * 134217729.0 - (x * 134217729.0 - x) for x in (a, b))
    a_low, b_low = a - a_high, b - b_high
    return product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


def _pieces(
    line: Line, index: int, mechanism: Mechanism, cycle: float, head_end: bool, ambient: float
) -> list[tuple[float, float, float, float]]:
    """Return (start angle, fraction, pressure, gradient by fraction) for every piece of one line of a card."""
    kept = [
        (z, p, (following_p - p) / (following_z - z))
        for (z, p), (following_z, following_p) in pairwise(zip(line.fractions, line.pressures, strict=True))
        if following_z != z
    ]
    # the crank end begins its process at the outer dead centre, one stroke later
    stroke = index + (0 if head_end else 1)
    inner, outer = mechanism.dead_centres()
    turn = 360.0 * (stroke // 2)
    begin = turn + (inner, outer)[stroke % 2]
    fractions = np.array([z for z, _, _ in kept[1:]])
    along = fractions if head_end else 1 - fractions
    angles = turn + mechanism.crank_angles_at(along * mechanism.stroke, stroke % 2 == 0) if len(kept) > 1 else []
    starts = np.mod(np.concatenate(([begin], angles)), cycle)
    return [(float(start), z, p - ambient, slope) for start, (z, p, slope) in zip(starts, kept, strict=True)]


class PistonGas:
    """The pressures on both sides of one piston."""

    def __init__(self, piston: Any, mechanism: Mechanism, cycle: float, ambient: float) -> None:
        indicator = piston.indicator
        base = ambient if indicator.absolute else 0.0
        self.piston = piston
        self.head, self.crank = (
            None if chamber is None else _pressure(chamber, mechanism, cycle, head_end, base)
            for chamber, head_end in ((indicator.head_end, True), (indicator.crank_end, False))
        )
        self._stroke = mechanism.stroke

    @property
    def starts(self) -> list[Array]:
        """The crank angles in degrees at which a pressure bends or jumps."""
        return [end.starts for end in (self.head, self.crank) if end]

    def force(self, x: Any, within: Array) -> Any:
        """Return P = p_H A_H − p_C A_C in N, R 296, with gauge pressures."""
        force: Any = 0.0
        if self.head:
            force = force + self.piston.head_area * self.head(x, within)
        if self.crank:
            force = force - self.piston.crank_area * self.crank(x, within)
        return force

    @property
    def works(self) -> tuple[float, float]:
        """Indicated work in J per cycle of head end and crank end: A s ∮ p dz."""
        return (
            self.piston.head_area * self._stroke * self.head.area if self.head else 0.0,
            self.piston.crank_area * self._stroke * self.crank.area if self.crank else 0.0,
        )

    @property
    def work(self) -> float:
        """Indicated work in J per cycle."""
        return math.fsum(self.works)

    @property
    def swept_volume(self) -> float:
        """Volume in m³ swept in the chambers that have pressures."""
        head = self.piston.head_area if self.head else 0.0
        return float((head + (self.piston.crank_area if self.crank else 0.0)) * self._stroke)


def _pressure(chamber: Any, mechanism: Mechanism, cycle: float, head_end: bool, ambient: float) -> CardPressure:
    if not isinstance(chamber, Card):
        kind = type(chamber).__name__.lower()
        raise UsageError(f"an indicator of kind '{kind}' is read and checked, but nothing computes it yet")
    return CardPressure(chamber, mechanism, cycle, head_end, ambient)
