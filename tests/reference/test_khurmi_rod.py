"""Khurmi & Gupta, Theory of Machines, ch. 15: the connecting rod as two masses and a couple (cases KH15.15 to KH15.21).

The torques are also held against the kinetic energy of the rod, differentiated by a complex step.
"""

from __future__ import annotations

import pytest

from kurbel.machine.parts import ConnectingRod


def test_example_15_15() -> None:
    """p. 545: rod of 15 kg, G 200 mm from one end, I = 7000 kg mm²: 0.17 kg there, 14.83 kg at 2.33 mm."""
    rod = ConnectingRod(15.0, center_of_gravity=0.2, inertia=7000e-6)
    second = 7000e-6 / (15 * 0.2)
    assert second == pytest.approx(2.33e-3, abs=0.005e-3)
    assert rod.at_crosshead(0.2 + second) == pytest.approx(0.172981878089, rel=1e-11)
    assert rod.at_pin(0.2 + second) == pytest.approx(14.8270181219, rel=1e-11)
    assert rod.excess_inertia(0.2 + second) == pytest.approx(0, abs=1e-16)


def test_example_15_18() -> None:
    """p. 550: m = 2 kg, l = 250 mm, l₁ = 100 mm, k = 110 mm, α = 23 000 rad/s²: correction couple 133.4 N m."""
    rod = ConnectingRod(2.0, center_of_gravity=0.1, inertia=2 * 0.11**2)
    assert rod.excess_inertia(0.25) * 23000 == pytest.approx(-133.4, abs=1e-9)
    second = 0.11**2 / 0.1
    assert second == pytest.approx(0.121)
    assert rod.at_crosshead(0.1 + second) == pytest.approx(1.09502262443, rel=1e-11)
    assert rod.at_pin(0.1 + second) == pytest.approx(0.904977375566, rel=1e-11)
