"""Figures that no machine built has are doubted; those of shipped machines and worked examples are not."""

from pathlib import Path

import pytest

from kurbel import load, loads
from kurbel.errors import KurbelError
from kurbel.notes.plausible import cylinder_doubts, machine_doubts
from kurbel.notes.warnings import machine_notes
from kurbel.solver.case import Case
from representative import SHIPPED

EXAMPLES = sorted(
    path for path in Path(__file__).parents[1].glob("examples/*.yaml") if path.stem != "answers"
)
ENGINE = {
    "speed": "2000 rpm",
    "stroke": "102 mm",
    "rod": "102 mm",
    "bore": "95 mm",
    "masses": "{piston: 0.5 kg, connecting_rod: {mass: 0.3 kg, center_of_gravity: 60 mm, inertia: 1e-3 kg m2}}",
    "indicator": "{pressures: absolute, head_end: {otto: {intake: 1 bar, clearance: 0.158, peak: 40 bar}}}",
    "cycle": "four-stroke",
}
"""A small petrol engine."""


def doubts(**changed: str) -> list[str]:
    """All warnings on the engine with these keys changed."""
    lines = ENGINE | changed
    if "rod_ratio" in changed.get("stroke", ""):
        del lines["rod"]
    text = "\n".join(f"{key}: {value}" for key, value in lines.items())
    return [note.text for note in machine_notes(Case(loads(text)))]


@pytest.mark.parametrize(
    ("key", "value", "sentence"),
    [
        # √(1.588/0.3) = 2.30073 m over 0.102 m
        (
            "masses",
            "{connecting_rod: {mass: 0.3 kg, center_of_gravity: 60 mm, inertia: 1.588 kg m2}}",
            "a radius of gyration √(I/m) of 22.5561 times the length of the connecting rod",
        ),
        # 2 · 0.102 m · 2000/2π
        ("speed", "2000 rad/s", "a mean piston speed of 64.9352 m/s is beyond anything built"),
        # 1380/(7850 · 0.095³)
        ("masses", "{piston: 1380 kg}", "a reciprocating mass of 205.04 times a cube of steel"),
        (
            "gas",
            "{inlet_temperature: 45 K, molar_mass: 29 g/mol}",
            "a gas temperature of 45 K is none",
        ),
        ("gas", "{inlet_temperature: 300 K, molar_mass: 2 kg/mol}", "a molar mass of 2"),
        ("ambient", "101325 bar", "an ambient pressure of 101325 bar is none in which engines run"),
        (
            "indicator",
            "{pressures: absolute, head_end: {otto: {intake: 1 bar, clearance: 15.8, peak: 40 bar}}}",
            "a clearance of 15.8 times the stroke volume leaves no compression",
        ),
        ("brake_power", "50 W", "% of the indicated power"),
        ("efficiency", "0.009", "an efficiency of 0.009 is that of no machine that runs"),
        ("stroke", "30 m\nrod_ratio: 4", "a stroke of 30 m is beyond anything built"),
        ("bore", "6 m", "a bore of 6000 mm is beyond anything built"),
    ],
)
def test_what_no_machine_has_is_doubted(key: str, value: str, sentence: str) -> None:
    assert doubts() == []
    assert any(sentence in text for text in doubts(**{key: value}))


@pytest.mark.parametrize("file", [*SHIPPED, *EXAMPLES], ids=lambda path: path.stem)
def test_machines_that_exist_are_not_doubted(file: Path) -> None:
    try:
        machine = load(file)
    except KurbelError:
        pytest.skip("not a machine by itself")
    texts = [text for cylinder in machine.cylinders for text in cylinder_doubts(machine, cylinder)]
    assert [*machine_doubts(machine), *texts] == []
