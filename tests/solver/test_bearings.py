"""Loads on pins and main bearings: against the free forces, against the statics of one throw, by closed form."""

import cmath
import itertools
import math
import re
from typing import Any

import numpy as np
import pytest
from scipy.integrate import fixed_quad
from scipy.special import ellipk

from command import answer
from kurbel.machine import Machine
from kurbel.machine_file import loads
from kurbel.solver.case import Case
from kurbel.solver.chapters.bearing import Bearing, BearingColumns
from representative import CONFIGS, few

ENGINE = re.sub(r"(?m)^oil_film:.*\n(  .*\n)+", "", CONFIGS["gas-engine"].read_text("utf-8"))
"""Without the sizes of its oil films, which friction gives as well."""
SHAFT = """crankshaft: {a: 60 mm, b: 50 mm, web_distance: 30 mm, web_thickness: 15 mm, web_width: 60 mm,
             pin_diameter: 50 mm, pin_length: 40 mm, journal_diameter: 55 mm, journal_length: 24 mm}
"""
EACH = """crank: 45 mm
    rod: 150 mm
    bore: 90 mm
    indicator: {head_end: {diesel: {intake: 0 bar, compression_ratio: 18, cut_off: 0.06}}}
    masses: {piston: 1.2 kg, rotating: 0.9 kg,
             connecting_rod: {mass: 2 kg, center_of_gravity: 0.1 m, inertia: 7e-3 kg m2}}
"""
HEAD = "speed: 1800 rpm\ncycle: four-stroke\n" + SHAFT
IN_LINE = (
    HEAD
    + f"cylinders:\n  count: 4\n  firing_order: 1-3-4-2\n  spacing: 110 mm\n  each:\n    {EACH}"
)
VEE = HEAD + f"cylinders:\n  count: 2\n  bank_angles: [0 deg, 90 deg]\n  each:\n    {EACH}"
OVERHUNG = (
    HEAD
    + f"cylinders:\n  - {EACH}    axial_position: 0 mm\n  - like: cylinder 1\n    crank_position: 90 deg\n"
    "    axial_position: 500 mm\n"
).replace("b: 50 mm", "b: 400 mm, overhung: true")
COUNTERWEIGHTS = "counterweights: [{product: 0.03 kg m, angle: 170 deg, axial_position: 20 mm}, {mass: 1 kg, radius: 40 mm}]\n"
MACHINES = {
    "one": HEAD + EACH.replace("\n    ", "\n"),
    "one, counterweights": HEAD + EACH.replace("\n    ", "\n") + COUNTERWEIGHTS,
    "one, a share": HEAD + EACH.replace("\n    ", "\n") + "counterweights: {share: 0.5}\n",
    "four in line": IN_LINE,
    "four in line, planes": IN_LINE + "counterweights: {share: 0.3, planes: [-20 mm, 400 mm]}\n",
    "vee": VEE,
    "two overhung": OVERHUNG,
    "offset": HEAD + EACH.replace("\n    ", "\n") + "offset: 12 mm\n",
    "rod by its share": HEAD
    + EACH.replace("\n    ", "\n").replace(
        "center_of_gravity: 0.1 m, inertia: 7e-3 kg m2", "share: 0.4"
    ),
}


def main_bearings(case: Case) -> list[Bearing]:
    return [part for part in case.bearings.parts if part.name.startswith("bearing")]


def in_engine(part: Bearing, degrees: np.ndarray) -> np.ndarray:
    result = part.at(degrees)
    return result.load * np.exp(1j * np.radians(result.load_engine))


def counterweights(machine: Machine) -> complex:
    """Sum in kg m of all counterweights, along the throw of crank 1: from the machine file alone."""
    given = machine.counterweights
    if isinstance(given, tuple):
        return sum(one.product * cmath.exp(1j * math.radians(one.angle)) for one in given)
    return -sum(
        (
            cylinder.masses.at_pin(cylinder.mechanism.rod_length)
            + given.share * cylinder.masses.at_crosshead(cylinder.mechanism.rod_length)
        )
        * cylinder.mechanism.crank
        * cmath.exp(1j * math.radians(cylinder.bank_angle - cylinder.crank_position))
        for cylinder in machine.cylinders
    )


