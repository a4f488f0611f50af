"""The segments that lines of cards are made of: straight over the stroke, or polytropic, each with its closed area."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Indices
from kurbel.machine.variants import count_of
from kurbel.numerics.arithmetic import log1p, where
from kurbel.solver.pressure import Setting


class Segment(NamedTuple):
    """Part of a line between two stroke fractions z, where the pressures p (Pa) are given;
    numbers, or those of many segments (n,).

    exponent: n of p V^n = const between them, with absolute pressures; 0 for a straight line.
    """

    z: Any
    p: Any
    next_z: Any
    next_p: Any
    exponent: Any = 0.0


Stroke = tuple[Segment, ...]
"""The segments of one line, in the order of the process, vertical jumps left out."""


@dataclass(frozen=True, eq=False)
class Process:
    """What happens in a chamber during one cycle, stroke by stroke from the (firing) dead centre on.

    lift: what makes the pressures absolute, in Pa; clearance: smallest volume over the stroke volume. Straight segments
    need neither.
    """

    strokes: tuple[Stroke, ...]
    lift: float = 0.0
    clearance: float = math.inf

    @property
    def area(self) -> float:
        """∮ p dz in Pa, closed: exact for straight segments, to a few roundings of its terms for polytropic ones."""
        return math.fsum(term for stroke in self.strokes for segment in stroke for term in self._terms(segment))

    def _terms(self, segment: Segment) -> Iterable[float]:
        """Return floats in Pa whose sum is ∫ p dz over a segment."""
        return self._polytropic_terms(segment) if segment.exponent else _straight_terms(segment)

    def _polytropic_terms(self, segment: Segment) -> tuple[float, float]:
        """Return P V ln(V′/V) (e^u − 1)/u with u = (1 − n) ln(V′/V) and P absolute, and what the lift takes off."""
        volume, way = segment.z + self.clearance, segment.next_z - segment.z
        grown = growth(segment.z, segment.next_z, self.clearance, math.copysign(1.0, way))
        u = (1 - segment.exponent) * grown
        mean = math.expm1(u) / u if u else 1.0
        return (segment.p + self.lift) * volume * grown * mean, -self.lift * way


@dataclass(frozen=True, eq=False)
class Processes:
    """The process of a chamber; of many variants the different ones, and which one each has, (v,), not None."""

    each: tuple[Process, ...]
    which: Indices | None = None

    def variants(self, setting: Setting) -> int | None:
        """Return of how many variants they are in this setting; None where all have the same."""
        return count_of(setting.mechanism) if self.which is None else len(self.which)

    def _spread(self, values: list[float]) -> Any:
        return values[0] if self.which is None or len(set(values)) == 1 else np.array(values)[self.which]

    @property
    def lift(self) -> Any:
        """What makes the pressures absolute, in Pa: a number, or of every variant, (v,)."""
        return self._spread([one.lift for one in self.each])

    @property
    def clearance(self) -> Any:
        """Smallest volume over the stroke volume: a number, or of every variant, (v,)."""
        return self._spread([one.clearance for one in self.each])

    @property
    def area(self) -> Any:
        """∮ p dz in Pa: a number, or of every variant, (v,)."""
        return self._spread([one.area for one in self.each])

    def segments(self, count: int | None) -> tuple[Indices, Indices, Segment]:
        """Return whose each segment is, of which stroke, and the segments, (n,), in the order of the process."""
        rows = [
            [(number, *segment) for number, stroke in enumerate(process.strokes) for segment in stroke]
            for process in self.each
        ]
        lengths = np.array([len(one) for one in rows])
        which = np.zeros(count or 1, dtype=np.intp) if self.which is None else self.which
        begun = (np.cumsum(lengths) - lengths)[which]
        whose = np.repeat(np.arange(len(which)), lengths[which])
        ends = np.cumsum(lengths[which])
        place = np.arange(len(whose)) + np.repeat(begun - ends + lengths[which], lengths[which])
        stroke, *columns = np.array([row for one in rows for row in one])[place].T
        return whose, stroke.astype(np.intp), Segment(*columns)


def polytropic_exponent(z: float, p: float, next_z: float, next_p: float, clearance: float) -> float:
    """Return n of p V^n = const through two points: stroke fractions z, absolute pressures p, relative clearance.

    >>> polytropic_exponent(0.0, 8.0, 1.0, 4.0, 1.0)
    1.0
    """
    exponent: float = math.log(p / next_p) / growth(z, next_z, clearance, math.copysign(1.0, next_z - z))
    return exponent


def growth(z: Any, next_z: Any, clearance: Any, sense: Any) -> Any:
    """Return ln(V′/V) between stroke fractions z and z′, floats, arrays or jets; sense: +1 where it grows, else −1.

    Only ln(1 + what is more than the smaller volume) has its digits both for steep lines and for small clearances.

    >>> round(growth(1.0, 0.0, 1.0, -1.0), 9)
    -0.693147181
    """
    smaller = where(sense < 0, next_z, z) + clearance
    return sense * log1p(sense * (next_z - z) / smaller)


def _straight_terms(segment: Segment) -> Iterable[float]:
    """Yield floats whose exact sum is (p + p′)(z′ − z)/2, so that nearly cancelling cards lose nothing."""
    for p in (segment.p / 2, segment.next_p / 2):
        yield from _exact_product(p, segment.next_z)
        yield from (-part for part in _exact_product(p, segment.z))


def _exact_product(a: float, b: float) -> tuple[float, float]:
    """Return a·b as two floats, whose sum is the exact product (Dekker)."""
    product = a * b
    a_high, b_high = (x * 134217729.0 - (x * 134217729.0 - x) for x in (a, b))
    a_low, b_low = a - a_high, b - b_high
    return product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low
