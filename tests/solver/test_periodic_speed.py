"""The speed line: exact solutions over twenty powers of ten of stiffness, scipy as oracle, laws, and what stops."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np
import pytest

from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Indicator
from kurbel.machine.parts import ConnectingRod, Masses, Piston
from kurbel.machine.turning import Flywheel, Load
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.flywheel import MachineTurning
from machines import STEAM_CARD
from representative import few
from turning_machines import moving_inertia, of_points

POINTS = [(0, 500), (40, 1500), (40, 900), (120, 200), (200, 300), (200, 1300), (290, 100), (360, 250)]
ANGLES = np.array([0.0, 1e-3, 20.0, 39.999, 40.0, 40.001, 100.0, 180.0, 200.0, 233.3, 300.0, 359.9])
RPM = 60.0
OMEGA = 2 * math.pi
CYLINDER = Cylinder(
    SliderCrank(0.4, 2.0),
    pistons=(Piston(0.45, 0.075, 0.1, Indicator(STEAM_CARD, STEAM_CARD)),),
    masses=Masses(826.0),
)


def ratio_of(machine: MachineTurning, degrees: np.ndarray) -> np.ndarray:
    """Return (ω/ω_n)² − 1 of the speed line at crank angles (n,) in degrees."""
    line: Any = machine.speed
    u = line.pieces.at(line.u, np.zeros(len(degrees), dtype=int), degrees)
    return u * (2 + u)


def kinetic(machine: MachineTurning, degrees: np.ndarray) -> np.ndarray:
    """Return half the inertia ½ J(φ) in kg m² at crank angles (n,) in degrees."""
    return (machine.J + moving_inertia(machine, degrees)) / 2


def steam(
    inertia: float | None,
    load: Load | None,
    *more: Cylinder,
    rpm: float = 50,
    delta: float | None = None,
    cylinder: Cylinder = CYLINDER,
    **machine: Any,
) -> MachineTurning:
    cylinders = tuple(replace(c, name=f"cylinder {i}") for i, c in enumerate((cylinder, *more), 1))
    return Case(Machine(cylinders, speed=rpm / 60, flywheel=Flywheel(inertia, delta), load=load, **machine)).flywheel


# a fan, M_load = M_m (ω/ω_n)², is linear in the energy: E′ = M(φ) − a E with a = M_m/E_n has a closed solution


def exact_energy(mean: Any, rate: Any, degrees: float) -> Any:
    """Kinetic energy in J by 60 digits: the solution of E′ = M − a E with the period of the straight-line diagram M."""
    mp = mpmath.mp
    pieces = [
        (mp.radians(a0), mp.radians(a1), mp.mpf(m0), (mp.mpf(m1) - m0) / mp.radians(a1 - a0))
        for (a0, m0), (a1, m1) in pairwise(POINTS)
        if a1 > a0
    ]

    def after(start: Any, upto: Any) -> Any:
        energy = start
        for low, high, torque, rise in pieces:
            if upto <= low:
                break
            way = min(high, upto) - low
            particular = lambda t, m=torque, r=rise: (m + r * t) / rate - r / rate**2  # noqa: E731
            energy = (energy - particular(0)) * mp.exp(-rate * way) + particular(way)
        return energy

    whole = after(mp.mpf(0), 2 * mp.pi)
    start = whole / (1 - mp.exp(-rate * 2 * mp.pi))
    return after(start, mp.radians(mp.mpf(degrees)))


RELAXATIONS = [1e-11, 1e-9, 1e-7, 1e-5, 1e-3, 1e-1, 1.0, 30.0, 1e3]


@pytest.mark.parametrize("relaxation", few(RELAXATIONS, [1e-11, 1e-5, 1e-1, 1e3]))
def test_relaxation_from_1e_11_to_1e3_revolutions(relaxation: float) -> None:
    """2e-14 in the kinetic energy at the angles of the table, against the closed solution."""
    mean = of_points(POINTS, RPM).M_mean
    inertia = 2 * relaxation * 2 * math.pi * mean / OMEGA**2
    machine = of_points(POINTS, RPM, inertia=inertia, load=Load(power=2.0))
    with mpmath.workdps(60):
        mp = mpmath.mp
        exact_mean = sum(
            (mp.radians(a1) - mp.radians(a0)) * (mp.mpf(m0) + m1) / 2 for (a0, m0), (a1, m1) in pairwise(POINTS)
        ) / (2 * mp.pi)
        nominal = mp.mpf(inertia) / 2 * (2 * mp.pi) ** 2
        for angle, omega in zip(ANGLES, machine.at(ANGLES).omega):
            truth = exact_energy(exact_mean, exact_mean / nominal, float(angle))
            error = mp.mpf(inertia) / 2 * mp.mpf(float(omega)) ** 2 / truth - 1
            assert abs(error) < 2e-14
    assert machine.multiplier == pytest.approx(math.exp(-1 / relaxation), rel=1e-9, abs=1e-60)


def test_power_and_load_are_in_balance() -> None:
    """Over a cycle the load takes what the effort gives, whatever the speed does."""
    machine = steam(2000, Load(slip=0.05))
    pieces, omega = machine.speed.omega
    load = machine.M_mean * (1 + (omega / machine.omega - 1) / 0.05)
    assert pieces.mean(load)[0] == pytest.approx(machine.M_mean, rel=1e-13)


def test_a_heavy_flywheel_keeps_the_digits_of_its_fluctuation() -> None:
    """δ → ΔE/(J ω²) as J grows; at 1e16 kg m² ω_max − ω_min itself has no digit left."""
    for inertia in (1e10, 1e13, 1e16):
        fixed, driven = steam(inertia, None), steam(inertia, Load(slip=1.0))
        assert fixed.delta == pytest.approx(fixed.delta_book, rel=1e-6)
        assert driven.delta == pytest.approx(fixed.delta_book, rel=1e-3)
    assert fixed.delta == pytest.approx(fixed.delta_book, rel=1e-12)


def test_the_mean_speed_over_time_is_the_nominal_one() -> None:
    """A load that does not mind the speed: the time of a cycle is 2π/ω_n."""
    for inertia in (500.0, 3000.0, 1e6):
        machine = steam(inertia, None)
        phi = np.linspace(0, 360, 20001)
        slowness = 1 / machine.at(phi).omega
        mean = np.sum((slowness[1:] + slowness[:-1]) / 2) / 20000
        assert 1 / mean == pytest.approx(machine.omega, rel=1e-8)
        assert machine.omega_mean == pytest.approx(machine.omega, rel=1e-12)


def test_no_inertia_in_a_dead_centre_is_refused() -> None:
    with pytest.raises(UsageError, match="inertia at φ = 0°"):
        _ = steam(0.0, Load(slip=0.01)).speed
    with pytest.raises(UsageError, match="give 'flywheel' an inertia"):
        _ = of_points(POINTS, RPM, inertia=0.0).speed


@pytest.mark.parametrize("load", [None, Load(power=2.0)])
def test_a_machine_that_stalls_says_where_and_what_flywheel_would_do(load: Load | None) -> None:
    with pytest.raises(NoSolutionError, match=r"stops near φ = [\d.]+°.* from J = ") as caught:
        _ = steam(60, load).speed
    enough = float(str(caught.value).partition("from J = ")[2].partition(" kg")[0])
    assert steam(enough, load).omega_min.value > 0
    with pytest.raises(NoSolutionError):
        _ = steam(0.9 * enough, load).speed


def test_masses_count_in_full_where_the_efficiency_takes_its_share() -> None:
    """With J(φ) varying and no gas force to speak of, ½ J(φ) ω² stays what it is, whatever the efficiency."""
    idle = replace(CYLINDER, pistons=())
    for eta in (1.0, 0.8):
        machine = Case(Machine((idle,), speed=1.0, flywheel=Flywheel(500.0), efficiency=eta)).flywheel
        energy = kinetic(machine, ANGLES) * machine.at(ANGLES).omega ** 2
        assert energy == pytest.approx(energy[0], rel=1e-13)


def test_a_load_on_a_mean_of_nothing_is_left_out() -> None:
    machine = Case(
        Machine((replace(CYLINDER, pistons=()),), speed=1.0, flywheel=Flywheel(500.0), load=Load(slip=0.01))
    ).flywheel
    assert machine.load_ignored
    assert machine.speed.law is None


@pytest.mark.parametrize(
    ("power", "inertia"),
    few([(-2.0, 800.0), (-1.5, 800.0), (1000.0, 300.0), (3000.0, 3000.0)], [(-2.0, 800.0)]),
)
def test_the_speed_line_does_not_hang_on_where_the_angle_begins(power: float, inertia: float) -> None:
    lines = [
        steam(inertia, Load(power=power), cylinder=replace(CYLINDER, masses=None, crank_position=position))
        for position in (0.0, 45.0, 90.0, 200.3, 315.0)
    ]
    deltas = [line.delta for line in lines]
    assert deltas == pytest.approx([deltas[0]] * 5, rel=1e-9)
    own = [line.at(np.array([0.0, 100.0]) + line.machine.cylinders[0].crank_position).omega for line in lines]
    for omega in own:
        assert omega == pytest.approx(own[0], rel=1e-10)


def test_an_unstable_line_is_where_marching_backward_ends() -> None:
    """Forward a disturbance grows 1e20 times in a turn; backward Runge's steps come to the periodic state from any."""
    machine = steam(300.0, Load(power=-2.0), cylinder=replace(CYLINDER, masses=None))
    steps = 50

    def slope(effort: float, energy: float) -> float:
        return effort - machine.M_mean * 150.0 * machine.omega**2 / energy

    energy = 150.0 * 25.0
    for low, high in list(pairwise(machine.breaks))[::-1]:
        angles = np.linspace(high, low, 2 * steps + 1)
        efforts = machine.at(angles, np.full(len(angles), (low + high) / 2)).M.tolist()
        h = math.radians(low - high) / steps
        for first, middle, last in zip(efforts[:-1:2], efforts[1::2], efforts[2::2]):
            one = slope(first, energy)
            two = slope(middle, energy + h / 2 * one)
            three = slope(middle, energy + h / 2 * two)
            four = slope(last, energy + h * three)
            energy += h / 6 * (one + 2 * two + 2 * three + four)
    assert math.sqrt(energy / 150.0) == pytest.approx(machine.at([0.0]).omega[0], rel=1e-7)


