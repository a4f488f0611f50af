"""Integrals, extremes and periodic solutions of what is smooth between corners, in floats or in mpmath's numbers.

In floats these are the strong methods that kurbel is compared with; the same searches in 40 digits, with the sines and
rules of mpmath, give the references. A function takes angles in radians and, for each, an angle within its piece.
"""

import math
from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any, NamedTuple

import mpmath
import numpy as np
from mpmath.calculus.quadrature import GaussLegendre
from numpy.polynomial import chebyshev

from kurbel.arrays import Array

mp = mpmath.mp
DIGITS = 40
"""Of a reference."""
Number = Any
"""A float or an mpf, or an array of either."""
Function = Callable[[Number, Number], Number]
Integrals = Callable[[Function, Array], Array]
"""Takes a function and the edges of n pieces; returns its integral over each, (n,)."""


class Numbers(NamedTuple):
    """A kind of number: `of` makes it of floats; functions of numbers and arrays; rounding: where a search ends."""

    of: Callable[[Any], Number]
    sin: Callable[[Number], Number]
    cos: Callable[[Number], Number]
    arcsin: Callable[[Number], Number]
    sqrt: Callable[[Number], Number]
    log: Callable[[Number], Number]
    pi: Number
    rounding: float


FLOATS = Numbers(np.float64, np.sin, np.cos, np.arcsin, np.sqrt, np.log, math.pi, 1e-15)
_OF_MPMATH = [np.frompyfunc(one, 1, 1) for one in (mp.mpf, mp.sin, mp.cos, mp.asin, mp.sqrt, mp.log)]
PRECISE = Numbers._make([*_OF_MPMATH, mp.pi, 1e-30])


class NoAnswer(Exception):
    """A method came to no answer; the text says why."""


def merged(angles: Sequence[Number], numbers: Numbers) -> Array:
    """Return angles in order, without those that differ from the one before by rounding only."""
    found = np.sort(np.array(angles))
    return np.asarray(found[np.append(True, np.diff(found) > 1e3 * numbers.rounding)])


def within(edges: Array) -> Array:
    """Return the middle of each piece, (n, 1)."""
    return np.asarray((edges[1:] + edges[:-1]) / 2)[:, None]


def spread(edges: Array, shares: Array) -> Array:
    """Return the angles at shares (m,) of the width of each piece, (n, m)."""
    return np.asarray(edges[:-1, None] + np.diff(edges)[:, None] * shares)


def roots(function: Function, edges: Array, numbers: Numbers, parts: int = 24) -> tuple[Array, Array]:
    """Return the roots inside the pieces (m,), looked for at equal steps, and the middle of the piece of each.

    False position, with a halving after every two steps, so that no bend of the function holds it up.
    """
    at = spread(edges, np.arange(parts + 1) / parts)
    values = function(at, within(edges))
    piece, step = np.nonzero((values[:, :-1] > 0) != (values[:, 1:] > 0))
    inside = within(edges)[piece, 0]
    low, high, f_low, f_high = at[piece, step], at[piece, step + 1], values[piece, step], values[piece, step + 1]
    found, change = high, high
    for count in range(900):
        if count % 3 == 2 and not (np.abs(change) > numbers.rounding * np.abs(found)).any():
            break
        new = (low + high) / 2 if count % 3 == 2 else (low * f_high - high * f_low) / (f_high - f_low)
        found, change = new, new - found
        f_found = function(found, inside)
        left = (f_found > 0) == (f_low > 0)
        low, f_low = np.where(left, found, low), np.where(left, f_found, f_low)
        high, f_high = np.where(left, high, found), np.where(left, f_high, f_found)
    return found, inside


def extremes(function: Function, edges: Array, numbers: Numbers) -> Array:
    """Return the largest and the smallest value, (2,), from the ends of the pieces and the roots of the derivative."""
    step = numbers.rounding ** (1 / 3)
    tops, inside = roots(lambda phi, at: function(phi + step, at) - function(phi - step, at), edges, numbers)
    ends = function(spread(edges, np.array([0.0, 1.0])), within(edges)).ravel()
    values = np.append(ends, function(tops, inside)) if len(tops) else ends
    return np.array([values.max(), values.min()])


def excess(function: Function, edges: Array, numbers: Numbers, integrals: Integrals) -> Number:
    """Return the largest swing of ∫ (function − its mean), between the angles at which the function has its mean."""
    mean = integrals(function, edges).sum() / (edges[-1] - edges[0])
    above: Function = lambda phi, at: function(phi, at) - mean  # noqa: E731
    crossings, _ = roots(above, edges, numbers)
    heights = np.append(0, np.cumsum(integrals(above, merged([*edges, *crossings], numbers))))
    return heights.max() - heights.min()


def gauss(points: int) -> Integrals:
    """Return integrals by the Gauss-Legendre rule with so many points on a piece."""
    return partial(_weighted, *np.polynomial.legendre.leggauss(points))


def _weighted(nodes: Array, weights: Array, function: Function, edges: Array) -> Array:
    values = function(spread(edges, (1 + nodes) / 2), within(edges))
    return np.asarray(values @ weights * np.diff(edges) / 2)


