"""Methods that know no crank: Gauss's rule, root searches and Chebyshev fits between corners; and without corners.

Each takes the name of a quantity, the function that it is the integral, the extremes or the swing of,
the edges (n + 1,) in degrees of the pieces on which that is smooth, and how finely. In numbers of mpmath
`by_gauss` gives the references.
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
"""A number of mpmath, or, where a function takes both, a float or an array of either."""
Function = Callable[[Array, Array], Array]
"""Takes angles (n,) in degrees, and for each one within its piece, which selects the side of a corner."""
MethodValue = Union[Precise, tuple[Precise, Precise]]
"""One value, or the largest and the smallest."""


def merged(angles: Array) -> Array:
    """Return angles in order, without those that differ from the one before by rounding only."""
    ordered = np.sort(angles)
    differs = np.append(True, np.diff(ordered) > 1e-25)
    return ordered[differs]


def is_precise(edges: Array) -> bool:
    """Return whether angles are numbers of mpmath."""
    return edges.dtype == object


def _on(function: Function, low: Array, high: Array, shares: Array) -> Array:
    """Return the values (n, m) at shares (m,) of the width of each of n pieces."""
    phi = low[:, None] + (high - low)[:, None] * shares
    within = np.repeat((low + high) / 2, len(shares))
    return function(phi.ravel(), within).reshape(phi.shape)


def roots_inside(function: Function, low: Array, high: Array, parts: int) -> tuple[Array, Array]:
    """Return the roots (m,) inside n pieces, looked for at equal steps, and the middle of the piece of each.

    Regula falsi in which the end that stays counts half in the next step.
    """
    # steps over which the sign changes
    shares = np.arange(parts + 1) / parts
    values = _on(function, low, high, shares)
    changes = (values[:, :-1] > 0) != (values[:, 1:] > 0)
    piece, step = np.nonzero(changes)
    width = (high - low)[piece]
    within = ((low + high) / 2)[piece]
    stays = low[piece] + width * shares[step]
    root = low[piece] + width * shares[step + 1]
    f_stays = values[piece, step]
    f_root = values[piece, step + 1]

    finest = 1e-25 if is_precise(low) else 1e-12
    for _ in range(60):
        last = root
        f_last = f_root
        root = (stays * f_last - last * f_stays) / (f_last - f_stays)
        if not (np.abs(root - last) > finest).any():
            break
        f_root = function(root, within)
        has_crossed = (f_root > 0) != (f_last > 0)
        stays = np.where(has_crossed, last, stays)
        f_stays = np.where(has_crossed, f_last, f_stays / 2)
    return root, within


@cache
def _gauss(count: int) -> tuple[Array, Array]:
    """Return the nodes (count,) on 0 … 1 of Gauss's rule, and their weights; for 0 points 12 in mpmath's numbers."""
    if count:
        nodes, weights = np.polynomial.legendre.leggauss(count)
    else:
        nodes, weights = np.array(GaussLegendre(mp).calc_nodes(3, mp.prec)).T
    return (1 + nodes) / 2, weights / 2


def integrals(function: Function, edges: Array, count: int) -> Array:
    """Return the integral over each piece (n,), over degrees, by Gauss's rule.

    In mpmath's numbers by 12 points, and pieces are halved until whole and halves agree to 15 digits: the halves then
    have 30, since halving a piece squares the error of this rule.
    """
    nodes, weights = _gauss(0 if is_precise(edges) else count)

    def ruled(edges: Array) -> tuple[Array, Array]:
        values = _on(function, edges[:-1], edges[1:], nodes)
        widths = np.diff(edges)
        return values @ weights * widths, np.abs(values) @ weights * widths

    areas, sizes = ruled(edges)
    if not is_precise(edges):
        return areas

    # once more on halves
    middles = (edges[1:] + edges[:-1]) / 2
    halved_edges = np.sort(np.append(edges, middles))
    half_areas, _ = ruled(halved_edges)
    finer_areas = half_areas.reshape(-1, 2).sum(axis=1)
    is_rough = np.abs(finer_areas - areas) > 1e-15 * sizes
    for piece in np.flatnonzero(is_rough):
        halves = halved_edges[2 * piece : 2 * piece + 3]
        finer_areas[piece] = integrals(function, halves, count).sum()
    return finer_areas


def by_gauss(quantity: str, function: Function, edges: Array, count: int) -> MethodValue:
    """Return a quantity by Gauss's rule on each piece, and roots looked for at as many steps."""
    if quantity[0] == "T":
        return largest_and_smallest(function, edges, count)
    radians = mp.radians if is_precise(edges) else math.radians
    area = integrals(function, edges, count).sum()
    if quantity[0] == "A":
        return radians(area)

    # the energy is largest and smallest where the torque crosses its mean
    mean = area / (edges[-1] - edges[0])

    def above(phi: Array, within: Array) -> Array:
        return function(phi, within) - mean

    crossings, _ = roots_inside(above, edges[:-1], edges[1:], count)
    cuts = merged(np.append(edges, crossings))
    excess = integrals(function, cuts, count) - mean * np.diff(cuts)
    energies = np.cumsum(excess)  # the last is that of the beginning
    return radians(energies.max() - energies.min())


