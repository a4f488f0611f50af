"""Periodic solutions by collocation, of equations that are solved by hand."""

import math
from typing import Any

import numpy as np
import pytest

from kurbel.numerics.collocation import Modal, periodic
from kurbel.numerics.pieces import Angles, Pieces


class Linear:
    """y′ = A y + b(φ), b of each unknown a function of φ in radians; by modes or all at once."""

    bounded: int | None = None

    def __init__(self, matrix: np.ndarray, driving: Any, by_modes: bool = False) -> None:
        self.matrix, self.driving = matrix, driving
        self.unknowns = len(matrix)
        self.noise = np.zeros(1)
        self.modal = Modal.of(matrix, np.ones(len(matrix))) if by_modes else None

    def known(self, pieces: Pieces) -> np.ndarray:
        phi = np.radians(pieces.degrees)
        middle = np.radians(pieces.middle)
        return np.stack([*self.driving(phi, middle), np.ones(phi.shape)])

    def rate(self, known: np.ndarray, y: np.ndarray, pieces: Pieces) -> Any:
        slope = np.broadcast_to(self.matrix[:, :, None, None], (*self.matrix.shape, *y.shape[1:]))
        return np.tensordot(self.matrix, y, 1) + known[:-1], slope


def cycle(*breaks: float) -> Pieces:
    return Pieces.between(Angles(np.zeros(len(breaks), dtype=np.intp), np.array(breaks)), 1, 360.0)


def error_of(equation: Linear, exact: Any, *breaks: float) -> float:
    """Largest error of a solution, over its largest value."""
    solution = periodic(equation, cycle(*breaks))
    assert not solution.failed[0]
    right = np.stack(exact(np.radians(solution.pieces.degrees)))
    return float(np.abs(solution.samples - right).max() / np.abs(right).max())


@pytest.mark.parametrize("k", [0.3, 5.0, 4e4, -0.3, -40.0])
def test_one_that_decays_or_grows(k: float) -> None:
    """y′ = −k y + cos φ has (k cos φ + sin φ)/(k² + 1)."""
    equation = Linear(np.array([[-k]]), lambda phi, _: [np.cos(phi)])
    right = lambda phi: [(k * np.cos(phi) + np.sin(phi)) / (k * k + 1)]  # noqa: E731
    assert error_of(equation, right) < 1e-13


@pytest.mark.parametrize("k", [1e-3, 2.0, 300.0])
def test_the_growth_of_a_disturbance(k: float) -> None:
    """It falls by e^{−2πk} in a turn, which has no logarithm of its own beyond k = 112."""
    equation = Linear(np.array([[-k]]), lambda phi, _: [np.cos(phi)])
    solution = periodic(equation, cycle(*range(360)))
    assert solution.growth[0] == pytest.approx(-2 * math.pi * k, rel=1e-9)


def jumping(k: float, phi: np.ndarray) -> np.ndarray:
    """y of y′ = −k y ± 1, + up to 180°: ±(1 − 2 e^{−kφ}/(1 + e^{−kπ}))/k."""
    is_second = phi > math.pi
    inside = np.where(is_second, phi - math.pi, phi)
    half = (1 - 2 * np.exp(-k * inside) / (1 + math.exp(-k * math.pi))) / k
    return np.where(is_second, -half, half)


@pytest.mark.parametrize("k", [1.0, 300.0])
def test_behind_a_jump(k: float) -> None:
    equation = Linear(
        np.array([[-k]]), lambda phi, middle: [np.where(middle > math.pi, -1.0, 1.0) + 0 * phi]
    )
    solution = periodic(equation, cycle(180.0))
    phi = np.radians(solution.pieces.degrees)
    phi = np.clip(phi, np.radians(solution.pieces.low), np.radians(solution.pieces.high))
    right = jumping(k, np.where(solution.pieces.middle > 180.0, np.maximum(phi, math.pi), phi))
    inner = slice(1, -1)
    assert solution.samples[0, inner] == pytest.approx(right[inner], abs=1e-12 / k)


@pytest.mark.parametrize("by_modes", [False, True])
@pytest.mark.parametrize("damping", [0.0, 0.01, 3.0])
def test_a_mass_on_a_spring(damping: float, by_modes: bool) -> None:
    """x″ + d x′ + ω² x = cos φ: Re e^{iφ}/(ω² − 1 + i d), by all unknowns together and mode by mode."""
    square = 7.3
    matrix = np.array([[0.0, 1.0], [-square, -damping]])
    equation = Linear(matrix, lambda phi, _: [0 * phi, np.cos(phi)], by_modes)
    amplitude = 1 / (square - 1 + 1j * damping)

    def right(phi: np.ndarray) -> list[np.ndarray]:
        wave = amplitude * np.exp(1j * phi)
        return [wave.real, (1j * wave).real]

    assert error_of(equation, right) < 1e-12


@pytest.mark.parametrize("by_modes", [False, True])
def test_what_an_equation_leaves_open_is_small(by_modes: bool) -> None:
    """x″ = cos φ − d (x′ − z′)…: of two masses that a spring joins the sum of the momenta may be anything."""
    matrix = np.array([[0.0, 1.0, -1.0], [-2.0, -0.5, 0.5], [2.0, 0.5, -0.5]])
    equation = Linear(matrix, lambda phi, _: [0 * phi, np.cos(phi), -np.cos(phi)], by_modes)
    solution = periodic(equation, cycle())
    assert not solution.failed[0]
    momentum = solution.samples[1] + solution.samples[2]
    assert np.abs(momentum).max() < 1e-7
    twist = solution.samples[0]
    # T = x − z with T″ + T′ + 4 T = 2 cos φ
    phi = np.radians(solution.pieces.degrees)
    assert twist == pytest.approx((2 * np.exp(1j * phi) / (3 + 1j)).real, abs=1e-12)


def test_noise_is_not_refined() -> None:
    equation = Linear(np.array([[-1.0]]), lambda phi, _: [np.cos(phi) + 1e-7 * np.sin(4000 * phi)])
    equation.noise = np.array([1e-5])
    few = periodic(equation, cycle())
    assert len(few.pieces.half) <= 64
