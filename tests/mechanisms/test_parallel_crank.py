"""Parallel crank: every coupler point on a circle, and the second pair at 90° (R ch. 14 A)."""

from __future__ import annotations

import numpy as np
import pytest

from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms.parallel_crank import ParallelCrank

TURN = CrankAngle.of(np.linspace(0, 360, 73))
MACHINE = ParallelCrank(0.3, 2.0)


def test_the_second_crank_turns_as_the_first():
    swing = MACHINE.swing_at(TURN)
    assert (swing.degrees == TURN.degrees).all()
    assert (swing.slope == 1).all()
    assert (swing.curvature == 0).all()


def test_coupler_points_run_on_a_circle_with_the_acceleration_of_the_pin():
    columns = {offer.quantity.id: offer.factor for offer in MACHINE.OFFERS}
    along, across = (columns[id](MACHINE, TURN) for id in ("x_coupler", "y_coupler"))
    assert np.hypot(along + 0.3, across) == pytest.approx(0.3, rel=1e-15)
    bend = (columns[id](MACHINE, TURN) for id in ("bx_coupler", "by_coupler"))
    assert np.hypot(*bend) == pytest.approx(0.3, rel=1e-15)  # v²/R over ω²
    assert (along[0], across[0]) == (0, 0)


def test_two_pairs_at_right_angles_pass_on_the_torque_everywhere():
    later = CrankAngle.of(TURN.degrees + 90)
    passed = sum(
        MACHINE.coupler_force_factor(angle) * MACHINE.crank * angle.sin for angle in (TURN, later)
    )  # force times its arm R sin φ
    assert passed == pytest.approx(1, rel=1e-15)


def test_undetermined_positions_are_named_with_their_cure():
    (note,) = MACHINE.notes
    assert "0 and 180 deg" in note
    assert "second pair of cranks at 90 deg" in note
