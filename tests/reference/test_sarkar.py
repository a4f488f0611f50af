"""B. K. Sarkar, Theory of Machines: motion. The Python companion of the textbook has several slips, named here."""

from __future__ import annotations

import math

import pytest

from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.mechanisms.slotted_lever import SlottedLever
from machines import largest_velocity


def test_example_1_1_slotted_lever():
    """p. 15: half swing 30°, printed right; the stroke is printed −13.790 mm (sine of degrees), it is 400 mm."""
    machine = SlottedLever(crank=0.1, frame=0.2, lever=0.4)
    assert machine.swing == pytest.approx(60, rel=1e-15)
    assert machine.stroke == pytest.approx(0.4, rel=1e-15)


def test_example_5_1_largest_velocity():
    """p. 160: 74.96° is the first-order angle; 7.0 m/s comes from sin 2θ/n for sin 2θ/(2n)."""
    largest = largest_velocity(SliderCrank(0.3, 1.0))
    assert largest.degrees == pytest.approx(74.5289308367, rel=1e-11)
    assert largest.value * 2 * math.pi * 200 / 60 == pytest.approx(6.56173215865, rel=1e-11)


def test_example_5_2_motion_at_40_degrees():
    """p. 161: printed 4.4 m/s and 83.5 m/s², both slips of the companion; 79.3° is first order."""
    machine, angle, omega = SliderCrank(0.3, 1.5), CrankAngle.of(40.0), 2 * math.pi * 180 / 60
    assert machine.slope(angle) * omega == pytest.approx(4.19643371937, rel=1e-11)
    assert machine.curvature(angle) * omega**2 == pytest.approx(85.5988562672, rel=1e-11)
    assert largest_velocity(machine).degrees == pytest.approx(79.1001352992, rel=1e-11)
