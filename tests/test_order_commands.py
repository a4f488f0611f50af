"""`kurbel harmonics` and `kurbel torsion` as their users call them: formats, options, and what they refuse."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from kurbel.cli import kurbel
from kurbel.machine.shaft_line import ShaftPart, line_of
from representative import few

pytestmark = pytest.mark.usefixtures("solved_once")
CONFIGS = Path(__file__).parent.parent / "configs"
BLOWER, SHIP = (str(CONFIGS / f"{name}.yaml") for name in ("coupled-blower", "marine-diesel"))
TWO = "shaft: [{inertia: 2 kg m2}, {stiffness: 50 N m/rad}, {inertia: 2 kg m2}]\n"


def run(*arguments: str, text: str | None = None) -> Result:
    return CliRunner().invoke(kurbel, list(arguments), input=text)


def parsed(*arguments: str, text: str | None = None) -> dict[str, Any]:
    result = run(*arguments, "-f", "json", text=text)
    assert result.exit_code == 0, result.output
    found: dict[str, Any] = json.loads(result.stdout)
    return found


def table(found: dict[str, Any], id: str) -> dict[str, list[Any]]:
    one = next(one for one in found["machine_place_tables"] if one["id"] == id)
    return {column["id"]: column["values"] for column in one["columns"]}


def test_the_columns_that_scripts_rely_on() -> None:
    orders = table(parsed("harmonics", BLOWER), "orders")
    assert list(orders) == ["order", "M_cos", "M_sin", "M_amplitude", "M_phase", "M_gas", "M_inertia"]
    assert orders["order"] == list(range(1, 25))
    found = parsed("torsion", SHIP)
    assert [one["id"] for one in found["machine_place_tables"]] == ["modes", "holzer", "critical_speeds", "pieces"]
    modes, critical = table(found, "modes"), table(found, "critical_speeds")
    assert list(modes)[:2] == ["mode", "frequency"]
    assert list(critical)[:3] == ["order", "mode", "speed"]
    assert (modes["mode"][:2], modes["frequency"][0]) == ([0, 1], 0)
    assert critical["order"] == list(range(1, 13)) * 3
    for order, mode, speed in zip(critical["order"], critical["mode"], critical["speed"]):
        assert speed == pytest.approx(modes["frequency"][int(mode)] / order, rel=1e-15)
    assert all(isinstance(one["unit"], str) for one in found["machine_place_tables"][0]["columns"])


UNIFORM = "speed: 60 rpm\neffort: {unit: N m, points: [[0, 5], [360, 5]]}\n"


def test_a_cylinder_without_orders_is_said_to_have_none() -> None:
    """Coupled wheels turn evenly: a table of zeros stood for their one cylinder."""
    told = run("harmonics", "configs/coupled-axle.yaml").stdout
    assert "The torque of cylinder 1 has none of these orders: they are all zero." in told
    assert "Orders of the torque" not in told


@pytest.mark.parametrize("options", [(), ("--speeds", "30, 90 rpm")])
def test_an_effort_without_orders_is_said_to_have_none(options: tuple[str, ...]) -> None:
    """Two dozen rows of zeros were printed; scripts still have them."""
    for look in ("table", "markdown", "html", "latex"):
        told = " ".join(run("harmonics", "-", "-f", look, *options, text=UNIFORM).stdout.split())
        assert "The turning effort has none of these orders: they are all zero." in told
        assert "Orders of the turning effort" not in told
    found = table(parsed("harmonics", "-", *options, text=UNIFORM), "orders")
    assert (found["order"], found["M_amplitude"]) == (list(range(1, 25)), [0] * 24)
    assert len(run("harmonics", "-", "-f", "csv", *options, text=UNIFORM).stdout.splitlines()) > 24


def test_half_orders_of_four_strokes() -> None:
    found = parsed("harmonics", str(CONFIGS / "four-cylinder-generator.yaml"))
    assert table(found, "orders")["order"] == [half / 2 for half in range(1, 49)]
    marks = found["machine_place_tables"][0]["rows"]
    assert [index / 2 + 0.5 for index, mark in enumerate(marks) if mark["kind"] == "major"] == list(range(2, 25, 2))
    assert len(found["cylinders"]) == 4


def test_orders_over_the_speed() -> None:
    found = table(parsed("harmonics", BLOWER, "--speeds", "75, 150 rpm", "--orders", "1,3"), "orders_by_speed")
    assert (found["speed"], found["order"]) == ([1.25, 1.25, 2.5, 2.5], [1, 3, 1, 3])
    slow = table(parsed("harmonics", BLOWER, "--set", "speed=75 rpm", "--orders", "1,3"), "orders")
    assert found["M_cos"][:2] == pytest.approx(slow["M_cos"], rel=1e-12)


def test_every_piece_over_the_angle() -> None:
    found = parsed("torsion", SHIP, "--columns", "M_shaft,tau", "--step", "1")
    pieces = found["cylinders"]
    assert len(pieces) == 7
    shown = table(found, "pieces")
    for number, piece in enumerate(pieces):
        columns = {column["id"]: column["values"] for column in piece["columns"]}
        assert max(columns["M_shaft"]) == pytest.approx(shown["M_shaft_max"][number], rel=1e-2)
        assert max(columns["M_shaft"]) <= shown["M_shaft_max"][number]
        stressed = [one / two for one, two in zip(columns["M_shaft"], columns["tau"])]
        assert min(stressed) == pytest.approx(max(stressed), rel=1e-12)


def test_over_the_speed_the_critical_one_is_the_worst() -> None:
    found = parsed("torsion", BLOWER, "--speeds", "60:90:1 rpm", "--orders", "3")
    speeds, critical = table(found, "speeds"), table(found, "critical_speeds")
    worst = max(range(31), key=speeds["M_vibratory"].__getitem__)
    assert speeds["speed"][worst] == pytest.approx(critical["speed"][0], abs=1.5 / 60)
    assert len(speeds["speed"]) == 31


def test_what_lies_beside_the_working_speed_is_told() -> None:
    result = run("torsion", SHIP)
    assert "mode 1: critical speed of order 3 (-1.78 %) within 10 % of the working speed 110 rpm" in result.stdout
    assert any(line.split()[:4] == ["near", "3", "1", "108"] for line in result.stdout.splitlines())


@pytest.mark.parametrize(
    ("asked", "orders"),
    [("0.5:48:0.5", [i / 2 for i in range(1, 97)]), ("12", [12]), ("0.5,1,6", [0.5, 1, 6]), ("1:6:2", [1, 3, 5])],
)
def test_orders_by_steps(asked: str, orders: list[float]) -> None:
    generator = str(CONFIGS / "four-cylinder-generator.yaml")
    assert table(parsed("harmonics", generator, "--orders", asked), "orders")["order"] == orders


def test_a_critical_speed_without_a_torque_is_said_to_be_beyond_the_machine() -> None:
    result = parsed("torsion", SHIP)
    critical, notes = table(result, "critical_speeds"), " ".join(result["notes"])
    beyond = [speed > 1.2 * 110 / 60 for speed in critical["speed"]]
    assert [torque is None for torque in critical["M_vibratory"]] == beyond
    assert "– marks a speed that the machine does not reach, beyond 1.2 times the working speed" in notes
    within = parsed("torsion", SHIP, "--orders", "6", "--modes", "1")
    assert "– stands" not in " ".join(within["notes"])


def test_what_hardly_excites_a_mode_is_no_danger() -> None:
    """Of six equal cranks 60° apart on stiff pieces the vectors of all orders but the sixth nearly cancel."""
    text = """
