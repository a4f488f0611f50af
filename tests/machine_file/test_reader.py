"""Good machine files: what arrives in the machine, in SI."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from good_machines import DEMO, DIESEL, EFFORT, FULL, GAS_ENGINE
from kurbel.errors import MachineFileError
from kurbel.machine_file import load, loads


def test_the_flat_machine_of_the_contract() -> None:
    machine = loads(DEMO)
    (cylinder,) = machine.cylinders
    assert machine.name == "Demo steam engine"
    assert machine.speed == 50 / 60
    assert cylinder.name == "cylinder 1"
    assert (cylinder.mechanism.crank, cylinder.mechanism.rod) == (0.4, 2.0)  # type: ignore[attr-defined]
    (piston,) = cylinder.pistons
    assert piston.bore == 0.45
    assert piston.indicator is not None
    card = piston.indicator.head_end
    assert card is piston.indicator.crank_end
    assert card.lines[0].pressures[0] == 9.5 * 98066.5  # type: ignore[union-attr]


def test_several_cylinders_with_everything() -> None:
    machine = loads(FULL)
    high, low = machine.cylinders
    assert [high.name, low.name] == ["HP", "LP"]
    assert (high.mechanism.crank, low.mechanism.rod, low.crank_position) == (0.4, math.inf, 90)  # type: ignore[attr-defined]
    assert [piston.bore for piston in high.pistons] == [0.45, 0.285]
    masses, friction = high.masses, high.friction
    assert (masses.parts, masses.reciprocating) == (717, 717 + 110)  # type: ignore[union-attr]
    assert friction.rings.count == 3  # type: ignore[union-attr]
    steam = high.pistons[0].indicator.head_end  # type: ignore[union-attr]
    assert (steam.admission, steam.exhaust, steam.cut_off, steam.release, steam.exponent) == (8e5, 0.2e5, 0.3, 1, 1)  # type: ignore[union-attr]
    assert machine.limits == (("c_max", 6.0), ("delta", 1 / 200))
    wheel, coupling = machine.flywheel, machine.coupling
    # GD² of 40000 kgf m² is 4J with J in kg m²
    assert (wheel.inertia, wheel.fluctuation) == (10000, 0.01)  # type: ignore[union-attr]
    assert (coupling.stiffness, coupling.inertia) == (1e6, 500)  # type: ignore[union-attr]
    assert (machine.load.power, machine.crankshaft.allowable_bending) == (2, 60e6)  # type: ignore[union-attr]


def test_engines_and_diagrams() -> None:
    otto = loads(GAS_ENGINE).cylinders[0].pistons[0].indicator.head_end  # type: ignore[union-attr]
    # c = 1/(ε − 1), ε = 5
    assert (otto.clearance, otto.exponent, otto.expansion_exponent) == (0.25, 1.4, 1.4)  # type: ignore[union-attr]
    machine = loads(DIESEL)
    diesel, diagram = machine.cylinders[0].pistons[0].indicator.head_end, machine.load.diagram  # type: ignore[union-attr]
    assert (diesel.peak, diesel.expansion_exponent) == (45e5, 1.35)  # type: ignore[union-attr]
    assert (diagram.angles, diagram.torques) == ((0, 90, 90, 720), (100, 100, 500, 100))  # type: ignore[union-attr]
    machine = loads(EFFORT)
    assert (machine.cylinders, machine.load) == ((), None)
    assert machine.effort.torques[1] == 300 * 9.80665  # type: ignore[union-attr]


@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
def test_line_ends_do_not_matter(ending: str) -> None:
    assert loads(DEMO.replace("\n", ending)).name == "Demo steam engine"


def test_the_name_is_that_of_the_file(tmp_path: Path) -> None:
    path = tmp_path / "Tafel I.yaml"
    path.write_text("crank: 400 mm\nrod_ratio: 5\n")
    assert load(path).name == "Tafel I"


def test_rules_of_parts_are_told_although_another_part_is_wrong() -> None:
    with pytest.raises(MachineFileError) as caught:
        loads("crank: 400 mm\nrod: 300 mm\nbore: 90 mm\nhead_end_rod: 95 mm\nflywheel: {}\n")
    assert [fault.path for fault in caught.value.faults] == [("rod",), ("head_end_rod",), ("flywheel",)]


@pytest.mark.parametrize(
    ("text", "value"), [("1/80", 1 / 80), ("1.25 %", 0.0125), (" 1 / 80 ", 1 / 80), ("1⁄80", 1 / 80)]
)
def test_a_ratio_is_written_as_people_do(text: str, value: float) -> None:
    machine = loads(
        f"crank: 1 m\nrod_ratio: 10/3\nefficiency: 75 %\nflywheel: {{fluctuation: {text}}}\nlimits: {{delta: {text}}}"
    )
    assert machine.flywheel is not None
    assert machine.flywheel.fluctuation == value
    assert machine.limits == (("delta", value),)
    assert machine.efficiency == 0.75
    assert machine.cylinders[0].mechanism.rod == 10 / 3  # type: ignore[attr-defined]
