"""Natural vibrations of chains: against eigenvalues with 60 digits, and by the laws of Holzer's table."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from kurbel.solver.chain import Chain, Modes, holzer_at
from representative import few

ENDS = {"": 0, "before": 1, "after": 1, "both": 2}
"""Fixed ends."""


def undamped(inertias: list[float], stiffnesses: list[float], ground: str = "") -> Chain:
    nothing = np.zeros(len(stiffnesses))
    return Chain(np.array(inertias), np.array(stiffnesses), nothing, np.zeros(len(inertias)), nothing, ground)


def at_random(count: int, spread: float, ground: str, seed: int) -> Chain:
    """A chain whose masses and stiffnesses differ by up to 10^(2 spread)."""
    draw = np.random.default_rng(seed)
    inertias = 10 ** draw.uniform(-spread, spread, count) * draw.uniform(0.5, 2, count)
    stiffnesses = 10 ** draw.uniform(3 - spread, 3 + spread, count - 1 + ENDS[ground])
    return undamped(inertias.tolist(), stiffnesses.tolist(), ground)


def eigenvalues(chain: Chain) -> list[mpmath.mpf]:
    """√ of the eigenvalues of J^{-1/2} K J^{-1/2}, with 60 digits."""
    count = len(chain.inertias)
    with mpmath.workdps(60):
        matrix = mpmath.matrix(count, count)
        for row, stiffness in zip(chain.twists, chain.stiffnesses):
            ends = np.flatnonzero(row).tolist()
            for i in ends:
                for j in ends:
                    matrix[i, j] += int(row[i] * row[j]) * mpmath.mpf(float(stiffness))
        roots = [mpmath.sqrt(float(inertia)) for inertia in chain.inertias]
        for i in range(count):
            for j in range(count):
                matrix[i, j] /= roots[i] * roots[j]
        found = sorted(mpmath.eigsy(matrix, eigvals_only=True))
        return [mpmath.sqrt(one) if one > 1e-45 else mpmath.mpf(0) for one in found]


CHAINS = [
    *((count, spread, ground) for count in (2, 8) for spread in (0, 5) for ground in ENDS),
    *(pytest.param(n, s, g, marks=pytest.mark.slow) for n in (3, 20) for s in (0, 2, 5) for g in ENDS),
    pytest.param(30, 5, "", marks=pytest.mark.slow),
]


@pytest.mark.parametrize(("count", "spread", "ground"), CHAINS)
def test_frequencies_with_all_their_digits(count: int, spread: float, ground: str) -> None:
    """Also where masses differ by 10^10, at which numpy.linalg.eigh has no digit of the lowest mode left."""
    for seed in range(3):
        chain = at_random(count, spread, ground, seed)
        found, exact = Modes(chain).omegas, eigenvalues(chain)
        assert len(found) == count
        for one, other in zip(found, exact):
            assert one == (0 if other == 0 else pytest.approx(float(other), rel=1e-14))
        assert (found[0] == 0) == (not ground)


HELD = [(*size, ground) for size in ((2, 0), (9, 1), (30, 0), (30, 3)) for ground in ENDS]


@pytest.mark.parametrize(("count", "spread", "ground"), few(HELD, [one for one in HELD if one[:2] != (30, 0)]))
def test_holzer_closes(count: int, spread: float, ground: str) -> None:
    chain = at_random(count, spread, ground, 7)
    modes = Modes(chain)
    for mode, omega in enumerate(modes.omegas):
        table = modes.holzer(mode)
        largest = np.abs(table.torques).max()
        assert table.residual <= 1e-12
        # J ω² Θ is what the torques before and behind a mass differ by; k ΔΘ is the torque
        left = chain.twists.T @ table.torques - omega**2 * chain.inertias * table.angles
        assert np.abs(left).max() <= 1e-12 * max(largest, 1e-300)
        twists = chain.twists @ table.angles
        assert twists == pytest.approx(table.torques / chain.stiffnesses, abs=1e-12 * np.abs(table.angles).max())
        if not ground and mode:
            momentum = chain.inertias * table.angles
            assert abs(momentum.sum()) <= 1e-13 * np.abs(momentum).sum()
        assert len(modes.nodes(mode)) == mode  # the law of the nodes, beside that at the ground


def test_a_mode_that_leaves_a_mass_at_rest() -> None:
    """Three equal masses: √(k/J) with the middle one still, √(3k/J); the node is the middle mass."""
    modes = Modes(undamped([2.0] * 3, [50.0] * 2))
    assert modes.omegas == pytest.approx([0, 5, 5 * math.sqrt(3)], rel=1e-15)
    assert modes.holzer(1).angles == pytest.approx([1, 0, -1], abs=1e-15)
    (node,) = modes.nodes(1)
    assert node[0] + node[1] == pytest.approx(1, abs=1e-12)


def test_equal_chains_in_closed_form() -> None:
    """2 √(k/J) sin(i π/2n), i = 0 … n − 1."""
    count = 25
    exact = [2 * math.sqrt(300.0 / 3) * math.sin(i * math.pi / (2 * count)) for i in range(count)]
    assert Modes(undamped([3.0] * count, [300.0] * (count - 1))).omegas == pytest.approx(exact, rel=1e-14)


def test_equal_chains_between_two_fixed_ends_in_closed_form() -> None:
    """2 √(k/J) sin(i π/(2n + 2)), i = 1 … n."""
    count = 25
    exact = [2 * math.sqrt(300.0 / 3) * math.sin(i * math.pi / (2 * count + 2)) for i in range(1, count + 1)]
    assert Modes(undamped([3.0] * count, [300.0] * (count + 1), "both")).omegas == pytest.approx(exact, rel=1e-14)


@pytest.mark.parametrize("ground", ENDS)
def test_holzer_at_a_frequency(ground: str) -> None:
    """At a natural frequency the table of the mode, else what a torque on the last mass, or a moved end, would make."""
    chain = at_random(5, 0, ground, 11)
    modes = Modes(chain)
    natural, mode = holzer_at(chain, modes.omegas[2]), modes.holzer(2)
    assert natural.angles == pytest.approx(mode.angles, rel=1e-9)
    assert natural.torques == pytest.approx(mode.torques, rel=1e-9, abs=1e-9 * np.abs(mode.torques).max())

    omega = 0.7 * modes.omegas[1] + 3
    table = holzer_at(chain, omega)
    held = chain.held[1]
    matrix = chain.twists.T @ np.diag(chain.stiffnesses) @ chain.twists - np.diag(omega**2 * chain.inertias)
    sides = matrix @ table.angles
    assert sides[:-1] == pytest.approx(np.zeros(4), abs=1e-9 * np.abs(table.torques).max())
    acting = chain.stiffnesses[-1] * table.residual if held else -table.residual
    assert sides[-1] == pytest.approx(acting, rel=1e-9)
    assert table.angles[0] == 1
