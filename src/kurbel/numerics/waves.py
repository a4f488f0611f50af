"""Sums of waves A_h cos hx …, as complex amplitudes: Re Σ A_h e^{ihx}, h whole numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kurbel.arrays import Array, ComplexArray

_PER_WAVE = 8
"""Samples at least to a period of the shortest wave, …"""
_STEPS = 3
"""… from which so many steps of Newton's method lead to the crest."""
_AT_ONCE = 1 << 17
"""Samples that are held at once."""


def crests(waves: Sequence[int], amplitudes: ComplexArray) -> tuple[Array, Array]:
    """Return the largest and the smallest value (m,) of sums with these numbers of waves (k,), amplitudes (m, k).

    >>> crests([1, 2], np.array([[1.0, 0.5j]]))[0].round(8)
    array([1.29903811])
    """
    highest, lowest = _sampled(waves, amplitudes)
    return _crest(waves, amplitudes, highest, 1.0), _crest(waves, amplitudes, lowest, -1.0)


def _sampled(waves: Sequence[int], amplitudes: ComplexArray) -> tuple[Array, Array]:
    """Return where the largest and the smallest of equal samples stand, (m,) each."""
    count = 2 * (_PER_WAVE // 2) * max(waves)
    rows = max(1, _AT_ONCE // count)
    found = np.empty((2, len(amplitudes)))
    for start in range(0, len(amplitudes), rows):
        part = slice(start, start + rows)
        spectrum = np.zeros((len(amplitudes[part]), count // 2 + 1), dtype=complex)
        spectrum[:, list(waves)] = amplitudes[part]
        samples = np.fft.irfft(spectrum, count, axis=1)
        found[:, part] = samples.argmax(axis=1), samples.argmin(axis=1)
    return found[0] * (2 * np.pi / count), found[1] * (2 * np.pi / count)


def _crest(waves: Sequence[int], amplitudes: ComplexArray, at: Array, sign: float) -> Array:
    """Return the largest (sign 1) or the smallest (−1) value near these places (m,)."""
    reach = np.pi / (_PER_WAVE * max(waves))
    best = np.full(len(at), -np.inf)
    for _ in range(_STEPS):
        value, slope, bend = _at(waves, amplitudes, at)
        best = np.maximum(best, sign * value)
        step = -slope / np.where(bend * sign < 0, bend, -np.inf * sign)
        at = at + np.clip(step, -reach, reach)
    return np.asarray(sign * np.maximum(best, sign * _at(waves, amplitudes, at)[0]))


def _at(waves: Sequence[int], amplitudes: ComplexArray, at: Array) -> tuple[Array, Array, Array]:
    """Return the sums at one place each (m,), with their first two derivatives."""
    turn, power, reached = np.exp(1j * at), np.ones(len(at), dtype=complex), 0
    value, slope, bend = np.zeros_like(at), np.zeros_like(at), np.zeros_like(at)
    for wave, amplitude in zip(waves, amplitudes.T):
        power = power * (turn if wave == reached + 1 else turn ** (wave - reached))
        reached = wave
        term = amplitude * power
        value, slope, bend = value + term.real, slope - wave * term.imag, bend - wave * wave * term.real
    return value, slope, bend
