"""Turning effort and excess work: laws, sums over cylinders, and ΔE against independent high precision."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from kurbel.crank_angle import CrankAngle
from kurbel.declared.units import GRAVITY
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Card, Indicator
from kurbel.machine.parts import ConnectingRod, Friction, Masses, Piston, Rings
from kurbel.machine_file import load
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.quantity import value
from kurbel.solver.case import Case
from kurbel.solver.flywheel import MachineTurning, TurningState
from machines import STEAM_CARD, constant_pressure
from representative import CONFIGS
from turning_machines import of_points

STEAM = Piston(
    0.45, head_end_rod=0.075, crank_end_rod=0.1, indicator=Indicator(STEAM_CARD, STEAM_CARD)
)
PUMP = Piston(
    0.285,
    head_end_rod=0.0,
    crank_end_rod=0.075,
    indicator=Indicator(constant_pressure(4e5), constant_pressure(4e5)),
    name="pump",
)
ENGINE = Cylinder(SliderCrank(0.4, 2.0), pistons=(STEAM,), masses=Masses(826.0))
ANGLES = np.array([0.0, 17.3, 90.0, 123.4, 180.0, 271.0, 359.0])


def turning(*cylinders: Cylinder, rpm: float | None = 50, **machine: Any) -> MachineTurning:
    named = tuple(replace(c, name=f"cylinder {i}") for i, c in enumerate(cylinders, 1))
    return Case(Machine(named, speed=None if rpm is None else rpm / 60, **machine)).flywheel


def test_masses_alone_do_no_work_and_fluctuate_against_none() -> None:
    """∮ m x′ x″ dφ = 0: their mean torque is none, where its rounding once stood as a divisor under ΔE."""
    moved = replace(ENGINE, pistons=())
    machine = turning(moved, replace(moved, crank_position=140.0))
    assert machine.M_mean == machine.work_shaft == 0.0
    assert machine.dE > 100
    assert machine.energy_fluctuation is None


LYING = Friction(crosshead=0.1, rings=Rings(3, 0.02, 3e4, 0.08))
ROD = ConnectingRod(220.0, center_of_gravity=1.3, inertia=90.0)


@pytest.mark.parametrize(
    "cylinder",
    [
        ENGINE,
        replace(ENGINE, friction=LYING),
        replace(ENGINE, inclination=60.0, friction=LYING),
        replace(ENGINE, masses=Masses(500.0, ROD), inclination=90.0),
        replace(ENGINE, mechanism=SliderCrank(0.4, 2.0, 0.15), pistons=(STEAM, PUMP)),
        replace(ENGINE, mechanism=SliderCrank(0.4, 0.41)),
        Cylinder(ScotchYoke(0.4), pistons=(STEAM,), masses=Masses(300.0)),
    ],
    ids=["steam", "friction", "standing", "exact rod", "offset, pump", "short rod", "yoke"],
)
def test_the_excess_work_is_the_integral_of_the_torque(cylinder: Cylinder) -> None:
    machine = turning(cylinder, replace(cylinder, crank_position=77.0))
    nodes, weights = np.polynomial.legendre.leggauss(20)

    def quadrature(upto: float, change: Callable[[np.ndarray], np.ndarray]) -> float:
        breaks = np.append(machine.breaks[machine.breaks < upto], upto)
        middles, halves = (breaks[1:] + breaks[:-1]) / 2, np.diff(breaks) / 2
        degrees = middles + halves * nodes[:, None]
        torque = (
            machine.at(degrees.ravel(), np.broadcast_to(middles, degrees.shape).ravel()).M
            - machine.M_mean
        )
        return math.fsum(np.radians(halves) * (weights @ change(torque.reshape(degrees.shape))))

    turnover = quadrature(360.0, np.abs)
    for angle in (13.0, 100.0, 181.5, 300.0, 360.0):
        assert machine.at([angle]).E[0] == pytest.approx(
            quadrature(angle, np.asarray), abs=2e-14 * turnover
        )


def test_the_work_of_the_masses_is_what_their_energy_loses() -> None:
    """∫ −m x′ x″ ω² dφ = −½ m ω² x′² is closed, and so is the work m g Δx of their weight."""
    idle = replace(ENGINE, pistons=(), inclination=60.0)
    machine, mechanism = turning(idle, rpm=200.0), idle.mechanism
    omega, angle = 200 * math.pi / 30, CrankAngle.of(ANGLES)
    weight = 826.0 * GRAVITY * CrankAngle.of(60.0).sin * mechanism.coordinate(angle)
    closed = weight - 826.0 / 2 * (mechanism.slope(angle) * omega) ** 2
    assert pytest.approx(closed, abs=2e-15 * np.ptp(closed)) == machine.at(ANGLES).E
    assert machine.M_mean == pytest.approx(0, abs=1e-15 * np.ptp(closed))


def test_the_work_of_a_card_is_its_closed_area() -> None:
    """Over a stroke from dead centre to dead centre, a card of straight lines without masses; both ends the same."""
    machine = turning(replace(ENGINE, masses=None))
    cylinder = Case(machine.machine).cylinders[0]
    assert machine.work_shaft == pytest.approx(cylinder.work, rel=2e-15)
    compressed = Card.from_keys(
        unit=(1e5, 1), expansion=[(0, 8), (0.3, 8), (1, 2)], compression=[(1, 0), (0, 0)]
    )
    single = replace(ENGINE, masses=None, pistons=(Piston(0.2, indicator=Indicator(compressed)),))
    work = turning(single)
    stroke = (0.3 * 8e5 + 0.7 * 5e5) * 0.8 * Piston(0.2).head_area
    assert work.at(np.array([180.0])).E[0] + work.M_mean * math.pi == pytest.approx(
        stroke, rel=2e-15
    )


def test_lobes_add_up_to_nothing_and_span_the_swing() -> None:
    machine = turning(ENGINE, replace(ENGINE, crank_position=-90.0))
    heights = np.cumsum(machine.lobes)
    assert heights[-1] == pytest.approx(0, abs=1e-12 * machine.dE)
    assert np.ptp(heights) == pytest.approx(machine.dE, rel=1e-13)
    assert machine.dE > max(machine.lobes)  # the largest lobe alone is not the swing
    assert machine.E_max.value - machine.E_min.value == pytest.approx(machine.dE, rel=1e-13)


def test_jumps_are_crossings_and_have_both_their_values() -> None:
    machine = of_points([(0, 300), (90, 300), (90, -100), (360, -100)])
    assert machine.M_mean == pytest.approx(0, abs=1e-12)
    assert machine.phi_crossing == (0.0, 90.0)
    assert (machine.M_max.value, machine.M_min.value) == (300, -100)
    assert machine.dE == pytest.approx(300 * math.pi / 2, rel=1e-15)


class _WithPower(TurningState):
    commands = ("flywheel",)
    N = value(
        "N",
        "power",
        "Power at the shaft",
        lambda one: one.M * one.omega,
        extremes=("flywheel",),
        called="power",
    )


class _Powered(MachineTurning):
    state = _WithPower


def test_a_column_that_is_a_product_of_others_has_its_extremes() -> None:
    """Torque times speed of an engine with a light flywheel, against ten thousand angles."""
    result = _Powered(Case(load(CONFIGS["four-cylinder-generator"])).effort)
    columns = result.columns(np.linspace(0.0, result.effort.cycle, 10_001), "M", "omega")
    power = columns["M"] * columns["omega"]
    assert power.max() <= result["N_max"].value * (1 + 1e-12)
    assert result["N_max"].value == pytest.approx(power.max(), rel=1e-6)
    assert result["N_min"].value == pytest.approx(power.min(), rel=1e-6)
