"""Efficiency as the book uses it (R p. 611–613, Abb. 1062, 1064, 1065): driving pistons pay for the losses."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from kurbel import load
from kurbel.crank_angle import CrankAngle
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Card, Constant, Indicator
from kurbel.machine.parts import ConnectingRod, Friction, Masses, Piston, RamForce
from kurbel.machine.shaft_side import Flywheel
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.flywheel import MachineTurning
from machines import AT, STEAM_CARD, constant_pressure
from representative import CONFIGS
from turning_machines import of_points

TWO_CRANKS = CONFIGS["waterworks-two-cranks"]
ETA = 0.9

STEAM = Piston(
    0.45, head_end_rod=0.075, crank_end_rod=0.1, indicator=Indicator(STEAM_CARD, STEAM_CARD)
)
WATER = Constant.from_keys(expansion=-0.45 * AT, compression=5.4 * AT)
PUMP = Piston(
    0.285, head_end_rod=0.0, crank_end_rod=0.075, indicator=Indicator(WATER, WATER), name="pump"
)
IDLE = Piston(
    0.1,
    head_end_rod=0.0,
    crank_end_rod=0.0,
    indicator=Indicator(constant_pressure(3e5)),
    name="idle",
)
SPRING = Card.from_keys(
    unit=(1e5, 1),
    expansion=[(0, 31.7), (0.3, 9.1), (1, 2.3)],
    compression=[(1, 2.3), (0.3, 9.1), (0, 31.7)],
    interpolate="polytropic",
    clearance=0.07,
)
MASSES = Masses(600.0, ConnectingRod(220.0, center_of_gravity=1.2, inertia=90.0))
ENGINE = Cylinder(
    SliderCrank(0.4, 2.0),
    pistons=(STEAM,),
    masses=MASSES,
    friction=Friction(0.05),
    inclination=20.0,
)
PUMPING = replace(ENGINE, pistons=(STEAM, PUMP))
DRIVEN = replace(ENGINE, pistons=(PUMP,), crank_position=70.0)
ANGLES = np.array([0.0, 17.3, 90.0, 123.4, 180.0, 271.0, 359.0])


def turning(*cylinders: Cylinder, eta: float = 1.0, **more: Any) -> MachineTurning:
    named = tuple(
        replace(one, name=f"cylinder {number}") for number, one in enumerate(cylinders, 1)
    )
    return Case(Machine(named, speed=50 / 60, efficiency=eta, **more)).flywheel


def gas_torque(*pistons: Piston, behind: float = 0.0) -> np.ndarray:
    """Return P dx/dφ in N m of gas on these pistons alone."""
    return turning(Cylinder(ENGINE.mechanism, pistons=pistons, crank_position=behind)).at(ANGLES).M


def works() -> Machine:
    """The waterworks engine with both its cranks, without its friction."""
    machine = load(TWO_CRANKS)
    return replace(
        machine, cylinders=tuple(replace(cylinder, friction=None) for cylinder in machine.cylinders)
    )


# the waterworks engine


@pytest.mark.parametrize("eta", [1.0, 0.95, 0.9, 0.865])
def test_the_power_is_that_of_the_steam_less_its_losses_less_the_pumps(eta: float) -> None:
    power = Case(replace(works(), efficiency=eta)).flywheel.power_shaft
    assert power == pytest.approx((eta * 130.7772e3 - 113.0581e3) * 50 / 60, abs=0.1)


# the rule, at every angle


def test_on_a_rod_with_both_only_the_driving_force_loses() -> None:
    """T_eff = T − (1 − η) P_driving (dx/dφ)/R: inertia, weight and friction in full."""
    whole, less = (turning(PUMPING, eta=eta).at(ANGLES) for eta in (1.0, ETA))
    assert pytest.approx(whole.M - (1 - ETA) * gas_torque(STEAM), abs=1e-9) == less.M
    assert less.T_inertia == pytest.approx(whole.T_inertia, rel=1e-14)


def test_driven_cylinders_on_a_shaft_that_others_drive_count_in_full() -> None:
    each = [turning(one).at(ANGLES).M for one in (ENGINE, DRIVEN)]
    assert (
        pytest.approx(ETA * each[0] + each[1], abs=1e-8)
        == turning(ENGINE, DRIVEN, eta=ETA).at(ANGLES).M
    )


def test_a_machine_that_is_only_driven_needs_more() -> None:
    whole = turning(DRIVEN, replace(DRIVEN, crank_position=160.0))
    less = turning(DRIVEN, replace(DRIVEN, crank_position=160.0), eta=ETA)
    assert pytest.approx(whole.at(ANGLES).M / ETA, rel=1e-13) == less.at(ANGLES).M
    press = replace(ENGINE, pistons=(), ram_force=RamForce(2e4), friction=None)
    assert (
        pytest.approx(turning(press).at(ANGLES).M / ETA, rel=1e-13)
        == turning(press, eta=ETA).at(ANGLES).M
    )


@pytest.mark.parametrize(
    ("piston", "factor"), [(STEAM, ETA), (PUMP, 1 / ETA)], ids=["drives", "driven"]
)
@pytest.mark.parametrize("idle", [constant_pressure(3e5), SPRING], ids=["constant", "gas spring"])
def test_a_piston_without_work_is_neither(piston: Piston, factor: float, idle: Card) -> None:
    beside = replace(ENGINE, pistons=(piston, replace(IDLE, indicator=Indicator(idle))))
    assert (
        pytest.approx(factor * turning(beside).at(ANGLES).M, rel=1e-13)
        == turning(beside, eta=ETA).at(ANGLES).M
    )


def test_a_given_effort_counts_by_its_mean() -> None:
    points = [(0, 100.0), (90, -60.0), (360, 100.0)]
    turned = [(angle, -torque) for angle, torque in points]
    assert of_points(points, efficiency=ETA).M_mean == pytest.approx(ETA * 20, rel=1e-14)
    assert of_points(turned, efficiency=ETA).M_mean == pytest.approx(-20 / ETA, rel=1e-14)


# what follows from the torque


def test_kinetic_energy_gains_what_gas_and_pump_give_beyond_the_load() -> None:
    """Masses count in full in ω: ½ J(φ) ω² changes by the work of η × steam less pump less the mean resistance."""
    cylinder = Cylinder(SliderCrank(0.4, 2.0), pistons=(STEAM, PUMP), masses=Masses(800.0))
    machine = turning(cylinder, eta=ETA, flywheel=Flywheel(20_000.0))
    gas = turning(replace(cylinder, masses=None), eta=ETA)
    slope = cylinder.mechanism.slope(CrankAngle.of(ANGLES))
    energy = (20_000.0 + 800.0 * slope**2) * machine.at(ANGLES).omega ** 2 / 2
    gained = gas.at(ANGLES).E
    assert energy - energy[0] == pytest.approx(gained - gained[0], abs=1e-9 * energy[0])
