"""The work of the gas in a chamber between two crank angles, closed where the pressure hangs on the displacement."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.crank_angle import CrankAngle
from kurbel.numerics.arithmetic import running_sums
from kurbel.solver.pressure.card import ProcessPressure
from kurbel.solver.turning.torques import exact_product

if TYPE_CHECKING:
    from kurbel.arrays import Array, Indices


class CardWork:
    """∫ p dz in Pa over the stroke fraction z of one chamber between two crank angles, with gauge pressures.

    Whole pieces of the card are added exactly; the piece under way is a closed trapezium or polytropic area.
    """

    def __init__(self, pressure: ProcessPressure) -> None:
        self._pressure = pressure
        self._place = pressure.place
        self._z, self._p, self._gradients, self._exponents, _ = pressure.lines

    @cached_property
    def _up_to(self) -> tuple[Array, Array]:
        """Area up to the start of each piece, and over the whole cycle at the end, each as a float and its rest."""
        process, base = self._pressure.process, self._place.base
        pieces = ((*process.terms_of(one), -base * one.next_z, base * one.z) for one in self._pressure.pieces)
        sums, rests = zip((0.0, 0.0), *running_sums(pieces))
        return np.array(sums), np.array(rests)

    def between(self, low: CrankAngle, high: CrankAngle) -> Array:
        """Return the area between two crank angles (n,), as terms (k, n)."""
        (turns_low, piece_low, part_low), (turns_high, piece_high, part_high) = map(self._at, (low, high))
        sums, rests = self._up_to
        return np.stack(
            (
                sums[-1] * (turns_high - turns_low),
                rests[-1] * (turns_high - turns_low),
                sums[piece_high],
                -sums[piece_low],
                rests[piece_high] - rests[piece_low],
                part_high,
                -part_low,
            )
        )

    def _at(self, angle: CrankAngle) -> tuple[Array, Indices, Array]:
        """Return whole cycles, number of the piece under way, and the area in it so far."""
        degrees, cycle = angle.degrees, self._place.cycle
        turns = np.floor(degrees / cycle)
        piece = np.searchsorted(self._pressure.starts, np.mod(degrees, cycle), side="right") - 1
        # before the first start the last piece of the cycle before is still under way
        turns, piece = np.where(piece < 0, turns - 1, turns), np.where(piece < 0, len(self._z) - 1, piece)
        mechanism = self._place.mechanism
        way = mechanism.coordinate(angle) - mechanism.start - self._starts[0][piece] - self._starts[1][piece]
        return turns, piece, self._part(piece, (way if self._place.head_end else -way) / mechanism.stroke)

    @cached_property
    def _starts(self) -> tuple[Array, Array]:
        """Displacements in m at which the pieces begin, as a float and its rest, so that small ways are exact."""
        stroke = self._place.mechanism.stroke
        at_crank = 1 - self._z
        share, rest = (self._z, 0.0) if self._place.head_end else (at_crank, (1 - at_crank) - self._z)
        product, error = exact_product(share[None, :], stroke)
        return product, error + rest * stroke

    def _part(self, piece: Indices, way: Array) -> Array:
        p = self._p[piece] - self._place.base
        straight: Array = way * (p + self._gradients[piece] * way / 2)
        if not self._pressure.process.polytropic:
            return straight
        return np.where(self._exponents[piece] != 0, self._polytropic(piece, way), straight)

    def _polytropic(self, piece: Indices, way: Array) -> Array:
        """Return P V ln(V′/V) (e^u − 1)/u with u = (1 − n) ln(V′/V) and P absolute, less the ambient times the way."""
        process: Any = self._pressure.process
        volume = self._z[piece] + process.clearance
        growth = np.log1p(way / volume)
        u = (1 - self._exponents[piece]) * growth
        mean = np.where(u == 0, 1.0, np.expm1(u) / np.where(u == 0, 1.0, u))
        area = (self._p[piece] + process.lift) * volume * growth * mean
        return np.asarray(area - self._place.ambient * way)
