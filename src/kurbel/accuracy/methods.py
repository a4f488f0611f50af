"""Methods that know no crank: Gauss's rule, root searches and Chebyshev fits between corners; and without corners.

Each takes the name of a quantity, the function that it is the integral, the extremes or the swing of, the edges
(n + 1,) in degrees of the pieces on which that is smooth, and how finely. In numbers of mpmath `by_gauss` gives the
references.
"""

import math
from collections.abc import Callable
from functools import cache
from typing import Any, Union

import mpmath
import numpy as np
from mpmath.calculus.quadrature import GaussLegendre
from numpy.polynomial import chebyshev

from kurbel.arrays import Array

mp, mpf = mpmath.mp, mpmath.mpf
Precise = Any
"""An mpf, or, where a function takes both, a float or an array of either."""
Function = Callable[[Array, Array], Array]
"""Takes angles (n,) in degrees, and for each one within its piece, which selects the side of a corner."""
Found = Union[Precise, tuple[Precise, Precise]]
"""One value, or the largest and the smallest."""


def merged(angles: Array) -> Array:
    """Return angles in order, without those that differ from the one before by rounding only."""
    found = np.sort(angles)
    return found[np.append(True, np.diff(found) > 1e-25)]


def _on(function: Function, low: Array, high: Array, shares: Array) -> Array:
    """Return the values (n, m) at shares (m,) of the width of each of n pieces."""
    phi = low[:, None] + (high - low)[:, None] * shares
    return function(phi.ravel(), np.repeat((low + high) / 2, len(shares))).reshape(phi.shape)


def roots_inside(function: Function, low: Array, high: Array, parts: int) -> tuple[Array, Array]:
    """Return the roots (m,) inside n pieces, looked for at equal steps, and the middle of the piece of each.

    Regula falsi in which the end that stays counts half in the next step.
    """
    shares = np.arange(parts + 1) / parts
    values = _on(function, low, high, shares)
    piece, step = np.nonzero((values[:, :-1] > 0) != (values[:, 1:] > 0))
    begin, width, within = low[piece], (high - low)[piece], ((low + high) / 2)[piece]
    stays, found = begin + width * shares[step], begin + width * shares[step + 1]
    f_stays, f_found = values[piece, step], values[piece, step + 1]
    for _ in range(60):
        last, f_last = found, f_found
        found = (stays * f_last - last * f_stays) / (f_last - f_stays)
        if not (np.abs(found - last) > (1e-12 if low.dtype == float else 1e-25)).any():
            break
        f_found = function(found, within)
        crossed = (f_found > 0) != (f_last > 0)
        stays, f_stays = np.where(crossed, last, stays), np.where(crossed, f_last, f_stays / 2)
    return found, within


@cache
def _gauss(count: int) -> tuple[Array, Array]:
    """Return the nodes (count,) on 0 … 1 of Gauss's rule, and their weights; for 0 points 12 in mpmath's numbers."""
    rule = (
        np.polynomial.legendre.leggauss(count)
        if count
        else np.array(GaussLegendre(mp).calc_nodes(3, mp.prec)).T
    )
    return (1 + rule[0]) / 2, rule[1] / 2


def integrals(function: Function, edges: Array, count: int) -> Array:
    """Return the integral over each piece (n,), over degrees, by Gauss's rule.

    In mpmath's numbers by 12 points, and pieces are halved until whole and halves agree to 15 digits: the halves then
    have 30, since the error of this rule is squared when a piece is halved.
    """
    precise = edges.dtype == object
    nodes, weights = _gauss(0 if precise else count)

    def ruled(edges: Array) -> tuple[Array, Array]:
        values, widths = _on(function, edges[:-1], edges[1:], nodes), np.diff(edges)
        return values @ weights * widths, np.abs(values) @ weights * widths

    whole, size = ruled(edges)
    if not precise:
        return whole
    halved = np.sort(np.append(edges, (edges[1:] + edges[:-1]) / 2))
    halves = ruled(halved)[0].reshape(-1, 2).sum(axis=1)
    for piece in np.flatnonzero(np.abs(halves - whole) > 1e-15 * size):
        halves[piece] = integrals(function, halved[2 * piece : 2 * piece + 3], count).sum()
    return halves


