"""R. S. Khurmi & J. K. Gupta, Theory of Machines, ch. 15: forces. Figures: FOSSEE companion @d34b2ae7, ch15.ipynb.

The book works with first-order accelerations; the expectations are independent 30-digit recalculations with the exact
ones and the book's g = 9.81 m/s², so that the weight here is given by mass and g of the book.
"""

from __future__ import annotations

import pytest

from kurbel.declared.units import GRAVITY
from kurbel.machine.parts import Masses
from kurbel.mechanisms.slider_crank import SliderCrank
from machines import one_cylinder, single_acting

BOOK_G = 9.81


def test_example_15_6_inertia_force() -> None:
    forces = one_cylinder(SliderCrank(0.1, 0.4), 500, masses=Masses(180))
    assert forces.at([60]).P_inertia[0] == pytest.approx(-18511.0139089, rel=1e-11)


def test_example_15_11_vertical_engine() -> None:
    forces = single_acting(0.06, 0.25, 0.1, 700e3, 2000, 1.1, vertical=True)
    state, weight = forces.at([20]), 1.1 * (GRAVITY - BOOK_G)
    assert state.P[0] - weight == pytest.approx(2249.84758051, rel=1e-11)
    ratio = 2249.84758051 / (2249.84758051 + weight)
    assert state.S[0] * ratio == pytest.approx(2257.46574669, rel=1e-11)
    assert state.N[0] * ratio == pytest.approx(185.303701977, rel=1e-11)


def test_example_15_11_speed_at_which_the_piston_force_vanishes() -> None:
    at_zero = single_acting(
        0.06, 0.25, 0.1, 700e3 + 1.1 * (BOOK_G - GRAVITY) / 0.007853981633974483, 2600.3123945, 1.1, True
    )
    assert at_zero.at([20]).P[0] == pytest.approx(0, abs=1e-6)


def test_example_15_9_horizontal_engine() -> None:
    """The source scales the crank angle for x = 10 mm off a drawing: 33°, exactly 33.12294°."""
    state = single_acting(0.05, 0.2, 0.08, 0.7e6, 1800, 1).at([33])
    assert state.P[0] == pytest.approx(1840.36194835, rel=1e-11)
    assert state.S[0] == pytest.approx(1857.6625584, rel=1e-11)
    assert state.N[0] == pytest.approx(252.938885798, rel=1e-11)
    at_x = SliderCrank(0.05, 0.2).crank_angles_at(0.01, True)
    assert float(at_x) == pytest.approx(33.12294, abs=5e-6)


def test_example_15_9_speed_at_which_the_piston_force_vanishes() -> None:
    forces = single_acting(0.05, 0.2, 0.08, 0.7e6, 2606.34420884, 1)
    assert forces.at([33]).P[0] == pytest.approx(0, abs=1e-7)
