"""Torsional vibration of shaft lines: natural frequencies by 60 digits, Holzer's table, and forced vibration."""

import math
from typing import Any

import mpmath
import numpy as np
import pytest

from kurbel.machine import Machine
from kurbel.machine.shaft_line import ShaftPart, line_of
from kurbel.machine.shaft_side import Coupling, Effort, Flywheel, Harmonics, Load
from kurbel.machine_file import load
from kurbel.solver.case import Case
from kurbel.solver.chapters.chain import Chain, response, row_of_joins
from kurbel.solver.chapters.excitation import Vibration
from kurbel.solver.chapters.natural_modes import Modes, holzer_at
from kurbel.solver.chapters.torsion import ShaftVibration
from representative import CONFIGS, few

ENDS = {"": 0, "before": 1, "after": 1, "both": 2}
"""Fixed ends."""


def undamped(inertias: list[float], stiffnesses: list[float], ground: str = "") -> Chain:
    nothing = np.zeros(len(stiffnesses))
    masses = len(inertias)
    joins = row_of_joins(masses, ground)
    return Chain(
        np.array(inertias),
        np.array(stiffnesses),
        nothing,
        np.zeros(masses),
        nothing,
        joins,
        nothing,
    )


def at_random(count: int, spread: float, ground: str, seed: int) -> Chain:
    """A chain whose masses and stiffnesses differ by up to 10^(2 spread)."""
    draw = np.random.default_rng(seed)
    inertias = 10 ** draw.uniform(-spread, spread, count) * draw.uniform(0.5, 2, count)
    stiffnesses = 10 ** draw.uniform(3 - spread, 3 + spread, count - 1 + ENDS[ground])
    return undamped(inertias.tolist(), stiffnesses.tolist(), ground)


def eigenvalues(chain: Chain) -> list[mpmath.mpf]:
    """√ of the eigenvalues of J^{-1/2} K J^{-1/2}, with 60 digits."""
    count = len(chain.inertias)
    with mpmath.workdps(60):
        matrix = mpmath.matrix(count, count)
        for row, stiffness in zip(chain.twists, chain.stiffnesses):
            ends = np.flatnonzero(row).tolist()
            for i in ends:
                for j in ends:
                    matrix[i, j] += int(row[i] * row[j]) * mpmath.mpf(float(stiffness))
        roots = [mpmath.sqrt(float(inertia)) for inertia in chain.inertias]
        for i in range(count):
            for j in range(count):
                matrix[i, j] /= roots[i] * roots[j]
        result = sorted(mpmath.eigsy(matrix, eigvals_only=True))
        return [mpmath.sqrt(one) if one > 1e-45 else mpmath.mpf(0) for one in result]


CHAINS = [
    *((count, spread, ground) for count in (2, 8) for spread in (0, 5) for ground in ENDS),
    *(
        pytest.param(n, s, g, marks=pytest.mark.slow)
        for n in (3, 20)
        for s in (0, 2, 5)
        for g in ENDS
    ),
    pytest.param(30, 5, "", marks=pytest.mark.slow),
]


@pytest.mark.parametrize(("count", "spread", "ground"), CHAINS)
def test_frequencies_with_all_their_digits(count: int, spread: float, ground: str) -> None:
    """Also where masses differ by 10^10, at which numpy.linalg.eigh has no digit of the lowest mode left."""
    for seed in range(3):
        chain = at_random(count, spread, ground, seed)
        result, exact = Modes(chain).omegas, eigenvalues(chain)
        assert len(result) == count
        for one, other in zip(result, exact):
            assert one == (0 if other == 0 else pytest.approx(float(other), rel=1e-14))
        assert (result[0] == 0) == (not ground)


HELD = [(*size, ground) for size in ((2, 0), (9, 1), (30, 0), (30, 3)) for ground in ENDS]


@pytest.mark.parametrize(
    ("count", "spread", "ground"), few(HELD, [one for one in HELD if one[:2] != (30, 0)])
)
def test_holzer_closes(count: int, spread: float, ground: str) -> None:
    chain = at_random(count, spread, ground, 7)
    modes = Modes(chain)
    for mode, omega in enumerate(modes.omegas):
        table = modes.holzer(mode)
        largest = np.abs(table.torques).max()
        assert table.residual <= 1e-12
        # J ω² Θ is what the torques before and behind a mass differ by; k ΔΘ is the torque
        left = chain.twists.T @ table.torques - omega**2 * chain.inertias * table.angles
        assert np.abs(left).max() <= 1e-12 * max(largest, 1e-300)
        twists = chain.twists @ table.angles
        assert twists == pytest.approx(
            table.torques / chain.stiffnesses, abs=1e-12 * np.abs(table.angles).max()
        )
        if not ground and mode:
            momentum = chain.inertias * table.angles
            assert abs(momentum.sum()) <= 1e-13 * np.abs(momentum).sum()
        assert len(modes.nodes(mode)) == mode  # the law of the nodes, beside that at the ground


