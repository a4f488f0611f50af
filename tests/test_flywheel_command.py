"""kurbel flywheel, and --where: crank angles at which a column of the whole machine has a value."""

import math
import re
from functools import cache
from typing import Any

import pytest
from click.testing import Result

from command import answer, printed, run
from kurbel.machine_file import loads
from kurbel.report.check import checked
from kurbel.solver.case import Case
from representative import CONFIGS

pytestmark = pytest.mark.usefixtures("solved_once")

ENGINE = CONFIGS["waterworks"].read_text(encoding="utf-8")
PUNCH = CONFIGS["punch"].read_text(encoding="utf-8")


@cache
def results(text: str, *arguments: str) -> dict[str, Any]:
    return answer("flywheel", "-", *arguments, text=text)


def values(text: str) -> dict[str, object]:
    return {one["id"]: one["value"] for one in results(text)["machine_key_values"]}


def test_the_whole_machine_stands_under_its_own_keys() -> None:
    """The contract, 3: machine_columns, machine_key_values."""
    found = results(ENGINE + "flywheel: {inertia: 50000 kg m2}\n", "--step", "90")
    columns = {column["id"]: column["values"] for column in found["machine_columns"]}
    assert list(columns) == ["phi", "T", "T_inertia", "M", "E", "omega", "alpha"]
    assert columns["phi"] == [0, 90, 180, 270, 360]
    assert columns["E"][0] == 0
    assert columns["E"][-1] == pytest.approx(0, abs=1e-9)
    assert columns["M"] == pytest.approx([0.4 * force for force in columns["T"]])
    ids = [one["id"] for one in found["machine_key_values"]]
    assert {"W", "M_mean", "dE", "delta", "J", "GD2", "omega_max", "omega_min"} <= set(ids)
    assert found["cylinders"][0]["key_values"][0]["id"] == "P_dead_centre"


def test_the_wanted_fluctuation_gives_the_flywheel() -> None:
    found = values(ENGINE + "flywheel: {fluctuation: 0.01}\n")
    assert found["J"] == pytest.approx(found["dE"] / (0.01 * (100 * math.pi / 60) ** 2), rel=1e-13)
    assert found["delta_book"] == pytest.approx(0.01, rel=1e-13)
    assert found["delta"] == pytest.approx(0.01, rel=0.01)
    both = values(ENGINE + "flywheel: {fluctuation: 0.01, inertia: 9000 kg m2}\n")
    assert (both["J"], both["J_needed"]) == (9000, found["J"])


def left_out(text: str) -> dict[str, str]:
    return {one["what"]: one["why"] for one in results(text)["machine_left_out"]}


def test_what_is_left_out_is_said() -> None:
    assert left_out(ENGINE)["speed line, δ"] == "no flywheel given"
    assert left_out(ENGINE)["weight"] == "no inclination given"
    slow = ENGINE.replace("speed: 50 rpm\n", "") + "flywheel: {fluctuation: 0.01}\n"
    assert left_out(slow)["J"] == left_out(slow)["speed line, δ"] == left_out(slow)["inertia"] == "no speed given"
    resting = ENGINE.replace("50 rpm", "0 rpm") + "flywheel: {inertia: 1 kg m2}\n"
    assert left_out(resting)["speed line, δ"] == "not defined at rest"
    assert left_out(PUNCH)["T, W"] == "no crank: the effort is given as a torque"
    assert "T" not in [column["id"] for column in results(PUNCH)["machine_columns"]]


def test_a_stall_is_exit_3_and_names_angle_and_flywheel() -> None:
    result = run("flywheel", "-", text=ENGINE + "flywheel: {inertia: 100 kg m2}\nload: {power_law: 2}\n")
    assert (result.exit_code, result.stdout) == (3, "")
    assert "stops near φ = " in result.stderr
    assert "GD2 = " in result.stderr


LIGHT = """\
speed: 3 1/s
crank: 1 m
rod: 1.4 m
bore: 1.2 m
flywheel: {inertia: 1 kg m2}
indicator:
  pressures: absolute
  head_end: {steam: {admission: 1.6 bar, exhaust: 0.26 bar, cut_off: 0.1, clearance: 0.26, compression: 0.25}}
  crank_end:
    steam:
      {admission: 0.5 bar, exhaust: 0.06 bar, cut_off: 0.63, clearance: 0.03, release: 0.95, compression: 0.08}
masses: {piston: 100 kg, connecting_rod: {mass: 65 kg, center_of_gravity: 0.2 m, inertia: 10 kg m2}}
"""


def advised(text: str, message: str) -> str:
    """The machine with the flywheel that the message advises."""
    return re.sub(
        r"flywheel: {.*}", f"flywheel: {{inertia: {message.partition('from J = ')[2].split()[0]} kg m2}}", text
    )


def test_a_speed_that_falls_to_zero_between_two_nodes_is_a_stall() -> None:
    """The kinetic energy vanishes between two dead centres; at 4 1/s it is 3e-4 of the nominal one there, and turns."""
    result = run("flywheel", "-", text=LIGHT)
    assert (result.exit_code, "stops near φ = " in result.stderr) == (3, True)
    for text in (LIGHT.replace("speed: 3", "speed: 4"), advised(LIGHT, result.stderr)):
        printed("flywheel", "-", text=text)


def warnings(text: str) -> str:
    return " ".join(results(text)["machine_warnings"])


