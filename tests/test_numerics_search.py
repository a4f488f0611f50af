"""All roots and lowest values of functions whose answers are known."""

import numpy as np
import pytest

from kurbel.arrays import Array
from kurbel.numerics.search import common_roots, lowest, roots


@pytest.mark.parametrize(
    ("function", "expected"),
    [
        (lambda x: x - 0.3, [0.3]),
        (lambda x: np.sin(20 * x) - 0.2, [(k * np.pi + (-1) ** k * np.arcsin(0.2)) / 20 for k in range(7)]),
        (lambda x: (x - 0.41) * (x - 0.4105), [0.41, 0.4105]),
        (lambda x: np.abs(x - 0.3) - 0.001, [0.299, 0.301]),
        (lambda x: np.sqrt(np.where(x > 0.3, x - 0.3, np.nan)) - 1e-4, [0.3 + 1e-8]),
        (lambda x: (x - 0.5) ** 2 + 1e-9, []),
        (lambda x: 0 * x - 1, []),
        (lambda x: np.full_like(x, np.nan), []),
    ],
    ids=["line", "wave", "two close", "kink", "edge of failing", "none", "constant", "nothing"],
)
def test_roots(function: object, expected: list[float]) -> None:
    found, jumps = roots(lambda places: function(places[:, 0]))  # type: ignore[operator]
    assert found == pytest.approx(expected, abs=1e-11)
    assert not jumps.any()


def test_a_jump_is_no_root() -> None:
    found, jumps = roots(lambda places: np.where(places[:, 0] > 0.37, 1.0, -1.0))
    assert found == pytest.approx([0.37], abs=1e-12)
    assert jumps.all()


def test_common_roots_of_a_circle_and_a_wave() -> None:
    def both(places: Array) -> Array:
        x, y = places.T
        return np.stack([x**2 + y**2 - 0.5, np.sin(6 * x) - y], axis=1)

    found = common_roots(both)
    assert len(found) == 2
    assert both(found) == pytest.approx(np.zeros((2, 2)), abs=1e-14)


@pytest.mark.parametrize(
    ("function", "place", "tolerance"),
    [
        (lambda p: np.abs(p[:, 0] - 0.31234567), [0.31234567], 1e-11),
        (lambda p: (p[:, 0] - 0.31234567) ** 2 + 1, [0.31234567], 1e-7),
        (lambda p: np.where(p[:, 0] > 0.7123456789, np.nan, -p[:, 0]), [0.7123456789], 1e-10),
        (lambda p: np.cos(9 * p[:, 0]) + p[:, 0], [1 / 9 * (np.pi - np.arcsin(1 / 9))], 1e-7),
        (lambda p: p[:, 0], [0.0], 0.0),
        (lambda p: (p[:, 0] - 0.3) ** 2 + (p[:, 1] - 0.8) ** 2, [0.3, 0.8], 1e-7),
        (lambda p: np.where(p.sum(axis=1) < 1.2, np.inf, 2 * p[:, 0] + p[:, 1]), [0.2, 1.0], 1e-6),
    ],
    ids=["kink", "parabola", "bound", "valleys", "end", "bowl", "bound of two"],
)
def test_lowest(function: object, place: list[float], tolerance: float) -> None:
    found, _ = lowest(function, len(place))  # type: ignore[arg-type]
    assert found == pytest.approx(place, abs=tolerance)


def test_nothing_is_lowest_where_nothing_counts() -> None:
    assert lowest(lambda places: np.full(len(places), np.nan), 1)[1] == np.inf