@pytest.mark.parametrize("name", few(MACHINES, list(MACHINES)[::3]))
def test_bearings_guides_and_covers_give_the_free_force_at_every_angle(name: str) -> None:
    """Internal forces cancel: what shaft, crossheads and gas leave on the frame is −Σ m a of what moves."""
    case = Case(loads(MACHINES[name]))
    machine, omega = case.machine, 2 * math.pi * 30
    phi = np.linspace(0.0, 720.0, 721) + 0.3
    on_frame = sum(in_engine(part, phi) for part in main_bearings(case))
    free = counterweights(machine) * omega**2 * np.exp(1j * np.radians(phi))
    for forces in case.cylinders:
        one = forces.drive.cylinder
        own, line = phi - one.crank_position, cmath.exp(1j * math.radians(one.bank_angle))
        state = forces.at(own)
        on_frame = on_frame + line * (state.P_gas - 1j * state.N)
        turning = one.masses.at_pin(one.mechanism.rod_length) * one.mechanism.crank * omega**2
        free = free + line * (forces.drive.mass * state.b + turning * np.exp(1j * np.radians(own)))
    largest = max(part.load_max.value for part in main_bearings(case))
    reported = case.balance.columns(phi)
    assert np.abs(reported["F_x"] + 1j * reported["F_y"] - free).max() <= 1e-13 * largest
    assert np.abs(on_frame - free).max() <= 1e-13 * largest
    # and over a turn nothing is left of it
    assert abs(on_frame[:-1].mean()) <= 1e-13 * largest


def test_a_bearing_between_two_throws_carries_both() -> None:
    case = Case(loads(IN_LINE))
    alone = Case(loads(MACHINES["one"]))
    A, B = main_bearings(alone)
    phi = np.linspace(0.0, 720.0, 73)
    turn = np.array([0.0, 540.0, 180.0, 360.0])  # crank positions of 1-3-4-2
    fixed = [in_engine(A, np.mod(phi - turn[0], 720.0))]
    fixed += [
        in_engine(B, np.mod(phi - turn[k], 720.0)) + in_engine(A, np.mod(phi - turn[k + 1], 720.0))
        for k in range(3)
    ]
    fixed += [in_engine(B, np.mod(phi - turn[3], 720.0))]
    assert len(main_bearings(case)) == 5
    for part, wanted in zip(main_bearings(case), fixed):
        assert np.abs(in_engine(part, phi) - wanted).max() <= 1e-12 * part.load_max.value


def test_a_counterweight_is_shared_by_the_bearings_as_by_a_lever() -> None:
    """0.06 kg m opposite the pin, in its plane, between bearings at 60 and 50 mm: A takes 5/11 of it, B 6/11."""
    text = MACHINES["one"] + "counterweights: [{product: 0.06 kg m, angle: 180 deg}]\n"
    phi = np.linspace(0.0, 720.0, 25)
    pull = 0.06 * (60 * math.pi) ** 2
    for part, bare, share in zip(
        main_bearings(Case(loads(text))),
        main_bearings(Case(loads(MACHINES["one"]))),
        (5 / 11, 6 / 11),
    ):
        more = in_engine(part, phi) - in_engine(bare, phi)
        opposite = -share * pull * np.exp(1j * np.radians(phi))
        assert np.abs(more - opposite).max() <= 1e-9 * pull


def test_two_rods_on_one_pin_have_half_of_it_each() -> None:
    parts = Case(loads(VEE)).bearings.parts
    assert [part.name for part in parts] == [
        *("crank pin of cylinder 1", "crosshead pin of cylinder 1", "crank pin of cylinder 2"),
        *("crosshead pin of cylinder 2", "bearing A", "bearing B"),
    ]
    assert parts[0].pressure_max.value == pytest.approx(
        parts[0].load_max.value / (0.050 * 0.020), rel=1e-14
    )


def test_directions_in_the_three_frames() -> None:
    """At 90° the throw stands square to the stroke line, and the rod leads back by ψ from the pin to the crosshead."""
    pin, crosshead, *_ = Case(loads(MACHINES["one"])).bearings.parts
    (throw,), (engine,), (rod,) = (
        getattr(pin.at([90.0]), f"load_{frame}") for frame in ("throw", "engine", "rod")
    )
    assert engine - throw == pytest.approx(90.0, abs=1e-12)
    assert rod - engine == pytest.approx(math.degrees(math.asin(0.3)), abs=1e-12)
    state = Case(loads(MACHINES["one"])).cylinders[0].at([90.0])
    assert throw == pytest.approx(math.degrees(math.atan2(state.T[0], -state.D[0])), abs=1e-12)
    assert crosshead.at([90.0]).load_throw is None


