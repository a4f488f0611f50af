"""Elements for collocation over a cycle: parts of its smooth pieces, each with the nodes of Radau IIA of 11 stages."""

from functools import cache
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices

STAGES = 11


def legendre(x: Array, degree: int) -> Array:
    """Return P_0 … P_degree at x (…,) as (…, degree + 1)."""
    p = [np.ones_like(x), x]
    for n in range(1, degree):
        p.append(((2 * n + 1) * x * p[n] - n * p[n - 1]) / (n + 1))
    return np.stack(p[: degree + 1], axis=-1)


class Rule(NamedTuple):
    """Radau IIA on 0 … 1: nodes (s,), matrix (s, s) of ∫ ℓⱼ from 0 to cᵢ, Legendre coefficients from nodal values."""

    nodes: Array
    matrix: Array
    to_legendre: Array


@cache
def rule() -> Rule:
    """Return the rule with nodes at the roots of P_s − P_{s−1}, the last one at 1."""
    # Golub: Jacobi matrix of the Legendre polynomials whose last entry puts an eigenvalue at 1
    n = np.arange(STAGES)
    off = n[1:] / np.sqrt(4.0 * n[1:] ** 2 - 1)
    last = np.where(n == STAGES - 1, STAGES / (2 * STAGES - 1), 0.0)
    x = np.append(np.linalg.eigvalsh(np.diag(last) + np.diag(off, 1) + np.diag(off, -1))[:-1], 1.0)
    p = legendre(x, STAGES)
    below = np.concatenate((-np.ones((STAGES, 1)), p[:, : STAGES - 1]), axis=1)
    integrals = (p[:, 1 : STAGES + 1] - below) / (2 * n + 1) / 2
    integrals[:, 0] = (x + 1) / 2
    matrix: Array = np.asarray(integrals @ np.linalg.inv(p[:, :STAGES]), dtype=float)
    whole = legendre(np.append(-1.0, x), STAGES)
    return Rule((x + 1) / 2, matrix, np.asarray(np.linalg.inv(whole), dtype=float))


class Elements(NamedTuple):
    """Parts of smooth pieces of the cycle, in degrees; all (k,).

    piece, offset, width: start of the piece, way from there to the start of the element, and its width; the way is kept
    apart because a part may be thinner than the rounding of its angle. within: an angle inside the piece.
    """

    piece: Array
    offset: Array
    width: Array
    within: Array

    @classmethod
    def over(cls, breaks: Array) -> "Elements":
        """Return the pieces between the angles `breaks` (k + 1,) in degrees, one element each."""
        low, high = breaks[:-1], breaks[1:]
        return cls(low, np.zeros_like(low), high - low, (low + high) / 2)

    @property
    def low(self) -> Array:
        """Angles at which the elements begin."""
        return self.piece + self.offset

    @property
    def degrees(self) -> Array:
        """Angles (k, s) of the nodes."""
        return self.piece[:, None] + (self.offset[:, None] + self.width[:, None] * rule().nodes)

    def at(self, coefficients: Array, degrees: Array, within: Array) -> Array:
        """Return Σ c_n P_n at angles (n,), of the elements that hold `within`; coefficients: (k, …, s + 1)."""
        k = np.clip(np.searchsorted(self.low, within, side="right") - 1, 0, None)
        x = 2 * ((degrees - self.piece[k]) - self.offset[k]) / self.width[k] - 1
        return np.asarray(np.einsum("...n,...mn->...m", legendre(x, STAGES), coefficients[k]))

    def cut(self, rough: Flags) -> "tuple[Elements, Indices, Array]":
        """Return the elements with the rough ones cut at 0.1 and 0.5.

        Beside them stand, of each new one, the index of the old one that holds it and where its nodes, its start
        included, lie on −1 … 1 there (k, s + 1).
        """
        times = np.where(rough, 3, 1)
        old = np.repeat(np.arange(len(times)), times)
        part = np.arange(len(old)) - np.repeat(np.cumsum(times) - times, times)
        begin = np.where(rough[old], np.array([0.0, 0.1, 0.5])[part], 0.0)
        share = np.where(rough[old], np.array([0.1, 0.4, 0.5])[part], 1.0)
        width = self.width[old]
        finer = Elements(self.piece[old], self.offset[old] + width * begin, width * share, self.within[old])
        nodes = begin[:, None] + share[:, None] * np.append(0.0, rule().nodes)
        return finer, old, np.asarray(2 * nodes - 1)
