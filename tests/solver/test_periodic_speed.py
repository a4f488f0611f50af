"""The speed of the shaft over a cycle: exact solutions, laws, stalling, and the angular acceleration."""

import math
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np
import pytest

from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Indicator
from kurbel.machine.parts import Masses, Piston
from kurbel.machine.shaft_side import Flywheel, Load
from kurbel.machine_file import load, loads
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.flywheel import MachineTurning
from machines import STEAM_CARD
from representative import CONFIGS, few
from turning_machines import of_points, rectangles

POINTS = [
    (0, 500),
    (40, 1500),
    (40, 900),
    (120, 200),
    (200, 300),
    (200, 1300),
    (290, 100),
    (360, 250),
]
ANGLES = np.array([0.0, 1e-3, 20.0, 39.999, 40.0, 40.001, 100.0, 180.0, 200.0, 233.3, 300.0, 359.9])
RPM = 60.0
OMEGA = 2 * math.pi
CYLINDER = Cylinder(
    SliderCrank(0.4, 2.0),
    pistons=(
        Piston(
            0.45, head_end_rod=0.075, crank_end_rod=0.1, indicator=Indicator(STEAM_CARD, STEAM_CARD)
        ),
    ),
    masses=Masses(826.0),
)


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
    return Case(
        Machine(cylinders, speed=rpm / 60, flywheel=Flywheel(inertia, delta), load=load, **machine)
    ).flywheel


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
            (mp.radians(a1) - mp.radians(a0)) * (mp.mpf(m0) + m1) / 2
            for (a0, m0), (a1, m1) in pairwise(POINTS)
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
def test_a_machine_that_stalls_reports_where_and_what_flywheel_would_do(load: Load | None) -> None:
    with pytest.raises(NoSolutionError, match=r"stops near φ = [\d.]+°.* from J = ") as caught:
        _ = steam(60, load).speed
    enough = float(str(caught.value).partition("from J = ")[2].partition(" kg")[0])
    assert steam(enough, load).omega_min.value > 0
    with pytest.raises(NoSolutionError):
        _ = steam(0.9 * enough, load).speed


def test_the_multiplier_is_exact_far_beyond_what_a_stability_function_can() -> None:
    """A fan: μ = exp(−∮ k M_m/(J ω_n²) dφ), whatever ω does; below the smallest float it is 0."""
    for inertia, exponent in ((1.0, None), (30.0, None), (0.01, 0.0)):
        machine = of_points(rectangle_above_zero(), RPM, inertia=inertia, load=Load(power=2.0))
        expected = math.exp(-2 * 2 * math.pi * machine.M_mean / (inertia * OMEGA**2))
        assert machine.multiplier == pytest.approx(expected, rel=1e-11)
        assert exponent is None or machine.multiplier == exponent


def rectangle_above_zero() -> list[tuple[float, float]]:
    return [(0, 500), (180, 500), (180, 300), (360, 300)]


WISHED = [(None, 1.0), (Load(slip=0.02), 1.0), (Load(slip=0.02), 0.85), (None, 0.7)]


@pytest.mark.parametrize(("slip", "wish"), [("1e-6", "5 %"), ("0.01", "1/50")])
def test_where_the_load_holds_the_speed_the_search_for_a_flywheel_ends_soon(
    slip: str, wish: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a stiff load δ is at most about ΔM s/M, whatever the flywheel: more cannot be had by less inertia."""
    machine = loads(
        "{speed: 50 rpm, crank: 400 mm, rod: 2 m, bore: 450 mm, masses: {piston: 500 kg}, indicator: {head_end: "
        "{constant: {expansion: 5 bar, compression: 0 bar}}, crank_end: mirrored}, "
        f"flywheel: {{fluctuation: {wish}}}, load: {{slip: {slip}}}}}"
    )
    tried: list[float] = []
    delta_with = MachineTurning._delta_with

    def noted(turning: MachineTurning, flywheel: float) -> float:
        tried.append(delta_with(turning, flywheel))
        return tried[-1]

    monkeypatch.setattr(MachineTurning, "_delta_with", noted)
    turning = Case(machine).flywheel
    assert turning.J_exact is None
    assert turning._wanted is not None
    assert max(tried) < turning._wanted
    assert len(tried) < 8


@pytest.mark.parametrize(("load", "efficiency"), few(WISHED, [WISHED[0], WISHED[2]]))
def test_the_exact_flywheel_meets_the_wish(load: Load | None, efficiency: float) -> None:
    machine = steam(None, load, delta=0.03, efficiency=efficiency)
    assert (
        machine.J
        == machine.J_needed
        == pytest.approx(machine.dE / (0.03 * machine.omega**2), rel=1e-13)
    )
    assert machine.misses_wanted_delta
    assert steam(machine.J_exact, load, efficiency=efficiency).delta == pytest.approx(
        0.03, rel=1e-9
    )


# the angular acceleration of the shaft: by Newton's law where the inertia is constant, else as the slope of ω²/2

ENGINE = """
speed: 300 rpm
crank: 100 mm
rod: 400 mm
bore: 200 mm
masses: {piston: 30 kg}
flywheel: {inertia: 4 kg m2}
indicator: {head_end: {constant: {expansion: 5 bar, compression: 0.5 bar}}}
"""


def test_over_a_constant_inertia_it_is_the_excess_torque() -> None:
    """Rectangles of ±60 J over a quarter turn each, J = 2 kg m²: α = ±60/(π/2)/2 rad/s², with jumps between."""
    turning = of_points(rectangles([60, -60, 60, -60], mean=100.0), rpm=200, inertia=2.0)
    expected = 60 / (np.pi / 2) / 2
    assert turning.at(np.array([10.0, 100.0, 190.0, 280.0])).alpha == pytest.approx(
        [expected, -expected, expected, -expected], rel=1e-11
    )
    assert (turning.alpha_max.value, turning.alpha_min.value) == pytest.approx(
        (expected, -expected), rel=1e-11
    )


@cache
def _solved(name: str) -> MachineTurning:
    more = {"constant": "", "power law": "load: {power_law: 2}\n", "slip": "load: {slip: 2 %}\n"}
    return (
        Case(loads(ENGINE + more[name])).flywheel
        if name in more
        else Case(load(CONFIGS[name])).flywheel
    )


@pytest.mark.parametrize(
    "name",
    [
        "constant",
        "power law",
        "slip",
        "four-cylinder-generator",
        "coupled-blower",
        "waterworks-two-cranks",
    ],
)
def test_it_is_the_slope_of_half_the_square_of_the_speed(name: str) -> None:
    """α = ½ dω²/dφ by central differences; with an elastic coupling ω_n dω/dφ, its speed line being linear."""
    turning = _solved(name)
    degrees, step = np.arange(3.3, 360.0, 7.1), 1e-3
    before, here, after = (turning.at(degrees + by).omega for by in (-step, 0.0, step))
    alpha = turning.at(degrees).alpha
    slope = (after - before) / np.radians(2 * step)
    speed = turning.omega if turning.elastic else here
    assert alpha == pytest.approx(slope * speed, abs=1e-5 * np.abs(alpha).max())
