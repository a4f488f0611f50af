"""Engines as they are built: the figures of ten machines, by calculations that are independent of kurbel."""

import inspect
import math
import textwrap
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from command import answer, run
from kurbel.errors import KurbelError, MachineFileError
from kurbel.machine import Machine
from kurbel.machine.cylinder import crank_lag, pin_lag
from kurbel.machine.firing import firings
from kurbel.machine.several import intervals, on_throws
from kurbel.machine_file import loads
from kurbel.mechanisms.link_rod import LinkedPiston
from kurbel.mechanisms.oscillating_cylinder import OscillatingCylinder
from kurbel.solver.case import Case
from kurbel.solver.chapters.bearings import MasterPin
from kurbel.solver.chapters.unbalanced import _of_knuckles
from kurbel.solver.effort import torque_of_inertia
from kurbel.solver.state import State, reduced_inertia

LATER: tuple[str, ...] = ()
"""Machines with keys that kurbel does not have yet."""
MACHINES: dict[str, dict[str, Any]] = {}
for document in yaml.safe_load_all(
    Path(__file__).with_name("engine_layouts.yaml").read_text(encoding="utf-8")
):
    if document["id"] not in LATER:
        MACHINES[document["id"]] = document
FIGURES = [(id, figure) for id, document in MACHINES.items() for figure in document["figures"]]


def named(figure: tuple[str, dict[str, Any]]) -> str:
    """Return what identifies a figure in the output of pytest."""
    id, what = figure
    words = [str(value) for key, value in what.items() if key not in ("value", "at", "intervals")]
    return "-".join((id, *words)).replace(" ", "_")


def pins_behind(machine: Machine) -> list[float]:
    """Return by how much the pins lag that of cylinder 1, from 0° to 360°."""
    first = machine.cylinders[0]
    return [pin_lag(cylinder, first) % 360.0 for cylinder in machine.cylinders]


def rows_of(printed: dict[str, Any], figure: dict[str, Any]) -> dict[str, Any]:
    """Return the part of a JSON answer that a figure is about."""
    name = figure.get("cylinder") or figure.get("bearing")
    parts = [*printed.get("cylinders", ()), *printed.get("bearings", ())]
    for part in parts:
        if name is not None and part["name"] == name:
            return part
    if name == "cylinder 1" or (name is None and len(parts) == 1):
        return parts[0]
    assert name is None, f"no part is called {name}"
    return {
        "columns": printed.get("machine_columns"),
        "key_values": printed.get("machine_key_values"),
    }


def column(columns: list[dict[str, Any]], id: str) -> list[Any]:
    """Return the values of a column."""
    return next(column["values"] for column in columns if column["id"] == id)


def swept_volumes(path: Path, degrees: list[float]) -> list[float]:
    """Return the sum of A x of two pistons of 105 mm at angles of crank 1, from the columns that kurbel prints."""
    printed = answer("motion", path, "--shaft-angle", "--angles", ",".join(map(str, degrees)))
    area = math.pi / 4 * 0.105**2
    travels = [column(part["columns"], "x") for part in printed["cylinders"]]
    return [area * sum(of_pistons) for of_pistons in zip(*travels)]


