"""Several pistons on one rod: their forces, works and mean pressures, and pistons driven by a rocker."""

import numpy as np
import pytest

import kurbel
from command import answer, run

STEAM = """
stroke: 800 mm
rod_ratio: 5
speed: 60 rpm
inclination: 30 deg
bore: 450 mm
crank_end_rod: 100 mm
indicator: {head_end: {constant: {expansion: 6 bar, compression: 1 bar}}, crank_end: mirrored}
"""
PUMP = "{name: pump, bore: 285 mm, crank_end_rod: 75 mm, lever_ratio: %s, indicator: {%s}}"
CHAMBER = "%s: {constant: {expansion: -0.4 bar, compression: %s bar}}"
MASSES = "masses: {piston: [120 kg, 80 kg], crosshead: 190 kg}\n"


def engine(ratio: str = "1", ends: str = "", more: str = "") -> str:
    both = ends or f"{CHAMBER % ('head_end', 5)}, {CHAMBER % ('crank_end', 3)}"
    return f"{STEAM}tandem: [{PUMP % (ratio, both)}]\n{more}"


A_HEAD, A_CRANK = np.pi / 4 * 0.285**2, np.pi / 4 * (0.285**2 - 0.075**2)
OUT = (-0.4e5 * A_HEAD - 3e5 * A_CRANK) * 0.8
BACK = (5e5 * A_HEAD - -0.4e5 * A_CRANK) * 0.8
"""Work in J of the pump's water on its outstroke and its return stroke; it takes in OUT − BACK."""


def test_rod_between_the_pistons_carries_what_the_tandem_piston_does() -> None:
    """Free body of the tandem piston: gas force, inertia of 80 kg, and its weight toward the shaft."""
    cylinder = kurbel.solve(engine(more=MASSES)).cylinders[0]
    state = cylinder.at([40.0, 100.0, 250.0])
    water = np.array([OUT, OUT, -BACK]) / 0.8 * [1, 1, -1]
    expected = water - 80 * state.b + 80 * 9.80665 * 0.5
    assert state.P_between == pytest.approx(expected, rel=1e-13)
    assert state.P_driven == pytest.approx(water, rel=1e-13)
    assert state.P_driving + state.P_driven == pytest.approx(state.P_gas, rel=1e-13)
    assert kurbel.solve(engine()).cylinders[0].at([40.0]).P_between == pytest.approx(
        water[:1], rel=1e-13
    )


def test_a_piston_by_a_lever_is_not_on_the_rod_between_the_pistons() -> None:
    """Neither its water nor its 50 kg pass through the rod that carries the pump in tandem of 80 kg."""
    water = f"{CHAMBER % ('head_end', 5)}, {CHAMBER % ('crank_end', 3)}"
    pumps = f"{PUMP % ('1', water)}, {(PUMP % ('0.5', water)).replace('pump', 'air pump')}"
    masses = MASSES.replace("80 kg]", "80 kg, 50 kg]")
    state = kurbel.solve(f"{STEAM}tandem: [{pumps}]\n{masses}").cylinders[0].at([40.0, 250.0])
    expected = np.array([OUT, BACK]) / 0.8 - 80 * state.b + 80 * 9.80665 * 0.5
    assert state.P_between == pytest.approx(expected, rel=1e-13)


def test_work_power_and_mean_pressure_of_every_piston() -> None:
    steam, pump = kurbel.solve(engine()).cylinders[0].pistons
    assert pump.work == pytest.approx(OUT - BACK, rel=1e-13)
    assert pump.power == pytest.approx(OUT - BACK, rel=1e-13)  # one turn a second
    assert pump.mean_pressure == pytest.approx((OUT - BACK) / (0.8 * (A_HEAD + A_CRANK)), rel=1e-13)
    assert steam.mean_pressure == pytest.approx(5e5, rel=1e-13)


@pytest.mark.parametrize("ratio", [0.5, -0.5, -1.0, 2.0])
def test_piston_by_a_rocker_takes_its_own_stroke(ratio: float) -> None:
    """By virtual work the crosshead feels ratio times its force, and its work is that of its own stroke."""
    cylinder = kurbel.solve(engine(str(ratio))).cylinders[0]
    pump = cylinder.pistons[1]
    assert pump.work == pytest.approx(abs(ratio) * (OUT - BACK), rel=1e-13)
    assert pump.mean_pressure == pytest.approx((OUT - BACK) / (0.8 * (A_HEAD + A_CRANK)), rel=1e-13)
    out, back = (OUT / 0.8, BACK / 0.8) if ratio > 0 else (BACK / 0.8, OUT / 0.8)
    assert cylinder.at([60.0, 300.0]).P_driven == pytest.approx(
        [ratio * out, ratio * back], rel=1e-13
    )
    assert abs(cylinder.energy_residual) < 1e-13
    assert cylinder.at([60.0]).P_between is None


def test_sweeps_have_each_piston_and_levers_of_both_signs() -> None:
    ratios = [0.5, -0.5, 1.0, -1.0, 2.0, -2.0]
    result = kurbel.sweep(
        engine(), {"tandem.0.lever_ratio": ratios}, ["pump.work", "piston.work", "T_max"]
    )
    alone = [kurbel.solve(engine(str(ratio))).cylinders[0] for ratio in ratios]
    assert result["pump.work"] == pytest.approx([one.pistons[1].work for one in alone], rel=1e-12)
    assert result["T_max"] == pytest.approx([one.T_max.value for one in alone], rel=1e-12)
    many = kurbel.sweep(
        engine(more=MASSES), {"masses.piston.1": [50.0, 60.0, 80.0, 90.0]}, ["P_between_max"]
    )
    one = kurbel.solve(engine(more=MASSES)).cylinders[0].P_between_max.value
    assert many["P_between_max"][2] == pytest.approx(one, rel=1e-12)


def test_json_and_table_show_every_piston() -> None:
    steam, pump = answer("forces", "-", text=engine())["cylinders"][0]["pistons"]
    assert (steam["name"], pump["name"]) == ("piston", "pump")
    assert {key_value["id"] for key_value in pump["key_values"]} == {
        "work",
        "power",
        "mean_pressure",
    }
    table = run("forces", "-", text=engine()).output
    assert "Each piston" in table
    listed = run("forces", "-", "--key-values", "-f", "csv", text=engine()).output
    assert listed.startswith("key_value,unit")
