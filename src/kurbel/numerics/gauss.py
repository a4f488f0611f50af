"""Rules of Gauss-Legendre and of Lobatto for integrals over a piece."""

Rule = tuple[tuple[float, ...], tuple[float, ...]]
"""Nodes and weights on (−1, 1)."""

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

_HALF_LOBATTO_9 = (
    (0.36311746382617816, 0.34642851097304633),
    (0.6771862795107377, 0.2745387125001617),
    (0.8997579954114602, 0.16549536156080552),
    (1.0, 0.027777777777777776),
)

_HALF_LOBATTO_16 = (
    (0.10132627352194945, 0.20195830817822988),
    (0.2998304689007632, 0.1936900238252036),
    (0.48605942188713763, 0.17749191339170411),
    (0.6523887028824931, 0.1540269808071643),
    (0.7920082918618151, 0.1242553821325141),
    (0.8992005330934721, 0.0893936973259308),
    (0.969568046270218, 0.05085036100591991),
    (1.0, 0.008333333333333333),
)


def _whole(half: tuple[tuple[float, float], ...], middle: tuple[float, ...] = ()) -> Rule:
    """Return a rule by its positive half; middle: the weight of its node 0, where it has one."""
    nodes, weights = (tuple(column) for column in zip(*half, strict=True))
    centre = (0.0,) * len(middle)
    return (*(-node for node in reversed(nodes)), *centre, *nodes), (*reversed(weights), *middle, *weights)


GAUSS = _whole((*HALF_RULE, (1.0, 0.0)))
"""16 points of Gauss, and both ends with the weight 0."""
LOBATTO_16 = _whole(_HALF_LOBATTO_16)
LOBATTO_9 = _whole(_HALF_LOBATTO_9, (0.37151927437641724,))
"""Both ends included: exact for polynomials of degree 15."""
LOBATTO_4 = (-1.0, -0.4472135954999579, 0.4472135954999579, 1.0), (1 / 6, 5 / 6, 5 / 6, 1 / 6)
"""Both ends included: exact for polynomials of degree 5."""
