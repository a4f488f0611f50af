"""kurbel flywheel, and --where: crank angles at which a column of the whole machine has a value."""

import math
import re
from functools import cache
from typing import Any

import pytest

from command import answer, printed, run
from representative import CONFIGS

ENGINE = CONFIGS["waterworks"].read_text(encoding="utf-8")
PUNCH = CONFIGS["punch"].read_text(encoding="utf-8")


@cache
def results(text: str, *arguments: str) -> dict[str, Any]:
    return answer("flywheel", "-", *arguments, text=text)


def values(text: str) -> dict[str, object]:
    return {
        key_value["id"]: key_value["value"] for key_value in results(text)["machine_key_values"]
    }


def test_the_whole_machine_is_under_its_own_keys() -> None:
    """The contract, 3: machine_columns, machine_key_values."""
    result = results(ENGINE + "flywheel: {inertia: 50000 kg m2}\n", "--step", "90")
    columns = {column["id"]: column["values"] for column in result["machine_columns"]}
    assert list(columns) == ["phi", "T", "T_inertia", "M", "E", "omega", "alpha"]
    assert columns["phi"] == [0, 90, 180, 270, 360]
    assert columns["E"][0] == 0
    assert columns["E"][-1] == pytest.approx(0, abs=1e-9)
    assert columns["M"] == pytest.approx([0.4 * force for force in columns["T"]])
    ids = [key_value["id"] for key_value in result["machine_key_values"]]
    assert {"W", "M_mean", "dE", "delta", "J", "GD2", "omega_max", "omega_min"} <= set(ids)
    assert result["cylinders"][0]["key_values"][0]["id"] == "P_dead_centre"


def test_the_wanted_fluctuation_gives_the_flywheel() -> None:
    result = values(ENGINE + "flywheel: {fluctuation: 0.01}\n")
    assert result["J"] == pytest.approx(
        result["dE"] / (0.01 * (100 * math.pi / 60) ** 2), rel=1e-13
    )
    assert result["delta_book"] == pytest.approx(0.01, rel=1e-13)
    assert result["delta"] == pytest.approx(0.01, rel=0.01)
    both = values(ENGINE + "flywheel: {fluctuation: 0.01, inertia: 9000 kg m2}\n")
    assert (both["J"], both["J_needed"]) == (9000, result["J"])


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
        r"flywheel: {.*}",
        f"flywheel: {{inertia: {message.partition('from J = ')[2].split()[0]} kg m2}}",
        text,
    )


def test_a_speed_that_falls_to_zero_between_two_nodes_is_a_stall() -> None:
    """The kinetic energy vanishes between two dead centres; at 4 1/s it is 3e-4 of the nominal one there, and turns."""
    result = run("flywheel", "-", text=LIGHT)
    assert (result.exit_code, "stops near φ = " in result.stderr) == (3, True)
    for text in (LIGHT.replace("speed: 3", "speed: 4"), advised(LIGHT, result.stderr)):
        printed("flywheel", "-", text=text)


def warnings(text: str) -> str:
    return " ".join(results(text)["machine_warnings"])


def test_a_resonance_is_reported() -> None:
    coupling = "{stiffness: 1e6 N m/rad, inertia: 3000 kg m2, damping: 100 N m s/rad}"
    text = f"{ENGINE}flywheel: {{inertia: 20 t m2}}\ncoupling: {coupling}\n"
    assert "harmonic 4 of the torque" in warnings(text)
    assert {"natural_order", "M_coupling_max", "M_coupling_min", "amplification"} <= values(
        text
    ).keys()
    undamped = text.replace(", damping: 100 N m s/rad", "")
    order = values(undamped)["natural_order"]
    tuned = undamped.replace("1e6", f"{1e6 * (4 / order) ** 2!r}")
    assert run("flywheel", "-", text=tuned).exit_code == 3


def test_the_warning_of_a_missed_wish_names_the_flywheel_that_meets_it() -> None:
    text = ENGINE + "flywheel: {fluctuation: 0.1}\n"
    exact = values(text)["J_exact"]
    assert f"J = {exact:.6g} kg m^2 gives the wanted one" in warnings(text)
    assert values(text.replace("fluctuation: 0.1", f"inertia: {exact!r} kg m2"))[
        "delta"
    ] == pytest.approx(0.1)
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
    result: list[float] = answer("flywheel", "--where", condition, "-", text=HARMONIC)[
        "machine_columns"
    ][0]["values"]
    return result


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
    words = answer("flywheel", "--where", "omega = omega_min", "-", text=HARMONIC)
    slowest = float(words["machine_columns"][3]["values"][0])
    wanted = math.sqrt(slowest**2 + 2 * 80 * (1 - math.cos(math.radians(50))) / J)
    assert angles_of(f"omega = {wanted!r} rad/s") == pytest.approx([50, 310], rel=1e-11)
