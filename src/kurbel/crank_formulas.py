"""How a connecting rod swings, and the first-order formulas of the books, for floats, arrays or mpmath numbers alike.

Arguments: `sin`, `cos` of the crank angle; `sin_psi`, `cos_psi` of the rod's; `lam` = R/L. Results have their shape.
"""

from kurbel.arrays import N


def rod_slope(cos: N, cos_psi: N, lam: N) -> N:
    """Return dψ/dφ = λ cos φ/cos ψ, of a straight or an offset slider-crank."""
    return lam * cos / cos_psi


def rod_curvature(sin: N, sin_psi: N, cos_psi: N, slope: N, lam: N) -> N:
    """Return d²ψ/dφ² = (dψ/dφ)² tan ψ − λ sin φ/cos ψ."""
    return slope * slope * (sin_psi / cos_psi) - lam * sin / cos_psi


def first_order_displacement(sin: N, cos: N, lam: N) -> N:
    """Return the book's x/R ≈ 1 − cos φ + ½ λ sin²φ, R 286, B 22.

    B example 31, λ = 1/5 at 45°:

    >>> round(first_order_displacement(0.5**0.5, 0.5**0.5, 0.2), 3)
    0.343
    """
    return 1 - cos + lam * (sin * sin) / 2


def first_order_velocity(sin: N, cos: N, lam: N) -> N:
    """Return the book's c/v ≈ sin φ + ½ λ sin 2φ, B 25."""
    return sin + lam * sin * cos


def first_order_acceleration(sin: N, cos: N, lam: N) -> N:
    """Return the book's b R/v² ≈ cos φ + λ cos 2φ, R 291, B 26.

    Zusammenstellung 112, L/R = 5 at 60°:

    >>> round(first_order_acceleration(0.75**0.5, 0.5, 0.2), 3)
    0.4
    """
    return cos + lam * (cos * cos - sin * sin)