def precise_integrals(function: Function, edges: Array) -> Array:
    """Return integrals by 24 Gauss points of mpmath on each piece, halved until whole and halves agree to 25 digits."""
    nodes, weights = np.array(GaussLegendre(mp).calc_nodes(4, mp.prec)).T
    rule = partial(_weighted, nodes, weights)
    halved = np.sort([*edges, *within(edges)[:, 0]])
    wholes, halves = rule(function, edges), rule(function, halved).reshape(-1, 2)
    found = halves.sum(axis=1)
    for piece in np.nonzero(np.abs(found - wholes) > 1e-25 * np.abs(halves).sum())[0]:
        found[piece] = precise_integrals(function, halved[2 * piece : 2 * piece + 3]).sum()
    return np.asarray(found)


def fitted(function: Function, edges: Array, points: int) -> Function:
    """Return the polynomials through so many values of a function on each piece, at the zeros of Chebyshev's."""
    nodes = chebyshev.chebpts1(points)
    values = function(spread(edges, (1 + nodes) / 2), within(edges))
    series = np.linalg.solve(chebyshev.chebvander(nodes, points - 1), values.T)

    def polynomials(phi: Array, at: Array) -> Array:
        piece = np.searchsorted(edges[1:-1], at)
        place = (2 * phi - edges[piece] - edges[piece + 1]) / (edges[piece + 1] - edges[piece])
        return np.asarray(chebyshev.chebval(place, series[:, piece], tensor=False))

    return polynomials


# the periodic solution of K′ = drive − load


class Motor(NamedTuple):
    """Kinetic energy K = ½ J ω² of a shaft in J, fed by drive − load per radian.

    drive: torque without inertia in N m; inertia: J in kg m²; load: takes ω, returns the torque and its slope by ω.
    """

    drive: Function
    inertia: Function
    load: Callable[[Number], tuple[Number, Number]]
    omega: Number


@cache
def _collocation(count: int) -> tuple[Array, Array]:
    """Return Chebyshev nodes (s,) on 0 … 1, the last of them 1, and the matrix (s, s) that integrates to them."""
    with mp.workdps(DIGITS):
        nodes = [(1 + mp.cos(2 * mp.pi * k / (2 * count - 1))) / 2 for k in reversed(range(count))]
        powers, integrals = mp.matrix(count), mp.matrix(count)
        for i, node in enumerate(nodes):
            for k in range(count):
                powers[i, k], integrals[i, k] = node**k, node ** (k + 1) / (k + 1)
        return np.array(nodes), np.array((integrals * powers**-1).tolist())


def periodic(motor: Motor, edges: Array, count: int, numbers: Numbers) -> tuple[Array, Array]:
    """Return ω in rad/s at the ends of the elements, (n,), and which of them are too long, (n,).

    Collocation with Newton's method over the whole cycle. Corrections are floats: in mpmath's numbers each gains a
    dozen digits. Raises NoAnswer.
    """
    nodes, matrix = (numbers.of(one) for one in _collocation(count))
    phi, widths = spread(edges, nodes), np.diff(edges)[:, None]
    drive, inertia = motor.drive(phi, within(edges)), motor.inertia(phi, within(edges))
    kinetic = nominal = inertia * motor.omega**2 / 2
    lengths, rigid, size = np.asarray(widths, dtype=float), np.asarray(nominal, dtype=float), math.inf
    for _ in range(80):
        omega = numbers.sqrt(2 * kinetic / inertia)
        load, slope = motor.load(omega)
        rate, before = drive - load, np.roll(kinetic[:, -1], 1)[:, None]
        missing = np.asarray(before + widths * (rate @ matrix.T) - kinetic, dtype=float)
        stiffness = lengths * np.asarray(slope / (inertia * omega), dtype=float)
        system = np.eye(count) + np.asarray(matrix, dtype=float) * stiffness[:, None, :]
        own, passed = np.moveaxis(np.linalg.solve(system, np.stack((missing, np.ones_like(missing)), axis=2)), 2, 0)
        step = own + passed * _arriving(own[:, -1], passed[:, -1])[:, None]
        step *= min(1.0, 0.5 / max(1e-9, float((-step / np.asarray(kinetic, dtype=float)).max())))
        kinetic, last, size = kinetic + step, size, float(np.abs(step / rigid).max())
        if not size < 1e300:
            break
        if size < numbers.rounding or (size < 1e-9 and size > last / 2):
            tail = (
                np.asarray(rate, dtype=float)
                @ np.linalg.inv(chebyshev.chebvander(np.asarray(2 * nodes - 1, dtype=float), count - 1)).T
            )
            least = np.asarray(kinetic, dtype=float).min(axis=1)
            rough = np.abs(lengths * tail[:, -2:]).max(axis=1) > 1e-14 * least
            return numbers.sqrt(2 * kinetic / inertia)[:, -1], rough
    raise NoAnswer("no solution")


def _arriving(own: Array, passed: Array) -> Array:
    """Return what arrives at each element (n,) if each sends on own + passed · arriving, the last one to the first."""
    alpha, beta = 1.0, 0.0
    for part, share in zip(own, passed):
        alpha, beta = share * alpha, share * beta + part
    found = [beta / (1 - alpha)]
    for part, share in zip(own[:-1], passed[:-1]):
        found.append(part + share * found[-1])
    return np.array(found)
