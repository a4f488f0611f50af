"""Roots of functions whose zeros are known: the search for a flywheel, at flat places and jumps."""

from __future__ import annotations

import math

import pytest

from kurbel.numerics.roots import rising_root


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