def test_a_mode_that_leaves_a_mass_at_rest() -> None:
    """Three equal masses: √(k/J) with the middle one still, √(3k/J); the node is the middle mass."""
    modes = Modes(undamped([2.0] * 3, [50.0] * 2))
    assert modes.omegas == pytest.approx([0, 5, 5 * math.sqrt(3)], rel=1e-15)
    assert modes.holzer(1).angles == pytest.approx([1, 0, -1], abs=1e-15)
    (node,) = modes.nodes(1)
    assert node[0] + node[1] == pytest.approx(1, abs=1e-12)


@pytest.mark.parametrize("ground", ENDS)
def test_holzer_at_a_frequency(ground: str) -> None:
    """At a natural frequency the table of the mode, else what a torque on the last mass, or a moved end, would make."""
    chain = at_random(5, 0, ground, 11)
    modes = Modes(chain)
    natural, mode = holzer_at(chain, modes.omegas[2]), modes.holzer(2)
    assert natural.angles == pytest.approx(mode.angles, rel=1e-9)
    assert natural.torques == pytest.approx(
        mode.torques, rel=1e-9, abs=1e-9 * np.abs(mode.torques).max()
    )

    omega = 0.7 * modes.omegas[1] + 3
    table = holzer_at(chain, omega)
    held = ground in ("after", "both")
    matrix = chain.twists.T @ np.diag(chain.stiffnesses) @ chain.twists - np.diag(
        omega**2 * chain.inertias
    )
    sides = matrix @ table.angles
    assert sides[:-1] == pytest.approx(np.zeros(4), abs=1e-9 * np.abs(table.torques).max())
    acting = chain.stiffnesses[-1] * table.residual if held else -table.residual
    assert sides[-1] == pytest.approx(acting, rel=1e-9)
    assert table.angles[0] == 1


# forced torsional vibration: order by order, over the angle, by its energy, and with the coupling of the flywheel

POINTS = [(0, 100), (60, 900), (60, 500), (180, 100), (240, 700), (360, 100)]


def damped(count: int, ground: str, seed: int, loss: float = 0.03) -> Chain:
    draw = np.random.default_rng(seed)
    pieces = count - 1 + ENDS[ground]
    return Chain(
        10 ** draw.uniform(-1, 1, count),
        10 ** draw.uniform(3, 5, pieces),
        draw.uniform(0, 5, pieces),
        draw.uniform(0, 5, count),
        draw.uniform(0, loss, pieces) if loss else np.zeros(pieces),
        row_of_joins(count, ground),
        np.zeros(pieces),
    )


@pytest.mark.parametrize("ground", ["", "before", "after", "both"])
@pytest.mark.parametrize("count", [1, 2, 5, 12])
def test_every_order_solves_its_equations(count: int, ground: str) -> None:
    """(K (1 + iη) + iνω C − (νω)² J) θ = M, with 40 digits by mpmath."""
    if count == 1 and not ground:
        return
    chain = damped(count, ground, 3)
    frequencies = np.array([[0.7, 20.0], [150.0, 900.0]])
    draw = np.random.default_rng(4)
    torques = draw.normal(size=(count, 2, 2)) + 1j * draw.normal(size=(count, 2, 2))
    result = response(chain, frequencies, torques)
    for place, w in np.ndenumerate(frequencies):
        with mpmath.workdps(40):
            still, dampers = (
                mpmath.diag(one.tolist()) for one in (chain.stiffnesses, chain.segment_damping)
            )
            losses, frequency = mpmath.diag((1 + 1j * chain.loss).tolist()), mpmath.mpf(w)
            twists, jw = mpmath.matrix(chain.twists.tolist()), mpmath.mpc(0, frequency)
            whole = twists.T * (still * losses + jw * dampers) * twists + jw * mpmath.diag(
                chain.mass_damping.tolist()
            )
            whole -= frequency**2 * mpmath.diag(chain.inertias.tolist())
            sides = mpmath.matrix([complex(torque) for torque in torques[(slice(None), *place)]])
            exact = mpmath.lu_solve(whole, sides)
        wanted = np.array([complex(one) for one in exact])
        assert result[(slice(None), *place)] == pytest.approx(
            wanted, abs=1e-12 * np.abs(wanted).max()
        )