speed: {speed} rpm
cylinders:
  count: 6
  firing_order: 1-5-3-6-2-4
  each: {crank: 100 mm, rod: 400 mm, bore: 200 mm, masses: {piston: 9 kg}, indicator: {head_end: {trace: CARD}}}
""".replace("CARD", "{unit: bar, points: [[0, 9], [90, 3], [180, 0], [270, 1], [360, 9]]}")
    text += "shaft:\n" + "  - {stiffness: 1000 MN m/rad}\n".join(
        f"  - {{cylinder: cylinder {number}, inertia: 1 kg m2}}\n" for number in range(1, 7)
    )
    text += "  - {stiffness: 1 MN m/rad}\n  - {name: load, inertia: 9 kg m2, load: true}\n"
    (speed,) = table(
        parsed("torsion", "-", "--orders", "6", "--modes", "1", text=text.replace("{speed}", "60")), "critical_speeds"
    )["speed"]
    near = {}
    for order in (5, 6):
        found = parsed("torsion", "-", text=text.replace("{speed}", str(speed * 60 * 6 / order)))
        rows = next(one["rows"] for one in found["machine_place_tables"] if one["id"] == "critical_speeds")
        near[order] = [row["note"] for row in rows[:12]]
        warned = [one for one in found["machine_warnings"] if "mode 1" in one]
        assert len(warned) == (order == 6)
    assert near[5] == [""] * 12
    assert near[6] == [*[""] * 5, "near", *[""] * 6]


def test_without_damping_it_says_so() -> None:
    result = run("torsion", BLOWER, "--set", "coupling.damping=0 N m s/rad")
    assert "no damping given; at resonance nothing but damping bounds a vibration" in " ".join(result.stdout.split())
    assert "M_w,a" not in result.stdout


def test_a_shaft_line_alone() -> None:
    checked = run("check", "-", text=TWO)
    assert "none, a shaft line alone" in checked.stdout
    assert "natural frequencies, critical speeds" in checked.stdout
    assert "turning effort" not in checked.stdout
    assert table(parsed("torsion", "-", text=TWO), "modes")["frequency"][1] == pytest.approx(1.1253953951963827)
    for command in ("motion", "forces", "flywheel", "stress", "harmonics"):
        assert run(command, "-", text=TWO).exit_code == 2


REFUSED = [
    (
        "harmonics",
        BLOWER,
        ("--orders", "0.5"),
        "--orders 0.5: the cycle repeats after 360 degrees and has the orders",
    ),
    ("torsion", BLOWER, ("--orders", "0"), "--orders 0: an order is more than 0 and at most 1000"),
    ("torsion", BLOWER, ("--orders", "1,x"), "expected a number, got 'x'"),
    ("torsion", BLOWER, ("--mode", "2"), "--mode 2: the shaft line has the modes 1 to 1"),
    ("torsion", BLOWER, ("--speeds", "100"), "100 has no unit; write it with one, such as '100 rpm'"),
    ("torsion", BLOWER, ("--speeds", "x rpm"), "expected a number with its unit"),
    ("torsion", BLOWER, ("--speeds", "0 rpm"), "a speed is more than 0"),
    ("torsion", BLOWER, ("--speeds", "200:100:5 rpm"), "write from, to and step as '300:1500:10 rpm'"),
    ("torsion", BLOWER, ("--speeds", "1:2:1e-9 rpm"), "more than 10000 steps; take larger ones"),
    ("torsion", BLOWER, ("--orders", "1:12"), "'1:12': write from, to and step as '0.5:12:0.5'"),
    ("torsion", BLOWER, ("--orders", "1:12:-1"), "'1:12:-1': write from, to and step as '0.5:12:0.5'"),
    ("motion", BLOWER, ("--angles", "0:360:1e-9"), "more than 10000 steps; take larger ones"),
    ("torsion", BLOWER, ("--speeds", "1e200 rpm"), "is too large to compute with"),
    ("torsion", BLOWER, ("--columns", "tau"), "'tau' is left out for this machine"),
    ("torsion", str(CONFIGS / "waterworks.yaml"), (), "no 'shaft' is given; write its masses"),
    ("harmonics", BLOWER, ("--set", "speed=0 rpm", "--speeds", "5 rpm"), "--speeds: the inertia forces are scaled"),
]


@pytest.mark.parametrize(("command", "file", "options", "message"), REFUSED)
def test_what_is_refused(command: str, file: str, options: tuple[str, ...], message: str) -> None:
    result = run(command, file, *options)
    assert message in " ".join(result.stderr.split())
    assert (result.exit_code, result.stdout) == (2, "")


def test_a_cylinder_without_any_inertia_is_refused() -> None:
    text = "crank: 100 mm\nrod: 400 mm\n" + TWO.replace("inertia: 2 kg m2", "cylinder: cylinder 1", 1)
    result = run("torsion", "-", text=text)
    assert result.exit_code == 2
    assert "cylinder 1 has no inertia in the shaft line; give its item 'inertia', or it 'masses'" in result.stderr
    assert "torsional vibration: cylinder 1 has no inertia" in run("check", "-", text=text).stdout


def test_an_undamped_resonance_beside_a_damper_elsewhere_has_no_solution() -> None:
    """The damper stands in the node of the mode: three equal masses, of which the middle one is at rest."""
    text = (
        "speed: 5 rad/s\neffort: {unit: N m, mean: 5, harmonics: [[1, 3, 0]]}\n"
        "shaft: [{inertia: 2 kg m2}, {stiffness: 50 N m/rad}, {inertia: 2 kg m2, damping: 1 N m s/rad},\n"
        " {stiffness: 50 N m/rad}, {inertia: 2 kg m2}]\n"
    )
    result = run("torsion", "-", text=text)
    assert (result.exit_code, result.stdout) == (3, "")
    assert "an order of the torque meets a natural vibration that is hardly damped: give 'damping'" in result.stderr
    beside = parsed("torsion", "-", "--set", "speed=5.5 rad/s", text=text)
    torques = table(beside, "critical_speeds")["M_vibratory"]
    assert torques[0] is None  # order 1 with mode 1
    assert torques[13] is not None  # order 2 with mode 2, which the damper reaches


def test_what_only_rounding_bounds_has_a_dash() -> None:
    """A loss factor of 1e-12: the torque of a critical speed was told to four digits, of which rounding made some."""
    text = (
        "speed: 600 rpm\neffort: {unit: N m, mean: 5, harmonics: [[1, 3, 0], [2, 1, 1], [3, 2, 0]]}\n"
        "shaft: [{inertia: 2 kg m2}, {stiffness: 4000 N m/rad}, {inertia: 2 kg m2},\n"
        " {stiffness: 6000 N m/rad, loss_factor: LOSS}, {inertia: 3 kg m2}]\n"
    )
    torques = [
        table(parsed("torsion", "-", text=text.replace("LOSS", loss)), "critical_speeds").get("M_vibratory")
        for loss in ("1e-6", "1e-12")
    ]
    assert None not in torques[0][:3]
    assert torques[1] is None or torques[1][:3] == [None] * 3
    told = " ".join(run("torsion", "-", text=text.replace("LOSS", "1e-12")).stdout.split())
    assert "and a mode that is hardly damped" in told


STALLS = """
speed: 158.121 rpm
crank: 0.289454 m
rod: 0.356377 m
bore: 0.238002 m
indicator:
  pressures: absolute
  head_end: {constant: {expansion: 38.0077 bar, compression: 0.818689 bar}}
