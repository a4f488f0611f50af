"""Polynomials on the pieces of a grid against the functions they stand for: values, slopes, integrals."""

from __future__ import annotations

import numpy as np
import pytest

from kurbel.numerics.grid import Cuts, Grid
from kurbel.numerics.piecewise import Piecewise

BREAKS = np.array([0.0, 20.0, 60.0, 61.5, 100.0, 140.0, 180.0, 225.0, 270.0, 315.0, 360.0])
ANGLES = np.linspace(0.0, 360.0, 777)


def wave(degrees: np.ndarray) -> np.ndarray:
    phi = np.radians(degrees)
    return np.sin(phi) + 0.3 * np.cos(2 * phi)


def test_values_slopes_and_integrals_of_a_wave() -> None:
    grid = Grid(BREAKS)
    line = Piecewise(grid, wave(grid.degrees))
    phi, found = np.radians(ANGLES), line.at(ANGLES, ANGLES)
    assert found.value == pytest.approx(wave(ANGLES), abs=4e-15)
    assert found.slope == pytest.approx(np.cos(phi) - 0.6 * np.sin(2 * phi), abs=1e-12)
    assert line.integral_to(ANGLES) == pytest.approx(1 - np.cos(phi) + 0.15 * np.sin(2 * phi), abs=2e-15)
    assert line.integral_to(np.array([0.0]))[0] == 0


def test_both_sides_of_a_jump() -> None:
    grid = Grid(np.array([0.0, 120.0, 360.0]))
    line = Piecewise(grid, np.where(grid.within < 120, 5.0, -2.0))
    at = np.array([120.0, 120.0])
    assert line.at(at, np.array([60.0, 240.0])).value == pytest.approx([5.0, -2.0], rel=1e-15)
    assert line.integral_to(np.array([120.0, 360.0])) == pytest.approx(np.radians([600.0, 120.0]), rel=1e-15)


def test_an_integral_keeps_what_large_ones_before_it_leave_when_they_cancel() -> None:
    grid = Grid(np.array([0.0, 90.0, 180.0, 270.0, 360.0]))
    line = Piecewise(grid, np.repeat([[1e20], [1.0], [-1e20], [0.0]], len(grid.nodes), axis=1))
    assert line.integral_to(np.array([270.0]))[0] == pytest.approx(np.pi / 2, rel=1e-15)


def test_between_many_jumps_four_points_a_piece_integrate_as_exactly() -> None:
    """1/(1 + (φ/w)²) beside poles at ±iw, on smooth pieces that widen from φ = 0 on as 1, 3, 9 w."""
    half_width = 0.5
    fan = half_width * 3.0 ** np.arange(6)
    smooth = np.concatenate(([0.0], fan, [180.0], 360 - fan[::-1], [360.0]))
    jumps = np.linspace(0.0, 360.0, 401)

    def bump(degrees: np.ndarray) -> np.ndarray:
        x = np.minimum(degrees, 360 - degrees) / half_width
        return 1 / (1 + x**2)

    exact = 2 * np.radians(half_width) * np.arctan(180 / half_width)
    grids = Cuts(smooth, jumps).grid(), Cuts(smooth).grid()
    assert [len(grid.nodes) for grid in grids] == [4, 18]
    for grid in grids:
        assert grid.integral(bump(grid.degrees)) == pytest.approx(exact, rel=1e-12)