def machine_of(
    load: Load | None = None, effort: Any = None, damping: float = 60.0, order: float = 2.4
) -> Machine:
    """Masses of 60 and 40 kg m² on a coupling, whose natural order at 60 rpm is `order`."""
    stiffness = (order * 2 * math.pi) ** 2 / (1 / 60.0 + 1 / 40.0)
    if effort is None:
        effort = Effort(*(tuple(map(float, one)) for one in zip(*POINTS)))
    coupling = Coupling(stiffness, 40.0, damping)
    return Machine(
        (), effort=effort, speed=1.0, flywheel=Flywheel(60.0), coupling=coupling, load=load
    )


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
    (piece,) = case.torsion.segments
    angles = np.linspace(0, 360, 73)
    wanted = case.flywheel.at(angles).M_coupling
    assert piece.at(angles).M_shaft == pytest.approx(wanted, abs=1e-12 * np.abs(wanted).max())
    assert piece.M_shaft_max == pytest.approx(case.flywheel.elastic.M_coupling_max.value, rel=1e-12)
    assert piece.M_shaft_min == pytest.approx(case.flywheel.elastic.M_coupling_min.value, rel=1e-12)


def test_the_damping_takes_what_the_torques_give() -> None:
    for name in ("generator-coupling", "marine-diesel", "torsional-damper", "coupled-blower"):
        vibration = Case(load(CONFIGS[name])).torsion.vibration
        assert vibration.loss[0] > 0
        speeds = 1j * vibration.acting.orders * vibration.omegas[0] * vibration.angles[:, 0]
        power = (vibration.driving[:, 0] * speeds.conj()).real.sum() / 2
        assert power == pytest.approx(vibration.loss[0], rel=1e-12)


def test_away_from_the_working_speed_the_load_takes_the_same_mean_torque() -> None:
    """A load of slip s has the slope M/(s ω_n) at ω_n, and ω_n/ω times that at ω: two masses as a linear system."""
    result = Case(machine_of(Load(slip=0.05))).torsion
    acting, ratio = result.vibration.acting, 1.5
    omega = 2 * math.pi * ratio
    vibration = Vibration(result.vibration.chain, result.vibration.line, acting, np.array([omega]))
    mean = (60 * 500 + 120 * 300 + 60 * 400 + 120 * 400) / 360
    slope = mean / (0.05 * 2 * math.pi) / ratio
    stiffness = (2.4 * 2 * math.pi) ** 2 / (1 / 60.0 + 1 / 40.0)
    for index, order in enumerate(acting.orders.tolist()):
        turning = order * omega
        spring = stiffness + 60.0j * turning
        system = np.array(
            [
                [spring - turning**2 * 60.0, -spring],
                [-spring, spring - turning**2 * 40.0 + 1j * turning * slope],
            ]
        )
        angles = np.linalg.solve(system, vibration.driving[:, 0, index])
        assert vibration.angles[:, 0, index] == pytest.approx(angles, rel=1e-9, abs=1e-15)


def shaft(effort: Any, speed: float, *parts: Any, **more: Any) -> ShaftVibration:
    return Case(Machine((), effort=effort, speed=speed, shaft=line_of(parts), **more)).torsion


def test_two_masses_in_closed_form() -> None:
    """T = k (1 + iη) M/J₁ /(ω_e² (1 + iη) − ω²), ω_e² = k (J₁ + J₂)/(J₁J₂); at resonance with the magnifier 1/η."""
    first, second, stiffness, loss = 3.0, 7.0, 2000.0, 0.02
    resonance = math.sqrt(stiffness * (1 / first + 1 / second)) / (2 * math.pi)
    parts = (
        ShaftPart(inertia=first),
        ShaftPart(stiffness=stiffness, loss_factor=loss),
        ShaftPart(inertia=second),
    )
    for speed in (0.4 * resonance, resonance / 2, resonance, 3.0 * resonance):
        result = shaft(Harmonics(10.0, ((2.0, 6.0, 8.0),)), speed, *parts)
        square, spring = (4 * math.pi * speed) ** 2, 1 + 1j * loss
        exact = (
            stiffness
            * spring
            * (6 - 8j)
            / first
            / ((2 * math.pi * resonance) ** 2 * spring - square)
        )
        assert result.vibration.torques[0, 0, 1] == pytest.approx(exact, rel=1e-12)
        assert result.vibration_loss == pytest.approx(
            loss * stiffness * 4 * math.pi * speed * abs(exact / (stiffness * spring)) ** 2 / 2,
            rel=1e-12,
        )
    at_resonance = shaft(Harmonics(10.0, ((2.0, 6.0, 8.0),)), resonance / 2, *parts).segments[0]
    static = 10.0 * second / (first + second)
    assert at_resonance.M_vibratory == pytest.approx(static * abs(1 + 1j * loss) / loss, rel=1e-12)


