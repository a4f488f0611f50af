"""Extremes of sums of waves, Re Σ A_h e^{ihx}, h whole numbers."""

from collections.abc import Sequence

import numpy as np

from kurbel.arrays import Array, ComplexArray

_PER_WAVE = 10
"""Least samples per period of the shortest wave, …"""
_STEPS = 3
"""… from which so many steps of Newton's method lead to a crest."""
_AT_ONCE = 1 << 16
"""Samples in memory at once."""


def crests(waves: Sequence[int], amplitudes: ComplexArray) -> tuple[Array, Array]:
    """Return the largest and the smallest value (m,) of sums with these numbers of waves (k,), amplitudes (m, k).

    >>> crests([1, 2], np.array([[1.0, 0.5j]]))[0].round(8)
    array([1.29903811])
    """
    count = 2 * (_PER_WAVE // 2) * max(waves)
    found, rows = np.empty((2, len(amplitudes))), max(1, _AT_ONCE // count)
    for start in range(0, len(amplitudes), rows):
        part = slice(start, start + rows)
        spectrum = np.zeros((len(amplitudes[part]), count // 2 + 1), dtype=complex)
        spectrum[:, list(waves)] = amplitudes[part] * (count / 2)
        samples = np.fft.irfft(spectrum, count, axis=1)
        found[:, part] = [sign * _highest(np.array(waves), sign * amplitudes[part], sign * samples) for sign in (1, -1)]
    return found[0], found[1]


def _highest(waves: Array, amplitudes: ComplexArray, samples: Array) -> Array:
    """Return the largest value (m,) near the highest of equally spaced samples (m, n)."""
    step = 2 * np.pi / samples.shape[1]
    # a crest is above the sample next to it by no more than the largest curvature makes over half a step
    above = np.abs(amplitudes) @ waves.astype(float) ** 2 * step**2 / 8
    high = (samples >= (samples.max(axis=1) - above)[:, None]) & (samples > np.roll(samples, 1, axis=1))
    row, place = np.nonzero(high & (samples >= np.roll(samples, -1, axis=1)))
    at, best = place * step, samples.max(axis=1)
    for _ in range(_STEPS + 1):
        terms = amplitudes[row] * np.exp(1j * np.multiply.outer(at, waves))
        slope, bend = -(terms.imag @ waves), -(terms.real @ waves**2)
        np.maximum.at(best, row, terms.real.sum(axis=1))
        at = at + np.clip(slope / np.where(bend < 0, -bend, np.inf), -step / 2, step / 2)
    return np.asarray(best)