def by_gauss(quantity: str, function: Function, edges: Array, count: int) -> Found:
    """Return a quantity by Gauss's rule on each piece, and roots looked for at as many steps."""
    if quantity[0] == "T":
        return largest_and_smallest(function, edges, count)
    radians = mp.radians if edges.dtype == object else math.radians
    whole = integrals(function, edges, count).sum()
    if quantity[0] == "A":
        return radians(whole)
    mean = whole / (edges[-1] - edges[0])
    crossings, _ = roots_inside(
        lambda phi, within: function(phi, within) - mean, edges[:-1], edges[1:], count
    )
    cuts = merged(np.append(edges, crossings))
    heights = np.cumsum(
        integrals(function, cuts, count) - mean * np.diff(cuts)
    )  # the last is that of the beginning
    return radians(heights.max() - heights.min())


def largest_and_smallest(function: Function, edges: Array, count: int) -> tuple[Precise, Precise]:
    """Return the largest and the smallest value, at the ends of the pieces or at a root of the derivative."""
    low, high, step = edges[:-1], edges[1:], mpf("1e-10") if edges.dtype == object else 1e-4

    def rise(phi: Array, within: Array) -> Array:
        return function(phi + step, within) - function(phi - step, within)

    tops, within = roots_inside(rise, low + 2 * step, high - 2 * step, count)
    middles = (low + high) / 2
    values = function(np.concatenate((low, high, tops)), np.concatenate((middles, middles, within)))
    return values.max(), values.min()


def by_fit(quantity: str, function: Function, edges: Array, count: int) -> Found:
    """Return a quantity of the polynomial through so many values on each piece, at the zeros of Chebyshev's."""
    nodes, (low, high) = chebyshev.chebpts1(count), (edges[:-1], edges[1:])
    series = chebyshev.chebfit(nodes, _on(function, low, high, (1 + nodes) / 2).T, count - 1)

    def fitted(phi: Array, within: Array) -> Array:
        piece = np.searchsorted(edges, within) - 1
        place = (2 * phi - low[piece] - high[piece]) / (high - low)[piece]
        return np.asarray(chebyshev.chebval(place, series[:, piece], tensor=False))

    return by_gauss(quantity, fitted, edges, count)


# without the corners


def equidistant(quantity: str, function: Function, edges: Array, count: int) -> Found:
    """Return a quantity from so many equal divisions of each turn: by the trapezium rule, or the largest ordinates."""
    values, step = _divided(function, edges, count)
    if quantity[0] == "T":
        return values.max(), values.min()
    if quantity[0] == "A":
        return values.sum() * step
    above = values - values.mean()
    return float(np.ptp(np.cumsum(above + np.roll(above, -1)))) / 2 * step


def by_simpson(quantity: str, function: Function, edges: Array, count: int) -> Found:
    """Return a work or a swing of energy from so many equal divisions of each turn by Simpson's rule."""
    values, step = _divided(function, edges, count)
    even, odd, next_even = values[::2], values[1::2], np.roll(values[::2], -1)
    works = (even + 4 * odd + next_even) * step / 3
    if quantity[0] == "A":
        return works.sum()
    return float(np.ptp(np.cumsum(works - works.mean())))


def _divided(function: Function, edges: Array, count: int) -> tuple[Array, float]:
    """Return values at equal divisions of the cycle, so many a turn, and their step in radians."""
    divisions = round((edges[-1] - edges[0]) * count / 360)
    phi = np.arange(divisions) * (360 / count)
    return function(phi, phi), 2 * math.pi / count


def over_the_turn(quantity: str, function: Function, edges: Array, count: int) -> Found:
    """Return a quantity by Gauss's rule with so many points on the whole cycle, as if it had no corner."""
    whole = edges[[0, -1]]

    def smooth(phi: Array, within: Array) -> Array:
        return function(phi, phi)

    return by_gauss(quantity, smooth, whole, count)


def by_quad(quantity: str, function: Function, edges: Array, _: int) -> Found:
    """Return a work by scipy's quad over the cycle, without further options."""
    integrate = scipy_integrate()

    def at(phi: float) -> float:
        angle = np.array([phi])
        return float(function(angle, angle)[0])

    return math.radians(integrate.quad(at, edges[0], edges[-1], full_output=1)[0])


def scipy_integrate() -> Any:
    """Return scipy's integrators, or None where scipy is not installed."""
    try:
        from scipy import integrate
    except ImportError:
        return None
    return integrate
