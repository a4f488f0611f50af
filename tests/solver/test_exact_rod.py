"""The exact connecting rod by energy and by a free body written down anew, not by comparison with its own formulas."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kurbel.declared.units import GRAVITY
from kurbel.errors import MachineFileError, RuleError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Indicator
from kurbel.machine.parts import ConnectingRod, Friction, Masses, Piston, RamForce
from kurbel.machine.turning import Flywheel
from kurbel.machine_file import loads
from kurbel.mechanisms.parallel_crank import ParallelCrank
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from machines import STEAM_CARD, one_cylinder
from turning_machines import moving_inertia

CRANK, LENGTH, RPM = 0.3, 1.3, 140.0
OMEGA = RPM * 2 * np.pi / 60


def rod_alone(
    mass: float = 250.0, at: float = 0.9, inertia: float = 70.0, offset: float = 0.0, **cylinder: Any
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


ROD = st.tuples(st.floats(1, 500), st.floats(0.0, LENGTH), st.floats(0.0, 200.0), st.sampled_from([0.0, 0.15, -0.3]))


@given(ROD)
def test_power_is_the_change_of_the_kinetic_energy(rod: tuple[float, float, float, float]) -> None:
    """M ω = −dE/dt at every angle: dE/dφ by a complex step, exact to rounding."""
    mass, at, inertia, offset = rod
    degrees = np.arange(0.0, 360.0, 7.0)
    torque = rod_alone(mass, at, inertia, offset).at(degrees).M
    change = np.imag(kinetic_energy(np.radians(degrees) + 1e-30j, *rod)) / 1e-30
    scale = np.abs(change).max() + mass * CRANK**2 * OMEGA**2
    assert np.abs(torque + change).max() <= 1e-13 * scale


@pytest.mark.parametrize("offset", [0.0, 0.2])
@pytest.mark.parametrize("inclination", [None, 0.0, 37.0, 90.0])
def test_no_work_over_a_revolution(offset: float, inclination: float | None) -> None:
    forces = rod_alone(offset=offset, inclination=inclination)
    assert forces.W == 0
    assert abs(forces.energy_residual or 0.0) < 1e-15


@pytest.mark.parametrize("offset", [0.0, 0.15])
def test_the_reduced_inertia_is_that_of_the_kinetic_energy(offset: float) -> None:
    """J(φ) = 2E/ω² of the rigid rod and of the mass at its crosshead pin; without gas ½ (J + J(φ)) ω² is constant."""
    rod, wheel = ConnectingRod(250.0, center_of_gravity=0.9, inertia=70.0), 100.0
    cylinder = Cylinder(SliderCrank(CRANK, LENGTH, offset), masses=Masses(40.0, rod))
    turning = Case(Machine((cylinder,), speed=RPM / 60, flywheel=Flywheel(wheel))).flywheel
    degrees = np.arange(0.0, 360.0, 7.0)
    phi = np.radians(degrees)
    energy = kinetic_energy(phi, 250.0, 0.9, 70.0, offset) + kinetic_energy(phi, 40.0, 0.0, 0.0, offset)
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
        pistons=(Piston(0.45, 0.075, 0.1, Indicator(STEAM_CARD, STEAM_CARD)),),
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
    weight_along, weight_across = mass * GRAVITY * np.sin(incline), -mass * GRAVITY * np.cos(incline)
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


def test_point_masses_at_the_pins_need_no_couple() -> None:
    """A rod whose mass sits in its two ends is what `share` describes, but for the centrifugal force in D."""
    share, mass = 0.4, 90.0
    card = Piston(0.45, indicator=Indicator(STEAM_CARD))
    exact = ConnectingRod(mass, center_of_gravity=0.6 * LENGTH, inertia=mass * 0.24 * LENGTH**2)
    forces, plain = (
        one_cylinder(SliderCrank(CRANK, LENGTH), RPM, pistons=(card,), masses=Masses(50.0, rod))
        for rod in (exact, ConnectingRod(mass, share))
    )
    degrees = np.arange(0.0, 360.0, 10.0)
    for column in ("P", "S", "N", "T", "M"):
        assert getattr(forces.at(degrees), column) == pytest.approx(
            getattr(plain.at(degrees), column), rel=1e-12, abs=1e-8
        )
    pull = mass * 0.6 * CRANK * OMEGA**2
    assert pytest.approx(plain.at(degrees).D - pull, rel=1e-12) == forces.at(degrees).D


def test_key_values_do_not_depend_on_a_step() -> None:
    forces = rod_alone(inclination=90.0)
    fine = forces.at(np.linspace(0, 360, 72001))
    for name in ("N", "T", "S_crosshead", "S_crank"):
        found = forces.extremes_of(name)
        assert found is not None
        column = getattr(fine, name)
        assert column.max() <= found.largest.value + 1e-9 * abs(found.largest.value)
        assert found.largest.value == pytest.approx(column.max(), rel=1e-7)
        assert found.smallest.value == pytest.approx(column.min(), rel=1e-7)


def test_an_infinite_rod_cannot_be_exact() -> None:
    text = (
        "{crank: 1 m, rod: infinite, masses: {connecting_rod: {mass: 1 kg, center_of_gravity: 1 m, inertia: 1 kg m2}}}"
    )
    with pytest.raises(MachineFileError, match="an infinite rod has no centre of gravity"):
        loads(text)


@pytest.mark.parametrize(
    ("place", "message"),
    [
        ("1.5 m", "1500 mm from the crosshead pin is beyond the crank pin: the rod is 1300 mm long"),
        ("-1 mm", "-1 mm is too small; it must be at least 0"),
    ],
)
def test_the_centre_of_gravity_lies_on_the_rod(place: str, message: str) -> None:
    with pytest.raises(MachineFileError) as caught:
        loads(
            "crank: 300 mm\nrod: 1300 mm\n"
            f"masses: {{connecting_rod: {{mass: 10 kg, center_of_gravity: {place}, inertia: 1 kg m2}}}}\n"
        )
    (fault,) = caught.value.faults
    assert fault.path == ("masses", "connecting_rod", "center_of_gravity")
    assert fault.message == message


def test_bounds_hold_in_python_too() -> None:
    for wrong in (
        {"mass": -1.0},
        {"mass": 1.0, "share": 1.2},
        {"mass": 1.0, "center_of_gravity": 0.1, "inertia": -1.0},
    ):
        with pytest.raises(RuleError, match="it must be at"):
            ConnectingRod(**wrong)
    for make in (lambda: RamForce(-1.0), lambda: RamForce(1.0, -1.0), lambda: ParallelCrank(0.3, 1.0, -5.0)):
        with pytest.raises(RuleError, match="it must be at least 0"):
            make()


def test_largest_and_smallest_inertia_force_by_value() -> None:
    forces = one_cylinder(SliderCrank(CRANK, LENGTH), RPM, masses=Masses(-5.0))
    assert forces.P_inertia_max is not None
    assert forces.P_inertia_min is not None
    assert forces.P_inertia_max.value > 0 > forces.P_inertia_min.value


@pytest.mark.parametrize("column", ["S", "S_crosshead", "S_crank"])
def test_extremes_are_those_of_their_own_column(column: str) -> None:
    """At the pins the forces are larger than S, which is between the masses at the ends of the rod."""
    forces = rod_alone(inclination=30.0)
    values = getattr(forces.at(np.arange(0.0, 360.0, 0.05)), column)
    assert getattr(forces, f"{column}_max").value == pytest.approx(values.max(), rel=1e-6)
    assert getattr(forces, f"{column}_min").value == pytest.approx(values.min(), rel=1e-6)


def test_the_peak_of_the_rod_force_is_that_of_its_column() -> None:
    forces = rod_alone(inclination=30.0)
    column = np.abs(forces.at(np.arange(0.0, 360.0, 0.05)).S)
    assert forces.S_peak.value == pytest.approx(column.max(), rel=1e-6)
    assert forces.S_peak.value < -forces.S_crank_min.value


def test_a_rod_alone_and_at_rest_hangs_on_its_pins() -> None:
    """Upright at the dead centre its weight rests on the crank pin, none of it on the crosshead pin."""
    masses = Masses(0.0, ConnectingRod(250.0, center_of_gravity=0.9, inertia=70.0))
    state = one_cylinder(SliderCrank(CRANK, LENGTH), None, masses=masses, inclination=90.0).at([0.0, 180.0])
    assert state.S_crosshead == pytest.approx(0.0, abs=1e-9)
    assert pytest.approx(250 * GRAVITY) == state.S_crank
