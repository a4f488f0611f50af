"""Masses, friction and what turns with the shaft, as people know them: a sum, a force, a rim, harmonics, a file."""

import math
from pathlib import Path

import numpy as np
import pytest

from command import run
from kurbel import load, loads, solve
from kurbel.solver.forces import CylinderForces

ENGINE = "speed: 60 rpm\ncrank: 400 mm\nrod: 2 m\nbore: 450 mm\n"
GAS = "indicator: {head_end: {constant: {expansion: 5 bar, compression: 1 bar}}}\n"
OMEGA = 2 * math.pi


def forces_of(text: str) -> CylinderForces:
    (forces,) = solve(loads(ENGINE + text)).cylinders
    return forces


def test_the_sum_of_the_reciprocating_masses() -> None:
    forces = forces_of("masses: {reciprocating: 250 kg}\n")
    b = 0.4 * OMEGA**2 * (1 + 0.2)  # at the inner dead centre, R 291
    assert forces.m == 250
    assert forces.at([0]).P_inertia[0] == pytest.approx(-250 * b, rel=1e-13)


@pytest.mark.parametrize("crosshead", ["", ", crosshead: 0.1"])
def test_a_constant_friction_takes_its_force_times_the_way(crosshead: str) -> None:
    forces = forces_of(GAS + f"friction: {{constant: 2 kN{crosshead}}}\n")
    (plain,) = solve(loads(ENGINE + GAS)).cylinders
    if not crosshead:
        assert forces.friction_work == pytest.approx(2000 * 2 * 0.8, rel=1e-14)
        assert forces.at([60, 300]).F_friction.tolist() == [-2000, 2000]
        assert forces.at([60]).S[0] == pytest.approx(
            plain.at([60]).S[0] * (1 - 2000 / plain.at([60]).P[0]), rel=1e-13
        )
    else:
        assert forces.friction_works["constant"] == 3200
        assert forces.friction_work == pytest.approx(
            3200 + forces.friction_works.get("crosshead", 0), rel=1e-15
        )
    assert abs(forces.energy_residual or 0) < 1e-13


# flywheel

DIAGRAM = "effort: {unit: N m, points: [[0, 0], [90, 4000], [180, 0], [270, 4000], [360, 0]]}\nspeed: 120 rpm\n"


def test_a_flywheel_by_mass_and_radius_of_gyration() -> None:
    machine = loads(DIAGRAM + "flywheel: {mass: 2 t, radius_of_gyration: 1.2 m}\n")
    assert machine.flywheel.inertia == pytest.approx(2000 * 1.44, rel=1e-15)


RIM = "rim: {mean_diameter: 3 m, density: 7200 kg/m3, allowable_tension: %s}"


def test_the_rim_of_the_wanted_flywheel() -> None:
    """J = ΔE/(δ ω²); a ring of section A weighs ρ A π D and has J = m D²/4; its hoop stress is ρ v², v = ω D/2."""
    text = DIAGRAM + "flywheel: {fluctuation: 1/50, %s}\n" % (RIM % "6 MPa")
    turning = solve(loads(text)).flywheel
    omega = 4 * math.pi
    # between two crossings at 45 deg and 135 deg stands a triangle of 2000 N m over a quarter turn
    inertia = 2000 * math.pi / 4 * 50 / omega**2
    assert turning.rim_section == pytest.approx(
        inertia / (3 / 2) ** 2 / (7200 * math.pi * 3), rel=1e-12
    )
    assert turning.rim_speed == pytest.approx(omega * 1.5, rel=1e-15)
    assert turning.rim_stress == pytest.approx(7200 * (omega * 1.5) ** 2, rel=1e-14)
    printed = run("flywheel", "-", text=text).stdout
    assert "hoop stress" not in printed.partition("Warnings")[2]
    weak = run("flywheel", "-", text=text.replace("6 MPa", "2 MPa")).stdout
    assert "the hoop stress of the rim, 2.55" in " ".join(weak.partition("Warnings")[2].split())