def test_the_multiplier_is_exact_far_beyond_what_a_stability_function_can() -> None:
    """A fan: μ = exp(−∮ k M_m/(J ω_n²) dφ), whatever ω does; below the smallest float it is 0."""
    for inertia, exponent in ((1.0, None), (30.0, None), (0.01, 0.0)):
        machine = of_points(rectangle_above_zero(), RPM, inertia=inertia, load=Load(power=2.0))
        expected = math.exp(-2 * 2 * math.pi * machine.M_mean / (inertia * OMEGA**2))
        assert machine.multiplier == pytest.approx(expected, rel=1e-11)
        assert exponent is None or machine.multiplier == exponent


def rectangle_above_zero() -> list[tuple[float, float]]:
    return [(0, 500), (180, 500), (180, 300), (360, 300)]


def test_the_turning_part_of_the_rod_counts_as_inertia() -> None:
    """(1 − share) m R²; as much as an exact rod of the same two masses without a couple of its own."""
    share, exact = (
        replace(CYLINDER, masses=Masses(826.0, rod))
        for rod in (
            ConnectingRod(300.0, share=0.4),
            ConnectingRod(300.0, center_of_gravity=0.6 * 2.0, inertia=300.0 * 1.2 * 0.8),
        )
    )
    one, other = (steam(500.0, None, cylinder=cylinder) for cylinder in (share, exact))
    angles = np.array([0.0, 50.0, 90.0, 222.0])
    plain = steam(500.0, None, cylinder=replace(CYLINDER, masses=Masses(826.0 + 0.4 * 300.0)))
    with_rod, without = (moving_inertia(machine, angles) for machine in (one, plain))
    more = with_rod - without
    assert more == pytest.approx(0.6 * 300.0 * 0.4**2, rel=1e-11)
    assert other.delta == pytest.approx(one.delta, rel=1e-12)


