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
        degrees = self.degrees.tolist()
        if count is None:
            return tuple(degrees)
        ends = np.searchsorted(self.machine, np.arange(count + 1)).tolist()
        return tuple(tuple(degrees[low:high]) for low, high in pairwise(ends))


NOWHERE = Angles(np.zeros(0, dtype=np.intp), np.zeros(0))


class SampledExtremes(NamedTuple):
    """Largest and smallest values of quantities, and the first angles in degrees that have them; each (q, machines)."""

    largest: Array
    largest_at: Array
    smallest: Array
    smallest_at: Array

    def each(self, result: Callable[[Array], Any]) -> list[Extremes]:
        """Return those of every quantity; result: gives numbers (machines,) the form in which they are shown."""
        highest = map(Extreme, map(result, self.largest), map(result, self.largest_at))
        lowest = map(Extreme, map(result, self.smallest), map(result, self.smallest_at))
        return list(map(Extremes, highest, lowest))


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
        # the breaks of every machine and all multiples of 45°, in order
        eighths = np.arange(0.0, cycle + 1, 45.0)
        machine = np.append(np.repeat(np.arange(count), len(eighths)), breaks.machine)
        degrees = np.append(np.tile(eighths, count), np.mod(breaks.degrees, cycle))
        is_between_right_angles = np.tile(eighths % 90 == 45, count)
        is_spare = np.append(is_between_right_angles, np.zeros(len(breaks.degrees), dtype=bool))
        order = np.lexsort((degrees, machine))
        machine = machine[order]
        degrees = degrees[order]
        is_spare = is_spare[order]

        # between the right angles a cut stays only where a piece would be too wide
        is_spare[1:-1] &= degrees[2:] - degrees[:-2] <= 45.0
        machine = machine[~is_spare]
        degrees = degrees[~is_spare]

        # from angle to angle; a piece without width is dropped
        widths = np.append(np.diff(degrees), 0.0)
        starts = np.flatnonzero(widths > _NO_WIDTH)
        low = degrees[starts]
        half = widths[starts] / 2
        right_angle = 90.0 * np.rint((low + half) / 90.0)
        offset = low - right_angle
        return cls(right_angle, offset, half, machine[starts], count, cycle, rule(nodes))

    def split(self, cuts: Angles) -> Pieces:
        """Return these pieces cut at more angles."""
        if not len(cuts.degrees):
            return self
        machine = np.append(self.machine, cuts.machine)
        degrees = np.append(self.low, cuts.degrees)
        return Pieces.between(
            Angles(machine, degrees), self.count, self.cycle, len(self.rule.nodes)
        )

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
        pieces = self.taken(rows)
        return pieces.parted(np.full(len(pieces.half), 2))

    def by_crank(self, lag: Number) -> Pieces:
        """Return these pieces by the angles of a crank that lags by so many degrees, a number or (machines,)."""
        piece_lag = self.of(lag)
        right_angle = 90.0 * np.rint((self.middle - piece_lag) / 90.0)
        # differences of right angles are exact
        shift = self.right_angle - right_angle - piece_lag
        return replace(self, right_angle=right_angle, offset=shift + self.offset)

    def parted(self, counts: Indices) -> Pieces:
        """Return every piece cut into so many equal parts, (pieces,), in order."""
        piece = np.repeat(np.arange(len(counts)), counts)
        first_part = np.repeat(np.cumsum(counts) - counts, counts)
        number = np.arange(len(piece)) - first_part
        parts = self.taken(piece)
        offset = parts.offset + 2 * parts.half * number / counts[piece]
        return replace(parts, offset=offset, half=parts.half / counts[piece])

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
        end = self.low + 2 * self.half
        is_last = self.after == self.first[self.machine]
        next_low = np.where(is_last, self.cycle, self.low[self.after])
        meets_next = np.abs(next_low - end) < _SAME
        return np.where(meets_next, next_low, end)

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
        # the cycles of the machines one behind the other, with a gap between them
        stride = 2 * self.cycle
        starts = self.machine * stride + self.low
        angles = machine * stride + np.mod(degrees, self.cycle)
        piece = np.searchsorted(starts, angles, side="right") - 1
        return np.maximum(piece, self.first[machine])

    def kept_of(self, others: Pieces) -> tuple[Indices, Indices]:
        """Return which of other pieces are among these as they are, and which of these are new."""
        piece = others.holding(self.machine, self.middle)
        is_same = (others.offset[piece] == self.offset) & (others.half[piece] == self.half)
        is_same &= others.right_angle[piece] == self.right_angle
        return piece[is_same], np.flatnonzero(~is_same)

    # integrals, zeros and extremes of samples (nodes, pieces)

    def largest(self, values: Array) -> Array:
        """Return the largest magnitude (…, machines) of samples (…, nodes, pieces)."""
        magnitudes = np.maximum(values.max(axis=-2), -values.min(axis=-2))
        return np.maximum.reduceat(magnitudes, self.first, axis=-1)

    def integral(self, values: Array) -> Array:
        """Return ∫ value dφ (φ in radians) over the cycle, (…, machines)."""
        areas = np.radians(self.half) * (self.rule.weights @ values)
        return np.add.reduceat(areas, self.first, axis=-1)

    def mean(self, values: Array) -> Array:
        """Return the means over the cycle, (…, machines)."""
        return self.integral(values) / np.radians(self.cycle)

    def running(self, values: Array) -> Array:
        """Return ∫ value dφ (φ in radians) from the angle 0 to every node, (nodes, pieces)."""
        # from the start of each piece
        inside = (self.rule.area @ values) * np.radians(self.half)
        # before each piece: the sum over all machines, with what its rounding loses
        after = np.cumsum(inside[-1])
        before = np.append(0.0, after[:-1])
        before[1:] += np.cumsum(lost(before, inside[-1], after))[:-1]
        # less that of the machines before
        return inside + (before - before[self.first][self.machine])

    def resampled(self, values: Array, source: Pieces, lag: Number = 0.0) -> Array:
        """Return samples (…, nodes, pieces) of other pieces, within which these lie, at the nodes of these.

        lag: degrees by which the other pieces lag these, a number or (machines,).
        """
        if source is self and not np.any(lag):
            return values
        # the piece of the source that holds each of these, and how far from its beginning this begins
        piece_lag = self.of(lag)
        piece = source.holding(self.machine, self.middle - piece_lag)
        source_half = source.half[piece]
        # differences of right angles are exact
        shift = self.right_angle - source.right_angle[piece] - piece_lag
        from_low = shift + (self.offset - source.offset[piece])
        turns = np.rint((from_low + self.half - source_half) / source.cycle)
        from_low = from_low - source.cycle * turns

        # a piece that the source has as it is keeps its samples
        samples = np.empty((*values.shape[:-2], *self.degrees.shape))
        is_same = (np.abs(from_low) < _NO_WIDTH) & (np.abs(self.half - source_half) < _NO_WIDTH)
        is_same &= self.rule is source.rule
        if is_same.any():
            samples[..., is_same] = values[..., piece[is_same]]

        # on the others the polynomials of the source are summed
        others = np.flatnonzero(~is_same)
        for chunk in np.split(others, range(_AT_ONCE, len(others), _AT_ONCE)):
            series = source.rule.series @ values[..., piece[chunk]]
            coefficients = np.moveaxis(series, -2, 0)[..., None, :]
            node_from_low = from_low[chunk] + self.half[chunk] * (1 + self.rule.nodes[:, None])
            positions = np.clip(node_from_low / source_half[chunk] - 1, -1, 1)
            positions = np.broadcast_to(positions, (*values.shape[:-2], *positions.shape))
            samples[..., chunk] = series_at(coefficients, positions)
        return samples

    def at(
        self, values: Array, machine: Indices, degrees: Array, within: Array | None = None
    ) -> Array:
        """Return values (n,) at angles (n,) in degrees of these machines.

        At a jump the value on the side that holds `within` (n,) is meant, just after it where that is not given.
        """
        # the piece on the side that is meant
        side = 0.0 if within is None else np.clip(within - degrees, -_SAME, _SAME)
        piece = self.holding(machine, degrees + side)
        half = self.half[piece]
        # where on it the angle is, from −1 to 1
        from_low = degrees - self.right_angle[piece] - self.offset[piece]
        from_low = from_low - self.cycle * np.rint((from_low - half) / self.cycle)
        positions = np.clip(from_low / half - 1, -1, 1)
        series = (self.rule.series @ values)[:, piece]
        return series_at(series, positions)

    def zeros(self, values: Array, size: Array | None = None) -> Angles:
        """Return where values (nodes, pieces) change sign, by a jump as well, within [0, cycle).

        size: (machines,), of the terms whose sum the values are; zero is judged relative to it.
        """
        # crossings inside the pieces, and jumps from the end of a piece to the start of the next
        size = self.largest(values) if size is None else size
        tiny = -ROUNDING * size[self.machine]
        piece, positions = _crossings(values, self.rule, tiny)
        is_jump = (values[-1] < tiny) != (values[0, self.after] < tiny)
        jumps = np.flatnonzero(is_jump)
        # all of them by machine and angle
        machine = np.append(self.machine[piece], self.machine[jumps])
        degrees = np.append(self._degrees_at(piece, positions), self.high[jumps])
        degrees = np.mod(degrees, self.cycle)
        if not len(degrees):
            return NOWHERE
        order = np.lexsort((degrees, machine))
        machine = machine[order]
        degrees = degrees[order]
        # near a break rounding may cross several times: an odd number of crossings is one, an even number none
        begins_group = np.append(True, (np.diff(degrees) > _SAME) | (np.diff(machine) > 0))
        group = np.cumsum(begins_group) - 1
        is_odd = np.bincount(group) % 2 == 1
        return Angles(machine[begins_group][is_odd], degrees[begins_group][is_odd])

    def extremes(self, values: Samples, size: Array | None = None) -> SampledExtremes:
        """Return largest and smallest values of quantities, each (nodes, pieces), of equal ones the first.

        size: (q, machines), of the terms whose sums the quantities are; a value that is rounding relative to it is 0.
        """
        ranges = _ranges(values)
        magnitudes = np.maximum(ranges[1], -ranges[0])
        largest = np.maximum.reduceat(magnitudes, self.first, axis=-1)
        size = largest if size is None else np.maximum(size, largest)
        (high, high_at), (low, low_at) = self.highest(values, ranges, size, (1.0, -1.0))
        # relative to values of the other sign: a zero at a dead centre whose angle is no float, for example
        high = np.where(np.abs(high) > ROUNDING * size, high, 0.0)
        low = np.where(np.abs(low) > ROUNDING * size, low, 0.0)
        # the smallest is the largest of the other sign; − 0 becomes 0
        return SampledExtremes(high + 0.0, high_at, 0.0 - low, low_at)

    def highest(
        self, values: Samples, ranges: Array, size: Array, signs: Sequence[float] = (1.0,)
    ) -> list[tuple[Array, Array]]:
        """Return for each sign the largest values times it, and the angles of the first summits there, (q, machines).

        values: each (nodes, pieces); ranges: see `_ranges`; size: (q, machines), of the terms whose sums they are.
        """
        # the largest samples of each sign, and what counts as equal to them
        slack = _REPEATED * size
        tops = [sign * ranges[int(sign > 0)] for sign in signs]
        best = [np.maximum.reduceat(top, self.first, axis=-1) for top in tops]
        bounds = [largest - slack for largest in best]

        # pieces that may reach these: a polynomial exceeds its samples by less than they differ
        over = ranges[1] - ranges[0]
        may_reach = [top + over >= bound[:, self.machine] for top, bound in zip(tops, bounds)]
        quantity, piece = _where(np.logical_or.reduce(may_reach))
        machine = self.machine[piece]
        samples = np.concatenate(
            [value[:, piece[quantity == q]] for q, value in enumerate(values)], axis=1
        )
        # by less, too, than a sample differs from the next
        steps = np.abs(np.diff(samples, axis=0)).max(axis=0)
        may_reach = [
            top[quantity, piece] + steps >= bound[quantity, machine]
            for top, bound in zip(tops, bounds)
        ]
        near = np.flatnonzero(np.logical_or.reduce(may_reach))
        quantity = quantity[near]
        piece = piece[near]
        machine = machine[near]
        samples = samples[:, near]

        # summits inside them; where all samples are equal but for rounding, it alone turns
        straight = _STRAIGHT * size[quantity, machine]
        bent = np.flatnonzero(over[quantity, piece] > straight)
        column, positions, summits = _turning_points(samples[:, bent], self.rule)
        inside = np.abs(positions) < _INSIDE
        column = bent[column[inside]]
        positions = positions[inside]
        summits = summits[inside]
        # by the rounding of a straight line nothing exceeds its ends
        low, high = ranges[:, quantity[column], piece[column]]
        is_low_summit = summits < low - straight[column]
        is_high_summit = summits > high + straight[column]
        is_summit = is_low_summit | is_high_summit
        summits = np.where(is_summit, summits, np.clip(summits, low, high))

        # the first of the largest values among both ends and the summits
        value = np.concatenate((samples[0], samples[-1], summits))
        summit_degrees = self._degrees_at(piece[column], positions)
        degrees = np.concatenate((self.low[piece], self.high[piece], summit_degrees))
        cell = quantity * self.count + machine
        cell = np.concatenate((cell, cell, cell[column]))
        return [
            _first_summits(cell, degrees, sign * value, largest, slack)
            for sign, largest in zip(signs, best)
        ]

    def _degrees_at(self, piece: Indices, positions: Array) -> Array:
        """Return the angles in degrees at positions in [−1, 1] of these pieces."""
        from_right_angle = self.offset[piece] + self.half[piece] * (1 + positions)
        return self.right_angle[piece] + from_right_angle

    def ranges(self, values: Array) -> tuple[Array, Array]:
        """Return smallest and largest value (pieces,) of samples inside each piece."""
        piece, _, summits = _turning_points(values, self.rule)
        low = np.minimum(values[0], values[-1])
        high = np.maximum(values[0], values[-1])
        np.minimum.at(low, piece, summits)
        np.maximum.at(high, piece, summits)
        return low, high


