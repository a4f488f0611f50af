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


# what the first-order formulas miss, without the cancellation of a difference; 1 − cos ψ = λ² sin²φ/(1 + cos ψ)


def displacement_error(sin: N, cos_psi: N, lam: N) -> N:
    """Return (x_0 − x)/R = −λ³ sin⁴φ/(2 (1 + cos ψ)²)."""
    share = sin * sin / (1 + cos_psi)
    return -lam * lam * lam * share * share / 2


def velocity_error(sin: N, cos: N, cos_psi: N, lam: N) -> N:
    """Return (c_0 − c)/v = −λ³ sin³φ cos φ/(cos ψ (1 + cos ψ))."""
    return -lam * lam * lam * sin * sin * sin * cos / (cos_psi * (1 + cos_psi))


def acceleration_error(sin: N, cos: N, cos_psi: N, lam: N) -> N:
    """Return (b_0 − b) R/v² = −λ³ sin²φ [cos 2φ/(cos ψ (1 + cos ψ)) + cos²φ/cos³ψ]."""
    cos_2_phi = cos * cos - sin * sin
    of_swing = cos_2_phi / (cos_psi * (1 + cos_psi))
    of_bend = cos * cos / (cos_psi * cos_psi * cos_psi)
    return -lam * lam * lam * sin * sin * (of_swing + of_bend)
