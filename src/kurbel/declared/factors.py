"""The quantities of `kurbel table`: the rows of Zusammenstellung 112."""

from kurbel.quantity import PHI, Quantity, by_id

__all__ = ["FACTORS", "PHI"]

FACTORS = by_id(
    Quantity("acceleration_factor", "cos φ + R/L cos 2φ", "ratio", "b over v²/R"),
    Quantity("velocity_factor", "sin(φ+ψ)/cos ψ", "ratio", "c over v, and T over P"),
    Quantity("displacement_factor", "x/R", "ratio", "x over R"),
    Quantity("psi", "ψ", "angle", "Angle between connecting rod and stroke line"),
    Quantity("rod_force_factor", "S/P", "ratio", "Rod force over piston force, 1/cos ψ (R 300)"),
    Quantity("guide_force_factor", "N/P", "ratio", "Guide force over piston force, tan ψ (R 301)"),
    Quantity("radial_force_factor", "D/P", "ratio", "Radial over piston force, cos(φ+ψ)/cos ψ (R 302)"),
)
"""Rows of Zusammenstellung 112, by id."""
