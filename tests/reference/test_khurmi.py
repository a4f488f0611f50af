"""R. S. Khurmi & J. K. Gupta, Theory of Machines: motion. Printed answers from the Python companion of the textbook.

The companion's graphical and first-order answers are noted; the expectation is an independent 30-digit recalculation.
"""

from __future__ import annotations

import cmath
import math

import pytest

from kurbel import crank_formulas as formulas
from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms.four_bar import FourBar, closed_loop
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.mechanisms.slotted_lever import SlottedLever
from kurbel.solver.motion import Motion
from machines import largest_velocity


def omega(rpm):
    return 2 * math.pi * rpm / 60


def rod_turning(machine, angle):
    """dψ/dφ and d²ψ/dφ² of the straight slider-crank (formula book 2.1)."""
    sin_psi, cos_psi = machine.rod_angle(angle)
    lam = machine.lam
    slope = lam * angle.cos / cos_psi
    return slope, (lam * angle.cos) ** 2 * sin_psi / cos_psi**3 - lam * angle.sin / cos_psi


def test_example_5_1_time_ratio_of_a_slotted_lever():
    """p. 110, printed 1.7; the companion takes sin where asin is meant, and the one decimal survives."""
    machine = SlottedLever(crank=0.120, frame=0.300, lever=0.5)
    assert machine.time_ratio == pytest.approx(1.70995278172, rel=1e-11)


def test_example_7_1_four_bar():
    """p. 148, printed 4.8 rad/s from a velocity polygon."""
    machine = FourBar(crank=0.040, coupler=0.150, rocker=0.080, frame=0.150)
    swing = machine.swing_at(CrankAngle.of(60.0))
    assert swing.slope * omega(120) == pytest.approx(4.78457094752, rel=1e-11)
    assert swing.degrees == pytest.approx(80.410279, abs=5e-7)


def test_example_7_7_slotted_lever():
    """p. 158, crank at 45° to the vertical; printed 1.015 rad/s (graphical) and 1.32 m/s for the lever's end."""
    machine = SlottedLever(crank=0.300, frame=0.800, lever=1.300)
    swing = machine.swing_at(CrankAngle.of(45.0))
    assert swing.slope * omega(40) == pytest.approx(1.01724419252, rel=1e-11)
    assert swing.slope * omega(40) * 1.3 == pytest.approx(1.32241745028, rel=1e-11)
    assert machine.time_ratio == pytest.approx(1.6480056, abs=5e-8)
    cutting, back = Motion(machine, 40 / 60).extremes_of("theta_dot")
    assert cutting.value == pytest.approx(1.1423973, abs=5e-8)
    assert -back.value == pytest.approx(2.5132741, abs=5e-8)


def test_example_8_1_rod_of_a_slider_crank():
    """p. 177, all graphical: 4.1 m/s, 117 m/s², 5.67 rad/s, 171.67 rad/s² at 45°."""
    machine, angle, w = SliderCrank(0.15, 0.6), CrankAngle.of(45.0), omega(300)
    turning, bending = rod_turning(machine, angle)
    assert turning * w == pytest.approx(5.64246697393, rel=1e-11)
    assert abs(bending) * w * w == pytest.approx(171.545156065, rel=1e-11)
    # the mid-point goes the mean of what both ends go; along the stroke the pin has R sin φ and R cos φ
    along = (machine.slope(angle) + 0.15 * angle.sin) / 2
    assert math.hypot(along, 0.15 * angle.cos / 2) * w == pytest.approx(3.99535810787, rel=1e-11)
    drawn = (machine.curvature(angle) + 0.15 * angle.cos) / 2
    assert math.hypot(drawn, 0.15 * angle.sin / 2) * w * w == pytest.approx(117.31042577, rel=1e-11)