PLAIN = """crank: 100 mm
rod: infinite
bore: 100 mm
speed: 60 rpm
indicator: {head_end: {constant: {expansion: 10 bar, compression: 10 bar}}}
"""


def test_what_a_constant_force_never_loads() -> None:
    """It goes all round the crank pin, stands in one place of its shell, and of the crosshead pin and its bush."""
    pin, crosshead = Case(loads(PLAIN)).bearings.parts
    assert (pin.unloaded_arc, pin.unloaded_middle) == (0.0, None)
    assert pin.unloaded_arc_shell == pytest.approx(240, abs=1e-9)
    assert pin.unloaded_middle_shell == 180  # the rod presses its end from the crosshead
    assert crosshead.unloaded_arc == pytest.approx(240, abs=1e-9)
    assert crosshead.unloaded_middle == 0
    for load in (pin.load_max.value, pin.load_min.value, pin.load_mean, pin.load_high):
        assert load == pytest.approx(1e6 * math.pi / 400, rel=1e-14)


@pytest.mark.parametrize("pressure", [0.73, 0.87, 1.15])
def test_an_unloaded_arc_ends_where_the_load_vanishes(pressure: float) -> None:
    """The rod alone loads this pin, pulling over ±φ_0 and pressing over the rest, with ε = −φ − ψ but for a half turn.

    Of two arcs about one middle, a and 180° − a to either side with a = φ_0 + ψ_0, and 60° more, the wider one counts.
    """
    case = Case(
        loads(
            "{speed: 300 rpm, crank: 80 mm, rod_ratio: 4, bore: 100 mm, masses: {piston: 20 kg}, "
            f"indicator: {{head_end: {pressure} bar}}}}"
        )
    )
    change = case.cylinders[0].phi_reversal[0]
    turned = change + math.degrees(math.asin(math.sin(math.radians(change)) / 4))
    assert case.bearings.parts[0].unloaded_arc == pytest.approx(
        240 - 2 * max(turned, 180 - turned), abs=1e-9
    )


def test_unloaded_arcs_against_many_samples() -> None:
    """Of the gas engine, by marking every hundredth of a degree that any of 36 000 loads reaches."""
    for part in Case(loads(ENGINE)).bearings.parts:
        columns = part.at(np.arange(0.0, 720.0, 0.02))
        for frame, arc in (
            (part.journal, part.unloaded_arc),
            (part.shell, part.unloaded_arc_shell),
        ):
            centres = np.unique(
                np.round(getattr(columns, f"load_{frame}") * 100).astype(int) % 36000
            )
            edges = np.diff(np.concatenate((centres, [centres[0] + 36000])))
            assert arc == pytest.approx(sum(max(gap / 100 - 120, 0.0) for gap in edges), abs=0.1)


def test_means_against_scipy() -> None:
    pin = Case(loads(ENGINE)).bearings.parts[0]
    pieces = list(itertools.pairwise(pin.breaks))

    def load(degrees: np.ndarray, within: float) -> np.ndarray:
        return pin.at(degrees, np.full_like(degrees, within)).load

    whole = sum(
        fixed_quad(load, low, high, args=((low + high) / 2,), n=60)[0] for low, high in pieces
    )
    assert pin.load_mean == pytest.approx(whole / 720, rel=1e-12)
    sampled = pin.at(np.arange(0.005, 720.0, 0.01)).load
    assert pin.load_high == pytest.approx(
        sampled[sampled > pin.load_max.value / 2].mean(), rel=1e-4
    )
    assert pin.load_min.value == pytest.approx(sampled.min(), rel=1e-6)


def test_rubbing_speeds() -> None:
    pin, crosshead, A, _ = Case(
        loads(
            ENGINE
            + "friction: {crosshead_pin: 0.05, crosshead_pin_diameter: 180 mm, crosshead_pin_length: 250 mm}\n"
        )
    ).bearings.parts
    omega = 2 * math.pi * 200 / 60
    assert pin.rubbing_speed_max.value == pytest.approx(omega * 0.105 * 1.2, rel=1e-13)
    # in the inner dead centre the rod turns against the crank
    assert pin.rubbing_speed_max.degrees == pytest.approx(0.0, abs=1e-6)
    assert pin.rubbing_speed_mean == pytest.approx(omega * 0.105, rel=1e-12)
    assert A.rubbing_speed_max.value == pytest.approx(omega * 0.100, rel=1e-13)
    assert A.rubbing_speed_mean == pytest.approx(omega * 0.100, rel=1e-13)
    assert crosshead.rubbing_speed_max.value == pytest.approx(omega * 0.090 * 0.2, rel=1e-12)
    assert crosshead.rubbing_speed_mean == pytest.approx(
        omega * 0.090 * 4 * math.asin(0.2) / (2 * math.pi), rel=1e-12
    )
    assert crosshead.pressure_max.value == pytest.approx(
        crosshead.load_max.value / (0.18 * 0.25), rel=1e-14
    )