def is_figure(text: str, figure: dict[str, Any], path: Path) -> None:
    """Assert that kurbel gives this figure of a machine file."""
    path.write_text(text, encoding="utf-8")
    if figure["ask"] == "check":
        machine = loads(text)
        if figure["what"] == "firing":
            result = firings(machine)
            angles = [angle for angle, _ in result]
            assert "-".join(str(number) for _, number in result) == figure["order"]
            assert angles == pytest.approx(figure["at"], rel=1e-9)
            assert intervals(angles, 720.0) == pytest.approx(figure["intervals"], rel=1e-9)
        else:
            assert pins_behind(machine) == pytest.approx(figure["value"], rel=1e-9, abs=1e-9)
        return
    words = figure["ask"].split()
    if words[0] == "sum":
        degrees = [step / 2 for step in range(720)]
        volumes = swept_volumes(path, degrees)
        value = {"largest": max, "smallest": min}[figure["what"]](volumes)
        assert value == pytest.approx(figure["value"], rel=1e-9)
        assert degrees[volumes.index(value)] == pytest.approx(figure["at_deg"], abs=1e-3)
        return
    if "order" in figure:
        printed = answer(*words, path, "--orders")
        (table,) = (table for table in printed["machine_place_tables"] if table["id"] == "orders")
        row = column(table["columns"], "order").index(figure["order"])
        value = column(table["columns"], figure["component"])[row]
        assert value == pytest.approx(figure["value"], rel=1e-7, abs=1e-9)
    elif "column" in figure:
        printed = answer(*words, path, "--angles", figure["at_deg"])
        (value,) = column(rows_of(printed, figure)["columns"], figure["column"])
        assert value == pytest.approx(figure["value"], rel=1e-9)
    else:
        rows = rows_of(answer(*words, path), figure)["key_values"]
        (row,) = (row for row in rows if row["id"] == figure["key_value"])
        assert row["value"] == pytest.approx(figure["value"], rel=1e-9)
        if "at_deg" in figure:
            assert row["at_deg"] == pytest.approx(figure["at_deg"], abs=1e-3)


@pytest.mark.parametrize("of_machine", FIGURES, ids=named)
def test_figure_of_an_engine(of_machine: tuple[str, dict[str, Any]], tmp_path: Path) -> None:
    id, figure = of_machine
    is_figure(MACHINES[id]["machine"], figure, tmp_path / f"{id}.yaml")


EACH = "each: {stroke: 90 mm, rod: 150 mm, masses: {piston: 0.5 kg}}"
ENGINES: dict[str, tuple[str, str, str, list[float]]] = {
    # engine-sim, 05_odd_fire_v6.mr: ignition at 0, 150, 240, 390, 480, 630
    "odd-fire V6": ("0 -90", "0 120 240", "1-6-5-4-3-2", [150, 90] * 3),
    # manual of 1997: pins offset by 30 deg
    "V6, even fire": ("0 -90", "0 -30 120 90 240 210", "1-6-5-4-3-2", [120] * 6),
    # britishv8, "semi-even"
    "V6, semi-even fire": ("0 -90", "0 -18 120 102 240 222", "1-6-5-4-3-2", [132, 108] * 3),
    # manual p. 21: "staggering the journals 30 deg"
    "V6 Diesel": ("0 90", "0 30 120 150 240 270", "1-2-5-6-3-4", [120] * 6),
    # Chevrolet small block
    "V8": ("0 -90", "0 270 90 180", "1-8-4-3-6-5-7-2", [90] * 8),
    "W9": ("0 80 160", "0 120 240", "", [80] * 9),
    "V12": ("0 60", "0 120 240 240 120 0", "", [60] * 12),
    "V10": ("0 72", "0 144 288 216 72", "", [72] * 10),
    # Suzuki VX 800: 45 deg between the lines, pins 75 deg apart
    "V2": ("0 45", "0 75", "", [480, 240]),
    # speeduino issue 1163
    "V4": ("0 70", "0 180", "", [180, 250, 180, 110]),
    "five in line": ("0", "0 144 216 288 72", "", [144] * 5),
    "flat six": ("0 180", "0 180 120 300 240 60", "", [120] * 6),
}
"""Engine: bank angles, throws along the shaft or split pins, firing order if it is given, and intervals."""
COUNTS = {"V2": 2, "V4": 4, "five in line": 5, "V8": 8, "W9": 9, "V10": 10, "V12": 12}


def degrees(numbers: str) -> str:
    return "[" + ", ".join(f"{number} deg" for number in numbers.split()) + "]"


