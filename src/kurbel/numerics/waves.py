"""Sums of waves A_h cos hx …, as complex amplitudes: Re Σ A_h e^{ihx}, h whole numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kurbel.arrays import Array, ComplexArray

_PER_WAVE = 8
"""Samples at least to a period of the shortest wave, …"""
_STEPS = 4
"""… from which so many steps of Newton's method lead to the crest."""
_AT_ONCE = 1 << 22
"""Samples that are held at once."""


def crests(waves: Sequence[int], amplitudes: ComplexArray) -> tuple[Array, Array]:
    """Return the largest and the smallest value (m,) of sums with these numbers of waves (k,), amplitudes (m, k).

    >>> crests([1, 2], np.array([[1.0, 0.5j]]))[0].round(9)
    array([1.299038106])
    """
    count = 1 << (_PER_WAVE * max(waves) - 1).bit_length()
    rows = max(1, _AT_ONCE // count)
    parts = [_crests(waves, amplitudes[start : start + rows], count) for start in range(0, len(amplitudes), rows)]
    high, low = (np.concatenate(part) for part in zip(*parts))
    return high, low


def _crests(waves: Sequence[int], amplitudes: ComplexArray, count: int) -> tuple[Array, Array]:
    spectrum = np.zeros((len(amplitudes), count // 2 + 1), dtype=complex)
    spectrum[:, list(waves)] = amplitudes
    samples = np.fft.irfft(spectrum, count, axis=1) * (count / 2)
    found = []
    for sign in (1.0, -1.0):
        at = np.argmax(sign * samples, axis=1) * (2 * np.pi / count)
        best = (sign * samples).max(axis=1)
        for _ in range(_STEPS):
            _, slope, bend = _at(waves, amplitudes, at)
            step = -slope / np.where(bend * sign < 0, bend, -np.inf * sign)
            at = at + np.clip(step, -np.pi / count, np.pi / count)
        found.append(sign * np.maximum(best, sign * _at(waves, amplitudes, at)[0]))
    return found[0], found[1]


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
