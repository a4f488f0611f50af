"""Numerical methods that know no crank: jets, grids of smooth pieces, roots, extremes, collocation."""