@pytest.mark.parametrize("name", ENGINES)
def test_an_engine_by_its_throws(name: str) -> None:
    """Firing order and intervals are those published; the same engine by crank positions has the same forces."""
    banks, throws, order, expected = ENGINES[name]
    count = COUNTS.get(name, 6)
    fires = f"firing_order: {order}, " if order else ""
    head = f"speed: 3000 rpm\ncycle: four-stroke\ncylinders: {{count: {count}, {EACH}, "
    common = f"{head}bank_angles: {degrees(banks)}, spacing: 100 mm, "
    machine = loads(f"{common}{fires}throw_angles: {degrees(throws)}}}")
    ignitions = firings(machine)
    if order:
        assert "-".join(str(number) for _, number in ignitions) == order
    assert intervals([angle for angle, _ in ignitions], 720.0) == pytest.approx(expected)

    # by hand: dead centre = pin + bank, in the turn that was chosen
    per_cylinder = [float(angle) for angle in throws.split()]
    bank_angles = [float(angle) for angle in banks.split()] * (count // len(banks.split()))
    if len(per_cylinder) < count:
        per_cylinder = [angle for angle in per_cylinder for _ in banks.split()]
    positions = []
    for cylinder, pin, bank in zip(machine.cylinders, per_cylinder, bank_angles):
        position = cylinder.crank_position
        assert (position - pin - bank) % 360.0 == pytest.approx(0.0, abs=1e-9)
        positions.append(f"{position!r} deg")
    by_hand = Case(loads(f"{common}crank_positions: [{', '.join(positions)}]}}")).balance
    balance = Case(machine).balance
    degrees_of_crank = [0.0, 40.0, 111.0, 300.0]
    for id in ("F_x", "F_y", "M_x", "M_y", "M_roll"):
        largest = max(map(abs, by_hand.at(degrees_of_crank)[id])) + 1.0
        difference = balance.at(degrees_of_crank)[id] - by_hand.at(degrees_of_crank)[id]
        assert max(abs(difference)) <= 1e-12 * largest


V6 = MACHINES["v6-split"]["machine"]


@pytest.mark.parametrize(
    ("right", "wrong", "message"),
    [
        ("1-6-5-4-3-2", "1-2-3-4-5-6", "cannot fire in this order; the most even order on them"),
        (
            ", 240 deg, 210 deg",
            "",
            "4 angles for 6 cylinders in 2 banks; give 3, one for each throw",
        ),
        ("spacing: 107.7 mm\n", "name: x\n", "'bank_offset' needs 'spacing' beside it"),
        ("throw_angles", "split_pins", "did you mean 'throw_angles'?"),
        ("each: {", "each: {throw_angle: 3 deg, ", "equal cylinders have 'throw_angles'"),
        ("each: {", "each: {crank_position: 3 deg, ", "'throw_angles' sets it; leave it out"),
    ],
)
def test_throws_that_cannot_be(right: str, wrong: str, message: str) -> None:
    with pytest.raises(MachineFileError, match=message.replace("?", r"\?")):
        loads(V6.replace(right, wrong))


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("pin_angle: 98 deg", "did you mean 'throw_angle'?"),
        ("pin_offset: 2 mm", "negative toward the thrust side"),
        ("throw_angle: 98 deg, crank_position: 98 deg", "mean the same; give only one of them"),
    ],
)
def test_a_pin_that_is_not_understood(keys: str, message: str) -> None:
    text = MACHINES["vr-pins"]["machine"]
    with pytest.raises(MachineFileError, match=message.replace("?", r"\?")):
        loads(text.replace("throw_angle: 98 deg", keys))


def test_throws_count_from_that_of_cylinder_1() -> None:
    text = MACHINES["vr-pins"]["machine"]
    with pytest.raises(MachineFileError, match="count from that of cylinder 1"):
        loads(text.replace("{name: c1,", "{name: c1, throw_angle: 5 deg,"))


