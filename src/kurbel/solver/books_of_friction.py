"""Means of the crosshead's friction by which the books replace its integral (D 5–D 7)."""

import numpy as np

from kurbel.arrays import Array, Number


def mean_by_logarithm(lam: Number, f: Number) -> Number:
    """Return Redtenbacher's mean of the friction over the piston force with cos β ≈ 1, sin β ≈ β: 1 − ln(1 + λf)/(λf).

    >>> f"{mean_by_logarithm(1 / 6, 0.1):.4%}"
    '0.8242%'
    """
    product = np.asarray(lam * f, dtype=float)
    divisor = np.where(product == 0, 1.0, product)
    return _float_or_array(1 - np.where(product == 0, 1.0, np.log1p(divisor) / divisor))


def mean_by_integral(lam: Number, f: Number) -> Number:
    """Return the mean of f sin β/(cos β + f sin β) over the rod angle β from 0 to λ (D 5).

    (f/(λ (1 + f²))) (f λ − ln(cos λ + f sin λ)).

    >>> f"{mean_by_integral(1 / 6, 0.1):.4%}"
    '0.8280%'
    """
    widest = np.asarray(lam, dtype=float)
    divisor = np.where(widest == 0, 1.0, widest)
    # cos β − 1 without cancellation
    lost = np.log1p(f * np.sin(widest) - 2 * np.sin(widest / 2) ** 2)
    return _float_or_array(f * (f * widest - lost) / (divisor * (1 + f * f)))


def _float_or_array(values: Array) -> Number:
    if np.ndim(values) != 0:
        return values
    return float(values)
