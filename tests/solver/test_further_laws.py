"""Laws of figures that no other test of the solver reaches: clearances, cycles of two turns, the rod in its line."""

import math

import numpy as np
import pytest

import kurbel
from kurbel.crank_angle import CrankAngle
from kurbel.machine_file import loads
from kurbel.mechanisms.four_bar import FourBar
from kurbel.solver.case import Case
from kurbel.solver.effort import torque_of_inertia
from kurbel.solver.state import reduced_inertia
from representative import CONFIGS

SHAPE = "crank: 0.1 m\nrod: 0.35 m\n"
COMPRESSOR = (
    "compressor: {suction: 1 bar, delivery: 4 bar, clearance: 0.1, exponent: 1.35, "
    "expansion_exponent: 1.2}"
)


def compressor_work(bore: float) -> float:
    """Work in J of a turn at one end: both polytropes with their own exponent, from 1 to 4 bar, stroke 0.2 m."""

    def shifted(volume: float, exponent: float) -> float:
        """Work in J to bring this volume from 1 to 4 bar and push it out."""
        power = (exponent - 1) / exponent
        return 1e5 * volume * (4**power - 1) / power

    swept = math.pi / 4 * bore**2 * 0.2
    return shifted(1.1 * swept, 1.35) - shifted(0.1 * swept * 4 ** (1 / 1.2), 1.2)


def test_what_stays_in_the_clearance_expands_with_its_own_exponent() -> None:
    indicator = f"indicator: {{pressures: absolute, head_end: {{{COMPRESSOR}}}}}\n"
    text = f"{SHAPE}bore: 0.2 m\nspeed: 600 rpm\nambient: 1 bar\n{indicator}"
    case = kurbel.solve(kurbel.loads(text))
    assert case.cylinders[0].work == pytest.approx(-compressor_work(0.2), rel=1e-12)
    (stage,) = case.delivery.stages
    assert stage["stage_power"].value == pytest.approx(10 * compressor_work(0.2), rel=1e-12)


def test_a_compressor_on_the_rod_of_a_four_stroke_engine_works_every_turn() -> None:
    otto = "{otto: {intake: 1 bar, compression_ratio: 8, peak: 40 bar}}"
    engine = f"indicator: {{pressures: absolute, head_end: {otto}}}\n"
    indicator = f"indicator: {{pressures: absolute, head_end: {{{COMPRESSOR}}}}}"
    tandem = f"{{name: compressor, bore: 0.15 m, {indicator}}}"
    text = f"{SHAPE}bore: 0.2 m\nspeed: 600 rpm\ncycle: four-stroke\n{engine}tandem: [{tandem}]\n"
    case = kurbel.solve(kurbel.loads(text))
    assert case.cylinders[0].pistons[1].work == pytest.approx(-2 * compressor_work(0.15), rel=1e-12)
    (stage,) = case.delivery.stages
    assert stage["stage_power"].value == pytest.approx(10 * compressor_work(0.15), rel=1e-12)


def test_volumes_of_both_ends_in_both_dead_centres() -> None:
    steam = "{steam: {admission: 8 bar, exhaust: 0 bar, cut_off: 0.3, clearance: %s}}"
    ends = f"indicator: {{head_end: {steam % 0.05}, crank_end: {steam % 0.08}}}\n"
    text = f"{SHAPE}bore: 0.2 m\ncrank_end_rod: 0.05 m\n{ends}"
    cylinder = Case(loads(text)).cylinders[0]
    head, crank = math.pi / 4 * 0.2**2 * 0.2, math.pi / 4 * (0.2**2 - 0.05**2) * 0.2
    ends_of_stroke = cylinder.at([0.0, 180.0])
    assert pytest.approx([0.05 * head, 1.05 * head], rel=1e-12) == ends_of_stroke.V
    assert ends_of_stroke.V_crank == pytest.approx([1.08 * crank, 0.08 * crank], rel=1e-12)
    # over a turn of 360 degrees: the rate is that of a degree
    near = cylinder.at([59.999, 60.0, 60.001])
    assert near.dV[1] == pytest.approx((near.V[2] - near.V[0]) / 0.002, rel=1e-8)


def test_a_ram_resists_on_every_stroke_of_the_cycle() -> None:
    """900 N out and 300 N back over 0.2 m, twice in the two turns of a four-stroke cycle."""
    engine = "indicator: {head_end: {otto: {intake: 0 bar, compression_ratio: 8, peak: 40 bar}}}"
    ram = "ram_force: {work: 900 N, return: 300 N}"
    text = f"cycle: four-stroke\nspeed: 600 rpm\n{SHAPE}bore: 0.2 m\n{engine}\n{ram}\n"
    forces = Case(loads(text)).cylinders[0]
    assert forces.resistance_work == pytest.approx(-2 * 1200 * 0.2, rel=1e-14)
    assert abs(forces.energy_residual or 0.0) < 1e-13