def test_split_pins_get_no_warning(tmp_path: Path) -> None:
    path = tmp_path / "v6.yaml"
    path.write_text(V6.replace("bank_offset: 3 mm", "bank_offset: 0 mm"), encoding="utf-8")
    assert "share no crank pin" not in run("check", path).output


def test_a_sweep_of_split_pins_is_the_machines_one_by_one(tmp_path: Path) -> None:
    path = tmp_path / "v6.yaml"
    path.write_text(V6, encoding="utf-8")
    vary = "cylinders.throw_angles.1=-40:-20:5 deg"
    rows = run("sweep", path, "--vary", vary, "--columns", "M_free_max", "-f", "csv").stdout
    for row in rows.splitlines()[-5:]:
        _, angle, moment = row.split(",")[:3]
        single = Case(loads(V6.replace("-30 deg", f"{angle} deg")))
        assert float(moment) == pytest.approx(single.balance.M_free_max.value, rel=1e-12)


WOBBLER = MACHINES["wobbler"]["machine"]


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("trunnion: 10 mm", "the crank pin would pass through the trunnions"),
        ("trunnion: 40 mm\nmasses: {piston: 1 kg}", "the cylinder swings with its piston"),
        ("trunnion: 40 mm\ninclination: 90 deg", "the cylinder swings with its piston"),
        ("trunnion: 40 mm\noffset: 2 mm", "belongs to 'mechanism: slider-crank'"),
        ("trunnion: 40 mm\nfriction: {crosshead: 0.1}", "an oscillating-cylinder has no"),
        ("trunnion: 40 mm\nfriction: {crank_pin: 0.1}", "an oscillating-cylinder has no"),
    ],
)
def test_an_oscillating_cylinder_that_cannot_be(keys: str, message: str) -> None:
    with pytest.raises(MachineFileError, match=message):
        loads(WOBBLER.replace("trunnion: 40 mm", keys))


def test_other_words_for_an_oscillating_cylinder_lead_to_it() -> None:
    with pytest.raises(MachineFileError, match="oscillating-cylinder"):
        loads(WOBBLER.replace("oscillating-cylinder", "wobbler"))


def test_an_oscillating_cylinder_turns_as_the_slotted_lever_half_a_turn_on() -> None:
    """The same triangle of shaft, pin and pivot, of which one counts from the far and one from the near pin."""
    lever = loads("{speed: 1000 rpm, mechanism: slotted-lever, crank: 10 mm, frame: 40 mm}")
    cylinder = Case(loads(WOBBLER)).cylinders[0].at([0.0, 25.0, 111.0, 250.0])
    swing = Case(lever).cylinders[0].at([180.0, 205.0, 291.0, 430.0])
    for id in ("theta", "theta_dot", "theta_ddot"):
        assert cylinder[id] == pytest.approx(swing[id], rel=1e-12, abs=1e-12)


def test_at_the_shaft_angle_there_are_no_figures_of_the_own_angle(tmp_path: Path) -> None:
    path = tmp_path / "opposed.yaml"
    path.write_text(MACHINES["opposed"]["machine"], encoding="utf-8")
    printed = answer("motion", path, "--shaft-angle", "--step", "90")
    exhaust = printed["cylinders"][1]
    assert not exhaust.get("key_values")
    own = answer("motion", path, "--angles", "11,101")["cylinders"][1]
    assert column(exhaust["columns"], "x")[:2] == column(own["columns"], "x")
    refused = run("motion", path, "--shaft-angle", "--key-values", "c_max")
    assert "--shaft-angle has a table" in refused.output


V_LINK = MACHINES["v-link"]["machine"]
RADIAL = MACHINES["radial-9"]["machine"]


