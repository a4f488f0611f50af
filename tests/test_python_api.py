"""What Python may be used for stays: public names with their signatures, and every attribute that the docs name.

Figures are those of the command line: the same machine, the same quantity, whichever way it is asked for.
"""

from __future__ import annotations

import inspect
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

import kurbel
from kurbel.cli import kurbel as command_line

CONFIGS = Path(__file__).parent.parent / "configs"
MACHINES = ["waterworks", "gas-engine", "coupled-blower", "crank-rocker"]

CYLINDER = (
    "mechanism, name='cylinder 1', pistons=(), masses=None, friction=None, inclination=None, crank_position=0.0, "
    "bank_angle=0.0, axial_position=None, counterweights=(), ram_force=None, moment=None, cycle=None, point=None"
)
MACHINE = (
    "cylinders, name='machine', speed=None, cycle='two-stroke', efficiency=1.0, ambient=101325.0, brake_power=None, "
    "flywheel=None, load=None, effort=None, coupling=None, crankshaft=None, counterweights=(), balance_shafts=(), "
    "moment_reference=None, locomotive=None, shaft=None, limits=(), expect=(), uncertainty=(), rotation=None, "
    "origin=None, cases=()"
)
SIGNATURES = {
    "Case": "machine, count=None",
    "Cylinder": CYLINDER,
    "Machine": MACHINE,
    "Piston": "bore, head_end_rod=0.0, crank_end_rod=0.0, indicator=None, name='piston'",
    "SliderCrank": "crank, rod, offset=0.0",
    "draw": "case, *names, units='metric', angles=None",
    "find": "machine, vary, wanted=(), least='', greatest='', where=()",
    "load": "path, overrides=(), case=''",
    "loads": "text, name='<text>', overrides=()",
    "solve": "machine",
    "sweep": "machine, inputs, columns=(), with_angles=False",
}
CLASSES_ALONE = {"KurbelError": Exception, "Mechanism": object}
"""Classes that are not called by users, and what they come from."""


def printed(command: str, machine: str, *options: str) -> dict[str, Any]:
    """Return what the command line prints of a shipped machine as JSON, in SI."""
    arguments = [command, str(CONFIGS / f"{machine}.yaml"), "-f", "json", *options]
    result = CliRunner().invoke(command_line, arguments)
    assert result.exit_code == 0, result.stderr
    answer: dict[str, Any] = json.loads(result.stdout)
    return answer


def solved(machine: str) -> kurbel.Case:
    return kurbel.solve(kurbel.load(CONFIGS / f"{machine}.yaml"))


def test_public_names() -> None:
    assert sorted(kurbel.__all__) == sorted([*SIGNATURES, *CLASSES_ALONE])
    assert kurbel.__version__
    assert all(issubclass(getattr(kurbel, name), base) for name, base in CLASSES_ALONE.items())


@pytest.mark.parametrize("name", SIGNATURES)
def test_signatures(name: str) -> None:
    """Annotations apart, which may say the same in many ways."""
    parameters = inspect.signature(getattr(kurbel, name)).parameters.values()
    bare = [one.replace(annotation=inspect.Parameter.empty) for one in parameters if one.name != "self"]
    assert ", ".join(map(str, bare)) == SIGNATURES[name]


def same(found: Any, told: dict[str, Any]) -> None:
    """A key value of Python is that of the command line: value, unit and angle."""
    value = list(found.value) if isinstance(told["value"], list) else found.value
    assert value == told["value"]
    assert (found.unit, found.degrees) == (told["unit"], told.get("at_deg"))
    assert (found.quantity.id, found.quantity.symbol) == (told["id"], told["symbol"])


@pytest.mark.parametrize("machine", MACHINES)
def test_key_values_of_cylinders(machine: str) -> None:
    case = solved(machine)
    parts = printed("forces", machine, "--key-values")["cylinders"]
    assert len(case.cylinders) == len(parts)
    for cylinder, part in zip(case.cylinders, parts):
        told = {one["id"]: one for one in part["key_values"]}
        assert set(cylinder.key_values()) >= set(told)
        for id, one in told.items():
            same(cylinder[id], one)
            same(cylinder[one["symbol"]], one)
            same(cylinder.key_values()[id], one)
            # what only some mechanisms have is no attribute, but is found by its name
            if "at_deg" in one and hasattr(cylinder, id):
                extreme = getattr(cylinder, id)
                assert (extreme.value, extreme.degrees) == (one["value"], one["at_deg"])
        for id in ("c_max", "c_min", "b_max", "b_min"):
            if id in told:
                assert getattr(cylinder.motion, id).value == told[id]["value"]
                assert getattr(cylinder.motion, id).degrees == told[id]["at_deg"]


OF_THE_MACHINE = [
    *(("flywheel", one) for one in MACHINES),
    *(("balance", one) for one in MACHINES if one != "crank-rocker"),
    *(("stress", "gas-engine"), ("torsion", "coupled-blower")),
]


