"""The Python API, as a notebook uses it."""

from __future__ import annotations

import copy
import math
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kurbel
from representative import case_of

CONFIGS = Path(__file__).parent.parent / "configs"


def test_import_kurbel_imports_nothing_else() -> None:
    code = "import sys, kurbel; print([m for m in sys.modules if m in ('numpy', 'yaml', 'click', 'rich')])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"


def test_a_machine_built_in_python_is_the_machine_of_the_file() -> None:
    from_file = kurbel.loads("{speed: 50 rpm, stroke: 800 mm, rod_ratio: 5}")
    built = kurbel.Machine((kurbel.Cylinder(kurbel.SliderCrank(0.4, 2.0)),), speed=50 / 60)
    for machine in (from_file, built):
        motion = kurbel.solve(machine).cylinders[0].motion
        assert motion.c_max is not None
        assert motion.c_max.value == pytest.approx(1.0198331 * 0.4 * 2 * math.pi * 50 / 60, rel=1e-7)


def test_functions_are_pointwise() -> None:
    """f(φ)[::7] == f(φ[::7]): no quantity knows its neighbours."""
    forces = kurbel.solve(kurbel.load(CONFIGS / "waterworks.yaml")).cylinders[0]
    degrees = np.linspace(0, 360, 721)
    whole, part = forces.at(degrees), forces.at(degrees[::7])
    given = [id for id in whole.rows if whole[id] is not None]
    assert {"x", "c", "b", "p_head", "p_crank", "P_gas", "P", "S", "N", "D", "T", "M"} <= {*given}
    for id in given:
        assert (whole[id][::7] == part[id]).all(), id


def test_results_repeat_every_turn() -> None:
    forces = kurbel.solve(kurbel.load(CONFIGS / "waterworks.yaml")).cylinders[0]
    degrees = np.arange(0.0, 360.0, 7.5)
    for name in ("x", "P", "T", "N"):
        assert (getattr(forces.at(degrees), name) == getattr(forces.at(degrees + 3600), name)).all()


# results by name

PLAIN = "{speed: 60 rpm, crank: 400 mm, rod: 2 m, masses: {piston: 100 kg}%s}"
PRESSURE = ", bore: 450 mm, indicator: {head_end: {constant: {expansion: 5 bar, compression: 1 bar}}}"


@pytest.mark.parametrize(
    ("name", "told"), [("T_mx", "no key value 'T_mx'; did you mean 'T_max'"), ("e_K", "this machine has no loss_cross")]
)
def test_a_name_that_is_not_there_is_told(name: str, told: str) -> None:
    (cylinder,) = kurbel.solve(kurbel.loads(PLAIN % PRESSURE)).cylinders
    with pytest.raises(kurbel.KurbelError, match=told):
        _ = cylinder[name]


def test_of_several_cylinders_each_has_its_own() -> None:
    case = kurbel.solve(kurbel.load(CONFIGS / "waterworks-two-cranks.yaml"))
    assert case["T_max"].value == case.flywheel.T_max.value  # type: ignore[union-attr]
    with pytest.raises(kurbel.KurbelError, match="each cylinder has its own P_max"):
        _ = case["P_max"]
    assert case.cylinders[1]["P_max"].value > 0


@pytest.mark.parametrize("degrees", ["abc", "", [float("nan")], [0.0, math.inf], None, {"phi": 1}])
def test_angles_that_are_none_are_refused_by_the_root_class(degrees: object) -> None:
    case = case_of("gas-engine")
    for results in (case.cylinders[0], case.flywheel, case.stress):
        for ask in (results.columns, results.at):
            with pytest.raises(kurbel.KurbelError, match="crank angles are"):
                ask(degrees)  # type: ignore[operator, arg-type]


def test_some_columns_by_id_or_symbol() -> None:
    case = case_of("gas-engine")
    (cylinder,) = case.cylinders
    found, every = cylinder.columns([0, 30, 90], "T", "p_H"), cylinder.columns([0, 30, 90])
    assert list(found) == ["phi", "T", "p_head"]
    assert all(np.array_equal(values, every[id]) for id, values in found.items())
    with pytest.raises(kurbel.KurbelError, match="no column 'P_inertai'; did you mean 'P_inertia'"):
        cylinder.columns([0], "P_inertai")
    with pytest.raises(kurbel.KurbelError, match="this machine has no S_crank: Force along an exact rod"):
        cylinder.columns([0], "S_crank")


