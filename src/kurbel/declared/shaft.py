"""Columns of the tables of `kurbel stress`: the stresses at one place of a crankshaft."""

from kurbel.quantity import Quantity, by_id

STRESSES = by_id(
    Quantity("compression", "σ_c", "stress", "Compression of a web by the force along it, negative where it is pulled"),
    Quantity("bending_in_plane", "σ_b1", "stress", "Bending in the plane of the throw"),
    Quantity("bending_out_of_plane", "σ_b2", "stress", "Bending square to the plane of the throw"),
    Quantity("torsion", "τ", "stress", "Torsion"),
    Quantity("combined", "σ_res", "stress", "Combined stress 0.35 σ + 0.65 √(σ² + 4(α₀τ)²) (Bach)"),
    Quantity("von_mises", "σ_v", "stress", "Equivalent stress √(σ² + 3τ²) (von Mises)"),
)
"""Stresses at one place of a crankshaft, by id."""