flywheel: {inertia: 3.51196 kg m2}
load: {power_law: 2.55509}
coupling: {stiffness: 13784 N m/rad, damping: 5.84372 N m s/rad, inertia: 66.24 kg m2}
"""


ENDLESS = [("flywheel", 3), ("harmonics", 0), ("torsion", 0)]


@pytest.mark.parametrize(("command", "status"), few(ENDLESS, []))
def test_a_coupling_whose_motion_finds_no_end_is_no_fault_of_kurbel(command: str, status: int) -> None:
    answer = CliRunner().invoke(kurbel, [command, "-"], input=STALLS)
    assert answer.exit_code == status
    told = " ".join((answer.stderr if status else answer.stdout).split())
    assert "the machine stops near φ = 346°" in told
    assert "and the elastic coupling" in told


NEIGHBOURS = """
speed: 100 rpm
effort: {unit: N m, mean: 9, harmonics: [[1, 1, 0], [10, 1, 0], [11, 1, 0]]}
shaft:
  - {inertia: 1 kg m2}
  - {stiffness: 5500 N m/rad}
  - {inertia: 1 kg m2}
"""


def test_near_stands_in_every_row_that_is() -> None:
    """ω_e = √(2 k/J) is order 10.02: both 10 and 11 are within a tenth."""
    answer = CliRunner().invoke(kurbel, ["torsion", "-", "--orders", "10,11"], input=NEIGHBOURS)
    assert answer.exit_code == 0
    assert [line.split()[:2] for line in answer.stdout.splitlines() if line.startswith("near")] == [
        ["near", "10"],
        ["near", "11"],
    ]
    assert "orders 10" in answer.stdout
    silent = NEIGHBOURS.replace(", [11, 1, 0]", "")
    answer = CliRunner().invoke(kurbel, ["torsion", "-", "--orders", "10,11"], input=silent)
    assert [line.split()[:2] for line in answer.stdout.splitlines() if line.startswith("near")] == [["near", "10"]]


def test_the_load_stands_at_an_end_that_is_no_crank() -> None:
    """A motor drives pistons: it is named first, so that the last mass is a crank and no load."""
    parts = [ShaftPart(inertia=2.0), ShaftPart(stiffness=1e3), ShaftPart(cylinder=("one",))]
    assert line_of(parts, ["one"]).load == 0
    assert line_of(parts[::-1], ["one"]).load == 1
