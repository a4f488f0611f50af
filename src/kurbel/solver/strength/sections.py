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


def wide_face_torsion(moment: Any, thickness: float, width: float) -> Any:
    """Return τ = (9/2) M/(t² w) in Pa at the middle of the wide face, where it is largest; t < w.

    moment in N m, thickness and width in m. Bach's rounded factor: de Saint-Venant's own is 4.81 for a square and 3 for
    a strip, 4.07 for w = 2t. Source: G, webs, "auf Drehung".
    """
    return 4.5 * moment / thickness / thickness / width


def narrow_face_torsion(moment: Any, thickness: float, width: float) -> Any:
    """Return τ = (9/2) M/(t w²) in Pa at the middle of the narrow face: t/w of that at the wide one (Bach).

    moment in N m, thickness and width in m.
    """
    return 4.5 * moment / thickness / width / width


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
