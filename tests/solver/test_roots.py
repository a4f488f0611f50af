"""Roots of functions whose zeros are known: by slopes, and of the search for a flywheel at flat places and jumps."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kurbel.numerics.roots import rising_root, roots_by_slope


@pytest.mark.parametrize("zero", [0.01, 0.9, 1.5, 200.0])
def test_a_zero_is_found(zero: float) -> None:
    assert rising_root(lambda x: 1 - zero / x, 1.0) == pytest.approx(zero, rel=2e-9)


def test_a_function_that_is_flat_where_trials_fall_is_sought_on() -> None:
    """The difference of two equal values once was a divisor."""
    trials: list[float] = []

    def flat_below(x: float) -> float:
        trials.append(x)
        return -0.05 if x < 0.69 else 3 * (x - 0.7)

    assert rising_root(flat_below, 1.0) == pytest.approx(0.7, rel=1e-8)
    assert sum(x < 0.69 for x in trials) >= 2


def test_at_a_jump_there_is_no_zero_and_the_search_ends_soon() -> None:
    """A machine that stalls below some flywheel has no δ between: each trial there takes seconds."""
    trials: list[float] = []

    def jumping(x: float) -> float:
        trials.append(x)
        return 2.4 + x / 1000 if x > 0.33 else -1.0

    assert rising_root(jumping, 1.0) is None
    assert len(trials) <= 8


def test_what_is_infinite_on_one_side_is_sought_on_the_other() -> None:
    assert rising_root(lambda x: math.inf if x > 0.9 else x - 0.5, 1.0) == pytest.approx(0.5, rel=1e-8)


@pytest.mark.parametrize("turn", [1, -1])
def test_roots_by_slope_of_many_functions_at_once(turn: int) -> None:
    """A sine, a cubic with a zero of third order, and a kink from which Newton's steps lead out of the bracket."""
    kink = np.array([False, False, True])

    def function(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        flat = np.array([0.0, 0.3, 0.0])
        value = np.where(kink, np.cbrt(x - 0.7), np.array([np.sin(x[0]), (x[1] - flat[1]) ** 3, 0.0]))
        slope = np.where(kink, 1 / (3 * value**2 + 1e-300), np.array([np.cos(x[0]), 3 * (x[1] - 0.3) ** 2, 1.0]))
        return turn * value, turn * slope

    low, high = np.array([3.0, 0.0, 0.2]), np.array([3.5, 1.0, 1.3])
    found = roots_by_slope(function, low, high, function(low)[0], function(high)[0])
    assert found[0] == pytest.approx(math.pi, abs=1e-14)
    assert found[1] == pytest.approx(0.3, abs=1e-5)
    assert found[2] == pytest.approx(0.7, abs=1e-14)
