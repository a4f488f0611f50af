"""The slider-crank in units of its crank radius: one set of formulas for every kind of number.

Arguments of all functions: `sin`, `cos` of the crank angle; `kappa` = cos ψ of the rod there (`cos_rod_angle`);
`lam` = R/L; `rho` = 1 − λ² (from R and L as (L − R)(L + R)/L², so that it keeps its digits near λ = 1). They may be
floats, arrays of any shape or mpmath numbers; only + − × ÷ and the square root are used. Results have the shape of
`sin`.

The textbook formulas subtract nearly equal terms near the dead centres; here every sum that can be has terms of one
sign. Measured against mpmath for λ from 1e-12 to 1 − 1e-12: x and c within 8 ulp, also near their zeros.
"""

import math
from typing import Any

from kurbel.numerics.arithmetic import arcsin, bearing, every, sqrt, where
from kurbel.numerics.arithmetic import sin as sine
from kurbel.numerics.extreme import Extreme


def cos_rod_angle(sin: Any, cos: Any, rho: Any) -> Any:
    """Return cos ψ = √(cos²φ + ρ sin²φ), which is √(1 − λ² sin²φ) without its cancellation."""
    return sqrt(cos * cos + rho * (sin * sin))


def rod_slope(cos: Any, cos_psi: Any, lam: Any) -> Any:
    """Return dψ/dφ = λ cos φ/cos ψ, of a straight or an offset slider-crank."""
    return lam * cos / cos_psi


def rod_curvature(sin: Any, sin_psi: Any, cos_psi: Any, slope: Any, lam: Any) -> Any:
    """Return d²ψ/dφ² = (dψ/dφ)² tan ψ − λ sin φ/cos ψ."""
    return slope * slope * (sin_psi / cos_psi) - lam * sin / cos_psi


def displacement_factor(sin: Any, cos: Any, kappa: Any, lam: Any, rho: Any) -> Any:
    """Return x/R = (1 − cos φ) + (1 − cos ψ)/λ, R 285, as a sum of positive terms.

    >>> displacement_factor(1.0, 0.0, 1.0, 0.0, 1.0)
    1.0
    """
    square = sin * sin
    near = 1 + abs(cos)
    # 1 − cos φ = sin²φ/(1 + cos φ) on the inner half, where the difference would cancel
    versine = where(cos >= 0, square / near, near)
    return versine + lam * square / (1 + kappa)


def _lead(cos: Any, kappa: Any, lam: Any, rho: Any) -> Any:
    """Return cos ψ + λ cos φ; for cos φ < 0 as ρ/(cos ψ − λ cos φ), since cos²ψ − λ² cos²φ = ρ."""
    total = kappa + lam * abs(cos)
    return where(cos >= 0, total, rho / total)


def velocity_factor(sin: Any, cos: Any, kappa: Any, lam: Any, rho: Any) -> Any:
    """Return c/v = T/P = sin(φ + ψ)/cos ψ, R 288, 303.

    >>> velocity_factor(1.0, 0.0, math.sqrt(0.9375), 0.25, 0.9375)
    1.0
    """
    return sin * _lead(cos, kappa, lam, rho) / kappa


def acceleration_factor(sin: Any, cos: Any, kappa: Any, lam: Any, rho: Any) -> Any:
    """Return b R/v² = cos(φ + ψ)/cos ψ + λ cos²φ/cos³ψ: exact, where R 291 is its first-order form.

    Written as cos φ (cos ψ + λ cos φ)/cos ψ − λ ρ sin²φ/cos³ψ, whose two terms have one sign for cos φ < 0.

    >>> acceleration_factor(0.0, 1.0, 1.0, 0.25, 0.9375)
    1.25
    """
    return cos * _lead(cos, kappa, lam, rho) / kappa - lam * rho * (sin * sin) / (kappa * kappa * kappa)


def radial_factor(sin: Any, cos: Any, kappa: Any, lam: Any, rho: Any) -> Any:
    """Return D/P = cos(φ + ψ)/cos ψ, R 302."""
    return cos - lam * (sin * sin) / kappa


