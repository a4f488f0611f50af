"""Forced torsional vibration: order by order, over the angle, by its energy, and with the coupling of the flywheel."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

from kurbel.machine import Machine
from kurbel.machine.shaft_line import ShaftLine, ShaftMass, ShaftPart, ShaftPiece, line_of
from kurbel.machine.turning import Coupling, Effort, Flywheel, Harmonics, Load
from kurbel.machine_file import load
from kurbel.numerics.collocation import periodic
from kurbel.numerics.pieces import Angles, Pieces
from kurbel.numerics.waves import crests
from kurbel.solver.case import Case
from kurbel.solver.chain import Chain, ChainEquation, Modes, passing, response
from kurbel.solver.effort import corners, torque_on
from kurbel.solver.harmonics import amplitudes
from kurbel.solver.torsion import Excitation, ShaftVibration, Vibration

CONFIGS = Path(__file__).parent.parent.parent / "configs"
POINTS = [(0, 100), (60, 900), (60, 500), (180, 100), (240, 700), (360, 100)]


def damped(count: int, ground: str, seed: int, loss: float = 0.03) -> Chain:
    draw = np.random.default_rng(seed)
    pieces = count if ground else count - 1
    return Chain(
        10 ** draw.uniform(-1, 1, count),
        10 ** draw.uniform(3, 5, pieces),
        draw.uniform(0, 5, pieces),
        draw.uniform(0, 5, count),
        draw.uniform(0, loss, pieces) if loss else np.zeros(pieces),
        ground,
    )


@pytest.mark.parametrize("ground", ["", "before", "after"])
@pytest.mark.parametrize("count", [1, 2, 5, 12])
def test_every_order_solves_its_equations(count: int, ground: str) -> None:
    """(K (1 + iη) + iνω C − (νω)² J) θ = M, with 40 digits by mpmath."""
    if count == 1 and not ground:
        return
    chain = damped(count, ground, 3)
    frequencies = np.array([[0.7, 20.0], [150.0, 900.0]])
    draw = np.random.default_rng(4)
    torques = draw.normal(size=(count, 2, 2)) + 1j * draw.normal(size=(count, 2, 2))
    found = response(chain, frequencies, torques).angles
    for place, w in np.ndenumerate(frequencies):
        with mpmath.workdps(40):
            still, dampers = (mpmath.diag(one.tolist()) for one in (chain.stiffnesses, chain.segment_damping))
            losses, frequency = mpmath.diag((1 + 1j * chain.loss).tolist()), mpmath.mpf(w)
            twists, jw = mpmath.matrix(chain.twists.tolist()), mpmath.mpc(0, frequency)
            whole = twists.T * (still * losses + jw * dampers) * twists + jw * mpmath.diag(chain.mass_damping.tolist())
            whole -= frequency**2 * mpmath.diag(chain.inertias.tolist())
            sides = mpmath.matrix([complex(one) for one in torques[(slice(None), *place)]])
            exact = mpmath.lu_solve(whole, sides)
        wanted = np.array([complex(one) for one in exact])
        assert found[(slice(None), *place)] == pytest.approx(wanted, abs=1e-12 * np.abs(wanted).max())


def test_a_piece_of_the_chain_in_resonance_by_itself_is_no_harm() -> None:
    """The first two masses alone, the third held, swing at √(k/J) (√5 − 1)/2: their pivot vanishes there."""
    chain = Chain(np.ones(4), np.ones(3), np.zeros(3), np.array([0.0, 0, 0, 0.1]), np.zeros(3))
    frequencies = np.array([(math.sqrt(5) - 1) / 2, 1.0])
    torques = np.zeros((4, 2), dtype=complex)
    torques[0] = 1.0
    found = response(chain, frequencies, torques).angles
    for column, w in enumerate(frequencies):
        whole = chain.twists.T @ chain.twists + np.diag(1j * w * chain.mass_damping - w * w)
        assert whole @ found[:, column] == pytest.approx(torques[:, column], abs=1e-14)


def machine_of(load: Load | None = None, effort: Any = None, damping: float = 60.0, order: float = 2.4) -> Machine:
    """Masses of 60 and 40 kg m² on a coupling, whose natural order at 60 rpm is `order`."""
    stiffness = (order * 2 * math.pi) ** 2 / (1 / 60.0 + 1 / 40.0)
    if effort is None:
        effort = Effort(*(tuple(map(float, one)) for one in zip(*POINTS)))
    coupling = Coupling(stiffness, 40.0, damping)
    return Machine((), effort=effort, speed=1.0, flywheel=Flywheel(60.0), coupling=coupling, load=load)


def orders_over_the_angle(pieces: Pieces, torques: np.ndarray, orders: np.ndarray) -> np.ndarray:
    """The complex amplitudes (q, k) of torques (q, nodes, pieces) of one machine."""
    return amplitudes(pieces, torques, orders)[..., 0]


@pytest.mark.parametrize("load", [None, Load(slip=0.05)], ids=["constant", "slip"])
def test_the_coupling_of_the_flywheel_with_all_its_orders(load: Load | None) -> None:
    """An effort that has three orders: the same torque over the angle, and the same extremes."""
    case = Case(machine_of(load, Harmonics(400.0, ((1.0, 30.0, -50.0), (2.0, 80.0, 20.0), (5.0, 0.0, 60.0)))))
    (piece,) = case.torsion.pieces
    angles = np.linspace(0, 360, 73)
    assert piece.at(angles).M_shaft == pytest.approx(case.flywheel.at(angles).M_coupling, rel=1e-12)
    assert piece.M_shaft_max == pytest.approx(case.flywheel.elastic.M_coupling_max.value, rel=1e-12)
    assert piece.M_shaft_min == pytest.approx(case.flywheel.elastic.M_coupling_min.value, rel=1e-12)


@pytest.mark.parametrize(
    "load",
    [
        None,
        Load(slip=0.05),
        Load(power=3.0),
        Load(diagram=Effort((0.0, 100.0, 100.0, 360.0), (9.0, 9.0, 400.0, 400.0))),
    ],
    ids=["constant", "slip", "power", "diagram"],
)
def test_the_coupling_of_the_flywheel_where_the_effort_jumps(load: Load | None) -> None:
    """All orders of a jump, not the first 24 of them: wave and extremes as `flywheel` has them."""
    case = Case(machine_of(load))
    (piece,) = case.torsion.pieces
    angles = np.linspace(0, 360, 73)
    wanted = case.flywheel.at(angles).M_coupling
    assert piece.at(angles).M_shaft == pytest.approx(wanted, abs=1e-12 * np.abs(wanted).max())
    assert piece.M_shaft_max == pytest.approx(case.flywheel.elastic.M_coupling_max.value, rel=1e-12)
    assert piece.M_shaft_min == pytest.approx(case.flywheel.elastic.M_coupling_min.value, rel=1e-12)


PISTONS = """
name: two cylinders behind a gear
speed: 300 rpm
efficiency: 0.85
cylinders:
  - {name: one, crank: 100 mm, rod: 400 mm, bore: 200 mm, masses: {reciprocating: 20 kg},
     indicator: {head_end: {constant: {expansion: 5 bar, compression: 1 bar}}}}
  - {name: two, like: one, crank_position: 90 deg}
