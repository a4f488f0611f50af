"""Loads other than gas: by points, of springs, constant and helping, by virtual work and against figures by hand."""

import math

import numpy as np
import pytest

import kurbel
from kurbel import loads
from kurbel.notes.left_out import stages
from kurbel.solver.case import Case
from representative import case_of

FOOT_POUND = 0.3048 * 4.4482216152605
ANGLES = np.linspace(0.5, 359.5, 360)
SHAPE = "speed: 600 rpm\ncrank: 10 mm\nrod: 60 mm\n"


def case(text: str) -> Case:
    return Case(loads(text))


def test_a_press_against_figures_by_hand() -> None:
    """1000 kN over the last 6 mm of 160 mm: 6 kJ, where x = R (1 − cos φ) + L − √(L² − R² sin² φ) is 6 mm."""
    press = case_of("press").cylinders[0]
    assert press.load_work == pytest.approx(-6000.0, rel=1e-14)
    # friction circles at f = 0.06, by numpy: source of the figures in the machine file
    assert press.friction_work == pytest.approx(8212.37825371863, rel=1e-9)
    assert press.friction_works["crosshead_pin"] == pytest.approx(214.3258626148386, rel=1e-8)

    def slide(phi: float) -> float:
        return 0.08 * (1 - math.cos(phi)) + 0.9 - math.sqrt(0.81 - (0.08 * math.sin(phi)) ** 2)

    begins = 338.58012001870236
    assert slide(math.radians(begins)) == pytest.approx(0.006, rel=1e-12)
    forces = press.at([begins - 1e-9, begins + 1e-9, 350.0, 10.0])
    assert pytest.approx([0, 1e6, 1e6, 0]) == forces.P_load
    assert press.extremes_of("P").largest.degrees == pytest.approx(begins, abs=1e-9)
    # without friction, T R = P dx/dφ
    plain = case(
        "speed: 40 rpm\nstroke: 160 mm\nrod: 900 mm\nforce: {unit: kN, points: [[0, 0, 1000], "
        "[0.0375, 0, 1000], [0.0375, 0, 0], [1, 0, 0]]}\n"
    ).cylinders[0]
    torque = plain.at([begins + 1e-9]).M[0]
    assert torque == pytest.approx(-31634.860874556263, rel=1e-7)


def test_a_spring_against_figures_by_hand() -> None:
    """50 N/mm and no force at the outer dead centre, 2 kg and 0.05 kg m2: the spring takes ½ k (20 mm)² = 10 J."""
    spring = case(
        f"{SHAPE}masses: {{reciprocating: 2 kg}}\nforce: {{spring: 50 N/mm, preload: 1 kN}}\n"
        "flywheel: {inertia: 0.05 kg m2}\n"
    )
    forces = spring.cylinders[0]
    x = forces.at(ANGLES).x
    assert pytest.approx(1000 - 5e4 * x, abs=1e-9) == forces.at(ANGLES).P_load
    assert forces.load_work == 0
    assert forces.N_peak.value == pytest.approx(100.05627101816185, rel=1e-12)
    assert spring["M_max"].value == pytest.approx(6.456414394560415, rel=1e-12)
    assert spring["dE"].value == pytest.approx(10.0, rel=1e-12)
    # ½ J ω² + ½ m c² = E_0 + 10 J: at both dead centres the slide rests
    low, high = spring["omega_min"].value, spring["omega_max"].value
    assert 0.025 * (high**2 - low**2) == pytest.approx(10.0, rel=1e-12)
    assert spring["delta"].value == pytest.approx(0.05097610580578676, rel=1e-8)


def test_a_pumpjack_against_its_torque_factors() -> None:
    """The torque is the load times 72 in dθ/dφ, at most 28.186 in lowering and 28.984 in lifting."""
    jack = case_of("pumpjack")
    assert jack["M_max"].value == pytest.approx(6000 * 28.186 / 12 * FOOT_POUND, rel=2e-5)
    assert jack["M_min"].value == pytest.approx(-10000 * 28.984 / 12 * FOOT_POUND, rel=2e-5)
    # lifting takes 10000 lbf over the swing of the horsehead, lowering gives 6000 lbf back
    arc = 72 / 12 * math.radians(44.19282952095877)
    assert jack["load_work"].value == pytest.approx(-4000 * arc * FOOT_POUND, rel=1e-9)


