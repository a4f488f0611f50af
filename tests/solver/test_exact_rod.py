"""The exact connecting rod by energy and by a free body written down anew, not by comparison with its own formulas."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kurbel.declared.units import GRAVITY
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Indicator
from kurbel.machine.parts import ConnectingRod, Friction, Masses, Piston
from kurbel.machine.shaft_side import Flywheel
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from machines import STEAM_CARD, one_cylinder
from turning_machines import moving_inertia

CRANK, LENGTH, RPM = 0.3, 1.3, 140.0
OMEGA = RPM * 2 * np.pi / 60


def rod_alone(
    mass: float = 250.0,
    at: float = 0.9,
    inertia: float = 70.0,
    offset: float = 0.0,
    **cylinder: Any,
) -> CylinderForces:
    masses = Masses(0.0, ConnectingRod(mass, center_of_gravity=at, inertia=inertia))
    return one_cylinder(SliderCrank(CRANK, LENGTH, offset), RPM, masses=masses, **cylinder)


def kinetic_energy(phi: Any, mass: float, at: float, inertia: float, offset: float) -> Any:
    """½ m v² + ½ I ψ̇² of the rod, from the positions of its centre of gravity; phi in radians, may be complex."""
    sin_psi = (CRANK * np.sin(phi) - offset) / LENGTH
    cos_psi = np.sqrt(1 - sin_psi**2)
    psi_dot = CRANK * np.cos(phi) / (LENGTH * cos_psi) * OMEGA
    # the pin is at (−R cos φ, R sin φ) from the shaft, the centre of gravity L − a back along the rod
    back = LENGTH - at
    v_along = CRANK * np.sin(phi) * OMEGA + back * sin_psi * psi_dot
    v_across = CRANK * np.cos(phi) * OMEGA - back * cos_psi * psi_dot
    return mass / 2 * (v_along**2 + v_across**2) + inertia / 2 * psi_dot**2


ROD = st.tuples(
    st.floats(1, 500),
    st.floats(0.0, LENGTH),
    st.floats(0.0, 200.0),
    st.sampled_from([0.0, 0.15, -0.3]),
)


@given(ROD)
def test_power_is_the_change_of_the_kinetic_energy(rod: tuple[float, float, float, float]) -> None:
    """M ω = −dE/dt at every angle: dE/dφ by a complex step, exact to rounding."""
    mass, at, inertia, offset = rod
    degrees = np.arange(0.0, 360.0, 7.0)
    torque = rod_alone(mass, at, inertia, offset).at(degrees).M
    change = np.imag(kinetic_energy(np.radians(degrees) + 1e-30j, *rod)) / 1e-30
    scale = np.abs(change).max() + mass * CRANK**2 * OMEGA**2
    assert np.abs(torque + change).max() <= 1e-13 * scale


@pytest.mark.parametrize("offset", [0.0, 0.15])
def test_the_reduced_inertia_is_that_of_the_kinetic_energy(offset: float) -> None:
    """J(φ) = 2E/ω² of the rigid rod and of the mass at its crosshead pin; without gas ½ (J + J(φ)) ω² is constant."""
    rod, wheel = ConnectingRod(250.0, center_of_gravity=0.9, inertia=70.0), 100.0
    cylinder = Cylinder(SliderCrank(CRANK, LENGTH, offset), masses=Masses(40.0, rod))
    turning = Case(Machine((cylinder,), speed=RPM / 60, flywheel=Flywheel(wheel))).flywheel
    degrees = np.arange(0.0, 360.0, 7.0)
    phi = np.radians(degrees)
    energy = kinetic_energy(phi, 250.0, 0.9, 70.0, offset) + kinetic_energy(
        phi, 40.0, 0.0, 0.0, offset
    )
    reduced = 2 * energy / OMEGA**2
    assert moving_inertia(turning, degrees) == pytest.approx(reduced, rel=1e-12)
    held = (wheel + reduced) * turning.at(degrees).omega ** 2
    assert held == pytest.approx(held[0], rel=1e-12)


def test_weight_is_the_slope_of_the_height() -> None:
    """At rest the torque of the rod's weight is −m g dh/dφ of its centre of gravity."""
    masses = Masses(0.0, ConnectingRod(250.0, center_of_gravity=0.9, inertia=70.0))
    incline = np.radians(25.0)
    forces = one_cylinder(SliderCrank(CRANK, LENGTH, 0.1), None, masses=masses, inclination=25.0)

    def height(phi: Any) -> Any:
        sin_psi = (CRANK * np.sin(phi) - 0.1) / LENGTH
        cos_psi = np.sqrt(1 - sin_psi**2)
        along = -CRANK * np.cos(phi) - 0.4 * cos_psi  # toward the shaft, that is down the incline
        across = CRANK * np.sin(phi) - 0.4 * sin_psi
        return -along * np.sin(incline) + across * np.cos(incline)

    degrees = np.arange(0.0, 360.0, 11.0)
    change = np.imag(height(np.radians(degrees) + 1e-30j)) / 1e-30
    assert pytest.approx(-250 * GRAVITY * change, abs=1e-10) == forces.at(degrees).M