WISHED = [(None, 1.0), (Load(slip=0.02), 1.0), (Load(slip=0.02), 0.85), (None, 0.7)]


@pytest.mark.parametrize(("load", "efficiency"), few(WISHED, [WISHED[0], WISHED[2]]))
def test_the_exact_flywheel_meets_the_wish(load: Load | None, efficiency: float) -> None:
    machine = steam(None, load, delta=0.03, efficiency=efficiency)
    assert machine.J == machine.J_needed == pytest.approx(machine.dE / (0.03 * machine.omega**2), rel=1e-13)
    assert machine.misses_the_wish
    assert steam(machine.J_exact, load, efficiency=efficiency).delta == pytest.approx(0.03, rel=1e-9)


def test_a_uniform_effort_needs_no_flywheel() -> None:
    machine = of_points([(0, 100), (360, 100)], RPM, delta=0.02)
    assert (machine.J, machine.delta, machine.omega_max.value) == (0, 0, OMEGA)
    with pytest.raises(UsageError, match="inertia"):
        _ = of_points([(0, 100), (360, 100)], RPM, inertia=0.0).speed


@pytest.mark.parametrize(("rpm", "size"), [(1e160, "large"), (1e170, "large"), (1e-150, "small")])
def test_speeds_beyond_all_machines_are_refused(rpm: float, size: str) -> None:
    with pytest.raises(UsageError, match=f"too {size} to compute with"):
        _ = steam(500.0, None, rpm=rpm)


def test_nothing_is_said_on_standard_error_by_numpy() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(NoSolutionError):
            _ = steam(60, Load(power=2.0)).speed
        assert steam(300.0, Load(power=1000.0)).delta > 0