def test_a_resonance_is_told() -> None:
    coupling = "{stiffness: 1e6 N m/rad, inertia: 3000 kg m2, damping: 100 N m s/rad}"
    text = f"{ENGINE}flywheel: {{inertia: 20 t m2}}\ncoupling: {coupling}\n"
    assert "harmonic 4 of the torque" in warnings(text)
    assert {"natural_order", "M_coupling_max", "M_coupling_min", "amplification"} <= values(text).keys()
    undamped = text.replace(", damping: 100 N m s/rad", "")
    order = values(undamped)["natural_order"]
    tuned = undamped.replace("1e6", f"{1e6 * (4 / order) ** 2!r}")
    assert run("flywheel", "-", text=tuned).exit_code == 3


def test_a_limit_on_the_flywheel_needed_is_kept_though_it_is_not_printed() -> None:
    text = ENGINE + "flywheel: {fluctuation: 0.01}\n"
    assert "J_needed" not in values(text)
    assert not checked(Case(loads(text + "limits: {J_needed: 1000 t m2}\n"))).broken
    (error,) = (one.error for one in checked(Case(loads(ENGINE + "limits: {delta: 0.1}\n"))).unjudged)
    assert "this machine has no delta: coefficient" in str(error)


@pytest.mark.parametrize(("load", "says"), [(150, "50 N m less resistance"), (50, "50 N m more resistance")])
def test_a_resistance_of_another_mean(load: int, says: str) -> None:
    effort = "effort: {unit: N m, points: [[0, 0], [180, 200], [360, 0]]}"
    load_ = f"load: {{unit: N m, points: [[0, {load}], [360, {load}]]}}"
    text = f"{{speed: 60 rpm, flywheel: {{inertia: 10 kg m2}}, {effort}, {load_}}}"
    assert says in run("flywheel", "-", "--key-values", text=text).stdout


def test_the_warning_of_a_missed_wish_names_the_flywheel_that_meets_it() -> None:
    text = ENGINE + "flywheel: {fluctuation: 0.1}\n"
    exact = values(text)["J_exact"]
    assert f"J = {exact:.6g} kg m^2 gives the wanted one" in warnings(text)
    assert values(text.replace("fluctuation: 0.1", f"inertia: {exact!r} kg m2"))["delta"] == pytest.approx(0.1)
    both = values(text.replace("fluctuation", "inertia: 9000 kg m2, fluctuation"))
    assert both["J_exact"] == pytest.approx(exact, rel=1e-12)


# `kurbel flywheel --where`: exact crank angles at which a column of the whole machine has a value

J = 5.0
HARMONIC = f"""
speed: 120 rpm
effort: {{unit: N m, mean: 100, harmonics: [[1, 0, 80]]}}
flywheel: {{inertia: {J} kg m2}}
"""
"""M = 100 + 80 sin φ, hence E = 80 (1 − cos φ) and α = 80 sin φ / J."""


def angles_of(condition: str) -> list[float]:
    found: list[float] = answer("flywheel", "--where", condition, "-", text=HARMONIC)["machine_columns"][0]["values"]
    return found


@pytest.mark.parametrize(
    ("condition", "degrees"),
    [
        ("M = 140 N m", [30, 150]),
        ("M = M_m", [0, 180]),
        ("E = 80 J", [90, 270]),
        ("E = 1/4 E_max", [60, 300]),
        (f"alpha = {40 / J} rad/s2", [30, 150]),
        ("α = α_max", [90]),
        ("omega = omega_min", [0]),
        ("ω = ω_max", [180]),
    ],
)
def test_against_the_formulas(condition: str, degrees: list[float]) -> None:
    assert [angle % 360 for angle in angles_of(condition)] == pytest.approx(degrees, abs=1e-6)


def test_a_speed_against_the_kinetic_energy() -> None:
    """½ J (ω² − ω_min²) = 80 (1 − cos φ)."""
    asked = answer("flywheel", "--where", "omega = omega_min", "-", text=HARMONIC)
    slowest = float(asked["machine_columns"][3]["values"][0])
    wanted = math.sqrt(slowest**2 + 2 * 80 * (1 - math.cos(math.radians(50))) / J)
    assert angles_of(f"omega = {wanted!r} rad/s") == pytest.approx([50, 310], rel=1e-11)


STAGES = """
speed: 600 rpm
cylinders:
  - {name: LP, stroke: 200 mm, rod: 450 mm, bore: 400 mm,
     indicator: {head_end: {constant: {expansion: 0 bar, compression: 3 bar}}}}
  - {name: HP, like: LP, indicator: {head_end: {constant: {expansion: 3 bar, compression: 9 bar}}}}
"""


def of_stages(*words: str) -> Result:
    return run("forces", "-", *words, text=STAGES)


def test_one_cylinder_may_have_what_another_has_not() -> None:
    both = of_stages("--where", "p_head = 5 bar", "--columns", "p_head")
    assert both.exit_code == 0
    assert "LP: p_head is nowhere 5 bar: it goes from 0 mbar to 3 bar." in both.stdout
    rows = of_stages("--where", "p_head = 5 bar", "--columns", "p_head", "-f", "csv").stdout.splitlines()
    assert {row.split(",")[0] for row in rows[1:]} == {"HP"}
    assert of_stages("--where", "p_head = 5 bar", "--columns", "p_head", "--cylinder", "2").exit_code == 0
    for cylinder, condition in (("LP", "p_head = 5 bar"), ("HP", "p_head = 1 bar")):
        alone = of_stages("--where", condition, "--columns", "p_head", "--cylinder", cylinder)
        assert (alone.exit_code, f"{cylinder}: p_head is nowhere" in alone.stderr) == (3, True)
    neither = of_stages("--where", "p_head = 50 bar")
    assert (neither.exit_code, "LP: p_head is nowhere 50 bar" in neither.stderr) == (3, True)
