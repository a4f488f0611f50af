"""Points of a curve: as many as it takes to look like the curve itself, each computed by the solver, none between."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.report.pictures.picture import Piece

_WIDEST = 7.5  # degrees between two points at first: narrow enough that no wave hides between them
_ROUNDS = 12
_JOINED = 1e-9
"""Beside its height, what a curve may step between two pieces without that being a jump."""

Values = Callable[["Array", "Array"], "Array"]
"""Several quantities (k, n) in SI at crank angles (n,) in degrees, on the sides of jumps that hold `within` (n,)."""


@dataclass(frozen=True, eq=False)
class Samples:
    """Quantities (k, n) at crank angles (n,), the pieces between jumps and bends one after the other."""

    degrees: Array
    within: Array
    values: Array


def sampled(breaks: Array, values: Values, fineness: float) -> Samples:
    """Return points so dense that straight lines between them miss no quantity by more than its height × fineness.

    breaks: crank angles (m,) in degrees between which all quantities are smooth.
    """
    counts = np.ceil(np.diff(breaks) / _WIDEST).astype(int)
    edges, within = cut_equally(breaks, counts), np.repeat((breaks[:-1] + breaks[1:]) / 2, counts)
    low, high = edges[:-1], edges[1:]
    at_low, at_high = np.split(values(np.append(low, high), np.append(within, within)), 2, axis=1)
    known = [(low, within, at_low), (high, within, at_high)]
    height = np.ptp(np.concatenate((at_low, at_high), axis=1), axis=1)[:, None] * fineness
    for _ in range(_ROUNDS):
        middle = (low + high) / 2
        at_middle = values(middle, within)
        known.append((middle, within, at_middle))
        missed = (np.abs(at_middle - (at_low + at_high) / 2) > height).any(axis=0)
        if not missed.any():
            break
        halves = ((low, middle, at_low, at_middle), (middle, high, at_middle, at_high))
        low, high, at_low, at_high = (
            np.concatenate([half[..., missed] for half in parts], axis=-1) for parts in zip(*halves)
        )
        within = np.concatenate((within[missed],) * 2)
    return _in_order(*(np.concatenate(parts, axis=-1) for parts in zip(*known)))


def cut_equally(breaks: Array, parts: Indices) -> Array:
    """Return the breaks (n + 1,) of pieces of which each is cut into so many equal parts (n,)."""
    ends = np.append(0, parts.cumsum())
    return np.interp(np.arange(ends[-1] + 1), ends, breaks)


def _in_order(degrees: Array, within: Array, values: Array) -> Samples:
    order = np.lexsort((degrees, within))
    degrees, within, values = degrees[order], within[order], values[:, order]
    new = np.concatenate(([True], (np.diff(degrees) != 0) | (np.diff(within) != 0)))
    return Samples(degrees[new], within[new], values[:, new])


def pieces(samples: Samples, x: Array, y: Array) -> tuple[Piece, ...]:
    """Return a curve through points x, y (n,), parted where it jumps."""
    steps = np.flatnonzero(np.diff(samples.within) != 0)
    jumps = [np.abs(np.diff(line)[steps]) > _JOINED * (np.ptp(line) or 1.0) for line in (x, y)]
    cuts = [0, *(steps[jumps[0] | jumps[1]] + 1).tolist(), len(x)]
    return tuple(
        Piece(*(part[start:end] for part in (x, y, samples.degrees, samples.within))) for start, end in pairwise(cuts)
    )
