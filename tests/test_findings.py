"""What kurbel has to say of a machine: notes on what looks wrong, what is left out, and how limits stand."""

from __future__ import annotations

import math

import pytest
from click.testing import CliRunner

from kurbel import loads, solve
from kurbel.cli import kurbel
from kurbel.declared.quantities import COMMON
from kurbel.declared.quantity import by_id
from kurbel.errors import UsageError
from kurbel.report.check import _compared, checked

ENDLESS = "{constant: {expansion: 1e300 at, compression: 1e300 at}}"
HUGE = f"crank: 1 m\nrod_ratio: 5\nbore: 1 m\nindicator: {{head_end: {ENDLESS}}}\n"
ENGINE = "speed: 60 rpm\ncrank: 400 mm\nrod: 2 m\nbore: 450 mm\n"
SHAFT = (
    "crankshaft: {a: 300 mm, b: 300 mm, web_distance: 150 mm, web_thickness: 100 mm, web_width: 200 mm,"
    " pin_diameter: 160 mm, pin_length: 180 mm}\n"
)
PRESSURE = "constant: {expansion: 5 bar, compression: 1 bar}"
GAUGE = "indicator: {head_end: {trace: {unit: bar, points: [[0, 1], [180, 5], [360, 1]]}}}\n"


def run(text: str, *arguments: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(kurbel, [*arguments, "-"], input=text)
    return result.exit_code, result.stdout, result.stderr


# limits


def test_what_overflows_is_neither_kept_nor_broken() -> None:
    status, listed, said = run(HUGE + "limits: {work: 1 J, stroke: 1 m}\n", "check")
    assert status == 2
    assert "too large" in said
    assert "kept" not in listed
    assert "nan" not in listed + said
    assert "inf " not in listed + said


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", ["mean_pressure", "T_min", "energy_residual"])
def test_what_is_not_finite_is_not_compared(name: str, value: float) -> None:
    found = _compared(by_id(COMMON.all_key_values)[name], 1.0, "cylinder 1", value)
    assert isinstance(found, UsageError)
    assert f"limits.{name} (cylinder 1): {name} is too large to compute with" in str(found)


# by the trapezoid rule the work of a sawtooth of four samples is far from that between them
COARSE = "indicator: {head_end: {trace: {unit: bar, points: [[0, 1], [90, 9], [180, 5], [270, 2], [360, 1]]}}}\n"


def test_a_residual_is_judged_by_its_magnitude() -> None:
    (forces,) = solve(loads(ENGINE + COARSE)).cylinders
    residual = forces.energy_residual
    assert residual is not None
    assert residual < -0.001  # or this tests nothing
    status, listed, _ = run(ENGINE + COARSE + "limits: {energy_residual: 0.001}\n", "check")
    assert status == 1
    assert f"|{residual:.9g}| > 0.001  BROKEN" in listed


def test_all_limits_are_told_in_one_run() -> None:
    status, listed, said = run(
        ENGINE + "limits: {c_max: 1 m/s, delta: 1/100, sigma_pin_max: 1 MPa, v: 9 m/s}\n", "check"
    )
    assert status == 2
    assert "BROKEN  (cylinder 1)" in listed
    assert "≤ 9 m/s  kept" in listed
    assert "limits.delta: " in said
    assert "limits.sigma_pin_max: " in said


def test_a_machine_that_stalls_does_not_hide_a_broken_limit() -> None:
    text = ENGINE + f"indicator: {{head_end: {{{PRESSURE}}}}}\nflywheel: {{inertia: 1e-3 kg m2}}\n"
    status, listed, said = run(text + "limits: {delta: 0.01, c_max: 1 m/s}\n", "check")
    assert (status, "BROKEN" in listed, said.startswith("Error: limits.delta: ")) == (3, True, True)
    assert run(text + "limits: {delta: 0.01, sigma_pin_max: 1 MPa}\n", "check")[0] == 2


# notes


@pytest.mark.parametrize("command", ["check", "forces", "flywheel", "stress"])
def test_notes_stand_in_every_command_once(command: str) -> None:
    """A gauge pressure that never falls below 1 bar looks absolute."""
    _, printed, _ = run(ENGINE + GAUGE + SHAFT, command)
    assert printed.count("about the ambient: absolute?") == 1


@pytest.mark.parametrize("command", ["check", "forces", "flywheel"])
def test_notes_name_their_cylinder(command: str) -> None:
    one = "{name: %s, crank: 400 mm, rod: 2 m, bore: 450 mm, %s}"
    both = ", ".join(one % (name, GAUGE.strip()) for name in ("left", "right"))
    _, printed, _ = run(f"speed: 60 rpm\ncylinders: [{both}]\nbrake_power: 1e6 kW\n", command)
    assert printed.count("about the ambient: absolute?") == 2
    assert printed.count("is below the brake power") == 1
    lines = [line.strip() for line in printed.splitlines()]
    notes = [line.removeprefix("note").strip() for line in lines if "about the ambient" in line]
    if command == "flywheel":
        assert [note.split(",")[0] for note in notes] == ["left", "right"]
    else:  # below the head of the cylinder
        assert notes[0] == notes[1]


def test_a_card_that_was_tidied_up_is_told_by_every_command() -> None:
    card = "indicator: {head_end: {unit: bar, expansion: [[0, 5], [1, 2], [1, 2]], compression: [[1, 1], [0, 4]]}}\n"
    (note,) = loads(ENGINE + card).cylinders[0].pistons[0].indicator.head_end.notes[:1]  # type: ignore[union-attr]
    for command in ("check", "forces", "flywheel", "stress"):
        assert run(ENGINE + card + SHAFT, command)[1].count(note) == 1


# left out


@pytest.mark.parametrize("command", ["check", "forces", "flywheel", "stress"])
def test_a_rod_whose_area_is_not_taken_off_is_told(command: str) -> None:
    text = ENGINE + f"indicator: {{head_end: {{{PRESSURE}}}, crank_end: {{{PRESSURE}}}}}\n" + SHAFT
    told = "no crank_end_rod given, its area is taken as 0"
    assert told in run(text, command)[1]
    assert told not in run(text + "crank_end_rod: 60 mm\n", command)[1]
    single = ENGINE + f"indicator: {{head_end: {{{PRESSURE}}}}}\n" + SHAFT
    assert told not in run(single, command)[1]
    assert len(checked(loads(text)).errors) == 0