def test_example_8_5_a_loop_that_does_not_turn_fully():
    """p. 186, all graphical: 2.2 m/s, 6.1 and 5.7 rad/s, 29.6 m/s², 73.9 and 37.8 rad/s².

    300 + 600 mm is more than 360 + 360 mm: no crank-rocker, but the loop closes at 60°. The crank turns toward the
    rocker, clockwise above the ground link: the same as a crank below it, at −60°, turning on.
    """
    w, acceleration = 10.0, 30.0
    at = closed_loop(0.3, 0.36, 0.36, 0.6, CrankAngle.of(60.0))
    rocker = -w * at.slope
    rocker_pull = -acceleration * at.slope + w * w * at.curvature
    assert abs(rocker) == pytest.approx(6.01929265429, rel=1e-11)
    assert abs(rocker) * 0.36 == pytest.approx(2.16694535554, rel=1e-11)
    assert abs(rocker_pull) == pytest.approx(77.4514993288, rel=1e-11)
    assert math.hypot(rocker_pull, rocker**2) * 0.36 == pytest.approx(30.7825981444, rel=1e-11)
    # the coupler from the velocities and accelerations of its ends, as numbers of the plane
    sin, cos = at.sin, at.cos
    pin, joint = 0.3 * cmath.exp(1j * math.pi / 3), 0.6 + 0.36 * (cos + 1j * sin)
    coupler, arm = joint - pin, 0.36 * (cos + 1j * sin)
    turning = ((1j * rocker * arm - 1j * -w * pin) / (1j * coupler)).real
    assert abs(turning) == pytest.approx(6.01929265429, rel=1e-11)
    pull = (1j * rocker_pull - rocker**2) * arm - (-1j * acceleration - w * w) * pin
    assert abs((pull / coupler).imag) == pytest.approx(38.0185545092, rel=1e-11)


def test_example_8_5_with_the_opposite_sense_of_rotation():
    at = closed_loop(0.3, 0.36, 0.36, 0.6, CrankAngle.of(60.0))
    assert 30 * at.slope + 100 * at.curvature == pytest.approx(113.567, abs=5e-4)


def test_example_15_2_slider_crank_by_kleins_construction():
    """p. 522, graphical: 6.833 m/s, 124.4 m/s², D at a quarter of the rod 6.833 m/s and 266.48 m/s², 6.126, 481.14."""
    machine, angle, w = SliderCrank(0.15, 0.6), CrankAngle.of(60.0), omega(450)
    assert machine.slope(angle) * w == pytest.approx(6.90535994284, rel=1e-11)
    assert machine.curvature(angle) * w * w == pytest.approx(124.949343885, rel=1e-11)
    turning, bending = rod_turning(machine, angle)
    assert turning * w == pytest.approx(6.03359582079, rel=1e-11)
    assert abs(bending) * w * w == pytest.approx(484.394706758, rel=1e-11)
    # D lies 150 mm from the crank pin on the 600 mm rod
    along = 0.75 * 0.15 * angle.sin + 0.25 * machine.slope(angle)
    assert math.hypot(along, 0.75 * 0.15 * angle.cos) * w == pytest.approx(6.8510849064, rel=1e-11)
    drawn = 0.75 * 0.15 * angle.cos + 0.25 * machine.curvature(angle)
    assert math.hypot(drawn, 0.75 * 0.15 * angle.sin) * w * w == pytest.approx(266.81797207, rel=1e-11)


def test_example_15_3_largest_velocity():
    """p. 527, printed 75° and 6.54 m/s from the zero of the first-order acceleration (74.955°, 6.5403 m/s)."""
    machine = SliderCrank(0.3, 1.0)
    largest = largest_velocity(machine)
    assert largest.degrees == pytest.approx(74.5289308367, rel=1e-11)
    assert largest.value * omega(200) == pytest.approx(6.56173215865, rel=1e-11)
    at = CrankAngle.of(74.955267824)
    assert formulas.first_order_acceleration(at.sin, at.cos, 0.3) == pytest.approx(0, abs=1e-10)
    assert 0.3 * omega(200) * formulas.first_order_velocity(at.sin, at.cos, 0.3) == pytest.approx(6.54033228249)


def test_example_15_4_motion_at_40_degrees():
    """p. 528, first order: 4.19 m/s, 85.36 m/s², zero acceleration at 79.27° and 280.73°."""
    machine, angle, w = SliderCrank(0.3, 1.5), CrankAngle.of(40.0), omega(180)
    assert machine.slope(angle) * w == pytest.approx(4.19643371937, rel=1e-11)
    assert machine.curvature(angle) * w * w == pytest.approx(85.5988562672, rel=1e-11)
    assert largest_velocity(machine).degrees == pytest.approx(79.1001352992, rel=1e-11)
    assert 0.3 * w * formulas.first_order_velocity(angle.sin, angle.cos, 0.2) == pytest.approx(4.19177396271, rel=1e-11)
    drawn = 0.3 * w * w * formulas.first_order_acceleration(angle.sin, angle.cos, 0.2)
    assert drawn == pytest.approx(85.3558924062, rel=1e-11)
