"""Fourier coefficients of a smooth periodic function, to the rounding of its values."""

from collections.abc import Callable

import numpy as np

from kurbel.arrays import Array, ComplexArray

_FEWEST, _MOST = 2**11, 2**18  # samples; more than are needed take the rounding of the values out of the mean


def coefficients(function: Callable[[Array], Array]) -> ComplexArray | None:
    """Return c_1, c_2, … (K,) of f(φ) = c_0 + 2 Re Σ c_n e^{inφ}, to the last that is more than rounding.

    function: maps angles (n,) in degrees to real values (n,), with a period of 360°. Where it is analytic, its mean at
    equal angles converges geometrically: samples are doubled until the orders above three quarters of those that they
    tell have died away. None where they never do: a pole stands within a hair of the real axis.

    >>> waves = coefficients(lambda degrees: 3 + np.cos(np.radians(degrees)) - 0.5 * np.sin(np.radians(2 * degrees)))
    >>> abs(waves).round(15)
    array([0.5 , 0.25])
    """
    count = _FEWEST
    while count <= _MOST:
        values = function(np.linspace(0.0, 360.0, count, endpoint=False))
        rounding = np.finfo(float).eps * np.abs(values).max()
        parts = (np.fft.rfft(values)[1:] / count).view(float)
        # cosines and sines by themselves: what is even has no sines
        found = np.where(np.abs(parts) > rounding, parts, 0.0).view(complex)
        if not found[3 * count // 8 :].any():
            return np.trim_zeros(found, "b")
        count *= 2
    return None