def test_a_case_says_what_it_is() -> None:
    case = case_of("gas-engine")
    assert repr(case) == "<kurbel case 'Lying gas engine': .cylinders (1), .flywheel, .stress>"
    assert repr(case.cylinders[0]) == "<kurbel forces of cylinder 1: ['id'], key_values(), columns(degrees)>"
    assert repr(case.flywheel).startswith("<kurbel flywheel of the whole machine: ")


def test_notebooks_show_tables_that_are_escaped() -> None:
    text = "{name: '<b>A&B</b>', " + (PLAIN % PRESSURE)[1:]
    case = kurbel.solve(kurbel.loads(text))
    page = case._repr_html_()
    assert "<h3>&lt;b&gt;A&amp;B&lt;/b&gt;</h3>" in page
    assert "<b>" not in page
    assert '<th scope="row">c_max</th><td class="r">2.563</td><td>m/s</td>' in page  # 2π · 0.4 · 1.0198331
    assert "&lt; 10⁻¹⁴</td>" in page
    locked = kurbel.loads((PLAIN % PRESSURE)[:-1] + ", friction: {crosshead: 20}}")
    assert "<p>" in kurbel.solve(locked).cylinders[0]._repr_html_()


def test_a_record_tells_what_was_given_to_it() -> None:
    cylinder = kurbel.Cylinder(kurbel.SliderCrank(crank=0.4, rod=2.0), name="HP")
    assert repr(cylinder) == "Cylinder(mechanism=SliderCrank(crank=0.4, rod=2.0), name='HP')"


def test_a_case_that_has_answered_is_handed_to_other_processes() -> None:
    """Its states were asked for a column before they had their fields, for ever."""
    case = kurbel.solve(kurbel.load("configs/waterworks.yaml"))
    largest = case["T_max"].value
    assert pickle.loads(pickle.dumps(case))["T_max"].value == copy.deepcopy(case)["T_max"].value == largest


# a machine as a text or a path, scalars, and how a figure prints

WATERWORKS = CONFIGS / "waterworks.yaml"
FLAT = "{speed: 60 rpm, stroke: 1 m, rod_ratio: 5}"
TAKEN = {"a path": WATERWORKS, "a path as a text": str(WATERWORKS), "a text": WATERWORKS.read_text(encoding="utf-8")}


@pytest.mark.parametrize("given", TAKEN)
@pytest.mark.parametrize("take", [kurbel.solve, kurbel.Case])
def test_a_machine_may_be_a_text_or_a_path(take: Any, given: str) -> None:
    assert take(TAKEN[given]).cylinders[0]["T_max"] == kurbel.solve(kurbel.load(WATERWORKS)).cylinders[0]["T_max"]


@pytest.mark.parametrize("given", [5, None, b"stroke: 1 m"])
def test_what_is_no_machine_is_refused_by_the_root_class(given: Any) -> None:
    for take in (kurbel.solve, kurbel.Case, lambda one: kurbel.sweep(one, {"rod_ratio": [4]})):
        with pytest.raises(kurbel.KurbelError):
            take(given)["stroke"]


@pytest.mark.parametrize("speed", [2.0, "120 rpm", np.float64(2)])
def test_a_scalar_holds_for_every_row(speed: Any) -> None:
    """b_max of a slider-crank is R ω² (1 + R/L), at the inner dead centre."""
    found = kurbel.sweep(kurbel.loads(FLAT), {"rod_ratio": [4, 5], "speed": speed}, ["b_max"])
    ratios = np.array([1 / 4, 1 / 5])
    assert found["b_max"] == pytest.approx(0.5 * (2 * math.pi * 2) ** 2 * (1 + ratios), rel=1e-12)


def test_a_figure_prints_as_people_read_it() -> None:
    """10 bar on 0.01 m2 of a Scotch yoke: 10 kN · sin φ at the crank pin, and 10 kN · 0.8 m in every second."""
    text = (
        "{speed: 60 rpm, mechanism: scotch-yoke, crank: 400 mm, bore: 112.8379167 mm, "
        "indicator: {head_end: {constant: {expansion: 10 bar, compression: 0 bar}}}}"
    )
    case = kurbel.solve(kurbel.loads(text))
    assert str(case["T_max"]) == "10.00 kN at 90.00°"
    assert str(case["power"]) == "8.000 kW"
    assert str(case["stroke"]) == "800.0 mm"
