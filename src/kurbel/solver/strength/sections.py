"""Stresses in a rectangular web and in a round pin from the forces and moments of the section, and their combination.

All functions are pointwise: numbers, arrays (n,) or jets, in N, N m and m, give stresses in Pa. They divide by one
length at a time: the product of three tiny ones would be zero.
"""

import math
from typing import Any

from kurbel.solver.shaft.statics import norm


def direct_stress(force: Any, thickness: float, width: float) -> Any:
    """Return σ = F/(t w) in Pa of a force along the web, of the sign of the force.

    force in N, thickness and width in m. Source: G, webs, "auf Druck".

    >>> round(direct_stress(157e3, 0.1, 0.2))
    7850000
    """
    return force / thickness / width


def rectangle_bending(moment: Any, depth: float, breadth: float) -> Any:
    """Return σ = 6M/(b h²) in Pa at the faces of a rectangle bent across its depth h.

    moment in N m; depth: h in m, the side in the plane of bending; breadth: b in m. Source: G, webs, "auf Biegung".

    >>> round(rectangle_bending(1000.0, depth=0.1, breadth=0.2))
    3000000
    """
    return 6 * moment / breadth / depth / depth


def face_torsion(moment: Any, depth: float, breadth: float) -> Any:
    """Return τ = (9/2) M/(b h²) in Pa at the middle of the two faces of a rectangle that stand h apart.

    moment in N m, depth and breadth in m: at the wide faces, where it is largest, h is the shorter side; at the narrow
    ones the longer one. Bach's rounded factor: de Saint-Venant's own is 4.81 for a square and 3 for a strip, 4.07 for
    sides of 1 and 2. Source: G, webs, "auf Drehung".
    """
    return 4.5 * moment / depth / depth / breadth


def round_bending(moment: Any, diameter: float) -> Any:
    """Return σ = 32 M/(π d³) in Pa at the surface of a round section; moment in N m, diameter in m (G, M_b/Z)."""
    return 32 / math.pi * moment / diameter / diameter / diameter


def round_torsion(moment: Any, diameter: float) -> Any:
    """Return τ = 16 M/(π d³) in Pa at the surface of a round section; moment in N m, diameter in m (G, M_d/Z_p)."""
    return 16 / math.pi * moment / diameter / diameter / diameter


def bach(sigma: Any, tau: Any, alpha: float) -> Any:
    """Return Bach's combined stress 0.35 σ + 0.65 √(σ² + 4 (α₀ τ)²) in Pa.

    sigma: normal stress in Pa, its magnitude counts; tau: shear stress in Pa; alpha: α₀ = k_b/(1.3 k_d), see
    `bach_factor`. Source: G, "Resultierende Beanspruchung nach Bach".

    >>> bach(100.0, 0.0, 1.0), bach(0.0, 100.0, 1.0)
    (100.0, 130.0)
    """
    size = abs(sigma)
    return 0.35 * size + 0.65 * norm(size, 2 * alpha * tau)


def bach_factor(allowable_bending: float | None, allowable_torsion: float | None) -> float:
    """Return α₀ = k_b/(1.3 k_d), or 1 where one of the allowable stresses in Pa is not known (G).

    With it a part under torsion alone is fully used just where τ reaches k_d.
    """
    if allowable_bending is None or allowable_torsion is None:
        return 1.0
    return allowable_bending / (1.3 * allowable_torsion)


def von_mises(sigma: Any, tau: Any) -> Any:
    """Return the equivalent stress √(σ² + 3 τ²) in Pa after von Mises.

    >>> von_mises(3.0, 0.0)
    3.0
    """
    return norm(sigma, math.sqrt(3) * tau)