def common(parts: Sequence[tuple[Pieces, Number]], cycle: float) -> Pieces:
    """Return the pieces of a cycle in degrees, one or several times those of the parts, that lie within all of theirs.

    parts: each with the degrees, a number or (machines,), by which its angle lags that of the common pieces.
    """
    first, first_lag = parts[0]
    if len(parts) == 1 and first.cycle == cycle and not np.any(first_lag):
        return first
    # the angles at which the pieces of any part begin, in every turn of the cycle
    machine: list[Indices] = []
    degrees: list[Array] = []
    for pieces, lag in parts:
        starts = np.mod(pieces.low + pieces.of(lag), pieces.cycle)
        for turn in np.arange(0.0, cycle, pieces.cycle):
            machine.append(pieces.machine)
            degrees.append(starts + turn)
    breaks = Angles(np.concatenate(machine), np.concatenate(degrees))
    nodes = max(len(pieces.rule.nodes) for pieces, _ in parts)
    return Pieces.between(breaks, first.count, cycle, nodes)


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
    zeros = [pieces.zeros(kink, kink_size) for kink, kink_size in zip(kinks, size)]
    machine = np.concatenate([angles.machine for angles in zeros])
    degrees = np.concatenate([angles.degrees for angles in zeros])
    cut = pieces.split(Angles(machine, degrees))
    return _halved_until_smooth(cut, function, cut.resampled(parts, pieces))


