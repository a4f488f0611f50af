"""Where a picture takes its values from: the results of one command, sampled, in the units in which they are shown."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.quantity import Quantity
from kurbel.declared.unit_systems import convert, shown_unit
from kurbel.numerics.extreme import Extreme
from kurbel.report.frame import too_large
from kurbel.report.pictures.picture import Axis, Curve, Figure, Mark, Panel, Piece, Words
from kurbel.report.pictures.sampling import Samples, Values, pieces, sampled

PHI = "phi"
FILE, TERMINAL = 1 / 2000, 1 / 250
"""By what of its height a line of points may miss a curve: less than can be seen on paper, or in a terminal."""


@dataclass(frozen=True, eq=False)
class Wish:
    """How pictures are wanted: in which system of units, how finely (FILE or TERMINAL), of which cylinder alone.

    angles: crank angles in degrees at which a mechanism is drawn, None where it moves.
    """

    system: str = "metric"
    fineness: float = FILE
    cylinder: str | None = None
    angles: Sequence[float] | None = None


class Source:
    """The results of one cylinder or of the whole machine, as pictures need them.

    results: what answers columns (`at`), key values (`answering`) and where it is smooth (`breaks`).
    """

    def __init__(self, results: Any, wish: Wish) -> None:
        self.results, self.wish = results, wish

    @cached_property
    def _declared(self) -> dict[str, Quantity]:
        return {one.id: one for one in self.results.lists.all_columns}

    def quantity(self, id: str) -> Quantity:
        """Return the declaration of a column."""
        return self._declared[id]

    @cached_property
    def _at_zero(self) -> Any:
        return self.results.at(np.zeros(1), np.full(1, 1e-3))

    def having(self, ids: Iterable[str]) -> tuple[str, ...]:
        """Return those of these columns that there are."""
        return tuple(id for id in ids if id in self._declared and self._at_zero[id] is not None)

    def values(self, ids: Sequence[str], degrees: Array, within: Array) -> Array:
        """Return columns (k, n) in SI at crank angles (n,); φ is one of them."""
        state = self.results.at(degrees, within)
        found = [degrees if id == PHI else np.broadcast_to(state[id], degrees.shape) for id in ids]
        return np.stack([np.asarray(one, dtype=float) for one in found])

    def samples(self, ids: Sequence[str], also: Iterable[float] = ()) -> Samples:
        """Return columns (k, n) in SI over the cycle, at the crank angles `also` too. Raises UsageError, see below."""
        breaks = self.results.breaks
        # not numpy.isin, which loads numpy.ma, a fifth of the whole start-up
        cut = np.array(sorted({*breaks.tolist(), *(angle for angle in also if 0 < angle < breaks[-1])}))
        return self.sampled(ids, lambda degrees, within: self.values(ids, degrees, within), cut)

    def sampled(self, ids: Sequence[str], values: Values, breaks: Array | None = None) -> Samples:
        """Return what goes by these ids, sampled between the breaks, those of the results if none are given.

        Raises UsageError where one has left the range of floats.
        """
        found = sampled(self.results.breaks if breaks is None else breaks, values, self.wish.fineness)
        for id, line in zip(ids, found.values):
            if not np.isfinite(line).all():
                raise too_large(self.quantity(id))
        return found

    def words(self, id: str) -> Words:
        """Return how a column is called."""
        return words(self.quantity(id))

    def unit(self, kind: str, *values: Any) -> str:
        """Return the unit in which values in SI of one kind are shown together."""
        return shown_unit(kind, self.wish.system, max((float(np.max(np.abs(one))) for one in values), default=0.0))

    def extremes(self, id: str) -> list[tuple[Quantity, Extreme]]:
        """Return the key values that are the largest and the smallest value of a column, as far as there are any."""
        known = self.results.lists.key_values(self.results.command)
        found = [
            (known[name], self.results.rows.key_values[name].of(self.results))
            for name in (f"{id}_max", f"{id}_min")
            if name in known
        ]
        turns = [(quantity, value) for quantity, value in found if isinstance(value, Extreme)]
        return turns if len({value.value for _, value in turns}) == len(turns) else []  # of a level line there are none

    def panel(self, ids: Sequence[str], over: str = PHI) -> Panel:
        """Return a panel of columns of one kind over another column, with their extremes marked."""
        samples = self.samples((over, *ids))
        kind = self.quantity(ids[0]).kind
        unit, run = self.unit(kind, *samples.values[1:]), self.axis(over, samples.values[0])
        x = convert(samples.values[0], self.quantity(over).kind, run.unit)
        curves = tuple(
            Curve(self.words(id), pieces(samples, x, convert(line, kind, unit)))
            for id, line in zip(ids, samples.values[1:])
        )
        marks = tuple(mark for id in ids for mark in self.marks(id, unit, over, run.unit))
        name = Words(*(", ".join(symbols) for symbols in zip(*map(self.words, ids))))
        title = "" if samples.values[1:].any() else "0 at every angle"
        return Panel(run, Axis(name, unit), curves, marks=marks, title=title)

    def axis(self, id: str, values: Array) -> Axis:
        """Return the axis for values of a column in SI."""
        return Axis(self.words(id), "deg" if id == PHI else self.unit(self.quantity(id).kind, values))

    def marks(self, id: str, unit: str, over: str = PHI, over_unit: str = "deg") -> Iterable[Mark]:
        """Yield the extremes of a column as marks at their exact place."""
        for quantity, extreme in self.extremes(id):
            at = np.array([extreme.degrees])
            (place,) = self.values((over,), at, at)
            yield mark(quantity, extreme, unit, float(convert(place[0], self.quantity(over).kind, over_unit)))


def mark(quantity: Quantity, extreme: Extreme, unit: str, x: float, y: float | None = None) -> Mark:
    """Return an extreme at a place in the units of the axes; y: its value, where none is given."""
    value = float(convert(extreme.value, quantity.kind, unit))
    return Mark(x, value if y is None else y, Figure(words(quantity), value, quantity.marked(unit), extreme.degrees))


def words(quantity: Quantity) -> Words:
    """Return how a quantity is called in a picture."""
    return Words(quantity.symbol, quantity.ascii_symbol)


def level(curves: Sequence[Curve], height: float = 0.0, name: Words = Words("")) -> Curve:  # noqa: B008 (immutable)
    """Return a faint level line, y = 0 if no other height is given, as far as the curves reach."""
    every = [piece.x for curve in curves for piece in curve.pieces if len(piece.x)]
    ends = min((x.min() for x in every), default=0.0), max((x.max() for x in every), default=0.0)
    return Curve(name, (Piece(np.array(ends, dtype=float), np.array([height, height])),), kind="faint")
