"""Sums of waves A_h cos hx …, as complex amplitudes: Re Σ A_h e^{ihx}, h whole numbers."""

from collections.abc import Sequence

import numpy as np

from kurbel.arrays import Array, ComplexArray, Indices

_PER_WAVE = 10
"""Samples at least to a period of the shortest wave, …"""
_STEPS = 3
"""… from which so many steps of Newton's method lead to a crest."""
_AT_ONCE = 1 << 16
"""Samples that are held at once."""


def crests(waves: Sequence[int], amplitudes: ComplexArray) -> tuple[Array, Array]:
    """Return the largest and the smallest value (m,) of sums with these numbers of waves (k,), amplitudes (m, k).

    >>> crests([1, 2], np.array([[1.0, 0.5j]]))[0].round(8)
    array([1.29903811])
    """
    count = 2 * (_PER_WAVE // 2) * max(waves)
    rows, step = max(1, _AT_ONCE // count), 2 * np.pi / count
    # above the sample next to it a crest lies by no more than the largest bend makes over half a step
    above = np.abs(amplitudes) @ np.square(np.array(waves, dtype=float)) * step**2 / 8
    found: list[list[Indices]] = [[], []]
    for start in range(0, len(amplitudes), rows):
        part = slice(start, start + rows)
        spectrum = np.zeros((len(amplitudes[part]), count // 2 + 1), dtype=complex)
        spectrum[:, list(waves)] = amplitudes[part] * (count / 2)
        samples = np.fft.irfft(spectrum, count, axis=1)
        found[0].append(_near(samples, above[part]) + start * count)
        found[1].append(_near(-samples, above[part]) + start * count)
    highest, lowest = (np.divmod(np.concatenate(places), count) for places in found)
    return _largest(waves, amplitudes, *highest, step), -_largest(waves, -amplitudes, *lowest, step)


def _near(samples: Array, above: Array) -> Indices:
    """Return the places in the raveled samples (m, n) that may stand beside the largest crests of their rows.

    Of two crests that are all but equal, the samples do not tell which is the larger one.
    """
    count, rows, top = samples.shape[1], np.arange(len(samples)), samples.argmax(axis=1)
    near = samples >= (samples[rows, top] - above)[:, None]
    for beside in (-1, 1):  # two crests do not stand so close
        near[rows, (top + beside) % count] = False
    return np.flatnonzero(near)


def _largest(waves: Sequence[int], amplitudes: ComplexArray, rows: Indices, places: Indices, step: float) -> Array:
    """Return the largest values (m,): those of the crests near these places in these rows (n,)."""
    best = np.full(len(amplitudes), -np.inf)
    np.maximum.at(best, rows, _crest(waves, amplitudes[rows], np.asarray(places * step, dtype=float), step))
    return best


def _crest(waves: Sequence[int], amplitudes: ComplexArray, at: Array, step: float) -> Array:
    """Return the crests (m,) near these places (m,)."""
    best = np.full(len(at), -np.inf)
    for _ in range(_STEPS):
        value, slope, bend = _at(waves, amplitudes, at)
        best = np.maximum(best, value)
        at = at + np.clip(slope / np.where(bend < 0, -bend, np.inf), -step / 2, step / 2)
    return np.asarray(np.maximum(best, _at(waves, amplitudes, at)[0]))


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