@pytest.mark.parametrize(
    ("right", "wrong", "message"),
    [
        ("master: main", "master: other", "no earlier cylinder has this name; there are main"),
        ("master: main, ", "", "'master' is missing"),
        ("length: 238.5 mm", "length: 70 mm", "it does not reach: it needs more than"),
        ("bank_angle: 60 deg", "bank_angle: 0 deg", "a link rod has a stroke line of its own"),
        ("bank_angle: 60 deg", "bank_angle: 60 deg, rod: 300 mm", "it is that of its master"),
        ("bank_angle: 60 deg", "bank_angle: 60 deg, crank: 80 mm", "it is that of its master"),
        ("bank_angle: 60 deg", "bank_angle: 60 deg, axial_position: 9 mm", "that of its master"),
        ("bank_angle: 60 deg", "bank_angle: 60 deg, crank_position: 9 deg", "follows from the pin"),
        ("link_rod:", "master_rod:", "did you mean 'link_rod'"),
        (
            "axial_position: 0 mm,",
            "friction: {crank_pin: 0.1, crank_pin_diameter: 9 mm},",
            "link rods",
        ),
    ],
)
def test_link_rods_that_cannot_be(right: str, wrong: str, message: str) -> None:
    with pytest.raises(MachineFileError, match=message):
        loads(V_LINK.replace(right, wrong))


def test_equal_cylinders_name_no_master() -> None:
    with pytest.raises(MachineFileError, match="the first one of every throw has the master rod"):
        loads(RADIAL.replace("link_rod: {", "link_rod: {master: cylinder 1, "))


def test_a_firing_order_of_a_radial_gives_the_turns() -> None:
    free = loads(RADIAL)
    given = loads(RADIAL.replace("spacing", "firing_order: 1-3-5-7-9-2-4-6-8\n  spacing"))
    assert firings(given) == firings(free)


def test_check_names_the_master_rod(tmp_path: Path) -> None:
    path = tmp_path / "radial.yaml"
    path.write_text(RADIAL, encoding="utf-8")
    printed = run("check", path).output
    assert "cylinder 3  " in printed
    assert "crank pin 0 deg behind the first, on the master rod of cylinder 1" in printed
    assert "rods are put on the crank pin itself" not in printed
    on_pin = "\n".join(line for line in RADIAL.splitlines() if "link_rod" not in line)
    path.write_text(on_pin, encoding="utf-8")
    assert "9 rods are put on the crank pin itself" in run("check", path).output


@pytest.mark.parametrize(
    ("machine", "right", "length", "is_doubted"),
    [
        # L = 320 mm, k = 81.5 mm: 15 % of L is 48 mm
        (V_LINK, "length: 238.5 mm", "length: 286.4 mm", False),
        (V_LINK, "length: 238.5 mm", "length: 286.6 mm", True),
        (V_LINK, "length: 238.5 mm", "length: 190.6 mm", False),
        (V_LINK, "length: 238.5 mm", "length: 190.4 mm", True),
        (V_LINK, "length: 238.5 mm, ", "", False),
        # the length of the master rod, written once more
        (RADIAL, "length: 214 mm", "length: 272 mm", True),
        (RADIAL, "length: 214 mm", "length: 214 mm", False),
    ],
)
def test_a_link_rod_as_long_as_its_master_is_doubted(
    machine: str, right: str, length: str, is_doubted: bool, tmp_path: Path
) -> None:
    assert right in machine
    path = tmp_path / "engine.yaml"
    path.write_text(machine.replace(right, length), encoding="utf-8")
    printed = run("check", path).output
    assert ("is 'length' the link rod's own?" in printed) is is_doubted


def test_the_work_of_link_rods_is_that_of_their_pistons() -> None:
    """Virtual work: of each cylinder T R is P x′ less what its masses take; over a cycle only the gas works."""
    case = Case(loads(V_LINK))
    for forces in case.cylinders:
        mean = forces.pieces.mean(forces.sampled("M"))[0]
        assert mean * 2 * math.pi == pytest.approx(forces.work, rel=1e-12)
    side = case.cylinders[1]
    degrees = [10.0, 70.0, 200.0, 333.0]
    state = side.at(degrees)
    on_pin = state.linked_piston.force_on_pin(state.angle, state.knuckle_force)
    assert pytest.approx(on_pin.imag, rel=1e-12) == state.T
    assert pytest.approx(-on_pin.real, rel=1e-12) == state.D


