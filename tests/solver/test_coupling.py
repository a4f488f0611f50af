"""Elastic coupling: against the two masses in time by scipy, its limits, and resonance."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine.turning import Coupling, Load
from kurbel.solver.coupling import natural_frequency
from kurbel.solver.flywheel import MachineSpeed
from turning_machines import of_points

POINTS = [(0, 100), (60, 900), (60, 500), (180, 100), (240, 700), (360, 100)]
RPM, OMEGA = 60.0, 2 * math.pi


def coupled(order: float, damping: float = 20.0, inertia: float = 40.0, load: Load | None = None) -> MachineSpeed:
    """A machine whose natural order, with 60 kg m² before the coupling, is `order`."""
    stiffness = (order * OMEGA) ** 2 / (1 / 60.0 + 1 / inertia)
    return of_points(POINTS, RPM, inertia=60.0, coupling=Coupling(stiffness, inertia, damping), load=load)


def test_natural_order() -> None:
    assert coupled(2.5).natural_order == pytest.approx(2.5, rel=1e-14)
    assert natural_frequency(Coupling(stiffness=200.0, inertia=1e12), 8.0) == pytest.approx(5.0, rel=1e-9)


@pytest.mark.parametrize("order", [0.4, 2.4, 7.5])
def test_two_masses_in_time_settle_to_the_harmonic_balance(order: float) -> None:
    """Both masses about uniform rotation, J₁ ω̇₁ = M − M_K, J₂ ω̇₂ = M_K − M_m, marched until they repeat."""
    machine = coupled(order, damping=60.0)
    coupling, mean = machine.machine.coupling, machine.M_mean

    def rates(time: float, state: np.ndarray) -> list[float]:
        twist, one, two = state
        angle = np.array([math.degrees(OMEGA * time) % 360])
        torque = coupling.stiffness * twist + coupling.damping * (one - two)
        return [one - two, (machine.M(angle)[0] - mean - torque) / 60.0, torque / coupling.inertia]

    state = np.array([0.0, 0.0, 0.0])
    turns = 25
    solved = solve_ivp(
        rates, (0, turns), state, method="DOP853", rtol=1e-6, atol=1e-8, max_step=1 / 60, dense_output=True
    )
    angles = np.linspace(0, 350, 36)
    twist, one, two = solved.sol(turns - 1 + angles / 360)
    torque = mean + coupling.stiffness * twist + coupling.damping * (one - two)
    swing = np.ptp(torque)
    assert machine.M_coupling(angles) == pytest.approx(
        torque, abs=3e-3 * swing
    )  # jumps of M bend M_K where it is damped
    drift = one.mean() - (machine.omega_line(angles) - OMEGA).mean()  # the load holds no speed of its own
    assert machine.omega_line(angles) - OMEGA == pytest.approx(one - drift, abs=2e-3 * np.ptp(one))


def test_a_soft_coupling_passes_the_mean_only() -> None:
    machine = coupled(0.05, damping=0.5)
    assert machine.elastic.amplification < 0.01
    assert machine.elastic.M_coupling_max.value == pytest.approx(machine.M_mean, rel=0.02)
    # the cranks then swing as if they were alone
    alone = of_points(POINTS, RPM, inertia=60.0)
    assert machine.delta == pytest.approx(alone.delta_book, rel=0.02)


def test_a_stiff_coupling_passes_what_a_rigid_one_does() -> None:
    machine = coupled(90.0, damping=5000.0)
    assert not machine.rigid
    assert 1 <= machine.elastic.amplification < 1.2  # the jumps of the effort still let it ring a little
    assert machine.delta == pytest.approx(machine.dE / (100.0 * OMEGA**2), rel=0.02)


def test_above_order_100_the_coupling_is_rigid() -> None:
    machine = coupled(101.0)
    assert machine.rigid
    assert machine.elastic is None
    together = of_points(POINTS, RPM, inertia=100.0)
    assert machine.delta == together.delta
    assert machine.delta_book == together.delta_book


def test_resonance_is_named_with_its_harmonic() -> None:
    near = coupled(2.05).elastic.resonances
    assert [h.order for h in near] == [2.0]
    assert near[0].distance == pytest.approx(2 / 2.05 - 1)
    assert near[0].amplification > 5
    assert coupled(2.5).elastic.resonances == ()


def test_resonance_without_damping_has_no_solution() -> None:
    with pytest.raises(NoSolutionError, match=r"resonance with harmonic 2 .*coupling\.damping"):
        _ = coupled(2.0, damping=0.0).delta
    assert coupled(2.0, damping=1.0).elastic.amplification > 3


def test_a_load_that_rises_with_the_speed_damps() -> None:
    """In resonance the driven side keeps its speed the more, the stiffer the load; k = 2 M_m/ω_n for a fan."""
    free, held = coupled(2.0, damping=1.0), coupled(2.0, damping=1.0, load=Load(power=2.0))
    assert held.elastic.amplification < free.elastic.amplification
    assert held.elastic.shaft.load_slope == pytest.approx(2 * held.M_mean / OMEGA, rel=1e-13)


def test_a_speed_that_falls_to_zero_is_a_stall_with_its_angle() -> None:
    light = of_points(POINTS, RPM, inertia=3.0, coupling=Coupling(20.0, 3.0))
    with pytest.raises(NoSolutionError, match=r"stops near φ = [\d.]+°: with J = 3 kg m\^2 and the elastic") as stop:
        _ = light.delta
    enough = float(str(stop.value).partition("from J = ")[2].partition(" kg")[0])
    assert of_points(POINTS, RPM, inertia=enough, coupling=Coupling(20.0, 3.0)).omega_min.value > 0
    assert coupled(0.4).omega_min.value > 0


def test_no_inertia_before_the_coupling_is_refused() -> None:
    with pytest.raises(UsageError, match="nothing before the coupling has any inertia"):
        _ = of_points(POINTS, RPM, inertia=0.0, coupling=Coupling(2631.0, 20.0)).speed
    uniform = of_points([(0, 100), (360, 100)], RPM, delta=0.02, coupling=Coupling(1e6, 30.0))
    assert (uniform.J, uniform.delta) == (0, 0)


@pytest.mark.parametrize("power", [-3.0, -1.0, 1.0, 2.0])
def test_what_is_left_of_a_disturbance_after_a_turn(power: float) -> None:
    """scipy marches the two linearised masses, J₁ ω̇₁ = −T, J₂ ω̇₂ = T − c ω₂, for a turn from three states."""
    machine = coupled(2.5, damping=60.0, load=Load(power=power))
    coupling, slope = machine.machine.coupling, power * machine.M_mean / OMEGA

    def rates(_: float, state: np.ndarray) -> list[float]:
        twist, one, two = state
        torque = coupling.stiffness * twist + coupling.damping * (one - two)
        return [one - two, -torque / 60.0, (torque - slope * two) / coupling.inertia]

    after = [solve_ivp(rates, (0, 1), start, method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1] for start in np.eye(3)]
    assert machine.multiplier == pytest.approx(np.abs(np.linalg.eigvals(np.array(after))).max(), rel=1e-8)
    assert (machine.multiplier > 1) == (power < 0)


def test_a_load_without_a_speed_of_its_own_has_no_multiplier() -> None:
    assert coupled(2.5).multiplier is None
    assert coupled(2.5).elastic.growth == pytest.approx(0, abs=1e-9)


def test_what_is_damped_is_no_resonance() -> None:
    assert coupled(2.05, damping=1e5).elastic.resonances == ()