def test_work_of_friction_is_that_of_the_energy_balance() -> None:
    rubs = "friction: {crank_pin: 0.05, crosshead_pin: 0.06, crosshead_pin_diameter: 180 mm, journals: 0.04}\n"
    case = Case(loads(ENGINE + rubs))
    pin, crosshead, A, B = case.bearings.parts
    work_of = case.cylinders[0].friction_works.get
    assert pin.work_rubbing == work_of("crank_pin")
    assert crosshead.work_rubbing == work_of("crosshead_pin")
    assert A.work_rubbing + B.work_rubbing == pytest.approx(work_of("journals"), rel=1e-12)


def test_work_of_friction_is_that_of_a_cycle_of_the_machine() -> None:
    """A compressor turns twice in the cycle of the four-stroke engine beside it: its pins lose twice their own work."""
    friction = "friction: {crank_pin: 0.05}"
    shape = f"crank: 45 mm, rod: 150 mm, bore: 90 mm, {friction}"
    engine = "indicator: {head_end: {otto: {intake: 0 bar, compression_ratio: 8, peak: 40 bar}}}"
    compressor = "indicator: {head_end: {constant: {expansion: 0 bar, compression: 2 bar}}}"
    cylinders = (
        f"cylinders:\n  - {{name: engine, {shape}, {engine}}}\n"
        f"  - {{name: compressor, cycle: two-stroke, {shape}, {compressor}}}\n"
    )
    case = Case(loads("speed: 1800 rpm\ncycle: four-stroke\n" + SHAFT + cylinders))
    works = {part.name: part.work_rubbing for part in case.bearings.parts}
    own = [cylinder.friction_works["crank_pin"] for cylinder in case.cylinders]
    assert works["crank pin of engine"] == pytest.approx(own[0], rel=1e-14)
    assert works["crank pin of compressor"] == pytest.approx(2 * own[1], rel=1e-14)
    # S = P/cos ψ over half a turn: 2 K(λ²)
    force = 2e5 * math.pi / 4 * 0.09**2
    assert own[1] == pytest.approx(0.05 * 0.025 * force * 2 * ellipk(0.3**2), rel=1e-12)


def test_a_load_that_is_only_rounding_has_no_direction_of_its_own() -> None:
    """Beside a largest load of 2 kN what is 1e-13 kN is none, and has the direction of none: 0°."""
    loads_at = np.array([1000 + 1000j, -1e-10 - 1e-10j, 0.0, -2000.0])
    columns = BearingColumns(np.arange(4.0), {"engine": loads_at}, 2000.0, None)
    assert columns.direction("engine") == pytest.approx([45.0, 0.0, 0.0, 180.0], abs=1e-12)


@pytest.mark.parametrize("command", ["bearings", "balance", "flywheel", "stress"])
def test_bank_angles_count_from_the_stroke_line_of_cylinder_1(command: str) -> None:
    """The same machine with 30° more at every stroke line has the same figures: they are between the lines."""
    text = (
        HEAD + f"cylinders:\n  - {EACH}    axial_position: 0 mm\n    bank_angle: 0 deg\n"
        "  - {like: cylinder 1, axial_position: 150 mm, crank_position: 200 deg, bank_angle: 70 deg}\n"
    )
    turned = text.replace("bank_angle: 0 deg", "bank_angle: 30 deg").replace("70 deg", "100 deg")
    documents = [answer(command, "-", text=version) for version in (text, turned)]
    for document in documents:
        document.pop("inputs", None)
    assert figures(documents[1]) == pytest.approx(figures(documents[0]), rel=1e-9, abs=1e-6)


def figures(document: Any) -> list[float]:
    """All numbers of a document in their order."""
    if isinstance(document, dict):
        return [number for value in document.values() for number in figures(value)]
    if isinstance(document, list):
        return [number for value in document for number in figures(value)]
    is_number = isinstance(document, (int, float)) and not isinstance(document, bool)
    return [float(document)] if is_number else []
