"""Friction of a crosshead and of piston rings, after Redtenbacher 1862 (D) and with signs for every quadrant."""

import math

import numpy as np

from kurbel.crank_angle import CrankAngle
from kurbel.errors import NoSolutionError
from kurbel.numerics.lobatto import rule


def redtenbacher_loss(lam: float, friction: float) -> float:
    """Return ½ λ f, the share of the work lost at the crosshead by Redtenbacher's mean over the rod angle, D 7.

    >>> round(1 / redtenbacher_loss(1 / 6, 1 / 10))
    120
    """
    return lam * friction / 2


def redtenbacher_logarithm(lam: float, friction: float) -> float:
    """Return 1 − ln(1 + fλ)/(fλ), the same mean before D 6 breaks off the series of the logarithm; any f, λ ≥ 0."""
    product = friction * lam
    if product < 1e-2:  # the difference cancels: the series itself
        return math.fsum((-1) ** (n + 1) * product**n / (n + 1) for n in range(1, 12))
    return 1 - math.log1p(product) / product


def mean_friction_over_rod_angle(gamma: float, friction: float) -> float:
    """Return F_m/P, the mean of f sin β/(cos β + f sin β) over the rod angle β from 0 to γ (radians), D 5.

    The closed form f/(1+f²) [f − ln(cos γ + f sin γ)/γ] cancels for small γ; there a rule of 16 points is exact.

    >>> round(mean_friction_over_rod_angle(0.2, 0.1), 8)
    0.00993391
    """
    if gamma < 0.2:
        beta = gamma / 2 * (1 + rule(16).nodes)
        share = friction * np.sin(beta) / (np.cos(beta) + friction * np.sin(beta))
        return float(rule(16).weights @ share) / 2
    change = friction * math.sin(gamma) - 2 * math.sin(gamma / 2) ** 2
    logarithm = math.log1p(change) if -0.5 < change < 1 else math.log(math.cos(gamma) + friction * math.sin(gamma))
    return friction / (1 + friction * friction) * (friction - logarithm / gamma)


def holding_force(incline: float, friction: float, direction: float = 0.0) -> float:
    """Return P/Q that moves a body of weight Q up an inclined plane: (sin α + f cos α)/(cos β + f sin β), D 1.

    incline α and direction β of the force above the plane, in degrees; β = −α is a horizontal force (D 3), f < 0 gives
    the force that just keeps it from sliding down (D 2), zero at tan α = f (D 4).

    Raises NoSolutionError where no force moves it (D 5: horizontally, tan α ≥ 1/f).
    """
    alpha, beta = CrankAngle.of(float(incline)), CrankAngle.of(float(direction))
    below = beta.cos + friction * beta.sin
    if below <= 0:
        raise NoSolutionError(f"the body locks itself: no force at {direction:g} deg moves it up {incline:g} deg")
    return float((alpha.sin + friction * alpha.cos) / below)
