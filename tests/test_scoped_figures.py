"""Whose key value a limit or an expectation is put on: `machine.T_max`, `HP.T_max`, and `T_max` alone."""

from __future__ import annotations

import json
import math

import pytest
from click.testing import CliRunner

import kurbel
from kurbel.cli import kurbel as command
from kurbel.errors import KurbelError

CARD = "{constant: {expansion: 2 bar, compression: 0 bar}}"
TWO = f"""\
speed: 60 rpm
cylinders:
- {{name: HP, stroke: 1 m, rod_ratio: infinite, bore: 400 mm, indicator: {{head_end: {CARD}, crank_end: {CARD}}}}}
- {{like: HP, name: LP, bore: 500 mm, crank_position: 0 deg}}
"""
"""With an infinite rod T = 2 bar · A |sin φ| of each cylinder, and the sum of both of the machine."""
HP, LP = (2e5 * math.pi / 4 * bore**2 for bore in (0.4, 0.5))


def newton(force: float) -> str:
    return f"{force!r} N"


def run(figures: str, *arguments: str) -> tuple[int, str]:
    result = CliRunner().invoke(command, [*arguments, "-"], input=TWO + figures)
    return result.exit_code, result.output


@pytest.mark.parametrize(
    ("name", "largest"), [("T_max", LP), ("HP.T_max", HP), ("LP.T_max", LP), ("machine.T_max", HP + LP)]
)
def test_a_limit_is_held_against_those_it_names(name: str, largest: float) -> None:
    """Of each cylinder, and not of the machine, where nobody is named."""
    assert run(f"limits: {{{name}: {newton(1.001 * largest)}}}", "check")[0] == 0
    status, told = run(f"limits: {{{name}: {newton(0.999 * largest)}}}", "check")
    assert status == 1
    assert told.count("BROKEN") == 1


def test_expectations_have_scopes_too() -> None:
    figures = {"machine.T_max": HP + LP, "HP.T_max": HP, "LP.T_max": LP}
    lines = [f"  {name}: {newton(size)} ± 0.1 %" for name, size in figures.items()]
    status, told = run("\n".join(["expect:", *lines]), "check")
    assert (status, told.count(" met ")) == (0, 3)
    assert run(f"expect: {{T_max: {newton(LP)} ± 0.1 %}}", "check")[0] == 1  # the HP cylinder has less


def test_findings_stand_at_the_name_as_it_is_written() -> None:
    result = run(f"limits: {{machine.T_max: {newton(1)}}}", "check", "-f", "json")[1]
    found = [one for one in json.loads(result)["findings"] if one["key"] == "limits.machine.T_max"]
    assert [(one["line"], one["column"], one["severity"]) for one in found] == [(5, 10, "error")]


@pytest.mark.parametrize(
    ("figures", "message"),
    [
        ("limits: {MP.T_max: 1 N}", "5:10: limits.MP.T_max: no cylinder is called 'MP'; there are machine, HP, LP"),
        ("expect: {machin.T_max: 1 N ± 1 %}", "no cylinder is called 'machin'; did you mean 'machine'?"),
        ("limits: {HP.T_mx: 1 N}", "unknown key value 'HP.T_mx'"),
        ("limits: {HP.phi_reversal: 1 deg}", "is a list of values"),
        ("limits: {HP.A_head: 1 m2, HP.A_H: 1 m2}", "'HP.A_H' is the symbol of HP.A_head, which is given already"),
        ("limits: {HP.delta: 1/50}", "limits.HP.delta: HP has no delta"),
        ("limits: {machine.c_max: 1 m/s}", "limits.machine.c_max: the whole machine has no c_max"),
    ],
)
def test_what_nobody_has_is_refused(figures: str, message: str) -> None:
    status, told = run(figures, "check")
    assert (status, message in told) == (2, True), told


def test_no_cylinder_is_called_machine() -> None:
    with pytest.raises(KurbelError, match=r"cylinders\[0\]\.name: 'machine' stands for the whole machine"):
        kurbel.loads(TWO.replace("HP", "machine"))
    assert kurbel.loads("{name: machine, crank: 1 m, rod: 4 m}").name == "machine"


def test_a_sweep_keeps_limits_of_those_they_name() -> None:
    bounds = f"limits: {{LP.T_max: {newton(1.001 * LP)}, machine.T_max: {newton(1.001 * (HP + LP))}}}"
    asked = ("sweep", "--vary", "cylinders.1.bore=400,500,600 mm", "--vary", "speed=50,60 rpm", "--columns", "LP.T_max")
    status, told = run(bounds, *asked, "-f", "json")
    found = [json.loads(line) for line in told.splitlines()]
    assert (status, [one["broken"] for one in found]) == (0, [None, None, None, None, "LP.T_max", "LP.T_max"])
    told = run(bounds, *asked, "-f", "json", "--set", "limits={}", "--set", "limits.machine.T_max=56 kN")[1]
    assert [json.loads(line)["broken"] for line in told.splitlines()] == [None] * 2 + ["machine.T_max"] * 4
