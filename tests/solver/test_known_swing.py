"""Efforts of which the swing of energy alone is known, loads by harmonics, and cycles of several turns."""

import math
from typing import Any

import numpy as np
import pytest

import kurbel
from kurbel.solver.case import Case

CYLINDERS = """
speed: 300 rpm
cycle: four-stroke
flywheel: {inertia: 300 kg m2}
cylinders:
  count: 2
  firing_order: 1-2
  each:
    stroke: 380 mm
    rod_ratio: 4.6
    bore: 280 mm
    masses: {reciprocating: 80 kg}
    indicator:
      head_end: {otto: {intake: -0.05 bar, exhaust: 0.05 bar, peak: 24 bar, compression_ratio: 6, exponent: 1.35}}
shaft: [{cylinder: [cylinder 1, cylinder 2]}, {stiffness: 9 MN m/rad, damping: 200 N m s/rad}, flywheel]
"""


def figures(text: str, *overrides: str) -> dict[str, Any]:
    case = kurbel.solve(kurbel.loads(text, overrides=overrides))
    return {id: one.value for id, one in case.flywheel.key_values().items()}


def test_of_a_swing_what_energy_alone_gives() -> None:
    """½ J (ω_max² − ω_min²) = ΔE, with ω_m in the middle of both."""
    result = figures("{speed: 300 rpm, effort: {swing: 20 kJ}, flywheel: {inertia: 500 kg m2}}")
    omega = 10 * math.pi
    assert result["delta"] == pytest.approx(20e3 / (500 * omega**2), rel=1e-15)
    assert 250 * (result["omega_max"] ** 2 - result["omega_min"] ** 2) == pytest.approx(
        20e3, rel=1e-12
    )
    assert (result["omega_max"] + result["omega_min"]) / 2 == pytest.approx(omega, rel=1e-15)
    assert (
        not {"M_mean", "M_max", "E_max", "phi_crossing", "power_shaft", "energy_fluctuation"}
        & result.keys()
    )


def test_a_coefficient_is_of_the_work_of_the_cycle() -> None:
    effort = "effort: {mean: 2 kN m, coefficient: 0.3}"
    for cycle, turns in (
        ("cycle: two-stroke", 1),
        ("cycle: four-stroke", 2),
        ("cycle_turns: 5", 5),
    ):
        result = figures(
            f"{{speed: 300 rpm, {cycle}, {effort}, efficiency: 0.8, flywheel: {{fluctuation: 1/50}}}}"
        )
        assert result["dE"] == pytest.approx(0.8 * 0.3 * 2e3 * 2 * math.pi * turns)
        assert result["J"] == pytest.approx(50 * result["dE"] / (10 * math.pi) ** 2)
        assert result["delta"] == pytest.approx(0.02)
    bare = "effort: {unit: kN m, mean: 2, coefficient: 0.3}"
    assert (
        figures(f"{{speed: 300 rpm, {bare}}}")["dE"]
        == figures(f"{{speed: 300 rpm, {effort}}}")["dE"]
    )


def test_swings_in_a_sweep_are_those_of_single_machines() -> None:
    text = "{speed: 300 rpm, effort: {swing: 20 kJ}, flywheel: {inertia: 500 kg m2}}"
    swings, speeds = (
        ["10 kJ", "10 kJ", "20 kJ", "9000 kJ"],
        ["250 rpm", "300 rpm", "300 rpm", "300 rpm"],
    )
    rows = kurbel.sweep(
        kurbel.loads(text),
        {"effort.swing": swings, "speed": speeds},
        columns=["dE", "delta", "omega_max"],
    )
    alone = [
        figures(text, f"effort.swing={one}", f"speed={n}") for one, n in zip(swings[:3], speeds)
    ]
    for id in ("dE", "delta", "omega_max"):
        assert np.asarray(rows[id])[:3].tolist() == pytest.approx(
            [one[id] for one in alone], rel=1e-15
        )
    assert np.isnan(np.asarray(rows["delta"])[3])  # it stalls


def test_a_load_by_harmonics_is_that_by_many_points() -> None:
    waves = "load: {unit: N m, mean: 500, harmonics: [[1, -200, 0], [3, 0, 50]]}"
    angles = np.linspace(0, 360, 2881)
    torques = 500 - 200 * np.cos(np.radians(angles)) + 50 * np.sin(np.radians(3 * angles))
    points = f"load: {{unit: N m, points: {np.stack((angles, torques), axis=1).tolist()}}}"
    effort = "speed: 60 rpm, effort: {unit: N m, mean: 500, harmonics: [[2, 300, 0]]}, flywheel: {inertia: 90 kg m2}"
    one, other = (figures(f"{{{effort}, {load}}}") for load in (waves, points))
    for id in ("dE", "delta", "omega_max", "alpha_max", "E_max"):
        assert one[id] == pytest.approx(other[id], rel=1e-5)
    # E = 150 sin 2φ + 200 sin φ + (50/3) (cos 3φ − 1)
    fine = np.radians(np.linspace(0, 360, 1_000_001))
    E = 150 * np.sin(2 * fine) + 200 * np.sin(fine) + 50 / 3 * (np.cos(3 * fine) - 1)
    assert one["dE"] == pytest.approx(np.ptp(E), rel=1e-10)


@pytest.mark.parametrize("turns", [1, 3, 4])
def test_what_repeats_sooner_is_the_same_in_a_longer_cycle(turns: int) -> None:
    usual, longer = (
        Case(kurbel.loads(CYLINDERS, overrides=(f"cycle_turns={n}",))) for n in (1, turns)
    )
    times = math.lcm(2, turns) // 2
    for id, one in usual.flywheel.key_values().items():
        other = longer.flywheel[id].value
        if id in ("phi_crossing", "lobes"):
            assert other[: len(one.value)] == pytest.approx(one.value, rel=1e-9)
            assert len(other) == times * len(one.value)
        else:
            factor = (
                times
                if id in ("work_shaft", "work_indicated")
                else 1 / times
                if id == "energy_fluctuation"
                else 1
            )
            assert other == pytest.approx(factor * one.value, rel=1e-9, abs=1e-9), id
    assert longer.torsion["M_vibratory"].value == pytest.approx(
        usual.torsion["M_vibratory"].value, rel=1e-9
    )
    orders, waves = (case.harmonics().machine for case in (usual, longer))
    result = dict(zip(np.round(waves.orders, 9), np.abs(waves.whole)))
    for order, amplitude in zip(orders.orders, np.abs(orders.whole)):
        assert result[round(order, 9)] == pytest.approx(
            amplitude, abs=1e-9 * np.abs(orders.whole).max()
        )


def test_a_press_that_works_once_in_three_turns() -> None:
    """A rectangle of work against a constant drive: ΔE = M_p φ_p (1 − φ_p/6π), whatever the phase."""
    press = "load: {unit: N m, points: [[0, 0], [400, 0], [400, 9000], [460, 9000], [460, 0], [1080, 0]]}"
    drive = "effort: {unit: N m, points: [[0, 500], [360, 500]]}"
    result = figures(
        f"{{speed: 1 Hz, cycle_turns: 3, {press}, {drive}, flywheel: {{inertia: 900 kg m2}}}}"
    )
    angle = math.radians(60)
    assert result["dE"] == pytest.approx(9000 * angle * (1 - angle / (6 * math.pi)))
    assert result["work_shaft"] == pytest.approx(500 * 6 * math.pi)