@pytest.mark.parametrize(("command", "machine"), OF_THE_MACHINE)
def test_key_values_of_the_machine(command: str, machine: str) -> None:
    case = solved(machine)
    results = getattr(case, command)
    told = printed(command, machine, "--key-values")["machine_key_values"]
    assert set(results.key_values()) >= {one["id"] for one in told}
    for one in told:
        same(results[one["id"]], one)
        same(results[one["symbol"]], one)
    of_the_machine = {one["id"]: one for one in told}
    for id in {"dE", "J", "delta", "F_free_max", "sigma_pin_max", "natural_frequency"} & set(of_the_machine):
        same(case[id], of_the_machine[id])


@pytest.mark.parametrize(("command", "machine"), [("forces", one) for one in MACHINES] + OF_THE_MACHINE)
def test_columns(command: str, machine: str) -> None:
    """By `columns`, all or some of them, and by `at`, as attributes."""
    case, angles = solved(machine), [0.0, 45.0, 200.0]
    results = case.cylinders[0] if command == "forces" else getattr(case, command)
    answer = printed(command, machine, "--angles", "0,45,200")
    told = answer["cylinders"][0]["columns"] if command == "forces" else answer["machine_columns"]
    columns, state = results.columns(angles), results.at(np.array(angles))
    for one in told:
        assert columns[one["id"]].tolist() == one["values"]
        assert results.columns(angles, one["symbol"])[one["id"]].tolist() == one["values"]
        assert list(results.columns(angles, one["id"])) == list(dict.fromkeys(["phi", one["id"]]))
        assert np.broadcast_to(state[one["id"]], (3,)).tolist() == one["values"]
        if hasattr(state, one["id"]):
            assert getattr(state, one["id"]) is state[one["id"]]


def test_the_example_of_the_package() -> None:
    machine = kurbel.loads("{speed: 50 rpm, stroke: 800 mm, rod_ratio: 5, masses: {piston: 830 kg}}", name="engine")
    case = kurbel.solve(machine)
    cylinder = case.cylinders[0]
    assert round(cylinder.motion.c_max.value, 4) == 2.1359
    assert round(cylinder.motion.c_max.degrees, 4) == 79.1001
    # m r ω² (1 ± λ) at the dead centres
    least, most = (830 * 0.4 * (2 * math.pi * 50 / 60) ** 2 * factor for factor in (1.2, 0.8))
    assert cylinder.at([0, 90, 180]).P_inertia[[0, 2]].tolist() == pytest.approx([-least, most], rel=1e-14)


def test_machines_made_and_changed() -> None:
    file = str(CONFIGS / "waterworks.yaml")
    faster = kurbel.load(file, ["speed=100 rpm"])
    assert faster.speed == 2 * kurbel.load(file).speed
    assert isinstance(faster, kurbel.Machine)
    assert kurbel.loads("{crank: 1 m, rod: 5 m}", overrides=["crank=2 m"]).cylinders[0].mechanism.stroke == 4.0
    built = kurbel.Machine((kurbel.Cylinder(kurbel.SliderCrank(crank=0.4, rod=2.0), pistons=(kurbel.Piston(0.45),)),))
    assert isinstance(built.cylinders[0].mechanism, kurbel.Mechanism)
    assert kurbel.solve(built)["stroke"].value == 0.8
    with pytest.raises(kurbel.KurbelError):
        kurbel.SliderCrank(crank=0.4, rod=0.3)


def test_sweep() -> None:
    machine = kurbel.load(CONFIGS / "waterworks.yaml")
    found = kurbel.sweep(machine, {"rod_ratio": [3, 0.5], "speed": ["40 rpm"] * 2}, ["T_max", "dE"], with_angles=True)
    assert list(found) == ["T_max", "T_max_at", "dE", "failure"]
    assert isinstance(found["T_max"], np.ndarray)
    case = kurbel.solve(kurbel.load(CONFIGS / "waterworks.yaml", ["rod_ratio=3", "speed=40 rpm"]))
    assert found["T_max"][0] == pytest.approx(case["T_max"].value, rel=1e-13)
    assert found["T_max_at"][0] == pytest.approx(case["T_max"].degrees, abs=1e-9)
    assert found["dE"][0] == pytest.approx(case["dE"].value, rel=1e-12)
    assert math.isnan(found["T_max"][1])
    assert found["failure"][1]
    assert not found["failure"][0]


def test_what_a_notebook_shows(tmp_path: Path) -> None:
    case = solved("gas-engine")
    for shown in (case, case.cylinders[0], case.flywheel):
        assert shown._repr_html_().count("<table") >= 1
        assert repr(shown).startswith("<kurbel ")
    drawing = kurbel.draw(case, "effort")
    assert drawing._repr_svg_().startswith("<svg")
    assert [mark.figure.name.symbol for mark in drawing.pictures[0].panels[0].marks] == ["T_max", "T_min"]
    drawing.save(str(tmp_path / "effort.svg"))
    assert (tmp_path / "effort.svg").read_text(encoding="utf-8").lstrip().startswith("<")
    assert len(kurbel.draw(case, "mechanism", angles=(30.0,), units="si").pictures) == 1