def test_the_torque_of_inertia_of_a_link_rod_follows_from_its_energy() -> None:
    """Tolle: at uniform rotation the inertia forces have the torque −½ ω² dJ/dφ, the mass at the knuckle pin, too."""
    side = Case(loads(V_LINK)).cylinders[1]
    degrees = [10.0, 70.0, 200.0, 333.0]
    step = 1e-2
    before = reduced_inertia(side.at([degree - step for degree in degrees]))
    after = reduced_inertia(side.at([degree + step for degree in degrees]))
    slope = (after - before) / math.radians(2 * step)
    omega = 2 * math.pi * 1800 / 60
    torque = torque_of_inertia(side.at(degrees))
    assert torque == pytest.approx(-0.5 * omega**2 * slope, rel=1e-6)


def test_a_rod_with_its_knuckle_on_the_crank_pin_is_a_rod_on_the_crank_pin() -> None:
    """With k → 0 and l = L the link rod is a rod like any other."""
    knuckle = "length: 320 mm, knuckle_radius: 1e-5 mm"
    near = loads(V_LINK.replace("length: 238.5 mm, knuckle_radius: 81.5 mm", knuckle))
    alone = "\n".join(line for line in V_LINK.splitlines() if "link_rod" not in line) + "}"
    on_pin = loads(
        alone.replace("bank_angle: 60 deg,}", "bank_angle: 60 deg, crank_position: 60 deg}")
    )
    side = Case(near).cylinders[1].at([20.0, 100.0, 300.0])
    other = Case(on_pin).cylinders[1].at([20.0, 100.0, 300.0])
    assert side.x == pytest.approx(other.x, abs=1e-7)
    assert side["b"] == pytest.approx(other["b"], rel=1e-5)


FIRED = """
{speed: 1500 rpm, cycle: four-stroke, cylinders: [
  {name: main, crank: 60 mm, rod: 240 mm, bore: 100 mm, FRICTION
   indicator: {head_end: {unit: bar, clearance: 0.2, interpolate: polytropic,
     intake: [[0, -0.05], [1, -0.05]], compression: [[1, -0.05], [0, 8.8]],
     expansion: [[0, 26], [0.03, 25], [1, 2.6]], exhaust: [[1, 0.1], [0, 0.1]]}}},
  {name: side, like: main, bank_angle: 72 deg,
   link_rod: {master: main, length: 185 mm, knuckle_radius: 52 mm, knuckle_angle: 75 deg}},
  {name: other, like: main, bank_angle: 200 deg, link_rod: {master: main, knuckle_radius: 55 mm}}]}
"""
"""A radial without masses; the second cylinder fires a turn after the third one, 432 deg behind the first."""


def test_the_guides_of_a_radial_carry_the_torque_back() -> None:
    """Σ N h = M about the shaft, h from the shaft to each piston: massless rods leave the frame the reaction alone."""
    case = Case(loads(FIRED.replace("FRICTION", "")))
    shaft = np.array([10.0, 75.0, 100.0, 245.0, 440.0, 461.0, 600.0])
    reaction = torque = 0.0
    for forces in case.cylinders:
        state = forces.at((shaft - forces.drive.lag) % 720)
        mechanism = forces.mechanism
        farthest = 0.3
        if isinstance(mechanism, LinkedPiston):
            farthest = mechanism._reach
        reaction = reaction + state.N * (farthest - state.x)
        torque = torque + state.M
    assert reaction == pytest.approx(torque, rel=1e-12, abs=1e-12 * np.abs(torque).max())


