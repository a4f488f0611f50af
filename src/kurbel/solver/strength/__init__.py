"""Strength of a crank throw between two bearings: statics, stresses, and the search over the whole cycle (G)."""
