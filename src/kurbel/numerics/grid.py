"""A cycle cut into smooth pieces: nodes for searches and integrals, each on its side of every jump."""

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices
from kurbel.numerics.gauss import GAUSS, LOBATTO_4, LOBATTO_16, Rule

_MANY = 300  # jumps; where there are fewer, sixteen points a piece cost nothing
_WIDEST = 36.0  # degrees of a smooth piece
_PARTS = 23  # of a smooth piece, 1.6° of 36°; on each four points integrate as exactly as sixteen on the whole
SAME = 1e-10  # degrees; two angles that differ by rounding only would leave a piece without width
_HALVES = np.array([0.0, 0.5, 1.0])
_CUTS = np.linspace(0.0, 1.0, 9)
_ROUNDS = 12  # of cuts into eight: enough for a kink
_AGREEMENT = 1e-12  # of values; integrals of what is smooth then agree far better


class Pieces:
    """Pieces from `low` to `high` (n,) in degrees with the nodes of a rule.

    within: the middles of the pieces, for every node of them, (pieces, nodes). variant: of which machine each piece is,
    (pieces,), where they are of many side by side.
    """

    variant: Indices | None = None

    def __init__(self, low: Array, high: Array, rule: Rule) -> None:
        self.low, self.high = low, high
        self.rule = rule
        self.nodes, self.weights = map(np.array, rule)
        self.shape = len(low), len(self.nodes)
        self.within: Array = np.broadcast_to(((low + high) / 2)[:, None], self.shape)

    @cached_property
    def right_angle(self) -> Array:
        """The multiple of 90° beside each piece, (pieces, 1)."""
        return np.asarray(90.0 * np.rint(self.within[:, :1] / 90.0))

    @cached_property
    def offset(self) -> Array:
        """How far the nodes are from these right angles in degrees: with R/L near 1 the rod swings round within a hair.

        Added up to `degrees` they would lose some digits.
        """
        start, end = self.low - self.right_angle[:, 0], self.high - self.right_angle[:, 0]
        # node by node in memory: what is one number to a piece then meets whole rows of pieces at once
        offset = ((start + end) / 2 + (self.high - self.low) / 2 * self.nodes[:, None]).T
        offset[:, 0], offset[:, -1] = start, end
        return np.asarray(offset)

    @cached_property
    def degrees(self) -> Array:
        """The angles of the nodes, (pieces, nodes)."""
        degrees = self.right_angle + self.offset
        degrees[:, 0], degrees[:, -1] = self.low, self.high
        return np.asarray(degrees)

    def part(self, rows: Indices | Flags) -> "Pieces":
        """Return these of the pieces."""
        part = Pieces(self.low[rows], self.high[rows], self.rule)
        part.variant = None if self.variant is None else self.variant[rows]
        return part

    @cached_property
    def half_degrees(self) -> Array:
        """Half the width of each piece in degrees, (pieces,)."""
        return np.asarray((self.high - self.low) / 2)

    @cached_property
    def half_widths(self) -> Array:
        """Half the width of each piece in radians, (pieces,)."""
        return np.radians(self.half_degrees)

    def integral(self, value: Array) -> float:
        """Return ∫ value dφ (φ in radians) over all pieces by the rule, of every variant; value (pieces, nodes)."""
        return float(self.half_widths @ self._means(value))

    def integrals(self, value: Array) -> Array:
        """Return ∫ value dφ (φ in radians) over each piece; value (…, pieces, nodes)."""
        return np.asarray(self.half_widths * self._means(value))

    def _means(self, value: Array) -> Array:
        # summed in one order, however the values lie in memory
        return np.asarray(np.ascontiguousarray(value) @ self.weights)