def test_a_gear_is_the_chain_referred_to_one_shaft() -> None:
    """The torque behind the gear is that of the referred chain over u, its stress that of its own section."""
    effort = Harmonics(10.0, ((1.0, 3.0, 2.0), (3.0, 1.0, -2.0)))
    behind = (
        ShaftPart(diameter=0.03, length=0.5, density=0.0, loss_factor=0.05),
        ShaftPart(inertia=0.4),
    )
    before = (
        ShaftPart(inertia=2.0),
        ShaftPart(stiffness=5e4, loss_factor=0.01),
        ShaftPart(inertia=0.3),
    )
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
    one, other = geared.segments[1], plain.segments[1]
    assert one.M_vibratory == pytest.approx(other.M_vibratory / 2.5, rel=1e-12)
    assert one.M_shaft_mean == pytest.approx(4.0, rel=1e-14)
    assert one.tau_vibratory == pytest.approx(16 * one.M_vibratory / (math.pi * 0.03**3), rel=1e-14)


def test_the_stress_of_a_stepped_piece_is_that_of_its_thinnest_section() -> None:
    """A hollow section may be wider and yet weaker: π (d⁴ − d_i⁴)/(16 d) is least, wherever it stands."""
    effort = Harmonics(10.0, ((1.0, 3.0, 2.0), (3.0, 1.0, -2.0)))
    sections = [
        ShaftPart(diameter=0.05, length=0.3, density=0.0, loss_factor=0.01),
        ShaftPart(diameter=0.045, length=0.2, density=0.0),
        ShaftPart(diameter=0.06, bore=0.055, length=0.1, density=0.0),
    ]
    least = math.pi * (0.06**4 - 0.055**4) / (16 * 0.06)
    assert least < math.pi * 0.045**3 / 16
    for turned in (sections, sections[::-1], [sections[0], sections[2], sections[1]]):
        piece = shaft(
            effort, 10.0, ShaftPart(inertia=2.0), *turned, ShaftPart(inertia=0.4)
        ).segments[0]
        assert piece.tau_vibratory == pytest.approx(piece.M_vibratory / least, rel=1e-14)


def test_the_mean_torque_goes_to_the_load() -> None:
    effort, piece = Harmonics(10.0, ((1.0, 3.0, 2.0),)), ShaftPart(stiffness=1e4, damping=1.0)
    masses = [ShaftPart(inertia=1.0), ShaftPart(inertia=2.0, load=True), ShaftPart(inertia=3.0)]
    result = shaft(effort, 5.0, masses[0], piece, masses[1], piece, masses[2])
    assert [segment.M_shaft_mean for segment in result.segments] == pytest.approx(
        [10.0, 0.0], abs=1e-14
    )
    held = shaft(effort, 5.0, ShaftPart(word="ground"), piece, masses[0], piece, masses[2])
    assert [segment.M_shaft_mean for segment in held.segments] == pytest.approx(
        [-10.0, 0.0], abs=1e-14
    )


def test_cylinders_on_the_shaft_count_by_their_mean_inertia() -> None:
    """J + m_pin R² + m mean(x′²), the mean of (1 + λ²/4 + …)/2 with mpmath."""
    result = Case(load(CONFIGS["coupled-blower"])).torsion
    lam, crank = mpmath.mpf(1) / 5, mpmath.mpf("0.2")

    def slope(phi: Any) -> Any:
        sin, cos = mpmath.sin(phi), mpmath.cos(phi)
        return sin + lam * sin * cos / mpmath.sqrt(1 - (lam * sin) ** 2)

    mean = mpmath.quad(
        lambda phi: slope(phi) ** 2, [0, mpmath.pi / 2, mpmath.pi, 2 * mpmath.pi]
    ) / (2 * mpmath.pi)
    each = (90 + 30 + 60 + 60) * crank**2 * mean + 60 * crank**2
    assert result.chain.inertias[0] == pytest.approx(float(900 + 2 * each), rel=1e-13)


def test_a_shaft_held_at_both_ends() -> None:
    """A mean torque goes to both ends as their stiffness, k₁/(k₁ + k₂); one mass swings by M/(k₁ + k₂ − J Ω²)."""
    ground, mass = ShaftPart(word="ground"), ShaftPart(inertia=2.0, damping=1e-9)
    parts = [ground, ShaftPart(stiffness=3e4), mass, ShaftPart(stiffness=1e4), ground]
    effort, omega = Harmonics(80.0, ((2.0, 0.0, 12.0),)), 2 * 2 * math.pi * 5
    result = Case(Machine((), effort=effort, speed=5.0, shaft=line_of(parts))).torsion
    swing = 12 / (4e4 - 2 * omega**2)
    before, after = result.segments
    assert (before.name, after.name) == ("ground – mass 1", "mass 1 – ground")
    assert (before.M_shaft_mean, after.M_shaft_mean) == pytest.approx((-60, 20))
    assert (before.M_vibratory, after.M_vibratory) == pytest.approx(
        (3e4 * swing, 1e4 * swing), rel=1e-9
    )
    assert result.natural_frequency == pytest.approx(math.sqrt(4e4 / 2) / (2 * math.pi), rel=1e-14)