@pytest.mark.parametrize(
    ("sizes", "inertia"),
    [
        # a ring is a disc less a disc, m r²/2 each
        (
            "outer_diameter: 8 ft, inner_diameter: 7 ft, width: 12 in",
            7250 * 0.3048 * math.pi * (1.2192**4 - 1.0668**4) / 2,
        ),
        (
            "mean_diameter: 90 in, depth: 6 in, width: 12 in, density: 7.85 t/m3",
            7850 * 0.3048 * math.pi * (1.2192**4 - 1.0668**4) / 2,
        ),
        (
            "outer_diameter: 8 ft, inner_diameter: 7 ft, mass: 3 t",
            3000 * (1.2192**2 + 1.0668**2) / 2,
        ),
        ("outer_diameter: 2 m, inner_diameter: 0 m, mass: 3 t", 3000 / 2),
    ],
)
def test_a_rim_of_which_the_sizes_are_known(sizes: str, inertia: float) -> None:
    text = DIAGRAM + f"flywheel: {{rim: {{{sizes}}}}}\n"
    turning = solve(loads(text)).flywheel
    result = turning.J
    assert result == pytest.approx(inertia, rel=1e-14)
    assert turning.delta_book == pytest.approx(
        turning.dE / (inertia * (4 * math.pi) ** 2), rel=1e-14
    )
    if "width" in sizes:
        assert turning.rim_section == pytest.approx(0.1524 * 0.3048, rel=1e-14)
    printed = run("flywheel", "-", text=text).stdout
    assert "arms and hub of the flywheel  J is that of the rim" in printed


def test_the_rim_of_a_given_flywheel_of_cast_iron() -> None:
    text = (
        DIAGRAM.replace("speed: 120 rpm\n", "")
        + "flywheel: {inertia: 500 kg m2, rim: {mean_diameter: 2 m}}\n"
    )
    turning = solve(loads(text)).flywheel
    assert turning.rim_section == pytest.approx(500 / (7250 * 2 * math.pi), rel=1e-14)
    assert turning.rim_stress is None


# a turning effort known from elsewhere

WHEEL = "speed: 120 rpm\nflywheel: {fluctuation: 1/50}\n"


@pytest.mark.parametrize(
    ("cycle", "order", "cos", "sin"),
    [
        ("two-stroke", 2, 300, 400),
        ("two-stroke", 24, 0, -50),
        ("four-stroke", 0.5, 400, 300),
        ("two-stroke", 7, 1, 0),
    ],
)
def test_an_effort_of_one_harmonic(cycle: str, order: float, cos: float, sin: float) -> None:
    """M = m + c cos νφ + s sin νφ has the amplitude a = √(c² + s²), and ΔE = 2 a/ν whatever the mean."""
    text = f"cycle: {cycle}\neffort: {{unit: kN m, mean: 1000, harmonics: [[{order}, {cos}, {sin}]]}}\n{WHEEL}"
    turning = solve(loads(text)).flywheel
    amplitude = math.hypot(cos, sin) * 1e3
    assert turning.M_mean == pytest.approx(1e6, rel=1e-13)
    assert turning.M_max.value == pytest.approx(1e6 + amplitude, rel=1e-13)
    assert turning.dE == pytest.approx(2 * amplitude / order, rel=1e-11)
    assert turning.J_needed == pytest.approx(
        2 * amplitude / order * 50 / (4 * math.pi) ** 2, rel=1e-11
    )


POINTS = [(0, 0.0), (90, 4.5), (180, -1.0), (180, 0.5), (270, 4.0), (360, 0.0)]


@pytest.mark.parametrize("first", [0, 90, 180])
def test_an_effort_from_a_file(tmp_path: Path, first: int) -> None:
    """As the logger counts, the inner dead centre stands at 30 deg, and the file may begin anywhere in the cycle."""
    start = next(i for i, (angle, _) in enumerate(POINTS) if angle == first)
    turned = [*POINTS[start:], *((angle + 360, torque) for angle, torque in POINTS[1 : start + 1])]
    rows = "\n".join(f"{angle + 30};x;{torque:.1f}".replace(".", ",") for angle, torque in turned)
    (tmp_path / "effort.csv").write_text(f"Winkel;;kNm\n{rows}\n")
    layout = (
        "skip_rows: 1, torque_column: 3, delimiter: semicolon, decimal: comma, angle_zero: 30 deg"
    )
    (tmp_path / "m.yaml").write_text(f"effort: {{unit: kN m, file: effort.csv, {layout}}}\n{WHEEL}")
    machine = load(tmp_path / "m.yaml")
    plain = loads(f"effort: {{unit: kN m, points: {[list(point) for point in POINTS]}}}\n{WHEEL}")
    angles = np.array([0, 45, 179.9, 180, 300])
    read, written = (np.asarray(solve(one).flywheel.at(angles).M) for one in (machine, plain))
    assert read == pytest.approx(written, rel=1e-13, abs=1e-9)
    assert solve(machine).flywheel.dE == pytest.approx(solve(plain).flywheel.dE, rel=1e-13)
    assert machine.trace_files == (str(tmp_path / "effort.csv"),)
