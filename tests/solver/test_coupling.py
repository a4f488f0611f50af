"""Elastic coupling: against the two masses in time by scipy, its limits, resonance, and the flywheel for a wish."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from kurbel.errors import NoSolutionError
from kurbel.machine.shaft_side import Coupling, Load
from kurbel.solver.chapters.coupling import natural_order
from kurbel.solver.flywheel import MachineTurning
from representative import few
from turning_machines import of_points

POINTS = [(0, 100), (60, 900), (60, 500), (180, 100), (240, 700), (360, 100)]
Points = Sequence[tuple[float, float]]
RPM, OMEGA = 60.0, 2 * math.pi


def coupled(
    order: float, damping: float = 20.0, inertia: float = 40.0, load: Load | None = None
) -> MachineTurning:
    """A machine whose natural order, with 60 kg m² before the coupling, is `order`."""
    stiffness = (order * OMEGA) ** 2 / (1 / 60.0 + 1 / inertia)
    return of_points(
        POINTS, RPM, inertia=60.0, coupling=Coupling(stiffness, inertia, damping), load=load
    )


def test_natural_order() -> None:
    assert coupled(2.5).natural_order == pytest.approx(2.5, rel=1e-14)
    assert natural_order(
        Coupling(stiffness=200.0, inertia=1e12), np.array(8.0), 1.0
    ) == pytest.approx(5.0, rel=1e-9)


ADVISED = [(0.01, 3e3), (0.02, 1e5), (0.005, 2e4), (0.05, 40.0)]


@pytest.mark.parametrize(("delta", "stiffness"), few(ADVISED, [ADVISED[1], ADVISED[3]]))
def test_the_advised_flywheel_meets_the_wish_on_the_coupling(
    delta: float, stiffness: float
) -> None:
    coupling = Coupling(stiffness, 40.0, 20.0)
    machine = of_points(POINTS, RPM, delta=delta, coupling=coupling)
    assert machine.misses_wanted_delta
    assert of_points(
        POINTS, RPM, inertia=machine.J_exact, coupling=coupling
    ).delta == pytest.approx(delta, rel=1e-9)


def test_above_order_100_the_coupling_is_rigid() -> None:
    machine = coupled(101.0)
    assert machine.rigid
    assert machine.elastic is None
    together = of_points(POINTS, RPM, inertia=100.0)
    assert machine.delta == together.delta
    assert machine.delta_book == together.delta_book


SMOOTH = [(0, 100), (60, 900), (180, 100), (240, 700), (360, 100)]


@pytest.mark.parametrize("load", [None, Load(power=2.0), Load(slip=0.05)])
def test_torque_of_a_stiff_coupling(load: Load | None) -> None:
    """T = M − J₁ α, by the balance of the cranks alone: of the load and the driven inertia nothing is used."""
    stiffness = (150 * OMEGA) ** 2 / (1 / 60.0 + 1 / 40.0)
    coupling = Coupling(stiffness, 40.0, 20.0)
    machine = of_points(POINTS, RPM, inertia=60.0, coupling=coupling, load=load)
    phi = np.array([10.0, 59.0, 61.0, 140.0, 200.0, 300.0])
    result = machine.at(phi)
    assert result.M_coupling == pytest.approx(result.M - 60.0 * result.alpha, rel=1e-11)
    before, after = machine.at([60.0, 60.0], within=np.array([59.0, 61.0])).M_coupling
    assert before - after == pytest.approx(0.4 * 400, rel=1e-9)  # the jump, by J₂/(J₁ + J₂)
    assert machine.M_coupling_max.value == pytest.approx(before, rel=1e-9)
    assert machine.M_coupling_max.degrees == pytest.approx(60.0, abs=1e-9)
    assert machine.amplification == 1.0


def test_the_torque_of_a_damped_coupling_becomes_that_of_a_stiff_one() -> None:
    """Just below order 100 what is left is the vibration after the corners of the effort, of about 1/n."""
    stiff, elastic = (
        of_points(
            SMOOTH, RPM, inertia=60.0, coupling=Coupling((n * OMEGA) ** 2 * 24.0, 40.0, 2000.0)
        )
        for n in (120.0, 99.0)
    )
    assert stiff.rigid
    assert not elastic.rigid
    swing = stiff.M_coupling_max.value - stiff.M_coupling_min.value
    assert elastic.M_coupling_max.value == pytest.approx(
        stiff.M_coupling_max.value, abs=0.01 * swing
    )
    assert elastic.M_coupling_min.value == pytest.approx(
        stiff.M_coupling_min.value, abs=0.01 * swing
    )


def test_resonance_is_named_with_its_harmonic() -> None:
    near = coupled(2.05).elastic.resonances
    assert [h.order for h in near] == [2.0]
    assert near[0].distance == pytest.approx(2 / 2.05 - 1)
    assert near[0].amplification > 5
    assert coupled(2.5).elastic.resonances == ()


def test_resonance_without_damping_has_no_solution() -> None:
    with pytest.raises(NoSolutionError, match=r"resonance with harmonic 2 .*coupling\.damping"):
        _ = coupled(2.0, damping=0.0).delta
    assert coupled(2.0, damping=40.0).elastic.amplification > 3


def test_a_speed_that_falls_to_zero_is_a_stall_with_its_angle() -> None:
    light = of_points(POINTS, RPM, inertia=3.0, coupling=Coupling(20.0, 3.0))
    with pytest.raises(
        NoSolutionError, match=r"stops near φ = [\d.]+°: with J = 3 kg m\^2 and the elastic"
    ) as stop:
        _ = light.delta
    enough = float(str(stop.value).partition("from J = ")[2].partition(" kg")[0])
    assert of_points(POINTS, RPM, inertia=enough, coupling=Coupling(20.0, 3.0)).omega_min.value > 0
    assert coupled(0.4).omega_min.value > 0


def under_a_law(
    machine: MachineTurning, torque: Points, law: Any, own: float
) -> tuple[np.ndarray, np.ndarray]:
    """Angles, torque in the coupling and ω₁ of the motion that repeats, and what a turn makes of small disturbances.

    J₁ ω̇₁ = M − T and J₂ ω̇₂ = T − L(ω₂) with their variations, by scipy and Newton's method for the start.
    law: L and its slope at ω₂.
    """
    coupling, omega = machine.machine.coupling, machine.omega
    k, d, driven = coupling.stiffness, coupling.damping, coupling.inertia
    corners = sorted({angle for angle, _ in torque})

    def turn(start: np.ndarray, dense: bool = False) -> tuple[np.ndarray, list[np.ndarray]]:
        state, rows = np.concatenate((start, np.eye(3).ravel())), []
        for low, high in pairwise(corners):
            first, last = np.interp([low + 1e-9, high - 1e-9], *zip(*torque))

            def rates(
                phi: float,
                flat: np.ndarray,
                low: float = low,
                high: float = high,
                ends: Any = (first, last),
            ) -> np.ndarray:
                (twist, one, two), varied = flat[:3], flat[3:].reshape(3, 3)
                load, slope = law(two)
                passed = k * twist + d * (one - two)
                of_passed = np.array([k, d, -d])
                driving = ends[0] + (phi - low) / (high - low) * (ends[1] - ends[0])
                jacobian = np.array(
                    [[0, 1, -1], -of_passed / own, (of_passed - [0, 0, slope]) / driven]
                )
                here = np.array([one - two, (driving - passed) / own, (passed - load) / driven])
                return np.concatenate((here, (jacobian @ varied).ravel())) * (math.pi / 180 / omega)

            at = np.linspace(low, high, 20) if dense else None
            solved = solve_ivp(
                rates, (low, high), state, method="DOP853", rtol=1e-13, atol=1e-14, t_eval=at
            )
            state = solved.y[:, -1]
            rows.append(np.vstack((solved.t, solved.y[:3])))
        return state, rows

    start = np.array([machine.M_mean / k, omega, omega])
    for _ in range(
        9
    ):  # under a constant load every mean speed repeats: the step that does not change it is taken
        state, _ = turn(start)
        start = (
            start
            - np.linalg.lstsq(state[3:].reshape(3, 3) - np.eye(3), state[:3] - start, rcond=1e-9)[0]
        )
    state, rows = turn(start, dense=True)
    angles, twist, one, two = np.hstack(rows)
    return np.stack((angles, k * twist + d * (one - two), one)), state[3:].reshape(3, 3)


LAWS = [Load(power=2.0), Load(power=-3.0), Load(power=0.5), Load(slip=0.05), None]
UNDER = [*((order, load) for order in (0.8, 2.5) for load in LAWS), (0.4, None), (7.5, None)]
KEPT = [(0.8, LAWS[1]), (0.8, LAWS[3]), (0.4, None), (2.5, None), (7.5, None)]


@pytest.mark.parametrize(
    ("order", "load"),
    few(UNDER, KEPT, [f"{order}-{load and (load.power or load.slip)}" for order, load in UNDER]),
)
def test_two_masses_under_a_load_over_the_speed(order: float, load: Load | None) -> None:
    """Where the effort jumps and the load is no straight line: nothing is taken as linear about the mean speed."""
    machine = coupled(order, damping=60.0, load=load)
    mean = machine.M_mean

    def law(speed: float) -> tuple[float, float]:
        if load is None:
            return mean, 0.0
        if load.slip:
            return mean * (1 + (speed / OMEGA - 1) / load.slip), mean / (load.slip * OMEGA)
        return mean * (speed / OMEGA) ** load.power, load.power * mean * speed ** (
            load.power - 1
        ) / OMEGA**load.power

    (angles, torque, speed), after = under_a_law(machine, POINTS, law, 60.0)
    inside = np.abs(angles[:, None] - np.array([a for a, _ in POINTS])).min(axis=1) > 1e-6
    result = machine.at(angles[inside])
    assert result.M_coupling == pytest.approx(torque[inside], abs=1e-9 * np.ptp(torque))
    if load is None:
        assert result.omega - result.omega.mean() == pytest.approx(
            speed[inside] - speed[inside].mean(), abs=1e-9 * np.ptp(speed)
        )
        return
    assert result.omega == pytest.approx(speed[inside], abs=1e-9 * np.ptp(speed))
    assert machine.multiplier == pytest.approx(np.abs(np.linalg.eigvals(after)).max(), rel=1e-9)
    assert (machine.multiplier > 1) == (load.power == -3.0)


@pytest.mark.parametrize("slip", [0.05, 0.02])
def test_amplification_of_a_harmonic_under_a_load_over_the_speed(slip: float) -> None:
    """Both equations as a linear system: −Ω² J₁ θ₁ = M − T, (−Ω² J₂ + iΩ c) θ₂ = −(−T), T = (k + iΩ d)(θ₁ − θ₂)."""
    machine = coupled(2.05, damping=60.0, load=Load(slip=slip))
    (near,) = [resonance for resonance in machine.elastic.resonances if resonance.order == 2.0]
    coupling, turning = machine.machine.coupling, 2.0 * OMEGA
    spring = coupling.stiffness + 1j * turning * coupling.damping
    slope = machine.M_mean / (slip * OMEGA)
    system = np.array(
        [
            [spring - turning**2 * 60.0, -spring],
            [-spring, spring - turning**2 * 40.0 + 1j * turning * slope],
        ]
    )
    first, second = np.linalg.solve(system, [1.0, 0.0])
    passed = abs(spring * (first - second))
    assert near.amplification == pytest.approx(passed / (40.0 / 100.0), rel=1e-9)
