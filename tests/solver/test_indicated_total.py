"""Indicated work, power and mechanical efficiency of the whole machine, from the balance of its energy."""

import json
from pathlib import Path

import pytest

import kurbel
from command import run
from representative import CONFIGS

BALANCED = [
    "waterworks",
    "waterworks-two-cranks",
    "compressor-two-stage",
    "locomotive",
    "diesel-four-stroke",
]


@pytest.mark.parametrize("name", BALANCED)
def test_work_put_in_is_work_given_off_and_friction(name: str) -> None:
    case = kurbel.solve(kurbel.load(CONFIGS[name]))
    works = [cylinder.work_driving for cylinder in case.cylinders]
    driven = -sum(cylinder.work_driven for cylinder in case.cylinders)
    lost = sum(cylinder.friction_work or 0.0 for cylinder in case.cylinders)
    shaft = case.flywheel.work_shaft
    put_in = sum(works) + max(-shaft, 0.0)
    assert case.flywheel.work_indicated == pytest.approx(sum(works) or -driven, rel=1e-12)
    assert case.flywheel.mechanical_efficiency == pytest.approx((put_in - lost) / put_in, rel=1e-9)
    cycles_per_second = case.machine.speed / case.machine.revolutions
    assert case.flywheel.power_indicated == pytest.approx(
        case.flywheel.work_indicated * cycles_per_second, rel=1e-12
    )


def test_loss_of_redtenbachers_locomotive() -> None:
    """1.304 % over the stroke: the crosshead alone rubs, on the forces of the steam and of the masses."""
    case = kurbel.solve(kurbel.load(CONFIGS["locomotive"]))
    assert 1 - case.flywheel.mechanical_efficiency == pytest.approx(
        case["loss_crosshead"].value, rel=1e-12
    )


def test_efficiency_of_the_file_is_that_of_the_machine() -> None:
    """Without friction η alone takes from the work of the pistons."""
    case = kurbel.solve(kurbel.load(CONFIGS["marine-diesel"]))
    assert case.flywheel.mechanical_efficiency == pytest.approx(case.machine.efficiency, rel=1e-12)


def test_ram_is_useful_work() -> None:
    """A crank that a motor drives against the resistance of a ram has no pistons, and no indicated work."""
    case = kurbel.solve(kurbel.load(CONFIGS["shaper"]))
    assert case.flywheel.work_indicated is None
    assert case.flywheel.mechanical_efficiency is None


@pytest.mark.parametrize("name", ["waterworks", "waterworks-two-cranks", "compressor-two-stage"])
def test_forces_prints_the_totals_of_several_pistons(name: str) -> None:
    """They are sums over the cylinders, and the same figures as those of `kurbel flywheel`."""
    case = kurbel.solve(kurbel.load(CONFIGS[name]))
    text = run("forces", str(CONFIGS[name]), "-f", "json").stdout
    figures = json.loads(text)["machine_key_values"]
    totals = {figure["id"]: figure["value"] for figure in figures}
    for id in ("work_indicated", "power_indicated", "mechanical_efficiency"):
        assert totals[id] == case.flywheel[id].value
    cycles_per_second = case.machine.speed / case.machine.revolutions
    lost = sum(cylinder.friction_work for cylinder in case.cylinders)
    assert totals["work_friction"] == pytest.approx(lost, rel=1e-12)
    assert totals["power_friction"] == pytest.approx(lost * cycles_per_second, rel=1e-12)


def test_work_of_a_cylinder_with_a_shorter_cycle_counts_twice(tmp_path: Path) -> None:
    """A four-stroke engine drives a pump that works in every turn: two of its cycles are one of the machine."""
    file = tmp_path / "engine-and-pump.yaml"
    file.write_text(ENGINE_AND_PUMP, encoding="utf-8")
    case = kurbel.solve(kurbel.load(file))
    engine, pump = case.cylinders
    text = run("forces", str(file), "-f", "json").stdout
    figures = json.loads(text)["machine_key_values"]
    totals = {figure["id"]: figure["value"] for figure in figures}
    # constant pressures: p A s in each working stroke
    assert engine.friction_work == pytest.approx(4 * 0.2 * 100.0)
    assert pump.friction_work == pytest.approx(2 * 0.2 * 50.0)
    assert totals["work_friction"] == pytest.approx(4 * 0.2 * 100.0 + 2 * 2 * 0.2 * 50.0)
    assert totals["power_friction"] == pytest.approx(totals["work_friction"] / 2)


ENGINE_AND_PUMP = """
speed: 60 rpm
cycle: four-stroke
cylinders:
  - {name: engine, crank: 100 mm, rod: 400 mm, bore: 200 mm, friction: {constant: 100 N},
     indicator: {head_end: {unit: bar, intake: [[0, 0], [1, 0]], compression: [[1, 0], [0, 0]],
                            expansion: [[0, 5], [1, 5]], exhaust: [[1, 0], [0, 0]]}}}
  - {name: pump, cycle: two-stroke, crank: 100 mm, rod: 400 mm, bore: 100 mm, friction: {constant: 50 N},
     indicator: {head_end: {constant: {expansion: 0 bar, compression: 2 bar}}}}
"""


def test_one_piston_has_no_totals_besides_its_own() -> None:
    assert (
        "machine_key_values" not in run("forces", str(CONFIGS["locomotive"]), "-f", "json").stdout
    )


def test_csv_of_one_cylinder_has_no_column_for_its_name() -> None:
    rows = run("forces", str(CONFIGS["waterworks"]), "--key-values", "-f", "csv").stdout
    assert rows.startswith("key_value,unit,value,at_deg\nstroke,m,0.8,\n")
    assert rows.splitlines()[-1].startswith("mechanical_efficiency,,0.98945")