def test_a_moment_that_helps_is_the_load_at_its_lever() -> None:
    """Of the pumpjack: 6 ft × 10000 lbf against the lifting stroke, and 6 ft × 6000 lbf that help the other one."""
    keys = "speed: 12 rpm\nmechanism: four-bar\ncrank: 24 in\ncoupler: 74.5 in\nrocker: 64 in\n"
    moment = "moment: {work: 60000 lbf ft, return: -36000 lbf ft}\n"
    given = case(f"{keys}frame: 98.5951317 in\n{moment}")
    jack = case_of("pumpjack")
    assert pytest.approx(jack.cylinders[0].at(ANGLES).M) == given.cylinders[0].at(ANGLES).M
    assert given["resistance_work"].value == pytest.approx(jack["load_work"].value, rel=1e-13)


BOTH_WAYS = (
    "force: {unit: N, points: [[0, 20, -90], [0.2, 50, 40], [0.2, 10, 40], [1, 30, 60]], "
    "constant: -25 N, spring: 3 N/mm, preload: 15 N}\n"
)


@pytest.mark.parametrize(
    ("mechanism", "lever", "strokes"),
    [
        ("crank: 10 mm\nrod: 60 mm\noffset: 3 mm", 1.0, 1),
        ("crank: 10 mm\nrod: 60 mm\ncycle: four-stroke", 1.0, 2),
        ("mechanism: scotch-yoke\nstroke: 20 mm", 1.0, 1),
        ("mechanism: slotted-lever\ncrank: 100 mm\nframe: 250 mm\nlever: 600 mm", 1.0, 1),
        ("mechanism: slotted-lever\ncrank: 100 mm\nframe: 250 mm", 0.3, 1),
    ],
)
def test_the_work_of_a_load_is_its_area(mechanism: str, lever: float, strokes: int) -> None:
    """W = s l (∮ F dz): out (20 + 50)/2 · 0.2 + (10 + 30)/2 · 0.8, back (−90 + 40)/2 · 0.2 + (40 + 60)/2 · 0.8."""
    text = BOTH_WAYS if lever == 1 else BOTH_WAYS.replace("{unit", f"{{lever: {lever} m, unit")
    forces = case(f"speed: 90 rpm\n{mechanism}\n{text}").cylinders[0]
    area = (7 + 16) - (-5 + 40)
    expected = strokes * lever * forces.mechanism.stroke * area
    assert forces.load_work == pytest.approx(expected, rel=1e-12)
    # ∮ M dφ, by the quadrature of the pieces
    assert abs(forces.energy_residual) < 1e-13
    # on both sides of the jump at 0.2 of the way out
    jump = float(
        forces.mechanism.crank_angles_at(np.array([0.2 * forces.mechanism.stroke]), True)[0]
    )
    travel = 0.2 * forces.mechanism.stroke * lever
    steady = -25 + 15 - 3000 * travel
    beside = forces.at([jump, jump], within=np.array([jump - 1e-6, jump + 1e-6])).P_load
    assert beside == pytest.approx([50 + steady, 10 + steady], abs=1e-9)


def test_loads_of_many_machines_are_those_of_each() -> None:
    """Strokes, springs and helping forces vary by row; columns as each row alone."""
    text = (
        f"{SHAPE}masses: {{reciprocating: 2 kg}}\nefficiency: 0.9\nflywheel: {{inertia: 0.05 kg m2}}\n"
        f"ram_force: {{work: 30 N, return: -9 N}}\n{BOTH_WAYS}"
    )
    varied = {
        "crank": ["10 mm", "11 mm", "9 mm", "12 mm"],
        "force.spring": ["3 N/mm", "2 N/mm", "9 N/mm", "5 N/mm"],
        "force.constant": ["-25 N", "-20 N", "10 N", "4 N"],
        "ram_force.return": ["-9 N", "-90 N", "5 N", "1 N"],
    }
    ids = ["load_work", "resistance_work", "P_load_max", "N_peak", "T_max", "dE", "M_mean", "W"]
    rows = kurbel.sweep(loads(text), varied, ids)
    for row in range(4):
        keys = [f"{key}={values[row]}" for key, values in varied.items()]
        single = Case(kurbel.loads(text, overrides=keys))
        for id in ids:
            expected = single[id].value
            assert rows[id][row] == pytest.approx(expected, rel=1e-12, abs=1e-12), (row, id)


