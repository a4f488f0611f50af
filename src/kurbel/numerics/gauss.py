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

_HALF_LOBATTO_10 = (
    (0.16527895766638703, 0.32753976118389744),
    (0.4779249498104445, 0.2920426836796838),
    (0.738773865105505, 0.22488934206312644),
    (0.9195339081664589, 0.13330599085107012),
    (1.0, 0.022222222222222223),
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


def _whole(half: tuple[tuple[float, float], ...]) -> Rule:
    nodes, weights = (tuple(column) for column in zip(*half, strict=True))
    return (*(-node for node in reversed(nodes)), *nodes), (*reversed(weights), *weights)


GAUSS = _whole((*HALF_RULE, (1.0, 0.0)))
"""16 points of Gauss, and both ends with the weight 0."""
LOBATTO_16 = _whole(_HALF_LOBATTO_16)
LOBATTO_10 = _whole(_HALF_LOBATTO_10)
"""Both ends included: exact for polynomials of degree 17."""
LOBATTO_4 = (-1.0, -0.4472135954999579, 0.4472135954999579, 1.0), (1 / 6, 5 / 6, 5 / 6, 1 / 6)
"""Both ends included: exact for polynomials of degree 5."""