@pytest.mark.parametrize("friction", [None, Friction(0.08)])
@pytest.mark.parametrize("offset", [0.0, 0.2])
def test_free_body_of_the_rod(friction: Friction | None, offset: float) -> None:
    """Forces at both ends give the rod's centre of gravity its acceleration and the rod its angular acceleration."""
    mass, at, inertia, parts = 250.0, 0.9, 70.0, 180.0
    forces = one_cylinder(
        SliderCrank(CRANK, LENGTH, offset),
        RPM,
        pistons=(
            Piston(
                0.45,
                head_end_rod=0.075,
                crank_end_rod=0.1,
                indicator=Indicator(STEAM_CARD, STEAM_CARD),
            ),
        ),
        masses=Masses(parts, ConnectingRod(mass, center_of_gravity=at, inertia=inertia)),
        friction=friction,
        inclination=20.0,
    )
    degrees = np.arange(3.0, 360.0, 9.0)
    s, phi, incline = forces.at(degrees), np.radians(degrees), np.radians(20.0)
    psi = np.radians(s.psi)
    psi_dot = CRANK * np.cos(phi) / (LENGTH * np.cos(psi)) * OMEGA
    psi_ddot = (psi_dot**2 * np.sin(psi) - CRANK / LENGTH * np.sin(phi) * OMEGA**2) / np.cos(psi)
    along = s.b - at * (np.cos(psi) * psi_dot**2 + np.sin(psi) * psi_ddot)
    across = at * (np.cos(psi) * psi_ddot - np.sin(psi) * psi_dot**2)
    # crosshead: gas, weight and friction push it, its own mass is parts; the guide holds it across
    friction_force = 0.0 if s.F_friction is None else s.F_friction
    push = s.P_gas + parts * GRAVITY * np.sin(incline) + friction_force - parts * s.b
    lift = s.N - parts * GRAVITY * np.cos(incline)
    # pin: T along (sin φ, cos φ), D along (cos φ, −sin φ) are what the rod does to it
    pin_along = s.T * np.sin(phi) + s.D * np.cos(phi)
    pin_across = s.T * np.cos(phi) - s.D * np.sin(phi)
    weight_along, weight_across = (
        mass * GRAVITY * np.sin(incline),
        -mass * GRAVITY * np.cos(incline),
    )
    assert push - pin_along + weight_along == pytest.approx(mass * along, abs=1e-7)
    assert lift - pin_across + weight_across == pytest.approx(mass * across, abs=1e-7)
    assert push * np.cos(psi) + lift * np.sin(psi) == pytest.approx(s.S_crosshead, abs=1e-7)
    assert pin_along * np.cos(psi) + pin_across * np.sin(psi) == pytest.approx(s.S_crank, abs=1e-7)
    ahead = LENGTH - at
    moment = at * (push * np.sin(psi) - lift * np.cos(psi)) + ahead * (
        pin_along * np.sin(psi) - pin_across * np.cos(psi)
    )
    assert moment == pytest.approx(inertia * psi_ddot, abs=1e-7)
    assert pytest.approx(s.T * CRANK, rel=1e-12) == s.M