def first_order_displacement(sin: Any, cos: Any, lam: Any) -> Any:
    """Return the book's x/R ≈ 1 − cos φ + ½ λ sin²φ, R 286, B 22.

    B example 31, λ = 1/5 at 45°:

    >>> round(first_order_displacement(math.sqrt(0.5), math.sqrt(0.5), 0.2), 3)
    0.343
    """
    return 1 - cos + lam * (sin * sin) / 2


def first_order_velocity(sin: Any, cos: Any, lam: Any) -> Any:
    """Return the book's c/v ≈ sin φ + ½ λ sin 2φ, B 25."""
    return sin + lam * sin * cos


def first_order_acceleration(sin: Any, cos: Any, lam: Any) -> Any:
    """Return the book's b R/v² ≈ cos φ + λ cos 2φ, R 291, B 26.

    Zusammenstellung 112, L/R = 5 at 60°:

    >>> round(first_order_acceleration(math.sqrt(0.75), 0.5, 0.2), 3)
    0.4
    """
    return cos + lam * (cos * cos - sin * sin)


def velocity_peak(lam: Any, rho: Any) -> Extreme:
    """Return c_max/v and its crank angle in degrees, where the exact acceleration is zero.

    With q = sin²ψ the condition is q³ − q² − q + λ² = 0, and cos φ = λ sin²φ cos ψ, c_max = v sin φ (1 + sin²ψ).
    The one root in (0, 1) is taken in trigonometric form, free of cancellation from λ = 1e-300 to 1 − 2⁻⁵³.
    R has about 1.02 v at λ = 1/5:

    >>> round(velocity_peak(0.2, 0.96).value, 7)
    1.0198331
    """
    square = lam * lam
    angle = (2 / 3) * arcsin(sqrt(27 * rho / 32))
    half = sine(angle / 2)
    cos2_psi = (4 / 3) * (half * half) + (2 / math.sqrt(3)) * sine(angle)
    eta = arcsin(27 * square / (math.sqrt(27) * sqrt(5 + 27 * square) + sqrt(135 * rho))) / 3
    sin2_psi = (8 / 3) * sine(eta) * sine((2 / 3) * math.asin(math.sqrt(27 / 32)) + math.pi / 3 - eta)
    tiny = square <= 1e-290  # λ² underflows: the peak is at 90°
    sin2_phi = where(tiny, 1.0, sin2_psi / where(tiny, 1.0, square))
    sin2_phi = where(sin2_phi > 1.0, 1.0, sin2_phi)
    sin = sqrt(sin2_phi)
    return Extreme(sin * (1 + sin2_psi), bearing(sin, lam * sin2_phi * sqrt(cos2_psi)))


_STEPS = 4
"""Newton's steps to the last digit: wherever the root may be, the slope of its equation is between 3 and 3.8."""


def acceleration_dip(lam: Any, rho: Any) -> Extreme | None:
    """Return the smallest b R/v² inside the stroke and its angle in degrees; None where the outer dead centre has it.

    It exists for λ > (√21 − 3)/6 = 0.263763 (the first-order formula says 1/4). With y = −λ cos φ/cos ψ the condition
    is 3y(1 − y)(1 + y)² = ρ, which has exactly one root in (0, λ). Of an array, what has no dip is nan.
    """
    none = 3 * lam * (1 + lam) <= 1
    if every(none):
        return None
    # what has no dip is searched as if it had one
    lam, rho = where(none, 0.5, lam), where(none, 0.75, rho)
    y = rho / 3
    for _ in range(_STEPS):
        y = y - (3 * y * (1 - y) * (1 + y) ** 2 - rho) / (3 * (1 + y) * (1 + y - 4 * y * y))
    kappa = sqrt(rho / ((1 - y) * (1 + y)))
    cos = -y * kappa / lam
    sin = sqrt((1 - cos) * (1 + cos))
    return Extreme(where(none, math.nan, acceleration_factor(sin, cos, kappa, lam, rho)), bearing(sin, cos))
