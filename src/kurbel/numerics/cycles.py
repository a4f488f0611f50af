"""The cycles of many variants of a machine, each cut into its own smooth pieces: one flat grid of all of them."""

from collections.abc import Iterable
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices
from kurbel.numerics.gauss import LOBATTO_9
from kurbel.numerics.grid import SAME, Grid, Pieces, narrow


class Unlike(Exception):
    """Some of many variants cannot be answered beside the others; `variants` says which, (n,)."""

    def __init__(self, variants: Indices) -> None:
        super().__init__()
        self.variants = variants


class Flat(NamedTuple):
    """Numbers of many variants one after another, be they few or many of each: whose each is, and the numbers, (n,)."""

    variant: Indices
    values: Array

    def sorted(self) -> "Flat":
        """Return them ascending, variant by variant."""
        pairs = np.sort(_pairs(*self), kind="stable")  # of some that are in order, in little time
        return Flat(pairs.real.astype(np.intp), pairs.imag)

    def of_each(self, count: int) -> tuple[tuple[float, ...], ...]:
        """Return the numbers of each of so many variants."""
        ends = np.searchsorted(self.variant, np.arange(count + 1)).tolist()
        values = self.values.tolist()
        return tuple(tuple(values[start:end]) for start, end in pairwise(ends))

    @classmethod
    def alike(cls, values: Array, count: int) -> "Flat":
        """Return the same numbers (n,) for each of so many variants."""
        return cls(np.repeat(np.arange(count), len(values)), np.tile(values, count))


def later(angles: Any, by: float) -> Any:
    """Return angles (n,), or those of many variants, with this added to each."""
    return Flat(angles.variant, angles.values + by) if isinstance(angles, Flat) else angles + by


def located(table: Flat, variant: Indices, values: Array) -> Indices:
    """Return the place (…,) in a sorted table of the last number of these variants that is no greater than the values.

    Where all numbers of a variant are greater, its last one is told: they repeat after a cycle. Every variant must have
    one.
    """
    found = np.searchsorted(_pairs(*table), _pairs(variant, values), side="right") - 1
    before = (found < 0) | (table.variant[found] != variant)
    found[before] = np.searchsorted(table.variant, variant[before], side="right") - 1
    return np.asarray(found)


def _pairs(variant: Indices, values: Array) -> Any:
    """Return variants and numbers (…,) as complex ones, which stand in order by variant first."""
    pairs = np.empty(values.shape, dtype=complex)
    pairs.real, pairs.imag = variant, values
    return pairs


class Cycles(Grid):
    """Smooth pieces of the cycles of many variants, those of one after those of another, each in order.

    breaks: the angles of every variant at which its pieces begin, from 0 on; cycle: degrees at which all of them end.
    """

    def __init__(self, breaks: Flat, cycle: float) -> None:
        self.variant, low = breaks
        Pieces.__init__(self, low, _ends(breaks, cycle), LOBATTO_9)
        self.cycle = cycle

    @cached_property
    def first(self) -> Indices:
        """The first piece of every variant, (v,)."""
        assert self.variant is not None
        return np.flatnonzero(np.append(True, self.variant[1:] != self.variant[:-1]))

    def told(self, values: Array) -> Any:
        """Return what was found of every variant (v,)."""
        return values

    def piece_at(self, angles: Array, variant: Indices | None) -> Indices:
        """Return the pieces (n,) that hold angles (n,) of these variants, or begin there."""
        assert self.variant is not None
        assert variant is not None
        return located(Flat(self.variant, self.low), variant, angles)

    def in_order(self, angles: Array, rows: Indices) -> Any:
        """Return angles (n,) found in the pieces of these rows, ascending, variant by variant."""
        assert self.variant is not None
        return Flat(self.variant[rows], angles).sorted()

    def integral(self, value: Array) -> Any:
        """Return ∫ value dφ (φ in radians) over all pieces of every variant, (v,); value (pieces, nodes)."""
        return np.add.reduceat(self.integrals(value), self.first)

    def split_at(self, angles: Any) -> Grid:
        """Return the grid cut at further angles `Flat` in degrees; two that differ by rounding only are one."""
        assert self.variant is not None
        if not len(angles.values):
            return self
        whole = Flat(np.append(self.variant, angles.variant), np.append(self.low, angles.values))
        return Cycles(_breaks(whole, self.cycle), self.cycle)


def cycles_of_turns(landmarks: Iterable[Any], cycle: float, jumps: Iterable[Any], count: int) -> Cycles:
    """Return the cycles (360 or 720 deg) of so many variants, cut at landmarks of every turn, in pieces up to 36°.

    landmarks: floats, or arrays (v,), nan where a variant has none; jumps: further angles in the cycle, (n,) or
    `Flat`.
    """
    more = [one if isinstance(one, Flat) else Flat.alike(one, count) for one in jumps]
    turns = np.arange(0.0, cycle, 360.0)
    each = np.stack([np.broadcast_to(mark, count) for mark in (0.0, *landmarks)], axis=1)
    angles = np.add.outer(np.mod(each, 360.0), turns).reshape(count, -1)
    smooth = Flat(np.repeat(np.arange(count), angles.shape[1]), angles.ravel())
    whole = Flat(*(np.concatenate(parts) for parts in zip(smooth, *more, strict=True)))
    breaks = _breaks(whole, cycle)
    low, whose = narrow(breaks.values, _ends(breaks, cycle))
    return Cycles(Flat(breaks.variant[whose], low), cycle)


def _ends(breaks: Flat, cycle: float) -> Array:
    """Return the angles at which the pieces of every variant end that begin at these."""
    last = np.append(breaks.variant[1:] != breaks.variant[:-1], True)
    return np.where(last, cycle, np.append(breaks.values[1:], cycle))


def _breaks(angles: Flat, cycle: float) -> Flat:
    """Return the angles of every variant in order, without those that differ by rounding only, and the end."""
    variant, values = angles.sorted()
    kept = _apart(variant, values) & (values < cycle - SAME)  # not where it is nan
    return Flat(variant[kept], values[kept])


def _apart(variant: Indices, values: Array) -> Flags:
    return np.append(True, (values[1:] - values[:-1] > SAME) | (variant[1:] != variant[:-1]))