class Grid(Pieces):
    """Smooth pieces that follow one another between the angles `breaks` (n + 1,) in degrees.

    Each has 16 Gauss points and, of weight 0, both its ends, unless there is another rule; `Cuts.grid` says when.
    """

    def __init__(self, breaks: Array, rule: Rule = GAUSS) -> None:
        super().__init__(breaks[:-1], breaks[1:], rule)
        self.breaks = breaks
        self.cycle = float(breaks[-1])

    @property
    def first(self) -> Indices:
        """The first piece of every variant, (v,)."""
        return np.zeros(1, dtype=np.intp)

    @property
    def counts(self) -> Indices:
        """How many pieces every variant has, (v,)."""
        return np.diff(np.append(self.first, len(self.low)))

    @cached_property
    def number(self) -> Indices:
        """Of which variant each piece is, counted from 0 on, (pieces,)."""
        return np.repeat(np.arange(len(self.first)), self.counts)

    def of_each(self, found: Array) -> Array:
        """Return what was found of every variant, (…, v), spread over its pieces, (…, pieces)."""
        return found.take(self.number, axis=-1)

    def told(self, values: Array) -> Any:
        """Return what was found of every variant (v,), or of the only machine as a number."""
        return float(values[0])

    def piece_at(self, angles: Array, variant: Indices | None) -> Indices:
        """Return the pieces (n,) that hold angles (n,) of these variants, or begin there."""
        return np.searchsorted(self.low, angles, side="right") - 1

    def in_order(self, angles: Array, rows: Indices) -> Any:
        """Return angles (n,) found in the pieces of these rows, ascending; of many variants as `Flat`."""
        return np.sort(angles)

    @property
    def gaps(self) -> Array:
        """The distances between the nodes of a piece, over half its width, (nodes − 1,)."""
        return np.diff(self.nodes)

    def slopes(self, value: Array, rows: Any = np.s_[:]) -> Array:
        """Return the derivatives by φ of the polynomials through values (k, nodes) on these pieces (k,)."""
        slopes = self._differences @ value.T
        slopes /= self.half_widths[rows]
        return np.asarray(slopes.T)

    @cached_property
    def _differences(self) -> Array:
        """What turns values at the nodes into slopes over half a piece, (nodes, nodes)."""
        gaps = self.nodes[:, None] - self.nodes + np.eye(len(self.nodes))
        products = gaps.prod(axis=1)
        matrix = products[:, None] / products / gaps
        np.fill_diagonal(matrix, 0.0)
        np.fill_diagonal(matrix, -matrix.sum(axis=1))
        return np.asarray(matrix)

    @cached_property
    def overshoot(self) -> float:
        """By what share of their range the polynomials through values at the nodes may pass these between the nodes."""
        shares = _interpolation(self.nodes, (self.nodes[1:] + self.nodes[:-1]) / 2)
        # an odd number of nodes has its worst place beside the middle between two of them, by less than a thousandth
        return -1.001 * float(np.minimum(shares, 0.0).sum(axis=1).min())

    @cached_property
    def coefficients(self) -> Array:
        """What turns values at the nodes into coefficients of their polynomial on −1 … 1, from the highest power on."""
        return np.linalg.inv(np.vander(self.nodes))

    def other(self) -> "Grid":
        """Return the same cycle in other pieces: each cut in two unequal ones."""
        return self.split_at(self.low + 0.381966 * (self.high - self.low))

    def split_at(self, angles: Array) -> "Grid":
        """Return the grid cut at further angles in degrees; two that differ by rounding only are one."""
        return Grid(_cycle(self.breaks, angles), self.rule) if len(angles) else self


def _inside(low: Array, high: Array, rule: Rule) -> Pieces:
    """Return pieces whose nodes at the ends, too, stand inside, though next to the end."""
    pieces = Pieces(low, high, rule)
    for end, degrees in ((0, np.nextafter(low, high)), (-1, np.nextafter(high, low))):
        pieces.degrees[:, end], pieces.offset[:, end] = degrees, degrees - pieces.right_angle[:, 0]
    return pieces


def _cut(pieces: Pieces, shares: Array, rule: Rule) -> Pieces:
    """Return every piece cut at these shares (k,) of its width, from 0 to 1."""
    edges = pieces.low[:, None] + (pieces.high - pieces.low)[:, None] * shares
    edges[:, -1] = pieces.high
    return _inside(edges[:, :-1].ravel(), edges[:, 1:].ravel(), rule)


def integral(grid: Grid, function: Callable[[Pieces], Array]) -> Array:
    """Return ∫ dφ (φ in radians) of quantities over the pieces of a grid, (…,).

    function: their values (…, pieces, nodes), each at its own angle. Only jumps must stand among the breaks: every
    piece is cut, and cut again until whole and parts agree, so that nothing need be known of kinks, or of poles beside
    the real axis. The nodes, those of Lobatto, are none of a grid's; being at the ends, they see a kink just there.
    """
    rule = LOBATTO_4 if grid.rule is LOBATTO_4 else LOBATTO_16
    pieces = _inside(grid.low, grid.high, rule)
    value = function(pieces)
    settled = np.zeros(value.shape[:-2])
    size = pieces.integrals(np.abs(value)).sum(axis=-1)
    for cuts in (_HALVES, *(_CUTS,) * _ROUNDS):
        parts = _cut(pieces, cuts, rule)
        finer = function(parts)
        sums = parts.integrals(finer)
        doubtful = _doubtful(pieces, value, cuts, finer, size)
        again = np.repeat(doubtful, len(cuts) - 1)
        settled = settled + sums[..., ~again].sum(axis=-1)
        # where rounding keeps too many from agreeing, no cut will mend it
        if not 0 < doubtful.sum() <= len(grid.breaks):
            break
        pieces, value = _inside(parts.low[again], parts.high[again], rule), finer[..., again, :]
    return np.asarray(settled + sums[..., again].sum(axis=-1))