def test_the_guide_of_a_master_is_smooth_between_what_turns_round_in_its_links() -> None:
    """Where a rubbing link changes the side of its guide the master's N has a kink: f |N| |dx| by 200,000 ordinates."""
    forces = Case(loads(FIRED.replace("FRICTION", "friction: {crosshead: 0.08},"))).cylinders[0]
    degrees = (np.arange(200_000) + 0.5) * 720 / 200_000
    state = forces.at(degrees)
    work = -(state.F_friction * state.slope).mean() * 4 * np.pi
    assert forces.friction_works["crosshead"] == pytest.approx(work, rel=1e-5)


def test_accuracy_and_strength_name_link_rods(tmp_path: Path) -> None:
    assert Case(loads(V_LINK)).cylinders[1].residual is None
    assert Case(loads(V_LINK)).cylinders[0].residual is None


def test_a_sweep_of_a_link_rod_is_the_machines_one_by_one(tmp_path: Path) -> None:
    path = tmp_path / "v.yaml"
    path.write_text(V_LINK, encoding="utf-8")
    vary = "cylinders.1.link_rod.length=230:240:5 mm"
    rows = run("sweep", path, "--vary", vary, "--columns", "F_free_max", "-f", "csv").stdout
    for row in rows.splitlines()[-3:]:
        _, length, force = row.split(",")[:3]
        single = loads(V_LINK.replace("238.5 mm", f"{length} m"))
        assert float(force) == pytest.approx(Case(single).balance.F_free_max.value, rel=1e-12)


@pytest.mark.parametrize(
    ("stroke", "rod", "drop", "opens_at", "tolerance"),
    [
        # torqsoft.net, piston position: both its examples, printed to 0.01
        (54.5, 110.0, 25.6, 79.51, 0.005),
        (54.5, 110.0, 27.31, 83.0, 0.02),
        # mopedmasters.com, exhaust timing, chart of the Puch E50: 180 deg less half the duration, printed to 0.1 deg
        (43.0, 90.0, 21.5, 180 - 193.7 / 2, 0.026),
        (43.0, 90.0, 24.0, 180 - 180.6 / 2, 0.026),
        (43.0, 90.0, 26.0, 180 - 169.8 / 2, 0.026),
        (43.0, 90.0, 28.0, 180 - 158.6 / 2, 0.026),
    ],
)
def test_ports_open_where_published_tables_have_them(
    stroke: float, rod: float, drop: float, opens_at: float, tolerance: float, tmp_path: Path
) -> None:
    path = tmp_path / "two-stroke.yaml"
    path.write_text(f"{{stroke: {stroke} mm, rod: {rod} mm, speed: 9000 rpm}}", encoding="utf-8")
    printed = answer("motion", path, "--where", f"x = {drop} mm")
    opening, closing = column(printed["cylinders"][0]["columns"], "phi")
    assert opening == pytest.approx(opens_at, abs=tolerance)
    assert closing == pytest.approx(360 - opens_at, abs=tolerance)


def body_of(of_type: type, name: str) -> Callable[..., Any]:
    """Return the function behind a property."""
    descriptor = vars(of_type)[name]
    if isinstance(descriptor, cached_property):
        return descriptor.func
    function: Callable[..., Any] = descriptor.fget
    return function