def test_mean_pressure_on_the_guide_is_over_the_path_of_both_turns() -> None:
    text = CONFIGS["gas-engine"].read_text("utf-8")
    guide = "friction: {crosshead: 0.1, guide: {length: 400 mm, width: 200 mm}}\n"
    forces = Case(loads(text + guide)).cylinders[0]
    at = forces.at((np.arange(72_000) + 0.5) / 100)
    way = np.abs(at.slope)
    assert forces.p_guide_mean == pytest.approx((at.p_guide * way).sum() / way.sum(), rel=1e-4)


def test_masses_alone_lose_nothing() -> None:
    """No piston drives or is driven: the efficiency has nothing to act on, and kinetic energy comes back."""
    text = f"{SHAPE}speed: 600 rpm\nmasses: {{piston: 5 kg}}\nefficiency: 0.8\n"
    case = Case(loads(text))
    effort = case.flywheel.effort
    own = effort.sampled([term._replace(factor=1.0) for term in effort.terms])
    assert np.abs(effort.M - own).max() <= 1e-14 * np.abs(own).max()


def test_torque_of_inertia_is_the_slope_of_the_reduced_inertia() -> None:
    """−½ ω² dJ/dφ of an exact rod with a large inertia of its own; J by its definition, the slope by differences."""
    rod = "connecting_rod: {mass: 8 kg, center_of_gravity: 0.12 m, inertia: 0.5 kg m2}"
    text = f"{SHAPE}speed: 600 rpm\nmasses: {{piston: 2 kg, {rod}}}\n"
    cylinder = Case(loads(text)).cylinders[0]
    degrees, step = np.array([35.0, 80.0, 155.0, 250.0]), 1e-3
    after, before = (reduced_inertia(cylinder.at(degrees + side * step)) for side in (1, -1))
    slope = (after - before) / np.radians(2 * step)
    wanted = -0.5 * (20 * math.pi) ** 2 * slope
    assert torque_of_inertia(cylinder.at(degrees)) == pytest.approx(wanted, rel=1e-7)


@pytest.mark.parametrize("degrees", [40.0, 130.0, 250.0, 320.0])
def test_a_rod_without_mass_loads_both_pins_along_its_line(degrees: float) -> None:
    gas = "{constant: {expansion: 3 bar, compression: 1 bar}}"
    text = f"{SHAPE}bore: 0.2 m\nindicator: {{head_end: {gas}}}\n"
    for pin in Case(loads(text)).bearings.parts[:2]:
        (direction,) = pin.at([degrees])["load_rod"]
        assert direction in (0.0, 180.0)


def test_rings_that_the_gas_presses_never_drive() -> None:
    """Whether the gas pushes or draws: f π d h k |Δp| against the motion."""
    gas = "{constant: {expansion: -0.4 bar, compression: 2 bar}}"
    rings = "friction: {rings: {count: 3, height: 10 mm, coefficient: 0.08, pressure: gas}}\n"
    text = f"{SHAPE}bore: 0.2 m\nspeed: 60 rpm\nindicator: {{head_end: {gas}}}\n{rings}"
    pressure_of_rings = 0.08 * math.pi * 0.2 * 0.03
    state = Case(loads(text)).cylinders[0].at([60.0, 250.0])
    assert state.F_friction == pytest.approx(
        [-0.4e5 * pressure_of_rings, 2e5 * pressure_of_rings], rel=1e-12
    )


def test_where_the_acceleration_of_the_book_is_zero() -> None:
    """R 291: cos φ + λ cos 2φ = 0."""
    motion = Case(loads(f"{SHAPE}speed: 60 rpm\n")).cylinders[0].motion
    roots = np.radians(motion.phi_b_zero_book)
    assert np.cos(roots) + np.cos(2 * roots) / 3.5 == pytest.approx([0, 0], abs=1e-14)


@pytest.mark.parametrize(("coupler", "rocker"), [(0.7, 0.7), (0.7, 0.8)])
def test_the_working_swing_is_the_slower_one(coupler: float, rocker: float) -> None:
    """On either side of a² + d² = b² + c² another dead centre begins it; its crank angle by a fine sum of θ′."""
    linkage = FourBar(0.3, coupler, rocker, 1.0)
    degrees = (np.arange(36_000) + 0.5) / 100
    rises = linkage.slope(CrankAngle.of(degrees)) > 0
    slower = 360 * max(rises.mean(), 1 - rises.mean())
    assert linkage.phi_work == pytest.approx(slower, abs=0.02)
    assert linkage.time_ratio == pytest.approx(slower / (360 - slower), rel=1e-3)
    assert linkage.works_outward == (rises.mean() > 0.5)
