"""Smooth pieces: what is no polynomial is halved, and what is noise does not take the memory of the machine."""

from __future__ import annotations

import numpy as np
import pytest

from kurbel.numerics.pieces import Angles, Pieces, refined

NOWHERE = Angles(np.zeros(0, dtype=np.intp), np.zeros(0))


@pytest.mark.parametrize("noise", [1e-6, 1e-10])
def test_halving_of_noise_ends(noise: float) -> None:
    """Speed lines under loads as stiff as a grid have such accelerations: they were halved into millions of pieces."""
    random = np.random.default_rng(5)

    def sampled(pieces: Pieces) -> np.ndarray:
        return (np.sin(np.radians(pieces.degrees)) + noise * random.standard_normal(pieces.degrees.shape))[None]

    pieces, values = refined(Pieces.between(NOWHERE, 1, 360.0), sampled)
    assert len(pieces.half) < 5000
    assert pieces.integral(np.abs(values[0]))[0] == pytest.approx(4.0, rel=10 * noise)


def test_machines_of_a_batch_are_halved_each_for_itself() -> None:
    """1/(k − cos φ) with k near 1 and far from it: 2π/√(k² − 1), and the pieces that one machine alone has."""
    steep = np.array([1.0001, 1.5, 3.0])

    def sampled(pieces: Pieces, k: np.ndarray) -> np.ndarray:
        versine = 2 * np.sin(np.radians(pieces.degrees) / 2) ** 2
        return (1 / (k[pieces.machine] - 1 + versine))[None]

    pieces, values = refined(Pieces.between(NOWHERE, 3, 360.0), lambda some: sampled(some, steep))
    assert pieces.integral(values[0]) == pytest.approx(2 * np.pi / np.sqrt(steep**2 - 1), rel=1e-12)
    for number, k in enumerate(steep):
        alone = refined(Pieces.between(NOWHERE, 1, 360.0), lambda some, k=k: sampled(some, np.array([k])))[0]
        assert (pieces.machine == number).sum() == len(alone.half)


def test_the_side_of_a_jump_is_named_by_any_angle_beyond_it() -> None:
    """Also where the piece ends before that angle, at the end of the cycle, and just after a jump if none is named."""
    pieces = Pieces.between(NOWHERE, 1, 360.0)
    steps = np.floor(pieces.middle / 90) + 0 * pieces.degrees
    angles, within = np.array([90.0, 90.0, 100.0, 100.0, 360.0]), np.array([1.0, 170.0, 1.0, 350.0, 300.0])
    machine = np.zeros(5, dtype=int)
    assert pieces.at(steps, machine, angles, within) == pytest.approx([0, 1, 1, 1, 3])
    assert pieces.at(steps, machine, angles) == pytest.approx([1, 1, 1, 1, 0])