def largest_and_smallest(function: Function, edges: Array, count: int) -> tuple[Precise, Precise]:
    """Return the largest and the smallest value, at the ends of the pieces or at a root of the derivative."""
    low = edges[:-1]
    high = edges[1:]
    step = mpf("1e-10") if is_precise(edges) else 1e-4

    def rise(phi: Array, within: Array) -> Array:
        return function(phi + step, within) - function(phi - step, within)

    tops, top_pieces = roots_inside(rise, low + 2 * step, high - 2 * step, count)
    middles = (low + high) / 2
    phi = np.concatenate((low, high, tops))
    within = np.concatenate((middles, middles, top_pieces))
    values = function(phi, within)
    return values.max(), values.min()


def by_fit(quantity: str, function: Function, edges: Array, count: int) -> MethodValue:
    """Return a quantity of the polynomial through so many values on each piece, at the zeros of Chebyshev's."""
    nodes = chebyshev.chebpts1(count)
    low = edges[:-1]
    high = edges[1:]
    values = _on(function, low, high, (1 + nodes) / 2)
    series = chebyshev.chebfit(nodes, values.T, count - 1)

    def fitted(phi: Array, within: Array) -> Array:
        piece = np.searchsorted(edges, within) - 1
        share = (2 * phi - low[piece] - high[piece]) / (high - low)[piece]
        return np.asarray(chebyshev.chebval(share, series[:, piece], tensor=False))

    return by_gauss(quantity, fitted, edges, count)


# without the corners


def equidistant(quantity: str, function: Function, edges: Array, count: int) -> MethodValue:
    """Return a quantity from so many equal divisions of each turn: by the trapezium rule, or the largest ordinates."""
    values = _divided(function, edges, count)
    step = 2 * math.pi / count
    if quantity[0] == "T":
        return values.max(), values.min()
    if quantity[0] == "A":
        return values.sum() * step
    above = values - values.mean()
    energies = np.cumsum(above + np.roll(above, -1)) / 2 * step
    return float(np.ptp(energies))


def by_simpson(quantity: str, function: Function, edges: Array, count: int) -> MethodValue:
    """Return a work or a swing of energy from so many equal divisions of each turn by Simpson's rule."""
    values = _divided(function, edges, count)
    step = 2 * math.pi / count
    even = values[::2]
    odd = values[1::2]
    works = (even + 4 * odd + np.roll(even, -1)) * step / 3
    if quantity[0] == "A":
        return works.sum()
    return float(np.ptp(np.cumsum(works - works.mean())))


def _divided(function: Function, edges: Array, count: int) -> Array:
    """Return values at equal divisions of the cycle, so many a turn."""
    divisions = round((edges[-1] - edges[0]) * count / 360)
    phi = np.arange(divisions) * (360 / count)
    return function(phi, phi)


def over_the_turn(quantity: str, function: Function, edges: Array, count: int) -> MethodValue:
    """Return a quantity by Gauss's rule with so many points on the whole cycle, as if it had no corner."""

    def smooth(phi: Array, within: Array) -> Array:
        return function(phi, phi)

    return by_gauss(quantity, smooth, edges[[0, -1]], count)


def by_quad(quantity: str, function: Function, edges: Array, _: int) -> MethodValue:
    """Return a work by scipy's quad over the cycle, without further options."""
    integrate = scipy_integrate()

    def at(phi: float) -> float:
        angle = np.array([phi])
        return float(function(angle, angle)[0])

    area, *_rest = integrate.quad(at, edges[0], edges[-1], full_output=1)
    return math.radians(area)


def scipy_integrate() -> Any:
    """Return scipy's integrators, or None where scipy is not installed."""
    try:
        from scipy import integrate
    except ImportError:
        return None
    return integrate
