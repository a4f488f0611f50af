"""Torsion of long shaft lines: solved over the angle mode by mode, against other ways to the same torques."""

from typing import Any

import numpy as np
import pytest

from kurbel.machine import Machine
from kurbel.machine.shaft_line import ShaftPart, line_of
from kurbel.machine.shaft_side import Effort, Load
from kurbel.solver.case import Case
from kurbel.solver.chapters import torsion
from kurbel.solver.chapters.excitation import Vibration, excitation
from kurbel.solver.chapters.harmonics import every_order
from kurbel.solver.chapters.torsion import ShaftVibration

EFFORT = Effort((0.0, 40.0, 90.0, 180.0, 270.0, 360.0), (-20.0, 300.0, 80.0, 0.0, -60.0, -20.0))
"""A turning-moment diagram with corners, in N m."""
FEW_ORDERS = 400


def line(
    masses: int, load: Load | None = None, grounds: int = 0, effort: Effort = EFFORT
) -> ShaftVibration:
    """A line of unequal masses and segments with viscous dampers, between so many fixed ends."""
    draw = np.random.default_rng(masses)
    parts: list[Any] = []
    for number in range(masses):
        if number or grounds:
            stiffness = float(draw.uniform(0.5, 2)) * 1e6
            parts.append(ShaftPart(stiffness=stiffness, damping=float(draw.uniform(2, 30))))
        parts.append(ShaftPart(inertia=float(draw.uniform(0.1, 0.4)), damping=0.5))
    if grounds:
        parts = ["ground", *parts]
    if grounds == 2:
        parts += [ShaftPart(stiffness=7e5), "ground"]
    machine = Machine((), effort=effort, speed=6.0, shaft=line_of(parts), load=load)
    return Case(machine).torsion


def swings(vibration: ShaftVibration) -> np.ndarray:
    """Highest and lowest torques of the segments in N m."""
    return np.array([(segment.M_shaft_max, segment.M_shaft_min) for segment in vibration.segments])


@pytest.mark.parametrize(
    ("masses", "load"),
    [(6, None), (7, Load(power=2.0)), pytest.param(9, Load(slip=0.01), marks=pytest.mark.slow)],
)
def test_the_modes_together_are_the_whole(
    masses: int, load: Load | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each mode is an equation of one unknown; all unknowns in one matrix give the same torques."""
    by_modes = line(masses, load)
    torques, loss = swings(by_modes), by_modes.vibration_loss
    monkeypatch.setattr(torsion, "_MOST_WORK", np.inf)
    whole = line(masses, load)
    assert by_modes.steady
    assert whole.steady
    assert torques == pytest.approx(swings(whole), rel=1e-12)
    assert loss == pytest.approx(whole.vibration_loss, rel=1e-12)


@pytest.mark.parametrize(("masses", "grounds"), [(20, 0), (8, 1), (3, 2), (8, 2)])
def test_all_orders_together(masses: int, grounds: int) -> None:
    """The motion over the angle is the sum of very many orders, and the power lost is that of theirs."""
    vibration = line(masses, grounds=grounds)
    assert vibration.steady
    orders = every_order(vibration.effort.cycle, FEW_ORDERS)
    acting = excitation(vibration.effort, vibration.line, orders)
    summed = Vibration(vibration.chain, vibration.line, acting, np.array([2 * np.pi * 6.0]))
    # torques behind corners fall off as 1/ν², those in the shaft as 1/ν⁴ beyond its natural orders
    left_out = np.abs(summed.torques[:, 0, orders > FEW_ORDERS / 2]).sum(axis=1).max()
    amplitudes = np.array([segment.M_vibratory for segment in vibration.segments])
    assert amplitudes == pytest.approx(summed.vibratory[:, 0], abs=max(left_out / 4, 1e-9))
    assert left_out < 1e-3 * amplitudes.max()
    assert vibration.vibration_loss == pytest.approx(float(summed.loss[0]), rel=1e-6)


def test_a_mode_without_damping_that_is_not_met() -> None:
    """Of two equal halves one mode leaves the damper at rest; away from resonance its torque is bounded."""
    parts = [
        ShaftPart(inertia=0.3),
        *(ShaftPart(stiffness=1e6), ShaftPart(inertia=0.2, damping=4.0)) * 5,
        *(ShaftPart(stiffness=1e6), ShaftPart(inertia=0.3)),
    ]
    vibration = Case(Machine((), effort=EFFORT, speed=6.0, shaft=line_of(parts))).torsion
    assert vibration.steady
    assert np.isfinite(swings(vibration)).all()


def test_a_line_that_is_summed_has_its_power_of_all_these_orders() -> None:
    """N_d is that of the orders in M_w,a, not of the 24 of the tables."""
    parts = [
        ShaftPart(inertia=0.3),
        ShaftPart(stiffness=1e6, loss_factor=0.02),
        ShaftPart(inertia=0.5),
    ]
    vibration = Case(Machine((), effort=EFFORT, speed=6.0, shaft=line_of(parts))).torsion
    assert vibration.summed is not None
    assert vibration.summed[-1] == 384
    twists = np.abs(vibration._summed.torques[0, 0] / (1e6 * (1 + 0.02j))) ** 2
    powers = 0.02 * 1e6 * 2 * np.pi * 6.0 * vibration.summed * twists / 2
    assert vibration.vibration_loss == pytest.approx(powers.sum(), rel=1e-12)