def test_a_load_that_drives_loses_and_one_that_is_moved_costs_more() -> None:
    """η of what a lowered load gives, 1/η of what a lifted one takes, and a spring alone neither."""
    lines = {
        "drives": "{unit: N, points: [[0, 50, 20], [1, 50, 20]]}",
        "driven": "{unit: N, points: [[0, 20, 50], [1, 20, 50]]}",
        "neither": "{spring: 3 N/mm, constant: 40 N}",
    }
    factors = {"drives": 0.8, "driven": 1 / 0.8, "neither": 1.0}
    for name, force in lines.items():
        lossless = case(f"{SHAPE}force: {force}\n")
        with_losses = case(f"{SHAPE}force: {force}\nefficiency: 0.8\n")
        expected = factors[name] * lossless.flywheel.at(ANGLES).M
        assert pytest.approx(expected, rel=1e-12) == with_losses.flywheel.at(ANGLES).M, name


@pytest.mark.parametrize("count", [3, 6])
@pytest.mark.parametrize("force", ["1 kN", "{spring: 3 N/mm, preload: 50 N}"])
def test_loads_that_give_back_their_work_leave_no_mean_torque(count: int, force: str) -> None:
    """Cranks at equal angles: of torques of 80 N m a thousandth is left, its mean is 0 and not their rounding."""
    angles = [f"{360 * number / count} deg" for number in range(count)]
    cranks = f"  count: {count}\n  crank_positions: [{', '.join(angles)}]\n"
    cylinder = f"  each: {{stroke: 160 mm, rod: 400 mm, force: {force}}}\n"
    machine = case(f"speed: 60 rpm\ncylinders:\n{cranks}{cylinder}")
    assert machine["M_max"].value > 0
    assert machine["M_mean"].value == 0
    assert machine["W"].value == 0


def test_check_lists_each_load_that_is_computed() -> None:
    """A press has either key or both; a shaper without any is expected to have a ram."""
    shaper = (
        "speed: 40 rpm\nmechanism: slotted-lever\ncrank: 100 mm\nframe: 250 mm\nlever: 600 mm\n"
    )
    ram, load = "ram_force: {work: 1 kN}\n", "force: 2 kN\n"
    for keys, listed in (
        (SHAPE + ram + load, {"load": "", "ram force": ""}),
        (SHAPE + load, {"load": ""}),
        (shaper + load, {"load": ""}),
        (shaper, {"ram force": "no ram_force given"}),
    ):
        machine = loads(keys)
        reasons = stages(machine, machine.cylinders[0])
        assert {name: reasons[name] for name in ("load", "ram force") if name in reasons} == listed


def test_a_hanging_weight_is_a_constant_force() -> None:
    """As the weight of a mass on a vertical slide without its inertia: m g along the line, at any speed."""
    weight = case(f"{SHAPE}masses: {{other: 5 kg}}\ninclination: 90 deg\n").cylinders[0]
    hung = case(f"{SHAPE}force: {5 * 9.80665} N\n").cylinders[0]
    assert pytest.approx(weight.at(ANGLES).P_weight, rel=1e-14) == hung.at(ANGLES).P
    assert hung.load_work == 0
    assert (
        pytest.approx(hung.at(ANGLES).P * np.tan(np.radians(hung.at(ANGLES).psi)))
        == hung.at(ANGLES).N
    )


def test_what_helps_a_pump_is_put_in() -> None:
    """Of 0.19 kJ that the pump takes, a load gives a part: η_g counts both as put in."""
    text = (
        "speed: 60 rpm\ncrank: 100 mm\nrod: 500 mm\nbore: 90 mm\nfriction: {constant: 100 N}\n"
        "indicator: {head_end: {constant: {expansion: 0 bar, compression: 3 bar}}}\n"
        "force: {unit: N, points: [[0, 2500, 1500], [1, 2500, 1500]]}\n"
    )
    machine = case(text)
    pumped = 3e5 * math.pi / 4 * 0.09**2 * 0.2
    helped = 1000 * 0.2
    lost = 100 * 0.4
    driven = pumped + lost - helped
    assert machine["mechanical_efficiency"].value == pytest.approx(
        pumped / (helped + driven), rel=1e-12
    )