load: {slip: 0.1}
shaft:
  - {cylinder: one, inertia: 2 kg m2}
  - {stiffness: 40 kN m/rad, damping: 12 N m s/rad}
  - {cylinder: two, inertia: 2 kg m2, damping: 3 N m s/rad}
  - {stiffness: 60 kN m/rad, damping: 4 N m s/rad}
  - {inertia: 3 kg m2}
  - {gear: 2}
  - {stiffness: 5 kN m/rad, damping: 9 N m s/rad}
  - {inertia: 1 kg m2}
"""


PUMP = """
     tandem: [{bore: 100 mm, indicator: {head_end: {constant: {expansion: 0 bar, compression: 4 bar}}}}],
     indicator"""


@pytest.mark.parametrize("text", [PISTONS, PISTONS.replace("\n     indicator", PUMP)], ids=["driving", "with pumps"])
def test_all_orders_of_a_shaft_line_hold_each_of_them(text: str, tmp_path: Path) -> None:
    """Cylinders, efficiency, a gear, and a load that slips: over the angle the same orders as order by order."""
    (tmp_path / "machine.yaml").write_text(text)
    found = Case(load(tmp_path / "machine.yaml")).torsion
    assert found.remainder is None
    size = np.abs(found.vibration.torques).max()
    ratios = np.array([piece.ratio for piece in found.line.pieces])
    over_the_angle = orders_over_the_angle(*found.steady, found.orders) / ratios[:, None]
    assert over_the_angle == pytest.approx(found.vibration.torques[:, 0], abs=1e-12 * size)


def test_of_a_loss_factor_the_orders_are_told_with_what_is_left(tmp_path: Path) -> None:
    """Eight times as many orders as the usual ones, of which half are summed, add no more than is told."""
    (tmp_path / "machine.yaml").write_text(PISTONS.replace("damping: 4 N m s/rad", "loss_factor: 0.02"))
    case = Case(load(tmp_path / "machine.yaml"))
    few, many = case.torsion, case.torsion_of(np.arange(1.0, 193.0))
    assert few.steady is None
    assert many.remainder is None
    for one, other in zip(few.pieces, many.pieces):
        assert abs(one.M_vibratory - other.M_vibratory) < few.remainder < 0.03 * few.M_vibratory
        assert abs(one.M_vibratory - other.M_vibratory) < 1e-3 * few.M_vibratory


@pytest.mark.parametrize("ground", ["", "after"])
def test_longer_chains_over_the_angle_have_the_same_orders(ground: str) -> None:
    """Collocation in 2n − 1 or 2n unknowns, driven at two masses by torques that jump."""
    chain, omega = damped(3, ground, 11, loss=0.0), 30.0
    efforts = [
        Effort(*(tuple(map(float, one)) for one in zip(*points)))
        for points in (POINTS, [(0, 50), (100, 50), (100, 300), (360, 300)])
    ]
    breaks = np.concatenate([corners(one, 360.0) for one in efforts])
    pieces = Pieces.between(Angles(np.zeros(len(breaks), dtype=int), breaks), 1, 360.0)
    torques = np.zeros((3, *pieces.degrees.shape))
    torques[0], torques[2] = (torque_on(one, pieces) for one in efforts)
    torques -= pieces.mean(torques)[:, None]

    orders = np.arange(1.0, 13.0)
    acting = orders_over_the_angle(pieces, torques, orders)
    wanted = passing(chain, orders * omega, response(chain, orders * omega, acting).angles)
    equation = ChainEquation(chain, Modes(chain).omegas[-1] / omega, omega, pieces, torques)
    solved = periodic(equation, equation.pieces)
    found = orders_over_the_angle(solved.pieces, equation.torques(solved.samples, solved.pieces), orders)
    assert found == pytest.approx(wanted, abs=1e-12 * np.abs(wanted).max())


def test_the_damping_takes_what_the_torques_give() -> None:
    for name in ("generator-coupling", "marine-diesel", "torsional-damper", "coupled-blower"):
        vibration = Case(load(CONFIGS / f"{name}.yaml")).torsion.vibration
        assert vibration.loss[0] > 0
        speeds = 1j * vibration.acting.orders * vibration.omegas[0] * vibration.angles[:, 0]
        power = (vibration.driving[:, 0] * speeds.conj()).real.sum() / 2
        assert power == pytest.approx(vibration.loss[0], rel=1e-12)


def shaft(effort: Any, speed: float, *parts: Any, **more: Any) -> ShaftVibration:
    return Case(Machine((), effort=effort, speed=speed, shaft=line_of(parts), **more)).torsion


def test_two_masses_in_closed_form() -> None:
    """T = k (1 + iη) M/J₁ /(ω_e² (1 + iη) − ω²), ω_e² = k (J₁ + J₂)/(J₁J₂); at resonance with the magnifier 1/η."""
    first, second, stiffness, loss = 3.0, 7.0, 2000.0, 0.02
    resonance = math.sqrt(stiffness * (1 / first + 1 / second)) / (2 * math.pi)
    parts = (ShaftPart(inertia=first), ShaftPart(stiffness=stiffness, loss_factor=loss), ShaftPart(inertia=second))
    for speed in (0.4 * resonance, resonance / 2, resonance, 3.0 * resonance):
        found = shaft(Harmonics(10.0, ((2.0, 6.0, 8.0),)), speed, *parts)
        square, spring = (4 * math.pi * speed) ** 2, 1 + 1j * loss
        exact = stiffness * spring * (6 - 8j) / first / ((2 * math.pi * resonance) ** 2 * spring - square)
        assert found.vibration.torques[0, 0, 1] == pytest.approx(exact, rel=1e-12)
        assert found.vibration_loss == pytest.approx(
            loss * stiffness * 4 * math.pi * speed * abs(exact / (stiffness * spring)) ** 2 / 2, rel=1e-12
        )
    at_resonance = shaft(Harmonics(10.0, ((2.0, 6.0, 8.0),)), resonance / 2, *parts).pieces[0]
    static = 10.0 * second / (first + second)
    assert at_resonance.M_vibratory == pytest.approx(static * abs(1 + 1j * loss) / loss, rel=1e-12)


@pytest.mark.parametrize("stiff", [1.0, 1e4])
def test_what_rounding_bounds_is_not_told(stiff: float) -> None:
    """At the resonance of a loss factor of 10⁻⁵ … 10⁻¹⁶: four digits against mpmath, or no answer.

    A stiff piece before the two masses takes digits of the soft one.
    """
    told = []
    for exponent in range(5, 17):
        loss = 10.0**-exponent
        inertias, stiffnesses = np.array([1.0, 2.0, 7.0]), np.array([2e3 * stiff, 2e3])
        chain = Chain(inertias, stiffnesses, np.zeros(2), np.zeros(3), np.full(2, loss))
        speed = float(Modes(chain).omegas[1])
        line = ShaftLine(tuple(ShaftMass("", one) for one in chain.inertias), (ShaftPiece(1.0),) * 2)
        torques = np.array([[5.0 - 2j], [-4.0], [1.0]])
        nothing = np.zeros(3)
        found = Vibration(
            chain, line, Excitation(1.0, np.ones(1), torques, 0 * torques, nothing, nothing), np.array([speed])
        )
        told.append(not found.endless[0])
        with mpmath.workdps(40):
            springs = mpmath.diag([one * (1 + mpmath.mpc(0, loss)) for one in chain.stiffnesses.tolist()])
            twists = mpmath.matrix(chain.twists.tolist())
            inertia = mpmath.diag([mpmath.mpf(speed) ** 2 * one for one in chain.inertias.tolist()])
            angles = mpmath.lu_solve(twists.T * springs * twists - inertia, mpmath.matrix(torques[:, 0].tolist()))
            exact = np.array([complex(one) for one in springs * (twists * angles)])
        if told[-1]:
            assert found.torques[:, 0, 0] == pytest.approx(exact, abs=1e-4 * np.abs(exact).max())
    assert told == sorted(told, reverse=True)
    assert (told[1], told[-3]) == (True, False)


def test_a_gear_is_the_chain_referred_to_one_shaft() -> None:
    """The torque behind the gear is that of the referred chain over u, its stress that of its own section."""
    effort = Harmonics(10.0, ((1.0, 3.0, 2.0), (3.0, 1.0, -2.0)))
    behind = (ShaftPart(diameter=0.03, length=0.5, loss_factor=0.05), ShaftPart(inertia=0.4))
    before = (ShaftPart(inertia=2.0), ShaftPart(stiffness=5e4, loss_factor=0.01), ShaftPart(inertia=0.3))
    geared = shaft(effort, 10.0, *before, ShaftPart(gear=2.5), ShaftPart(inertia=0.1), *behind)
    stiffness = 82e9 * math.pi * 0.03**4 / 32 / 0.5 * 2.5**2
    plain = shaft(
        effort,
        10.0,
        *before[:2],
        ShaftPart(inertia=0.3 + 0.1 * 2.5**2),
        ShaftPart(stiffness=stiffness, loss_factor=0.05),
        ShaftPart(inertia=0.4 * 2.5**2),
    )
    assert geared.modes.omegas == pytest.approx(plain.modes.omegas, rel=1e-14)
    one, other = geared.pieces[1], plain.pieces[1]
    assert one.M_vibratory == pytest.approx(other.M_vibratory / 2.5, rel=1e-12)
    assert one.M_shaft_mean == pytest.approx(4.0, rel=1e-14)
    assert one.tau_vibratory == pytest.approx(16 * one.M_vibratory / (math.pi * 0.03**3), rel=1e-14)


def test_the_mean_torque_goes_to_the_load() -> None:
    effort, piece = Harmonics(10.0, ((1.0, 3.0, 2.0),)), ShaftPart(stiffness=1e4, damping=1.0)
    masses = [ShaftPart(inertia=1.0), ShaftPart(inertia=2.0, load=True), ShaftPart(inertia=3.0)]
    found = shaft(effort, 5.0, masses[0], piece, masses[1], piece, masses[2])
    assert [one.M_shaft_mean for one in found.pieces] == pytest.approx([10.0, 0.0], abs=1e-14)
    held = shaft(effort, 5.0, "ground", piece, masses[0], piece, masses[2])
    assert [one.M_shaft_mean for one in held.pieces] == pytest.approx([-10.0, 0.0], abs=1e-14)


@pytest.mark.parametrize("torques", [(7.1, 3.3, 7.1), (0.3, -0.3, 0.3)])
def test_the_mean_torque_is_one_number_in_every_command(torques: tuple[float, ...]) -> None:
    """5.2 stood beside 5.200000000000001: `torsion` summed it anew."""
    case = Case(machine_of(effort=Effort((0.0, 130.0, 360.0), torques)))
    assert case.torsion.pieces[0].M_shaft_mean == case.harmonics().M_mean == case.flywheel.M_mean


def test_crests_against_many_samples() -> None:
    draw = np.random.default_rng(2)
    waves = [1, 2, 3, 7, 24]
    amplitudes = draw.normal(size=(40, 5)) + 1j * draw.normal(size=(40, 5))
    high, low = crests(waves, amplitudes)
    angles = np.linspace(0, 2 * np.pi, 100_001)
    for row, largest, smallest in zip(amplitudes[:6], high, low):
        curve = (row * np.exp(1j * np.multiply.outer(angles, waves))).sum(axis=1).real
        assert largest == pytest.approx(curve.max(), rel=1e-6)
        assert largest >= curve.max()
        assert smallest <= curve.min()


def test_cylinders_on_the_shaft_count_by_their_mean_inertia() -> None:
    """J + m_pin R² + m mean(x′²), the mean of (1 + λ²/4 + …)/2 with mpmath."""
    found = Case(load(CONFIGS / "coupled-blower.yaml")).torsion
    lam, crank = mpmath.mpf(1) / 5, mpmath.mpf("0.2")

    def slope(phi: Any) -> Any:
        sin, cos = mpmath.sin(phi), mpmath.cos(phi)
        return sin + lam * sin * cos / mpmath.sqrt(1 - (lam * sin) ** 2)

    mean = mpmath.quad(lambda phi: slope(phi) ** 2, [0, mpmath.pi / 2, mpmath.pi, 2 * mpmath.pi]) / (2 * mpmath.pi)
    each = (90 + 30 + 60 + 60) * crank**2 * mean + 60 * crank**2
    assert found.chain.inertias[0] == pytest.approx(float(900 + 2 * each), rel=1e-13)
