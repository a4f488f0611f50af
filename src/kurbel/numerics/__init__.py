"""Numerical methods that know no crank: smooth pieces, series, roots, extremes, collocation."""
