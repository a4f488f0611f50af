"""Extremes and zeros between the nodes of a grid, of functions that are known in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kurbel.mechanisms import fan
from kurbel.numerics.gauss import LOBATTO_9
from kurbel.numerics.grid import Cuts, Grid
from kurbel.numerics.search import Evaluate, OnNodes, Polynomials, Sampled, extremes, zeros
from representative import case_of

GRID = Grid(np.arange(0.0, 361.0, 45.0), LOBATTO_9)


def counted(function: Evaluate, calls: list[int]) -> Evaluate:
    def evaluate(degrees: np.ndarray, within: np.ndarray) -> dict[str, Sampled]:
        calls.append(len(degrees))
        return function(degrees, within)

    return evaluate


def waves(degrees: np.ndarray, within: np.ndarray) -> dict[str, Sampled]:
    """sin(φ − 10°) and its product with e^cos φ."""
    phi = np.radians(degrees)
    sin, cos, growth = np.sin(phi - math.pi / 18), np.cos(phi - math.pi / 18), np.exp(np.cos(phi))
    return {"sine": Sampled(sin, cos), "grown": Sampled(sin * growth, (cos - sin * np.sin(phi)) * growth)}


def on_nodes(function: Evaluate) -> dict[str, OnNodes]:
    return {name: Polynomials(GRID, one.value) for name, one in function(GRID.degrees, GRID.within).items()}


def test_extremes_between_nodes_take_one_evaluation_or_two() -> None:
    calls: list[int] = []
    found = extremes(GRID, on_nodes(waves), counted(waves, calls))
    assert found["sine"].largest == pytest.approx((1.0, 100.0), rel=1e-15)
    assert found["sine"].smallest == pytest.approx((-1.0, 280.0), rel=1e-15)
    phi = math.radians(found["grown"].largest.degrees)
    assert math.cos(phi - math.pi / 18) == pytest.approx(math.sin(phi - math.pi / 18) * math.sin(phi), abs=1e-15)
    assert calls[0] == 4
    assert len(calls) <= 2


@pytest.mark.parametrize("rise", [20 * np.finfo(float).eps, 3e-13])
def test_of_two_ends_of_a_piece_that_are_alike_but_for_rounding_the_first_is_told(rise: float) -> None:
    """2x² − 1 over 135° … 180° with its end 20 units in the last place higher or as a solution may be, else zero."""

    def valley(degrees: np.ndarray, within: np.ndarray) -> dict[str, Sampled]:
        x, inside = (degrees - 157.5) / 22.5, (within > 135) & (within < 180)
        value = 2 * x * x - 1 + np.where(x == 1, rise, 0.0)
        return {"valley": Sampled(np.where(inside, value, 0.0), np.where(inside, 4 * x / np.radians(22.5), 0.0))}

    found = extremes(GRID, valley(GRID.degrees, GRID.within), valley)["valley"]
    assert found.largest == (1.0 + rise, 135.0)
    assert found.smallest == (-1.0, 157.5)


def test_of_equal_cylinders_the_first_has_the_extremes_of_the_speed_line() -> None:
    """Six at equal distances: all comes back every 60°, a speed that was solved for only about to its last digits."""
    flywheel = case_of("marine-diesel").flywheel
    for name in ("alpha_max", "alpha_min", "omega_max", "omega_min", "M_max", "M_min"):
        assert 0 <= flywheel[name].degrees < 60


def test_zeros_between_nodes_are_exact() -> None:
    assert zeros(GRID, on_nodes(waves), waves)["grown"] == pytest.approx([10.0, 190.0], rel=1e-15)


@pytest.mark.parametrize("steepness", [30.0, 3e3, 1e6])
def test_a_zero_of_what_no_polynomial_follows_is_found_in_its_bracket(steepness: float) -> None:
    """tanh a(φ − 100.3°) − 0.2, the other way round beside 280.3°."""

    def steps(degrees: np.ndarray, within: np.ndarray) -> dict[str, Sampled]:
        side = np.where(within < 180, 1.0, -1.0)
        value = np.tanh(steepness * np.radians(degrees - np.where(side > 0, 100.3, 280.3)))
        return {"step": Sampled(side * (value - 0.2), side * steepness * (1 - value * value))}

    angle = math.degrees(math.atanh(0.2) / steepness)
    found = zeros(GRID, {"step": steps(GRID.degrees, GRID.within)["step"]}, steps)["step"]
    assert found == pytest.approx([100.3 + angle, 280.3 + angle], rel=1e-14)


def test_what_is_flat_toward_a_dead_centre_has_its_extreme_there() -> None:
    """R/L is all but that at which S″ = 0 at 180°: S is as large within rounding for 10⁻⁶ degrees beside it."""
    for cylinder in case_of("radial-three").cylinders:
        assert cylinder["S_max"].degrees == 180.0


@pytest.mark.parametrize("width", [1e-4, 0.02, 1.0, 30.0, 60.0])
def test_twelve_points_between_the_angles_of_a_fan_integrate_beside_a_pole(width: float) -> None:
    """1/(1 + (φ/w)²) has its poles at ±iw."""
    cuts = np.array([*fan(180.0, width), *np.arange(0.0, 361.0, 45.0)])
    grid = Cuts(np.unique(cuts)).grid(LOBATTO_9)
    exact = 2 * math.radians(width) * math.atan(180 / width)
    assert grid.integral(1 / (1 + ((grid.degrees - 180) / width) ** 2)) == pytest.approx(exact, rel=2e-14)