KNUCKLE_MOTION = "_, acceleration = linked_piston.knuckle_motion(CrankAngle.of(degrees))"
PIN_MOTION = "acceleration = -linked_piston.crank * unit_vector(degrees)"
SLIPS: tuple[tuple[str, Callable[..., Any], str, str], ...] = (
    ("vr-pair", crank_lag, "+ (first_inner - inner)", ""),
    ("vr-pair", crank_lag, "first_inner - inner", "inner - first_inner"),
    ("v6-split", on_throws, "+ bank_angle", ""),
    ("v6-split", on_throws, "+ bank_angle", "- bank_angle"),
    ("vr-pins", on_throws, "- lead", "+ lead"),
    ("v6-odd-fire", on_throws, "order is None", "True"),
    ("v-link", LinkedPiston._knuckle_at, "(R * pin - slope * arm)", "R * pin"),
    ("v-link", LinkedPiston._knuckle_at, "(cos - 1j * sin)", "(cos + 1j * sin)"),
    ("v-link", LinkedPiston._knuckle_at, "(slope * slope + 1j * bend)", "slope * slope"),
    ("v-link", LinkedPiston._knuckle_at, "self.angle - self.between", "self.angle"),
    ("v-link", LinkedPiston._knuckle_at, "self.angle - self.between", "0.0"),
    ("v-link", LinkedPiston._knuckle_at, "self.radius * unit", "0.0 * unit"),
    ("v-link", LinkedPiston.dead_centres, "self._ends", "(0.0, 180.0)"),
    ("v-link", LinkedPiston.force_on_pin, "- 1j * side", "- 0j * side"),
    ("v-link", LinkedPiston.force_on_pin, "- 1j * side", "+ 1j * side"),
    ("v-link", LinkedPiston.moment_on_master, "return moment", "return 0 * moment"),
    ("v-link", LinkedPiston.moment_on_master, "return moment", "return -moment"),
    ("v-link", LinkedPiston.curvature, "link.cos * link.slope * link.slope + ", ""),
    ("radial-9", _of_knuckles, "* -throw.knuckle_mass", "* throw.knuckle_mass"),
    ("radial-9", _of_knuckles, "-throw.knuckle_mass", "0.0"),
    # the mass at the knuckle pin put on the crank pin: z″ = −R e^{iφ}
    ("radial-9", _of_knuckles, KNUCKLE_MOTION, PIN_MOTION),
    # the mass at the knuckle pin left out of Q, of T, of D
    ("v-link", body_of(State, "knuckle_force"), "self._knuckle_inertia - ", "-"),
    ("v-link", body_of(State, "_rod_tangential"), "self.knuckle_inertia_torque", "0.0"),
    ("v-link", body_of(State, "_knuckle_inertia_on_pin"), "self._knuckle_", "0 * self._knuckle_"),
    # the side force that links take from the master's guide, and their loads on its crank pin
    (
        "v-link",
        body_of(State, "_side_force_of_links"),
        "self._side_force_of(self._moment_of_links)",
        "0.0",
    ),
    ("v-link", MasterPin._frames, "(self._forces, *self._links)", "(self._forces,)"),
    # the force of a wobbler along the line of centres; its cylinder turned the wrong way; x″ without x′²
    ("wobbler", OscillatingCylinder.radial, "angle.cos * cos + angle.sin * sin", "angle.cos"),
    ("wobbler", OscillatingCylinder._direction, "-self.crank", "self.crank"),
    ("wobbler", OscillatingCylinder.curvature, "- slope * slope", ""),
)
"""Machine, function, its text and a wrong one."""


@pytest.mark.parametrize(("id", "function", "right", "wrong"), SLIPS)
def test_a_planted_slip_changes_a_figure(
    id: str,
    function: Callable[..., Any],
    right: str,
    wrong: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    source = textwrap.dedent(inspect.getsource(function))
    assert right in source, (
        f"{function.__name__} has no '{right}': plant the slip in it as it is now"
    )
    module = inspect.getmodule(function)
    spoilt: dict[str, Any] = {**vars(module)}
    lines = source.replace(right, wrong, 1)
    exec(lines[lines.index("def ") :], spoilt)
    monkeypatch.setattr(function, "__code__", spoilt[function.__name__].__code__)
    document = MACHINES[id]
    for figure in document["figures"]:
        try:
            is_figure(document["machine"], figure, tmp_path / "machine.yaml")
        except (AssertionError, KurbelError):
            return
    pytest.fail("no figure is another one")