def refined(pieces: Pieces, sample: Sample, judged: int | None = None) -> tuple[Pieces, Samples]:
    """Return pieces halved until the samples are polynomials on them, and the samples there, each (nodes, pieces).

    judged: how many of the samples are, the first ones; the others come along.
    """

    def function(pieces: Pieces, _: Array) -> Samples:
        return sample(pieces)

    no_parts = np.zeros((0, *pieces.degrees.shape))
    fine, values, _ = _halved_until_smooth(pieces, function, no_parts, judged=judged)
    return fine, values


def highest(
    pieces: Pieces, parts: Array, function: Callable[[Pieces, Array], Samples]
) -> tuple[Array, Array]:
    """Return the largest values of functions ≥ 0 of the parts, and the first angles in degrees, each (q, machines).

    parts: (p, nodes, pieces), with polynomials on the pieces. Only pieces that may hold the largest value are halved.
    """
    fine, values, _ = _halved_until_smooth(pieces, function, parts, only_highest=True)
    ranges = _ranges(values)
    size = np.maximum.reduceat(ranges[1], fine.first, axis=-1)
    return fine.highest(values, ranges, size)[0]


def _ranges(values: Samples) -> Array:
    """Return the smallest and the largest samples of quantities on every piece, (2, q, pieces)."""
    smallest = [value.min(axis=0) for value in values]
    largest = [value.max(axis=0) for value in values]
    return np.array([smallest, largest])


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
    todo = pieces
    size = np.zeros(())
    done: list[tuple[Pieces, Indices, Sequence[Array]]] = []
    while True:
        values = function(todo, parts)
        tested = values[:judged]
        low, high = _ranges(tested)

        # the largest magnitude so far in each machine; not all of them still have pieces here
        first = np.flatnonzero(np.diff(todo.machine, prepend=-1))
        magnitudes = np.maximum(high, -low)
        largest = np.zeros((len(tested), pieces.count))
        largest[:, todo.machine[first]] = np.maximum.reduceat(magnitudes, first, axis=-1)
        size = np.maximum(size, largest)

        # a polynomial exceeds its samples by less than they differ
        may_be_highest = np.True_
        if only_highest:
            may_be_highest = ~(2 * high - low < (1 - _REPEATED) * size[:, todo.machine])
            counts = may_be_highest.any(axis=0)
            todo = todo.taken(counts)
            may_be_highest = may_be_highest[:, counts]
            parts = parts[..., counts]
            values = tested = [value[:, counts] for value in values]

        # smooth pieces are done, the others are halved
        coefficients = [todo.rule.tail @ value for value in tested]
        tails = may_be_highest * np.array([np.abs(last).max(axis=0) for last in coefficients])
        is_rough = _find_rough(todo, tails, size, len(done))
        if not (done or is_rough.any()):
            return todo, values, parts
        done.append((todo, np.flatnonzero(~is_rough), [*values, *parts]))
        if not is_rough.any():
            break
        todo = todo.halved(is_rough)
        nodes = len(pieces.rule.nodes)
        halves = pieces.rule.halving @ parts[..., is_rough]
        halves = halves.reshape(len(parts), 2, nodes, len(todo.half) // 2)
        parts = halves.transpose(0, 2, 3, 1).reshape(len(parts), nodes, len(todo.half))
    fine, samples = joined_pieces(done)
    return fine, samples[: len(values)], samples[len(values) :]


def _find_rough(pieces: Pieces, tails: Array, size: Array, halvings: int) -> Flags:
    """Return on which pieces any quantity is no polynomial yet, by the tails (q, pieces) of its coefficients.

    size: (q, machines), the largest magnitudes. A crowd of rough pieces that halving does not thin out is noise.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.nan_to_num(tails / size[:, pieces.machine], nan=0.0, posinf=0.0)
    share = shares.max(axis=0)
    is_rough = (share > TAIL) & (pieces.half > NARROWEST / 2)
    is_crowded = np.bincount(pieces.machine[is_rough], minlength=pieces.count) > _CROWD
    is_above_noise = (share > _NOISE) & (halvings < _OFTEN)
    return is_rough & (is_above_noise | ~is_crowded[pieces.machine])


def joined_pieces(parts: Sequence[tuple[Pieces, Indices, Sequence[Array]]]) -> tuple[Pieces, Array]:
    """Return pieces that together fill the cycles as one row, in order, and samples of quantities (q, …, pieces) there.

    parts: pieces, which of them are taken, and the samples of each quantity on all of them.
    """
    # the pieces that are taken, in order
    taken = [pieces.taken(rows) for pieces, rows, _ in parts]
    right_angle = np.concatenate([pieces.right_angle for pieces in taken])
    offset = np.concatenate([pieces.offset for pieces in taken])
    half = np.concatenate([pieces.half for pieces in taken])
    machine = np.concatenate([pieces.machine for pieces in taken])
    joined = replace(taken[0], right_angle=right_angle, offset=offset, half=half, machine=machine)
    order = np.lexsort((offset, right_angle, machine))

    # their columns among the samples of all parts, one part behind the other
    columns = []
    passed = 0
    for pieces, rows, _ in parts:
        columns.append(rows + passed)
        passed += len(pieces.half)
    column = np.concatenate(columns)[order]
    part_values = [values for _, _, values in parts]
    first_value = part_values[0][0]
    samples = np.empty((len(part_values[0]), *first_value.shape[:-1], len(order)))
    for quantity, values in zip(samples, zip(*part_values)):
        all_values = np.concatenate(values, axis=-1)
        np.take(all_values, column, axis=-1, out=quantity, mode="clip")  # without a buffer
    return joined.taken(order), samples


def _first_summits(
    cell: Indices, degrees: Array, value: Array, best: Array, slack: Array
) -> tuple[Array, Array]:
    """Return the largest values (q, machines) and the angles of the first summits that reach them but for the slack.

    best: the largest samples; value: of more angles (n,), each of a quantity and machine by its number in `best`.
    """
    # the first angle that reaches the largest value
    largest = best.ravel()
    slack = slack.ravel()
    np.maximum.at(largest, cell, value)
    is_equal = value >= (largest - slack)[cell]
    cell = cell[is_equal]
    degrees = degrees[is_equal]
    value = value[is_equal]
    first = np.full(largest.shape, np.inf)
    np.minimum.at(first, cell, degrees)

    # what is near it belongs to the same summit
    is_near = degrees <= first[cell] + _SUMMIT
    cell = cell[is_near]
    degrees = degrees[is_near]
    value = value[is_near]
    level = np.full(largest.shape, -np.inf)
    np.maximum.at(level, cell, value)

    # of a plateau the beginning
    is_top = value >= (level - slack / 100)[cell]
    summit = np.full(largest.shape, np.inf)
    np.minimum.at(summit, cell[is_top], degrees[is_top])
    return largest.reshape(best.shape), summit.reshape(best.shape)


def _turning_points(values: Array, of: LobattoRule) -> tuple[Indices, Array, Array]:
    """Return columns, positions in [−1, 1] and values where polynomials through samples (nodes, n) are level."""
    slopes = of.scan_slope @ values
    interval, column = _where((slopes[1:] < 0) != (slopes[:-1] < 0))
    low = of.scan_positions[interval]
    high = of.scan_positions[interval + 1]
    low_slope = slopes[interval, column]
    high_slope = slopes[interval + 1, column]
    series = of.series @ values[:, column]
    positions = _roots(of.slope @ series, low, high, low_slope, high_slope)
    return column, positions, series_at(series, positions)


def _crossings(values: Array, of: LobattoRule, tiny: Array) -> tuple[Indices, Array]:
    """Return columns and positions in [−1, 1] where polynomials through samples (nodes, n) pass tiny (n,), nearly zero."""
    # a polynomial exceeds its samples by less than they differ
    bottoms = values.min(axis=0)
    tops = values.max(axis=0)
    may_cross = (2 * bottoms - tops <= -tiny) & (2 * tops - bottoms >= tiny)
    candidates = np.flatnonzero(may_cross)
    values = values[:, candidates]
    tiny = tiny[candidates]

    # a change of sign between neighbours of a finer scan
    fine = of.scan @ values
    is_below = fine < tiny
    interval, column = _where(is_below[1:] != is_below[:-1])
    low = of.scan_positions[interval]
    high = of.scan_positions[interval + 1]
    first = fine[interval, column]
    last = fine[interval + 1, column]

    # between neighbours of the same sign a summit may pass zero and come back
    near = np.flatnonzero(np.abs(fine).min(axis=0) < _NEAR * np.ptp(fine, axis=0))
    owner, turns, summits = _turning_points(values[:, near], of)
    owner = near[owner]
    before = np.searchsorted(of.scan_positions, turns, side="right") - 1
    before = np.clip(before, 0, len(of.scan_positions) - 2)
    starts_below = is_below[before, owner]
    ends_below = is_below[before + 1, owner]
    rises_through = starts_below & ends_below & (summits > -tiny[owner])
    falls_through = ~starts_below & ~ends_below & (summits < tiny[owner])
    passes = rises_through | falls_through
    owner = owner[passes]
    turns = turns[passes]
    summits = summits[passes]
    before = before[passes]

    # it crosses once on either side of the summit
    column = np.concatenate((column, owner, owner))
    low = np.concatenate((low, of.scan_positions[before], turns))
    high = np.concatenate((high, turns, of.scan_positions[before + 1]))
    first = np.concatenate((first, fine[before, owner], summits))
    last = np.concatenate((last, summits, fine[before + 1, owner]))
    positions = _roots(of.series @ values[:, column], low, high, first, last)
    return candidates[column], positions


def _where(flags: Flags) -> tuple[Indices, Indices]:
    """Return rows and columns of what is true, as `numpy.nonzero`, which takes five times as long."""
    return np.divmod(np.flatnonzero(flags), flags.shape[1])


def _roots(series: Array, low: Array, high: Array, first: Array, last: Array) -> Array:
    """Return the zeros of series (k, n) between low and high (n,), where they are first and last."""
    # of the functions and their slopes, summed together
    coefficients = np.zeros((len(series), 2, len(low)))
    coefficients[:, 0] = series
    coefficients[:-1, 1] = slope_of_series(len(series)) @ series

    def values_and_slopes(positions: Array) -> Array:
        return series_at(coefficients, np.broadcast_to(positions, (2, len(positions))))

    return bracketed_roots(values_and_slopes, low, high, first, last, _SETTLED)
