"""Good machine files: what arrives in the machine, in SI; values set over the file by --set."""

import math
import re
from pathlib import Path

import pytest

from good_machines import ALL, DEMO
from kurbel.errors import KurbelError, MachineFileError
from kurbel.machine_file import load, loads


def test_the_flat_machine_of_the_contract() -> None:
    machine = loads(DEMO)
    (cylinder,) = machine.cylinders
    assert machine.name == "Demo steam engine"
    assert machine.speed == 50 / 60
    assert cylinder.name == "cylinder 1"
    assert (cylinder.mechanism.crank, cylinder.mechanism.rod) == (0.4, 2.0)
    (piston,) = cylinder.pistons
    assert piston.bore == 0.45
    card = piston.indicator.head_end
    assert card is piston.indicator.crank_end
    assert card.lines[0].pressures[0] == 9.5 * 98066.5


def test_several_cylinders_with_everything() -> None:
    machine = loads(ALL["full"])
    high, low = machine.cylinders
    assert [high.name, low.name] == ["HP", "LP"]
    assert (high.mechanism.crank, low.mechanism.rod, low.crank_position) == (0.4, math.inf, 90)
    assert [piston.bore for piston in high.pistons] == [0.45, 0.285]
    masses, friction = high.masses, high.friction
    assert (masses.parts, masses.at_crosshead(math.inf)) == (717, 717 + 110)
    assert friction.rings.count == 3
    steam = high.pistons[0].indicator.head_end
    assert (steam.admission, steam.exhaust, steam.cut_off, steam.release, steam.exponent) == (
        8e5,
        0.2e5,
        0.3,
        1,
        1,
    )
    assert machine.limits == (("c_max", 6.0), ("delta", 1 / 200))
    wheel, coupling = machine.flywheel, machine.coupling
    # GD² of 40000 kgf m² is 4J with J in kg m²
    assert (wheel.inertia, wheel.fluctuation) == (10000, 0.01)
    assert (coupling.stiffness, coupling.inertia) == (1e6, 500)
    assert (machine.load.power, machine.crankshaft.allowable_bending) == (2, 60e6)


def test_engines_and_diagrams() -> None:
    otto = loads(ALL["gas_engine"]).cylinders[0].pistons[0].indicator.head_end
    # c = 1/(ε − 1), ε = 5
    assert (otto.clearance, otto.exponent, otto.expansion_exponent) == (0.25, 1.4, 1.4)
    machine = loads(ALL["diesel"])
    diesel, diagram = machine.cylinders[0].pistons[0].indicator.head_end, machine.load.diagram
    assert (diesel.peak, diesel.expansion_exponent) == (45e5, 1.35)
    assert (diagram.angles, diagram.torques) == ((0, 90, 90, 720), (100, 100, 500, 100))
    machine = loads(ALL["effort"])
    assert (machine.cylinders, machine.load) == ((), None)
    assert machine.effort.torques[1] == 300 * 9.80665


@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
def test_line_ends_do_not_matter(ending: str) -> None:
    assert loads(DEMO.replace("\n", ending)).name == "Demo steam engine"


def test_the_name_is_that_of_the_file(tmp_path: Path) -> None:
    path = tmp_path / "Tafel I.yaml"
    path.write_text("crank: 400 mm\nrod_ratio: 5\n")
    assert load(path).name == "Tafel I"


def test_rules_of_parts_are_reported_although_another_part_is_wrong() -> None:
    with pytest.raises(MachineFileError) as caught:
        loads("crank: 400 mm\nrod: 300 mm\nbore: 90 mm\nhead_end_rod: 95 mm\nflywheel: {}\n")
    assert [fault.path for fault in caught.value.faults] == [
        ("rod",),
        ("head_end_rod",),
        ("flywheel",),
    ]


@pytest.mark.parametrize(
    ("text", "value"),
    [("1/80", 1 / 80), ("1.25 %", 0.0125), (" 1 / 80 ", 1 / 80), ("1⁄80", 1 / 80)],
)
def test_a_ratio_is_written_as_people_do(text: str, value: float) -> None:
    machine = loads(
        f"crank: 1 m\nrod_ratio: 10/3\nefficiency: 75 %\nflywheel: {{fluctuation: {text}}}\nlimits: {{delta: {text}}}"
    )
    assert machine.flywheel.fluctuation == value
    assert machine.limits == (("delta", value),)
    assert machine.efficiency == 0.75
    assert machine.cylinders[0].mechanism.rod == 10 / 3


# `--set KEY=VALUE`: values over those of the file, and faults that name them


def test_a_value_of_any_depth_is_set() -> None:
    card = "indicator.head_end.expansion.1=[0.3, 9.5]"
    machine = loads(
        DEMO,
        "m",
        ["speed=9 rpm", "speed=60 rpm", "flywheel.fluctuation=1/80", card, "masses={piston: 9 kg}"],
    )
    (cylinder,) = machine.cylinders
    assert machine.speed == 1  # the last one holds
    assert machine.flywheel.fluctuation == 1 / 80
    assert cylinder.masses.parts == 9
    assert cylinder.pistons[0].indicator.head_end.lines[0].fractions[1] == 0.3


def test_what_is_like_the_changed_one_changes_with_it() -> None:
    for key in ("cylinders.0.crank", "cylinders[0].crank"):
        assert [
            cylinder.mechanism.crank
            for cylinder in loads(ALL["like_one"], "m", [f"{key}=150 mm"]).cylinders
        ] == [0.15, 0.15]
    changed = ["cylinders.count=2", "cylinders.firing_order=1-2", "cylinders.each.bore=1 m"]
    results = [
        (cylinder.pistons[0].bore, cylinder.crank_position)
        for cylinder in loads(ALL["equal_cylinders"], "m", changed).cylinders
    ]
    assert results == [(1, 0), (1, 360)]


@pytest.mark.parametrize(
    ("override", "message"),
    [
        (f"{'9' * 5000}=3", "99…: unknown key; valid keys here are kurbel, name, speed"),
        ("name=a\udcff", "is no UTF-8"),
    ],
)
def test_a_fault_names_the_override(override: str, message: str) -> None:
    with pytest.raises(KurbelError, match=re.escape(message)) as caught:
        loads(DEMO, "m", [override])
    assert "Traceback" not in str(caught.value)
