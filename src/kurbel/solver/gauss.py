"""The Gauss-Legendre rule of 16 points, and rules for narrow pieces."""

from __future__ import annotations

HALF_RULE = (
    (0.09501250983763744, 0.1894506104550685),
    (0.2816035507792589, 0.1826034150449236),
    (0.45801677765722737, 0.16915651939500254),
    (0.6178762444026438, 0.14959598881657674),
    (0.755404408355003, 0.12462897125553388),
    (0.8656312023878318, 0.09515851168249279),
    (0.9445750230732326, 0.062253523938647894),
    (0.9894009349916499, 0.027152459411754096),
)
"""Nodes and weights on (−1, 1), the positive half; the rule is symmetric."""

NODES = tuple(-node for node, _ in reversed(HALF_RULE)) + tuple(node for node, _ in HALF_RULE)
WEIGHTS = tuple(weight for _, weight in reversed(HALF_RULE)) + tuple(weight for _, weight in HALF_RULE)
LOBATTO = (-1.0, -0.4472135954999579, 0.4472135954999579, 1.0), (1 / 6, 5 / 6, 5 / 6, 1 / 6)
SIMPSON = (-1.0, 0.0, 1.0), (1 / 3, 4 / 3, 1 / 3)
"""Nodes and weights for narrow pieces, both ends included: exact for polynomials of degree 5 and of degree 3."""
