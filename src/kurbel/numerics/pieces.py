"""The cycles of many machines cut into smooth pieces, and the means, zeros and extremes of samples on them.

Every quantity is sampled once at the Lobatto nodes of the pieces, (nodes, pieces). Means, integrals, crossings,
extremes and samples on finer pieces follow from these samples by constant matrices. A piece on which the samples are no
polynomial yet, by the tail of its Chebyshev coefficients, is halved, so that poles need not be known. Kinks and jumps
should be ends of pieces from the start: halving only closes in on them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple, Union

import numpy as np

from kurbel.arrays import Array, Flags, Indices, Number
from kurbel.numerics.arithmetic import lost, spread
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.numerics.lobatto import LobattoRule, rule, series_at, slope_of_series
from kurbel.numerics.search import bracketed_roots

ROUNDING = 1e-14
"""Relative to the largest value of a quantity: a smaller value counts as zero."""
TAIL = 1e-13
"""Relative to the largest value: a piece whose last two Chebyshev coefficients are larger is halved."""
NARROWEST = 1e-5
"""Degrees: so narrow a piece is not halved further; only the rounding of angles makes it rough."""
_STRAIGHT = 1e-15
"""Relative to the largest value: by less a polynomial exceeds its samples only through rounding."""
_REPEATED = 1e-12
"""Relative to the largest value: summits that differ by less are equal, as those of equal cylinders."""
_SUMMIT = 0.5
"""Degrees after the first angle that reaches the largest value: equal values there belong to the same summit."""
_CROWD = 100
"""More rough pieces than this in one machine are a sign of noise: a pole or a kink leaves two to four."""
_OFTEN = 6
"""Halvings after which so many rough pieces are left only by noise."""
_NOISE = 1e-8
"""Relative to the largest value: among so many rough pieces, smaller tails are noise and are not refined."""
_SAME = 1e-9
"""Degrees: crossings closer together are one crossing, repeated by rounding."""
_NEAR = 0.05
"""Of the range of samples on a piece: if they come closer to zero, a summit between them may cross it."""
_INSIDE = 1 - 1e-10
"""Of half a piece: a summit beyond this is the end of the piece."""
_SETTLED = 1e-10
"""Of half a piece: after so short a step to a root the next would be its square."""
_NO_WIDTH = 1e-11
"""Degrees: a narrower piece is dropped."""

_AT_ONCE = 512
"""Pieces whose polynomials are summed together: what fits into the cache."""

Samples = Union[Array, Sequence[Array]]
Sample = Callable[["Pieces"], Samples]
"""Gives quantities at the nodes of pieces, each (nodes, pieces)."""


class Angles(NamedTuple):
    """Angles in degrees (n,), each of a machine (n,), in order."""

    machine: Indices
    degrees: Array

    def listed(self, count: int | None) -> tuple[object, ...]:
        """Return them as a tuple; of many machines one tuple each."""
        if count is None:
            return tuple(self.degrees.tolist())
        known, ends = (
            self.degrees.tolist(),
            np.searchsorted(self.machine, np.arange(count + 1)).tolist(),
        )
        return tuple(tuple(known[low:high]) for low, high in pairwise(ends))


NOWHERE = Angles(np.zeros(0, dtype=np.intp), np.zeros(0))


class SampledExtremes(NamedTuple):
    """Largest and smallest values of quantities, and the first angles in degrees that have them; each (q, machines)."""

    largest: Array
    largest_at: Array
    smallest: Array
    smallest_at: Array

    def each(self, result: Callable[[Array], Any]) -> list[Extremes]:
        """Return those of every quantity; result: gives numbers (machines,) the form in which they are shown."""
        high, high_at, low, low_at = (map(result, part) for part in self)
        return [
            Extremes(*pair) for pair in zip(map(Extreme, high, high_at), map(Extreme, low, low_at))
        ]


@dataclass(frozen=True, eq=False)
class Pieces:
    """Pieces (n,) of the cycles of `count` machines, ordered by machine and angle.

    right_angle: the multiple of 90° nearest to a piece; offset: from there to its beginning; half: half its width; all
    in degrees, apart, so that no digit is lost near dead centres and at 90°. machine: the machine of each piece. cycle:
    its length in degrees.
    """

    right_angle: Array
    offset: Array
    half: Array
    machine: Indices
    count: int
    cycle: float
    rule: LobattoRule

    @classmethod
    def between(cls, breaks: Angles, count: int, cycle: float, nodes: int = 16) -> Pieces:
        """Return the pieces between these angles, taken modulo the cycle, and all right angles; no wider than 45°."""
        eighths = np.arange(0.0, cycle + 1, 45.0)
        machine = np.append(np.repeat(np.arange(count), len(eighths)), breaks.machine)
        degrees = np.append(np.tile(eighths, count), np.mod(breaks.degrees, cycle))
        between = np.append(
            np.tile(eighths % 90 == 45, count), np.zeros(len(breaks.degrees), dtype=bool)
        )
        order = np.lexsort((degrees, machine))
        machine, degrees, spare = machine[order], degrees[order], between[order]
        # between the right angles only where a piece would be too wide
        spare[1:-1] &= degrees[2:] - degrees[:-2] <= 45.0
        machine, degrees = machine[~spare], degrees[~spare]
        width = np.append(np.diff(degrees), 0.0)
        kept = np.flatnonzero(width > _NO_WIDTH)
        right_angle = 90.0 * np.rint((degrees[kept] + width[kept] / 2) / 90.0)
        return cls(
            right_angle,
            degrees[kept] - right_angle,
            width[kept] / 2,
            machine[kept],
            count,
            cycle,
            rule(nodes),
        )

    def split(self, at: Angles) -> Pieces:
        """Return these pieces cut at more angles."""
        if not len(at.degrees):
            return self
        breaks = Angles(np.append(self.machine, at.machine), np.append(self.low, at.degrees))
        return Pieces.between(breaks, self.count, self.cycle, len(self.rule.nodes))

    def taken(self, rows: Indices | Flags) -> Pieces:
        """Return these of the pieces; they then no longer fill the cycle."""
        return replace(
            self,
            right_angle=self.right_angle[rows],
            offset=self.offset[rows],
            half=self.half[rows],
            machine=self.machine[rows],
        )

    def halved(self, rows: Indices | Flags) -> Pieces:
        """Return the halves of these pieces, in order."""
        some = self.taken(rows)
        return some.parted(np.full(len(some.half), 2))

    def by_crank(self, later: Number) -> Pieces:
        """Return these pieces by the angles of a crank that lags by so many degrees, a number or (machines,)."""
        behind = self.of(later)
        right_angle = 90.0 * np.rint((self.middle - behind) / 90.0)
        # differences of right angles are exact
        return replace(
            self,
            right_angle=right_angle,
            offset=(self.right_angle - right_angle - behind) + self.offset,
        )

    def parted(self, parts: Indices) -> Pieces:
        """Return every piece cut into so many equal parts, (pieces,), in order."""
        row = np.repeat(np.arange(len(parts)), parts)
        number = np.arange(len(row)) - np.repeat(np.cumsum(parts) - parts, parts)
        cut = self.taken(row)
        return replace(
            cut, offset=cut.offset + 2 * cut.half * number / parts[row], half=cut.half / parts[row]
        )

    # positions

    @cached_property
    def low(self) -> Array:
        """The angles in degrees at which they begin."""
        return self.right_angle + self.offset

    @cached_property
    def middle(self) -> Array:
        """Their middles in degrees: they decide on which side of a jump a piece is."""
        return self.right_angle + (self.offset + self.half)

    @property
    def offsets(self) -> Array:
        """How far the nodes are from the right angles in degrees, (nodes, pieces)."""
        return self.offset + self.half * (1 + self.rule.nodes[:, None])

    @cached_property
    def degrees(self) -> Array:
        """The angles of the nodes, (nodes, pieces)."""
        return self.right_angle + self.offsets

    @cached_property
    def first(self) -> Indices:
        """The first piece of every machine."""
        return np.searchsorted(self.machine, np.arange(self.count))

    @cached_property
    def after(self) -> Indices:
        """The piece that follows each, the first after the last of a machine."""
        following = np.arange(1, len(self.half) + 1)
        following[np.append(self.first[1:], len(self.half)) - 1] = self.first
        return following

    @cached_property
    def high(self) -> Array:
        """The angles in degrees at which they end, the last of a machine with the cycle."""
        own, following = self.low + 2 * self.half, self.low[self.after]
        following = np.where(self.after == self.first[self.machine], self.cycle, following)
        return np.where(np.abs(following - own) < _SAME, following, own)

    @property
    def ends(self) -> Array:
        """The angles in degrees at which those of the only machine begin, and the end of the cycle."""
        return np.append(self.low, self.cycle)

    def of(self, numbers: Any) -> Any:
        """Return numbers (machines,) for each piece, (pieces,); a single number is returned as it is."""
        return spread(numbers, self.machine)

    def filled(self, values: Any) -> Array:
        """Return a value, or one of every piece (pieces,), at every node, (nodes, pieces)."""
        return np.broadcast_to(values, self.degrees.shape)

    def holding(self, machine: Indices, degrees: Array) -> Indices:
        """Return the pieces (n,) that hold angles (n,) in degrees of these machines, or begin there."""
        keys = self.machine * (2 * self.cycle) + self.low
        found = (
            np.searchsorted(
                keys, machine * (2 * self.cycle) + np.mod(degrees, self.cycle), side="right"
            )
            - 1
        )
        return np.maximum(found, self.first[machine])

    def kept_of(self, others: Pieces) -> tuple[Indices, Indices]:
        """Return which of other pieces are among these as they are, and which of these are new."""
        row = others.holding(self.machine, self.middle)
        same = (others.offset[row] == self.offset) & (others.half[row] == self.half)
        same &= others.right_angle[row] == self.right_angle
        return row[same], np.flatnonzero(~same)

    # integrals, zeros and extremes of samples (nodes, pieces)

    def largest(self, values: Array) -> Array:
        """Return the largest magnitude (…, machines) of samples (…, nodes, pieces)."""
        return np.maximum.reduceat(
            np.maximum(values.max(axis=-2), -values.min(axis=-2)), self.first, axis=-1
        )

    def integral(self, values: Array) -> Array:
        """Return ∫ value dφ (φ in radians) over the cycle, (…, machines)."""
        return np.add.reduceat(
            np.radians(self.half) * (self.rule.weights @ values), self.first, axis=-1
        )

    def mean(self, values: Array) -> Array:
        """Return the means over the cycle, (…, machines)."""
        return self.integral(values) / np.radians(self.cycle)

    def running(self, values: Array) -> Array:
        """Return ∫ value dφ (φ in radians) from the angle 0 to every node, (nodes, pieces)."""
        inside = (self.rule.area @ values) * np.radians(self.half)
        after = np.cumsum(inside[-1])
        before = np.append(0.0, after[:-1])
        before[1:] += np.cumsum(lost(before, inside[-1], after))[:-1]
        return inside + (before - before[self.first][self.machine])

    def carried(self, values: Array, source: Pieces, later: Number = 0.0) -> Array:
        """Return samples (…, nodes, pieces) of other pieces, within which these lie, at the nodes of these.

        later: degrees by which the other pieces lag these, a number or (machines,).
        """
        if source is self and not np.any(later):
            return values
        behind = self.of(later)
        row = source.holding(self.machine, self.middle - behind)
        # differences of right angles are exact
        from_low = (self.right_angle - source.right_angle[row] - behind) + (
            self.offset - source.offset[row]
        )
        from_low = from_low - source.cycle * np.rint(
            (from_low + self.half - source.half[row]) / source.cycle
        )
        width = source.half[row]
        whole = (
            (np.abs(from_low) < _NO_WIDTH)
            & (np.abs(self.half - width) < _NO_WIDTH)
            & (self.rule is source.rule)
        )
        found = np.empty((*values.shape[:-2], *self.degrees.shape))
        if whole.any():
            found[..., whole] = values[..., row[whole]]
        for part in np.split(
            np.flatnonzero(~whole), range(_AT_ONCE, np.count_nonzero(~whole), _AT_ONCE)
        ):
            series = np.moveaxis(source.rule.series @ values[..., row[part]], -2, 0)[..., None, :]
            places = (from_low[part] + self.half[part] * (1 + self.rule.nodes[:, None])) / width[
                part
            ] - 1
            own = np.broadcast_to(np.clip(places, -1, 1), (*values.shape[:-2], *places.shape))
            found[..., part] = series_at(series, own)
        return found

    def at(
        self, values: Array, machine: Indices, degrees: Array, within: Array | None = None
    ) -> Array:
        """Return values (n,) at angles (n,) in degrees of these machines.

        At a jump the value on the side that holds `within` (n,) is meant, just after it where that is not given.
        """
        side = 0.0 if within is None else np.clip(within - degrees, -_SAME, _SAME)
        row = self.holding(machine, degrees + side)
        from_low = degrees - self.right_angle[row] - self.offset[row]
        from_low = from_low - self.cycle * np.rint((from_low - self.half[row]) / self.cycle)
        return series_at(
            (self.rule.series @ values)[:, row], np.clip(from_low / self.half[row] - 1, -1, 1)
        )

    def zeros(self, values: Array, size: Array | None = None) -> Angles:
        """Return where values (nodes, pieces) change sign, by a jump as well, within [0, cycle).

        size: (machines,), of the terms whose sum the values are; zero is judged relative to it.
        """
        size = (self.largest(values) if size is None else size)[self.machine]
        tiny = -ROUNDING * size
        rows, places = _crossings(values, self.rule, tiny)
        jumps = np.flatnonzero((values[-1] < tiny) != (values[0, self.after] < tiny))
        machine = np.append(self.machine[rows], self.machine[jumps])
        degrees = np.mod(np.append(self._at(rows, places), self.high[jumps]), self.cycle)
        order = np.lexsort((degrees, machine))
        machine, degrees = machine[order], degrees[order]
        # near a break rounding may cross several times: an odd number of crossings is one, an even number none
        begins = np.append(True, (np.diff(degrees) > _SAME) | (np.diff(machine) > 0))[
            : len(degrees)
        ]
        odd = np.bincount(np.cumsum(begins) - 1) % 2 == 1 if len(degrees) else begins
        return Angles(machine[begins][odd], degrees[begins][odd])

    def extremes(self, values: Samples, size: Array | None = None) -> SampledExtremes:
        """Return largest and smallest values of quantities, each (nodes, pieces), of equal ones the first.

        size: (q, machines), of the terms whose sums the quantities are; a value that is rounding relative to it is 0.
        """
        low, high = ranges = _ranges(values)
        largest = np.maximum.reduceat(np.maximum(high, -low), self.first, axis=-1)
        size = largest if size is None else np.maximum(size, largest)
        (high, high_at), (low, low_at) = self.highest(values, ranges, size, (1.0, -1.0))
        # relative to values of the other sign: a zero at a dead centre whose angle is no float, for example
        high, low = (np.where(np.abs(one) > ROUNDING * size, one, 0.0) for one in (high, low))
        return SampledExtremes(high + 0.0, high_at, 0.0 - low, low_at)

    def highest(
        self, values: Samples, ranges: Array, size: Array, signs: Sequence[float] = (1.0,)
    ) -> list[tuple[Array, Array]]:
        """Return for each sign the largest values times it, and the angles of the first summits there, (q, machines).

        values: each (nodes, pieces); ranges: see `_ranges`; size: (q, machines), of the terms whose sums they are.
        """
        slack = _REPEATED * size
        tops = [sign * ranges[int(sign > 0)] for sign in signs]
        best = [np.maximum.reduceat(top, self.first, axis=-1) for top in tops]
        # a polynomial exceeds its samples by less than they differ
        over = ranges[1] - ranges[0]
        may = [top + over >= (one - slack)[:, self.machine] for top, one in zip(tops, best)]
        which, piece = _where(np.logical_or.reduce(may))
        samples = np.concatenate(
            [one[:, piece[which == q]] for q, one in enumerate(values)], axis=1
        )
        # by less, too, than one sample differs from the next
        steps, owner = np.abs(np.diff(samples, axis=0)).max(axis=0), self.machine[piece]
        may = [
            top[which, piece] + steps >= (one - slack)[which, owner] for top, one in zip(tops, best)
        ]
        near = np.flatnonzero(np.logical_or.reduce(may))
        which, piece, samples, owner = which[near], piece[near], samples[:, near], owner[near]
        straight = _STRAIGHT * size[which, owner]
        # where all samples are equal but for rounding, it alone turns
        bent = np.flatnonzero(over[which, piece] > straight)
        rows, places, turning = _turning_points(samples[:, bent], self.rule)
        inside = np.abs(places) < _INSIDE
        rows, places, turning = bent[rows[inside]], places[inside], turning[inside]
        # by the rounding of a straight line nothing exceeds its ends
        low, high = ranges[:, which[rows], piece[rows]]
        beyond = (turning > high + straight[rows]) | (turning < low - straight[rows])
        turning = np.where(beyond, turning, np.clip(turning, low, high))
        value = np.concatenate((samples[0], samples[-1], turning))
        degrees = np.concatenate((self.low[piece], self.high[piece], self._at(piece[rows], places)))
        cell = which * self.count + owner
        cell = np.concatenate((cell, cell, cell[rows]))
        return [
            _first_summits(cell, degrees, sign * value, one, slack)
            for sign, one in zip(signs, best)
        ]

    def _at(self, rows: Indices, places: Array) -> Array:
        """Return the angles in degrees at places in [−1, 1] of these pieces."""
        return self.right_angle[rows] + (self.offset[rows] + self.half[rows] * (1 + places))

    def ranges(self, values: Array) -> tuple[Array, Array]:
        """Return smallest and largest value (pieces,) of samples inside each piece."""
        rows, _, turning = _turning_points(values, self.rule)
        low, high = np.minimum(values[0], values[-1]), np.maximum(values[0], values[-1])
        np.minimum.at(low, rows, turning)
        np.maximum.at(high, rows, turning)
        return low, high


def common(parts: Sequence[tuple[Pieces, Number]], cycle: float) -> Pieces:
    """Return the pieces of a cycle in degrees, one or several times those of the parts, that lie within all of theirs.

    parts: each with the degrees, a number or (machines,), by which its angle lags that of the common pieces.
    """
    first = parts[0][0]
    if len(parts) == 1 and not np.any(parts[0][1]) and first.cycle == cycle:
        return first
    machine: list[Indices] = []
    degrees: list[Array] = []
    for one, later in parts:
        starts = np.mod(one.low + one.of(later), one.cycle)
        degrees += [starts + turn for turn in np.arange(0.0, cycle, one.cycle)]
        machine += [one.machine] * (len(degrees) - len(machine))
    nodes = max(len(one.rule.nodes) for one, _ in parts)
    return Pieces.between(
        Angles(np.concatenate(machine), np.concatenate(degrees)), first.count, cycle, nodes
    )


def resolved(
    pieces: Pieces,
    parts: Array,
    kinks: Array,
    size: Array,
    function: Callable[[Pieces, Array], Samples],
) -> tuple[Pieces, Samples, Array]:
    """Return pieces on which functions with kinks, such as magnitudes of the parts, are polynomials.

    The pieces are cut at the zeros of `kinks`, then halved. Returned with them: the values of the functions (q, nodes,
    pieces) and the parts (p, nodes, pieces) there. parts: polynomials on the given pieces; kinks: (k, nodes, pieces),
    quantities at whose zeros a function bends; size: (k, machines), relative to which a kink counts as zero.
    """
    cuts = [pieces.zeros(one, beside) for one, beside in zip(kinks, size)]
    cut = pieces.split(Angles(*(np.concatenate(columns) for columns in zip(*cuts))))
    return _halved_until_smooth(cut, function, cut.carried(parts, pieces))


def refined(pieces: Pieces, sample: Sample, judged: int | None = None) -> tuple[Pieces, Samples]:
    """Return pieces halved until the samples are polynomials on them, and the samples there, each (nodes, pieces).

    judged: how many of the samples are, the first ones; the others come along.
    """
    nothing = np.zeros((0, *pieces.degrees.shape))
    return _halved_until_smooth(pieces, lambda some, _: sample(some), nothing, judged=judged)[:2]


def highest(
    pieces: Pieces, parts: Array, function: Callable[[Pieces, Array], Samples]
) -> tuple[Array, Array]:
    """Return the largest values of functions ≥ 0 of the parts, and the first angles in degrees, each (q, machines).

    parts: (p, nodes, pieces), with polynomials on the pieces. Only pieces that may hold the largest value are halved.
    """
    fine, values, _ = _halved_until_smooth(pieces, function, parts, only_highest=True)
    ranges = _ranges(values)
    return fine.highest(values, ranges, np.maximum.reduceat(ranges[1], fine.first, axis=-1))[0]


def _ranges(values: Samples) -> Array:
    """Return the smallest and the largest samples of quantities on every piece, (2, q, pieces)."""
    return np.array([[edge(value, axis=0) for value in values] for edge in (np.min, np.max)])


def _halved_until_smooth(
    pieces: Pieces,
    function: Callable[[Pieces, Array], Samples],
    parts: Array,
    only_highest: bool = False,
    judged: int | None = None,
) -> tuple[Pieces, Samples, Array]:
    """Return pieces halved until the functions of parts are polynomials on them, the functions, and the parts there.

    only_highest: where they may have their largest values; the other pieces are left out. judged: see `refined`.
    """
    todo, size = pieces, np.zeros(())
    done: list[tuple[Pieces, Indices, Sequence[Array]]] = []
    while True:
        values = function(todo, parts)
        tested = values[:judged]
        low, high = _ranges(tested)
        top, first = (
            np.zeros((len(tested), pieces.count)),
            np.flatnonzero(np.diff(todo.machine, prepend=-1)),
        )
        top[:, todo.machine[first]] = np.maximum.reduceat(np.maximum(high, -low), first, axis=-1)
        size = np.maximum(size, top)
        may = np.True_
        if only_highest:
            may = ~(2 * high - low < (1 - _REPEATED) * size[:, todo.machine])
            some = may.any(axis=0)
            todo, may, parts = todo.taken(some), may[:, some], parts[..., some]
            values = tested = [value[:, some] for value in values]
        # a crowd of rough pieces that halving does not thin out is noise
        tails = may * np.array([np.abs(todo.rule.series[-2:] @ one).max(axis=0) for one in tested])
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.nan_to_num(tails / size[:, todo.machine], nan=0.0, posinf=0.0).max(axis=0)
        rough = (share > TAIL) & (todo.half > NARROWEST / 2)
        crowd = np.bincount(todo.machine[rough], minlength=todo.count) > _CROWD
        rough &= ((share > _NOISE) & (len(done) < _OFTEN)) | ~crowd[todo.machine]
        if not (done or rough.any()):
            return todo, values, parts
        done.append((todo, np.flatnonzero(~rough), [*values, *parts]))
        if not rough.any():
            break
        nodes, halved = len(pieces.rule.nodes), 2 * np.count_nonzero(rough)
        halves = (pieces.rule.halving @ parts[..., rough]).reshape(
            len(parts), 2, nodes, halved // 2
        )
        parts = halves.transpose(0, 2, 3, 1).reshape(len(parts), nodes, halved)
        todo = todo.halved(rough)
    whole, both = joined_pieces(done)
    return whole, both[: len(values)], both[len(values) :]


def joined_pieces(parts: Sequence[tuple[Pieces, Indices, Sequence[Array]]]) -> tuple[Pieces, Array]:
    """Return pieces that together fill the cycles as one row, in order, and samples of quantities (q, …, pieces) there.

    parts: pieces, which of them are taken, and the samples of each quantity on all of them.
    """
    taken = [pieces.taken(rows) for pieces, rows, _ in parts]
    columns = [(one.right_angle, one.offset, one.half, one.machine) for one in taken]
    right_angle, offset, half, machine = (np.concatenate(column) for column in zip(*columns))
    order = np.lexsort((offset, right_angle, machine))
    whole = replace(
        taken[0], right_angle=right_angle, offset=offset, half=half, machine=machine
    ).taken(order)
    before = np.cumsum([0, *(len(pieces.half) for pieces, _, _ in parts)])
    source = np.concatenate([rows + passed for (_, rows, _), passed in zip(parts, before)])[order]
    values = [part for _, _, part in parts]
    found = np.empty((len(values[0]), *values[0][0].shape[:-1], len(order)))
    for quantity, each in zip(found, zip(*values)):
        np.take(
            np.concatenate(each, axis=-1), source, axis=-1, out=quantity, mode="clip"
        )  # without a buffer
    return whole, found


def _first_summits(
    cell: Indices, degrees: Array, value: Array, best: Array, slack: Array
) -> tuple[Array, Array]:
    """Return the largest values (q, machines) and the angles of the first summits that reach them but for the slack.

    best: the largest samples; value: of more places (n,), each of a quantity and machine by its place in `best`.
    """
    largest, slack = best.ravel(), slack.ravel()
    np.maximum.at(largest, cell, value)
    first, level, found = (np.full(largest.shape, empty) for empty in (np.inf, -np.inf, np.inf))
    reached = value >= (largest - slack)[cell]
    cell, degrees, value = cell[reached], degrees[reached], value[reached]
    np.minimum.at(first, cell, degrees)
    own = degrees <= first[cell] + _SUMMIT
    cell, degrees, value = cell[own], degrees[own], value[own]
    np.maximum.at(level, cell, value)
    top = value >= (level - slack / 100)[cell]  # of a plateau the beginning
    np.minimum.at(found, cell[top], degrees[top])
    return largest.reshape(best.shape), found.reshape(best.shape)


def _turning_points(values: Array, of: LobattoRule) -> tuple[Indices, Array, Array]:
    """Return columns, places in [−1, 1] and values where polynomials through samples (nodes, n) are level."""
    slopes = of.scan_slope @ values
    i, rows = _where((slopes[1:] < 0) != (slopes[:-1] < 0))
    series = of.series @ values[:, rows]
    places = _roots(
        of.slope @ series, of.places[i], of.places[i + 1], slopes[i, rows], slopes[i + 1, rows]
    )
    return rows, places, series_at(series, places)


def _crossings(values: Array, of: LobattoRule, tiny: Array) -> tuple[Indices, Array]:
    """Return columns and places in [−1, 1] where polynomials through samples (nodes, n) pass tiny (n,), nearly zero."""
    # a polynomial exceeds its samples by less than they differ
    bottoms, tops = values.min(axis=0), values.max(axis=0)
    some = np.flatnonzero((2 * bottoms - tops <= -tiny) & (2 * tops - bottoms >= tiny))
    values, tiny = values[:, some], tiny[some]
    fine = of.scan @ values
    below = fine < tiny
    i, rows = _where(below[1:] != below[:-1])
    low, high, first, last = of.places[i], of.places[i + 1], fine[i, rows], fine[i + 1, rows]
    # between two places of one sign a summit may pass zero and come back
    near = np.flatnonzero(np.abs(fine).min(axis=0) < _NEAR * np.ptp(fine, axis=0))
    owner, turns, value = _turning_points(values[:, near], of)
    owner = near[owner]
    before = np.clip(np.searchsorted(of.places, turns, side="right") - 1, 0, len(of.places) - 2)
    there = below[before, owner] & below[before + 1, owner] & (value > -tiny[owner])
    there |= ~below[before, owner] & ~below[before + 1, owner] & (value < tiny[owner])
    owner, turns, value, before = owner[there], turns[there], value[there], before[there]
    rows = np.concatenate((rows, owner, owner))
    low, high = (
        np.concatenate((low, of.places[before], turns)),
        np.concatenate((high, turns, of.places[before + 1])),
    )
    first = np.concatenate((first, fine[before, owner], value))
    last = np.concatenate((last, value, fine[before + 1, owner]))
    return some[rows], _roots(of.series @ values[:, rows], low, high, first, last)


def _where(flags: Flags) -> tuple[Indices, Indices]:
    """Return rows and columns of what is true, as `numpy.nonzero`, which takes five times as long."""
    return np.divmod(np.flatnonzero(flags), flags.shape[1])


def _roots(series: Array, low: Array, high: Array, first: Array, last: Array) -> Array:
    """Return the zeros of series (k, n) between low and high (n,), where they are first and last."""
    both = np.zeros((len(series), 2, len(low)))
    both[:, 0], both[:-1, 1] = series, slope_of_series(len(series)) @ series
    return bracketed_roots(
        lambda at: series_at(both, np.broadcast_to(at, (2, len(at)))),
        low,
        high,
        first,
        last,
        _SETTLED,
    )