def _doubtful(pieces: Pieces, value: Array, cuts: Array, finer: Array, size: Array) -> Flags:
    """Return the pieces (n,) whose polynomials through their nodes miss the values at the nodes of their parts."""
    at = (2 * (cuts[:-1, None] + np.diff(cuts)[:, None] * (1 + pieces.nodes) / 2) - 1).ravel()
    missed = np.abs(value @ _interpolation(pieces.nodes, at).T - finer.reshape(*value.shape[:-1], -1)).max(axis=-1)
    wrong = missed * np.radians(pieces.high - pieces.low) > _AGREEMENT * size[..., None]
    return np.asarray(wrong.reshape(-1, wrong.shape[-1]).any(axis=0))


def _interpolation(nodes: Array, at: Array) -> Array:
    """Return the matrix (m, n) that turns values at nodes (n,) into those of their polynomial at other places (m,)."""
    gaps = at[:, None] - nodes
    hit = gaps == 0
    shares = 1 / np.where(hit, 1.0, gaps) / (nodes[:, None] - nodes + np.eye(len(nodes))).prod(axis=1)
    shares = np.where(hit.any(axis=1, keepdims=True), hit, shares)
    return np.asarray(shares / shares.sum(axis=1, keepdims=True))


class Cuts(NamedTuple):
    """Where a cycle is cut into smooth pieces, both in degrees from 0 to its end.

    smooth: ascending, so dense toward a pole beside the real axis that on every piece, none being wider than 36°, the
    polynomial through sixteen points is exact, and the integral of that through nine. jumps: further angles at which
    something bends or jumps, be they thousands.
    """

    smooth: Array
    jumps: Array = np.array([])

    @classmethod
    def of_turns(cls, landmarks: Iterable[float], cycle: float, jumps: Iterable[Array] = ()) -> "Cuts":
        """Return the cuts of a cycle (360 or 720 deg) of which every turn is cut at the landmarks."""
        each = np.mod(np.array([*landmarks]), 360.0)
        turns = [each + turn for turn in np.arange(0.0, cycle, 360.0)]
        return cls(_cycle(np.array([0.0, cycle]), *turns), np.concatenate([np.array([]), *jumps]))

    @classmethod
    def joined(cls, several: "Sequence[Cuts]") -> "Cuts":
        """Return the cuts of several quantities over the same cycle."""
        smooth, jumps = zip(*several, strict=True)
        return cls(_cycle(*smooth), np.concatenate(jumps))

    def shifted(self, by: float, cycle: float) -> "Cuts":
        """Return the cuts repeated over a longer cycle, and put later by an angle."""
        turns = np.arange(0.0, cycle, self.smooth[-1])
        smooth, jumps = (np.mod(np.add.outer(turns, part + by).ravel(), cycle) for part in self)
        return Cuts(_cycle(np.array([0.0, cycle]), smooth), jumps)

    def first_of(self, parts: int) -> "Cuts":
        """Return the cuts of the first of so many equal parts, in each of which all comes back."""
        end = self.smooth[-1] / parts
        return Cuts(np.append(self.smooth[self.smooth < end], end), self.jumps[self.jumps < end])

    def grid(self, rule: Rule = GAUSS) -> Grid:
        """Return the pieces. Between many jumps they have four points, and the smooth pieces are cut to suit them."""
        if len(self.jumps) <= _MANY:
            return Grid(_narrow(_cycle(self.smooth, self.jumps)), rule)
        smooth = _narrow(self.smooth)
        parts = smooth[:-1, None] + np.diff(smooth)[:, None] * (np.arange(_PARTS) / _PARTS)
        return Grid(_cycle(smooth[[0, -1]], parts.ravel(), self.jumps), LOBATTO_4)


def narrow(low: Array, high: Array) -> tuple[Array, Indices]:
    """Return where the equal parts of pieces (n,) begin, none of them wider than 36°, and of which piece each is."""
    counts = np.maximum(np.ceil((high - low) / _WIDEST - SAME), 1).astype(np.intp)
    whose = np.repeat(np.arange(len(low)), counts)
    number = np.arange(len(whose)) - np.repeat(np.cumsum(counts) - counts, counts)
    return low[whose] + number * ((high - low) / counts)[whose], whose


def _narrow(breaks: Array) -> Array:
    return np.append(narrow(breaks[:-1], breaks[1:])[0], breaks[-1])


def _cycle(*angles: Array) -> Array:
    """Return all angles, those of a whole cycle first, without those that differ by rounding only."""
    kept = ascending(np.concatenate(angles), apart=SAME)
    end = angles[0][-1]
    return np.append(kept[kept < end - SAME], end)


def cut_equally(breaks: Array, parts: Indices) -> Array:
    """Return the breaks (n + 1,) of pieces of which each is cut into so many equal parts (n,)."""
    ends = np.append(0, parts.cumsum())
    return np.interp(np.arange(ends[-1] + 1), ends, breaks)


def ascending(angles: Array, apart: float = 0.0) -> Array:
    """Return the angles (n,) in degrees sorted, without those that are no more than `apart` beyond the one before.

    (numpy.unique would do for apart = 0, but imports numpy.ma, a fifth of the whole start-up.)
    """
    angles = np.sort(angles)
    return angles[np.concatenate(([True], np.diff(angles) > apart))] if len(angles) else angles
